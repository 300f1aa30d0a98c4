//! What the command line understands.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use study::{
    Assignment, FilterChoice, ForeignFilter, Grid, Isolation, Mapping, Phase, Plan, Requirement, Shard, Variation,
    check_case, inline,
};

use crate::pack;
use crate::pack::platforms::Wanted;
use crate::tuning::ranges::Range;
use crate::tuning::standing::Objective;

/// Compares navigation filters in simulated worlds; both are FMI 2.0 FMUs.
#[derive(Debug, Parser)]
#[command(name = "trade-harness", version, about, arg_required_else_help = true)]
pub struct Cli {
    /// One JSON document on standard output instead of text; an error is one, too
    #[arg(long, global = true)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What the harness can do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List missions, filters, presets, parameters, ports, distributions and metrics
    List(ListArgs),
    /// Build our FMUs and pack them as .fmu files
    Pack(PackArgs),
    /// Run a Monte Carlo study of several filters in the same worlds
    Compare(CompareArgs),
    /// Put the parts of a study together that 'compare --shard' has done
    Merge(MergeArgs),
    /// Repeat a study from its manifest alone and tell whether every byte is the same
    Rerun(RerunArgs),
    /// Write the HTML page of a finished study again, from its files
    Report(ReportArgs),
    /// Search for every filter's best parameters, then compare the filters at their best
    Tune(TuneArgs),
    /// Hold laws against the best constant noise, chosen in hindsight for each level of disturbance
    Regret(RegretArgs),
    /// Write one run out, sample by sample
    Replay(ReplayArgs),
    /// Rerun everything the two papers print and hold it beside their numbers
    Reproduce(ReproduceArgs),
    /// Show what an FMU is and which variables it has
    Inspect(InspectArgs),
    /// Check FMUs, anyone's, against FMI 2.0: archive, description and the library at work
    Check(CheckArgs),
    /// Write, check and describe mission files
    #[command(subcommand)]
    Mission(MissionCommand),
    /// Tell what every column of the CSV files means
    Columns,
    /// Print a script that completes commands and options in a shell
    #[command(after_help = "Example, for this shell alone:\n  source <(trade-harness completions bash)")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Make runs for a study of another process
    #[command(hide = true)]
    Worker(WorkerArgs),
    /// Make a trial for 'check' of another process
    #[command(hide = true)]
    CheckTrial(CheckTrialArgs),
}

