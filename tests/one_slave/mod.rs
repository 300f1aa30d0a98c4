//! What either slave must do: the committed descriptions, states that hold no place of this machine, missions that leave nothing
//! behind. A module of both crates, each of which names its own [`Slave`].

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use std::fs;
use std::path::Path;

use super::Slave;
use fmi_model::{Log, Model, Phase, Seal, Snapshot};
use interface::mission::{EMBEDDED, PACKED, SHIPPED};
use tempfile::TempDir;
use uuid::Uuid;

type Instance = fmi_model::Instance<Slave>;

const SEAL: Seal = Seal {
    magic: *b"in tests",
    tool: "tests",
    guid: Uuid::nil(),
};

fn bytes(slave: &Instance) -> Vec<u8> {
    slave.state().to_bytes(&SEAL).unwrap()
}

fn choose(slave: &mut Instance, mission: &str) {
    let row = Slave::table().find("mission_file").unwrap();
    slave.set(&[row], |_| mission.to_owned()).unwrap();
}

/// Resources with a mission of this name, packed and shipped as `own.toml`.
fn resources(name: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = EMBEDDED[0].text.replacen(EMBEDDED[0].name, name, 1);
    fs::create_dir(folder.path().join(SHIPPED)).unwrap();
    fs::write(folder.path().join(PACKED), &text).unwrap();
    fs::write(folder.path().join(SHIPPED).join("own.toml"), &text).unwrap();
    folder
}

/// An instance in this phase that runs `mission` of its resources.
fn reached(phase: Phase, folder: &TempDir, mission: &str) -> Instance {
    let mut slave = Instance::with_resources(folder.path().to_owned());
    choose(&mut slave, mission);
    if phase != Phase::Instantiated {
        slave.enter_initialization(&mut Log::silent()).unwrap();
        // Said again, it is read again.
        choose(&mut slave, mission);
    }
    if phase == Phase::StepComplete {
        slave.exit_initialization(&mut Log::silent()).unwrap();
    }
    slave
}

const PHASES: [Phase; 3] = [Phase::Instantiated, Phase::Initialization, Phase::StepComplete];

#[test]
fn model_descriptions_are_the_committed_ones() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../modelDescription")
        .join(env!("CARGO_PKG_NAME"));
    fmi2_export::golden_check::<Slave>(&folder.join("modelDescription.xml")).unwrap();
    fmi3_export::golden_check::<Slave>(&folder.join("fmi3/modelDescription.xml")).unwrap();
}

#[test]
fn equal_instances_have_equal_states_wherever_their_resources_are() {
    let (here, there) = (resources("same"), resources("same"));
    for phase in PHASES {
        for mission in ["", "own.toml"] {
            let state = bytes(&reached(phase, &here, mission));
            assert_eq!(state, bytes(&reached(phase, &there, mission)), "{phase} {mission}");
            let path = here.path().to_str().unwrap().as_bytes();
            assert!(!state.windows(path.len()).any(|part| part == path), "{phase} {mission}");
        }
    }
}

#[test]
fn a_state_finds_the_missions_of_the_instance_that_it_is_set_on() {
    let (here, there) = (resources("here"), resources("there"));
    for phase in [Phase::Instantiated, Phase::Initialization] {
        for mission in ["", "own.toml"] {
            let from = reached(phase, &here, mission);
            let read = Snapshot::from_bytes(&bytes(&from), &SEAL).unwrap();
            for state in [from.state().clone(), read] {
                let begun = |mut slave: Instance| {
                    slave.set_state(state.clone());
                    if phase == Phase::Instantiated {
                        slave.enter_initialization(&mut Log::silent())?;
                        choose(&mut slave, mission);
                    }
                    slave.exit_initialization(&mut Log::silent())?;
                    Ok::<_, fmi_model::InstanceError>(bytes(&slave))
                };
                let with = |folder: &TempDir| Instance::with_resources(folder.path().to_owned());
                for folder in [&here, &there] {
                    let fresh = bytes(&reached(Phase::StepComplete, folder, mission));
                    assert!(begun(with(folder)).unwrap() == fresh, "{phase} {mission}");
                }
                // Where the instance has none there is no such file, and the first scenario is that of the library.
                match begun(Instance::new()) {
                    Ok(state) if mission.is_empty() => {
                        let mut first = Instance::new();
                        first.enter_initialization(&mut Log::silent()).unwrap();
                        choose(&mut first, mission);
                        first.exit_initialization(&mut Log::silent()).unwrap();
                        assert!(state == bytes(&first));
                    }
                    Ok(_) => panic!("{phase}: read {mission} of resources that are another's"),
                    Err(_) => assert!(!mission.is_empty(), "{phase}"),
                }
            }
        }
    }
}

/// A model initialises from its variables alone: nothing of a mission that was chosen before stays.
#[test]
fn a_mission_leaves_nothing_to_the_next() {
    let begun = |missions: &[&str]| {
        let mut slave = Instance::new();
        choose(&mut slave, missions[0]);
        slave.enter_initialization(&mut Log::silent()).unwrap();
        for mission in &missions[1..] {
            choose(&mut slave, mission);
        }
        slave.exit_initialization(&mut Log::silent()).unwrap();
        bytes(&slave)
    };
    for entry in EMBEDDED {
        // Chosen twice, it is read twice, as the second mission below is.
        let fresh = begun(&[entry.name, entry.name]);
        for before in EMBEDDED {
            assert!(
                begun(&[before.name, entry.name]) == fresh,
                "{} after {}",
                entry.name,
                before.name
            );
        }
    }
}
