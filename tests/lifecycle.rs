//! The life of both FMUs as any host may lead it: reset, saved states, many instances, odd steps, and mistakes.
//!
//! Every comparison is of bits: an FMU either goes on exactly as it would have, or it has forgotten something.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![allow(clippy::float_cmp, reason = "bits are what is compared")]

mod common;

use common::fmi::{FROM_ZERO, bits, get, initialise, names, set, step};
use common::{fmu, repacked};
use fmi2_import::{Causality, Experiment, Fmi2Status, Fmu, ImportError, Instance, Status, Value};
use interface::annotation::{self, Filters};
use std::sync::{Arc, LazyLock};

/// Length of a run, in steps of [`H`]: MILTON's buffer of 30 samples fills and adapts.
const STEPS: usize = 160;
/// Communication step, s: every other one ends between samples and between the grid points of the truth.
const H: f64 = 0.5;

fn time(k: usize) -> f64 {
    k as f64 * H
}

static TRUTH: LazyLock<Arc<Fmu>> = LazyLock::new(|| Arc::new(Fmu::open(fmu("fmu-truth")).unwrap()));
static NAV: LazyLock<Arc<Fmu>> = LazyLock::new(|| Arc::new(Fmu::open(fmu("fmu-nav")).unwrap()));
/// What fmu-nav tells of its filters.
static TOLD: LazyLock<Filters> =
    LazyLock::new(|| Filters::read(NAV.description().annotations(annotation::TOOL)).unwrap());

fn texts(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
        .collect()
}

/// Names of the items of an enumeration of fmu-nav.
fn items(name: &str) -> impl Iterator<Item = &str> {
    let items = NAV.description().variable(name).unwrap().enumeration_items().unwrap();
    items.iter().map(|item| item.name.as_str())
}

/// Filters that have a meaning in a scenario.
fn filters(scenario: &str) -> impl Iterator<Item = &str> {
    items("filter").filter(move |filter| TOLD.without_meaning(filter, scenario, "of a scenario").is_none())
}

/// Noise, faults and a push of the target, so that every random stream and every latch is in use.
fn world(scenario: &str) -> Vec<(String, String)> {
    texts(&[
        ("scenario", scenario),
        ("run", "3"),
        ("lidar.dropout_probability", "0.1"),
        ("metrology.dropout_probability", "0.1"),
        ("lidar.outlier_probability", "0.05"),
        ("target_burn.start", "20"),
        ("target_burn.duration", "30"),
        ("target_burn.a_t_n[2]", "1e-4"),
    ])
}

/// What is set on an FMU before each step of a run.
type Script = Vec<Vec<(String, Value)>>;

/// One FMU with its parameters and inputs.
#[derive(Clone)]
struct Case {
    label: String,
    fmu: Arc<Fmu>,
    parameters: Vec<(String, String)>,
    script: Arc<Script>,
}

impl Case {
    fn instance(&self) -> Instance {
        self.fmu.instantiate(&self.label, false).unwrap()
    }

    fn started(&self) -> Instance {
        let mut instance = self.instance();
        initialise(&mut instance, &self.parameters, &FROM_ZERO);
        instance
    }

    fn watched(&self) -> Vec<String> {
        names(&self.fmu, &[Causality::Output, Causality::Local])
    }

    /// Sets the inputs of step `k` and takes it.
    fn step(&self, instance: &mut Instance, k: usize) {
        for (name, value) in &self.script[k] {
            set(instance, name, value).unwrap();
        }
        step(instance, time(k), H);
    }

    /// Takes some steps; returns every output and local after each.
    fn run(&self, instance: &mut Instance, steps: std::ops::Range<usize>) -> Vec<Vec<u64>> {
        let watched = self.watched();
        let mut answers = Vec::new();
        for k in steps {
            self.step(instance, k);
            answers.push(bits(instance, &watched));
        }
        answers
    }
}

/// For every scenario the truth under changing inputs, and every filter with each of its parameter sets on what that truth
/// measures.
static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| items("scenario").flat_map(cases).collect());

