//! `[navigation]`: what the filter is told; and [`Navigation`], the same resolved in full, which is all a filter sees.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::events::{Axes, Which};
use super::{AccelerometerOutput, BelievedSensors, Gravity, Mission, Sensor};

/// What the filter is told, as the file states it; what it leaves out is the world's.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NavigationSection {
    /// Gravity the filter believes in; absent: the world's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Gravity>,
    /// Frame of the filter's state.
    #[serde(default)]
    pub frame: Frame,
    /// Units in which it works and adapts.
    #[serde(default)]
    pub units: UnitsChoice,
    /// White acceleration density of the chaser, m2/s3.
    #[serde(default)]
    pub chaser_q_c_m2_s3: f64,
    /// Most Gauss-Newton passes of an update beyond the first, made where a correction is large beside the range; absent: 0 with
    /// an instantaneous accelerometer, as in the papers, else 8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub update_passes: Option<u32>,
    /// Semi-major axis of the circular orbit that Clohessy-Wiltshire is written about, m; absent: the target's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_orbit_a_m: Option<f64>,
    /// Where the filter's initial covariance differs from `initial_error`.
    #[serde(default)]
    pub p0: P0,
    /// Where its noises differ from those of the sensors.
    #[serde(default)]
    pub sensors: BelievedSensors,
    /// Size of what is unmodelled: laws derive their start values from it.
    #[serde(default)]
    pub scale: Scale,
    /// Start values of laws that are not derived: `"milton.r_w" = 1.0`.
    #[serde(default)]
    pub law: BTreeMap<String, f64>,
}

/// Frame of a filter's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Frame {
    /// Both vehicles in axes N.
    #[default]
    Inertial,
    /// The relative state in the target's LVLH axes, by Clohessy-Wiltshire about a reference orbit.
    Lvlh,
}

impl Frame {
    /// As a mission file says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertial => "inertial",
            Self::Lvlh => "lvlh",
        }
    }
}

/// Units in which a filter works and adapts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum UnitsChoice {
    /// Metres and seconds.
    #[default]
    Si,
    /// Characteristic length and time of the three-body problem.
    Cr3bp,
}

/// Standard deviations of an initial state, each absent where the file leaves it out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct P0 {
    /// Of the position per axis, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_position_m: Option<f64>,
    /// Of the velocity per axis, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_velocity_m_s: Option<f64>,
    /// Of the target's unmodelled acceleration per axis, m/s2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_acceleration_m_s2: Option<f64>,
    /// Of the accelerometer bias per axis, m/s2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_bias_m_s2: Option<f64>,
}

/// Size of what the filter's dynamics leave out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// A typical acceleration, m/s2.
    #[serde(default = "disturbance")]
    pub disturbance_m_s2: f64,
    /// How long it typically lasts, s.
    #[serde(default = "disturbance_time")]
    pub disturbance_time_s: f64,
}

fn disturbance() -> f64 {
    5e-6
}

fn disturbance_time() -> f64 {
    10.0
}

impl Default for Scale {
    fn default() -> Self {
        Self {
            disturbance_m_s2: disturbance(),
            disturbance_time_s: disturbance_time(),
        }
    }
}

/// Initial standard deviations per axis: of one vehicle, or of the relative state in the LVLH frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InitialSigma {
    /// Of its position, m.
    pub position: f64,
    /// Of its velocity, m/s.
    pub velocity: f64,
    /// Of the target's unmodelled acceleration, m/s2.
    pub acceleration: f64,
    /// Of the accelerometer bias, m/s2.
    pub bias: f64,
}

/// Length and time of one internal unit of a filter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Units {
    /// One internal length, m.
    pub length_m: f64,
    /// One internal time, s.
    pub time_s: f64,
}

/// A manoeuvre that the filter knows of; constant acceleration over its length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Whose it is.
    pub vehicle: Which,
    /// Begin, s since the start time.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Acceleration, m/s2, in `axes`.
    pub a_m_s2: [f64; 3],
    /// Axes of the acceleration.
    pub axes: Axes,
}

/// A sensor of the target as a filter knows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KnownSensor {
    /// Which.
    pub sensor: Sensor,
    /// Time between samples, s.
    pub period_s: f64,
    /// Standard deviations in the order of [`Sensor::sigmas`], SI and radians.
    pub sigmas: Vec<f64>,
}

