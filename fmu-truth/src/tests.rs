//! The slave as an instance, and its descriptions.

#[path = "../../tests/one_slave/mod.rs"]
mod one_slave;

use super::TruthModel;
use std::path::Path;

#[test]
fn model_descriptions_are_the_committed_ones() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-truth/modelDescription.xml");
    fmi2_export::golden_check::<TruthModel>(&path).unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-truth/fmi3/modelDescription.xml");
    fmi3_export::golden_check::<TruthModel>(&path).unwrap();
}

#[test]
fn equal_instances_have_equal_states_wherever_their_resources_are() {
    one_slave::equal_instances_have_equal_states_wherever_their_resources_are::<TruthModel>();
}

#[test]
fn a_state_finds_the_missions_of_the_instance_that_it_is_set_on() {
    one_slave::a_state_finds_the_missions_of_the_instance_that_it_is_set_on::<TruthModel>();
}

/// A model initialises from its variables alone: nothing of a mission that was chosen before stays.
#[test]
fn a_mission_leaves_nothing_to_the_next() {
    one_slave::a_mission_leaves_nothing_to_the_next::<TruthModel>();
}
