//! `replay`: one run, sample by sample.

use std::io::Write;

use nalgebra::Vector3;

use super::{Cast, Verdict, note, say};
use crate::HarnessError;
use crate::cli::ReplayArgs;
use crate::output::{prepare_file, write_whole};
use crate::report::{cell, finished};
use crate::run::{rehearse, run_once};
use crate::scenarios::{self, Scenario};
use crate::score::{Quantity, Score, score};
use crate::signals::{Estimate, TruthSample};

pub(super) fn replay(args: &ReplayArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let scenario = scenarios::find(&args.scenario)?;
    prepare_file(&args.out)?;
    let cast = Cast::new(&args.study)?;
    let spec = cast.spec(&args.study, scenario)?;
    rehearse(&spec)?;
    let mut lines: Vec<Vec<Vec<String>>> = spec.filters.iter().map(|_| Vec::new()).collect();
    let report = run_once(&spec, args.run, |filter, truth, estimate| {
        let score = score(scenario, truth, estimate)
            .ok_or_else(|| format!("the axes of the results are undefined at {} s", truth.time))?;
        lines[filter].push(line(scenario, &spec.filters[filter].label, truth, estimate, &score));
        Ok(())
    });

    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header(scenario))?;
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
    say(
        out,
        &format!(
            "{} ({} samples)",
            args.out.display(),
            lines.iter().map(Vec::len).sum::<usize>()
        ),
    )?;
    Ok(Verdict::Done)
}

/// Truth and estimate in the axes of their variables; error and sigma in those of the results.
fn header(scenario: &Scenario) -> Vec<String> {
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
            scenario.signals.axes
        };
        for kind in ["err", "sigma"] {
            names.extend(axes.map(|axis| format!("{kind}_{quantity}_{axis}_{unit}")));
        }
    }
    for residual in scenario.signals.residual.iter().flatten() {
        for kind in ["", "_sigma"] {
            let columns = residual.columns().into_iter().zip(residual.units);
            names.extend(columns.map(|(name, unit)| format!("{name}{kind}_{unit}")));
        }
    }
    names.extend(["nees", "nis", "q_s_1", "q_s_2", "q_s_3"].map(str::to_owned));
    names
}

fn line(scenario: &Scenario, label: &str, truth: &TruthSample, estimate: &Estimate, score: &Score) -> Vec<String> {
    let mut cells = vec![
        label.to_owned(),
        truth.count.to_string(),
        cell(Some(truth.time)),
        u8::from(truth.measured).to_string(),
        estimate
            .status
            .map(|s| format!("{s:?}").to_lowercase())
            .unwrap_or_default(),
    ];
    let mut push = |v: Option<Vector3<f64>>| cells.extend((0..3).map(|axis| cell(v.map(|v| v[axis]))));
    let pairs = [
        (Some(truth.position), Some(estimate.position)),
        (Some(truth.velocity), Some(estimate.velocity)),
        (truth.acceleration, estimate.acceleration),
        (truth.bias, estimate.bias),
    ];
    let sigma = |index: usize| score.variances[index].map(|v| v.map(f64::sqrt));
    for (index, (truth, estimate)) in pairs.into_iter().enumerate() {
        push(truth);
        push(estimate);
        push(score.errors[index]);
        push(sigma(index));
    }
    let residuals = [Quantity::Residual, Quantity::ResidualRate];
    for (quantity, _) in residuals
        .into_iter()
        .zip(&scenario.signals.residual)
        .filter(|(_, rows)| rows.is_some())
    {
        push(score.errors[quantity as usize]);
        push(sigma(quantity as usize));
    }
    cells.extend([cell(score.nees), cell(score.nis)]);
    cells.extend((0..3).map(|axis| cell(estimate.jerk_root.map(|q| q[axis]))));
    cells
}
