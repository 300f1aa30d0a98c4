//! Worlds from missions: those that come with the project, by name, and anybody's file.

use std::path::{Path, PathBuf};

use astro::Cr3bpSystem;
use interface::mission::{self, Document, EMBEDDED, Mission, ResultAxes, embedded};

use crate::arguments::{Assignment, FilterChoice};
use crate::error::StudyError;
use crate::world::{Axes, Frame, World};

/// Name under which `--set` addresses the mission itself.
pub const MISSION: &str = "mission";

/// The world of every mission that comes with the project; those of the FMUs' `scenario` enumeration first, in its order.
///
/// # Errors
/// None for the missions as they come: a test reads each.
pub fn all() -> Result<Vec<World>, StudyError> {
    EMBEDDED.iter().map(|entry| find(entry.name)).collect()
}

/// The world of this name among the missions that come with the project.
///
/// # Errors
/// [`StudyError::Mission`], with the names that exist.
pub fn find(name: &str) -> Result<World, StudyError> {
    World::of(embedded(name)?.mission()?)
}

/// Where a mission comes from, and what is to be changed in it.
pub(crate) struct Source<'a> {
    /// A file, or the name of one that comes with the project.
    pub(crate) from: From<'a>,
    /// What a plan sets; only what concerns the mission is read.
    pub(crate) assignments: &'a [Assignment],
    /// Folder for the file of a mission that is changed or that the FMUs do not know by name.
    pub(crate) folder: &'a Path,
    /// Case, which tells the files of a mission apart that is changed in several ways.
    pub(crate) case: &'a str,
}

/// A mission's place.
#[derive(Clone, Copy)]
pub(crate) enum From<'a> {
    Name(&'a str),
    File(&'a Path),
}

impl Source<'_> {
    /// The world. A mission that is changed, or that the FMUs do not know by name, stands in a file for them afterwards.
    pub(crate) fn world(&self) -> Result<World, StudyError> {
        let (mut document, known) = match self.from {
            From::Name(name) => {
                let entry = embedded(name)?;
                (Document::parse(&format!("{name}.toml"), entry.text)?, entry.scenario)
            }
            From::File(path) => (Document::read(path)?, false),
        };
        let own = self.assignments.iter().filter(|a| a.model == MISSION);
        let mut changed = false;
        for assignment in own {
            document.set(&assignment.variable, &assignment.value)?;
            changed = true;
        }
        let mut mission = document.mission()?;
        let mission_file = match self.from {
            From::File(path) if !changed => {
                Some(std::path::absolute(path).map_err(|source| StudyError::MissionFile {
                    path: path.to_owned(),
                    source,
                })?)
            }
            _ if changed => Some(self.write(&mut document, &format!("{}_{}", mission.name, self.case))?),
            _ if !known => Some(self.write(&mut document, &mission.name)?),
            _ => None,
        };
        // The FMU's parameter is the period of every sensor that has none of its own.
        let period = |a: &&Assignment| a.model == crate::models::TRUTH && a.variable == "sample_period";
        if let Some(period) = self.assignments.iter().rfind(period)
            && let Ok(value) = period.value.parse::<f64>()
            && value > 0.0
        {
            mission.time.sample_period_s = value;
        }
        Ok(World {
            mission_file,
            ..World::of(mission)?
        })
    }

    fn write(&self, document: &mut Document, stem: &str) -> Result<PathBuf, StudyError> {
        document.make_paths_absolute()?;
        let folder = self.folder.join("missions");
        let path = folder.join(format!("{stem}.toml"));
        let written = std::fs::create_dir_all(&folder)
            .and_then(|()| std::fs::write(&path, document.text()))
            .and_then(|()| std::path::absolute(&path));
        written.map_err(|source| StudyError::MissionFile { path, source })
    }
}

impl World {
    /// A world as a study sees it.
    ///
    /// # Errors
    /// [`StudyError::Filters`] for a filter of the mission that is no `NAME` or `NAME@PRESET`.
    pub fn of(mission: Mission) -> Result<Self, StudyError> {
        let told = mission.navigation();
        let frame = match told.frame {
            mission::Frame::Inertial => Frame::Inertial,
            mission::Frame::Lvlh => Frame::Lvlh,
        };
        let axes = match (mission.study.axes, frame, mission.environment.gravity.cr3bp()) {
            // The state in LVLH axes is given in them.
            (_, Frame::Lvlh, _) => Axes::Lvlh,
            (_, Frame::Inertial, Some(p)) => Axes::RtnRotating(Cr3bpSystem::new(p.mass_ratio, p.length_m, p.time_s)?),
            (Some(ResultAxes::Rtn | ResultAxes::Lvlh) | None, Frame::Inertial, None) => Axes::Rtn,
        };
        let periods = mission.sensors.periods(mission.time.sample_period_s);
        let filters = mission.study.filters.iter().map(|label| {
            label.parse::<FilterChoice>().map_err(|problem| StudyError::Filters {
                mission: mission.name.clone(),
                problem,
            })
        });
        Ok(Self {
            name: mission.name.clone(),
            about: mission.about.clone(),
            reference: mission.reference.clone(),
            duration_s: mission.time.duration_s,
            scored_from_s: mission.time.scored_from_s,
            sample_period_s: grid(&periods).ok_or_else(|| StudyError::NoGrid {
                mission: mission.name.clone(),
                periods,
            })?,
            frame,
            axes,
            nis_rows: told.sensors.iter().map(|known| known.sensor.rows() as u32).sum(),
            filters: filters.collect::<Result<_, _>>()?,
            notes: mission.notes(),
            mission_file: None,
            mission,
        })
    }
}

