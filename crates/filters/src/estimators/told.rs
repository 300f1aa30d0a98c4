//! Manoeuvres that a filter is told of.

use crate::error::FilterError;
use astro::frames;
use interface::Navigation;
use interface::mission::{Axes, Frame, Told, Which};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

/// Edges within a gap for which there is room in place; where more come, memory is asked for.
const FEW: usize = 16;

/// A manoeuvre of constant acceleration in its axes; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Manoeuvre {
    vehicle: Which,
    /// Seconds after the start of the run.
    from: f64,
    to: f64,
    a: Vector3<f64>,
    axes: Axes,
}

/// All of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Manoeuvres {
    all: Vec<Manoeuvre>,
    /// Angle by which axes N have turned from inertial ones, at the start and per second; zero where N are inertial.
    angle: (f64, f64),
}

/// Where the vehicles are, axes N, for the axes of their orbits; position and velocity in any units, the velocity inertial.
pub(super) struct Place {
    pub r_n: Vector3<f64>,
    pub v_n: Vector3<f64>,
}

/// Steps of a gap, s.
pub(super) enum Steps {
    /// Equal ones.
    Equal {
        /// Length of each.
        step: f64,
        /// How many are left.
        left: u32,
    },
    /// From edge to edge.
    Cut {
        /// Ends of the steps, s after the begin of the gap.
        edges: smallvec::IntoIter<[f64; FEW]>,
        /// The last of them that was reached.
        last: f64,
    },
}

impl Iterator for Steps {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        match self {
            Self::Equal { step, left } => {
                *left = left.checked_sub(1)?;
                Some(*step)
            }
            Self::Cut { edges, last } => {
                let edge = edges.next()?;
                let step = edge - *last;
                *last = edge;
                Some(step)
            }
        }
    }
}

impl Manoeuvres {
    /// Those of a mission that its accelerometer does not tell of.
    ///
    /// # Errors
    /// When a manoeuvre is told in axes in which the filter cannot use it.
    pub(super) fn of(told: &Navigation) -> Result<Self, FilterError> {
        // The accelerometer feels what the chaser does; a plan beside it would count that twice.
        let felt = |m: &&Told| m.vehicle == Which::Target || told.accelerometer.is_none() || told.frame == Frame::Lvlh;
        let mut all = Vec::new();
        for m in told.told.iter().filter(felt) {
            let usable = match (told.frame, m.axes) {
                (Frame::Inertial, Axes::N | Axes::Inertial | Axes::Rtn) | (Frame::Lvlh, Axes::Rtn) => true,
                (Frame::Inertial, Axes::Body) => m.vehicle == Which::Chaser,
                (Frame::Lvlh, _) => false,
            };
            if !usable {
                let axes = if told.frame == Frame::Lvlh {
                    "in the LVLH frame a manoeuvre is told in axes \"rtn\""
                } else {
                    "the target's attitude is not known: tell its manoeuvre in axes \"n\", \"inertial\" or \"rtn\""
                };
                return Err(FilterError::Unusable {
                    mission: told.mission.clone(),
                    what: format!("the burn told at {} s: {axes}", m.start_s),
                });
            }
            all.push(Manoeuvre {
                vehicle: m.vehicle,
                from: m.start_s,
                to: m.start_s + m.duration_s,
                a: Vector3::from(m.a_m_s2),
                axes: m.axes,
            });
        }
        let angle = told.gravity.cr3bp().map_or((0.0, 0.0), |problem| {
            let rate = 1.0 / problem.time_s;
            (problem.inertial_angle_at_end_rad - rate * told.duration_s, rate)
        });
        Ok(Self { all, angle })
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Steps of a gap in seconds, one behind the other: equal parts, cut where a manoeuvre begins or ends, so that its
    /// acceleration is constant over each.
    ///
    /// * `from`: begin of the gap, s after the start of the run.
    /// * `cuts`: other times at which it is cut, s after its begin.
    pub(super) fn steps(&self, from: f64, length: f64, parts: u32, cuts: impl Iterator<Item = f64>) -> Steps {
        let told = self.all.iter().flat_map(|m| [m.from - from, m.to - from]);
        let mut cuts = told.chain(cuts).filter(|cut| *cut > 0.0 && *cut < length).peekable();
        let step = length / f64::from(parts);
        if cuts.peek().is_none() {
            return Steps::Equal { step, left: parts };
        }
        let mut edges: SmallVec<[f64; FEW]> = (1..=parts).map(|k| f64::from(k) * step).collect();
        for edge in cuts {
            // A step that is nearly nothing would only cost.
            if edges.iter().all(|e| (e - edge).abs() > 1e-9 * length) {
                edges.push(edge);
            }
        }
        edges.sort_by(f64::total_cmp);
        Steps::Cut {
            edges: edges.into_iter(),
            last: 0.0,
        }
    }

    /// Acceleration of target and chaser, in axes N of an inertial frame, or relative ones in LVLH axes (both in the target's).
    ///
    /// * `t`: middle of the step, s after the start of the run.
    /// * `target`, `chaser`: their places, for axes of an orbit; `None` in LVLH axes, which are those of the orbit.
    /// * returns: m/s2.
    pub(super) fn at(
        &self,
        t: f64,
        places: Option<(&Place, &Place)>,
        dcm_n_bc: &Matrix3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let (mut target, mut chaser) = (Vector3::zeros(), Vector3::zeros());
        for m in self.all.iter().filter(|m| m.from <= t && t < m.to) {
            let place = places.map(|(target, chaser)| match m.vehicle {
                Which::Target => target,
                Which::Chaser => chaser,
            });
            let a_n = match (m.axes, place) {
                (Axes::N, _) | (Axes::Rtn, None) => m.a,
                (Axes::Inertial, _) => astro::cr3bp::dcm_rotating_inertial(self.angle.0 + self.angle.1 * t) * m.a,
                (Axes::Body, _) => dcm_n_bc * m.a,
                // Along its radius a vehicle has no such axes, and nothing flies so.
                (Axes::Rtn, Some(place)) => frames::try_rtn(&place.r_n, &place.v_n)
                    .map_or_else(Vector3::zeros, |dcm_rtn_n| dcm_rtn_n.tr_mul(&m.a)),
            };
            match m.vehicle {
                Which::Target => target += a_n,
                Which::Chaser => chaser += a_n,
            }
        }
        (target, chaser)
    }
}
