//! `mission check`: a mission read, flown without noise, and shown.

use std::fmt::Write as _;
use std::path::Path;

use astro::harmonics::{EGM96, Extent};
use astro::{AstroError, Coefficients, Cr3bpSystem, Elements};
use interface::Mission;
use interface::mission::{First, Gravity, Magnitude, Which, embedded};
use nalgebra::Vector3;
use rasciigraph::Config;
use study::{MISSION, Models, Plan, StudyError, World, rehearse};

use super::super::out::Out;
use super::super::shared::{Verdict, models, scratch};
use super::quiet_run::{Point, QuietRun, run_quietly};
use crate::HarnessError;
use crate::cli::MissionCheckArgs;

/// Halving the time grid may move the relative position by this much, m.
const FINE_ENOUGH: f64 = 1e-3;

pub(super) fn check(args: &MissionCheckArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let plan = plan(args)?;
    let folder = scratch()?;
    let world = only_world(&plan, folder.path())?;
    out.say(&head(&world))?;
    out.tell("mission", &world.mission)?;
    out.tell("notes", &world.notes)?;
    let models = models(&plan, &args.build)?;
    // What the filters make of it, names of laws above all, is told before anything is flown.
    rehearse(&models.spec(
        &Plan {
            filters: None,
            ..plan.clone()
        },
        &world,
    )?)?;
    let quiet = run_quietly(&models, &plan, &world, args.run)?;
    if let Some(point) = below_the_surface(&world.mission, &quiet) {
        return Err(HarnessError::BelowSurface { time: point.t });
    }
    if quiet.seen.values().all(|seen| seen.valid == 0) {
        return Err(HarnessError::SeesNothing);
    }
    out.say(&orbits(&world, &quiet)?)?;
    out.say(&approach(&quiet))?;
    out.say(&events(&world.mission))?;
    out.say(&sensors(&world, &quiet))?;
    out.say(&plot(&quiet))?;
    for note in &world.notes {
        out.say(&format!("note: {note}"))?;
    }
    if args.once {
        return Ok(Verdict::Done);
    }
    grid(args, &plan, &models, &world, &quiet, out)
}

fn plan(args: &MissionCheckArgs) -> Result<Plan, HarnessError> {
    let name = args.mission.to_string_lossy();
    let known = !args.mission.exists() && embedded(&name).is_ok();
    Ok(Plan {
        scenarios: if known { vec![name.into_owned()] } else { Vec::new() },
        missions: if known { Vec::new() } else { vec![args.mission.clone()] },
        assignments: args.assignments.clone(),
        seed: args.seed,
        ..Plan::default()
    })
}

fn only_world(plan: &Plan, folder: &Path) -> Result<World, HarnessError> {
    let worlds = plan.worlds(folder)?;
    worlds.into_iter().next().ok_or_else(|| StudyError::NoWorld.into())
}

fn head(world: &World) -> String {
    let mission = &world.mission;
    let mut text = format!("{}: {}\n", mission.name, or_dash(&mission.about));
    let time = &mission.time;
    let _ = write!(
        text,
        "{} s, scored from {} s; time grid {} s; samples on a grid of {} s; gravity: {}",
        time.duration_s,
        time.scored_from_s,
        time.grid_s,
        world.sample_period_s,
        gravity(&mission.environment.gravity)
    );
    text
}

fn or_dash(text: &str) -> &str {
    if text.is_empty() { "-" } else { text }
}

fn gravity(gravity: &Gravity) -> String {
    match gravity {
        Gravity::TwoBody(_) => "two bodies".into(),
        Gravity::Zonal(field) => format!("zonal to J{}", field.j.len() + 1),
        Gravity::Harmonics(field) => match (&field.field, &field.file) {
            (Some(name), _) => format!("harmonics {name}"),
            (None, Some(file)) => format!("harmonics of {}", file.display()),
            (None, None) => "harmonics".into(),
        },
        Gravity::Cr3bp(problem) => format!("three-body problem, mass ratio {}", problem.mass_ratio),
    }
}

