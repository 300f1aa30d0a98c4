//! From variables to samples: which names of a truth or filter are read, and what they mean together.

use cosim::{CosimError, Handle, Sample, SlaveId, StepContext, System};
use nalgebra::{SMatrix, Vector3};

use crate::error::StudyError;
use crate::participant::Participant;
use crate::samples::{Estimate, StatusItems, TruthSample};
use crate::world::{Frame, Innovation};
use interface::Status;
use interface::ports::{PORTS, Part};

type VectorHandle = Handle<[f64; 3]>;

/// A variable that no comparison can do without.
fn required<T>(found: Result<T, CosimError>, participant: &Participant, name: &str) -> Result<T, StudyError> {
    found.map_err(|_| StudyError::MissingSignal {
        label: participant.label.clone(),
        name: name.to_owned(),
    })
}

/// Reads [`TruthSample`]s.
pub(crate) struct TruthReader {
    /// Read at each communication point.
    head: Sample,
    count: Handle<i32>,
    /// Read once for each sample.
    body: Sample,
    time: Handle<f64>,
    position: VectorHandle,
    velocity: VectorHandle,
    acceleration: Option<VectorHandle>,
    bias: Option<VectorHandle>,
    chaser: Option<[VectorHandle; 2]>,
    measured: Vec<Handle<bool>>,
}

impl TruthReader {
    pub(crate) fn new(
        system: &System,
        slave: SlaveId,
        participant: &Participant,
        frame: Frame,
    ) -> Result<Self, StudyError> {
        let signals = frame.signals();
        let mut head = system.probe(slave)?;
        let count = required(head.integer("sample_count"), participant, "sample_count")?;
        let mut body = system.probe(slave)?;
        let time = required(body.real("sample_time"), participant, "sample_time")?;
        let mut vector = |name: &str| required(body.vec3(name), participant, name);
        let position = vector(signals.position[0])?;
        let velocity = vector(signals.velocity[0])?;
        let chaser = match signals.chaser {
            Some([r, v]) => Some([vector(r)?, vector(v)?]),
            None => None,
        };
        // Of which each says that a sensor measured the target; a truth has those of its sensors.
        let valid = PORTS.iter().filter(|port| matches!(port.part, Some((_, Part::Valid))));
        let measured = valid.filter_map(|port| body.boolean(port.name).ok()).collect();
        Ok(Self {
            head: head.sample(),
            count,
            time,
            position,
            velocity,
            acceleration: body.vec3(signals.acceleration[0]).ok(),
            bias: signals.bias.and_then(|[name, _]| body.vec3(name).ok()),
            chaser,
            measured,
            body: body.sample(),
        })
    }

    /// Ordinal of the newest sample; `None` when the truth cannot be read.
    pub(crate) fn newest(&mut self, context: &mut StepContext<'_>) -> Option<i32> {
        context.read(&mut self.head).ok()?;
        Some(self.head.get(self.count))
    }

