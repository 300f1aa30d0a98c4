//! One run: one world, every filter of the study beside it.

use std::ops::ControlFlow;
use std::time::Duration;

use cosim::{Causality, RunOptions, Scheme, SlaveId, StepContext, System, Value};

use crate::error::{StudyError, chain};
use crate::history::History;
use crate::models::OF_TRUTH;
use crate::participant::Participant;
use crate::readers::{CalculatedReader, EstimateReader, MeasurementReader, TruthReader, units_unsaid};
use crate::samples::{Estimate, SAME_TIME, TruthSample};
use crate::spec::Spec;
use crate::stop::stop_asked;
use interface::Status;
use interface::ports::{self, Role};
use serde::{Deserialize, Serialize};

/// Why a filter has no result in a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// When, s; `None` before the first step.
    pub time: Option<f64>,
    /// What happened.
    pub message: String,
}

/// How a run ended for one filter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ending {
    /// Set when there is no result.
    pub failure: Option<Failure>,
    /// The filter's status said so.
    pub says_diverged: bool,
    /// Samples of the world that it has not answered.
    pub missing: u64,
    /// Parameters that it calculated, by contract name; of the first run of a study alone, and of a filter that came so far.
    pub calculated: Vec<(String, f64)>,
}

/// CPU time that one slave took over a run, as [`cosim::SlaveTiming`] has it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SlaveTime {
    /// Inside `fmi2DoStep`.
    pub step: Duration,
    /// Inside the get and set functions.
    pub exchange: Duration,
}

/// A run that is over.
#[derive(Debug)]
pub struct RunReport {
    /// How it ended, by filter.
    pub endings: Vec<Ending>,
    /// Communication steps taken.
    pub steps: u64,
    /// CPU time that the truth took.
    pub truth_time: SlaveTime,
    /// CPU time that each filter took.
    pub filter_times: Vec<SlaveTime>,
    /// What the FMUs have logged, each message once with its count.
    pub messages: Vec<String>,
}

/// What slaves have logged since the last time, by name.
fn messages(system: &mut System, slaves: impl IntoIterator<Item = SlaveId>) -> Vec<String> {
    let mut all = Vec::new();
    for slave in slaves {
        let own = system.messages(slave);
        all.extend(own.into_iter().map(|text| format!("{}: {text}", system.name(slave))));
    }
    all
}

/// Every filter of a run, and how far it has come.
struct Seat {
    id: SlaveId,
    reader: EstimateReader,
    calculated: Option<CalculatedReader>,
    /// Epoch of the last of them.
    last: Option<usize>,
    /// Samples that it has answered.
    answered: u64,
}

struct Coupled {
    system: System,
    truth: SlaveId,
    truth_reader: TruthReader,
    seats: Vec<Result<Seat, StudyError>>,
    drivers: Vec<SlaveId>,
}

