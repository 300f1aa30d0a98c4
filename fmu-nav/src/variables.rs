//! Everything a master can see of the filter: one table, from which the model description is written too.
//!
//! Names, units and meanings that outside programs rely on are fixed; more may be added, in front of nothing.

use crate::model::NavModel;
use astro::TargetOrbit;
use filters::laws::FILTERS;
use filters::scenarios::{Measures, SCENARIOS};
use filters::tunable::{Bound, Kind, Tunable, Value};
use filters::{Beliefs, Navigator, Settings, Status};
use fmi2_export::{Real, Row, Table, TableBuilder};

type Builder = TableBuilder<NavModel>;

/// The whole table.
pub fn table() -> Table<NavModel> {
    let mut t = Builder::new();
    types(&mut t);
    study(&mut t);
    beliefs(&mut t);
    for (f, filter) in FILTERS.iter().enumerate() {
        for (i, tunable) in filter.tunables.iter().enumerate() {
            tunable_row(&mut t, filter.name, tunable, f, i);
        }
    }
    inputs(&mut t);
    outputs(&mut t);
    locals(&mut t);
    t.build()
}

fn types(t: &mut Builder) {
    t.enumeration_type(
        "Scenario",
        "world that the filter believes in",
        SCENARIOS.iter().map(|s| (s.name, s.about)),
    );
    t.enumeration_type(
        "Filter",
        "registered filters",
        FILTERS.iter().map(|f| (f.name, f.about)),
    );
    let about = [
        "no sample yet",
        "newest sample used",
        "newest sample had no measurement of the target",
        "innovations far too large",
    ];
    t.enumeration_type(
        "Status",
        "what the filter is doing",
        Status::ALL.iter().zip(about).map(|((_, n), a)| (*n, a)),
    );
    let mut known = Vec::new();
    for tunable in FILTERS.iter().flat_map(|f| f.tunables) {
        if let Kind::Choice { type_name, items } = tunable.kind
            && !known.contains(&type_name)
        {
            known.push(type_name);
            t.enumeration_type(type_name, "", items.iter().map(|item| (*item, "")));
        }
    }
}

fn study(t: &mut Builder) {
    t.enumeration("scenario", "Scenario")
        .parameter()
        .start(1)
        .about("chooses dynamics, state and the defaults of parameters left at -1")
        .rw(
            |m| m.settings.scenario as i32 + 1,
            |m, v| m.settings.scenario = index(v),
        );
    t.enumeration("filter", "Filter")
        .parameter()
        .start(1)
        .about("which filter runs")
        .rw(|m| m.settings.filter as i32 + 1, |m, v| m.settings.filter = index(v));
    t.integer("study_seed")
        .parameter()
        .min(0)
        .start(1)
        .about("seed of the study, for the random start of an adaptation or a network")
        .rw(
            |m| m.settings.study_seed as i32,
            |m, v| m.settings.study_seed = v.unsigned_abs().into(),
        );
    t.integer("run")
        .parameter()
        .min(0)
        .start(0)
        .about("run within the study")
        .rw(
            |m| m.settings.run as i32,
            |m, v| m.settings.run = v.unsigned_abs().into(),
        );
}

/// From an FMI enumeration value, counted from 1 and range-checked before it gets here, to an index.
fn index(item: i32) -> usize {
    usize::try_from(item - 1).unwrap_or_default()
}

type Field = fn(&mut Beliefs) -> &mut f64;

/// Reads through the same accessor that writes, so that a row names its field once.
fn read(settings: &Settings, field: Field) -> f64 {
    *field(&mut settings.beliefs.clone())
}

/// A real parameter; `None` as start means "the scenario's own", shown as -1.
fn real_parameter<'t>(
    t: &'t mut Builder,
    name: &str,
    unit: &str,
    bound: Bound,
    start: Option<f64>,
    about: &str,
) -> Row<'t, NavModel, Real> {
    let mut row = t.real(name).parameter();
    row = match unit {
        "" => row,
        "rad" => row.unit(unit).display_unit("deg"),
        _ => row.unit(unit),
    };
    row = match bound {
        Bound::Positive => row.positive(),
        Bound::NonNegative => row.min(0.0),
        Bound::Fraction => row.min(0.0).max(1.0),
        Bound::Any => row,
    };
    match start {
        Some(start) => row.start(start).about(about),
        None => row.own_default().about(format!("{about}; -1: the scenario's own")),
    }
}

