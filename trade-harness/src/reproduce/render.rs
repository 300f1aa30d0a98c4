//! `reproduce.csv` and `reproduce.md`.

use super::line::{Line, Verdict};
use super::notebook::Notebook;
use crate::HarnessError;
use crate::format::{Align, cell, finished, markdown_table, number};

const COLUMNS: [&str; 13] = [
    "chapter",
    "paper",
    "item",
    "quantity",
    "unit",
    "paper_value",
    "value",
    "standard_error",
    "bound_low",
    "bound_high",
    "required",
    "verdict",
    "note",
];

/// Contents of `reproduce.csv`: a row for each line; `required` is 1 or 0, absent numbers are empty, an infinite bound too.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn csv(notebook: &Notebook) -> Result<Vec<u8>, HarnessError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for (chapter, line) in &notebook.lines {
        writer.write_record([
            *chapter,
            line.paper,
            &line.item,
            &line.quantity,
            line.unit,
            &cell(line.printed),
            &cell(line.value),
            &cell(line.standard_error),
            &cell(line.bound.map(|b| b.low)),
            &cell(line.bound.map(|b| b.high)),
            if line.required { "1" } else { "0" },
            line.verdict().text(),
            &line.note,
        ])?;
    }
    finished(writer)
}

/// Contents of `reproduce.md`: a table for each chapter.
///
/// * `heading`: what was run, one line.
pub fn markdown(notebook: &Notebook, heading: &str) -> String {
    let mut text = format!(
        "# What the two papers print, rerun\n\n{heading}\n\n\
        A verdict of a required line decides whether the reproduction stands; the others say whether the paper's claim does.\n"
    );
    for chapter in notebook.lines.chunk_by(|(one, _), (next, _)| one == next) {
        let Some((title, _)) = chapter.first() else { continue };
        let rows = chapter.iter().map(|(_, line)| cells(line));
        text.push_str(&format!("\n## {title}\n\n{}", markdown_table(&HEADERS, rows)));
    }
    text
}

const HEADERS: [(&str, Align); 8] = [
    ("item", Align::Left),
    ("quantity", Align::Left),
    ("unit", Align::Left),
    ("paper", Align::Left),
    ("here", Align::Left),
    ("bound", Align::Left),
    ("verdict", Align::Left),
    ("note", Align::Left),
];

fn cells(line: &Line) -> [String; HEADERS.len()] {
    [
        line.item.clone(),
        line.quantity.clone(),
        line.unit.to_owned(),
        line.printed.map(printed).unwrap_or_default(),
        found(line),
        bound(line),
        verdict(line),
        line.note.clone(),
    ]
}

/// As few digits as read back as the same number; the paper's rounding is its own.
fn printed(value: f64) -> String {
    let short = format!("{value:.4e}").parse::<f64>().unwrap_or(value);
    if short == 0.0 || (1e-2..1e5).contains(&short.abs()) {
        short.to_string()
    } else {
        format!("{short:e}")
    }
}

fn found(line: &Line) -> String {
    let error = line.standard_error.map(|e| format!(" ± {}", number(Some(e))));
    format!("{}{}", number(line.value), error.unwrap_or_default())
}

/// The range in words; empty without one.
fn bound(line: &Line) -> String {
    match line.bound {
        None => String::new(),
        Some(b) if b.low.is_infinite() => "nothing to compare with".to_owned(),
        Some(b) => b.words(|end| number(Some(end))),
    }
}

/// A line for the terminal.
pub fn line_text(line: &Line) -> String {
    let word = match (line.verdict(), line.required) {
        (Verdict::Holds, _) => "holds ",
        (Verdict::Fails, true) => "MISSED",
        (Verdict::Fails, false) => "fails ",
        (Verdict::PrintedOnly, _) => "      ",
    };
    let paper = line.printed.map(|p| format!(", paper {}", printed(p)));
    let bound = line.bound.map(|_| format!(" (bound: {})", bound(line)));
    format!(
        "{word}  {}: {} = {}{}{}{}",
        line.item,
        line.quantity,
        found(line),
        if line.unit == "1" {
            String::new()
        } else {
            format!(" {}", line.unit)
        },
        paper.unwrap_or_default(),
        bound.unwrap_or_default()
    )
}

/// The verdict, with the word that makes it count.
fn verdict(line: &Line) -> String {
    let required = if line.required { ", required" } else { "" };
    format!("{}{required}", line.verdict().text())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::Bound;

    fn notebook() -> Notebook {
        let lines = vec![
            (
                "One",
                Line::new("A and B", "Table 2, x", "f d_x RMSE", "m/s2")
                    .printed(7.2e-7)
                    .value(Some(7.123_456e-7))
                    .error(Some(1.2e-8))
                    .bound(Bound::between(6.12e-7, 8.28e-7))
                    .required(true),
            ),
            (
                "One",
                Line::new("A and B", "Table 2, z", "f d_z RMSE", "m/s2").printed(0.0079),
            ),
            (
                "Two",
                Line::new("A and B", "Sec. 3: larger", "a over b, \"q\"", "1")
                    .value(Some(0.9))
                    .bound(Bound::between(1.0, f64::INFINITY))
                    .note("a, b"),
            ),
        ];
        let mut notebook = Notebook::default();
        notebook.lines = lines;
        notebook
    }

    #[test]
    fn snapshot_of_both_files() {
        let text = markdown(&notebook(), "3 runs from seed 1");
        let table = text.split_once("## One\n\n").unwrap().1;
        let head =
            "| item | quantity | unit | paper | here | bound | verdict | note |\n|---|---|---|---|---|---|---|---|\n";
        let expected = format!(
            "{head}\
            | Table 2, x | f d_x RMSE | m/s2 | 7.2e-7 | 7.123e-7 ± 1.200e-8 | 6.120e-7 to 8.280e-7 | holds, required |  |\n\
            | Table 2, z | f d_z RMSE | m/s2 | 7.9e-3 | - |  | printed only |  |\n\
            \n## Two\n\n{head}\
            | Sec. 3: larger | a over b, \"q\" | 1 |  | 0.9000 | at least 1.000 | fails | a, b |\n"
        );
        assert_eq!(table, expected, "\n{text}");
        assert!(text.contains("3 runs from seed 1"));

        let said: Vec<String> = notebook().lines.iter().map(|(_, line)| line_text(line)).collect();
        let first =
            "holds   Table 2, x: f d_x RMSE = 7.123e-7 ± 1.200e-8 m/s2, paper 7.2e-7 (bound: 6.120e-7 to 8.280e-7)";
        assert_eq!(said[0], first);
        assert_eq!(
            said[2],
            "fails   Sec. 3: larger: a over b, \"q\" = 0.9000 (bound: at least 1.000)"
        );

        let bytes = csv(&notebook()).unwrap();
        let mut reader = ::csv::Reader::from_reader(&bytes[..]);
        assert_eq!(reader.headers().unwrap(), &COLUMNS[..]);
        let rows: Vec<Vec<String>> = reader
            .records()
            .map(|r| r.unwrap().iter().map(str::to_owned).collect())
            .collect();
        assert_eq!(
            rows[0][5..13],
            [
                "7.2e-7",
                "7.123456e-7",
                "1.2e-8",
                "6.12e-7",
                "8.28e-7",
                "1",
                "holds",
                ""
            ]
        );
        assert_eq!(rows[1][6..13], ["", "", "", "", "0", "printed only", ""]);
        assert_eq!(rows[2][3], "a over b, \"q\"");
        assert_eq!(rows[2][8..13], ["1.0", "", "0", "fails", "a, b"]);
    }
}
