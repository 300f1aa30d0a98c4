//! A whole FMU in one file: the output is the integral of the input times a gain.
//!
//! `cargo build --example integrator` builds the library. With it and the text of [`fmi2_export::render`], a zip file of
//! `modelDescription.xml` and `binaries/linux64/integrator.so` is an FMU.

use std::sync::OnceLock;

use fmi2_export::{Experiment, Log, Model, ModelError, ModelInfo, Table, TableBuilder, export_fmu};
use serde::{Deserialize, Serialize};

/// The state of one instance.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Integrator {
    gain_per_s: f64,
    u: f64,
    y: f64,
}

impl Model for Integrator {
    fn info() -> &'static ModelInfo {
        static INFO: OnceLock<ModelInfo> = OnceLock::new();
        INFO.get_or_init(|| ModelInfo {
            model_name: "integrator",
            model_identifier: "integrator",
            description: "Integral of the input times a gain",
            version: env!("CARGO_PKG_VERSION"),
            default_stop: 10.0,
            default_step: 0.1,
            ..ModelInfo::default()
        })
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Integrator>> = OnceLock::new();
        TABLE.get_or_init(|| {
            let mut t = TableBuilder::new();
            t.real("gain")
                .parameter()
                .unit("1/s")
                .positive()
                .start(1.0)
                .about("growth of the output for an input of one")
                .rw(|m: &Integrator| m.gain_per_s, |m, value| m.gain_per_s = value);
            t.real("u")
                .input()
                .unit("m")
                .about("integrand, held over a step")
                .rw(|m| m.u, |m, value| m.u = value);
            t.real("y")
                .output()
                .unit("m")
                .about("integral since the start")
                .get(|m| m.y);
            t.build()
        })
    }

    fn blank() -> Self {
        Self::default()
    }

    fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
        self.y = 0.0;
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, log: &mut Log<'_>) -> Result<(), ModelError> {
        self.y += self.gain_per_s * self.u * h;
        log.detail(format_args!("y = {} m at {} s", self.y, t + h));
        Ok(())
    }
}

export_fmu!(Integrator);
