//! Where Sun and Moon are and how the central body has turned.

use astro::epoch;
use interface::mission::Mission;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::Needs;
use crate::TruthError;

/// What the sky of a mission follows from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Almanac {
    /// Julian date of the start.
    epoch_jd: f64,
}

/// The sky at one instant; what no model needs is zero.
pub(crate) struct Sky {
    /// Maps N to body-fixed axes of the central body.
    pub dcm_f_n: Matrix3<f64>,
    /// The Sun from the central body, N, m.
    pub sun: Vector3<f64>,
    /// The Moon from the central body, N, m.
    pub moon: Vector3<f64>,
}

impl Almanac {
    pub(super) fn of(_mission: &Mission) -> Result<Self, TruthError> {
        Ok(Self { epoch_jd: 2_458_849.5 })
    }

    /// * `t`: s since the start of the run.
    pub(super) fn at(&self, t: f64, needs: Needs) -> Sky {
        let days = epoch::days_since_j2000(self.epoch_jd, t);
        let (sun, moon) = if needs.bodies {
            (astro::sun_moon::sun(days), astro::sun_moon::moon(days))
        } else {
            (Vector3::zeros(), Vector3::zeros())
        };
        Sky {
            dcm_f_n: if needs.turn {
                astro::earth_rotation::dcm_f_n(days)
            } else {
                Matrix3::zeros()
            },
            sun,
            moon,
        }
    }
}
