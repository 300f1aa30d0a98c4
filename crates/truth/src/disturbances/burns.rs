//! Manoeuvres that the mission states.

use interface::mission::{Axes, Burn, Which};
use nalgebra::Vector3;

use super::profiles::{OnOff, Profile};
use crate::timeline::{Event, Side, Vector};

/// A burn as an event.
pub(super) fn event(burn: &Burn) -> Event {
    let acceleration = Vector3::from(burn.direction).normalize() * burn.acceleration_m_s2;
    Event {
        start: burn.start_s,
        duration: burn.duration_s,
        profile: Profile::OnOff(OnOff),
        side: match burn.vehicle {
            Which::Chaser => Side::Chaser,
            Which::Target => Side::Target,
        },
        acceleration: match burn.axes {
            Axes::N => Vector::N(acceleration),
            Axes::Inertial => Vector::Inertial(acceleration),
            Axes::Body => Vector::Body(acceleration),
            Axes::Rtn => Vector::Rtn(acceleration),
        },
        back_propagated: burn.is_back_propagated(),
        told: burn.told,
    }
}
