//! `replay`: one run, sample by sample.

use nalgebra::Vector3;

use study::{Estimate, Plan, Quantity, Record, StudyError, TruthSample, World, rehearse, run_once, score};

use super::out::Out;
use super::shared::{Verdict, changed, models, note, scratch};
use crate::HarnessError;
use crate::cli::ReplayArgs;
use crate::format::{cell, finished};
use crate::output::{prepare_file, write_whole};

pub(super) fn replay(args: &ReplayArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    prepare_file(&args.out)?;
    let plan = Plan {
        scenarios: if args.mission.is_none() {
            vec![args.scenario.clone()]
        } else {
            Vec::new()
        },
        missions: args.mission.clone().into_iter().collect(),
        ..changed(Plan::default(), &args.study)?
    };
    let folder = scratch()?;
    let world = plan
        .worlds(folder.path())?
        .into_iter()
        .next()
        .ok_or(StudyError::NoWorld)?;
    let spec = models(&plan, &args.study.build)?.spec(&plan, &world)?;
    rehearse(&spec)?;
    let mut lines: Vec<Vec<Vec<String>>> = spec.filters.iter().map(|_| Vec::new()).collect();
    let report = run_once(&spec, args.run, |filter, truth, estimate| {
        let record = score(&world, truth, estimate)
            .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
        lines[filter].push(line(&world, &spec.filters[filter].label, truth, estimate, &record));
        Ok(())
    });

    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header(&world))?;
    for record in lines.iter().flatten() {
        writer.write_record(record)?;
    }
    write_whole(&args.out, &finished(writer)?)?;
    for (filter, ending) in spec.filters.iter().zip(&report.endings) {
        if let Some(failure) = &ending.failure {
            let when = failure.time.map(|t| format!(" at {t} s")).unwrap_or_default();
            note(&format!("failed: {}{when}: {}", filter.label, failure.message));
        }
    }
    out.tell("file", &args.out)?;
    out.say(&format!(
        "{} ({} samples)",
        args.out.display(),
        lines.iter().map(Vec::len).sum::<usize>()
    ))?;
    Ok(Verdict::Done)
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
    names
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
    cells
}
