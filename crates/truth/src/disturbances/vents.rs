//! Vents of the target: when they begin, how large they are and where they point, drawn from one stream for each cause and
//! each entry of the mission.

use interface::mission::{Distribution, First, FirstTable, Magnitude, Vent};
use nalgebra::{Unit, Vector3};
use numerics::{Generator, Source, math, rotation};
use rand::RngExt;
use rand_distr::{Distribution as _, StandardNormal};

use super::{entry_stream, profiles};
use crate::overrides::Run;
use crate::timeline::{Event, Side, Vector};

/// The vents of one run, kind by kind.
pub(super) fn draw(run: &Run) -> Vec<Event> {
    let mut firsts: Vec<(&str, f64)> = Vec::new();
    let mut events = Vec::new();
    for vent in &run.mission.vents {
        let first = first(run, vent, &firsts);
        firsts.push((&vent.name, first));
        let mut sizes = entry_stream(run, Source::VentSize, &vent.name);
        let mut directions = entry_stream(run, Source::VentDirection, &vent.name);
        let axis = Vector3::from(vent.direction_body).normalize();
        for i in 0..vent.count {
            let start = first + f64::from(i) * vent.period_s.unwrap_or(0.0);
            let magnitude = magnitude(&vent.magnitude_m_s2, &mut sizes) * run.vent_scale.at(start);
            let along = spread(&axis, vent.direction_sigma_deg.to_radians(), &mut directions);
            events.push(Event {
                start,
                duration: vent.duration_s,
                profile: profiles::Profile::of(vent.profile),
                side: Side::Target,
                acceleration: Vector::Body(along * magnitude),
                back_propagated: true,
                told: false,
            });
        }
    }
    events
}

/// Begin of the first vent of a kind, s; `earlier` holds those of the kinds above it.
fn first(run: &Run, vent: &Vent, earlier: &[(&str, f64)]) -> f64 {
    let mut timing = entry_stream(run, Source::VentTiming, &vent.name);
    match &vent.first_s {
        First::At(t) => *t,
        First::From(FirstTable {
            uniform_integer: Some([low, high]),
            ..
        }) => f64::from(timing.random_range(*low..=*high)),
        First::From(FirstTable {
            uniform: Some([low, high]),
            ..
        }) => low + (high - low) * timing.random::<f64>(),
        First::From(FirstTable { after, offset_s, .. }) => {
            let other = earlier.iter().find(|(name, _)| Some(*name) == after.as_deref());
            other.map_or(0.0, |(_, t)| *t) + offset_s.unwrap_or(0.0)
        }
    }
}

/// Size of one vent, m/s2. Every vent draws once, whatever its distribution.
fn magnitude(magnitude: &Magnitude, sizes: &mut Generator) -> f64 {
    let drawn = match magnitude {
        Magnitude::Fixed(value) => return *value,
        Magnitude::Drawn(drawn) => drawn,
    };
    if let Distribution::Uniform([low, high]) = drawn {
        return low + (high - low) * sizes.random::<f64>();
    }
    let normal: f64 = StandardNormal.sample(sizes);
    match drawn {
        Distribution::HalfNormal(sigma) => normal.abs() * sigma,
        Distribution::Normal([mean, sigma]) => mean + sigma * normal,
        Distribution::Lognormal([mu, sigma]) => math::exp(mu + sigma * normal),
        Distribution::Uniform([low, _]) => *low,
    }
}

