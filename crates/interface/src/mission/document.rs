//! A mission file as text: places of keys, changes to it, and the way to a checked [`Mission`].

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml_edit::{Document as Spanned, DocumentMut, Item, TableLike, Value};

use super::check::{self, Finding};
use super::{FORMAT, Mission, MissionError, Problem};

/// The text of a mission file. Changes keep its comments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Document {
    origin: String,
    folder: PathBuf,
    text: String,
    /// Keys that have been set since it was read: places count in the changed text.
    set: Vec<String>,
}

/// What to add where a name was given that is neither a file nor a mission of the project.
fn of_no_mission(path: &Path, source: &std::io::Error) -> String {
    let bare = path.extension().is_none() && path.components().count() == 1;
    if !bare || source.kind() != std::io::ErrorKind::NotFound {
        return String::new();
    }
    let names: Vec<&str> = super::EMBEDDED.iter().map(|entry| entry.name).collect();
    format!(
        "; nor is it a mission of the project{}",
        one_of(&path.to_string_lossy(), &names, "there are")
    )
}

/// Longest name, bytes, that a nearer one is looked for; of longer ones the beginning is shown.
const LONGEST_SLIP: usize = 100;

/// Most findings that are told of.
const TOLD: usize = 100;

/// The end of a message about a name that does not exist: the nearest one, if one is near, and all there are.
///
/// * `all`: how these are introduced.
fn one_of(given: &str, known: &[&str], all: &str) -> String {
    // Of a text that nobody has typed no slip can be told; it would take memory by its length.
    let typed = given.len() <= LONGEST_SLIP;
    let nearest = known
        .iter()
        .filter(|_| typed)
        .map(|name| (strsim::damerau_levenshtein(given, name), *name))
        // A name without its unit is a likely slip.
        .min_by_key(|(distance, name)| if name.starts_with(given) { 0 } else { *distance });
    let hint = match nearest {
        Some((distance, name)) if distance <= 1 + given.len() / 2 || name.starts_with(given) => {
            format!(", did you mean `{name}`?")
        }
        _ => ";".into(),
    };
    let mut names = known.to_vec();
    names.sort_unstable();
    format!("{hint} {all}: {}", names.join(", "))
}

impl Document {
    /// Reads a file; nothing is checked yet.
    ///
    /// # Errors
    /// [`MissionError::Read`].
    pub fn read(path: &Path) -> Result<Self, MissionError> {
        let read = |path: &Path| {
            let folder = std::path::absolute(path)?
                .parent()
                .map(Path::to_owned)
                .unwrap_or_default();
            Ok::<_, std::io::Error>((crate::text::read(path)?, folder))
        };
        let (text, folder) = read(path).map_err(|source| MissionError::Read {
            path: path.display().to_string(),
            reason: format!("{source}{}", of_no_mission(path, &source)),
        })?;
        Ok(Self {
            origin: path.display().to_string(),
            folder,
            text,
            set: Vec::new(),
        })
    }

    /// A text that messages call `origin`.
    ///
    /// # Errors
    /// When it is no TOML.
    pub fn parse(origin: &str, text: &str) -> Result<Self, MissionError> {
        let document = Self {
            origin: origin.to_owned(),
            folder: PathBuf::new(),
            text: text.to_owned(),
            set: Vec::new(),
        };
        document.spanned()?;
        Ok(document)
    }

