//! Vents of the target: when they begin, how large they are and where they point, drawn from one stream for each cause and
//! each entry of the mission.

use interface::mission::{Distribution, First, FirstTable, Magnitude, Vent};
use nalgebra::{Rotation3, Unit, Vector3};
use numerics::{Generator, Source};
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
            let magnitude = magnitude(&vent.magnitude_m_s2, &mut sizes) * run.vent_scale;
            let along = spread(&axis, vent.direction_sigma_deg.to_radians(), &mut directions);
            events.push(Event {
                start: first + f64::from(i) * vent.period_s.unwrap_or(0.0),
                duration: vent.duration_s,
                profile: profiles::Profile::of(vent.profile),
                side: Side::Target,
                acceleration: Vector::Body(along * magnitude),
                back_propagated: true,
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
        Distribution::Lognormal([mu, sigma]) => (mu + sigma * normal).exp(),
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
    let turn =
        Rotation3::from_axis_angle(&across, sigma * angles[0]) * Rotation3::from_axis_angle(&other, sigma * angles[1]);
    turn * axis
}
