//! The FMUs through a third party's eyes: FMPy validates them, simulates each alone and couples them.
//!
//! The scripts stand in `tests/fmpy`. FMPy goes into a virtual environment of its own under `target`, made by the first
//! test that needs it from `tests/fmpy/requirements.txt`.

#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

mod common;

use common::{fmu, harness_ok, read_csv, root, skipped, twin, virtual_environment};
use interface::ports::Role;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Python of the virtual environment; `None` when this system has no Python to make one with.
fn python() -> Option<&'static Path> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    PYTHON
        .get_or_init(|| {
            let environment = root().join("target/fmpy");
            let requirements = root().join("tests/fmpy/requirements.txt");
            let installed = environment.join("requirements.txt");
            if std::fs::read(&installed).ok() == std::fs::read(&requirements).ok() {
                return Some(environment.join("bin/python"));
            }
            let python = virtual_environment(&environment, &["--requirement", requirements.to_str().unwrap()])?;
            std::fs::copy(&requirements, &installed).unwrap();
            Some(python)
        })
        .as_deref()
}

/// Runs a script of `tests/fmpy`; returns what it printed, or `None` when it was skipped.
fn script(test: &str, name: &str, arguments: &[&str]) -> Option<String> {
    let Some(python) = python() else {
        skipped(test, "python3-venv");
        return None;
    };
    let output = Command::new(python)
        .arg(root().join("tests/fmpy").join(name))
        .args(arguments)
        .output()
        .unwrap();
    let (out, err) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{name} {arguments:?}:\n{out}\n{err}");
    Some(out.into_owned())
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn fmpy_finds_nothing_to_say_about_any_fmu() {
    let fmus = [fmu("fmu-truth"), fmu("fmu-nav"), twin("fmu-truth"), twin("fmu-nav")];
    if let Some(out) = script("validate", "validate.py", &fmus.each_ref().map(|path| text(path))) {
        let versions: Vec<_> = out.lines().map(|line| line.rsplit(' ').next().unwrap()).collect();
        assert_eq!(versions, ["2.0", "2.0", "3.0", "3.0"], "{out}");
    }
}

/// What an FMU has inside as its reference, somebody else's program gets, too, to the bit.
#[test]
fn fmpy_repeats_the_reference_results() {
    let fmus = [fmu("fmu-truth"), fmu("fmu-nav"), twin("fmu-truth"), twin("fmu-nav")];
    if let Some(out) = script("reference", "reference.py", &fmus.each_ref().map(|path| text(path))) {
        let expected = [
            "fmu-truth: 601 rows, 10 columns, 0 other bits",
            "fmu-nav: 601 rows, 10 columns, 0 other bits",
            // Of the ten numbers six are two vectors.
            "fmu-truth: 601 rows, 6 columns, 0 other bits",
            "fmu-nav: 601 rows, 6 columns, 0 other bits",
        ];
        assert_eq!(out.lines().collect::<Vec<_>>(), expected, "{out}");
    }
}

#[test]
fn terminals_of_the_twins_fit_the_schema_and_each_other() {
    let twins = [twin("fmu-truth"), twin("fmu-nav")];
    if let Some(out) = script("terminals", "terminals.py", &twins.each_ref().map(|path| text(path))) {
        let lines: BTreeSet<&str> = out.lines().collect();
        let count = |role| interface::ports::of(role).count();
        let sensors = count(Role::Sensor);
        assert!(lines.contains("sensors plug output to input"), "{out}");
        assert!(lines.contains("commands bus input to input"), "{out}");
        let truth = format!("fmu-truth sensors {sensors}, commands 3, attitude 1, disturbances 2");
        // All of the estimate but its covariance, which is local.
        let nav = format!(
            "fmu-nav sensors {sensors}, commands 3, estimate {}",
            count(Role::Estimate) - 1
        );
        assert!(
            lines.contains(truth.as_str()) && lines.contains(nav.as_str()),
            "{truth}\n{nav}\n{out}"
        );
        assert_eq!(lines.len(), 4, "{out}");
    }
}

#[test]
fn fmpy_simulates_each_fmu_alone() {
    let truth = script(
        "truth alone",
        "alone.py",
        &[text(&fmu("fmu-truth")), "sample_count", "truth.r_tc_n[1]"],
    );
    if let Some(out) = truth {
        let values: Vec<(&str, f64)> = out
            .lines()
            .filter_map(|line| line.split_once(' '))
            .map(|(name, value)| (name, value.parse().unwrap()))
            .collect();
        assert_eq!(values[0], ("sample_count", 5680.0));
        // The run ends at the rendezvous: r_tc = -[1, 1, 1] m.
        assert!((values[1].1 + 1.0).abs() < 1e-4, "{out}");
    }
    // Without a world the filter waits for its first sample, without complaint.
    if let Some(out) = script("nav alone", "alone.py", &[text(&fmu("fmu-nav")), "est.count", "status"]) {
        assert_eq!(out.lines().collect::<Vec<_>>(), ["est.count 0", "status 1"]);
    }
}

/// The FMI 3.0 twins step the same library, and a vector is one variable.
#[test]
fn fmpy_simulates_each_twin_alone() {
    let outputs = [text(&twin("fmu-truth")), "sample_count", "truth.r_tc_n"].map(str::to_owned);
    if let Some(out) = script("truth twin alone", "alone.py", &outputs.each_ref().map(String::as_str)) {
        let alone = [
            text(&fmu("fmu-truth")),
            "truth.r_tc_n[1]",
            "truth.r_tc_n[2]",
            "truth.r_tc_n[3]",
        ]
        .map(str::to_owned);
        let two = script("truth alone", "alone.py", &alone.each_ref().map(String::as_str)).unwrap();
        let elements: Vec<_> = two.lines().map(|line| line.split_once(' ').unwrap().1).collect();
        let vector = format!("truth.r_tc_n [{}]", elements.join(", "));
        assert_eq!(out.lines().collect::<Vec<_>>(), ["sample_count 5680", &vector]);
    }
    let outputs = [text(&twin("fmu-nav")), "est.count", "status"].map(str::to_owned);
    if let Some(out) = script("nav twin alone", "alone.py", &outputs.each_ref().map(String::as_str)) {
        assert_eq!(out.lines().collect::<Vec<_>>(), ["est.count 0", "status 1"]);
    }
}

/// Whole arrays handed over by name, in every world: each sample's estimate as the FMI 2.0 FMUs have it, to the bit.
#[test]
fn fmpy_couples_the_twins_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let estimates = |[truth, nav]: [PathBuf; 2], name: &str, [world, filter]: [&str; 2], [scheme, step]: [&str; 2]| {
        let out = folder.path().join(name);
        let fmus = ["--truth", text(&truth), "--nav", text(&nav), "--out", text(&out)];
        let what = [
            "--scenario",
            world,
            "--filter",
            filter,
            "--run",
            "3",
            "--seed",
            "7",
            "--stop",
            "600",
        ];
        let how = ["--scheme", scheme, "--step", step];
        script("twins", "couple.py", &[&fmus[..], &what[..], &how[..]].concat())?;
        Some(std::fs::read_to_string(out).unwrap())
    };
    for (what, how, rows) in [
        (["leo_venting", "hybrid"], ["gauss-seidel", "1"], 600),
        (["leo_venting", "milton"], ["jacobi", "0.25"], 599),
        (["leo_venting", "constrained_q"], ["gauss-seidel", "0.5"], 600),
        (["nrho_venting", "imm"], ["gauss-seidel", "1"], 600),
        (["nrho_venting", "snc"], ["jacobi", "1"], 599),
        (["formation", "rbfnn_aekf"], ["gauss-seidel", "1"], 600),
        (["formation", "ekf_j2"], ["gauss-seidel", "0.25"], 600),
    ] {
        let twins = ["fmu-truth", "fmu-nav"].map(twin);
        let Some(three) = estimates(twins, "three.csv", what, how) else {
            return;
        };
        let two = estimates(["fmu-truth", "fmu-nav"].map(fmu), "two.csv", what, how).unwrap();
        assert_eq!(three.lines().count(), rows + 1, "{what:?}");
        assert!(three == two, "{what:?} {how:?}");
    }
}

