//! Banks of filters, where they must be filters that are there already.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod common;
mod formation;

use common::{OwnWorld, navigation};
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Navigator, Reading, Settings};
use formation::{Formation, World};

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