/// Where our FMUs come from.
#[derive(Debug, Clone, Args)]
pub struct BuildArgs {
    /// Use the .fmu files as they are, without building
    #[arg(long)]
    pub no_build: bool,
    /// Folder of fmu-truth.fmu and fmu-nav.fmu [default: target/fmu of the workspace]
    #[arg(long, value_name = "DIR")]
    pub fmu_dir: Option<PathBuf>,
    /// Workspace to build in
    #[arg(long, value_name = "DIR", default_value_os_t = pack::home_workspace(), hide_default_value = true)]
    pub workspace: PathBuf,
    /// No progress, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Which worlds.
#[derive(Debug, Clone, Args)]
pub struct WorldArgs {
    /// Missions that come with the project, one study each [default: leo_venting, unless --mission is given]
    #[arg(long = "scenario", value_name = "NAME,...", value_delimiter = ',')]
    pub scenarios: Vec<String>,
    /// A mission file, a study of its own; repeatable
    #[arg(long = "mission", value_name = "FILE")]
    pub missions: Vec<PathBuf>,
}

/// How many runs, on how many threads.
#[derive(Debug, Clone, Args)]
pub struct WorkArgs {
    /// Runs of each study [default: 100]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=i64::from(i32::MAX)))]
    pub runs: Option<u32>,
    /// Threads [default: all cores]
    #[arg(long)]
    pub jobs: Option<std::num::NonZeroUsize>,
}

impl WorkArgs {
    /// Runs asked for, or those of a plan that does not tell.
    pub fn runs(&self) -> u32 {
        self.runs.unwrap_or(Plan::default().runs)
    }
}

/// Which filters, which parameters.
#[derive(Debug, Clone, Args)]
pub struct StudyArgs {
    /// Filters of fmu-nav, each with a preset if it is not 'paper'; 'all' for every one with a meaning in the world, empty
    /// for none [default: those of the mission, see list missions]
    #[arg(long, value_name = "NAME[@PRESET],...", value_delimiter = ',', value_parser = optional_choice)]
    pub filters: Vec<OptionalChoice>,
    /// Seed of the study; with the number of a run it selects every random stream [default: 1]
    #[arg(long, allow_negative_numbers = true, value_parser = clap::value_parser!(i32).range(0..))]
    pub seed: Option<i32>,
    /// Set a parameter of fmu-truth, fmu-nav or a foreign filter, after the preset, or any key of the mission, as in
    /// mission.vent.co2.period_s=300; repeatable
    #[arg(long = "set", value_name = "MODEL.VARIABLE=VALUE")]
    pub assignments: Vec<Assignment>,
    /// Draw a Real parameter anew in each run, the same for all filters: uniform:LOW:HIGH, loguniform:LOW:HIGH,
    /// normal:MEAN:SIGMA, lognormal:MEDIAN:FACTOR (one sigma of the logarithm), choice:VALUE:VALUE:...; repeatable
    #[arg(long = "vary", value_name = "MODEL.VARIABLE=DISTRIBUTION")]
    pub variations: Vec<Variation>,
    /// Communication step, s [default: the truth's sample period]
    #[arg(long, value_name = "H")]
    pub step: Option<f64>,
    /// When values are handed over [default: gauss-seidel]
    #[arg(long, value_enum)]
    pub scheme: Option<SchemeChoice>,
    /// Foreign FMU in the place of fmu-truth
    #[arg(long, value_name = "PATH")]
    pub truth: Option<PathBuf>,
    /// Add a foreign filter FMU under a label; repeatable
    #[arg(long = "nav", value_name = "LABEL=PATH")]
    pub foreign: Vec<ForeignFilter>,
    /// Add a driver FMU under a label: guidance or life support that pushes the vehicles through inputs of the truth such as a_cmd_c_n and
    /// f_dist_t_bt. One that reads est.* or pred.* gives every filter a world of its own, seeded alike; repeatable
    #[arg(long = "drive", value_name = "LABEL=PATH")]
    pub drivers: Vec<ForeignFilter>,
    /// Let foreign filters read truth.*, as a bound rather than a filter
    #[arg(long)]
    pub allow_truth: bool,
    /// Tell what a variable of a foreign FMU is called here; repeatable
    #[arg(long = "map", value_name = "LABEL.THEIR_NAME=OUR_NAME")]
    pub mappings: Vec<Mapping>,
    /// Read more of these from a TOML file: a table for each LABEL, of THEIR_NAME = "OUR_NAME"; repeatable
    #[arg(long = "map-file", value_name = "FILE")]
    pub map_files: Vec<PathBuf>,
    /// Read tuned sets that 'tune' has written; they go by NAME@tuned
    #[arg(long, value_name = "FILE")]
    pub tuned: Option<PathBuf>,
    /// Where our FMUs come from.
    #[command(flatten)]
    pub build: BuildArgs,
}

impl StudyArgs {
    /// Seed asked for, or that of a plan that does not tell.
    pub fn seed(&self) -> i32 {
        self.seed.unwrap_or(Plan::default().seed)
    }
}

/// An element of `--filters`; `--filters ''` is one that chooses nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OptionalChoice(pub Option<FilterChoice>);

fn optional_choice(text: &str) -> Result<OptionalChoice, String> {
    if text.is_empty() {
        Ok(OptionalChoice(None))
    } else {
        text.parse().map(|c| OptionalChoice(Some(c)))
    }
}

/// Order of exchange and stepping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SchemeChoice {
    /// Truth first; the filter gets its new sample in the same step
    GaussSeidel,
    /// All at once; samples arrive one step later, with the same estimates
    Jacobi,
}

impl From<SchemeChoice> for cosim::Scheme {
    fn from(choice: SchemeChoice) -> Self {
        match choice {
            SchemeChoice::GaussSeidel => Self::GaussSeidel,
            SchemeChoice::Jacobi => Self::Jacobi,
        }
    }
}

/// `list`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness list filters milton\n  trade-harness list parameters fmu-truth lidar\n  trade-harness list --json presets"
)]
pub struct ListArgs {
    /// What to list, or the name of a mission or filter [default: an overview]
    #[arg(value_parser = TopicParser)]
    pub what: Option<Topic>,
    /// One of them: a mission, a filter, an FMU, a file
    pub name: Option<String>,
    /// Of an FMU's parameters: those of one filter or of one part of the world, as in 'parameters fmu-truth lidar'
    pub of: Option<String>,
}

