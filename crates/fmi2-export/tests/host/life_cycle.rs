//! Creation, call order, initialization, steps, failures, and the end.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CStr, CString};
use std::ptr;

use fmi2_export::abi::{Fmi2CallbackFunctions, Fmi2Status};

use crate::host::{Host, Journal, callbacks, own_guid, vr};
use crate::probe::{
    FAILS_IN_STEP, FAILS_TO_INITIALISE, LONGEST_STEP, PANICS_IN_CHECK, PANICS_IN_DROP, PANICS_IN_GET, PANICS_IN_STEP,
    WARNS, fmi2,
};

use Fmi2Status::{Discard, Error, Fatal, Ok as Fine, Warning};

/// What `fmi2Instantiate` logs when it must answer null.
#[track_caller]
fn refusal(name: Option<&CStr>, kind: i32, guid: Option<&CStr>) -> String {
    let journal = Journal::default();
    let functions = callbacks(&journal);
    let pointer = |text: Option<&CStr>| text.map_or(ptr::null(), CStr::as_ptr);
    // SAFETY: pointers are null or to live values.
    let component = unsafe { fmi2::fmi2Instantiate(pointer(name), kind, pointer(guid), ptr::null(), &functions, 0, 1) };
    assert!(component.is_null());
    let messages = journal.messages.into_inner().unwrap();
    assert_eq!(messages.len(), 1);
    assert_eq!(messages[0].category, "logStatusError");
    messages[0].text.clone()
}

#[test]
fn instantiate_says_why_not() {
    let own = CString::new(own_guid()).unwrap();
    let (name, own) = (Some(c"x"), Some(own.as_c_str()));
    let wrong = refusal(name, 1, Some(c"{abc}"));
    assert!(
        wrong.contains("the GUID given is '{abc}'") && wrong.contains(&own_guid()),
        "{wrong}"
    );
    for (reason, part) in [
        (refusal(name, 0, own), "co-simulation only"),
        (refusal(name, 7, own), "unknown fmi2Type 7"),
        (refusal(Some(c""), 1, own), "name is empty"),
        (refusal(None, 1, own), "instanceName is a null"),
        (refusal(name, 1, None), "fmuGUID is a null"),
        (refusal(Some(c"\xff"), 1, own), "instanceName is not UTF-8"),
    ] {
        assert!(reason.contains(part), "{reason}");
        assert!(reason.starts_with("fmi2Instantiate: "), "{reason}");
    }
}

/// Whatever the host does not offer, an instance lives without.
#[test]
fn any_callback_may_be_missing() {
    let own = CString::new(own_guid()).unwrap();
    let journal = Journal::default();
    let whole = callbacks(&journal);
    let none = Fmi2CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::null_mut(),
    };
    let mute = Fmi2CallbackFunctions { logger: None, ..whole };
    // Without allocator in any case; with a logger that hears of refused calls, or none.
    for (functions, heard) in [
        (ptr::null(), 0),
        (ptr::from_ref(&none), 0),
        (ptr::from_ref(&mute), 0),
        (ptr::from_ref(&whole), 2),
    ] {
        let (name, guid) = (c"x".as_ptr(), own.as_ptr());
        // SAFETY: pointers are null or to live values.
        let component = unsafe { fmi2::fmi2Instantiate(name, 1, guid, ptr::null(), functions, 0, 1) };
        assert!(!component.is_null());
        let mut steps = 0;
        // SAFETY: the component is alive, and the arrays have one element.
        unsafe {
            assert_eq!(fmi2::fmi2DoStep(component, 0.0, 1.0, 1), Error.raw());
            assert_eq!(fmi2::fmi2EnterInitializationMode(component), Fine.raw());
            assert_eq!(fmi2::fmi2ExitInitializationMode(component), Fine.raw());
            assert_eq!(fmi2::fmi2DoStep(component, 0.0, 1.0, 1), Fine.raw());
            assert_eq!(fmi2::fmi2GetInteger(component, &vr("steps"), 1, &mut steps), Fine.raw());
            assert_eq!(fmi2::fmi2Terminate(component), Fine.raw());
            fmi2::fmi2FreeInstance(component);
            // Refused, and nobody to tell where there are no callbacks.
            assert!(fmi2::fmi2Instantiate(name, 1, c"{}".as_ptr(), ptr::null(), functions, 0, 1).is_null());
        }
        assert_eq!(steps, 1);
        let refusals = std::mem::take(&mut *journal.messages.lock().unwrap());
        let refusals = refusals.iter().filter(|m| m.status == Error).count();
        assert_eq!(refusals, heard);
    }
    // SAFETY: a misaligned pointer is not read.
    unsafe {
        let askew = ptr::without_provenance(1);
        assert!(fmi2::fmi2Instantiate(c"x".as_ptr(), 1, own.as_ptr(), ptr::null(), askew, 0, 1).is_null());
    }
}

