//! The parameters of a run, named as in the FMU: what a user sets goes before what the mission file states.

use std::borrow::Cow;
use std::sync::LazyLock;

use interface::mission::{Choice, Mission, Quantity, embedded};
use interface::{Bound, Sensor};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::TruthError;

/// What a user may set before a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Params {
    /// Which mission.
    pub choice: Choice,
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
            choice: Choice::default(),
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
        Self::of(Choice {
            scenario,
            ..Choice::default()
        })
    }

    /// Everything at its start but the mission file.
    pub fn of_file(path: impl Into<String>) -> Self {
        Self::of(Choice {
            mission_file: path.into(),
            ..Choice::default()
        })
    }

    fn of(choice: Choice) -> Self {
        Self {
            choice,
            ..Self::default()
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
        let mission = self.choice.mission()?;
        let mut run = Run {
            mission,
            study_seed: self.study_seed.into(),
            run: self.run.into(),
            vent_scale: VentScale::default(),
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
                        row.name.to_string()
                    };
                    return Err(TruthError::Parameter {
                        name,
                        value,
                        allowed: row.words(),
                    });
                }
            }
            if !(row.own && values.iter().all(|v| *v == OWN)) {
                row.apply(&mut run, values);
            }
        }
        Ok(run)
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
    pub vent_scale: VentScale,
    /// A manoeuvre of the target that the filter is not told of.
    pub target_burn: TargetBurn,
}

/// A factor on the size of vents, which may be another one for those that begin late.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VentScale {
    /// Of every vent.
    pub factor: f64,
    /// Of those that begin then or later, if it is another one.
    pub late: Option<f64>,
    /// s since the start of the run.
    pub late_from_s: f64,
}

impl Default for VentScale {
    fn default() -> Self {
        Self {
            factor: 1.0,
            late: None,
            late_from_s: 0.0,
        }
    }
}

impl VentScale {
    /// That of a vent which begins at `start`, s since the start of the run.
    pub fn at(&self, start: f64) -> f64 {
        self.late.filter(|_| start >= self.late_from_s).unwrap_or(self.factor)
    }
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
#[derive(Debug, Clone)]
pub struct Parameter {
    /// Name of the FMI variable; without `[i]` if it is a vector.
    pub name: Cow<'static, str>,
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
    pub about: Cow<'static, str>,
    effect: Effect,
}

/// What a parameter changes.
#[derive(Debug, Clone, Copy)]
enum Effect {
    /// Anything of a run.
    Run(fn(&mut Run, &[f64])),
    /// A number of a sensor of the target, by its key, where that is on board.
    Sensor(Sensor, &'static str),
}

impl Parameter {
    fn allows(&self, value: f64) -> bool {
        self.bound.allows(value) || (self.own && value == OWN)
    }