#[test]
fn the_twins_keep_states_and_refuse_what_is_wrong() {
    let twins = [twin("fmu-truth"), twin("fmu-nav")];
    if let Some(out) = script("twins", "twin.py", &twins.each_ref().map(|path| text(path))) {
        assert_eq!(out.lines().count(), 4, "{out}");
    }
}

/// A mission inside makes a twin another FMU, too: its token fits, and it runs that mission for as long as it lasts.
#[test]
fn fmpy_runs_a_twin_packed_with_a_mission() {
    let folder = tempfile::tempdir().unwrap();
    let mission = root().join("missions/fast_approach.toml");
    trade_harness::pack::pack(root(), folder.path(), Some(&mission), true).unwrap();
    let alone = |test: &str, fmu: &Path, output: &str| script(test, "alone.py", &[text(fmu), output]);
    let at = trade_harness::pack::fmi3::folder(folder.path()).join("fmu-truth.fmu");
    if let Some(three) = alone("packed twin", &at, "truth.r_tc_n") {
        let two = alone("packed", &folder.path().join("fmu-truth.fmu"), "truth.r_tc_n[1]").unwrap();
        let first = two.split_whitespace().nth(1).unwrap();
        assert!(three.starts_with(&format!("truth.r_tc_n [{first}, ")), "{three} {two}");
    }
}

