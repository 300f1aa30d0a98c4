//! Settings that differ from case to case of a study.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use numerics::{Source, stream};
use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::arguments::Assignment;
use crate::variation::Distribution;

/// Most cases of a grid: each is a study of its own.
const MOST_CASES: usize = 1000;

/// A value of a setting as files hold it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// `true` or `false`.
    Switch(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// Anything else.
    Text(String),
}

impl Setting {
    /// What a text stands for, as TOML would read it.
    fn of(text: &str) -> Self {
        let text = text.trim();
        match (text.parse(), text.parse(), text.parse()) {
            (Ok(on), _, _) => Self::Switch(on),
            (_, Ok(number), _) => Self::Whole(number),
            (_, _, Ok(number)) => Self::Number(number),
            _ => Self::Text(text.to_owned()),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Switch(on) => write!(f, "{on}"),
            Self::Whole(number) => write!(f, "{number}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// Settings by `MODEL.VARIABLE`, in one of three forms: lists of values, whole cases, or a Latin hypercube. Several grids are
/// combined, each case of one with each of the next.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Grid {
    /// Values are taken together, the first of each, then the second, instead of each with each.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub zip: bool,
    /// Number of points of a Latin hypercube over `range`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lhs: Option<u32>,
    /// Cases one by one; the key `case` gives one a name of its own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cases: Vec<BTreeMap<String, Setting>>,
    /// Values of each setting; in a product, settings in the order of the alphabet, the last one changing fastest.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Vec<Setting>>,
    /// What the points of a Latin hypercube are drawn from.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub range: BTreeMap<String, Distribution>,
}

/// One case.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Point {
    /// What it sets.
    pub(crate) settings: Vec<Assignment>,
    /// Its name, in parts.
    pub(crate) name: Vec<String>,
    /// Whether somebody gave it that name: else it says what is set.
    pub(crate) named: bool,
}

impl Point {
    fn of(setting: Assignment) -> Self {
        Self {
            name: vec![format!("{}-{}", setting.variable, setting.value)],
            settings: vec![setting],
            named: false,
        }
    }

    fn with(mut self, other: Self) -> Self {
        self.settings.extend(other.settings);
        self.name.extend(other.name);
        self.named |= other.named;
        self
    }
}

/// Key of a case that gives it a name.
const CASE: &str = "case";

impl Grid {
    /// One setting with its values, as a command line gives it.
    ///
    /// # Errors
    /// A text that is not `MODEL.VARIABLE=VALUE,VALUE,...`.
    pub fn axis(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not MODEL.VARIABLE=VALUE,VALUE,..., as in fmu-truth.vent.scale=1,3,10");
        let Assignment { model, variable, value } = text.parse().map_err(|_| wrong())?;
        let values: Vec<Setting> = value.split(',').map(Setting::of).collect();
        if value.split(',').any(str::is_empty) {
            return Err(wrong());
        }
        Ok(Self {
            set: [(format!("{model}.{variable}"), values)].into(),
            ..Self::default()
        })
    }

    /// Settings of each case, in order.
    ///
    /// * `seed`, `place`: of the study and of the grid in it: they select the draws of a Latin hypercube.
    ///
    /// # Errors
    /// What is wrong with the grid and what is allowed.
    fn points(&self, seed: i32, place: usize) -> Result<Vec<Point>, String> {
        let forms = [
            !self.set.is_empty(),
            !self.cases.is_empty(),
            self.lhs.is_some() || !self.range.is_empty(),
        ];
        if forms.iter().filter(|given| **given).count() != 1 {
            return Err("takes one of: set (with or without zip), cases, lhs with range".to_owned());
        }
        if self.zip && self.set.is_empty() {
            return Err("zip goes with set alone".to_owned());
        }
        if !self.cases.is_empty() {
            return self.cases.iter().map(listed).collect();
        }
        if self.set.is_empty() {
            return self.hypercube(seed, place);
        }
        if let Some((name, _)) = self.set.iter().find(|(_, values)| values.is_empty()) {
            return Err(format!("set.\"{name}\" has no value"));
        }
        if self.zip { self.zipped() } else { self.product() }
    }

    fn product(&self) -> Result<Vec<Point>, String> {
        let mut points = vec![Point::default()];
        for (name, values) in &self.set {
            let axis: Vec<Point> = values
                .iter()
                .map(|value| Ok(Point::of(assignment(name, value)?)))
                .collect::<Result<_, String>>()?;
            points = combined(&points, &axis)?;
        }
        Ok(points)
    }

    fn zipped(&self) -> Result<Vec<Point>, String> {
        let lengths: BTreeSet<usize> = self.set.values().map(Vec::len).collect();
        if lengths.len() > 1 {
            let told: Vec<String> = self
                .set
                .iter()
                .map(|(name, values)| format!("{name}: {}", values.len()))
                .collect();
            return Err(format!(
                "zip takes lists of one length, and these are not: {}",
                told.join(", ")
            ));
        }
        let count = lengths.first().copied().unwrap_or(0);
        let point = |index: usize| {
            let mut settings = self.set.iter().map(|(name, values)| assignment(name, &values[index]));
            settings.try_fold(Point::default(), |point, setting| Ok(point.with(Point::of(setting?))))
        };
        (0..count).map(point).collect()
    }

    /// One point in each of so many equal shares of every setting.
    fn hypercube(&self, seed: i32, place: usize) -> Result<Vec<Point>, String> {
        let count = match self.lhs {
            Some(count) if (1..=MOST_CASES as u32).contains(&count) => count,
            Some(count) => return Err(format!("lhs = {count}: give 1 to {MOST_CASES}")),
            None => return Err("range needs lhs, the number of points".to_owned()),
        };
        if self.range.is_empty() {
            return Err(
                "lhs needs range, as in range = { \"fmu-truth.vent.scale\" = \"loguniform:1:100\" }".to_owned(),
            );
        }
        let mut generator = stream(seed.unsigned_abs().into(), place as u64, Source::Grid);
        let mut points = vec![Point::default(); count as usize];
        for (name, distribution) in &self.range {
            let mut shares: Vec<u32> = (0..count).collect();
            shares.shuffle(&mut generator);
            for (point, share) in points.iter_mut().zip(shares) {
                let u = (f64::from(share) + generator.random::<f64>()) / f64::from(count);
                let setting = assignment(name, &Setting::Number(rounded(distribution.quantile(u))))?;
                *point = std::mem::take(point).with(Point::of(setting));
            }
        }
        Ok(points)
    }
}

/// Settings of each case of several grids.
///
/// # Errors
/// Which grid is wrong, how, and what is allowed.
pub(crate) fn points(grids: &[Grid], seed: i32) -> Result<Vec<Point>, String> {
    let mut all = vec![Point::default()];
    for (place, grid) in grids.iter().enumerate() {
        let wrong = |problem: String| format!("number {}: {problem}", place + 1);
        let own = grid.points(seed, place).map_err(wrong)?;
        all = combined(&all, &own).map_err(wrong)?;
    }
    Ok(all)
}

/// Each of these with each of those.
fn combined(these: &[Point], those: &[Point]) -> Result<Vec<Point>, String> {
    let count = these.len().saturating_mul(those.len());
    if count > MOST_CASES {
        return Err(format!("makes {count} cases; at most {MOST_CASES} are run at once"));
    }
    let pair = |a: &Point| those.iter().map(|b| a.clone().with(b.clone())).collect::<Vec<_>>();
    Ok(these.iter().flat_map(pair).collect())
}

fn listed(case: &BTreeMap<String, Setting>) -> Result<Point, String> {
    let settings = case.iter().filter(|(name, _)| *name != CASE);
    let mut point = Point::default();
    for (name, value) in settings {
        point = point.with(Point::of(assignment(name, value)?));
    }
    if let Some(name) = case.get(CASE) {
        point.name = vec![name.to_string()];
        point.named = true;
    }
    Ok(point)
}

fn assignment(name: &str, value: &Setting) -> Result<Assignment, String> {
    format!("{name}={value}").parse()
}

/// Six digits: as many as a point needs, and as stand in the name of its case.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grids(text: &str) -> Vec<Grid> {
        #[derive(Deserialize)]
        struct Holder {
            grid: Vec<Grid>,
        }
        toml::from_str::<Holder>(text).unwrap().grid
    }

