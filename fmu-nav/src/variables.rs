//! Everything a master can see of the filter: one table, from which the model description is written too.
//!
//! Names, units and meanings that outside programs rely on are fixed; more may be added. What belongs to one law stands last,
//! so that another law changes no other row.

use crate::slave::NavModel;
use filters::beliefs::{BELIEFS, Belief, Place};
use filters::laws::FILTERS;
use filters::tunable::{self, Tunable, Value};
use filters::{Beliefs, Command, Navigator, Prediction};
use fmi2_export::{Real, Row, Table, TableBuilder};
use interface::mission::{Embedded, Frame};
use interface::ports::{Kind, PORTS, Part, Port, Role, Shape, of};
use interface::signals::{Slot, slots};
use interface::{Bound, Signals, Status};

type Builder = TableBuilder<NavModel>;

/// The whole table.
pub fn table() -> Table<NavModel> {
    let mut t = Builder::new();
    types(&mut t);
    study(&mut t);
    for belief in BELIEFS {
        belief_row(&mut t, belief);
    }
    for (port, slot) in slots() {
        input_row(&mut t, port, slot);
    }
    for port in of(Role::Command) {
        command_row(&mut t, port);
    }
    for (port, shown) in estimates() {
        estimate_row(&mut t, port, shown);
    }
    for (f, filter) in FILTERS.iter().enumerate() {
        for (i, tunable) in filter.tunables.iter().enumerate() {
            tunable_row(&mut t, filter.name, tunable, f, i);
        }
    }
    let tunables = FILTERS.iter().flat_map(|f| f.tunables.iter().map(|t| (f.name, t)));
    let derived = tunables.filter(|(_, tunable)| tunable.kind.derived());
    for (place, (filter, tunable)) in derived.enumerate() {
        resolved_row(&mut t, filter, tunable, place);
    }
    t.build()
}

fn types(t: &mut Builder) {
    t.enumeration_type("Scenario", "mission that comes with the FMU", scenarios());
    t.enumeration_type(
        "Filter",
        "registered filters",
        FILTERS.iter().map(|f| (f.name, f.about)),
    );
    t.enumeration_type(
        "Status",
        "what the filter is doing",
        Status::ALL.iter().map(|(_, name, about)| (*name, *about)),
    );
    let mut known = Vec::new();
    for tunable in FILTERS.iter().flat_map(|f| f.tunables) {
        if let tunable::Kind::Choice {
            type_name,
            about,
            items,
        } = tunable.kind
            && !known.contains(&type_name)
        {
            known.push(type_name);
            t.enumeration_type(type_name, about, items.iter().copied());
        }
    }
}

/// Names and meanings of the scenarios.
fn scenarios() -> impl Iterator<Item = (&'static str, String)> {
    Embedded::scenarios().map(|entry| (entry.name, entry.mission().map(|m| m.about).unwrap_or_default()))
}

fn study(t: &mut Builder) {
    t.enumeration("scenario", "Scenario")
        .parameter()
        .start(1)
        .about("which of the missions that come with the FMU the filter is told of: dynamics, state, and every parameter at -1")
        .rw(|m| m.choice.scenario, |m, v| m.choice.scenario = v);
    t.integer("scenario_index")
        .parameter()
        .min(0)
        .start(0)
        .about("the same as scenario, for tools that know no enumerations; 0: scenario counts")
        .rw(|m| m.choice.scenario_index, |m, v| m.choice.scenario_index = v);
    t.string("mission_file")
        .parameter()
        .start("")
        .about("path of a mission file, or name of a mission that comes with the FMU, which then stands for the scenario; empty: none")
        .rw(|m| m.choice.mission_file.clone(), |m, v| m.choice.mission_file = v);
    t.enumeration("filter", "Filter")
        .parameter()
        .start(1)
        .about("which filter runs")
        .rw(|m| m.filter, |m, v| m.filter = v);
    t.integer("filter_index")
        .parameter()
        .min(0)
        .start(0)
        .about("the same as filter, for tools that know no enumerations; 0: filter counts")
        .rw(|m| m.filter_index, |m, v| m.filter_index = v);
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
    t.boolean("guidance.burn_enabled")
        .parameter()
        .start(true)
        .about("whether the mission's own burns of the chaser act, so that the filter reckons with those that it is told of; as in fmu-truth")
        .rw(|m| m.burn_enabled, |m, v| m.burn_enabled = v);
}

