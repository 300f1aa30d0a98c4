//! Samples of the chaser's sensors, with their noise and faults.

use astro::{TargetOrbit, frames};
use nalgebra::{Matrix3, Vector3, Vector6};
use numerics::{Generator, Source, stream};
use rand::RngExt;
use sensors::{accelerometer, lidar, metrology, normal3};
use serde::{Deserialize, Serialize};

use crate::Params;

/// What the LiDAR says of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct LidarSample {
    /// Whether the sample was received; if not, the other fields keep their last values.
    pub valid: bool,
    /// Range, m.
    pub range: f64,
    /// Azimuth, rad.
    pub azimuth: f64,
    /// Elevation, rad.
    pub elevation: f64,
}

/// What the metrology says of one sample: chaser minus target in LVLH axes of the target.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MetrologySample {
    /// Whether the sample was received; if not, the other fields keep their last values.
    pub valid: bool,
    /// Position, m.
    pub rho_lvlh: Vector3<f64>,
    /// Its rate in the turning axes, m/s.
    pub rho_dot_lvlh: Vector3<f64>,
}

impl Default for MetrologySample {
    fn default() -> Self {
        Self {
            valid: false,
            rho_lvlh: Vector3::zeros(),
            rho_dot_lvlh: Vector3::zeros(),
        }
    }
}

/// The newest sample of all sensors. An instrument that the world does not have is never valid, and its values are 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorSample {
    /// Ordinal, from 1; 0 before the first.
    pub count: u64,
    /// Epoch, s; 0 before the first.
    pub time: f64,
    /// LiDAR.
    pub lidar: LidarSample,
    /// Metrology.
    pub metrology: MetrologySample,
    /// The target's own orbit at the epoch, in worlds with metrology; that of the start time before the first sample.
    pub target_orbit: Option<TargetOrbit>,
    /// Accelerometer reading, chaser body axes, m/s2; 0 before the first sample.
    pub alpha_c_bc: Vector3<f64>,
    /// Attitude of the chaser at the epoch, maps N to body; that of the start time before the first sample.
    pub dcm_bc_n: Matrix3<f64>,
}

impl SensorSample {
    /// What the outputs show before the first sample.
    pub(crate) fn before_the_first(scene: &Scene) -> Self {
        Self {
            count: 0,
            time: 0.0,
            lidar: LidarSample::default(),
            metrology: MetrologySample::default(),
            target_orbit: scene.view.target_orbit(),
            alpha_c_bc: Vector3::zeros(),
            dcm_bc_n: scene.dcm_bc_n,
        }
    }
}

/// The truth at a sample's epoch.
pub(crate) struct Scene {
    /// The target, as the instrument sees it.
    pub view: View,
    /// Acceleration of the chaser beside gravity just after the epoch, N, m/s2.
    pub force_c_n: Vector3<f64>,
    /// Attitude of the chaser.
    pub dcm_bc_n: Matrix3<f64>,
    /// Accelerometer bias, chaser body axes, m/s2.
    pub b_c_bc: Vector3<f64>,
}

/// The target without noise.
pub(crate) enum View {
    /// To a LiDAR.
    Lidar {
        /// Target relative to chaser, N, m.
        r_tc_n: Vector3<f64>,
    },
    /// To metrology.
    Metrology {
        /// Relative state as `sensors::metrology` orders it.
        x_lvlh: Vector6<f64>,
        /// Orbit of the target.
        target_orbit: TargetOrbit,
    },
}

impl View {
    fn target_orbit(&self) -> Option<TargetOrbit> {
        match self {
            Self::Lidar { .. } => None,
            Self::Metrology { target_orbit, .. } => Some(*target_orbit),
        }
    }
}

/// The generators of the sensors, one for each cause. Every sample draws from each that the world's sensors need,
/// whatever the parameters, so that no setting moves the draws of another cause or of a later sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sensors {
    lidar: Generator,
    metrology: Generator,
    accelerometer: Generator,
    dropout: Generator,
    outlier: Generator,
}

impl Sensors {
    pub(crate) fn new(params: &Params) -> Self {
        let rng = |source| stream(params.study_seed.into(), params.run.into(), source);
        Self {
            lidar: rng(Source::Lidar),
            metrology: rng(Source::Metrology),
            accelerometer: rng(Source::Accelerometer),
            dropout: rng(Source::Dropout),
            outlier: rng(Source::Outlier),
        }
    }

