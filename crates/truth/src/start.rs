//! Where a run begins: the vehicles' states as the mission states them, taken back to the start where they are those of the
//! end.

use astro::{Elements, frames};
use interface::mission::{self, Gravity, Mission, Orbit, Relative, RelativeAxes};
use nalgebra::Vector3;

use crate::timeline::Timeline;
use crate::world::World;
use crate::{TruthError, Vehicles};

/// State at the start of the run.
///
/// # Errors
/// When an orbit is none.
pub(crate) fn start(mission: &Mission, world: &World, timeline: &Timeline) -> Result<Vehicles, TruthError> {
    let (target, chaser) = (&mission.target, &mission.chaser);
    let at = |orbit: &Orbit| orbit.at.is_end();
    let at_end = target.orbit.as_ref().or(chaser.orbit.as_ref()).is_some_and(at);
    let time = if at_end { mission.time.duration_s } else { 0.0 };
    let of = |orbit: &Orbit| state(mission, world, orbit);
    let stated = match ((&target.orbit, &target.relative), (&chaser.orbit, &chaser.relative)) {
        ((Some(target), _), (Some(chaser), _)) => {
            let (r_t, v_t) = of(target)?;
            let (r_c, v_c) = of(chaser)?;
            Vehicles { r_t, v_t, r_c, v_c }
        }
        ((Some(target), _), (None, Some(relative))) => {
            let (r_t, v_t) = of(target)?;
            let (r_tc, v_tc) = placed(world, relative, time, &r_t, &v_t);
            Vehicles {
                r_t,
                v_t,
                r_c: r_t - r_tc,
                v_c: v_t - v_tc,
            }
        }
        ((None, Some(relative)), (Some(chaser), _)) => {
            let (r_c, v_c) = of(chaser)?;
            let (r_tc, v_tc) = placed(world, relative, time, &r_c, &v_c);
            Vehicles {
                r_t: r_c + r_tc,
                v_t: v_c + v_tc,
                r_c,
                v_c,
            }
        }
        _ => return Err(TruthError::NoOrbit),
    };
    if !at_end {
        return Ok(stated);
    }
    let intervals = (mission.time.duration_s / world.grid).round() as u64;
    Ok(world.back_propagate(&timeline.back_propagated(), &stated, intervals))
}

/// Position and velocity of an orbit, axes N.
fn state(mission: &Mission, world: &World, orbit: &Orbit) -> Result<(Vector3<f64>, Vector3<f64>), TruthError> {
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

/// Target minus chaser in axes N.
///
/// * `time`: s since the start of the run.
/// * `r`, `v`: of the vehicle whose orbit is given, axes N.
fn placed(
    world: &World,
    relative: &Relative,
    time: f64,
    r: &Vector3<f64>,
    v: &Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let (r_tc, v_tc) = (Vector3::from(relative.r_tc_m), Vector3::from(relative.v_tc_m_s));
    match relative.axes {
        RelativeAxes::N => (r_tc, v_tc),
        RelativeAxes::Inertial => {
            let dcm = world.axes.dcm_n_i(time);
            let r_tc = dcm * r_tc;
            (r_tc, world.axes.velocity_in_n(&r_tc, &(dcm * v_tc)))
        }
        RelativeAxes::Rtn => {
            let dcm = frames::rtn(r, v);
            (dcm.tr_mul(&r_tc), dcm.tr_mul(&v_tc))
        }
        RelativeAxes::Lvlh => {
            let dcm = frames::rtn(r, v);
            let r_tc = dcm.tr_mul(&r_tc);
            let omega = r.cross(v) / r.norm_squared();
            (r_tc, dcm.tr_mul(&v_tc) + omega.cross(&r_tc))
        }
    }
}
