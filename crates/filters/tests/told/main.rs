//! What a command does to the predictions of a filter that is told of it: nothing, whatever its accelerometer reads and whenever
//! samples come.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(clippy::print_stdout, reason = "what is found is a table")]

mod flight;
mod lvlh;

use flight::{Order, Seen, Setup, fly, moved};

/// Impulses and pulses, in and across the intervals of the readings.
const ORDERS: [Order; 6] = [
    Order::Impulse(64.0, [0.03, -0.03, 0.02]),
    Order::Push(65.0, 66.0, [0.0, 0.02, 0.0]),
    Order::Push(67.0, 84.0, [2e-3, 0.0, -1e-3]),
    Order::Impulse(90.0, [0.0, 0.05, 0.0]),
    Order::Push(93.0, 95.0, [1e-2, 0.0, 0.0]),
    // Weaker than the gate.
    Order::Push(96.0, 120.0, [5e-5, 6e-5, 0.0]),
];

/// Readings, periods and communication steps: accelerometer as fast as the LiDAR, faster, slower, and both faster than the master.
fn setups() -> Vec<Setup> {
    let mut all = Vec::new();
    for mean in [true, false] {
        for (accelerometer_s, lidar_s, step_s) in [
            (10.0, 10.0, 1.0),
            (1.0, 1.0, 1.0),
            (1.0, 1.0, 0.25),
            (2.0, 10.0, 0.5),
            (50.0, 10.0, 1.0),
            (3.0, 2.0, 1.0),
            (0.02, 0.2, 0.2),
            (0.02, 0.2, 0.25),
            (0.02, 0.2, 1.0),
            (0.5, 2.0, 1.0),
            (6.0, 1.0, 2.0),
        ] {
            // A reading of the instant cannot be held for long, told or not.
            if !mean && accelerometer_s > 10.0 {
                continue;
            }
            for jacobi in [false, true] {
                all.push(Setup {
                    mean,
                    accelerometer_s,
                    lidar_s,
                    step_s,
                    jacobi,
                    ..Setup::default()
                });
            }
        }
    }
    all
}

/// Those that change at communication points.
fn orders(setup: &Setup) -> Vec<Order> {
    let point = |t: f64| ((t / setup.step_s).round() * setup.step_s - t).abs() < 1e-6;
    let fits = |order: &Order| match order {
        Order::Push(from, to, _) => point(*from) && point(*to),
        Order::Impulse(at, _) => point(*at),
    };
    ORDERS.into_iter().filter(fits).collect()
}

fn label(setup: &Setup) -> String {
    format!(
        "{:7} accelerometer {:4} s, LiDAR {:3} s, step {:4} s, {:12}",
        if setup.mean { "mean" } else { "instant" },
        setup.accelerometer_s,
        setup.lidar_s,
        setup.step_s,
        if setup.jacobi { "Jacobi" } else { "Gauss-Seidel" },
    )
}

