//! A small truth of its own: two vehicles in any gravity, burns, and every sensor at a period of its own.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(missing_docs, reason = "part of test binaries")]
#![allow(dead_code, reason = "each binary uses its own part")]

use filters::state::State;
use filters::{Reading, Sample, SpecificForce, Untold};
use interface::{Mission, Navigation};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};
use numerics::{Generator, Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

/// A mission about the Earth; `sensors` and `navigation` are the rest of its file.
///
/// * `orbit`: semi-major axis, m, and eccentricity; `sigma`: of the initial position, m, and velocity, m/s.
pub fn orbit(orbit: [f64; 2], sigma: [f64; 2], sensors: &str, navigation: &str) -> Navigation {
    let ([a, e], [position, velocity]) = (orbit, sigma);
    let text = format!(
        r#"
mission = 1
name = "test"
[time]
epoch_utc = "2020-01-01T00:00:00"
duration_s = 900.0
[environment]
gravity = {{ model = "zonal", mu_m3_s2 = 3.986e14, radius_m = 6.378e6, j = [1.083e-3, -2.532e-6, -1.620e-6] }}
[target.orbit]
at = "start"
elements = {{ a_m = {a:e}, e = {e:e}, i_deg = 15.0, raan_deg = 0.0, argp_deg = 0.0, mean_anomaly_deg = 0.0 }}
[chaser.relative]
at = "start"
axes = "n"
r_tc_m = [300.0, -900.0, 250.0]
v_tc_m_s = [0.1, 0.5, -0.2]
[initial_error]
sigma_position_m = {position:e}
sigma_velocity_m_s = {velocity:e}
{sensors}
[navigation]
{navigation}
"#
    );
    Mission::parse("test.toml", &text).unwrap().navigation()
}

/// Acceleration at an epoch, a position and a velocity, axes N, SI.
pub type Gravity = Box<dyn Fn(f64, &Vector3<f64>, &Vector3<f64>) -> Vector3<f64>>;

/// A constant acceleration from one second to another, axes N.
#[derive(Clone, Copy)]
pub struct Push {
    pub from: f64,
    pub to: f64,
    pub a_n: Vector3<f64>,
}

/// The truth; what its sensors are like is what the filter is told.
pub struct Flight {
    pub told: Navigation,
    pub gravity: Gravity,
    pub on_target: Vec<Push>,
    pub on_chaser: Vec<Push>,
    /// Seconds of one step; pushes begin and end with one.
    pub grid: f64,
    /// Target, then chaser: position and velocity.
    pub x: SVector<f64, 12>,
    g: Generator,
    step: u32,
    samples: i32,
    /// Sum of the chaser's specific force in its body axes since the last accelerometer sample, and its steps.
    felt: (Vector3<f64>, f64),
    untold: Untold,
}

const BIAS: Vector3<f64> = Vector3::new(2.9e-6, -2.0e-6, 1.0e-6);

/// Whether an epoch is one of a sensor's.
fn due(t: f64, period: Option<f64>) -> bool {
    period.is_some_and(|period| {
        let count = t / period;
        (count - count.round()).abs() < 1e-6
    })
}

impl Flight {
    /// * `target`, `relative`: of the target, and target minus chaser, position and velocity, axes N, SI.
    /// * returns: the truth, and an initial estimate drawn around it.
    pub fn new(
        told: &Navigation,
        gravity: Gravity,
        target: &Vector6<f64>,
        relative: &Vector6<f64>,
        run: u64,
    ) -> (Self, State) {
        let mut x = SVector::<f64, 12>::zeros();
        x.fixed_rows_mut::<6>(0).copy_from(target);
        x.fixed_rows_mut::<6>(6).copy_from(&(target - relative));
        let mut g = stream(31, run, Source::InitialError);
        let mut error = || {
            Vector6::from_fn(|i, _| {
                let w: f64 = StandardNormal.sample(&mut g);
                w * if i < 3 { told.p0.position } else { told.p0.velocity }
            })
        };
        let (of_target, of_chaser) = (error(), error());
        let mut start = State::zeros();
        start
            .fixed_rows_mut::<6>(0)
            .copy_from(&(relative + of_target - of_chaser));
        start.fixed_rows_mut::<6>(9).copy_from(&(target - relative + of_chaser));
        start.fixed_rows_mut::<3>(15).copy_from(&BIAS);
        let flight = Self {
            told: told.clone(),
            gravity,
            on_target: Vec::new(),
            on_chaser: Vec::new(),
            grid: 1.0,
            x,
            g: stream(32, run, Source::Lidar),
            step: 0,
            samples: 0,
            felt: (Vector3::zeros(), 0.0),
            untold: Untold::default(),
        };
        (flight, start)
    }

    fn part(&self, slot: usize) -> Vector3<f64> {
        self.x.fixed_rows::<3>(slot).into_owned()
    }

    /// Target minus chaser.
    pub fn relative(&self) -> Vector6<f64> {
        self.x.fixed_rows::<6>(0) - self.x.fixed_rows::<6>(6)
    }

    fn attitude(&self) -> Matrix3<f64> {
        let normal = self.part(6).cross(&self.part(9)).normalize();
        astro::frames::los_body_axes(&(self.part(0) - self.part(6)), &(self.part(3) - self.part(9)), &normal)
    }

    fn noise<const M: usize>(&mut self, sigma: [f64; M]) -> SVector<f64, M> {
        SVector::from_fn(|i, _| {
            let w: f64 = StandardNormal.sample(&mut self.g);
            w * sigma[i]
        })
    }

    fn sum(pushes: &[Push], t: f64) -> Vector3<f64> {
        let acting = pushes.iter().filter(|p| p.from <= t && t < p.to);
        acting.map(|p| p.a_n).sum()
    }

    /// Flies on to the next epoch at which a sensor samples.
    pub fn next(&mut self) -> Sample {
        loop {
            let t = f64::from(self.step) * self.grid;
            let middle = t + 0.5 * self.grid;
            let (a_t, a_c) = (Self::sum(&self.on_target, middle), Self::sum(&self.on_chaser, middle));
            let gravity = &self.gravity;
            let x = rk4::step(t, &self.x, self.grid, |t, y| {
                let part = |slot: usize| y.fixed_rows::<3>(slot).into_owned();
                let mut dy = SVector::<f64, 12>::zeros();
                dy.fixed_rows_mut::<3>(0).copy_from(&part(3));
                dy.fixed_rows_mut::<3>(3)
                    .copy_from(&(gravity(t, &part(0), &part(3)) + a_t));
                dy.fixed_rows_mut::<3>(6).copy_from(&part(9));
                dy.fixed_rows_mut::<3>(9)
                    .copy_from(&(gravity(t, &part(6), &part(9)) + a_c));
                dy
            });
            self.x = x;
            self.step += 1;
            self.untold.dv_t_n += a_t * self.grid;
            if a_t != Vector3::zeros() {
                self.untold.event_time += self.grid;
            }
            self.felt.0 += a_c;
            self.felt.1 += 1.0;
            if let Some(sample) = self.sample(f64::from(self.step) * self.grid) {
                return sample;
            }
        }
    }

    fn sample(&mut self, t: f64) -> Option<Sample> {
        let told = self.told.clone();
        let mut sample = Sample::blank(self.samples + 1, t);
        (sample.dcm_bc_n, sample.untold) = (self.attitude(), Some(self.untold));
        let (r_t, v_t) = (self.part(0), self.part(3));
        let lvlh = astro::Lvlh::new(&r_t, &v_t, &(self.gravity)(t, &r_t, &v_t));
        let (rho, rho_dot) = lvlh.relative(&self.part(6), &self.part(9));
        let scene = sensors::Scene {
            r_tc_n: r_t - self.part(6),
            v_tc_n: v_t - self.part(9),
            dcm_l_n: astro::frames::lidar_from_body() * sample.dcm_bc_n,
            lvlh: sensors::metrology::measure(&rho, &rho_dot),
        };
        let mut any = false;
        for known in told.sensors.iter().filter(|known| due(t, Some(known.period_s))) {
            let mut z = sensors::of(known.sensor).measure(&scene);
            for (z, sigma) in z.iter_mut().zip(known.deviations()) {
                *z += self.noise([sigma])[0];
            }
            (sample[known.sensor], any) = (Reading::Seen(z), true);
        }
        if let Some(s) = told.accelerometer.filter(|s| due(t, Some(s.period_s))) {
            let mean = sample.dcm_bc_n * self.felt.0 / self.felt.1.max(1.0);
            self.felt = (Vector3::zeros(), 0.0);
            let alpha = mean + BIAS + self.noise([s.sigma_m_s2; 3]);
            (sample.accelerometer, any) = (Some(SpecificForce::Mean(alpha)), true);
        }
        self.samples += i32::from(any);
        any.then_some(sample)
    }
}
