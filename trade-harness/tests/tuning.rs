//! Searches over mock filters whose best parameter is known, and what a search keeps of their runs.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod mocks;

use mocks::{BEST_GAIN, Quirk, SIGMA, noise, spec};
use serde_json::json;
use study::{Quantity, Study, Summary, evaluate};
use trade_harness::report::best::{self, Entry, Ranking};
use trade_harness::report::searched;
use trade_harness::tuning::contender::Contender;
use trade_harness::tuning::notes::notes;
use trade_harness::tuning::ranges::Axis;
use trade_harness::tuning::standing::{Limits, Objective};
use trade_harness::tuning::study::{Evaluation, Options, Searched, Tuning};

const RUNS: u32 = 6;

/// A study keeps every sample, a tally only sums; both must say the same of the same runs.
#[test]
fn a_tally_says_what_a_study_says() {
    let quirks = [
        ("good", Quirk::None),
        ("failing", Quirk::Fails { run: 3, time: 30.0 }),
        ("says", Quirk::SaysDiverged { run: 1 }),
        ("lost", Quirk::Lost { run: 4 }),
        ("broken", Quirk::BrokenCovariance { run: 2 }),
        ("nan", Quirk::NotFinite { run: 5 }),
        ("bare", Quirk::Bare),
    ];
    let study = Study {
        spec: spec(Quirk::None, &quirks),
        runs: RUNS,
        jobs: 2,
        case: "nominal".to_owned(),
    };
    let filters = study.run(study::Engine::default(), |_, _| ()).unwrap().filters;
    let mut runs = 0;
    let tallies = evaluate(&study.spec, RUNS, 2, || runs += 1);
    assert_eq!(runs, RUNS);
    for (tally, filter) in tallies.iter().zip(&filters) {
        let row = Summary::new("mock", "nominal", filter);
        assert_eq!(
            (tally.failed as usize, tally.diverged as usize),
            (row.failed, row.diverged),
            "{}",
            row.filter
        );
        for (ours, theirs) in [
            (tally.rmse(Quantity::Position), row.position.rmse),
            (tally.rmse(Quantity::Velocity), row.velocity.rmse),
            (tally.rmse(Quantity::Acceleration), row.acceleration.rmse),
            (tally.nees6(), row.nees6.mean),
        ] {
            assert_eq!(ours.is_some(), theirs.is_some(), "{}", row.filter);
            // Only the order of the sums differs.
            let (ours, theirs) = (ours.unwrap_or(1.0), theirs.unwrap_or(1.0));
            assert!((ours / theirs - 1.0).abs() < 1e-12, "{}: {ours} {theirs}", row.filter);
        }
    }
    let bad: Vec<u32> = tallies.iter().map(|t| t.bad_runs).collect();
    assert_eq!(bad, [0, 1, 1, 1, 1, 1, 0]);
}

fn gain(low: f64, high: f64) -> Vec<Axis> {
    vec![Axis {
        variable: "gain".to_owned(),
        low,
        high,
        start: None,
    }]
}

fn options(limits: Limits, jobs: usize) -> Options {
    Options {
        objective: Objective::Position,
        limits,
        evaluations: 32,
        runs: RUNS,
        jobs,
    }
}

/// A search of these mocks, each over its axes.
fn tuning(filters: &[(&str, Quirk)], axes: Vec<Vec<Axis>>, options: Options) -> Tuning {
    let spec = spec(Quirk::None, filters);
    let contenders = spec.filters.iter().cloned().zip(axes);
    let contenders = contenders.map(|(base, axes)| Contender::foreign(base, axes)).collect();
    Tuning::new(spec, contenders, options)
}

fn tuned(filters: &[(&str, Quirk)], axes: Vec<Vec<Axis>>, limits: Limits, jobs: usize) -> Tuning {
    let mut tuning = tuning(filters, axes, options(limits, jobs));
    let (work, mut done) = (tuning.work(), 0);
    while tuning.round(|n| done += n) {}
    assert_eq!(done, work);
    tuning
}

/// Mean NEES of the mock with a gain at its best: errors of known size over a claimed sigma.
fn least_nees() -> f64 {
    let mut squares = Vec::new();
    for run in 0..RUNS as i32 {
        for count in 11..=40 {
            squares.extend((0..3).map(|axis| (noise(run, count, axis) / SIGMA).powi(2)));
        }
    }
    squares.iter().sum::<f64>() / squares.len() as f64
}