#[test]
fn version_and_platform_are_those_of_the_standard() {
    // SAFETY: static strings.
    let (version, platform) = unsafe {
        (
            CStr::from_ptr(fmi2::fmi2GetVersion()),
            CStr::from_ptr(fmi2::fmi2GetTypesPlatform()),
        )
    };
    assert_eq!((version, platform), (c"2.0", c"default"));
}

/// The table of FMI 2.0.3, section 4.2.4, as far as the phases exist here.
const ALLOWED: &str = "
    call         instantiated initializing stepping failed terminated
    setup        yes          -            -        -      -
    enter        yes          -            -        -      -
    exit         -            yes          -        -      -
    set_fixed    yes          yes          -        -      -
    set_input    yes          yes          yes      -      -
    get_real     -            yes          yes      yes    yes
    get_integer  -            yes          yes      yes    yes
    get_boolean  -            yes          yes      yes    yes
    get_string   -            yes          yes      yes    yes
    do_step      -            -            yes      -      -
    status       -            -            yes      yes    yes
    terminate    -            -            yes      -      -
    logging      yes          yes          yes      yes    yes
    save         yes          yes          yes      yes    yes
    reset        yes          yes          yes      yes    yes
";

fn in_phase(phase: &str) -> Host {
    let host = match phase {
        "failed" => Host::stepping(&[("behaviour", FAILS_IN_STEP)]),
        "stepping" | "terminated" => Host::stepping(&[]),
        _ => Host::new(),
    };
    match phase {
        "initializing" => assert_eq!(host.enter_initialization_mode(), Fine),
        "failed" => assert_eq!(host.do_step(0.0, 1.0), Error),
        "terminated" => assert_eq!(host.terminate(), Fine),
        _ => {}
    }
    host.messages();
    host
}

