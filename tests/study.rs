//! The harness as its user meets it: repeatable studies, failures that are counted, and mistakes on the command line.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{files, fmu, harness, harness_ok, read_csv, repacked, results};
use std::collections::BTreeMap;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

const STUDY: [&str; 7] = [
    "compare",
    "--filters",
    "fixed_q,milton@consistent",
    "--runs",
    "3",
    "--case",
    "tried",
];

#[test]
fn threads_repeats_and_masters_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let study = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        harness_ok(&[&STUDY, more, &["--out", text(&out)]].concat());
        results(&out)
    };
    let one = study("one", &["--jobs", "1"]);
    assert!(one.len() >= 5, "{:?}", one.keys());
    assert_eq!(study("two", &["--jobs", "2"]), one);
    // Into a folder that holds results already.
    assert_eq!(study("one", &["--jobs", "2"]), one);
    let every_epoch = |results: &BTreeMap<String, Vec<u8>>| {
        let mut kept = results.clone();
        kept.remove("manifest.json"); // tells step and scheme
        kept.remove("report.html"); // the same
        kept.remove("study.toml"); // the same
        kept
    };
    assert_eq!(
        every_epoch(&study("jacobi", &["--scheme", "jacobi"])),
        every_epoch(&one)
    );
    assert_eq!(every_epoch(&study("quarter", &["--step", "0.25"])), every_epoch(&one));
    assert_ne!(study("seed", &["--seed", "6"])["summary.csv"], one["summary.csv"]);
}

#[test]
fn a_varied_run_is_replayed_with_its_own_values() {
    let folder = tempfile::tempdir().unwrap();
    let study = |name: &str, jobs: &str| {
        let out = folder.path().join(name);
        let vary = [
            "--vary",
            "fmu-truth.vent.scale=loguniform:1:1000",
            "--jobs",
            jobs,
            "--out",
            text(&out),
        ];
        harness_ok(&[&STUDY, &vary[..]].concat());
        results(&out)
    };
    let one = study("one", "1");
    assert_eq!(study("two", "2"), one);
    let manifest = String::from_utf8(one["manifest.json"].clone()).unwrap();
    assert!(manifest.contains("\"vent.scale\":\"loguniform:1:1000\""), "{manifest}");

    let facts: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    let digest = |name: &str| facts["models"][name]["sha256"].as_str().unwrap().to_owned();
    for name in ["fmu-truth", "fmu-nav"] {
        let file = trade_harness::digest::of_file(&fmu(name)).unwrap();
        assert_eq!(digest(name), file, "{name}");
    }
    assert_ne!(digest("fmu-truth"), digest("fmu-nav"));

    // What is left to the mission stands there as the filter took it.
    let mission = std::fs::read_to_string(common::root().join("missions/leo_venting.toml")).unwrap();
    let stated = mission.lines().find_map(|line| line.strip_prefix("\"fixed_q.s\" = "));
    let stated: f64 = stated.unwrap().parse().unwrap();
    let filters = facts["studies"][0]["filters"].as_array().unwrap();
    let fixed = filters.iter().find(|filter| filter["filter"] == "fixed_q").unwrap();
    assert_eq!(fixed["calculated"]["resolved.fixed_q.s"], stated);
    assert_eq!(facts["studies"][0]["told"]["law"]["fixed_q.s"], stated);

    let runs = read_csv(&folder.path().join("one/runs.csv"));
    let row = runs
        .iter()
        .find(|r| r["filter"] == "fixed_q" && r["run"] == "2")
        .unwrap();
    let drawn = &row["fmu-truth.vent.scale"];
    let replayed = |vary: &[&str]| {
        let out = folder.path().join("replay.csv");
        let run = ["replay", "--filters", "fixed_q", "--run", "2", "--out", text(&out)];
        harness_ok(&[&run, vary].concat());
        let scored: Vec<f64> = read_csv(&out)
            .iter()
            .filter(|line| line["t_s"].parse::<f64>().unwrap() >= 300.0)
            .map(|line| ["r", "t", "n"].map(|axis| line[&format!("err_pos_{axis}_m")].parse::<f64>().unwrap().powi(2)))
            .map(|squares| squares.iter().sum())
            .collect();
        (scored.iter().sum::<f64>() / scored.len() as f64).sqrt()
    };
    let rmse: f64 = row["pos_rmse_m"].parse().unwrap();
    let same = replayed(&["--vary", "fmu-truth.vent.scale=loguniform:1:1000"]);
    assert!((same / rmse - 1.0).abs() < 1e-9, "{same} and {rmse}");
    let set = replayed(&["--set", &format!("fmu-truth.vent.scale={drawn}")]);
    assert!((set / rmse - 1.0).abs() < 1e-9, "{set} with {drawn} and {rmse}");
    assert!(
        (replayed(&[]) / rmse - 1.0).abs() > 1e-9,
        "the variation has changed nothing"
    );
}

