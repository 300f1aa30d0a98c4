//! Radio link: range and range rate, whatever the attitude.

use interface::mission;
use numerics::Generator;
use numerics::streams::{Source, stream};
use sensors::{normal3, radio};
use serde::{Deserialize, Serialize};

use super::Scene;
use super::faults::Faults;
use crate::overrides::Run;

/// What the radio link says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RadioSample {
    /// Whether it sampled at this epoch.
    pub due: bool,
    /// Whether the sample was received; if not, the values stay the last ones.
    pub valid: bool,
    /// Range, m.
    pub range: f64,
    /// Rate of the range, m/s.
    pub range_rate: f64,
}

impl RadioSample {
    pub(super) fn not_due(&mut self) {
        self.due = false;
        self.valid = false;
    }
}

/// The sensor with its generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Radio {
    sigma_range: f64,
    sigma_range_rate: f64,
    noise: Generator,
    faults: Faults,
}

impl Radio {
    pub(super) fn new(sensor: &mission::Radio, run: &Run) -> Self {
        Self {
            sigma_range: sensor.sigma_range_m,
            sigma_range_rate: sensor.sigma_range_rate_m_s,
            noise: stream(run.study_seed, run.run, Source::Radio),
            faults: Faults::new(sensor.faults(), run, "radio", false),
        }
    }

    pub(super) fn sample(&mut self, seen: &mut RadioSample, scene: &Scene) {
        let unit = normal3(&mut self.noise);
        let truth = radio::measure(&scene.r_tc_n, &scene.v_tc_n);
        let fault = self.faults.draw(truth[0]);
        // Two vehicles in one place have no line of sight.
        seen.due = true;
        seen.valid = !fault.dropped && truth[0] > 0.0;
        if !seen.valid {
            return;
        }
        seen.range = truth[0] + unit[0] * self.sigma_range * fault.scale;
        seen.range_rate = truth[1] + unit[1] * self.sigma_range_rate * fault.scale;
    }
}
