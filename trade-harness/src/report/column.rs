//! A column of a CSV file: what it is called, what it means, and where its cells come from, said once.

use std::borrow::Cow;

use serde::Serialize;

use crate::HarnessError;
use crate::format;

/// One column of a table whose rows are made of `T`.
pub struct Column<T: 'static> {
    /// Name in the header.
    pub name: &'static str,
    /// Unit; `1` for a number without, empty for text and counts.
    pub unit: &'static str,
    /// What it tells.
    pub meaning: &'static str,
    get: Get<T>,
}

/// Where the cells of a column come from, by kind.
enum Get<T: 'static> {
    Text(for<'a> fn(&'a T) -> Cow<'a, str>),
    Count(fn(&T) -> Option<u64>),
    Number(fn(&T) -> Option<f64>),
}

/// What stands in a row under a column; absent values are empty.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell<'a> {
    /// Text.
    Text(Cow<'a, str>),
    /// Whole number.
    Count(Option<u64>),
    /// Number in the unit of the column.
    Number(Option<f64>),
}

/// A column of text.
pub(crate) const fn text<T>(
    name: &'static str,
    meaning: &'static str,
    get: for<'a> fn(&'a T) -> Cow<'a, str>,
) -> Column<T> {
    Column {
        name,
        unit: "",
        meaning,
        get: Get::Text(get),
    }
}

/// A column of whole numbers.
pub(crate) const fn count<T>(name: &'static str, meaning: &'static str, get: fn(&T) -> Option<u64>) -> Column<T> {
    Column {
        name,
        unit: "",
        meaning,
        get: Get::Count(get),
    }
}

/// A column of numbers.
pub(crate) const fn number<T>(
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    get: fn(&T) -> Option<f64>,
) -> Column<T> {
    Column {
        name,
        unit,
        meaning,
        get: Get::Number(get),
    }
}

impl<T> Column<T> {
    /// Whether its cells are text.
    pub(crate) fn is_text(&self) -> bool {
        matches!(self.get, Get::Text(_))
    }

    /// The cell of a row.
    pub fn cell<'a>(&self, row: &'a T) -> Cell<'a> {
        match self.get {
            Get::Text(get) => Cell::Text(get(row)),
            Get::Count(get) => Cell::Count(get(row)),
            Get::Number(get) => Cell::Number(get(row)),
        }
    }
}

impl Cell<'_> {
    /// The number, of whichever kind.
    pub fn as_f64(&self) -> Option<f64> {
        match self {
            Self::Text(_) => None,
            Self::Count(n) => n.map(|n| n as f64),
            Self::Number(x) => *x,
        }
    }

    /// For people: numbers with four significant digits, a dash for what is absent.
    pub fn short(&self) -> String {
        match self {
            Self::Text(text) => text.clone().into_owned(),
            Self::Count(n) => n.map_or_else(|| format::number(None), |n| n.to_string()),
            Self::Number(x) => format::number(*x),
        }
    }
}

/// The columns of one file, without what their cells come from.
#[derive(Debug, Clone)]
pub struct FileColumns {
    /// Name of the file.
    pub file: &'static str,
    /// What its rows are.
    pub about: &'static str,
    /// Name, unit and meaning of each column.
    pub columns: Vec<[&'static str; 3]>,
}

impl FileColumns {
    /// The columns of a file.
    pub(crate) fn new<T>(file: &'static str, about: &'static str, columns: &[Column<T>]) -> Self {
        Self {
            file,
            about,
            columns: columns.iter().map(|c| [c.name, c.unit, c.meaning]).collect(),
        }
    }

    /// The columns of a file that are made elsewhere.
    ///
    /// * `columns`: name, unit and meaning of each.
    pub(crate) fn described(file: &'static str, about: &'static str, columns: &[[&'static str; 3]]) -> Self {
        Self {
            file,
            about,
            columns: columns.to_vec(),
        }
    }
}

/// The column of this name.
pub(crate) fn find<'c, T>(columns: &'c [Column<T>], name: &str) -> Option<&'c Column<T>> {
    columns.iter().find(|c| c.name == name)
}

/// A row by the names of its columns.
pub(crate) fn fields<T>(columns: &[Column<T>], row: &T) -> serde_json::Map<String, serde_json::Value> {
    let cells = columns.iter().map(|column| {
        let value = serde_json::to_value(column.cell(row)).unwrap_or_default();
        (column.name.to_owned(), value)
    });
    cells.collect()
}

/// A CSV file of these columns.
///
/// # Errors
/// [`HarnessError::Csv`].
pub(crate) fn render<'r, T: 'static>(
    columns: &[Column<T>],
    rows: impl IntoIterator<Item = &'r T>,
) -> Result<Vec<u8>, HarnessError> {
    let names: Vec<&str> = columns.iter().map(|c| c.name).collect();
    let cells = rows
        .into_iter()
        .map(|row| columns.iter().map(|c| c.cell(row)).collect::<Vec<_>>());
    format::csv_bytes(&names, cells)
}
