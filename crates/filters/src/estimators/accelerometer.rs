//! What an accelerometer tells the propagation: a reading just after an epoch drives the step that follows, a mean drives the
//! interval that it was taken over. What the chaser was commanded to do meanwhile is no news: where a filter is told of it, that is taken
//! out of a reading, and drives at its own time.

use super::estimator::Gap;
use crate::commands::Commands;
use crate::dynamics::Thrust;
use crate::sample::{Sample, SpecificForce};
use crate::units::Units;
use interface::Navigation;
use interface::mission::{AccelerometerOutput, KnownAccelerometer};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// An accelerometer and what it has told; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Accelerometer {
    units: Units,
    gate: f64,
    sigma: f64,
    /// Whether the noise of a reading of the instant that drives enters the covariance.
    noise_enters: bool,
    /// How long the newest reading of the instant has driven.
    held_for: f64,
    /// Drives the steps until the next reading; `None` when below the gate or before the first.
    held: Option<Thrust>,
    /// Commanded acceleration that the newest reading has in it, axes N.
    command_n: Vector3<f64>,
    /// What a mean covers of the time since the last one where samples in between did not arrive.
    cadence: Cadence,
    mean: Mean,
}

/// How often an accelerometer samples, as far as a mission says it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Cadence {
    /// Whether its first reading is told to be a mean.
    begins_with_mean: bool,
    /// Its period, s.
    period_s: f64,
    /// Whether every epoch at which a sensor samples is one of its own.
    always: bool,
}

/// What readings that are means leave behind.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Mean {
    /// Epoch of the newest, s.
    last_s: Option<f64>,
    /// Shortest time between two.
    shortest: Option<f64>,
    /// Whether it drove the propagation.
    drives: bool,
    /// Its acceleration, axes N; zero where it did not.
    drive_n: Vector3<f64>,
    /// By how much it differs from the one before.
    change_n: Vector3<f64>,
    /// Velocity that the filter has credited since then without a reading, axes N.
    credited_n: Vector3<f64>,
    /// Ordinal of the sample that it came with; 0 before the first.
    count: i32,
    /// Ordinal of the newest sample, whatever it held.
    newest: i32,
    /// Whether a sample has not arrived since then, or one without its reading.
    gone: bool,
}

/// The bias as it is estimated; internal units, body axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bias {
    pub mean: Vector3<f64>,
    /// The largest variance of an axis.
    pub variance: f64,
}

/// What drives an interval, and what stays unknown of it at its end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Driven {
    pub thrust: Option<Thrust>,
    /// Set where the covariance must grow.
    pub blur: Option<Blur>,
}

/// Errors of the chaser's position and velocity at the end of an interval; internal units, axes N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blur {
    /// One standard deviation of position, along this.
    pub position_n: Vector3<f64>,
    /// One standard deviation of velocity, along this.
    pub velocity_n: Vector3<f64>,
    /// Standard deviation of a constant acceleration over the interval, each axis.
    pub acceleration: f64,
    /// The interval.
    pub interval: f64,
}

impl Accelerometer {
    /// * `told`: the mission, for the periods of the other sensors.
    pub(super) fn new(known: &KnownAccelerometer, told: &Navigation, noise_enters: bool, units: Units) -> Self {
        let multiple = |period_s: f64| {
            let periods = period_s / known.period_s;
            periods > 0.5 && (periods - periods.round()).abs() < 1e-6
        };
        Self {
            units,
            cadence: Cadence {
                begins_with_mean: known.output == AccelerometerOutput::Mean,
                period_s: known.period_s,
                always: told.sensors.iter().all(|sensor| multiple(sensor.period_s)),
            },
            gate: known.gate_m_s2 / units.acceleration(),
            sigma: known.sigma_m_s2 / units.acceleration(),
            noise_enters,
            held_for: 0.0,
            held: None,
            command_n: Vector3::zeros(),
            mean: Mean::default(),
        }
    }

    /// Variance of a sample, per axis.
    pub(super) fn variance(&self) -> f64 {
        self.sigma * self.sigma
    }

    fn reading(&self, force: &SpecificForce) -> Vector3<f64> {
        force.alpha_c_bc() / self.units.acceleration()
    }

    /// The reading of a sample less what was commanded meanwhile, once [`Accelerometer::over`] knows it.
    fn beyond_command(&self, force: &SpecificForce, sample: &Sample) -> Vector3<f64> {
        let alpha = self.reading(force);
        if self.command_n == Vector3::zeros() {
            return alpha;
        }
        alpha - sample.dcm_bc_n * self.command_n
    }

