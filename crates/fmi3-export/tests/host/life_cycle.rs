//! Call order, initialization, steps, failures, and the end.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ptr;

use fmi3_export::abi::Fmi3Status;

use crate::host::{Host, Stepped, UNTOUCHED, vr};
use crate::probe::{
    FAILS_IN_STEP, FAILS_TO_INITIALISE, GOOD, PANICS_IN_DROP, PANICS_IN_GET, PANICS_IN_STEP, WARNS, fmi3,
};

use Fmi3Status::{Error, Fatal, Ok as Fine, Warning};

/// The state machine of FMI 3.0, sections 2.3 and 4.2, as far as the phases exist here.
const ALLOWED: &str = "
    call         instantiated initializing stepping failed terminated
    enter        yes          -            -        -      -
    exit         -            yes          -        -      -
    set_fixed    yes          yes          -        -      -
    set_input    yes          yes          yes      -      -
    get_float64  yes          yes          yes      yes    yes
    get_int32    yes          yes          yes      yes    yes
    get_int64    yes          yes          yes      yes    yes
    get_boolean  yes          yes          yes      yes    yes
    get_string   yes          yes          yes      yes    yes
    do_step      -            -            yes      -      -
    terminate    -            -            yes      -      -
    logging      yes          yes          yes      yes    yes
    save         yes          yes          yes      yes    yes
    reset        yes          yes          yes      yes    yes
";

fn in_phase(phase: &str) -> Host {
    let host = match phase {
        "failed" => Host::stepping(FAILS_IN_STEP),
        "stepping" | "terminated" => Host::stepping(GOOD),
        _ => Host::new(),
    };
    match phase {
        "initializing" => assert_eq!(host.enter(), Fine),
        "failed" => assert_eq!(host.do_step(0.0, 1.0), Error),
        "terminated" => assert_eq!(host.terminate(), Fine),
        _ => {}
    }
    host.messages();
    host
}

fn call(host: &Host, name: &str) -> Fmi3Status {
    fn status<T>(answer: Result<T, Fmi3Status>) -> Fmi3Status {
        answer.err().unwrap_or(Fine)
    }
    match name {
        "enter" => host.enter(),
        "exit" => host.exit_initialization_mode(),
        "set_fixed" => host.set_float64(&[vr("gain")], &[2.0]),
        "set_input" => host.set_float64(&[vr("u")], &[2.0; 3]),
        "get_float64" => status(host.get_float64(&[vr("y")], 3)),
        "get_int32" => status(host.get_int32(&[vr("steps")], 1)),
        "get_int64" => status(host.get_int64(&[vr("kind_used")], 1)),
        "get_boolean" => status(host.get_boolean(&[vr("started")], 1)),
        "get_string" => status(host.get_string(&[vr("echo")])),
        "do_step" => host.do_step(0.0, 1.0),
        "terminate" => host.terminate(),
        "logging" => host.set_debug_logging(0, &[]),
        "save" => status(host.bytes()),
        "reset" => host.reset(),
        other => panic!("no call {other}"),
    }
}

#[test]
fn call_order_is_that_of_the_standard() {
    let mut rows = ALLOWED
        .lines()
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .filter(|row| !row.is_empty());
    let phases = rows.next().unwrap();
    let mut checked = 0;
    for row in rows {
        for (phase, allowed) in phases[1..].iter().zip(&row[1..]) {
            let host = in_phase(phase);
            let before = host.bytes().unwrap();
            let expected = if *allowed == "yes" { Fine } else { Error };
            assert_eq!(call(&host, row[0]), expected, "{} while {phase}", row[0]);
            if expected == Error {
                assert_eq!(host.bytes().unwrap(), before, "{} while {phase}", row[0]);
                let reason = host.reason(Error);
                assert!(reason.contains("not allowed in phase") || row[0] == "set_fixed");
            }
            checked += 1;
        }
    }
    assert_eq!(checked, 14 * 5);
}