fn call(host: &Host, name: &str) -> Fmi2Status {
    fn status<T>(answer: Result<T, Fmi2Status>) -> Fmi2Status {
        answer.err().unwrap_or(Fine)
    }
    match name {
        "setup" => host.setup_experiment(0, 0.0, 0.0, 0, 0.0),
        "enter" => host.enter_initialization_mode(),
        "exit" => host.exit_initialization_mode(),
        "set_fixed" => host.set_real(&[vr("gain")], &[2.0]),
        "set_input" => host.set_real(&[vr("u[1]")], &[2.0]),
        "get_real" => status(host.get_real(&[vr("y[1]")])),
        "get_integer" => status(host.get_integer(&[vr("steps")])),
        "get_boolean" => status(host.get_boolean(&[vr("started")])),
        "get_string" => status(host.get_string(&[vr("echo")])),
        "do_step" => host.do_step(0.0, 1.0),
        "status" => {
            let mut time = 0.0;
            // SAFETY: the component is alive.
            let raw = unsafe { fmi2::fmi2GetRealStatus(host.component, 2, &mut time) };
            Fmi2Status::from_raw(raw).unwrap()
        }
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
    assert_eq!(checked, 15 * 5);
}

#[test]
fn a_call_out_of_order_names_function_phase_and_remedy() {
    let host = Host::new();
    assert_eq!(host.do_step(0.0, 1.0), Error);
    assert_eq!(
        host.reason(Error),
        "fmi2DoStep: not allowed in phase 'instantiated', only in: step complete"
    );
}

#[test]
fn outputs_follow_the_parameters_throughout_initialization() {
    let host = Host::new();
    let (gain, y, initialisations) = (vr("gain"), vr("y[2]"), vr("initialisations"));
    assert_eq!(host.set_real(&[gain], &[4.0]), Fine);
    assert_eq!(host.setup_experiment(0, 0.0, 20.0, 1, 30.0), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.get_real(&[y]), Ok(vec![4.0]));
    assert_eq!(host.set_real(&[gain], &[5.0]), Fine);
    assert_eq!(host.get_real(&[y]), Ok(vec![5.0]));
    assert_eq!(host.get_integer(&[initialisations]), Ok(vec![2]));
    assert_eq!(host.set_real(&[gain], &[6.0]), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.get_real(&[y]), Ok(vec![6.0]));
    assert_eq!(host.get_integer(&[initialisations]), Ok(vec![3]));
    // an input set between steps does not initialise anew
    assert_eq!(host.set_real(&[vr("u[2]")], &[1.0]), Fine);
    assert_eq!(host.do_step(20.0, 0.5), Fine);
    assert_eq!(host.get_real(&[y]), Ok(vec![7.0]));
    assert_eq!(host.get_integer(&[initialisations]), Ok(vec![3]));
}

#[test]
fn setup_experiment_refuses_times_that_cannot_be() {
    let host = Host::new();
    for ((tolerance, start, stop), part) in [
        ((1e-6, f64::NAN, 1.0), "start time = NaN is not finite"),
        ((1e-6, 0.0, f64::INFINITY), "stop time = inf is not finite"),
        ((1e-6, 2.0, 1.0), "stop time 1 s is before start time 2 s"),
        ((0.0, 0.0, 1.0), "tolerance 0 must be greater than 0"),
        ((f64::NAN, 0.0, 1.0), "tolerance = NaN is not finite"),
    ] {
        assert_eq!(host.setup_experiment(1, tolerance, start, 1, stop), Error);
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
    }
    // what is not defined is not looked at
    let nan = f64::NAN;
    assert_eq!(host.setup_experiment(0, nan, 0.0, 0, nan), Fine);
}

#[test]
fn steps_of_any_size_are_taken_past_the_stop_time_and_must_be_gapless() {
    let host = Host::new();
    assert_eq!(host.setup_experiment(0, 0.0, 0.0, 1, 1.0), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    assert_eq!(host.do_step(1.0, 1e-16), Fine);
    assert_eq!(host.do_step(1.0, 0.1), Fine);
    assert_eq!(host.do_step(1.1 + 1e-13, 1e4), Fine);
    let before = host.bytes().unwrap();
    for ((t, h), part) in [
        (
            (0.0, 1.0),
            "communication point 0 s does not follow on the end of the last step, 10001.1 s",
        ),
        ((10002.0, 1.0), "10002 s does not follow"),
        ((10001.1, 0.0), "step size 0 s must be greater than 0"),
        ((10001.1, -1.0), "step size -1 s must be"),
        ((10001.1, f64::NAN), "step size = NaN is not finite"),
        ((f64::NAN, 1.0), "point = NaN is not finite"),
        ((f64::INFINITY, 1.0), "point = inf is not finite"),
        ((10001.1, f64::INFINITY), "step size = inf is not finite"),
        (
            (10001.1, f64::MAX),
            "the model does not take this step: too far: patience has an end",
        ),
        ((10001.1, 1.1 * LONGEST_STEP), "the model does not take this step"),
    ] {
        // What the model does not take it may take otherwise; what the times forbid is a mistake.
        let expected = if part.starts_with("the model") { Discard } else { Error };
        assert_eq!(host.do_step(t, h), expected);
        let reason = host.reason(expected);
        assert!(reason.contains(part), "{reason}");
        assert_eq!(host.bytes().unwrap(), before);
    }
    assert_eq!(host.get_integer(&[vr("steps")]), Ok(vec![4]));
    assert_eq!(host.do_step(10001.1, 1.0), Fine, "as good as before");
}

/// Seconds since 2000 as of the end of 2025: doubles are 1.2e-7 s apart there, and 1e-9 of it is eight steps.
const LATE: f64 = 8.2e8;

#[test]
fn steps_counted_or_added_up_follow_one_another_however_late_the_start() {
    let h = 0.1;
    for start in [0.0, LATE] {
        let begun = || {
            let host = Host::new();
            assert_eq!(host.setup_experiment(0, 0.0, start, 0, 0.0), Fine);
            assert_eq!(host.enter_initialization_mode(), Fine);
            assert_eq!(host.exit_initialization_mode(), Fine);
            host
        };
        let (counted, added_up) = (begun(), begun());
        let mut t = start;
        for k in 0..1_000_000 {
            assert_eq!(added_up.do_step(t, h), Fine, "{t}");
            t += h;
            let t = start + f64::from(k) * h;
            assert_eq!(counted.do_step(t, h), Fine, "{t}");
        }
        assert_eq!(counted.get_integer(&[vr("steps")]), Ok(vec![1_000_000]));
    }
}

#[test]
fn a_gap_is_refused_however_late_the_start() {
    for start in [0.0, LATE, -LATE] {
        let host = Host::new();
        assert_eq!(host.setup_experiment(0, 0.0, start, 0, 0.0), Fine);
        assert_eq!(host.enter_initialization_mode(), Fine);
        assert_eq!(host.exit_initialization_mode(), Fine);
        assert_eq!(host.do_step(start, 0.25), Fine);
        let before = host.bytes().unwrap();
        for off in [-0.25, 0.25, 1e-3, 1e-5] {
            assert_eq!(host.do_step(start + 0.25 + off, 0.25), Error, "{start} {off}");
            assert!(
                host.reason(Error)
                    .contains("does not follow on the end of the last step")
            );
            assert_eq!(host.bytes().unwrap(), before);
        }
        assert_eq!(host.do_step(start + 0.25, 0.25), Fine, "as good as before");
    }
}

#[test]
fn a_model_that_cannot_initialise_fails_until_reset() {
    let host = Host::new();
    let behaviour = vr("behaviour");
    assert_eq!(host.set_integer(&[behaviour], &[FAILS_TO_INITIALISE]), Fine);
    assert_eq!(host.enter_initialization_mode(), Error);
    let reason = host.reason(Error);
    assert!(reason.starts_with("fmi2EnterInitializationMode: the model failed"));
    assert!(reason.ends_with(": cannot start: no fuel"), "{reason}");
    assert_eq!(host.exit_initialization_mode(), Error);
    assert_eq!(host.get_integer(&[behaviour]), Ok(vec![FAILS_TO_INITIALISE]));
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.get_integer(&[behaviour]), Ok(vec![1]));
}

#[test]
fn a_failed_step_leaves_time_and_values_readable() {
    let host = Host::stepping(&[("behaviour", FAILS_IN_STEP)]);
    let good = Host::stepping(&[]);
    assert_eq!(good.do_step(0.0, 2.0), Fine);
    assert_eq!(host.do_step(0.0, 2.0), Error);
    assert!(host.reason(Error).ends_with("stuck"));
    let mut time = -1.0;
    // SAFETY: the component is alive.
    let raw = unsafe { fmi2::fmi2GetRealStatus(host.component, 2, &mut time) };
    assert_eq!((raw, time), (0, 0.0));
    assert_eq!(host.get_integer(&[vr("steps")]), Ok(vec![0]));
    host.restore(&good.bytes().unwrap());
    assert_eq!(host.do_step(2.0, 1.0), Fine);
    assert_eq!(host.get_integer(&[vr("steps")]), Ok(vec![2]));
}

#[test]
fn a_panic_is_fatal_for_its_instance_alone() {
    for (behaviour, part) in [
        (PANICS_IN_STEP, "fmi2DoStep: panic inside the model: seized at 0 s"),
        (PANICS_IN_CHECK, "fmi2DoStep: panic inside the model: cannot judge 0 s"),
        (PANICS_IN_GET, "fmi2GetString: panic inside the model: lost my voice"),
    ] {
        let other = Host::stepping(&[]);
        let host = Host::stepping(&[("behaviour", behaviour)]);
        let status = match behaviour {
            PANICS_IN_STEP | PANICS_IN_CHECK => host.do_step(0.0, 1.0),
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
        assert_eq!(host.get_real(&[vr("gain")]), Err(Fatal));
        assert_eq!(host.bytes(), Err(Error));
        assert_eq!(host.free(), []);
        assert_eq!(other.do_step(0.0, 1.0), Fine);
    }
}

#[test]
fn a_panic_while_freeing_stays_inside() {
    let messages = Host::stepping(&[("behaviour", PANICS_IN_DROP)]).free();
    assert_eq!(messages.len(), 1);
    assert_eq!(
        messages[0].text,
        "fmi2FreeInstance: panic inside the model: does not want to go"
    );
}

#[test]
fn a_warning_of_the_model_is_the_status_of_the_call() {
    let host = Host::stepping(&[("behaviour", WARNS)]);
    assert_eq!(host.do_step(0.0, 1.0), Warning);
    assert_eq!(host.reason(Warning), "running hot: 90 %%s");
    assert_eq!(host.do_step(1.0, 1.0), Warning);
}

#[test]
fn reset_is_as_instantiated() {
    let host = Host::new();
    let fresh = host.bytes().unwrap();
    assert_eq!(host.setup_experiment(1, 1e-3, 5.0, 1, 9.0), Fine);
    assert_eq!(host.set_real(&[vr("gain"), vr("u[3]")], &[2.0, 3.0]), Fine);
    assert_eq!(host.set_string(&[vr("label")], &[c"other"]), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
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
        assert_eq!(fmi2::fmi2DoStep(null, 0.0, 1.0, 1), Error.raw());
        assert_eq!(fmi2::fmi2Reset(null), Error.raw());
        fmi2::fmi2FreeInstance(null);
    }
    // aligned memory that is not an instance, and a state where an instance should be
    let host = Host::new();
    let mut foreign = [0_u64; 64];
    let mut state = null;
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    for component in [foreign.as_mut_ptr().cast(), state, ptr::dangling_mut()] {
        // SAFETY: only the head is read, and only if aligned.
        unsafe {
            assert_eq!(fmi2::fmi2Reset(component), Error.raw());
            fmi2::fmi2FreeInstance(component);
        }
    }
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

#[test]
fn a_call_from_inside_the_logger_is_refused() {
    let host = Host::new();
    *host.journal.call_back.lock().unwrap() = Some((host.component as usize, Vec::new()));
    assert_eq!(host.do_step(0.0, 1.0), Error);
    let (_, answers) = host.journal.call_back.lock().unwrap().take().unwrap();
    assert_eq!(answers, [Error]);
    let messages = host.messages();
    assert_eq!(messages.len(), 3, "{messages:?}");
    for (message, function) in messages[1..].iter().zip(["fmi2GetReal", "fmi2FreeInstance"]) {
        assert!(message.text.starts_with(function), "{message:?}");
        assert!(message.text.contains("another call"), "{message:?}");
    }
    // and the instance is as good as before
    assert_eq!(host.enter_initialization_mode(), Fine);
}

#[test]
fn what_is_not_there_is_answered_with_the_reason() {
    let host = Host::stepping(&[]);
    assert_eq!(host.cancel_step(), Error);
    assert!(host.reason(Error).contains("no step is ever pending"));
    assert_eq!(host.enter_event_mode(), Error);
    assert_eq!(host.reason(Error), "fmi2EnterEventMode: this FMU is co-simulation only");
    assert_eq!(host.set_time(1.0), Error);
    assert_eq!(host.enter_continuous_time_mode(), Error);
    host.messages();
    let c = host.component;
    let (n, d) = (ptr::null_mut(), ptr::null());
    // SAFETY: arguments beyond the component are not looked at.
    let answers = unsafe {
        [
            fmi2::fmi2SetRealInputDerivatives(c, d, 0, ptr::null(), ptr::null()),
            fmi2::fmi2GetRealOutputDerivatives(c, d, 0, ptr::null(), n),
            fmi2::fmi2GetDirectionalDerivative(c, d, 0, d, 0, ptr::null(), n),
            fmi2::fmi2NewDiscreteStates(c, ptr::null_mut()),
            fmi2::fmi2CompletedIntegratorStep(c, 0, ptr::null_mut(), ptr::null_mut()),
            fmi2::fmi2SetContinuousStates(c, ptr::null(), 0),
            fmi2::fmi2GetDerivatives(c, n, 0),
            fmi2::fmi2GetEventIndicators(c, n, 0),
            fmi2::fmi2GetContinuousStates(c, n, 0),
            fmi2::fmi2GetNominalsOfContinuousStates(c, n, 0),
        ]
    };
    assert_eq!(answers, [Error.raw(); 10]);
    let texts: Vec<_> = host.messages().into_iter().map(|m| m.text).collect();
    for (text, part) in texts.iter().zip([
        "canInterpolateInputs",
        "maxOutputDerivativeOrder",
        "providesDirectionalDerivative",
    ]) {
        assert!(text.contains(part), "{text}");
    }
    assert!(
        texts[3..]
            .iter()
            .all(|text| text.ends_with("this FMU is co-simulation only"))
    );
    assert_eq!(host.do_step(0.0, 1.0), Fine);
}

#[test]
fn status_queries_answer_or_discard() {
    let host = Host::stepping(&[]);
    assert_eq!(host.do_step(0.0, 0.75), Fine);
    let c = host.component;
    let (mut status, mut real, mut integer, mut boolean) = (77, 7.0, 77, 77);
    let mut string = ptr::null();
    // SAFETY: the component is alive, the answers have room.
    let answers = unsafe {
        [
            fmi2::fmi2GetRealStatus(c, 2, &mut real),
            fmi2::fmi2GetBooleanStatus(c, 3, &mut boolean),
            fmi2::fmi2GetStatus(c, 0, &mut status),
            fmi2::fmi2GetStringStatus(c, 1, &mut string),
            fmi2::fmi2GetIntegerStatus(c, 2, &mut integer),
            fmi2::fmi2GetRealStatus(c, 3, &mut real),
            fmi2::fmi2GetRealStatus(c, 9, &mut real),
            fmi2::fmi2GetRealStatus(c, 2, ptr::null_mut()),
        ]
    };
    assert_eq!(answers, [0, 0, 2, 2, 2, 2, 3, 3]);
    assert_eq!((status, real, integer, boolean), (77, 0.75, 77, 0));
    let messages = host.messages();
    assert_eq!(messages.len(), 6);
    assert!(messages[..4].iter().all(|m| m.category == "logStatusDiscard"));
    assert!(messages[4].text.contains("unknown fmi2StatusKind 9"));
    assert!(messages[5].text.contains("argument value is a null"));
}

#[test]
fn instances_run_side_by_side_in_threads() {
    let run = |gain: f64| {
        let host = Host::new();
        assert_eq!(host.set_real(&[vr("gain"), vr("u[1]")], &[gain, 1.0]), Fine);
        assert_eq!(host.enter_initialization_mode(), Fine);
        assert_eq!(host.exit_initialization_mode(), Fine);
        for k in 0..200 {
            assert_eq!(host.do_step(f64::from(k) * 0.5, 0.5), Fine);
        }
        host.get_real(&[vr("y[1]")]).unwrap()[0]
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (1..=8).map(|i| (i, scope.spawn(move || run(f64::from(i))))).collect();
        for (i, thread) in threads {
            assert_eq!(thread.join().unwrap(), f64::from(i) + 100.0);
        }
    });
}