    /// The sample after `last`, taken at `time`, s.
    pub(crate) fn sample(&mut self, params: &Params, last: &SensorSample, time: f64, scene: &Scene) -> SensorSample {
        let noise = normal3(&mut self.accelerometer) * params.accelerometer_sigma;
        let (mut lidar, mut metrology) = (last.lidar, last.metrology);
        match &scene.view {
            View::Lidar { r_tc_n } => lidar = self.lidar(params, &lidar, &(scene.dcm_bc_n * r_tc_n)),
            View::Metrology { x_lvlh, .. } => metrology = self.metrology(params, &metrology, x_lvlh),
        }
        SensorSample {
            count: last.count + 1,
            time,
            lidar,
            metrology,
            target_orbit: scene.view.target_orbit(),
            alpha_c_bc: accelerometer::reading(&scene.force_c_n, &scene.dcm_bc_n, &scene.b_c_bc, &noise),
            dcm_bc_n: scene.dcm_bc_n,
        }
    }

    /// `r_tc_bc`: target relative to chaser, chaser body axes, m.
    fn lidar(&mut self, params: &Params, last: &LidarSample, r_tc_bc: &Vector3<f64>) -> LidarSample {
        let unit = normal3(&mut self.lidar);
        let dropped = occurs(&mut self.dropout, params.lidar_dropout_probability);
        let outlier = occurs(&mut self.outlier, params.lidar_outlier_probability);
        let rho_l = frames::lidar_from_body() * r_tc_bc;
        if dropped || !lidar::in_view(&rho_l) {
            return LidarSample { valid: false, ..*last };
        }
        let sigma = Vector3::new(
            params.lidar_sigma_range,
            params.lidar_sigma_angle,
            params.lidar_sigma_angle,
        );
        let scale = if outlier { params.lidar_outlier_scale } else { 1.0 };
        let z = lidar::measure(&rho_l) + unit.component_mul(&sigma) * scale;
        LidarSample {
            valid: true,
            range: z[0],
            azimuth: z[1],
            elevation: z[2],
        }
    }

    fn metrology(&mut self, params: &Params, last: &MetrologySample, x_lvlh: &Vector6<f64>) -> MetrologySample {
        let unit = metrology::measure(&normal3(&mut self.metrology), &normal3(&mut self.metrology));
        let dropped = occurs(&mut self.dropout, params.metrology_dropout_probability);
        let outlier = occurs(&mut self.outlier, params.metrology_outlier_probability);
        if dropped {
            return MetrologySample { valid: false, ..*last };
        }
        let sigma = metrology::deviations(params.metrology_sigma_position, params.metrology_sigma_velocity);
        let scale = if outlier { params.metrology_outlier_scale } else { 1.0 };
        let z = x_lvlh + unit.component_mul(&sigma) * scale;
        MetrologySample {
            valid: true,
            rho_lvlh: z.fixed_rows::<3>(0).into_owned(),
            rho_dot_lvlh: z.fixed_rows::<3>(3).into_owned(),
        }
    }
}

fn occurs(generator: &mut Generator, probability: f64) -> bool {
    generator.random::<f64>() < probability
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(seen_from_body: [f64; 3]) -> Scene {
        Scene {
            view: View::Lidar {
                r_tc_n: seen_from_body.into(),
            },
            force_c_n: Vector3::zeros(),
            dcm_bc_n: Matrix3::identity(),
            b_c_bc: Vector3::zeros(),
        }
    }

    #[test]
    fn target_out_of_view_gives_no_measurement_but_a_sample() {
        let params = Params {
            lidar_sigma_range: 0.0,
            lidar_sigma_angle: 0.0,
            ..Params::default()
        };
        let mut sensors = Sensors::new(&params);
        let before = SensorSample::before_the_first(&scene([0.0, 20.0, 0.0]));
        // The boresight is body y; 1 in 20 is 2.9 degrees.
        let seen = sensors.sample(&params, &before, 1.0, &scene([0.0, 20.0, 0.0]));
        assert_eq!(
            seen.lidar,
            LidarSample {
                valid: true,
                range: 20.0,
                azimuth: 0.0,
                elevation: 0.0
            }
        );
        let lost = sensors.sample(&params, &seen, 2.0, &scene([1.0, 20.0, 0.0]));
        assert_eq!(
            lost.lidar,
            LidarSample {
                valid: false,
                ..seen.lidar
            }
        );
        assert_eq!((lost.count, lost.time), (2, 2.0));
        assert!(lost.alpha_c_bc != seen.alpha_c_bc, "the accelerometer goes on");
    }
}