    fn told(text: &str) -> Vec<String> {
        let points = points(&grids(text), 3).unwrap();
        let one = |point: &Point| {
            let settings: Vec<String> = point.settings.iter().map(Assignment::to_string).collect();
            settings.join(" ")
        };
        points.iter().map(one).collect()
    }

    #[test]
    fn products_zips_lists_and_their_combination() {
        let product = "[[grid]]\nset = { \"m.a\" = [1, 2.5], \"m.b\" = [true, \"x\"] }\n";
        assert_eq!(
            told(product),
            ["m.a=1 m.b=true", "m.a=1 m.b=x", "m.a=2.5 m.b=true", "m.a=2.5 m.b=x"]
        );
        let zip = "[[grid]]\nzip = true\nset = { \"m.a\" = [1, 2], \"m.b\" = [3, 4] }\n";
        assert_eq!(told(zip), ["m.a=1 m.b=3", "m.a=2 m.b=4"]);
        let cases = "[[grid]]\ncases = [{ \"m.a\" = 1 }, { \"m.c\" = 7, \"m.b\" = 2 }]\n";
        assert_eq!(told(cases), ["m.a=1", "m.b=2 m.c=7"]);
        let named = "[[grid]]\ncases = [{ case = \"plain\" }, { case = \"odd\", \"m.a\" = 1 }]\n";
        let named = points(&grids(named), 3).unwrap();
        assert_eq!(
            named
                .iter()
                .map(|p| (p.name.concat(), p.settings.len()))
                .collect::<Vec<_>>(),
            [("plain".to_owned(), 0), ("odd".to_owned(), 1)]
        );
        let both = format!("{zip}[[grid]]\nset = {{ \"n.k\" = [0, 1] }}\n");
        assert_eq!(
            told(&both),
            [
                "m.a=1 m.b=3 n.k=0",
                "m.a=1 m.b=3 n.k=1",
                "m.a=2 m.b=4 n.k=0",
                "m.a=2 m.b=4 n.k=1"
            ]
        );
    }