/// What a sensor said is what it says of the truth, with its noise; and no file has a column that nothing documents.
#[test]
fn a_replay_holds_what_the_sensors_said_and_every_column_is_documented() {
    use trade_harness::report::{columns, histories::is_named};
    let folder = tempfile::tempdir().unwrap();
    let documented = |file: &str, path: &Path| {
        let all = columns::all();
        let ours = all
            .iter()
            .find(|own| own.file == file)
            .unwrap_or_else(|| panic!("{file}"));
        let header = csv::Reader::from_path(path).unwrap().headers().unwrap().clone();
        for name in &header {
            assert!(
                ours.columns.iter().any(|[own, ..]| is_named(own, name)),
                "{file}: {name}"
            );
        }
    };
    for (world, filters, set) in [
        ("leo_venting", "snc,milton", "fmu-truth.lidar.dropout_probability=0.2"),
        ("formation", "snc", "fmu-truth.metrology.dropout_probability=0.2"),
    ] {
        let out = folder.path().join(world);
        let what = ["--filters", filters, "--set", set, "--scenario", world];
        let runs = ["compare", "--runs", "2", "--duration", "500", "--out", text(&out)];
        harness_ok(&[&runs[..], &what[..]].concat());
        for (name, _) in results(&out).iter().filter(|(name, _)| name.ends_with(".csv")) {
            let file = name
                .split_once('/')
                .map_or(name.clone(), |(kind, _)| format!("{kind}/*.csv"));
            documented(&file, &out.join(name));
        }
        let replayed = folder.path().join("replay.csv");
        harness_ok(&["replay", text(&out), "--run", "1", "--out", text(&replayed)]);
        documented("replay.csv", &replayed);

        let number = |row: &std::collections::HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
        let (valid, first, sigma) = match world {
            "leo_venting" => ("meas_lidar_valid", "meas_lidar_range_m", 0.08),
            _ => ("meas_metrology_valid", "meas_metrology_rho_lvlh_1_m", 0.01),
        };
        let rows = read_csv(&replayed);
        let (seen, missed): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row[valid] == "1");
        assert!(missed.len() > rows.len() / 10 && missed.iter().all(|row| row[valid] == "0" && row[first].is_empty()));
        let squares = seen.iter().map(|row| {
            let position = ["x", "y", "z"].map(|axis| number(row, &format!("truth_pos_{axis}_m")));
            let predicted = match world {
                "leo_venting" => position.iter().map(|x| x * x).sum::<f64>().sqrt(),
                _ => position[0],
            };
            (number(row, first) - predicted).powi(2)
        });
        let deviation = (squares.sum::<f64>() / seen.len() as f64).sqrt();
        assert!((deviation / sigma - 1.0).abs() < 0.15, "{world}: {deviation}");
    }
}

