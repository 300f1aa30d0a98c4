//! Time series of a filter, thinned to what a figure can show.

use serde::Serialize;

use crate::folder::Epochs;
use crate::number::significant;
use crate::pack::pack;

/// Most means over time. Innovations are independent from epoch to epoch, and errors forget quickly: of single epochs a figure
/// shows a bar alone.
const NEES: usize = 240;
const NIS: usize = 120;

/// Significant digits of what a figure draws.
const DIGITS: usize = 4;

/// The curves of a filter.
#[derive(Debug, Serialize)]
pub(crate) struct Series {
    /// Epochs in the file for each pair of points drawn; 1 when all are drawn.
    pub every: usize,
    /// Time, s.
    pub t: Vec<f64>,
    /// Position, velocity, acceleration, as far as the file has them.
    pub quantities: Vec<QuantitySeries>,
    pub nees: Means,
    pub nis: Means,
    /// Mean over the runs of the root of the jerk density in axes N, m/s^2.5; `None` where the filter tells none.
    pub jerk_root: Option<[Column; 3]>,
    /// Degrees of freedom of the NIS, where they are the same at all epochs.
    #[serde(skip)]
    pub residual_rows: Option<usize>,
}

/// Means over so many epochs each.
#[derive(Debug, Serialize)]
pub(crate) struct Means {
    /// Epochs with a value that each is a mean of.
    pub epochs: usize,
    /// Mean of their times, s.
    pub t: Vec<f64>,
    #[serde(serialize_with = "pack")]
    pub mean: Vec<Option<f64>>,
}

#[derive(Debug, Serialize)]
pub(crate) struct QuantitySeries {
    pub name: &'static str,
    pub unit: &'static str,
    pub axes: Vec<AxisSeries>,
}

/// Mean error, sample sigma, estimated sigma; of each bucket the extremes of the first, root mean squares of the others.
#[derive(Debug, Serialize)]
pub(crate) struct AxisSeries {
    pub axis: String,
    #[serde(serialize_with = "pack")]
    pub mean: Vec<Option<f64>>,
    #[serde(serialize_with = "pack")]
    pub sample: Vec<Option<f64>>,
    #[serde(serialize_with = "pack")]
    pub estimated: Vec<Option<f64>>,
    /// Name of the column of single runs.
    pub column: String,
}

/// A curve.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(crate) struct Column(#[serde(serialize_with = "pack")] pub Vec<Option<f64>>);

/// Prefix in the header, name, suffix, unit.
const QUANTITIES: [(&str, &str, &str, &str); 3] = [
    ("mean_pos_", "position", "_m", "m"),
    ("mean_vel_", "velocity", "_m_s", "m/s"),
    ("mean_acc_", "acceleration", "_m_s2", "m/s²"),
];

/// The curves of a file over time.
///
/// * `points`: most points of a curve.
/// * returns: `None` when the file has no time.
pub(crate) fn series(epochs: &Epochs, points: usize) -> Option<Series> {
    let time: Vec<f64> = epochs.column("t_s")?.iter().map(|t| t.unwrap_or(f64::NAN)).collect();
    let every = if time.len() <= points {
        1
    } else {
        time.len().div_ceil((points / 2).max(1))
    };
    let thin = |column: &[Option<f64>]| thinned(column, every);
    let column = |name: &str| epochs.column(name).map(thin).unwrap_or_default();
    let quantities = QUANTITIES.into_iter().filter_map(|(prefix, name, suffix, unit)| {
        let axes: Vec<AxisSeries> = epochs
            .header
            .iter()
            .filter_map(|h| h.strip_prefix(prefix)?.strip_suffix(suffix))
            .map(|axis| {
                let named = |kind: &str| format!("{kind}{}{axis}{suffix}", &prefix["mean".len()..]);
                let sigma = |kind: &str| {
                    epochs
                        .column(&named(kind))
                        .map(|c| rooted(c, every))
                        .unwrap_or_default()
                };
                AxisSeries {
                    column: format!("{}{axis}{suffix}", &prefix["mean_".len()..]),
                    axis: axis.to_owned(),
                    mean: column(&named("mean")),
                    sample: sigma("sample_sigma"),
                    estimated: sigma("est_sigma"),
                }
            })
            .filter(|a| a.mean.iter().any(Option::is_some))
            .collect();
        (!axes.is_empty()).then_some(QuantitySeries { name, unit, axes })
    });
    let jerk_root = [1, 2, 3].map(|i| Column(column(&format!("mean_q_s_{i}_m_s2_5"))));
    let told = jerk_root.iter().any(|c| c.0.iter().flatten().any(|q| *q > 0.0));
    Some(Series {
        every,
        t: thinned_time(&time, every),
        quantities: quantities.collect(),
        nees: means(&time, epochs.column("nees").unwrap_or_default(), NEES),
        nis: means(&time, epochs.column("nis").unwrap_or_default(), NIS),
        jerk_root: told.then_some(jerk_root),
        residual_rows: residual_rows(epochs),
    })
}