/// From an FMI enumeration value, counted from 1 and range-checked before it gets here, to an index.
fn index(item: i32) -> usize {
    usize::try_from(item - 1).unwrap_or_default()
}

/// A real parameter; `None` as start means "the mission's own", shown as -1.
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
        Bound::AtLeast(least) => row.min(least),
        Bound::NonNegative => row.min(0.0),
        Bound::PositiveBelow(limit) => row.positive().max(limit.next_down()),
        Bound::Fraction => row.min(0.0).max(1.0),
        Bound::Any => row,
    };
    match start {
        Some(start) => row.start(start).about(about),
        None => row.own_default().about(format!("{about}; -1: the mission's own")),
    }
}

fn belief_row(t: &mut Builder, belief: &'static Belief) {
    let Belief {
        name,
        unit,
        bound,
        about,
        place,
    } = *belief;
    let mut start = Beliefs::default();
    match place {
        Place::Real(at) => {
            let start = (!belief.own()).then(|| *at(&mut start));
            real_parameter(t, name, unit, bound, start, about).rw(
                move |m| *at(&mut m.settings.beliefs.clone()),
                move |m, v| *at(&mut m.settings.beliefs) = v,
            );
        }
        Place::Integer(at) => {
            let mut row = t.integer(name).parameter().start(*at(&mut start)).about(about);
            if let Bound::AtLeast(least) = bound {
                row = row.min(least as i32);
            }
            row.rw(
                move |m| *at(&mut m.settings.beliefs.clone()),
                move |m, v| *at(&mut m.settings.beliefs) = v,
            );
        }
        Place::Boolean(at) => t.boolean(name).parameter().start(*at(&mut start)).about(about).rw(
            move |m| *at(&mut m.settings.beliefs.clone()),
            move |m, v| *at(&mut m.settings.beliefs) = v,
        ),
    }
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
        tunable::Kind::Real { start, unit, bound } => {
            let (get, set) = stored!(f, i, Real, 0.0);
            real_parameter(t, &name, unit, bound, start.fixed(), tunable.about).rw(get, set);
        }
        tunable::Kind::Integer { start, min, max } => {
            let (get, set) = stored!(f, i, Integer, 0);
            t.integer(name)
                .parameter()
                .min(min)
                .max(max)
                .start(start)
                .about(tunable.about)
                .rw(get, set);
        }
        tunable::Kind::Boolean { start } => {
            let (get, set) = stored!(f, i, Boolean, false);
            t.boolean(name)
                .parameter()
                .start(start)
                .about(tunable.about)
                .rw(get, set);
        }
        tunable::Kind::Choice { type_name, .. } => {
            let (get, set) = stored!(f, i, Choice, 0);
            t.enumeration(name, type_name)
                .parameter()
                .start(1)
                .about(tunable.about)
                .rw(move |m| get(m) as i32 + 1, move |m, v| set(m, index(v)));
        }
    }
}

/// What a tunable that may be left to the mission comes to.
fn resolved_row(t: &mut Builder, filter: &str, tunable: &Tunable, place: usize) {
    let tunable::Kind::Real { unit, .. } = tunable.kind else {
        return;
    };
    let name = format!("{filter}.{}", tunable.name);
    let row = t.real(format!("resolved.{name}")).calculated_parameter();
    let row = if unit.is_empty() { row } else { row.unit(unit) };
    row.about(format!(
        "{name} as it acts from initialization on: the mission's own value where it is left at -1"
    ))
    .get(move |m| m.resolved.get(place).copied().unwrap_or(Beliefs::OWN));
}

