//! Samples of the chaser's sensors, with their noise and faults.

use astro::frames;
use nalgebra::{Matrix3, Vector3};
use numerics::{Generator, Source, stream};
use rand::RngExt;
use sensors::{accelerometer, lidar, normal3};
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

/// The newest sample of all sensors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorSample {
    /// Ordinal, from 1; 0 before the first.
    pub count: u64,
    /// Epoch, s; 0 before the first.
    pub time: f64,
    /// LiDAR.
    pub lidar: LidarSample,
    /// Accelerometer reading, chaser body axes, m/s2; 0 before the first sample.
    pub alpha_c_bc: Vector3<f64>,
    /// Attitude of the chaser at the epoch, maps N to body; that of the start time before the first sample.
    pub dcm_bc_n: Matrix3<f64>,
}

impl SensorSample {
    /// What the outputs show before the first sample.
    pub(crate) fn before_the_first(dcm_bc_n: Matrix3<f64>) -> Self {
        Self {
            count: 0,
            time: 0.0,
            lidar: LidarSample::default(),
            alpha_c_bc: Vector3::zeros(),
            dcm_bc_n,
        }
    }
}

/// The truth at a sample's epoch.
pub(crate) struct Scene {
    /// Target relative to chaser, N, m.
    pub r_tc_n: Vector3<f64>,
    /// Acceleration of the chaser beside gravity just after the epoch, N, m/s2.
    pub force_c_n: Vector3<f64>,
    /// Attitude of the chaser.
    pub dcm_bc_n: Matrix3<f64>,
    /// Accelerometer bias, chaser body axes, m/s2.
    pub b_c_bc: Vector3<f64>,
}

/// The generators of the sensors, one for each cause. Every sample draws from each of them, whatever the parameters, so that
/// no setting moves the draws of another cause or of a later sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sensors {
    lidar: Generator,
    accelerometer: Generator,
    dropout: Generator,
    outlier: Generator,
}

impl Sensors {
    pub(crate) fn new(params: &Params) -> Self {
        let rng = |source| stream(params.study_seed.into(), params.run.into(), source);
        Self {
            lidar: rng(Source::Lidar),
            accelerometer: rng(Source::Accelerometer),
            dropout: rng(Source::Dropout),
            outlier: rng(Source::Outlier),
        }
    }

    /// The sample after `last`, taken at `time`, s.
    pub(crate) fn sample(&mut self, params: &Params, last: &SensorSample, time: f64, scene: &Scene) -> SensorSample {
        let noise = normal3(&mut self.accelerometer) * params.accelerometer_sigma;
        SensorSample {
            count: last.count + 1,
            time,
            lidar: self.lidar(params, &last.lidar, scene),
            alpha_c_bc: accelerometer::reading(&scene.force_c_n, &scene.dcm_bc_n, &scene.b_c_bc, &noise),
            dcm_bc_n: scene.dcm_bc_n,
        }
    }

    fn lidar(&mut self, params: &Params, last: &LidarSample, scene: &Scene) -> LidarSample {
        let unit = normal3(&mut self.lidar);
        let dropped = self.dropout.random::<f64>() < params.lidar_dropout_probability;
        let outlier = self.outlier.random::<f64>() < params.lidar_outlier_probability;
        let rho_l = frames::lidar_from_body() * scene.dcm_bc_n * scene.r_tc_n;
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
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(seen_from_body: [f64; 3]) -> Scene {
        Scene {
            r_tc_n: seen_from_body.into(),
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
        let before = SensorSample::before_the_first(Matrix3::identity());
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