/// A study is made again from its file and from its manifest, cases of a grid and all; another FMU or mission is told.
#[test]
fn a_study_is_made_again_to_the_last_byte_and_what_has_changed_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mission = at("mine.toml");
    std::fs::copy(common::root().join("missions/leo_venting.toml"), &mission).unwrap();
    let asked = format!(
        "mission = [{mission:?}]\nfilters = [\"snc\"]\nruns = 2\nduration_s = 500\n\
         vary = [\"fmu-truth.lidar.sigma_range=normal:0.1:0.01\"]\n\
         [[grid]]\nset = {{ \"fmu-truth.vent.scale\" = [1, 10], \"mission.vent.co2.period_s\" = [300] }}\n\
         [[phase]]\nname = \"end\"\nfrom_s = 400\nto_s = 500\n\
         [[requirement]]\nmetric = \"pos_rmse_m\"\nphase = \"end\"\nat_most = 100\n"
    );
    std::fs::write(at("asked.toml"), asked).unwrap();
    harness_ok(&["compare", "--study", text(&at("asked.toml")), "--out", text(&at("one"))]);
    let cases: Vec<String> = read_csv(&at("one/summary.csv"))
        .iter()
        .map(|row| row["case"].clone())
        .collect();
    assert_eq!(cases.len(), 2);
    assert_ne!(cases[0], cases[1]);
    assert_eq!(read_csv(&at("one/requirements.csv")).len(), 2);
    harness_ok(&[
        "compare",
        "--study",
        text(&at("one/study.toml")),
        "--out",
        text(&at("two")),
    ]);
    assert!(results(&at("one")) == results(&at("two")), "made again from its file");
    let told = harness_ok(&["rerun", text(&at("one")), "--jobs", "1"]);
    assert!(told.contains("not a byte different"), "{told}");
    assert!(results(&at("one")) == results(&at("one.rerun")));

    let changed = std::fs::read_to_string(&mission)
        .unwrap()
        .replace("period_s = ", "period_s = 1");
    std::fs::write(&mission, changed).unwrap();
    let refused = harness(&["rerun", text(&at("one")), "--out", text(&at("three"))]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(
        said.contains("mine.toml is another file") && said.contains("--other-files"),
        "{said}"
    );
    assert!(!at("three").exists());
}

/// A filter that no setting of a case concerns is run for the first alone; in a world that a mission file changes, too.
#[test]
fn what_cases_have_in_common_is_run_once_and_gives_what_it_gives_alone() {
    let folder = tempfile::tempdir().unwrap();
    let study = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let what = [
            "compare",
            "--filters",
            "snc,milton@consistent",
            "--runs",
            "2",
            "--duration",
            "600",
            "--set",
            "mission.vent.co2.period_s=300",
        ];
        harness_ok(&[&what, more, &["--out", text(&out)]].concat());
        results(&out)
    };
    let grid = study("grid", &["--grid", "fmu-nav.milton.m_b=20,30"]);
    let isolated = study("isolated", &["--grid", "fmu-nav.milton.m_b=20,30", "--isolate"]);
    let rows = read_csv(&folder.path().join("grid/timing.csv"));
    let time = |filter: &str, m_b: u32| {
        let case = format!("milton.m_b-{m_b}");
        let row = rows
            .iter()
            .find(|row| row["filter"] == filter && row["case"].contains(&case));
        row.unwrap()["nav_us_per_step"].clone()
    };
    assert_eq!(time("snc", 20), time("snc", 30), "measured once");
    assert_ne!(
        time("milton@consistent", 20),
        time("milton@consistent", 30),
        "measured twice"
    );

    let epochs = |results: &BTreeMap<String, Vec<u8>>, part: &str| -> Vec<Vec<u8>> {
        let of_part = results
            .iter()
            .filter(|(name, _)| name.starts_with("epochs") && name.contains(part));
        of_part.map(|(_, contents)| contents.clone()).collect()
    };
    for m_b in ["20", "30"] {
        let alone = study(m_b, &["--set", &format!("fmu-nav.milton.m_b={m_b}"), "--case", "alone"]);
        let case = epochs(&grid, &format!("m_b-{m_b}"));
        assert_eq!(case.len(), 2);
        assert!(case == epochs(&alone, "alone"), "m_b {m_b}");
        assert!(case == epochs(&isolated, &format!("m_b-{m_b}")), "m_b {m_b}");
    }
}

