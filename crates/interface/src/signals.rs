//! What the truth hands to the filter: one struct, whose places the ports name.

use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

use crate::mission::Sensor;
use crate::ports::{Part, Port, Role, of};

/// The newest sensor sample, the initial estimate and what a bound is told, SI and radians; matrices row by row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Signals {
    /// `sample_time`, s.
    pub sample_time: f64,
    /// `sample_count`.
    pub sample_count: i32,
    /// What each sensor of the target says, in the order of [`Sensor::ALL`].
    pub sensors: [Seen; Sensor::COUNT],
    /// `target_orbit.*`: distance, its rate, angular momentum, inclination, argument of latitude, node.
    pub target_orbit: [f64; 6],
    /// `dcm_lvlh_n`, row by row; all 0 where nobody says it.
    pub dcm_lvlh_n: [f64; 9],
    /// `omega_lvlh`, rad/s.
    pub omega_lvlh: [f64; 3],
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
    /// `truth.dv_t_n`, m/s.
    pub dv_t_n: [f64; 3],
    /// `truth.event_time`, s; negative where nobody says.
    pub event_time: f64,
}

/// What a sensor of the target says at an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Seen {
    /// Whether it samples.
    pub due: bool,
    /// Whether it saw the target; if not, `z` keeps the last values.
    pub valid: bool,
    /// What it measured, SI and radians; rows beyond its own are 0.
    pub z: [f64; Sensor::MOST_ROWS],
}

impl Index<Sensor> for Signals {
    type Output = Seen;

    fn index(&self, sensor: Sensor) -> &Seen {
        &self.sensors[sensor as usize]
    }
}

impl IndexMut<Sensor> for Signals {
    fn index_mut(&mut self, sensor: Sensor) -> &mut Seen {
        &mut self.sensors[sensor as usize]
    }
}

impl Default for Signals {
    /// Before anything has arrived: the values of a truth that does not know of a port, too. Whoever does not say when a sensor
    /// is due means at every sample, and an accelerometer that does not say so is valid and of the instant.
    fn default() -> Self {
        let unsaid = Seen {
            due: true,
            ..Seen::default()
        };
        Self {
            sample_time: 0.0,
            sample_count: 0,
            sensors: [unsaid; Sensor::COUNT],
            target_orbit: [0.0; 6],
            dcm_lvlh_n: [0.0; 9],
            omega_lvlh: [0.0; 3],
            accelerometer_valid: true,
            accelerometer_mean: false,
            alpha_c_bc: [0.0; 3],
            dcm_bc_n: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            nav_init: [0.0; 18],
            dv_t_n: [0.0; 3],
            event_time: -1.0,
        }
    }
}

/// Where a port's values stand in [`Signals`]. One that is read as another type than its own is empty, false or 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// The epoch.
    Time,
    /// Its ordinal.
    Count,
    /// Whether a sensor samples.
    Due(Sensor),
    /// Whether it saw the target.
    Valid(Sensor),
    /// Rows of what it measured: the first and their number.
    Rows(Sensor, usize, usize),
    /// One number of the target's orbit.
    TargetOrbit(usize),
    /// Axes of the target's orbit.
    LvlhAxes,
    /// Their angular rate.
    LvlhRate,
    /// Whether the accelerometer measured.
    AccelerometerValid,
    /// Whether it measured the mean.
    AccelerometerMean,
    /// Its reading.
    Alpha,
    /// The attitude.
    Attitude,
    /// The initial estimate.
    NavInit,
    /// Velocity that no filter is told of.
    DvT,
    /// Time of events.
    EventTime,
}

impl Slot {
    /// Real elements.
    pub fn reals(self, s: &Signals) -> &[f64] {
        match self {
            Self::Time => std::slice::from_ref(&s.sample_time),
            Self::Rows(sensor, first, count) => &s[sensor].z[first..first + count],
            Self::TargetOrbit(place) => &s.target_orbit[place..=place],
            Self::LvlhAxes => &s.dcm_lvlh_n,
            Self::LvlhRate => &s.omega_lvlh,
            Self::Alpha => &s.alpha_c_bc,
            Self::Attitude => &s.dcm_bc_n,
            Self::NavInit => &s.nav_init,
            Self::DvT => &s.dv_t_n,
            Self::EventTime => std::slice::from_ref(&s.event_time),
            Self::Count | Self::Due(_) | Self::Valid(_) | Self::AccelerometerValid | Self::AccelerometerMean => &[],
        }
    }

