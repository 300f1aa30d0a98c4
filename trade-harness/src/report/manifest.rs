//! `manifest.json`: what was studied, and under `environment` where and when.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::Serialize;
use study::{Calibration, FilterResult, Model, Models, Participant, Plan, Study, scheme_name};

use crate::HarnessError;
use crate::digest::of_file;
use crate::format::json_bytes;
use crate::output::OutputFolder;

/// The whole file; all but `environment` depends on the study alone.
#[derive(Debug, Serialize)]
pub struct Manifest {
    /// Version of the harness.
    pub harness_version: &'static str,
    /// What tells the studies from any others ([`crate::store::identity`]); of a command whose folder is its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identity: Option<String>,
    /// The whole study, as its file tells it: what `rerun` repeats.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub study: Option<Plan>,
    /// SHA-256 of every file that the study reads, by its path in it.
    pub inputs: BTreeMap<String, String>,
    /// Each FMU by its name in the study.
    pub models: BTreeMap<String, ModelFacts>,
    /// Each world.
    pub studies: Vec<StudyFacts>,
    /// What the statistics made of a case whose answers are known; of a command that tries them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// Files written beside the manifest.
    pub files: Vec<String>,
    /// What differs from one repeat to the next.
    pub environment: Environment,
}

/// Which FMU it was.
#[derive(Debug, Serialize)]
pub struct ModelFacts {
    model_name: String,
    version: Option<String>,
    guid: String,
    /// SHA-256 of the `.fmu` file, which tells binaries of one GUID apart.
    sha256: String,
}

impl ModelFacts {
    /// Facts from the model description and the file.
    ///
    /// # Errors
    /// [`HarnessError::Read`].
    pub fn new(model: &Model) -> Result<Self, HarnessError> {
        let d = model.fmu.description();
        Ok(Self {
            model_name: d.model_name.clone(),
            version: d.version.clone(),
            guid: d.guid.clone(),
            sha256: of_file(model.fmu.path())?,
        })
    }
}

/// What one world's study consisted of.
#[derive(Debug, Clone, Serialize)]
pub struct StudyFacts {
    scenario: String,
    case: String,
    runs: u32,
    study_seed: i32,
    duration_s: f64,
    scored_from_s: f64,
    step_s: f64,
    sample_period_s: f64,
    scheme: &'static str,
    truth: BTreeMap<String, String>,
    filters: Vec<FilterFacts>,
    /// Parameters of each driver, by its label.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    drivers: BTreeMap<String, BTreeMap<String, String>>,
    /// What it takes to run this study again.
    plan: Plan,
    /// The mission, every key of it.
    mission: interface::Mission,
    /// What of it a filter is told that asks for the mission: the world's own values where it states no belief.
    told: interface::Navigation,
    /// What a reader should know of it.
    notes: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
struct FilterFacts {
    filter: String,
    parameters: BTreeMap<String, String>,
    /// What it calculated of them and of the mission; of one that came so far.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    calculated: BTreeMap<String, f64>,
}

impl StudyFacts {
    /// Facts from the definition of the study.
    ///
    /// * `plan`: what it was part of.
    /// * `results`: of the filters that have run, in any order.
    pub fn new(plan: &Plan, study: &Study, results: &[FilterResult]) -> Self {
        let calculated = |label: &str| {
            let result = results.iter().find(|result| result.label == label);
            let first = result.and_then(|result| result.runs.first());
            first.map(|run| run.calculated.iter().cloned().collect())
        };
        let spec = &study.spec;
        let parameters = |p: &Participant| p.record.iter().cloned().collect();
        Self {
            scenario: spec.world.name.clone(),
            case: study.case.clone(),
            runs: study.runs,
            study_seed: spec.seed,
            duration_s: spec.world.duration_s,
            scored_from_s: spec.world.scored_from_s,
            step_s: spec.step,
            sample_period_s: spec.sample_period,
            scheme: scheme_name(spec.scheme),
            truth: parameters(&spec.truth),
            filters: spec
                .filters
                .iter()
                .map(|f| FilterFacts {
                    filter: f.label.clone(),
                    parameters: parameters(f),
                    calculated: calculated(&f.label).unwrap_or_default(),
                })
                .collect(),
            drivers: spec.drivers.iter().map(|d| (d.label.clone(), parameters(d))).collect(),
            plan: plan.of_case(&study.case).resolved(spec),
            mission: spec.world.mission.clone(),
            told: spec.world.mission.navigation(),
            notes: spec.world.notes.clone(),
        }
    }
}

/// Where and when the study ran.
#[derive(Debug, Serialize)]
pub struct Environment {
    /// What the harness was built from.
    pub build: Build,
    /// Date and time of the end, UTC.
    pub date: String,
    /// Name of the machine, if it tells.
    pub host: Option<String>,
    /// Operating system and processor family.
    pub platform: String,
    /// Cores available.
    pub cores: Option<usize>,
    /// Threads used.
    pub jobs: usize,
    /// Command line.
    pub command_line: Vec<String>,
    /// File of each FMU.
    pub fmu_paths: BTreeMap<String, String>,
    /// Time on the clock for all runs, s.
    pub wall_time_s: f64,
    /// Peak memory of the process, MiB, if the system tells.
    pub peak_memory_mib: Option<f64>,
}

/// What the harness was built from.
#[derive(Debug, Serialize)]
pub struct Build {
    /// Commit of the project; none outside a checkout.
    pub commit: Option<&'static str>,
    /// Whether files differed from that commit.
    pub dirty: Option<bool>,
    /// Compiler.
    pub compiler: Option<&'static str>,
}

impl Build {
    fn of_this_program() -> Self {
        Self {
            commit: option_env!("TRADE_HARNESS_COMMIT"),
            dirty: option_env!("TRADE_HARNESS_DIRTY").map(|text| text == "true"),
            compiler: option_env!("TRADE_HARNESS_COMPILER"),
        }
    }
}

impl Environment {
    /// Looks around.
    ///
    /// * `wall`: time on the clock for all runs.
    pub fn now<'a>(jobs: usize, wall: Duration, models: impl Iterator<Item = &'a Model>) -> Self {
        let path = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let host = fs::read_to_string("/proc/sys/kernel/hostname").ok();
        Self {
            build: Build::of_this_program(),
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            host: host
                .map(|h| h.trim().to_owned())
                .or_else(|| std::env::var("COMPUTERNAME").ok()),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            cores: std::thread::available_parallelism().ok().map(usize::from),
            jobs,
            command_line: std::env::args().collect(),
            fmu_paths: models
                .map(|m| (m.name.clone(), path(m.fmu.path()).display().to_string()))
                .collect(),
            wall_time_s: wall.as_secs_f64(),
            peak_memory_mib: peak_memory_mib(),
        }
    }
}

