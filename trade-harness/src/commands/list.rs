//! `list`: what can be studied, set, read and tuned; from tables that are part of the program, without building anything.

use std::path::Path;

use clap::ValueEnum;
use comfy_table::{ContentArrangement, Table, presets};
use fmi2_import::{Causality, EnumerationItem, ModelDescription, Variable, suggest};
use interface::annotation::{Filters, Search};
use interface::ports::{PORTS, Shape};
use serde_json::{Value, json};
use study::{DISTRIBUTIONS, FilterChoice, NAV, PAPER, TRUTH, filters_of, worlds};

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::claims::{self, Claim};
use crate::cli::{ListArgs, Listed, Topic};
use crate::format::{TERMINAL, lines, wrapped};
use crate::report::columns;

/// What the FMUs of this project say of themselves. Their own test holds the files to what they render.
const TRUTH_XML: &str = include_str!("../../../modelDescription/fmu-truth/modelDescription.xml");
const NAV_XML: &str = include_str!("../../../modelDescription/fmu-nav/modelDescription.xml");

pub(super) fn list(args: &ListArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let nav = ModelDescription::parse(NAV_XML.as_bytes(), Path::new(NAV))?;
    match &args.what {
        None => overview(&nav, out)?,
        Some(Topic::Named(name)) => named(&nav, name, out)?,
        Some(Topic::Kind(kind)) => all_of(*kind, args, &nav, out)?,
    }
    Ok(Verdict::Done)
}

/// Everything of a kind, or the one of them that is named.
fn all_of(kind: Listed, args: &ListArgs, nav: &ModelDescription, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let name = args.name.as_deref();
    match kind {
        Listed::Missions => missions(name, out),
        Listed::Filters => filters(nav, name, out),
        Listed::Presets => sets(nav, name, out),
        Listed::Parameters => {
            let truth = ModelDescription::parse(TRUTH_XML.as_bytes(), Path::new(TRUTH))?;
            parameters_of(&truth, nav, name, args.of.as_deref(), out)
        }
        Listed::Ports => ports(out),
        Listed::Distributions => distributions(out),
        Listed::Metrics => metrics(name, out),
    }
}

/// A mission or a filter, whichever has this name.
fn named(nav: &ModelDescription, name: &str, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let worlds = worlds::all()?;
    if worlds.iter().any(|world| world.name == name) {
        return missions(Some(name), out);
    }
    let items = nav.items("filter");
    if items.iter().any(|item| item.name == name) {
        return filters(nav, Some(name), out);
    }
    let kinds: Vec<_> = Listed::value_variants()
        .iter()
        .filter_map(Listed::to_possible_value)
        .collect();
    let kinds = kinds.iter().map(|kind| kind.get_name());
    let items = items.iter().map(|item| item.name.as_str());
    let all = kinds.chain(worlds.iter().map(|world| world.name.as_str())).chain(items);
    known("list, mission or filter", name, all).map(drop)
}

/// The one of these names that is meant.
pub(super) fn known<'a>(
    kind: &'static str,
    name: &str,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Result<&'a str, HarnessError> {
    names
        .clone()
        .find(|own| *own == name)
        .ok_or_else(|| HarnessError::NoSuchThing {
            kind,
            name: name.to_owned(),
            meant: suggest(name, names.clone()),
            known: names.collect::<Vec<_>>().join(", "),
        })
}

fn overview(nav: &ModelDescription, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let missions = worlds::all()?;
    out.say("Missions")?;
    out.say(&pairs(missions.iter().map(|m| [m.name.clone(), m.about.clone()])))?;
    out.say("\nFilters")?;
    let items = nav.items("filter");
    let about = |item: &EnumerationItem| item.description.clone().unwrap_or_default();
    out.say(&pairs(items.iter().map(|item| [item.name.clone(), about(item)])))?;
    out.say("\nMore of each: list WHAT [NAME], as in 'list filters milton'")?;
    out.say(&pairs(
        [
            ["missions", "length, filters, and what a source claims of them"],
            ["filters", "presets, parameters and search ranges"],
            ["presets", "every parameter set"],
            [
                "parameters",
                "what --set and --vary change, as in 'list parameters fmu-nav milton'",
            ],
            ["ports", "variables that connect truth and filters"],
            ["distributions", "what --vary draws from"],
            ["metrics", "columns of the CSV files, what requirements are about"],
        ]
        .map(|row| row.map(str::to_owned))
        .into_iter(),
    ))?;
    out.tell("missions", missions.iter().map(|m| &m.name).collect::<Vec<_>>())?;
    out.tell("filters", items.iter().map(|item| &item.name).collect::<Vec<_>>())
}

