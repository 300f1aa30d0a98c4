//! CSV tables as Parquet files, for pandas, polars and whatever else reads them.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use crate::HarnessError;

/// Columns of text and of whole numbers, by the names that they have in every file; all others are numbers.
const TEXT: &[&str] = &["filter", "status"];
const WHOLE: &[&str] = &["sample", "measured", "run", "runs", "nis_runs"];

/// What a column holds.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Text,
    Whole,
    Number,
}

impl Kind {
    fn of(name: &str) -> Self {
        // Flags of sensors.
        let flag = name.starts_with("meas_") && name.ends_with("_valid");
        if TEXT.contains(&name) {
            Self::Text
        } else if flag || WHOLE.contains(&name) {
            Self::Whole
        } else {
            Self::Number
        }
    }

    fn column(self, name: &str) -> Result<Type, ParquetError> {
        let (physical, logical) = match self {
            Self::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Self::Whole => (Physical::INT64, None),
            Self::Number => (Physical::DOUBLE, None),
        };
        Type::primitive_type_builder(name, physical)
            .with_logical_type(logical)
            .with_repetition(Repetition::OPTIONAL)
            .build()
    }
}

/// A table with the same columns and rows; an empty cell is null, and a number has the bits that its text stands for.
///
/// * `csv`: with a header.
///
/// # Errors
/// [`HarnessError::Csv`] for what is no table; [`HarnessError::Parquet`] for a cell that is not of its column's kind.
pub fn from_csv(csv: &[u8]) -> Result<Vec<u8>, HarnessError> {
    let mut reader = csv::Reader::from_reader(csv);
    let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    let rows = reader.records().collect::<Result<Vec<_>, _>>()?;
    let columns = names.iter().map(|name| Kind::of(name).column(name).map(Arc::new));
    let schema = Type::group_type_builder("table")
        .with_fields(columns.collect::<Result<_, _>>()?)
        .build()?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (place, name) in names.iter().enumerate() {
        let cells = rows.iter().map(|row| row.get(place).unwrap_or_default());
        if let Some(column) = group.next_column()? {
            write_column(column, name, cells)?;
        }
    }
    group.close()?;
    Ok(writer.into_inner()?)
}

fn write_column<'c>(
    mut column: SerializedColumnWriter<'_>,
    name: &str,
    cells: impl Iterator<Item = &'c str> + Clone,
) -> Result<(), HarnessError> {
    let present: Vec<i16> = cells.clone().map(|cell| i16::from(!cell.is_empty())).collect();
    let full = cells.filter(|cell| !cell.is_empty());
    let wrong = |cell: &str| ParquetError::General(format!("column {name}: {cell} is no number"));
    match Kind::of(name) {
        Kind::Text => {
            let values: Vec<ByteArray> = full.map(ByteArray::from).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&values, Some(&present), None)?;
        }
        Kind::Whole => {
            let values = full.map(|cell| cell.parse().map_err(|_| wrong(cell)));
            let values = values.collect::<Result<Vec<i64>, _>>()?;
            column.typed::<Int64Type>().write_batch(&values, Some(&present), None)?;
        }
        Kind::Number => {
            let values = full.map(|cell| cell.parse().map_err(|_| wrong(cell)));
            let values = values.collect::<Result<Vec<f64>, _>>()?;
            column
                .typed::<DoubleType>()
                .write_batch(&values, Some(&present), None)?;
        }
    }
    column.close()?;
    Ok(())
}