    /// The text as it stands now.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Folder that relative paths in the file start from.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Sets a key, as in `vent.co2.period_s` or `navigation.law.milton.r_w`; entries of lists go by their name or number.
    ///
    /// * `value`: as TOML writes it; what is no TOML value is taken as text.
    ///
    /// # Errors
    /// [`MissionError::Set`] when a table on the way does not exist. Whether the key is a known one shows when the mission is
    /// read.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), MissionError> {
        let key = key.trim();
        let refuse = |reason: String| MissionError::Set {
            key: key.to_owned(),
            reason,
        };
        let mut document: DocumentMut = self
            .text
            .parse()
            .map_err(|e: toml_edit::TomlError| refuse(e.to_string()))?;
        let parsed: Value = value.parse().unwrap_or_else(|_| Value::from(value));
        let segments = segments(key);
        let Some((last, tables)) = segments.split_last() else {
            return Err(refuse("it is empty".into()));
        };
        let table = holder(document.as_table_mut(), tables).map_err(&refuse)?;
        match table.get_mut(last) {
            Some(Item::Value(old)) => {
                // What stands around a value, a comment behind it above all, stays.
                let decor = old.decor().clone();
                *old = parsed;
                *old.decor_mut() = decor;
            }
            _ => {
                table.insert(last, Item::Value(parsed));
            }
        }
        self.text = document.to_string();
        self.set.push(key.to_owned());
        Ok(())
    }

    /// Makes every path in the text absolute, so that the text may stand in another folder.
    ///
    /// # Errors
    /// As for [`Document::set`].
    pub fn make_paths_absolute(&mut self) -> Result<(), MissionError> {
        for (key, path) in self.files()? {
            self.set(key, &Value::from(path.display().to_string()).to_string())?;
        }
        Ok(())
    }

    /// Files that the text names: the key of each, and its path from here.
    ///
    /// # Errors
    /// When the text is no TOML.
    pub fn files(&self) -> Result<Vec<(&'static str, PathBuf)>, MissionError> {
        let spanned = self.spanned()?;
        let file = |section: &str| {
            let gravity = spanned.as_table().get(section)?.get("gravity")?;
            Some(self.folder.join(gravity.get("file")?.as_str()?))
        };
        let keys = [
            ("environment.gravity.file", file("environment")),
            ("navigation.gravity.file", file("navigation")),
        ];
        Ok(keys.into_iter().filter_map(|(key, path)| Some((key, path?))).collect())
    }

    /// The mission that the text states.
    ///
    /// # Errors
    /// [`MissionError::Invalid`] with everything that is wrong.
    pub fn mission(&self) -> Result<Mission, MissionError> {
        let spanned = self.spanned()?;
        let problem = |path: &str, what: String| self.problem(span_of(spanned.as_table(), &segments(path)), what);
        if let Some(version) = spanned.get("mission").and_then(Item::as_integer)
            && version > i64::from(FORMAT)
        {
            let what = format!("mission = {version} is a newer format than this program reads: at most {FORMAT}");
            return Err(MissionError::Invalid(vec![problem("mission", what)]));
        }
        let mut not_finite = Vec::new();
        floats(spanned.as_item(), String::new(), &mut |path, value, span| {
            if !value.is_finite() {
                not_finite.push(self.problem(span, format!("{path} = {value}: it must be a finite number")));
            }
        });
        if !not_finite.is_empty() {
            return Err(MissionError::Invalid(not_finite));
        }
        let mut mission: Mission =
            toml::from_str(&self.text).map_err(|e| MissionError::Invalid(vec![self.told(&e)]))?;
        mission.folder = self.folder.clone();
        let mut findings = Vec::new();
        // What the file says and the mission does not hold has been passed over: a list where a table belongs, an entry too many.
        if let (Ok(said), Ok(held)) = (self.text.parse::<toml::Table>(), toml::Table::try_from(&mission)) {
            passed_over(&said, &held, "", &mut findings);
        }
        findings.extend(check::findings(&mission));
        if findings.is_empty() {
            return Ok(mission);
        }
        Err(MissionError::Invalid(
            findings
                .into_iter()
                .take(TOLD)
                .map(|Finding { path, what }| problem(&path, what))
                .collect(),
        ))
    }

    /// What the parser says, at the place of the key that it names.
    fn told(&self, error: &toml::de::Error) -> Problem {
        let (place, what) = explained(&self.text, error);
        self.problem(place, what)
    }

    fn spanned(&self) -> Result<Spanned<&str>, MissionError> {
        Spanned::parse(self.text.as_str()).map_err(|e| {
            let (place, what) = too_deep(&self.text, e.message()).unwrap_or((e.span(), e.message().to_owned()));
            MissionError::Invalid(vec![self.problem(place, what)])
        })
    }

    fn problem(&self, span: Option<Range<usize>>, what: String) -> Problem {
        let origin = match self.set.as_slice() {
            [] => self.origin.clone(),
            set => format!("{} with {} set", self.origin, set.join(", ")),
        };
        Problem {
            origin,
            place: span.map(|span| place(&self.text, span.start)),
            what,
        }
    }
}

