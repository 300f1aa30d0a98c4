//! What is studied.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use cosim::Scheme;
use interface::mission::Phase;
use serde::{Deserialize, Serialize};

use crate::arguments::{Assignment, FilterChoice, ForeignFilter, Mapping, PAPER};
use crate::error::StudyError;
use crate::grid::{Grid, points};
use crate::requirement::Requirement;
use crate::spec::Spec;
use crate::tuned::TunedSet;
use crate::variation::Variation;
use crate::worker::Limits;
use crate::world::World;
use crate::worlds::{From, MISSION, Source};

/// A study as somebody asks for it; in a file it has the names of the command line's options.
///
/// ```
/// let plan: study::Plan = serde_json::from_str(
///     r#"{
///         "scenario": ["leo_venting"],
///         "filters": ["snc", "milton@consistent"],
///         "runs": 20,
///         "set": ["fmu-truth.vent.scale=10"],
///         "vary": ["fmu-truth.lidar.sigma_range=loguniform:0.01:1"]
///     }"#,
/// )
/// .unwrap();
/// assert!(plan.check().is_ok());
/// assert_eq!(plan.seed, 1);
/// assert_eq!(plan.case_text(), "vent.scale-10_lidar.sigma_range-loguniform-0.01-1");
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Plan {
    /// Names of missions that come with the project, a study each.
    #[serde(rename = "scenario")]
    pub scenarios: Vec<String>,
    /// Mission files, a study each, after those.
    #[serde(rename = "mission")]
    pub missions: Vec<PathBuf>,
    /// Text of the `case` column; with the world it names a study. `None`: what differs from the missions as they stand.
    pub case: Option<String>,
    /// Filters of fmu-nav, and tuned foreign ones; `None` for those of each world, [`ALL`] for every one with a meaning there.
    pub filters: Option<Vec<FilterChoice>>,
    /// Runs of each study; run j has the parameter `run` = j.
    pub runs: u32,
    /// Seed of the studies; with the number of a run it selects every random stream.
    pub seed: i32,
    /// Threads; `None` for one on each core. They change no number, so a resolved plan does not tell.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jobs: Option<NonZeroUsize>,
    /// Length of the runs, s; `None` for that of each world.
    pub duration_s: Option<f64>,
    /// Communication step, s; `None` for the truth's sample period.
    pub step_s: Option<f64>,
    /// When values are handed over.
    #[serde(with = "scheme")]
    pub scheme: Scheme,
    /// Parameters set for every run, after the preset.
    #[serde(rename = "set")]
    pub assignments: Vec<Assignment>,
    /// Parameters drawn anew in each run, the same for all filters.
    #[serde(rename = "vary")]
    pub variations: Vec<Variation>,
    /// Foreign FMU in the place of fmu-truth.
    pub truth: Option<PathBuf>,
    /// Foreign filters, after those of fmu-nav.
    #[serde(rename = "nav")]
    pub foreign: Vec<ForeignFilter>,
    /// Drivers: foreign FMUs that push the vehicles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drive: Vec<ForeignFilter>,
    /// Whether foreign filters may read `truth.*`: what does is a bound and no filter.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub allow_truth: bool,
    /// Names in foreign FMUs.
    #[serde(rename = "map")]
    pub mappings: Vec<Mapping>,
    /// Files of names whose mappings join `mappings`.
    #[serde(rename = "map_file", skip_serializing_if = "Vec::is_empty")]
    pub map_files: Vec<PathBuf>,
    /// Files of a search whose sets join `tuned`.
    #[serde(rename = "tuned_file", skip_serializing_if = "Vec::is_empty")]
    pub tuned_files: Vec<PathBuf>,
    /// Parameter sets that a search has found; they stand beside the presets of the FMUs.
    pub tuned: Vec<TunedSet>,
    /// Where runs are made.
    #[serde(skip_serializing_if = "is_default")]
    pub isolation: Isolation,
    /// What is written, and where.
    #[serde(skip_serializing_if = "is_default")]
    pub output: Output,
    /// Settings that differ from case to case: each case is a study of its own, in the same worlds.
    #[serde(rename = "grid", skip_serializing_if = "Vec::is_empty")]
    pub grids: Vec<Grid>,
    /// Named parts of the runs.
    #[serde(rename = "phase", skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<Phase>,
    /// What every case must show.
    #[serde(rename = "requirement", skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<Requirement>,
}

