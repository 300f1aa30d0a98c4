//! Sums over short stretches of time, from which the page makes the errors of any stretch.

use serde::Serialize;

use crate::folder::Epochs;
use crate::pack::pack;

/// Most stretches.
const STRETCHES: usize = 400;

/// Sums over all epochs of a filter, by stretch; no epoch is left out, as it is in curves.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Window {
    /// Time of the first epoch of each stretch, s.
    pub from: Vec<f64>,
    /// Time of the last, s.
    pub to: Vec<f64>,
    /// Position, velocity and acceleration: runs times mean square of the norm, summed over the epochs.
    squares: [Sums; 3],
    /// Mean over the runs, summed over the epochs that have one.
    nees: Sums,
    nis: Sums,
}

#[derive(Debug, Default, Serialize)]
struct Sums {
    #[serde(serialize_with = "pack")]
    sum: Vec<Option<f64>>,
    /// What the sum is divided by.
    #[serde(serialize_with = "pack")]
    weight: Vec<Option<f64>>,
}

impl Sums {
    fn add(&mut self, stretch: usize, value: f64, weight: f64) {
        for (list, more) in [(&mut self.sum, value), (&mut self.weight, weight)] {
            list.resize(stretch + 1, Some(0.0));
            if let Some(Some(total)) = list.last_mut() {
                *total += more;
            }
        }
    }
}

/// Sums of a file over time. The scored time is a whole number of stretches.
pub(crate) fn window(epochs: &Epochs, scored_from_s: f64) -> Option<Window> {
    let time = epochs.column("t_s")?;
    let runs = epochs.column("runs")?;
    let squares = [("pos", "_m"), ("vel", "_m_s"), ("acc", "_m_s2")].map(|(name, unit)| {
        let prefix = format!("sample_sigma_{name}_");
        let of = |h: &&String| {
            h.strip_prefix(&prefix)
                .is_some_and(|rest| rest.strip_suffix(unit).is_some())
        };
        let axes = epochs.header.iter().filter(of).filter_map(|h| epochs.column(h));
        axes.collect::<Vec<_>>()
    });
    let (nees, nis) = (epochs.column("nees"), epochs.column("nis"));
    // A study of an earlier version does not say in how many runs there was a measurement.
    let measured = epochs.column("nis_runs").unwrap_or(runs);
    let length = time.len().div_ceil(STRETCHES).max(1);
    let mut window = Window::default();
    let mut in_stretch = 0;
    let mut before = f64::NEG_INFINITY;
    for (index, t) in time.iter().enumerate() {
        let (Some(t), Some(n)) = (*t, runs[index]) else {
            continue;
        };
        if in_stretch == length || window.from.is_empty() || (before < scored_from_s && t >= scored_from_s) {
            window.from.push(t);
            window.to.push(t);
            in_stretch = 0;
        }
        in_stretch += 1;
        before = t;
        let stretch = window.from.len() - 1;
        window.to[stretch] = t;
        for (sums, axes) in window.squares.iter_mut().zip(&squares) {
            let square: Option<f64> = axes.iter().map(|a| a[index].map(|s| s * s)).sum();
            match square.filter(|_| !axes.is_empty()) {
                Some(square) => sums.add(stretch, n * square, n),
                None => sums.add(stretch, 0.0, 0.0),
            }
        }
        for (sums, column, weight) in [
            (&mut window.nees, nees, Some(n)),
            (&mut window.nis, nis, measured[index]),
        ] {
            match Option::zip(column.and_then(|c| c[index]), weight) {
                Some((mean, weight)) => sums.add(stretch, weight * mean, weight),
                None => sums.add(stretch, 0.0, 0.0),
            }
        }
    }
    Some(window)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_end_at_the_scored_time_and_sum_every_epoch() {
        let some = |v: &[f64]| v.iter().copied().map(Some).collect::<Vec<_>>();
        let epochs = Epochs {
            header: ["t_s", "runs", "sample_sigma_pos_r_m", "sample_sigma_pos_t_m", "nees"]
                .map(str::to_owned)
                .into(),
            columns: vec![
                (1..=1000).map(|t| Some(f64::from(t))).collect(),
                vec![Some(2.0); 1000],
                some(&[3.0; 1000]),
                some(&[4.0; 1000]),
                [vec![None; 500], some(&[1.5; 500])].concat(),
            ],
        };
        let window = window(&epochs, 302.0).unwrap();
        assert!(window.from.contains(&302.0) && window.to.contains(&301.0));
        let total = |v: &[Option<f64>]| v.iter().map(|x| x.unwrap()).sum::<f64>();
        // 1000 epochs of two runs whose squared norm is 25.
        assert!((total(&window.squares[0].sum) - 50_000.0).abs() < 1e-6);
        assert!((total(&window.squares[0].weight) - 2000.0).abs() < 1e-6);
        assert!((total(&window.nees.sum) - 1500.0).abs() < 1e-6 && (total(&window.nees.weight) - 1000.0).abs() < 1e-6);
        // The second of two runs measured at a fifth of the epochs: a mean of both counts twice.
        let both = |t: usize| t.is_multiple_of(5);
        let told = Epochs {
            header: ["t_s", "runs", "nis", "nis_runs"].map(str::to_owned).into(),
            columns: vec![
                epochs.columns[0].clone(),
                epochs.columns[1].clone(),
                (0..1000).map(|t| Some(if both(t) { 3.0 } else { 1.0 })).collect(),
                (0..1000).map(|t| Some(if both(t) { 2.0 } else { 1.0 })).collect(),
            ],
        };
        let nis = super::window(&told, 302.0).unwrap().nis;
        assert!((total(&nis.sum) / total(&nis.weight) - 2000.0 / 1200.0).abs() < 1e-12);
        assert!(total(&window.squares[1].weight).abs() < 1e-12);
    }
}
