//! Filters flown as nobody should fly them: whatever the tuning, the start and the samples, an estimate is a number, its covariance
//! that of something, or the filter says that it has diverged.
//!
//! `RANDOMISED_RUNS=2500 cargo test --release -p filters --test randomised -- --nocapture` is the long way, of each mission.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "what has happened is shown with --nocapture")]

mod common;
mod flight;
mod formation;

use astro::{Cr3bpSystem, Elements};
use common::{OwnWorld, navigation};
use filters::laws::{FILTERS, FilterEntry};
use filters::state::State;
use filters::tunable::{Kind, Value};
use filters::{Estimate, FilterError, Navigation, Navigator, Reading, Sample, Settings, Status};
use flight::{Flight, Push};
use formation::{Formation, World};
use interface::mission::Frame;
use nalgebra::{Vector3, Vector6};
use numerics::{Generator, Source, stream};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where filters fly: each of them in each, as far as it has a meaning there.
const MISSIONS: [&str; 4] = ["leo_venting", "nrho_venting", "formation", DRAWN];

/// A mission that each run draws for itself.
const DRAWN: &str = "a drawn one";

fn vector(g: &mut Generator, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| size * normal(g))
}

/// Relative position and velocity, metres to kilometres.
fn relative(g: &mut Generator) -> Vector6<f64> {
    let distance = 10_f64.powf(g.random_range(1.0..4.0));
    let (r, v) = (vector(g, distance), vector(g, 1e-3 * distance));
    Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z)
}

/// An orbit of any shape and plane about the Earth, any set of sensors that tells where the target is, at any periods and precisions,
/// any scale of what is not modelled.
fn drawn_mission(g: &mut Generator) -> (Navigation, Vector6<f64>) {
    let mut sensors = String::new();
    let mut sensor = |name: &str, g: &mut Generator, more: &str| {
        let period = [0.5, 1.0, 2.0, 5.0, 10.0][g.random_range(0..5)];
        sensors.push_str(&format!("[sensors.{name}]\nperiod_s = {period:?}\n{more}"));
    };
    let lidar = format!(
        "sigma_range_m = {:e}\nsigma_angle_deg = {:e}\n",
        0.08 * decades(g, 2.0),
        0.04 * decades(g, 2.0)
    );
    match g.random_range(0..4) {
        0 => sensor("lidar", g, &lidar),
        // Angles alone do not say how far the target is.
        1 => ["camera", "radio"].into_iter().for_each(|name| sensor(name, g, "")),
        2 => sensor("radio", g, ""),
        _ => ["lidar", "camera", "radio"]
            .into_iter()
            .for_each(|name| sensor(name, g, "")),
    }
    if g.random_bool(0.7) {
        sensor("accelerometer", g, "sigma_m_s2 = 3.4e-6\n");
    }
    let elements = Elements {
        a: g.random_range(6.8e6..4.2e7),
        e: g.random_range(0.0..0.05),
        inclination: g.random_range(0.0..std::f64::consts::PI),
        node: g.random_range(0.0..6.0),
        argument_of_periapsis: g.random_range(0.0..6.0),
        mean_anomaly: g.random_range(0.0..6.0),
    };
    let sigma = [5.0 * decades(g, 2.0), 0.05 * decades(g, 2.0)];
    let navigation = format!(
        "chaser_q_c_m2_s3 = {:e}\n[navigation.scale]\ndisturbance_m_s2 = {:e}\ndisturbance_time_s = {:e}\n",
        1e-12 * decades(g, 4.0),
        1e-5 * decades(g, 3.0),
        30.0 * decades(g, 1.5),
    );
    let told = flight::orbit([elements.a, elements.e], sigma, &sensors, &navigation);
    let (r, v) = elements.to_state(3.986e14).unwrap();
    (told, Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z))
}

/// A truth that brings a sample when it is asked for one.
type Samples = Box<dyn FnMut() -> Sample>;

/// A world, what its filter is told, and where that begins.
fn world(mission: &str, run: u64, g: &mut Generator) -> (Navigation, Samples, State) {
    fn own(mut world: impl World + 'static) -> Samples {
        Box::new(move || world.step())
    }
    let flown = |told: &Navigation, gravity: flight::Gravity, target: &Vector6<f64>, g: &mut Generator| {
        let (mut flight, start) = Flight::new(told, gravity, target, &relative(g), run);
        let from = g.random_range(0..200_u32);
        let size = 1e-5 * decades(g, 3.0);
        flight.grid = 0.5;
        flight.on_target.push(Push {
            from: f64::from(from),
            to: f64::from(from + g.random_range(1..100_u32)),
            a_n: vector(g, size),
        });
        let samples: Samples = Box::new(move || flight.next());
        (samples, start)
    };
    match mission {
        DRAWN => {
            let (told, target) = drawn_mission(g);
            let gravity: flight::Gravity = Box::new(|_, r, _| astro::earth::FILTER.acceleration(r));
            let (samples, start) = flown(&told, gravity, &target, g);
            (told, samples, start)
        }
        "nrho_venting" => {
            let told = navigation(mission);
            let system = Cr3bpSystem::new(1.215e-2, 3.844e8, 3.752e5).unwrap();
            let (r, v) = system.to_si(
                &Vector3::new(0.9879, 1.432e-2, 2.009e-3),
                &Vector3::new(7.173e-2, 0.9238, -0.8528),
            );
            let target = Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
            let (samples, start) = flown(&told, Box::new(move |_, r, v| system.acceleration(r, v)), &target, g);
            (told, samples, start)
        }
        "formation" => {
            let (world, start) = Formation::new(run);
            (navigation(mission), own(world), start)
        }
        _ => {
            let (world, start) = OwnWorld::new(run, 1e-6 * decades(g, 3.0));
            (navigation(mission), own(world), start)
        }
    }
}

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
    let settings = drawn(entry, filter, run, g);
    let (told, mut next, mut start) = world(mission, run, g);
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
        let mut sample = next();
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
    let pairs: Vec<(usize, &str)> = (0..FILTERS.len())
        .flat_map(|filter| MISSIONS.map(|mission| (filter, mission)))
        .filter(|(filter, mission)| {
            // Drawn missions are in inertial axes, as the first is.
            let told = navigation(if *mission == DRAWN { MISSIONS[0] } else { mission });
            FILTERS[*filter].no_meaning_in(&told).is_none()
        })
        .collect();
    let (next, faults) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    println!("filter, mission: runs, tracked at the end, diverged, broke down");
    let work = || {
        while let Some((filter, mission)) = pairs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let entry = &FILTERS[*filter];
            let mut ends = [0; 3];
            for run in 0..runs {
                let flown = catch_unwind(AssertUnwindSafe(|| flown(entry, *filter, mission, run)));
                match flown.unwrap_or_else(|_| Err("panicked".to_owned())) {
                    Ok(end) => ends[end as usize] += 1,
                    Err(what) => {
                        let what = format!("{} in {mission}, run {run}: {what}", entry.name);
                        faults.lock().unwrap().push(what);
                    }
                }
            }
            println!(
                "{}, {mission}: {runs}, {}, {}, {}",
                entry.name, ends[0], ends[1], ends[2]
            );
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let faults = faults.into_inner().unwrap();
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