impl Problem {
    /// What a TOML parser says of a text, in the words of mission files: with the nearest name that is allowed.
    ///
    /// * `origin`: the file, or what the text is called.
    pub fn of_toml(origin: &str, text: &str, error: &toml::de::Error) -> Self {
        let (span, what) = explained(text, error);
        Self {
            origin: origin.to_owned(),
            place: span.map(|span| place(text, span.start)),
            what,
        }
    }
}

/// What the parser says, and the place of the key that it names.
fn explained(text: &str, error: &toml::de::Error) -> (Option<Range<usize>>, String) {
    if let Some(told) = too_deep(text, error.message()) {
        return told;
    }
    let what = friendlier(error.message(), text, error.span());
    // A table that is read whole before its kind is known gives its own place for what is wrong inside.
    let named = error
        .message()
        .strip_prefix("unknown field `")
        .and_then(|rest| rest.split('`').next());
    let place = error.span().map(|span| {
        let inside = named.and_then(|key| {
            let text = text.get(span.start..)?;
            let at = text.match_indices(key).map(|(at, _)| at).find(|at| {
                let (before, after) = (text[..*at].chars().next_back(), text[at + key.len()..].trim_start());
                after.starts_with('=') && !before.is_some_and(|c| c.is_alphanumeric() || c == '_')
            })?;
            Some(span.start + at..span.start + at + key.len())
        });
        inside.unwrap_or(span)
    });
    (place, what)
}

/// The parser says of a key of too many parts neither where nor how many there may be.
fn too_deep(text: &str, message: &str) -> Option<(Option<Range<usize>>, String)> {
    const PARTS: usize = 80;
    (message == "recursion limit").then(|| {
        let mut begin = 0;
        let line = text.split_inclusive('\n').find_map(|line| {
            let range = begin..begin + line.len();
            begin = range.end;
            (line.matches('.').count() >= PARTS).then_some(range)
        });
        (line, format!("a key has {PARTS} parts or more"))
    })
}

/// Line and column, from 1, of a byte.
fn place(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
    (line, column)
}

/// The entry of a list that has this name, or this number counted from 1.
fn place_in_list<'a>(names: impl Iterator<Item = Option<&'a str>>, segment: &str) -> Option<usize> {
    let names: Vec<_> = names.collect();
    names.iter().position(|name| *name == Some(segment)).or_else(|| {
        let number: usize = segment.parse().ok()?;
        (1..=names.len()).contains(&number).then(|| number - 1)
    })
}

fn name_of(table: &dyn TableLike) -> Option<&str> {
    table.get("name").and_then(Item::as_str)
}

/// The parts of a path; names of laws have a dot of their own.
fn segments(path: &str) -> Vec<&str> {
    match path.strip_prefix("navigation.law.") {
        Some(law) => vec!["navigation", "law", law],
        None => path.split('.').collect(),
    }
}

/// Place of what a path names, or of the nearest thing that holds it.
fn span_of(table: &dyn TableLike, path: &[&str]) -> Option<Range<usize>> {
    let (first, rest) = path.split_first()?;
    let item = table.get(first)?;
    let deeper = match (item, rest.split_first()) {
        (Item::ArrayOfTables(list), Some((entry, rest))) => {
            let at = place_in_list(list.iter().map(|t| name_of(t)), entry)?;
            let table = list.get(at)?;
            span_of(table, rest).or_else(|| table.span())
        }
        (item, Some(_)) => item.as_table_like().and_then(|table| span_of(table, rest)),
        (_, None) => None,
    };
    let of_key = || table.key(first).and_then(toml_edit::Key::span);
    deeper.or_else(|| item.span()).or_else(of_key)
}

/// The table that holds the last key of a path; tables that do not exist are made.
fn holder<'a>(table: &'a mut dyn TableLike, path: &[&str]) -> Result<&'a mut dyn TableLike, String> {
    let Some((first, rest)) = path.split_first() else {
        return Ok(table);
    };
    let item = table.entry(first).or_insert_with(toml_edit::table);
    if let Item::ArrayOfTables(list) = item {
        let names: Vec<&str> = list.iter().filter_map(|t| name_of(t)).collect();
        let known = names.join(", ");
        let Some((entry, rest)) = rest.split_first() else {
            return Err(format!("{first:?} is a list: say which entry, of {known}"));
        };
        let at = place_in_list(list.iter().map(|t| name_of(t)), entry);
        return match at.and_then(|at| list.get_mut(at)) {
            Some(table) => holder(table, rest),
            None => Err(format!("{first:?} has no entry {entry:?}: there are {known}")),
        };
    }
    match item.as_table_like_mut() {
        Some(table) => holder(table, rest),
        None => Err(format!("{first:?} is no table")),
    }
}

