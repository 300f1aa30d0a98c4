//! The parameters of a world, named as in the FMU.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{Forces, Scenario, TruthError};

/// What a user may set before a run. Units and meanings stand in [`PARAMETERS`] and [`CHOICES`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct Params {
    /// Which world.
    pub scenario: Scenario,
    /// Seed of the whole study.
    pub study_seed: u32,
    /// Number of the run in the study.
    pub run: u32,
    pub sample_period: f64,
    pub vent_scale: f64,
    pub lidar_sigma_range: f64,
    pub lidar_sigma_angle: f64,
    pub lidar_dropout_probability: f64,
    pub lidar_outlier_probability: f64,
    pub lidar_outlier_scale: f64,
    pub accelerometer_sigma: f64,
    pub accelerometer_bias0: f64,
    pub accelerometer_bias_sigma: f64,
    pub accelerometer_bias_time_constant: f64,
    pub target_burn_start: f64,
    pub target_burn_duration: f64,
    pub target_burn_a_t_n: Vector3<f64>,
    pub nav_init_sigma_position: f64,
    pub nav_init_sigma_velocity: f64,
    pub nav_init_sigma_acceleration: f64,
    pub nav_init_sigma_bias: f64,
    pub metrology_sigma_position: f64,
    pub metrology_sigma_velocity: f64,
    pub metrology_dropout_probability: f64,
    pub metrology_outlier_probability: f64,
    pub metrology_outlier_scale: f64,
    pub target_mass: f64,
    pub chaser_mass: f64,
    pub formation_forces: Forces,
}

impl Default for Params {
    /// The first scenario, seed 1, run 0, the first of every choice, and the start column of [`PARAMETERS`].
    fn default() -> Self {
        let mut params = Self {
            scenario: Scenario::default(),
            study_seed: 1,
            run: 0,
            sample_period: 0.0,
            vent_scale: 0.0,
            lidar_sigma_range: 0.0,
            lidar_sigma_angle: 0.0,
            lidar_dropout_probability: 0.0,
            lidar_outlier_probability: 0.0,
            lidar_outlier_scale: 0.0,
            accelerometer_sigma: 0.0,
            accelerometer_bias0: 0.0,
            accelerometer_bias_sigma: 0.0,
            accelerometer_bias_time_constant: 0.0,
            target_burn_start: 0.0,
            target_burn_duration: 0.0,
            target_burn_a_t_n: Vector3::zeros(),
            nav_init_sigma_position: 0.0,
            nav_init_sigma_velocity: 0.0,
            nav_init_sigma_acceleration: 0.0,
            nav_init_sigma_bias: 0.0,
            metrology_sigma_position: 0.0,
            metrology_sigma_velocity: 0.0,
            metrology_dropout_probability: 0.0,
            metrology_outlier_probability: 0.0,
            metrology_outlier_scale: 0.0,
            target_mass: 0.0,
            chaser_mass: 0.0,
            formation_forces: Forces::default(),
        };
        for parameter in PARAMETERS {
            (parameter.values_mut)(&mut params).fill(parameter.start);
        }
        params
    }
}

impl Params {
    /// Holds every parameter against its bound.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for the first one outside its range, NaN and infinities included.
    pub fn check(&self) -> Result<(), TruthError> {
        for parameter in PARAMETERS {
            let values = (parameter.values)(self);
            if let Some(place) = values.iter().position(|&value| !parameter.bound.allows(value)) {
                let element = if values.len() > 1 {
                    format!("[{}]", place + 1)
                } else {
                    String::new()
                };
                return Err(TruthError::Parameter {
                    name: format!("{}{element}", parameter.name),
                    value: values[place],
                    allowed: parameter.bound.words(parameter.unit),
                });
            }
        }
        Ok(())
    }
}

/// Values that a parameter accepts; always finite ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Any.
    Any,
    /// This value or more.
    AtLeast(f64),
    /// More than zero.
    Positive,
    /// From 0 to 1.
    Probability,
    /// Zero or more, or exactly -1 for the scenario's own value.
    OwnOrNonNegative,
}

impl Bound {
    /// Whether `value` is accepted.
    #[allow(clippy::float_cmp)]
    pub fn allows(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::AtLeast(least) => value >= least,
                Self::Positive => value > 0.0,
                Self::Probability => (0.0..=1.0).contains(&value),
                Self::OwnOrNonNegative => value >= 0.0 || value == -1.0,
            }
    }

    fn words(self, unit: &str) -> String {
        match self {
            Self::Any => "a finite number".into(),
            Self::AtLeast(least) => format!("finite and at least {least} {unit}").trim_end().into(),
            Self::Positive => format!("finite and above 0 {unit}"),
            Self::Probability => "between 0 and 1".into(),
            Self::OwnOrNonNegative => format!("finite and at least 0 {unit}, or -1 for the scenario's own value"),
        }
    }
}