impl ListArgs {
    /// All of one kind.
    pub fn of(what: Listed) -> Self {
        Self {
            what: Some(Topic::Kind(what)),
            name: None,
            of: None,
        }
    }
}

/// What is asked of `list`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Topic {
    /// Everything of a kind.
    Kind(Listed),
    /// One thing by its name, whatever kind it is.
    Named(String),
}

/// Takes any name, but offers the kinds to help texts and shells.
#[derive(Debug, Clone)]
struct TopicParser;

impl TypedValueParser for TopicParser {
    type Value = Topic;

    fn parse_ref(&self, _: &clap::Command, _: Option<&clap::Arg>, value: &OsStr) -> Result<Topic, clap::Error> {
        let name = value.to_string_lossy();
        Ok(Listed::from_str(&name, false).map_or_else(|_| Topic::Named(name.clone().into_owned()), Topic::Kind))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let kinds = Listed::value_variants().iter();
        Some(Box::new(kinds.filter_map(ValueEnum::to_possible_value)))
    }
}

/// What can be listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Listed {
    /// Missions that come with the project
    Missions,
    /// Filters of fmu-nav with presets, parameters and search ranges
    Filters,
    /// Every parameter set
    Presets,
    /// What --set and --vary change
    Parameters,
    /// Variables that connect truth and filters
    Ports,
    /// What --vary draws from
    Distributions,
    /// Columns of the CSV files
    #[value(alias = "columns")]
    Metrics,
}

/// `mission`.
#[derive(Debug, Subcommand)]
pub enum MissionCommand {
    /// Write a commented mission file to start from
    New(MissionNewArgs),
    /// Read a mission file, fly it without noise and show what happens
    Check(MissionCheckArgs),
    /// Print the JSON schema of mission files, for editors
    #[command(after_help = "Example:\n  trade-harness mission schema > mission.schema.json")]
    Schema,
}

/// `mission new`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness mission new my_mission\n  trade-harness mission new moon --from lunar_inspection --out missions"
)]
pub struct MissionNewArgs {
    /// Name of the mission; the file is NAME.toml
    pub name: String,
    /// Mission that comes with the project to start from
    #[arg(long, value_name = "NAME", default_value = "leo_venting")]
    pub from: String,
    /// Folder to write to
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
}

/// `mission check`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness mission check my_mission.toml\n  trade-harness mission check leo_venting --set mission.vent.co2.period_s=300\n\n\
        Exit code 0: fit to fly. 1: it flies, but the time grid is too coarse. 2: it cannot be used."
)]
pub struct MissionCheckArgs {
    /// The mission file, or the name of a mission that comes with the project
    #[arg(value_name = "FILE")]
    pub mission: PathBuf,
    /// Change a key, as in mission.vent.co2.period_s=300; repeatable
    #[arg(long = "set", value_name = "mission.KEY=VALUE")]
    pub assignments: Vec<Assignment>,
    /// Number of the run whose vents are flown
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=i64::from(i32::MAX)))]
    pub run: u32,
    /// Seed of the study whose vents are flown
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(i32).range(0..))]
    pub seed: i32,
    /// Do not fly it a second time with half the time grid
    #[arg(long)]
    pub once: bool,
    /// Where our FMUs come from.
    #[command(flatten)]
    pub build: BuildArgs,
}