impl KnownSensor {
    /// Standard deviation of each row, SI and radians.
    pub fn deviations(&self) -> impl Iterator<Item = f64> {
        self.sensor.by_row(&self.sigmas)
    }
}

/// An accelerometer as a filter knows it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KnownAccelerometer {
    /// Time between samples, s.
    pub period_s: f64,
    /// What a reading is.
    pub output: AccelerometerOutput,
    /// Of a sample, m/s2.
    pub sigma_m_s2: f64,
    /// That the bias walk gains in 1 s, m/s2.
    pub bias_sigma_m_s2: f64,
    /// Of the bias, s.
    pub bias_time_constant_s: f64,
    /// Readings of at least this norm drive the propagation, as does a mean that noise cannot account for, m/s2.
    pub gate_m_s2: f64,
}

/// Everything a filter is told of a mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Navigation {
    /// Name of the mission, for messages.
    pub mission: String,
    /// Length of a run, s.
    pub duration_s: f64,
    /// Gravity of both vehicles. Paths in it are absolute or start from the present folder.
    pub gravity: Gravity,
    /// The central body's turning, for a field in turning axes: epoch and rotation are those of the environment.
    pub body: super::Body,
    /// A stated rotation of body-fixed axes.
    pub rotation: Option<super::Rotation>,
    /// Date of the start, UTC.
    pub epoch_utc: Option<String>,
    /// Frame of the state.
    pub frame: Frame,
    /// Internal units.
    pub units: Units,
    /// White acceleration density of the chaser, m2/s3.
    pub chaser_q_c_m2_s3: f64,
    /// Most Gauss-Newton passes of an update beyond the first.
    pub update_passes: u32,
    /// Semi-major axis of the reference orbit, m; `None` where the mission gives no elements and states none.
    pub reference_orbit_a_m: Option<f64>,
    /// Initial standard deviations.
    pub p0: InitialSigma,
    /// Sensors of the target that are on board, in the order of [`Sensor::ALL`].
    pub sensors: Vec<KnownSensor>,
    /// Accelerometer.
    pub accelerometer: Option<KnownAccelerometer>,
    /// Manoeuvres that the filter knows of.
    pub told: Vec<Told>,
    /// Size of what is unmodelled.
    pub scale: Scale,
    /// Start values of laws by full name, in their own units.
    pub law: BTreeMap<String, f64>,
}

impl Navigation {
    /// Leaves out the burns of the chaser that a filter is told of, where they do not act.
    pub fn forget_burns_of_chaser(&mut self) {
        self.told.retain(|burn| burn.vehicle != Which::Chaser);
    }

    /// A sensor of the target; `None` when it is not on board.
    pub fn sensor(&self, sensor: Sensor) -> Option<&KnownSensor> {
        self.sensors.iter().find(|known| known.sensor == sensor)
    }

    /// A deviation of a sensor of the target, to be changed, by its place in [`Sensor::sigmas`]; `None` likewise.
    pub fn sigma_mut(&mut self, sensor: Sensor, place: usize) -> Option<&mut f64> {
        let known = self.sensors.iter_mut().find(|known| known.sensor == sensor);
        known?.sigmas.get_mut(place)
    }

    /// The start value that the mission states for a tunable, by full name.
    pub fn law(&self, name: &str) -> Option<f64> {
        self.law.get(name).copied()
    }
}

impl Mission {
    /// Standard deviations of the draw behind the initial estimate.
    pub fn initial_sigma(&self) -> InitialSigma {
        let e = &self.initial_error;
        // In the LVLH frame the initial estimate is a measurement of its own.
        let metrology = self.sensors.metrology.filter(|_| self.navigation.frame == Frame::Lvlh);
        let position = metrology.map_or(10.0, |m| m.sigma_position_m);
        let velocity = metrology.map_or(0.1, |m| m.sigma_velocity_m_s);
        let small = if metrology.is_some() { 0.0 } else { 1e-9 };
        InitialSigma {
            position: e.sigma_position_m.unwrap_or(position),
            velocity: e.sigma_velocity_m_s.unwrap_or(velocity),
            acceleration: e.sigma_acceleration_m_s2.unwrap_or(small),
            bias: e.sigma_bias_m_s2.unwrap_or(small),
        }
    }
}