/// One real parameter: the row from which the FMU's variable, its check and its default are made.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Name of the FMI variable; without `[i]` if it is a vector.
    pub name: &'static str,
    /// Unit; empty for a plain number.
    pub unit: &'static str,
    /// Default, of every element.
    pub start: f64,
    /// Accepted values.
    pub bound: Bound,
    /// Meaning, one line.
    pub about: &'static str,
    /// Its elements: one, or three of a vector.
    pub values: fn(&Params) -> &[f64],
    /// Its elements, to be written unchecked.
    pub values_mut: fn(&mut Params) -> &mut [f64],
}

/// A field of [`Params`] as a slice.
trait Values {
    fn values(&self) -> &[f64];
    fn values_mut(&mut self) -> &mut [f64];
}

impl Values for f64 {
    fn values(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    fn values_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
}

impl Values for Vector3<f64> {
    fn values(&self) -> &[f64] {
        self.as_slice()
    }

    fn values_mut(&mut self) -> &mut [f64] {
        self.as_mut_slice()
    }
}

/// `field: name, unit, start, bound, meaning` for each row.
macro_rules! rows {
    ($($field:ident: $name:literal, $unit:literal, $start:expr, $bound:expr, $about:literal;)*) => {
        &[$(Parameter {
            name: $name,
            unit: $unit,
            start: $start,
            bound: $bound,
            about: $about,
            values: |p| p.$field.values(),
            values_mut: |p| p.$field.values_mut(),
        }),*]
    };
}

use Bound::{Any, AtLeast, OwnOrNonNegative, Positive, Probability};

/// Every real parameter, in the order of the FMU's variables.
pub const PARAMETERS: &[Parameter] = rows! {
    sample_period: "sample_period", "s", 1.0, AtLeast(1e-3),
        "sensor sampling: sample k is taken at the start time plus k periods";
    vent_scale: "vent.scale", "", 1.0, AtLeast(0.0),
        "multiplies every vent magnitude; 0 switches vents off; no effect in formation, where nothing vents";
    lidar_sigma_range: "lidar.sigma_range", "m", 0.08, AtLeast(0.0),
        "standard deviation of the range noise per sample; 0: noise-free";
    lidar_sigma_angle: "lidar.sigma_angle", "rad", 0.04 * std::f64::consts::PI / 180.0, AtLeast(0.0),
        "standard deviation of the azimuth and elevation noise per sample; 0: noise-free";
    lidar_dropout_probability: "lidar.dropout_probability", "", 0.0, Probability,
        "probability that a LiDAR sample is missing";
    lidar_outlier_probability: "lidar.outlier_probability", "", 0.0, Probability,
        "probability that a LiDAR sample is an outlier";
    lidar_outlier_scale: "lidar.outlier_scale", "", 10.0, AtLeast(0.0),
        "noise of an outlier in multiples of the standard deviation, on range and both angles";
    accelerometer_sigma: "accelerometer.sigma", "m/s2", 3.433e-6, AtLeast(0.0),
        "standard deviation of the noise per sample and axis; 0: noise-free";
    accelerometer_bias0: "accelerometer.bias0", "m/s2", 2.943e-6, Any,
        "bias at the start time, on each body axis";
    accelerometer_bias_sigma: "accelerometer.bias_sigma", "m/s2", 3.433e-8, AtLeast(0.0),
        "standard deviation that the bias walk gains in 1 s; grows with the square root of time";
    accelerometer_bias_time_constant: "accelerometer.bias_time_constant", "s", 3600.0, Positive,
        "time constant with which the bias decays";
    target_burn_start: "target_burn.start", "s", 0.0, AtLeast(0.0),
        "begin of a manoeuvre of the target that the filter is not told of, counted from the start time";
    target_burn_duration: "target_burn.duration", "s", 0.0, AtLeast(0.0),
        "length of that manoeuvre, rounded to the grid of the integration; 0: none";
    target_burn_a_t_n: "target_burn.a_t_n", "m/s2", 0.0, Any,
        "acceleration of the target in that manoeuvre, axes N";
    nav_init_sigma_position: "nav_init.sigma_position", "m", -1.0, OwnOrNonNegative,
        "initial position error of one vehicle (formation: of chaser minus target), standard deviation per axis; \
         -1: the scenario's own";
    nav_init_sigma_velocity: "nav_init.sigma_velocity", "m/s", -1.0, OwnOrNonNegative,
        "initial velocity error of one vehicle (formation: of chaser minus target), standard deviation per axis; \
         -1: the scenario's own";
    nav_init_sigma_acceleration: "nav_init.sigma_acceleration", "m/s2", -1.0, OwnOrNonNegative,
        "initial error of the target's acceleration, standard deviation per axis; -1: the scenario's own; no effect in \
         formation";
    nav_init_sigma_bias: "nav_init.sigma_bias", "m/s2", -1.0, OwnOrNonNegative,
        "initial error of the accelerometer bias, standard deviation per axis; -1: the scenario's own; no effect in \
         formation";
    metrology_sigma_position: "metrology.sigma_position", "m", 1e-2, AtLeast(0.0),
        "standard deviation of the relative position noise per sample and axis; 0: noise-free";
    metrology_sigma_velocity: "metrology.sigma_velocity", "m/s", 1e-4, AtLeast(0.0),
        "standard deviation of the relative velocity noise per sample and axis; 0: noise-free";
    metrology_dropout_probability: "metrology.dropout_probability", "", 0.0, Probability,
        "probability that a metrology sample is missing";
    metrology_outlier_probability: "metrology.outlier_probability", "", 0.0, Probability,
        "probability that a metrology sample is an outlier";
    metrology_outlier_scale: "metrology.outlier_scale", "", 10.0, AtLeast(0.0),
        "noise of an outlier in multiples of the standard deviation, on all six components";
    target_mass: "target.mass", "kg", 100.0, AtLeast(1e-3),
        "mass of the target, against which air and light push it in formation";
    chaser_mass: "chaser.mass", "kg", 100.0, AtLeast(1e-3),
        "mass of the chaser, against which air and light push it in formation";
};

/// One parameter whose values have names: the row from which the FMU's enumeration and its variable are made.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    /// Name of the FMI variable.
    pub name: &'static str,
    /// Name of its enumeration type.
    pub type_name: &'static str,
    /// Meaning, one line.
    pub about: &'static str,
    /// Names and meanings of the values; the first is the default.
    pub items: &'static [(&'static str, &'static str)],
    /// Place of the value in `items`, from 1.
    pub get: fn(&Params) -> i32,
    /// Sets the value at this place; a place that does not exist means the default.
    pub set: fn(&mut Params, i32),
}

