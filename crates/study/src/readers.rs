//! From variables to samples: which names of a truth or filter are read, and what they mean together.

use cosim::{CosimError, Handle, Port, Probe, Sample, SlaveId, StepContext, System};
use nalgebra::{SMatrix, Vector3};

use crate::error::StudyError;
use crate::participant::Participant;
use crate::samples::{Estimate, StatusItems, TruthSample};
use crate::signals::Innovation;
use crate::world::Frame;
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

/// Units of position, velocity and acceleration, as exponents of m and s.
const UNITS: [[i32; 2]; 3] = [[1, 0], [1, -1], [1, -2]];

/// Refuses a variable whose unit measures something else; one that says no unit is taken as it comes.
///
/// # Errors
/// [`StudyError::Unit`].
fn check_unit(system: &System, slave: SlaveId, label: &str, name: &str, [m, s]: [i32; 2]) -> Result<(), StudyError> {
    let port = system.port(slave, name);
    let Some(unit) = port.and_then(|port| port.unit.as_deref()) else {
        return Ok(());
    };
    if unit.base.is_none_or(|base| base.exponents == [0, m, s, 0, 0, 0, 0, 0]) {
        return Ok(());
    }
    Err(StudyError::Unit {
        label: label.to_owned(),
        name: name.to_owned(),
        found: unit.name.clone(),
        expected: in_words(m, s),
    })
}

/// [`check_unit`] for the elements of position, velocity and acceleration.
fn check_vectors(system: &System, slave: SlaveId, label: &str, names: [&str; 3]) -> Result<(), StudyError> {
    for (name, unit) in names.into_iter().zip(UNITS) {
        for axis in 1..=3 {
            check_unit(system, slave, label, &format!("{name}[{axis}]"), unit)?;
        }
    }
    Ok(())
}

/// A unit of m and s, as in 'm2/s3'.
fn in_words(m: i32, s: i32) -> String {
    let power = |unit: &str, n: i32| if n == 1 { unit.to_owned() } else { format!("{unit}{n}") };
    if s == 0 {
        power("'m", m) + "'"
    } else {
        format!("'{}/{}'", power("m", m), power("s", -s))
    }
}

/// Whether a variable is `name` or an element of it.
fn is_element(variable: &str, name: &str) -> bool {
    let indices = variable.strip_prefix(name);
    indices.is_some_and(|i| i.is_empty() || i.starts_with('['))
}

/// Names, without indices, of what a filter is fed or read whose unit it does not say, though the truth says its own.
pub(crate) fn units_unsaid(system: &System, truth: SlaveId, filter: SlaveId, frame: Frame) -> Vec<String> {
    let signals = frame.signals();
    let says = |slave, name: &str| {
        let unit = system
            .port(slave, &format!("{name}[1]"))
            .and_then(|port| port.unit.as_deref());
        unit.is_some_and(|unit| unit.base.is_some())
    };
    let read = [signals.position, signals.velocity].map(|[of_truth, of_filter]| {
        let silent = says(truth, of_truth) && !says(filter, of_filter);
        silent.then(|| of_filter.to_owned())
    });
    let mut names: Vec<String> = Vec::new();
    let fed = system.inputs_of_unknown_unit(filter).into_iter();
    let fed = fed.map(|name| name.split('[').next().unwrap_or(name).to_owned());
    for name in fed.chain(read.into_iter().flatten()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
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
    event: Option<Handle<bool>>,
    /// Whether the acceleration is of the target alone.
    inertial: bool,
    push: Push,
}

/// What is known of the pushes that no filter is told of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Push {
    Never,
    Acts,
    /// First epoch without, s.
    Over(f64),
}

impl Push {
    /// What is known after a sample at which one acts or does not.
    fn then(self, acts: bool, time: f64) -> Self {
        match self {
            _ if acts => Self::Acts,
            Self::Acts => Self::Over(time),
            before => before,
        }
    }

