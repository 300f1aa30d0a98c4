//! What `tune` tried, from `search.csv`.

use serde::Serialize;

use crate::folder::Row;

/// The search of one filter.
#[derive(Debug, Serialize)]
pub(crate) struct Search {
    pub filter: String,
    /// What was made small, and its unit.
    pub objective: [String; 2],
    pub parameters: Vec<Parameter>,
    pub tries: Vec<Try>,
}

#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Parameter {
    pub name: String,
    /// Edges of the search.
    pub low: f64,
    pub high: f64,
}

/// A candidate.
#[derive(Debug, Serialize)]
pub(crate) struct Try {
    /// By parameter; empty for the filter as it was given.
    pub values: Vec<f64>,
    pub error: Option<f64>,
    pub feasible: bool,
}

/// The searches in a world, in the order of the file.
pub(crate) fn searches(rows: &[&Row]) -> Vec<Search> {
    let same = |a: &&Row, b: &&Row| a.text("filter") == b.text("filter");
    rows.chunk_by(same).filter_map(search).collect()
}

fn search(rows: &[&Row]) -> Option<Search> {
    let first = rows.first()?;
    let parameters: Vec<Parameter> = named(first.text("ranges"))
        .filter_map(|(name, range)| {
            let (low, high) = range.split_once(':')?;
            Some(Parameter {
                name: name.to_owned(),
                low: low.parse().ok()?,
                high: high.parse().ok()?,
            })
        })
        .collect();
    let tries = rows.iter().map(|row| Try {
        values: named(row.text("values"))
            .filter_map(|(_, value)| value.parse().ok())
            .collect(),
        error: row.number("value"),
        feasible: row.count("feasible") > 0,
    });
    let unit = match first.text("objective") {
        "velocity" => "m/s",
        "acceleration" => "m/s²",
        _ => "m",
    };
    Some(Search {
        filter: first.text("filter").to_owned(),
        objective: [first.text("objective").to_owned(), unit.to_owned()],
        tries: tries.collect(),
        parameters,
    })
    .filter(|s| !s.parameters.is_empty())
}

/// The parts of `NAME=TEXT NAME=TEXT`.
fn named(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split(' ').filter_map(|part| part.split_once('='))
}
