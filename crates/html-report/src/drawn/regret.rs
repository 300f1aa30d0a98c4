//! Laws against the best constant, level by level.

use std::path::Path;

use super::axis::Axis;
use super::sheet::{Dot, INK, Key, Line, Mark, Panel, Sheet, colour, range};
use crate::ReportError;
use crate::folder::{Row, table};
use plotters::style::Color;

/// Name of the table that makes a folder one of `regret`.
pub(super) const TABLE: &str = "regret.csv";

/// Ratios beyond these stand at the edge.
const EDGES: [f64; 2] = [0.25, 10.0];

/// A figure for each mission.
pub(super) fn sheets(folder: &Path) -> Result<Vec<(String, Sheet)>, ReportError> {
    let rows = table(
        folder,
        TABLE,
        &["mission", "level", "filter", "kind", "pos_ratio", "vel_ratio"],
    )?;
    let laws: Vec<&Row> = rows.iter().filter(|row| row.text("kind") == "law").collect();
    let missions = names(&laws, "mission");
    let sheet = |mission: String| {
        let own: Vec<&Row> = laws
            .iter()
            .copied()
            .filter(|row| row.text("mission") == mission)
            .collect();
        (format!("{mission}_regret"), of_mission(&mission, &own))
    };
    Ok(missions.into_iter().map(sheet).collect())
}

/// Values of a column in the order in which they come.
fn names(rows: &[&Row], column: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for row in rows {
        if !names.iter().any(|name| name == row.text(column)) {
            names.push(row.text(column).to_owned());
        }
    }
    names
}

fn of_mission(mission: &str, rows: &[&Row]) -> Sheet {
    let (levels, filters) = (names(rows, "level"), names(rows, "filter"));
    let place = |v: f64| v.clamp(EDGES[0], EDGES[1]).log10();
    let panel = |title: &str, column: &str| {
        let ends = ["", "_low", "_high"].map(|end| format!("{column}{end}"));
        let values = rows
            .iter()
            .flat_map(|row| ends.iter().filter_map(|name| row.number(name)))
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
        for row in rows {
            let (Some(level), Some(filter), Some(value)) = (
                levels.iter().position(|name| name == row.text("level")),
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
    Sheet {
        panel: (560, 90 + 46 * levels.len() as u32),
        across: 2,
        name: format!("{mission}, 95 % intervals"),
        keys: keys.collect(),
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
