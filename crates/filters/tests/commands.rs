//! A filter that is told of the chaser's commands, with an accelerometer that reads the instant, and nothing else to see.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

use filters::state::State;
use filters::{Command, Navigator, Sample, Settings, SpecificForce};
use interface::mission::embedded;
use nalgebra::{Matrix3, Vector3};

const BIAS: f64 = 2.943e-6;

/// Seconds with pulses, strong, weak and weaker than the gate, alone and in a row, m/s2 along x.
fn pulse(second: u32) -> f64 {
    match second {
        5 | 20..=22 | 40 => 5e-3,
        10 => 3e-4,
        50..=52 => 8e-5,
        30 => -2e-3,
        31 => 4e-3,
        _ => 0.0,
    }
}

/// Velocity of the target relative to the chaser along x at 60 s, less where it began, m/s.
///
/// * `told`: the pulses, of which a reading has what stood just before its epoch.
/// * `late`: a sample comes in the step that begins with its epoch, not in that which ends with it.
fn velocity(told: impl Fn(u32) -> f64, late: bool) -> f64 {
    let navigation = embedded("leo_venting").unwrap().mission().unwrap().navigation();
    let mut nav = Navigator::new(&navigation, &Settings::default(), 0.0).unwrap();
    let mut start = State::zeros();
    for (slot, part) in [
        (0, [3.0, 50.0, -4.0]),
        (9, [6.878e6, 0.0, 0.0]),
        (12, [0.0, 7350.0, 1970.0]),
        (15, [BIAS; 3]),
    ] {
        start.fixed_rows_mut::<3>(slot).copy_from_slice(&part);
    }
    nav.begin(&Sample::blank(0, 0.0), &start, &Command::default());
    for second in 0..60 + u32::from(late) {
        let command = Command {
            a_cmd_c_n: Vector3::new(told(second), 0.0, 0.0),
            ..Command::default()
        };
        nav.step(f64::from(second), 1.0, &command);
        let epoch = second + u32::from(!late);
        let before = epoch.checked_sub(1).map_or(0.0, &told);
        let sample = Sample {
            accelerometer: Some(SpecificForce::Instant(Vector3::new(before, 0.0, 0.0).add_scalar(BIAS))),
            dcm_bc_n: Matrix3::identity(),
            ..Sample::blank(i32::try_from(epoch).unwrap(), f64::from(epoch))
        };
        if epoch > 0 {
            nav.process(&sample, &start).unwrap();
        }
    }
    nav.estimate().x[3]
}

/// In a Jacobi master a pulse has ended before the reading that feels it is heard of.
#[test]
fn pulses_keep_their_momentum_where_samples_come_a_step_late() {
    let wanted = -(0..60).map(pulse).sum::<f64>();
    for late in [false, true] {
        let given = velocity(pulse, late) - velocity(|_| 0.0, late);
        // Bias is estimated from readings below the gate; gravity differs along the way by 1e-6 per second squared.
        assert!((given / wanted - 1.0).abs() < 1e-2, "late {late}: {given} not {wanted}");
    }
    let (timely, late) = (velocity(pulse, false), velocity(pulse, true));
    assert!((timely - late).abs() < 1e-9, "{timely} {late}");
}
