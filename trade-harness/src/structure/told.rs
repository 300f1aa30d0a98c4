//! Anybody's system structure as a plan of a study.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use fmi2_import::Fmu;
use interface::mission::{Document, EMBEDDED, PACKED};
use ssp::{FMU, Flat, Package, flatten};
use study::{Assignment, FilterChoice, ForeignFilter, Mapping, NAV, OwnFmus, Plan, StudyError, TRUTH, World, worlds};

use super::values::{Values, values};
use super::wiring::{Part, Problem, Role, parts};
use crate::HarnessError;
use crate::digest::of_bytes;
use crate::output::write_whole;

/// What a structure says of a study.
#[derive(Debug)]
pub struct Told {
    /// The plan: worlds, filters, drivers, names, parameters.
    pub plan: Plan,
    /// Our own FMUs, where it holds them.
    pub own: OwnFmus,
    /// What a reader should know: what a study says itself.
    pub notes: Vec<String>,
}

/// Reads a structure. The component with outputs `truth.*` is the world, those with `est.*` are filters, all others drivers; our own
/// FMUs are known by the name of their model, and keep their places.
///
/// * `path`: archive, folder or `.ssd` file.
/// * `folder`: where its FMUs are put, for as long as the study is.
/// * `mappings`: names that the command line gives.
/// * `mission`: whether the command line names worlds.
///
/// # Errors
/// [`HarnessError::Ssp`], [`HarnessError::Import`]; [`HarnessError::Element`] for what a study cannot represent.
pub fn read(path: &Path, folder: &Path, mappings: &[Mapping], mission: bool) -> Result<Told, HarnessError> {
    let mut package = Package::open(path)?;
    let flat = flatten(package.structure())?;
    let wrong = |(element, problem): Problem| HarnessError::Element {
        path: path.to_owned(),
        element,
        problem,
    };
    let fmus = unpack(&mut package, &flat, folder)?;
    let models = labels(&flat, &fmus).map_err(wrong)?;
    let described: Vec<_> = models
        .iter()
        .zip(&fmus)
        .map(|(label, unpacked)| (label.clone(), unpacked.fmu.description()))
        .collect();
    let parts = parts(&flat, &described, mappings).map_err(wrong)?;
    let mut given = Vec::new();
    for (part, component) in parts.iter().zip(&flat.components) {
        given.push(values(part.description, &component.parameters).map_err(wrong)?);
    }
    let mut cast = Cast::default();
    for ((part, unpacked), values) in parts.iter().zip(&fmus).zip(&given) {
        cast.place(part, unpacked, values).map_err(wrong)?;
    }
    cast.closed(&flat, &parts).map_err(wrong)?;
    let own_mission = fmus.iter().any(|unpacked| unpacked.with_mission);
    if own_mission && cast.mission.is_none() && !mission {
        let text = "was packed with a mission, which is not read from it; give its file with --mission";
        return Err(wrong(("an FMU".to_owned(), text.to_owned())));
    }
    let worlds = if mission {
        Worlds::default()
    } else {
        Worlds::of(&cast, &flat).map_err(wrong)?
    };
    Ok(cast.told(worlds))
}

/// A component's FMU, out of the archive.
struct Unpacked {
    path: PathBuf,
    fmu: Fmu,
    /// Whether it is another one's file, byte for byte: the first of them.
    same_as: usize,
    /// Whether it was packed with a mission of its own.
    with_mission: bool,
}

/// Longest name of a file or filter: systems have no longer names of files than 255 bytes.
const LONGEST: usize = 100;

/// The name of an element as part of the name of a file or filter; elements may be called anything.
fn plain(name: &str) -> String {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    name.chars()
        .map(|c| if allowed(c) { c } else { '_' })
        .take(LONGEST)
        .collect()
}

