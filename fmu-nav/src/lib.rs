//! The navigation filters of `crates/filters` as an FMI 2.0 co-simulation slave.
//!
//! `variables.rs` is the table of everything a master can see; `slave.rs` is what the table reads and writes, around a
//! [`filters::Navigator`]; `model.rs` answers what FMI asks. Behaviour belongs in `filters`, the C interface in `fmi2-export`;
//! here stands neither.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod model;
mod slave;
mod variables;

use slave::NavModel;

fmi2_export::export_fmu!(NavModel);

#[cfg(test)]
mod tests {
    use super::NavModel;
    use std::path::Path;

    #[test]
    fn model_description_is_the_committed_one() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-nav/modelDescription.xml");
        fmi2_export::golden_check::<NavModel>(&path).unwrap();
    }
}
