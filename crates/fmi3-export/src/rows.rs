//! What a value reference means. A variable of FMI 3.0 is a row of the table, whatever its shape, and its value reference is the
//! place of the row; after the last row comes time.

use fmi_model::{Model, Table, Typed, Variable};

use crate::error::Fmi3Error;

/// Name of the independent variable, which the standard demands and no table has.
pub const TIME: &str = "time";

/// Value reference of the variable of this name; that of a vector or matrix stands for all its elements.
pub fn value_reference<M>(table: &Table<M>, name: &str) -> Option<u32> {
    let row = table.rows().iter().position(|row| row.name == name);
    let place = row.or_else(|| (name == TIME).then(|| table.rows().len()))?;
    u32::try_from(place).ok()
}

/// The type of a row in FMI 3.0, by the name of its element in the description.
pub(crate) fn type_name<M>(typed: &Typed<M>) -> &'static str {
    match typed {
        Typed::Real { .. } => "Float64",
        Typed::Integer { .. } => "Int32",
        Typed::Enumeration { .. } => "Enumeration",
        Typed::Boolean { .. } => "Boolean",
        Typed::String { .. } => "String",
    }
}

/// What a value reference stands for.
enum Referred<M: 'static> {
    Row(&'static Variable<M>),
    Time,
}

fn referred<M: Model>(reference: u32) -> Result<Referred<M>, Fmi3Error> {
    let rows = M::table().rows();
    let place = usize::try_from(reference).unwrap_or(usize::MAX);
    match rows.get(place) {
        Some(row) => Ok(Referred::Row(row)),
        None if place == rows.len() => Ok(Referred::Time),
        None => Err(Fmi3Error::UnknownReference {
            reference,
            count: rows.len() + 1,
        }),
    }
}

/// Whether a reference is that of time.
pub(crate) fn is_time<M: Model>(reference: u32) -> bool {
    matches!(referred::<M>(reference), Ok(Referred::Time))
}

/// Whether all references are those of variables of type `wanted`, of `given` values together.
///
/// * `time`: whether time may be among them.
pub(crate) fn check<M: Model>(
    references: &[u32],
    wanted: &'static str,
    given: usize,
    time: bool,
) -> Result<(), Fmi3Error> {
    let mut needed = 0_usize;
    for &reference in references {
        let (name, declared, count) = match referred::<M>(reference)? {
            Referred::Row(row) => (row.name.as_str(), type_name(&row.typed), row.shape.count()),
            Referred::Time => (TIME, "Float64", 1),
        };
        if declared != wanted {
            return Err(Fmi3Error::WrongType {
                name: name.to_owned(),
                reference,
                declared,
            });
        }
        if !time && is_time::<M>(reference) {
            return Err(Fmi3Error::Independent { name: TIME, reference });
        }
        needed = needed.saturating_add(count);
    }
    if needed == given {
        Ok(())
    } else {
        Err(Fmi3Error::WrongCount { needed, given })
    }
}

/// The entries of the rows that are referred to, one row after the other.
pub(crate) fn entries<M: Model>(references: &[u32]) -> impl Iterator<Item = u32> + Clone {
    let rows = M::table().rows();
    let row = |reference: &u32| usize::try_from(*reference).ok().and_then(|place| rows.get(place));
    references.iter().filter_map(row).flat_map(|row| {
        let count = u32::try_from(row.shape.count()).unwrap_or(u32::MAX);
        row.first..row.first.saturating_add(count)
    })
}