    fn since(self, time: f64) -> Option<f64> {
        match self {
            Self::Never => None,
            Self::Acts => Some(0.0),
            Self::Over(end) => Some(time - end),
        }
    }
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
        let names = [signals.position[0], signals.velocity[0], signals.acceleration[0]];
        check_vectors(system, slave, &participant.label, names)?;
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
            event: body.boolean("truth.event_active").ok(),
            inertial: frame == Frame::Inertial,
            push: Push::Never,
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
        let acceleration = self.acceleration.map(vector);
        // A truth that does not say so is taken to push by its acceleration, unless that is one of the formation's frame.
        let acts = match self.event {
            Some(event) => x.get(event),
            None => self.inertial && acceleration.is_some_and(|a| a.norm() > 0.0),
        };
        let time = x.get(self.time);
        self.push = self.push.then(acts, time);
        Some(TruthSample {
            count,
            epoch: 0,
            time,
            pushed: acts,
            since_push: self.push.since(time),
            position: vector(self.position),
            velocity: vector(self.velocity),
            acceleration,
            bias: self.bias.map(vector),
            chaser: self.chaser.map(|[r, v]| (vector(r), vector(v))),
            // A truth that says nothing of its sensors is taken to measure at each sample.
            measured: self.measured.is_empty() || self.measured.iter().any(|valid| x.get(*valid)),
        })
    }
}

/// Reads the parameters that a filter has calculated.
pub(crate) struct CalculatedReader {
    names: Vec<String>,
    sample: Sample,
    handles: Vec<Handle<f64>>,
}

impl CalculatedReader {
    pub(crate) fn new(system: &System, slave: SlaveId, filter: &Participant) -> Result<Self, StudyError> {
        let names = filter.calculated.clone();
        let mut probe = system.probe(slave)?;
        let handles = names.iter().map(|name| probe.real(name));
        let handles = handles.collect::<Result<_, _>>()?;
        Ok(Self {
            names,
            sample: probe.sample(),
            handles,
        })
    }

    /// By name; none of a filter that cannot be read.
    pub(crate) fn values(mut self, context: &mut StepContext<'_>) -> Vec<(String, f64)> {
        if context.read(&mut self.sample).is_err() {
            return Vec::new();
        }
        let values = self.handles.iter().map(|handle| self.sample.get(*handle));
        self.names.into_iter().zip(values).collect()
    }
}

/// Reads what the sensors have said at the newest sample.
pub(crate) struct MeasurementReader {
    sample: Sample,
    handles: Vec<Element>,
}

/// Where an element of a measurement stands.
enum Element {
    Number(Handle<f64>),
    Truth(Handle<bool>),
    /// A world of somebody else need not have every sensor.
    Absent,
}

impl MeasurementReader {
    /// * `names`: variables of the truth, Real or Boolean.
    pub(crate) fn new(system: &System, truth: SlaveId, names: &[String]) -> Result<Self, StudyError> {
        let mut probe = system.probe(truth)?;
        let mut element = |name: &String| match probe.boolean(name) {
            Ok(handle) => Element::Truth(handle),
            Err(_) => probe.real(name).map_or(Element::Absent, Element::Number),
        };
        let handles = names.iter().map(&mut element).collect();
        Ok(Self {
            sample: probe.sample(),
            handles,
        })
    }