/// Unit and order of magnitude of every element of a port.
fn with_unit<'t>(row: Row<'t, NavModel, Real>, port: &'static Port) -> Row<'t, NavModel, Real> {
    let row = row.nominal_by(|i| port.nominal(i));
    if port.unit(0) == "rad" {
        row.unit("rad").display_unit("deg")
    } else {
        row.unit_by(|i| port.unit(i))
    }
}

/// An input, which starts at what a truth means that does not know of it.
fn input_row(t: &mut Builder, port: &'static Port, slot: Slot) {
    let (name, about, start) = (port.name, port.about(0), Signals::default());
    match port.kind {
        Kind::Integer => t.integer(name).input().start(slot.integer(&start)).about(about).rw(
            move |m| slot.integer(&m.inputs),
            move |m, v| slot.set_integer(&mut m.inputs, v),
        ),
        Kind::Boolean => t.boolean(name).input().start(slot.boolean(&start)).about(about).rw(
            move |m| slot.boolean(&m.inputs),
            move |m, v| slot.set_boolean(&mut m.inputs, v),
        ),
        _ => {
            let row = t.real(name).input().discrete();
            let row = if port.at_times_invalid() { row.any_number() } else { row };
            let row = with_unit(row, port)
                .start_by(move |i| slot.reals(&start)[i])
                .about_by(|i| port.about(i).to_owned());
            let get = move |m: &NavModel, i: usize| slot.reals(&m.inputs)[i];
            let set = move |m: &mut NavModel, i: usize, v| slot.reals_mut(&mut m.inputs)[i] = v;
            match port.shape {
                Shape::Scalar => row.rw(move |m| get(m, 0), move |m, v| set(m, 0, v)),
                Shape::Vector(n) => row.vector_rw(n, get, set),
                Shape::Matrix(rows, columns) => row.matrix_rw(
                    rows,
                    columns,
                    move |m, i, j| get(m, columns * i + j),
                    move |m, i, j, v| set(m, columns * i + j, v),
                ),
            }
        }
    }
}

/// An input that says what the chaser is commanded to do.
fn command_row(t: &mut Builder, port: &'static Port) {
    let about = port.about(0);
    let place: fn(&mut Command) -> &mut nalgebra::Vector3<f64> = match port.name {
        "a_cmd_c_n" => |command| &mut command.a_cmd_c_n,
        "impulse_c_n" => |command| &mut command.impulse_c_n,
        "impulse_count" => {
            let row = t.integer(port.name).input().about(about);
            row.rw(|m| m.command.impulse_count, |m, v| m.command.impulse_count = v);
            return;
        }
        // A test misses it.
        _ => return,
    };
    let row = t.real(port.name).input().unit(port.unit(0)).about(about);
    row.vector_rw(
        port.shape.len(),
        move |m, i| place(&mut m.command.clone())[i],
        move |m, i, v| place(&mut m.command)[i] = v,
    );
}

/// How a port of the estimate is read from a running filter; elements count from 0, matrices go row by row.
enum Shown {
    Real(fn(&Navigator, usize) -> f64),
    Integer(fn(&Navigator) -> i32),
    Boolean(fn(&Navigator) -> bool),
    /// Of the prediction.
    Predicted(fn(&Prediction, usize) -> f64),
    /// Measured minus predicted, from this place of an innovation on.
    Innovation(usize),
    /// Predicted variance, likewise.
    Variance(usize),
    /// The status, which has a value before the filter runs.
    Status,
    /// Its number.
    StatusIndex,
}

/// Every port of the estimate with its reader.
fn estimates() -> impl Iterator<Item = (&'static Port, Shown)> {
    of(Role::Estimate).filter_map(|port| Some((port, shown(port)?)))
}