/// Name in `filters` that stands for every filter of fmu-nav that has a meaning in the world, but for its bounds.
pub const ALL: &str = "all";

/// Where runs are made: in the process of the study, or in others that may die of an FMU.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Isolation {
    /// In workers or not; `None`: as soon as a foreign FMU takes part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub isolate: Option<bool>,
    /// Longest time of one call of an FMU in a worker, s.
    pub call_limit_s: f64,
    /// Longest time of a run in a worker, s.
    pub run_limit_s: f64,
    /// Most memory of a worker, MiB.
    pub memory_limit_mib: u64,
    /// Libraries that are loaded before any FMU, in workers and in `replay`, for FMUs that expect them in the program; `python`: that of the `python3` on the
    /// path.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub preload: Vec<PathBuf>,
}

impl Default for Isolation {
    fn default() -> Self {
        let limits = Limits::default();
        Self {
            isolate: None,
            call_limit_s: limits.call_s,
            run_limit_s: limits.run_s,
            memory_limit_mib: limits.memory >> 20,
            preload: Vec::new(),
        }
    }
}

impl Isolation {
    /// Limits of the workers.
    pub fn limits(&self) -> Limits {
        Limits {
            call_s: self.call_limit_s,
            run_s: self.run_limit_s,
            memory: self.memory_limit_mib << 20,
        }
    }

    fn check(&self) -> Result<(), String> {
        for (name, limit) in [("call_limit_s", self.call_limit_s), ("run_limit_s", self.run_limit_s)] {
            if !(1e-3..=1e9).contains(&limit) {
                return Err(format!("{name} = {limit}: give a positive time in seconds"));
            }
        }
        if (64..=1 << 24).contains(&self.memory_limit_mib) {
            Ok(())
        } else {
            Err(format!(
                "memory_limit_mib = {}: give 64 to {}",
                self.memory_limit_mib,
                1 << 24
            ))
        }
    }
}

/// What a study writes, and where.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Folder of the results; `None`: the command's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folder: Option<PathBuf>,
    /// Whether report.html is written.
    pub report: bool,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            folder: None,
            report: true,
        }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            scenarios: vec!["leo_venting".to_owned()],
            missions: Vec::new(),
            case: None,
            filters: None,
            runs: 100,
            seed: 1,
            jobs: None,
            duration_s: None,
            step_s: None,
            scheme: Scheme::GaussSeidel,
            assignments: Vec::new(),
            variations: Vec::new(),
            truth: None,
            foreign: Vec::new(),
            drive: Vec::new(),
            allow_truth: false,
            mappings: Vec::new(),
            map_files: Vec::new(),
            tuned_files: Vec::new(),
            tuned: Vec::new(),
            isolation: Isolation::default(),
            output: Output::default(),
            grids: Vec::new(),
            phases: Vec::new(),
            requirements: Vec::new(),
        }
    }
}

impl Plan {
    /// Checks what no type does: ranges of numbers and the name of the case.
    ///
    /// # Errors
    /// [`StudyError::Plan`].
    pub fn check(&self) -> Result<(), StudyError> {
        let wrong = |field, problem: String| Err(StudyError::Plan { field, problem });
        if self.runs == 0 || i32::try_from(self.runs).is_err() {
            return wrong("runs", format!("= {}: give 1 to {}", self.runs, i32::MAX));
        }
        if self.seed < 0 {
            return wrong("seed", format!("= {}: give 0 or more", self.seed));
        }
        if let Some(duration) = self.duration_s.filter(|d| !(d.is_finite() && *d > 0.0)) {
            return wrong("duration_s", format!("= {duration}: give a positive time in seconds"));
        }
        if let Some(case) = &self.case
            && let Err(problem) = check_case(case)
        {
            return wrong("case", format!("= {case:?}: {problem}"));
        }
        if let Err(problem) = self.isolation.check() {
            return wrong("isolation", problem);
        }
        self.check_phases()?;
        for (requirement, number) in self.requirements.iter().zip(1..) {
            if let Err(problem) = requirement.check() {
                return wrong(
                    "requirement",
                    format!("number {number}, on {}, {problem}", requirement.metric),
                );
            }
            let Some(phase) = &requirement.phase else { continue };
            if let Err(problem) = check_case(phase) {
                return wrong(
                    "requirement",
                    format!(
                        "number {number}, on {}, names phase {phase:?}: {problem}",
                        requirement.metric
                    ),
                );
            }
        }
        self.cases().map(drop)
    }