fn cases(scenario: &str) -> Vec<Case> {
    let push = |k: usize| {
        let push = 1e-5 * (k / 7) as f64;
        vec![
            ("a_cmd_c_n[1]".to_owned(), Value::Real(push)),
            ("a_dist_t_n[3]".to_owned(), Value::Real(-push)),
        ]
    };
    let truth = Case {
        label: format!("{scenario} truth"),
        fmu: TRUTH.clone(),
        parameters: world(scenario),
        script: Arc::new((0..STEPS).map(push).collect()),
    };
    let sensors = names(&NAV, &[Causality::Input]);
    let mut instance = truth.started();
    let measured = (0..STEPS).map(|k| {
        truth.step(&mut instance, k);
        sensors
            .iter()
            .map(|name| (name.clone(), get(&mut instance, name)))
            .collect()
    });
    let measured: Arc<Script> = Arc::new(measured.collect());

    let mut cases = vec![truth];
    for filter in filters(scenario) {
        let bare = ("paper", Vec::new());
        let sets = TOLD.presets_of(filter).filter(|p| p.name != "paper").map(|p| {
            let sets = p.sets.iter().map(|s| (s.variable.clone(), s.value.clone()));
            (p.name.as_str(), sets.collect())
        });
        for (name, tunables) in std::iter::once(bare).chain(sets) {
            let chosen = texts(&[("scenario", scenario), ("run", "3"), ("filter", filter)]);
            cases.push(Case {
                label: format!("{scenario} {filter}@{name}"),
                fmu: NAV.clone(),
                parameters: [chosen, tunables].concat(),
                script: measured.clone(),
            });
        }
    }
    cases
}

/// Whatever a sensor says that says that it is not valid, the filter does not hear it.
#[test]
fn what_is_not_valid_may_be_no_number() {
    let snc: Vec<&Case> = CASES.iter().filter(|case| case.label.ends_with("snc@paper")).collect();
    assert_eq!(snc.len(), items("scenario").count());
    for case in snc {
        let invalid = |inputs: &[(String, Value)]| -> Vec<String> {
            let of = |(name, value): &(String, Value)| {
                let sensor = name.strip_suffix("valid").filter(|_| *value == Value::Boolean(false));
                sensor.map(str::to_owned)
            };
            inputs.iter().filter_map(of).collect()
        };
        let spoilt = |inputs: &Vec<(String, Value)>| {
            let sensors = invalid(inputs);
            let spoil = |(name, value): &(String, Value)| {
                let of_one = sensors.iter().any(|sensor| name.starts_with(sensor));
                let none = of_one && matches!(value, Value::Real(_));
                (name.clone(), if none { Value::Real(f64::NAN) } else { value.clone() })
            };
            inputs.iter().map(spoil).collect()
        };
        let spoilt = Case {
            script: Arc::new(case.script.iter().map(spoilt).collect()),
            ..case.clone()
        };
        let answers = |case: &Case| case.run(&mut case.started(), 0..STEPS);
        assert!(answers(case) == answers(&spoilt), "{}", case.label);
    }
}

#[test]
fn a_reset_makes_an_instance_new() {
    for case in CASES.iter() {
        let mut instance = case.started();
        let first = case.run(&mut instance, 0..STEPS);
        assert_ne!(first[0], first[STEPS - 1], "{}", case.label);
        instance.terminate().unwrap();
        // After a run, in the middle of one, in initialization mode, and after an error.
        for end in [0, 2 * STEPS / 3, STEPS] {
            instance.reset().unwrap();
            initialise(&mut instance, &case.parameters, &FROM_ZERO);
            assert_eq!(case.run(&mut instance, 0..end), first[..end], "{}", case.label);
        }
        instance.reset().unwrap();
        instance.enter_initialization().unwrap();
        instance.reset().unwrap();
        assert!(instance.do_step(0.0, 1.0).is_err());
        instance.reset().unwrap();
        initialise(&mut instance, &case.parameters, &FROM_ZERO);
        assert_eq!(case.run(&mut instance, 0..STEPS), first, "{}", case.label);
        // The start column is back, too: nothing that was set before the reset is left.
        let settable = names(&case.fmu, &[Causality::Parameter, Causality::Input]);
        instance.reset().unwrap();
        initialise(&mut instance, &[], &FROM_ZERO);
        let mut fresh = case.instance();
        initialise(&mut fresh, &[], &FROM_ZERO);
        assert_eq!(
            bits(&mut instance, &settable),
            bits(&mut fresh, &settable),
            "{}",
            case.label
        );
    }
}

