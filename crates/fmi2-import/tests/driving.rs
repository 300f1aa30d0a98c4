//! A C library, compiled on the spot, that answers as badly as an FMU may.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;

use std::path::Path;
use std::sync::Arc;

use common::{Workshop, tank_description};
use fmi2_import::{Experiment, Fmi2Status, Fmu, ImportError, Instance, Outcome, Status};

const STATES: &str = r#"canGetAndSetFMUstate="true" canSerializeFMUstate="true""#;
const INFLOW: &[u32] = &[0];
const LEVEL: &[u32] = &[1];
const ANSWER: &[u32] = &[0];
const EXPERIMENT: Experiment = Experiment {
    start_time: 0.0,
    stop_time: Some(10.0),
    tolerance: None,
};

/// A tank with the given attributes; `None` without a C compiler.
fn tank(shop: &Workshop, attributes: &str) -> Option<Fmu> {
    let library = shop.compile(&[])?;
    Some(Fmu::open(shop.fmu("tank.fmu", &tank_description(attributes), &library)).unwrap())
}

/// An initialized instance that traces the end of its life to `trace` and answers `answer` in each step.
fn started(fmu: &Fmu, shop: &Workshop, answer: i32) -> Instance {
    let mut instance = fmu.instantiate("t1", false).unwrap();
    instance
        .set_string(&[0], &[shop.path("trace").to_str().unwrap()])
        .unwrap();
    instance.setup_experiment(&EXPERIMENT).unwrap();
    instance.enter_initialization().unwrap();
    instance.set_integer(ANSWER, &[answer]).unwrap();
    instance.exit_initialization().unwrap();
    instance
}

/// The lines of the trace so far.
fn trace(shop: &Workshop) -> Vec<String> {
    std::fs::read_to_string(shop.path("trace"))
        .unwrap_or_default()
        .lines()
        .map(str::to_owned)
        .collect()
}

fn level(instance: &mut Instance) -> f64 {
    let mut value = [0.0];
    instance.get_real(LEVEL, &mut value).unwrap();
    value[0]
}

#[test]
#[allow(clippy::float_cmp, reason = "sums of powers of two are exact")]
fn values_of_all_types_cross_and_the_end_of_life_is_orderly() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let mut instance = started(&fmu, &shop, 0);
    // The library outlives the Fmu, and the instance may change threads.
    drop(fmu);
    let mut instance = std::thread::spawn(move || {
        instance.set_real(INFLOW, &[2.0]).unwrap();
        for k in 0..3 {
            assert_eq!(instance.do_step(f64::from(k) * 0.25, 0.25).unwrap(), Outcome::Ok);
        }
        instance
    })
    .join()
    .unwrap();
    // 0.5 comes from the file in resources.
    assert_eq!(level(&mut instance), 0.5 + 3.0 * 0.25 * 2.0);
    instance.set_boolean(&[0], &[false]).unwrap();
    let _ = instance.do_step(0.75, 0.25).unwrap();
    assert_eq!(level(&mut instance), 2.0, "a closed tank keeps its level");

    let (mut open, mut counts) = ([true], [0, 7]);
    instance.get_boolean(&[0], &mut open).unwrap();
    instance.get_integer(&[1, 0], &mut counts).unwrap();
    assert_eq!((open, counts), ([false], [4, 0]));
    assert_eq!(
        instance.get_string(&[0]).unwrap(),
        [shop.path("trace").to_str().unwrap()]
    );

    assert_eq!(trace(&shop), [""; 0]);
    drop(instance);
    assert_eq!(trace(&shop), ["terminate", "free"]);
}

#[test]
fn instances_do_not_share_anything() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let fmu = Arc::new(fmu);
    let levels: Vec<f64> = (0..4)
        .map(|i| {
            let (fmu, name) = (Arc::clone(&fmu), format!("t{i}"));
            std::thread::spawn(move || {
                let mut instance = fmu.instantiate(&name, false).unwrap();
                instance.set_real(INFLOW, &[f64::from(i)]).unwrap();
                instance.exit_initialization().unwrap();
                for k in 0..100 {
                    let _ = instance.do_step(f64::from(k), 1.0).unwrap();
                }
                level(&mut instance)
            })
        })
        .map(|thread| thread.join().unwrap())
        .collect();
    #[allow(clippy::float_cmp, reason = "small whole numbers and a half are exact")]
    let exact = levels == [0.5, 100.5, 200.5, 300.5];
    assert!(exact, "{levels:?}");
}

#[test]
fn warnings_are_kept_and_counted() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let mut instance = started(&fmu, &shop, 1);
    assert_eq!(instance.do_step(0.0, 1.0).unwrap(), Outcome::Warning);
    assert_eq!(instance.do_step(1.0, 1.0).unwrap(), Outcome::Warning);
    assert_eq!(instance.warnings(), 2);
    let messages = instance.messages();
    assert_eq!(messages.len(), 1);
    assert_eq!((messages[0].text.as_str(), messages[0].count), ("nearly full", 2));
    assert_eq!(messages[0].to_string(), "fmi2Warning [tank] nearly full (x 2)");
    assert_eq!(messages[0].category, "tank");
    assert_eq!(messages[0].status, Status::Known(Fmi2Status::Warning));
    assert!(instance.messages().is_empty());
}