/// The longest time of which every period is a whole multiple; `None` where that is below a millisecond, since a master that
/// steps on a coarser grid would lose samples without a word.
fn grid(periods: &[f64]) -> Option<f64> {
    let shortest = periods.iter().copied().fold(f64::INFINITY, f64::min);
    // An equal or whole period keeps its digits.
    let whole = |p: &f64| (p / shortest - (p / shortest).round()).abs() < 1e-9;
    if periods.iter().all(whole) {
        return Some(shortest);
    }
    let ticks: Vec<u64> = periods.iter().map(|p| (p * 1e6).round() as u64).collect();
    let exact = ticks
        .iter()
        .zip(periods)
        .all(|(t, p)| (*t as f64 / 1e6 - p).abs() < 1e-9);
    let common = ticks.iter().copied().fold(0, gcd);
    (exact && common >= 1000).then_some(common as f64 / 1e6)
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mission_of_the_project_is_found_by_its_name_and_scores_something() {
        for entry in EMBEDDED {
            let world = find(entry.name).unwrap();
            assert_eq!(world.name, entry.name);
            assert!(world.scored_from_s < world.duration_s, "{}", world.name);
            assert_eq!(world.filters.len(), world.mission.study.filters.len());
            assert!(world.sample_period_s > 0.0);
        }
        assert_eq!(all().unwrap().len(), EMBEDDED.len());
        let error = find("leo_vent").unwrap_err().to_string();
        assert!(error.contains("leo_vent") && error.contains("leo_venting"), "{error}");
    }

    #[test]
    fn samples_lie_on_the_longest_common_grid() {
        for (periods, expected) in [
            (vec![1.0, 1.0], 1.0),
            (vec![2.0, 10.0], 2.0),
            (vec![0.02, 0.2], 0.02),
            (vec![2.0, 3.0], 1.0),
            (vec![1.0 / 3.0], 1.0 / 3.0),
            (vec![1.0 / 3.0, 1.0], 1.0 / 3.0),
        ] {
            let found = grid(&periods).unwrap();
            assert!((found - expected).abs() < 1e-12, "{periods:?}: {found}");
        }
        for periods in [vec![0.033_333, 1.0], vec![0.7, 0.0333], vec![1.0, std::f64::consts::PI]] {
            assert_eq!(grid(&periods), None, "{periods:?}");
        }
    }

    #[test]
    fn a_changed_mission_stands_in_a_file_for_the_fmus() {
        let folder = tempfile::tempdir().unwrap();
        let world = |assignments: &[&str], from| {
            let assignments: Vec<Assignment> = assignments.iter().map(|a| a.parse().unwrap()).collect();
            let source = Source {
                from,
                assignments: &assignments,
                folder: folder.path(),
                case: "short",
            };
            source.world()
        };
        let plain = world(&["fmu-truth.vent.scale=10"], From::Name("leo_venting")).unwrap();
        assert_eq!(plain.mission_file, None);
        let changed = world(&["mission.vent.co2.period_s=300"], From::Name("leo_venting")).unwrap();
        let file = changed.mission_file.unwrap();
        assert!(file.ends_with("missions/leo_venting_short.toml"));
        assert_eq!(Mission::read(&file).unwrap().vents[0].period_s, Some(300.0));
        let same = world(&[], From::File(&file)).unwrap();
        assert_eq!(same.mission_file.as_deref(), Some(file.as_path()));
        let twin = world(&[], From::Name("formation_j2")).unwrap();
        assert!(twin.mission_file.is_some(), "no item of the enumeration");
        let slow = world(&["fmu-truth.sample_period=3"], From::Name("leo_venting")).unwrap();
        assert!((slow.sample_period_s - 3.0).abs() < 1e-15 && !slow.notes.is_empty());
        let error = world(&["mission.vent.oxygen.count=2"], From::Name("leo_venting")).unwrap_err();
        assert!(error.to_string().contains("co2, waste_water"), "{error}");
    }
}