/// `pack`.
#[derive(Debug, Args)]
#[command(
    after_help = "fmu-truth.fmu, fmu-nav.fmu, and relative-navigation.ssp, both as one system with the values of every mission.\n\nExamples:\n  trade-harness pack\n  trade-harness pack --out fmus\n  trade-harness pack --mission my_mission.toml --out fmus\n  trade-harness pack --platforms all\n  trade-harness pack --platforms linux64,win64 --out fmus"
)]
pub struct PackArgs {
    /// Put this mission into both FMUs as the one they run unless told otherwise
    #[arg(long, value_name = "FILE")]
    pub mission: Option<PathBuf>,
    /// Platforms of the archive, which then does not depend on the machine it is made on [default: this one's, as cargo builds]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub platforms: Vec<Wanted>,
    /// Folder to write to [default: target/fmu of the workspace]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Workspace to build in
    #[arg(long, value_name = "DIR", default_value_os_t = pack::home_workspace(), hide_default_value = true)]
    pub workspace: PathBuf,
    /// No progress, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `compare`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness compare\n  trade-harness compare --scenario leo_venting,nrho_venting --runs 200 --seed 7\n  trade-harness compare --filters snc,milton@consistent --set fmu-truth.vent.scale=10\n  trade-harness compare --grid fmu-truth.lidar.dropout_probability=0,0.2 --runs 50\n  trade-harness compare --study studies/vents_ten_times.toml --out results/vents\n  trade-harness compare --ssp target/fmu/relative-navigation.ssp --runs 20"
)]
pub struct CompareArgs {
    /// Which worlds.
    #[command(flatten)]
    pub worlds: WorldArgs,
    /// How many runs.
    #[command(flatten)]
    pub work: WorkArgs,
    /// A study file, which says all that the options say and more; options go before it
    #[arg(long = "study", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// A system structure, archive or folder, in the place of --scenario, --filters, --truth, --nav and --drive: the component with
    /// outputs truth.* is the world, those with est.* are filters, others drivers; options go before what its bindings say
    #[arg(long, value_name = "FILE.ssp", conflicts_with_all = ["file", "truth", "foreign", "drivers", "fmu_dir"])]
    pub ssp: Option<PathBuf>,
    /// Folder for the results [default: results/compare, or results/NAME for the study file NAME.toml]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Cases with each of these values, combined with those of every other --grid; repeatable
    #[arg(long = "grid", value_name = "MODEL.VARIABLE=VALUE,VALUE,...", value_parser = Grid::axis)]
    pub grids: Vec<Grid>,
    /// Score a part of the runs by itself, in the words of a study file: 'name = "last", from_s = 4480'; repeatable
    #[arg(long = "phase", value_name = "TABLE", value_parser = inline::<Phase>)]
    pub phases: Vec<Phase>,
    /// Require something, in the words of a study file: 'metric = "pos_rmse_m", phase = "last", at_most = 0.5'; exit code 1 when
    /// it is missed; repeatable
    #[arg(long = "require", value_name = "TABLE", value_parser = inline::<Requirement>)]
    pub requirements: Vec<Requirement>,
    /// Length of the runs, s [default: the mission's]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Text of the 'case' column [default: nominal, or what differs from it]
    #[arg(long, value_name = "NAME", value_parser = case_name)]
    pub case: Option<String>,
    /// What becomes of a study that is in the folder.
    #[command(flatten)]
    pub folder: FolderArgs,
    /// Where runs are made.
    #[command(flatten)]
    pub isolation: IsolationArgs,
    /// End with exit code 1 when the scenario as published misses one of its bounds
    #[arg(long, conflicts_with_all = ["assignments", "variations", "truth", "drivers", "duration", "grids"])]
    pub check: bool,
    /// Do not write report.html
    #[arg(long)]
    pub no_report: bool,
    /// All columns of the table, and one by axis; the plain one fits 80 columns
    #[arg(long)]
    pub wide: bool,
    /// Which filters, which parameters.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// What becomes of a study that is in the folder already, and which part of the runs is done.
#[derive(Debug, Clone, Default, Args)]
pub struct FolderArgs {
    /// Go on with the unfinished study in the folder; its finished runs are not made again
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Set a study that is in the folder aside (DIR.old-1) and begin anew
    #[arg(long)]
    pub force: bool,
    /// Do part I of N of the runs, for 'merge' to put together
    #[arg(long, value_name = "I/N", conflicts_with = "check")]
    pub shard: Option<Shard>,
}

/// Where runs are made: in this process, or in others that may die of an FMU.
#[derive(Debug, Clone, Args)]
pub struct IsolationArgs {
    /// Make runs in worker processes, so that an FMU that crashes, loops or eats memory costs its own runs alone [default: as
    /// soon as a foreign FMU takes part]
    #[arg(long, conflicts_with = "no_isolate")]
    pub isolate: bool,
    /// Make runs in this process, foreign FMUs or not
    #[arg(long)]
    pub no_isolate: bool,
    /// Longest time of one call of an FMU in a worker, s [default: 60]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub call_limit: Option<f64>,
    /// Longest time of a run in a worker, s [default: 3600]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub run_limit: Option<f64>,
    /// Most memory of a worker, MiB [default: 2048]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(64..=1 << 24))]
    pub memory_limit: Option<u64>,
    /// Load a library into every worker before any FMU, for FMUs that expect it there; 'python' is that of the python3 on the
    /// path, which filters made with PythonFMU need; repeatable
    #[arg(long, value_name = "LIB", conflicts_with = "no_isolate")]
    pub preload: Vec<PathBuf>,
}

impl IsolationArgs {
    /// What is asked for here, else what a plan says.
    pub fn changed(&self, plan: &Isolation) -> Isolation {
        let asked = (self.isolate || self.no_isolate).then_some(self.isolate);
        Isolation {
            isolate: asked.or(plan.isolate),
            call_limit_s: self.call_limit.unwrap_or(plan.call_limit_s),
            run_limit_s: self.run_limit.unwrap_or(plan.run_limit_s),
            memory_limit_mib: self.memory_limit.unwrap_or(plan.memory_limit_mib),
            preload: plan.preload.iter().chain(&self.preload).cloned().collect(),
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let wrong = || format!("'{text}' is no positive time in seconds");
    let value: f64 = text.parse().map_err(|_| wrong())?;
    (1e-3..=1e9).contains(&value).then_some(value).ok_or_else(wrong)
}

/// `worker`.
#[derive(Debug, Args)]
pub struct WorkerArgs {
    /// What the parent has written down
    pub job: PathBuf,
}

/// `rerun`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness rerun results/compare\n  trade-harness rerun results/compare --out results/again --jobs 1"
)]
pub struct RerunArgs {
    /// Folder of a finished study
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Folder for the results [default: DIR.rerun]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Set a study that is in that folder aside
    #[arg(long)]
    pub force: bool,
    /// Go on with FMUs and files that are others than they were
    #[arg(long)]
    pub other_files: bool,
    /// Threads [default: all cores]
    #[arg(long)]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// No progress, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `merge`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples, of which the first two may run on different machines:\n  trade-harness compare --shard 1/2 --out results/parts\n  trade-harness compare --shard 2/2 --out results/parts\n  trade-harness merge results/parts"
)]
pub struct MergeArgs {
    /// Folder in which the parts of a study were done
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// All columns of the table, and one by axis; the plain one fits 80 columns
    #[arg(long)]
    pub wide: bool,
    /// Threads [default: all cores]
    #[arg(long)]
    pub jobs: Option<std::num::NonZeroUsize>,
    /// No progress, only results and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `report`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness report results/compare\n  trade-harness report results/compare --svg --png
  trade-harness report results/compare --parquet"
)]
pub struct ReportArgs {
    /// Folder of a finished study, or of 'tune', 'reproduce' or 'regret'; report.html goes there
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Write the figures as SVG as well, into DIR/figures
    #[arg(long)]
    pub svg: bool,
    /// Write the figures as PNG as well, into DIR/figures
    #[arg(long)]
    pub png: bool,
    /// Write the histories (epochs/, run_errors/, paths/) as Parquet files beside the CSV files; of a program built with
    /// `--features parquet`
    #[arg(long)]
    pub parquet: bool,
    /// Say nothing of what was written
    #[arg(long, short)]
    pub quiet: bool,
}