fn belief(t: &mut Builder, name: &str, unit: &str, bound: Bound, about: &str, field: Field) {
    let start = *field(&mut Beliefs::default());
    let start = (start != Beliefs::OWN).then_some(start);
    real_parameter(t, name, unit, bound, start, about).rw(
        move |m| read(&m.settings, field),
        move |m, v| *field(&mut m.settings.beliefs) = v,
    );
}

fn beliefs(t: &mut Builder) {
    use Bound::{Any, NonNegative, Positive};
    let one =
        "initial standard deviation (where the relative state is measured in full, of that; else of one vehicle's)";
    belief(
        t,
        "p0.sigma_position",
        "m",
        Positive,
        &format!("{one} position, per axis"),
        |b| &mut b.p0_sigma_position,
    );
    belief(
        t,
        "p0.sigma_velocity",
        "m/s",
        Positive,
        &format!("{one} velocity, per axis"),
        |b| &mut b.p0_sigma_velocity,
    );
    belief(
        t,
        "p0.sigma_acceleration",
        "m/s2",
        Positive,
        "initial standard deviation of the unmodelled acceleration, per axis",
        |b| &mut b.p0_sigma_acceleration,
    );
    belief(
        t,
        "p0.sigma_bias",
        "m/s2",
        Positive,
        "initial standard deviation of the accelerometer bias, per axis",
        |b| &mut b.p0_sigma_bias,
    );
    belief(
        t,
        "chaser.q_c",
        "m2/s3",
        NonNegative,
        "white acceleration density of the chaser, per axis",
        |b| &mut b.chaser_q_c,
    );
    t.boolean("chaser.q_coupled")
        .parameter()
        .start(Beliefs::default().chaser_q_coupled)
        .about("whether the chaser's process noise also enters v_tc, with opposite sign")
        .rw(
            |m| m.settings.beliefs.chaser_q_coupled,
            |m, v| m.settings.beliefs.chaser_q_coupled = v,
        );
    let gate = "readings of at least this norm drive the propagation, those below observe the bias";
    belief(t, "accelerometer.gate", "m/s2", NonNegative, gate, |b| {
        &mut b.accelerometer_gate
    });
    belief(
        t,
        "accelerometer.beta",
        "1/s",
        NonNegative,
        "inverse time constant of the accelerometer bias",
        |b| &mut b.accelerometer_beta,
    );
    belief(
        t,
        "accelerometer.bias_sigma",
        "m/s2",
        NonNegative,
        "standard deviation of the bias walk per 1 s",
        |b| &mut b.accelerometer_bias_sigma,
    );
    belief(
        t,
        "r.sigma_range",
        "m",
        Positive,
        "standard deviation of the range",
        |b| &mut b.r_sigma_range,
    );
    belief(
        t,
        "r.sigma_angle",
        "rad",
        Positive,
        "standard deviation of azimuth and elevation",
        |b| &mut b.r_sigma_angle,
    );
    belief(
        t,
        "r.sigma_accelerometer",
        "m/s2",
        Positive,
        "standard deviation of an accelerometer sample, per axis",
        |b| &mut b.r_sigma_accelerometer,
    );
    belief(
        t,
        "r.sigma_position",
        "m",
        Positive,
        "standard deviation of a relative position in LVLH, per axis",
        |b| &mut b.r_sigma_position,
    );
    belief(
        t,
        "r.sigma_velocity",
        "m/s",
        Positive,
        "standard deviation of a relative velocity in LVLH, per axis",
        |b| &mut b.r_sigma_velocity,
    );
    belief(
        t,
        "reference_orbit.semi_major_axis",
        "m",
        Positive,
        "of the circular orbit that the Clohessy-Wiltshire equations are written about",
        |b| &mut b.reference_orbit_semi_major_axis,
    );
    let off_nominal = "factor on the process noise of the filter (that it starts from, if it adapts) or on its constant gain, for studies of mistuning";
    belief(t, "off_nominal", "1", Positive, off_nominal, |b| &mut b.off_nominal);
    belief(
        t,
        "gravity.mu",
        "m3/s2",
        Positive,
        "gravitational parameter of the Earth",
        |b| &mut b.gravity_mu,
    );
    belief(
        t,
        "gravity.radius",
        "m",
        Positive,
        "reference radius of the zonal harmonics",
        |b| &mut b.gravity_radius,
    );
    belief(t, "gravity.j2", "1", Any, "second zonal harmonic", |b| {
        &mut b.gravity_j[0]
    });
    belief(t, "gravity.j3", "1", Any, "third zonal harmonic", |b| {
        &mut b.gravity_j[1]
    });
    belief(t, "gravity.j4", "1", Any, "fourth zonal harmonic", |b| {
        &mut b.gravity_j[2]
    });
    belief(
        t,
        "gravity.mass_ratio",
        "1",
        Positive,
        "mass ratio of the three-body problem",
        |b| &mut b.gravity_mass_ratio,
    );
    let diverged = "the filter calls itself diverged when the running mean of NIS over its rows exceeds this";
    belief(t, "divergence.nis", "1", Positive, diverged, |b| &mut b.divergence_nis);
    t.integer("divergence.samples")
        .parameter()
        .min(1)
        .start(Beliefs::default().divergence_samples)
        .about("time constant of that running mean, samples")
        .rw(
            |m| m.settings.beliefs.divergence_samples,
            |m, v| m.settings.beliefs.divergence_samples = v,
        );
}

