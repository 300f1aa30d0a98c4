//! The comparison as a table in a terminal, and as Markdown.

use study::Ratio;

use super::row::{Kind, Row, family};
use crate::format::{Align, markdown_table, number, plain_table};

/// How to read the table.
pub const LEGEND: &str = "\
ratio: RMSE over that of the best constant, below 1 is better; in brackets its
95 % interval. NEES6: of position and velocity, 1 on average when consistent
* bound, told by the truth what no law knows: the best of its family by each
error, NEES6 that of the best by position";

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

/// A law, or the best of a bound's family by each error, at a level.
struct Line<'a> {
    level: &'a str,
    label: String,
    bound: bool,
    ratios: [Option<Ratio>; 2],
    nees6: Option<f64>,
    best: &'a [Option<String>; 2],
}

/// Laws, then bounds, level by level.
fn lines<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Vec<Line<'a>> {
    let mut lines: Vec<Line<'a>> = Vec::new();
    for row in rows {
        let bound = match row.kind {
            Kind::Fixed => continue,
            Kind::Law => false,
            Kind::Bound => true,
        };
        let mut label = if bound {
            format!("{} *", family(&row.filter))
        } else {
            row.filter.clone()
        };
        let bad = row.tally.bad_runs;
        if bad > 0 && !bound {
            label.push_str(&format!(" ({bad} bad)"));
        }
        // NEES of the best by position, where it has a ratio.
        let nees6 = row.tally.nees6().filter(|_| !bound || row.ratios[0].is_some());
        let same = |line: &&mut Line<'a>| bound && line.level == row.level && line.label == label;
        if let Some(line) = lines.iter_mut().find(same) {
            line.ratios = [0, 1].map(|at| line.ratios[at].or(row.ratios[at]));
            line.nees6 = line.nees6.or(nees6);
            continue;
        }
        lines.push(Line {
            level: &row.level,
            label,
            bound,
            ratios: row.ratios,
            nees6,
            best: &row.best,
        });
    }
    let levels: Vec<&str> = lines.iter().map(|line| line.level).collect();
    lines.sort_by_key(|line| (levels.iter().position(|level| *level == line.level), line.bound));
    lines
}

fn cells(line: &Line<'_>) -> Vec<String> {
    vec![
        line.level.to_owned(),
        line.label.clone(),
        ratio(line.ratios[0]),
        ratio(line.ratios[1]),
        number(line.nees6),
    ]
}

/// Laws and bounds, level by level; it fits 80 columns unless labels of foreign filters are long.
pub fn table(rows: &[&Row]) -> String {
    let lines = lines(rows.iter().copied());
    plain_table(HEADERS, 2, lines.iter().map(cells))
}

/// The same of every mission, with the constants that they are held against.
pub fn markdown(rows: &[Row], missions: &[String]) -> String {
    let mut text = "# Laws against the best constant in hindsight\n\n\
        `*`: a bound, told by the truth what no law knows, the best of its family by each error.\n"
        .to_owned();
    for mission in missions {
        let own = lines(rows.iter().filter(|row| row.mission == *mission));
        if own.is_empty() {
            continue;
        }
        let cells = own.iter().map(|line| {
            let mut cells = cells(line);
            cells.extend(
                line.best
                    .iter()
                    .map(|best| best.clone().unwrap_or_else(|| number(None))),
            );
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
        text.push_str(&format!("\n## {mission}\n\n{}", markdown_table(&aligned, cells)));
    }
    text
}
