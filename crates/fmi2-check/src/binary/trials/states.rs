//! Saved states, in one process and in another.

use std::fs;
use std::path::PathBuf;
use std::ptr;

use serde::{Deserialize, Serialize};

use crate::binary::instance::{Bench, Ended, Instance};
use crate::binary::run::{Failed, Record};
use crate::rules::binary as rules;

/// A call that the capability promises.
fn promised(bench: &Bench<'_>, function: &'static str, ended: Ended) -> Result<(), Failed> {
    match ended {
        Ended::Well => Ok(()),
        Ended::Refused(status) => {
            let rule = if function.contains("erialize") {
                &rules::SERIALIZE
            } else {
                &rules::STATE
            };
            bench.journal.found(rule, function, format!("it returned {status}"));
            Err(Failed)
        }
        Ended::Later | Ended::Unclear => Err(Failed),
    }
}

fn half_way<'a>(bench: &'a Bench<'a>) -> Result<Instance<'a>, Failed> {
    let instance = bench.instance()?;
    bench.initialize(&instance)?;
    bench.record(&instance, 0..bench.half())?;
    Ok(instance)
}

pub(super) fn states(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = half_way(bench)?;
    let (half, end) = (bench.half(), bench.job.steps);
    let mut state = ptr::null_mut();
    promised(bench, "fmi2GetFMUstate", instance.get_state(&mut state))?;
    let expected = bench.record(&instance, half..end)?;
    promised(bench, "fmi2SetFMUstate", instance.set_state(state))?;
    let found = bench.record(&instance, half..end)?;
    let outputs = bench.outputs();
    for (place, what) in bench.differences(&expected, &found, half) {
        let name = &outputs[place].name;
        bench
            .journal
            .found(&rules::STATE, name, format!("after fmi2SetFMUstate {what}"));
    }
    // A handle that is there already is filled anew.
    promised(bench, "fmi2GetFMUstate", instance.get_state(&mut state))?;
    promised(bench, "fmi2FreeFMUstate", instance.free_state(&mut state))?;
    if !state.is_null() {
        let what = "the handle is not NULL afterwards";
        bench.journal.found(&rules::STATE_FREE, "fmi2FreeFMUstate", what);
        return Ok(());
    }
    if let Ended::Refused(status) = instance.free_state(&mut state) {
        let what = format!("it returned {status} for NULL");
        bench.journal.found(&rules::STATE_FREE, "fmi2FreeFMUstate", what);
    }
    Ok(())
}

/// What goes from the process that writes to the one that reads.
#[derive(Serialize, Deserialize)]
struct Carried {
    state: Vec<u8>,
    expected: Record,
}

fn carried(bench: &Bench<'_>) -> PathBuf {
    bench.job.folder.join("state.json")
}

pub(super) fn serialize(bench: &Bench<'_>) -> Result<(), Failed> {
    let instance = half_way(bench)?;
    let mut state = ptr::null_mut();
    promised(bench, "fmi2GetFMUstate", instance.get_state(&mut state))?;
    let (ended, bytes) = instance.serialize(state);
    promised(bench, "fmi2SerializeFMUstate", ended)?;
    promised(bench, "fmi2FreeFMUstate", instance.free_state(&mut state))?;
    let carried_over = Carried {
        state: bytes,
        expected: bench.record(&instance, bench.half()..bench.job.steps)?,
    };
    let text = serde_json::to_vec(&carried_over).map_err(|_| Failed)?;
    fs::write(carried(bench), text).map_err(|_| Failed)
}

pub(super) fn deserialize(bench: &Bench<'_>) -> Result<(), Failed> {
    // Where nothing was written, its process has said why.
    let Ok(text) = fs::read(carried(bench)) else {
        return Ok(());
    };
    let Carried { state: bytes, expected } = serde_json::from_slice(&text).map_err(|_| Failed)?;
    let instance = bench.instance()?;
    bench.initialize(&instance)?;
    let mut state = ptr::null_mut();
    promised(
        bench,
        "fmi2DeSerializeFMUstate",
        instance.deserialize(&bytes, &mut state),
    )?;
    promised(bench, "fmi2SetFMUstate", instance.set_state(state))?;
    promised(bench, "fmi2FreeFMUstate", instance.free_state(&mut state))?;
    let found = bench.record(&instance, bench.half()..bench.job.steps)?;
    let outputs = bench.outputs();
    for (place, what) in bench.differences(&expected, &found, bench.half()) {
        let name = &outputs[place].name;
        bench
            .journal
            .found(&rules::SERIALIZE, name, format!("in another process {what}"));
    }
    Ok(())
}