#[test]
fn a_flood_of_messages_keeps_the_last_ones() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let mut instance = fmu.instantiate("t1", true).unwrap();
    for k in 0..300 {
        instance
            .set_debug_logging(true, &["first", &format!("message_{k}")])
            .unwrap();
    }
    let messages = instance.messages();
    assert_eq!(messages.len(), 256);
    assert_eq!(messages[0].text, "message_44");
    assert_eq!(messages[255].text, "message_299");
}

#[test]
fn failed_calls_carry_status_and_messages() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    for (answer, status) in [
        (2, Status::Known(Fmi2Status::Discard)),
        (3, Status::Known(Fmi2Status::Error)),
        (4, Status::Known(Fmi2Status::Fatal)),
        (5, Status::Known(Fmi2Status::Pending)),
        (7, Status::Unknown(7)),
        (-1, Status::Unknown(-1)),
    ] {
        let mut instance = started(&fmu, &shop, answer);
        let error = instance.do_step(0.0, 1.0).unwrap_err();
        let ImportError::Call {
            instance: name,
            function,
            status: found,
            messages,
        } = &error
        else {
            panic!("{error}")
        };
        assert_eq!((name.as_str(), *function, *found), ("t1", "fmi2DoStep", status));
        // The doubled percent sign is one, and the number stands where the FMU wants it.
        assert_eq!(messages[0], format!("answer {answer} at 100% load"));
        assert!(error.to_string().contains("100% load"), "{error}");
        if answer == 2 {
            assert_eq!(
                messages[1..],
                ["last successful time 0 s", "the FMU asks to end the simulation"]
            );
        }
        // Only these two end an instance for good.
        let usable = !matches!(answer, 4 | 5);
        let after = instance.get_real(LEVEL, &mut [0.0]);
        assert_eq!(after.is_ok(), usable, "after status {answer}");
        if let Err(after) = after {
            assert!(
                matches!(&after, ImportError::Unusable { status: s, .. } if *s == status),
                "{after}"
            );
        }
        drop(instance);
        let expected: &[&str] = match answer {
            2 => &["terminate", "free"],
            4 | 5 => &[],
            _ => &["free"],
        };
        assert_eq!(trace(&shop), expected, "end of life after status {answer}");
        let _ = std::fs::remove_file(shop.path("trace"));
    }
}

#[test]
#[allow(clippy::float_cmp, reason = "a restored state is exact")]
fn states_come_back_and_are_freed_once() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, STATES) else { return };
    let mut instance = started(&fmu, &shop, 0);
    instance.set_real(INFLOW, &[1.0]).unwrap();
    let saved = instance.get_state().unwrap();
    let _ = instance.do_step(0.0, 4.0).unwrap();
    assert_eq!(trace(&shop), ["may go back"]);
    assert_eq!(level(&mut instance), 4.5);
    let bytes = {
        let later = instance.get_state().unwrap();
        instance.serialize_state(&later).unwrap()
    };
    assert_eq!(bytes, 4.5_f64.to_ne_bytes());
    instance.set_state(&saved).unwrap();
    assert_eq!(level(&mut instance), 0.5);

    let mut other = fmu.instantiate("t2", false).unwrap();
    assert!(matches!(
        other.set_state(&saved).unwrap_err(),
        ImportError::ForeignState { .. }
    ));
    assert!(matches!(
        other.serialize_state(&saved).unwrap_err(),
        ImportError::ForeignState { .. }
    ));
    let carried = other.deserialize_state(&bytes).unwrap();
    other.set_state(&carried).unwrap();
    assert_eq!(level(&mut other), 4.5);
    assert!(matches!(
        other.deserialize_state(&bytes[1..]).unwrap_err(),
        ImportError::Call { .. }
    ));

    // The state dropped above is freed with the next one; the two alive, with the instance.
    let _kept = instance.get_state().unwrap();
    assert_eq!(trace(&shop)[1..], ["free state"]);
    drop(instance);
    assert_eq!(trace(&shop)[2..], ["terminate", "free state", "free state", "free"]);
    drop(saved);
}