/// The accessors of one tunable's value, stored in the variant that its kind calls for; a restored state may hold less.
macro_rules! stored {
    ($f:expr, $i:expr, $variant:ident, $default:expr) => {
        (
            move |m: &NavModel| match m.settings.tunables.get($f).and_then(|of| of.get($i)) {
                Some(Value::$variant(v)) => *v,
                _ => $default,
            },
            move |m: &mut NavModel, v| {
                if let Some(slot) = m.settings.tunables.get_mut($f).and_then(|of| of.get_mut($i)) {
                    *slot = Value::$variant(v);
                }
            },
        )
    };
}

fn tunable_row(t: &mut Builder, filter: &str, tunable: &Tunable, f: usize, i: usize) {
    let name = format!("{filter}.{}", tunable.name);
    match tunable.kind {
        Kind::Real { start, unit, bound } => {
            let (get, set) = stored!(f, i, Real, 0.0);
            real_parameter(t, &name, unit, bound, start, tunable.about).rw(get, set);
        }
        Kind::Integer { start, min, max } => {
            let (get, set) = stored!(f, i, Integer, 0);
            t.integer(name)
                .parameter()
                .min(min)
                .max(max)
                .start(start)
                .about(tunable.about)
                .rw(get, set);
        }
        Kind::Boolean { start } => {
            let (get, set) = stored!(f, i, Boolean, false);
            t.boolean(name)
                .parameter()
                .start(start)
                .about(tunable.about)
                .rw(get, set);
        }
        Kind::Choice { type_name, .. } => {
            let (get, set) = stored!(f, i, Choice, 0);
            t.enumeration(name, type_name)
                .parameter()
                .start(1)
                .about(tunable.about)
                .rw(move |m| get(m) as i32 + 1, move |m, v| set(m, index(v)));
        }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];
const POSITION_AND_VELOCITY: [&str; 2] = ["m", "m/s"];
const STATES: [&str; 6] = ["r_tc", "v_tc", "a_t", "r_c", "v_c", "b_c"];
const STATE_UNITS: [&str; 6] = ["m", "m/s", "m/s2", "m", "m/s", "m/s2"];

fn state_label(i: usize) -> String {
    format!("{} {}", STATES[i / 3], AXES[i % 3])
}

fn inputs(t: &mut Builder) {
    t.real("sample_time")
        .input()
        .discrete()
        .unit("s")
        .about("epoch of the newest sensor sample")
        .rw(|m| m.inputs.sample_time, |m, v| m.inputs.sample_time = v);
    t.integer("sample_count")
        .input()
        .about("ordinal of the newest sensor sample; 0 before the first; a sample is used once")
        .rw(|m| m.inputs.sample_count, |m, v| m.inputs.sample_count = v);
    t.boolean("lidar.valid")
        .input()
        .about("whether the sample holds a LiDAR measurement")
        .rw(|m| m.inputs.lidar_valid, |m, v| m.inputs.lidar_valid = v);
    t.real("lidar.range")
        .input()
        .discrete()
        .unit("m")
        .about("measured range")
        .rw(|m| m.inputs.lidar.x, |m, v| m.inputs.lidar.x = v);
    t.real("lidar.azimuth")
        .input()
        .discrete()
        .unit("rad")
        .display_unit("deg")
        .about("measured atan(rho_x / rho_z), LiDAR axes")
        .rw(|m| m.inputs.lidar.y, |m, v| m.inputs.lidar.y = v);
    t.real("lidar.elevation")
        .input()
        .discrete()
        .unit("rad")
        .display_unit("deg")
        .about("measured atan(rho_y / rho_z), LiDAR axes")
        .rw(|m| m.inputs.lidar.z, |m, v| m.inputs.lidar.z = v);
    t.boolean("metrology.valid")
        .input()
        .about("whether the sample holds a measured relative state")
        .rw(|m| m.inputs.metrology_valid, |m, v| m.inputs.metrology_valid = v);
    for (block, (name, about)) in [
        (
            "metrology.rho_lvlh",
            "measured position of the chaser relative to the target, LVLH",
        ),
        (
            "metrology.rho_dot_lvlh",
            "measured velocity of the chaser relative to the target, LVLH",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        t.real(name)
            .input()
            .discrete()
            .unit(POSITION_AND_VELOCITY[block])
            .about_by(move |i| format!("{about} {}", AXES[i]))
            .vector_rw(
                3,
                move |m, i| m.inputs.metrology[3 * block + i],
                move |m, i, v| m.inputs.metrology[3 * block + i] = v,
            );
    }
    type Element = fn(&mut TargetOrbit) -> &mut f64;
    let orbit: [(&str, &str, &str, Element); 5] = [
        ("r", "m", "geocentric distance", |o| &mut o.r),
        ("r_dot", "m/s", "rate of the geocentric distance", |o| &mut o.r_dot),
        ("h", "m2/s", "angular momentum per unit mass", |o| &mut o.h),
        ("inclination", "rad", "inclination", |o| &mut o.inclination),
        ("argument_of_latitude", "rad", "angle from the ascending node", |o| {
            &mut o.argument_of_latitude
        }),
    ];
    for (name, unit, about, element) in orbit {
        let mut row = t
            .real(format!("target_orbit.{name}"))
            .input()
            .discrete()
            .unit(unit)
            .about(format!("orbit of the target at the sample, as known on board: {about}"));
        if unit == "rad" {
            row = row.display_unit("deg");
        }
        row.rw(
            move |m| *element(&mut m.inputs.target_orbit.clone()),
            move |m, v| *element(&mut m.inputs.target_orbit) = v,
        );
    }
    t.real("accelerometer.alpha_c_bc")
        .input()
        .discrete()
        .unit("m/s2")
        .about_by(|i| format!("accelerometer reading, chaser body {}", AXES[i]))
        .vector_rw(3, |m, i| m.inputs.alpha_c_bc[i], |m, i, v| m.inputs.alpha_c_bc[i] = v);
    t.real("dcm_bc_n")
        .input()
        .discrete()
        .unit("1")
        .about("direction cosine matrix, axes N to chaser body")
        .start_by(|i| if i % 4 == 0 { 1.0 } else { 0.0 })
        .matrix_rw(
            3,
            3,
            |m, i, j| m.inputs.dcm_bc_n[(i, j)],
            |m, i, j, v| m.inputs.dcm_bc_n[(i, j)] = v,
        );
    t.real("nav_init.x")
        .input()
        .discrete()
        .unit_by(|i| STATE_UNITS[i / 3])
        .about_by(|i| format!("initial estimate of {}, read with the first sample", state_label(i)))
        .vector_rw(18, |m, i| m.inputs.nav_init[i], |m, i, v| m.inputs.nav_init[i] = v);
}

/// `value` where the filter's world measures this, else 0.
fn of(navigator: &Navigator, measures: Measures, value: f64) -> f64 {
    if navigator.measures() == measures { value } else { 0.0 }
}

fn outputs(t: &mut Builder) {
    t.real("est.time")
        .output()
        .discrete()
        .unit("s")
        .about("epoch of the sample last used")
        .get(|m| m.read(|n| n.estimate().time));
    t.integer("est.count")
        .output()
        .about("ordinal of the sample last used")
        .get(|m| m.read(|n| n.estimate().count));
    t.integer("est.dimension")
        .output()
        .about("states with a covariance: relative position and velocity, and acceleration where it is estimated")
        .get(|m| m.read(|n| n.dimension() as i32));
    let inertial: [(&str, &str); 6] = [
        ("est.r_tc_n", "target relative to chaser, position, axes N"),
        ("est.v_tc_n", "target relative to chaser, velocity, axes N"),
        ("est.a_t_n", "unmodelled acceleration of the target, axes N"),
        ("est.r_c_n", "chaser position (consider state), axes N"),
        ("est.v_c_n", "chaser velocity (consider state), axes N"),
        ("est.b_c_bc", "accelerometer bias, chaser body axes"),
    ];
    let lvlh: [(&str, &str); 3] = [
        (
            "est.rho_lvlh",
            "chaser relative to target, position, LVLH of the target",
        ),
        (
            "est.rho_dot_lvlh",
            "chaser relative to target, velocity, LVLH of the target",
        ),
        (
            "est.d_lvlh",
            "acceleration that Clohessy-Wiltshire leaves out, LVLH of the target",
        ),
    ];
    for (measures, parts) in [
        (Measures::RangeAndBearing, inertial.as_slice()),
        (Measures::RelativeState, lvlh.as_slice()),
    ] {
        for (block, &(name, about)) in parts.iter().enumerate() {
            t.real(name)
                .output()
                .discrete()
                .unit(STATE_UNITS[block])
                .about_by(move |i| format!("{about}, {}", AXES[i]))
                .vector(3, move |m, i| {
                    m.read(|n| of(n, measures, n.estimate().x[3 * block + i]))
                });
        }
    }
    t.boolean("est.acceleration_valid")
        .output()
        .about("whether the filter estimates an unmodelled acceleration, be it as a state with a covariance or not")
        .get(|m| m.read(Navigator::estimates_acceleration));
    t.real("nis")
        .output()
        .discrete()
        .unit("1")
        .about("normalised innovation squared of the newest measurement: LiDAR, 3 rows, or relative state, 6; 0 without a covariance")
        .get(|m| m.read(|n| n.innovation().nis));
    t.real("q.s")
        .output()
        .discrete()
        .unit("m/s^2.5")
        .about_by(|i| {
            format!(
                "square root of the jerk density in use, axis {} of the estimate",
                AXES[i]
            )
        })
        .vector(3, |m, i| m.read(|n| n.s()[i]));
    t.integer("q.updates")
        .output()
        .about("times the law changed its process noise")
        .get(|m| m.read(|n| n.updates()));
    t.enumeration("status", "Status")
        .output()
        .about("what the filter is doing")
        .get(|m| {
            let status = m.navigator.as_ref().map_or(Status::Initialising, |n| n.status());
            Status::ALL
                .iter()
                .zip(1..)
                .find(|((s, _), _)| *s == status)
                .map_or(1, |(_, i)| i)
        });
}

fn locals(t: &mut Builder) {
    t.real("cov.p")
        .local()
        .discrete()
        .about("covariance of r_tc, v_tc, a_t (formation: rho, rho_dot, d), SI")
        .matrix(9, 9, |m, i, j| m.read(|n| n.estimate().p_target[(i, j)]));
    t.real("cov.sigma")
        .local()
        .discrete()
        .unit_by(|i| STATE_UNITS[i / 3])
        .about_by(|i| {
            format!(
                "standard deviation of {}; formation: of rho, rho_dot, d",
                state_label(i)
            )
        })
        .vector(18, |m, i| m.read(|n| n.estimate().sigma[i]));
    for (i, (name, unit)) in [
        ("innov.range", "m"),
        ("innov.azimuth", "rad"),
        ("innov.elevation", "rad"),
    ]
    .into_iter()
    .enumerate()
    {
        let mut row = t
            .real(name)
            .local()
            .discrete()
            .unit(unit)
            .about("measured minus predicted");
        if unit == "rad" {
            row = row.display_unit("deg");
        }
        row.get(move |m| m.read(|n| of(n, Measures::RangeAndBearing, n.innovation().residual[i])));
    }
    t.real("innov.s")
        .local()
        .discrete()
        .unit_by(|i| if i == 0 { "m2" } else { "rad2" })
        .about_by(|i| {
            format!(
                "predicted variance of the innovation, {}",
                ["range", "azimuth", "elevation"][i]
            )
        })
        .vector(3, |m, i| {
            m.read(|n| of(n, Measures::RangeAndBearing, n.innovation().variance[i]))
        });
    for (block, quantity) in ["rho", "rho_dot"].into_iter().enumerate() {
        let unit = POSITION_AND_VELOCITY[block];
        t.real(format!("innov.{quantity}"))
            .local()
            .discrete()
            .unit(unit)
            .about_by(|i| format!("measured minus predicted, LVLH {}", AXES[i]))
            .vector(3, move |m, i| {
                m.read(|n| of(n, Measures::RelativeState, n.innovation().residual[3 * block + i]))
            });
        t.real(format!("innov.{quantity}_s"))
            .local()
            .discrete()
            .unit(["m2", "m2/s2"][block])
            .about_by(|i| format!("predicted variance of the innovation, LVLH {}", AXES[i]))
            .vector(3, move |m, i| {
                m.read(|n| of(n, Measures::RelativeState, n.innovation().variance[3 * block + i]))
            });
    }
    t.integer("q.skipped")
        .local()
        .about("updates passed by because the adaptation window was singular")
        .get(|m| m.read(|n| n.skipped()));
    t.integer("q.unsolved")
        .local()
        .about("updates at which the law's solver found no solution, so that the last process noise stayed")
        .get(|m| m.read(|n| n.unsolved()));
}
