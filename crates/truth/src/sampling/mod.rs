//! Samples of the chaser's sensors, with their noise and faults: one file for each sensor.
//!
//! A sensor samples at whole multiples of its own period. Every sample draws from each stream of its sensor, whatever the
//! parameters, so that no setting moves the draws of another cause, of another sensor or of a later sample.

mod accelerometer;
mod camera;
mod faults;
mod lidar;
mod metrology;
mod radio;

use astro::TargetOrbit;
use interface::mission::AccelerometerOutput;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::overrides::Run;

pub use accelerometer::AccelerometerSample;
pub use camera::CameraSample;
pub use lidar::LidarSample;
pub use metrology::MetrologySample;
pub use radio::RadioSample;

/// Epochs this close are one, s.
const SAME: f64 = 1e-6;

/// The newest sample of all sensors. A sensor that is not on board is never due and its values are 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorSample {
    /// Ordinal among the epochs at which any sensor samples, from 1; 0 before the first.
    pub count: u64,
    /// Epoch, s; 0 before the first.
    pub time: f64,
    /// LiDAR.
    pub lidar: LidarSample,
    /// Camera.
    pub camera: CameraSample,
    /// Radio link.
    pub radio: RadioSample,
    /// Metrology.
    pub metrology: MetrologySample,
    /// Accelerometer.
    pub accelerometer: AccelerometerSample,
    /// The target's own orbit at the epoch, in missions with metrology; that of the start time before the first sample.
    pub target_orbit: Option<TargetOrbit>,
    /// Attitude of the chaser at the epoch, maps N to body; that of the start time before the first sample.
    pub dcm_bc_n: Matrix3<f64>,
}

/// The truth at a sample's epoch.
pub(crate) struct Scene {
    /// Target relative to chaser, N, m.
    pub r_tc_n: Vector3<f64>,
    /// Its rate of change as seen in N, m/s.
    pub v_tc_n: Vector3<f64>,
    /// The relative state as metrology has it, and the target's orbit, where it is on board.
    pub metrology: Option<(nalgebra::Vector6<f64>, TargetOrbit)>,
    /// Acceleration of the chaser beside gravity just after the epoch, N, m/s2.
    pub force_c_n: Vector3<f64>,
    /// Mean of that in chaser body axes since the accelerometer's last sample, m/s2, where it measures the mean.
    pub mean_force_c_bc: Option<Vector3<f64>>,
    /// Attitude of the chaser.
    pub dcm_bc_n: Matrix3<f64>,
    /// Accelerometer bias, chaser body axes, m/s2.
    pub b_c_bc: Vector3<f64>,
}

/// When a sensor samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Clock {
    /// s.
    period: f64,
    /// Samples taken.
    taken: u64,
}

impl Clock {
    fn new(period: f64) -> Self {
        Self { period, taken: 0 }
    }

    /// Epoch of the next sample, s since the start of the run.
    fn next(&self) -> f64 {
        (self.taken + 1) as f64 * self.period
    }

    /// Whether the next sample falls on the epoch `elapsed`.
    fn due(&self, elapsed: f64) -> bool {
        (self.next() - elapsed).abs() <= SAME
    }
}

macro_rules! sensors {
    ($($name:ident: $kind:ident),* $(,)?) => {
        /// The sensors on board, with their clocks and generators.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub(crate) struct Sensors {
            $($name: Option<(Clock, $kind)>,)*
        }

        impl Sensors {
            pub(crate) fn new(run: &Run) -> Self {
                let period = |own: Option<f64>| own.unwrap_or(run.mission.time.sample_period_s);
                Self {
                    $($name: run
                        .mission
                        .sensors
                        .$name
                        .map(|sensor| (Clock::new(period(sensor.period_s)), $kind::new(&sensor, run))),)*
                }
            }

            /// The next epoch at which any sensor samples, s since the start of the run.
            pub(crate) fn next(&self) -> f64 {
                let epochs = [$(self.$name.as_ref().map(|(clock, _)| clock.next())),*];
                epochs.into_iter().flatten().fold(f64::INFINITY, f64::min)
            }

            /// Takes the sample after `sample`, at `time`, which is `elapsed` seconds after the start of the run.
            pub(crate) fn sample(&mut self, sample: &mut SensorSample, time: f64, elapsed: f64, scene: &Scene) {
                sample.count += 1;
                sample.time = time;
                $(match &mut self.$name {
                    Some((clock, sensor)) if clock.due(elapsed) => {
                        clock.taken += 1;
                        sensor.sample(&mut sample.$name, scene);
                    }
                    _ => sample.$name.not_due(),
                })*
                sample.target_orbit = scene.metrology.map(|(_, orbit)| orbit);
                sample.dcm_bc_n = scene.dcm_bc_n;
            }
        }

        impl SensorSample {
            /// What the outputs show before the first sample.
            pub(crate) fn before_the_first(scene: &Scene) -> Self {
                Self {
                    count: 0,
                    time: 0.0,
                    $($name: Default::default(),)*
                    target_orbit: scene.metrology.map(|(_, orbit)| orbit),
                    dcm_bc_n: scene.dcm_bc_n,
                }
            }
        }
    };
}

