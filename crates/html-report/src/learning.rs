//! The learning curve of `reproduce`: a true acceleration and the error of its estimate, over the logarithm of time.

use serde::Serialize;

use crate::folder::Epochs;
use crate::pack::pack;

/// Points of a curve for each decade of time.
const PER_DECADE: f64 = 40.0;

/// Share of the points that may lie below the axis, where the truth changes its sign.
const BELOW: f64 = 0.02;

/// Root mean squares over short stretches of time, equally long on an axis of powers of ten.
#[derive(Debug, Serialize)]
pub(crate) struct Learning {
    /// Mean of the times of each stretch, s, ascending, positive.
    pub t: Vec<f64>,
    /// First and last time, s.
    pub span_s: [f64; 2],
    pub axes: Vec<LearningAxis>,
}

/// The acceleration along an axis, m/s2.
#[derive(Debug, Serialize)]
pub(crate) struct LearningAxis {
    pub name: &'static str,
    #[serde(serialize_with = "pack")]
    pub truth: Vec<Option<f64>>,
    /// Over the runs, too.
    #[serde(serialize_with = "pack")]
    pub error: Vec<Option<f64>>,
    /// What an axis of powers of ten shows.
    pub range: [f64; 2],
}

/// * `file`: `learning_curve.csv`.
/// * returns: `None` when it has no positive time.
pub(crate) fn learning(file: &Epochs) -> Option<Learning> {
    let time = file.column("t_s")?;
    let mut stretches: Vec<Vec<(usize, f64)>> = Vec::new();
    let mut last = None;
    for (row, t) in time.iter().enumerate().filter_map(|(row, t)| Some((row, (*t)?))) {
        if t > 0.0 {
            let stretch = (PER_DECADE * t.log10()).floor() as i64;
            if last != Some(stretch) {
                stretches.push(Vec::new());
            }
            last = Some(stretch);
            if let Some(rows) = stretches.last_mut() {
                rows.push((row, t));
            }
        }
    }
    let axis = |name: &'static str| {
        let rooted = |column: String| {
            let values = file.column(&column)?;
            let root = |rows: &Vec<(usize, f64)>| {
                let squares: Vec<f64> = rows.iter().filter_map(|(row, _)| values[*row].map(|v| v * v)).collect();
                (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
            };
            Some(stretches.iter().map(root).collect::<Vec<_>>())
        };
        let truth = rooted(format!("d_{name}_m_s2"))?;
        let error = rooted(format!("rms_error_{name}_m_s2"))?;
        Some(LearningAxis {
            range: range(truth.iter().chain(&error).flatten()),
            name,
            truth,
            error,
        })
    };
    let mean = |rows: &Vec<(usize, f64)>| rows.iter().map(|(_, t)| t).sum::<f64>() / rows.len() as f64;
    let ends = [stretches.first()?.first()?.1, stretches.last()?.last()?.1];
    Some(Learning {
        t: stretches.iter().map(mean).collect(),
        span_s: ends,
        axes: ["x", "y", "z"].into_iter().filter_map(axis).collect(),
    })
}

/// From the least values, but for a few, to the largest, with a margin.
fn range<'a>(values: impl Iterator<Item = &'a f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.copied().filter(|v| *v > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let low = sorted.get((BELOW * sorted.len() as f64) as usize);
    match low.zip(sorted.last()) {
        Some((low, high)) => [low / 1.5, high * 1.5],
        None => [0.1, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_keeps_its_mean_square_and_its_small_values() {
        let steps = 1..=1000;
        let constant = |v: f64| vec![Some(v); 1000];
        let names = ["t_s", "d_x_m_s2", "rms_error_x_m_s2"];
        let file = Epochs {
            header: names.map(str::to_owned).into(),
            columns: vec![
                steps.clone().map(|t| Some(f64::from(t))).collect(),
                constant(-1e-10),
                steps.map(|t| Some(if t % 2 == 0 { 3.0 } else { 4.0 })).collect(),
            ],
        };
        let found = learning(&file).unwrap();
        assert_eq!(found.span_s.map(|t| t as u32), [1, 1000]);
        assert!(found.t.len() < 3 * 40 && found.t.is_sorted(), "{}", found.t.len());
        let [axis] = &found.axes[..] else { panic!("{found:?}") };
        assert!(axis.truth.iter().all(|v| (v.unwrap() - 1e-10).abs() < 1e-22));
        assert!(axis.range[0] < 1e-10 && axis.range[1] > 4.0);
        // The last whole stretch holds some fifty times, half of them of either size.
        let late = axis.error[axis.error.len() - 2].unwrap();
        assert!((late - 12.5_f64.sqrt()).abs() < 0.03, "{late}");
    }
}
