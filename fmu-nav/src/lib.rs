//! The navigation filters of `crates/filters` as a co-simulation slave of FMI 2.0 and FMI 3.0.
//!
//! `variables.rs` is the table of everything a master can see; `slave.rs` is what the table reads and writes, around a
//! [`filters::Navigator`]; `model.rs` answers what FMI asks. Behaviour belongs in `filters`, the C interfaces in `fmi2-export` and `fmi3-export`;
//! here stands neither.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod model;
mod slave;
mod variables;

use slave::NavModel;

// One library with both interfaces: they step the same code, so a run has the same bits in either.
fmi2_export::export_fmu!(NavModel);
fmi3_export::export_fmu!(NavModel);

#[cfg(test)]
mod tests {
    use super::NavModel;
    use std::path::Path;

    #[test]
    fn model_descriptions_are_the_committed_ones() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-nav/modelDescription.xml");
        fmi2_export::golden_check::<NavModel>(&path).unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-nav/fmi3/modelDescription.xml");
        fmi3_export::golden_check::<NavModel>(&path).unwrap();
    }
}
