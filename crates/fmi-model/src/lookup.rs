//! Entries of one type by their numbers, for calls that take many of them.

use crate::error::InstanceError;
use crate::model::Model;
use crate::table::Table;
use crate::variable::{Access, Entry, Scalar, Variable};

/// Finds entries of type `T`. Neighbours are mostly of one row, so the row found last is looked at first.
pub(crate) struct Lookup<M: 'static, T: 'static> {
    table: &'static Table<M>,
    last: Option<Found<M, T>>,
}

/// A row of type `T`, and how its elements are read and written.
struct Found<M: 'static, T: 'static> {
    row: &'static Variable<M>,
    access: &'static Access<M, T>,
    count: usize,
}

impl<M: Model, T: Scalar> Lookup<M, T> {
    pub(crate) fn new() -> Self {
        Self {
            table: M::table(),
            last: None,
        }
    }

    /// The entry of this number and the access to its row.
    ///
    /// # Errors
    /// [`InstanceError::UnknownReference`] or [`InstanceError::WrongType`].
    #[inline]
    pub(crate) fn entry(&mut self, number: u32) -> Result<(Entry<'static, M>, &'static Access<M, T>), InstanceError> {
        if let Some(Found { row, access, count }) = self.last {
            // Below the row's first it wraps to something large.
            let element = number.wrapping_sub(row.first) as usize;
            if element < count {
                return Ok((Entry { row, element }, access));
            }
        }
        let Some((entry, access)) = self.in_table(number) else {
            return Err(refused(self.table, number));
        };
        let (row, count) = (entry.row, entry.row.shape.count());
        self.last = Some(Found { row, access, count });
        Ok((entry, access))
    }

    fn in_table(&self, number: u32) -> Option<(Entry<'static, M>, &'static Access<M, T>)> {
        let entry = self.table.entry(number)?;
        Some((entry, T::access(&entry.row.typed)?))
    }
}

impl<M, T> Clone for Found<M, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M, T> Copy for Found<M, T> {}

#[cold]
fn refused<M>(table: &Table<M>, reference: u32) -> InstanceError {
    match table.entry(reference) {
        None => InstanceError::UnknownReference {
            reference,
            count: table.entry_count(),
        },
        Some(entry) => InstanceError::WrongType {
            name: entry.name().into_owned(),
            reference,
            declared: entry.row.typed.name(),
        },
    }
}