/// Puts the FMUs into a folder, under names that tell them apart.
fn unpack(package: &mut Package, flat: &Flat, folder: &Path) -> Result<Vec<Unpacked>, HarnessError> {
    let mut digests: Vec<String> = Vec::new();
    // Components of one source: the first of them stands for all, and its file is read once.
    let mut sources: BTreeMap<&str, usize> = BTreeMap::new();
    let mut fmus: Vec<Unpacked> = Vec::new();
    for component in &flat.components {
        let by = format!("component '{}'", component.name);
        if component.media_type != FMU {
            return Err(HarnessError::Element {
                path: package.path().to_owned(),
                element: by,
                problem: format!("is of type {}; a study takes FMUs, {FMU}", component.media_type),
            });
        }
        let here = fmus.len();
        if let Some(first) = sources.get(component.source.as_str()).map(|first| &fmus[*first]) {
            let again = Unpacked {
                path: first.path.clone(),
                fmu: Fmu::open(&first.path)?,
                same_as: first.same_as,
                with_mission: first.with_mission,
            };
            digests.push(digests[again.same_as].clone());
            fmus.push(again);
            continue;
        }
        sources.insert(&component.source, here);
        let bytes = package.source(&by, &component.source)?;
        let digest = of_bytes(&bytes);
        let same_as = digests.iter().position(|other| *other == digest).unwrap_or(here);
        let path = match fmus.get(same_as) {
            Some(first) => first.path.clone(),
            None => folder.join(format!("{here}-{}.fmu", plain(&component.name))),
        };
        if same_as == here {
            write_whole(&path, &bytes)?;
        }
        let fmu = Fmu::open(&path)?;
        let with_mission = zip::ZipArchive::new(std::io::Cursor::new(&bytes))
            .is_ok_and(|archive| archive.index_for_name(&format!("resources/{PACKED}")).is_some());
        digests.push(digest);
        fmus.push(Unpacked {
            path,
            fmu,
            same_as,
            with_mission,
        });
    }
    Ok(fmus)
}

/// What each component is called in a study: our own by the names of their models, others by those of their elements.
fn labels(flat: &Flat, fmus: &[Unpacked]) -> Result<Vec<String>, Problem> {
    let mut labels: Vec<String> = Vec::new();
    for (component, unpacked) in flat.components.iter().zip(fmus) {
        let model = unpacked.fmu.description().model_name.as_str();
        let label: String = match [TRUTH, NAV].into_iter().find(|own| *own == model) {
            Some(own) => own.to_owned(),
            None => plain(&component.name),
        };
        let twice = labels.iter().position(|other| *other == label);
        if let Some(first) = twice.filter(|first| label != NAV || fmus[*first].same_as != unpacked.same_as) {
            let text = format!(
                "would go by the name '{label}', as '{}' does; rename it, or give both the same file",
                flat.components[first].name
            );
            return Err((format!("component '{}'", component.name), text));
        }
        labels.push(label);
    }
    Ok(labels)
}

/// Who plays which part.
#[derive(Default)]
struct Cast {
    own: OwnFmus,
    truth: Option<PathBuf>,
    filters: Vec<FilterChoice>,
    foreign: Vec<ForeignFilter>,
    drive: Vec<ForeignFilter>,
    names: BTreeMap<(String, String), String>,
    settings: BTreeMap<(String, String), String>,
    /// Each with the element that says so.
    mission: Option<(String, String)>,
    seed: Option<(i32, String)>,
    counts_runs: Vec<String>,
}

impl Cast {
    fn place(&mut self, part: &Part<'_>, unpacked: &Unpacked, values: &Values) -> Result<(), Problem> {
        let element = format!("component '{}'", part.element);
        let differs = |what: &str, one: &str, other: &str, who: &str| {
            let text = format!("has {what} {one}, and {who} has {other}; a study has one, give both the same");
            (element.clone(), text)
        };
        let path = unpacked.path.clone();
        match (part.role, part.label.as_str()) {
            (Role::World, TRUTH) => self.own.truth = Some(path),
            (Role::World, _) => self.truth = Some(path),
            (Role::Filter, NAV) => {
                let first = part.description.items("filter").first().map(|item| item.name.clone());
                let name = values.filter.clone().or(first).unwrap_or_default();
                let choice: FilterChoice = name.parse().map_err(|problem| (element.clone(), problem))?;
                if self.filters.iter().any(|other| other.name == choice.name) {
                    return Err((
                        element,
                        format!("is filter '{name}' as another component is; give each one of its own"),
                    ));
                }
                self.own.nav = Some(path);
                self.filters.push(choice);
            }
            (Role::Filter, label) => self.foreign.push(ForeignFilter {
                label: label.to_owned(),
                path,
            }),
            (Role::Driver, label) => self.drive.push(ForeignFilter {
                label: label.to_owned(),
                path,
            }),
        }
        let label = |own: &String| (part.label.clone(), own.clone());
        self.names
            .extend(part.names.iter().map(|(own, contract)| (label(own), contract.clone())));
        for (own, value) in &values.others {
            if let Some(other) = self
                .settings
                .insert(label(own), value.clone())
                .filter(|other| other != value)
            {
                return Err(differs(own, value, &other, "another component of the same FMU"));
            }
        }
        if let Some(mission) = &values.mission {
            match &self.mission {
                Some((other, who)) if other != mission => return Err(differs("mission", mission, other, who)),
                Some(_) => {}
                None => self.mission = Some((mission.clone(), element.clone())),
            }
        }
        if let Some(seed) = values.seed {
            match &self.seed {
                Some((other, who)) if *other != seed => {
                    return Err(differs("study_seed", &seed.to_string(), &other.to_string(), who));
                }
                Some(_) => {}
                None => self.seed = Some((seed, element.clone())),
            }
        }
        if values.run {
            self.counts_runs.push(part.element.to_owned());
        }
        Ok(())
    }

