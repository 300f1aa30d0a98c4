//! Saved states of both FMUs: what `fmi2DeSerializeFMUstate` is given.
//!
//! The FMUs are C libraries and no crates, so that models of what they hold stand here: a filter, and a world.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;

use filters::laws::FILTERS;
use filters::state::State;
use filters::{Command, Navigator, Reading, Sample, Settings, SpecificForce};
use fmi_model::{
    Experiment, Instance, InstanceError, Log, Model, ModelError, ModelInfo, Seal, Snapshot, Table, TableBuilder,
};
use interface::mission::{EMBEDDED, embedded};
use interface::{Sensor, Signals};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use truth::{Inputs, Params, Simulation};
use uuid::Uuid;

use crate::Kind;

pub(crate) const KIND: Kind = Kind {
    name: "saved-state",
    feed,
    seeds,
};

const SEAL: Seal = Seal {
    magic: *b"hostile!",
    tool: "a test of hostile files",
    guid: Uuid::from_u128(1),
};

/// Length of what stands before a payload, and behind it.
const HEAD: usize = 36;
const CHECKSUM: usize = 8;

/// The first byte says whose state it is, and whether the rest is the whole of it or a payload that gets head and checksum.
fn feed(bytes: &[u8]) {
    let Some((first, rest)) = bytes.split_first() else {
        return;
    };
    let state = if first & 2 == 0 { sealed(rest) } else { rest.to_vec() };
    if first & 1 == 0 {
        restore::<Filter>(&state);
    } else {
        restore::<World>(&state);
    }
}

/// How an instance goes on from a state that somebody has changed and sealed again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stepped {
    /// It is no state.
    Refused,
    /// The step is made.
    Well,
    /// The step is refused or fails, with an error.
    Failed,
    /// The model panics, which an exported FMU tells its master as `fmi2Fatal`.
    Panicked,
}

/// Takes one step from a state, which begins as for fuzzing.
pub fn step(bytes: &[u8]) -> Stepped {
    let Some((first, rest)) = bytes.split_first() else {
        return Stepped::Refused;
    };
    if first & 1 == 0 {
        step_of::<Filter>(&sealed(rest))
    } else {
        step_of::<World>(&sealed(rest))
    }
}

fn step_of<M: Model>(bytes: &[u8]) -> Stepped {
    let Ok(state) = Snapshot::<M>::from_bytes(bytes, &SEAL) else {
        return Stepped::Refused;
    };
    let mut instance = Instance::<M>::new();
    instance.set_state(state);
    let time = instance.time();
    let stepped = catch_unwind(AssertUnwindSafe(|| instance.do_step(time, 1.0, &mut Log::silent())));
    match stepped {
        Ok(Ok(())) => Stepped::Well,
        Ok(Err(_)) => Stepped::Failed,
        Err(_) => Stepped::Panicked,
    }
}

fn restore<M: Model>(bytes: &[u8]) {
    match Snapshot::<M>::from_bytes(bytes, &SEAL) {
        Ok(snapshot) => {
            let again = snapshot.to_bytes(&SEAL).expect("a state that was read can be saved");
            let mut instance = Instance::<M>::new();
            instance.set_state(Snapshot::from_bytes(&again, &SEAL).expect("what is saved can be read"));
            instance.reset();
        }
        Err(error) => {
            assert!(error.to_string().len() > 20, "an error says nothing: {error}");
            assert!(!matches!(error, InstanceError::StateFormat { .. }) || bytes.len() > 12);
        }
    }
}

/// A payload with head and checksum, as [`Snapshot::to_bytes`] makes them.
fn sealed(payload: &[u8]) -> Vec<u8> {
    static HEADED: OnceLock<Vec<u8>> = OnceLock::new();
    let headed = HEADED.get_or_init(|| Instance::<Filter>::new().state().to_bytes(&SEAL).unwrap());
    let mut bytes = headed[..HEAD - 8].to_vec();
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(payload);
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    bytes.extend(hash.to_le_bytes());
    bytes
}

/// What the filters' FMU holds.
#[derive(Clone, Serialize, Deserialize)]
struct Filter {
    settings: Settings,
    inputs: Signals,
    command: Command,
    navigator: Option<Navigator>,
}

/// What the world's FMU holds.
#[derive(Clone, Serialize, Deserialize)]
struct World {
    params: Params,
    inputs: Inputs,
    simulation: Option<Simulation>,
}

fn info() -> &'static ModelInfo {
    static INFO: OnceLock<ModelInfo> = OnceLock::new();
    INFO.get_or_init(ModelInfo::default)
}

