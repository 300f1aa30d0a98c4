//! `tune` as its user meets it: a search, its judgement, what compare makes of it, and mistakes on the command line.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{fmu, harness, harness_ok, read_csv, repacked};
use std::collections::HashMap;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

type Row = HashMap<String, String>;

fn number(row: &Row, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column}: {:?}", row[column]))
}

fn of<'a>(rows: &'a [Row], filter: &str) -> &'a Row {
    rows.iter().find(|r| r["filter"] == filter).unwrap()
}

/// One search of two filters of ours and of a stranger, which is fmu-nav under another name and brings its ranges along;
/// what is set is not searched.
#[test]
fn a_search_is_judged_apart_and_compare_repeats_the_judgement() {
    let folder = tempfile::tempdir().unwrap();
    let (out, again, compared) = (
        folder.path().join("a"),
        folder.path().join("b"),
        folder.path().join("c"),
    );
    // A stranger is one filter and all its ranges are searched, so it brings those of the filter alone that it is.
    let theirs = folder.path().join("theirs.fmu");
    repacked(&fmu("fmu-nav"), &theirs, |name, bytes| {
        if name != "modelDescription.xml" {
            return Some(bytes);
        }
        let kept = |line: &&str| {
            let own = ["fixed_q.s", "snc.q"]
                .iter()
                .any(|v| line.contains(&format!("\"{v}\"")));
            own || !line.contains("<Search ")
        };
        let xml = String::from_utf8(bytes).unwrap();
        Some(xml.lines().filter(kept).collect::<Vec<_>>().join("\n").into_bytes())
    });
    let foreign = format!("theirs={}", text(&theirs));
    let tune = |out: &Path, jobs: &str| {
        let search = [
            "--runs",
            "2",
            "--evaluations",
            "10",
            "--judge-runs",
            "2",
            "--range",
            "fmu-nav.snc.q=1e-6:1e-4",
        ];
        let filters = [
            "tune",
            "--filters",
            "fixed_q@small,snc",
            "--nav",
            &foreign,
            "--range",
            "theirs.snc.q=1e-6:1e-4",
        ];
        let set = [
            "--set",
            "fmu-truth.vent.scale=2",
            "--set",
            "theirs.filter=snc",
            "--set",
            "theirs.fixed_q.s=1e-6",
        ];
        harness_ok(&[&filters[..], &search, &set, &["--jobs", jobs, "--out", text(out)]].concat())
    };
    let table = tune(&out, "2");
    assert!(
        table.contains("fixed_q@small-tuned") && table.contains("snc.q="),
        "{table}"
    );

    // On the worlds of the search the winner is no worse than what it started from.
    let search = read_csv(&out.join("search.csv"));
    assert_eq!(search.len(), 3 * 10);
    for filter in ["fixed_q@small", "snc", "theirs"] {
        let own: Vec<&Row> = search.iter().filter(|r| r["filter"] == filter).collect();
        assert_eq!(own.len(), 10, "{filter}");
        assert_eq!(own[0]["values"], "");
        let feasible = own.iter().filter(|r| r["feasible"] == "1");
        let least = feasible.map(|r| number(r, "value")).fold(f64::INFINITY, f64::min);
        let sets: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("tuned.json")).unwrap()).unwrap();
        let name = filter.split('@').next().unwrap();
        let set = sets["sets"]
            .as_array()
            .unwrap()
            .iter()
            .find(|s| s["filter"] == name)
            .unwrap();
        assert_eq!(set["feasible"], true, "{filter}");
        assert!(
            (set["search_objective"].as_f64().unwrap() - least).abs() <= 1e-15,
            "{filter}"
        );
        assert!(
            own[0]["feasible"] == "0" || least <= number(own[0], "value"),
            "{filter}"
        );
    }

    // The judged worlds are those of compare, and its tuned filters those of the search.
    let filters = "fixed_q@small,fixed_q@small-tuned,snc,snc@tuned,theirs@tuned";
    let tuned = out.join("tuned.json");
    let set = [
        "--set",
        "fmu-truth.vent.scale=2",
        "--set",
        "theirs.filter=snc",
        "--set",
        "theirs.fixed_q.s=1e-6",
    ];
    let study = [
        "compare",
        "--filters",
        filters,
        "--nav",
        &foreign,
        "--runs",
        "2",
        "--tuned",
        text(&tuned),
    ];
    harness_ok(&[&study[..], &set, &["--out", text(&compared)]].concat());
    for file in ["summary.csv", "runs.csv", "paired.csv"] {
        let both = [&out, &compared].map(|folder| std::fs::read(folder.join(file)).unwrap());
        assert_eq!(both[0], both[1], "{file}");
    }
    let summary = read_csv(&out.join("summary.csv"));
    let best = read_csv(&out.join("best.csv"));
    let labels: Vec<&str> = best.iter().map(|r| r["filter"].as_str()).collect();
    assert_eq!(labels.len(), 3);
    for row in &best {
        assert_eq!(row["pos_rmse_m"], of(&summary, &row["filter"])["pos_rmse_m"]);
        let better = best
            .iter()
            .filter(|o| number(o, "pos_rmse_m") < number(row, "pos_rmse_m"))
            .count();
        assert_eq!(row["rank"], (better + 1).to_string());
    }
    // The stranger is our filter under another name, so its search ends at the same place.
    let stranger = of(&best, "theirs@tuned");
    for column in ["pos_rmse_m", "rank", "given", "nees"] {
        assert_eq!(stranger[column], of(&best, "snc@tuned")[column]);
    }
    assert!(stranger["tuned"].contains("snc.q="), "{stranger:?}");
    assert_eq!(of(&best, "snc@tuned")["given"], of(&summary, "snc")["pos_rmse_m"]);
    assert!(
        best.is_sorted_by(|a, b| number(a, "pos_rmse_m") <= number(b, "pos_rmse_m")),
        "{labels:?}"
    );
    assert!(
        std::fs::read_to_string(out.join("best.md"))
            .unwrap()
            .contains("| snc@tuned |")
    );

    tune(&again, "1");
    for file in ["search.csv", "tuned.json", "summary.csv", "best.csv"] {
        let both = [&out, &again].map(|folder| std::fs::read(folder.join(file)).unwrap());
        assert_eq!(both[0], both[1], "{file} with another number of threads");
    }
}