/// Gravitational parameter of the central body, m3/s2; `None` in the three-body problem.
fn mu(mission: &Mission) -> Result<Option<f64>, HarnessError> {
    Ok(match &mission.environment.gravity {
        Gravity::TwoBody(body) => Some(body.mu_m3_s2),
        Gravity::Zonal(body) => Some(body.mu_m3_s2),
        Gravity::Harmonics(field) => Some(match &field.file {
            None => EGM96.coefficients().mu(),
            Some(file) => {
                let extent = Extent {
                    degree: field.degree.map(usize::from),
                    order: field.order.map(usize::from),
                };
                Coefficients::read(&mission.locate(file), extent)
                    .map_err(AstroError::from)?
                    .mu()
            }
        }),
        Gravity::Cr3bp(_) => None,
    })
}

/// The first point at which a vehicle is inside the central body.
fn below_the_surface<'a>(mission: &Mission, quiet: &'a QuietRun) -> Option<&'a Point> {
    let radius = mission.environment.gravity.radius_m()?;
    let inside = |p: &&Point| p.r_c.norm() < radius || (p.r_c + p.r_tc).norm() < radius;
    quiet.points.iter().find(inside)
}

/// The orbit of the target at the begin and at the end.
fn orbits(world: &World, quiet: &QuietRun) -> Result<String, HarnessError> {
    let mut text = "Orbit of the target".to_owned();
    let ends = [("begin", quiet.points.first()), ("end", quiet.points.last())];
    let mu = mu(&world.mission)?;
    for (name, point) in ends {
        let Some(point) = point else { continue };
        let (r, v) = (point.r_c + point.r_tc, point.v_c + point.v_tc);
        let line = match (mu, &world.mission.environment.gravity) {
            (Some(mu), gravity) => elements(&r, &v, mu, gravity.radius_m()),
            (None, Gravity::Cr3bp(problem)) => {
                let system = Cr3bpSystem::new(problem.mass_ratio, problem.length_m, problem.time_s)?;
                let (r, v) = system.about_secondary(&r, &v);
                format!(
                    "{:.1} km from the smaller body, {:.2} m/s about it",
                    r.norm() / 1e3,
                    v.norm()
                )
            }
            _ => continue,
        };
        let _ = write!(text, "\n  {name:5} {line}");
    }
    Ok(text)
}

fn elements(r: &Vector3<f64>, v: &Vector3<f64>, mu: f64, radius: Option<f64>) -> String {
    let Ok(e) = Elements::from_state(r, v, mu) else {
        return format!(
            "no closed orbit: {:.3} km from the centre at {:.3} m/s, of which {:.3} m/s outwards",
            r.norm() / 1e3,
            v.norm(),
            r.dot(v) / r.norm()
        );
    };
    let above = |distance: f64| match radius {
        Some(radius) => format!("{:.1} km above the surface", (distance - radius) / 1e3),
        None => format!("{:.1} km from the centre", distance / 1e3),
    };
    format!(
        "a {:.3} km, e {:.5}, i {:.3} deg, node {:.3} deg, periapsis argument {:.3} deg, period {:.0} s; lowest {}, highest {}",
        e.a / 1e3,
        e.e,
        e.inclination.to_degrees(),
        e.node.to_degrees(),
        e.argument_of_periapsis.to_degrees(),
        e.period(mu),
        above(e.periapsis_radius()),
        above(e.apoapsis_radius())
    )
}

fn approach(quiet: &QuietRun) -> String {
    let of = |name: &str, point: Option<&Point>| match point {
        Some(p) => format!(
            "\n  {name:9} at {:.1} s: {} apart, {:.4} m/s",
            p.t,
            distance(p.r_tc.norm()),
            p.v_tc.norm()
        ),
        None => String::new(),
    };
    format!(
        "Distance{}{}{}",
        of("begin", quiet.points.first()),
        of("closest", quiet.closest()),
        of("end", quiet.points.last())
    )
}

fn distance(m: f64) -> String {
    if m >= 1e4 {
        format!("{:.2} km", m / 1e3)
    } else {
        format!("{m:.2} m")
    }
}

