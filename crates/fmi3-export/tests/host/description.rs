//! `modelDescription.xml` of the probe.

use std::path::Path;
use std::sync::OnceLock;

use fmi3_export::{
    DefinitionError, Experiment, Log, Model, ModelError, ModelInfo, TIME, Table, TableBuilder, golden_check,
    instantiation_token, render, value_reference,
};
use serde::{Deserialize, Serialize};
use uuid::Uuid;

use crate::probe::Probe;

#[test]
fn the_committed_description_is_that_of_the_probe() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/host/probe.xml");
    golden_check::<Probe>(&path).unwrap();
}

#[test]
fn value_references_are_places_of_rows_and_time_comes_last() {
    let rows = Probe::table().rows();
    for (place, row) in (0_u32..).zip(rows) {
        assert_eq!(value_reference(Probe::table(), &row.name), Some(place));
    }
    assert_eq!(value_reference(Probe::table(), TIME), u32::try_from(rows.len()).ok());
    assert_eq!(value_reference(Probe::table(), "u[1]"), None);
}

#[test]
fn the_token_is_a_hash_of_all_the_rest() {
    let token = instantiation_token::<Probe>().unwrap();
    let text = render::<Probe>().unwrap();
    assert_eq!(text.matches(&token.to_string()).count(), 1);
    let rest = text.replace(&format!("{{{token}}}"), "") + "1.2.3";
    assert_eq!(token, Uuid::new_v5(&Uuid::NAMESPACE_OID, rest.as_bytes()));
}

/// A model with a row that has the name of the independent variable.
#[derive(Clone, Serialize, Deserialize)]
struct Timed;

impl Model for Timed {
    fn info() -> &'static ModelInfo {
        Probe::info()
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Timed>> = OnceLock::new();
        TABLE.get_or_init(|| {
            let mut t = TableBuilder::new();
            t.real(TIME).output().get(|_| 0.0);
            t.build()
        })
    }

    fn blank() -> Self {
        Self
    }

    fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }

    fn do_step(&mut self, _: f64, _: f64, _: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }
}

#[test]
fn a_row_called_time_is_a_mistake() {
    let name = TIME.to_owned();
    assert_eq!(render::<Timed>(), Err(DefinitionError::DuplicateName { name }));
}
