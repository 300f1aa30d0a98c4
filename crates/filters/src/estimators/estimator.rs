//! What an estimator offers to the navigator.

use crate::commands::Commands;
use crate::error::FilterError;
use crate::innovation::Innovation;
use crate::laws::{Adaptation, Step, positive};
use crate::sample::Sample;
use crate::state::{State, TargetMatrix};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

/// Mean, covariance and standard deviations, SI, as in [`crate::Estimate`].
pub(crate) struct Reported {
    pub x: State,
    pub p_target: TargetMatrix,
    pub sigma: State,
}

/// The interval from the last sample to a new one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// Epoch of the last sample, or the start time, s.
    pub from_s: f64,
    /// Length, s, positive.
    pub length_s: f64,
    /// Start of the run, s.
    pub start_s: f64,
    /// Longest step in which it is crossed, s.
    pub step_s: f64,
}

/// A state, perhaps with its covariance, and what is known of its motion and of the sensors. Several of them, or one of several
/// covariances, can stand behind the same trait.
pub(crate) trait Estimator {
    /// Refuses a sample that makes no sense, before anything changes.
    fn check(&self, sample: &Sample) -> Result<(), FilterError>;

    /// Refuses an initial estimate, SI, that cannot be taken.
    fn check_start(&self, _nav_init: &State, _t_s: f64) -> Result<(), FilterError> {
        Ok(())
    }

    /// Takes the initial estimate, SI, when the first sample arrives at `t_s`.
    fn start(&mut self, nav_init: &State, t_s: f64) -> Result<(), FilterError>;

    /// Whether [`Estimator::start`] has been called.
    fn started(&self) -> bool;

    /// Time update over the gap, up to the epoch of `sample`, at which its axes stand as they say.
    ///
    /// * `commands`: what the chaser was commanded to do, as far as that is known.
    /// * returns: transition of the target's nine states over the whole gap.
    fn propagate(
        &mut self,
        gap: &Gap,
        sample: &Sample,
        law: &dyn Adaptation,
        commands: &Commands,
    ) -> Result<TargetMatrix, FilterError>;

    /// Measurement update with what the sample offers.
    ///
    /// * `step`: what a law shall see; filled in.
    /// * returns: the innovation in SI; `None` when nothing was measured of the target.
    fn update(&mut self, sample: &Sample, step: &mut Step) -> Result<Option<Innovation>, FilterError>;

    /// Goes back to before the last update.
    fn undo(&mut self);

    /// Moves the mean of relative position and velocity, internal units; the covariance stays that of its own gain.
    fn shift(&mut self, by: &Vector6<f64>);

    /// Begin of the interval of which the accelerometer's next reading may be the mean, s; `None` where no reading looks back.
    ///
    /// * `start_s`: start of the run.
    fn reads_since(&self, _start_s: f64) -> Option<f64> {
        None
    }

    /// Number of the target's nine states that have a covariance; none under a constant gain.
    fn dimension(&self) -> usize;

    /// Whether its dynamics say what the simplest ones leave out.
    fn knows_acceleration(&self) -> bool {
        false
    }

    /// Relative position and velocity, internal units.
    fn relative(&self) -> Vector6<f64>;

    /// The estimate in SI.
    ///
    /// * `since`: transition from the sample that the law has observed last, 9x9; `None` where that is this one.
    fn report(&self, sample: &Sample, law: &dyn Adaptation, since: Option<&TargetMatrix>) -> Reported;

    /// The first thing wrong with mean and covariance.
    fn defect(&self, t_s: f64) -> Option<FilterError>;
}

impl Gap {
    /// Longest step of one propagation, s; a gap between samples is crossed in equal parts no longer than this.
    pub(crate) const LONGEST_STEP: f64 = 1.0;

    /// Number of equal parts in which the gap is crossed.
    pub(super) fn parts(&self) -> u32 {
        (self.length_s / self.step_s - 1e-9).ceil().max(1.0) as u32
    }
}

/// The first thing wrong with a mean and a covariance.
pub(super) fn defect<const D: usize>(x: &SVector<f64, D>, p: &SMatrix<f64, D, D>, t_s: f64) -> Option<FilterError> {
    // All of them, so that several are looked at at once.
    let finite = |values: &[f64]| values.iter().fold(true, |all, v| all & v.is_finite());
    if !(finite(x.as_slice()) & finite(p.as_slice())) {
        return Some(FilterError::NotFinite { t_s });
    }
    // Zero is legal: a law without an acceleration state has no variance there.
    let negative = (0..D).find(|i| p[(*i, *i)] < 0.0);
    negative.map(|i| FilterError::NegativeVariance { t_s, state: i + 1 })
}

/// Puts the covariance of position and velocity that a law stands for in place of the estimator's own.
///
/// * `p`: the estimator's own, D x D, internal units; `since`: as in [`Estimator::report`].
pub(super) fn stand_in<const D: usize>(p: &mut SMatrix<f64, D, D>, law: &dyn Adaptation, since: Option<&TargetMatrix>) {
    let Some(said) = law.replacement() else { return };
    let mut block = p.fixed_view_mut::<6, 6>(0, 0);
    let own: Matrix6<f64> = block.clone_owned();
    let stands = match since {
        None => said.p,
        Some(f) => match law.excess(&f.fixed_view::<6, 6>(0, 0).into_owned()) {
            // The estimator's own may have walked much further than the law says.
            Some(excess) => own + excess,
            None => return,
        },
    };
    block.copy_from(&positive(stands, &own));
}
