//! Filters that crash, loop, exit, eat memory and talk nonsense: each costs its own runs, is named with what it did, and takes
//! nothing else along.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{c_library, harness, harness_ok, read_csv, results};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

const RUNS: usize = 3;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Packs the filter; `None` without a C compiler.
fn nasty(folder: &Path) -> Option<PathBuf> {
    let library = c_library(folder, "nasty", include_str!("nasty/nasty.c"), &["-lm"], "isolation")?;
    let scalar = |name: &str, reference: u32, causality: &str, kind: &str| {
        let variability = if causality == "parameter" { "fixed" } else { "discrete" };
        let start = if causality == "output" { "" } else { " start=\"0\"" };
        format!(
            "<ScalarVariable name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" \
             variability=\"{variability}\"><{kind}{start}/></ScalarVariable>\n"
        )
    };
    let mut variables = scalar("deed", 0, "parameter", "Integer")
        + &scalar("sample_count", 1, "input", "Integer")
        + &scalar("est.count", 1, "output", "Integer")
        + &scalar("status", 2, "output", "Integer")
        + &scalar("sample_time", 0, "input", "Real")
        + &scalar("est.time", 0, "output", "Real");
    for (first, name) in [(1, "est.r_tc_n"), (4, "est.v_tc_n"), (7, "a_cmd_c_n")] {
        for element in 0..3 {
            variables += &scalar(&format!("{name}[{}]", element + 1), first + element, "output", "Real");
        }
    }
    let description = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"2.0\" modelName=\"nasty\" \
         guid=\"nasty\"><CoSimulation modelIdentifier=\"nasty\" canHandleVariableCommunicationStepSize=\"true\"/>\
         <ModelVariables>{variables}</ModelVariables><ModelStructure/></fmiModelDescription>"
    );
    let path = folder.join("nasty.fmu");
    let mut zip = zip::ZipWriter::new(File::create(&path).unwrap());
    let library = std::fs::read(library).unwrap();
    let binary = format!("binaries/{}/nasty.so", fmi2_import::PLATFORM);
    for (name, bytes) in [
        ("modelDescription.xml", description.as_bytes()),
        (binary.as_str(), &library),
    ] {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap();
    Some(path)
}

#[test]
fn whatever_a_filter_does_costs_its_own_runs_alone() {
    let folder = tempfile::tempdir().unwrap();
    let Some(fmu) = nasty(folder.path()) else { return };
    let study = ["compare", "--filters", "snc,fixed_q", "--runs", &RUNS.to_string()].map(str::to_owned);
    let study: Vec<&str> = study.iter().map(String::as_str).collect();
    let alone = folder.path().join("alone");
    harness_ok(&[&study[..], &["--out", text(&alone)]].concat());
    let ours = |out: &Path| -> Vec<_> {
        let rows = read_csv(&out.join("runs.csv"));
        rows.into_iter()
            .filter(|row| row["filter"] != "nasty")
            .map(|row| row.into_iter().collect::<std::collections::BTreeMap<_, _>>())
            .collect()
    };
    let expected = ours(&alone);
    assert_eq!(expected.len(), 2 * RUNS);
    // Deed, and what the message of each run must name; none for one that does no harm.
    let deeds: [(i32, &[&str]); 21] = [
        (1, &["signal 11", "segmentation fault", "about to touch"]),
        (2, &["signal 6", "abort"]),
        (3, &["exit code 0"]),
        (4, &["did not come back within 2 s"]),
        (5, &["did not come back within 2 s"]),
        (6, &["signal 6", "memory limit 512 MiB"]),
        (7, &["NaN"]),
        (8, &[]),
        (9, &[]),
        (10, &["signal 11"]),
        (11, &[]),
        (12, &["gave up at step 100"]),
        (13, &["beyond repair at step 100"]),
        (14, &["Discard"]),
        (15, &[]),
        (16, &[]),
        (17, &[]),
        (18, &[]),
        (19, &["ended"]),
        (20, &["exit code 0"]),
        (21, &["stack overflow"]),
    ];
    for (deed, says) in deeds {
        let out = folder.path().join(format!("deed{deed}"));
        let (filter, set) = (format!("nasty={}", text(&fmu)), format!("nasty.deed={deed}"));
        // Short for those that never come back; the others, and ours, may be kept waiting by the machine.
        let limit = if matches!(deed, 4 | 5) { "2" } else { "60" };
        let more = [
            "--nav",
            &filter,
            "--set",
            &set,
            "--call-limit",
            limit,
            "--memory-limit",
            "512",
            "--out",
            text(&out),
        ];
        let output = harness(&[&study[..], &more].concat());
        let (said, told) = (
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr),
        );
        // Every run of a filter failed: the study is done, and not well.
        let code = if says.is_empty() { 0 } else { 1 };
        assert_eq!(output.status.code(), Some(code), "deed {deed}: {told}");
        assert!(
            !said.contains("nonsense") && !said.contains("not for the table"),
            "{said}"
        );
        assert_eq!(ours(&out), expected, "deed {deed} has touched the others");
        // What an FMU has to say in a step is said once.
        let warned = told.matches("note: in run 0, nasty: ").count();
        assert_eq!(warned, usize::from((11..=13).contains(&deed)), "{told}");
        assert!(deed != 11 || told.contains("lacks conviction"), "{told}");
        let failures = read_csv(&out.join("failures.csv"));
        assert_eq!(
            failures.len(),
            if says.is_empty() { 0 } else { RUNS },
            "deed {deed}: {failures:?}"
        );
        for failure in &failures {
            assert_eq!(failure["filter"], "nasty");
            let message = &failure["message"];
            assert!(says.iter().all(|word| message.contains(word)), "deed {deed}: {message}");
        }
        assert!(!out.join(".unfinished").exists());
    }
}