/// `tune`.
#[derive(Debug, Args)]
// Seeds of the search, not of a study; and each filter once, since a search leaves its preset behind.
#[command(
    after_help = "Examples:\n  trade-harness tune --filters snc,milton\n  trade-harness tune --scenario nrho_venting --evaluations 96 --objective velocity\n  trade-harness compare --tuned results/tune/tuned.json --filters milton@tuned"
)]
#[command(mut_arg("seed", |a| a.default_value("1001").help("Seed of the worlds to search in")))]
#[command(mut_arg("runs", |a| a.default_value("8").help("Runs of each candidate, in the same worlds for all")))]
#[command(mut_arg("scenarios", |a| a.help("Scenarios, one search each")))]
#[command(mut_arg("filters", |a| a.help("Filters of fmu-nav, each with a preset if it is not 'paper'; empty for none [default: every one]")))]
pub struct TuneArgs {
    /// Which worlds.
    #[command(flatten)]
    pub worlds: WorldArgs,
    /// How many runs.
    #[command(flatten)]
    pub work: WorkArgs,
    /// Candidates of each filter, however many parameters it has; the first is the filter as given
    #[arg(long, default_value_t = 48, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub evaluations: u32,
    /// Runs to judge by
    #[arg(long, value_name = "RUNS", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=i64::from(i32::MAX)))]
    pub judge_runs: u32,
    /// Seed of the worlds to judge in; not that of the search
    #[arg(long, value_name = "SEED", default_value_t = 1, allow_negative_numbers = true, value_parser = clap::value_parser!(i32).range(0..))]
    pub judge_seed: i32,
    /// The error to make small
    #[arg(long, value_enum, default_value_t = Objective::Position)]
    pub objective: Objective,
    /// Least mean NEES of position and velocity, over 6, that a candidate may have
    #[arg(long, value_name = "NEES", default_value_t = 0.5, allow_negative_numbers = true)]
    pub nees_min: f64,
    /// Largest
    #[arg(long, value_name = "NEES", default_value_t = 2.0, allow_negative_numbers = true)]
    pub nees_max: f64,
    /// Search a Real parameter on a logarithmic scale, beside or instead of the FMU's own range; repeatable
    #[arg(long = "range", value_name = "MODEL.VARIABLE=LOW:HIGH")]
    pub ranges: Vec<Range>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "results/tune")]
    pub out: PathBuf,
    /// All columns of the table; the plain one fits 80 columns
    #[arg(long)]
    pub wide: bool,
    /// Load a library before any FMU, for FMUs that expect it there; 'python' is that of the python3 on the path, which filters
    /// made with PythonFMU need; repeatable
    #[arg(long, value_name = "LIB")]
    pub preload: Vec<PathBuf>,
    /// Which filters, which parameters.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// `regret`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness regret --filters hybrid,imm --runs 30\n  trade-harness regret --scenario leo_venting,nrho_venting,formation --nav mine=my_filter.fmu\n  trade-harness regret --at vents_10,vents_100\n  trade-harness regret --print-levels > levels.toml\n\nEach level that is through is kept in DIR/trials, and not run again."
)]
#[command(mut_arg("filters", |a| a.help("Laws, each with a preset if it is not 'paper' [default: hybrid, change_point, imm, mmae, milton@consistent, constrained_q, rbfnn_ekf]")))]
pub struct RegretArgs {
    /// Which worlds.
    #[command(flatten)]
    pub worlds: WorldArgs,
    /// How many runs.
    #[command(flatten)]
    pub work: WorkArgs,
    /// Only these levels
    #[arg(long, value_name = "LEVEL,...", value_delimiter = ',')]
    pub at: Vec<String>,
    /// Levels and constants from a file of your own
    #[arg(long, value_name = "FILE")]
    pub levels: Option<PathBuf>,
    /// Print the file of levels that comes with the project, and end
    #[arg(long)]
    pub print_levels: bool,
    /// Runs by which the constants are chosen that then fly every run
    #[arg(long, value_name = "RUNS", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=i64::from(i32::MAX)))]
    pub scouts: u32,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "results/regret")]
    pub out: PathBuf,
    /// Replace trials of other settings
    #[arg(long)]
    pub force: bool,
    /// Which filters, which parameters.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// The case stands in a file name.
