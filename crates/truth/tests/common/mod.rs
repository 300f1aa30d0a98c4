//! Parameters and missions for the tests.
#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test file uses its part; helpers of tests unwrap"
)]

use interface::mission::Embedded;
use nalgebra::Vector3;
use truth::{Inputs, Params, SensorSample, Simulation};

/// The same parameters for another run.
pub fn numbered(mut params: Params, run: u32) -> Params {
    params.run = run;
    params
}

/// The same parameters with some of them set.
pub fn with(params: &Params, values: &[(&str, f64)]) -> Params {
    let mut params = params.clone();
    for (name, value) in values {
        assert!(params.set(name, *value), "there is no {name}");
    }
    params
}

/// A mission file that lives as long as the test.
pub struct File {
    folder: tempfile::TempDir,
}

impl File {
    /// A file with this text.
    pub fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("mission.toml"), text).unwrap();
        Self { folder }
    }

    /// A file beside it.
    pub fn beside(self, name: &str, text: &str) -> Self {
        std::fs::write(self.folder.path().join(name), text).unwrap();
        self
    }

    pub fn params(&self) -> Params {
        Params::of_file(self.folder.path().join("mission.toml").display().to_string())
    }

    pub fn simulation(&self) -> Simulation {
        start(&self.params())
    }
}

/// Text of a mission that comes with the project, with changes, each of which must find its place.
pub fn changed(name: &str, changes: &[(&str, &str)]) -> String {
    let embedded = interface::mission::embedded(name).unwrap();
    changes.iter().fold(embedded.text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    })
}

/// A quiet low orbit with the target 100 m ahead and whatever sensors and events are appended.
pub fn quiet(rest: &str) -> String {
    format!("{QUIET}\n{rest}")
}

pub const QUIET: &str = r#"
mission = 1
name = "quiet"
[time]
duration_s = 600.0
sample_period_s = 1.0
grid_s = 1.0
[environment]
gravity = { model = "two_body", mu_m3_s2 = 3.986e14, radius_m = 6.378e6 }
[target.orbit]
elements = { a_m = 7.0e6, e = 0.01, i_deg = 40.0, raan_deg = 10.0, argp_deg = 20.0, true_anomaly_deg = 30.0 }
[chaser.relative]
axes = "rtn"
r_tc_m = [3.0, 100.0, -2.0]
v_tc_m_s = [0.01, -0.2, 0.03]
"#;

/// A run at its start.
pub fn start(params: &Params) -> Simulation {
    Simulation::new(params, 0.0, &Inputs::default()).unwrap()
}

/// Goes on without inputs.
pub fn advance(simulation: &mut Simulation, t: f64) {
    simulation.advance_to(t, &Inputs::default()).unwrap();
}

/// The samples at `count` communication points, one every `step` seconds.
pub fn samples(params: &Params, step: f64, count: u32) -> Vec<SensorSample> {
    let mut run = start(params);
    (1..=count)
        .map(|k| {
            advance(&mut run, f64::from(k) * step);
            *run.sample()
        })
        .collect()
}

/// Every mission of the enumeration, counted from 1.
pub fn scenarios() -> impl Iterator<Item = (i32, &'static Embedded)> {
    (1..).zip(Embedded::scenarios())
}

/// Reading of the accelerometer in axes N, m/s2.
pub fn felt(sample: &SensorSample) -> Vector3<f64> {
    sample.dcm_bc_n.tr_mul(&sample.accelerometer.alpha_c_bc)
}