impl Model for Filter {
    fn info() -> &'static ModelInfo {
        info()
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<Filter>> = OnceLock::new();
        TABLE.get_or_init(|| TableBuilder::new().build())
    }

    fn blank() -> Self {
        Self {
            settings: Settings::default(),
            inputs: Signals::default(),
            command: Command::default(),
            navigator: None,
        }
    }

    fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }

    fn do_step(&mut self, t: f64, h: f64, _: &mut Log<'_>) -> Result<(), ModelError> {
        if let Some(navigator) = &mut self.navigator {
            navigator.step(t, h, &self.command);
            navigator.process(&sample(6), &start())?;
            navigator.wait(h);
            navigator.predict();
        }
        Ok(())
    }
}

impl Model for World {
    fn info() -> &'static ModelInfo {
        info()
    }

    fn table() -> &'static Table<Self> {
        static TABLE: OnceLock<Table<World>> = OnceLock::new();
        TABLE.get_or_init(|| TableBuilder::new().build())
    }

    fn blank() -> Self {
        Self {
            params: Params::default(),
            inputs: Inputs::default(),
            simulation: None,
        }
    }

    fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
        Ok(())
    }

    fn check_step(&self, t: f64, h: f64) -> Result<(), ModelError> {
        self.simulation
            .as_ref()
            .map_or(Ok(()), |s| Ok(s.check(t + h, &self.inputs)?))
    }

    fn do_step(&mut self, t: f64, h: f64, _: &mut Log<'_>) -> Result<(), ModelError> {
        if let Some(simulation) = &mut self.simulation {
            simulation.advance_to(t + h, &self.inputs)?;
        }
        Ok(())
    }
}

/// A state of every filter and of every world, after some steps: as payload, and one of each as a whole.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let mut seeds = Vec::new();
    for mission in ["leo_venting", "formation"] {
        let told = embedded(mission).unwrap().mission().unwrap().navigation();
        for (filter, entry) in FILTERS.iter().enumerate() {
            let settings = Settings {
                filter,
                ..Settings::default()
            };
            let Ok(mut navigator) = Navigator::new(&told, &settings, 0.0) else {
                continue;
            };
            for count in 1..=5 {
                // What it thinks of the sample is no matter.
                let _ = navigator.process(&sample(count), &start());
            }
            let model = Filter {
                settings,
                navigator: Some(navigator),
                ..Filter::blank()
            };
            both(&format!("{}-{mission}", entry.name), 0, &model, filter == 0, &mut seeds);
        }
    }
    for entry in EMBEDDED.iter().filter(|entry| entry.scenario) {
        let ordinal = EMBEDDED.iter().position(|e| e.name == entry.name).unwrap() as u32 + 1;
        let params = Params::of_scenario(ordinal as i32);
        let mut simulation = Simulation::new(&params, 0.0, &Inputs::default()).unwrap();
        simulation.advance_to(3.5, &Inputs::default()).unwrap();
        let model = World {
            params,
            simulation: Some(simulation),
            ..World::blank()
        };
        both(entry.name, 1, &model, ordinal == 1, &mut seeds);
    }
    seeds
}

/// What every sensor that a filter may use reports.
fn sample(count: i32) -> Sample {
    let mut sample = Sample::blank(count, f64::from(count));
    sample[Sensor::Lidar] = Reading::of(&[1000.0, 0.01, -0.01]);
    sample[Sensor::Metrology] = Reading::of(&[100.0, 900.0, -300.0, 0.1, 0.2, 0.3]);
    sample.accelerometer = Some(SpecificForce::Instant(Vector3::repeat(1e-6)));
    sample
}

/// Relative state, target's orbit and bias to begin with.
fn start() -> State {
    let mut x = State::zeros();
    x.fixed_rows_mut::<3>(0).copy_from_slice(&[300.0, -900.0, 250.0]);
    x.fixed_rows_mut::<3>(9).copy_from_slice(&[6.878e6, 0.0, 0.0]);
    x.fixed_rows_mut::<3>(12).copy_from_slice(&[0.0, 7350.0, 1970.0]);
    x
}

/// A payload is what stands before the model in that of a blank instance, and the model.
fn both<M: Model>(name: &str, whose: u8, model: &M, whole: bool, seeds: &mut Vec<(String, Vec<u8>)>) {
    let blank = Instance::<M>::new().state().to_bytes(&SEAL).unwrap();
    let own = postcard::to_stdvec(&M::blank()).unwrap().len();
    let before = &blank[HEAD..blank.len() - CHECKSUM - own];
    let payload = [before, &postcard::to_stdvec(model).unwrap()].concat();
    if whole {
        seeds.push((
            format!("{name}-whole"),
            [&[whose | 2], sealed(&payload).as_slice()].concat(),
        ));
    }
    seeds.push((name.to_owned(), [&[whose], payload.as_slice()].concat()));
}