#[test]
fn every_filter_gets_its_best_gain_for_the_same_number_of_evaluations() {
    let limits = Limits::new(0.5, 1e3).unwrap();
    let filters = [
        ("wide", Quirk::Tunable),
        ("plain", Quirk::None),
        ("short", Quirk::Tunable),
    ];
    let axes = || vec![gain(1e-7, 1e1), Vec::new(), gain(1e-2, 1e1)];
    let tuning = tuned(&filters, axes(), limits, 2);
    let [wide, plain, short] = tuning.filters.as_slice() else {
        unreachable!()
    };
    assert_eq!([wide, plain, short].map(|f| f.evaluations.len()), [32, 0, 32]);
    assert!(plain.best().is_none());
    let best = |f: &Searched| f.best().unwrap().values.as_ref().unwrap()[0];
    // Five per cent of eight decades; the objective is flat at its best.
    assert!((best(wide) / BEST_GAIN).log10().abs() < 0.2, "{}", best(wide));
    assert!(wide.best().unwrap().standing.feasible());
    assert!(notes(wide, &options(limits, 2)).is_empty());
    assert_eq!(notes(plain, &options(limits, 2)), ["nothing to tune"]);
    assert_eq!(
        notes(short, &options(limits, 2))[0],
        "gain is at the low edge of its range"
    );
    // The best lies outside this range, so its low edge is the best of it.
    assert_eq!(short.contender.axes[0].edge(best(short)), Some("low"));
    assert_eq!(
        wide.evaluations[0].values, None,
        "the starting point is among the candidates"
    );
    let value = |e: &Evaluation| e.standing.objective;
    let early = wide.evaluations[..24].iter().map(value).fold(f64::INFINITY, f64::min);
    assert!((wide.late_gain() - (1.0 - value(wide.best().unwrap()) / early)).abs() < 1e-12);

    let file =
        |t: &Tuning| searched::render([("mock", t.filters.as_slice())].into_iter(), Objective::Position).unwrap();
    let text = String::from_utf8(file(&tuning)).unwrap();
    assert_eq!(text.lines().count(), 1 + 64, "{text}");
    for jobs in [1, 5] {
        assert_eq!(
            file(&tuned(&filters, axes(), limits, jobs)),
            file(&tuning),
            "{jobs} threads"
        );
    }
}

/// The least error has too small a NEES, so the best allowed gain is where the NEES just reaches the limit.
#[test]
fn a_limit_of_the_nees_is_kept_where_it_costs_accuracy() {
    let least = least_nees();
    let limits = Limits::new(4.0 * least, 1e3).unwrap();
    let tuning = tuned(&[("a", Quirk::Tunable)], vec![gain(1e-7, 1e1)], limits, 2);
    let best = tuning.filters[0].best().unwrap();
    assert!(best.standing.feasible());
    // NEES goes with the square of the error: a factor of 2 on the error, as a decade away from the best gain.
    let nees = best.tally.nees6().unwrap() / least;
    assert!((4.0..4.4).contains(&nees), "{nees}");
    let decades = (best.values.as_ref().unwrap()[0] / BEST_GAIN).log10().abs();
    assert!((1.0..1.05).contains(&decades), "{decades}");
}

#[test]
fn filters_are_ranked_and_sorted_by_the_objective() {
    let quirks = [
        ("lost", Quirk::Lost { run: 1 }),
        ("good", Quirk::None),
        ("same", Quirk::None),
        ("never", Quirk::WrongTag),
    ];
    let study = Study {
        spec: spec(Quirk::None, &quirks),
        runs: 2,
        jobs: 1,
        case: "nominal".to_owned(),
    };
    let filters = study.run(study::Engine::default(), |_, _| ()).unwrap().filters;
    let mut rows: Vec<_> = filters
        .iter()
        .rev()
        .map(|f| Summary::new("mock", "nominal", f))
        .collect();
    rows.push(Summary {
        filter: "told".to_owned(),
        bound: true,
        ..rows[1].clone()
    });
    let entries = rows.iter().map(|best| Entry {
        best,
        given: Some(&rows[1]),
        timing: None,
        tuned: "a|b=1".to_owned(),
        notes: vec!["first".to_owned(), "second".to_owned()],
    });
    let ranking = Ranking::new(entries.collect(), Objective::Position);
    let labels: Vec<_> = ranking.entries.iter().map(|e| e.best.filter.as_str()).collect();
    assert_eq!(labels, ["same", "good", "lost", "never", "told"]);
    let text = String::from_utf8(best::render(std::slice::from_ref(&ranking)).unwrap()).unwrap();
    let cells = |line: &str, columns: &[&str]| {
        let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let at = |name: &&str| names.iter().position(|n| n == name).unwrap();
        let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        columns.iter().map(|c| cells[at(c)].clone()).collect::<Vec<_>>()
    };
    // Equals share a place, the third is third; no estimate, no place, and none for a bound.
    let places: Vec<_> = text.lines().skip(1).map(|l| cells(l, &["rank"]).join("/")).collect();
    assert_eq!(places, ["1", "1", "3", "", ""]);
    assert!(text.contains("first; second"), "{text}");
    assert!(
        ranking.render_wide().contains("told: a|b=1; bound, told by the truth"),
        "{}",
        ranking.render_wide()
    );
    assert!(ranking.markdown().contains("a\\|b=1"), "{}", ranking.markdown());
    assert!(
        ranking.render_wide().contains("never: a|b=1; first; second"),
        "{}",
        ranking.render_wide()
    );
    // What programs are told is what stands in the file.
    let told = ranking.told();
    assert_eq!((&told[0]["filter"], &told[2]["rank"]), (&json!("same"), &json!(3)));
    let rmse: f64 = cells(text.lines().nth(1).unwrap(), &["pos_rmse_m"])[0].parse().unwrap();
    assert_eq!(told[0]["pos_rmse_m"], json!(rmse));
}

