//! `run_errors/*.csv`: thinned errors of the first runs of a filter; `paths/*.csv`: the true path of run 0 of a world.

use study::{FilterResult, PathPoint, Spec};

use crate::HarnessError;
use crate::format::csv_bytes;

/// Five digits: what is thinned for figures needs no more.
fn short(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.4e}")
    } else {
        String::new()
    }
}

/// Contents of the file of a filter: two rows for each run and stretch of time (a hundredth of a run), axis by axis the least
/// and the greatest error of the stretch in the order in which they came, in the axes of the results.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_run_errors(spec: &Spec, result: &FilterResult) -> Result<Vec<u8>, HarnessError> {
    let axes = spec.world.axes.names();
    let mut header = vec!["run".to_owned(), "t_s".to_owned()];
    for (name, unit) in [("pos", "m"), ("vel", "m_s"), ("acc", "m_s2")] {
        header.extend(axes.map(|axis| format!("{name}_{axis}_{unit}")));
    }
    let rows = result.kept.iter().flat_map(|kept| {
        kept.rows.iter().map(|row| {
            let mut cells = vec![kept.run.to_string(), spec.time(row.epoch).to_string()];
            cells.extend(row.errors.iter().flat_map(|e| e.iter().copied().map(short)));
            cells
        })
    });
    csv_bytes(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}

/// Contents of the file of a world: chaser relative to target in the axes of the results, and the chaser in axes N.
///
/// # Errors
/// [`HarnessError::Csv`].
pub fn render_path(spec: &Spec, path: &[PathPoint]) -> Result<Vec<u8>, HarnessError> {
    let mut header = vec!["t_s".to_owned()];
    header.extend(spec.world.axes.names().map(|axis| format!("relative_{axis}_m")));
    header.extend(["x", "y", "z"].map(|axis| format!("chaser_{axis}_m")));
    let rows = path.iter().map(|point| {
        let mut cells = vec![spec.time(point.epoch as usize).to_string()];
        cells.extend(point.relative.iter().copied().map(short));
        cells.extend((0..3).map(|axis| point.chaser.map_or_else(String::new, |c| format!("{:.0}", c[axis]))));
        cells
    });
    csv_bytes(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows)
}