#[test]
fn a_saved_state_goes_on_bit_for_bit() {
    for case in CASES.iter() {
        // After an odd number of steps the truth stands between two grid points, with its inputs latched.
        let middle = STEPS / 2 + 1;
        let mut instance = case.started();
        case.run(&mut instance, 0..middle);
        let watched = case.watched();
        let there = bits(&mut instance, &watched);
        let state = instance.get_state().unwrap();
        let bytes = instance.serialize_state(&state).unwrap();
        let expected = case.run(&mut instance, middle..STEPS);

        instance.set_state(&state).unwrap();
        assert_eq!(bits(&mut instance, &watched), there, "{}", case.label);
        assert_eq!(
            case.run(&mut instance, middle..STEPS),
            expected,
            "{}: set back",
            case.label
        );
        // The same point saved again is the same bytes, and looking did not change the state.
        instance.set_state(&state).unwrap();
        let again = instance.get_state().unwrap();
        assert!(instance.serialize_state(&again).unwrap() == bytes, "{}", case.label);

        let mut other = case.instance();
        let carried = other.deserialize_state(&bytes).unwrap();
        other.set_state(&carried).unwrap();
        assert_eq!(bits(&mut other, &watched), there, "{}", case.label);
        assert_eq!(
            case.run(&mut other, middle..STEPS),
            expected,
            "{}: in another instance",
            case.label
        );
    }
}

#[test]
fn a_damaged_state_is_refused() {
    for case in [&CASES[0], &CASES[1]] {
        let mut instance = case.started();
        let state = instance.get_state().unwrap();
        let good = instance.serialize_state(&state).unwrap();
        let mut changed = good.clone();
        changed[good.len() / 2] ^= 1;
        for (bytes, reason) in [
            (&good[..good.len() - 1], "should have"),
            (&changed[..], "damaged"),
            (&[0; 64][..], "no serialized state"),
            (&[][..], "no serialized state"),
        ] {
            let error = instance.deserialize_state(bytes).unwrap_err().to_string();
            assert!(
                error.contains("fmi2DeSerializeFMUstate") && error.contains(reason),
                "{error}"
            );
        }
        // A state of the other FMU.
        let other = if Arc::ptr_eq(&case.fmu, &TRUTH) {
            &CASES[1]
        } else {
            &CASES[0]
        };
        let mut stranger = other.started();
        let error = stranger.deserialize_state(&good).unwrap_err().to_string();
        assert!(error.contains(&case.fmu.description().guid), "{error}");
        case.run(&mut instance, 0..4);
    }
}

#[test]
fn many_instances_side_by_side_are_as_if_alone() {
    // Several runs of each case, on two copies of each library.
    let copies = [&*TRUTH, &*NAV].map(|fmu| Arc::new(Fmu::open(fmu.path()).unwrap()));
    let mut cases = Vec::new();
    for (case, run) in CASES.iter().flat_map(|case| (0..4).map(move |run| (case, run))) {
        let mut case = case.clone();
        case.parameters.push(("run".to_owned(), run.to_string()));
        if run % 2 == 1 {
            let original = case.fmu.clone();
            case.fmu = copies.iter().find(|c| c.path() == original.path()).unwrap().clone();
        }
        cases.push(case);
    }
    let alone: Vec<_> = cases
        .iter()
        .map(|case| case.run(&mut case.started(), 0..STEPS))
        .collect();

    // Interleaved in one thread.
    let mut instances: Vec<Instance> = cases.iter().map(Case::started).collect();
    let mut together: Vec<Vec<Vec<u64>>> = vec![Vec::new(); cases.len()];
    for k in 0..STEPS {
        for ((case, instance), answers) in cases.iter().zip(&mut instances).zip(&mut together) {
            answers.extend(case.run(instance, k..k + 1));
        }
    }
    drop(instances);
    // Each in a thread of its own, then handed to another halfway.
    let threads: Vec<_> = cases
        .iter()
        .map(|case| {
            let case = case.clone();
            std::thread::spawn(move || {
                let mut instance = case.started();
                let first = case.run(&mut instance, 0..STEPS / 2);
                let rest = std::thread::spawn(move || case.run(&mut instance, STEPS / 2..STEPS));
                [first, rest.join().unwrap()].concat()
            })
        })
        .collect();
    let threaded: Vec<_> = threads.into_iter().map(|thread| thread.join().unwrap()).collect();
    for (((case, alone), together), threaded) in cases.iter().zip(&alone).zip(&together).zip(&threaded) {
        assert!(alone == together, "{}: interleaved", case.label);
        assert!(alone == threaded, "{}: threads", case.label);
    }
    assert!(alone[0] != alone[1], "runs differ");
}

