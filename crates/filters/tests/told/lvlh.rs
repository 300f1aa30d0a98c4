//! Commands in the LVLH frame: they stand in axes N, and the axes of the estimate turn meanwhile.

#![allow(clippy::float_cmp, reason = "what is left alone is the same to the bit")]

use super::flight::Order;
use astro::Lvlh;
use filters::laws::FILTERS;
use filters::{Command, Navigator, Reading, Sample, Settings};
use interface::Sensor;
use interface::mission::embedded;
use nalgebra::{SVector, Vector3, Vector6};
use numerics::rk4;

const MU: f64 = astro::earth::FILTER.mu;
const AXIS: f64 = 8.1431e6;

/// Target on the circular orbit of the equations, then chaser: position and velocity, axes N.
struct World {
    x: SVector<f64, 12>,
    second: u32,
}

impl World {
    fn new() -> Self {
        let speed = (MU / AXIS).sqrt();
        // Inclined, so that no axis stands along N.
        let (r_t, v_t) = (
            Vector3::new(AXIS, 0.0, 0.0),
            Vector3::new(0.0, speed * 0.6, speed * 0.8),
        );
        let (r, v) = Lvlh::new(&r_t, &v_t, &Vector3::zeros())
            .absolute(&Vector3::new(3.0, -12.0, 4.0), &Vector3::new(1e-3, 2e-3, -1e-3));
        let mut x = SVector::<f64, 12>::zeros();
        for (slot, part) in [(0, r_t), (3, v_t), (6, r), (9, v)] {
            x.fixed_rows_mut::<3>(slot).copy_from(&part);
        }
        Self { x, second: 0 }
    }

    fn part(&self, slot: usize) -> Vector3<f64> {
        self.x.fixed_rows::<3>(slot).into_owned()
    }

    fn lvlh(&self) -> Lvlh {
        Lvlh::new(&self.part(0), &self.part(3), &Vector3::zeros())
    }

    fn relative(&self) -> Vector6<f64> {
        let (rho, rho_dot) = self.lvlh().relative(&self.part(6), &self.part(9));
        Vector6::from_iterator(rho.iter().chain(&rho_dot).copied())
    }

    fn step(&mut self, command: &Command) {
        self.x = rk4::step(0.0, &self.x, 1.0, |_, x| {
            let mut rate = SVector::<f64, 12>::zeros();
            for (slot, push) in [(0, Vector3::zeros()), (6, command.a_cmd_c_n)] {
                let r = x.fixed_rows::<3>(slot).into_owned();
                rate.fixed_rows_mut::<3>(slot).copy_from(&x.fixed_rows::<3>(slot + 3));
                rate.fixed_rows_mut::<3>(slot + 3)
                    .copy_from(&(r * (-MU / r.norm().powi(3)) + push));
            }
            rate
        });
        self.second += 1;
    }

    fn sample(&self, axes: bool, period: u32) -> Sample {
        let epoch = self.second / period;
        let mut sample = Sample {
            target_axes: axes.then(|| *self.lvlh().axes()),
            ..Sample::blank(epoch as i32, f64::from(epoch * period))
        };
        sample[Sensor::Metrology] = Reading::of(self.relative().as_slice());
        sample
    }
}