    fn check_phases(&self) -> Result<(), StudyError> {
        for (place, phase) in self.phases.iter().enumerate() {
            let name = &phase.name;
            let problem = if let Err(problem) = check_case(name) {
                format!("{name:?}: {problem}")
            } else if let Err(problem) = phase.check() {
                problem
            } else if self.phases[..place].iter().any(|other| other.name == *name) {
                format!("'{name}' stands there twice; give each a name of its own")
            } else {
                continue;
            };
            return Err(StudyError::Plan {
                field: "phase",
                problem,
            });
        }
        Ok(())
    }

    /// The plan of each case of the grids, each with its settings and its name; without a grid, the plan itself.
    ///
    /// # Errors
    /// [`StudyError::Plan`] for a grid that is none, [`StudyError::VariedTwice`] for what it sets beside somebody else.
    pub fn cases(&self) -> Result<Vec<Self>, StudyError> {
        if self.grids.is_empty() {
            let case = Some(self.case_text());
            return Ok(vec![Self { case, ..self.clone() }]);
        }
        let wrong = |problem| StudyError::Plan { field: "grid", problem };
        let points = points(&self.grids, self.seed).map_err(wrong)?;
        let mut cases: Vec<Self> = Vec::new();
        for point in points {
            for (index, a) in point.settings.iter().enumerate() {
                let same = |model: &str, variable: &str| model == a.model && variable == a.variable;
                let elsewhere = self.assignments.iter().chain(&point.settings[..index]);
                let varied = self.variations.iter().any(|v| same(&v.model, &v.variable));
                if varied || elsewhere.into_iter().any(|b| same(&b.model, &b.variable)) {
                    let text = format!(
                        "sets {}.{}, which stands elsewhere in the study too",
                        a.model, a.variable
                    );
                    return Err(wrong(text));
                }
            }
            let base = match &self.case {
                Some(case) => vec![case.clone()],
                None if point.named => Vec::new(),
                None => self.deviations(),
            };
            let name = file_name(&[base, point.name].concat());
            if cases.iter().any(|case| case.case.as_deref() == Some(name.as_str())) {
                return Err(wrong(format!("holds case {name} twice")));
            }
            cases.push(Self {
                case: Some(name),
                assignments: [&self.assignments[..], &point.settings[..]].concat(),
                grids: Vec::new(),
                ..self.clone()
            });
        }
        Ok(cases)
    }

    /// The plan of the case of this name; the plan itself where it has none of that name.
    pub fn of_case(&self, name: &str) -> Self {
        let cases = self.cases().unwrap_or_default();
        let found = cases.into_iter().find(|case| case.case.as_deref() == Some(name));
        found.unwrap_or_else(|| self.clone())
    }

    /// Whether the worlds are the missions as they stand.
    pub fn as_published(&self) -> bool {
        let undisturbed = self.truth.is_none() && self.drive.is_empty();
        let unchanged = self.assignments.is_empty() && self.variations.is_empty();
        undisturbed && unchanged && self.duration_s.is_none()
    }

    /// Text of the `case` column: as given, or what differs.
    pub fn case_text(&self) -> String {
        self.case.clone().unwrap_or_else(|| self.case_name())
    }

