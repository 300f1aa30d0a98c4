//! Camera: two angles, in the axes of the LiDAR.

use astro::frames;
use interface::mission;
use numerics::Generator;
use numerics::streams::{Source, stream};
use sensors::{View, camera, normal3};
use serde::{Deserialize, Serialize};

use super::Scene;
use super::faults::Faults;
use crate::overrides::Run;

/// What the camera says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraSample {
    /// Whether it sampled at this epoch.
    pub due: bool,
    /// Whether the sample was received; if not, the values stay the last ones.
    pub valid: bool,
    /// Azimuth, rad.
    pub azimuth: f64,
    /// Elevation, rad.
    pub elevation: f64,
}

impl CameraSample {
    pub(super) fn not_due(&mut self) {
        self.due = false;
        self.valid = false;
    }
}

/// The sensor with its generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Camera {
    sigma: f64,
    view: View,
    noise: Generator,
    faults: Faults,
}

impl Camera {
    pub(super) fn new(sensor: &mission::Camera, run: &Run) -> Self {
        Self {
            sigma: sensor.sigma_angle_deg.to_radians(),
            view: View::of_width(sensor.field_of_view_deg.to_radians()),
            noise: stream(run.study_seed, run.run, Source::Camera),
            faults: Faults::new(sensor.faults(), run, "camera", false),
        }
    }

    pub(super) fn sample(&mut self, seen: &mut CameraSample, scene: &Scene) {
        let unit = normal3(&mut self.noise);
        let rho_l = frames::lidar_from_body() * (scene.dcm_bc_n * scene.r_tc_n);
        let fault = self.faults.draw(rho_l.norm());
        seen.due = true;
        seen.valid = !fault.dropped && self.view.holds(&rho_l);
        if !seen.valid {
            return;
        }
        let truth = camera::measure(&rho_l);
        let noise = unit * (self.sigma * fault.scale);
        seen.azimuth = truth[0] + noise[1];
        seen.elevation = truth[1] + noise[2];
    }
}
