//! Monte Carlo studies of navigation filters that are coupled with a simulated world through FMI.
//!
//! A [`Plan`] says what is studied: worlds, filters with their presets, runs, seed, what is set and what is varied. A file,
//! a command line and a program make the same plan. [`Models`] opens the FMUs it names and casts the parts of a run,
//! [`run_once`] is one run, [`score`] makes a [`Record`] of each estimate, and [`Study::run`] folds the records of all runs
//! into a [`FilterResult`] for each filter, of which a [`Summary`] holds the statistics.
//!
//! Truth and filters are known by the variable names of the contract alone, so anyone's FMU can take either place. Not
//! here: how a plan is typed in, how results are printed, and what they are held to.
//!
//! Start reading at [`Plan`], then [`Study`].

mod arguments;
mod calibration;
mod cast;
mod error;
mod file;
mod flown;
mod fold;
mod grid;
mod history;
mod journal;
mod kept;
mod maps;
mod models;
mod ordered;
mod outcome;
mod pairs;
mod participant;
mod phase;
mod phase_result;
mod phase_summary;
mod plan;
mod readers;
mod record;
mod requirement;
mod run;
mod samples;
mod score;
mod shard;
mod signals;
mod spec;
mod starts;
mod stop;
mod study;
mod summary;
mod tally;
mod tuned;
mod variation;
mod worker;
mod workers;
mod world;
pub mod worlds;

pub use arguments::{Assignment, FilterChoice, ForeignFilter, Mapping, PAPER};
pub use calibration::{Calibration, Check, calibrate};
pub use error::{StudyError, chain, did_you_mean};
pub use file::inline;
pub use flown::Flown;
pub use fold::{FilterResult, RunRow, Timing};
pub use grid::{Grid, Setting};
pub use interface::Status;
pub use interface::mission::Phase;
pub use journal::Journal;
pub use kept::{KEPT_RUNS, KeptRow, KeptRun, PathPoint};
pub use maps::read_mappings;
pub use models::{Model, Models, NAV, OwnFmus, TRUTH, filters_of};
pub use outcome::{Outcome, Part};
pub use pairs::{Pair, pairs, ranks};
pub use participant::{Participant, SlaveSource};
pub use phase::Phases;
pub use phase_result::{HOLD_S, PhaseResult, PhaseRun};
pub use phase_summary::{ChiSquareSummary, ErrorSummary, PhaseSummary};
pub use plan::{ALL, Isolation, Output, Plan, check_case, scheme_name};
pub use record::{QUANTITIES, Quantity, Record};
pub use requirement::Requirement;
pub use run::{Ending, Failure, RunReport, SlaveTime, call_time, rehearse, run_once, run_recorded, seat};
pub use samples::{Estimate, StatusItems, TruthSample};
pub use score::score;
pub use shard::Shard;
pub use signals::{Innovation, Signals};
pub use spec::Spec;
pub use starts::check_real_range;
pub use stop::{stop, stop_asked};
pub use study::{Engine, Study, StudyResult};
pub use summary::{QuantitySummary, ScalarSummary, Summary};
pub use tally::{Ratio, RunTally, Tally, evaluate, evaluate_each, ratio};
pub use tuned::TunedSet;
pub use variation::{DISTRIBUTIONS, Distribution, Variation, Varied};
pub use worker::{Limits, serve};
pub use workers::Workers;
pub use world::{Axes, Frame, World};
pub use worlds::MISSION;
