//! Filters flown as nobody should fly them: whatever the tuning, the start and the samples, an estimate is a number, its covariance
//! that of something, or the filter says that it has diverged.
//!
//! `RANDOMISED_RUNS=10000 cargo test --release -p filters --test randomised -- --nocapture` is the long way.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "what has happened is shown with --nocapture")]

mod common;
mod formation;

use common::{OwnWorld, navigation};
use filters::laws::{FILTERS, FilterEntry};
use filters::state::State;
use filters::tunable::{Kind, Value};
use filters::{Estimate, FilterError, Navigator, Reading, Sample, Settings, Status};
use formation::{Formation, World};
use interface::mission::Frame;
use numerics::{Generator, Source, stream};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Filters in a mission, drawn in turn; each of them in both.
const MISSIONS: [&str; 2] = ["leo_venting", "formation"];

fn normal(g: &mut Generator) -> f64 {
    StandardNormal.sample(g)
}

/// A factor within so many decades either way.
fn decades(g: &mut Generator, most: f64) -> f64 {
    10_f64.powf(g.random_range(-most..most))
}

/// Tunings over decades, each within what is allowed.
fn drawn(entry: &FilterEntry, filter: usize, run: u64, g: &mut Generator) -> Settings {
    let mut settings = Settings {
        filter,
        run,
        ..Settings::default()
    };
    let own = settings.resolved(&navigation("leo_venting")).is_ok();
    assert!(own, "{}", entry.name);
    for tunable in entry.tunables {
        let value = match tunable.kind {
            Kind::Real { bound, .. } => {
                let range = entry.search.iter().find(|range| range.tunable == tunable.name);
                let Some(range) = range.filter(|_| g.random_bool(0.7)) else {
                    continue;
                };
                let wide = 10_f64.powf(g.random_range(range.low.log10() - 2.0..range.high.log10() + 2.0));
                Value::Real(if bound.allows(wide) { wide } else { range.low })
            }
            Kind::Integer { min, max, .. } if g.random_bool(0.3) => {
                Value::Integer(g.random_range(min..=max.min(min.saturating_add(60))))
            }
            Kind::Boolean { .. } if g.random_bool(0.3) => Value::Boolean(g.random_bool(0.5)),
            Kind::Choice { items, .. } if g.random_bool(0.3) => Value::Choice(g.random_range(0..items.len())),
            _ => continue,
        };
        *settings.tunable_mut(entry.name, tunable.name).unwrap() = value;
    }
    let beliefs = &mut settings.beliefs;
    for (value, size) in [
        (&mut beliefs.p0_sigma_position, 10.0),
        (&mut beliefs.p0_sigma_velocity, 0.1),
        (&mut beliefs.p0_sigma_acceleration, 1e-6),
        (&mut beliefs.r_sigma_range, 0.1),
        (&mut beliefs.r_sigma_angle, 1e-3),
        (&mut beliefs.r_sigma_position, 1e-2),
        (&mut beliefs.r_sigma_velocity, 1e-4),
        (&mut beliefs.off_nominal, 1.0),
    ] {
        if g.random_bool(0.5) {
            *value = size * decades(g, 3.0);
        }
    }
    if g.random_bool(0.3) {
        beliefs.editing_mode = g.random_range(0..=1);
    }
    settings
}

/// What samples may go through on their way.
struct Trouble {
    dropouts: f64,
    outliers: f64,
    gaps: f64,
    scale: f64,
}

impl Trouble {
    fn drawn(g: &mut Generator) -> Self {
        Self {
            dropouts: if g.random_bool(0.5) {
                g.random_range(0.0..0.9)
            } else {
                0.0
            },
            outliers: if g.random_bool(0.5) {
                g.random_range(0.0..0.3)
            } else {
                0.0
            },
            gaps: if g.random_bool(0.5) {
                g.random_range(0.0..0.05)
            } else {
                0.0
            },
            scale: decades(g, 4.0),
        }
    }

    fn strike(&self, sample: &mut Sample, g: &mut Generator) {
        for reading in &mut sample.sensors {
            if !reading.is_due() {
                continue;
            }
            if g.random_bool(self.dropouts) {
                *reading = Reading::Lost;
            } else if g.random_bool(self.outliers)
                && let Reading::Seen(z) = reading
            {
                let off = z.map(|v| v * (1.0 + self.scale * normal(g)));
                *reading = Reading::Seen(off);
            }
        }
    }
}

