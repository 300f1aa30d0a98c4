//! `list`: what can be studied and tuned.

use std::io::Write;

use comfy_table::{ContentArrangement, Table, presets};
use fmi2_import::{Causality, EnumerationItem, ModelDescription, Variable};
use interface::annotation::Filters;
use study::{FilterChoice, NAV, PAPER, TRUTH, filters_of, worlds};

use super::shared::{Verdict, own_fmus, say};
use crate::HarnessError;
use crate::claims::{self, Claim};
use crate::cli::ListArgs;
use crate::format::lines;

pub(super) fn list(args: &ListArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let paths = own_fmus(&args.build, &[TRUTH, NAV])?;
    let fmus = paths
        .iter()
        .map(fmi2_import::Fmu::open)
        .collect::<Result<Vec<_>, _>>()?;
    say(out, &scenarios()?)?;
    if let [truth, nav] = fmus.as_slice() {
        let filters = nav.description().items("filter");
        let told = filters_of(nav.description())?;
        for filter in filters {
            say(out, &describe_filter(nav.description(), &told, filter))?;
        }
        let of_a_filter = |v: &Variable| filters.iter().any(|f| prefix(&v.name) == f.name);
        let shared = parameters(nav.description()).filter(|v| !of_a_filter(v));
        say(
            out,
            &format!(
                "Parameters of every filter (--set {NAV}.NAME=VALUE)\n{}\n",
                variables(shared)
            ),
        )?;
        let world = parameters(truth.description());
        say(
            out,
            &format!(
                "Parameters of the world (--set {TRUTH}.NAME=VALUE)\n{}",
                variables(world)
            ),
        )?;
    }
    Ok(Verdict::Done)
}

fn scenarios() -> Result<String, HarnessError> {
    let mut text = "Scenarios\n".to_owned();
    for s in worlds::all()? {
        text.push_str(&format!("  {}: {}\n", s.name, s.about));
        text.push_str(&format!(
            "    {} s, scored from {} s; {}\n",
            s.duration_s, s.scored_from_s, s.reference
        ));
        let filters: Vec<String> = s.filters.iter().map(FilterChoice::to_string).collect();
        text.push_str(&format!("    filters: {}\n", filters.join(",")));
        let same = |a: &Claim, b: &Claim| (a.filter, a.text, a.bound) == (b.filter, b.text, b.bound);
        for together in claims::of(&s.name).chunk_by(same) {
            let columns: Vec<&str> = together.iter().map(|c| c.column).collect();
            if let Some(claim) = together.first() {
                let (columns, range) = (columns.join(", "), claim.bound.words(|end| end.to_string()));
                text.push_str(&format!("    {} {columns} {range}: {}\n", claim.filter, claim.text));
            }
        }
    }
    Ok(text)
}

fn describe_filter(nav: &ModelDescription, told: &Filters, item: &EnumerationItem) -> String {
    let (filter, about) = (item.name.as_str(), item.description.as_deref());
    let mut text = format!(
        "Filter {filter}{}\n",
        about.map(|a| format!(": {a}")).unwrap_or_default()
    );
    for only in told.meanings.iter().filter(|m| m.filter == filter) {
        text.push_str(&format!("  only in {}: {}\n", only.scenarios.join(", "), only.why));
    }
    if !told.presets_of(filter).any(|p| p.name == PAPER) {
        text.push_str(&format!("  {filter} = {filter}@{PAPER}: start values as below\n"));
    }
    for preset in told.presets_of(filter) {
        text.push_str(&format!("  {filter}@{}: {}\n", preset.name, preset.about));
        for set in &preset.sets {
            text.push_str(&format!("    {} = {}\n", set.variable, set.value));
        }
    }
    for search in told.searches.iter().filter(|s| prefix(&s.variable) == filter) {
        text.push_str(&format!(
            "  tune: {} from {:?} to {:?}\n",
            search.variable, search.low, search.high
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

fn prefix(name: &str) -> &str {
    name.split('.').next().unwrap_or(name)
}

/// A table of names, start values, units and meanings.
pub(super) fn variables<'a>(list: impl Iterator<Item = &'a Variable>) -> String {
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(["  name", "start", "unit", "meaning"]);
    for v in list {
        let start = v.start().map(|s| v.format_value(&s)).unwrap_or_default();
        let mut meaning = v.description.clone().unwrap_or_default();
        if let Some(items) = v.enumeration_items() {
            let names: Vec<&str> = items.iter().map(|i| i.name.as_str()).collect();
            meaning.push_str(&format!(" [{}]", names.join(", ")));
        }
        table.add_row([
            format!("  {}", v.name),
            start,
            v.unit().unwrap_or_default().to_owned(),
            meaning,
        ]);
    }
    lines(&table)
}