fn case_name(text: &str) -> Result<String, String> {
    check_case(text).map(|()| text.to_owned())
}

/// `replay`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness replay results/compare --run 37 --filter milton\n  trade-harness replay --run 37 --filters milton\n  trade-harness replay --scenario formation --filters rbfnn_aekf --out results/one.csv"
)]
pub struct ReplayArgs {
    /// Folder of a finished study whose run it is; without one, the options say which study
    #[arg(value_name = "DIR", conflicts_with_all = ["mission", "filters", "seed", "assignments", "variations", "step", "scheme", "truth", "foreign", "drivers", "allow_truth", "mappings", "map_files", "tuned"])]
    pub dir: Option<PathBuf>,
    /// Of the filters of the study in DIR, this one alone; repeatable
    #[arg(long = "filter", value_name = "LABEL")]
    pub labels: Vec<String>,
    /// Case of the study in DIR, where it has several
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,
    /// Of the study in DIR: go on with FMUs and files that are others than they were
    #[arg(long)]
    pub other_files: bool,
    /// Mission that comes with the project [default: leo_venting, or the first of the study in DIR]
    #[arg(long, value_name = "NAME", conflicts_with = "mission")]
    pub scenario: Option<String>,
    /// A mission file
    #[arg(long, value_name = "FILE")]
    pub mission: Option<PathBuf>,
    /// Number of the run
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=i64::from(i32::MAX)))]
    pub run: u32,
    /// CSV file to write; a Parquet file where its name ends in .parquet, by a program built with `--features parquet`
    #[arg(long, value_name = "FILE", default_value = "results/replay.csv")]
    pub out: PathBuf,
    /// Load a library before any FMU, for FMUs that expect it there, beside those that the study in DIR was made with; 'python' is that of the python3 on the path; repeatable
    #[arg(long, value_name = "LIB")]
    pub preload: Vec<PathBuf>,
    /// Which filters, which parameters.
    #[command(flatten)]
    pub study: StudyArgs,
}