/// What is wrong with an estimate, if anything is.
fn wrong(estimate: &Estimate, dimension: usize) -> Option<String> {
    let numbers = [
        estimate.x.as_slice(),
        estimate.p_target.as_slice(),
        estimate.sigma.as_slice(),
    ];
    if numbers.iter().any(|part| part.iter().any(|v| !v.is_finite())) {
        return Some("a number that is none".to_owned());
    }
    if dimension == 0 {
        return None;
    }
    let p = estimate.p_target.view((0, 0), (dimension, dimension)).into_owned();
    if p != p.transpose() {
        return Some("not symmetric".to_owned());
    }
    let sizes = p.diagonal().map(f64::sqrt);
    if sizes.iter().any(|size| size.is_nan() || *size <= 0.0) {
        return Some(format!("variances {}", p.diagonal()));
    }
    // As correlations, positive definite but for their own rounding.
    let correlations = p.map_with_location(|i, j, v| v / (sizes[i] * sizes[j]));
    let least = correlations.symmetric_eigenvalues().min();
    (least < -1e-9).then(|| format!("correlations with an eigenvalue of {least:e}"))
}

/// How a run has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Tracked,
    Diverged,
    BrokeDown,
}

/// One run; the text says what no run may do.
fn flown(entry: &FilterEntry, filter: usize, mission: &str, run: u64) -> Result<End, String> {
    let g = &mut stream(20_271_129, run, Source::Variation);
    let told = navigation(mission);
    let settings = drawn(entry, filter, run, g);
    let (mut world, start): (Box<dyn World>, State) = match told.frame {
        Frame::Inertial => {
            let (world, start) = OwnWorld::new(run, 1e-6 * decades(g, 3.0));
            (Box::new(world), start)
        }
        Frame::Lvlh => {
            let (world, start) = Formation::new(run);
            (Box::new(world), start)
        }
    };
    let mut start = start;
    if g.random_bool(0.3) {
        // A hundred sigma of what the missions state.
        let sigmas = if told.frame == Frame::Lvlh {
            [1.0, 1e-2]
        } else {
            [1000.0, 10.0]
        };
        for (slot, sigma) in [0, 3].into_iter().zip(sigmas) {
            (slot..slot + 3).for_each(|i| start[i] += sigma * normal(g));
        }
    }
    let trouble = Trouble::drawn(g);
    let mut nav = match Navigator::new(&told, &settings, 0.0) {
        Ok(nav) => nav,
        // Two tunings that do not go together are refused by name.
        Err(FilterError::OutOfRange { .. }) => return Ok(End::Tracked),
        Err(error) => return Err(format!("refused: {error}")),
    };
    let mut skip = 0;
    for _ in 0..300 {
        let mut sample = world.step();
        if skip > 0 {
            skip -= 1;
            continue;
        }
        if g.random_bool(trouble.gaps) {
            skip = g.random_range(1..60);
        }
        trouble.strike(&mut sample, g);
        if nav.check(&sample, &start).is_err() {
            continue;
        }
        let broke = nav.process(&sample, &start).is_err();
        let status = nav.status();
        if broke && status != Status::Diverged {
            return Err(format!("broke down as {}", status.name()));
        }
        if let Some(what) = wrong(nav.estimate(), nav.dimension())
            && status != Status::Diverged
        {
            return Err(format!("{what} at sample {}, {}", sample.count, status.name()));
        }
        if broke {
            return Ok(End::BrokeDown);
        }
    }
    Ok(if nav.status() == Status::Diverged {
        End::Diverged
    } else {
        End::Tracked
    })
}

#[test]
fn whatever_the_tuning_and_the_samples_an_estimate_is_one_or_diverged() {
    let runs = std::env::var("RANDOMISED_RUNS").map_or(20, |runs| runs.parse().unwrap());
    let mut faults = Vec::new();
    println!("filter, mission: runs, tracked at the end, diverged, broke down");
    for (filter, entry) in FILTERS.iter().enumerate() {
        for mission in MISSIONS {
            if entry.no_meaning_in(&navigation(mission)).is_some() {
                continue;
            }
            let mut ends = [0; 3];
            for run in 0..runs {
                let flown = catch_unwind(AssertUnwindSafe(|| flown(entry, filter, mission, run)));
                match flown.unwrap_or_else(|_| Err("panicked".to_owned())) {
                    Ok(end) => ends[end as usize] += 1,
                    Err(what) => faults.push(format!("{} in {mission}, run {run}: {what}", entry.name)),
                }
            }
            println!(
                "{}, {mission}: {runs}, {}, {}, {}",
                entry.name, ends[0], ends[1], ends[2]
            );
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
