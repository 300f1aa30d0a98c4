//! Whole studies of mock slaves whose errors are known: statistics, order, failures and foreign filters.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod mocks;

use cosim::Scheme;
use mocks::{Quirk, SIGMA, acceleration, driver, noise, spec, two_rates};
use study::{Distribution, FilterResult, Spec, Study, StudyError, Summary, Varied, rehearse};
use trade_harness::report::runs::{Named, render_failures, render_paired, render_runs};
use trade_harness::report::summary;
use trade_harness::report::{epochs, kept};

const RUNS: i32 = 8;

fn study(spec: Spec, jobs: usize) -> (Spec, Vec<FilterResult>) {
    let study = Study {
        spec,
        runs: RUNS as u32,
        jobs,
        case: "nominal".to_owned(),
    };
    let filters = study.run(study::Engine::default(), |_, _| ()).unwrap().filters;
    (study.spec, filters)
}

/// Every deterministic file of the study as one text.
fn files(spec: &Spec, filters: &[FilterResult]) -> String {
    let rows: Vec<Summary> = filters.iter().map(|f| Summary::new("mock", "nominal", f)).collect();
    let named = [Named {
        spec,
        case: "nominal",
        filters,
    }];
    let mut all = vec![
        summary::render(&rows).unwrap(),
        render_runs(&named).unwrap(),
        render_failures(&named).unwrap(),
        render_paired(&named).unwrap(),
    ];
    all.extend(filters.iter().map(|f| epochs::render(spec, f).unwrap()));
    String::from_utf8(all.concat()).unwrap()
}

fn row(filter: &FilterResult) -> Summary {
    Summary::new("mock", "nominal", filter)
}

