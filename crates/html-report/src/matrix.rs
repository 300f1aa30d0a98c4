//! Errors of every filter in every phase, or in every case of a grid.

use serde::Serialize;

use crate::folder::Row;

/// Errors by filter and by phase or case.
#[derive(Debug, Serialize)]
pub(crate) struct Matrix {
    pub filters: Vec<String>,
    pub columns: Vec<String>,
    /// By filter, then by column; position, m.
    pub values: Vec<Vec<Option<f64>>>,
}

impl Matrix {
    /// * `rows`: of a table with `filter` and `pos_rmse_m`.
    /// * `by`: column of the table that names the columns of the matrix.
    /// * returns: `None` with fewer than two columns, which show no more than the summary.
    pub fn new(rows: &[&Row], by: &str) -> Option<Self> {
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
        let of = |filter| columns.iter().map(|column| value(filter, column)).collect();
        let values = filters.iter().map(of).collect();
        (columns.len() > 1).then_some(Self {
            filters,
            columns,
            values,
        })
    }
}
