//! The simulated world of `crates/truth` as a co-simulation slave of FMI 2.0 and FMI 3.0.
//!
//! `variables.rs` is the table of everything a master can see, `slave.rs` what the table reads and writes, around a
//! [`truth::Simulation`]; `model.rs` answers what FMI asks. Behaviour belongs in `truth`, the C interfaces in `fmi2-export` and `fmi3-export`;
//! here stands neither.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod model;
mod slave;
mod variables;

use slave::TruthModel;

// One library with both interfaces: they step the same code, so a run has the same bits in either.
fmi2_export::export_fmu!(TruthModel);
fmi3_export::export_fmu!(TruthModel);

#[cfg(test)]
mod tests {
    use super::TruthModel;
    use std::path::Path;

    #[test]
    fn model_descriptions_are_the_committed_ones() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-truth/modelDescription.xml");
        fmi2_export::golden_check::<TruthModel>(&path).unwrap();
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../modelDescription/fmu-truth/fmi3/modelDescription.xml");
        fmi3_export::golden_check::<TruthModel>(&path).unwrap();
    }
}