    /// Whether a reading of the instant is that of a thrust: with what was commanded in it, since thrusters are not perfect, or beyond
    /// that, since something else may push the other way.
    fn instant_drives(&self, force: &SpecificForce, beyond: &Vector3<f64>) -> bool {
        self.reading(force).norm() >= self.gate || beyond.norm() >= self.gate
    }

    /// The reading of a sample, less what was commanded, that observes the bias rather than drive the propagation.
    pub(super) fn of_bias(&self, sample: &Sample) -> Option<Vector3<f64>> {
        let force = sample.accelerometer.as_ref()?;
        let alpha = self.beyond_command(force, sample);
        let drives = match force {
            SpecificForce::Instant(_) => self.instant_drives(force, &alpha),
            SpecificForce::Mean(_) => self.mean.drives,
        };
        (!drives).then_some(alpha)
    }

    /// Whether a mean is that of a thrust: above the gate as any reading, and below it too where it is further from the bias than
    /// noise and what is not known of the bias can account for. A burn that fills a hundredth of the interval has a mean as small
    /// as the gate, and its velocity would be lost and the bias be taken for it.
    fn is_thrust(&self, alpha: &Vector3<f64>, bias: &Bias) -> bool {
        let beyond_chance = 6.0 * (self.variance() + bias.variance).sqrt();
        alpha.norm() >= self.gate || (alpha - bias.mean).norm() >= beyond_chance
    }

    /// What drives the gap up to a sample.
    ///
    /// A mean is used over the interval since the last one. It stands in body axes as they are at its end, into which the unit
    /// has turned what it felt earlier, so that no turn is left to account for.
    ///
    /// The mean fixes the velocity gained, not when in the interval T it was gained. Let a burn have run in the last interval
    /// and end in this one, or begin in it: with a the mean and a' that of the interval before, the position at the end is off
    /// by at most |a - a'| T^2 / 2, and evenly spread over that when the edge may lie anywhere. So the covariance of the
    /// chaser's position gains a part of standard deviation |a - a'| T^2 / (2 sqrt 3) along the change; nothing where the
    /// chaser does not thrust. A burn that fills neither of two intervals can have the same mean in both; so the change before
    /// counts too, where it is the larger one.
    ///
    /// Where other sensors sample in between, T is longer than the gap: the last mean is held meanwhile, its effect made
    /// uncertain, and what it credited too little or too much is made good in the gap at whose end the reading comes.
    ///
    /// Where samples were lost, T is longer than the period P that the reading is the mean of, which is taken to be the
    /// shortest T so far; nothing is known of the other T - P. The reading stands for all of T, and the velocity's covariance
    /// gains (T - P) |a - a'| / sqrt 3, with |a| where that is larger.
    ///
    /// * `commands`: what is known of the commands; all of this is then about what is felt beyond them.
    pub(super) fn over(&mut self, gap: &Gap, sample: &Sample, estimated: &Bias, commands: Option<&Commands>) -> Driven {
        let dt = gap.length_s / self.units.time;
        let bias = &estimated.mean;
        let no_reading = self.cadence.always && sample.accelerometer.is_none();
        self.mean.gone |= no_reading || sample.count.wrapping_sub(self.mean.newest) != 1;
        self.mean.newest = sample.count;
        let Some(force @ SpecificForce::Mean(_)) = &sample.accelerometer else {
            if sample.accelerometer.is_some() {
                let before = |told: &Commands| told.mean(sample.time, sample.time) / self.units.acceleration();
                self.command_n = commands.map_or_else(Vector3::zeros, before);
            }
            return self.held_over(dt, bias);
        };
        let since_s = self.mean.last_s.unwrap_or(gap.start_s);
        self.command_n = commands.map_or_else(Vector3::zeros, |told| {
            let from_s = sample.time - self.covered(since_s, sample);
            told.gained(from_s, sample.time) / ((sample.time - from_s) * self.units.acceleration())
        });
        let alpha = self.beyond_command(force, sample);
        let drives = self.is_thrust(&alpha, estimated);
        let interval = (sample.time - since_s) / self.units.time;
        let dcm_n_bc = sample.dcm_bc_n.transpose();
        let drive_n = if drives {
            dcm_n_bc * (alpha - bias)
        } else {
            Vector3::zeros()
        };
        let earlier = interval - dt;
        let late_n = if earlier > 1e-9 * interval {
            drive_n * earlier - self.mean.credited_n
        } else {
            Vector3::zeros()
        };
        let change_n = drive_n - self.mean.drive_n;
        let period = self.mean.shortest.map_or(interval, |shortest| shortest.min(interval));
        let unseen = if interval > 1.5 * period {
            interval - period
        } else {
            0.0
        };
        let mut unsure_n = larger(change_n, self.mean.change_n);
        if unseen > 0.0 {
            unsure_n = larger(unsure_n, drive_n);
        }
        let unseen_n = unsure_n * if late_n.dot(&unsure_n) < 0.0 { -unseen } else { unseen };
        self.mean = Mean {
            last_s: Some(sample.time),
            shortest: Some(period),
            drives,
            drive_n,
            change_n,
            credited_n: Vector3::zeros(),
            count: sample.count,
            newest: sample.count,
            gone: false,
        };
        self.held = drives.then_some(Thrust {
            alpha_c_bc: alpha,
            dcm_n_bc,
        });
        if !drives && late_n == Vector3::zeros() && unseen_n == Vector3::zeros() {
            return Driven::default();
        }
        let root3 = 3.0_f64.sqrt();
        Driven {
            thrust: Some(Thrust {
                alpha_c_bc: sample.dcm_bc_n * (late_n / dt) + if drives { alpha } else { *bias },
                dcm_n_bc,
            }),
            blur: Some(Blur {
                position_n: unsure_n * (interval * interval / (2.0 * root3)),
                velocity_n: (late_n + unseen_n) / root3,
                acceleration: self.sigma,
                interval,
            }),
        }
    }