#[test]
fn the_table_of_the_best_fits_a_terminal_of_80_columns() {
    let label = "constrained_q@full-tuned-once-more";
    let mut best = Summary {
        filter: label.to_owned(),
        failed: 10_000,
        diverged: 10_000,
        ..Summary::default()
    };
    for errors in [&mut best.position, &mut best.velocity, &mut best.acceleration] {
        errors.rmse = Some(1.2345e-5);
    }
    best.nees.mean = Some(1.2345e-5);
    let entry = Entry {
        best: &best,
        given: Some(&best),
        timing: None,
        tuned: "constrained_q.lower=1.234e-5 ".repeat(5),
        notes: vec!["something that takes many words to say ".repeat(5)],
    };
    let ranking = Ranking::new(vec![entry], Objective::Position);
    for text in [&ranking.render(), best::LEGEND] {
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }
    // Nothing is lost: the whole name stands below, and every column in the wide table.
    let words = ranking.render().split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(label) && words.contains("untuned 1.234e-5"), "{words}");
    assert!(ranking.render_wide().contains("[us/step]") && ranking.render_wide().contains(label));
}

#[test]
fn a_search_without_a_covariance_or_without_success_says_so() {
    let limits = Limits::new(1e-9, 2e-9).unwrap();
    let filters = [("bare", Quirk::Bare), ("good", Quirk::None)];
    // Neither has the parameter, so every candidate but the first fails.
    let tuning = tuned(&filters, vec![gain(0.1, 1.0), gain(0.1, 1.0)], limits, 2);
    let said: Vec<_> = tuning
        .filters
        .iter()
        .map(|f| notes(f, &options(limits, 2)).join("; "))
        .collect();
    let given = "no candidate was better than the given values; ";
    let reasons = [
        "no covariance, so the NEES limits do not apply",
        "no candidate was without bad runs and within the NEES limits",
    ];
    assert_eq!(said, reasons.map(|reason| format!("{given}{reason}")));
    assert_eq!(tuning.filters[0].evaluations[1].tally.failed, RUNS);
}

/// A filter that fails is not one that lacks what it is tuned by.
#[test]
fn a_search_in_which_everything_fails_says_so() {
    let limits = Limits::new(0.5, 1e3).unwrap();
    let tuning = tuned(&[("never", Quirk::WrongTag)], vec![gain(1e-4, 1.0)], limits, 2);
    assert_eq!(
        notes(&tuning.filters[0], &options(limits, 2)),
        ["every run of every candidate failed: see search.csv"]
    );
}

#[test]
fn what_cannot_be_had_leaves_the_filter_as_given() {
    let options = Options {
        objective: Objective::Acceleration,
        evaluations: 5,
        ..options(Limits::new(0.5, 1e3).unwrap(), 1)
    };
    let mut tuning = tuning(&[("six", Quirk::Tunable)], vec![gain(1e-4, 1.0)], options);
    while tuning.round(|_| ()) {}
    assert!(tuning.filters[0].late_gain() <= 0.0);
    assert_eq!(notes(&tuning.filters[0], &options), ["no acceleration to tune by"]);
    let best = tuning.filters[0].best().unwrap();
    assert_eq!(best.values, None);
    assert!(!best.standing.feasible() && best.standing.objective.is_infinite());
}