#[test]
fn a_filter_with_nothing_to_tune_is_judged_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let tune = [
        "tune",
        "--filters",
        "fixed_q",
        "--set",
        "fmu-nav.fixed_q.s=1e-7",
        "--judge-runs",
        "1",
    ];
    let table = harness_ok(&[&tune[..], &["--out", text(folder.path())]].concat());
    assert!(table.contains("fixed_q: nothing to tune"), "{table}");
    assert_eq!(read_csv(&folder.path().join("search.csv")).len(), 0);
    assert_eq!(read_csv(&folder.path().join("summary.csv")).len(), 1);

    // What each run draws would replace what the search tries, so it is not searched either.
    let folder = tempfile::tempdir().unwrap();
    let tune = [
        "tune",
        "--filters",
        "fixed_q",
        "--vary",
        "fmu-nav.fixed_q.s=loguniform:1e-8:1e-6",
        "--judge-runs",
        "1",
    ];
    let told = harness_ok(&[&tune[..], &["--json", "--out", text(folder.path())]].concat());
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    let ranking = &told["ranking"][0];
    assert_eq!(
        (&ranking["scenario"], &ranking["objective"]),
        (&"leo_venting".into(), &"position".into())
    );
    let best = &read_csv(&folder.path().join("best.csv"))[0];
    for column in ["filter", "notes"] {
        assert_eq!(ranking["filters"][0][column], *best[column], "{column}");
    }
    assert_eq!(ranking["filters"][0]["pos_rmse_m"], number(best, "pos_rmse_m"));
    assert_eq!(read_csv(&folder.path().join("search.csv")).len(), 0);
}