    /// The last reading over a gap at whose end there is none, or one of the instant.
    ///
    /// Its error n ~ N(0, sigma^2 I) is the same for as long as it is held: after a time t, n t in velocity. Where other sensors
    /// sample meanwhile, that is made of parts as if they were independent, each with as much as t^2 grows by.
    fn held_over(&mut self, dt: f64, bias: &Vector3<f64>) -> Driven {
        let mut driven = Driven {
            thrust: self.held,
            blur: None,
        };
        if self.noise_enters && self.held.is_some() && self.mean.last_s.is_none() {
            let before = self.held_for;
            self.held_for += dt;
            driven.blur = Some(Blur {
                position_n: Vector3::zeros(),
                velocity_n: Vector3::zeros(),
                acceleration: self.sigma * (self.held_for.powi(2) - before.powi(2)).sqrt() / dt,
                interval: dt,
            });
        }
        if let (Some(held), Some(_)) = (&self.held, self.mean.last_s) {
            let velocity_n = held.dcm_n_bc * (held.alpha_c_bc - bias) * dt;
            self.mean.credited_n += velocity_n;
            driven.blur = Some(Blur {
                position_n: Vector3::zeros(),
                velocity_n: velocity_n / 3.0_f64.sqrt(),
                acceleration: 0.0,
                interval: dt,
            });
        }
        driven
    }

    /// Length of the interval of which a reading is the mean, s.
    ///
    /// All since the last one, unless samples did not arrive: then the ordinals say how many, where each has a reading; where not, the
    /// mission says what the period is.
    fn covered(&self, since_s: f64, sample: &Sample) -> f64 {
        let (all, samples) = (sample.time - since_s, sample.count.saturating_sub(self.mean.count));
        if !self.mean.gone {
            all
        } else if self.cadence.always && samples > 0 {
            all / f64::from(samples)
        } else {
            self.cadence.period_s.min(all)
        }
    }

    /// Begin of the interval of which the next reading may be the mean, s; `None` for a reading of the instant.
    ///
    /// * `start_s`: start of the run.
    pub(super) fn reads_since(&self, start_s: f64) -> Option<f64> {
        self.mean.last_s.or(self.cadence.begins_with_mean.then_some(start_s))
    }

    /// Takes note of a reading of the instant.
    pub(super) fn take(&mut self, sample: &Sample) {
        if let Some(force @ SpecificForce::Instant(_)) = &sample.accelerometer {
            let alpha = self.beyond_command(force, sample);
            self.held_for = 0.0;
            self.held = self.instant_drives(force, &alpha).then(|| Thrust {
                alpha_c_bc: alpha,
                dcm_n_bc: sample.dcm_bc_n.transpose(),
            });
        }
    }
}

/// The first unless the second is longer.
fn larger(first: Vector3<f64>, second: Vector3<f64>) -> Vector3<f64> {
    if first.norm() >= second.norm() { first } else { second }
}