    /// The newest sample; `None` when the truth cannot be read.
    pub(crate) fn sample(&mut self, context: &mut StepContext<'_>, count: u32) -> Option<TruthSample> {
        context.read(&mut self.body).ok()?;
        let x = &self.body;
        let vector = |handle| Vector3::from(x.get(handle));
        Some(TruthSample {
            count,
            epoch: 0,
            time: x.get(self.time),
            position: vector(self.position),
            velocity: vector(self.velocity),
            acceleration: self.acceleration.map(vector),
            bias: self.bias.map(vector),
            chaser: self.chaser.map(|[r, v]| (vector(r), vector(v))),
            // A truth that says nothing of its sensors is taken to measure at each sample.
            measured: self.measured.is_empty() || self.measured.iter().any(|valid| x.get(*valid)),
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
    /// Read at each communication point.
    head: Sample,
    count: Option<Handle<i32>>,
    time: Option<Handle<f64>>,
    dimension: Option<Handle<i32>>,
    status: Option<Handle<i32>>,
    statuses: StatusItems,
    /// Read once for each sample.
    body: Sample,
    position: VectorHandle,
    velocity: VectorHandle,
    acceleration: Option<VectorHandle>,
    acceleration_valid: Option<Handle<bool>>,
    bias: Option<VectorHandle>,
    bias_sigma: Option<VectorHandle>,
    covariance: Option<Handle<[[f64; 9]; 9]>>,
    residual: [Option<VectorHandle>; 2],
    residual_variance: [Option<VectorHandle>; 2],
    nis: Option<Handle<f64>>,
    nis_rows: Option<Handle<i32>>,
    jerk_root: Option<VectorHandle>,
}

impl EstimateReader {
    pub(crate) fn new(
        system: &System,
        slave: SlaveId,
        participant: &Participant,
        frame: Frame,
    ) -> Result<Self, StudyError> {
        let signals = frame.signals();
        let mut head = system.probe(slave)?;
        let mut body = system.probe(slave)?;
        let mut vector = |name: &str| required(body.vec3(name), participant, name);
        let position = vector(signals.position[1])?;
        let velocity = vector(signals.velocity[1])?;
        let innovations = signals.innovations.each_ref();
        let innovation = |rows: &Option<Innovation>| body.reals(&rows.as_ref()?.names).ok();
        let residual = innovations.map(innovation);
        let variance = |rows: &Option<Innovation>| body.vec3(rows.as_ref()?.variance).ok();
        let residual_variance = innovations.map(variance);
        Ok(Self {
            count: head.integer("est.count").ok(),
            time: head.real("est.time").ok(),
            dimension: head.integer("est.dimension").ok(),
            status: head.integer("status").ok(),
            statuses: participant.statuses.clone(),
            head: head.sample(),
            position,
            velocity,
            acceleration: body.vec3(signals.acceleration[1]).ok(),
            acceleration_valid: body.boolean("est.acceleration_valid").ok(),
            bias: signals.bias.and_then(|[_, name]| body.vec3(name).ok()),
            bias_sigma: signals.bias_sigma.and_then(|names| body.reals(&names).ok()),
            covariance: body.matrix("cov.p").ok(),
            residual,
            residual_variance,
            nis: body.real("nis").ok(),
            nis_rows: body.integer("nis.rows").ok(),
            jerk_root: body.vec3("q.s").ok(),
            body: body.sample(),
        })
    }

    /// Which sample the estimate belongs to; `None` when the filter cannot be read.
    pub(crate) fn tag(&mut self, context: &mut StepContext<'_>) -> Option<Tag> {
        context.read(&mut self.head).ok()?;
        let integer = |handle| self.head.get::<i32>(handle);
        Some(Tag {
            count: self.count.map(integer),
            time: self.time.map(|handle| self.head.get(handle)),
            dimension: self.dimension.map(integer),
            status: self.status.map(integer).and_then(|number| self.statuses.status(number)),
        })
    }

    /// The estimate; `None` when the filter cannot be read.
    pub(crate) fn estimate(&mut self, context: &mut StepContext<'_>, tag: &Tag) -> Option<Estimate> {
        context.read(&mut self.body).ok()?;
        let x = &self.body;
        let vector = |handle| Vector3::from(x.get::<[f64; 3]>(handle));
        let offered = if self.acceleration.is_some() { 9 } else { 6 };
        let dimension = tag
            .dimension
            .map_or(offered, |d| usize::try_from(d).unwrap_or(0).min(9));
        // Unless it says so itself, a filter of six states that shows an acceleration has none: it shows zeros.
        let estimates_acceleration = self.acceleration_valid.map_or(dimension != 6, |valid| x.get(valid));
        Some(Estimate {
            position: vector(self.position),
            velocity: vector(self.velocity),
            acceleration: self.acceleration.map(vector).filter(|_| estimates_acceleration),
            bias: self.bias.map(vector),
            covariance: self
                .covariance
                .filter(|_| dimension > 0)
                .map(|handle| SMatrix::<f64, 9, 9>::from(x.get(handle)).transpose()),
            dimension,
            bias_sigma: self.bias_sigma.map(vector),
            residual: self.residual.map(|rows| rows.map(vector)),
            residual_variance: self.residual_variance.map(|rows| rows.map(vector)),
            nis: self.nis.map(|handle| x.get(handle)),
            nis_rows: self.nis_rows.map(|handle| u32::try_from(x.get(handle)).unwrap_or(0)),
            jerk_root: self.jerk_root.map(vector),
            status: tag.status,
        })
    }
}
