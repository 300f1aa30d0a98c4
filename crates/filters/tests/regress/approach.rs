//! Two vehicles in the gravity of a mission, seen by LiDAR; the chaser thrusts for ten seconds. For bounds the target is pushed, too:
//! there is nothing to tell them of one that is not.

use super::formation::World;
use filters::state::State;
use filters::{Reading, Sample, SpecificForce, Untold};
use interface::Sensor;
use nalgebra::{SVector, Vector3, Vector6};
use numerics::{Generator, Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

/// Acceleration at a position with a velocity, SI.
type Gravity = fn(&Vector3<f64>, &Vector3<f64>) -> Vector3<f64>;

pub struct Approach {
    gravity: Gravity,
    /// Target, then chaser: position and velocity.
    x: SVector<f64, 12>,
    g: Generator,
    k: i32,
    /// Whether something unannounced pushes the target.
    pushed: bool,
    untold: Untold,
}

/// Steps at which the target is pushed, where it is, and how, axes N, m/s2: a vent that is followed by a burn.
const PUSHES: [(std::ops::Range<i32>, [f64; 3]); 2] = [(60..90, [-2e-5, 1e-5, 3e-5]), (150..160, [1e-3, 2e-3, -1e-3])];

const BIAS: Vector3<f64> = Vector3::new(2.9e-6, 2.9e-6, 2.9e-6);

impl Approach {
    /// * `chaser`: its position and velocity, axes N, SI; `spread`: sizes of the first estimate's errors; `pushed`: whether something
    ///   unannounced pushes the target.
    pub fn new(gravity: Gravity, chaser: &Vector6<f64>, spread: [f64; 2], pushed: bool) -> (Self, State) {
        let relative = Vector6::new(300.0, -900.0, 250.0, 0.1, 0.5, -0.2);
        let mut x = SVector::<f64, 12>::zeros();
        x.fixed_rows_mut::<6>(0).copy_from(&(chaser + relative));
        x.fixed_rows_mut::<6>(6).copy_from(chaser);
        let mut start = State::zeros();
        start.fixed_rows_mut::<6>(0).copy_from(&relative);
        start.fixed_rows_mut::<6>(9).copy_from(chaser);
        start.fixed_rows_mut::<3>(15).copy_from(&BIAS);
        for (slot, size) in [(0, spread[0]), (3, spread[1]), (9, -spread[0]), (12, -spread[1])] {
            for axis in 0..3 {
                start[slot + axis] += size * [0.5, -0.7, 0.3][axis];
            }
        }
        let world = Self {
            gravity,
            x,
            g: stream(12, 0, Source::Lidar),
            k: 0,
            pushed,
            untold: Untold::default(),
        };
        (world, start)
    }

    fn force(&self) -> Vector3<f64> {
        if (100..110).contains(&self.k) {
            Vector3::new(2e-3, -1e-3, 5e-4)
        } else {
            Vector3::zeros()
        }
    }

    /// What pushes the target, where something does.
    fn push(&self) -> Option<Vector3<f64>> {
        let mut pushes = PUSHES
            .iter()
            .filter(|(steps, _)| self.pushed && steps.contains(&self.k));
        pushes.next().map(|(_, push)| Vector3::from(*push))
    }

    fn normal(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| StandardNormal.sample(&mut self.g))
    }
}

impl World for Approach {
    fn step(&mut self) -> Sample {
        let (gravity, force, push) = (self.gravity, self.force(), self.push());
        self.x = rk4::step(0.0, &self.x, 1.0, |_, y| {
            let part = |slot: usize| y.fixed_rows::<3>(slot).into_owned();
            let mut dy = SVector::<f64, 12>::zeros();
            dy.fixed_rows_mut::<3>(0).copy_from(&part(3));
            let mut of_target = gravity(&part(0), &part(3));
            of_target
                .iter_mut()
                .zip(push.iter().flatten())
                .for_each(|(a, push)| *a += push);
            dy.fixed_rows_mut::<3>(3).copy_from(&of_target);
            dy.fixed_rows_mut::<3>(6).copy_from(&part(9));
            dy.fixed_rows_mut::<3>(9)
                .copy_from(&(gravity(&part(6), &part(9)) + force));
            dy
        });
        if let Some(push) = push {
            self.untold.dv_t_n += push;
            self.untold.event_time += 1.0;
        }
        self.k += 1;
        let part = |slot: usize| self.x.fixed_rows::<3>(slot).into_owned();
        let (r_c, v_c, r_tc, v_tc) = (part(6), part(9), part(0) - part(6), part(3) - part(9));
        let dcm_bc_n = astro::frames::los_body_axes(&r_tc, &v_tc, &r_c.cross(&v_c).normalize());
        let noise = self.normal().component_mul(&Vector3::new(0.08, 7e-4, 7e-4));
        let lidar = sensors::lidar::measure(&(astro::frames::lidar_from_body() * dcm_bc_n * r_tc)) + noise;
        let alpha_c_bc = dcm_bc_n * self.force() + BIAS + self.normal() * 3.4e-6;
        let mut sample = Sample {
            accelerometer: Some(SpecificForce::Instant(alpha_c_bc)),
            dcm_bc_n,
            untold: Some(self.untold),
            ..Sample::blank(self.k, f64::from(self.k))
        };
        sample[Sensor::Lidar] = Reading::of(lidar.as_slice());
        sample
    }

    fn truth(&self) -> SVector<f64, 9> {
        let relative = self.x.fixed_rows::<6>(0) - self.x.fixed_rows::<6>(6);
        relative.fixed_resize(0.0)
    }
}