fn events(mission: &Mission) -> String {
    let mut text = "Events".to_owned();
    if mission.burns.is_empty() && mission.vents.is_empty() {
        text.push_str("\n  none");
    }
    for burn in &mission.burns {
        let vehicle = match burn.vehicle {
            Which::Chaser => "chaser",
            Which::Target => "target",
        };
        let told = if burn.told { ", told to the filter" } else { "" };
        let _ = write!(
            text,
            "\n  burn {} of the {vehicle}: {} s to {} s, {:.4} m/s{told}",
            burn.name,
            burn.start_s,
            burn.start_s + burn.duration_s,
            burn.acceleration_m_s2 * burn.duration_s
        );
    }
    for vent in &mission.vents {
        let first = match &vent.first_s {
            First::At(t) => format!("from {t} s"),
            First::From(table) => match (&table.uniform_integer, &table.uniform, &table.after) {
                (Some([a, b]), ..) => format!("first between {a} s and {b} s"),
                (_, Some([a, b]), _) => format!("first between {a} s and {b} s"),
                (.., Some(other)) => format!("first {} s after {other}", table.offset_s.unwrap_or(0.0)),
                _ => String::new(),
            },
        };
        let every = vent.period_s.map(|p| format!(", every {p} s")).unwrap_or_default();
        let size = match &vent.magnitude_m_s2 {
            Magnitude::Fixed(a) => format!("{a:e} m/s2"),
            Magnitude::Drawn(drawn) => format!("{drawn:?} m/s2"),
        };
        let _ = write!(
            text,
            "\n  vent {}: {} of {} s, {first}{every}; {size}",
            vent.name, vent.count, vent.duration_s
        );
    }
    text
}

fn sensors(world: &World, quiet: &QuietRun) -> String {
    let mut text = "Sensors".to_owned();
    for (sensor, seen) in &quiet.seen {
        let _ = write!(
            text,
            "\n  {}: {} samples, target seen in {}",
            sensor.name(),
            seen.due,
            seen.valid
        );
        if let (Some((from, to)), Some((near, far))) = (seen.span, seen.range) {
            let _ = write!(
                text,
                ", {from:.1} s to {to:.1} s, at {} to {}",
                distance(near),
                distance(far)
            );
        }
        if seen.valid == 0 {
            text.push_str(": it never sees the target (attitude, field of view, max_range_m?)");
        }
    }
    if let Some(accelerometer) = &world.mission.sensors.accelerometer {
        let period = accelerometer.period_s.unwrap_or(world.mission.time.sample_period_s);
        let _ = write!(text, "\n  accelerometer: every {period} s, {:?}", accelerometer.output);
    }
    text
}

/// Distance over time.
fn plot(quiet: &QuietRun) -> String {
    const WIDTH: usize = 90;
    let Some(last) = quiet.points.last() else {
        return String::new();
    };
    let column = |i: usize| {
        quiet
            .points
            .get(i * (quiet.points.len() - 1) / (WIDTH - 1))
            .map_or(0.0, |p| p.r_tc.norm())
    };
    let caption = format!("distance [m], 0 to {} s", last.t);
    let config = Config::default().with_height(11).with_caption(caption);
    rasciigraph::plot((0..WIDTH).map(column).collect(), config)
}

/// Flies it again with half the time grid and says what that moves.
fn grid(
    args: &MissionCheckArgs,
    plan: &Plan,
    models: &Models,
    world: &World,
    quiet: &QuietRun,
    out: &mut Out<'_>,
) -> Result<Verdict, HarnessError> {
    let step = world.mission.time.grid_s;
    let halved = format!("{MISSION}.time.grid_s={:?}", 0.5 * step);
    let finer = Plan {
        assignments: plan.assignments.iter().cloned().chain(halved.parse()).collect(),
        ..plan.clone()
    };
    let folder = scratch()?;
    let again = run_quietly(models, &finer, &only_world(&finer, folder.path())?, args.run)?;
    let moved = quiet.apart_from(&again);
    let fine = moved <= FINE_ENOUGH;
    out.tell("half_grid_moves_m", moved)?;
    // The error of the scheme falls with the fourth power of its step.
    let advice = if fine {
        "fine enough".to_owned()
    } else {
        let factor = (moved / FINE_ENOUGH).powf(0.25).ceil().max(2.0);
        format!("too coarse: set time.grid_s to about {:?}", step / factor)
    };
    out.say(&format!(
            "Time grid: halving {step} s moves the relative position by {moved:.2e} m at most over the run, {FINE_ENOUGH:e} m are \
             allowed: {advice}"
        ),
    )?;
    Ok(if fine { Verdict::Done } else { Verdict::BoundsMissed })
}