/// Calls `each` with every float of the document: its path, value and place.
fn floats(item: &Item, path: String, each: &mut impl FnMut(&str, f64, Option<Range<usize>>)) {
    let below = |key: &str| {
        if path.is_empty() {
            key.to_owned()
        } else {
            format!("{path}.{key}")
        }
    };
    match item {
        Item::None => (),
        Item::Value(value) => floats_of(value, &path, each),
        Item::Table(table) => table.iter().for_each(|(key, item)| floats(item, below(key), each)),
        Item::ArrayOfTables(list) => {
            for (place, table) in (1..).zip(list) {
                let name = name_of(table).map_or_else(|| format!("{place}"), str::to_owned);
                for (key, item) in table {
                    floats(item, format!("{}.{key}", below(&name)), each);
                }
            }
        }
    }
}

fn floats_of(value: &Value, path: &str, each: &mut impl FnMut(&str, f64, Option<Range<usize>>)) {
    match value {
        Value::Float(float) => each(path, *float.value(), value.span()),
        Value::Array(array) => array.iter().for_each(|value| floats_of(value, path, each)),
        Value::InlineTable(table) => table
            .iter()
            .for_each(|(key, value)| floats_of(value, &format!("{path}.{key}"), each)),
        _ => (),
    }
}

/// Finds what a table says that another, read from it, does not hold.
fn passed_over(said: &toml::Table, held: &toml::Table, path: &str, findings: &mut Vec<Finding>) {
    for (key, value) in said {
        let path = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        let Some(kept) = held.get(key) else {
            // An empty list says nothing.
            if value.as_array().is_none_or(|list| !list.is_empty()) {
                let what = format!("{path} goes with nothing else here: only one of these may be given");
                findings.push(Finding { path, what });
            }
            continue;
        };
        compare(value, kept, path, findings);
    }
}

fn compare(said: &toml::Value, held: &toml::Value, path: String, findings: &mut Vec<Finding>) {
    use toml::Value::{Array, Table};
    match (said, held) {
        (Table(said), Table(held)) => passed_over(said, held, &path, findings),
        (Array(_), Table(_)) => {
            let what = format!("{path} is a list: a table {{ key = value, ... }} belongs here");
            findings.push(Finding { path, what });
        }
        (Array(said), Array(held)) if said.len() != held.len() => {
            let what = format!("{path} has {} entries: {} belong here", said.len(), held.len());
            findings.push(Finding { path, what });
        }
        (Array(said), Array(held)) => {
            for (number, (said, held)) in (1..).zip(said.iter().zip(held)) {
                let name = said.get("name").and_then(toml::Value::as_str);
                let entry = name.map_or_else(|| number.to_string(), str::to_owned);
                compare(said, held, format!("{path}.{entry}"), findings);
            }
        }
        _ => (),
    }
}

/// A parser's message, with the nearest of the names it lists.
fn friendlier(message: &str, text: &str, span: Option<Range<usize>>) -> String {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let kind = ["unknown field", "unknown variant"]
        .into_iter()
        .find(|kind| message.starts_with(kind));
    if let (Some(kind), Some((given, known))) = (kind, quoted.split_first()) {
        let what = if kind == "unknown field" {
            "unknown key"
        } else {
            "unknown value"
        };
        let mut shown: String = given.chars().take(LONGEST_SLIP).collect();
        if shown.len() < given.len() {
            shown.push_str("...");
        }
        return format!("{what} `{shown}`{}", one_of(given, known, "allowed here"));
    }
    let given = span.and_then(|span| text.get(span)).unwrap_or_default();
    if message.starts_with("invalid type") && !given.is_empty() && given.len() < 60 && !given.contains('\n') {
        return format!("{message}, in `{given}`");
    }
    message.to_owned()
}
