//! Everything a master can see of the world: one table, from which the model description is written too.
//!
//! Names, units and meanings that outside programs rely on are fixed; more may be added.

use crate::slave::TruthModel;
use fmi2_export::{Table, TableBuilder};
use interface::Bound;
use interface::mission::Embedded;
use interface::ports::{Kind, Port, Role, Shape, of};
use interface::signals::{Slot, slots};
use truth::{Forces, Moment, PARAMETERS, Parameter};

type Builder = TableBuilder<TruthModel>;

/// The whole table.
pub fn table() -> Table<TruthModel> {
    let mut t = Builder::new();
    t.enumeration_type("Scenario", "mission that comes with the FMU", scenarios());
    t.enumeration_type("Forces", FORCES, Forces::ITEMS.iter().copied());
    study(&mut t);
    for (row, parameter) in PARAMETERS.iter().enumerate() {
        parameter_row(&mut t, row, parameter);
    }
    inputs(&mut t);
    for (port, slot) in slots() {
        sensor_row(&mut t, port, slot);
    }
    for port in of(Role::Truth) {
        truth_row(&mut t, port);
    }
    t.build()
}

const FORCES: &str = "what acts on both vehicles in the scenario formation";

/// Names and meanings of the scenarios.
fn scenarios() -> impl Iterator<Item = (&'static str, String)> {
    Embedded::scenarios().map(|entry| (entry.name, entry.mission().map(|m| m.about).unwrap_or_default()))
}

fn study(t: &mut Builder) {
    t.enumeration("scenario", "Scenario")
        .parameter()
        .start(1)
        .about("which of the missions that come with the FMU is simulated")
        .rw(|m| m.params.choice.scenario, |m, v| m.params.choice.scenario = v);
    t.integer("scenario_index")
        .parameter()
        .min(0)
        .start(0)
        .about("the same as scenario, for tools that know no enumerations; 0: scenario counts")
        .rw(
            |m| m.params.choice.scenario_index,
            |m, v| m.params.choice.scenario_index = v,
        );
    t.string("mission_file")
        .parameter()
        .start("")
        .about("path of a mission file, or name of a mission that comes with the FMU, which then stands for the scenario; empty: none")
        .rw(
            |m| m.params.choice.mission_file.clone(),
            |m, v| m.params.choice.mission_file = v,
        );
    t.integer("study_seed")
        .parameter()
        .min(0)
        .start(1)
        .about("seed of the study; with the run it selects every random stream")
        .rw(
            |m| m.params.study_seed as i32,
            |m, v| m.params.study_seed = v.unsigned_abs(),
        );
    t.integer("run")
        .parameter()
        .min(0)
        .start(0)
        .about("run within the study; with the seed it selects every random stream")
        .rw(|m| m.params.run as i32, |m, v| m.params.run = v.unsigned_abs());
    t.boolean("guidance.burn_enabled")
        .parameter()
        .start(true)
        .about("whether the mission's own burns of the chaser act, also in finding the start from the end")
        .rw(|m| m.params.burn_enabled, |m, v| m.params.burn_enabled = v);
    t.enumeration("formation.forces", "Forces")
        .parameter()
        .start(1)
        .about(FORCES)
        .rw(
            |m| m.params.formation_forces as i32 + 1,
            |m, v| m.params.formation_forces = Forces::from_ordinal(v),
        );
}

fn parameter_row(t: &mut Builder, row: usize, parameter: &'static Parameter) {
    let about = if parameter.own {
        format!("{}; -1: the mission's own", parameter.about)
    } else {
        parameter.about.to_string()
    };
    let variable = t.real(parameter.name.as_ref()).parameter().about(about);
    let variable = match parameter.unit {
        "" => variable.unit("1"),
        "rad" => variable.unit("rad").display_unit("deg"),
        unit => variable.unit(unit),
    };
    let variable = match parameter.bound {
        Bound::Any => variable,
        Bound::AtLeast(least) => variable.min(least),
        Bound::NonNegative => variable.min(0.0),
        Bound::Positive => variable.positive(),
        Bound::PositiveBelow(limit) => variable.positive().max(limit.next_down()),
        Bound::Fraction => variable.min(0.0).max(1.0),
    };
    let variable = if parameter.own {
        variable.own_default()
    } else {
        variable.start(parameter.start)
    };
    match parameter.len {
        1 => variable.rw(
            move |m| m.params.value(row, 0),
            move |m, v| m.params.set_value(row, 0, v),
        ),
        n => variable.vector_rw(
            n,
            move |m, i| m.params.value(row, i),
            move |m, i, v| m.params.set_value(row, i, v),
        ),
    }
}

