//! `modelDescription.xml` of the probe.

use std::path::Path;

use fmi2_export::{Model, golden_check, guid, render};
use uuid::Uuid;

use crate::probe::Probe;

#[test]
fn the_committed_description_is_that_of_the_probe() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/host/probe.xml");
    golden_check::<Probe>(&path).unwrap();
}

#[test]
fn value_references_are_entry_numbers() {
    for (number, entry) in (0_u32..).zip(Probe::table().entries()) {
        assert_eq!(Probe::table().find(&entry.name()), Some(number));
    }
    assert_eq!(Probe::table().find("no such"), None);
}

#[test]
fn the_guid_is_a_hash_of_all_the_rest() {
    let guid = guid::<Probe>().unwrap();
    let text = render::<Probe>().unwrap();
    assert_eq!(text.matches(&guid.to_string()).count(), 1);
    let rest = text.replace(&format!("{{{guid}}}"), "") + "1.2.3";
    assert_eq!(guid, Uuid::new_v5(&Uuid::NAMESPACE_OID, rest.as_bytes()));
}