fn missions(name: Option<&str>, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let all = worlds::all()?;
    if let Some(name) = name {
        known("mission", name, all.iter().map(|m| m.name.as_str()))?;
    }
    let mut told = Vec::new();
    for s in all.iter().filter(|m| name.is_none_or(|name| m.name == name)) {
        let filters: Vec<String> = s.filters.iter().map(FilterChoice::to_string).collect();
        let (length, from) = (s.duration_s, s.scored_from_s);
        out.say(&wrapped(&format!("{}: {}", s.name, s.about)))?;
        out.say(&wrapped(&format!(
            "  {length} s, scored from {from} s; {}",
            s.reference
        )))?;
        out.say(&wrapped(&format!("  filters: {}", filters.join(", "))))?;
        let same = |a: &Claim, b: &Claim| (a.filter, a.text, a.bound) == (b.filter, b.text, b.bound);
        for together in claims::of(&s.name).chunk_by(same) {
            let columns: Vec<&str> = together.iter().map(|c| c.column).collect();
            if let Some(claim) = together.first() {
                let (columns, range) = (columns.join(", "), claim.bound.words(|end| end.to_string()));
                let claim = format!("  claim: {} {columns} {range}: {}", claim.filter, claim.text);
                out.say(&wrapped(&claim))?;
            }
        }
        out.say("")?;
        told.push(json!({
            "name": s.name, "about": s.about, "duration_s": s.duration_s, "scored_from_s": s.scored_from_s,
            "reference": s.reference, "filters": filters,
        }));
    }
    out.tell("missions", told)
}

fn filters(nav: &ModelDescription, name: Option<&str>, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let items = nav.items("filter");
    let told = filters_of(nav)?;
    if let Some(name) = name {
        known("filter", name, items.iter().map(|item| item.name.as_str()))?;
    }
    let mut said = Vec::new();
    for item in items.iter().filter(|item| name.is_none_or(|name| item.name == name)) {
        out.say(&describe_filter(nav, &told, item))?;
        let presets = told.presets_of(&item.name).map(|p| p.name.as_str());
        let own = parameters(nav).filter(|v| prefix(&v.name) == item.name);
        said.push(json!({
            "name": item.name, "about": item.description, "bound": told.is_bound(&item.name), "presets": presets.collect::<Vec<_>>(),
            "parameters": own.map(variable_json).collect::<Vec<_>>(),
        }));
    }
    out.tell("filters", said)
}

fn sets(nav: &ModelDescription, name: Option<&str>, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let told = filters_of(nav)?;
    if let Some(name) = name {
        known(
            "filter",
            name,
            nav.items("filter").iter().map(|item| item.name.as_str()),
        )?;
    }
    let mut said = Vec::new();
    for preset in told.presets.iter().filter(|p| name.is_none_or(|name| p.filter == name)) {
        let values: Vec<String> = preset
            .sets
            .iter()
            .map(|s| format!("{} = {}", s.variable, s.value))
            .collect();
        out.say(&wrapped(&format!(
            "{}@{}: {}",
            preset.filter, preset.name, preset.about
        )))?;
        out.say(&format!("  {}", values.join("\n  ")))?;
        let values = preset
            .sets
            .iter()
            .map(|s| (s.variable.clone(), Value::from(s.value.clone())));
        said.push(json!({
            "filter": preset.filter, "name": preset.name, "about": preset.about,
            "values": values.collect::<serde_json::Map<_, _>>(),
        }));
    }
    out.tell("presets", said)
}