/// Couples truth and filter at the given steps; returns the measurement and the estimate of each sample, and epochs apart
/// from the start time.
fn coupled(scenario: &str, filter: &str, experiment: &Experiment, steps: &[f64]) -> Vec<(f64, Vec<u64>)> {
    let wires: Vec<String> = names(&NAV, &[Causality::Input]);
    let shown: Vec<String> = names(&NAV, &[Causality::Output, Causality::Local])
        .into_iter()
        // What holds at the end of a step depends on where that is.
        .filter(|name| name != "est.time" && !name.starts_with("pred."))
        .collect();
    let (mut truth, mut nav) = (
        TRUTH.instantiate("truth", false).unwrap(),
        NAV.instantiate("nav", false).unwrap(),
    );
    initialise(&mut truth, &world(scenario), experiment);
    initialise(
        &mut nav,
        &texts(&[("scenario", scenario), ("run", "3"), ("filter", filter)]),
        experiment,
    );
    let (mut t, mut used, mut samples) = (experiment.start_time, 0, Vec::new());
    for &h in steps {
        step(&mut truth, t, h);
        for name in &wires {
            let value = get(&mut truth, name);
            set(&mut nav, name, &value).unwrap();
        }
        step(&mut nav, t, h);
        t += h;
        let Value::Integer(count) = get(&mut nav, "est.count") else {
            unreachable!()
        };
        if count > used {
            used = count;
            let Value::Real(epoch) = get(&mut nav, "est.time") else {
                unreachable!()
            };
            let measured: Vec<String> = wires.iter().filter(|name| *name != "sample_time").cloned().collect();
            let row = [bits(&mut truth, &measured), bits(&mut nav, &shown)].concat();
            samples.push((epoch - experiment.start_time, row));
        }
    }
    samples
}

#[test]
fn samples_do_not_depend_on_steps_or_start_time() {
    let samples = 80;
    for (scenario, filter) in items("scenario").flat_map(|s| filters(s).map(move |f| (s, f))) {
        let regular = coupled(scenario, filter, &FROM_ZERO, &vec![1.0; samples]);
        assert_eq!(regular.len(), samples);
        assert!(regular.iter().zip(1..).all(|((epoch, _), k)| *epoch == f64::from(k)));
        // Past the stop time, in steps of all sizes, of which none holds two samples.
        let experiment = Experiment {
            stop_time: Some(30.0),
            ..FROM_ZERO
        };
        let sizes = [0.25, 1.0, 0.1, 1e-16, 0.7, 1.0, 1.0, 1e-9, 1.0 / 3.0];
        let mut irregular: Vec<f64> = Vec::new();
        while irregular.iter().sum::<f64>() < samples as f64 + 0.5 {
            irregular.push(sizes[irregular.len() % sizes.len()]);
        }
        assert!(
            coupled(scenario, filter, &experiment, &irregular)[..samples] == regular,
            "{scenario} {filter}: irregular steps"
        );
        for start_time in [1000.25, -64.5] {
            let experiment = Experiment {
                start_time,
                stop_time: Some(start_time + 80.0),
                tolerance: Some(1e-6),
            };
            let shifted = coupled(scenario, filter, &experiment, &vec![1.0; samples]);
            assert!(shifted == regular, "{scenario} {filter}: from {start_time} s");
        }
    }
}