    fn apply(&self, run: &mut Run, values: &[f64]) {
        match self.effect {
            Effect::Run(apply) => apply(run, values),
            Effect::Sensor(sensor, key) => {
                let sigma = sensor.sigmas().iter().find(|sigma| sigma.key == key);
                let quantity = match key {
                    VIEW => Some(Quantity::Angle),
                    _ => sigma.map(|sigma| sigma.quantity),
                };
                if let (Some(place), Some(&value)) = (run.mission.sensors.place(sensor, key), values.first()) {
                    *place = quantity.map_or(value, |quantity| quantity.from_si(value));
                }
            }
        }
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
        name: Cow::Borrowed(name),
        unit,
        len: 1,
        start: OWN,
        bound,
        own: true,
        about: Cow::Borrowed(about),
        effect: Effect::Run(apply),
    }
}

/// Changes the accelerometer where it is on board.
macro_rules! accelerometer {
    (|$s:ident, $v:ident| $body:expr) => {
        |run, v| {
            if let (Some($s), Some(&$v)) = (&mut run.mission.sensors.accelerometer, v.first()) {
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

/// Every real parameter, in the order of the FMU's variables: those of the sensors of the target stand last.
pub static PARAMETERS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
    GENERAL
        .iter()
        .cloned()
        .chain(Sensor::ALL.into_iter().flat_map(of_sensor))
        .collect()
});

/// Those that are no sensor's.
#[rustfmt::skip]
const GENERAL: &[Parameter] = &[
    own("sample_period", "s", AtLeast(1e-3),
        "sensor sampling of every sensor without a period of its own: sample k is taken at the start time plus k periods",
        mission!(|m, v| m.time.sample_period_s = v)),
    Parameter { name: Cow::Borrowed("vent.scale"), unit: "", len: 1, start: 1.0, bound: NonNegative, own: false,
        about: Cow::Borrowed("multiplies every vent magnitude; 0 switches vents off"),
        effect: Effect::Run(|run, v| run.vent_scale.factor = v.first().copied().unwrap_or(1.0)) },
    own("accelerometer.sigma", "m/s2", NonNegative, "standard deviation of the noise per sample and axis; 0: noise-free",
        accelerometer!(|s, v| s.sigma_m_s2 = v)),
    own("accelerometer.bias0", "m/s2", AtLeast(-0.5), "bias at the start time, on each body axis",
        accelerometer!(|s, v| s.bias0_m_s2 = [v; 3])),
    own("accelerometer.bias_sigma", "m/s2", NonNegative,
        "standard deviation that the bias walk gains in 1 s; grows with the square root of time",
        accelerometer!(|s, v| s.bias_sigma_m_s2 = v)),
    own("accelerometer.bias_time_constant", "s", Positive, "time constant with which the bias decays",
        accelerometer!(|s, v| s.bias_time_constant_s = v)),
    Parameter { name: Cow::Borrowed("target_burn.start"), unit: "s", len: 1, start: 0.0, bound: NonNegative, own: false,
        about: Cow::Borrowed("begin of a manoeuvre of the target that the filter is not told of, counted from the start time"),
        effect: Effect::Run(|run, v| run.target_burn.start = v.first().copied().unwrap_or_default()) },
    Parameter { name: Cow::Borrowed("target_burn.duration"), unit: "s", len: 1, start: 0.0, bound: NonNegative, own: false,
        about: Cow::Borrowed("length of that manoeuvre; 0: none"),
        effect: Effect::Run(|run, v| run.target_burn.duration = v.first().copied().unwrap_or_default()) },
    Parameter { name: Cow::Borrowed("target_burn.a_t_n"), unit: "m/s2", len: 3, start: 0.0, bound: Any, own: false,
        about: Cow::Borrowed("acceleration of the target in that manoeuvre, axes N"),
        effect: Effect::Run(|run, v| if let &[x, y, z] = v { run.target_burn.a_t_n = Vector3::new(x, y, z) }) },
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
    own("target.mass", "kg", AtLeast(1e-3), "mass of the target, against which air and light push it",
        mission!(|m, v| m.target.mass_kg = v)),
    own("chaser.mass", "kg", AtLeast(1e-3), "mass of the chaser, against which air and light push it",
        mission!(|m, v| m.chaser.mass_kg = v)),
    Parameter { name: Cow::Borrowed("vent.scale_late"), unit: "", len: 1, start: OWN, bound: NonNegative, own: true,
        about: Cow::Borrowed("multiplies the magnitude of vents that begin at vent.late_from or later, in the place of vent.scale"),
        effect: Effect::Run(|run, v| run.vent_scale.late = v.first().copied()) },
    Parameter { name: Cow::Borrowed("vent.late_from"), unit: "s", len: 1, start: 0.0, bound: NonNegative, own: false,
        about: Cow::Borrowed("from when on vent.scale_late holds, counted from the start time"),
        effect: Effect::Run(|run, v| run.vent_scale.late_from_s = v.first().copied().unwrap_or_default()) },
    own("unmodelled.wander_sigma", "m/s2", NonNegative,
        "acceleration of the target that wanders and that no filter is told of, steady standard deviation per axis N; 0: none",
        mission!(|m, v| m.unmodelled.wander_sigma_m_s2 = v)),
    own("unmodelled.wander_time_constant", "s", Positive, "time constant with which it wanders",
        mission!(|m, v| m.unmodelled.wander_time_constant_s = v)),
    own("unmodelled.white", "m/s^1.5", NonNegative,
        "white acceleration of the target that no filter is told of, square root of its density per axis N; 0: none",
        mission!(|m, v| m.unmodelled.white_m_s1_5 = v)),
];

/// Key of the field of view in a sensor's table.
const VIEW: &str = "field_of_view_deg";

/// The parameters of one sensor of the target.
fn of_sensor(sensor: Sensor) -> impl Iterator<Item = Parameter> {
    let row = move |key: &'static str, name: &str, unit, bound, about| Parameter {
        name: format!("{}.{name}", sensor.name()).into(),
        unit,
        len: 1,
        start: OWN,
        bound,
        own: true,
        about: Cow::Owned(about),
        effect: Effect::Sensor(sensor, key),
    };
    let sigmas = sensor.sigmas().iter().map(move |sigma| {
        let about = format!("{} per sample; 0: noise-free", sigma.meaning());
        row(sigma.key, sigma.name(), sigma.quantity.unit(), NonNegative, about)
    });
    let word = sensor.word();
    let view = sensor.looks_ahead().then(|| {
        let about = format!("full width of the square field of view of the {word}");
        row(
            VIEW,
            "field_of_view",
            "rad",
            Bound::PositiveBelow(std::f64::consts::PI),
            about,
        )
    });
    let reach = row(
        "max_range_m",
        "max_range",
        "m",
        Bound::Positive,
        format!("distance beyond which the {word} sees nothing"),
    );
    let faults = [
        (
            "dropout_probability",
            Fraction,
            format!("probability that a {word} sample is missing"),
        ),
        (
            "outlier_probability",
            Fraction,
            format!("probability that a {word} sample is an outlier"),
        ),
        (
            "outlier_scale",
            NonNegative,
            "noise of an outlier in multiples of the standard deviation, on all channels".to_owned(),
        ),
    ];
    let faults = faults.map(|(key, bound, about)| row(key, key, "", bound, about));
    sigmas.chain(faults).chain(view).chain([reach])
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use interface::mission::Embedded;

    /// A mission with every sensor.
    fn mission() -> Mission {
        let text = embedded("leo_venting").unwrap().text;
        let absent = |sensor: &Sensor| !text.contains(&sensor.table());
        let tables: Vec<String> = Sensor::ALL.into_iter().filter(absent).map(Sensor::table).collect();
        let rest = format!("{}\n[initial_error]", tables.join("\n"));
        Mission::parse("all.toml", &text.replace("[initial_error]", &rest)).unwrap()
    }

    fn untouched() -> Run {
        Run {
            mission: mission(),
            study_seed: 1,
            run: 0,
            vent_scale: VentScale::default(),
            target_burn: TargetBurn::default(),
        }
    }

    #[test]
    fn every_row_reads_what_it_writes_and_no_other() {
        let elements = || {
            PARAMETERS
                .iter()
                .enumerate()
                .flat_map(|(row, p)| (0..p.len).map(move |i| (row, i)))
        };
        for (row, i) in elements() {
            let mut changed = Params::default();
            changed.set_value(row, i, 0.625);
            for (other, j) in elements() {
                let start = PARAMETERS[other].start;
                let expected = if (row, i) == (other, j) { 0.625 } else { start };
                assert_eq!(changed.value(other, j), expected, "{}[{i}]", PARAMETERS[row].name);
            }
            let name = PARAMETERS[row].name.as_ref();
            let name = if PARAMETERS[row].len > 1 {
                format!("{name}[{}]", i + 1)
            } else {
                name.to_owned()
            };
            let mut named = Params::default();
            assert!(named.set(&name, 0.625));
            assert_eq!(named, changed, "{name}");
        }
        for name in [
            "",
            "vent",
            "vent.scale[2]",
            "vent.scale[0]",
            "target_burn.a_t_n[4]",
            "target_burn.a_t_n[x",
        ] {
            let mut params = Params::of_scenario(1);
            assert!(!params.set(name, 1.0), "{name}");
            assert_eq!(params, Params::default());
        }
    }

    /// The keys of the mission that a parameter changes, as the mission's own text shows them.
    fn differences(a: &Run, b: &Run) -> Vec<String> {
        let lines = |run: &Run| {
            let text = run.mission.to_toml().unwrap();
            let mut section = String::new();
            let mut keys = std::collections::BTreeMap::new();
            for line in text.lines() {
                if line.starts_with('[') {
                    line.trim_matches(['[', ']']).clone_into(&mut section);
                } else if let Some((key, value)) = line.split_once(" = ") {
                    keys.insert(format!("{section}.{key}"), value.to_owned());
                }
            }
            keys.insert("vent_scale".into(), format!("{:?}", run.vent_scale));
            keys.insert("target_burn".into(), format!("{:?}", run.target_burn));
            keys
        };
        let (a, b) = (lines(a), lines(b));
        let keys: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).cloned().collect();
        keys.into_iter().filter(|key| a.get(key) != b.get(key)).collect()
    }

    /// The key that each row changes, by its name: nothing else of the mission moves.
    #[test]
    fn every_row_changes_what_it_says_and_nothing_else() {
        let before = untouched();
        for row in PARAMETERS.iter() {
            let mut run = before.clone();
            row.apply(&mut run, &vec![0.25; row.len]);
            let (owner, quantity) = row.name.split_once('.').unwrap_or(("time", &row.name));
            let expected = match (owner, quantity) {
                ("time", _) => "time.sample_period_s".to_owned(),
                ("vent", _) => "vent_scale".to_owned(),
                ("target_burn", _) => "target_burn".to_owned(),
                ("target" | "chaser", _) => format!("{owner}.mass_kg"),
                ("nav_init", _) => format!("initial_error.{quantity}_{}", row.unit.replace('/', "_")),
                ("unmodelled", "white") => "unmodelled.white_m_s1_5".to_owned(),
                ("unmodelled", _) => format!("unmodelled.{quantity}_{}", row.unit.replace('/', "_")),
                (_, "sigma_angle" | "field_of_view") => format!("sensors.{owner}.{quantity}_deg"),
                _ if row.unit.is_empty() => format!("sensors.{owner}.{quantity}"),
                _ => format!("sensors.{owner}.{quantity}_{}", row.unit.replace('/', "_")),
            };
            assert_eq!(differences(&before, &run), [expected], "{}", row.name);
        }
    }

    #[test]
    fn angles_are_radians_here_and_degrees_there() {
        let mut params = Params::of_scenario(1);
        params.set("lidar.sigma_angle", 0.01);
        let run = params.run().unwrap();
        assert!((run.mission.sensors.lidar.unwrap().sigma_angle_deg - 0.572_957_795_130_823).abs() < 1e-15);
    }

    #[test]
    fn parameters_left_alone_leave_the_mission_alone() {
        for (ordinal, entry) in (1..).zip(Embedded::scenarios()) {
            assert_eq!(
                Params::of_scenario(ordinal).run().unwrap().mission,
                entry.mission().unwrap()
            );
        }
    }

    #[test]
    fn burns_of_the_chaser_can_be_switched_off() {
        let mut params = Params::of_scenario(1);
        assert_eq!(params.run().unwrap().mission.burns.len(), 1);
        params.burn_enabled = false;
        assert!(params.run().unwrap().mission.burns.is_empty());
    }

    #[test]
    fn forces_of_the_formation_are_those_of_the_mission_with_j2_alone() {
        for (ordinal, _) in (1..).zip(Forces::ITEMS) {
            assert_eq!(Forces::from_ordinal(ordinal) as i32 + 1, ordinal);
        }
        assert_eq!(Forces::from_ordinal(0), Forces::Full);
        assert_eq!(Forces::from_ordinal(3), Forces::Full);
        let mut params = Params::of_scenario(3);
        params.formation_forces = Forces::J2;
        let set = params.run().unwrap().mission;
        let written = embedded("formation_j2").unwrap().mission().unwrap();
        assert_eq!(set.environment, written.environment);
        assert_eq!(
            (set.target, set.chaser, set.sensors),
            (written.target, written.chaser, written.sensors)
        );
        // It says nothing of other missions.
        let mut other = Params::of_scenario(1);
        other.formation_forces = Forces::J2;
        assert_eq!(other.run().unwrap(), Params::default().run().unwrap());
    }

    #[test]
    fn values_out_of_range_are_named_with_their_range() {
        let refused = |name: &str, value: f64| {
            let mut params = Params::of_scenario(1);
            assert!(params.set(name, value), "{name}");
            params.run().unwrap_err().to_string()
        };
        let own = ", or -1 for the mission's own value";
        let cases = [
            (
                "lidar.sigma_range",
                -0.5,
                "lidar.sigma_range is -0.5: it must be finite and at least 0 m",
                own,
            ),
            (
                "lidar.dropout_probability",
                1.5,
                "lidar.dropout_probability is 1.5: it must be between 0 and 1",
                own,
            ),
            (
                "accelerometer.bias_time_constant",
                0.0,
                "accelerometer.bias_time_constant is 0: it must be finite and above 0 s",
                own,
            ),
            (
                "nav_init.sigma_position",
                -2.0,
                "nav_init.sigma_position is -2: it must be finite and at least 0 m",
                own,
            ),
            (
                "vent.scale",
                -1.0,
                "vent.scale is -1: it must be finite and at least 0",
                "",
            ),
            (
                "sample_period",
                0.0,
                "sample_period is 0: it must be finite and at least 0.001 s",
                own,
            ),
            (
                "chaser.mass",
                0.0,
                "chaser.mass is 0: it must be finite and at least 0.001 kg",
                own,
            ),
            (
                "metrology.outlier_probability",
                -0.1,
                "metrology.outlier_probability is -0.1: it must be between 0 and 1",
                own,
            ),
            (
                "target_burn.a_t_n[3]",
                f64::NAN,
                "target_burn.a_t_n[3] is NaN: it must be a finite number",
                "",
            ),
        ];
        for (name, value, expected, own) in cases {
            assert_eq!(refused(name, value), format!("{expected}{own}"));
        }
        for row in PARAMETERS.iter() {
            for value in [f64::NAN, f64::INFINITY] {
                assert!(refused(&row.name, value).starts_with(row.name.as_ref()));
            }
        }
    }

    #[test]
    fn scenarios_are_the_entries_counted_from_one() {
        for ordinal in [0, -1, i32::MIN, Embedded::scenarios().count() as i32 + 1] {
            let error = Params::of_scenario(ordinal).run().unwrap_err().to_string();
            assert!(
                error.contains(&ordinal.to_string()) && error.contains("1 (leo_venting)"),
                "{error}"
            );
        }
    }
}
