//! Errors of every filter in every phase, or in every case of a grid.

use serde::Serialize;

use crate::folder::Row;

/// Width that phases or cases may take up beside each other, else they stand below each other; that of a letter, and that of a
/// value at least.
const WIDTH: usize = 900;
const LETTER: usize = 7;
const VALUE: usize = 62;

/// Errors by filter and by phase or case.
#[derive(Debug, Serialize)]
pub(crate) struct Matrix {
    /// What the rows are.
    pub of: String,
    pub rows: Vec<String>,
    pub columns: Vec<String>,
    /// By row, then by column; position, m.
    pub values: Vec<Vec<Option<f64>>>,
    /// Decades above the best filter of the same phase or case, from 0 to 1, as dark as it gets.
    pub shades: Vec<Vec<f64>>,
    /// Whether it is the best filter of the phase or case.
    pub best: Vec<Vec<bool>>,
}

impl Matrix {
    /// * `rows`: of a table with `filter` and `pos_rmse_m`.
    /// * `by`: column of the table whose values the filters are compared in.
    /// * `bounds`: filters that are none, and the best of nothing.
    /// * returns: `None` with fewer than two of these, which show no more than the summary.
    pub fn new(rows: &[&Row], by: &str, bounds: &[&str]) -> Option<Self> {
        let distinct = |column: &str| {
            let mut names: Vec<String> = Vec::new();
            for row in rows {
                let name = row.text(column);
                if !names.iter().any(|n| n == name) {
                    names.push(name.to_owned());
                }
            }
            names
        };
        let (filters, columns) = (distinct("filter"), distinct(by));
        let value = |filter: &String, column: &String| {
            let row = rows
                .iter()
                .find(|r| r.text("filter") == filter && r.text(by) == column)?;
            row.number("pos_rmse_m")
        };
        let takes_part = |filter: &String| !bounds.contains(&filter.as_str());
        let contest = || filters.iter().filter(|filter| takes_part(filter));
        let least = |column: &String| {
            let values = contest().filter_map(|f| value(f, column));
            values.min_by(f64::total_cmp)
        };
        let least: Vec<Option<f64>> = columns.iter().map(least).collect();
        let longest = |names: &[String]| LETTER * names.iter().map(|n| n.chars().count()).max().unwrap_or(0);
        let wide = longest(&filters) + columns.len() * longest(&columns).max(VALUE) > WIDTH;
        let ratio = |filter: &String, c: usize| Some(value(filter, &columns[c])? / least[c]?);
        let shade = |f: &String, c: usize| {
            // That of zero over zero is no number.
            let decades = ratio(f, c).map(f64::log10).filter(|d| !d.is_nan());
            decades.map_or(0.0, |d| d.clamp(0.0, 1.0))
        };
        let best = |f: &String, c: usize| {
            takes_part(f) && value(f, &columns[c]).is_some() && value(f, &columns[c]) == least[c]
        };
        let count = columns.len();
        Some(Self {
            of: if wide { by } else { "filter" }.to_owned(),
            values: arranged(&filters, count, wide, |f, c| value(f, &columns[c])),
            shades: arranged(&filters, count, wide, shade),
            best: arranged(&filters, count, wide, best),
            rows: if wide { columns.clone() } else { filters.clone() },
            columns: if wide { filters } else { columns },
        })
        .filter(|_| count > 1)
    }
}

/// A value of each filter and column, by filter, or else by column.
fn arranged<T>(filters: &[String], columns: usize, turned: bool, value: impl Fn(&String, usize) -> T) -> Vec<Vec<T>> {
    let value = &value;
    if turned {
        let row = |c| filters.iter().map(|f| value(f, c)).collect();
        (0..columns).map(row).collect()
    } else {
        filters
            .iter()
            .map(|f| (0..columns).map(|c| value(f, c)).collect())
            .collect()
    }
}
