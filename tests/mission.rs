//! Missions as their author meets them: a file written, checked, flown, packed; and what is wrong with one.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{fmu, harness, harness_ok, program, read_csv, root};
use std::path::Path;
use std::process::Command;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Standard error of a call that must end with exit code 2.
fn refused(arguments: &[&str]) -> String {
    let output = harness(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    message
}

#[test]
fn a_new_mission_is_written_checked_and_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let wanted = [
        "mission",
        "new",
        "mine",
        "--from",
        "leo_venting",
        "--out",
        text(folder.path()),
    ];
    let new = |arguments: &[&str]| {
        Command::new(program())
            .args(arguments)
            .current_dir(root())
            .output()
            .unwrap()
    };
    let output = new(&wanted);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let file = folder.path().join("mine.toml");
    let written = std::fs::read_to_string(&file).unwrap();
    assert!(written.contains("name = \"mine\"") && written.contains("# the run ends with the rendezvous"));
    let shown = harness_ok(&["mission", "check", text(&file)]);
    for part in [
        "mine:",
        "burn capture",
        "vent co2: 9",
        "lidar: 5680 samples",
        "closest",
        "fine enough",
    ] {
        assert!(shown.contains(part), "{part:?} is missing in: {shown}");
    }
    let again = new(&wanted);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("exists already"));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), written, "nothing is lost");
    let schema = new(&["mission", "schema"]);
    let schema: serde_json::Value = serde_json::from_slice(&schema.stdout).unwrap();
    assert!(schema["properties"]["environment"].is_object());
}

#[test]
fn a_time_grid_that_is_too_coarse_is_told_with_a_better_one() {
    let output = harness(&[
        "mission",
        "check",
        "missions/elliptic_rendezvous.toml",
        "--set",
        "mission.time.grid_s=40.0",
    ]);
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1), "{shown}");
    assert!(shown.contains("too coarse: set time.grid_s to about"), "{shown}");
}

#[test]
fn mistakes_in_a_mission_file_end_with_file_line_and_what_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let leo = std::fs::read_to_string(root().join("missions/leo_venting.toml")).unwrap();
    for (from, to, says) in [
        (
            "grid_s = 1.0",
            "grid = 1.0",
            "unknown key `grid`, did you mean `grid_s`?",
        ),
        ("a_m = 6.878e6", "a_m = 6.0e6", "below the surface"),
        (
            "sigma_range_m = 0.08",
            "sigma_range_m = nan",
            "it must be a finite number",
        ),
        ("start_s = 5560.0", "start_s = 5660.0", "after the run"),
        ("mission = 1", "mission = 2", "newer format"),
        (
            "gravity = { model = \"zonal\", mu_m3_s2 = 3.986e14, radius_m = 6.378e6, j = [1.083e-3, -2.532e-6, -1.620e-6, -2.278e-7, 5.407e-7] }",
            "gravity = { model = \"harmonics\", file = \"none.csv\" }\nrotation = { rate_deg_s = 0.0 }",
            "none.csv",
        ),
    ] {
        let file = folder.path().join("wrong.toml");
        assert!(leo.contains(from), "{from}");
        std::fs::write(&file, leo.replacen(from, to, 1)).unwrap();
        for command in [
            &["mission", "check", text(&file)][..],
            &[
                "compare",
                "--runs",
                "1",
                "--mission",
                text(&file),
                "--out",
                text(&folder.path().join("out")),
            ],
        ] {
            let message = refused(command);
            assert!(message.contains(says), "{says:?} is missing in: {message}");
        }
    }
    let message = refused(&["mission", "check", "missions/none.toml"]);
    assert!(message.contains("missions/none.toml"), "{message}");
    let message = refused(&[
        "mission",
        "check",
        "leo_venting",
        "--set",
        "mission.vent.oxygen.count=2",
    ]);
    assert!(message.contains("co2, waste_water"), "{message}");
}

#[test]
fn a_key_set_on_the_command_line_reaches_both_fmus() {
    let folder = tempfile::tempdir().unwrap();
    let study = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let plain = ["compare", "--filters", "snc", "--runs", "1", "--out", text(&out)];
        harness_ok(&[&plain, more].concat());
        let rows = read_csv(&out.join("summary.csv"));
        (rows[0]["pos_rmse_m"].clone(), out)
    };
    let (plain, _) = study("plain", &[]);
    let (same, _) = study("same", &["--mission", "missions/leo_venting.toml"]);
    assert_eq!(plain, same, "a file is what the scenario is");
    let (set, out) = study("set", &["--set", "mission.navigation.law.snc.q=1e-3"]);
    let (tunable, _) = study("tunable", &["--set", "fmu-nav.snc.q=1e-3"]);
    assert_eq!(set, tunable, "the filter reads the changed mission");
    assert_ne!(set, plain);
    let written = std::fs::read_to_string(out.join("missions/leo_venting_navigation.law.snc.q-1e-3.toml")).unwrap();
    assert!(written.contains("\"snc.q\" = 1e-3"), "{written}");
    let (noisy, _) = study("noisy", &["--set", "mission.sensors.lidar.sigma_range_m=0.8"]);
    assert_ne!(noisy, plain, "the truth reads it");
    // What was run can be run again from its manifest.
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("manifest.json")).unwrap()).unwrap();
    let study = &manifest["studies"][0];
    assert_eq!(study["mission"]["navigation"]["law"]["snc.q"], 1e-3);
    assert!(
        study["plan"]["mission"][0]
            .as_str()
            .unwrap()
            .ends_with("leo_venting_navigation.law.snc.q-1e-3.toml")
    );
}