/// Errors of the predictions at the end of each second, with a sample every `period` seconds.
///
/// * `axes`: whether somebody says how the LVLH axes stand.
fn fly(period: u32, orders: &[Order], told: bool, axes: bool, jacobi: bool) -> (Vec<Vector6<f64>>, Navigator) {
    let navigation = embedded("formation").unwrap().mission().unwrap().navigation();
    let settings = Settings {
        filter: FILTERS.iter().position(|f| f.name == "snc").unwrap(),
        ..Settings::default()
    };
    let mut nav = Navigator::new(&navigation, &settings, 0.0).unwrap();
    let (mut world, mut command) = (World::new(), Command::default());
    let start = world.relative().fixed_resize(0.0);
    let mut newest = world.sample(axes, period);
    nav.begin(&newest, &start, &command);
    let mut errors = Vec::new();
    for second in 0..300_u32 {
        let now = |t: f64| (t - f64::from(second)).abs() < 1e-9;
        for order in orders {
            match order {
                Order::Push(from, _, a) if now(*from) => command.a_cmd_c_n = Vector3::from(*a),
                Order::Push(_, to, _) if now(*to) => command.a_cmd_c_n = Vector3::zeros(),
                Order::Impulse(at, dv) if now(*at) => {
                    command.impulse_c_n = Vector3::from(*dv);
                    command.impulse_count += 1;
                    let mut v_c = world.x.fixed_rows_mut::<3>(9);
                    v_c += command.impulse_c_n;
                }
                _ => (),
            }
        }
        let before = newest.clone();
        world.step(&command);
        if world.second.is_multiple_of(period) {
            newest = world.sample(axes, period);
        }
        nav.step(f64::from(second), 1.0, &if told { command } else { Command::default() });
        let sample = if jacobi { &before } else { &newest };
        nav.expect(sample, &start);
        nav.process(sample, &start).unwrap();
        let predicted = nav.predict();
        let predicted = predicted.rho_lvlh.iter().chain(&predicted.rho_dot_lvlh).copied();
        errors.push(Vector6::from_iterator(predicted) - world.relative());
    }
    (errors, nav)
}

fn moved(period: u32, order: Order, told: bool, jacobi: bool) -> f64 {
    let (with, _) = fly(period, &[order], told, true, jacobi);
    let (without, _) = fly(period, &[], told, true, jacobi);
    let pairs = with.iter().zip(&without);
    let by = |(a, b): (&Vector6<f64>, &Vector6<f64>)| (a - b).fixed_rows::<3>(3).norm();
    pairs.map(by).fold(0.0, f64::max)
}

#[test]
fn commands_stand_in_axes_that_do_not_turn() {
    for period in [1, 10, 60] {
        for jacobi in [false, true] {
            for order in [
                Order::Push(121.0, 180.0, [1e-3, 0.0, 0.0]),
                Order::Push(119.0, 122.0, [0.0, 5e-3, -5e-3]),
                Order::Impulse(124.0, [0.0, 0.03, 0.03]),
                Order::Impulse(179.0, [0.05, 0.0, 0.0]),
            ] {
                let (told, untold) = (moved(period, order, true, jacobi), moved(period, order, false, jacobi));
                println!("every {period:2} s, Jacobi {jacobi}, {order:?}: {told:.1e} m/s, untold {untold:.1e} m/s");
                assert!(told < 1e-6 * order.dv(), "every {period} s, {order:?}: {told}");
                assert!(untold > 1e-2 * order.dv(), "every {period} s, {order:?}: {untold}");
            }
        }
    }
}

/// Nobody says how the axes stand: the filter goes on as if it were not told, and says so.
#[test]
fn without_axes_a_command_is_left_out_and_the_filter_says_so() {
    let order = [Order::Push(121.0, 180.0, [1e-3, 0.0, 0.0])];
    for axes in [true, false] {
        let (told, nav) = fly(10, &order, true, axes, false);
        assert_eq!(nav.leaves_commands_out(), !axes);
        let (untold, silent) = fly(10, &order, false, axes, false);
        assert!(!silent.leaves_commands_out());
        assert_eq!(told == untold, !axes);
    }
}

/// Where the way to the end of the step cannot be gone, the time is that of what is shown.
#[test]
fn a_prediction_that_fails_does_not_pretend_to_be_of_now() {
    let (_, mut nav) = fly(10, &[], true, true, false);
    let step = |nav: &mut Navigator, x: f64| {
        let a_cmd_c_n = Vector3::new(x, 0.0, 0.0);
        let command = Command {
            a_cmd_c_n,
            ..Command::default()
        };
        nav.step(300.0, 4.0, &command);
        nav.predict()
    };
    assert!((step(&mut nav, 0.0).time - 304.0).abs() < 1e-12);
    let (failed, estimate) = (step(&mut nav, f64::NAN), nav.estimate());
    assert!((failed.time - 300.0).abs() < 1e-12, "{}", failed.time);
    assert_eq!(failed.rho_lvlh.as_slice(), &estimate.x.as_slice()[..3]);
}
