//! Sensors through the public interface: their own periods, what they measure, and the mean accelerometer.
#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;

use common::{File, advance, changed, felt, quiet, samples, start, with};
use interface::Sensor;
use nalgebra::Vector3;
use proptest::prelude::*;
use truth::{Params, SensorSample};

const ALL: &str = "[sensors.lidar]\nperiod_s = 2.0\n[sensors.camera]\nperiod_s = 3.0\nfield_of_view_deg = 20.0\n[sensors.radio]\nperiod_s = 0.25\n[sensors.metrology]\nperiod_s = 5.0\n[sensors.accelerometer]\nperiod_s = 0.7\n";

/// Every epoch counts, and at each exactly the sensors of that epoch are due.
#[test]
fn sensors_keep_their_own_periods() {
    let mut run = File::new(&quiet(ALL)).simulation();
    let mut epochs: Vec<(u64, [bool; 5])> = Vec::new();
    // In units of 1/20 s all periods are whole.
    for tick in 1..=(20 * 60_u64) {
        let periods = [40, 60, 5, 100, 14];
        let due = periods.map(|p| tick % p == 0);
        if due.contains(&true) {
            epochs.push((tick, due));
        }
    }
    let mut before = *run.sample();
    for (count, (tick, due)) in (1..).zip(epochs) {
        let t = tick as f64 / 20.0;
        advance(&mut run, t);
        let seen = *run.sample();
        assert_eq!(seen.count, count, "at {t} s");
        assert!((seen.time - t).abs() < 1e-12, "{} at {t} s", seen.time);
        let flags = [
            seen[Sensor::Lidar].due,
            seen[Sensor::Camera].due,
            seen[Sensor::Radio].due,
            seen[Sensor::Metrology].due,
            seen.accelerometer.valid,
        ];
        assert_eq!(flags, due, "at {t} s");
        let valid = [
            seen[Sensor::Lidar].valid,
            seen[Sensor::Camera].valid,
            seen[Sensor::Radio].valid,
            seen[Sensor::Metrology].valid,
        ];
        assert_eq!(valid, due[..4], "at {t} s");
        // Values stay until the next.
        let kept = [
            seen[Sensor::Lidar].z[0] == before[Sensor::Lidar].z[0],
            seen[Sensor::Camera].z[0] == before[Sensor::Camera].z[0],
            seen[Sensor::Radio].z[1] == before[Sensor::Radio].z[1],
            seen[Sensor::Metrology].z == before[Sensor::Metrology].z,
            seen.accelerometer.alpha_c_bc == before.accelerometer.alpha_c_bc,
        ];
        assert_eq!(kept, due.map(|d| !d), "at {t} s");
        before = seen;
    }
}

#[test]
fn periods_that_only_nearly_meet_do_meet() {
    // In binary 3 * 0.1 is not 0.3.
    let text = quiet("[sensors.lidar]\nperiod_s = 0.1\n[sensors.radio]\nperiod_s = 0.3\n");
    let mut run = File::new(&text).simulation();
    advance(&mut run, 30.0);
    assert_eq!(run.sample().count, 300);
    assert!(run.sample()[Sensor::Lidar].due && run.sample()[Sensor::Radio].due);
}

#[test]
fn the_sample_period_is_that_of_sensors_without_their_own() {
    let file = File::new(&quiet("[sensors.lidar]\n[sensors.radio]\nperiod_s = 4.0\n"));
    let epochs = |params: &Params| {
        let mut run = start(params);
        advance(&mut run, 12.0);
        (
            run.sample().count,
            run.sample()[Sensor::Lidar].due,
            run.sample()[Sensor::Radio].due,
        )
    };
    assert_eq!(epochs(&file.params()), (12, true, true));
    assert_eq!(
        epochs(&with(&file.params(), &[("sample_period", 6.0)])),
        (4, true, true)
    );
    assert_eq!(
        epochs(&with(&file.params(), &[("sample_period", 5.0)])),
        (5, false, true)
    );
}

