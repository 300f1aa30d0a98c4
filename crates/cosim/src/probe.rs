//! Variables to be read together while a system runs.

use std::fmt;
use std::marker::PhantomData;

use fmi2_import::BaseType;

use crate::exchange::Bundle;
use crate::units::{Conversion, to_si};
use crate::{CosimError, SlaveId, System};

/// Chooses variables of one slave; made by [`System::probe`].
///
/// Each choice answers with a [`Handle`] that knows its type, so that nobody counts positions:
///
/// ```
/// # use cosim::{CosimError, Sample, SlaveId, StepContext, System};
/// # fn choose(system: &System, filter: SlaveId) -> Result<(), CosimError> {
/// let mut probe = system.probe(filter)?;
/// let position = probe.vec3("est.r_tc_n")?;
/// let count = probe.integer("est.count").ok(); // not every filter offers it
/// let mut sample = probe.sample();
/// let mut each = |context: &mut StepContext<'_>| -> Result<([f64; 3], Option<i32>), CosimError> {
///     context.read(&mut sample)?;
///     Ok((sample.get(position), count.map(|handle| sample.get(handle))))
/// };
/// # let _ = &mut each;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Probe<'a> {
    system: &'a System,
    slave: SlaveId,
    bundle: Bundle,
    conversions: Vec<(usize, Conversion)>,
}

/// Room for the values of the variables that a [`Probe`] has chosen, filled by [`crate::StepContext::read`] with one call
/// per type. Before the first reading they are 0, false or empty.
#[derive(Debug, Clone)]
pub struct Sample {
    pub(crate) slave: SlaveId,
    pub(crate) bundle: Bundle,
    /// Places among the Reals whose values are not in SI units.
    conversions: Vec<(usize, Conversion)>,
}

/// What was chosen, by its type: `f64`, `i32`, `bool`, `String`, `[f64; N]` or `[[f64; C]; R]`.
///
/// It belongs to the samples of the probe that gave it; with others it finds another variable, or 0, false or nothing.
pub struct Handle<T> {
    at: usize,
    of: PhantomData<fn() -> T>,
}

// Derived, they would ask the same of `T`.
impl<T> Clone for Handle<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Handle<T> {}

impl<T> fmt::Debug for Handle<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Handle({})", self.at)
    }
}

impl System {
    /// Begins to choose variables of a slave that are to be read together.
    ///
    /// # Errors
    /// [`CosimError::UnknownSlave`].
    pub fn probe(&self, slave: SlaveId) -> Result<Probe<'_>, CosimError> {
        self.known(slave)?;
        Ok(Probe {
            system: self,
            slave,
            bundle: Bundle::default(),
            conversions: Vec::new(),
        })
    }
}

