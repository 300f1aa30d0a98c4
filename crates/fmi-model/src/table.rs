//! The variable table: the one place that knows a variable's name, shape, type, unit, causality, bounds, start value and access.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::definition::DefinitionError;
use crate::variable::{Causality, Entry, EnumerationType, Variable};

/// The variables of a model. Written by a [`TableBuilder`](crate::TableBuilder).
#[derive(Debug)]
pub struct Table<M> {
    rows: Vec<Variable<M>>,
    /// Row of each entry.
    row_of: Vec<usize>,
    types: Vec<Arc<EnumerationType>>,
    defect: Option<DefinitionError>,
    by_name: HashMap<String, u32>,
}

impl<M> Table<M> {
    pub(crate) fn new(
        rows: Vec<Variable<M>>,
        types: Vec<Arc<EnumerationType>>,
        mut defect: Option<DefinitionError>,
    ) -> Self {
        let mut row_of = Vec::new();
        let mut by_name = HashMap::new();
        let mut names = HashSet::new();
        for (index, row) in rows.iter().enumerate() {
            if !names.insert(row.name.as_str()) {
                let name = row.name.clone();
                defect.get_or_insert(DefinitionError::DuplicateName { name });
            }
            for (number, entry) in (row.first..).zip(row.entries()) {
                row_of.push(index);
                by_name.insert(entry.name().into_owned(), number);
            }
        }
        let is_input = |name: &str| {
            rows.iter()
                .any(|row| row.causality == Causality::Input && row.name == name)
        };
        for row in &rows {
            if let Some(input) = row.initial_inputs.iter().find(|input| !is_input(input)) {
                let name = row.shape.element_name(&row.name, 0).into_owned();
                defect.get_or_insert(DefinitionError::UnknownInput { name, input });
            }
        }
        Self {
            rows,
            row_of,
            types,
            defect,
            by_name,
        }
    }

    /// Every row, in the order in which it was written: what a standard with arrays calls a variable.
    pub fn rows(&self) -> &[Variable<M>] {
        &self.rows
    }

    /// Every element of every row, in order: what a standard without arrays calls a variable.
    pub fn entries(&self) -> impl Iterator<Item = Entry<'_, M>> {
        self.rows.iter().flat_map(Variable::entries)
    }

    /// Number of entries.
    pub fn entry_count(&self) -> usize {
        self.row_of.len()
    }

    /// The entry with this number; entries count from 0, those of a row one after the other.
    pub fn entry(&self, number: u32) -> Option<Entry<'_, M>> {
        let row = &self.rows[*self.row_of.get(usize::try_from(number).ok()?)?];
        let element = usize::try_from(number - row.first).ok()?;
        Some(Entry { row, element })
    }

    /// Number of the entry with this name, indices included.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    /// Every declared enumeration, in order of declaration.
    pub fn enumeration_types(&self) -> impl Iterator<Item = &EnumerationType> {
        self.types.iter().map(AsRef::as_ref)
    }

    /// Sets every variable that has a start value to it.
    pub fn apply_start(&self, model: &mut M) {
        for entry in self.entries() {
            entry.row.typed.any().apply_start(model, entry.element);
        }
    }

    /// The first mistake in the rows, if there is one.
    pub fn defect(&self) -> Option<&DefinitionError> {
        self.defect.as_ref()
    }

    /// Whether `model`, to which the start column has been applied, reads as it says.
    ///
    /// # Errors
    /// [`DefinitionError::StartNotKept`] for the first variable that does not.
    pub fn check_start(&self, model: &M) -> Result<(), DefinitionError> {
        for entry in self.entries() {
            if let Some((start, read)) = entry.row.typed.any().start_mismatch(model, entry.element) {
                return Err(DefinitionError::StartNotKept {
                    name: entry.name().into_owned(),
                    start,
                    read,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::{Shape, TableBuilder};

    struct State {
        covariance: [[f64; 3]; 2],
        mode: i32,
    }

    /// What a standard with arrays needs: the shape as written, and an accessor for every element.
    #[test]
    fn rows_keep_their_shape_and_entries_count_through() {
        let mut t = TableBuilder::<State>::new();
        t.integer("mode").output().get(|m| m.mode);
        t.real("p").output().matrix(2, 3, |m, i, j| m.covariance[i][j]);
        t.real("none").output().vector(0, |_, _| 0.0);
        t.boolean("on").output().vector(2, |m, i| m.mode > i32::from(i > 0));
        let table = t.build();
        assert_eq!(table.defect(), None);
        let shapes: Vec<_> = table.rows().iter().map(|row| (row.first, row.shape)).collect();
        assert_eq!(
            shapes,
            [
                (0, Shape::Scalar),
                (1, Shape::Matrix(2, 3)),
                (7, Shape::Vector(0)),
                (7, Shape::Vector(2)),
            ]
        );
        assert_eq!(table.entry_count(), 9);
        for (number, entry) in (0..).zip(table.entries()) {
            let name = entry.name();
            assert_eq!(table.find(&name), Some(number), "{name}");
            let found = table.entry(number).unwrap();
            assert_eq!((found.name(), found.element), (name, entry.element));
        }
        assert!(table.entry(9).is_none() && table.find("p").is_none());

        let state = State {
            covariance: [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
            mode: 1,
        };
        let entry = |name: &str| table.find(name).and_then(|number| table.entry(number)).unwrap();
        assert_eq!(entry("p[2,1]").read::<f64>(&state), Some(4.0));
        assert_eq!(entry("on[2]").read::<bool>(&state), Some(false));
        assert_eq!(entry("on[1]").read::<i32>(&state), None);
    }
}