/// Every parameter with named values beside the scenario, in the order of the FMU's variables.
pub const CHOICES: &[Choice] = &[Choice {
    name: "formation.forces",
    type_name: "Forces",
    about: "what acts on both vehicles in formation",
    items: Forces::ITEMS,
    get: |p| p.formation_forces as i32 + 1,
    set: |p, ordinal| p.formation_forces = Forces::from_ordinal(ordinal),
}];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_reads_what_it_writes_and_no_other() {
        let elements = || {
            PARAMETERS
                .iter()
                .flat_map(|row| (0..(row.values)(&Params::default()).len()).map(move |i| (row, i)))
        };
        for (row, i) in elements() {
            let mut changed = Params::default();
            (row.values_mut)(&mut changed)[i] = 0.625;
            for (other, j) in elements() {
                let expected = if (row.name, i) == (other.name, j) {
                    0.625
                } else {
                    other.start
                };
                let value = (other.values)(&changed)[j];
                assert!(
                    value.to_bits() == expected.to_bits(),
                    "{}[{i}] moves {}[{j}]",
                    row.name,
                    other.name
                );
            }
        }
    }

    #[test]
    fn every_choice_reads_what_it_writes() {
        for choice in CHOICES {
            let mut params = Params::default();
            assert_eq!((choice.get)(&params), 1, "{}", choice.name);
            for (ordinal, _) in (1..).zip(choice.items) {
                (choice.set)(&mut params, ordinal);
                assert_eq!((choice.get)(&params), ordinal, "{}", choice.name);
            }
            (choice.set)(&mut params, choice.items.len() as i32 + 1);
            assert_eq!((choice.get)(&params), 1, "{}", choice.name);
        }
    }

    #[test]
    fn values_out_of_range_are_named_with_their_range() {
        let refused = |name: &str, value: f64| {
            let row = PARAMETERS.iter().find(|row| row.name == name).unwrap();
            let mut params = Params::default();
            if let Some(last) = (row.values_mut)(&mut params).last_mut() {
                *last = value;
            }
            params.check().unwrap_err().to_string()
        };
        assert_eq!(
            refused("lidar.sigma_range", -0.5),
            "lidar.sigma_range is -0.5: it must be finite and at least 0 m"
        );
        assert_eq!(
            refused("lidar.dropout_probability", 1.5),
            "lidar.dropout_probability is 1.5: it must be between 0 and 1"
        );
        assert_eq!(
            refused("accelerometer.bias_time_constant", 0.0),
            "accelerometer.bias_time_constant is 0: it must be finite and above 0 s"
        );
        assert_eq!(
            refused("nav_init.sigma_position", -2.0),
            "nav_init.sigma_position is -2: it must be finite and at least 0 m, or -1 for the scenario's own value"
        );
        assert_eq!(
            refused("vent.scale", -1.0),
            "vent.scale is -1: it must be finite and at least 0"
        );
        assert_eq!(
            refused("sample_period", 0.0),
            "sample_period is 0: it must be finite and at least 0.001 s"
        );
        assert_eq!(
            refused("chaser.mass", 0.0),
            "chaser.mass is 0: it must be finite and at least 0.001 kg"
        );
        assert_eq!(
            refused("metrology.outlier_probability", -0.1),
            "metrology.outlier_probability is -0.1: it must be between 0 and 1"
        );
        assert_eq!(
            refused("target_burn.a_t_n", f64::NAN),
            "target_burn.a_t_n[3] is NaN: it must be a finite number"
        );
        for row in PARAMETERS {
            for value in [f64::NAN, f64::INFINITY] {
                assert!(refused(row.name, value).starts_with(row.name));
            }
        }
        assert!(Params::default().check().is_ok());
    }
}
