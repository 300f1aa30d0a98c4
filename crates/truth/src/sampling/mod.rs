//! Samples of the chaser's sensors, with their noise and faults: the accelerometer, and whatever sees the target.
//!
//! A sensor samples at whole multiples of its own period. Every sample draws from each stream of its sensor, whatever the
//! parameters, so that no setting moves the draws of another cause, of another sensor or of a later sample.

mod accelerometer;
mod faults;
mod of_target;

use std::ops::Index;

use astro::{LvlhAxes, TargetOrbit};
use interface::Sensor;
use interface::mission::AccelerometerOutput;
use interface::signals::Seen;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::overrides::Run;
use crate::untold::Untold;
use accelerometer::Accelerometer;
use of_target::OfTarget;

pub use accelerometer::AccelerometerSample;

/// Epochs this close are one, s.
const SAME: f64 = 1e-6;

/// The newest sample of all sensors. A sensor that is not on board is never due and its values are 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SensorSample {
    /// Ordinal among the epochs at which any sensor samples, from 1; 0 before the first.
    pub count: u64,
    /// Epoch, s; 0 before the first.
    pub time: f64,
    /// What each sensor of the target says, in the order of [`Sensor::ALL`].
    pub sensors: [Seen; Sensor::COUNT],
    /// Accelerometer.
    pub accelerometer: AccelerometerSample,
    /// The target's own orbit at the epoch, in missions with a sensor that measures in its axes; that of the start time before the first sample.
    pub target_orbit: Option<TargetOrbit>,
    /// The axes of that orbit, likewise.
    pub target_axes: Option<LvlhAxes>,
    /// Attitude of the chaser at the epoch, maps N to body; that of the start time before the first sample.
    pub dcm_bc_n: Matrix3<f64>,
    /// What no sensor measures and only a bound is told, up to the epoch.
    pub untold: Untold,
}

impl Index<Sensor> for SensorSample {
    type Output = Seen;

    fn index(&self, sensor: Sensor) -> &Seen {
        &self.sensors[sensor as usize]
    }
}

/// The truth at a sample's epoch, SI.
pub(crate) struct Scene {
    /// Where the target is.
    pub target: sensors::Scene,
    /// The target's orbit, where a sensor measures in its axes.
    pub target_orbit: Option<TargetOrbit>,
    /// Its axes, likewise.
    pub target_axes: Option<LvlhAxes>,
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

/// The sensors on board, with their clocks and generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sensors {
    of_target: Vec<(Clock, OfTarget)>,
    accelerometer: Option<(Clock, Accelerometer)>,
}

impl Sensors {
    pub(crate) fn new(run: &Run) -> Self {
        let clock = |own: Option<f64>| Clock::new(own.unwrap_or(run.mission.time.sample_period_s));
        let on_board = &run.mission.sensors;
        Self {
            of_target: (on_board.of_the_target())
                .map(|own| (clock(own.period_s), OfTarget::new(&own, run)))
                .collect(),
            accelerometer: (on_board.accelerometer).map(|own| (clock(own.period_s), Accelerometer::new(&own, run))),
        }
    }

    /// The next epoch at which any sensor samples, s since the start of the run.
    pub(crate) fn next(&self) -> f64 {
        let of_target = self.of_target.iter().map(|(clock, _)| clock.next());
        let all = of_target.chain(self.accelerometer.as_ref().map(|(clock, _)| clock.next()));
        all.fold(f64::INFINITY, f64::min)
    }

    /// Takes the sample after `sample`, at `time`, which is `elapsed` seconds after the start of the run.
    pub(crate) fn sample(&mut self, sample: &mut SensorSample, time: f64, elapsed: f64, scene: &Scene) {
        sample.count += 1;
        sample.time = time;
        for seen in &mut sample.sensors {
            (seen.due, seen.valid) = (false, false);
        }
        for (clock, of_target) in &mut self.of_target {
            if clock.due(elapsed) {
                clock.taken += 1;
                of_target.sample(&mut sample.sensors[of_target.sensor as usize], &scene.target);
            }
        }
        sample.accelerometer.valid = false;
        if let Some((clock, accelerometer)) = &mut self.accelerometer
            && clock.due(elapsed)
        {
            clock.taken += 1;
            accelerometer.sample(&mut sample.accelerometer, scene);
        }
        sample.target_orbit = scene.target_orbit;
        sample.target_axes = scene.target_axes;
        sample.dcm_bc_n = scene.dcm_bc_n;
    }
}

impl SensorSample {
    /// What the outputs show before the first sample.
    pub(crate) fn before_the_first(scene: &Scene) -> Self {
        Self {
            count: 0,
            time: 0.0,
            sensors: Default::default(),
            accelerometer: AccelerometerSample::default(),
            target_orbit: scene.target_orbit,
            target_axes: scene.target_axes,
            dcm_bc_n: scene.dcm_bc_n,
            untold: Untold::default(),
        }
    }
}

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

    /// Whether any measures in the axes of the target's orbit, so that someone has to tell it of them.
    pub(crate) fn measure_in_lvlh(&self) -> bool {
        self.of_target
            .iter()
            .any(|(_, of_target)| sensors::of(of_target.sensor).in_lvlh())
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::Params;
    use Sensor::{Camera, Lidar, Metrology, Radio};
    use nalgebra::Vector6;

    fn scene(seen_from_body: [f64; 3]) -> Scene {
        Scene {
            target: sensors::Scene {
                r_tc_n: seen_from_body.into(),
                v_tc_n: Vector3::zeros(),
                dcm_l_n: astro::frames::lidar_from_body(),
                lvlh: Vector6::repeat(f64::NAN),
            },
            target_orbit: None,
            target_axes: None,
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
        let first = Seen {
            due: true,
            valid: true,
            z: [20.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        };
        assert_eq!(seen[Lidar], first);
        assert_eq!(lost[Lidar], Seen { valid: false, ..first });
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
            .map(|s| (s[Lidar].valid, s[Camera].valid, s[Radio].valid))
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
                .all(|s| s[Lidar].due && s[Camera].due && s[Radio].due && !s[Metrology].due)
        );
        // 2 m along body x are 2 m along LiDAR y: elevation.
        assert!((seen[1][Camera].z[1] - 0.1_f64.atan()).abs() < 1e-15 && seen[1][Camera].z[0] == 0.0);
        assert_eq!(
            seen[3][Camera],
            Seen {
                valid: false,
                ..seen[1][Camera]
            }
        );
    }
}
