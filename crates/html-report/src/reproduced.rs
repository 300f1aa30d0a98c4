//! The page of a folder of `reproduce`: what the papers print beside what was found, and the learning curve.

use askama::Template;
use serde::Serialize;

use crate::ReportError;
use crate::folder::{Row, over_time, table};
use crate::frame::Frame;
use crate::learning::{self, Learning};
use crate::number::short;

/// Name of the table that makes a folder one of `reproduce`.
pub(crate) const TABLE: &str = "reproduce.csv";

#[derive(Template)]
#[template(path = "reproduced.html")]
struct Page {
    frame: Frame,
    headline: String,
    lines: Vec<Line>,
    has_learning: bool,
}

struct Line {
    paper: String,
    item: String,
    quantity: String,
    unit: String,
    /// Each as it is sorted and as it is shown.
    numbers: [[String; 2]; 3],
    bound: String,
    verdict: String,
    class: &'static str,
    note: String,
}

/// What `report.js` draws; it knows the figures of a study by the same names.
#[derive(Serialize)]
struct Data {
    id: &'static str,
    scenario: &'static str,
    scored_from_s: f64,
    events: [(); 0],
    filters: [(); 0],
    learning: Option<Learning>,
}

pub(crate) fn render(folder: &std::path::Path) -> Result<String, ReportError> {
    let rows = table(
        folder,
        TABLE,
        &["paper", "item", "quantity", "paper_value", "value", "verdict"],
    )?;
    let required = rows.iter().filter(|r| r.count("required") > 0);
    let missed = required.clone().filter(|r| r.text("verdict") == "fails").count();
    let learning = learning(folder)?;
    let data = [Data {
        id: "s0",
        scenario: "reproduce",
        scored_from_s: 0.0,
        events: [],
        filters: [],
        learning,
    }];
    let page = Page {
        frame: Frame::new("What the papers print, again", &data)?,
        headline: format!("{missed} of {} required bounds missed.", required.count()),
        lines: rows.iter().map(line).collect(),
        has_learning: data[0].learning.is_some(),
    };
    Ok(page.render()?)
}

fn line(row: &Row) -> Line {
    let text = |column: &str| row.text(column).to_owned();
    let [low, high] = ["bound_low", "bound_high"].map(|column| row.number(column).map(|v| short(Some(v))));
    Line {
        paper: text("paper"),
        item: text("item"),
        quantity: text("quantity"),
        unit: text("unit"),
        numbers: ["paper_value", "value", "standard_error"].map(|column| row.cell(column)),
        bound: match (low, high) {
            (Some(low), Some(high)) => format!("{low} to {high}"),
            (Some(low), None) => format!("≥ {low}"),
            (None, Some(high)) => format!("≤ {high}"),
            (None, None) => String::new(),
        },
        class: match row.text("verdict") {
            "holds" => "good",
            "fails" => "bad",
            _ => "",
        },
        verdict: text("verdict"),
        note: text("note"),
    }
}

/// The learning curve; `None` when the folder has none.
pub(crate) fn learning(folder: &std::path::Path) -> Result<Option<Learning>, ReportError> {
    Ok(over_time(folder, "learning_curve.csv")?
        .as_ref()
        .and_then(learning::learning))
}
