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
    /// Index of the feasible candidate of the least error.
    pub best: Option<usize>,
    /// Index of the filter as it was given.
    pub given: Option<usize>,
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
    let tries: Vec<Try> = rows
        .iter()
        .map(|row| Try {
            values: named(row.text("values"))
                .filter_map(|(_, value)| value.parse().ok())
                .collect(),
            error: row.number("value"),
            feasible: row.count("feasible") > 0,
        })
        .collect();
    let positive = |index: &usize| tries[*index].error.filter(|e| *e > 0.0);
    let with_error = || (0..tries.len()).filter(|index| positive(index).is_some());
    let feasible = with_error().filter(|index| tries[*index].feasible);
    let unit = match first.text("objective") {
        "velocity" => "m/s",
        "acceleration" => "m/s²",
        _ => "m",
    };
    Some(Search {
        filter: first.text("filter").to_owned(),
        objective: [first.text("objective").to_owned(), unit.to_owned()],
        best: feasible.min_by(|a, b| {
            f64::total_cmp(
                &positive(a).unwrap_or(f64::INFINITY),
                &positive(b).unwrap_or(f64::INFINITY),
            )
        }),
        given: with_error().find(|index| tries[*index].values.is_empty()),
        tries,
        parameters,
    })
    .filter(|s| !s.parameters.is_empty())
}

/// The parts of `NAME=TEXT NAME=TEXT`.
fn named(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split(' ').filter_map(|part| part.split_once('='))
}