/// Range rate against a difference of order four of the true range.
fn range_rate(text: &str, at: &[f64], rounding: f64) {
    let quiet_radio = "[sensors.radio]\nperiod_s = 0.5\nsigma_range_m = 0.0\nsigma_range_rate_m_s = 0.0\n";
    let mut run = File::new(&format!("{text}\n{quiet_radio}")).simulation();
    for &t in at {
        let h = 0.5;
        let mut seen = [0.0; 5];
        let mut rate = 0.0;
        for (k, range) in (0..).zip(&mut seen) {
            advance(&mut run, t + h * (f64::from(k) - 2.0));
            *range = run.now().state.r_tc().norm();
            assert!((run.sample()[Sensor::Radio].z[0] - *range).abs() < 1e-9);
            if k == 2 {
                rate = run.sample()[Sensor::Radio].z[1];
            }
        }
        let difference = ((seen[3] - seen[1]) * 8.0 - (seen[4] - seen[0])) / (12.0 * h);
        // Rounding of the positions, 1e-9 m about the Earth and 6e-8 m from the barycentre, over a second.
        assert!(
            (rate - difference).abs() < rounding,
            "at {t} s: {rate} and {difference}"
        );
    }
}

#[test]
fn range_rate_is_the_rate_of_the_range() {
    range_rate(&quiet(""), &[10.0, 100.0, 500.0], 1e-8);
    // In rotating axes too; far from the rendezvous and before the burn.
    let rotating = changed("nrho_venting", &[]);
    range_rate(&rotating, &[50.0, 1000.0, 4000.0], 3e-7);
}

#[test]
fn camera_sees_what_the_lidar_sees() {
    let text = quiet("[sensors.lidar]\nsigma_range_m = 0.0\nsigma_angle_deg = 0.0\nfield_of_view_deg = 40.0\n[sensors.camera]\nsigma_angle_deg = 0.0\nfield_of_view_deg = 40.0\n")
        .replace("[chaser.relative]", "[chaser]\nattitude = \"rtn\"\n[chaser.relative]");
    let mut run = File::new(&text).simulation();
    advance(&mut run, 1.0);
    let seen = run.sample();
    assert!(seen[Sensor::Lidar].valid && seen[Sensor::Camera].valid);
    assert_eq!(
        (seen[Sensor::Camera].z[0], seen[Sensor::Camera].z[1]),
        (seen[Sensor::Lidar].z[1], seen[Sensor::Lidar].z[2])
    );
    // In RTN body axes the target is 100 m along y, 3 m up and 2 m off the plane: elevation turns to x, azimuth to z. In the
    // second since the start the axes have turned by 1e-3.
    assert!(
        (seen[Sensor::Camera].z[1] - (3.0_f64 / 100.0).atan()).abs() < 2e-3,
        "{}",
        seen[Sensor::Camera].z[1]
    );
    assert!(
        (seen[Sensor::Camera].z[0] - (-2.0_f64 / 100.0).atan()).abs() < 3e-3,
        "{}",
        seen[Sensor::Camera].z[0]
    );
}