fn shown(port: &Port) -> Option<Shown> {
    use Shown::{Boolean, Integer, Predicted, Real, Status, StatusIndex};
    match port.part {
        Some((sensor, Part::Innovation(first))) => return Some(Shown::Innovation(sensor.channels().start + first)),
        Some((sensor, Part::Variance(first))) => return Some(Shown::Variance(sensor.channels().start + first)),
        _ => (),
    }
    Some(match port.name {
        "est.time" => Real(|n, _| n.estimate().time),
        "est.count" => Integer(|n| n.estimate().count),
        "est.dimension" => Integer(|n| n.dimension() as i32),
        "est.r_tc_n" => Real(|n, i| n.relative_n().0[i]),
        "est.v_tc_n" => Real(|n, i| n.relative_n().1[i]),
        "est.a_t_n" => Real(|n, i| inertial(n, n.estimate().x[6 + i])),
        "est.r_c_n" => Real(|n, i| inertial(n, n.estimate().x[9 + i])),
        "est.v_c_n" => Real(|n, i| inertial(n, n.estimate().x[12 + i])),
        "est.b_c_bc" => Real(|n, i| inertial(n, n.estimate().x[15 + i])),
        "est.rho_lvlh" => Real(|n, i| lvlh(n, n.estimate().x[i])),
        "est.rho_dot_lvlh" => Real(|n, i| lvlh(n, n.estimate().x[3 + i])),
        "est.d_lvlh" => Real(|n, i| lvlh(n, n.estimate().x[6 + i])),
        "est.acceleration_valid" => Boolean(Navigator::estimates_acceleration),
        "nis" => Real(|n, _| n.innovation().nis),
        // None before the first measurement, and none of which there is a covariance under a constant gain.
        "nis.rows" => Integer(|n| {
            if n.dimension() > 0 {
                n.innovation().rows as i32
            } else {
                0
            }
        }),
        "q.s" => Real(|n, i| n.s()[i]),
        "q.updates" => Integer(Navigator::updates),
        "q.skipped" => Integer(Navigator::skipped),
        "q.unsolved" => Integer(Navigator::unsolved),
        "edited.outliers" => Integer(Navigator::outliers),
        "edited.impossible" => Integer(Navigator::impossible),
        "edited.duplicates" => Integer(Navigator::duplicates),
        "edited.restarts" => Integer(Navigator::restarts),
        "status" => Status,
        "status_index" => StatusIndex,
        "pred.time" => Predicted(|p, _| p.time),
        "pred.r_tc_n" => Predicted(|p, i| p.r_tc_n[i]),
        "pred.v_tc_n" => Predicted(|p, i| p.v_tc_n[i]),
        "pred.rho_lvlh" => Predicted(|p, i| p.rho_lvlh[i]),
        "pred.rho_dot_lvlh" => Predicted(|p, i| p.rho_dot_lvlh[i]),
        "pred.sigma" => Predicted(|p, i| p.sigma[i]),
        "cov.sigma" => Real(|n, i| n.estimate().sigma[i]),
        "cov.p" => Real(|n, i| n.estimate().p_target[(i / 9, i % 9)]),
        _ => return None,
    })
}

/// `value` of a filter whose state stands in axes N, else 0.
fn inertial(navigator: &Navigator, value: f64) -> f64 {
    of_frame(navigator, Frame::Inertial, value)
}

/// `value` of a filter whose state stands in the target's LVLH axes, else 0.
fn lvlh(navigator: &Navigator, value: f64) -> f64 {
    of_frame(navigator, Frame::Lvlh, value)
}

fn of_frame(navigator: &Navigator, frame: Frame, value: f64) -> f64 {
    if navigator.frame() == frame { value } else { 0.0 }
}

