//! What the runs of one study share.

use cosim::{OnSlaveError, RunOptions, Scheme};

use crate::error::StudyError;
use crate::participant::Participant;
use crate::phase::Phases;
use crate::samples::SAME_TIME;
use crate::world::World;

/// What a run needs to know, apart from its number.
#[derive(Debug)]
pub struct Spec {
    /// The world.
    pub world: World,
    /// The truth.
    pub truth: Participant,
    /// The filters, in the order of the results.
    pub filters: Vec<Participant>,
    /// Who pushes the vehicles, as guidance and life support do.
    pub drivers: Vec<Participant>,
    /// Whether a driver reads a filter: then every filter flies in a world of its own, seeded alike.
    pub closed_loop: bool,
    /// Seed of the study.
    pub seed: i32,
    /// Communication step, s.
    pub step: f64,
    /// Time between sensor samples, s. Where sensors have periods of their own, the longest of which each is a whole
    /// multiple: the grid on which samples lie.
    pub sample_period: f64,
    /// When values are handed over.
    pub scheme: Scheme,
    /// Whether filters may read `truth.*`, as bounds do.
    pub allow_truth: bool,
    /// Named parts of the runs.
    pub phases: Phases,
}

/// What the results of a filter are laid out by.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    /// Epochs of a run.
    pub(crate) epochs: usize,
    /// First epoch that counts in statistics over time.
    pub(crate) first_scored: usize,
    /// Time between epochs, s.
    pub(crate) sample_period: f64,
    /// Seed of the study.
    pub(crate) seed: i32,
    /// Names of the phases, in the order of their bits; the first is the scored time.
    pub(crate) phases: Vec<String>,
}

impl Spec {
    /// Number of epochs in a run: whole sample periods, from the first.
    pub fn epochs(&self) -> usize {
        // A float-to-integer cast saturates; SAME_TIME forgives a duration that is a rounded multiple.
        ((self.world.duration_s + SAME_TIME) / self.sample_period).floor() as usize
    }

    /// Time of an epoch, s.
    pub fn time(&self, epoch: usize) -> f64 {
        (epoch + 1) as f64 * self.sample_period
    }

    /// First epoch that counts in statistics over time.
    pub fn first_scored(&self) -> usize {
        (((self.world.scored_from_s - SAME_TIME) / self.sample_period).ceil() as usize).saturating_sub(1)
    }

    /// What results of its filters are laid out by.
    pub(crate) fn layout(&self) -> Layout {
        Layout {
            epochs: self.epochs(),
            first_scored: self.first_scored(),
            sample_period: self.sample_period,
            seed: self.seed,
            phases: self.phases.rules().iter().map(|rule| rule.name.clone()).collect(),
        }
    }

    /// Checks that every sample that is used falls on a communication point.
    ///
    /// # Errors
    /// [`StudyError::StepGrid`].
    pub fn check_grid(&self) -> Result<(), StudyError> {
        let whole = |x: f64| (x - x.round()).abs() < 1e-9 * x.abs().max(1.0) && x.round() >= 1.0;
        let (step, period) = (self.step, self.sample_period);
        let positive = step.is_finite() && step > 0.0 && period.is_finite() && period > 0.0;
        if positive && (whole(period / step) || whole(step / period)) {
            Ok(())
        } else {
            Err(StudyError::StepGrid { step, period })
        }
    }

    /// The same study with some of its filters, by their places.
    pub fn subset(&self, filters: &[usize]) -> Self {
        let chosen = filters.iter().filter_map(|place| self.filters.get(*place).cloned());
        Self {
            world: self.world.clone(),
            truth: self.truth.clone(),
            filters: chosen.collect(),
            drivers: self.drivers.clone(),
            phases: self.phases.clone(),
            ..*self
        }
    }

    /// Whether the filters take more than one world, a [`Spec::subset`] of one filter each.
    pub(crate) fn takes_worlds_apart(&self) -> bool {
        self.closed_loop && self.filters.len() > 1
    }

    pub(crate) fn options(&self, timing: bool) -> RunOptions {
        // With the Jacobi scheme the last sample is handed over one step late.
        let extra = if self.scheme == Scheme::Jacobi { self.step } else { 0.0 };
        RunOptions {
            start: 0.0,
            stop: self.world.duration_s + extra,
            step: self.step,
            scheme: self.scheme,
            on_slave_error: OnSlaveError::Isolate,
            timing,
            ..RunOptions::default()
        }
    }
}
