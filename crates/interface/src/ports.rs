//! The quantities that cross between models, each said once: name, unit, shape and meaning.
//!
//! Where truth and filter use the same name, output connects to input: equal names connect is the whole wiring rule.

use crate::mission::Sensor as Of;

/// Type of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A real number, SI or radians.
    Real,
    /// A whole number.
    Integer,
    /// A truth value.
    Boolean,
    /// An item of an enumeration of this name.
    Enumeration(&'static str),
    /// Text.
    String,
}

/// How many elements a port has; `name[1]` and `name[1,1]` are the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One.
    Scalar,
    /// A vector.
    Vector(usize),
    /// A matrix, row by row.
    Matrix(usize, usize),
}

impl Shape {
    /// Number of elements.
    pub fn len(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(n) => n,
            Self::Matrix(rows, columns) => rows * columns,
        }
    }

    /// Never: every port has an element.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}

/// Who offers a port and who reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// An output of the truth and an input of the filter.
    Sensor,
    /// An input of the truth that a filter may be told of, too: what the chaser is commanded to do.
    Command,
    /// An input of the truth alone that pushes the target.
    Disturbance,
    /// An input of the truth alone: how the chaser is to be turned.
    Attitude,
    /// An output of the truth that no filter may see.
    Truth,
    /// An output of the truth, as of the newest sample, that a bound is told of and every other filter passes by.
    Untold,
    /// An output of the filter.
    Estimate,
}

/// A quantity that crosses between models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// Name of the FMI variable, without `[i]`.
    pub name: &'static str,
    /// Type.
    pub kind: Kind,
    /// Units: one for all elements, one for each, or one for each group of three; `1` for none.
    pub units: &'static [&'static str],
    /// Elements.
    pub shape: Shape,
    /// Meanings: one for all elements, one for each, or one for each group of three.
    pub about: &'static [&'static str],
    /// Who offers and who reads it.
    pub role: Role,
    /// Which part of what a sensor of the target says, or of what a filter makes of it; `None` for anything else.
    pub part: Option<(Of, Part)>,
}

/// Part of what a sensor of the target says at an epoch, and of what a filter makes of that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Whether it samples.
    Due,
    /// Whether it saw the target.
    Valid,
    /// What it measured: rows from this one on.
    Measured(usize),
    /// Measured minus predicted, likewise.
    Innovation(usize),
    /// Predicted variances of those.
    Variance(usize),
}

impl Port {
    /// Unit of an element; empty for none.
    pub fn unit(&self, element: usize) -> &'static str {
        self.pick(self.units, element)
    }

    /// Meaning of an element.
    pub fn about(&self, element: usize) -> &'static str {
        self.pick(self.about, element)
    }

    /// Order of magnitude of an element, SI: of a distance between the vehicles 1 km, of one from a planet 10,000 km, of what is not
    /// known of both a ten-thousandth of the former.
    pub fn nominal(&self, element: usize) -> f64 {
        let name = self.name;
        let state = matches!(name, "nav_init.x" | "cov.sigma").then_some(element / 3);
        let absolute = name.ends_with(".r_c_n") || name.ends_with(".v_c_n") || matches!(state, Some(3 | 4));
        let unsure = ["cov.", "pred.sigma", "innov."]
            .iter()
            .any(|begin| name.starts_with(begin));
        let size = match (self.unit(element), absolute) {
            ("m", true) => 1e7,
            ("m", false) if name == "target_orbit.r" => 1e7,
            ("m", false) => 1e3,
            ("m/s", true) => 1e4,
            ("m2/s", _) if name == "target_orbit.h" => 5e10,
            ("m/s2", _) => 1e-5,
            ("m/s^2.5", _) => 1e-6,
            ("rad", _) => 0.1,
            ("rad/s", _) => 1e-3,
            ("s", _) => 1e3,
            // Variances and covariances, by what their units are made of.
            ("m2", _) => return 1e-2,
            ("m2/s", _) => return 1e-5,
            ("m2/s2", _) => return 1e-8,
            ("m2/s3", _) => return 1e-10,
            ("m2/s4", _) => return 1e-12,
            ("rad2", _) => return 1e-7,
            _ => 1.0,
        };
        if unsure { size * 1e-4 } else { size }
    }

    /// Whether it may hold anything, NaN included, while another port says that it is not valid.
    pub fn at_times_invalid(&self) -> bool {
        matches!(self.part, Some((_, Part::Measured(_)))) || self.name == "accelerometer.alpha_c_bc"
    }

    fn pick(&self, list: &'static [&'static str], element: usize) -> &'static str {
        let group = if list.len() == self.shape.len() { 1 } else { 3 };
        list.get(element / group).or(list.first()).copied().unwrap_or_default()
    }
}