#[test]
fn outputs_follow_the_parameters_throughout_initialization() {
    let host = Host::new();
    let (gain, y, initialisations) = (vr("gain"), vr("y"), vr("initialisations"));
    assert_eq!(host.set_float64(&[gain], &[4.0]), Fine);
    assert_eq!(host.enter_initialization_mode(0, 0.0, 20.0, 1, 30.0), Fine);
    assert_eq!(host.get_float64(&[y], 3), Ok(vec![4.0; 3]));
    assert_eq!(host.set_float64(&[gain], &[5.0]), Fine);
    assert_eq!(host.get_float64(&[y], 3), Ok(vec![5.0; 3]));
    assert_eq!(host.get_int32(&[initialisations], 1), Ok(vec![2]));
    assert_eq!(host.set_float64(&[gain], &[6.0]), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.get_float64(&[y], 3), Ok(vec![6.0; 3]));
    assert_eq!(host.get_int32(&[initialisations], 1), Ok(vec![3]));
}

#[test]
fn times_that_cannot_be_are_refused_and_leave_the_instance_instantiated() {
    let host = Host::new();
    let before = host.bytes().unwrap();
    for ((tolerance, start, stop), part) in [
        ((1e-6, f64::NAN, 1.0), "start time = NaN is not finite"),
        ((1e-6, 0.0, f64::INFINITY), "stop time = inf is not finite"),
        ((1e-6, 2.0, 1.0), "stop time 1 s is before start time 2 s"),
        ((0.0, 0.0, 1.0), "tolerance 0 must be greater than 0"),
    ] {
        assert_eq!(host.enter_initialization_mode(1, tolerance, start, 1, stop), Error);
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
        assert_eq!(host.bytes().unwrap(), before);
    }
    // what is not defined is not looked at
    let nan = f64::NAN;
    assert_eq!(host.enter_initialization_mode(0, nan, 0.0, 0, nan), Fine);
}

#[test]
fn a_step_tells_where_it_ended() {
    let host = Host::stepping(GOOD);
    let told = |last_successful_time| Stepped {
        event_handling_needed: 0,
        terminate_simulation: 0,
        early_return: 0,
        last_successful_time,
    };
    assert_eq!(host.step(0.0, 0.75), (Fine, told(0.75)));
    // refused and failed ones, too: where the last good one ended
    assert_eq!(host.step(0.0, 0.75), (Error, told(0.75)));
    assert_eq!(host.step(0.75, f64::NAN), (Error, told(0.75)));
    assert_eq!(host.messages().len(), 2);
    let failing = Host::stepping(FAILS_IN_STEP);
    assert_eq!(failing.step(0.0, 1.0), (Error, told(0.0)));
    assert_eq!(failing.step(0.0, 1.0), (Error, UNTOUCHED)); // not even asked: the phase forbids it
    // an answer without room
    let null = ptr::null_mut();
    let (c, mut flag, mut time) = (host.instance, 0, 0.0);
    // SAFETY: null is to be recognised.
    let answers = unsafe {
        [
            fmi3::fmi3DoStep(c, 0.75, 1.0, 1, null, &mut flag, &mut 0, &mut time),
            fmi3::fmi3DoStep(c, 0.75, 1.0, 1, &mut flag, &mut 0, &mut 0, ptr::null_mut()),
        ]
    };
    assert_eq!(answers, [Error.raw(); 2]);
    let messages = host.messages();
    assert!(messages[0].text.contains("argument eventHandlingNeeded is a null"));
    assert!(messages[1].text.contains("argument lastSuccessfulTime is a null"));
    assert_eq!(host.step(0.75, 1e4), (Fine, told(10000.75)));
}

#[test]
fn a_model_that_cannot_initialise_fails_until_reset() {
    let host = Host::new();
    let behaviour = vr("behaviour");
    assert_eq!(host.set_int64(&[behaviour], &[FAILS_TO_INITIALISE.into()]), Fine);
    assert_eq!(host.enter(), Error);
    let reason = host.reason(Error);
    assert!(reason.starts_with("fmi3EnterInitializationMode: the model failed"));
    assert!(reason.ends_with(": cannot start: no fuel"), "{reason}");
    assert_eq!(host.exit_initialization_mode(), Error);
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.enter(), Fine);
    assert_eq!(host.get_int64(&[behaviour], 1), Ok(vec![1]));
}

