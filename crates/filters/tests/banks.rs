//! Banks of filters, where they must be filters that are there already.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod common;
mod formation;

use common::{OwnWorld, navigation};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Navigator, Reading, Sample, Settings};
use formation::{Formation, World};
use std::time::{Duration, Instant};

fn settings(filter: &str, tunables: &[(&str, Value)]) -> Settings {
    let mut settings = Settings {
        filter: FILTERS.iter().position(|f| f.name == filter).unwrap(),
        ..Settings::default()
    };
    for (name, value) in tunables {
        *settings.tunable_mut(filter, name).unwrap() = *value;
    }
    settings
}

fn world(mission: &str, run: u64) -> (Box<dyn World>, State) {
    if mission == "formation" {
        let (world, start) = Formation::new(run);
        (Box::new(world), start)
    } else {
        let (world, start) = OwnWorld::new(run, 3e-6);
        (Box::new(world), start)
    }
}

/// Largest distance of two filters' means in standard deviations of the first, and of their covariances as a share of it, over
/// the time after the first samples; every ninth sample is lost and some are skipped.
fn apart(mission: &str, one: &Settings, other: &Settings) -> (f64, f64) {
    let (mut world, start) = world(mission, 2);
    let told = navigation(mission);
    let mut filters = [one, other].map(|settings| Navigator::new(&told, settings, 0.0).unwrap());
    let (mut mean, mut covariance) = (0.0_f64, 0.0_f64);
    for k in 1..=600 {
        let mut sample = world.step();
        if k % 9 == 0 {
            sample.sensors.fill(Reading::Lost);
        }
        if k % 50 == 20 {
            continue;
        }
        filters
            .iter_mut()
            .for_each(|nav| assert!(nav.process(&sample, &start).unwrap()));
        let [a, b] = [filters[0].estimate(), filters[1].estimate()];
        for i in 0..6 {
            mean = mean.max((a.x[i] - b.x[i]).abs() / a.sigma[i]);
            for j in 0..6 {
                let difference = a.p_target[(i, j)] - b.p_target[(i, j)];
                covariance = covariance.max(difference.abs() / (a.sigma[i] * a.sigma[j]));
            }
        }
    }
    (mean, covariance)
}

#[test]
fn a_bank_of_one_is_its_member() {
    for mission in ["leo_venting", "formation"] {
        let q = 3e-4;
        let snc = settings("snc", &[("q", Value::Real(q))]);
        for bank in ["mmae", "imm"] {
            let one = [("lowest", Value::Real(q)), ("members", Value::Integer(1))];
            let (mean, covariance) = apart(mission, &snc, &settings(bank, &one));
            // Beyond rounding: members share what later passes of the first updates make of the angles, and do not hear what the
            // accelerometer's bias says of the target.
            assert!(
                mean < 1e-2 && covariance < 1e-3,
                "{bank} in {mission}: {mean:e}, {covariance:e}"
            );
        }
    }
}

/// Models that are never left, and weights that never return, are the same bank by two laws.
#[test]
fn a_chain_that_stays_is_a_bank_without_exchange() {
    for mission in ["leo_venting", "formation"] {
        let for_ever = Value::Real(1e200);
        let (mean, covariance) = apart(
            mission,
            &settings("imm", &[("sojourn", for_ever)]),
            &settings("mmae", &[("memory", for_ever)]),
        );
        assert!(mean < 1e-6 && covariance < 1e-6, "{mission}: {mean:e}, {covariance:e}");
    }
}

#[test]
fn a_window_that_would_keep_too_many_hypotheses_is_refused_by_name() {
    let told = navigation("leo_venting");
    for bank in ["change_point", "hybrid"] {
        let settings = settings(bank, &[("window", Value::Real(3601.0))]);
        let error = Navigator::new(&told, &settings, 0.0).err().unwrap().to_string();
        assert!(error.contains(&format!("{bank}.window = 3601 s")), "{error}");
    }
}