/// When a mistake is made.
#[derive(Clone, Copy, PartialEq, Debug)]
enum When {
    Instantiated,
    Initialization,
    Stepping,
}
use When::{Initialization, Instantiated, Stepping};

/// A call, given the step it comes before.
type Call = dyn Fn(&mut Instance, usize) -> Result<(), ImportError>;

/// A call that must be refused, and what its message must say.
struct Mistake {
    when: &'static [When],
    call: Box<Call>,
    says: Vec<String>,
}

fn mistake(
    when: &'static [When],
    says: &[&str],
    call: impl Fn(&mut Instance, usize) -> Result<(), ImportError> + 'static,
) -> Mistake {
    let says = says.iter().map(|text| (*text).to_owned()).collect();
    Mistake {
        when,
        call: Box::new(call),
        says,
    }
}

/// A value that must be refused.
fn bad_value(when: &'static [When], name: &'static str, value: Value, says: &[&str]) -> Mistake {
    let quoted = format!("'{name}'");
    let says = [&[quoted.as_str()], says].concat();
    mistake(when, &says, move |instance, _| set(instance, name, &value))
}

/// What no FMU of ours accepts; `output` and `input` are names of its own.
fn common_mistakes(output: &'static str, input: &'static str, parameter: &'static str) -> Vec<Mistake> {
    let mut all = Vec::new();
    for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let says = ["fmi2DoStep", "communication step size", &h.to_string()];
        all.push(mistake(&[Stepping], &says, move |i, k| i.do_step(time(k), h).map(drop)));
    }
    for wrong in [f64::NAN, 1e6, -H] {
        let says = ["fmi2DoStep", "communication point"];
        all.push(mistake(&[Stepping], &says, move |i, k| {
            i.do_step(time(k) + wrong, H).map(drop)
        }));
    }
    all.push(mistake(
        &[Stepping],
        &["fmi2DoStep", "too long", "at most 10000000 s"],
        |i, k| i.do_step(time(k), 1e9).map(drop),
    ));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let says = ["fmi2SetReal", &bad.to_string(), "not finite"];
        all.push(bad_value(
            &[Instantiated, Initialization, Stepping],
            input,
            Value::Real(bad),
            &says,
        ));
        all.push(bad_value(
            &[Instantiated, Initialization],
            parameter,
            Value::Real(bad),
            &says,
        ));
        all.push(mistake(
            &[Instantiated],
            &["fmi2SetupExperiment", "start time"],
            move |i, _| {
                i.setup_experiment(&Experiment {
                    start_time: bad,
                    ..FROM_ZERO
                })
            },
        ));
    }
    let (any, running): (&[When], &[When]) = (&[Instantiated, Initialization, Stepping], &[Initialization, Stepping]);
    all.extend([
        bad_value(any, output, Value::Real(1.0), &["fmi2SetReal", "causality output"]),
        bad_value(
            &[Stepping],
            parameter,
            Value::Real(1.0),
            &["fmi2SetReal", "causality parameter", "step complete"],
        ),
        bad_value(
            &[Instantiated],
            "scenario",
            Value::Integer(99),
            &["fmi2SetInteger", "99", "leo_venting"],
        ),
        bad_value(
            &[Instantiated],
            "study_seed",
            Value::Integer(-1),
            &["fmi2SetInteger", "-1", "at least 0"],
        ),
        mistake(any, &["fmi2SetReal", "value reference 4000"], |i, _| {
            i.set_real(&[4000], &[1.0])
        }),
        mistake(running, &["fmi2GetReal", "value reference 4000"], |i, _| {
            i.get_real(&[4000], &mut [0.0])
        }),
        mistake(running, &["fmi2GetBoolean", "'scenario'", "Enumeration"], |i, _| {
            i.get_boolean(&[0], &mut [false])
        }),
        mistake(&[Instantiated], &["fmi2DoStep", "'instantiated'"], |i, _| {
            i.do_step(0.0, H).map(drop)
        }),
        mistake(&[Instantiated], &["fmi2GetReal", "'instantiated'"], |i, _| {
            i.get_real(&[4000], &mut [0.0])
        }),
        mistake(running, &["fmi2EnterInitializationMode"], |i, _| {
            i.enter_initialization()
        }),
        mistake(running, &["fmi2SetupExperiment"], |i, _| i.setup_experiment(&FROM_ZERO)),
        mistake(&[Instantiated], &["stop time 1 s is before start time 2 s"], |i, _| {
            i.setup_experiment(&Experiment {
                start_time: 2.0,
                stop_time: Some(1.0),
                tolerance: None,
            })
        }),
    ]);
    all
}

