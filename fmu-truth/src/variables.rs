//! Everything a master can see of the world: one table, from which the model description is written too.
//!
//! Names, units and meanings that outside programs rely on are fixed; more may be added.

use crate::model::TruthModel;
use astro::TargetOrbit;
use fmi2_export::{Table, TableBuilder};
use truth::{Bound, CHOICES, Choice, LidarSample, Moment, PARAMETERS, Parameter, Params, Scenario, WORLDS};

type Builder = TableBuilder<TruthModel>;

/// The whole table.
pub fn table() -> Table<TruthModel> {
    let mut t = Builder::new();
    t.enumeration_type(
        "Scenario",
        "world that is simulated",
        WORLDS.iter().map(|world| (world.name, world.about)),
    );
    for choice in CHOICES {
        t.enumeration_type(choice.type_name, choice.about, choice.items.iter().copied());
    }
    study(&mut t);
    for choice in CHOICES {
        choice_row(&mut t, choice);
    }
    for parameter in PARAMETERS {
        parameter_row(&mut t, parameter);
    }
    inputs(&mut t);
    sensors(&mut t);
    metrology(&mut t);
    initial_estimate(&mut t);
    truth(&mut t);
    t.build()
}

fn study(t: &mut Builder) {
    t.enumeration("scenario", "Scenario")
        .parameter()
        .start(1)
        .about("which world is simulated")
        .rw(
            |m| m.params.scenario.into(),
            // Range-checked before it gets here.
            |m, v| m.params.scenario = Scenario::try_from(v).unwrap_or_default(),
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
}

fn choice_row(t: &mut Builder, choice: &'static Choice) {
    t.enumeration(choice.name, choice.type_name)
        .parameter()
        .start(1)
        .about(choice.about)
        .rw(|m| (choice.get)(&m.params), |m, v| (choice.set)(&mut m.params, v));
}

fn parameter_row(t: &mut Builder, parameter: &'static Parameter) {
    let row = t
        .real(parameter.name)
        .parameter()
        .about(parameter.about)
        .start(parameter.start);
    let row = match parameter.unit {
        "" => row.unit("1"),
        "rad" => row.unit("rad").display_unit("deg"),
        unit => row.unit(unit),
    };
    let row = match parameter.bound {
        Bound::Any => row,
        Bound::AtLeast(least) => row.min(least),
        Bound::Positive => row.positive(),
        Bound::Probability => row.min(0.0).max(1.0),
        Bound::OwnOrNonNegative => row.min(0.0).own_default(),
    };
    let (values, values_mut) = (parameter.values, parameter.values_mut);
    match values(&Params::default()).len() {
        1 => row.rw(
            move |m| values(&m.params)[0],
            move |m, v| values_mut(&mut m.params)[0] = v,
        ),
        n => row.vector_rw(
            n,
            move |m, i| values(&m.params)[i],
            move |m, i, v| values_mut(&mut m.params)[i] = v,
        ),
    }
}

fn inputs(t: &mut Builder) {
    t.real("a_cmd_c_n")
        .input()
        .unit("m/s2")
        .about("extra acceleration of the chaser, axes N; acts from the next grid point, the accelerometer feels it")
        .vector_rw(3, |m, i| m.inputs.a_cmd_c_n[i], |m, i, v| m.inputs.a_cmd_c_n[i] = v);
    t.real("a_dist_t_n")
        .input()
        .unit("m/s2")
        .about("extra acceleration of the target, axes N; acts from the next grid point")
        .vector_rw(3, |m, i| m.inputs.a_dist_t_n[i], |m, i, v| m.inputs.a_dist_t_n[i] = v);
}

/// The newest sample.
fn sensors(t: &mut Builder) {
    t.real("sample_time")
        .output()
        .discrete()
        .unit("s")
        .about("epoch of the newest sensor sample; 0 before the first")
        .get(|m| m.read(|s| s.sample().time));
    t.integer("sample_count")
        .output()
        .about("ordinal of the newest sensor sample; 0 before the first")
        .get(|m| m.read(|s| i32::try_from(s.sample().count).unwrap_or(i32::MAX)));
    t.boolean("lidar.valid")
        .output()
        .about("whether the LiDAR saw the target; if not, range and angles keep their last values")
        .get(|m| m.read(|s| s.sample().lidar.valid));
    t.real("lidar.range")
        .output()
        .discrete()
        .unit("m")
        .about("measured distance from chaser to target")
        .get(|m| m.read(|s| s.sample().lidar.range));
    type Angle = fn(&LidarSample) -> f64;
    let angles: [(&str, &str, Angle); 2] = [
        (
            "lidar.azimuth",
            "measured angle atan(rho_x / rho_z) in LiDAR axes",
            |l| l.azimuth,
        ),
        (
            "lidar.elevation",
            "measured angle atan(rho_y / rho_z) in LiDAR axes",
            |l| l.elevation,
        ),
    ];
    for (name, about, angle) in angles {
        t.real(name)
            .output()
            .discrete()
            .unit("rad")
            .display_unit("deg")
            .about(about)
            .get(move |m| m.read(|s| angle(&s.sample().lidar)));
    }
    t.real("accelerometer.alpha_c_bc")
        .output()
        .discrete()
        .unit("m/s2")
        .about("accelerometer reading, chaser body axes: the acceleration just after the epoch")
        .vector(3, |m, i| m.read(|s| s.sample().alpha_c_bc[i]));
    t.real("dcm_bc_n")
        .output()
        .discrete()
        .unit("1")
        .about("attitude of the chaser at the epoch: direction cosine matrix from axes N to chaser body axes")
        .matrix(3, 3, |m, i, j| m.read(|s| s.sample().dcm_bc_n[(i, j)]));
}

/// What the newest sample holds in worlds with metrology; zero in the others.
fn metrology(t: &mut Builder) {
    t.boolean("metrology.valid")
        .output()
        .about("whether the metrology saw the target; if not, its measurement keeps the last values")
        .get(|m| m.read(|s| s.sample().metrology.valid));
    t.real("metrology.rho_lvlh")
        .output()
        .discrete()
        .unit("m")
        .about("measured position of the chaser relative to the target, LVLH axes of the target; formation")
        .vector(3, |m, i| m.read(|s| s.sample().metrology.rho_lvlh[i]));
    t.real("metrology.rho_dot_lvlh")
        .output()
        .discrete()
        .unit("m/s")
        .about("measured rate of that position as seen in the turning LVLH axes; formation")
        .vector(3, |m, i| m.read(|s| s.sample().metrology.rho_dot_lvlh[i]));
    type Element = fn(&TargetOrbit) -> f64;
    let elements: [(&str, &str, &str, Element); 5] = [
        ("target_orbit.r", "m", "geocentric distance of the target", |o| o.r),
        ("target_orbit.r_dot", "m/s", "rate of that distance", |o| o.r_dot),
        (
            "target_orbit.h",
            "m2/s",
            "angular momentum of the target per unit mass",
            |o| o.h,
        ),
        (
            "target_orbit.inclination",
            "rad",
            "inclination of the target's orbit",
            |o| o.inclination,
        ),
        (
            "target_orbit.argument_of_latitude",
            "rad",
            "angle from the ascending node to the target, in (-pi, pi]",
            |o| o.argument_of_latitude,
        ),
    ];
    for (name, unit, about, element) in elements {
        let row = t.real(name).output().discrete().unit(unit).about(format!(
            "{about}, at the epoch of the newest sample, before the first at the start; formation"
        ));
        let row = if unit == "rad" { row.display_unit("deg") } else { row };
        row.get(move |m| m.read(|s| s.sample().target_orbit.as_ref().map_or(0.0, element)));
    }
}

fn initial_estimate(t: &mut Builder) {
    /// Unit and meaning of each group of three.
    const PARTS: [(&str, &str); 6] = [
        (
            "m",
            "position of the target relative to the chaser, axes N; formation: as metrology.rho_lvlh",
        ),
        (
            "m/s",
            "velocity of the target relative to the chaser, axes N; formation: as metrology.rho_dot_lvlh",
        ),
        ("m/s2", "unmodelled acceleration of the target, axes N; formation: 0"),
        ("m", "position of the chaser, axes N; formation: 0"),
        ("m/s", "velocity of the chaser, axes N; formation: 0"),
        ("m/s2", "accelerometer bias, chaser body axes; formation: 0"),
    ];
    t.real("nav_init.x")
        .output()
        .discrete()
        .unit_by(|i| PARTS[i / 3].0)
        .about_by(|i| format!("initial estimate drawn around the truth: {}", PARTS[i / 3].1))
        .initially_from("a_dist_t_n")
        .vector(18, |m, i| m.read(|s| s.initial_estimate()[i]));
}

/// The true state at the communication point.
fn truth(t: &mut Builder) {
    type Part = fn(&Moment, usize) -> f64;
    let parts: [(&str, &str, &str, Part); 9] = [
        (
            "truth.r_tc_n",
            "m",
            "true position of the target relative to the chaser, axes N",
            |now, i| now.state.r_tc()[i],
        ),
        (
            "truth.v_tc_n",
            "m/s",
            "true velocity of the target relative to the chaser, axes N",
            |now, i| now.state.v_tc()[i],
        ),
        (
            "truth.a_t_n",
            "m/s2",
            "true acceleration of the target by vents, target_burn and a_dist_t_n, axes N, just after this time",
            |now, i| now.a_t_n[i],
        ),
        ("truth.r_c_n", "m", "true position of the chaser, axes N", |now, i| {
            now.state.r_c[i]
        }),
        ("truth.v_c_n", "m/s", "true velocity of the chaser, axes N", |now, i| {
            now.state.v_c[i]
        }),
        (
            "truth.b_c_bc",
            "m/s2",
            "true accelerometer bias, chaser body axes",
            |now, i| now.b_c_bc[i],
        ),
        (
            "truth.rho_lvlh",
            "m",
            "true position of the chaser relative to the target, LVLH axes of the target; formation",
            |now, i| now.relative.map_or(0.0, |r| r.rho_lvlh[i]),
        ),
        (
            "truth.rho_dot_lvlh",
            "m/s",
            "true rate of that position as seen in the turning LVLH axes; formation",
            |now, i| now.relative.map_or(0.0, |r| r.rho_dot_lvlh[i]),
        ),
        (
            "truth.d_lvlh",
            "m/s2",
            "true relative acceleration less that of Clohessy-Wiltshire motion, LVLH axes, just after this time; formation",
            |now, i| now.relative.map_or(0.0, |r| r.d_lvlh[i]),
        ),
    ];
    for (name, unit, about, part) in parts {
        let mut row = t.real(name).output().unit(unit).about(about);
        // Accelerations as such, and through the turning of the target's axes.
        if matches!(name, "truth.a_t_n" | "truth.rho_dot_lvlh" | "truth.d_lvlh") {
            row = row.initially_from("a_dist_t_n");
        }
        if name == "truth.d_lvlh" {
            row = row.initially_from("a_cmd_c_n");
        }
        row.vector(3, move |m, i| m.read(|s| part(s.now(), i)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fmi2_export::{Experiment, Log, Model};

    /// Value of a Real variable.
    fn real(model: &TruthModel, name: &str) -> f64 {
        let table = TruthModel::table();
        let entry = table.find(name).and_then(|number| table.entry(number)).unwrap();
        entry.read(model).unwrap()
    }

    fn run(scenario: i32) -> TruthModel {
        let mut model = TruthModel::blank();
        TruthModel::table().apply_start(&mut model);
        model.params.scenario = Scenario::try_from(scenario).unwrap();
        model.params.sample_period = 2.0;
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
    fn outputs_show_the_run() {
        let model = run(1);
        let simulation = model.simulation.clone().unwrap();
        let (sample, now) = (simulation.sample(), simulation.now());
        let expected = [
            ("sample_time", 14.0),
            ("lidar.range", sample.lidar.range),
            ("lidar.azimuth", sample.lidar.azimuth),
            ("lidar.elevation", sample.lidar.elevation),
            ("accelerometer.alpha_c_bc[2]", sample.alpha_c_bc.y),
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
        ];
        for (name, value) in expected {
            assert_eq!(real(&model, name).to_bits(), value.to_bits(), "{name}");
        }
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
            ("metrology.rho_lvlh[2]", sample.metrology.rho_lvlh.y),
            ("metrology.rho_dot_lvlh[1]", sample.metrology.rho_dot_lvlh.x),
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
