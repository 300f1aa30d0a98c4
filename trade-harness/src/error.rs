//! Why the harness could not do what it was asked.

use std::io;
use std::path::PathBuf;

use fmi2_import::ImportError;
use stats::StatsError;
use study::{StudyError, did_you_mean};
use thiserror::Error;

/// Everything that ends a command; a failed run of a study does not.
#[derive(Debug, Error)]
pub enum HarnessError {
    /// A study that cannot be run.
    #[error(transparent)]
    Study(Box<StudyError>),
    /// An FMU that cannot be used, or a name or value it does not know.
    #[error(transparent)]
    Import(Box<ImportError>),
    /// A system structure that cannot be read or written.
    #[error(transparent)]
    Ssp(#[from] ssp::SspError),
    /// A system structure that no study can represent.
    #[error("{}: {element}: {problem}", path.display())]
    Element {
        /// The structure.
        path: PathBuf,
        /// Component, connector, connection or binding.
        element: String,
        /// What is in the way, and what to do.
        problem: String,
    },
    /// An FMU that cannot be checked.
    #[error(transparent)]
    Check(#[from] fmi2_check::CheckError),
    /// An orbit, a field of gravity or a date that makes no sense.
    #[error(transparent)]
    Astro(#[from] astro::AstroError),
    /// A mission that leads into its central body.
    #[error(
        "a vehicle is below the surface of the central body at {time} s: the orbit, the relative start or a burn is wrong"
    )]
    BelowSurface {
        /// When, s.
        time: f64,
    },
    /// A mission whose sensors never see the target.
    #[error(
        "no sensor ever sees the target: attitude, field_of_view_deg, max_range_m and period_s decide what is seen"
    )]
    SeesNothing,
    /// A name that is none of those to choose from.
    #[error("there is no {kind} '{name}'{}; there are: {known}", did_you_mean(meant.as_deref()))]
    NoSuchThing {
        /// What was asked for.
        kind: &'static str,
        /// Its name.
        name: String,
        /// The nearest name.
        meant: Option<String>,
        /// All names.
        known: String,
    },
    /// An option of a finished study, and no study.
    #[error("{option} is for a run of a finished study: give its folder, as in `trade-harness replay DIR`; {instead}")]
    NeedsAStudy {
        /// The option.
        option: &'static str,
        /// What does without a study.
        instead: &'static str,
    },
    /// A library that workers cannot load first.
    #[error("--preload {}: {why}", library.display())]
    Preload {
        /// The library, as given.
        library: PathBuf,
        /// Why not.
        why: String,
    },
    /// A complete study that is to be resumed with requirements that it was not judged by.
    #[error(
        "{}: the study is complete and was judged by other requirements; without --resume it is made again and judged by these",
        path.display()
    )]
    OtherRequirements {
        /// Its folder.
        path: PathBuf,
    },
    /// A folder without a study that can be made again.
    #[error("{}: {problem}", path.display())]
    NoStudy {
        /// Its manifest.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Files of a study that are gone or others than they were.
    #[error(
        "the study in {} cannot be made again: {changes};{commit} put the files back, or give --other-files to go on and see \
         what differs",
        path.display()
    )]
    NotAsItWas {
        /// Folder of the study.
        path: PathBuf,
        /// What has changed.
        changes: String,
        /// What to build, if that is known.
        commit: String,
    },
    /// A file that is not overwritten.
    #[error("{} exists already; name another, or move it away", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
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
    /// A file of levels is none.
    #[error("{file}: {problem}; 'trade-harness regret --print-levels' shows one")]
    Levels {
        /// Which.
        file: String,
        /// What is wrong, and what is allowed.
        problem: String,
    },
    /// Nothing is left to try.
    #[error("no level of that name is for these missions; there are: {known}")]
    NoLevel {
        /// Names.
        known: String,
    },
    /// A trial of other settings stands there.
    #[error("{} holds a trial of other settings or FMUs: give another --out, or --force to replace it", path.display())]
    OtherRegret {
        /// The file.
        path: PathBuf,
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
    /// Where a folder is needed there is something else.
    #[error("{} is {what}; give a folder", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
        /// What is there: 'a file'.
        what: &'static str,
    },
    /// Where a file is to be written there is something else.
    #[error("{} is {what}; give the name of a file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// What is there: 'a folder'.
        what: &'static str,
    },
    /// The system does not let us listen for Ctrl-C.
    #[error("cannot listen for Ctrl-C: {source}")]
    Signals {
        /// Why.
        source: ctrlc::Error,
    },
    /// A study that is called nominal and is not.
    #[error(
        "case 'nominal' is for missions as they stand, and here differs: {differs}; leave --case out, or name it otherwise"
    )]
    NotNominal {
        /// What does.
        differs: String,
    },
    /// A requirement on what is not there.
    #[error("requirement '{requirement}': {problem}")]
    Requirement {
        /// What is asked.
        requirement: String,
        /// What is wrong and what there is.
        problem: String,
    },
    /// Another process works in the folder.
    #[error("{} is in use by another process; wait for it, or give another folder with --out", path.display())]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds something else.
    #[error(
        "{} holds another study (or one of other FMUs or of another version); give another folder with --out, or --force to set it aside",
        path.display()
    )]
    OtherStudy {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds the same study, broken off.
    #[error(
        "{} holds this study unfinished; give --resume to go on, or --force to set it aside and begin anew",
        path.display()
    )]
    Unfinished {
        /// The folder.
        path: PathBuf,
    },
    /// Parts of a study that do not make a whole.
    #[error("{}: {problem}", path.display())]
    Shards {
        /// The folder.
        path: PathBuf,
        /// What is missing or does not fit.
        problem: String,
    },
    /// Rows that cannot be put into CSV.
    #[error("cannot form a CSV table: {0}")]
    Csv(#[from] csv::Error),
    /// Rows that cannot be put into a Parquet file.
    #[cfg(feature = "parquet")]
    #[error("cannot form a Parquet file: {0}")]
    Parquet(#[from] ::parquet::errors::ParquetError),
    /// A program built without what was asked of it.
    #[error(
        "this program was built without Parquet files; `cargo build --release -p trade-harness --features parquet` makes one with them"
    )]
    NoParquet,
    /// A manifest that cannot be put into JSON.
    #[error("cannot form the manifest: {0}")]
    Json(#[from] serde_json::Error),
    /// A folder of which no page can be made.
    #[error(transparent)]
    Report(#[from] html_report::ReportError),
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
    /// A date that is none.
    #[error("SOURCE_DATE_EPOCH is '{value}'; give whole seconds since 1970, or unset it")]
    SourceDate {
        /// What stands there.
        value: String,
    },
    /// Cargo does not say what an FMU is made of.
    #[error("cargo cannot list the crates that are linked into {name}: {told}")]
    Linked {
        /// Crate.
        name: String,
        /// What it said.
        told: String,
    },
    /// What is not here that building for other platforms takes.
    #[error("cannot build for every platform that was asked for; deploy/release.md tells how. {missing}")]
    Platforms {
        /// What, how to get it, and for which platform.
        missing: String,
    },
    /// Libraries of two processors that cannot be joined in one file.
    #[error("cannot join the libraries of macOS in one file: {source}")]
    Universal {
        /// Why.
        source: fat_macho::Error,
    },
    /// Cargo built no library of that name.
    #[error("cargo named no shared library for '{target}'; is its crate-type still cdylib?")]
    NoLibrary {
        /// Name of the library target.
        target: String,
    },
    /// A crate has no identifier of its build.
    #[error("cargo told no FMU_GUID of {name}: its build.rs must call `build_identity::tell_cargo`")]
    NoIdentifier {
        /// Crate and model name.
        name: &'static str,
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

impl From<StudyError> for HarnessError {
    fn from(error: StudyError) -> Self {
        Self::Study(Box::new(error))
    }
}

impl From<StatsError> for HarnessError {
    fn from(error: StatsError) -> Self {
        StudyError::from(error).into()
    }
}
