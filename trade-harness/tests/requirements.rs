//! Phases, pairs, groups and requirements of mock studies whose errors are known.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod mocks;

use mocks::{Quirk, noise, spec};
use study::{
    Engine, Phase, PhaseSummary, Phases, Quantity, Requirement, Spec, Study, StudyResult, Summary, pairs, ranks,
};
use trade_harness::requirements::{Verdict, check, evaluate, render, render_csv};

const RUNS: i32 = 8;

fn study(spec: Spec) -> (Study, StudyResult) {
    let study = Study {
        spec,
        runs: RUNS as u32,
        jobs: 1,
        case: "nominal".to_owned(),
    };
    let result = study.run(Engine::default(), |_, _| ()).unwrap();
    (study, result)
}

/// With a phase of the last ten samples.
fn with_end(filters: &[(&str, Quirk)]) -> Spec {
    let spec = spec(Quirk::None, filters);
    let end = Phase {
        name: "end".to_owned(),
        from_s: Some(31.0),
        ..Phase::default()
    };
    let phases = Phases::new(&spec.world, &spec.truth, &[end]).unwrap();
    Spec { phases, ..spec }
}

fn squares(run: i32, counts: std::ops::RangeInclusive<i32>) -> Vec<f64> {
    counts
        .map(|count| (0..3).map(|axis| noise(run, count, axis).powi(2)).sum())
        .collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().sum::<f64>() / values.len() as f64).sqrt()
}

fn near(value: Option<f64>, expected: f64) {
    assert!(
        (value.unwrap() / expected - 1.0).abs() < 1e-7,
        "{value:?} instead of {expected}"
    );
}

fn requirement(text: &str) -> Requirement {
    serde_json::from_str(text).unwrap()
}

fn judged(required: &[Requirement], study: Study, result: StudyResult) -> Vec<Verdict> {
    let (studies, results) = ([study], [result]);
    let filters = &results[0].filters;
    let rows: Vec<Summary> = filters.iter().map(|f| Summary::new("mock", "nominal", f)).collect();
    let phases: Vec<PhaseSummary> = filters
        .iter()
        .flat_map(|f| PhaseSummary::of("mock", "nominal", f))
        .collect();
    evaluate(required, &studies, &results, &rows, &phases).unwrap()
}

#[test]
fn a_phase_is_scored_by_its_own_epochs() {
    let (_, result) = study(with_end(&[("good", Quirk::None)]));
    let phases = PhaseSummary::of("mock", "nominal", &result.filters[0]);
    let names: Vec<&str> = phases.iter().map(|p| p.phase.as_str()).collect();
    assert_eq!(names, ["scored", "vents", "quiet", "after_push", "calm", "end"]);
    let row = Summary::new("mock", "nominal", &result.filters[0]);
    near(phases[0].errors[0].rmse, row.position.rmse.unwrap());
    let end = &phases[5];
    let all: Vec<f64> = (0..RUNS).flat_map(|run| squares(run, 31..=40)).collect();
    near(end.errors[0].rmse, rms(&all));
    near(end.errors[0].largest, all.iter().copied().fold(0.0, f64::max).sqrt());
    near(
        end.errors[0].last,
        rms(&(0..RUNS).flat_map(|run| squares(run, 40..=40)).collect::<Vec<_>>()),
    );
    assert_eq!((end.present, end.samples), (8, 80));
    let [low, high] = end.errors[0].interval.unwrap();
    assert!(low < rms(&all) && rms(&all) < high);
    // Half of the norms lie below the median, to a bin.
    let [median, p95, p997] = end.errors[0].quantiles.map(Option::unwrap);
    let below = all.iter().filter(|square| square.sqrt() < median).count();
    assert!((39..=41).contains(&below) && median < p95 && p95 <= p997, "{below}");
}