/// The port of this name.
pub fn port(name: &str) -> Option<&'static Port> {
    PORTS.iter().find(|port| port.name == name)
}

/// The ports of a role, in order.
pub fn of(role: Role) -> impl Iterator<Item = &'static Port> {
    PORTS.iter().filter(move |port| port.role == role)
}

const fn row(
    role: Role,
    name: &'static str,
    kind: Kind,
    shape: Shape,
    units: &'static [&'static str],
    about: &'static [&'static str],
) -> Port {
    Port {
        name,
        kind,
        units,
        shape,
        about,
        role,
        part: None,
    }
}

/// Whether a sensor samples.
const fn due(of: Of, name: &'static str, about: &'static [&'static str]) -> Port {
    let port = row(Role::Sensor, name, Kind::Boolean, Shape::Scalar, &[], about);
    Port {
        part: Some((of, Part::Due)),
        ..port
    }
}

/// Whether it saw the target.
const fn valid(of: Of, name: &'static str, about: &'static [&'static str]) -> Port {
    let port = row(Role::Sensor, name, Kind::Boolean, Shape::Scalar, &[], about);
    Port {
        part: Some((of, Part::Valid)),
        ..port
    }
}

/// Some of its rows, from `first` on, or their innovations or variances.
const fn rows(
    of: Of,
    part: Part,
    name: &'static str,
    shape: Shape,
    units: &'static [&'static str],
    about: &'static [&'static str],
) -> Port {
    let role = match part {
        Part::Innovation(_) | Part::Variance(_) => Role::Estimate,
        Part::Due | Part::Valid | Part::Measured(_) => Role::Sensor,
    };
    let port = row(role, name, Kind::Real, shape, units, about);
    Port {
        part: Some((of, part)),
        ..port
    }
}

use Kind::{Boolean, Enumeration, Integer, Real};
use Part::{Innovation, Measured, Variance};
use Role::{Attitude, Command, Disturbance, Estimate, Sensor, Truth, Untold};
use Shape::{Matrix, Scalar, Vector};

/// Units of the 18 states, by groups of three.
const STATES: &[&str] = &["m", "m/s", "m/s2", "m", "m/s", "m/s2"];

/// Units of a covariance of position, velocity and acceleration, 9x9, by groups of three along its rows.
#[rustfmt::skip]
const COVARIANCE: &[&str] = &[
    "m2", "m2/s", "m2/s2", "m2", "m2/s", "m2/s2", "m2", "m2/s", "m2/s2",
    "m2/s", "m2/s2", "m2/s3", "m2/s", "m2/s2", "m2/s3", "m2/s", "m2/s2", "m2/s3",
    "m2/s2", "m2/s3", "m2/s4", "m2/s2", "m2/s3", "m2/s4", "m2/s2", "m2/s3", "m2/s4",
];