/// What a command moves the error of the prediction by, at most: in metres as in metres per second a hundredth of its change of
/// velocity. A filter that is not told is moved by more, if by nothing else then by an impulse.
#[test]
fn a_command_that_is_told_leaves_the_error_of_the_prediction_alone() {
    let mut wrong = Vec::new();
    println!("largest move of position and velocity over the change of velocity, told; untold");
    for setup in setups() {
        let worst = |setup: Setup| {
            let share = |order: Order| {
                let (r, v) = moved(&setup, &[order]);
                [r / order.dv(), v / order.dv()]
            };
            let shares: Vec<_> = orders(&setup).into_iter().map(share).collect();
            [0, 1].map(|i| shares.iter().map(|share| share[i]).fold(0.0, f64::max))
        };
        let (told, untold) = (worst(setup), worst(Setup { told: false, ..setup }));
        let line = format!(
            "{}: {:.1e} {:.1e}; {:.1e} {:.1e}",
            label(&setup),
            told[0],
            told[1],
            untold[0],
            untold[1]
        );
        println!("{line}");
        if told.iter().any(|share| *share > 0.01) || untold.iter().all(|share| *share < 0.1) {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A weak command is no bias.
#[test]
fn a_command_below_the_gate_is_not_learnt_as_bias() {
    let weak = Order::Push(100.0, 300.0, [5e-5, -6e-5, 2e-5]);
    for mean in [false, true] {
        for step_s in [1.0, 0.25] {
            let setup = Setup {
                mean,
                step_s,
                accelerometer_s: 1.0,
                lidar_s: 1.0,
                duration_s: 320.0,
                ..Setup::default()
            };
            let biases = |orders: &[Order], setup: &Setup| fly(setup, orders).into_iter().map(|seen| seen.bias);
            let learnt = |setup: &Setup| {
                let pairs = biases(&[weak], setup).zip(biases(&[], setup));
                pairs.map(|(with, without)| (with - without).norm()).fold(0.0, f64::max)
            };
            let (told, untold) = (learnt(&setup), learnt(&Setup { told: false, ..setup }));
            println!("mean {mean}, {step_s} s: {told:.1e} m/s2 of it is learnt, untold {untold:.1e}");
            assert!(told < 1e-9, "mean {mean}, {step_s} s: {told}");
            assert!(mean || untold > 1e-5, "{step_s} s: {untold}");
        }
    }
}

/// What is known is not made uncertain.
#[test]
fn a_command_that_is_told_adds_nothing_to_the_deviations() {
    for setup in setups().into_iter().filter(|setup| setup.mean) {
        let (with, without) = (fly(&setup, &orders(&setup)), fly(&setup, &[]));
        let grows = |(a, b): (&Seen, &Seen)| a.sigma.component_div(&b.sigma).max();
        let worst = with.iter().zip(&without).map(grows).fold(0.0, f64::max);
        println!("{}: {worst:.4}", label(&setup));
        // The chaser comes nearer to its target, or goes away from it.
        assert!(worst < 1.02, "{}: {worst}", label(&setup));
    }
}

/// What the thrusters leave out is felt and makes good, as a thrust does that nobody tells of.
#[test]
fn thrusters_that_do_less_are_found_out() {
    let all = [
        Order::Push(64.0, 74.0, [5e-3, 0.0, -4e-3]),
        Order::Impulse(90.0, [0.0, 0.05, 0.0]),
    ];
    for setup in setups() {
        // An impulse leaves no trace in a reading of the instant.
        let orders = if setup.mean { &all[..] } else { &all[..1] };
        let setup = Setup { short: 0.03, ..setup };
        let (_, v) = moved(&setup, orders);
        let short = orders.iter().map(|order| 0.03 * order.dv()).sum::<f64>();
        let last = |orders: &[Order]| fly(&setup, orders).last().map(|seen| seen.error).unwrap();
        let left = (last(orders) - last(&[])).fixed_rows::<3>(3).norm();
        let label = label(&setup);
        println!(
            "{label}: {short:.1e} m/s less moves the prediction by {v:.1e} m/s at most, {left:.1e} m/s in the end"
        );
        assert!(v < 1.1 * short, "{label}: {v} of {short}");
        // Of a gap between two steps a reading that is shorter tells a part.
        if setup.accelerometer_s >= setup.step_s {
            assert!(left < 0.15 * short, "{label}: {left} of {short}");
        }
    }
}

/// The error of a prediction halfway between two samples is what its deviations say, while all that can be commanded is.
#[test]
fn predictions_between_samples_are_as_good_as_they_say() {
    for mean in [true, false] {
        let (mut sum, mut count) = (0.0, 0.0);
        for run in 0..40 {
            let setup = Setup {
                mean,
                noise: Some(run),
                accelerometer_s: if mean { 10.0 } else { 1.0 },
                ..Setup::default()
            };
            for seen in fly(&setup, &ORDERS)
                .iter()
                .filter(|seen| seen.t > 60.0 && (seen.t % 10.0 - 5.0).abs() < 1e-6)
            {
                sum += seen.error.component_div(&seen.sigma).norm_squared();
                count += 6.0;
            }
        }
        println!("mean {mean}: squared errors over variances {:.3}", sum / count);
        assert!((0.7..1.3).contains(&(sum / count)), "mean {mean}: {}", sum / count);
    }
}

/// Whatever a filter remembers of commands and readings can be saved.
#[test]
fn a_filter_that_is_told_goes_on_from_where_it_was_saved() {
    for setup in setups() {
        let orders = orders(&setup);
        let (once, saved) = (fly(&setup, &orders), fly(&Setup { saved: true, ..setup }, &orders));
        assert!(once == saved, "{}", label(&setup));
    }
}
