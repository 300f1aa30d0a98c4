//! A chaser that is commanded and a target that is left alone in low Earth orbit, flown in communication steps of a master: the truth by
//! itself, its sensors at periods of their own, and a filter to which samples and commands are handed over.

use astro::frames;
use filters::laws::FILTERS;
use filters::state::State;
use filters::tunable::Value;
use filters::{Command, Navigator, Reading, Sample, Settings, SpecificForce};
use interface::mission::{AccelerometerOutput, embedded};
use interface::{Navigation, Sensor};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};
use numerics::{Generator, Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

/// Times are whole numbers of this, s.
const TICK: f64 = 0.01;
const BIAS: f64 = 2.943e-6;
const SIGMA_ACCELEROMETER: f64 = 3.433e-6;

fn ticks(seconds: f64) -> u32 {
    (seconds / TICK).round() as u32
}

/// What is commanded, axes N; times are communication points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// An acceleration from one time to another, s and m/s2.
    Push(f64, f64, [f64; 3]),
    /// A change of velocity at a time, s and m/s.
    Impulse(f64, [f64; 3]),
}

impl Order {
    /// Change of velocity that it makes, m/s.
    pub fn dv(&self) -> f64 {
        match self {
            Self::Push(from, to, a) => Vector3::from(*a).norm() * (to - from),
            Self::Impulse(_, dv) => Vector3::from(*dv).norm(),
        }
    }
}

/// How a run goes.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Whether readings are means since the last one.
    pub mean: bool,
    /// Periods, s.
    pub accelerometer_s: f64,
    pub lidar_s: f64,
    /// Communication step, s.
    pub step_s: f64,
    /// Whether samples are handed over in the step after that in which they were taken.
    pub jacobi: bool,
    /// Whether the filter is told of the commands.
    pub told: bool,
    /// Share of a command that the thrusters leave out.
    pub short: f64,
    /// Whether the filter is saved and restored after each step.
    pub saved: bool,
    /// Run, for noise; `None` for sensors without any.
    pub noise: Option<u64>,
    pub duration_s: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            mean: true,
            accelerometer_s: 10.0,
            lidar_s: 10.0,
            step_s: 1.0,
            jacobi: false,
            told: true,
            short: 0.0,
            saved: false,
            noise: None,
            duration_s: 160.0,
        }
    }
}

/// The prediction at the end of a communication step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    pub t: f64,
    /// Predicted less true relative position and velocity.
    pub error: Vector6<f64>,
    pub sigma: Vector6<f64>,
    /// Estimated less true bias.
    pub bias: Vector3<f64>,
}

/// Square root of the target's acceleration density that the filter reckons with, m/s^1.5: the target is left alone.
const Q: f64 = 1e-7;

fn navigation(setup: &Setup) -> Navigation {
    let mut told = embedded("leo_venting").unwrap().mission().unwrap().navigation();
    (told.p0.position, told.p0.velocity, told.p0.bias) = (0.1, 1e-3, 1e-6);
    let lidar = told.sensors.iter_mut().find(|s| s.sensor == Sensor::Lidar).unwrap();
    lidar.period_s = setup.lidar_s;
    let accelerometer = told.accelerometer.as_mut().unwrap();
    accelerometer.period_s = setup.accelerometer_s;
    accelerometer.output = if setup.mean {
        AccelerometerOutput::Mean
    } else {
        AccelerometerOutput::Instantaneous
    };
    told
}

struct World {
    /// Target, then chaser: position and velocity.
    x: SVector<f64, 12>,
    now: u32,
    /// Velocity that the chaser was given by other than gravity since the last mean, axes N, and when that was.
    felt: Vector3<f64>,
    since: u32,
    sample: Sample,
    g: Option<Generator>,
}

impl World {
    fn part(&self, slot: usize) -> Vector3<f64> {
        self.x.fixed_rows::<3>(slot).into_owned()
    }

    fn relative(&self) -> Vector6<f64> {
        self.x.fixed_rows::<6>(0) - self.x.fixed_rows::<6>(6)
    }

    fn attitude(&self) -> Matrix3<f64> {
        let normal = self.part(6).cross(&self.part(9));
        frames::los_body_axes(&(self.part(0) - self.part(6)), &(self.part(3) - self.part(9)), &normal)
    }

    fn noise(&mut self, sigma: f64) -> f64 {
        let normal: f64 = self.g.as_mut().map_or(0.0, |g| StandardNormal.sample(g));
        sigma * normal
    }

    /// Flies on to `until` under a constant push, and samples on the way.
    fn fly(&mut self, until: u32, push: &Vector3<f64>, setup: &Setup) {
        while self.now < until {
            let next = [setup.accelerometer_s, setup.lidar_s, 1.0]
                .map(|period| (self.now / ticks(period) + 1) * ticks(period));
            let end = next.into_iter().fold(until, u32::min);
            let length = f64::from(end - self.now) * TICK;
            self.x = rk4::step(0.0, &self.x, length, |_, x| {
                let mut rate = SVector::<f64, 12>::zeros();
                for (slot, push) in [(0, Vector3::zeros()), (6, *push)] {
                    let r = x.fixed_rows::<3>(slot).into_owned();
                    rate.fixed_rows_mut::<3>(slot).copy_from(&x.fixed_rows::<3>(slot + 3));
                    rate.fixed_rows_mut::<3>(slot + 3)
                        .copy_from(&(astro::earth::FILTER.acceleration(&r) + push));
                }
                rate
            });
            self.felt += push * length;
            self.now = end;
            self.measure(push, setup);
        }
    }