#[test]
fn states_need_the_capability() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, r#"canGetAndSetFMUstate="true""#) else {
        return;
    };
    let mut instance = started(&fmu, &shop, 0);
    let state = instance.get_state().unwrap();
    let error = instance.serialize_state(&state).unwrap_err();
    assert!(
        matches!(
            error,
            ImportError::NotOffered {
                flag: "canSerializeFMUstate",
                ..
            }
        ),
        "{error}"
    );
    let Some(fmu) = tank(&shop, "") else { return };
    let error = started(&fmu, &shop, 0).get_state().unwrap_err();
    assert!(
        matches!(
            error,
            ImportError::NotOffered {
                flag: "canGetAndSetFMUstate",
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn bad_arguments_do_not_reach_the_fmu() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let mut instance = started(&fmu, &shop, 0);
    let error = instance.set_real(&[0, 0], &[1.0]).unwrap_err();
    assert!(
        matches!(
            error,
            ImportError::LengthMismatch {
                references: 2,
                values: 1,
                ..
            }
        ),
        "{error}"
    );
    let error = instance.get_boolean(&[0], &mut []).unwrap_err();
    assert!(
        matches!(
            error,
            ImportError::LengthMismatch {
                references: 1,
                values: 0,
                ..
            }
        ),
        "{error}"
    );
    let error = instance.set_string(&[0], &["a\0b"]).unwrap_err();
    assert!(matches!(error, ImportError::NulInText { .. }), "{error}");
    assert!(matches!(
        fmu.instantiate("a\0b", false).unwrap_err(),
        ImportError::NulInText { .. }
    ));
    assert_eq!(trace(&shop), [""; 0], "the trace file is still named as before");
}

#[test]
fn an_instance_can_be_terminated_reset_and_run_again() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, "") else { return };
    let mut instance = started(&fmu, &shop, 3);
    assert!(instance.do_step(0.0, 1.0).is_err());
    instance.reset().unwrap();
    instance.setup_experiment(&EXPERIMENT).unwrap();
    instance.enter_initialization().unwrap();
    instance.exit_initialization().unwrap();
    let _ = instance.do_step(0.0, 1.0).unwrap();
    instance.terminate().unwrap();
    drop(instance);
    assert_eq!(trace(&shop), ["terminate", "free"], "terminated once");
}

#[test]
fn an_fmu_that_refuses_to_be_says_why() {
    let shop = Workshop::new();
    let Some(library) = shop.compile(&["REFUSE"]) else {
        return;
    };
    let fmu = Fmu::open(shop.fmu("refuse.fmu", &tank_description(""), &library)).unwrap();
    match fmu.instantiate("t1", false).unwrap_err() {
        ImportError::Instantiate { messages, .. } => assert_eq!(messages, ["no licence"]),
        other => panic!("{other}"),
    }
    let wrong_guid = tank_description("").replace("tank-1", "tank-2");
    let fmu = Fmu::open(shop.fmu("guid.fmu", &wrong_guid, &shop.compile(&[]).unwrap())).unwrap();
    assert!(matches!(
        fmu.instantiate("t1", false).unwrap_err(),
        ImportError::Instantiate { .. }
    ));
}

#[test]
fn once_per_process_is_kept() {
    let shop = Workshop::new();
    let Some(fmu) = tank(&shop, r#"canBeInstantiatedOnlyOncePerProcess="true""#) else {
        return;
    };
    let first = fmu.instantiate("t1", false).unwrap();
    assert!(matches!(
        fmu.instantiate("t2", false).unwrap_err(),
        ImportError::OnlyOnce { .. }
    ));
    drop(first);
    assert!(fmu.instantiate("t3", false).is_ok());
}

#[test]
fn a_library_of_another_kind_is_refused() {
    let shop = Workshop::new();
    for (define, names) in [
        ("WITHOUT_RESET", ["fmi2Reset", "does not export"]),
        ("VERSION=\"1.0\"", ["fmi2GetVersion", "\"1.0\", expected \"2.0\""]),
        (
            "TYPES=\"wide\"",
            ["fmi2GetTypesPlatform", "\"wide\", expected \"default\""],
        ),
    ] {
        let Some(library) = shop.compile(&[define]) else { return };
        let fmu = Fmu::open(shop.fmu("odd.fmu", &tank_description(""), &library)).unwrap();
        let error = fmu.load().unwrap_err();
        let kind = matches!(
            error,
            ImportError::MissingSymbol { .. } | ImportError::Incompatible { .. }
        );
        assert!(
            kind && names.iter().all(|n| error.to_string().contains(n)),
            "{define}: {error}"
        );
    }
}

#[test]
fn the_unpacked_folder_goes_with_its_last_owner() {
    let shop = Workshop::new();
    for answer in [0, 4] {
        let Some(fmu) = tank(&shop, "") else { return };
        let mut instance = started(&fmu, &shop, answer);
        drop(fmu);
        let folder = instance.get_string(&[1]).unwrap().remove(0);
        assert_eq!(instance.do_step(0.0, 1.0).is_ok(), answer == 0);
        assert!(Path::new(&folder).join("level.txt").exists(), "{folder}");
        assert!(
            !Path::new(&folder).join("../sources").exists(),
            "sources are of no use here"
        );
        drop(instance);
        // Fatal keeps the library loaded, and with it the files that it may still read.
        let unpacked = Path::new(&folder).parent().unwrap();
        assert_eq!(unpacked.exists(), answer == 4, "{folder} after answer {answer}");
        if answer == 4 {
            std::fs::remove_dir_all(unpacked).unwrap();
        }
    }
}