    #[test]
    fn an_axis_is_read_from_a_command_line() {
        let grid = Grid::axis("fmu-truth.vent.scale=1,2.5,10").unwrap();
        let told: Vec<String> = points(&[grid], 1)
            .unwrap()
            .iter()
            .map(|p| p.settings[0].to_string())
            .collect();
        let expected = ["1", "2.5", "10"].map(|value| format!("fmu-truth.vent.scale={value}"));
        assert_eq!(told, expected);
        for bad in ["fmu-truth.vent.scale", "vent=1,2", "m.a=1,,2", "m.a="] {
            assert!(Grid::axis(bad).unwrap_err().contains("VALUE,VALUE"), "{bad}");
        }
    }

    /// Each tenth of each range holds one point: counted, whatever the draws.
    #[test]
    fn a_latin_hypercube_has_one_point_in_each_share() {
        let text = "[[grid]]\nlhs = 10\nrange = { \"m.a\" = \"uniform:0:10\", \"m.b\" = \"loguniform:1:1024\" }\n";
        let grid = grids(text);
        let found = points(&grid, 3).unwrap();
        let share = |index: usize, of: fn(f64) -> f64| {
            let mut shares: Vec<u64> = found
                .iter()
                .map(|point| of(point.settings[index].value.parse().unwrap()).floor() as u64)
                .collect();
            let order = shares.clone();
            shares.sort_unstable();
            (shares, order)
        };
        let (first, second) = (share(0, |a| a), share(1, f64::log2));
        assert_eq!(first.0, (0..10).collect::<Vec<_>>());
        assert_eq!(second.0, (0..10).collect::<Vec<_>>());
        assert_ne!(first.1, second.1, "the settings go together");
        assert_eq!(points(&grid, 3).unwrap(), found);
        assert_ne!(points(&grid, 4).unwrap(), found);
    }

    #[test]
    fn what_is_wrong_is_told() {
        for (text, says) in [
            ("[[grid]]\n", "one of: set"),
            ("[[grid]]\nset = { \"m.a\" = [1] }\nlhs = 3\n", "one of: set"),
            ("[[grid]]\nzip = true\ncases = [{ \"m.a\" = 1 }]\n", "zip goes with set"),
            ("[[grid]]\nset = { \"m.a\" = [] }\n", "no value"),
            ("[[grid]]\nset = { \"a\" = [1] }\n", "MODEL.VARIABLE"),
            (
                "[[grid]]\nzip = true\nset = { \"m.a\" = [1], \"m.b\" = [1, 2] }\n",
                "m.a: 1, m.b: 2",
            ),
            (
                "[[grid]]\nlhs = 0\nrange = { \"m.a\" = \"uniform:0:1\" }\n",
                "1 to 1000",
            ),
            ("[[grid]]\nlhs = 3\n", "needs range"),
            ("[[grid]]\nrange = { \"m.a\" = \"uniform:0:1\" }\n", "needs lhs"),
        ] {
            let error = points(&grids(text), 1).unwrap_err();
            assert!(error.contains(says) && error.starts_with("number 1"), "{text}: {error}");
        }
        let many: Vec<String> = (0..40).map(|n| n.to_string()).collect();
        let many = many.join(", ");
        let text = format!("[[grid]]\nset = {{ \"m.a\" = [{many}], \"m.b\" = [{many}] }}\n");
        assert!(points(&grids(&text), 1).unwrap_err().contains("1600 cases"));
    }
}