fn inputs(t: &mut Builder) {
    for port in [Role::Command, Role::Disturbance, Role::Attitude]
        .into_iter()
        .flat_map(of)
    {
        let place: fn(&mut truth::Inputs) -> &mut nalgebra::Vector3<f64> = match port.name {
            "a_cmd_c_n" => |inputs| &mut inputs.a_cmd_c_n,
            "impulse_c_n" => |inputs| &mut inputs.impulse_c_n,
            "a_dist_t_n" => |inputs| &mut inputs.a_dist_t_n,
            "f_dist_t_bt" => |inputs| &mut inputs.f_dist_t_bt,
            "impulse_count" => {
                let row = t.integer(port.name).input().about(port.about(0));
                row.rw(|m| m.inputs.impulse_count, |m, v| m.inputs.impulse_count = v);
                continue;
            }
            "dcm_cmd_bc_n" => {
                let row = t.real(port.name).input().unit(port.unit(0)).about(port.about(0));
                row.matrix_rw(
                    3,
                    3,
                    |m, i, j| m.inputs.dcm_cmd_bc_n[(i, j)],
                    |m, i, j, v| m.inputs.dcm_cmd_bc_n[(i, j)] = v,
                );
                continue;
            }
            // A test misses it.
            _ => continue,
        };
        t.real(port.name)
            .input()
            .unit(port.unit(0))
            .about(port.about(0))
            .vector_rw(
                port.shape.len(),
                move |m, i| place(&mut m.inputs.clone())[i],
                move |m, i, v| place(&mut m.inputs)[i] = v,
            );
    }
}

/// Inputs that push the target.
fn pushes_target() -> impl Iterator<Item = &'static str> {
    of(Role::Disturbance).map(|port| port.name)
}

/// What the newest sample holds; that of a sensor which is not on board is zero.
fn sensor_row(t: &mut Builder, port: &'static Port, slot: Slot) {
    let (name, about) = (port.name, port.about(0));
    match port.kind {
        Kind::Integer => t
            .integer(name)
            .output()
            .about(about)
            .get(move |m| slot.integer(&m.signals)),
        Kind::Boolean => t
            .boolean(name)
            .output()
            .about(about)
            .get(move |m| slot.boolean(&m.signals)),
        _ => {
            let mut row = t.real(name).output().discrete();
            row = if port.unit(0) == "rad" {
                row.unit("rad").display_unit("deg")
            } else {
                row.unit_by(|i| port.unit(i))
            };
            row = row
                .about_by(|i| port.about(i).to_owned())
                .nominal_by(|i| port.nominal(i));
            // The start has no sample yet: the initial estimate, the attitude and the turn of the target's axes are what shows.
            row = match name {
                "nav_init.x" | "omega_lvlh" => pushes_target().fold(row, |row, input| row.initially_from(input)),
                "dcm_bc_n" => row.initially_from("dcm_cmd_bc_n"),
                _ => row,
            };
            match port.shape {
                Shape::Scalar => row.get(move |m| slot.reals(&m.signals)[0]),
                Shape::Vector(n) => row.vector(n, move |m, i| slot.reals(&m.signals)[i]),
                Shape::Matrix(rows, columns) => {
                    row.matrix(rows, columns, move |m, i, j| slot.reals(&m.signals)[columns * i + j])
                }
            }
        }
    }
}

