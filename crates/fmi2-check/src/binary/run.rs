//! A run from start values, as every trial makes it.

use fmi2_abi::Fmi2Status;

use super::instance::{Bench, Ended, Instance, Refusal};
use super::job::{Value, Variable};
use crate::role::Causality;
use crate::rules::binary as rules;

/// A call that should have ended well and did not; it is in the journal.
#[derive(Debug)]
pub(super) struct Failed;

/// Values of all outputs at each communication point.
pub(super) type Record = Vec<Vec<Value>>;

impl<'a> Bench<'a> {
    /// Every output.
    pub(super) fn outputs(&self) -> Vec<&'a Variable> {
        let all = self.job.variables.iter();
        all.filter(|v| v.causality == Causality::Output).collect()
    }

    /// Finds a call that did not end well.
    pub(super) fn expect(&self, function: &'static str, ended: Ended, instance: &Instance<'_>) -> Result<(), Failed> {
        match ended {
            Ended::Well => Ok(()),
            Ended::Refused(status) => {
                let what = format!("it returned {status}{}", instance.sink.said());
                self.journal.found(&rules::CALL, function, what);
                Err(Failed)
            }
            Ended::Later => {
                let what = "it returned fmi2Pending, and nobody waits for it here";
                self.journal.found(&rules::SKIPPED, function, what);
                Err(Failed)
            }
            Ended::Unclear => Err(Failed),
        }
    }

    /// Time of a communication point.
    pub(super) fn time(&self, step: u32) -> f64 {
        self.job.start + f64::from(step) * self.job.step
    }

    /// A new instance, made as usual.
    pub(super) fn instance(&'a self) -> Result<Instance<'a>, Failed> {
        Instance::usual(self).ok_or(Failed)
    }

    /// From instantiation, or a reset, to initialization mode.
    pub(super) fn reach_initialization(&self, instance: &Instance<'_>) -> Result<(), Failed> {
        self.expect("fmi2SetupExperiment", instance.setup(), instance)?;
        self.expect("fmi2EnterInitializationMode", instance.enter_initialization(), instance)
    }

    /// From instantiation, or a reset, to the first communication point.
    pub(super) fn initialize(&self, instance: &Instance<'_>) -> Result<(), Failed> {
        self.reach_initialization(instance)?;
        self.expect("fmi2ExitInitializationMode", instance.exit_initialization(), instance)
    }

    /// One step, from the communication point of this number.
    pub(super) fn step(&self, instance: &Instance<'_>, step: u32) -> Result<(), Failed> {
        self.expect("fmi2DoStep", instance.do_step(self.time(step), self.job.step), instance)
    }

    /// Reads, and finds where that is refused.
    pub(super) fn read(&self, instance: &Instance<'_>, variables: &[&Variable]) -> Result<Vec<Value>, Failed> {
        instance.read(variables).map_err(
            |Refusal {
                 function,
                 ended,
                 variable,
             }| {
                if let Ended::Refused(status) = ended {
                    let status: Fmi2Status = status;
                    let what = format!(
                        "it returned {status} for {variable} or others of its kind{}",
                        instance.sink.said()
                    );
                    self.journal.found(&rules::CALL, function, what);
                }
                Failed
            },
        )
    }

    /// Steps, with all outputs before the first and after each.
    pub(super) fn record(&self, instance: &Instance<'_>, steps: std::ops::Range<u32>) -> Result<Record, Failed> {
        let outputs = self.outputs();
        let mut record = vec![self.read(instance, &outputs)?];
        for step in steps {
            self.step(instance, step)?;
            record.push(self.read(instance, &outputs)?);
        }
        Ok(record)
    }

    /// The number of the step in the middle of a run.
    pub(super) fn half(&self) -> u32 {
        self.job.steps / 2
    }

    /// Outputs that differ between two records: place of the output, and what is told of it.
    pub(super) fn differences(&self, expected: &Record, found: &Record, first_step: u32) -> Vec<(usize, String)> {
        let outputs = self.outputs().len();
        (0..outputs)
            .filter_map(|place| {
                let mut pairs = expected.iter().zip(found).zip(first_step..);
                let ((expected, found), step) = pairs.find(|((e, f), _)| e[place] != f[place])?;
                let (expected, found) = (expected[place].shown(), found[place].shown());
                Some((
                    place,
                    format!("at {} s it is {found} instead of {expected}", self.time(step)),
                ))
            })
            .collect()
    }
}
