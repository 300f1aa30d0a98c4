//! The page of a folder of `regret`: laws against the best constant, mission by mission, as a figure and as a table.

use std::path::Path;

use askama::Template;

use crate::ReportError;
use crate::drawn::regret::{names, rows};
use crate::drawn::{Format, drawn};
use crate::folder::Row;
use crate::frame::Frame;
use crate::number::short;

#[derive(Template)]
#[template(path = "regret.html")]
struct Page {
    frame: Frame,
    missions: Vec<Mission>,
}

struct Mission {
    name: String,
    headline: String,
    figure: String,
    lines: Vec<Line>,
}

struct Line {
    level: String,
    filter: String,
    kind: String,
    runs: String,
    bad: bool,
    /// Each as it is sorted and as it is shown: ratios of position and velocity, both RMSE, NEES6.
    numbers: [[String; 2]; 5],
}

pub(crate) fn render(folder: &Path) -> Result<String, ReportError> {
    let rows = rows(folder)?;
    let all: Vec<&Row> = rows.iter().collect();
    let figures = drawn(folder, Format::Svg)?;
    let missions = names(&all, |row| row.text("mission")).into_iter().map(|name| {
        let own = all.iter().copied().filter(|row| row.text("mission") == name);
        let own: Vec<&Row> = own.collect();
        Mission {
            headline: headline(&own),
            figure: figure(&figures, &name),
            lines: own.iter().map(|row| line(row)).collect(),
            name,
        }
    });
    // Its figures are drawn already.
    let nothing: [(); 0] = [];
    let page = Page {
        frame: Frame::new("Laws against the best constant in hindsight", &nothing)?,
        missions: missions.collect(),
    };
    Ok(page.render()?)
}

/// That of a mission, as [`drawn`] names it.
fn figure(figures: &[(String, Vec<u8>)], mission: &str) -> String {
    let name = format!("figures/{mission}_regret.svg");
    let svg = figures.iter().find(|(of, _)| *of == name);
    svg.map_or_else(String::new, |(_, svg)| String::from_utf8_lossy(svg).into_owned())
}

/// From its best to its worst level, law by law.
fn headline(own: &[&Row]) -> String {
    let laws: Vec<&Row> = own.iter().copied().filter(|row| row.text("kind") == "law").collect();
    let said = names(&laws, |row| row.text("filter")).into_iter().filter_map(|law| {
        let ratios = laws.iter().filter(|row| row.text("filter") == law);
        let ratios: Vec<f64> = ratios.filter_map(|row| row.number("pos_ratio")).collect();
        let low = ratios.iter().copied().reduce(f64::min)?;
        let high = ratios.iter().copied().reduce(f64::max)?;
        Some(format!("{law} {} to {}", short(Some(low)), short(Some(high))))
    });
    format!(
        "Position RMSE over that of the best constant: {}.",
        said.collect::<Vec<_>>().join(", ")
    )
}

fn line(row: &Row) -> Line {
    let text = |column: &str| row.text(column).to_owned();
    let ratio = |column: &str| {
        let [low, high] = ["low", "high"].map(|end| row.number(&format!("{column}_{end}")));
        let [sorted, shown] = row.cell(column);
        match (low, high) {
            (Some(_), Some(_)) => [sorted, format!("{shown} ({} to {})", short(low), short(high))],
            _ => [sorted, shown],
        }
    };
    let bad = row.count("failed") + row.count("diverged");
    Line {
        level: text("level"),
        filter: text("filter"),
        kind: text("kind"),
        runs: match bad {
            0 => text("runs"),
            _ => format!("{}, {bad} bad", text("runs")),
        },
        bad: bad > 0,
        numbers: [
            ratio("pos_ratio"),
            ratio("vel_ratio"),
            row.cell("pos_rmse_m"),
            row.cell("vel_rmse_m_s"),
            row.cell("nees6"),
        ],
    }
}
