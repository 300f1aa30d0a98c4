//! Why a study could not be what its plan says.

use std::path::PathBuf;

use cosim::{BaseType, CosimError};
use fmi2_import::{Causality, ImportError};
use interface::annotation::AnnotationError;
use stats::StatsError;
use thiserror::Error;

/// Everything that keeps a study from being run; what goes wrong in a run does not.
#[derive(Debug, Error)]
pub enum StudyError {
    /// An FMU that cannot be used, or a name or value it does not know.
    #[error(transparent)]
    Import(Box<ImportError>),
    /// Slaves that cannot be coupled.
    #[error(transparent)]
    Cosim(Box<CosimError>),
    /// A statistic that cannot be formed.
    #[error(transparent)]
    Stats(#[from] StatsError),
    /// Two bodies that make no sense.
    #[error(transparent)]
    Astro(#[from] astro::AstroError),
    /// A run that left the numbers.
    #[error("the relative position is no number at {time} s")]
    Lost {
        /// When, s.
        time: f64,
    },
    /// A mission that cannot be used.
    #[error(transparent)]
    Mission(#[from] interface::MissionError),
    /// Sensors whose samples lie on no common grid.
    #[error(
        "mission {mission}: sensors sample every {} s, which are whole multiples of no millisecond or more in common, so that a \
         master would lose samples; choose periods that are",
        periods.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
    )]
    NoGrid {
        /// Name of the mission.
        mission: String,
        /// Of each sensor, s.
        periods: Vec<f64>,
    },
    /// The file of a mission that cannot be placed.
    #[error("{}: the mission cannot be written there", path.display())]
    MissionFile {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A mission that names a filter as none can be named.
    #[error("mission {mission}, study.filters: {problem}")]
    Filters {
        /// Name of the mission.
        mission: String,
        /// What is wrong.
        problem: String,
    },
    /// A scenario is named more than once; its rows and files would be the same.
    #[error("scenario '{name}' is named twice; name each once")]
    ScenarioTwice {
        /// The name.
        name: String,
    },
    /// What an FMU tells the harness of its filters cannot be read.
    #[error("{model}: {source}")]
    Annotation {
        /// Model name of the FMU.
        model: String,
        /// What is wrong.
        source: AnnotationError,
    },
    /// A filter of that name does not exist.
    #[error("fmu-nav has no filter '{name}'{}; it has: {known}", did_you_mean(meant.as_deref()))]
    UnknownFilter {
        /// Name asked for.
        name: String,
        /// The nearest name.
        meant: Option<String>,
        /// Names that exist.
        known: String,
    },
    /// A filter has no parameter set of that name.
    #[error("filter '{filter}' has no preset '{preset}'; it has: {known}")]
    UnknownPreset {
        /// The filter.
        filter: String,
        /// Preset asked for.
        preset: String,
        /// Presets that exist.
        known: String,
    },
    /// `--set` or `--map` names an FMU that is not in the study.
    #[error("'{text}': there is no model '{model}' in this study; there are: {known}")]
    UnknownModel {
        /// Name asked for.
        model: String,
        /// The whole assignment.
        text: String,
        /// Names that exist.
        known: String,
    },
    /// `--set`, `--vary` or `--range` of something another option governs.
    #[error("{model}.{variable} cannot be set, varied or searched; use {option}")]
    Reserved {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// The option to use.
        option: &'static str,
    },
    /// A value that a variable cannot take; the FMUs share names, so the message tells whose it is.
    #[error("{model}: {source}")]
    Value {
        /// Model.
        model: String,
        /// Variable, value, and what would be allowed.
        source: Box<ImportError>,
    },
    /// `--set`, `--vary` or `--range` of something that is no parameter.
    #[error("{model}.{variable} has causality '{causality}'; only parameters can be set, varied or searched")]
    NotAParameter {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// What it is.
        causality: Causality,
    },
    /// `--vary` or `--range` of a parameter that is no number.
    #[error("{model}.{variable} has type '{found}'; only Real parameters can be varied or searched")]
    NotReal {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// Its type.
        found: BaseType,
    },
    /// A parameter would be given two values.
    #[error("{model}.{variable} is varied twice, or set as well; give one --vary or one --set for it")]
    VariedTwice {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
    },
    /// A filter that cannot do anything sensible in a world.
    #[error("filter '{filter}' has no meaning in scenario '{scenario}': {why}; leave it out there")]
    NoMeaning {
        /// The filter, with its preset.
        filter: String,
        /// The scenario.
        scenario: String,
        /// Why.
        why: String,
    },
    /// A tuned set with a value that cannot be set.
    #[error("tuned set '{set}' of {scenario} in {}: {source}", file.display())]
    BadTunedSet {
        /// The file.
        file: PathBuf,
        /// `NAME@SET`.
        set: String,
        /// Scenario it holds for.
        scenario: String,
        /// What cannot be set, and why.
        source: Box<StudyError>,
    },
    /// Two rows of the results would have the same name.
    #[error("filter '{label}' stands in the study twice (or is the name of the truth); give each a label of its own")]
    LabelTwice {
        /// The label.
        label: String,
    },
    /// A study of no world.
    #[error("the study holds no world; give --scenario")]
    NoWorld,
    /// A study of nothing.
    #[error("the study holds no filter; give --filters or --nav")]
    NoFilter,
    /// One of our filters is asked for, but fmu-nav was not opened.
    #[error("filter '{label}' needs fmu-nav, which is not part of this study")]
    NoNav {
        /// The filter asked for.
        label: String,
    },
    /// A truth or filter lacks a variable that no comparison can do without.
    #[error(
        "'{label}' offers no variable '{name}' (a Real vector has elements '{name}[1]' to '{name}[3]'); if it has another name there, say so with --map {label}.THEIR_NAME={name}"
    )]
    MissingSignal {
        /// Participant.
        label: String,
        /// Name of the contract.
        name: String,
    },
    /// A parameter is set twice; the second would win without a word.
    #[error("{model}.{variable} is set twice; give one --set for it")]
    SetTwice {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
    },
    /// A setting that changes nothing.
    #[error("{model}.{variable} would change nothing: {why}; leave it out")]
    NoEffect {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// Why.
        why: String,
    },
    /// A filter that would know what it is to find out.
    #[error(
        "'{label}' asks for '{input}', which no filter may see; if it is meant as a bound rather than a filter, give --allow-truth"
    )]
    AsksForTruth {
        /// Participant.
        label: String,
        /// The input.
        input: String,
    },
    /// A vector or matrix of which a filter offers another shape than can be read.
    #[error("'{label}' offers '{name}' as {found}; expected are {expected}, or nothing of that name")]
    Shape {
        /// Participant.
        label: String,
        /// Name of the contract.
        name: String,
        /// What it offers.
        found: String,
        /// What can be read.
        expected: &'static str,
    },
    /// A variable whose unit measures something else than its name says.
    #[error("'{label}' offers '{name}' in '{found}', which cannot be converted to {expected}")]
    Unit {
        /// Participant.
        label: String,
        /// Name of the contract.
        name: String,
        /// Its unit.
        found: String,
        /// Unit of the contract.
        expected: String,
    },
    /// A file of mappings that is none.
    #[error("{}: {problem}", path.display())]
    Mappings {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        problem: String,
    },
    /// An FMU that expects Python in the program that loads it.
    #[error(
        "'{label}' expects Python in the program that loads it, as FMUs of PythonFMU do; give --preload python, or --preload with the path of a libpython3.x.so: {source}"
    )]
    ExpectsPython {
        /// Participant.
        label: String,
        /// What the loader says.
        source: Box<ImportError>,
    },
    /// A driver that pushes nothing.
    #[error("driver '{label}' has no output of the name of an input of the world, of which there are: {inputs}")]
    DrivesNothing {
        /// The driver.
        label: String,
        /// Inputs of the world, without indices.
        inputs: String,
    },
    /// Nothing feeds the initial estimate of a filter, or what a bound is told.
    #[error("'{label}' needs '{input}', but the truth offers none")]
    MissingInput {
        /// Participant.
        label: String,
        /// The input.
        input: String,
    },
    /// Samples would fall between communication points.
    #[error(
        "a communication step of {step} s and samples every {period} s do not fit: one must be a whole multiple of the other, both positive"
    )]
    StepGrid {
        /// Communication step, s.
        step: f64,
        /// Sample period, s.
        period: f64,
    },
    /// A slave refuses its settings during initialization.
    #[error("'{label}' refuses to start with these settings")]
    Refused {
        /// Participant.
        label: String,
        /// Why.
        source: Box<CosimError>,
    },
    /// The journal of finished runs cannot be read or written.
    #[error("{}: {source}; every finished run before it is safe", path.display())]
    Journal {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A journal with a run that no study has written there.
    #[error("{}: {problem}; remove this file, and its runs are made again", path.display())]
    DamagedJournal {
        /// The file.
        path: PathBuf,
        /// Which run, and what is wrong with it.
        problem: String,
    },
    /// A journal of finished runs of another study.
    #[error("{} holds the runs of another study", path.display())]
    OtherJournal {
        /// The file.
        path: PathBuf,
    },
    /// A process that makes runs cannot be started or talked to.
    #[error("a process that makes runs cannot be used: {source}")]
    Worker {
        /// Why.
        source: std::io::Error,
    },
    /// A filter refuses its settings.
    #[error("{why}")]
    Rehearsal {
        /// What it says.
        why: String,
    },
    /// Somebody has asked the process to stop.
    #[error("stopped as asked; what is finished is kept")]
    Stopped,
    /// A study file that cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A study file that says something wrong.
    #[error("{0}")]
    FileProblem(interface::mission::Problem),
    /// A plan that no file can hold.
    #[error("the study cannot be written as a file: {0}")]
    Unwritten(toml::ser::Error),
    /// A plan that no study can follow.
    #[error("plan: {field} {problem}")]
    Plan {
        /// The field.
        field: &'static str,
        /// Its value, and what is allowed.
        problem: String,
    },
}

// Boxed by hand, so that `?` works and results stay small.
impl From<ImportError> for StudyError {
    fn from(error: ImportError) -> Self {
        Self::Import(Box::new(error))
    }
}

impl From<CosimError> for StudyError {
    fn from(error: CosimError) -> Self {
        Self::Cosim(Box::new(error))
    }
}

/// An error with its causes, in one line.
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        let inner_text = inner.to_string();
        // Transparent wrappers repeat their cause.
        if !text.ends_with(&inner_text) {
            text = format!("{text}: {inner_text}");
        }
        cause = inner.source();
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The end of a sentence about a name that does not exist.
pub fn did_you_mean(meant: Option<&str>) -> String {
    meant
        .map(|meant| format!(", did you mean '{meant}'?"))
        .unwrap_or_default()
}