fn truth_mistakes() -> Vec<Mistake> {
    let before: &[When] = &[Instantiated, Initialization];
    let mut all = common_mistakes("truth.r_tc_n[1]", "a_cmd_c_n[2]", "lidar.sigma_range");
    for name in [
        "lidar.sigma_range",
        "lidar.sigma_angle",
        "accelerometer.sigma",
        "accelerometer.bias_sigma",
        "vent.scale",
    ] {
        all.push(bad_value(before, name, Value::Real(-1e-9), &["-1e-9", "at least 0"]));
    }
    for name in ["sample_period", "accelerometer.bias_time_constant"] {
        all.push(bad_value(before, name, Value::Real(0.0), &[]));
    }
    all.push(bad_value(
        before,
        "lidar.dropout_probability",
        Value::Real(1.5),
        &["1.5"],
    ));
    all
}

fn nav_mistakes() -> Vec<Mistake> {
    let before: &[When] = &[Instantiated, Initialization];
    let mut all = common_mistakes("est.r_tc_n[1]", "sample_time", "r.sigma_range");
    for name in [
        "r.sigma_range",
        "r.sigma_angle",
        "r.sigma_accelerometer",
        "p0.sigma_position",
        "gravity.mu",
    ] {
        for value in [0.0, -2.0] {
            all.push(bad_value(before, name, Value::Real(value), &["greater than 0"]));
        }
    }
    for name in ["fixed_q.s", "milton.r_w", "milton.psi0"] {
        all.push(bad_value(before, name, Value::Real(-0.5), &["-0.5"]));
    }
    all.push(bad_value(before, "milton.m_b", Value::Integer(0), &["0"]));
    all.push(bad_value(
        before,
        "filter",
        Value::Integer(0),
        &["fmi2SetInteger", "fixed_q", "milton"],
    ));
    all
}

#[test]
fn mistakes_are_refused_with_a_reason_and_change_nothing() {
    for (case, mistakes) in [(&CASES[0], truth_mistakes()), (&CASES[1], nav_mistakes())] {
        let expected = case.run(&mut case.started(), 0..8);
        let mut instance = case.instance();
        let all_at = |instance: &mut Instance, when: When, k: usize| {
            for mistake in mistakes.iter().filter(|mistake| mistake.when.contains(&when)) {
                let error = (mistake.call)(instance, k).expect_err(&format!("{when:?}: {:?}", mistake.says));
                let ImportError::Call { status, messages, .. } = &error else {
                    panic!("{when:?}: {error}");
                };
                // What the model does not take is discarded, and the importer adds how far the step went.
                let discarded = error.to_string().contains("does not take this step");
                let expected = if discarded {
                    Fmi2Status::Discard
                } else {
                    Fmi2Status::Error
                };
                assert_eq!(*status, Status::Known(expected), "{error}");
                assert_eq!(messages.len(), 1 + usize::from(discarded), "{error}");
                for part in &mistake.says {
                    assert!(
                        messages[0].contains(part),
                        "{when:?}: '{part}' is missing in: {}",
                        messages[0]
                    );
                }
            }
        };
        all_at(&mut instance, Instantiated, 0);
        for (name, text) in &case.parameters {
            let value = case
                .fmu
                .description()
                .variable(name)
                .unwrap()
                .parse_value(text)
                .unwrap();
            set(&mut instance, name, &value).unwrap();
        }
        instance.setup_experiment(&FROM_ZERO).unwrap();
        instance.enter_initialization().unwrap();
        all_at(&mut instance, Initialization, 0);
        instance.exit_initialization().unwrap();
        let mut answers = Vec::new();
        for k in 0..8 {
            all_at(&mut instance, Stepping, k);
            answers.extend(case.run(&mut instance, k..k + 1));
        }
        assert_eq!(answers, expected, "{}", case.label);
        instance.terminate().unwrap();
        let error = instance.do_step(time(8), H).unwrap_err().to_string();
        assert!(error.contains("'terminated'"), "{error}");
        assert!(error.starts_with(&case.label), "the instance is named: {error}");
        assert_eq!(
            bits(&mut instance, &case.watched()),
            expected[7],
            "outputs stay readable"
        );
    }
}

