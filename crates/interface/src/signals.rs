//! What the truth hands to the filter: one struct, whose places the sensor ports name.

use serde::{Deserialize, Serialize};

use crate::ports::{Port, Role, of};

/// The newest sensor sample and the initial estimate, SI and radians; matrices row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Signals {
    /// `sample_time`, s.
    pub sample_time: f64,
    /// `sample_count`.
    pub sample_count: i32,
    /// `lidar.due` and `lidar.valid`.
    pub lidar: Seen,
    /// `lidar.range` (m), `lidar.azimuth`, `lidar.elevation` (rad).
    pub lidar_z: [f64; 3],
    /// `camera.due` and `camera.valid`.
    pub camera: Seen,
    /// `camera.azimuth`, `camera.elevation`, rad.
    pub camera_z: [f64; 2],
    /// `radio.due` and `radio.valid`.
    pub radio: Seen,
    /// `radio.range` (m), `radio.range_rate` (m/s).
    pub radio_z: [f64; 2],
    /// `metrology.due` and `metrology.valid`.
    pub metrology: Seen,
    /// `metrology.rho_lvlh` (m), then `metrology.rho_dot_lvlh` (m/s).
    pub metrology_z: [f64; 6],
    /// `target_orbit.*`: distance, its rate, angular momentum, inclination, argument of latitude.
    pub target_orbit: [f64; 5],
    /// `accelerometer.valid`.
    pub accelerometer_valid: bool,
    /// `accelerometer.mean`.
    pub accelerometer_mean: bool,
    /// `accelerometer.alpha_c_bc`, m/s2.
    pub alpha_c_bc: [f64; 3],
    /// `dcm_bc_n`, row by row.
    pub dcm_bc_n: [f64; 9],
    /// `nav_init.x`.
    pub nav_init: [f64; 18],
}

/// Whether a sensor of the target samples at the epoch, and whether it saw the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Seen {
    /// It samples.
    pub due: bool,
    /// It saw.
    pub valid: bool,
}

impl Default for Signals {
    /// Before anything has arrived: the values of a truth that does not know of a port, too. Whoever does not say when a sensor
    /// is due means at every sample, and an accelerometer that does not say so is valid and of the instant.
    fn default() -> Self {
        let unsaid = Seen {
            due: true,
            valid: false,
        };
        Self {
            sample_time: 0.0,
            sample_count: 0,
            lidar: unsaid,
            lidar_z: [0.0; 3],
            camera: unsaid,
            camera_z: [0.0; 2],
            radio: unsaid,
            radio_z: [0.0; 2],
            metrology: unsaid,
            metrology_z: [0.0; 6],
            target_orbit: [0.0; 5],
            accelerometer_valid: true,
            accelerometer_mean: false,
            alpha_c_bc: [0.0; 3],
            dcm_bc_n: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            nav_init: [0.0; 18],
        }
    }
}

/// Where a port's values stand in [`Signals`].
#[derive(Debug, Clone, Copy)]
pub enum Slot {
    /// Real elements.
    Real(fn(&Signals) -> &[f64], fn(&mut Signals) -> &mut [f64]),
    /// A whole number.
    Integer(fn(&Signals) -> i32, fn(&mut Signals, i32)),
    /// A truth value.
    Boolean(fn(&Signals) -> bool, fn(&mut Signals, bool)),
}

/// A place, named once and read and written through it.
macro_rules! real {
    ($field:ident) => {
        Slot::Real(|s| &s.$field[..], |s| &mut s.$field[..])
    };
    ($field:ident, $range:expr) => {
        Slot::Real(|s| &s.$field[$range], |s| &mut s.$field[$range])
    };
}

macro_rules! one {
    ($kind:ident, $($field:ident).+) => {
        Slot::$kind(|s| s.$($field).+, |s, value| s.$($field).+ = value)
    };
}

/// Where the values of a sensor port stand; `None` for a port of another role.
pub fn slot(port: &Port) -> Option<Slot> {
    Some(match port.name {
        "sample_time" => Slot::Real(
            |s| std::slice::from_ref(&s.sample_time),
            |s| std::slice::from_mut(&mut s.sample_time),
        ),
        "sample_count" => one!(Integer, sample_count),
        "lidar.due" => one!(Boolean, lidar.due),
        "lidar.valid" => one!(Boolean, lidar.valid),
        "lidar.range" => real!(lidar_z, 0..1),
        "lidar.azimuth" => real!(lidar_z, 1..2),
        "lidar.elevation" => real!(lidar_z, 2..3),
        "camera.due" => one!(Boolean, camera.due),
        "camera.valid" => one!(Boolean, camera.valid),
        "camera.azimuth" => real!(camera_z, 0..1),
        "camera.elevation" => real!(camera_z, 1..2),
        "radio.due" => one!(Boolean, radio.due),
        "radio.valid" => one!(Boolean, radio.valid),
        "radio.range" => real!(radio_z, 0..1),
        "radio.range_rate" => real!(radio_z, 1..2),
        "metrology.due" => one!(Boolean, metrology.due),
        "metrology.valid" => one!(Boolean, metrology.valid),
        "metrology.rho_lvlh" => real!(metrology_z, 0..3),
        "metrology.rho_dot_lvlh" => real!(metrology_z, 3..6),
        "target_orbit.r" => real!(target_orbit, 0..1),
        "target_orbit.r_dot" => real!(target_orbit, 1..2),
        "target_orbit.h" => real!(target_orbit, 2..3),
        "target_orbit.inclination" => real!(target_orbit, 3..4),
        "target_orbit.argument_of_latitude" => real!(target_orbit, 4..5),
        "accelerometer.valid" => one!(Boolean, accelerometer_valid),
        "accelerometer.mean" => one!(Boolean, accelerometer_mean),
        "accelerometer.alpha_c_bc" => real!(alpha_c_bc),
        "dcm_bc_n" => real!(dcm_bc_n),
        "nav_init.x" => real!(nav_init),
        _ => return None,
    })
}

/// Every sensor port with its place.
pub fn slots() -> impl Iterator<Item = (&'static Port, Slot)> {
    of(Role::Sensor).filter_map(|port| Some((port, slot(port)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ports::Kind;

    #[test]
    fn every_sensor_port_has_a_place_of_its_own_and_of_its_size() {
        assert_eq!(slots().count(), of(Role::Sensor).count());
        for (port, slot) in slots() {
            let mut changed = Signals::default();
            match slot {
                Slot::Real(get, get_mut) => {
                    assert_eq!(
                        (port.kind, get(&changed).len()),
                        (Kind::Real, port.shape.len()),
                        "{}",
                        port.name
                    );
                    get_mut(&mut changed).fill(0.625);
                }
                Slot::Integer(_, set) => set(&mut changed, 7),
                Slot::Boolean(get, set) => {
                    let value = get(&changed);
                    set(&mut changed, !value);
                }
            }
            assert_ne!(changed, Signals::default(), "{}", port.name);
            for (other, theirs) in slots().filter(|(other, _)| other.name != port.name) {
                let same = match theirs {
                    Slot::Real(get, _) => get(&changed) == get(&Signals::default()),
                    Slot::Integer(get, _) => get(&changed) == get(&Signals::default()),
                    Slot::Boolean(get, _) => get(&changed) == get(&Signals::default()),
                };
                assert!(same, "{} moves {}", port.name, other.name);
            }
        }
    }
}