    /// In the order of the names, a truth value as 0 or 1, NaN for what it does not have; `None` when the truth cannot be read.
    pub(crate) fn values(&mut self, context: &mut StepContext<'_>) -> Option<Vec<f64>> {
        context.read(&mut self.sample).ok()?;
        let value = |element: &Element| match element {
            Element::Number(handle) => self.sample.get(*handle),
            Element::Truth(handle) => f64::from(u8::from(self.sample.get(*handle))),
            Element::Absent => f64::NAN,
        };
        Some(self.handles.iter().map(value).collect())
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

/// A covariance of position, velocity and perhaps acceleration.
#[derive(Debug, Clone, Copy)]
enum Covariance {
    Six(Handle<[[f64; 6]; 6]>),
    Nine(Handle<[[f64; 9]; 9]>),
}

impl Covariance {
    /// Of the largest state it has room for.
    fn dimension(self) -> usize {
        match self {
            Self::Six(_) => 6,
            Self::Nine(_) => 9,
        }
    }

    /// Chooses `cov.p`, if the filter offers any.
    ///
    /// # Errors
    /// [`StudyError::Shape`] unless it is 6x6 or 9x9 Reals.
    fn choose(body: &mut Probe<'_>, ports: &[Port], label: &str) -> Result<Option<Self>, StudyError> {
        let elements = elements(ports, "cov.p");
        let found = match elements {
            0 => return Ok(None),
            36 => body.matrix("cov.p").ok().map(Self::Six),
            81 => body.matrix("cov.p").ok().map(Self::Nine),
            _ => None,
        };
        let refused = || {
            odd(
                label,
                "cov.p",
                elements,
                "6x6 or 9x9 Reals, 'cov.p[1,1]' to 'cov.p[6,6]' or 'cov.p[9,9]'",
            )
        };
        found.map(Some).ok_or_else(refused)
    }

    /// The matrix; beyond its own states it is zero.
    fn read(self, sample: &Sample) -> SMatrix<f64, 9, 9> {
        match self {
            Self::Six(handle) => {
                let mut p = SMatrix::<f64, 9, 9>::zeros();
                p.fixed_view_mut::<6, 6>(0, 0)
                    .copy_from(&SMatrix::<f64, 6, 6>::from(sample.get(handle)).transpose());
                p
            }
            Self::Nine(handle) => SMatrix::<f64, 9, 9>::from(sample.get(handle)).transpose(),
        }
    }
}

/// Number of variables `name` and `name[...]`.
fn elements(ports: &[Port], name: &str) -> usize {
    ports.iter().filter(|p| is_element(&p.name, name)).count()
}

fn odd(label: &str, name: &str, elements: usize, expected: &'static str) -> StudyError {
    StudyError::Shape {
        label: label.to_owned(),
        name: name.to_owned(),
        found: format!("{elements} variables"),
        expected,
    }
}

/// A vector that a filter may leave out, but not offer in part.
///
/// # Errors
/// [`StudyError::Shape`] unless it has three Reals or nothing.
fn vector_or_nothing(
    body: &mut Probe<'_>,
    ports: &[Port],
    label: &str,
    name: &str,
) -> Result<Option<VectorHandle>, StudyError> {
    match elements(ports, name) {
        0 => Ok(None),
        count => {
            let found = body.vec3(name).ok().filter(|_| count == 3);
            let expected = "three Reals with the indices [1] to [3]";
            found.map(Some).ok_or_else(|| odd(label, name, count, expected))
        }
    }
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
    covariance: Option<Covariance>,
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
        let ports = system.ports(slave);
        let label = &participant.label;
        let mut optional = |name: &str| vector_or_nothing(&mut body, ports, label, name);
        let acceleration = optional(signals.acceleration[1])?;
        let bias = match signals.bias {
            Some([_, name]) => optional(name)?,
            None => None,
        };
        let jerk_root = optional("q.s")?;
        let covariance = Covariance::choose(&mut body, ports, label)?;
        let names = [signals.position[1], signals.velocity[1], signals.acceleration[1]];
        check_vectors(system, slave, label, names)?;
        for i in 0..9 {
            for j in 0..9 {
                let ([m, s], [n, t]) = (UNITS[i / 3], UNITS[j / 3]);
                let element = format!("cov.p[{},{}]", i + 1, j + 1);
                check_unit(system, slave, label, &element, [m + n, s + t])?;
            }
        }
        Ok(Self {
            count: head.integer("est.count").ok(),
            time: head.real("est.time").ok(),
            dimension: head.integer("est.dimension").ok(),
            status: head.integer("status").ok(),
            statuses: participant.statuses.clone(),
            head: head.sample(),
            position,
            velocity,
            acceleration,
            acceleration_valid: body.boolean("est.acceleration_valid").ok(),
            bias,
            bias_sigma: signals.bias_sigma.and_then(|names| body.reals(&names).ok()),
            covariance,
            residual,
            residual_variance,
            nis: body.real("nis").ok(),
            nis_rows: body.integer("nis.rows").ok(),
            jerk_root,
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
        let room = self.covariance.map_or(9, Covariance::dimension);
        let dimension = tag
            .dimension
            .map_or(offered, |d| usize::try_from(d).unwrap_or(0))
            .min(room);
        // Unless it says so itself, a filter of six states that shows an acceleration has none: it shows zeros.
        let estimates_acceleration = self
            .acceleration_valid
            .map_or(tag.dimension != Some(6), |valid| x.get(valid));
        Some(Estimate {
            position: vector(self.position),
            velocity: vector(self.velocity),
            acceleration: self.acceleration.map(vector).filter(|_| estimates_acceleration),
            bias: self.bias.map(vector),
            covariance: self
                .covariance
                .filter(|_| dimension > 0)
                .map(|covariance| covariance.read(x)),
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