/// Means over equally many epochs that have a value; epochs at the end that are too few for another are left out.
///
/// * `most`: means.
fn means(time: &[f64], column: &[Option<f64>], most: usize) -> Means {
    let there = time.iter().zip(column).filter_map(|(t, v)| Some((*t, (*v)?)));
    let there: Vec<(f64, f64)> = there.collect();
    let epochs = there.len().div_ceil(most).max(1);
    let mean = |part: &[(f64, f64)], of: fn(&(f64, f64)) -> f64| part.iter().map(of).sum::<f64>() / epochs as f64;
    Means {
        epochs,
        t: there.chunks_exact(epochs).map(|part| mean(part, |p| p.0)).collect(),
        mean: there
            .chunks_exact(epochs)
            .map(|part| Some(significant(mean(part, |p| p.1), DIGITS)))
            .collect(),
    }
}

/// Rows of the residual at the epochs that have a NIS; `None` when they are not always the same number.
fn residual_rows(epochs: &Epochs) -> Option<usize> {
    let states = ["mean_pos_", "mean_vel_", "mean_acc_", "mean_bias_", "mean_q_"];
    let is_residual = |header: &str| header.starts_with("mean_") && !states.iter().any(|s| header.starts_with(s));
    let residuals: Vec<_> = epochs
        .header
        .iter()
        .zip(&epochs.columns)
        .filter(|(header, _)| is_residual(header))
        .map(|(_, column)| column)
        .collect();
    let with_nis = epochs
        .column("nis")?
        .iter()
        .enumerate()
        .filter(|(_, nis)| nis.is_some());
    let mut rows = with_nis.map(|(i, _)| residuals.iter().filter(|c| c[i].is_some()).count());
    let first = rows.next().filter(|n| *n > 0)?;
    rows.all(|n| n == first).then_some(first)
}

/// Of each bucket of `every` values the least and the greatest, in the order in which they come.
fn thinned(column: &[Option<f64>], every: usize) -> Vec<Option<f64>> {
    let round = |v: Option<f64>| v.map(|v| significant(v, DIGITS));
    if every == 1 {
        return column.iter().copied().map(round).collect();
    }
    let extremes = |bucket: &[Option<f64>]| {
        let present = || bucket.iter().enumerate().filter_map(|(i, v)| Some((i, (*v)?)));
        let least = present().min_by(|a, b| a.1.total_cmp(&b.1));
        let greatest = present().max_by(|a, b| a.1.total_cmp(&b.1));
        let value = |e: Option<(usize, f64)>| e.map(|(_, v)| v);
        if least.map(|e| e.0) <= greatest.map(|e| e.0) {
            [value(least), value(greatest)]
        } else {
            [value(greatest), value(least)]
        }
    };
    column.chunks(every).flat_map(extremes).map(round).collect()
}

/// Root mean squares over the halves of each bucket: the extremes of a sigma over few runs are those of chance.
fn rooted(column: &[Option<f64>], every: usize) -> Vec<Option<f64>> {
    if every == 1 {
        return thinned(column, every);
    }
    let root = |half: &[Option<f64>]| {
        let squares: Vec<f64> = half.iter().flatten().map(|v| v * v).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (!squares.is_empty()).then(|| significant(mean.sqrt(), DIGITS))
    };
    let halves = |bucket: &[Option<f64>]| {
        let (first, second) = bucket.split_at(bucket.len().div_ceil(2));
        [root(first), root(second)]
    };
    column.chunks(every).flat_map(halves).collect()
}

/// Times of the two points of each bucket: its first epoch and its middle one.
fn thinned_time(time: &[f64], every: usize) -> Vec<f64> {
    if every == 1 {
        return time.to_vec();
    }
    let two = |bucket: &[f64]| {
        let first = bucket.first().copied().unwrap_or(f64::NAN);
        let last = bucket.last().copied().unwrap_or(f64::NAN);
        [first, 0.5 * (first + last)]
    };
    time.chunks(every).flat_map(two).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_of_as_many_epochs_each() {
        let time: Vec<f64> = (0..300).map(f64::from).collect();
        // Every third epoch has none.
        let column: Vec<Option<f64>> = (0..300).map(|i| (i % 3 > 0).then(|| f64::from(i % 3))).collect();
        let found = means(&time, &column, 120);
        assert_eq!((found.epochs, found.t.len()), (2, 100));
        assert!(found.mean.iter().all(|m| *m == Some(1.5)));
        assert_eq!(found.t[..2], [1.5, 4.5]);
        assert!(means(&time, &[], 120).t.is_empty());
    }

    #[test]
    fn extremes_survive_in_their_order() {
        let values = [1.0, 9.0, 2.0, 5.0, 0.5, 4.0].map(Some);
        assert_eq!(thinned(&values, 3), [Some(1.0), Some(9.0), Some(5.0), Some(0.5)]);
        assert_eq!(
            thinned(&[None, Some(3.0), None, None], 2),
            [Some(3.0), Some(3.0), None, None]
        );
        let sigmas = [3.0, 4.0, 1.0, 0.0, 7.0, 2.0].map(Some);
        let root = |v: f64| Some(significant(v.sqrt(), DIGITS));
        assert_eq!(rooted(&sigmas, 4), [root(12.5), root(0.5), Some(7.0), Some(2.0)]);
        assert_eq!(rooted(&[None, None, Some(1.0)], 3), [None, Some(1.0)]);
        assert_eq!(thinned_time(&[0.0, 1.0, 2.0, 3.0], 3), [0.0, 1.0, 3.0, 3.0]);
    }
}