#[test]
fn equals_share_a_group_and_runs_of_both_are_compared() {
    let failing = Quirk::Fails { run: 3, time: 20.0 };
    let (_, result) = study(spec(
        Quirk::None,
        &[("good", Quirk::None), ("failing", failing), ("twin", Quirk::None)],
    ));
    let found = pairs(&result.filters).unwrap();
    let position: Vec<_> = found.iter().filter(|p| p.quantity == Quantity::Position).collect();
    let places: Vec<_> = position
        .iter()
        .map(|p| (p.filter, p.reference, p.by_run.runs))
        .collect();
    assert_eq!(places, [(1, 0, 7), (2, 0, 8), (2, 1, 7)]);
    assert!(
        position
            .iter()
            .all(|p| p.difference.abs() < 1e-15 && p.interval == Some([0.0, 0.0]))
    );
    assert_eq!(ranks(&result.filters, Quantity::Position).unwrap(), [Some(1); 3]);
}

#[test]
fn a_bound_takes_no_part_in_the_groups() {
    let mut spec = spec(Quirk::None, &[("told", Quirk::None), ("good", Quirk::None)]);
    spec.filters[0].bound = true;
    let (_, result) = study(spec);
    assert_eq!(ranks(&result.filters, Quantity::Velocity).unwrap(), [None, Some(1)]);
}

#[test]
fn pooled_requirements_are_missed_by_failures_and_shares_count_them() {
    let failing = Quirk::Fails { run: 3, time: 20.0 };
    let per_run: Vec<f64> = (0..RUNS).map(|run| rms(&squares(run, 31..=40))).collect();
    let bound = 0.5 * (per_run.iter().copied().fold(0.0, f64::max) + rms(&squares(0, 31..=40)));
    let inside = |run: &i32| per_run[*run as usize] <= bound;
    let [good, of_failing] = [
        (0..RUNS).filter(inside).count() as u32,
        (0..RUNS).filter(|run| *run != 3 && inside(run)).count() as u32,
    ];
    let required = [
        requirement(r#"{"metric": "pos_rmse_m", "at_most": 100.0}"#),
        requirement(&format!(
            r#"{{"metric": "pos_rmse_m", "phase": "end", "at_most": {bound}, "share": 0.5}}"#
        )),
        requirement(r#"{"metric": "failed", "at_most": 1.0}"#),
        requirement(r#"{"metric": "pos_rmse_m", "at_least": 50.0, "filter": "good", "confidence": 0.95}"#),
    ];
    let (study, result) = study(with_end(&[("good", Quirk::None), ("failing", failing)]));
    let found = judged(&required, study, result);
    let met: Vec<bool> = found.iter().map(|v| v.met).collect();
    let half = |satisfied: u32| f64::from(satisfied) / 8.0 >= 0.5;
    assert_eq!(met, [true, false, half(good), half(of_failing), true, true, false]);
    assert_eq!(found[1].runs, [8, 1, 0]);
    assert!(found[1].margin.unwrap() > 90.0 && found[1].reason().contains("1 failed"));
    assert_eq!([found[2].satisfied, found[3].satisfied], [Some(good), Some(of_failing)]);
    near(found[2].value, f64::from(good) / 8.0);
    // 50 asked, about 1 found: farther off than 45, and 90 % of the bound.
    assert!(found[6].margin_percent().unwrap() < -90.0);
    let table = render(&found);
    assert!(
        table.contains("MISSED") && table.contains("pos_rmse_m at most 100"),
        "{table}"
    );
    assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    let csv = String::from_utf8(render_csv(&found).unwrap()).unwrap();
    assert_eq!(csv.lines().count(), 8);
}

#[test]
fn what_is_not_there_is_named_with_what_is() {
    let (study, _) = study(with_end(&[("good", Quirk::None)]));
    for (text, says) in [
        (r#"{"metric": "pos_rmse", "at_most": 1}"#, "pos_rmse_m"),
        (r#"{"metric": "filter", "at_most": 1}"#, "no metric 'filter'"),
        (
            r#"{"metric": "nees", "phase": "start", "at_most": 1}"#,
            "scored, vents, quiet, after_push, calm, end",
        ),
        (r#"{"metric": "nees", "filter": "ukf", "at_most": 1}"#, "only good"),
        (r#"{"metric": "pos_p95_m", "share": 0.9, "at_most": 1}"#, "pos_max_m"),
        (
            r#"{"metric": "pos_p95_m", "confidence": 0.9, "at_most": 1}"#,
            "confidence needs a share",
        ),
    ] {
        let error = check(&[requirement(text)], std::slice::from_ref(&study))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{text}: {error}");
    }
}