#[test]
fn isolated_or_not_our_filters_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let study = [
        "compare",
        "--scenario",
        "leo_venting,formation",
        "--filters",
        "snc,fixed_q",
        "--runs",
        "4",
    ];
    let (here, there) = (folder.path().join("here"), folder.path().join("there"));
    harness_ok(&[&study[..], &["--out", text(&here)]].concat());
    harness_ok(&[&study[..], &["--isolate", "--out", text(&there)]].concat());
    assert!(results(&here) == results(&there), "bytes differ");
}

#[test]
fn a_driver_pushes_the_chaser_and_its_death_fails_the_run_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let Some(fmu) = nasty(folder.path()) else { return };
    let driver = format!("push={}", text(&fmu));
    let position = |name: &str, more: &[&str]| -> Vec<f64> {
        let out = folder.path().join(name);
        let line = ["replay", "--filters", "snc", "--out", text(&out)];
        harness_ok(&[&line[..], more].concat());
        let rows = read_csv(&out);
        let row = rows
            .iter()
            .find(|row| row["t_s"].parse::<f64>().unwrap() >= 60.0)
            .unwrap();
        ["x", "y", "z"]
            .map(|axis| row[&format!("truth_pos_{axis}_m")].parse().unwrap())
            .to_vec()
    };
    let (left, pushed) = (position("left.csv", &[]), position("pushed.csv", &["--drive", &driver]));
    for (left, pushed) in left.iter().zip(&pushed) {
        // 1 m/s2 on the chaser for 60 s, and what the gradient of gravity does meanwhile: of the order of n^2 t^2, 0.5 %.
        let expected = -0.5 * 60.0 * 60.0;
        assert!(((pushed - left) / expected - 1.0).abs() < 1e-2, "{left} {pushed}");
    }

    let out = folder.path().join("dies");
    let line = [
        "compare",
        "--filters",
        "snc,fixed_q",
        "--runs",
        "2",
        "--duration",
        "300",
        "--out",
        text(&out),
    ];
    let notes = |more: &[&str]| {
        let said = harness(&[&line[..], &["--force"], more].concat());
        let said = String::from_utf8(said.stderr).unwrap();
        said.lines()
            .filter(|line| line.contains("nothing feeds"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    // Where nobody commands there is nothing to be told of; of a driver that gives a part, one line for each filter says what is left.
    assert_eq!(notes(&[]), [""; 0]);
    let told = notes(&["--drive", &driver]);
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("snc: impulse_c_n[1], impulse_c_n[2]"), "{told:?}");

    let dies = ["--force", "--drive", &driver, "--set", "push.deed=1"];
    harness(&[&line[..], &dies].concat());
    let failures = read_csv(&out.join("failures.csv"));
    assert_eq!(failures.len(), 4, "{failures:?}");
    for failure in &failures {
        let message = &failure["message"];
        assert!(
            message.contains("signal 11") && message.contains("driver push"),
            "{message}"
        );
        assert_eq!(failure["case"], "deed-1_drive-push_duration-300");
    }
    let manifest = std::fs::read_to_string(out.join("manifest.json")).unwrap();
    assert!(
        manifest.contains("driven by push; all filters share each world"),
        "{manifest}"
    );
}
