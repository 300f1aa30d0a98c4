//! The parameters of a run, named as in the FMU: what a user sets goes before what the mission file states.

use interface::Bound;
use interface::mission::{Embedded, Mission, embedded};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::TruthError;

/// What a user may set before a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Params {
    /// Which of the missions that come with the project, counted from 1 among those of the `scenario` enumeration.
    pub scenario: i32,
    /// Path of a mission file; empty: none, the scenario counts.
    pub mission_file: String,
    /// Seed of the whole study.
    pub study_seed: u32,
    /// Number of the run in the study.
    pub run: u32,
    /// Whether the mission's own burns of the chaser act.
    pub burn_enabled: bool,
    /// Forces of the formation.
    pub formation_forces: Forces,
    /// Values of [`PARAMETERS`], one list for each row.
    values: Vec<Vec<f64>>,
}

impl Default for Params {
    /// The first scenario, seed 1, run 0, and the start column of [`PARAMETERS`].
    fn default() -> Self {
        Self {
            scenario: 1,
            mission_file: String::new(),
            study_seed: 1,
            run: 0,
            burn_enabled: true,
            formation_forces: Forces::default(),
            values: PARAMETERS.iter().map(|row| vec![row.start; row.len]).collect(),
        }
    }
}

impl Params {
    /// Everything at its start but the scenario, counted from 1.
    pub fn of_scenario(scenario: i32) -> Self {
        let default = Self::default();
        Self { scenario, ..default }
    }

    /// Everything at its start but the mission file.
    pub fn of_file(path: impl Into<String>) -> Self {
        let mission_file = path.into();
        let default = Self::default();
        Self {
            mission_file,
            ..default
        }
    }

    /// Value of an element of a row of [`PARAMETERS`]; its start where there is no such element.
    pub fn value(&self, row: usize, element: usize) -> f64 {
        let stored = self.values.get(row).and_then(|values| values.get(element));
        stored
            .or(PARAMETERS.get(row).map(|r| &r.start))
            .copied()
            .unwrap_or_default()
    }

    /// Sets an element of a row of [`PARAMETERS`], unchecked.
    pub fn set_value(&mut self, row: usize, element: usize, value: f64) {
        if let Some(slot) = self.values.get_mut(row).and_then(|values| values.get_mut(element)) {
            *slot = value;
        }
    }

    /// Sets a parameter by its name, unchecked: one element of a vector as `name[1]`, all of them as `name`. False if there is
    /// none of that name.
    pub fn set(&mut self, name: &str, value: f64) -> bool {
        let (name, element) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
            Some((name, element)) => (name, element.parse::<usize>().ok()),
            None => (name, None),
        };
        let Some(row) = PARAMETERS.iter().position(|row| row.name == name) else {
            return false;
        };
        let Some(values) = self.values.get_mut(row) else {
            return false;
        };
        let places = match element {
            Some(element) => values.get_mut(element.wrapping_sub(1)..element).unwrap_or_default(),
            None => values.as_mut_slice(),
        };
        places.fill(value);
        !places.is_empty()
    }

    /// The mission that the file or the scenario names, changed by every parameter that is not left to it.
    ///
    /// # Errors
    /// When the mission cannot be read, does not exist, or a parameter is out of range.
    pub fn run(&self) -> Result<Run, TruthError> {
        let mission = if self.mission_file.is_empty() {
            self.scenario()?.mission()?
        } else {
            Mission::read(self.mission_file.as_ref())?
        };
        let mut run = Run {
            mission,
            study_seed: self.study_seed.into(),
            run: self.run.into(),
            vent_scale: 1.0,
            target_burn: TargetBurn::default(),
        };
        if !self.burn_enabled {
            run.mission
                .burns
                .retain(|burn| burn.vehicle == interface::mission::Which::Target);
        }
        if self.formation_forces == Forces::J2 && run.mission.name == "formation" {
            run.mission.environment = embedded("formation_j2")?.mission()?.environment;
        }
        for (row, values) in PARAMETERS.iter().zip(&self.values) {
            for (element, &value) in (1..).zip(values) {
                if !row.allows(value) {
                    let name = if row.len > 1 {
                        format!("{}[{element}]", row.name)
                    } else {
                        row.name.to_owned()
                    };
                    return Err(TruthError::Parameter {
                        name,
                        value,
                        allowed: row.words(),
                    });
                }
            }
            if !(row.own && values.iter().all(|v| *v == OWN)) {
                (row.apply)(&mut run, values);
            }
        }
        Ok(run)
    }

    fn scenario(&self) -> Result<&'static Embedded, TruthError> {
        let place = usize::try_from(i64::from(self.scenario) - 1).ok();
        place.and_then(|place| Embedded::scenarios().nth(place)).ok_or_else(|| {
            let names = Embedded::scenarios()
                .zip(1..)
                .map(|(entry, number)| format!("{number} ({})", entry.name));
            TruthError::Scenario {
                ordinal: self.scenario,
                known: names.collect::<Vec<_>>().join(", "),
            }
        })
    }
}