/// Peak memory of this process so far, MiB, if the system tells.
pub fn peak_memory_mib() -> Option<f64> {
    resident_peak_mib(Path::new("/proc/self/status"))
}

/// `VmHWM` of Linux, MiB.
fn resident_peak_mib(status: &Path) -> Option<f64> {
    let text = fs::read_to_string(status).ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes / 1024.0)
}

impl Manifest {
    /// What a command has done.
    ///
    /// * `jobs`: threads; `wall`: time on the clock for all runs.
    ///
    /// # Errors
    /// An FMU that cannot be read any more.
    pub fn new(models: &Models, studies: Vec<StudyFacts>, jobs: usize, wall: Duration) -> Result<Self, HarnessError> {
        let facts = |model: &Model| Ok((model.name.clone(), ModelFacts::new(model)?));
        Ok(Self {
            harness_version: env!("CARGO_PKG_VERSION"),
            identity: None,
            calibration: None,
            study: None,
            inputs: BTreeMap::new(),
            models: models.all().map(facts).collect::<Result<_, HarnessError>>()?,
            studies,
            files: Vec::new(),
            environment: Environment::now(jobs, wall, models.all()),
        })
    }

    /// Writes `manifest.json`, with the names of the files beside it, and adds its own to them.
    ///
    /// # Errors
    /// [`HarnessError::Json`], [`HarnessError::Write`].
    pub fn write(mut self, folder: &OutputFolder, files: &mut Vec<String>) -> Result<(), HarnessError> {
        self.files.clone_from(files);
        folder.write("manifest.json", &self.render(folder.path())?)?;
        files.push("manifest.json".to_owned());
        Ok(())
    }

    /// Contents of `manifest.json`; what lies in the folder is told from there, so that a study tells the same wherever it is.
    ///
    /// # Errors
    /// [`HarnessError::Json`].
    fn render(&self, folder: &Path) -> Result<Vec<u8>, HarnessError> {
        let mut manifest = serde_json::to_value(self)?;
        let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        from_folder(&mut manifest["studies"], &whole);
        json_bytes(&manifest)
    }
}

/// Turns paths below a folder into those from it.
fn from_folder(value: &mut serde_json::Value, folder: &Path) {
    use serde_json::Value;
    match value {
        Value::String(text) => {
            if let Ok(inside) = Path::new(text.as_str()).strip_prefix(folder) {
                *text = inside.display().to_string();
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|value| from_folder(value, folder)),
        Value::Object(map) => map.values_mut().for_each(|value| from_folder(value, folder)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peak_memory_is_read_from_a_status_file() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("status");
        fs::write(&file, "Name:\tx\nVmHWM:\t   51200 kB\nVmRSS:\t 1 kB\n").unwrap();
        assert!((resident_peak_mib(&file).unwrap() - 50.0).abs() < 1e-12);
        assert!(resident_peak_mib(&dir.path().join("none")).is_none());
    }
}