#[test]
fn noise_of_camera_and_radio_has_its_deviation() {
    let of = |scale: f64| {
        quiet(&format!(
            "[sensors.camera]\nsigma_angle_deg = {}\nfield_of_view_deg = 60.0\n[sensors.radio]\nsigma_range_m = {}\nsigma_range_rate_m_s = {}\n",
            0.02 * scale,
            3.0 * scale,
            1e-2 * scale
        ))
    };
    let n = 600;
    let (noisy, clean) = (File::new(&of(1.0)), File::new(&of(0.0)));
    for (outliers, scale) in [(0.0, 1.0), (1.0, 5.0)] {
        let mut params = noisy.params();
        for sensor in ["camera", "radio"] {
            params.set(&format!("{sensor}.outlier_probability"), outliers);
            params.set(&format!("{sensor}.outlier_scale"), 5.0);
        }
        let mut sums = [0.0; 4];
        let seen = samples(&params, 1.0, n);
        for (noisy, clean) in seen.iter().zip(&samples(&clean.params(), 1.0, n)) {
            let errors = [
                (noisy[Sensor::Camera].z[0] - clean[Sensor::Camera].z[0]) / 0.02_f64.to_radians(),
                (noisy[Sensor::Camera].z[1] - clean[Sensor::Camera].z[1]) / 0.02_f64.to_radians(),
                (noisy[Sensor::Radio].z[0] - clean[Sensor::Radio].z[0]) / 3.0,
                (noisy[Sensor::Radio].z[1] - clean[Sensor::Radio].z[1]) / 1e-2,
            ];
            for (sum, error) in sums.iter_mut().zip(errors) {
                *sum += (error / scale).powi(2) / f64::from(n);
            }
        }
        for (channel, variance) in sums.iter().enumerate() {
            // A mean of n squares of normal draws scatters by sqrt(2 / n); 3.5 sigma of it.
            let bound = 3.5 * (2.0 / f64::from(n)).sqrt();
            assert!((variance - 1.0).abs() < bound, "channel {channel}: {variance}");
        }
    }
}

/// Dropouts, outliers and noise of one sensor, and the sensor itself, are the business of nobody else.
#[test]
fn a_sensor_more_moves_no_other_draw() {
    let faulty = |name: &str| format!("[sensors.{name}]\ndropout_probability = 0.2\noutlier_probability = 0.2\n");
    let every = Sensor::ALL;
    let text = |some: &[Sensor]| {
        let sensors: String = some.iter().map(|sensor| faulty(sensor.name())).collect();
        quiet(&format!("{sensors}[sensors.accelerometer]\nbias_sigma_m_s2 = 1e-8\n"))
    };
    let taken = |some: &[Sensor]| samples(&File::new(&text(some)).params(), 1.0, 200);
    let all = taken(&every);
    for left_out in every {
        let rest: Vec<Sensor> = every.into_iter().filter(|sensor| *sensor != left_out).collect();
        for (with, without) in all.iter().zip(taken(&rest)) {
            let mut with = *with;
            // The target's orbit goes with whatever measures in its axes.
            if sensors::of(left_out).in_lvlh() {
                (with.target_orbit, with.target_axes) = (without.target_orbit, without.target_axes);
            }
            with.sensors[left_out as usize] = without[left_out];
            assert_eq!(with, without, "without {left_out:?}");
        }
    }
    // Nor do means know of a sensor that samples between their own samples.
    let mean = |more: &str| {
        let burn = "[[burn]]\nname = \"one\"\nstart_s = 3.3\nduration_s = 9.45\nacceleration_m_s2 = 0.02\ndirection = [0.3, 1, -0.2]\n";
        let sensors = format!(
            "[sensors.radio]\nperiod_s = 0.7\n{more}[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = 0.7\n"
        );
        let mut run = File::new(&quiet(&format!("{burn}{sensors}"))).simulation();
        advance(&mut run, 7.0);
        run.sample().accelerometer
    };
    assert_eq!(mean(""), mean("[sensors.lidar]\nperiod_s = 0.3\n"));
    // No two share their faults.
    let lost = |seen: &SensorSample, sensor: Sensor| !seen[sensor].valid;
    for (i, a) in every.into_iter().enumerate() {
        for b in &every[i + 1..] {
            let both = all.iter().filter(|s| lost(s, a) && lost(s, *b)).count();
            // 200 at 0.04, within 3 sigma.
            assert!((1..=17).contains(&both), "{a:?} and {b:?}: {both} shared");
        }
    }
}