/// A mission with everything that a user has set.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The mission, changed by what was set.
    pub mission: Mission,
    /// Seed of the whole study.
    pub study_seed: u64,
    /// Number of the run.
    pub run: u64,
    /// Multiplies every vent.
    pub vent_scale: f64,
    /// A manoeuvre of the target that the filter is not told of.
    pub target_burn: TargetBurn,
}

/// A manoeuvre of the target, axes N.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TargetBurn {
    /// Begin, s since the start time.
    pub start: f64,
    /// Length, s.
    pub duration: f64,
    /// Acceleration, m/s2.
    pub a_t_n: Vector3<f64>,
}

/// What acts on both vehicles of the formation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Forces {
    /// Everything that the mission states.
    #[default]
    Full,
    /// The environment of `formation_j2`.
    J2,
}

impl Forces {
    /// Names and meanings, in the order of the variants.
    pub const ITEMS: &[(&str, &str)] = &[
        (
            "full",
            "gravity to degree and order 3, Sun and Moon, sunlight with the Earth's shadow, drag",
        ),
        ("j2", "two-body gravity and J2 alone"),
    ];

    /// From a place in [`Forces::ITEMS`], counted from 1; any other means the default.
    pub fn from_ordinal(ordinal: i32) -> Self {
        match ordinal {
            2 => Self::J2,
            _ => Self::default(),
        }
    }
}

/// The value that leaves a parameter to the mission.
pub const OWN: f64 = -1.0;

/// One real parameter: the row from which the FMU's variable, its check, its default and its effect are made.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Name of the FMI variable; without `[i]` if it is a vector.
    pub name: &'static str,
    /// Unit; empty for a plain number.
    pub unit: &'static str,
    /// Number of elements.
    pub len: usize,
    /// Default, of every element.
    pub start: f64,
    /// Accepted values, beside [`OWN`].
    pub bound: Bound,
    /// Whether [`OWN`], the start value then, means the mission's own value.
    pub own: bool,
    /// Meaning, one line.
    pub about: &'static str,
    apply: fn(&mut Run, &[f64]),
}

impl Parameter {
    fn allows(&self, value: f64) -> bool {
        self.bound.allows(value) || (self.own && value == OWN)
    }

    fn words(&self) -> String {
        let own = if self.own {
            ", or -1 for the mission's own value"
        } else {
            ""
        };
        format!("{}{own}", self.bound.words(self.unit))
    }
}

/// A parameter that changes one number of the mission; left at -1, the mission's own.
const fn own(
    name: &'static str,
    unit: &'static str,
    bound: Bound,
    about: &'static str,
    apply: fn(&mut Run, &[f64]),
) -> Parameter {
    Parameter {
        name,
        unit,
        len: 1,
        start: OWN,
        bound,
        own: true,
        about,
        apply,
    }
}