    /// The worlds, in the order of the plan.
    ///
    /// * `folder`: where the file of a mission goes that the plan changes.
    ///
    /// # Errors
    /// [`StudyError::Mission`], [`StudyError::MissionFile`], [`StudyError::ScenarioTwice`].
    pub fn worlds(&self, folder: &Path) -> Result<Vec<World>, StudyError> {
        let named = self.scenarios.iter().map(|name| From::Name(name));
        let files = self.missions.iter().map(|path| From::File(path));
        let mut found: Vec<World> = Vec::new();
        let case = self.case_text();
        for from in named.chain(files) {
            let source = Source {
                from,
                assignments: &self.assignments,
                folder,
                case: &case,
            };
            let world = source.world()?;
            if found.iter().any(|w| w.name == world.name) {
                return Err(StudyError::ScenarioTwice { name: world.name });
            }
            found.push(world);
        }
        Ok(found)
    }

    /// What is set in the FMUs: all but the mission's own keys.
    pub fn in_fmus(&self) -> impl Iterator<Item = &Assignment> {
        self.assignments.iter().filter(|a| a.model != MISSION)
    }

    /// Filters that are chosen by name in a world; the foreign ones follow them.
    pub fn choices<'a>(&'a self, world: &'a World) -> &'a [FilterChoice] {
        self.filters.as_ref().unwrap_or(&world.filters)
    }

    /// Whether the plan uses our fmu-truth and our fmu-nav.
    pub fn needs(&self) -> [bool; 2] {
        let foreign = |c: &FilterChoice| c.preset != PAPER && self.foreign.iter().any(|f| f.label == c.name);
        let of_ours = |choices: &Vec<FilterChoice>| choices.iter().any(|c| !foreign(c));
        [self.truth.is_none(), self.filters.as_ref().is_none_or(of_ours)]
    }

    /// Threads to use.
    pub fn threads(&self) -> usize {
        self.jobs
            .or_else(|| std::thread::available_parallelism().ok())
            .map_or(1, usize::from)
    }

    /// Without how it is carried out, threads and processes, which changes no number.
    pub fn without_means(&self) -> Self {
        Self {
            jobs: None,
            isolation: Isolation {
                isolate: None,
                ..self.isolation.clone()
            },
            ..self.clone()
        }
    }

    /// The plan of one of its studies alone, with nothing left to a default: what it takes to run that study again.
    pub fn resolved(&self, spec: &Spec) -> Self {
        let named = spec.world.mission_file.is_none();
        let foreign = |label: &str| self.foreign.iter().any(|f| f.label == label);
        let labels = spec
            .filters
            .iter()
            .map(|p| p.label.as_str())
            .filter(|label| !foreign(label));
        Self {
            scenarios: if named {
                vec![spec.world.name.clone()]
            } else {
                Vec::new()
            },
            missions: spec.world.mission_file.clone().into_iter().collect(),
            // What the file of a changed mission holds is not set again.
            assignments: self.in_fmus().cloned().collect(),
            filters: Some(labels.filter_map(|label| label.parse().ok()).collect()),
            case: Some(self.case_text()),

            duration_s: Some(spec.world.duration_s),
            step_s: Some(spec.step),
            tuned: self
                .tuned
                .iter()
                .filter(|t| t.scenario == spec.world.name)
                .cloned()
                .collect(),
            ..self.without_means()
        }
    }
}

/// Longest name of a case that is made from what differs.
const LONGEST_CASE: usize = 60;

impl Plan {
    /// A name of the case that says what differs from the missions as they stand: `nominal` where nothing does, else the
    /// settings, as in `vent.scale-10`; a long list is cut, and a checksum tells it from others.
    pub fn case_name(&self) -> String {
        let differs = self.deviations();
        if differs.is_empty() {
            return "nominal".to_owned();
        }
        file_name(&differs)
    }

