//! `replay`: one run, sample by sample.

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::Vector3;

use interface::ports::{Kind, Port, Role, Shape};
use study::{
    Estimate, Plan, Quantity, Record, Spec, Status, StudyError, TruthSample, World, rehearse, run_recorded, score,
};

use super::list::known;
use super::out::Out;
use super::preload::start_again_with;
use super::recorded::Recorded;
use super::shared::{Verdict, changed, models, note, scratch};
use crate::HarnessError;
use crate::cli::ReplayArgs;
use crate::format::{cell, finished};
use crate::output::{prepare_file, write_whole};
use crate::parquet::from_csv;

pub(super) fn replay(args: &ReplayArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let as_parquet = args.out.extension().is_some_and(|extension| extension == "parquet");
    if as_parquet && !cfg!(feature = "parquet") {
        return Err(HarnessError::NoParquet);
    }
    if args.dir.is_none() {
        check_without_a_study(args)?;
    }
    start_again_with(&args.preload)?;
    prepare_file(&args.out)?;
    let folder = scratch()?;
    let spec = match &args.dir {
        Some(dir) => of_a_study(args, dir, folder.path())?,
        None => {
            let named = args.scenario.clone().unwrap_or_else(|| "leo_venting".to_owned());
            let plan = Plan {
                scenarios: if args.mission.is_none() {
                    vec![named]
                } else {
                    Vec::new()
                },
                missions: args.mission.clone().into_iter().collect(),
                ..changed(Plan::default(), &args.study)?
            };
            let world = plan
                .worlds(folder.path())?
                .into_iter()
                .next()
                .ok_or(StudyError::NoWorld)?;
            models(&plan, &args.study.build)?.spec(&plan, &world)?
        }
    };
    let world = spec.world.clone();
    rehearse(&spec)?;
    let measurements = Measurements::of(&world);
    let mut measured: Vec<BTreeMap<u32, Vec<f64>>> = vec![BTreeMap::new(); spec.filters.len()];
    let mut lines: Vec<Vec<(u32, Vec<String>)>> = spec.filters.iter().map(|_| Vec::new()).collect();
    let mut diverged: Vec<Option<f64>> = vec![None; spec.filters.len()];
    let seen = |first: usize, sample, values: &[f64]| {
        measured[first].insert(sample, values.to_vec());
    };
    let report = run_recorded(&spec, args.run, &measurements.names, seen, |filter, truth, estimate| {
        let record = score(&world, truth, estimate)
            .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
        let said = estimate.status == Some(Status::Diverged);
        if said || (record.lost && truth.time >= world.scored_from_s) {
            diverged[filter].get_or_insert(truth.time);
        }
        let cells = line(&world, &spec.filters[filter].label, truth, estimate, &record);
        lines[filter].push((truth.count, cells));
        Ok(())
    });

    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header(&world).into_iter().chain(measurements.columns()))?;
    for (filter, lines) in lines.iter().enumerate() {
        // Filters that share a world share its measurements, which stand with the first of them.
        let own = measured[filter..=filter]
            .iter()
            .chain(measured.first())
            .find(|world| !world.is_empty());
        for (sample, line) in lines {
            let values = own.and_then(|world| world.get(sample));
            writer.write_record(line.iter().cloned().chain(measurements.cells(values)))?;
        }
    }
    let table = finished(writer)?;
    write_whole(&args.out, &if as_parquet { from_csv(&table)? } else { table })?;
    for text in &report.messages {
        note(text);
    }
    for (filter, ending) in spec.filters.iter().zip(&report.endings) {
        if let Some(failure) = &ending.failure {
            let when = failure.time.map(|t| format!(" at {t} s")).unwrap_or_default();
            note(&format!("failed: {}{when}: {}", filter.label, failure.message));
        }
    }
    for (filter, own) in spec.filters.iter().zip(&diverged) {
        let said = match own {
            Some(time) => format!("{} diverged at {time} s", filter.label),
            None => format!("{} did not diverge", filter.label),
        };
        out.say(&said)?;
    }
    let told = spec
        .filters
        .iter()
        .zip(&diverged)
        .map(|(filter, time)| (filter.label.clone(), *time));
    out.tell("diverged_at_s", told.collect::<BTreeMap<_, _>>())?;
    out.tell("file", &args.out)?;
    out.say(&format!(
        "{} ({} samples)",
        args.out.display(),
        lines.iter().map(Vec::len).sum::<usize>()
    ))?;
    Ok(Verdict::Done)
}