/// `reproduce`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  trade-harness reproduce\n  trade-harness reproduce --runs 30 --out results/quick")]
#[command(mut_arg("runs", |a| a.default_value("100").help("Runs of each study; the bounds are meant for 100")))]
pub struct ReproduceArgs {
    /// How many runs.
    #[command(flatten)]
    pub work: WorkArgs,
    /// Seed of the studies
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = clap::value_parser!(i32).range(0..))]
    pub seed: i32,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "results/reproduce")]
    pub out: PathBuf,
    /// Where our FMUs come from.
    #[command(flatten)]
    pub build: BuildArgs,
}

/// `check`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness check tank.fmu\n  trade-harness check target/fmu/*.fmu --json\n  trade-harness check tank.fmu --no-run\n  trade-harness check Toy.fmu --with-tool --preload python\n  trade-harness check --rules\n\n\
        Exit code 0: no error, though there may be warnings and notes. 1: the standard is broken. 2: a file cannot be read."
)]
pub struct CheckArgs {
    /// The .fmu files
    #[arg(value_name = "FILE", required_unless_present = "rules")]
    pub files: Vec<PathBuf>,
    /// List every rule with its section of the standard
    #[arg(long, conflicts_with = "files")]
    pub rules: bool,
    /// Do not run the library, only read the files
    #[arg(long)]
    pub no_run: bool,
    /// Run the library of an FMU that needs a tool, too; the tool is installed
    #[arg(long, conflicts_with = "no_run")]
    pub with_tool: bool,
    /// The longest that one trial of the library may take, s
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds)]
    pub limit: f64,
    /// Every breach of every rule, not the first few
    #[arg(long)]
    pub all: bool,
    /// A library that is loaded before the FMU's, as python for FMUs of PythonFMU; repeatable
    #[arg(long, value_name = "LIBRARY")]
    pub preload: Vec<PathBuf>,
}

/// `check-trial`.
#[derive(Debug, Args)]
pub struct CheckTrialArgs {
    /// What it is told
    pub job: PathBuf,
    /// Which trial
    pub trial: String,
}

/// `inspect`.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  trade-harness inspect target/fmu/fmu-nav.fmu\n  trade-harness inspect my_filter.fmu"
)]
pub struct InspectArgs {
    /// The .fmu file
    #[arg(value_name = "FMU")]
    pub path: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn compare(arguments: &[&str]) -> Result<CompareArgs, String> {
        let all = ["trade-harness", "compare"].iter().chain(arguments);
        match Cli::try_parse_from(all).map_err(|e| e.to_string())?.command {
            Command::Compare(args) => Ok(args),
            other => Err(format!("{other:?}")),
        }
    }

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    /// Command lines in the help of a command and of those below it, by command.
    fn examples(command: &clap::Command) -> Vec<(String, Vec<String>)> {
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let lines = help.lines().filter_map(|line| line.strip_prefix("  trade-harness "));
        let own = (command.get_name().to_owned(), lines.map(str::to_owned).collect());
        let below: Vec<_> = command.get_subcommands().filter(|c| !c.is_hide_set()).collect();
        if below.is_empty() {
            return vec![own];
        }
        below.into_iter().flat_map(examples).collect()
    }

