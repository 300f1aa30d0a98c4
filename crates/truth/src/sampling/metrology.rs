//! Relative metrology.

use interface::mission::{self, Frame};
use nalgebra::{Vector3, Vector6};
use numerics::Generator;
use numerics::streams::{Source, stream};
use sensors::{metrology, normal3};
use serde::{Deserialize, Serialize};

use super::Scene;
use super::faults::Faults;
use crate::overrides::Run;

/// What the metrology says of one sample: chaser minus target in LVLH axes of the target.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MetrologySample {
    /// Whether it sampled at this epoch.
    pub due: bool,
    /// Whether the sample was received; if not, the values stay the last ones.
    pub valid: bool,
    /// Position, m.
    pub rho_lvlh: Vector3<f64>,
    /// Its rate in the turning axes, m/s.
    pub rho_dot_lvlh: Vector3<f64>,
}

impl MetrologySample {
    pub(super) fn not_due(&mut self) {
        self.due = false;
        self.valid = false;
    }
}

/// The sensor with its generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Metrology {
    sigma: Vector6<f64>,
    noise: Generator,
    faults: Faults,
}

impl Metrology {
    pub(super) fn new(sensor: &mission::Metrology, run: &Run) -> Self {
        Self {
            sigma: metrology::deviations(sensor.sigma_position_m, sensor.sigma_velocity_m_s),
            noise: stream(run.study_seed, run.run, Source::Metrology),
            faults: Faults::new(
                sensor.faults(),
                run,
                "metrology",
                run.mission.navigation.frame == Frame::Lvlh,
            ),
        }
    }

    pub(super) fn sample(&mut self, seen: &mut MetrologySample, scene: &Scene) {
        let unit = metrology::measure(&normal3(&mut self.noise), &normal3(&mut self.noise));
        let fault = self.faults.draw(scene.r_tc_n.norm());
        seen.due = true;
        seen.valid = !fault.dropped;
        let (Some((truth, _)), false) = (scene.metrology, fault.dropped) else {
            return;
        };
        let z = truth + unit.component_mul(&self.sigma) * fault.scale;
        seen.rho_lvlh = z.fixed_rows::<3>(0).into_owned();
        seen.rho_dot_lvlh = z.fixed_rows::<3>(3).into_owned();
    }
}