/// The errors of these runs, from the formula of the mock, over the scored samples 11 to 40.
fn rms_norm(runs: impl Iterator<Item = i32>) -> f64 {
    let mut squares = Vec::new();
    for run in runs {
        for count in 11..=40 {
            squares.push((0..3).map(|axis| noise(run, count, axis).powi(2)).sum::<f64>());
        }
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn near(value: Option<f64>, expected: f64) {
    assert!(
        (value.unwrap() / expected - 1.0).abs() < 1e-7,
        "{value:?} instead of {expected}"
    );
}

#[test]
fn statistics_are_those_of_the_known_errors() {
    let (_, filters) = study(spec(Quirk::None, &[("good", Quirk::None)]), 2);
    let row = row(&filters[0]);
    assert_eq!((row.runs, row.failed, row.diverged), (8, 0, 0));
    near(row.position.rmse, rms_norm(0..RUNS));
    near(row.velocity.rmse, rms_norm(0..RUNS));
    // Six states of the same variance, position and velocity errors alike.
    near(row.nees.mean, 2.0 * rms_norm(0..RUNS).powi(2) / (SIGMA * SIGMA) / 6.0);
    // It has no other states.
    assert_eq!(row.nees6, row.nees);
    near(row.nis.mean, 2.0);
    let mut ratios: Vec<f64> = Vec::new();
    for count in 11..=40 {
        for axis in 0..3 {
            let second = (0..RUNS).map(|run| noise(run, count, axis).powi(2)).sum::<f64>() / f64::from(RUNS);
            ratios.push(SIGMA / second.sqrt());
        }
    }
    ratios.sort_by(f64::total_cmp);
    near(row.position.ratio, 0.5 * (ratios[44] + ratios[45]));
    assert_eq!(
        (row.acceleration.rmse, row.acceleration.ratio, row.nees_dimension),
        (None, None, Some(6))
    );
}

/// Mean squares of the known errors of each run on each axis, over the scored samples that `counts` keeps.
fn mean_squares(counts: impl Fn(&i32) -> bool) -> Vec<[f64; 3]> {
    let of = |run: i32| {
        [0, 1, 2].map(|axis| {
            let squares: Vec<f64> = (11..=40)
                .filter(&counts)
                .map(|count| noise(run, count, axis).powi(2))
                .collect();
            squares.iter().sum::<f64>() / squares.len() as f64
        })
    };
    (0..RUNS).map(of).collect()
}

/// Mean and standard error over the runs, by the textbook.
fn spread(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| v * v).sum::<f64>() / n - mean * mean;
    (mean, (variance / (n - 1.0)).sqrt())
}

#[test]
fn standard_errors_and_axes_are_those_of_the_known_errors() {
    let (_, filters) = study(spec(Quirk::None, &[("good", Quirk::None)]), 2);
    let row = row(&filters[0]);
    let runs = mean_squares(|_| true);
    let of_axis = |axis: usize| runs.iter().map(|r| r[axis]).collect::<Vec<_>>();
    for (axis, value) in [
        row.position.rmse_axes[0],
        row.position.rmse_axes[1],
        row.position.rmse_axes[2],
    ]
    .into_iter()
    .enumerate()
    {
        near(value, spread(&of_axis(axis)).0.sqrt());
    }
    near(row.velocity.rmse_axes[1], spread(&of_axis(1)).0.sqrt());
    let (mean, error) = spread(&runs.iter().map(|r| r.iter().sum()).collect::<Vec<f64>>());
    near(row.position.rmse_error, error / (2.0 * mean.sqrt()));
    near(row.velocity.rmse_error, error / (2.0 * mean.sqrt()));
    // Position and velocity errors alike over six states: two thirds of a squared error over three sigmas squared.
    near(row.nees.error, 2.0 * error / (SIGMA * SIGMA) / 6.0);
    assert_eq!((row.nis.error, row.acceleration.rmse_error), (Some(0.0), None));
    near(row.zero_acceleration_axes[1], acceleration(1));
    near(row.zero_acceleration, 1e-5 * 14.0_f64.sqrt());
}

#[test]
fn an_acceleration_beside_six_states_is_scored_where_the_filter_says_so() {
    let (_, filters) = study(spec(Quirk::None, &[("net", Quirk::EstimatesAcceleration)]), 1);
    let row = row(&filters[0]);
    let runs = mean_squares(|count| count % 2 == 1);
    let of_axis = |axis: usize| spread(&runs.iter().map(|r| r[axis]).collect::<Vec<_>>());
    near(row.acceleration.rmse_axes[2], 1e-6 * of_axis(2).0.sqrt());
    near(
        row.acceleration.rmse_error_axes[0],
        1e-6 * of_axis(0).1 / (2.0 * of_axis(0).0.sqrt()),
    );
    assert_eq!((row.acceleration.ratio, row.nees_dimension), (None, Some(6)));
    near(row.nees.mean, 2.0 * rms_norm(0..RUNS).powi(2) / (SIGMA * SIGMA) / 6.0);
}

#[test]
fn a_varied_parameter_is_one_draw_for_each_run_and_all_filters() {
    let varied = Varied {
        name: "factor".to_owned(),
        distribution: Distribution::Uniform(0.5, 2.0),
        draw: 0,
    };
    let mut s = spec(Quirk::None, &[("one", Quirk::Scaled), ("two", Quirk::Scaled)]);
    for filter in &mut s.filters {
        filter.varied.push(varied.clone());
    }
    let (s, filters) = study(s, 2);
    let mut factors = Vec::new();
    for run in 0..RUNS {
        let found = filters[0].runs[run as usize].rmse[0].unwrap();
        let factor = found / rms_norm(run..run + 1);
        assert!((factor / varied.value(s.seed, run as u32) - 1.0).abs() < 1e-9);
        assert!((0.5..2.0).contains(&factor) && filters[1].runs[run as usize].rmse[0] == Some(found));
        factors.push(factor.to_bits());
    }
    factors.dedup();
    assert_eq!(factors.len(), RUNS as usize);
}

#[test]
fn threads_scheme_and_step_change_no_byte() {
    let base = || {
        spec(
            Quirk::Drops,
            &[("good", Quirk::None), ("failing", Quirk::Fails { run: 3, time: 7.0 })],
        )
    };
    let (s, f) = study(base(), 1);
    let expected = files(&s, &f);
    assert!(expected.contains("out of cheese"));
    for jobs in [2, 5] {
        let (s, f) = study(base(), jobs);
        assert_eq!(files(&s, &f), expected, "{jobs} threads");
    }
    let healthy = || spec(Quirk::Drops, &[("good", Quirk::None), ("bare", Quirk::Bare)]);
    let (s, f) = study(healthy(), 2);
    let expected = files(&s, &f);
    for scheme in [Scheme::GaussSeidel, Scheme::Jacobi] {
        for step in [1.0, 0.25, 0.1] {
            let (s, f) = study(
                Spec {
                    scheme,
                    step,
                    ..healthy()
                },
                2,
            );
            assert_eq!(files(&s, &f), expected, "{scheme:?} at {step} s");
        }
    }
}

#[test]
fn a_long_step_scores_the_samples_that_are_left() {
    let (_, filters) = study(
        Spec {
            step: 4.0,
            ..spec(Quirk::None, &[("good", Quirk::None)])
        },
        1,
    );
    let runs = 0..RUNS;
    let squares: Vec<f64> = runs
        .flat_map(|run| {
            (12..=40)
                .step_by(4)
                .map(move |count| (0..3).map(|a| noise(run, count, a).powi(2)).sum())
        })
        .collect();
    near(
        row(&filters[0]).position.rmse,
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt(),
    );
}

/// A run that leaves the truth and then ends in an error has diverged, and has no part in the errors.
#[test]
fn a_run_that_is_lost_and_then_fails_counts_as_both() {
    let quirks = [
        ("lost", Quirk::LostThenFails { run: 3, time: 17.0 }),
        ("failing", Quirk::Fails { run: 3, time: 17.0 }),
    ];
    let (_, filters) = study(spec(Quirk::None, &quirks), 2);
    let [lost, failing] = [0, 1].map(|i| row(&filters[i]));
    assert_eq!(
        [(lost.failed, lost.diverged), (failing.failed, failing.diverged)],
        [(1, 1), (1, 0)]
    );
    near(lost.position.rmse, rms_norm((0..RUNS).filter(|r| *r != 3)));
}

#[test]
fn a_failed_run_is_counted_and_leaves_the_others_alone() {
    let quirks = [
        ("good", Quirk::None),
        ("failing", Quirk::Fails { run: 3, time: 7.0 }),
        ("nan", Quirk::NotFinite { run: 2 }),
        ("lying", Quirk::WrongTag),
    ];
    let (s, filters) = study(spec(Quirk::None, &quirks), 2);
    let [good, failing, nan, lying] = [0, 1, 2, 3].map(|i| row(&filters[i]));
    assert_eq!([good.failed, failing.failed, nan.failed, lying.failed], [0, 1, 1, 8]);
    assert_eq!([good.runs, failing.runs, nan.runs, lying.runs], [8; 4]);
    near(good.position.rmse, rms_norm(0..RUNS));
    near(failing.position.rmse, rms_norm((0..RUNS).filter(|r| *r != 3)));
    near(nan.position.rmse, rms_norm((0..RUNS).filter(|r| *r != 2)));
    assert_eq!(lying.position.rmse, None);

    let named = [Named {
        spec: &s,
        case: "nominal",
        filters: &filters,
    }];
    let failures = String::from_utf8(render_failures(&named).unwrap()).unwrap();
    let lines: Vec<&str> = failures.lines().collect();
    assert_eq!(lines.len(), 1 + 1 + 1 + 8, "{failures}");
    assert!(
        lines[1].starts_with("mock,failing,nominal,1,3,6.0,") && lines[1].contains("out of cheese"),
        "{failures}"
    );
    assert!(
        lines[2].starts_with("mock,nan,nominal,1,2,8.0,")
            && lines[2].contains("est.r_tc_n[1] is NaN in the estimate of sample 8 (8 s)"),
        "{failures}"
    );
    // Seven runs are left to compare with the first filter.
    let paired = String::from_utf8(render_paired(&named).unwrap()).unwrap();
    assert!(
        paired.contains("mock,failing,good,nominal,pos_rmse_m,7,0.0,0.0,0.0,0.0,0.0"),
        "{paired}"
    );
}

#[test]
fn a_failed_truth_fails_every_filter_of_that_run() {
    let (_, filters) = study(
        spec(
            Quirk::Fails { run: 5, time: 20.0 },
            &[("a", Quirk::None), ("b", Quirk::None)],
        ),
        2,
    );
    for filter in &filters {
        assert_eq!(filter.failed(), 1);
        let failure = filter.runs[5].failure.as_ref().unwrap();
        assert!(failure.message.contains("fmu-truth"), "{failure:?}");
        near(row(filter).position.rmse, rms_norm((0..RUNS).filter(|r| *r != 5)));
    }
}

/// Whatever a truth says that is none costs its run, by the variable that says it, and no other.
#[test]
fn a_truth_that_goes_wrong_fails_its_run_by_name() {
    let not_finite = |name| Quirk::NotFiniteTruth { run: 2, name };
    for (quirk, run, said) in [
        (
            not_finite("truth.r_tc_n[2]"),
            2,
            "truth.r_tc_n[2] is NaN at sample 9 (9 s)",
        ),
        (not_finite("truth.v_tc_n[3]"), 2, "truth.v_tc_n[3] is NaN at sample 9"),
        (not_finite("truth.a_t_n[1]"), 2, "truth.a_t_n[1] is NaN at sample 9"),
        (not_finite("truth.r_c_n[1]"), 2, "truth.r_c_n[1] is NaN at sample 9"),
        (not_finite("truth.v_c_n[2]"), 2, "truth.v_c_n[2] is NaN at sample 9"),
        (not_finite("sample_time"), 2, "NaN s"),
        (
            Quirk::Stalls { run: 1, after: 12 },
            1,
            "sample_count stayed at 12 from 12 s to the end at 40 s",
        ),
        (Quirk::Stalls { run: 0, after: 0 }, 0, "sample_count stayed at 0"),
    ] {
        let (_, filters) = study(spec(quirk, &[("a", Quirk::None), ("b", Quirk::None)]), 2);
        for filter in &filters {
            assert_eq!(filter.failed(), 1, "{quirk:?}");
            let failure = filter.runs[run].failure.as_ref().unwrap();
            assert!(failure.message.contains(said), "{quirk:?}: {failure:?}");
            near(
                row(filter).position.rmse,
                rms_norm((0..RUNS).filter(|r| *r != run as i32)),
            );
        }
    }
}

/// A covariance that is none is counted, and takes nothing else with it.
#[test]
fn a_covariance_that_is_none_above_its_diagonal_counts_against_its_filter() {
    let (_, filters) = study(
        spec(
            Quirk::None,
            &[("good", Quirk::None), ("above", Quirk::BrokenAbove { run: 4 })],
        ),
        2,
    );
    let [good, above] = [0, 1].map(|i| row(&filters[i]));
    assert_eq!((good.covariances_broken, above.covariances_broken), (0, 2));
    assert_eq!((good.failed, above.failed), (0, 0));
    near(above.position.rmse, rms_norm(0..RUNS));
    assert!(above.nees.mean.is_some() && above.nees.mean != good.nees.mean);
}

#[test]
fn diverged_runs_are_counted_and_stay_in_the_statistics() {
    let quirks = [("says", Quirk::SaysDiverged { run: 1 }), ("is", Quirk::Lost { run: 4 })];
    let (_, filters) = study(spec(Quirk::None, &quirks), 2);
    assert_eq!((row(&filters[0]).diverged, row(&filters[1]).diverged), (1, 1));
    assert!(filters[0].runs[1].diverged && filters[1].runs[4].diverged);
    near(row(&filters[0]).position.rmse, rms_norm(0..RUNS));
    assert!(row(&filters[1]).position.rmse.unwrap() > 200.0 / f64::from(RUNS).sqrt());
}

#[test]
fn dropped_samples_do_not_enter_the_nis() {
    let (_, filters) = study(spec(Quirk::Drops, &[("good", Quirk::None)]), 1);
    near(row(&filters[0]).nis.mean, 2.0);
}

#[test]
fn samples_that_a_filter_does_not_answer_are_counted() {
    for scheme in [Scheme::GaussSeidel, Scheme::Jacobi] {
        for step in [1.0, 0.25] {
            let filters = [("good", Quirk::None), ("naps", Quirk::Naps), ("drops", Quirk::Drops)];
            let s = Spec {
                scheme,
                step,
                ..spec(Quirk::None, &filters)
            };
            let (_, filters) = study(s, 2);
            let missing: Vec<u64> = filters.iter().map(|f| row(f).missing_epochs).collect();
            assert_eq!(missing, [0, 5 * u64::from(RUNS as u32), 0], "{scheme:?} at {step} s");
        }
    }
}

/// Samples are counted, epochs are times: what has no sample is left out, and a sample of any sensor counts.
#[test]
fn sensors_of_two_rates_are_scored_at_their_own_times() {
    let (s, filters) = study(
        spec(Quirk::TwoRates, &[("good", Quirk::TwoRates), ("bare", Quirk::Bare)]),
        2,
    );
    let times = two_rates(40);
    let scored = || (1..).zip(&times).filter(|(_, t)| **t >= 11);
    let squares: Vec<f64> = (0..RUNS)
        .flat_map(|run| scored().map(move |(count, _)| (0..3).map(|a| noise(run, count, a).powi(2)).sum()))
        .collect();
    for filter in &filters {
        assert_eq!(filter.failed(), 0, "{:?}", filter.runs[0].failure);
        let rmse = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        near(row(filter).position.rmse, rmse);
    }
    near(row(&filters[0]).nis.mean, 2.0);
    let text = String::from_utf8(epochs::render(&s, &filters[0]).unwrap()).unwrap();
    let shown: Vec<f64> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(shown, times.iter().map(|t| f64::from(*t)).collect::<Vec<_>>());
}

/// Of forty epochs each stretch has one or two; single runs keep their errors, in their order.
#[test]
fn errors_of_single_runs_are_kept() {
    let (s, filters) = study(spec(Quirk::None, &[("good", Quirk::None)]), 1);
    let text = String::from_utf8(kept::render_run_errors(&s, &filters[0]).unwrap()).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    // Two epochs a stretch, so that every error is there, in the order of size in its stretch.
    assert_eq!(rows.len(), 40 * RUNS as usize);
    for (index, pair) in rows.chunks(2).enumerate() {
        let (run, first) = (index as i32 / 20, 2 * (index as i32 % 20) + 1);
        assert_eq!((pair[0][0], pair[0][1]), (f64::from(run), f64::from(first)));
        for axis in 0..3 {
            let expected = [noise(run, first, axis), noise(run, first + 1, axis)];
            for (row, expected) in pair.iter().zip(expected) {
                // Five digits are written.
                assert!((row[2 + axis] - expected).abs() <= 5e-5 * expected.abs(), "{row:?}");
            }
        }
    }
}

#[test]
fn a_bare_filter_is_scored_by_what_it_offers() {
    let (_, filters) = study(spec(Quirk::None, &[("bare", Quirk::Bare)]), 1);
    let row = row(&filters[0]);
    near(row.position.rmse, rms_norm(0..RUNS));
    assert_eq!(
        (row.position.ratio, row.nees.mean, row.nees.median, row.nis.mean),
        (None, None, None, None)
    );
    let text = String::from_utf8(summary::render(&[row]).unwrap()).unwrap();
    assert!(!text.contains("NaN") && text.contains(",,"), "{text}");
}

#[test]
fn what_cannot_work_is_told_before_the_first_run() {
    let refused = |truth, filter| rehearse(&spec(truth, &[("theirs", filter)])).unwrap_err();
    assert!(
        rehearse(&spec(Quirk::None, &[("theirs", Quirk::None)]))
            .unwrap()
            .is_empty()
    );
    let error = refused(Quirk::None, Quirk::NoVelocity);
    assert!(matches!(&error, StudyError::MissingSignal { label, name } if label == "theirs" && name == "est.v_tc_n"));
    let error = refused(Quirk::NoInitialEstimate, Quirk::None);
    assert!(
        matches!(&error, StudyError::MissingInput { input, .. } if input == "nav_init.x[1]"),
        "{error}"
    );
    let error = refused(Quirk::None, Quirk::Refuses);
    assert!(
        matches!(&error, StudyError::Refused { label, .. } if label == "theirs"),
        "{error}"
    );
    for (step, sample_period) in [(0.3, 1.0), (0.0, 1.0), (-1.0, 1.0), (1.0, f64::NAN), (1.5, 1.0)] {
        let s = Spec {
            step,
            sample_period,
            ..spec(Quirk::None, &[("theirs", Quirk::None)])
        };
        assert!(
            matches!(rehearse(&s), Err(StudyError::StepGrid { .. })),
            "{step} {sample_period}"
        );
    }
}

#[test]
fn samples_between_communication_points_fail_the_run() {
    let (_, filters) = study(spec(Quirk::OffGrid, &[("good", Quirk::None)]), 1);
    assert_eq!(filters[0].failed(), 8);
    let message = &filters[0].runs[0].failure.as_ref().unwrap().message;
    assert!(message.contains("1.5 s"), "{message}");
}

#[test]
fn a_mapped_name_takes_the_place_of_ours() {
    let mut mapped = spec(Quirk::None, &[("theirs", Quirk::NoVelocity)]);
    let names = |axis: usize| (format!("their_v[{axis}]"), format!("est.v_tc_n[{axis}]"));
    mapped.filters[0].aliases.extend((1..=3).map(names));
    let (_, filters) = study(mapped, 1);
    near(row(&filters[0]).velocity.rmse, rms_norm(0..RUNS));
}

/// What no filter may see is refused by name, and costs nobody else anything; a bound is let through.
#[test]
fn a_filter_that_asks_for_the_truth_is_refused() {
    let (_, filters) = study(
        spec(Quirk::None, &[("good", Quirk::None), ("peeping", Quirk::AsksForTruth)]),
        2,
    );
    assert_eq!((filters[0].failed(), filters[1].failed()), (0, RUNS as usize));
    let failure = filters[1].runs[0].failure.clone().unwrap();
    assert!(
        failure.message.contains("'peeping' asks for 'truth.r_tc_n[1]'"),
        "{}",
        failure.message
    );
    assert!(failure.message.contains("--allow-truth"), "{}", failure.message);
    let error = rehearse(&spec(Quirk::None, &[("peeping", Quirk::AsksForTruth)])).unwrap_err();
    assert!(matches!(error, StudyError::AsksForTruth { .. }), "{error}");
    let bound = Spec {
        allow_truth: true,
        ..spec(Quirk::None, &[("peeping", Quirk::AsksForTruth)])
    };
    assert_eq!(study(bound, 1).1[0].failed(), 0);
}

#[test]
fn a_bound_reads_the_truth() {
    let bound = Spec {
        allow_truth: true,
        ..spec(Quirk::None, &[("peeping", Quirk::AsksForTruth)])
    };
    let (_, filters) = study(bound, 1);
    // Unfed, its first position would be 100 m off.
    near(row(&filters[0]).position.rmse, rms_norm(0..RUNS));
}

#[test]
fn outputs_of_filters_reach_neither_the_world_nor_each_other() {
    let two = [("one", Quirk::Pushes), ("other", Quirk::Pushes)];
    let (pushed_spec, pushed) = study(spec(Quirk::Pushes, &two), 1);
    let plain = two.map(|(label, _)| (label, Quirk::None));
    let (plain_spec, left_alone) = study(spec(Quirk::None, &plain), 1);
    assert_eq!(files(&pushed_spec, &pushed), files(&plain_spec, &left_alone));
}

#[test]
fn a_covariance_of_six_states_counts_as_six() {
    let (_, filters) = study(spec(Quirk::None, &[("six", Quirk::SixBySix)]), 1);
    let six = row(&filters[0]);
    assert_eq!((six.failed, six.nees_dimension), (0, Some(6)));
    near(six.nees.mean, 2.0 * rms_norm(0..RUNS).powi(2) / (SIGMA * SIGMA) / 6.0);
}

#[test]
fn partial_shapes_are_refused_by_name_with_what_is_expected() {
    for (quirk, parts) in [
        (
            Quirk::PartialCovariance,
            ["'odd'", "'cov.p'", "80 variables", "6x6 or 9x9"],
        ),
        (
            Quirk::PartialAcceleration,
            ["'odd'", "'est.a_t_n'", "2 variables", "three Reals"],
        ),
    ] {
        let text = rehearse(&spec(Quirk::None, &[("odd", quirk)])).unwrap_err().to_string();
        for part in parts {
            assert!(text.contains(part), "{text}");
        }
    }
}

/// A study with a driver.
fn driven(filters: &[(&str, Quirk)], by: Quirk) -> Spec {
    Spec {
        drivers: vec![driver("pusher", by)],
        closed_loop: by == Quirk::Guides,
        ..spec(Quirk::Pushes, filters)
    }
}

/// RMS of the error norm whose first component is shifted by what `first` says of run and sample.
fn rms_shifted(first: impl Fn(i32, i32) -> f64) -> f64 {
    let mut squares = Vec::new();
    for run in 0..RUNS {
        for count in 11..=40 {
            let others = noise(run, count, 1).powi(2) + noise(run, count, 2).powi(2);
            squares.push((noise(run, count, 0) + first(run, count)).powi(2) + others);
        }
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn a_driver_moves_the_world_of_all_filters() {
    let two = [("one", Quirk::None), ("other", Quirk::Bare)];
    let (_, filters) = study(driven(&two, Quirk::Drives { until: 1e9 }), 2);
    // The target is 50 m further away than the filters believe.
    for filter in &filters {
        near(row(filter).position.rmse, rms_shifted(|_, _| -50.0));
    }
}

#[test]
fn a_driver_that_reads_a_filter_gives_each_its_own_world() {
    let lost = Quirk::Lost { run: 3 };
    let (both_spec, both) = study(driven(&[("one", Quirk::None), ("lost", lost)], Quirk::Guides), 2);
    let (alone_spec, alone) = study(driven(&[("one", Quirk::None)], Quirk::Guides), 1);
    // What the driver read at the sample before is what the target is away.
    near(
        row(&both[0]).position.rmse,
        rms_shifted(|run, count| -100.0 - noise(run, count - 1, 0)),
    );
    assert_eq!(files(&both_spec, &both[..1]), files(&alone_spec, &alone));
}

#[test]
fn a_driver_that_fails_fails_the_run_by_name() {
    let two = [("one", Quirk::None), ("other", Quirk::Bare)];
    let (_, filters) = study(driven(&two, Quirk::Drives { until: 20.0 }), 2);
    for filter in &filters {
        assert_eq!(filter.failed(), RUNS as usize);
        let message = &filter.runs[0].failure.as_ref().unwrap().message;
        assert!(
            message.contains("pusher") && message.contains("out of fuel"),
            "{message}"
        );
    }
}

#[test]
fn drivers_without_a_world_to_push_and_two_of_one_input_are_refused() {
    let mut nothing = driven(&[("one", Quirk::None)], Quirk::Guides);
    nothing.truth = spec(Quirk::None, &[]).truth;
    let error = rehearse(&nothing).unwrap_err();
    assert!(matches!(error, StudyError::DrivesNothing { .. }), "{error}");
    let mut twice = driven(&[("one", Quirk::None)], Quirk::Guides);
    twice.drivers.push(driver("second", Quirk::Guides));
    let text = rehearse(&twice).unwrap_err().to_string();
    for part in ["a_cmd_c_n[1]", "pusher", "second"] {
        assert!(text.contains(part), "{text}");
    }
}
