//! How numbers and tables are written: CSV and JSON for programs, aligned text and Markdown for people.

use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};
use serde::Serialize;

use crate::HarnessError;

/// A CSV file with a header, also when there are no rows; absent values are empty cells.
pub(crate) fn csv_bytes(
    columns: &[&str],
    rows: impl IntoIterator<Item = impl Serialize>,
) -> Result<Vec<u8>, HarnessError> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.write_record(columns)?;
    for row in rows {
        writer.serialize(row)?;
    }
    finished(writer)
}

/// The bytes of a CSV file.
pub(crate) fn finished(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, HarnessError> {
    writer
        .into_inner()
        .map_err(|e| HarnessError::Csv(e.into_error().into()))
}

/// A JSON file that people can read, with a final newline.
pub(crate) fn json_bytes(value: &impl Serialize) -> Result<Vec<u8>, HarnessError> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Shortest text that reads back as the same number; empty for what is absent or no number.
pub(crate) fn cell(value: Option<f64>) -> String {
    value
        .filter(|v| v.is_finite())
        .map(|v| format!("{v:?}"))
        .unwrap_or_default()
}

/// Four significant digits; a dash for what is absent.
pub fn number(value: Option<f64>) -> String {
    let Some(v) = value else { return "-".to_owned() };
    let magnitude = v.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if (1e-2..1e5).contains(&magnitude) {
        let digits = (3.0 - magnitude.log10().floor()).max(0.0) as usize;
        format!("{v:.digits$}")
    } else {
        format!("{v:.3e}")
    }
}

/// A table with rules above, below and under the header; columns after the first `left` are aligned to the right. Without a
/// final newline.
pub(crate) fn plain_table<H: Into<comfy_table::Cell>>(
    headers: impl IntoIterator<Item = H>,
    left: usize,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> String {
    let rule = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table.load_style(
        TableStyle::new()
            .top_border(rule)
            .header_separator(rule)
            .bottom_border(rule),
    );
    table.set_header(headers.into_iter().collect::<Vec<_>>());
    table.add_rows(rows);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 1));
        if index >= left {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    lines(&table)
}

/// The lines of a table without blanks at their ends.
pub(crate) fn lines(table: &Table) -> String {
    table
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Width of what a terminal shows.
pub(crate) const TERMINAL: usize = 80;

/// A line that is broken where it is wider than a terminal, what follows set under its ninth letter.
pub(crate) fn wrapped(line: &str) -> String {
    // At blanks alone: a number such as 1e-5 stays whole.
    let options = textwrap::Options::new(TERMINAL)
        .subsequent_indent("        ")
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(line, options)
}

/// Where the cells of a column of a Markdown table stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// A table in Markdown, with a final newline.
pub(crate) fn markdown_table<R: AsRef<[String]>>(
    headers: &[(&str, Align)],
    rows: impl IntoIterator<Item = R>,
) -> String {
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let cells: Vec<String> = cells.map(|c| c.replace('|', "\\|").replace('\n', " ")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let mut text = line(&mut headers.iter().map(|(heading, _)| *heading));
    let rules = headers.iter().map(|(_, align)| match align {
        Align::Left => "|---",
        Align::Right => "|---:",
    });
    text.extend(rules);
    text.push_str("|\n");
    for row in rows {
        text.push_str(&line(&mut row.as_ref().iter().map(String::as_str)));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_at_any_magnitude() {
        for (value, text) in [
            (None, "-"),
            (Some(0.0), "0"),
            (Some(-1.0), "-1.000"),
            (Some(0.0123456), "0.01235"),
            (Some(12345.6), "12346"),
            (Some(1.5e-7), "1.500e-7"),
            (Some(1e5), "1.000e5"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn markdown_keeps_its_columns_whatever_the_cells_hold() {
        let headers = [("a", Align::Left), ("b\n[m]", Align::Right)];
        let rows = [["x|y".to_owned(), "1".to_owned()], [String::new(), "2\n3".to_owned()]];
        let expected = "| a | b [m] |\n|---|---:|\n| x\\|y | 1 |\n|  | 2 3 |\n";
        assert_eq!(markdown_table(&headers, rows), expected);
        assert_eq!(markdown_table(&headers[..1], [[]; 0]), "| a |\n|---|\n");
    }
}