/// A standard deviation of the bias when none is stated, so that a covariance is positive definite.
fn positive_or(value: f64, least: f64) -> f64 {
    if value > 0.0 { value } else { least }
}

pub(super) fn resolve(mission: &Mission) -> Navigation {
    let section = &mission.navigation;
    let believed = &section.sensors;
    let period = |own: Option<f64>| own.unwrap_or(mission.time.sample_period_s);
    let units = match (section.units, mission.environment.gravity.cr3bp()) {
        (UnitsChoice::Cr3bp, Some(problem)) => Units {
            length_m: problem.length_m,
            time_s: problem.time_s,
        },
        _ => Units {
            length_m: 1.0,
            time_s: 1.0,
        },
    };
    let drawn = mission.initial_sigma();
    let p0 = InitialSigma {
        position: section.p0.sigma_position_m.unwrap_or(drawn.position),
        velocity: section.p0.sigma_velocity_m_s.unwrap_or(drawn.velocity),
        acceleration: section
            .p0
            .sigma_acceleration_m_s2
            .unwrap_or_else(|| positive_or(drawn.acceleration, section.scale.disturbance_m_s2)),
        bias: section
            .p0
            .sigma_bias_m_s2
            .unwrap_or_else(|| positive_or(drawn.bias, 1e-9)),
    };
    let a_of = |v: &super::Vehicle| v.orbit.as_ref().and_then(|o| o.elements).map(|e| e.a_m);
    let mut gravity = section
        .gravity
        .clone()
        .unwrap_or_else(|| mission.environment.gravity.clone());
    if let Gravity::Harmonics(field) = &mut gravity {
        field.file = field.file.as_ref().map(|path| mission.locate(path));
    }
    Navigation {
        mission: mission.name.clone(),
        duration_s: mission.time.duration_s,
        gravity,
        body: mission.environment.body,
        rotation: mission.environment.rotation,
        epoch_utc: mission.time.epoch_utc.clone(),
        frame: section.frame,
        units,
        chaser_q_c_m2_s3: section.chaser_q_c_m2_s3,
        update_passes: section.update_passes.unwrap_or_else(|| {
            let output = mission.sensors.accelerometer.map(|a| a.output);
            if output == Some(AccelerometerOutput::Instantaneous) {
                0
            } else {
                8
            }
        }),
        reference_orbit_a_m: section
            .reference_orbit_a_m
            .or_else(|| a_of(&mission.target))
            .or_else(|| a_of(&mission.chaser)),
        p0,
        sensors: mission
            .sensors
            .of_the_target()
            .map(|own| KnownSensor {
                sensor: own.sensor,
                period_s: period(own.period_s),
                sigmas: (own.sensor.sigmas().iter().zip(&own.sigmas))
                    .zip(believed.of(own.sensor))
                    .map(|((sigma, own), believed)| sigma.quantity.to_si(believed.unwrap_or(*own)))
                    .collect(),
            })
            .collect(),
        accelerometer: mission.sensors.accelerometer.map(|s| KnownAccelerometer {
            period_s: period(s.period_s),
            output: s.output,
            sigma_m_s2: believed.accelerometer_sigma_m_s2.unwrap_or(s.sigma_m_s2),
            bias_sigma_m_s2: believed.accelerometer_bias_sigma_m_s2.unwrap_or(s.bias_sigma_m_s2),
            bias_time_constant_s: believed
                .accelerometer_bias_time_constant_s
                .unwrap_or(s.bias_time_constant_s),
            gate_m_s2: believed.accelerometer_gate_m_s2.unwrap_or(1e-4),
        }),
        told: mission
            .burns
            .iter()
            .filter(|burn| burn.told)
            .map(|burn| {
                let [x, y, z] = burn.direction;
                let size = burn.acceleration_m_s2 / (x * x + y * y + z * z).sqrt();
                Told {
                    vehicle: burn.vehicle,
                    start_s: burn.start_s,
                    duration_s: burn.duration_s,
                    a_m_s2: [x * size, y * size, z * size],
                    axes: burn.axes,
                }
            })
            .collect(),
        scale: section.scale,
        law: section.law.clone(),
    }
}