/// Instantiates and wires the truth and every filter; a filter that cannot be is an error of its own.
fn couple(spec: &Spec, run: u32) -> Result<Coupled, StudyError> {
    let mut system = System::new();
    let truth = seat(&mut system, &spec.truth, spec.seed, run)?;
    let truth_reader = TruthReader::new(&system, truth, &spec.truth, spec.world.frame)?;
    let placed: Vec<_> = spec
        .filters
        .iter()
        .map(|filter| seat(&mut system, filter, spec.seed, run))
        .collect();
    // The world feeds the filters, and nothing that a filter says reaches the world or another filter.
    let mut seated = Vec::new();
    for (placed, filter) in placed.into_iter().zip(&spec.filters) {
        let fed = placed.and_then(|id| {
            let fed = filter.bound || spec.allow_truth;
            if !fed && !filter.beside_bounds {
                keep_from_the_truth(&system, id, filter)?;
            }
            system.connect_by_name_where(truth, id, |name| fed || !name.starts_with(OF_TRUTH))?;
            Ok(id)
        });
        seated.push(fed);
    }
    let mut drivers = Vec::new();
    for driver in &spec.drivers {
        let id = seat(&mut system, driver, spec.seed, run)?;
        drive(&mut system, id, truth, driver)?;
        for filter in seated.iter().flatten() {
            announce(&mut system, id, *filter)?;
            if spec.closed_loop {
                system.connect_by_name_from(*filter, id)?;
            }
        }
        drivers.push(id);
    }
    let unconnected = system.unconnected_inputs();
    let seats = seated.into_iter().zip(&spec.filters).map(|(seated, filter)| {
        let id = seated?;
        if let Some(open) = unconnected
            .iter()
            .filter(|u| u.slave == id)
            .find(|u| u.input.starts_with("nav_init.") || (filter.bound && u.input.starts_with(OF_TRUTH)))
        {
            return Err(StudyError::MissingInput {
                label: filter.label.clone(),
                input: open.input.clone(),
            });
        }
        let reader = EstimateReader::new(&system, id, filter, spec.world.frame)?;
        let calculated = (run == 0)
            .then(|| CalculatedReader::new(&system, id, filter))
            .transpose()?;
        Ok(Seat {
            id,
            reader,
            calculated,
            last: None,
            answered: 0,
        })
    });
    let seats = seats.collect();
    Ok(Coupled {
        system,
        truth,
        truth_reader,
        seats,
        drivers,
    })
}

/// Couples a driver with the world: it reads what it asks for, and feeds every input of the world that it has an output for.
fn drive(system: &mut System, id: SlaveId, truth: SlaveId, driver: &Participant) -> Result<(), StudyError> {
    system.connect_by_name_from(truth, id)?;
    let ports = system.ports(truth).iter().filter(|p| p.causality == Causality::Input);
    let inputs: Vec<String> = ports.map(|p| p.name.clone()).collect();
    let offers = |name: &&String| {
        let port = system.port(id, name);
        port.is_some_and(|port| port.causality == Causality::Output)
    };
    let driven: Vec<&String> = inputs.iter().filter(offers).collect();
    if driven.is_empty() {
        let mut names: Vec<&str> = inputs.iter().filter_map(|name| name.split('[').next()).collect();
        names.dedup();
        return Err(StudyError::DrivesNothing {
            label: driver.label.clone(),
            inputs: names.join(", "),
        });
    }
    for name in driven {
        system.connect(id, name, truth, name)?;
    }
    Ok(())
}

/// Whether a variable is part of what is commanded of the chaser.
fn is_command(name: &str) -> bool {
    ports::of(Role::Command).any(|port| name.split('[').next() == Some(port.name))
}

/// Tells a filter what a driver commands the chaser to do, as far as it asks.
fn announce(system: &mut System, driver: SlaveId, filter: SlaveId) -> Result<(), StudyError> {
    let open = system.unconnected_inputs().into_iter();
    let asked: Vec<String> = open
        .filter(|open| open.slave == filter && is_command(&open.input))
        .map(|open| open.input)
        .collect();
    for name in asked {
        let offered = system.port(driver, &name);
        if offered.is_some_and(|port| port.causality == Causality::Output) {
            system.connect(driver, &name, filter, &name)?;
        }
    }
    Ok(())
}

/// Refuses a filter that asks for what no filter may see.
fn keep_from_the_truth(system: &System, id: SlaveId, filter: &Participant) -> Result<(), StudyError> {
    let truth = system
        .unconnected_inputs()
        .into_iter()
        .find(|open| open.slave == id && open.input.starts_with(OF_TRUTH));
    truth.map_or(Ok(()), |open| {
        Err(StudyError::AsksForTruth {
            label: filter.label.clone(),
            input: open.input,
        })
    })
}