/// A direction turned by normal angles of standard deviation `sigma`, rad, about two axes across it.
fn spread(axis: &Vector3<f64>, sigma: f64, directions: &mut Generator) -> Vector3<f64> {
    let angles: [f64; 2] = std::array::from_fn(|_| StandardNormal.sample(directions));
    if sigma == 0.0 {
        return *axis;
    }
    let mut helper = Vector3::zeros();
    helper[axis.iamin()] = 1.0;
    let across = Unit::new_normalize(axis.cross(&helper));
    let other = Unit::new_normalize(axis.cross(&across));
    let turn = rotation::about(&across, sigma * angles[0]) * rotation::about(&other, sigma * angles[1]);
    turn * axis
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;
    use crate::Params;
    use crate::overrides::VentScale;
    use interface::mission::Mission;

    fn of(run: u32) -> Run {
        let mut params = Params::of_scenario(1);
        params.run = run;
        params.run().unwrap()
    }

    fn body(event: &Event) -> Vector3<f64> {
        match event.acceleration {
            Vector::Body(a) => a,
            _ => panic!("a vent acts in body axes"),
        }
    }

    /// One kind of vents, written with these keys.
    fn kind(keys: &str) -> Run {
        let text = interface::mission::embedded("leo_venting").unwrap().text;
        let (head, _) = text.split_once("[[vent]]").unwrap();
        let (_, tail) = text.split_once("[sensors.lidar]").unwrap();
        let text = format!("{head}[[vent]]\nname = \"gas\"\nduration_s = 4.0\n{keys}\n[sensors.lidar]{tail}");
        let mut run = of(0);
        run.mission = Mission::parse("vents.toml", &text).unwrap_or_else(|e| panic!("{e}"));
        run
    }

    #[test]
    fn ten_vents_stand_where_the_paper_puts_them() {
        for run in 0..100 {
            let vents = draw(&of(run));
            assert_eq!(vents.len(), 10);
            let first = vents[0].start;
            assert!(
                (100.0..=300.0).contains(&first) && first.fract() == 0.0,
                "run {run}: {first}"
            );
            for (i, vent) in (0..9).zip(&vents) {
                assert_eq!((vent.start, vent.duration), (first + 600.0 * f64::from(i), 10.0));
                let along = body(vent).normalize();
                assert!(
                    (along - Vector3::new(-0.5, -0.75_f64.sqrt(), 0.0)).amax() < 3e-5,
                    "{along}"
                );
            }
            assert_eq!((vents[9].start, vents[9].duration), (first + 1400.0, 60.0));
            let along = body(&vents[9]).normalize();
            assert!(
                (along - Vector3::new(-0.5, 0.0, -0.75_f64.sqrt())).amax() < 3e-5,
                "{along}"
            );
        }
    }

    #[test]
    fn starts_and_magnitudes_have_their_distribution() {
        let mut run = of(0);
        let runs: Vec<Vec<Event>> = (0..2000)
            .map(|number| {
                run.run = number;
                draw(&run)
            })
            .collect();
        let n = runs.len() as f64;
        let mean_start = runs.iter().map(|v| v[0].start).sum::<f64>() / n;
        let sigma_start = ((201.0_f64.powi(2) - 1.0) / 12.0).sqrt();
        assert!(
            (mean_start - 200.0).abs() < 3.0 * sigma_start / n.sqrt(),
            "mean start {mean_start}"
        );
        for (vent, sigma) in [(0, 1.7094e-5_f64), (4, 1.7094e-5), (9, 1.8803e-5)] {
            let square = runs.iter().map(|v| body(&v[vent]).norm_squared()).sum::<f64>() / n;
            // The mean square of n normal draws scatters by sqrt(2 / n).
            assert!(
                (square / sigma.powi(2) - 1.0).abs() < 3.0 * (2.0 / n).sqrt(),
                "vent {vent}: {square}"
            );
        }
    }

    #[test]
    fn scale_multiplies_magnitudes_and_nothing_else() {
        let scale = |vent_scale: VentScale| draw(&Run { vent_scale, ..of(0) });
        let scaled = |factor: f64| {
            scale(VentScale {
                factor,
                ..VentScale::default()
            })
        };
        for (plain, scaled) in draw(&of(0)).iter().zip(&scaled(4.0)) {
            assert!((body(plain) * 4.0 - body(scaled)).amax() < 1e-19);
            assert_eq!(plain.start, scaled.start);
        }
        assert!(scaled(0.0).iter().all(|vent| body(vent) == Vector3::zeros()));
        // Another factor for those that begin late, that instant included.
        let late = draw(&of(0))[4].start;
        let changed = scale(VentScale {
            factor: 2.0,
            late: Some(100.0),
            late_from_s: late,
        });
        for (plain, changed) in draw(&of(0)).iter().zip(&changed) {
            let factor = if plain.start >= late { 100.0 } else { 2.0 };
            assert!(
                (body(plain) * factor - body(changed)).amax() < 1e-18,
                "{} s",
                plain.start
            );
        }
    }

    /// Moments of each distribution from its textbook.
    #[test]
    fn val_sizes_have_the_moments_of_their_distribution() {
        let n = 4000.0_f64;
        for (written, mean, deviation) in [
            ("2e-5", 2e-5, 0.0),
            (
                "{ half_normal = 1.0e-5 }",
                1e-5 * (2.0 / std::f64::consts::PI).sqrt(),
                1e-5 * (1.0 - 2.0 / std::f64::consts::PI).sqrt(),
            ),
            ("{ normal = [3e-5, 1e-6] }", 3e-5, 1e-6),
            (
                "{ lognormal = [-11.0, 0.3] }",
                f64::exp(-11.0 + 0.045),
                f64::exp(-11.0 + 0.045) * 0.09_f64.exp_m1().sqrt(),
            ),
            ("{ uniform = [1e-5, 3e-5] }", 2e-5, 2e-5 / 12.0_f64.sqrt()),
        ] {
            let run = kind(&format!(
                "first_s = 0\ncount = 4000\nperiod_s = 1.0\nmagnitude_m_s2 = {written}\ndirection_body = [0, 2, 0]"
            ));
            let sizes: Vec<f64> = draw(&run).iter().map(|vent| body(vent).y).collect();
            let seen = sizes.iter().sum::<f64>() / n;
            let square = (sizes.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
            // Three sigma of a mean, and four of a deviation with the lognormal's kurtosis of 4.6.
            assert!(
                (seen - mean).abs() <= 3.0 * deviation / n.sqrt() + 1e-18,
                "{written}: {seen} and {mean}"
            );
            assert!(
                (square - deviation).abs() <= 4.0 * deviation / n.sqrt() + 1e-18,
                "{written}: {square} and {deviation}"
            );
        }
    }

    #[test]
    fn directions_spread_about_their_axis_by_their_deviation() {
        let spread = |sigma: &str| {
            let keys = format!(
                "first_s = 0\ncount = 4000\nperiod_s = 1.0\nmagnitude_m_s2 = 1.0\ndirection_body = [1, -2, 2]\ndirection_sigma_deg = {sigma}"
            );
            draw(&kind(&keys)).iter().map(body).collect::<Vec<_>>()
        };
        let axis = Vector3::new(1.0, -2.0, 2.0) / 3.0;
        assert!(spread("0.0").iter().all(|a| (a - axis).amax() < 1e-15));
        let (seen, n) = (spread("2.0"), 4000.0);
        let mean: Vector3<f64> = seen.iter().sum::<Vector3<f64>>() / n;
        let sigma = 2.0_f64.to_radians();
        // Across, each of two directions scatters by sigma; sigma / sqrt n of the mean is left.
        assert!(
            (mean - axis * mean.dot(&axis)).norm() < 4.0 * sigma / f64::sqrt(n),
            "{mean}"
        );
        let square = seen.iter().map(|a| a.angle(&axis).powi(2)).sum::<f64>() / n;
        // The sum of two squares has mean 2 sigma^2 and scatters by its own size.
        assert!(
            (square / (2.0 * sigma * sigma) - 1.0).abs() < 3.0 / f64::sqrt(n),
            "{square}"
        );
        assert!(seen.iter().all(|a| (a.norm() - 1.0).abs() < 1e-14));
    }

    #[test]
    fn first_vents_begin_as_written() {
        let first = |written: &str, run: u64| {
            let keys = format!("first_s = {written}\nmagnitude_m_s2 = 1e-5\ndirection_body = [0, 1, 0]");
            draw(&Run { run, ..kind(&keys) })[0].start
        };
        assert_eq!(first("17.25", 0), 17.25);
        assert_eq!(first("17", 3), 17.0);
        let starts: Vec<f64> = (0..300).map(|run| first("{ uniform = [100.0, 200.0] }", run)).collect();
        assert!(starts.iter().all(|t| (100.0..200.0).contains(t)));
        let mean = starts.iter().sum::<f64>() / 300.0;
        assert!(
            (mean - 150.0).abs() < 3.0 * 100.0 / 12.0_f64.sqrt() / 300.0_f64.sqrt(),
            "{mean}"
        );
    }

    #[test]
    fn a_kind_more_moves_no_other_draw() {
        let mut run = of(5);
        let alone = draw(&run);
        let extra = Vent {
            name: "gas".to_owned(),
            direction_sigma_deg: 3.0,
            ..run.mission.vents[0].clone()
        };
        run.mission.vents.insert(0, extra);
        let both = draw(&run);
        assert_eq!(both.len(), alone.len() + 9);
        assert_eq!(both[9..], alone);
        // Nor are its own draws those of its model.
        assert!(
            both[..9]
                .iter()
                .zip(&alone)
                .all(|(a, b)| body(a).norm() != body(b).norm())
        );
    }
}
