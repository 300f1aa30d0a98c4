//! What a registered filter is made of: dynamics, a kind of update, and a law with its tunables.

use super::adaptation::Setup;
use crate::error::FilterError;
use crate::tunable::{Preset, Tunable};
use crate::update::ConstantGain;
use interface::Navigation;
use interface::mission::Frame;

/// Dynamics that a filter asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Those of the mission's frame: both vehicles in its gravity, or Clohessy and Wiltshire's in the LVLH frame.
    OfFrame,
    /// Nonlinear with J2, about the target's known orbit, in the LVLH frame.
    J2,
}

/// How a filter takes a measurement in.
#[derive(Clone, Copy)]
pub enum Update {
    /// By the Kalman gain of its covariance.
    Kalman,
    /// By a constant gain; there is no covariance.
    ConstantGain(fn(&Setup<'_>) -> Result<ConstantGain, FilterError>),
}

/// A tunable to be searched, on a logarithmic scale.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Name without the law's prefix.
    pub tunable: &'static str,
    /// Smallest value, SI or as the tunable says.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// The choice, a tunable and its item, under which alone the tunable has an effect; `None` where it always has one.
    pub only_with: Option<(&'static str, &'static str)>,
}

/// A registered filter.
pub struct FilterEntry {
    /// Name, as in the FMU's `filter` enumeration, and prefix of its tunables.
    pub name: &'static str,
    /// One line for `list` and the enumeration's description.
    pub about: &'static str,
    /// Its dynamics.
    pub motion: Motion,
    /// Its update.
    pub update: Update,
    /// Whether it reproduces no paper: unless told otherwise it looks for outliers, and lets the accelerometer's noise enter its
    /// covariance.
    pub ours: bool,
    /// Whether it is no filter but a bound: told by the truth what nothing on board knows, to hold laws against.
    pub bound: bool,
    /// Parameters it offers.
    pub tunables: &'static [Tunable],
    /// Named sets; the first is always `paper`.
    pub presets: &'static [Preset],
    /// Real tunables that a search for the best tuning varies.
    pub search: &'static [Search],
}

impl FilterEntry {
    /// The frame in which alone the filter has a meaning, and why; `None` when it has one in both.
    pub fn alone_in(&self) -> Option<(Frame, &'static str)> {
        if self.bound {
            return Some((
                Frame::Inertial,
                "it is told what pushes the target; in the target's LVLH frame what dynamics leave out is gravity's above all, hangs on \
                 the state, and is what ekf_j2 knows",
            ));
        }
        let why = match (self.motion, self.update) {
            (Motion::J2, _) => Some(
                "it is the J2 model in the target's LVLH frame; elsewhere every filter already has the full gravity, as in snc",
            ),
            (Motion::OfFrame, Update::ConstantGain(_)) => {
                Some("its gain multiplies a measurement of the whole state (H = I), which range and angles are not")
            }
            (Motion::OfFrame, Update::Kalman) => None,
        };
        why.map(|why| (Frame::Lvlh, why))
    }

    /// Why the filter has no meaning in a mission; `None` where it has one.
    pub fn no_meaning_in(&self, navigation: &Navigation) -> Option<&'static str> {
        let (frame, why) = self.alone_in()?;
        (navigation.frame != frame).then_some(why)
    }
}
