//! The axes that a world is computed in.

use astro::Cr3bpSystem;
use astro::cr3bp::InertialAxes;
use astro::relative_axes::AxesN;
use interface::Mission;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::TruthError;

/// Axes N: inertial ones, or those that turn with the two bodies of the three-body problem about z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) enum Axes {
    Inertial,
    Rotating {
        system: Cr3bpSystem,
        inertial: InertialAxes,
    },
}

impl Axes {
    pub(crate) fn of(mission: &Mission) -> Result<Self, TruthError> {
        let Some(p) = mission.environment.gravity.cr3bp() else {
            return Ok(Self::Inertial);
        };
        Ok(Self::Rotating {
            system: Cr3bpSystem::new(p.mass_ratio, p.length_m, p.time_s)?,
            inertial: InertialAxes {
                angle_at_end: p.inertial_angle_at_end_rad,
                end: mission.time.duration_s,
                time: p.time_s,
            },
        })
    }

    /// Maps inertial axes to N at `t`, s since the start of the run.
    pub(crate) fn dcm_n_i(&self, t: f64) -> Matrix3<f64> {
        match self {
            Self::Inertial => Matrix3::identity(),
            Self::Rotating { inertial, .. } => inertial.dcm_n_i(t),
        }
    }

    /// Components in N, at `t`, of a vector that is fixed in inertial axes.
    pub(crate) fn held_in_n(&self, t: f64, a: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Inertial => *a,
            Self::Rotating { inertial, .. } => inertial.dcm_n_i(t) * a,
        }
    }

    /// Position and inertial velocity relative to the body that is orbited, in the three-body problem the smaller one.
    pub(crate) fn about_body(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        match self {
            Self::Inertial => (*r, *v),
            Self::Rotating { system, .. } => system.about_secondary(r, v),
        }
    }

    /// The axes as they stand at `t`, s since the start of the run.
    pub(crate) fn at(&self, t: f64) -> AxesN {
        match self {
            Self::Inertial => AxesN::Inertial,
            Self::Rotating { system, inertial } => AxesN::Rotating {
                system: *system,
                angle: inertial.angle(t),
            },
        }
    }
}
