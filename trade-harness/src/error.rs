//! Why the harness could not do what it was asked.

use std::io;
use std::path::PathBuf;

use cosim::{BaseType, CosimError};
use fmi2_import::{Causality, ImportError};
use interface::annotation::AnnotationError;
use stats::StatsError;
use thiserror::Error;

/// Everything that ends a command; a failed run of a study does not.
#[derive(Debug, Error)]
pub enum HarnessError {
    /// An FMU that cannot be used, or a name or value it does not know.
    #[error(transparent)]
    Import(Box<ImportError>),
    /// Slaves that cannot be coupled.
    #[error(transparent)]
    Cosim(Box<CosimError>),
    /// A statistic that cannot be formed.
    #[error(transparent)]
    Stats(#[from] StatsError),
    /// A scenario of that name does not exist.
    #[error("there is no scenario '{name}'; there are: {known}")]
    UnknownScenario {
        /// Name asked for.
        name: String,
        /// Names that exist.
        known: String,
    },
    /// A scenario is named more than once; its rows and files would be the same.
    #[error("scenario '{name}' is named twice; name each once")]
    ScenarioTwice {
        /// The name.
        name: String,
    },
    /// A filter of that name does not exist.
    #[error("fmu-nav has no filter '{name}'; it has: {known}")]
    UnknownFilter {
        /// Name asked for.
        name: String,
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
    /// What an FMU tells the harness of its filters cannot be read.
    #[error("{model}: {source}")]
    Annotation {
        /// Model name of the FMU.
        model: String,
        /// What is wrong.
        source: AnnotationError,
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
    /// A range that no search can cover on a logarithmic scale.
    #[error("{model}.{variable} cannot be searched from {low} to {high}: give LOW:HIGH with 0 < LOW < HIGH")]
    SearchRange {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// `--range` for a filter that takes no part.
    #[error("--range {model}.{variable} concerns no filter of this study; there are: {known}")]
    RangeOfNothing {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
        /// Filters of the study.
        known: String,
    },
    /// Two ranges for one variable.
    #[error("--range gives two ranges for {model}.{variable}; give one")]
    RangeTwice {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
    },
    /// `--set` and `--range` of the same variable.
    #[error(
        "{model}.{variable} stands in --set and in --range; a value that is set is not searched, so give one of them"
    )]
    SetAndSearched {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
    },
    /// `--vary` and `--range` of the same variable.
    #[error(
        "{model}.{variable} stands in --vary and in --range; a value that each run draws is not searched, so give one of them"
    )]
    VariedAndSearched {
        /// Model.
        model: String,
        /// Variable.
        variable: String,
    },
    /// A NEES limit that leaves nothing.
    #[error(
        "NEES limits of {low} to {high} leave nothing: give 0 < --nees-min < --nees-max; a consistent filter has 1"
    )]
    NeesLimits {
        /// Smallest NEES over its dimension.
        low: f64,
        /// Largest.
        high: f64,
    },
    /// A search would be judged in the worlds it was made in.
    #[error(
        "--seed and --judge-seed are both {seed}: filters would be judged in the worlds they were tuned in; give two seeds"
    )]
    SameSeeds {
        /// The seed.
        seed: i32,
    },
    /// A file of tuned sets that is none.
    #[error("{} holds no tuned sets as 'trade-harness tune' writes them: {source}", path.display())]
    NotTuned {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
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
        source: Box<HarnessError>,
    },
    /// Two rows of the results would have the same name.
    #[error("filter '{label}' stands in the study twice (or is the name of the truth); give each a label of its own")]
    LabelTwice {
        /// The label.
        label: String,
    },
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
    /// Nothing feeds the initial estimate of a filter.
    #[error("'{label}' needs its initial estimate, but the truth offers no '{input}'")]
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
    /// A folder or file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The folder or file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Where a folder is needed there is a file.
    #[error("{} is a file; give a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// Where a file is to be written there is a folder.
    #[error("{} is a folder; give the name of a file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// Rows that cannot be put into CSV.
    #[error("cannot form a CSV table: {0}")]
    Csv(#[from] csv::Error),
    /// A manifest that cannot be put into JSON.
    #[error("cannot form the manifest: {0}")]
    Json(#[from] serde_json::Error),
    /// A `.fmu` that cannot be put together.
    #[error("cannot form {}: {source}", path.display())]
    Zip {
        /// The archive.
        path: PathBuf,
        /// Why.
        source: zip::result::ZipError,
    },
    /// The FMU is not there and must not be built.
    #[error("there is no {}; run 'trade-harness pack', or leave out --no-build", path.display())]
    NoFmu {
        /// Where it should be.
        path: PathBuf,
    },
    /// The folder to build in is not our workspace.
    #[error("{} is not the workspace of fmu-truth and fmu-nav; give it with --workspace, or use packed FMUs with --no-build and --fmu-dir", path.display())]
    NoWorkspace {
        /// The folder.
        path: PathBuf,
    },
    /// Cargo could not be started.
    #[error("cannot start '{program}': {source}; set CARGO to its path, or use packed FMUs with --no-build")]
    NoCargo {
        /// Program tried.
        program: String,
        /// Why.
        source: io::Error,
    },
    /// Cargo ended with an error.
    #[error("building fmu-truth and fmu-nav failed ({status}); cargo's messages are above")]
    Build {
        /// How cargo ended.
        status: std::process::ExitStatus,
    },
    /// Cargo built no library of that name.
    #[error("cargo named no shared library for '{target}'; is its crate-type still cdylib?")]
    NoLibrary {
        /// Name of the library target.
        target: String,
    },
    /// The packed FMU cannot be instantiated.
    #[error(
        "{name} does not start from its modelDescription.xml; if its variables have changed, render the file anew with 'UPDATE_GOLDEN=1 cargo test -p {name}'"
    )]
    DoesNotStart {
        /// Crate and model name.
        name: &'static str,
        /// Why.
        source: Box<ImportError>,
    },
}

// Boxed by hand, so that `?` works and results stay small.
impl From<ImportError> for HarnessError {
    fn from(error: ImportError) -> Self {
        Self::Import(Box::new(error))
    }
}

impl From<CosimError> for HarnessError {
    fn from(error: CosimError) -> Self {
        Self::Cosim(Box::new(error))
    }
}