/// `all` is every filter, each once, whatever is named beside it.
#[test]
fn all_filters_are_searched_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let few = ["--evaluations", "1", "--runs", "1", "--judge-runs", "1"];
    harness_ok(
        &[
            &["tune", "--filters", "snc,all", "--out", text(folder.path())][..],
            &few,
        ]
        .concat(),
    );
    let rows = read_csv(&folder.path().join("search.csv"));
    let searched: Vec<&str> = rows.iter().map(|row| row["filter"].as_str()).collect();
    let once = |label: &str| searched.iter().filter(|found| **found == label).count() == 1;
    assert!(
        ["snc", "dmc", "milton", "rbfnn_ekf"].into_iter().all(once),
        "{searched:?}"
    );
}

/// Arguments, and what the message must hold.
type Mistake<'a> = (&'a [&'a str], &'a [&'a str]);

#[test]
fn mistakes_are_told_before_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let no_json = folder.path().join("notes.json");
    std::fs::write(&no_json, "[]").unwrap();
    let range = |text: &'static str| ["--range", text];
    let mistakes: [Mistake<'_>; 21] = [
        (
            &range("fmu-nav.snc.q=1e-3:1e-6"),
            &["fmu-nav.snc.q", "0.001", "0.000001", "0 < LOW < HIGH"],
        ),
        (&range("fmu-nav.snc.q=1e-3:1e-3"), &["fmu-nav.snc.q", "LOW < HIGH"]),
        (&range("fmu-nav.snc.q=0:1"), &["fmu-nav.snc.q", "0 < LOW"]),
        (&range("fmu-nav.snc.q=1:inf"), &["fmu-nav.snc.q", "inf"]),
        (&range("fmu-nav.snc.q=1e-3"), &["LOW:HIGH"]),
        (
            &range("fmu-nav.snc.qq=1:2"),
            &["fmu-nav", "snc.qq", "did you mean \"snc.q\""],
        ),
        (
            &range("fmu-nav.est.time=1:2"),
            &["fmu-nav.est.time", "causality 'output'", "only parameters"],
        ),
        (
            &range("fmu-nav.chaser.q_coupled=1:2"),
            &["fmu-nav.chaser.q_coupled", "Boolean", "Real parameters"],
        ),
        (
            &range("fmu-nav.milton.r_w=1:2"),
            &["fmu-nav.milton.r_w", "no filter of this study", "fixed_q, snc"],
        ),
        (
            &range("fmu-truth.vent.scale=1:2"),
            &["fmu-truth.vent.scale", "no filter of this study"],
        ),
        (&range("fmu-sea.x=1:2"), &["fmu-sea", "fmu-truth, fmu-nav"]),
        (
            &["--range", "fmu-nav.snc.q=1:2", "--range", "fmu-nav.snc.q=1:3"],
            &["two ranges for fmu-nav.snc.q"],
        ),
        (
            &["--range", "fmu-nav.snc.q=1:2", "--set", "fmu-nav.snc.q=1"],
            &["fmu-nav.snc.q", "--set and in --range"],
        ),
        (
            &["--range", "fmu-nav.snc.q=1:2", "--vary", "fmu-nav.snc.q=loguniform:1:2"],
            &["fmu-nav.snc.q", "--vary and in --range"],
        ),
        (
            &["--scenario", "leo_venting,formation,leo_venting"],
            &["'leo_venting'", "twice"],
        ),
        (&["--seed", "1"], &["--seed and --judge-seed are both 1"]),
        (&["--nees-min", "3"], &["NEES limits of 3 to 2"]),
        (&["--nees-min", "-1"], &["NEES limits of -1 to 2"]),
        (&["--filters", "snc,snc@paper"], &["snc@tuned", "twice"]),
        (&["--tuned", text(&no_json)], &["notes.json", "no tuned sets"]),
        (&["--filters", "snc@tuned"], &["snc", "no preset 'tuned'", "paper"]),
    ];
    for (arguments, says) in mistakes {
        let filters: &[&str] = if arguments[0] == "--filters" {
            &[]
        } else {
            &["--filters", "fixed_q,snc"]
        };
        let output = harness(&[&["tune", "--out", text(&out)], filters, arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        for part in says {
            assert!(said.contains(part), "{arguments:?}: '{part}' is missing in: {said}");
        }
        assert!(!out.join("search.csv").exists(), "{arguments:?}");
    }
}