    /// What differs from the missions as they stand, a short text each. Filters, runs and seeds are no difference, nor is how
    /// somebody's filter is set up.
    pub fn deviations(&self) -> Vec<String> {
        let foreign = |a: &&Assignment| self.foreign.iter().any(|f| f.label == a.model);
        let own = self.assignments.iter().filter(|a| !foreign(a));
        let set = own.map(|a| format!("{}-{}", a.variable, a.value));
        let varied = self
            .variations
            .iter()
            .map(|v| format!("{}-{}", v.variable, v.distribution));
        let truth = self
            .truth
            .iter()
            .filter_map(|path| Some(format!("truth-{}", path.file_stem()?.to_string_lossy())));
        let drivers = self.drive.iter().map(|driver| format!("drive-{}", driver.label));
        let step = self.step_s.map(|step| format!("step-{step}"));
        let duration = self.duration_s.map(|duration| format!("duration-{duration}"));
        let scheme = (self.scheme != Scheme::GaussSeidel).then(|| scheme_name(self.scheme).to_owned());
        set.chain(varied)
            .chain(truth)
            .chain(drivers)
            .chain(step)
            .chain(duration)
            .chain(scheme)
            .collect()
    }
}

/// A name for files from what differs; a long one is cut, and a checksum tells it from others.
fn file_name(differs: &[String]) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || matches!(c, '.' | '_') {
            c
        } else {
            '-'
        }
    };
    let name: String = differs.join("_").chars().map(plain).collect();
    let name = name.trim_matches(['-', '.']).to_owned();
    if name.len() <= LONGEST_CASE {
        return name;
    }
    let whole = crc32fast::hash(differs.join("_").as_bytes());
    format!("{}-{whole:08x}", &name[..LONGEST_CASE - 9])
}

/// Checks the name of a case, which stands in file names.
///
/// # Errors
/// What is allowed.
pub fn check_case(text: &str) -> Result<(), String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    if !text.is_empty() && text.chars().all(plain) && !text.starts_with('.') {
        Ok(())
    } else {
        Err("use letters, digits, '-', '_' and '.'".to_owned())
    }
}

/// [`Scheme`] as text.
mod scheme {
    use cosim::Scheme;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    const NAMES: [(Scheme, &str); 2] = [(Scheme::GaussSeidel, "gauss-seidel"), (Scheme::Jacobi, "jacobi")];

    pub(super) fn name(scheme: Scheme) -> &'static str {
        NAMES.iter().find(|(s, _)| *s == scheme).map_or("", |(_, name)| name)
    }

    // serde's `with` hands over a reference.
    #[allow(clippy::trivially_copy_pass_by_ref)]
    pub(super) fn serialize<S: Serializer>(scheme: &Scheme, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(name(*scheme))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Scheme, D::Error> {
        let text = String::deserialize(deserializer)?;
        let found = NAMES.iter().find(|(_, name)| *name == text).map(|(scheme, _)| *scheme);
        found.ok_or_else(|| D::Error::custom(format!("scheme '{text}': give gauss-seidel or jacobi")))
    }
}