/// Parameters of one FMU, or of both; those of one filter or part of the world alone, if one is named.
fn parameters_of(
    truth: &ModelDescription,
    nav: &ModelDescription,
    model: Option<&str>,
    of: Option<&str>,
    out: &mut Out<'_>,
) -> Result<(), HarnessError> {
    if let Some(model) = model {
        known("model", model, [TRUTH, NAV].into_iter())?;
    }
    for (name, title, description) in [(TRUTH, "the world", truth), (NAV, "the filters", nav)] {
        if model.is_some_and(|model| model != name) {
            continue;
        }
        if let Some(of) = of {
            let mut owners: Vec<&str> = parameters(description).map(|v| prefix(&v.name)).collect();
            owners.dedup();
            known("group of parameters", of, owners.iter().copied())?;
        }
        let own = || parameters(description).filter(|v| of.is_none_or(|of| prefix(&v.name) == of));
        out.say(&format!(
            "Parameters of {title} (--set {name}.NAME=VALUE)\n{}\n",
            variables(own())
        ))?;
        out.tell(name, own().map(variable_json).collect::<Vec<_>>())?;
    }
    Ok(())
}

fn ports(out: &mut Out<'_>) -> Result<(), HarnessError> {
    let mut table = plain(["name", "shape", "unit", "meaning"]);
    let mut told = Vec::new();
    for port in PORTS {
        let (shape, unit) = (shape(port.shape), port.unit(0));
        table.add_row([
            format!("  {}", port.name),
            shape.clone(),
            unit.to_owned(),
            port.about(0).to_owned(),
        ]);
        told.push(json!({"name": port.name, "shape": shape, "unit": unit, "about": port.about(0)}));
    }
    out.say(&lines(&table))?;
    out.tell("ports", told)
}

fn shape(shape: Shape) -> String {
    match shape {
        Shape::Scalar => "1".to_owned(),
        Shape::Vector(n) => n.to_string(),
        Shape::Matrix(rows, columns) => format!("{rows}x{columns}"),
    }
}

fn distributions(out: &mut Out<'_>) -> Result<(), HarnessError> {
    out.say(&pairs(DISTRIBUTIONS.iter().map(|row| row.map(str::to_owned))))?;
    let told = DISTRIBUTIONS
        .iter()
        .map(|[form, about]| json!({"form": form, "about": about}));
    out.tell("distributions", told.collect::<Vec<_>>())
}

fn metrics(file: Option<&str>, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let all = columns::all();
    if let Some(file) = file {
        known("file", file, all.iter().map(|f| f.file))?;
    }
    for own in all.iter().filter(|f| file.is_none_or(|file| f.file == file)) {
        let mut table = plain(["column", "unit", "meaning"]);
        table.add_rows(own.columns.iter().map(|[name, unit, meaning]| {
            let name = format!("  {name}");
            [name, (*unit).to_owned(), (*meaning).to_owned()]
        }));
        let head = wrapped(&format!("{}: one row for {}", own.file, own.about));
        out.say(&format!("{head}\n{}\n", lines(&table)))?;
        let told = own
            .columns
            .iter()
            .map(|[name, unit, meaning]| json!({"name": name, "unit": unit, "meaning": meaning}));
        out.tell(own.file, told.collect::<Vec<_>>())?;
    }
    Ok(())
}

fn describe_filter(nav: &ModelDescription, told: &Filters, item: &EnumerationItem) -> String {
    let (filter, about) = (item.name.as_str(), item.description.as_deref());
    let mut text = String::new();
    let mut say = |line: &str| {
        text.push_str(&wrapped(line));
        text.push('\n');
    };
    say(&format!(
        "Filter {filter}{}",
        about.map(|a| format!(": {a}")).unwrap_or_default()
    ));
    for only in told.meanings.iter().filter(|m| m.filter == filter) {
        say(&format!("  only in {}: {}", only.scenarios.join(", "), only.why));
    }
    if !told.presets_of(filter).any(|p| p.name == PAPER) {
        say(&format!("  {filter} = {filter}@{PAPER}: start values as below"));
    }
    for preset in told.presets_of(filter) {
        say(&format!("  {filter}@{}: {}", preset.name, preset.about));
        for set in &preset.sets {
            say(&format!("    {} = {}", set.variable, set.value));
        }
    }
    for search in told.searches.iter().filter(|s| prefix(&s.variable) == filter) {
        say(&format!(
            "  tune: {} from {:?} to {:?}{}",
            search.variable,
            search.low,
            search.high,
            only_with(search)
        ));
    }
    let own: Vec<&Variable> = parameters(nav).filter(|v| prefix(&v.name) == filter).collect();
    if !own.is_empty() {
        text.push_str(&variables(own.into_iter()));
        text.push('\n');
    }
    text
}

