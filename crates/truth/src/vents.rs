//! Vents of the target's life support: Mamich and Zanetti, Table 1 and Sec. IV.

use nalgebra::Vector3;
use numerics::{Generator, Source, stream};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use crate::{Event, Params, Push};

/// A kind of vent.
struct Kind {
    /// Standard deviation of the magnitude, m/s2.
    sigma: f64,
    /// Length, s.
    duration: f64,
    /// Direction in the target's body axes, as printed (not quite of unit length).
    direction: [f64; 3],
}

const CARBON_DIOXIDE: Kind = Kind {
    sigma: 1.7094e-5,
    duration: 10.0,
    direction: [-0.5, -0.866, 0.0],
};
const WASTE_WATER: Kind = Kind {
    sigma: 1.8803e-5,
    duration: 60.0,
    direction: [-0.5, 0.0, -0.866],
};

/// The first vent begins at one of these whole seconds, all equally likely, s.
const FIRST_START: std::ops::RangeInclusive<u32> = 100..=300;
const CARBON_DIOXIDE_COUNT: u32 = 9;
const CARBON_DIOXIDE_EVERY: f64 = 600.0;
/// Waste water follows the first carbon dioxide by this much, s.
const WASTE_WATER_DELAY: f64 = 1400.0;

/// The vents of one run: nine of carbon dioxide, then one of waste water.
pub(crate) fn draw(params: &Params) -> Vec<Event> {
    let rng = |source| stream(params.study_seed.into(), params.run.into(), source);
    let first = f64::from(rng(Source::VentTiming).random_range(FIRST_START));
    let mut sizes = rng(Source::VentSizeCo2);
    let mut vents: Vec<Event> = (0..CARBON_DIOXIDE_COUNT)
        .map(|i| {
            CARBON_DIOXIDE.vent(
                first + f64::from(i) * CARBON_DIOXIDE_EVERY,
                params.vent_scale,
                &mut sizes,
            )
        })
        .collect();
    vents.push(WASTE_WATER.vent(
        first + WASTE_WATER_DELAY,
        params.vent_scale,
        &mut rng(Source::VentSizeWater),
    ));
    vents
}

impl Kind {
    fn vent(&self, start: f64, scale: f64, sizes: &mut Generator) -> Event {
        let draw: f64 = StandardNormal.sample(sizes);
        let magnitude = draw.abs() * self.sigma * scale;
        let target_bt = Vector3::from(self.direction).normalize() * magnitude;
        Event {
            start,
            duration: self.duration,
            push: Push {
                target_bt,
                ..Push::default()
            },
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp)]
mod tests {
    use super::*;

    fn vents(run: u32) -> Vec<Event> {
        draw(&Params {
            run,
            ..Params::default()
        })
    }

    #[test]
    fn ten_vents_stand_where_the_paper_puts_them() {
        for run in 0..100 {
            let vents = vents(run);
            assert_eq!(vents.len(), 10);
            let first = vents[0].start;
            assert!(
                (100.0..=300.0).contains(&first) && first.fract() == 0.0,
                "run {run}: {first}"
            );
            for (i, vent) in (0..9).zip(&vents) {
                assert_eq!((vent.start, vent.duration), (first + 600.0 * f64::from(i), 10.0));
                let along = vent.push.target_bt.normalize();
                assert!(
                    (along - Vector3::new(-0.5, -0.75_f64.sqrt(), 0.0)).amax() < 3e-5,
                    "{along}"
                );
            }
            assert_eq!((vents[9].start, vents[9].duration), (first + 1400.0, 60.0));
            let along = vents[9].push.target_bt.normalize();
            assert!(
                (along - Vector3::new(-0.5, 0.0, -0.75_f64.sqrt())).amax() < 3e-5,
                "{along}"
            );
        }
    }

    #[test]
    fn starts_and_magnitudes_have_their_distribution() {
        let runs: Vec<Vec<Event>> = (0..2000).map(vents).collect();
        let n = runs.len() as f64;
        let mean_start = runs.iter().map(|v| v[0].start).sum::<f64>() / n;
        let sigma_start = ((201.0_f64.powi(2) - 1.0) / 12.0).sqrt();
        assert!(
            (mean_start - 200.0).abs() < 3.0 * sigma_start / n.sqrt(),
            "mean start {mean_start}"
        );
        for (vent, sigma) in [(0, 1.7094e-5_f64), (4, 1.7094e-5), (9, 1.8803e-5)] {
            let square = runs.iter().map(|v| v[vent].push.target_bt.norm_squared()).sum::<f64>() / n;
            // The mean square of n normal draws scatters by sqrt(2 / n).
            assert!(
                (square / sigma.powi(2) - 1.0).abs() < 3.0 * (2.0 / n).sqrt(),
                "vent {vent}: {square}"
            );
        }
    }

    #[test]
    fn scale_multiplies_magnitudes_and_nothing_else() {
        let scaled = draw(&Params {
            vent_scale: 4.0,
            ..Params::default()
        });
        for (plain, scaled) in vents(0).iter().zip(&scaled) {
            assert_eq!(plain.push.target_bt * 4.0, scaled.push.target_bt);
            assert_eq!(plain.start, scaled.start);
        }
        let off = draw(&Params {
            vent_scale: 0.0,
            ..Params::default()
        });
        assert!(off.iter().all(|vent| vent.push == Push::default()));
    }
}