sensors! {
    lidar: Lidar,
    camera: Camera,
    radio: Radio,
    metrology: Metrology,
    accelerometer: Accelerometer,
}

use accelerometer::Accelerometer;
use camera::Camera;
use lidar::Lidar;
use metrology::Metrology;
use radio::Radio;

impl Sensors {
    /// Whether the accelerometer measures the mean, so that someone has to take it.
    pub(crate) fn measure_the_mean(&self) -> bool {
        let output = self.accelerometer.as_ref().map(|(_, a)| a.output());
        output == Some(AccelerometerOutput::Mean)
    }

    /// Whether the accelerometer samples at this epoch, s since the start of the run.
    pub(crate) fn accelerometer_due(&self, elapsed: f64) -> bool {
        self.accelerometer.as_ref().is_some_and(|(clock, _)| clock.due(elapsed))
    }

    /// Whether metrology is on board.
    pub(crate) fn have_metrology(&self) -> bool {
        self.metrology.is_some()
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::Params;

    fn scene(seen_from_body: [f64; 3]) -> Scene {
        Scene {
            r_tc_n: seen_from_body.into(),
            v_tc_n: Vector3::zeros(),
            metrology: None,
            force_c_n: Vector3::zeros(),
            mean_force_c_bc: None,
            dcm_bc_n: Matrix3::identity(),
            b_c_bc: Vector3::zeros(),
        }
    }

    /// Samples of noise-free sensors of these places, one a second.
    fn seen(extra: &str, places: &[[f64; 3]]) -> Vec<SensorSample> {
        let mut params = Params::of_scenario(1);
        for name in ["lidar.sigma_range", "lidar.sigma_angle"] {
            params.set(name, 0.0);
        }
        let mut run = params.run().unwrap();
        let text = interface::mission::embedded("leo_venting").unwrap().text;
        let text = text.replace("[initial_error]", &format!("{extra}\n[initial_error]"));
        let sensors = interface::mission::Mission::parse("m.toml", &text).unwrap().sensors;
        (run.mission.sensors.camera, run.mission.sensors.radio) = (sensors.camera, sensors.radio);
        let mut sensors = Sensors::new(&run);
        let mut sample = SensorSample::before_the_first(&scene(places[0]));
        let mut all = Vec::new();
        for (k, place) in (1..).zip(places) {
            let t = f64::from(k);
            sensors.sample(&mut sample, t, t, &scene(*place));
            all.push(sample);
        }
        all
    }

    #[test]
    fn target_out_of_view_gives_no_measurement_but_a_sample() {
        // The boresight is body y; 1 in 20 is 2.9 degrees.
        let [seen, lost] = seen("", &[[0.0, 20.0, 0.0], [1.0, 20.0, 0.0]])[..] else {
            panic!("two samples")
        };
        let first = LidarSample {
            due: true,
            valid: true,
            range: 20.0,
            azimuth: 0.0,
            elevation: 0.0,
        };
        assert_eq!(seen.lidar, first);
        assert_eq!(lost.lidar, LidarSample { valid: false, ..first });
        assert_eq!((lost.count, lost.time), (2, 2.0));
        assert!(
            lost.accelerometer.alpha_c_bc != seen.accelerometer.alpha_c_bc,
            "the accelerometer goes on"
        );
    }

    #[test]
    fn each_sensor_has_its_own_view_and_reach() {
        let sensors = "[sensors.camera]\nsigma_angle_deg = 0.0\nfield_of_view_deg = 20.0\nmax_range_m = 50.0\n[sensors.radio]\nsigma_range_m = 0.0\nsigma_range_rate_m_s = 0.0\nmax_range_m = 90.0";
        let seen = seen(
            sensors,
            &[
                [0.0, 20.0, 0.0],
                [2.0, 20.0, 0.0],
                [0.0, 60.0, 0.0],
                [0.0, -60.0, 0.0],
                [0.0, 100.0, 0.0],
            ],
        );
        let valid: Vec<_> = seen
            .iter()
            .map(|s| (s.lidar.valid, s.camera.valid, s.radio.valid))
            .collect();
        // Ahead; 5.7 deg off; out of the camera's reach; behind; out of the radio's.
        let expected = [
            (true, true, true),
            (false, true, true),
            (true, false, true),
            (false, false, true),
            (true, false, false),
        ];
        assert_eq!(valid, expected);
        assert!(
            seen.iter()
                .all(|s| s.lidar.due && s.camera.due && s.radio.due && !s.metrology.due)
        );
        // 2 m along body x are 2 m along LiDAR y: elevation.
        assert!((seen[1].camera.elevation - 0.1_f64.atan()).abs() < 1e-15 && seen[1].camera.azimuth == 0.0);
        assert_eq!(
            seen[3].camera,
            CameraSample {
                valid: false,
                ..seen[1].camera
            }
        );
    }
}