/// Refuses, where no study is named, what only says something of one.
///
/// Not by clap's `requires`, which says nothing of a folder that is missing where another option excludes it.
fn check_without_a_study(args: &ReplayArgs) -> Result<(), HarnessError> {
    let given = [
        ("--filter", !args.labels.is_empty(), "a run of its own takes --filters"),
        (
            "--case",
            args.case.is_some(),
            "a run of its own has no cases, it takes --set",
        ),
        (
            "--other-files",
            args.other_files,
            "a run of its own takes files as they are",
        ),
    ];
    match given.into_iter().find(|(_, given, _)| *given) {
        Some((option, _, instead)) => Err(HarnessError::NeedsAStudy { option, instead }),
        None => Ok(()),
    }
}

/// What a run of a finished study is made of.
///
/// * `folder`: where the files of missions go that the study changes.
fn of_a_study(args: &ReplayArgs, dir: &Path, folder: &Path) -> Result<Spec, HarnessError> {
    let recorded = Recorded::read(dir)?;
    let plan = recorded.plan(dir)?;
    recorded.check(dir, args.other_files)?;
    let cases = plan.cases()?;
    let names = cases.iter().filter_map(|case| case.case.as_deref());
    let case = match args.case.as_deref() {
        Some(name) => Some(known("case", name, names)?),
        None => None,
    };
    let plan = cases
        .iter()
        .find(|plan| case.is_none() || plan.case.as_deref() == case)
        .ok_or(StudyError::NoWorld)?;
    let worlds = plan.worlds(folder)?;
    let scenario = match args.scenario.as_deref() {
        Some(name) => Some(known("world", name, worlds.iter().map(|world| world.name.as_str()))?),
        None => None,
    };
    let world = worlds
        .iter()
        .find(|world| scenario.is_none_or(|name| world.name == name))
        .ok_or(StudyError::NoWorld)?;
    if args.run >= plan.runs {
        return Err(HarnessError::NoSuchThing {
            kind: "run",
            name: args.run.to_string(),
            meant: None,
            known: format!("0 to {}", plan.runs - 1),
        });
    }
    start_again_with(&plan.isolation.preload)?;
    let mut spec = recorded.models(plan)?.spec(plan, world)?;
    for label in &args.labels {
        known("filter", label, spec.filters.iter().map(|filter| filter.label.as_str()))?;
    }
    if !args.labels.is_empty() {
        spec.filters.retain(|filter| args.labels.contains(&filter.label));
    }
    Ok(spec)
}

/// Which of a world's outputs are measurements: of the mission's sensors, whether they saw anything and what.
struct Measurements {
    /// Scalars of the truth.
    names: Vec<String>,
    ports: Vec<&'static Port>,
}

impl Measurements {
    fn of(world: &World) -> Self {
        let told = world.mission.navigation();
        let sensors = told.sensors.iter().map(|known| known.sensor.name());
        let sensors: Vec<&str> = sensors.chain(told.accelerometer.map(|_| "accelerometer")).collect();
        let of_a_sensor = |port: &&Port| {
            let (sensor, part) = port.name.split_once('.').unwrap_or_default();
            sensors.contains(&sensor) && !["due", "mean"].contains(&part)
        };
        let mut names = Vec::new();
        let mut ports = Vec::new();
        for port in interface::ports::of(Role::Sensor).filter(of_a_sensor) {
            let elements = match port.shape {
                Shape::Vector(n) => (1..=n).map(|i| format!("{}[{i}]", port.name)).collect(),
                _ => vec![port.name.to_owned()],
            };
            ports.extend(elements.iter().map(|_| port));
            names.extend(elements);
        }
        Self { names, ports }
    }

    /// `meas_`, the name of the variable and its unit.
    fn columns(&self) -> impl Iterator<Item = String> {
        let column = |(name, port): (&String, &&Port)| {
            let name = name.replace(['.', '['], "_").replace(']', "");
            let unit = match port.unit(0) {
                "" => String::new(),
                unit => format!("_{}", unit.replace('/', "_")),
            };
            format!("meas_{name}{unit}")
        };
        self.names.iter().zip(&self.ports).map(column)
    }