#[test]
fn a_model_that_cannot_go_on_says_so_and_a_reset_helps() {
    let case = &CASES[1];
    let expected = case.run(&mut case.started(), 0..8);
    let mut instance = case.started();
    // The first sample arrives, but nobody has set nav_init.
    for (name, value) in case.script[4].iter().filter(|(name, _)| !name.starts_with("nav_init")) {
        set(&mut instance, name, value).unwrap();
    }
    let error = instance.do_step(0.0, H).unwrap_err().to_string();
    assert!(error.contains("nav_init.x") && error.contains("t = 2 s"), "{error}");
    // The step was refused and has changed nothing, so it can be taken once that is mended.
    assert_eq!(get(&mut instance, "est.count"), Value::Integer(0));
    assert_eq!(case.run(&mut instance, 0..8), expected);

    let case = &CASES[0];
    let expected = case.run(&mut case.started(), 0..8);
    let mut instance = case.started();
    case.run(&mut instance, 0..4);
    // An attitude that is no rotation is refused and changes nothing either.
    let command_diagonal = |instance: &mut Instance, values: [f64; 3]| {
        for (axis, value) in (1..).zip(values) {
            set(instance, &format!("dcm_cmd_bc_n[{axis},{axis}]"), &Value::Real(value)).unwrap();
        }
    };
    command_diagonal(&mut instance, [1.001, 1.0, 1.0]);
    let error = instance.do_step(time(4), H).unwrap_err().to_string();
    assert!(error.contains("dcm_cmd_bc_n"), "{error}");
    command_diagonal(&mut instance, [0.0; 3]);
    assert_eq!(case.run(&mut instance, 4..8), expected[4..]);
    let mut instance = case.started();
    case.run(&mut instance, 0..4);
    let state = instance.get_state().unwrap();
    let fail = |instance: &mut Instance| {
        set(instance, "a_dist_t_n[1]", &Value::Real(1e300)).unwrap();
        let error = instance.do_step(time(4), 1e3).unwrap_err().to_string();
        assert!(error.contains("no longer finite"), "{error}");
        // Readable for a diagnosis, but not to be stepped.
        assert!(matches!(get(instance, "sample_count"), Value::Integer(_)));
        let error = instance.do_step(time(4), H).unwrap_err().to_string();
        assert!(error.contains("'failed'"), "{error}");
    };
    fail(&mut instance);
    // An earlier state helps as well as a reset.
    instance.set_state(&state).unwrap();
    assert_eq!(case.run(&mut instance, 4..8), expected[4..]);
    instance.set_state(&state).unwrap();
    fail(&mut instance);
    instance.reset().unwrap();
    initialise(&mut instance, &case.parameters, &FROM_ZERO);
    assert_eq!(case.run(&mut instance, 0..8), expected);
}

#[test]
fn a_description_of_another_version_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for fmu in [&*TRUTH, &*NAV] {
        let own = &fmu.description().guid;
        let strange = "{00000000-0000-0000-0000-000000000000}";
        let path = folder.path().join("strange.fmu");
        repacked(fmu.path(), &path, |name, bytes| {
            if name != "modelDescription.xml" {
                return Some(bytes);
            }
            Some(String::from_utf8(bytes).unwrap().replace(own, strange).into_bytes())
        });
        let error = Fmu::open(&path).unwrap().instantiate("strange", false).unwrap_err();
        assert!(matches!(error, ImportError::Instantiate { .. }), "{error}");
        let error = error.to_string();
        assert!(
            error.contains("GUID") && error.contains(own) && error.contains(strange),
            "{error}"
        );
    }
}
