//! `regret` as its user meets it: levels and constants of their own, what is kept, and mistakes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{harness, harness_ok, read_csv, root};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

const LEVELS: &str = r#"
[[level]]
name = "as_it_is"
[[level]]
name = "strong"
missions = ["leo_venting"]
set = ["fmu-truth.vent.scale=100"]
[[level]]
name = "elsewhere"
missions = ["nrho_venting"]
[[fixed]]
filter = "snc"
values = { q = [1e-7, 3e-5, 1e-3] }
[[bound]]
filter = "clairvoyant"
values = { q = [1e-8] }
[[bound]]
filter = "times_known"
values = { q_active = [3e-4, 1e-2] }
"#;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// `hybrid` at these levels.
fn line<'a>(levels: &'a Path, out: &'a Path, runs: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let line = [
        "regret",
        "--levels",
        text(levels),
        "--filters",
        "hybrid",
        "--runs",
        runs,
        "--out",
        text(out),
    ];
    [&line[..], more].concat()
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column}: {:?}", row[column]))
}

#[test]
fn laws_are_held_against_the_best_constant_of_each_level() {
    let folder = tempfile::tempdir().unwrap();
    let (levels, out) = (folder.path().join("levels.toml"), folder.path().join("out"));
    std::fs::write(&levels, LEVELS).unwrap();
    let line =
        |runs, more: &[&'static str]| line(&levels, &out, runs, &[&["--scouts", "2", "--seed", "7"], more].concat());
    let table = harness_ok(&line("5", &[]));
    assert!(
        table.contains("hybrid")
            && table
                .lines()
                .take_while(|l| !l.is_empty())
                .all(|l| l.chars().count() <= 80)
    );
    let rows = read_csv(&out.join("regret.csv"));
    for (level, q) in [("as_it_is", "snc(q=3e-5)"), ("strong", "snc(q=1e-3)")] {
        let own: Vec<_> = rows.iter().filter(|r| r["level"] == level).collect();
        let law = own.iter().find(|r| r["filter"] == "hybrid").unwrap();
        // The quietest is dishonest where vents are strong, and the loudest far off where they are not.
        assert_eq!((law["pos_best"].as_str(), law["kind"].as_str()), (q, "law"), "{level}");
        let best = own.iter().find(|r| r["filter"] == q).unwrap();
        assert_eq!(number(best, "pos_ratio").to_bits(), 1.0_f64.to_bits());
        let ratio = number(law, "pos_rmse_m") / number(best, "pos_rmse_m");
        assert!((number(law, "pos_ratio") / ratio - 1.0).abs() < 1e-12);
        assert!(number(law, "pos_ratio_low") <= ratio && ratio <= number(law, "pos_ratio_high"));
    }
    assert!(rows.iter().all(|r| r["level"] != "elsewhere"));
    // Who is told everything errs as where nothing is pushed hard; who is told when, less than who is not.
    let bound = |level: &str, of: &str, column: &str| {
        let own = rows
            .iter()
            .filter(|r| r["level"] == level && r["kind"] == "bound" && r["family"] == of);
        let shown: Vec<f64> = own
            .filter(|r| !r["pos_ratio"].is_empty())
            .map(|r| number(r, column))
            .collect();
        assert_eq!(shown.len(), 1, "{level}: the best of a family alone has a ratio");
        shown[0]
    };
    let [calm, strong] = ["as_it_is", "strong"].map(|level| bound(level, "clairvoyant", "pos_rmse_m"));
    // Strong vents drive the target some tenths further away.
    assert!((strong / calm - 1.0).abs() < 0.2, "{calm} and {strong} m");
    let [clairvoyant, times_known] = ["clairvoyant", "times_known"].map(|of| bound("strong", of, "pos_ratio"));
    assert!(
        clairvoyant < times_known && times_known < 0.9,
        "{clairvoyant} and {times_known}"
    );
    assert!(
        table.contains("clairvoyant *") && table.contains("times_known *"),
        "{table}"
    );
    for file in [
        "regret.md",
        "report.html",
        "figures/leo_venting_regret.svg",
        "figures/leo_venting_regret.png",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }

    // What is through is not run again, and not mixed with anything else.
    let kept = out.join("trials/leo_venting_strong.json");
    let (before, csv) = (
        std::fs::metadata(&kept).unwrap(),
        std::fs::read(out.join("regret.csv")).unwrap(),
    );
    harness_ok(&line("5", &["--jobs", "1"]));
    assert_eq!(
        before.modified().unwrap(),
        std::fs::metadata(&kept).unwrap().modified().unwrap()
    );
    assert_eq!(csv, std::fs::read(out.join("regret.csv")).unwrap());
    let refused = harness(&line("6", &[]));
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && told.contains("--force"), "{told}");
    harness_ok(&line("6", &["--force", "--at", "strong"]));
    assert!(
        read_csv(&out.join("regret.csv"))
            .iter()
            .all(|r| r["runs"] == "6" && r["level"] == "strong")
    );
}

/// The file that draws ten thousand runs from the levels does not drift away from them.
#[test]
fn the_study_of_ten_thousand_runs_flies_every_level_of_the_venting_missions() {
    let number = |value: &str| value.parse::<f64>().unwrap().to_bits();
    let levels: toml::Table = harness_ok(&["regret", "--print-levels"]).parse().unwrap();
    let mut tried = BTreeMap::new();
    for level in levels["level"].as_array().unwrap() {
        let is_for = |mission| level["missions"].as_array().unwrap().contains(&mission);
        if is_for("leo_venting".into()) && is_for("nrho_venting".into()) {
            let set = level
                .get("set")
                .and_then(toml::Value::as_array)
                .cloned()
                .unwrap_or_default();
            let set = set.iter().map(|text| text.as_str().unwrap().split_once('=').unwrap());
            let set: BTreeMap<String, u64> = set.map(|(name, value)| (name.to_owned(), number(value))).collect();
            tried.insert(level["name"].as_str().unwrap().to_owned(), set);
        }
    }
    let file = std::fs::read_to_string(root().join("studies/hybrid_ten_thousand_runs.toml")).unwrap();
    let study: toml::Table = file.parse().unwrap();
    let mut flown = BTreeMap::new();
    for case in study["grid"][0]["cases"].as_array().unwrap() {
        let mut set = case.as_table().unwrap().clone();
        let name = set.remove("case").unwrap();
        let set = set.into_iter().map(|(name, value)| (name, number(&value.to_string())));
        flown.insert(name.as_str().unwrap().to_owned(), set.collect());
    }
    assert_eq!(flown, tried);
    let missions = study["scenario"].as_array().unwrap().len();
    assert!(study["runs"].as_integer().unwrap() as usize * flown.len() * missions >= 10_000);
}

#[test]
fn mistakes_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let (levels, out) = (folder.path().join("levels.toml"), folder.path().join("out"));
    for (from, to, says) in [
        ("snc", "sncc", "sncc"),
        ("q = [1e-7", "q = [-3.0", "snc.q"),
        ("q = [1e-7", "r = [1e-7", "snc.r"),
        ("vent.scale=100", "vent.size=100", "vent.size"),
        ("[[fixed]]", "[[fix]]", "levels.toml"),
    ] {
        std::fs::write(&levels, LEVELS.replace(from, to)).unwrap();
        let refused = harness(&line(&levels, &out, "5", &[]));
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && told.contains(says), "{to}: {told}");
    }
    let refused = harness(&["regret", "--at", "never", "--out", text(&out)]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && told.contains("vents_10"), "{told}");
}