/// Name of a scheme, as in plans and manifests.
pub fn scheme_name(scheme: Scheme) -> &'static str {
    scheme::name(scheme)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Setting;

    fn read(text: &str) -> Result<Plan, serde_json::Error> {
        serde_json::from_str(text)
    }

    #[test]
    fn an_empty_plan_is_the_default_and_every_plan_is_read_back() {
        assert_eq!(read("{}").unwrap(), Plan::default());
        let plan = Plan {
            scenarios: vec!["formation".to_owned()],
            missions: vec!["a.toml".into()],
            case: Some("odd".to_owned()),
            filters: Some(vec!["snc".parse().unwrap(), "milton@consistent".parse().unwrap()]),
            runs: 7,
            seed: 3,
            jobs: NonZeroUsize::new(2),
            duration_s: Some(100.5),
            step_s: Some(0.1),
            scheme: Scheme::Jacobi,
            assignments: vec!["fmu-truth.vent.scale=10".parse().unwrap()],
            variations: vec!["fmu-nav.k=loguniform:0.1:10".parse().unwrap()],
            truth: Some("their.fmu".into()),
            foreign: vec!["other=b.fmu".parse().unwrap()],
            drive: vec!["guide=g.fmu".parse().unwrap()],
            allow_truth: true,
            mappings: vec!["other.x=est.r_tc_n".parse().unwrap()],
            map_files: vec!["names.toml".into()],
            tuned: vec![TunedSet {
                file: None,
                scenario: "formation".to_owned(),
                filter: "snc".to_owned(),
                preset: PAPER.to_owned(),
                name: "tuned".to_owned(),
                values: [("snc.q".to_owned(), 0.1 + 0.2)].into(),
                conditions: vec!["vent.scale-10".to_owned()],
                search_objective: Some(0.3),
                search_nees: None,
                feasible: true,
            }],
            tuned_files: vec!["sets.json".into()],
            isolation: Isolation {
                isolate: Some(true),
                run_limit_s: 12.5,
                ..Isolation::default()
            },
            output: Output {
                folder: Some("there".into()),
                report: false,
            },
            grids: vec![Grid {
                set: [(
                    "fmu-truth.vent.hold".to_owned(),
                    vec![Setting::Whole(1), Setting::Number(2.5)],
                )]
                .into(),
                ..Grid::default()
            }],
            phases: vec![Phase {
                name: "end".to_owned(),
                from_s: Some(50.0),
                to_s: Some(100.0),
                ..Phase::default()
            }],
            requirements: vec![Requirement {
                metric: "nees".to_owned(),
                filter: Some("snc".to_owned()),
                phase: None,
                at_most: Some(1.5),
                at_least: None,
                confidence: Some(0.95),
                share: None,
            }],
        };
        let text = serde_json::to_string(&plan).unwrap();
        assert_eq!(read(&text).unwrap(), plan, "{text}");
        let file = plan.to_toml().unwrap();
        assert_eq!(Plan::parse("file", &file).unwrap(), plan, "{file}");
        assert!(text.contains("\"set\":[\"fmu-truth.vent.scale=10\"]"), "{text}");
    }

    #[test]
    fn mistakes_in_a_file_are_told_with_their_place() {
        for (text, says) in [
            ("{\"rums\": 3}", "rums"),
            ("{\"scheme\": \"newton\"}", "gauss-seidel or jacobi"),
            ("{\"filters\": [\"a@\"]}", "NAME@PRESET"),
            ("{\"vary\": [\"m.k=uniform:2:1\"]}", "2 to 1 is empty"),
            ("{\"nav\": [\"a.fmu\"]}", "LABEL=PATH"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(says) && error.contains("line 1"), "{text}: {error}");
        }
        for (text, says) in [
            ("{\"runs\": 0}", "plan: runs = 0"),
            ("{\"seed\": -1}", "plan: seed = -1"),
            ("{\"case\": \"a/b\"}", "letters"),
            ("{\"duration_s\": 0}", "positive"),
        ] {
            let error = read(text).unwrap().check().unwrap_err().to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
        let plan = read("{\"scenario\": [\"formation\", \"formation\"]}").unwrap();
        assert!(matches!(
            plan.worlds(Path::new("none")),
            Err(StudyError::ScenarioTwice { .. })
        ));
    }

    #[test]
    fn cases_of_a_grid_are_named_by_their_settings_and_share_the_rest() {
        let names = |text: &str| {
            let plan = Plan::parse("s.toml", text).unwrap();
            let cases = plan.cases().map_err(|error| error.to_string())?;
            assert!(cases.iter().all(|case| case.seed == plan.seed && case.grids.is_empty()));
            Ok::<_, String>(cases.into_iter().filter_map(|case| case.case).collect::<Vec<_>>())
        };
        let grid = "[[grid]]\nset = { \"fmu-truth.vent.scale\" = [1, 10] }\n";
        assert_eq!(names("runs = 3\n").unwrap(), ["nominal"]);
        assert_eq!(names(grid).unwrap(), ["vent.scale-1", "vent.scale-10"]);
        let base = format!("case = \"odd\"\n{grid}");
        assert_eq!(names(&base).unwrap(), ["odd_vent.scale-1", "odd_vent.scale-10"]);
        let named = "duration_s = 9.0\n[[grid]]\ncases = [{ case = \"a\" }, { \"fmu-truth.vent.scale\" = 2 }]\n";
        assert_eq!(names(named).unwrap(), ["a", "duration-9_vent.scale-2"]);
        let twice = format!("set = [\"fmu-truth.vent.scale=3\"]\n{grid}");
        assert!(names(&twice).unwrap_err().contains("stands elsewhere"));
        let same = "[[grid]]\nset = { \"fmu-truth.vent.scale\" = [1, 1] }\n";
        assert!(names(same).unwrap_err().contains("vent.scale-1 twice"));
    }

    #[test]
    fn phases_and_requirements_are_checked_by_name() {
        let phase = "[[phase]]\nname = \"end\"\nfrom_s = 10\nto_s = 20\n";
        let asked = "[[requirement]]\nmetric = \"nees\"\nat_most = 2\n";
        for (text, says) in [
            (
                "[[phase]]\nname = \"end\"\nfrom_s = 20\nto_s = 10\n".to_owned(),
                "is empty",
            ),
            (format!("{phase}{phase}"), "twice"),
            ("[[phase]]\nname = \"end\"\n".to_owned(), "no condition"),
            ("[[phase]]\nname = \"vents\"\nfrom_s = 1\n".to_owned(), "always there"),
            (format!("{asked}phase = \"the end\"\n"), "letters"),
            ("[[requirement]]\nmetric = \"nees\"\n".to_owned(), "no bound"),
        ] {
            let error = Plan::parse("s.toml", &text).unwrap().check().unwrap_err().to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
        assert!(
            Plan::parse("s.toml", &format!("{asked}phase = \"end\"\n{phase}"))
                .unwrap()
                .check()
                .is_ok()
        );
    }

    #[test]
    fn a_case_is_nominal_only_where_nothing_differs() {
        let case = |text: &str| {
            let name = read(text).unwrap().case_name();
            assert_eq!(check_case(&name), Ok(()), "{name}");
            name
        };
        assert_eq!(
            case(r#"{"runs": 7, "seed": 3, "filters": ["snc"], "scenario": ["formation"]}"#),
            "nominal"
        );
        assert_eq!(case(r#"{"set": ["fmu-truth.vent.scale=10"]}"#), "vent.scale-10");
        assert_eq!(
            case(r#"{"set": ["mission.vent.co2.period_s=300"], "scheme": "jacobi"}"#),
            "vent.co2.period_s-300_jacobi"
        );
        assert_eq!(
            case(r#"{"vary": ["fmu-nav.off_nominal=uniform:0.1:10"], "step_s": 0.25}"#),
            "off_nominal-uniform-0.1-10_step-0.25"
        );
        assert_eq!(case(r#"{"truth": "there/their world.fmu"}"#), "truth-their-world");
        let long = |value: &str| {
            case(&format!(
                "{{\"set\": [\"fmu-truth.target_burn.a_t_n[1]={}{value}\"]}}",
                "1".repeat(80)
            ))
        };
        assert!(long("1").len() <= LONGEST_CASE && long("1") != long("2"));
    }

    /// What a source claims is claimed of its own world.
    #[test]
    fn a_world_is_as_published_unless_something_acts_on_it() {
        let published = |text: &str| read(text).unwrap().as_published();
        assert!(published(
            r#"{"runs": 7, "seed": 3, "step_s": 0.25, "scheme": "jacobi"}"#
        ));
        for changed in [
            r#"{"duration_s": 900}"#,
            r#"{"set": ["fmu-truth.vent.scale=10"]}"#,
            r#"{"vary": ["fmu-truth.vent.scale=uniform:0:1"]}"#,
            r#"{"drive": ["push=p.fmu"]}"#,
            r#"{"truth": "t.fmu"}"#,
        ] {
            assert!(!published(changed), "{changed}");
        }
    }

    #[test]
    fn our_fmus_are_needed_unless_others_take_their_place() {
        assert_eq!(read("{}").unwrap().needs(), [true, true]);
        let foreign = r#"{"truth": "t.fmu", "nav": ["a=a.fmu"], "filters": ["a@tuned"]}"#;
        assert_eq!(read(foreign).unwrap().needs(), [false, false]);
        // Without a preset the label can only be a filter of ours.
        let bare = r#"{"nav": ["a=a.fmu"], "filters": ["a"]}"#;
        assert_eq!(read(bare).unwrap().needs(), [true, true]);
        assert_eq!(read(r#"{"filters": []}"#).unwrap().needs(), [true, false]);
    }
}