fn estimate_row(t: &mut Builder, port: &'static Port, shown: Shown) {
    let (name, about) = (port.name, port.about(0));
    match shown {
        Shown::Integer(get) => t.integer(name).output().about(about).get(move |m| m.read(get)),
        Shown::Boolean(get) => t.boolean(name).output().about(about).get(move |m| m.read(get)),
        Shown::Status => t
            .enumeration(name, "Status")
            .output()
            .about(about)
            .get(|m| m.status().number()),
        Shown::StatusIndex => t.integer(name).output().about(about).get(|m| m.status().number()),
        Shown::Real(get) => real_estimate(t, port, move |m, i| m.read(|n| get(n, i))),
        Shown::Predicted(get) => real_estimate(t, port, move |m, i| get(m.predicted(), i)),
        Shown::Innovation(first) => {
            real_estimate(t, port, move |m, i| m.read(|n| n.innovation().residual[first + i]));
        }
        Shown::Variance(first) => real_estimate(t, port, move |m, i| m.read(|n| n.innovation().variance[first + i])),
    }
}

fn real_estimate(
    t: &mut Builder,
    port: &'static Port,
    get: impl Fn(&NavModel, usize) -> f64 + Copy + Send + Sync + 'static,
) {
    let name = port.name;
    let mut row = t.real(name);
    // What holds at a sample changes there; a prediction changes with every step.
    if !name.starts_with("pred.") {
        row = row.discrete();
    }
    let mut row = with_unit(row, port).about_by(|i| port.about(i).to_owned());
    // Before the first sample they are those of the initial estimate.
    let state = [
        "est.r_tc_n",
        "est.v_tc_n",
        "est.a_t_n",
        "est.r_c_n",
        "est.v_c_n",
        "est.b_c_bc",
    ];
    let in_lvlh = ["est.rho_lvlh", "est.rho_dot_lvlh", "est.d_lvlh"];
    let spread = name.starts_with("pred.") && name != "pred.time" || name.starts_with("cov.");
    if state.contains(&name) || in_lvlh.contains(&name) || spread {
        row = row.initially_from("nav_init.x");
    }
    if matches!(name, "est.r_tc_n" | "est.v_tc_n" | "pred.r_tc_n" | "pred.v_tc_n") {
        row = row.initially_from("dcm_lvlh_n").initially_from("omega_lvlh");
    }
    // How the axes turn, where nobody says it, and what the better model has beyond the simpler one.
    if matches!(
        name,
        "est.r_tc_n" | "est.v_tc_n" | "pred.r_tc_n" | "pred.v_tc_n" | "est.d_lvlh"
    ) {
        let orbit = PORTS.iter().filter(|port| port.name.starts_with("target_orbit."));
        row = orbit.fold(row, |row, port| row.initially_from(port.name));
    }
    match port.shape {
        Shape::Scalar => row.output().get(move |m| get(m, 0)),
        Shape::Vector(count) => row.output().vector(count, get),
        // Not an output: it would crowd every master's result file.
        Shape::Matrix(rows, columns) => {
            row.local()
                .matrix(rows, columns, move |m, i, j| get(m, columns * i + j));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fmi2_export::{Experiment, Log, Model};
    use interface::Sensor;
    use interface::signals::Seen;
    use std::path::Path;

    /// Value of a variable.
    fn real(model: &NavModel, name: &str) -> f64 {
        let table = NavModel::table();
        let entry = table.find(name).and_then(|number| table.entry(number)).unwrap();
        entry.read(model).unwrap()
    }

    fn integer(model: &NavModel, name: &str) -> i32 {
        let table = NavModel::table();
        let entry = table.find(name).and_then(|number| table.entry(number)).unwrap();
        entry.read(model).unwrap()
    }

    fn started(scenario: i32) -> NavModel {
        let mut model = NavModel::blank();
        NavModel::table().apply_start(&mut model);
        model.choice.scenario = scenario;
        model
    }

    fn initialised(mut model: NavModel) -> NavModel {
        let experiment = Experiment {
            start_time: 0.0,
            stop_time: None,
            tolerance: None,
        };
        model.initialise(&experiment, &mut Log::silent()).unwrap();
        model
    }

    /// A sample at `t` seconds, which is also its ordinal, with every sensor's measurement; both vehicles in low orbit.
    fn sampled(model: NavModel, t: i32) -> NavModel {
        sampled_with(model, t, |_| ())
    }

    /// The same, changed.
    fn sampled_with(mut model: NavModel, t: i32, change: impl Fn(&mut Signals)) -> NavModel {
        let mut init = [0.0; 18];
        init[..6].copy_from_slice(&[500.0, 30.0, -20.0, -0.5, 0.1, 0.0]);
        init[9..15].copy_from_slice(&[6.878e6, 0.0, 0.0, 0.0, 7.6e3, 0.0]);
        model.inputs = Signals {
            sample_time: f64::from(t),
            sample_count: t,
            target_orbit: [8.1e6, 10.0, 5.6e10, 0.5, 0.25, -1.5],
            // Body y, the boresight, along N x.
            dcm_bc_n: [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            nav_init: init,
            ..model.inputs
        };
        for (sensor, z) in [
            (Sensor::Lidar, [501.0, 1e-4, -2e-4, 0.0, 0.0, 0.0]),
            (Sensor::Metrology, [500.0, 30.0, -20.0, -0.5, 0.1, 0.0]),
        ] {
            model.inputs[sensor] = Seen {
                due: true,
                valid: true,
                z,
            };
        }
        change(&mut model.inputs);
        model.do_step(f64::from(t - 1), 1.0, &mut Log::silent()).unwrap();
        model
    }

    #[test]
    fn every_port_of_the_filter_is_in_the_table() {
        let rows = NavModel::table().rows();
        for port in PORTS {
            let row = rows.iter().find(|row| row.name == port.name);
            let ours = !matches!(port.role, Role::Disturbance | Role::Attitude | Role::Truth);
            assert_eq!(row.is_some(), ours, "{}", port.name);
            if let Some(row) = row {
                assert_eq!(row.shape.count(), port.shape.len(), "{}", port.name);
            }
        }
    }

    #[test]
    fn tunables_stand_last() {
        let rows = NavModel::table().rows();
        let of_a_law = |name: &str| FILTERS.iter().any(|f| name.starts_with(&format!("{}.", f.name)));
        let first = rows.iter().position(|row| of_a_law(&row.name)).unwrap();
        let tunables: usize = FILTERS.iter().map(|f| f.tunables.len()).sum();
        let (own, resolved) = rows[first..].split_at(tunables);
        assert!(own.iter().all(|row| of_a_law(&row.name)));
        assert!(resolved.iter().all(|row| row.name.starts_with("resolved.")));
    }

    /// What the mission states, what is set, and what follows from the mission's scales.
    #[test]
    fn a_tunable_left_to_the_mission_is_shown_as_it_acts() {
        let mut model = started(1);
        let shown = |model: &NavModel, name: &str| real(model, name).to_bits();
        assert_eq!(shown(&model, "resolved.milton.psi0"), (-1.0_f64).to_bits());
        let navigation = model.choice.mission().unwrap().navigation();
        *model.settings.tunable_mut("milton", "psi0").unwrap() = tunable::Value::Real(7.5);
        let model = initialised(model);
        assert_eq!(shown(&model, "milton.s0"), (-1.0_f64).to_bits());
        assert_eq!(
            shown(&model, "resolved.milton.s0"),
            navigation.law["milton.s0"].to_bits()
        );
        assert_eq!(shown(&model, "resolved.milton.psi0"), 7.5_f64.to_bits());
        assert_eq!(
            shown(&model, "resolved.dmc.sigma"),
            navigation.scale.disturbance_m_s2.to_bits()
        );
    }

    #[test]
    fn inputs_start_at_what_a_truth_means_that_does_not_know_of_them() {
        assert_eq!(started(1).inputs, Signals::default());
    }

    #[test]
    fn outputs_show_the_estimate() {
        let model = sampled(initialised(started(1)), 1);
        let n = model.navigator.clone().unwrap();
        let (estimate, innovation) = (n.estimate(), n.innovation());
        let expected = [
            ("est.time", 1.0),
            ("est.r_tc_n[1]", estimate.x[0]),
            ("est.v_tc_n[2]", estimate.x[4]),
            ("est.a_t_n[3]", estimate.x[8]),
            ("est.r_c_n[1]", estimate.x[9]),
            ("est.v_c_n[2]", estimate.x[13]),
            ("est.b_c_bc[3]", estimate.x[17]),
            ("est.rho_lvlh[1]", 0.0),
            ("nis", innovation.nis),
            ("q.s[2]", n.s()[1]),
            ("cov.sigma[1]", estimate.p_target[(0, 0)].sqrt()),
            ("cov.sigma[18]", estimate.sigma[17]),
            ("cov.p[1,4]", estimate.p_target[(0, 3)]),
            ("cov.p[9,2]", estimate.p_target[(8, 1)]),
            ("innov.range", innovation.residual[0]),
            ("innov.azimuth", innovation.residual[1]),
            ("innov.elevation", innovation.residual[2]),
            ("innov.s[3]", innovation.variance[2]),
            ("innov.rho[1]", 0.0),
            ("innov.rho_s[1]", 0.0),
        ];
        for (name, value) in expected {
            assert_eq!(real(&model, name).to_bits(), value.to_bits(), "{name}");
        }
        // Nearly along the boresight, half a kilometre away.
        assert!((real(&model, "est.r_tc_n[1]") - 500.0).abs() < 20.0);
        assert!(real(&model, "innov.range").abs() > 0.0 && real(&model, "cov.p[1,4]").abs() > 0.0);
        let expected = [
            ("est.count", 1),
            ("est.dimension", 9),
            ("nis.rows", 3),
            ("status", Status::Tracking.number()),
        ];
        for (name, value) in expected {
            assert_eq!(integer(&model, name), value, "{name}");
        }
    }

    /// The same sample twice, and in one of them everything that is not valid is no number.
    #[test]
    fn what_is_not_valid_may_be_anything() {
        for scenario in [1, 3] {
            for (number, nothing) in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].into_iter().enumerate() {
                let fly = |spoilt: bool| {
                    let mut model = initialised(started(scenario));
                    for t in 1..=20 {
                        model.inputs.accelerometer_valid = t % 3 == number as i32;
                        model.inputs.alpha_c_bc = [1e-6; 3];
                        if spoilt && !model.inputs.accelerometer_valid {
                            model.inputs.alpha_c_bc = [nothing; 3];
                        }
                        model = sampled_with(model, t, |inputs| {
                            for sensor in Sensor::ALL {
                                inputs[sensor].valid &= t % 4 != 0;
                                if spoilt && !inputs[sensor].valid {
                                    inputs[sensor].z = [nothing; Sensor::MOST_ROWS];
                                }
                            }
                        });
                    }
                    model
                };
                let (plain, spoilt) = (fly(false), fly(true));
                let of = |model: &NavModel| {
                    let navigator = model.navigator.clone().unwrap();
                    (navigator.estimate().clone(), navigator.impossible(), navigator.status())
                };
                assert_eq!(of(&plain), of(&spoilt), "scenario {scenario}, {nothing}");
                assert_eq!(of(&spoilt).1, 0);
            }
        }
    }

    /// Handed over again under a new count, counted from one again, and no more: each is said, and none is an error.
    #[test]
    fn a_source_that_stumbles_is_said() {
        let said = |model: &NavModel| {
            let edited = ["edited.duplicates", "edited.restarts"].map(|name| integer(model, name));
            (integer(model, "est.count"), edited, model.status())
        };
        let mut model = initialised(started(1));
        for t in 1..=3 {
            model = sampled(model, t);
        }
        let before = model.navigator.clone().unwrap().estimate().clone();
        for count in [4, 4, 5] {
            model = sampled_with(model, 3, |inputs| inputs.sample_count = count);
        }
        assert_eq!(said(&model), (3, [2, 0], Status::Tracking));
        assert_eq!(model.navigator.clone().unwrap().estimate(), &before);
        for (t, count) in [(4, 1), (5, 2)] {
            model = sampled_with(model, t, |inputs| inputs.sample_count = count);
        }
        assert_eq!(said(&model), (2, [2, 1], Status::Tracking));
        // Twelve quarters of a second are three periods.
        for quarter in 1..=12 {
            model
                .do_step(5.0 + 0.25 * f64::from(quarter), 0.25, &mut Log::silent())
                .unwrap();
            assert_eq!(model.status(), Status::Tracking, "{quarter}");
        }
        model.do_step(8.25, 0.25, &mut Log::silent()).unwrap();
        assert_eq!(integer(&model, "status"), 5);
        model = sampled_with(model, 9, |inputs| inputs.sample_count = 3);
        assert_eq!(model.status(), Status::Tracking);
    }

    #[test]
    fn a_valid_measurement_that_is_no_number_is_impossible() {
        let model = sampled_with(initialised(started(1)), 1, |inputs| {
            inputs[Sensor::Lidar].z[1] = f64::NAN;
            inputs.alpha_c_bc[2] = f64::NAN;
        });
        assert_eq!(integer(&model, "edited.impossible"), 2);
        assert_eq!(model.status(), Status::Coasting);
        assert!(model.navigator.unwrap().estimate().x.iter().all(|v| v.is_finite()));
    }

    #[test]
    fn outputs_show_the_formation() {
        let model = sampled(initialised(started(3)), 1);
        let n = model.navigator.clone().unwrap();
        let (estimate, innovation) = (n.estimate(), n.innovation());
        let expected = [
            ("est.r_tc_n[1]", 0.0),
            ("est.rho_lvlh[2]", estimate.x[1]),
            ("est.rho_dot_lvlh[1]", estimate.x[3]),
            ("est.d_lvlh[3]", estimate.x[8]),
            ("innov.range", 0.0),
            ("innov.rho[1]", innovation.residual[7]),
            ("innov.rho_s[3]", innovation.variance[9]),
            ("innov.rho_dot[2]", innovation.residual[11]),
            ("innov.rho_dot_s[1]", innovation.variance[10]),
        ];
        for (name, value) in expected {
            assert_eq!(real(&model, name).to_bits(), value.to_bits(), "{name}");
        }
        assert_eq!(integer(&model, "nis.rows"), 6);
    }

    #[test]
    fn before_the_first_sample_nothing_is_claimed() {
        let model = initialised(started(1));
        assert_eq!(integer(&model, "status"), Status::Initialising.number());
        assert_eq!(integer(&model, "nis.rows"), 0);
        assert_eq!(integer(&started(1), "status"), Status::Initialising.number());
    }

    #[test]
    fn a_mission_file_goes_before_the_scenario() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../missions/formation.toml");
        let mut told = started(1);
        told.choice.mission_file = path.to_string_lossy().into_owned();
        let (told, same) = (sampled(initialised(told), 1), sampled(initialised(started(3)), 1));
        assert_eq!(told.navigator.unwrap().estimate(), same.navigator.unwrap().estimate());
    }

    #[test]
    fn a_mission_that_cannot_be_had_is_named() {
        let experiment = Experiment {
            start_time: 0.0,
            stop_time: None,
            tolerance: None,
        };
        for (scenario, file, part) in [(1, "nowhere/none.toml", "none.toml"), (9, "", "1 (leo_venting)")] {
            let mut model = started(scenario);
            model.choice.mission_file = file.to_owned();
            let error = model
                .initialise(&experiment, &mut Log::silent())
                .unwrap_err()
                .to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