/// The true state at the communication point.
fn truth_row(t: &mut Builder, port: &'static Port) {
    if port.kind == Kind::Boolean {
        let row = t.boolean(port.name).output().about(port.about(0));
        let row = pushes_target().fold(row, |row, input| row.initially_from(input));
        row.get(|m| m.read(|s| s.now().event_active));
        return;
    }
    let part: fn(&Moment, usize) -> f64 = match port.name {
        "truth.r_tc_n" => |now, i| now.state.r_tc()[i],
        "truth.v_tc_n" => |now, i| now.state.v_tc()[i],
        "truth.a_t_n" => |now, i| now.a_t_n[i],
        "truth.r_c_n" => |now, i| now.state.r_c[i],
        "truth.v_c_n" => |now, i| now.state.v_c[i],
        "truth.b_c_bc" => |now, i| now.b_c_bc[i],
        "truth.rho_lvlh" => |now, i| now.relative.map_or(0.0, |r| r.rho_lvlh[i]),
        "truth.rho_dot_lvlh" => |now, i| now.relative.map_or(0.0, |r| r.rho_dot_lvlh[i]),
        "truth.d_lvlh" => |now, i| now.relative.map_or(0.0, |r| r.d_lvlh[i]),
        // A test misses it.
        _ => return,
    };
    let row = t.real(port.name).output().unit(port.unit(0)).about(port.about(0));
    let mut row = row.nominal_by(|i| port.nominal(i));
    // Accelerations as such, and through the turning of the target's axes.
    if matches!(port.name, "truth.a_t_n" | "truth.rho_dot_lvlh" | "truth.d_lvlh") {
        row = pushes_target().fold(row, |row, input| row.initially_from(input));
    }
    if port.name == "truth.d_lvlh" {
        row = row.initially_from("a_cmd_c_n").initially_from("dcm_cmd_bc_n");
    }
    row.vector(port.shape.len(), move |m, i| m.read(|s| part(s.now(), i)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use fmi2_export::{Experiment, Log, Model};
    use interface::Sensor;

    /// Value of a Real variable.
    fn real(model: &TruthModel, name: &str) -> f64 {
        let table = TruthModel::table();
        let entry = table.find(name).and_then(|number| table.entry(number)).unwrap();
        entry.read(model).unwrap()
    }

    fn run(scenario: i32) -> TruthModel {
        let mut model = TruthModel::blank();
        TruthModel::table().apply_start(&mut model);
        model.params.choice.scenario = scenario;
        assert!(model.params.set("sample_period", 2.0));
        let experiment = Experiment {
            start_time: 10.0,
            stop_time: None,
            tolerance: None,
        };
        model.initialise(&experiment, &mut Log::silent()).unwrap();
        model.inputs.a_dist_t_n[2] = 1e-3;
        model.do_step(10.0, 5.0, &mut Log::silent()).unwrap();
        model
    }

    #[test]
    fn every_port_of_the_truth_is_in_the_table() {
        let rows = TruthModel::table().rows();
        for port in interface::ports::PORTS {
            let row = rows.iter().find(|row| row.name == port.name);
            assert_eq!(row.is_some(), port.role != Role::Estimate, "{}", port.name);
            if let Some(row) = row {
                assert_eq!(row.shape.count(), port.shape.len(), "{}", port.name);
            }
        }
    }

    #[test]
    fn outputs_show_the_run() {
        let model = run(1);
        let simulation = model.simulation.clone().unwrap();
        let (sample, now) = (simulation.sample(), simulation.now());
        let expected = [
            ("sample_time", 14.0),
            ("lidar.range", sample[Sensor::Lidar].z[0]),
            ("lidar.azimuth", sample[Sensor::Lidar].z[1]),
            ("lidar.elevation", sample[Sensor::Lidar].z[2]),
            ("accelerometer.alpha_c_bc[2]", sample.accelerometer.alpha_c_bc.y),
            ("dcm_bc_n[1,3]", sample.dcm_bc_n[(0, 2)]),
            ("nav_init.x[1]", simulation.initial_estimate()[0]),
            ("nav_init.x[18]", simulation.initial_estimate()[17]),
            ("truth.r_tc_n[1]", (now.state.r_t - now.state.r_c).x),
            ("truth.v_tc_n[2]", (now.state.v_t - now.state.v_c).y),
            ("truth.a_t_n[3]", 1e-3),
            ("truth.r_c_n[1]", now.state.r_c.x),
            ("truth.v_c_n[3]", now.state.v_c.z),
            ("truth.b_c_bc[2]", now.b_c_bc.y),
            ("metrology.rho_lvlh[2]", 0.0),
            ("target_orbit.r", 0.0),
            ("truth.d_lvlh[1]", 0.0),
            ("camera.azimuth", 0.0),
            ("radio.range", 0.0),
        ];
        for (name, value) in expected {
            assert_eq!(real(&model, name).to_bits(), value.to_bits(), "{name}");
        }
        assert!(now.event_active, "an input pushes the target");
    }

    #[test]
    fn outputs_show_the_formation() {
        let model = run(3);
        let simulation = model.simulation.clone().unwrap();
        let (sample, relative) = (simulation.sample(), simulation.now().relative.unwrap());
        let orbit = sample.target_orbit.unwrap();
        let expected = [
            ("sample_time", 14.0),
            ("lidar.range", 0.0),
            ("metrology.rho_lvlh[2]", sample[Sensor::Metrology].z[1]),
            ("metrology.rho_dot_lvlh[1]", sample[Sensor::Metrology].z[3]),
            ("target_orbit.r", orbit.r),
            ("target_orbit.r_dot", orbit.r_dot),
            ("target_orbit.h", orbit.h),
            ("target_orbit.inclination", orbit.inclination),
            ("target_orbit.argument_of_latitude", orbit.argument_of_latitude),
            ("nav_init.x[2]", simulation.initial_estimate()[1]),
            ("truth.rho_lvlh[2]", relative.rho_lvlh.y),
            ("truth.rho_dot_lvlh[3]", relative.rho_dot_lvlh.z),
            ("truth.d_lvlh[1]", relative.d_lvlh.x),
            ("truth.a_t_n[3]", 1e-3),
        ];
        for (name, value) in expected {
            assert_eq!(real(&model, name).to_bits(), value.to_bits(), "{name}");
        }
    }
}