    /// A driver that reads one filter reads every filter of a study, each in a world of its own.
    fn closed(&self, flat: &Flat, parts: &[Part<'_>]) -> Result<(), Problem> {
        let filters = parts.iter().filter(|part| part.role == Role::Filter).count();
        let closes = flat
            .connections
            .iter()
            .find(|c| parts[c.from.0].role == Role::Filter && parts[c.to.0].role == Role::Driver);
        match closes {
            Some(closes) if filters > 1 => {
                let text = "reads one of several filters, and in a study every filter flies in a world of its own; keep one filter, and \
                            add others with --filters";
                Err((format!("component '{}'", parts[closes.to.0].element), text.to_owned()))
            }
            _ => Ok(()),
        }
    }

    fn told(self, worlds: Worlds) -> Told {
        let mut notes = Vec::new();
        if !self.counts_runs.is_empty() {
            let elements = self.counts_runs.join(", ");
            notes.push(format!(
                "a study counts its runs from 0: 'run' of {elements} is passed by"
            ));
        }
        let nobody = Plan::default();
        let plan = Plan {
            scenarios: worlds.scenarios.unwrap_or(nobody.scenarios),
            missions: worlds.missions,
            duration_s: worlds.duration_s,
            step_s: worlds.step_s,
            filters: Some(self.filters),
            seed: self.seed.map_or(nobody.seed, |(seed, _)| seed),
            truth: self.truth,
            foreign: self.foreign,
            drive: self.drive,
            mappings: self
                .names
                .into_iter()
                .map(|((model, own), contract)| Mapping { model, own, contract })
                .collect(),
            assignments: self
                .settings
                .into_iter()
                .map(|((model, variable), value)| Assignment { model, variable, value })
                .collect(),
            ..Plan::default()
        };
        Told {
            plan,
            own: self.own,
            notes,
        }
    }
}

/// Worlds and times of a plan.
#[derive(Default)]
struct Worlds {
    scenarios: Option<Vec<String>>,
    missions: Vec<PathBuf>,
    duration_s: Option<f64>,
    step_s: Option<f64>,
}

impl Worlds {
    /// The mission that components name, and times where they are not its own.
    fn of(cast: &Cast, flat: &Flat) -> Result<Self, Problem> {
        let told = |element: &str| {
            let element = element.to_owned();
            move |error: StudyError| (element.clone(), error.to_string())
        };
        let (mut worlds, world) = match &cast.mission {
            Some((name, element)) if EMBEDDED.iter().any(|entry| entry.name == *name) => {
                let scenarios = Some(vec![name.clone()]);
                let world = worlds::find(name).map_err(told(element))?;
                (
                    Self {
                        scenarios,
                        ..Self::default()
                    },
                    Some(world),
                )
            }
            Some((path, element)) => {
                let mission = Document::read(Path::new(path)).and_then(|document| document.mission());
                let world = mission
                    .map_err(StudyError::from)
                    .and_then(World::of)
                    .map_err(told(element))?;
                let worlds = Self {
                    scenarios: Some(Vec::new()),
                    missions: vec![path.into()],
                    ..Self::default()
                };
                (worlds, Some(world))
            }
            None => (Self::default(), None),
        };
        let Some(times) = flat.experiment else {
            return Ok(worlds);
        };
        if let Some(start) = times.start_time.filter(|start| *start != 0.0) {
            let text = format!("startTime is {start}; a study begins at 0");
            return Err(("ssd:DefaultExperiment".to_owned(), text));
        }
        let differs =
            |told: Option<f64>, own: Option<f64>| told.filter(|told| own.is_none_or(|own| (own - told).abs() > 1e-9));
        worlds.duration_s = differs(times.stop_time, world.as_ref().map(|world| world.duration_s));
        worlds.step_s = differs(times.step_size, world.as_ref().map(|world| world.sample_period_s));
        Ok(worlds)
    }
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn no_name_of_an_element_leads_out_of_the_folder() {
        assert_eq!(plain("../up/guest.filter"), "___up_guest_filter");
        assert_eq!(plain("nav-2_b"), "nav-2_b");
    }
}
