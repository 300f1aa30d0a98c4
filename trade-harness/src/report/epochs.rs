//! `epochs/*.csv`: what the paper's figures show, for one filter, as numbers over time.

use study::{FilterResult, Quantity, Spec};

use crate::HarnessError;
use crate::format::{cell, finished};

/// Names of the columns of one axis: quantity, axis, unit.
struct Axis {
    name: String,
    unit: &'static str,
}

/// The columns of a quantity; `None` where the world has no such rows.
fn axes(spec: &Spec, quantity: Quantity) -> Option<[Axis; 3]> {
    let [a, b, c] = spec.world.axes.names();
    let named = |prefix: &str, axes: [&str; 3], unit| {
        axes.map(|axis| Axis {
            name: format!("{prefix}_{axis}"),
            unit,
        })
    };
    let rows = |index: usize| {
        let residual = spec.world.frame.signals().innovations[index]?;
        let [p, q, r] = residual.columns();
        let [s, t, u] = residual.units;
        Some([(p, s), (q, t), (r, u)].map(|(name, unit)| Axis { name, unit }))
    };
    Some(match quantity {
        Quantity::Position => named("pos", [a, b, c], "m"),
        Quantity::Velocity => named("vel", [a, b, c], "m_s"),
        Quantity::Acceleration => named("acc", [a, b, c], "m_s2"),
        Quantity::Bias => named("bias", ["x", "y", "z"], "m_s2"),
        Quantity::Residual => rows(0)?,
        Quantity::ResidualRate => rows(1)?,
        Quantity::JerkRoot => return None,
    })
}

/// Contents of the file: at each sample the number of runs and, by axis, the mean error, Eq. (31), the sample sigma,
/// Eq. (32), and the estimated sigma, Eq. (33); then mean NEES over its dimension, mean NIS over its rows with the number of runs that
/// have one, and for a filter
/// that tells it the mean of `q.s`, the root of the jerk density in axes N, with its standard deviation over the runs.
///
/// Sigmas are single, not triple; epochs before the scored time are included.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render(spec: &Spec, result: &FilterResult) -> Result<Vec<u8>, HarnessError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header = vec!["t_s".to_owned(), "runs".to_owned()];
    let mut quantities = Vec::new();
    for quantity in Quantity::ALL {
        let Some(axes) = axes(spec, quantity) else { continue };
        quantities.push(quantity);
        for Axis { name, unit } in axes {
            header.extend(["mean", "sample_sigma", "est_sigma"].map(|kind| format!("{kind}_{name}_{unit}")));
        }
    }
    header.extend(["nees", "nis", "nis_runs"].map(str::to_owned));
    let jerk_root = result.ensemble(Quantity::JerkRoot);
    if jerk_root.epochs() > 0 {
        header.extend((1..=3).flat_map(|i| ["mean", "spread"].map(|kind| format!("{kind}_q_s_{i}_m_s2_5"))));
    }
    writer.write_record(&header)?;

    for epoch in 0..spec.epochs() {
        let Some(position) = result.ensemble(Quantity::Position).at(epoch) else {
            continue;
        };
        let mut record = vec![cell(Some(spec.time(epoch))), position.runs.to_string()];
        for quantity in &quantities {
            let moments = result.ensemble(*quantity).at(epoch);
            let sample = moments.map(|m| m.sample_sigma());
            let estimated = moments.and_then(|m| m.estimated_sigma());
            for axis in 0..3 {
                record.push(cell(moments.map(|m| m.mean[axis])));
                record.push(cell(sample.map(|s| s[axis])));
                record.push(cell(estimated.map(|s| s[axis])));
            }
        }
        record.push(cell(result.nees.at(epoch).map(|(_, mean)| mean)));
        let nis = result.nis.at(epoch);
        record.push(cell(nis.map(|(_, mean)| mean)));
        record.push(nis.map_or(0, |(runs, _)| runs).to_string());
        if jerk_root.epochs() > 0 {
            let moments = jerk_root.at(epoch);
            // Rounding may leave the variance of equal values below zero.
            let spread = moments.map(|m| (m.second_moment - m.mean.component_mul(&m.mean)).map(|v| v.max(0.0).sqrt()));
            for axis in 0..3 {
                record.push(cell(moments.map(|m| m.mean[axis])));
                record.push(cell(spread.map(|s| s[axis])));
            }
        }
        writer.write_record(&record)?;
    }
    finished(writer)
}
