//! From variables to samples: which names of a truth or filter are read, and what they mean together.

use cosim::{BaseType, Probe, SlaveId, StepContext, System};
use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::HarnessError;
use crate::models::Participant;
use crate::scenarios::{Residual, Scenario, Signal};

/// True state at the epoch of one sensor sample, in the axes of the truth's variables, SI.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TruthSample {
    /// Ordinal of the sample, from 1.
    pub count: u32,
    /// Epoch, s.
    pub time: f64,
    /// Relative position, m.
    pub position: Vector3<f64>,
    /// Relative velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Unmodelled acceleration, m/s2.
    pub acceleration: Option<Vector3<f64>>,
    /// Accelerometer bias, m/s2, chaser body axes.
    pub bias: Option<Vector3<f64>>,
    /// Position, m, and velocity, m/s, of the chaser.
    pub chaser: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Whether the measurement of this sample arrived.
    pub measured: bool,
}

/// What a filter answers after one sample, in the axes of its variables, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Relative position, m.
    pub position: Vector3<f64>,
    /// Relative velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Unmodelled acceleration, m/s2, if it estimates one.
    pub acceleration: Option<Vector3<f64>>,
    /// Accelerometer bias, m/s2, chaser body axes, if it estimates one.
    pub bias: Option<Vector3<f64>>,
    /// Covariance of position, velocity, acceleration, if it has one.
    pub covariance: Option<SMatrix<f64, 9, 9>>,
    /// Leading rows of the covariance that hold states.
    pub dimension: usize,
    /// Standard deviation of the bias, m/s2.
    pub bias_sigma: Option<Vector3<f64>>,
    /// Innovation, three rows at a time.
    pub residual: [Option<Vector3<f64>>; 2],
    /// Variance of the innovation as predicted.
    pub residual_variance: [Option<Vector3<f64>>; 2],
    /// Normalised innovation squared, not divided by its rows.
    pub nis: Option<f64>,
    /// Root of the jerk density, m/s^2.5.
    pub jerk_root: Option<Vector3<f64>>,
    /// What the filter says of itself.
    pub status: Option<Status>,
}

/// Items of the `status` enumeration that a study acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// No estimate yet.
    Initialising,
    /// Measurements are used.
    Tracking,
    /// The sample held no measurement.
    Coasting,
    /// The filter has given up.
    Diverged,
}

impl Status {
    fn from_number(n: i32) -> Option<Self> {
        [Self::Initialising, Self::Tracking, Self::Coasting, Self::Diverged]
            .into_iter()
            .zip(1..)
            .find_map(|(status, number)| (number == n).then_some(status))
    }
}

/// What a coupled slave offers for reading, under the names of the contract.
struct Offered<'a> {
    system: &'a System,
    slave: SlaveId,
}

impl Offered<'_> {
    fn kind(&self, name: &str) -> Option<BaseType> {
        self.system.port(self.slave, name).map(|port| port.kind)
    }

    fn is_real(&self, name: &str) -> bool {
        self.kind(name) == Some(BaseType::Real)
    }

    fn is_integer(&self, name: &str) -> bool {
        matches!(self.kind(name), Some(BaseType::Integer | BaseType::Enumeration))
    }

    fn is_boolean(&self, name: &str) -> bool {
        self.kind(name) == Some(BaseType::Boolean)
    }
}

/// Names to read in one batch, with the places their values will be found at.
#[derive(Default)]
struct Batch {
    names: Vec<String>,
    reals: usize,
    integers: usize,
    booleans: usize,
}

impl Batch {
    fn real(&mut self, offered: &Offered<'_>, name: &str) -> Option<usize> {
        offered
            .is_real(name)
            .then(|| Self::place(&mut self.names, &mut self.reals, name))
    }

    fn integer(&mut self, offered: &Offered<'_>, name: &str) -> Option<usize> {
        offered
            .is_integer(name)
            .then(|| Self::place(&mut self.names, &mut self.integers, name))
    }

    fn boolean(&mut self, offered: &Offered<'_>, name: &str) -> Option<usize> {
        offered
            .is_boolean(name)
            .then(|| Self::place(&mut self.names, &mut self.booleans, name))
    }

    fn place(names: &mut Vec<String>, next: &mut usize, name: &str) -> usize {
        names.push(name.to_owned());
        *next += 1;
        *next - 1
    }

    /// All of the names or none of them, so that their values lie side by side.
    fn reals(&mut self, offered: &Offered<'_>, names: &[String]) -> Option<usize> {
        if names.iter().all(|n| offered.is_real(n)) {
            names
                .iter()
                .map(|n| Self::place(&mut self.names, &mut self.reals, n))
                .min()
        } else {
            None
        }
    }