/// Every port.
#[rustfmt::skip]
pub const PORTS: &[Port] = &[
    row(Command, "a_cmd_c_n", Real, Vector(3), &["m/s2"],
        &["extra acceleration of the chaser, axes N; acts from the communication point at which it is set for as long as it stays, and the accelerometer feels it"]),
    row(Command, "impulse_c_n", Real, Vector(3), &["m/s"],
        &["change of the chaser's velocity, axes N, made at once at each change of impulse_count; a mean of the accelerometer has it, a reading of the instant has not"]),
    row(Command, "impulse_count", Integer, Scalar, &[],
        &["ordinal of that change; its value after initialization is where counting begins"]),
    row(Disturbance, "a_dist_t_n", Real, Vector(3), &["m/s2"],
        &["extra acceleration of the target, axes N; acts as a_cmd_c_n does"]),
    row(Disturbance, "f_dist_t_bt", Real, Vector(3), &["N"],
        &["extra force on the target, its body axes, against its mass, as of a vent by mass flow and exhaust velocity; acts as a_cmd_c_n does"]),
    row(Attitude, "dcm_cmd_bc_n", Real, Matrix(3, 3), &["1"],
        &["attitude that the chaser holds: direction cosine matrix from axes N to its body axes; all 0: the mission's own"]),

    row(Sensor, "sample_time", Real, Scalar, &["s"], &["epoch of the newest sensor sample; 0 before the first"]),
    row(Sensor, "sample_count", Integer, Scalar, &[], &["ordinal of the newest sensor sample; 0 before the first"]),
    valid(Of::Lidar, "lidar.valid",
        &["whether the LiDAR saw the target; if not, range and angles keep their last values"]),
    rows(Of::Lidar, Measured(0), "lidar.range", Scalar, &["m"], &["measured distance from chaser to target"]),
    rows(Of::Lidar, Measured(1), "lidar.azimuth", Scalar, &["rad"], &["measured angle atan(rho_x / rho_z) in LiDAR axes"]),
    rows(Of::Lidar, Measured(2), "lidar.elevation", Scalar, &["rad"], &["measured angle atan(rho_y / rho_z) in LiDAR axes"]),
    row(Sensor, "accelerometer.alpha_c_bc", Real, Vector(3), &["m/s2"],
        &["accelerometer reading, chaser body axes: the acceleration just after the epoch (inputs: as they stood over the step that ended), or the mean since the last sample in axes as they are at this one"]),
    row(Sensor, "dcm_bc_n", Real, Matrix(3, 3), &["1"],
        &["attitude of the chaser at the epoch: direction cosine matrix from axes N to chaser body axes"]),
    valid(Of::Metrology, "metrology.valid",
        &["whether the metrology saw the target; if not, its measurement keeps the last values"]),
    rows(Of::Metrology, Measured(0), "metrology.rho_lvlh", Vector(3), &["m"],
        &["measured position of the chaser relative to the target, LVLH axes of the target"]),
    rows(Of::Metrology, Measured(3), "metrology.rho_dot_lvlh", Vector(3), &["m/s"],
        &["measured rate of that position as seen in the turning LVLH axes"]),
    row(Sensor, "target_orbit.r", Real, Scalar, &["m"],
        &["distance of the target from the central body at the epoch, as known on board; with metrology"]),
    row(Sensor, "target_orbit.r_dot", Real, Scalar, &["m/s"], &["rate of that distance; with metrology"]),
    row(Sensor, "target_orbit.h", Real, Scalar, &["m2/s"],
        &["angular momentum of the target per unit mass; with metrology"]),
    row(Sensor, "target_orbit.inclination", Real, Scalar, &["rad"],
        &["inclination of the target's orbit; with metrology"]),
    row(Sensor, "target_orbit.argument_of_latitude", Real, Scalar, &["rad"],
        &["angle from the ascending node to the target, in (-pi, pi]; with metrology"]),
    row(Sensor, "target_orbit.raan", Real, Scalar, &["rad"],
        &["right ascension of the ascending node, in (-pi, pi], against axes N; with metrology"]),
    row(Sensor, "dcm_lvlh_n", Real, Matrix(3, 3), &["1"],
        &["direction cosine matrix from axes N to the target's LVLH axes at the epoch, as known on board; with metrology, else 0"]),
    row(Sensor, "omega_lvlh", Real, Vector(3), &["rad/s"],
        &["angular rate of the target's LVLH axes against N, in them; with metrology"]),
    row(Sensor, "nav_init.x", Real, Vector(18), STATES, &[
        "initial estimate drawn around the truth: position of the target relative to the chaser, axes N; in the LVLH frame as \
         metrology.rho_lvlh",
        "initial estimate drawn around the truth: velocity of the target relative to the chaser, axes N; in the LVLH frame as \
         metrology.rho_dot_lvlh",
        "initial estimate drawn around the truth: unmodelled acceleration of the target, axes N; in the LVLH frame 0",
        "initial estimate drawn around the truth: position of the chaser, axes N; in the LVLH frame 0",
        "initial estimate drawn around the truth: velocity of the chaser, axes N; in the LVLH frame 0",
        "initial estimate drawn around the truth: accelerometer bias, chaser body axes; in the LVLH frame 0",
    ]),
    row(Sensor, "accelerometer.valid", Boolean, Scalar, &[], &["whether the accelerometer measured at this epoch"]),
    row(Sensor, "accelerometer.mean", Boolean, Scalar, &[],
        &["whether its reading is the mean since its last sample rather than the instant after the epoch"]),
    due(Of::Lidar, "lidar.due", &["whether the LiDAR samples at this epoch; due and not valid is a dropout"]),
    due(Of::Metrology, "metrology.due", &["whether the metrology samples at this epoch"]),
    due(Of::Camera, "camera.due", &["whether the camera samples at this epoch"]),
    valid(Of::Camera, "camera.valid",
        &["whether the camera saw the target; if not, its angles keep their last values"]),
    rows(Of::Camera, Measured(0), "camera.azimuth", Scalar, &["rad"], &["measured angle atan(rho_x / rho_z) in LiDAR axes"]),
    rows(Of::Camera, Measured(1), "camera.elevation", Scalar, &["rad"], &["measured angle atan(rho_y / rho_z) in LiDAR axes"]),
    due(Of::Radio, "radio.due", &["whether the radio link samples at this epoch"]),
    valid(Of::Radio, "radio.valid",
        &["whether the radio link measured; if not, range and rate keep their last values"]),
    rows(Of::Radio, Measured(0), "radio.range", Scalar, &["m"], &["measured distance from chaser to target"]),
    rows(Of::Radio, Measured(1), "radio.range_rate", Scalar, &["m/s"], &["measured rate of that distance"]),

    row(Truth, "truth.r_tc_n", Real, Vector(3), &["m"], &["true position of the target relative to the chaser, axes N"]),
    row(Truth, "truth.v_tc_n", Real, Vector(3), &["m/s"], &["true velocity of the target relative to the chaser, axes N"]),
    row(Truth, "truth.a_t_n", Real, Vector(3), &["m/s2"],
        &["true acceleration of the target by vents, burns, a_dist_t_n and f_dist_t_bt, axes N, just after this time (inputs: as they stood over the step that ended)"]),
    row(Truth, "truth.r_c_n", Real, Vector(3), &["m"], &["true position of the chaser, axes N"]),
    row(Truth, "truth.v_c_n", Real, Vector(3), &["m/s"], &["true velocity of the chaser, axes N"]),
    row(Truth, "truth.b_c_bc", Real, Vector(3), &["m/s2"], &["true accelerometer bias, chaser body axes"]),
    row(Truth, "truth.rho_lvlh", Real, Vector(3), &["m"],
        &["true position of the chaser relative to the target, LVLH axes of the target; with metrology"]),
    row(Truth, "truth.rho_dot_lvlh", Real, Vector(3), &["m/s"],
        &["true rate of that position as seen in the turning LVLH axes; with metrology"]),
    row(Truth, "truth.d_lvlh", Real, Vector(3), &["m/s2"],
        &["true relative acceleration less that of Clohessy-Wiltshire motion, LVLH axes, just after this time; with metrology"]),

    row(Truth, "truth.event_active", Boolean, Scalar, &[],
        &["whether a vent, or a burn or input that no filter is told of, pushes the target just after this time"]),

    row(Untold, "truth.dv_t_n", Real, Vector(3), &["m/s"],
        &["integral of what truth.a_t_n holds and no filter is told of, axes N, from the start to the newest sample"]),
    row(Untold, "truth.event_time", Real, Scalar, &["s"],
        &["time in which truth.event_active held, from the start to the newest sample; -1 where nobody says"]),

    row(Estimate, "est.time", Real, Scalar, &["s"], &["epoch of the sample last used; before the first, the start time"]),
    row(Estimate, "est.count", Integer, Scalar, &[], &["ordinal of the sample last used"]),
    row(Estimate, "est.dimension", Integer, Scalar, &[],
        &["states with a covariance: relative position and velocity, and acceleration where it is estimated"]),
    row(Estimate, "est.r_tc_n", Real, Vector(3), &["m"],
        &["target relative to chaser, position, axes N; before the first sample that of nav_init.x; in the LVLH frame through dcm_lvlh_n"]),
    row(Estimate, "est.v_tc_n", Real, Vector(3), &["m/s"],
        &["target relative to chaser, velocity, axes N; in the LVLH frame through dcm_lvlh_n and omega_lvlh"]),
    row(Estimate, "est.a_t_n", Real, Vector(3), &["m/s2"], &["unmodelled acceleration of the target, axes N"]),
    row(Estimate, "est.r_c_n", Real, Vector(3), &["m"], &["chaser position (consider state), axes N"]),
    row(Estimate, "est.v_c_n", Real, Vector(3), &["m/s"], &["chaser velocity (consider state), axes N"]),
    row(Estimate, "est.b_c_bc", Real, Vector(3), &["m/s2"], &["accelerometer bias, chaser body axes"]),
    row(Estimate, "est.rho_lvlh", Real, Vector(3), &["m"], &["chaser relative to target, position, LVLH of the target"]),
    row(Estimate, "est.rho_dot_lvlh", Real, Vector(3), &["m/s"], &["chaser relative to target, velocity, LVLH of the target"]),
    row(Estimate, "est.d_lvlh", Real, Vector(3), &["m/s2"],
        &["acceleration that Clohessy-Wiltshire leaves out, LVLH of the target"]),
    row(Estimate, "est.acceleration_valid", Boolean, Scalar, &[],
        &["whether the filter estimates an unmodelled acceleration, be it as a state with a covariance or not"]),
    row(Estimate, "nis", Real, Scalar, &["1"],
        &["normalised innovation squared of the newest measurement of the target; 0 without a covariance"]),
    row(Estimate, "nis.rows", Integer, Scalar, &[], &["rows of that measurement"]),
    row(Estimate, "q.s", Real, Vector(3), &["m/s^2.5"], &["square root of the jerk density in use, axes of the estimate"]),
    row(Estimate, "q.updates", Integer, Scalar, &[], &["times the law changed its process noise"]),
    row(Estimate, "status", Enumeration("Status"), Scalar, &[], &["what the filter is doing"]),
    row(Estimate, "status_index", Integer, Scalar, &[], &["the same as a number, for tools that know no enumerations"]),
    row(Estimate, "pred.time", Real, Scalar, &["s"], &["end of the communication step, to which pred.* is propagated; est.time where it cannot be"]),
    row(Estimate, "pred.r_tc_n", Real, Vector(3), &["m"],
        &["target relative to chaser, position at pred.time, axes N, driven by the accelerometer, and by a_cmd_c_n and impulse_c_n where they are connected"]),
    row(Estimate, "pred.v_tc_n", Real, Vector(3), &["m/s"], &["target relative to chaser, velocity at pred.time, axes N"]),
    row(Estimate, "pred.rho_lvlh", Real, Vector(3), &["m"],
        &["chaser relative to target, position at pred.time, LVLH of the target; in the LVLH frame"]),
    row(Estimate, "pred.rho_dot_lvlh", Real, Vector(3), &["m/s"],
        &["chaser relative to target, velocity at pred.time, LVLH of the target; in the LVLH frame"]),
    row(Estimate, "pred.sigma", Real, Vector(6), &["m", "m/s"], &[
        "standard deviation of the relative position at pred.time; in the LVLH frame of rho",
        "standard deviation of the relative velocity at pred.time; in the LVLH frame of rho_dot",
    ]),
    row(Estimate, "cov.sigma", Real, Vector(18), STATES, &[
        "standard deviation of the relative position; in the LVLH frame of rho",
        "standard deviation of the relative velocity; in the LVLH frame of rho_dot",
        "standard deviation of the target's unmodelled acceleration; in the LVLH frame of d",
        "standard deviation of the chaser's position; in the LVLH frame 0",
        "standard deviation of the chaser's velocity; in the LVLH frame 0",
        "standard deviation of the accelerometer bias; in the LVLH frame 0",
    ]),
    rows(Of::Lidar, Innovation(0), "innov.range", Scalar, &["m"], &["range, measured minus predicted"]),
    rows(Of::Lidar, Innovation(1), "innov.azimuth", Scalar, &["rad"], &["azimuth, measured minus predicted"]),
    rows(Of::Lidar, Innovation(2), "innov.elevation", Scalar, &["rad"], &["elevation, measured minus predicted"]),
    rows(Of::Lidar, Variance(0), "innov.s", Vector(3), &["m2", "rad2", "rad2"], &[
        "predicted variance of the range's innovation", "predicted variance of the azimuth's innovation",
        "predicted variance of the elevation's innovation",
    ]),
    rows(Of::Metrology, Innovation(0), "innov.rho", Vector(3), &["m"], &["relative position, measured minus predicted, LVLH of the target"]),
    rows(Of::Metrology, Variance(0), "innov.rho_s", Vector(3), &["m2"], &["predicted variance of that innovation"]),
    rows(Of::Metrology, Innovation(3), "innov.rho_dot", Vector(3), &["m/s"], &["relative velocity, measured minus predicted, LVLH of the target"]),
    rows(Of::Metrology, Variance(3), "innov.rho_dot_s", Vector(3), &["m2/s2"], &["predicted variance of that innovation"]),
    row(Estimate, "q.skipped", Integer, Scalar, &[], &["updates passed by because the adaptation window was singular"]),
    row(Estimate, "q.unsolved", Integer, Scalar, &[],
        &["updates at which the law's solver found no solution, so that the last process noise stayed"]),
    row(Estimate, "edited.outliers", Integer, Scalar, &[], &["samples of a sensor that were passed by as most likely outliers"]),
    row(Estimate, "edited.impossible", Integer, Scalar, &[],
        &["samples of a sensor, the accelerometer included, that were passed by since they cannot be: a range that is not positive, a number that is none"]),
    row(Estimate, "edited.duplicates", Integer, Scalar, &[],
        &["samples that were passed by since their epoch was not beyond the last, though sample_count was new"]),
    row(Estimate, "edited.restarts", Integer, Scalar, &[],
        &["how often sample_count began again, at an epoch beyond the last"]),
    rows(Of::Camera, Innovation(0), "innov.camera", Vector(2), &["rad"], &[
        "azimuth of the camera, measured minus predicted", "elevation of the camera, measured minus predicted",
    ]),
    rows(Of::Camera, Variance(0), "innov.camera_s", Vector(2), &["rad2"], &["predicted variance of that innovation"]),
    rows(Of::Radio, Innovation(0), "innov.radio", Vector(2), &["m", "m/s"], &[
        "range of the radio, measured minus predicted", "range rate of the radio, measured minus predicted",
    ]),
    rows(Of::Radio, Variance(0), "innov.radio_s", Vector(2), &["m2", "m2/s2"], &["predicted variance of that innovation"]),
    row(Estimate, "cov.p", Real, Matrix(9, 9), COVARIANCE,
        &["covariance of r_tc, v_tc, a_t, in the LVLH frame of rho, rho_dot, d; 0 where a filter has no such state"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_every_element_has_unit_and_meaning() {
        for (place, port) in PORTS.iter().enumerate() {
            assert!(PORTS[place + 1..].iter().all(|p| p.name != port.name), "{}", port.name);
            for element in 0..port.shape.len() {
                assert!(!port.about(element).is_empty(), "{}", port.name);
                assert_eq!(port.kind == Real, !port.unit(element).is_empty(), "{}", port.name);
            }
            for list in [port.units, port.about] {
                let fits = [0, 1, port.shape.len()].contains(&list.len()) || 3 * list.len() == port.shape.len();
                assert!(fits, "{}", port.name);
            }
        }
    }

    /// A sensor of which something is missing would be wired, scored or shown in part, and nobody would be told.
    #[test]
    fn every_sensor_of_the_target_has_all_its_ports() {
        for sensor in Of::ALL {
            let parts = || {
                PORTS.iter().filter_map(move |port| match port.part {
                    Some((of, part)) if of == sensor => Some((port, part)),
                    _ => None,
                })
            };
            for (part, suffix) in [(Part::Due, "due"), (Part::Valid, "valid")] {
                let names: Vec<_> = parts().filter(|(_, p)| *p == part).map(|(port, _)| port.name).collect();
                assert_eq!(names, [format!("{}.{suffix}", sensor.name())]);
            }
            let units = |wanted: fn(Part) -> Option<usize>| {
                let mut found: Vec<_> = parts()
                    .filter_map(|(port, part)| Some((wanted(part)?, port)))
                    .flat_map(|(first, port)| (0..port.shape.len()).map(move |i| (first + i, port.unit(i))))
                    .collect();
                found.sort_unstable();
                assert!(
                    found.iter().enumerate().all(|(i, (row, _))| i == *row),
                    "{sensor:?}: {found:?}"
                );
                found.into_iter().map(|(_, unit)| unit).collect::<Vec<_>>()
            };
            let expected: Vec<_> = sensor.quantities().map(|quantity| quantity.unit()).collect();
            let squares: Vec<_> = (expected.iter())
                .map(|unit| match *unit {
                    "m" => "m2",
                    "rad" => "rad2",
                    _ => "m2/s2",
                })
                .collect();
            let variance = units(|part| if let Variance(first) = part { Some(first) } else { None });
            assert_eq!(variance, squares, "{sensor:?}");
        }
    }

    #[test]
    fn elements_have_units_of_their_own() {
        let unit = |name, element| port(name).map_or("", |port| port.unit(element));
        assert_eq!([0, 1, 2].map(|i| unit("innov.s", i)), ["m2", "rad2", "rad2"]);
        assert_eq!([0, 5, 17].map(|i| unit("nav_init.x", i)), ["m", "m/s", "m/s2"]);
        // A covariance: the product of the units of its row and of its column.
        for (row, column, expected) in [
            (1, 2, "m2"),
            (2, 3, "m2/s"),
            (3, 2, "m2/s"),
            (5, 8, "m2/s3"),
            (8, 8, "m2/s4"),
        ] {
            assert_eq!(unit("cov.p", 9 * row + column), expected, "{row} {column}");
        }
    }
}