    fn measure(&mut self, push: &Vector3<f64>, setup: &Setup) {
        let due = |period: f64| self.now.is_multiple_of(ticks(period));
        let (reads, sees) = (due(setup.accelerometer_s), due(setup.lidar_s));
        if !(reads || sees) {
            return;
        }
        let dcm_bc_n = self.attitude();
        let mut sample = Sample {
            dcm_bc_n,
            ..Sample::blank(self.sample.count + 1, f64::from(self.now) * TICK)
        };
        if sees {
            let rho = frames::lidar_from_body() * dcm_bc_n * (self.part(0) - self.part(6));
            let angle = 0.04_f64.to_radians();
            let noise = [0.08, angle, angle].map(|sigma| self.noise(sigma));
            sample[Sensor::Lidar] = Reading::of((sensors::lidar::measure(&rho) + Vector3::from(noise)).as_slice());
        }
        if reads {
            let noise = Vector3::from([(); 3].map(|()| BIAS + self.noise(SIGMA_ACCELEROMETER)));
            sample.accelerometer = Some(if setup.mean {
                let mean = self.felt / (f64::from(self.now - self.since) * TICK);
                (self.felt, self.since) = (Vector3::zeros(), self.now);
                SpecificForce::Mean(dcm_bc_n * mean + noise)
            } else {
                SpecificForce::Instant(dcm_bc_n * push + noise)
            });
        }
        self.sample = sample;
    }
}

/// A run from a first estimate that is the truth but for noise.
pub fn fly(setup: &Setup, orders: &[Order]) -> Vec<Seen> {
    let mut x = SVector::<f64, 12>::zeros();
    let (r_c, v_c) = (Vector3::new(6.878e6, 0.0, 0.0), Vector3::new(0.0, 7350.0, 1970.0));
    for (slot, part) in [
        (0, r_c + Vector3::new(80.0, -120.0, 50.0)),
        (3, v_c + Vector3::new(0.02, 0.03, -0.05)),
        (6, r_c),
        (9, v_c),
    ] {
        x.fixed_rows_mut::<3>(slot).copy_from(&part);
    }
    let mut world = World {
        x,
        now: 0,
        felt: Vector3::zeros(),
        since: 0,
        sample: Sample::blank(0, 0.0),
        g: setup.noise.map(|run| stream(13, run, Source::Lidar)),
    };
    world.sample.dcm_bc_n = world.attitude();
    let told = navigation(setup);
    let mut start = State::zeros();
    start.fixed_rows_mut::<6>(0).copy_from(&world.relative());
    start.fixed_rows_mut::<6>(9).copy_from(&world.x.fixed_rows::<6>(6));
    start.fixed_rows_mut::<3>(15).fill(BIAS);
    if setup.noise.is_some() {
        let l = filters::dynamics::initial_covariance(&told.p0)
            .cholesky()
            .unwrap()
            .unpack();
        start += l * State::from_fn(|_, _| world.noise(1.0));
    }
    let mut settings = Settings {
        filter: FILTERS.iter().position(|f| f.name == "snc").unwrap(),
        ..Settings::default()
    };
    *settings.tunable_mut("snc", "q").unwrap() = Value::Real(Q);
    let mut nav = Navigator::new(&told, &settings, 0.0).unwrap();
    nav.begin(&world.sample, &start, &Command::default());
    let (mut seen, mut command) = (Vec::new(), Command::default());
    let h = ticks(setup.step_s);
    for k in 0..ticks(setup.duration_s) / h {
        let t = f64::from(k * h) * TICK;
        let at = |time: &f64| ticks(*time) == k * h;
        for order in orders {
            match order {
                Order::Push(from, _, a) if at(from) => command.a_cmd_c_n = Vector3::from(*a),
                Order::Push(_, to, _) if at(to) => command.a_cmd_c_n = Vector3::zeros(),
                Order::Impulse(when, dv) if at(when) => {
                    command.impulse_c_n = Vector3::from(*dv);
                    command.impulse_count += 1;
                    let done = command.impulse_c_n * (1.0 - setup.short);
                    world.felt += done;
                    let mut v_c = world.x.fixed_rows_mut::<3>(9);
                    v_c += done;
                }
                _ => (),
            }
        }
        let before = world.sample.clone();
        let push = command.a_cmd_c_n * (1.0 - setup.short);
        world.fly((k + 1) * h, &push, setup);
        let sample = if setup.jacobi { &before } else { &world.sample };
        let heard = if setup.told { command } else { Command::default() };
        nav.step(t, setup.step_s, &heard);
        nav.process(sample, &start).unwrap();
        if setup.saved {
            nav = postcard::from_bytes(&postcard::to_allocvec(&nav).unwrap()).unwrap();
        }
        let pred = nav.predict();
        let mut x = Vector6::zeros();
        x.fixed_rows_mut::<3>(0).copy_from(&pred.r_tc_n);
        x.fixed_rows_mut::<3>(3).copy_from(&pred.v_tc_n);
        seen.push(Seen {
            t: t + setup.step_s,
            error: x - world.relative(),
            sigma: pred.sigma,
            bias: nav.estimate().x.fixed_rows::<3>(15).add_scalar(-BIAS),
        });
    }
    seen
}

/// How far a command moves the error of the prediction at most, position (m) and velocity (m/s): the same run with it and without.
pub fn moved(setup: &Setup, orders: &[Order]) -> (f64, f64) {
    let (with, without) = (fly(setup, orders), fly(setup, &[]));
    let pairs = with.iter().zip(&without);
    pairs.fold((0.0, 0.0), |(r, v): (f64, f64), (a, b)| {
        let by = a.error - b.error;
        (r.max(by.fixed_rows::<3>(0).norm()), v.max(by.fixed_rows::<3>(3).norm()))
    })
}