fn parameters(description: &ModelDescription) -> impl Iterator<Item = &Variable> {
    description
        .variables
        .iter()
        .filter(|v| v.causality == Causality::Parameter)
}

/// Under which setting alone a search has an effect, to be put behind its range.
pub(super) fn only_with(search: &Search) -> String {
    let told = search.only_with.as_ref();
    told.map(|set| format!(" with {} = {}", set.variable, set.value))
        .unwrap_or_default()
}

fn prefix(name: &str) -> &str {
    name.split('.').next().unwrap_or(name)
}

/// A table of names, start values, units and meanings.
pub(super) fn variables<'a>(list: impl Iterator<Item = &'a Variable>) -> String {
    let mut table = plain(["name", "start", "unit", "meaning"]);
    for v in list {
        let mut meaning = v.description.clone().unwrap_or_default();
        if let Some(items) = v.enumeration_items() {
            let names: Vec<&str> = items.iter().map(|i| i.name.as_str()).collect();
            meaning.push_str(&format!(" [{}]", names.join(", ")));
        }
        table.add_row([
            format!("  {}", v.name),
            start(v),
            v.unit().unwrap_or_default().to_owned(),
            meaning,
        ]);
    }
    lines(&table)
}

fn start(v: &Variable) -> String {
    v.start().map(|s| v.format_value(&s)).unwrap_or_default()
}

/// A variable for programs.
pub(super) fn variable_json(v: &Variable) -> Value {
    json!({"name": v.name, "start": start(v), "unit": v.unit(), "about": v.description})
}

/// Names and what they are, in two columns that fit the terminal.
fn pairs(rows: impl Iterator<Item = [String; 2]>) -> String {
    let mut table = plain::<0>([]);
    table.add_rows(rows.map(|[name, about]| [format!("  {name}"), about]));
    lines(&table)
}

/// A table without rules that fits the terminal.
fn plain<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_content_arrangement(ContentArrangement::Dynamic);
    if !table.is_tty() {
        table.set_width(u16::try_from(TERMINAL).unwrap_or(u16::MAX));
    }
    if N > 0 {
        let mut header: Vec<String> = header.map(str::to_owned).to_vec();
        header[0] = format!("  {}", header[0]);
        table.set_header(header);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(line: &[&str]) -> Result<String, String> {
        use clap::Parser as _;
        let all = ["trade-harness", "list"].iter().chain(line);
        let cli = crate::cli::Cli::try_parse_from(all).map_err(|error| error.to_string())?;
        let crate::cli::Command::List(args) = cli.command else {
            return Err("another command".to_owned());
        };
        let mut text = Vec::new();
        let mut out = Out::new(&mut text, cli.json);
        list(&args, &mut out).map_err(|error| error.to_string())?;
        out.end().map_err(|error| error.to_string())?;
        String::from_utf8(text).map_err(|error| error.to_string())
    }

    #[test]
    fn everything_is_listed_as_text_and_as_json() {
        for (line, says) in [
            (&[][..], "nrho_venting"),
            (&["missions", "formation"], "observer"),
            (&["filters", "milton"], "milton.m_b"),
            (&["presets"], "milton@consistent"),
            (&["parameters"], "lidar.sigma_range"),
            (&["parameters", "fmu-nav", "snc"], "snc.q"),
            (&["ports"], "est.r_tc_n"),
            (&["distributions"], "lognormal:MEDIAN:FACTOR"),
            (&["metrics", "summary.csv"], "pos_rmse_m"),
        ] {
            let text = said(line).unwrap();
            assert!(text.contains(says), "{line:?}: {text}");
            let json = said(&[line, &["--json"]].concat()).unwrap();
            let value: Value = serde_json::from_str(&json).unwrap();
            assert!(value.as_object().is_some_and(|o| !o.is_empty()), "{line:?}");
        }
        assert!(!said(&["filters", "snc"]).unwrap().contains("milton.m_b"));
    }

    #[test]
    fn what_is_not_there_is_told_with_the_nearest_name() {
        let error = said(&["filters", "miltno"]).unwrap_err();
        assert!(
            error.contains("miltno") && error.contains("did you mean 'milton'"),
            "{error}"
        );
        assert!(said(&["missions", "mars"]).unwrap_err().contains("leo_venting"));
        assert!(said(&["widgets"]).unwrap_err().contains("distributions"));
    }
}
