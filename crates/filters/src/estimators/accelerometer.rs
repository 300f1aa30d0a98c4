//! What an accelerometer tells the propagation: a reading just after an epoch drives the step that follows, a mean drives the
//! interval that it was taken over.

use super::estimator::Gap;
use crate::commands::Commands;
use crate::dynamics::Thrust;
use crate::sample::{Sample, SpecificForce};
use crate::units::Units;
use interface::mission::KnownAccelerometer;
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
    mean: Mean,
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
    pub(super) fn new(known: &KnownAccelerometer, noise_enters: bool, units: Units) -> Self {
        Self {
            units,
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

    /// The reading of a sample that observes the bias rather than drive the propagation.
    pub(super) fn of_bias(&self, sample: &Sample) -> Option<Vector3<f64>> {
        let force = sample.accelerometer.as_ref()?;
        let alpha = self.reading(force);
        let drives = match force {
            SpecificForce::Instant(_) => alpha.norm() >= self.gate,
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
    pub(super) fn over(&mut self, gap: &Gap, sample: &Sample, estimated: &Bias) -> Driven {
        let dt = gap.length_s / self.units.time;
        let bias = &estimated.mean;
        let Some(force @ SpecificForce::Mean(_)) = &sample.accelerometer else {
            return self.held_over(dt, bias);
        };
        let alpha = self.reading(force);
        let drives = self.is_thrust(&alpha, estimated);
        let interval = (sample.time - self.mean.last_s.unwrap_or(gap.start_s)) / self.units.time;
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

    /// Whether the command says what a gap's readings do not: not where the gap ends with the mean of what it was.
    pub(super) fn leaves_to_command(sample: &Sample) -> bool {
        !matches!(sample.accelerometer, Some(SpecificForce::Mean(_)))
    }

    /// Commanded acceleration that drives by way of the reading which is held, axes N.
    pub(super) fn command_held(&self) -> Vector3<f64> {
        self.held.map_or_else(Vector3::zeros, |_| self.command_n)
    }

    /// Whether the newest reading has a commanded acceleration in it.
    pub(super) fn has_felt_command(&self) -> bool {
        self.command_n != Vector3::zeros()
    }

    /// Takes note of the velocity that a command has credited to a gap at whose end there is no mean; it will be part of one.
    pub(super) fn credit(&mut self, velocity_n: &Vector3<f64>) {
        if self.mean.last_s.is_some() {
            self.mean.credited_n += velocity_n;
        }
    }

    /// Takes note of what was commanded while the reading of a sample was taken.
    pub(super) fn remember(&mut self, sample: &Sample, since_s: f64, commands: &Commands) {
        let from_s = match sample.accelerometer {
            None => return,
            Some(SpecificForce::Instant(_)) => sample.time,
            Some(SpecificForce::Mean(_)) => since_s,
        };
        self.command_n = commands.mean(from_s, sample.time) / self.units.acceleration();
    }

    /// Begin of the interval of which the next mean is one, s; `None` before the first.
    pub(super) fn mean_since(&self) -> Option<f64> {
        self.mean.last_s
    }

    /// Takes note of a reading of the instant.
    pub(super) fn take(&mut self, sample: &Sample) {
        if let Some(force @ SpecificForce::Instant(_)) = &sample.accelerometer {
            let alpha = self.reading(force);
            self.held_for = 0.0;
            self.held = (alpha.norm() >= self.gate).then(|| Thrust {
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
