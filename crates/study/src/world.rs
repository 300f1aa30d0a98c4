//! A world, as a study sees it: how long it lasts, which variables are compared, in which axes, and by which filters.

use std::path::PathBuf;

use astro::{Cr3bpSystem, frames};
use interface::Mission;
use interface::mission;
use nalgebra::{Matrix3, Vector3};

use crate::arguments::FilterChoice;
use crate::samples::TruthSample;
use crate::signals::{INERTIAL, LVLH, Signals};

/// One world.
#[derive(Debug, Clone, PartialEq)]
pub struct World {
    /// Name of its mission.
    pub name: String,
    /// What happens in it, in one sentence.
    pub about: String,
    /// What it reproduces.
    pub reference: String,
    /// Length of a run, s.
    pub duration_s: f64,
    /// Start of the time that statistics are taken over, s.
    pub scored_from_s: f64,
    /// Time between samples where the truth does not tell its own, s: the longest of which every sensor's period is a
    /// whole multiple.
    pub sample_period_s: f64,
    /// Axes in which truth and filter give the relative state; the names of what is compared follow from them.
    pub frame: Frame,
    /// Axes in which results are given.
    pub axes: Axes,
    /// Rows that `nis` is taken over by a filter that does not say so itself.
    pub nis_rows: u32,
    /// Filters of fmu-nav that are compared unless others are asked for.
    pub filters: Vec<FilterChoice>,
    /// What a user should know of it.
    pub notes: Vec<String>,
    /// File that the FMUs read it from; `None` where they know it by its name.
    pub mission_file: Option<PathBuf>,
    /// The mission.
    pub mission: Mission,
}

/// Axes of the relative state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// Target relative to chaser, axes N; of both vehicles the absolute state is known as well.
    Inertial,
    /// Chaser relative to target, LVLH axes of the target.
    Lvlh,
}

/// Axes of results, and how the truth turns into them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Axes {
    /// Radial, transverse and normal of the target's orbit about the origin of N, which does not turn.
    Rtn,
    /// The same about the smaller body of the three-body problem, in whose rotating axes the state is given.
    RtnRotating(Cr3bpSystem),
    /// Those of the variables: LVLH of the target.
    Lvlh,
}

impl Frame {
    /// As a mission's `navigation.frame` says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertial => mission::Frame::Inertial,
            Self::Lvlh => mission::Frame::Lvlh,
        }
        .name()
    }

    /// What truth and filter call the quantities that are compared.
    pub fn signals(self) -> &'static Signals {
        match self {
            Self::Inertial => &INERTIAL,
            Self::Lvlh => &LVLH,
        }
    }
}

impl Axes {
    /// Names for columns.
    pub fn names(self) -> [&'static str; 3] {
        match self {
            Self::Rtn | Self::RtnRotating(_) => ["r", "t", "n"],
            Self::Lvlh => ["x", "y", "z"],
        }
    }

    /// Matrix that turns the truth's axes into these: rows R, T, N with R along the target's position from the central
    /// body, N along its angular momentum, and T to complete them.
    ///
    /// Position and velocity of the target are those of the chaser plus the relative ones. `None` without the chaser's
    /// state or where position and velocity are parallel.
    pub fn matrix(self, truth: &TruthSample) -> Option<Matrix3<f64>> {
        match self {
            Self::Lvlh => Some(Matrix3::identity()),
            Self::Rtn => {
                let (r, v) = target(truth)?;
                frames::try_rtn(&r, &v)
            }
            Self::RtnRotating(system) => {
                let (r, v) = target(truth)?;
                system.rtn_about_secondary(&r, &v)
            }
        }
    }
}

/// Position and velocity of the target; `None` without the chaser's.
fn target(truth: &TruthSample) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let (r_c, v_c) = truth.chaser?;
    Some((r_c + truth.position, v_c + truth.velocity))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A target on the x axis that moves along y and a bit outwards: R = x, T = y, N = z.
    #[test]
    fn rtn_of_a_case_worked_by_hand() {
        let mut truth = TruthSample {
            position: Vector3::new(1.0, 0.0, 0.0),
            velocity: Vector3::new(0.0, 1.0, 0.0),
            chaser: Some((Vector3::new(6.0, 0.0, 0.0), Vector3::new(0.5, 2.0, 0.0))),
            ..TruthSample::default()
        };
        assert!((Axes::Rtn.matrix(&truth).unwrap() - Matrix3::identity()).amax() < 1e-15);
        truth.velocity = Vector3::new(0.0, -2.0, 0.0);
        assert!(Axes::Rtn.matrix(&truth).is_none());
        // At rest in axes that turn, beside the smaller body on x: it moves along y all the same.
        let system = Cr3bpSystem::new(0.2, 5.0, 10.0).unwrap();
        let rotating = Axes::RtnRotating(system);
        assert!((rotating.matrix(&truth).unwrap() - Matrix3::identity()).amax() < 1e-15);
        truth.chaser = None;
        assert!(Axes::Rtn.matrix(&truth).is_none() && rotating.matrix(&truth).is_none());
        assert_eq!(Axes::Lvlh.matrix(&truth), Some(Matrix3::identity()));
    }
}