/// Adds a slave with its start values; a foreign one need not know of seeds and runs.
pub fn seat(system: &mut System, participant: &Participant, seed: i32, run: u32) -> Result<SlaveId, StudyError> {
    let id = system.add(participant.source.create(&participant.label)?)?;
    for (own, contract) in &participant.aliases {
        system.alias(id, own, contract)?;
    }
    for (name, value) in &participant.starts {
        system.set_start(id, name, value.clone())?;
    }
    for varied in &participant.varied {
        system.set_start(id, &varied.name, Value::Real(varied.value(seed, run)))?;
    }
    let run = i32::try_from(run).unwrap_or(i32::MAX);
    for (name, value) in [("study_seed", seed), ("run", run)] {
        if system.port(id, name).is_some() {
            system.set_start(id, name, Value::Integer(value))?;
        }
    }
    Ok(id)
}

/// Couples everything and goes through initialization once, so that a bad setting shows before the first run.
///
/// * returns: what a user should know: inputs of the filters that nothing feeds, and what the FMUs have logged.
///
/// # Errors
/// Whatever a slave or the wiring refuses.
pub fn rehearse(spec: &Spec) -> Result<Vec<String>, StudyError> {
    spec.check_grid()?;
    if spec.takes_worlds_apart() {
        let mut told = Vec::new();
        for filter in 0..spec.filters.len() {
            for text in rehearse(&spec.subset(&[filter]))? {
                if !told.contains(&text) {
                    told.push(text);
                }
            }
        }
        return Ok(told);
    }
    let mut coupled = couple(spec, 0)?;
    let mut seats = coupled.drivers;
    let mut beside_bounds = Vec::new();
    for (seat, filter) in coupled.seats.into_iter().zip(&spec.filters) {
        let id = seat?.id;
        seats.push(id);
        beside_bounds.extend(filter.beside_bounds.then_some(id));
    }
    let report = coupled
        .system
        .run(&spec.options(false), |_: &mut StepContext<'_>| ControlFlow::Break(()))?;
    if let Some(refused) = report.isolated.into_iter().next() {
        return Err(StudyError::Refused {
            label: refused.name,
            source: Box::new(refused.error),
        });
    }
    let logged = messages(
        &mut coupled.system,
        std::iter::once(coupled.truth).chain(seats.iter().copied()),
    );
    let open = coupled.system.unconnected_inputs();
    let told = seats.iter().filter_map(|seat| {
        let open = open.iter().filter(|u| u.slave == *seat);
        let names: Vec<&str> = open
            .map(|u| u.input.as_str())
            .filter(|name| !(beside_bounds.contains(seat) && name.starts_with(OF_TRUTH)))
            // Where nobody commands there is nothing to be told of.
            .filter(|name| !(spec.drivers.is_empty() && is_command(name)))
            .collect();
        let label = coupled.system.name(*seat);
        (!names.is_empty()).then(|| {
            format!(
                "nothing feeds {label}: {}; each keeps its start value",
                names.join(", ")
            )
        })
    });
    let unsaid = seats.iter().filter_map(|filter| {
        let names = units_unsaid(&coupled.system, coupled.truth, *filter, spec.world.frame);
        let label = coupled.system.name(*filter);
        (!names.is_empty()).then(|| format!("{label} says no unit of {}: taken as SI", names.join(", ")))
    });
    Ok(told.chain(unsaid).chain(logged).collect())
}

/// CPU time of one `fmi2DoStep` of a filter that has no new sample: the cost of crossing the interface.
///
/// # Errors
/// As for a run; a filter that fails alone is an error here.
pub fn call_time(spec: &Spec, filter: &Participant) -> Result<Duration, StudyError> {
    const CALLS: u32 = 2000;
    let mut system = System::new();
    seat(&mut system, filter, spec.seed, 0)?;
    let step = 1e-3 * spec.sample_period;
    let options = RunOptions {
        stop: step * f64::from(CALLS),
        step,
        timing: true,
        ..RunOptions::default()
    };
    let report = system.run(&options, |_: &mut StepContext<'_>| ControlFlow::<()>::Continue(()))?;
    Ok(report.timings.first().map_or(Duration::ZERO, |t| t.step / CALLS))
}

/// Runs one world with every filter beside it, or one for each filter where a driver reads it.
///
/// * `observe`: called for each estimate with the filter's index, the truth at the estimate's own epoch and the
///   estimate; a text it returns fails that filter.
/// * returns: how it ended for each filter. Never an error: what goes wrong is a failure of the filters it concerns.
pub fn run_once(
    spec: &Spec,
    run: u32,
    observe: impl FnMut(usize, &TruthSample, &Estimate) -> Result<(), String>,
) -> RunReport {
    run_recorded(spec, run, &[], |_, _, _| (), observe)
}

/// As [`run_once`], with what the sensors say.
///
/// * `names`: Real and Boolean variables of the truth.
/// * `measured`: called once for each sample, before any estimate of it, with the first filter of its world, the sample's
///   ordinal, and their values in the order of the names, a truth value as 0 or 1, NaN for what the truth does not have.
pub fn run_recorded(
    spec: &Spec,
    run: u32,
    names: &[String],
    mut measured: impl FnMut(usize, u32, &[f64]),
    mut observe: impl FnMut(usize, &TruthSample, &Estimate) -> Result<(), String>,
) -> RunReport {
    if !spec.takes_worlds_apart() {
        return run_world(spec, run, names, |count, values| measured(0, count, values), observe);
    }
    let mut whole = RunReport {
        endings: Vec::new(),
        steps: 0,
        truth_time: SlaveTime::default(),
        filter_times: Vec::new(),
        messages: Vec::new(),
    };
    for filter in 0..spec.filters.len() {
        let of_world = |count, values: &[f64]| measured(filter, count, values);
        let own = run_world(&spec.subset(&[filter]), run, names, of_world, |_, truth, estimate| {
            observe(filter, truth, estimate)
        });
        whole.endings.extend(own.endings);
        whole.steps = whole.steps.max(own.steps);
        whole.truth_time.step += own.truth_time.step;
        whole.truth_time.exchange += own.truth_time.exchange;
        whole.filter_times.extend(own.filter_times);
        for text in own.messages {
            if !whole.messages.contains(&text) {
                whole.messages.push(text);
            }
        }
    }
    whole
}

/// Runs one world with every filter of the study in it.
fn run_world(
    spec: &Spec,
    run: u32,
    names: &[String],
    mut measured: impl FnMut(u32, &[f64]),
    mut observe: impl FnMut(usize, &TruthSample, &Estimate) -> Result<(), String>,
) -> RunReport {
    let mut report = RunReport {
        endings: vec![Ending::default(); spec.filters.len()],
        steps: 0,
        truth_time: SlaveTime::default(),
        filter_times: vec![SlaveTime::default(); spec.filters.len()],
        messages: Vec::new(),
    };
    let coupled = couple(spec, run).and_then(|coupled| {
        let recorder = (!names.is_empty()).then(|| MeasurementReader::new(&coupled.system, coupled.truth, names));
        Ok((coupled, recorder.transpose()?))
    });
    let (
        Coupled {
            mut system,
            truth,
            mut truth_reader,
            mut seats,
            drivers,
        },
        mut recorder,
    ) = match coupled {
        Ok(coupled) => coupled,
        Err(error) => {
            fail_all(&mut report.endings, None, &chain(&error));
            return report;
        }
    };
    for (seat, ending) in seats.iter().zip(&mut report.endings) {
        if let Err(error) = seat {
            ending.failure = Some(Failure {
                time: None,
                message: chain(error),
            });
        }
    }

    let mut history = History::new(spec);
    let endings = &mut report.endings;
    let outcome = system.run(&spec.options(true), |context: &mut StepContext<'_>| {
        if stop_asked() {
            return ControlFlow::Break("stopped as asked".to_owned());
        }
        let handed_late = history.newest;
        let Some(count) = truth_reader.newest(context) else {
            return ControlFlow::Continue(());
        };
        if count > history.newest && context.time() <= spec.world.duration_s + SAME_TIME {
            let number = u32::try_from(count).unwrap_or_default();
            let Some(sample) = truth_reader.sample(context, number) else {
                return ControlFlow::Continue(());
            };
            if let Err(message) = history.push(context.time(), sample) {
                return ControlFlow::Break(message);
            }
            if let Some(values) = recorder.as_mut().and_then(|recorder| recorder.values(context)) {
                measured(number, &values);
            }
        }
        let handed = if spec.scheme == Scheme::Jacobi {
            handed_late
        } else {
            history.newest
        };
        for (index, (seat, ending)) in seats.iter_mut().zip(endings.iter_mut()).enumerate() {
            let Ok(seat) = seat else { continue };
            if ending.failure.is_some() || !context.is_active(seat.id) {
                continue;
            }
            if let Some(reader) = seat.calculated.take() {
                ending.calculated = reader.values(context);
            }
            let answered = answer(seat, context, &history, handed, ending, |t, e| observe(index, t, e));
            if let Err(message) = answered {
                ending.failure = Some(Failure {
                    time: Some(context.time()),
                    message,
                });
            }
        }
        ControlFlow::Continue(())
    });

    let seated = seats.iter().flatten().map(|seat| seat.id);
    report.messages = messages(&mut system, std::iter::once(truth).chain(seated).chain(drivers));
    match outcome {
        Err(error) => fail_all(&mut report.endings, None, &chain(&error)),
        Ok(outcome) => {
            report.steps = outcome.steps;
            let broke = outcome.broke.is_some();
            if let Some(message) = outcome.broke {
                fail_all(&mut report.endings, Some(history.time), &message);
            }
            for (seat, ending) in seats.iter().zip(&mut report.endings) {
                let Ok(seat) = seat else { continue };
                ending.missing = history.taken().saturating_sub(seat.answered);
                if let Some(isolated) = outcome.isolated.iter().find(|i| i.slave == seat.id) {
                    let message = chain(&isolated.error);
                    ending.failure.get_or_insert(Failure {
                        time: Some(isolated.time),
                        message,
                    });
                } else if seat.last.is_none() && ending.failure.is_none() && history.newest > 0 {
                    let message = "ended without an estimate: est.count never rose above 0".to_owned();
                    ending.failure = Some(Failure {
                        time: Some(history.time),
                        message,
                    });
                }
            }
            if let Some(message) = history.stalled(spec.world.duration_s).filter(|_| !broke) {
                fail_all(&mut report.endings, Some(history.time), &message);
            }
            let time_of = |slave: SlaveId| {
                let timing = outcome.timings.get(slave.index());
                timing.map_or_else(SlaveTime::default, |t| SlaveTime {
                    step: t.step,
                    exchange: t.set + t.get,
                })
            };
            report.truth_time = time_of(truth);
            for (seat, time) in seats.iter().zip(&mut report.filter_times) {
                if let Ok(seat) = seat {
                    *time = time_of(seat.id);
                }
            }
        }
    }
    report
}

/// Takes the estimate of one filter, if it is new.
fn answer(
    seat: &mut Seat,
    context: &mut StepContext<'_>,
    history: &History,
    handed: i32,
    ending: &mut Ending,
    observe: impl FnOnce(&TruthSample, &Estimate) -> Result<(), String>,
) -> Result<(), String> {
    // A filter that cannot be read is isolated by the master, which keeps the reason.
    let Some(tag) = seat.reader.tag(context) else {
        return Ok(());
    };
    ending.says_diverged |= tag.status == Some(Status::Diverged);
    let Some(truth) = history.tagged(&tag, handed)? else {
        return Ok(());
    };
    if seat.last.is_some_and(|last| truth.epoch <= last) {
        return Ok(());
    }
    let Some(estimate) = seat.reader.estimate(context, &tag) else {
        return Ok(());
    };
    seat.last = Some(truth.epoch);
    seat.answered += 1;
    if let Some(what) = estimate.first_not_finite(history.signals()) {
        return Err(format!(
            "{what} in the estimate of sample {} ({} s)",
            truth.count, truth.time
        ));
    }
    observe(truth, &estimate)
}

fn fail_all(endings: &mut [Ending], time: Option<f64>, message: &str) {
    for ending in endings {
        ending.failure.get_or_insert(Failure {
            time,
            message: message.to_owned(),
        });
    }
}