/// A chaser that burns off the grid, turning as it burns.
fn burning(accelerometer: &str, grid: f64) -> File {
    let text = quiet(&format!(
        "[[burn]]\nname = \"one\"\nstart_s = 20.3\nduration_s = 17.45\nacceleration_m_s2 = 0.02\ndirection = [0.3, 1, -0.2]\naxes = \"rtn\"\n\
         [[burn]]\nname = \"two\"\nstart_s = 61.0\nduration_s = 0.4\nacceleration_m_s2 = 0.5\ndirection = [1, 0, 0]\naxes = \"body\"\n\
         [sensors.radio]\nperiod_s = 40.0\n\
         [sensors.accelerometer]\noutput = \"mean\"\nsigma_m_s2 = 0.0\n{accelerometer}\n"
    ));
    // A body that turns at 3 deg/s beside one that looks at a target 100 m away.
    let text = text.replace(
        "[chaser.relative]",
        "[chaser]\nattitude = { spin_deg_s = [1.0, -2.0, 2.0] }\n[chaser.relative]",
    );
    File::new(&text.replace("grid_s = 1.0", &format!("grid_s = {grid:?}")))
}

/// Angular velocity of the chaser, body axes, rad/s.
fn rate() -> Vector3<f64> {
    Vector3::new(1.0_f64, -2.0, 2.0).map(f64::to_radians)
}

/// Integral of the specific force in inertial axes over the first `t` seconds, by the readings of one sensor.
fn impulses(file: &File, period: f64, t: f64) -> Vec<Vector3<f64>> {
    let mut run = file.simulation();
    let mut sum = Vector3::zeros();
    let mut sums = vec![sum];
    for k in 1..=((t / period).round() as u32) {
        advance(&mut run, f64::from(k) * period);
        let seen = run.sample().accelerometer;
        assert!(seen.valid && seen.mean);
        sum += nalgebra::Rotation3::new(rate() * (f64::from(k) * period)) * seen.alpha_c_bc * period;
        sums.push(sum);
    }
    sums
}

/// The same from the definition, on a far finer grid: instants of the force by hand.
fn by_hand(t: f64) -> Vector3<f64> {
    let mut run = burning("period_s = 20.0", 0.01).simulation();
    let h = 0.01;
    let mut sum = Vector3::zeros();
    for k in 0..((t / h).round() as u32) {
        let now = (f64::from(k) + 0.5) * h;
        let inside = |start: f64, length: f64| (start..start + length).contains(&now);
        if inside(20.3, 17.45) {
            advance(&mut run, now);
            let s = run.now().state;
            sum += astro::frames::rtn(&s.r_c, &s.v_c).tr_mul(&(Vector3::new(0.3, 1.0, -0.2).normalize() * (0.02 * h)));
        }
        if inside(61.0, 0.4) {
            sum += nalgebra::Rotation3::new(rate() * now) * Vector3::x() * (0.5 * h);
        }
    }
    sum
}

#[test]
fn mean_readings_times_their_interval_are_the_integral_of_the_specific_force() {
    let whole = by_hand(80.0);
    assert!(whole.norm() > 0.3, "{whole}");
    for (period, grid) in [
        (20.0, 1.0),
        (0.02, 0.02),
        (0.02, 1.0),
        (1.0, 1.0),
        (2.5, 1.0),
        (0.8, 0.5),
        (0.3125, 1.0),
    ] {
        let file = burning(&format!("period_s = {period:?}"), grid);
        let sum = impulses(&file, period, 80.0).pop().unwrap();
        // What acts is constant over a grid interval of g s. The first burn's direction turns with the orbit, by 1e-3 rad/s: at
        // an edge a share f of 0.02 g m/s acts (1 - f) g / 2 s too early or late; f (1 - f) is 1/4 at most. The second, of 0.2
        // m/s, turns with the body, by 0.052 rad/s, and acts in the middle of the intervals it lies in. The sum by hand is good
        // to 2e-6.
        let shift = (0.5 * ((0.4 / grid).ceil() * grid - 0.4)).max(0.0);
        let bound = 4e-6 + 2.0 * 0.02 * 1.2e-3 * grid * grid / 8.0 + 0.2 * 0.053 * shift;
        assert!(
            (sum - whole).norm() < bound,
            "every {period} s on {grid} s: {sum} and {whole}"
        );
    }
}