/// Changes a sensor where it is on board.
macro_rules! sensor {
    ($sensor:ident, |$s:ident, $v:ident| $body:expr) => {
        |run, v| {
            if let (Some($s), Some(&$v)) = (&mut run.mission.sensors.$sensor, v.first()) {
                $body;
            }
        }
    };
}

/// Changes the mission.
macro_rules! mission {
    (|$m:ident, $v:ident| $body:expr) => {
        |run, v| {
            let $m = &mut run.mission;
            if let Some(&$v) = v.first() {
                $body;
            }
        }
    };
}

use Bound::{Any, AtLeast, Fraction, NonNegative, Positive};

/// Every real parameter, in the order of the FMU's variables.
#[rustfmt::skip]
pub const PARAMETERS: &[Parameter] = &[
    own("sample_period", "s", AtLeast(1e-3),
        "sensor sampling of every sensor without a period of its own: sample k is taken at the start time plus k periods",
        mission!(|m, v| m.time.sample_period_s = v)),
    Parameter { name: "vent.scale", unit: "", len: 1, start: 1.0, bound: NonNegative, own: false,
        about: "multiplies every vent magnitude; 0 switches vents off",
        apply: |run, v| run.vent_scale = v.first().copied().unwrap_or(1.0) },
    own("lidar.sigma_range", "m", NonNegative, "standard deviation of the range noise per sample; 0: noise-free",
        sensor!(lidar, |s, v| s.sigma_range_m = v)),
    own("lidar.sigma_angle", "rad", NonNegative,
        "standard deviation of the azimuth and elevation noise per sample; 0: noise-free",
        sensor!(lidar, |s, v| s.sigma_angle_deg = v.to_degrees())),
    own("lidar.dropout_probability", "", Fraction, "probability that a LiDAR sample is missing",
        sensor!(lidar, |s, v| s.dropout_probability = v)),
    own("lidar.outlier_probability", "", Fraction, "probability that a LiDAR sample is an outlier",
        sensor!(lidar, |s, v| s.outlier_probability = v)),
    own("lidar.outlier_scale", "", NonNegative,
        "noise of an outlier in multiples of the standard deviation, on range and both angles",
        sensor!(lidar, |s, v| s.outlier_scale = v)),
    own("accelerometer.sigma", "m/s2", NonNegative, "standard deviation of the noise per sample and axis; 0: noise-free",
        sensor!(accelerometer, |s, v| s.sigma_m_s2 = v)),
    own("accelerometer.bias0", "m/s2", AtLeast(-0.5), "bias at the start time, on each body axis",
        sensor!(accelerometer, |s, v| s.bias0_m_s2 = [v; 3])),
    own("accelerometer.bias_sigma", "m/s2", NonNegative,
        "standard deviation that the bias walk gains in 1 s; grows with the square root of time",
        sensor!(accelerometer, |s, v| s.bias_sigma_m_s2 = v)),
    own("accelerometer.bias_time_constant", "s", Positive, "time constant with which the bias decays",
        sensor!(accelerometer, |s, v| s.bias_time_constant_s = v)),
    Parameter { name: "target_burn.start", unit: "s", len: 1, start: 0.0, bound: NonNegative, own: false,
        about: "begin of a manoeuvre of the target that the filter is not told of, counted from the start time",
        apply: |run, v| run.target_burn.start = v.first().copied().unwrap_or_default() },
    Parameter { name: "target_burn.duration", unit: "s", len: 1, start: 0.0, bound: NonNegative, own: false,
        about: "length of that manoeuvre; 0: none",
        apply: |run, v| run.target_burn.duration = v.first().copied().unwrap_or_default() },
    Parameter { name: "target_burn.a_t_n", unit: "m/s2", len: 3, start: 0.0, bound: Any, own: false,
        about: "acceleration of the target in that manoeuvre, axes N",
        apply: |run, v| if let &[x, y, z] = v { run.target_burn.a_t_n = Vector3::new(x, y, z) } },
    own("nav_init.sigma_position", "m", NonNegative,
        "initial position error of one vehicle (formation: of chaser minus target), standard deviation per axis",
        mission!(|m, v| m.initial_error.sigma_position_m = Some(v))),
    own("nav_init.sigma_velocity", "m/s", NonNegative,
        "initial velocity error of one vehicle (formation: of chaser minus target), standard deviation per axis",
        mission!(|m, v| m.initial_error.sigma_velocity_m_s = Some(v))),
    own("nav_init.sigma_acceleration", "m/s2", NonNegative,
        "initial error of the target's acceleration, standard deviation per axis; no effect in formation",
        mission!(|m, v| m.initial_error.sigma_acceleration_m_s2 = Some(v))),
    own("nav_init.sigma_bias", "m/s2", NonNegative,
        "initial error of the accelerometer bias, standard deviation per axis; no effect in formation",
        mission!(|m, v| m.initial_error.sigma_bias_m_s2 = Some(v))),
    own("metrology.sigma_position", "m", NonNegative,
        "standard deviation of the relative position noise per sample and axis; 0: noise-free",
        sensor!(metrology, |s, v| s.sigma_position_m = v)),
    own("metrology.sigma_velocity", "m/s", NonNegative,
        "standard deviation of the relative velocity noise per sample and axis; 0: noise-free",
        sensor!(metrology, |s, v| s.sigma_velocity_m_s = v)),
    own("metrology.dropout_probability", "", Fraction, "probability that a metrology sample is missing",
        sensor!(metrology, |s, v| s.dropout_probability = v)),
    own("metrology.outlier_probability", "", Fraction, "probability that a metrology sample is an outlier",
        sensor!(metrology, |s, v| s.outlier_probability = v)),
    own("metrology.outlier_scale", "", NonNegative,
        "noise of an outlier in multiples of the standard deviation, on all six components",
        sensor!(metrology, |s, v| s.outlier_scale = v)),
    own("target.mass", "kg", AtLeast(1e-3), "mass of the target, against which air and light push it",
        mission!(|m, v| m.target.mass_kg = v)),
    own("chaser.mass", "kg", AtLeast(1e-3), "mass of the chaser, against which air and light push it",
        mission!(|m, v| m.chaser.mass_kg = v)),
    own("camera.sigma_angle", "rad", NonNegative, "standard deviation of the camera's angles per sample; 0: noise-free",
        sensor!(camera, |s, v| s.sigma_angle_deg = v.to_degrees())),
    own("camera.dropout_probability", "", Fraction, "probability that a camera sample is missing",
        sensor!(camera, |s, v| s.dropout_probability = v)),
    own("camera.outlier_probability", "", Fraction, "probability that a camera sample is an outlier",
        sensor!(camera, |s, v| s.outlier_probability = v)),
    own("camera.outlier_scale", "", NonNegative,
        "noise of an outlier in multiples of the standard deviation, on both angles",
        sensor!(camera, |s, v| s.outlier_scale = v)),
    own("radio.sigma_range", "m", NonNegative, "standard deviation of the radio's range per sample; 0: noise-free",
        sensor!(radio, |s, v| s.sigma_range_m = v)),
    own("radio.sigma_range_rate", "m/s", NonNegative,
        "standard deviation of the radio's range rate per sample; 0: noise-free",
        sensor!(radio, |s, v| s.sigma_range_rate_m_s = v)),
    own("radio.dropout_probability", "", Fraction, "probability that a radio sample is missing",
        sensor!(radio, |s, v| s.dropout_probability = v)),
    own("radio.outlier_probability", "", Fraction, "probability that a radio sample is an outlier",
        sensor!(radio, |s, v| s.outlier_probability = v)),
    own("radio.outlier_scale", "", NonNegative,
        "noise of an outlier in multiples of the standard deviation, on range and range rate",
        sensor!(radio, |s, v| s.outlier_scale = v)),
];
