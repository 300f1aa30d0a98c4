//! What `hybrid` promises, in worlds that it was not tuned in: it is back soon after a burn that nobody announced, and away from
//! pushes it is neither sure of what is wrong nor unsure of what it knows.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{files, harness_ok, read_csv};
use std::collections::HashMap;
use std::path::Path;

/// Start of the burn, s.
const BURN: f64 = 2500.0;

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column}: {:?}", row[column]))
}

fn fly(out: &Path, mission: &str, set: &[&str]) {
    let out = out.to_str().unwrap();
    let study = ["compare", "--scenario", mission, "--filters", "hybrid", "--runs", "16"];
    let mut line = [&study[..], &["--seed", "90210", "--out", out]].concat();
    set.iter().for_each(|assignment| line.extend(["--set", assignment]));
    harness_ok(&line);
}

/// Error of the relative position over time: epoch, s, and root mean square over the runs, m.
fn errors(out: &Path) -> Vec<(f64, f64)> {
    let path = files(&out.join("epochs")).into_keys().next().unwrap();
    let of_axis = |row: &HashMap<String, String>, axis: &str| {
        let [mean, sigma] = ["mean", "sample_sigma"].map(|kind| number(row, &format!("{kind}_pos_{axis}_m")));
        mean * mean + sigma * sigma
    };
    let rows = read_csv(&path);
    let error = |row| {
        (
            number(row, "t_s"),
            ["r", "t", "n"]
                .map(|axis| of_axis(row, axis))
                .iter()
                .sum::<f64>()
                .sqrt(),
        )
    };
    rows.iter().map(error).collect()
}

#[test]
fn it_is_back_soon_after_a_burn() {
    for mission in ["leo_venting", "nrho_venting"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let burn = [
            format!("fmu-truth.target_burn.start={BURN}"),
            "fmu-truth.target_burn.duration=30".to_owned(),
            "fmu-truth.target_burn.a_t_n[1]=1e-2".to_owned(),
        ];
        fly(&out, mission, &burn.each_ref().map(String::as_str));
        let errors = errors(&out);
        let mut before: Vec<f64> = errors
            .iter()
            .filter(|(t, _)| (BURN - 200.0..BURN).contains(t))
            .map(|(_, e)| *e)
            .collect();
        before.sort_by(f64::total_cmp);
        let steady = before[before.len() / 2];
        let far = |(t, error): &&(f64, f64)| (BURN..BURN + 600.0).contains(t) && *error > 3.0 * steady;
        let last = errors.iter().rfind(far);
        let (t, _) = last.unwrap_or_else(|| panic!("{mission}: the burn leaves no trace"));
        assert!(t - BURN <= 110.0, "{mission}: {} s", t - BURN);
    }
}

#[test]
fn it_is_consistent_away_from_pushes() {
    for (mission, scale) in [("leo_venting", "1"), ("leo_venting", "100"), ("nrho_venting", "10")] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        fly(&out, mission, &[&format!("fmu-truth.vent.scale={scale}")]);
        let phases = read_csv(&out.join("phases.csv"));
        let calm = phases.iter().find(|row| row["phase"] == "calm").unwrap();
        let [mean, median, beyond] = ["nees6", "nees6_median", "nees6_beyond"].map(|column| number(calm, column));
        let told = format!("{mission}, scale {scale}: {mean}, {median}, {beyond}");
        assert!((0.4..=1.1).contains(&mean), "{told}");
        assert!((0.35..=1.0).contains(&median), "{told}");
        assert!(beyond <= 0.04, "{told}");
    }
}