    /// Real elements, to be written.
    pub fn reals_mut(self, s: &mut Signals) -> &mut [f64] {
        match self {
            Self::Time => std::slice::from_mut(&mut s.sample_time),
            Self::Rows(sensor, first, count) => &mut s[sensor].z[first..first + count],
            Self::TargetOrbit(place) => &mut s.target_orbit[place..=place],
            Self::LvlhAxes => &mut s.dcm_lvlh_n,
            Self::LvlhRate => &mut s.omega_lvlh,
            Self::Alpha => &mut s.alpha_c_bc,
            Self::Attitude => &mut s.dcm_bc_n,
            Self::NavInit => &mut s.nav_init,
            Self::DvT => &mut s.dv_t_n,
            Self::EventTime => std::slice::from_mut(&mut s.event_time),
            Self::Count | Self::Due(_) | Self::Valid(_) | Self::AccelerometerValid | Self::AccelerometerMean => &mut [],
        }
    }

    /// A truth value.
    pub fn boolean(self, s: &Signals) -> bool {
        match self {
            Self::Due(sensor) => s[sensor].due,
            Self::Valid(sensor) => s[sensor].valid,
            Self::AccelerometerValid => s.accelerometer_valid,
            Self::AccelerometerMean => s.accelerometer_mean,
            _ => false,
        }
    }

    /// Sets a truth value.
    pub fn set_boolean(self, s: &mut Signals, value: bool) {
        match self {
            Self::Due(sensor) => s[sensor].due = value,
            Self::Valid(sensor) => s[sensor].valid = value,
            Self::AccelerometerValid => s.accelerometer_valid = value,
            Self::AccelerometerMean => s.accelerometer_mean = value,
            _ => (),
        }
    }

    /// A whole number.
    pub fn integer(self, s: &Signals) -> i32 {
        if self == Self::Count { s.sample_count } else { 0 }
    }

    /// Sets a whole number.
    pub fn set_integer(self, s: &mut Signals, value: i32) {
        if self == Self::Count {
            s.sample_count = value;
        }
    }
}

/// Where the values of a port from truth to filter stand; `None` for a port of another role.
pub fn slot(port: &Port) -> Option<Slot> {
    match port.part {
        Some((sensor, Part::Due)) => return Some(Slot::Due(sensor)),
        Some((sensor, Part::Valid)) => return Some(Slot::Valid(sensor)),
        Some((sensor, Part::Measured(first))) => return Some(Slot::Rows(sensor, first, port.shape.len())),
        Some((_, Part::Innovation(_) | Part::Variance(_))) => return None,
        None => (),
    }
    Some(match port.name {
        "sample_time" => Slot::Time,
        "sample_count" => Slot::Count,
        "target_orbit.r" => Slot::TargetOrbit(0),
        "target_orbit.r_dot" => Slot::TargetOrbit(1),
        "target_orbit.h" => Slot::TargetOrbit(2),
        "target_orbit.inclination" => Slot::TargetOrbit(3),
        "target_orbit.argument_of_latitude" => Slot::TargetOrbit(4),
        "target_orbit.raan" => Slot::TargetOrbit(5),
        "dcm_lvlh_n" => Slot::LvlhAxes,
        "omega_lvlh" => Slot::LvlhRate,
        "accelerometer.valid" => Slot::AccelerometerValid,
        "accelerometer.mean" => Slot::AccelerometerMean,
        "accelerometer.alpha_c_bc" => Slot::Alpha,
        "dcm_bc_n" => Slot::Attitude,
        "nav_init.x" => Slot::NavInit,
        "truth.dv_t_n" => Slot::DvT,
        "truth.event_time" => Slot::EventTime,
        _ => return None,
    })
}

/// Every port from truth to filter with its place: those of the sensors, then those of bounds.
pub fn slots() -> impl Iterator<Item = (&'static Port, Slot)> {
    let ports = of(Role::Sensor).chain(of(Role::Untold));
    ports.filter_map(|port| Some((port, slot(port)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ports::Kind;

    #[test]
    fn every_port_to_a_filter_has_a_place_of_its_own_and_of_its_size() {
        assert_eq!(slots().count(), of(Role::Sensor).chain(of(Role::Untold)).count());
        let same = |slot: Slot, a: &Signals, b: &Signals| {
            slot.reals(a) == slot.reals(b) && slot.boolean(a) == slot.boolean(b) && slot.integer(a) == slot.integer(b)
        };
        for (port, slot) in slots() {
            let mut changed = Signals::default();
            match port.kind {
                Kind::Integer => slot.set_integer(&mut changed, 7),
                Kind::Boolean => slot.set_boolean(&mut changed, !slot.boolean(&Signals::default())),
                _ => {
                    assert_eq!(slot.reals(&changed).len(), port.shape.len(), "{}", port.name);
                    slot.reals_mut(&mut changed).fill(0.625);
                }
            }
            assert_ne!(changed, Signals::default(), "{}", port.name);
            assert!(
                !same(slot, &changed, &Signals::default()),
                "{} is read where it was written",
                port.name
            );
            for (other, theirs) in slots().filter(|(other, _)| other.name != port.name) {
                assert!(
                    same(theirs, &changed, &Signals::default()),
                    "{} moves {}",
                    port.name,
                    other.name
                );
            }
        }
    }
}