/// Readings at several periods are sums of one another, whatever the grid.
#[test]
fn mean_readings_of_any_period_add_up() {
    let fine = impulses(&burning("period_s = 0.125", 1.0), 0.125, 80.0);
    for period in [0.25, 0.5, 1.0, 2.0, 4.0, 5.0, 8.0, 10.0, 16.0, 20.0] {
        let coarse = impulses(&burning(&format!("period_s = {period:?}"), 1.0), period, 80.0);
        for (k, sum) in coarse.iter().enumerate() {
            let place = (k as f64 * period / 0.125).round() as usize;
            // Simpson's rule with a node every 1/8 s and one a second: (0.05 rad)^4 / 2880 of it.
            assert!(
                (sum - fine[place]).norm() < 1e-8,
                "every {period} s at {}: {sum}",
                k as f64 * period
            );
        }
    }
}

/// In inertial body axes the reading is what the velocity gains beyond gravity.
#[test]
fn mean_readings_are_the_velocity_gained_beside_gravity() {
    let text = quiet(
        "[[burn]]\nname = \"one\"\nstart_s = 3.3\nduration_s = 9.45\nacceleration_m_s2 = 0.02\ndirection = [0.3, 1, -0.2]\n[sensors.radio]\n[sensors.accelerometer]\noutput = \"mean\"\nperiod_s = 7.0\nsigma_m_s2 = 0.0\n",
    )
    .replace("[chaser.relative]", "[chaser]\nattitude = \"inertial\"\n[chaser.relative]");
    let mut run = File::new(&text).simulation();
    let mut free = File::new(&text.replace("acceleration_m_s2 = 0.02", "acceleration_m_s2 = 0.0")).simulation();
    let mut sum = Vector3::zeros();
    for k in 1..=4 {
        let t = 7.0 * f64::from(k);
        advance(&mut run, t);
        advance(&mut free, t);
        sum += felt(run.sample()) * 7.0;
        let gained = run.now().state.v_c - free.now().state.v_c;
        // Gravity gradient 2.3e-6 / s2 of 3 m, half of it in the mean, over 20 s.
        assert!((sum - gained).amax() < 1e-4, "{sum} and {gained}");
    }
    // A bias and noise stand on the mean as on the instant.
    let mut biased =
        File::new(&text.replace("sigma_m_s2 = 0.0", "sigma_m_s2 = 0.0\nbias0_m_s2 = [1e-3, 0, -1e-3]")).simulation();
    let mut exact = File::new(&text).simulation();
    advance(&mut biased, 14.0);
    advance(&mut exact, 14.0);
    let more = biased.sample().accelerometer.alpha_c_bc - exact.sample().accelerometer.alpha_c_bc;
    assert!((more - biased.now().b_c_bc).amax() < 1e-15, "{more}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// As for the instant: means do not know of communication points, nor does a run that was saved on the way.
    #[test]
    fn means_do_not_depend_on_the_communication_points(
        steps in prop::collection::vec(prop_oneof![Just(1.0), Just(0.1), 1e-3..3.0_f64], 1..60),
        period in prop_oneof![Just(1.0), Just(0.25), Just(0.3), Just(2.5)],
    ) {
        let file = burning(&format!("period_s = {period:?}\nbias_sigma_m_s2 = 1e-6"), 1.0);
        let mut coarse = file.simulation();
        let mut reference = coarse.clone();
        let mut t = 0.0;
        for h in steps {
            t += h;
            advance(&mut coarse, t);
            coarse = postcard::from_bytes(&postcard::to_stdvec(&coarse).unwrap()).unwrap();
        }
        advance(&mut reference, t);
        prop_assert_eq!(coarse.sample(), reference.sample());
        prop_assert_eq!(coarse.now(), reference.now());
    }
}