#[test]
fn an_fmu_packed_with_a_mission_runs_it_and_is_another_fmu() {
    use fmi2_import::Fmu;
    let folder = tempfile::tempdir().unwrap();
    trade_harness::pack::pack(
        root(),
        folder.path(),
        Some(&root().join("missions/lunar_inspection.toml")),
        true,
    )
    .unwrap();
    let packed = Fmu::open(folder.path().join("fmu-truth.fmu")).unwrap();
    let plain = Fmu::open(fmu("fmu-truth")).unwrap();
    assert_ne!(packed.description().guid, plain.description().guid);
    let range = |fmu: &Fmu, mission_file: Option<&str>| {
        let mut instance = fmu.instantiate("truth", false).unwrap();
        let reference = |name: &str| fmu.description().variable(name).unwrap().value_reference;
        if let Some(path) = mission_file {
            instance.set_string(&[reference("mission_file")], &[path]).unwrap();
        }
        instance
            .setup_experiment(&fmi2_import::Experiment {
                start_time: 0.0,
                stop_time: None,
                tolerance: None,
            })
            .unwrap();
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        let mut values = [0.0];
        instance.get_real(&[reference("truth.r_tc_n[1]")], &mut values).unwrap();
        values[0]
    };
    let lunar = range(&packed, None);
    assert!((lunar - range(&plain, Some("missions/lunar_inspection.toml"))).abs() < f64::MIN_POSITIVE);
    assert!(
        (range(&packed, Some("leo_venting.toml")) - range(&plain, None)).abs() < f64::MIN_POSITIVE,
        "shipped by name"
    );
}

/// Two gravity fields in files: the world's, and the one that a filter is told of.
#[test]
fn the_coefficient_files_of_a_mission_are_part_of_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let field = |name: &str, j2: &str| {
        let text = format!("mu_m3_s2 = 3.986e14\nradius_m = 6.378e6\ndegree,order,c,s\n2,0,{j2},0\n");
        std::fs::write(at(name), text).unwrap();
    };
    field("world.csv", "-4.84e-4");
    field("told.csv", "-4.8e-4");
    let leo = std::fs::read_to_string(root().join("missions/leo_venting.toml")).unwrap();
    let gravity =
        |file: &str| format!("gravity = {{ model = \"harmonics\", file = \"{file}\", degree = 2, order = 0 }}");
    let mut lines: Vec<String> = leo.lines().map(str::to_owned).collect();
    let mut files = ["world.csv", "told.csv"].into_iter();
    for line in lines.iter_mut().filter(|line| line.starts_with("gravity = ")) {
        *line = gravity(files.next().unwrap());
    }
    assert_eq!(files.next(), None, "a gravity of the world and one of the filters");
    let mission = at("fields.toml");
    let text_of = lines
        .join("\n")
        .replace("[environment]", "[environment]\nrotation = { rate_deg_s = 0.0 }");
    std::fs::write(&mission, text_of).unwrap();

    let study = |name: &str| -> serde_json::Value {
        let out = at(name);
        let what = ["compare", "--filters", "snc", "--runs", "1", "--duration", "400"];
        harness_ok(&[&what[..], &["--mission", text(&mission), "--out", text(&out)]].concat());
        serde_json::from_slice(&std::fs::read(out.join("manifest.json")).unwrap()).unwrap()
    };
    let guid = |name: &str| {
        trade_harness::pack::pack(root(), &at(name), Some(&mission), true).unwrap();
        let packed = fmi2_import::Fmu::open(at(name).join("fmu-nav.fmu")).unwrap();
        packed.description().guid.clone()
    };
    let (first, packed) = (study("first"), guid("packed"));
    for file in ["fields.toml", "world.csv", "told.csv"] {
        let digest = trade_harness::digest::of_file(&at(file)).unwrap();
        assert_eq!(first["inputs"][text(&at(file))], digest, "{file}");
    }
    assert_eq!(guid("again"), packed);
    field("told.csv", "-4.84e-4");
    assert_ne!(study("second")["identity"], first["identity"]);
    assert_ne!(guid("other"), packed);
    let message = refused(&["rerun", text(&at("first"))]);
    assert!(message.contains("told.csv is another file"), "{message}");
}

#[test]
fn both_fmus_refuse_a_mission_with_the_same_words_in_their_logs() {
    use fmi2_import::{Experiment, Fmu};
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.toml");
    let leo = std::fs::read_to_string(root().join("missions/leo_venting.toml")).unwrap();
    std::fs::write(&file, leo.replace("grid_s = 1.0", "grid = 1.0")).unwrap();
    let shown = refused(&["mission", "check", text(&file)]);
    let said = shown.trim().trim_start_matches("error: ");
    for name in ["fmu-truth", "fmu-nav"] {
        let fmu = Fmu::open(fmu(name)).unwrap();
        let mut instance = fmu.instantiate(name, false).unwrap();
        let reference = fmu.description().variable("mission_file").unwrap().value_reference;
        instance.set_string(&[reference], &[text(&file)]).unwrap();
        let experiment = Experiment {
            start_time: 0.0,
            stop_time: None,
            tolerance: None,
        };
        instance.setup_experiment(&experiment).unwrap();
        let error = instance.enter_initialization().unwrap_err().to_string();
        let log: Vec<String> = instance.messages().iter().map(|m| m.text.clone()).collect();
        assert!(
            error.contains(said) || log.iter().any(|line| line.contains(said)),
            "{said} / {error} / {log:?}"
        );
        // A reset brings it back.
        instance.reset().unwrap();
        instance.setup_experiment(&experiment).unwrap();
        instance.enter_initialization().unwrap();
    }
}