/// A lower bound far above what the bank finds makes it as unsure of the velocity as one filter of that density; an upper bound far
/// below makes it surer, if not as sure as one filter: members that are much louder and much more likely keep a small weight.
#[test]
fn bounds_of_a_density_make_a_bank_less_sure_or_surer() {
    let sigma = |filter: &str, tunables: &[(&str, f64)]| {
        let real: Vec<_> = tunables.iter().map(|(name, v)| (*name, Value::Real(*v))).collect();
        let (mut world, start) = OwnWorld::new(2, 1e-6);
        let mut nav = Navigator::new(&navigation("leo_venting"), &settings(filter, &real), 0.0).unwrap();
        for _ in 0..600 {
            nav.process(&world.step(), &start).unwrap();
        }
        assert_eq!(nav.unsolved(), 0);
        nav.estimate().sigma.fixed_rows::<3>(3).norm()
    };
    let free = sigma("constrained_q", &[]);
    let (loud, one) = (sigma("constrained_q", &[("q_min", 1e-2)]), sigma("snc", &[("q", 1e-2)]));
    assert!(loud > 10.0 * free, "{loud} and {free}");
    assert!((loud / one - 1.0).abs() < 0.01, "{loud} and {one}");
    let quiet = sigma("constrained_q", &[("q_max", 2e-6)]);
    assert!(quiet < 0.7 * free, "{quiet} and {free}");
}

const OURS: [&str; 5] = ["change_point", "hybrid", "imm", "mmae", "constrained_q"];

/// A target that pushes for ten seconds every four minutes, hard every third time, and samples that are lost.
fn pushed(seconds: u32) -> (Vec<Sample>, State) {
    let (mut world, start) = OwnWorld::new(4, 1e-9);
    let sample = |k: u32| {
        let push = match (k % 240, (k / 240) % 3) {
            (100..110, 0) => 3e-2,
            (100..110, _) => 1e-4,
            _ => 0.0,
        };
        world
            .x
            .fixed_rows_mut::<3>(6)
            .copy_from_slice(&[push, -push, 0.5 * push]);
        let mut sample = world.step();
        if k % 11 == 3 {
            sample.sensors.fill(Reading::Lost);
        }
        sample
    };
    ((0..seconds).map(sample).collect(), start)
}

/// With all that it may learn.
fn navigator(filter: &str) -> Navigator {
    let schedule: &[_] = match filter {
        "change_point" | "hybrid" => &[("schedule", Value::Boolean(true))],
        _ => &[],
    };
    Navigator::new(&navigation("leo_venting"), &settings(filter, schedule), 0.0).unwrap()
}

/// Each step by the quickest of nine passes through the same samples: what another process took from one pass, it does not take from
/// all of them.
#[test]
fn no_step_costs_ten_times_the_median() {
    let (samples, start) = pushed(1500);
    for filter in OURS {
        let mut costs = vec![Duration::MAX; samples.len()];
        for _ in 0..9 {
            let mut nav = navigator(filter);
            for (sample, cost) in samples.iter().zip(&mut costs) {
                let clock = Instant::now();
                nav.process(sample, &start).unwrap();
                *cost = clock.elapsed().min(*cost);
            }
            let decides = !matches!(filter, "imm" | "mmae");
            assert_eq!(nav.updates() > 0, decides, "{filter}");
        }
        costs.sort_unstable();
        let (median, most) = (costs[costs.len() / 2], costs[costs.len() - 1]);
        assert!(most < 10 * median, "{filter}: {most:?} and {median:?}");
    }
}

#[test]
fn a_bank_keeps_no_more_in_its_second_three_hours_than_in_its_first() {
    let hours = 3 * 3600;
    let (samples, start) = pushed(2 * hours);
    for filter in OURS {
        let mut nav = navigator(filter);
        let most: Vec<usize> = (samples.chunks(hours as usize))
            .map(|chunk| {
                let kept = chunk.iter().map(|sample| {
                    nav.process(sample, &start).unwrap();
                    postcard::to_allocvec(&nav).unwrap().len()
                });
                kept.max().unwrap()
            })
            .collect();
        // Counts are written shorter while they are small.
        assert!(most[1] <= most[0] + 100, "{filter}: {most:?}");
    }
}