type Row = HashMap<String, String>;

/// Vectors of an estimate: the FMU's name, and name and unit in the harness's column.
type Names = &'static [(&'static str, &'static str, &'static str)];

/// Drives `filter` from FMPy with each scheme, step and stop time, and compares every sample with the harness.
///
/// * `world`: option and value that choose it, the same in both programs.
fn same_bits_from_both_masters(world: [&str; 2], filter: &str, samples: usize, names: Names, ways: &[[&str; 3]]) {
    let folder = tempfile::tempdir().unwrap();
    let reference = folder.path().join("harness.csv");
    let chosen = ["--filters", filter, "--run", "3", "--seed", "7"];
    harness_ok(&[&["replay", "--out", text(&reference)], &world[..], &chosen[..]].concat());
    let reference = read_csv(&reference);
    assert_eq!(reference.len(), samples);
    let (truth, nav) = (fmu("fmu-truth"), fmu("fmu-nav"));
    for [scheme, step, stop] in ways {
        let out = folder.path().join(format!("{scheme}-{step}.csv"));
        let fmus = ["--truth", text(&truth), "--nav", text(&nav), "--out", text(&out)];
        let what = ["--filter", filter, "--run", "3", "--seed", "7"];
        let how = ["--scheme", scheme, "--step", step, "--stop", stop];
        if script(
            "coupling",
            "couple.py",
            &[&fmus[..], &world[..], &what[..], &how[..]].concat(),
        )
        .is_none()
        {
            return;
        }
        let rows = read_csv(&out);
        // A master that hands over one step late sees the last sample only after the end.
        let late = usize::from(*scheme == "jacobi");
        let taken = reference
            .iter()
            .filter(|r| r["t_s"].parse::<f64>().unwrap() <= stop.parse().unwrap());
        assert_eq!(rows.len(), taken.count() - late, "{scheme} {step}");
        same_bits(&rows, &reference, names, &format!("{filter} {scheme} {step}"));
    }
}

/// Compares what another master wrote with a replay, sample by sample.
fn same_bits(rows: &[Row], reference: &[Row], names: Names, what: &str) {
    for (row, expected) in rows.iter().zip(reference) {
        assert_eq!(row["est.count"], expected["sample"]);
        for (theirs, ours, unit) in names {
            for (i, axis) in ["x", "y", "z"].iter().enumerate() {
                let theirs: f64 = row[&format!("{theirs}[{}]", i + 1)].parse().unwrap();
                let ours: f64 = expected[&format!("{ours}_{axis}_{unit}")].parse().unwrap();
                let sample = &row["est.count"];
                assert_eq!(theirs.to_bits(), ours.to_bits(), "{what}: sample {sample}");
            }
        }
    }
}