    /// Empty where a sensor saw nothing.
    fn cells(&self, values: Option<&Vec<f64>>) -> Vec<String> {
        let Some(values) = values else {
            return vec![String::new(); self.names.len()];
        };
        let valid = |sensor: &str| {
            let name = format!("{sensor}.valid");
            let place = self.names.iter().position(|own| *own == name);
            place
                .and_then(|place| values.get(place))
                .is_none_or(|valid| *valid > 0.0)
        };
        let cell_of = |(port, value): (&&Port, &f64)| {
            let sensor = port.name.split('.').next().unwrap_or_default();
            match port.kind {
                Kind::Boolean if value.is_finite() => format!("{value:.0}"),
                _ => cell(Some(*value).filter(|value| value.is_finite() && valid(sensor))),
            }
        };
        self.ports.iter().zip(values).map(cell_of).collect()
    }
}

/// Truth and estimate in the axes of their variables; error and sigma in those of the results.
fn header(world: &World) -> Vec<String> {
    let mut names: Vec<String> = ["filter", "sample", "t_s", "measured", "status"]
        .map(str::to_owned)
        .to_vec();
    let quantities = [("pos", "m"), ("vel", "m_s"), ("acc", "m_s2"), ("bias", "m_s2")];
    for (quantity, unit) in quantities {
        for kind in ["truth", "est"] {
            names.extend(["x", "y", "z"].map(|axis| format!("{kind}_{quantity}_{axis}_{unit}")));
        }
        let axes = if quantity == "bias" {
            ["x", "y", "z"]
        } else {
            world.axes.names()
        };
        for kind in ["err", "sigma"] {
            names.extend(axes.map(|axis| format!("{kind}_{quantity}_{axis}_{unit}")));
        }
    }
    for residual in world.frame.signals().innovations.iter().flatten() {
        for kind in ["", "_sigma"] {
            let columns = residual.columns().into_iter().zip(residual.units);
            names.extend(columns.map(|(name, unit)| format!("{name}{kind}_{unit}")));
        }
    }
    names.extend(["nees", "nis", "q_s_1", "q_s_2", "q_s_3"].map(str::to_owned));
    names.extend(upper().map(|(row, column)| format!("p_{}_{}", row + 1, column + 1)));
    names
}

/// Places of the covariance of position, velocity and acceleration on and above its diagonal, in the axes of its variables.
fn upper() -> impl Iterator<Item = (usize, usize)> {
    (0..9).flat_map(|row| (row..9).map(move |column| (row, column)))
}

fn line(world: &World, label: &str, truth: &TruthSample, estimate: &Estimate, record: &Record) -> Vec<String> {
    let mut cells = vec![
        label.to_owned(),
        truth.count.to_string(),
        cell(Some(truth.time)),
        u8::from(truth.measured).to_string(),
        estimate.status.map(|s| s.name().to_owned()).unwrap_or_default(),
    ];
    let mut push = |v: Option<Vector3<f64>>| cells.extend((0..3).map(|axis| cell(v.map(|v| v[axis]))));
    let sigma = |quantity| record.variance(quantity).map(|v| v.map(f64::sqrt));
    for (quantity, truth, estimate) in [
        (Quantity::Position, Some(truth.position), Some(estimate.position)),
        (Quantity::Velocity, Some(truth.velocity), Some(estimate.velocity)),
        (Quantity::Acceleration, truth.acceleration, estimate.acceleration),
        (Quantity::Bias, truth.bias, estimate.bias),
    ] {
        push(truth);
        push(estimate);
        push(record.error(quantity));
        push(sigma(quantity));
    }
    let innovations = [Quantity::Residual, Quantity::ResidualRate].into_iter();
    for (quantity, rows) in innovations.zip(world.frame.signals().innovations) {
        if rows.is_some() {
            push(record.error(quantity));
            push(sigma(quantity));
        }
    }
    cells.extend([cell(record.nees()), cell(record.nis())]);
    cells.extend((0..3).map(|axis| cell(estimate.jerk_root.map(|q| q[axis]))));
    let states = estimate.dimension;
    let held = |place: &(usize, usize)| place.0 < states && place.1 < states;
    cells.extend(upper().map(|place| cell(estimate.covariance.filter(|_| held(&place)).map(|p| p[place]))));
    cells
}