#[test]
fn a_filter_that_fails_is_counted_and_named_and_the_others_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let (alone, beside) = (folder.path().join("alone"), folder.path().join("beside"));
    let study = ["compare", "--filters", "fixed_q", "--runs", "2", "--seed", "9"];
    harness_ok(&[&study[..], &["--out", text(&alone)]].concat());
    let foreign = format!("broken={}", text(&fmu("fmu-nav")));
    let broken = [
        "--nav",
        &foreign,
        "--set",
        "broken.p0.sigma_position=1e200",
        "--out",
        text(&beside),
    ];
    let output = harness(&[&study[..], &broken].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    // A filter that failed every run makes an exit code of its own.
    assert_eq!(output.status.code(), Some(1), "{said}");
    for run in ["seed 9 run 0", "seed 9 run 1"] {
        assert!(
            said.lines().any(|line| line.contains("broken") && line.contains(run)),
            "{said}"
        );
    }
    let rows = read_csv(&beside.join("summary.csv"));
    let columns =
        |row: usize| ["filter", "runs", "failed", "diverged", "pos_rmse_m"].map(|name| rows[row][name].as_str());
    assert_eq!(columns(1), ["broken", "2", "2", "0", ""]);
    assert_eq!(columns(0)[..4], ["fixed_q", "2", "0", "0"]);
    assert_eq!(
        rows[0],
        read_csv(&alone.join("summary.csv"))[0],
        "a failing neighbour changes nothing"
    );
    let failures = read_csv(&beside.join("failures.csv"));
    let told: Vec<_> = failures
        .iter()
        .map(|f| [&f["filter"], &f["study_seed"], &f["run"]].map(String::as_str))
        .collect();
    assert_eq!(told, [["broken", "9", "0"], ["broken", "9", "1"]]);
    assert!(
        failures[0]["message"].contains("not positive definite"),
        "{}",
        failures[0]["message"]
    );
}

/// A world that breaks takes every filter of its run along, and the study still ends in a table.
#[test]
fn a_world_that_fails_is_counted_for_each_filter() {
    let folder = tempfile::tempdir().unwrap();
    let burn = ["start=100", "duration=10", "a_t_n[1]=1e300"].map(|set| format!("fmu-truth.target_burn.{set}"));
    let burn = ["--set", &burn[0], "--set", &burn[1], "--set", &burn[2]];
    let study = [
        "compare",
        "--filters",
        "fixed_q,milton",
        "--runs",
        "2",
        "--out",
        text(folder.path()),
    ];
    let output = harness(&[&study[..], &burn].concat());
    let (table, told) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        table.contains("milton") && told.contains("none of its 2 runs has a result"),
        "{table}{told}"
    );
    for row in read_csv(&folder.path().join("summary.csv")) {
        assert_eq!([&row["runs"], &row["failed"]], ["2", "2"]);
    }
    let failures = read_csv(&folder.path().join("failures.csv"));
    assert_eq!(failures.len(), 4);
    assert!(
        failures.iter().all(|f| f["message"].contains("no longer finite")),
        "{failures:?}"
    );
}

/// New contents for an entry of an archive, or `None` to leave it out.
type Edit<'a> = dyn Fn(&str, Vec<u8>) -> Option<Vec<u8>> + 'a;