/// Another master, another language, either scheme and several communication steps: the same bits for each sample.
#[test]
fn fmpy_couples_them_to_the_same_bits_as_the_harness() {
    let names: Names = &[
        ("est.r_tc_n", "est_pos", "m"),
        ("est.v_tc_n", "est_vel", "m_s"),
        ("est.a_t_n", "est_acc", "m_s2"),
        ("est.b_c_bc", "est_bias", "m_s2"),
    ];
    let ways = [
        ["gauss-seidel", "1", "5680"],
        ["gauss-seidel", "0.25", "700"],
        ["gauss-seidel", "0.1", "400"],
        ["jacobi", "1", "700"],
        ["jacobi", "0.25", "400"],
    ];
    same_bits_from_both_masters(["--scenario", "leo_venting"], "milton", 5680, names, &ways);
}

/// The same where other sensors are wired: the relative state measured in full, the target's orbit, a learning network.
#[test]
fn fmpy_couples_the_formation_to_the_same_bits_as_the_harness() {
    let names: Names = &[
        ("est.rho_lvlh", "est_pos", "m"),
        ("est.rho_dot_lvlh", "est_vel", "m_s"),
        ("est.d_lvlh", "est_acc", "m_s2"),
    ];
    for filter in ["rbfnn_aekf", "observer", "ekf_j2"] {
        let ways = [
            ["gauss-seidel", "1", "700"],
            ["gauss-seidel", "0.25", "200"],
            ["jacobi", "0.5", "300"],
        ];
        same_bits_from_both_masters(["--scenario", "formation"], filter, 21939, names, &ways);
    }
}

/// And in a mission that is a file, with a camera, a radio link, and samples of either at periods of their own.
#[test]
fn fmpy_couples_a_mission_from_a_file_to_the_same_bits_as_the_harness() {
    let names: Names = &[("est.r_tc_n", "est_pos", "m"), ("est.v_tc_n", "est_vel", "m_s")];
    let mission = root().join("missions/lunar_inspection.toml");
    let ways = [
        ["gauss-seidel", "2", "600"],
        ["gauss-seidel", "0.5", "200"],
        ["jacobi", "1", "200"],
    ];
    same_bits_from_both_masters(["--mission", text(&mission)], "snc", 7070, names, &ways);
}

/// The SSP that `pack` writes, as it is: its master hands over one step late, so the last sample is not seen.
#[test]
fn fmpy_simulates_the_system_structure_to_the_same_bits_as_the_harness() {
    let inertial: Names = &[
        ("est.r_tc_n", "est_pos", "m"),
        ("est.v_tc_n", "est_vel", "m_s"),
        ("est.b_c_bc", "est_bias", "m_s2"),
    ];
    let lvlh: Names = &[("est.rho_lvlh", "est_pos", "m"), ("est.rho_dot_lvlh", "est_vel", "m_s")];
    let folder = tempfile::tempdir().unwrap();
    let ssp = fmu("fmu-nav").with_file_name("relative-navigation.ssp");
    for (mission, names, step, stop, samples) in [
        ("leo_venting", inertial, "1", "400", 399),
        ("leo_venting", inertial, "0.25", "100", 99),
        ("formation", lvlh, "1", "300", 299),
    ] {
        let reference = folder.path().join(format!("{mission}.csv"));
        let chosen = [
            "--scenario",
            mission,
            "--filters",
            "hybrid",
            "--run",
            "3",
            "--seed",
            "1",
        ];
        harness_ok(&[&["replay", "--out", text(&reference)], &chosen[..]].concat());
        let out = folder.path().join(format!("{mission}-{step}.csv"));
        let arguments = [text(&ssp), mission, "3", step, stop, text(&out)];
        if script("system structure", "packed_ssp.py", &arguments).is_none() {
            return;
        }
        let rows = read_csv(&out);
        assert_eq!(rows.len(), samples, "{mission} {step}");
        same_bits(&rows, &read_csv(&reference), names, &format!("{mission} {step}"));
    }
}