    #[test]
    fn every_command_has_examples_that_work() {
        let home = pack::home_workspace();
        let description = |model: &str| {
            let path = home.join("modelDescription").join(model).join("modelDescription.xml");
            std::fs::read_to_string(path).unwrap()
        };
        for (command, lines) in examples(&Cli::command()) {
            // One takes no options, the other's example is a line of a shell's own.
            let none = ["columns", "completions"].contains(&command.as_str());
            assert!(none || !lines.is_empty(), "{command}");
            for line in lines {
                let words: Vec<&str> = line.split_whitespace().take_while(|word| *word != ">").collect();
                let parsed = Cli::try_parse_from(["trade-harness"].iter().chain(&words));
                assert!(parsed.is_ok(), "{line}: {}", parsed.unwrap_err());
                for word in words {
                    if word.starts_with("studies/") {
                        assert!(home.join(word).is_file(), "{line}: there is no {word}");
                    }
                    if let Some((model, rest)) = word.split_once('.').filter(|(model, _)| model.starts_with("fmu-")) {
                        let variable = rest.split('=').next().unwrap();
                        assert!(description(model).contains(&format!("name=\"{variable}\"")), "{line}");
                    }
                }
            }
        }
    }

    #[test]
    fn defaults_are_those_of_the_manual() {
        let args = compare(&[]).unwrap();
        assert!(args.study.filters.is_empty() && args.study.variations.is_empty());
        assert_eq!(
            (args.work.runs, args.study.seed, args.case.as_deref()),
            (None, None, None)
        );
        assert!(args.worlds.scenarios.is_empty() && args.out.is_none());
        assert!(args.study.step.is_none() && args.work.jobs.is_none());
    }

    #[test]
    fn each_command_has_its_own_number_of_runs() {
        let runs = |command| match Cli::try_parse_from(["trade-harness", command]).unwrap().command {
            Command::Compare(args) => args.work.runs,
            Command::Tune(args) => args.work.runs,
            Command::Reproduce(args) => args.work.runs,
            other => unreachable!("{other:?}"),
        };
        assert_eq!(["compare", "tune", "reproduce"].map(runs), [None, Some(8), Some(100)]);
    }

    #[test]
    fn a_full_line_is_understood() {
        let line = "--scenario a,b --filters snc,milton@x --runs 7 --seed 3 --jobs 2 --out o --case c \
            --set fmu-truth.vent.scale=10 --set other.k=1 --step 0.25 --scheme jacobi --nav other=p.fmu --map other.y=est.r_tc_n";
        let args = compare(&line.split_whitespace().collect::<Vec<_>>()).unwrap();
        assert_eq!(args.worlds.scenarios, ["a", "b"]);
        assert_eq!(args.study.assignments.len(), 2);
        assert_eq!(args.study.scheme, Some(SchemeChoice::Jacobi));
        assert_eq!(args.study.foreign[0].label, "other");
        assert_eq!(args.study.mappings[0].own, "y");
        let none = compare(&["--filters", "", "--nav", "other=p.fmu"]).unwrap();
        assert_eq!(none.study.filters, [OptionalChoice(None)]);
        let varied = compare(&["--vary", "fmu-nav.k=uniform:0.1:10", "--vary", "x.y=loguniform:1:2"]).unwrap();
        assert_eq!(varied.study.variations.len(), 2);
    }

    #[test]
    fn mistakes_are_told_with_the_option() {
        for (arguments, expected) in [
            (&["--runs", "0"][..], "--runs"),
            (&["--runs", "many"], "--runs"),
            (&["--seed", "-1"], "--seed"),
            (&["--seed", "2147483648"], "--seed"),
            (&["--jobs", "0"], "--jobs"),
            (&["--filters", "a@"], "NAME@PRESET"),
            (&["--set", "vent.scale"], "MODEL.VARIABLE=VALUE"),
            (&["--nav", "x.fmu"], "LABEL=PATH"),
            (&["--map", "x"], "THEIR_NAME"),
            (&["--scheme", "newton"], "gauss-seidel"),
            (&["--case", "a/b"], "letters"),
            (&["--steps", "1"], "--step"),
            (&["--check", "--set", "fmu-truth.vent.scale=0"], "--check"),
            (&["--check", "--vary", "fmu-truth.vent.scale=uniform:0:1"], "--check"),
            (&["--check", "--duration", "900"], "--duration"),
            (&["--check", "--drive", "push=p.fmu"], "--drive"),
            (&["--check", "--grid", "fmu-truth.vent.scale=1,10"], "--grid"),
            (&["--vary", "fmu-truth.vent.scale=uniform:2:1"], "2 to 1 is empty"),
            (&["--vary", "fmu-truth.vent.scale"], "uniform:LOW:HIGH"),
        ] {
            let error = compare(arguments).unwrap_err();
            assert!(error.contains(expected), "{arguments:?}: {error}");
        }
    }
}