/// Arguments, and what the message must hold.
type Mistake<'a> = (&'a [&'a str], &'a [&'a str]);

#[test]
fn mistakes_on_the_command_line_are_told_and_leave_earlier_results_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    harness_ok(&["compare", "--filters", "fixed_q", "--runs", "1", "--out", text(&out)]);
    let before = files(&out);

    let nav = fmu("fmu-nav");
    let broken = |name: &str, edit: &Edit<'_>| {
        let path = folder.path().join(name);
        repacked(&nav, &path, edit);
        format!("x={}", text(&path))
    };
    let is_library = |name: &str| name.starts_with("binaries/");
    let no_binary = broken("no-binary.fmu", &|name, bytes| (!is_library(name)).then_some(bytes));
    let no_library = broken("no-library.fmu", &|name, bytes| {
        Some(if is_library(name) { vec![7; 99] } else { bytes })
    });
    let no_xml = broken("no-xml.fmu", &|name, bytes| {
        (name != "modelDescription.xml").then_some(bytes)
    });
    let bad_xml = broken("bad-xml.fmu", &|name, bytes| {
        let half = bytes.len() / 2;
        Some(if name == "modelDescription.xml" {
            bytes[..half].to_vec()
        } else {
            bytes
        })
    });
    let cut = folder.path().join("cut.fmu");
    let bytes = std::fs::read(&nav).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let cut = format!("x={}", text(&cut));

    let mistakes: [Mistake<'_>; 30] = [
        (
            &["--set", "fmu-truth.lidar.sigma_rnge=1"],
            &["fmu-truth", "lidar.sigma_rnge", "did you mean \"lidar.sigma_range\""],
        ),
        (
            &["--set", "fmu-nav.fixed_q.S=1"],
            &["fmu-nav", "fixed_q.S", "did you mean \"fixed_q.s\""],
        ),
        (&["--set", "fmu-sea.x=1"], &["fmu-sea", "fmu-truth, fmu-nav"]),
        (
            &["--set", "fmu-truth.target_burn.start=-1"],
            &["fmu-truth", "target_burn.start", "-1", "minimum is 0 s"],
        ),
        (
            &["--set", "fmu-truth.lidar.sigma_range=-2"],
            &["fmu-truth", "lidar.sigma_range", "-2", "minimum is -1 m"],
        ),
        (
            &["--set", "fmu-truth.lidar.sigma_range=inf"],
            &["fmu-truth", "lidar.sigma_range", "inf", "finite"],
        ),
        (
            &["--set", "fmu-nav.r.sigma_range=0"],
            &["snc", "r.sigma_range", "0.0 m must be greater than 0"],
        ),
        (&["--set", "fmu-nav.est.time=0"], &["fmu-nav.est.time", "output"]),
        (
            &["--vary", "fmu-truth.vent.scale=uniform:2:1"],
            &["--vary", "range 2 to 1 is empty"],
        ),
        (
            &["--vary", "fmu-truth.vent.sclae=uniform:1:2"],
            &["vent.sclae", "did you mean \"vent.scale\""],
        ),
        (
            &["--vary", "fmu-truth.vent.scale=uniform:-1:2"],
            &["fmu-truth", "vent.scale", "-1", "minimum is 0"],
        ),
        (
            &["--vary", "fmu-nav.milton.m_b=uniform:1:2"],
            &["fmu-nav.milton.m_b", "Integer", "Real"],
        ),
        (
            &[
                "--set",
                "fmu-truth.vent.scale=1",
                "--vary",
                "fmu-truth.vent.scale=uniform:1:2",
            ],
            &["fmu-truth.vent.scale", "set as well"],
        ),
        (
            &["--scenario", "formation,leo_venting", "--filters", "observer"],
            &["'observer'", "'leo_venting'", "measurement of the whole state"],
        ),
        (&["--filters", "kalman"], &["kalman", "fixed_q, "]),
        (&["--filters", "milton@papr"], &["milton", "papr", "consistent"]),
        (&["--scenario", "moon"], &["moon", "leo_venting"]),
        (&["--scenario", "leo_venting,leo_venting"], &["'leo_venting'", "twice"]),
        (&["--step", "0"], &["step of 0 s"]),
        (&["--step", "-1"], &["-1"]),
        (&["--step", "nan"], &["NaN"]),
        (&["--nav", "x=missing.fmu"], &["missing.fmu", "check the path"]),
        (&["--nav", &cut], &["cut.fmu", "zip"]),
        (&["--nav", &no_binary], &["no-binary.fmu", "binaries/", "no platform"]),
        (&["--nav", &no_library], &["no-library.fmu", "cannot load"]),
        (&["--nav", &no_xml], &["no-xml.fmu", "modelDescription.xml"]),
        (&["--nav", &bad_xml], &["bad-xml.fmu", "modelDescription.xml", "line"]),
        (&["--truth", text(&nav)], &["truth.r_tc_n", "--map"]),
        (&["--fmu-dir", "nowhere"], &["nowhere", "pack"]),
        (&["--runs", "0"], &["--runs"]),
    ];
    for (arguments, says) in mistakes {
        let output = harness(&[&["compare", "--out", text(&out)], arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        for part in says {
            assert!(said.contains(part), "{arguments:?}: '{part}' is missing in: {said}");
        }
        assert!(files(&out) == before, "{arguments:?} touched earlier results");
    }

    // A place that takes no files: a file in the way, and a folder below one.
    let file = out.join("summary.csv");
    for place in [file.clone(), file.join("deeper")] {
        let output = harness(&["compare", "--filters", "fixed_q", "--runs", "1", "--out", text(&place)]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(text(&place)), "{said}");
        assert!(files(&out) == before);
    }
}
