//! What is tried; each trial in a process of its own.

mod callbacks;
mod dependencies;
mod life;
mod misuse;
mod same;
mod states;

use super::instance::Bench;
use super::job::Job;
use super::run::Failed;
use crate::rule::Rule;
use crate::rules::binary as rules;

/// Something that is tried.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    /// Name on the command line of the process.
    pub(super) name: &'static str,
    /// What it tries, as in "while ...".
    pub(super) about: &'static str,
    /// Broken when the process ends in the middle.
    pub(super) crash: &'static Rule,
    /// Broken when a call does not come back.
    pub(super) hang: &'static Rule,
    /// Whether it is a wrong call, whose answer is not waited for as long.
    pub(super) mistake: bool,
    /// Whether it has a meaning for this FMU.
    pub(super) applies: fn(&Job) -> bool,
    pub(super) run: fn(&Bench<'_>) -> Result<(), Failed>,
}

const fn trial(name: &'static str, about: &'static str, run: fn(&Bench<'_>) -> Result<(), Failed>) -> Trial {
    Trial {
        name,
        about,
        crash: &rules::CRASH,
        hang: &rules::HANG,
        mistake: false,
        applies: |_| true,
        run,
    }
}

const fn mistake(name: &'static str, about: &'static str, run: fn(&Bench<'_>) -> Result<(), Failed>) -> Trial {
    Trial {
        crash: &rules::MISUSE_CRASH,
        hang: &rules::MISUSE_CRASH,
        mistake: true,
        ..trial(name, about, run)
    }
}

/// A wrong call that the standard wants refused.
const fn to_refuse(rule: &'static Rule, mistake: Trial) -> Trial {
    Trial {
        crash: rule,
        hang: rule,
        ..mistake
    }
}

/// The first: a whole life. Where it fails, others are not tried.
pub(super) static LIFE: Trial = trial("life", "living from start values", life::life);

/// Two equal runs; where they differ, trials that compare runs of two instances say nothing.
pub(super) static REPEAT: Trial = trial("repeat", "running twice", same::repeat);

/// Compare runs with those of another instance.
pub(super) static COMPARING: &[Trial] = &[
    trial("reset", "resetting", same::reset),
    Trial {
        applies: |job| !job.once,
        ..trial("two", "running two instances in turns", same::two)
    },
    Trial {
        applies: |job| job.states && job.serializes,
        ..trial("serialize", "serializing a state", states::serialize)
    },
    Trial {
        applies: |job| job.states && job.serializes,
        ..trial(
            "deserialize",
            "reading the state of another process",
            states::deserialize,
        )
    },
];

/// All others.
pub(super) static OTHERS: &[Trial] = &[
    trial("logging", "logging everything", callbacks::logging),
    Trial {
        applies: |job| job.states,
        ..trial("states", "saving and restoring a state", states::states)
    },
    trial(
        "initial-dependencies",
        "moving knowns in initialization mode",
        dependencies::initial,
    ),
    trial(
        "dependencies",
        "moving inputs between steps",
        dependencies::between_steps,
    ),
    Trial {
        crash: &rules::FREE_NULL,
        ..trial("free-null", "freeing NULL", callbacks::free_null)
    },
    Trial {
        crash: &rules::LOGGER_NULL,
        hang: &rules::LOGGER_NULL,
        ..trial("logger-null", "living without a logger", callbacks::logger_null)
    },
    Trial {
        crash: &rules::MEMORY_NULL,
        hang: &rules::MEMORY_NULL,
        applies: |job| job.own_memory,
        ..trial("memory-null", "living without memory functions", callbacks::memory_null)
    },
    to_refuse(
        &rules::GUID,
        mistake("wrong-guid", "instantiating with another guid", misuse::wrong_guid),
    ),
    mistake("step-at-once", "stepping before initialization", misuse::step_at_once),
    mistake(
        "step-too-early",
        "stepping in initialization mode",
        misuse::step_too_early,
    ),
    mistake(
        "exit-at-once",
        "leaving an initialization mode that was not entered",
        misuse::exit_at_once,
    ),
    mistake("enter-twice", "entering initialization mode twice", misuse::enter_twice),
    mistake(
        "setup-too-late",
        "setting up the experiment after initialization",
        misuse::setup_too_late,
    ),
    mistake(
        "terminate-at-once",
        "terminating before initialization",
        misuse::terminate_at_once,
    ),
    mistake("step-too-late", "stepping after fmi2Terminate", misuse::step_too_late),
    mistake("step-back", "stepping backwards", misuse::step_back),
    mistake(
        "step-elsewhere",
        "stepping from another time than the last step has reached",
        misuse::step_elsewhere,
    ),
    mistake("step-nan", "stepping by what is no number", misuse::step_nan),
    to_refuse(
        &rules::REFERENCE,
        mistake(
            "get-unknown",
            "reading value references that do not exist",
            misuse::get_unknown,
        ),
    ),
    to_refuse(
        &rules::REFERENCE,
        mistake(
            "set-unknown",
            "setting value references that do not exist",
            misuse::set_unknown,
        ),
    ),
    to_refuse(
        &rules::CONSTANT_SET,
        mistake("set-constant", "setting a constant", misuse::set_constant),
    ),
    mistake(
        "set-fixed",
        "setting fixed parameters after initialization",
        misuse::set_fixed,
    ),
    mistake("set-output", "setting an output between steps", misuse::set_output),
    mistake("set-nan", "setting an input to what is no number", misuse::set_nan),
];

/// The trial of this name.
pub(super) fn by_name(name: &str) -> Option<&'static Trial> {
    let all = [&LIFE, &REPEAT].into_iter().chain(COMPARING).chain(OTHERS);
    all.into_iter().find(|trial| trial.name == name)
}