    fn vector(&mut self, offered: &Offered<'_>, name: &str) -> Option<usize> {
        self.reals(offered, &elements(name, 1..=3))
    }

    fn probe(&self, offered: &Offered<'_>) -> Result<Probe, HarnessError> {
        Ok(offered.system.probe(offered.slave, &self.names)?)
    }
}

fn elements(name: &str, range: std::ops::RangeInclusive<usize>) -> Vec<String> {
    range.map(|i| format!("{name}[{i}]")).collect()
}

fn vector_at(values: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(values[at], values[at + 1], values[at + 2])
}

fn missing(participant: &Participant, name: &str) -> HarnessError {
    HarnessError::MissingSignal {
        label: participant.label.clone(),
        name: name.to_owned(),
    }
}

/// Reads [`TruthSample`]s.
pub(crate) struct TruthReader {
    head: Probe,
    body: Probe,
    position: usize,
    velocity: usize,
    acceleration: Option<usize>,
    bias: Option<usize>,
    chaser: Option<[usize; 2]>,
    measured: Option<usize>,
}

impl TruthReader {
    pub(crate) fn new(
        system: &System,
        slave: SlaveId,
        participant: &Participant,
        scenario: &Scenario,
    ) -> Result<Self, HarnessError> {
        let signals = &scenario.signals;
        let offered = &Offered { system, slave };
        let mut head = Batch::default();
        head.integer(offered, "sample_count")
            .ok_or_else(|| missing(participant, "sample_count"))?;
        let mut body = Batch::default();
        body.real(offered, "sample_time")
            .ok_or_else(|| missing(participant, "sample_time"))?;
        let mut required = |name: &str| body.vector(offered, name).ok_or_else(|| missing(participant, name));
        let position = required(signals.position.truth)?;
        let velocity = required(signals.velocity.truth)?;
        let chaser = match signals.chaser {
            Some([r, v]) => Some([required(r)?, required(v)?]),
            None => None,
        };
        let acceleration = body.vector(offered, signals.acceleration.truth);
        let bias = signals
            .bias
            .as_ref()
            .and_then(|Signal { truth, .. }| body.vector(offered, truth));
        let measured = body.boolean(offered, signals.measurement_valid);
        Ok(Self {
            head: head.probe(offered)?,
            body: body.probe(offered)?,
            position,
            velocity,
            acceleration,
            bias,
            chaser,
            measured,
        })
    }

    /// Ordinal of the newest sample; `None` when the truth cannot be read.
    pub(crate) fn newest(&mut self, context: &mut StepContext<'_>) -> Option<i32> {
        context.read(&mut self.head).ok()?;
        self.head.integers().first().copied()
    }

    /// The newest sample; `None` when the truth cannot be read.
    pub(crate) fn sample(&mut self, context: &mut StepContext<'_>, count: u32) -> Option<TruthSample> {
        context.read(&mut self.body).ok()?;
        let x = self.body.reals();
        Some(TruthSample {
            count,
            time: x[0],
            position: vector_at(x, self.position),
            velocity: vector_at(x, self.velocity),
            acceleration: self.acceleration.map(|at| vector_at(x, at)),
            bias: self.bias.map(|at| vector_at(x, at)),
            chaser: self.chaser.map(|[r, v]| (vector_at(x, r), vector_at(x, v))),
            measured: self.measured.is_none_or(|at| self.body.booleans()[at]),
        })
    }
}

/// Which sample an estimate belongs to, in the filter's own words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tag {
    /// `est.count`, if offered.
    pub count: Option<i32>,
    /// `est.time`, if offered.
    pub time: Option<f64>,
    /// `est.dimension`, if offered.
    pub dimension: Option<i32>,
    /// `status`, if offered.
    pub status: Option<Status>,
}

/// Reads [`Tag`]s and [`Estimate`]s.
pub(crate) struct EstimateReader {
    head: Probe,
    body: Probe,
    tag: [Option<usize>; 4],
    position: usize,
    velocity: usize,
    acceleration: Option<usize>,
    acceleration_valid: Option<usize>,
    bias: Option<usize>,
    covariance: Option<usize>,
    bias_sigma: Option<usize>,
    residual: [Option<usize>; 2],
    residual_variance: [Option<usize>; 2],
    nis: Option<usize>,
    jerk_root: Option<usize>,
}

