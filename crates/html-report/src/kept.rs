//! What the folder holds of single runs: their thinned errors, and the true path of run 0.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::folder::Epochs;
use crate::pack::pack;

/// Errors of single runs, on times that all share.
#[derive(Debug, Serialize)]
pub(crate) struct KeptRuns {
    pub runs: Vec<u32>,
    /// Time, s.
    pub t: Vec<f64>,
    /// By name of the column, run by run at all times.
    pub columns: BTreeMap<String, KeptColumn>,
}

#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(crate) struct KeptColumn(#[serde(serialize_with = "pack")] pub Vec<Option<f64>>);

/// Errors of the first runs of a file of `run_errors`.
///
/// * `numbers`: most of them; as many runs are taken as that allows.
/// * returns: `None` when there is no row.
pub(crate) fn kept_runs(file: &Epochs, numbers: usize) -> Option<KeptRuns> {
    let (run, time) = (file.column("run")?, file.column("t_s")?);
    let known = || run.iter().zip(time).filter_map(|(run, t)| Option::zip(*run, *t));
    let mut runs: Vec<u32> = known().map(|(run, _)| run as u32).collect();
    runs.dedup();
    let mut t: Vec<f64> = known().map(|(_, t)| t).collect();
    t.sort_by(f64::total_cmp);
    t.dedup();
    let columns: Vec<&String> = file.header.iter().filter(|h| *h != "run" && *h != "t_s").collect();
    runs.truncate((numbers / (t.len() * columns.len()).max(1)).max(1));
    let place = |row: usize| {
        let of_run = runs.iter().position(|r| Some(f64::from(*r)) == run[row])?;
        let at = time[row]?;
        let of_time = t.binary_search_by(|other| other.total_cmp(&at)).ok()?;
        Some(of_run * t.len() + of_time)
    };
    let places: Vec<Option<usize>> = (0..run.len()).map(place).collect();
    let column = |name: &String| {
        let mut values = vec![None; runs.len() * t.len()];
        let cells = file.column(name).unwrap_or_default();
        for (place, value) in places.iter().zip(cells).filter_map(|(p, v)| Some(((*p)?, *v))) {
            values[place] = value;
        }
        (name.clone(), KeptColumn(values))
    };
    let columns = columns
        .into_iter()
        .map(column)
        .filter(|(_, c)| c.0.iter().any(Option::is_some));
    let columns: BTreeMap<_, _> = columns.collect();
    (!columns.is_empty()).then_some(KeptRuns { runs, t, columns })
}

/// The true path of run 0.
#[derive(Debug, Serialize)]
pub(crate) struct Path {
    /// Time, s.
    pub t: Vec<Option<f64>>,
    /// Names of the axes of the results.
    pub axes: Vec<String>,
    /// Chaser relative to target, m, by axis.
    pub relative: Vec<Vec<Option<f64>>>,
    /// Chaser in axes N, m, by axis; empty where it is not told or where the orbit is a circle to the eye.
    pub chaser: Vec<Vec<Option<f64>>>,
    /// The body that it is drawn about, with its place in axes N, m.
    pub body: Option<(&'static str, [f64; 3])>,
}

/// * `gravity`: of the mission; paths in the axes of two bodies show the chaser's orbit, too.
pub(crate) fn path(file: &Epochs, gravity: &serde_json::Value) -> Option<Path> {
    let t = file.column("t_s")?.to_vec();
    let axes: Vec<String> = (file.header.iter())
        .filter_map(|h| Some(h.strip_prefix("relative_")?.strip_suffix("_m")?.to_owned()))
        .collect();
    let of = |name: String| file.column(&name).map(<[_]>::to_vec);
    let relative: Vec<_> = axes
        .iter()
        .filter_map(|axis| of(format!("relative_{axis}_m")))
        .collect();
    let moon = || {
        let length = gravity["length_m"].as_f64().filter(|_| gravity["model"] == "cr3bp")?;
        Some((
            "smaller body",
            [(1.0 - gravity["mass_ratio"].as_f64()?) * length, 0.0, 0.0],
        ))
    };
    let body = moon();
    let chaser: Vec<_> = body
        .iter()
        .flat_map(|_| ["x", "y", "z"])
        .filter_map(|axis| of(format!("chaser_{axis}_m")))
        .collect();
    let known = chaser.iter().flatten().any(Option::is_some);
    (t.len() > 1 && relative.len() == 3).then_some(Path {
        t,
        axes,
        relative,
        chaser: if known { chaser } else { Vec::new() },
        body,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_share_their_times_and_gaps_are_absent() {
        let some = |v: &[f64]| v.iter().copied().map(Some).collect::<Vec<_>>();
        let file = Epochs {
            header: ["run", "t_s", "pos_r_m", "acc_r_m_s2"].map(str::to_owned).into(),
            columns: vec![
                some(&[0.0, 0.0, 3.0]),
                some(&[1.0, 2.0, 2.0]),
                some(&[5.0, 6.0, 7.0]),
                vec![None; 3],
            ],
        };
        let kept = kept_runs(&file, 1000).unwrap();
        assert_eq!(
            (kept.runs.as_slice(), kept.t.as_slice()),
            (&[0, 3][..], &[1.0, 2.0][..])
        );
        assert_eq!(kept.columns.keys().collect::<Vec<_>>(), ["pos_r_m"]);
        assert_eq!(kept.columns["pos_r_m"].0, [Some(5.0), Some(6.0), None, Some(7.0)]);
        assert_eq!(kept_runs(&file, 1).unwrap().runs, [0]);
    }
}
