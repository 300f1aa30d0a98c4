//! The comparison as a table in a terminal, and as Markdown.

use study::Ratio;

use super::row::{Kind, Row};
use crate::format::{Align, markdown_table, number, plain_table};

/// How to read the table.
pub const LEGEND: &str = "\
ratio: RMSE over that of the best constant, below 1 is better; in brackets its
95 % interval. NEES6: of position and velocity, 1 on average when consistent";

const HEADERS: [&str; 5] = ["level", "filter", "position\nratio", "velocity\nratio", "NEES6"];

fn ratio(ratio: Option<Ratio>) -> String {
    let Some(Ratio { value, interval }) = ratio else {
        return number(None);
    };
    // Three digits, however far off.
    let short = |v: f64| {
        let digits = (2.0 - v.abs().log10().floor()).clamp(0.0, 3.0) as usize;
        format!("{v:.digits$}")
    };
    interval.map_or_else(
        || short(value),
        |[low, high]| format!("{} ({}, {})", short(value), short(low), short(high)),
    )
}

fn cells(row: &Row) -> Vec<String> {
    let bad = row.tally.bad_runs;
    let label = if bad > 0 {
        format!("{} ({bad} bad)", row.filter)
    } else {
        row.filter.clone()
    };
    vec![
        row.level.clone(),
        label,
        ratio(row.ratios[0]),
        ratio(row.ratios[1]),
        number(row.tally.nees6()),
    ]
}

/// Laws, level by level; it fits 80 columns unless labels of foreign filters are long.
pub fn table(rows: &[&Row]) -> String {
    let laws = rows.iter().filter(|row| row.kind == Kind::Law);
    plain_table(HEADERS, 2, laws.map(|row| cells(row)))
}

/// The same of every mission, with the constants that they are held against.
pub fn markdown(rows: &[Row], missions: &[String]) -> String {
    let mut text = "# Laws against the best constant in hindsight\n".to_owned();
    for mission in missions {
        let own: Vec<&Row> = rows.iter().filter(|row| row.mission == *mission).collect();
        if own.is_empty() {
            continue;
        }
        let laws = own.iter().filter(|row| row.kind == Kind::Law).map(|row| {
            let mut cells = cells(row);
            cells.extend(row.best.iter().map(|best| best.clone().unwrap_or_else(|| number(None))));
            cells
        });
        let headers = [
            "level",
            "filter",
            "position ratio",
            "velocity ratio",
            "NEES6",
            "best by position",
            "best by velocity",
        ];
        let aligned = headers.map(|header| {
            let align = if header.contains("ratio") || header == "NEES6" {
                Align::Right
            } else {
                Align::Left
            };
            (header, align)
        });
        text.push_str(&format!("\n## {mission}\n\n{}", markdown_table(&aligned, laws)));
    }
    text
}
