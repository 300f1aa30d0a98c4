//! Flash LiDAR.

use astro::frames;
use interface::mission;
use nalgebra::Vector3;
use numerics::Generator;
use numerics::streams::{Source, stream};
use sensors::{View, lidar, normal3};
use serde::{Deserialize, Serialize};

use super::Scene;
use super::faults::Faults;
use crate::overrides::Run;

/// What the LiDAR says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct LidarSample {
    /// Whether it sampled at this epoch.
    pub due: bool,
    /// Whether the sample was received; if not, the values stay the last ones.
    pub valid: bool,
    /// Range, m.
    pub range: f64,
    /// Azimuth, rad.
    pub azimuth: f64,
    /// Elevation, rad.
    pub elevation: f64,
}

impl LidarSample {
    pub(super) fn not_due(&mut self) {
        self.due = false;
        self.valid = false;
    }
}

/// The sensor with its generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Lidar {
    sigma: Vector3<f64>,
    view: View,
    noise: Generator,
    faults: Faults,
}

impl Lidar {
    pub(super) fn new(sensor: &mission::Lidar, run: &Run) -> Self {
        let angle = sensor.sigma_angle_deg.to_radians();
        Self {
            sigma: Vector3::new(sensor.sigma_range_m, angle, angle),
            view: View::of_width(sensor.field_of_view_deg.to_radians()),
            noise: stream(run.study_seed, run.run, Source::Lidar),
            faults: Faults::new(sensor.faults(), run, "lidar", true),
        }
    }

    pub(super) fn sample(&mut self, seen: &mut LidarSample, scene: &Scene) {
        let unit = normal3(&mut self.noise);
        let rho_l = frames::lidar_from_body() * (scene.dcm_bc_n * scene.r_tc_n);
        let fault = self.faults.draw(rho_l.norm());
        seen.due = true;
        seen.valid = !fault.dropped && self.view.holds(&rho_l);
        if !seen.valid {
            return;
        }
        let z = lidar::measure(&rho_l) + unit.component_mul(&self.sigma) * fault.scale;
        (seen.range, seen.azimuth, seen.elevation) = (z[0], z[1], z[2]);
    }
}