#[test]
fn a_panic_is_fatal_for_its_instance_alone() {
    for (behaviour, part) in [
        (PANICS_IN_STEP, "fmi3DoStep: panic inside the model: seized at 0 s"),
        (PANICS_IN_GET, "fmi3GetString: panic inside the model: lost my voice"),
    ] {
        let other = Host::stepping(GOOD);
        let host = Host::stepping(behaviour);
        let status = match behaviour {
            PANICS_IN_STEP => host.do_step(0.0, 1.0),
            _ => host.get_string(&[vr("echo")]).unwrap_err(),
        };
        assert_eq!(status, Fatal);
        let messages = host.messages();
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].text, part);
        assert_eq!(messages[0].category, "logStatusFatal");
        // nothing reaches the model any more
        assert_eq!(host.do_step(0.0, 1.0), Fatal);
        assert_eq!(host.reset(), Fatal);
        assert_eq!(host.get_float64(&[vr("gain")], 1), Err(Fatal));
        assert_eq!(host.free(), []);
        assert_eq!(other.do_step(0.0, 1.0), Fine);
    }
    let messages = Host::stepping(PANICS_IN_DROP).free();
    assert_eq!(messages.len(), 1);
    assert_eq!(
        messages[0].text,
        "fmi3FreeInstance: panic inside the model: does not want to go"
    );
}

#[test]
fn a_warning_of_the_model_is_the_status_of_the_call() {
    let host = Host::stepping(WARNS);
    assert_eq!(host.set_debug_logging(0, &[]), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Warning);
    assert_eq!(host.messages(), []);
    assert_eq!(host.set_debug_logging(1, &[c"logStatusWarning"]), Fine);
    assert_eq!(host.do_step(1.0, 1.0), Warning);
    assert_eq!(host.reason(Warning), "running hot: 90 %s");
}

#[test]
fn reset_is_as_instantiated() {
    let host = Host::new();
    let fresh = host.bytes().unwrap();
    assert_eq!(host.set_float64(&["gain", "u"].map(vr), &[2.0, 3.0, 4.0, 5.0]), Fine);
    assert_eq!(host.set_string(&[vr("label")], &[c"other"]), Fine);
    assert_eq!(host.enter_initialization_mode(1, 1e-3, 5.0, 1, 9.0), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.do_step(5.0, 1.0), Fine);
    assert_ne!(host.bytes().unwrap(), fresh);
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.bytes().unwrap(), fresh);
}

