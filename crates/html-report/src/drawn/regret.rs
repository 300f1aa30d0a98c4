//! Laws against the best constant, level by level, with bounds: `clairvoyant`, told all that pushes the target, which none can pass, and
//! `times_known`, told when and never how hard.

use std::path::Path;

use super::axis::Axis;
use super::sheet::{Dash, Dot, INK, Key, Line, Mark, Panel, SOFT, Sheet, colour, range};
use crate::ReportError;
use crate::folder::{Row, table};
use plotters::style::Color;

/// Name of the table that makes a folder one of `regret`.
pub(crate) const TABLE: &str = "regret.csv";

/// Its rows, with the columns that figure and page are made of.
pub(crate) fn rows(folder: &Path) -> Result<Vec<Row>, ReportError> {
    table(
        folder,
        TABLE,
        &["mission", "level", "filter", "family", "kind", "pos_ratio", "vel_ratio"],
    )
}

/// What rows are called, in the order in which they come.
pub(crate) fn names<'a>(rows: impl IntoIterator<Item = &'a &'a Row>, of: impl Fn(&'a Row) -> &'a str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for row in rows {
        if !names.iter().any(|name| name == of(row)) {
            names.push(of(row).to_owned());
        }
    }
    names
}

/// Ratios beyond these stand at the edge.
const EDGES: [f64; 2] = [0.25, 10.0];

/// A figure for each mission.
pub(super) fn sheets(folder: &Path) -> Result<Vec<(String, Sheet)>, ReportError> {
    let rows = rows(folder)?;
    let of_kind = |kind| rows.iter().filter(move |row| row.text("kind") == kind);
    let (laws, bounds): (Vec<&Row>, Vec<&Row>) = (of_kind("law").collect(), of_kind("bound").collect());
    let missions = names(laws.iter().chain(&bounds), |row| row.text("mission"));
    let sheet = |mission: String| {
        let [laws, bounds] = [&laws, &bounds].map(|all| {
            let own = all.iter().filter(|row| row.text("mission") == mission);
            own.copied().collect::<Vec<&Row>>()
        });
        (format!("{mission}_regret"), of_mission(&mission, &laws, &bounds))
    };
    Ok(missions.into_iter().map(sheet).collect())
}

/// Lines of the bounds, one for each family.
const DASHES: [Option<Dash>; 3] = [None, Some((5, 2)), Some((2, 2))];

/// * `rows`, `bounds`: laws, which are dots, and the bounds of each level, which are lines across it.
fn of_mission(mission: &str, rows: &[&Row], bounds: &[&Row]) -> Sheet {
    let levels = names(rows.iter().chain(bounds), |row| row.text("level"));
    let filters = names(rows, |row| row.text("filter"));
    let families = names(bounds, |row| row.text("family"));
    let level = |row: &Row| levels.iter().position(|name| name == row.text("level"));
    let dash = |index: usize| DASHES[index % DASHES.len()];
    let place = |v: f64| v.clamp(EDGES[0], EDGES[1]).log10();
    let panel = |title: &str, column: &str| {
        let ends = ["", "_low", "_high"].map(|end| format!("{column}{end}"));
        let values = rows
            .iter()
            .flat_map(|row| ends.iter().filter_map(|name| row.number(name)))
            .chain(bounds.iter().filter_map(|row| row.number(column)))
            .chain([1.0]);
        let x = Axis::powers(
            range(values.map(place)),
            &format!("{title} RMSE over that of the best constant"),
            "1",
            6.0,
        );
        let mut panel = Panel::new(x, Axis::names(levels.iter().cloned(), true));
        let last = levels.len() as f64 - 0.5;
        panel.sides.0 = 24 + 7 * levels.iter().map(String::len).max().unwrap_or(0) as u32;
        panel.lines.push(line(vec![(0.0, -0.5), (0.0, last)], 1.0, INK));
        for row in bounds {
            let place_of = families.iter().position(|name| name == row.text("family"));
            let (Some(level), Some(index), Some(value)) = (level(row), place_of, row.number(column)) else {
                continue;
            };
            let (x, y) = (place(value), level as f64);
            panel.lines.push(Line {
                dash: dash(index),
                ..line(vec![(x, y - 0.45), (x, y + 0.45)], 1.5, SOFT)
            });
        }
        for row in rows {
            let (Some(level), Some(filter), Some(value)) = (
                level(row),
                filters.iter().position(|name| name == row.text("filter")),
                row.number(column),
            ) else {
                continue;
            };
            let step = 0.7 / filters.len().max(1) as f64;
            let y = level as f64 + step * (filter as f64 - 0.5 * (filters.len() as f64 - 1.0));
            let ends = ["low", "high"].map(|end| row.number(&format!("{column}_{end}")));
            if let [Some(low), Some(high)] = ends {
                panel
                    .lines
                    .push(line(vec![(place(low), y), (place(high), y)], 1.5, colour(filter)));
            }
            panel.dots.push(Dot {
                at: (place(value), y),
                radius: 3.0,
                colour: colour(filter),
                // Beyond the edge.
                ring: !(EDGES[0]..=EDGES[1]).contains(&value),
            });
        }
        panel
    };
    let keys = filters.iter().enumerate().map(|(index, name)| Key {
        name: name.clone(),
        colour: colour(index).to_rgba(),
        mark: Mark::Dot,
    });
    let bounds = families.iter().enumerate().map(|(index, name)| Key {
        name: format!("{name} (bound)"),
        colour: SOFT.to_rgba(),
        mark: Mark::Line(dash(index)),
    });
    Sheet {
        panel: (560, 90 + 46 * levels.len() as u32),
        across: 2,
        name: format!("{mission}, 95 % intervals"),
        keys: keys.chain(bounds).collect(),
        panels: vec![panel("position", "pos_ratio"), panel("velocity", "vel_ratio")],
    }
}

fn line(points: Vec<(f64, f64)>, width: f64, colour: plotters::style::RGBColor) -> Line {
    Line {
        points,
        colour,
        width,
        dash: None,
    }
}