impl EstimateReader {
    pub(crate) fn new(
        system: &System,
        slave: SlaveId,
        participant: &Participant,
        scenario: &Scenario,
    ) -> Result<Self, HarnessError> {
        let signals = &scenario.signals;
        let offered = &Offered { system, slave };
        let mut head = Batch::default();
        let tag = [
            head.integer(offered, "est.count"),
            head.real(offered, "est.time"),
            head.integer(offered, "est.dimension"),
            head.integer(offered, "status"),
        ];
        let mut body = Batch::default();
        let mut required = |name: &str| body.vector(offered, name).ok_or_else(|| missing(participant, name));
        let position = required(signals.position.estimate)?;
        let velocity = required(signals.velocity.estimate)?;
        let square: Vec<String> = (1..=9)
            .flat_map(|i| (1..=9).map(move |j| format!("cov.p[{i},{j}]")))
            .collect();
        let mut rows = |names: &dyn Fn(&Residual) -> Vec<String>| {
            std::array::from_fn(|i| {
                let residual = signals.residual[i].as_ref()?;
                body.reals(offered, &names(residual))
            })
        };
        let residual = rows(&|residual| residual.names.map(str::to_owned).to_vec());
        let residual_variance = rows(&|residual| elements(residual.variance, 1..=3));
        Ok(Self {
            tag,
            position,
            velocity,
            acceleration: body.vector(offered, signals.acceleration.estimate),
            acceleration_valid: body.boolean(offered, "est.acceleration_valid"),
            bias: signals
                .bias
                .as_ref()
                .and_then(|Signal { estimate, .. }| body.vector(offered, estimate)),
            covariance: body.reals(offered, &square),
            bias_sigma: signals
                .bias
                .as_ref()
                .and_then(|_| body.reals(offered, &elements("cov.sigma", 16..=18))),
            residual,
            residual_variance,
            nis: body.real(offered, "nis"),
            jerk_root: body.vector(offered, "q.s"),
            head: head.probe(offered)?,
            body: body.probe(offered)?,
        })
    }

    /// Which sample the estimate belongs to; `None` when the filter cannot be read.
    pub(crate) fn tag(&mut self, context: &mut StepContext<'_>) -> Option<Tag> {
        context.read(&mut self.head).ok()?;
        let integer = |at: Option<usize>| at.map(|at| self.head.integers()[at]);
        let [count, time, dimension, status] = self.tag;
        Some(Tag {
            count: integer(count),
            time: time.map(|at| self.head.reals()[at]),
            dimension: integer(dimension),
            status: integer(status).and_then(Status::from_number),
        })
    }

    /// The estimate; `None` when the filter cannot be read.
    pub(crate) fn estimate(&mut self, context: &mut StepContext<'_>, tag: &Tag) -> Option<Estimate> {
        context.read(&mut self.body).ok()?;
        let x = self.body.reals();
        let vector = |at: Option<usize>| at.map(|at| vector_at(x, at));
        let offered = if self.acceleration.is_some() { 9 } else { 6 };
        let dimension = tag
            .dimension
            .map_or(offered, |d| usize::try_from(d).unwrap_or(0).min(9));
        // Unless it says so itself, a filter of six states that shows an acceleration has none: it shows zeros.
        let estimates_acceleration = self
            .acceleration_valid
            .map_or(dimension != 6, |at| self.body.booleans()[at]);
        Some(Estimate {
            position: vector_at(x, self.position),
            velocity: vector_at(x, self.velocity),
            acceleration: vector(self.acceleration).filter(|_| estimates_acceleration),
            bias: vector(self.bias),
            covariance: self
                .covariance
                .filter(|_| dimension > 0)
                .map(|at| SMatrix::from_row_slice(&x[at..at + 81])),
            dimension,
            bias_sigma: vector(self.bias_sigma),
            residual: self.residual.map(vector),
            residual_variance: self.residual_variance.map(vector),
            nis: self.nis.map(|at| x[at]),
            jerk_root: vector(self.jerk_root),
            status: tag.status,
        })
    }
}

impl Estimate {
    /// First number of the estimate itself that is NaN or infinite, with its name.
    pub(crate) fn first_not_finite(&self) -> Option<(&'static str, f64)> {
        let parts = [
            ("position", Some(self.position)),
            ("velocity", Some(self.velocity)),
            ("acceleration", self.acceleration),
            ("bias", self.bias),
        ];
        parts
            .into_iter()
            .find_map(|(name, v)| v?.iter().copied().find(|x| !x.is_finite()).map(|x| (name, x)))
    }

    /// Block of the covariance that belongs to position (0), velocity (1) or acceleration (2).
    pub(crate) fn block(&self, index: usize) -> Option<Matrix3<f64>> {
        let p = self.covariance.as_ref().filter(|_| 3 * (index + 1) <= self.dimension)?;
        Some(p.fixed_view::<3, 3>(3 * index, 3 * index).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_numbers_are_those_of_the_interface() {
        assert_eq!(Status::from_number(1), Some(Status::Initialising));
        assert_eq!(Status::from_number(3), Some(Status::Coasting));
        assert_eq!(Status::from_number(4), Some(Status::Diverged));
        assert_eq!(Status::from_number(0), None);
    }
}