#[test]
fn misuse_of_handles_is_an_error() {
    let null = ptr::null_mut();
    // SAFETY: null is to be recognised.
    unsafe {
        assert_eq!(fmi3::fmi3Reset(null), Error.raw());
        fmi3::fmi3FreeInstance(null);
    }
    // aligned memory that is not an instance, and a state where an instance should be
    let host = Host::new();
    let mut foreign = [0_u64; 64];
    let mut state = null;
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    for instance in [foreign.as_mut_ptr().cast(), state, ptr::dangling_mut()] {
        // SAFETY: only the head is read, and only if aligned.
        unsafe {
            assert_eq!(fmi3::fmi3Reset(instance), Error.raw());
            fmi3::fmi3FreeInstance(instance);
        }
    }
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

#[test]
fn a_call_from_inside_the_logger_is_refused() {
    let host = Host::new();
    *host.journal.call_back.lock().unwrap() = Some((host.instance as usize, Vec::new()));
    assert_eq!(host.do_step(0.0, 1.0), Error);
    let (_, answers) = host.journal.call_back.lock().unwrap().take().unwrap();
    assert_eq!(answers, [Error]);
    let messages = host.messages();
    assert_eq!(messages.len(), 3, "{messages:?}");
    for (message, function) in messages[1..].iter().zip(["fmi3Reset", "fmi3FreeInstance"]) {
        assert!(message.text.starts_with(function), "{message:?}");
        assert!(message.text.contains("another call"), "{message:?}");
    }
    // and the instance is as good as before
    assert_eq!(host.enter(), Fine);
}

#[test]
fn what_is_not_there_is_answered_with_the_reason() {
    let host = Host::stepping(GOOD);
    for (status, part) in [
        (host.enter_event_mode(), "hasEventMode"),
        (host.enter_step_mode(), "hasEventMode"),
        (host.enter_configuration_mode(), "no structural parameters"),
        (host.set_time(1.0), "co-simulation only"),
        (host.activate_model_partition(0, 1.0), "co-simulation only"),
    ] {
        assert_eq!(status, Error, "{part}");
    }
    let (c, mut n, mut f) = (host.instance, 0_usize, [0_u8; 5]);
    let (vr, real, whole) = (ptr::null(), ptr::null_mut::<f64>(), ptr::null_mut::<u64>());
    let [a, b, d, e, g] = &mut f;
    // SAFETY: arguments beyond the instance are not looked at.
    let answers = unsafe {
        [
            fmi3::fmi3GetNumberOfVariableDependencies(c, 0, &mut n),
            fmi3::fmi3GetVariableDependencies(c, 0, &mut n, ptr::null_mut(), &mut 0, ptr::null_mut(), 0),
            fmi3::fmi3GetDirectionalDerivative(c, vr, 0, vr, 0, real, 0, real, 0),
            fmi3::fmi3GetAdjointDerivative(c, vr, 0, vr, 0, real, 0, real, 0),
            fmi3::fmi3ExitConfigurationMode(c),
            fmi3::fmi3GetIntervalDecimal(c, vr, 0, real, ptr::null_mut()),
            fmi3::fmi3GetIntervalFraction(c, vr, 0, whole, whole, ptr::null_mut()),
            fmi3::fmi3GetShiftDecimal(c, vr, 0, real),
            fmi3::fmi3GetShiftFraction(c, vr, 0, whole, whole),
            fmi3::fmi3SetIntervalDecimal(c, vr, 0, real),
            fmi3::fmi3SetIntervalFraction(c, vr, 0, whole, whole),
            fmi3::fmi3SetShiftDecimal(c, vr, 0, real),
            fmi3::fmi3SetShiftFraction(c, vr, 0, whole, whole),
            fmi3::fmi3EvaluateDiscreteStates(c),
            fmi3::fmi3UpdateDiscreteStates(c, a, b, d, e, g, real),
            fmi3::fmi3GetOutputDerivatives(c, vr, 0, ptr::null(), real, 0),
            fmi3::fmi3EnterContinuousTimeMode(c),
            fmi3::fmi3CompletedIntegratorStep(c, 0, ptr::null_mut(), ptr::null_mut()),
            fmi3::fmi3SetContinuousStates(c, real, 0),
            fmi3::fmi3GetContinuousStateDerivatives(c, real, 0),
            fmi3::fmi3GetEventIndicators(c, real, 0),
            fmi3::fmi3GetContinuousStates(c, real, 0),
            fmi3::fmi3GetNominalsOfContinuousStates(c, real, 0),
            fmi3::fmi3GetNumberOfEventIndicators(c, &mut n),
            fmi3::fmi3GetNumberOfContinuousStates(c, &mut n),
        ]
    };
    assert_eq!(answers, [Error.raw(); 25]);
    let texts: Vec<_> = host.messages().into_iter().map(|m| m.text).collect();
    assert_eq!(texts.len(), 30);
    for (text, part) in texts.iter().zip(
        [
            "hasEventMode",
            "hasEventMode",
            "structural",
            "co-simulation only",
            "co-simulation only",
        ]
        .into_iter()
        .chain(["providesPerElementDependencies"; 2])
        .chain([
            "providesDirectionalDerivatives",
            "providesAdjointDerivatives",
            "structural",
        ])
        .chain(["there are no clocks"; 8])
        .chain(["hasEventMode", "hasEventMode", "maxOutputDerivativeOrder"])
        .chain(["co-simulation only"; 9]),
    ) {
        assert!(text.contains(part), "{text}: {part}");
    }
    assert_eq!(host.do_step(0.0, 1.0), Fine);
}

#[test]
fn instances_run_side_by_side_in_threads() {
    let run = |gain: f64| {
        let host = Host::new();
        assert_eq!(host.set_float64(&["gain", "u"].map(vr), &[gain, 1.0, 0.0, 0.0]), Fine);
        assert_eq!(host.enter(), Fine);
        assert_eq!(host.exit_initialization_mode(), Fine);
        for k in 0..200 {
            assert_eq!(host.do_step(f64::from(k) * 0.5, 0.5), Fine);
        }
        host.get_float64(&[vr("y")], 3).unwrap()[0]
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (1..=8).map(|i| (i, scope.spawn(move || run(f64::from(i))))).collect();
        for (i, thread) in threads {
            assert_eq!(thread.join().unwrap(), f64::from(i) + 100.0);
        }
    });
}