impl Probe<'_> {
    /// A Real.
    ///
    /// # Errors
    /// [`CosimError::UnknownVariable`], [`CosimError::WrongType`]; as for all choices, nothing is chosen then.
    pub fn real(&mut self, name: &str) -> Result<Handle<f64>, CosimError> {
        self.choose(&[BaseType::Real], &[name])
    }

    /// An Integer or Enumeration.
    ///
    /// # Errors
    /// As for [`Probe::real`].
    pub fn integer(&mut self, name: &str) -> Result<Handle<i32>, CosimError> {
        self.choose(&[BaseType::Integer, BaseType::Enumeration], &[name])
    }

    /// A Boolean.
    ///
    /// # Errors
    /// As for [`Probe::real`].
    pub fn boolean(&mut self, name: &str) -> Result<Handle<bool>, CosimError> {
        self.choose(&[BaseType::Boolean], &[name])
    }

    /// A String.
    ///
    /// # Errors
    /// As for [`Probe::real`].
    pub fn string(&mut self, name: &str) -> Result<Handle<String>, CosimError> {
        self.choose(&[BaseType::String], &[name])
    }

    /// The Reals of these names, in this order.
    ///
    /// # Errors
    /// As for [`Probe::real`], for the first name that will not do.
    pub fn reals<const N: usize>(&mut self, names: &[&str; N]) -> Result<Handle<[f64; N]>, CosimError> {
        self.choose(&[BaseType::Real], names)
    }

    /// The Real vector with the elements `name[1]` to `name[3]`.
    ///
    /// # Errors
    /// As for [`Probe::reals`].
    pub fn vec3(&mut self, name: &str) -> Result<Handle<[f64; 3]>, CosimError> {
        let names: Vec<String> = (1..=3).map(|i| format!("{name}[{i}]")).collect();
        self.choose(&[BaseType::Real], &names)
    }

    /// The Real matrix with the elements `name[1,1]` to `name[R,C]`, row by row.
    ///
    /// # Errors
    /// As for [`Probe::reals`].
    pub fn matrix<const R: usize, const C: usize>(&mut self, name: &str) -> Result<Handle<[[f64; C]; R]>, CosimError> {
        let names: Vec<String> = (1..=R)
            .flat_map(|i| (1..=C).map(move |j| format!("{name}[{i},{j}]")))
            .collect();
        self.choose(&[BaseType::Real], &names)
    }

    /// The choice is made: room for the values.
    #[must_use]
    pub fn sample(self) -> Sample {
        Sample {
            slave: self.slave,
            bundle: self.bundle,
            conversions: self.conversions,
        }
    }

    /// Takes variables that are stored side by side, all of them or none.
    fn choose<T>(&mut self, kinds: &[BaseType], names: &[impl AsRef<str>]) -> Result<Handle<T>, CosimError> {
        let mut ports = Vec::with_capacity(names.len());
        for name in names {
            let port = self.system.known_port(self.slave, name.as_ref())?;
            if !kinds.contains(&port.kind) {
                return Err(CosimError::WrongType {
                    slave: self.system.name(self.slave).to_owned(),
                    variable: name.as_ref().to_owned(),
                    found: port.kind,
                    expected: kinds[0],
                });
            }
            ports.push(port);
        }
        let mut first = None;
        for port in ports {
            let place = self.bundle.push(port.kind, port.reference);
            first.get_or_insert(place);
            self.conversions
                .extend(to_si(port).map(|conversion| (place, conversion)));
        }
        Ok(Handle {
            at: first.unwrap_or_default(),
            of: PhantomData,
        })
    }
}

impl Sample {
    /// Turns the Reals just read into SI units.
    pub(crate) fn convert(&mut self) {
        for (place, conversion) in &self.conversions {
            conversion.apply(&mut self.bundle.reals.values[*place]);
        }
    }

    /// The slave it is read from.
    #[must_use]
    pub fn slave(&self) -> SlaveId {
        self.slave
    }

    /// The value as last read; Reals are in SI units where their variables say in which unit they are, else as they come.
    #[must_use]
    pub fn get<T: Readable>(&self, handle: Handle<T>) -> T {
        T::read(Values(&self.bundle), handle.at)
    }
}

/// What a [`Sample`] holds, for [`Readable`].
#[derive(Debug, Clone, Copy)]
pub struct Values<'a>(&'a Bundle);

/// A type that can be read from a [`Sample`]. Implemented here for all there are.
pub trait Readable {
    /// The value that begins at this place among those of its base type.
    fn read(values: Values<'_>, at: usize) -> Self;
}

impl Readable for f64 {
    fn read(values: Values<'_>, at: usize) -> Self {
        values.0.reals.values.get(at).copied().unwrap_or_default()
    }
}

impl Readable for i32 {
    fn read(values: Values<'_>, at: usize) -> Self {
        values.0.integers.values.get(at).copied().unwrap_or_default()
    }
}

impl Readable for bool {
    fn read(values: Values<'_>, at: usize) -> Self {
        values.0.booleans.values.get(at).copied().unwrap_or_default()
    }
}

impl Readable for String {
    fn read(values: Values<'_>, at: usize) -> Self {
        values.0.strings.values.get(at).cloned().unwrap_or_default()
    }
}

impl<const N: usize> Readable for [f64; N] {
    fn read(values: Values<'_>, at: usize) -> Self {
        std::array::from_fn(|i| f64::read(values, at + i))
    }
}

impl<const R: usize, const C: usize> Readable for [[f64; C]; R] {
    fn read(values: Values<'_>, at: usize) -> Self {
        std::array::from_fn(|i| Readable::read(values, at + i * C))
    }
}
