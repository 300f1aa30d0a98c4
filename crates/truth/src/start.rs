//! Where a run begins: the vehicles' states as the mission states them, taken back to the start where they are those of the
//! end.

use astro::relative_axes::{Reference, in_own_axes};
use astro::{Elements, RelativeAxes};
use interface::mission::{self, Gravity, Mission, Orbit, Relative};
use nalgebra::Vector3;

use crate::timeline::Timeline;
use crate::world::World;
use crate::{TruthError, Vehicles};

/// Position and velocity, axes N, m and m/s.
type State = (Vector3<f64>, Vector3<f64>);

/// State at the start of the run.
///
/// # Errors
/// When an orbit is none, or a vehicle has no axes in which the other could be placed.
pub(crate) fn start(mission: &Mission, world: &World, timeline: &Timeline) -> Result<Vehicles, TruthError> {
    let (target, chaser) = (&mission.target, &mission.chaser);
    let at_end = |orbit: &Orbit| orbit.at.is_end();
    let at_end = target.orbit.as_ref().or(chaser.orbit.as_ref()).is_some_and(at_end);
    let intervals = (mission.time.duration_s / world.grid).round() as u64;
    let time = if at_end { mission.time.duration_s } else { 0.0 };
    let of = |orbit: &Orbit| state(mission, world, orbit);
    let stated = match ((&target.orbit, &target.relative), (&chaser.orbit, &chaser.relative)) {
        ((Some(target), _), (Some(chaser), _)) => {
            let ((r_t, v_t), (r_c, v_c)) = (of(target)?, of(chaser)?);
            Vehicles { r_t, v_t, r_c, v_c }
        }
        ((Some(target), _), (None, Some(relative))) => {
            let (r_t, v_t) = of(target)?;
            let (r_tc, v_tc) = beside_the_target(world, relative, time, &(r_t, v_t))?;
            Vehicles {
                r_t,
                v_t,
                r_c: r_t - r_tc,
                v_c: v_t - v_tc,
            }
        }
        ((None, Some(relative)), (Some(chaser), _)) => {
            let (r_c, v_c) = of(chaser)?;
            let (r_tc, v_tc) = beside_the_chaser(world, relative, time, &(r_c, v_c))?;
            Vehicles {
                r_t: r_c + r_tc,
                v_t: v_c + v_tc,
                r_c,
                v_c,
            }
        }
        _ => return Err(TruthError::NoOrbit),
    };
    Ok(if at_end {
        world.back_propagate(&timeline.back_propagated(), &stated, intervals)
    } else {
        stated
    })
}

/// Position and velocity of an orbit, axes N.
fn state(mission: &Mission, world: &World, orbit: &Orbit) -> Result<State, TruthError> {
    if let Some(e) = &orbit.elements {
        let mu = world.environment.mu().ok_or(TruthError::NoOrbit)?;
        return Ok(elements(e).to_state(mu)?);
    }
    let s = orbit.state.ok_or(TruthError::NoOrbit)?;
    match (s.r_m, s.v_m_s, s.r_nd, s.v_nd, &mission.environment.gravity) {
        (Some(r), Some(v), ..) => Ok((r.into(), v.into())),
        (_, _, Some(r), Some(v), Gravity::Cr3bp(problem)) => Ok((
            Vector3::from(r) * problem.length_m,
            Vector3::from(v) * (problem.length_m / problem.time_s),
        )),
        _ => Err(TruthError::NoOrbit),
    }
}

fn elements(e: &mission::Elements) -> Elements {
    let mean = match (e.mean_anomaly_deg, e.true_anomaly_deg) {
        (Some(mean), _) => mean.to_radians(),
        (None, nu) => Elements::mean_from_true_anomaly(nu.unwrap_or(0.0).to_radians(), e.e),
    };
    Elements {
        a: e.a_m,
        e: e.e,
        inclination: e.i_deg.to_radians(),
        node: e.raan_deg.to_radians(),
        argument_of_periapsis: e.argp_deg.to_radians(),
        mean_anomaly: mean,
    }
}

fn axes(of: mission::RelativeAxes) -> RelativeAxes {
    match of {
        mission::RelativeAxes::N => RelativeAxes::N,
        mission::RelativeAxes::Inertial => RelativeAxes::Inertial,
        mission::RelativeAxes::Rtn => RelativeAxes::Rtn,
        mission::RelativeAxes::Lvlh => RelativeAxes::Lvlh,
    }
}

/// Target minus chaser, where the target's orbit is known.
///
/// * `time`: s since the start of the run.
fn beside_the_target(world: &World, relative: &Relative, time: f64, (r_t, v_t): &State) -> Result<State, TruthError> {
    let a_t = world.free_target(&world.sky(time), r_t, v_t);
    let reference = Reference::new(world.axes.at(time), r_t, v_t, &a_t);
    let (r_tc, v_tc) = (relative.r_tc_m.into(), relative.v_tc_m_s.into());
    Ok(reference.to_n(axes(relative.axes), &r_tc, &v_tc)?)
}

/// Target minus chaser, where the chaser's orbit is known: the axes are those of the target all the same.
///
/// * `time`: s since the start of the run.
fn beside_the_chaser(world: &World, relative: &Relative, time: f64, (r_c, v_c): &State) -> Result<State, TruthError> {
    let sky = world.sky(time);
    Ok(in_own_axes(
        world.axes.at(time),
        (r_c, v_c),
        |r, v| world.free_target(&sky, r, v),
        axes(relative.axes),
        (&relative.r_tc_m.into(), &relative.v_tc_m_s.into()),
    )?)
}
