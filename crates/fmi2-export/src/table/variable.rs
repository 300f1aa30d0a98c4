//! One row of the table.

use std::fmt;
use std::sync::Arc;

use super::bounds::Bounds;

/// What a variable is to the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set before the first step, then fixed.
    Parameter,
    /// Set by the host between steps.
    Input,
    /// Read by the host, meant for connections and result files.
    Output,
    /// Read by the host, not offered for connections.
    Local,
}

impl Causality {
    /// The name in the XML.
    pub fn name(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Input => "input",
            Self::Output => "output",
            Self::Local => "local",
        }
    }

    /// Whether the host may ever set the variable.
    pub fn settable(self) -> bool {
        matches!(self, Self::Parameter | Self::Input)
    }
}

/// When a value may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variability {
    /// Not after initialization.
    Fixed,
    /// At communication points.
    Discrete,
    /// At any time (Real only).
    Continuous,
}

impl Variability {
    /// The name in the XML.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Discrete => "discrete",
            Self::Continuous => "continuous",
        }
    }
}

/// A row of the table; its value reference is its index.
#[derive(Debug)]
pub struct Variable<M> {
    /// Unique structured name, e.g. `est.r_tc_n[1]`.
    pub name: String,
    /// One sentence, or empty.
    pub about: String,
    /// What it is to the host.
    pub causality: Causality,
    /// When it may change.
    pub variability: Variability,
    /// Inputs, without indices, that its value depends on at initialization.
    pub initial_inputs: Vec<&'static str>,
    /// FMI type and access.
    pub typed: Typed<M>,
}

impl<M> Variable<M> {
    /// Its name without indices: that of the scalar, vector or matrix it belongs to.
    pub(crate) fn base_name(&self) -> &str {
        self.name.split('[').next().unwrap_or_default()
    }
}

/// A declared enumeration. Items count from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EnumerationType {
    /// Name of the type.
    pub name: String,
    /// One sentence, or empty.
    pub about: String,
    /// Items in order.
    pub items: Vec<EnumerationItem>,
}

impl EnumerationType {
    /// The item with this value.
    pub fn item(&self, value: i32) -> Option<&EnumerationItem> {
        let index = usize::try_from(value).ok()?.checked_sub(1)?;
        self.items.get(index)
    }
}

/// One item of an enumeration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EnumerationItem {
    /// Name, unique in its type.
    pub name: String,
    /// One sentence, or empty.
    pub about: String,
}

/// FMI type of a variable, with what only that type has.
#[derive(Debug)]
pub enum Typed<M> {
    /// `fmi2Real`.
    Real {
        /// Reads and writes the model.
        access: Access<M, f64>,
        /// Spelling of the unit, if it has one.
        unit: Option<String>,
        /// Unit for people, e.g. `deg` for `rad`.
        display_unit: Option<&'static str>,
        /// Values that may be set; they must be finite, too.
        bounds: Bounds<f64>,
    },
    /// `fmi2Integer`.
    Integer {
        /// Reads and writes the model.
        access: Access<M, i32>,
        /// Values that may be set.
        bounds: Bounds<i32>,
    },
    /// An enumeration, which travels as `fmi2Integer`, counted from 1.
    Enumeration {
        /// Reads and writes the model.
        access: Access<M, i32>,
        /// Declared type.
        declared: Arc<EnumerationType>,
    },
    /// `fmi2Boolean`.
    Boolean {
        /// Reads and writes the model.
        access: Access<M, bool>,
    },
    /// `fmi2String`.
    String {
        /// Reads and writes the model.
        access: Access<M, String>,
    },
}

impl<M> Typed<M> {
    /// The element in the XML.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Real { .. } => "Real",
            Self::Integer { .. } => "Integer",
            Self::Enumeration { .. } => "Enumeration",
            Self::Boolean { .. } => "Boolean",
            Self::String { .. } => "String",
        }
    }

    /// What every row can do, whatever its type.
    pub(crate) fn row(&self) -> &dyn AnyAccess<M> {
        match self {
            Self::Real { access, .. } => access,
            Self::Integer { access, .. } | Self::Enumeration { access, .. } => access,
            Self::Boolean { access } => access,
            Self::String { access } => access,
        }
    }
}

pub(crate) type Read<M, T> = Arc<dyn Fn(&M, usize) -> T + Send + Sync>;
pub(crate) type Write<M, T> = Arc<dyn Fn(&mut M, usize, T) + Send + Sync>;

/// How a row reads and writes the model. The elements of a vector share their closures and differ in the index.
pub struct Access<M, T> {
    pub(crate) element: usize,
    pub(crate) read: Read<M, T>,
    pub(crate) write: Option<Write<M, T>>,
    pub(crate) start: Option<T>,
}

impl<M, T: Clone> Access<M, T> {
    /// The value now.
    pub fn read(&self, model: &M) -> T {
        (self.read)(model, self.element)
    }

    /// Sets the value, unchecked; does nothing for a variable that is only read.
    pub fn write(&self, model: &mut M, value: T) {
        if let Some(write) = &self.write {
            write(model, self.element, value);
        }
    }

    /// The start value.
    pub fn start(&self) -> Option<&T> {
        self.start.as_ref()
    }
}

/// The part of [`Access`] that does not depend on the type of the value.
pub(crate) trait AnyAccess<M> {
    /// Whether a start value is declared.
    fn has_start(&self) -> bool;
    /// Whether the row can write the model.
    fn writable(&self) -> bool;
    /// Sets the start value, if there is one.
    fn apply_start(&self, model: &mut M);
    /// The start value and what the model reads instead, if they differ.
    fn start_mismatch(&self, model: &M) -> Option<(String, String)>;
}

impl<M, T: Scalar> AnyAccess<M> for Access<M, T> {
    fn has_start(&self) -> bool {
        self.start.is_some()
    }

    fn writable(&self) -> bool {
        self.write.is_some()
    }

    fn apply_start(&self, model: &mut M) {
        if let Some(start) = &self.start {
            self.write(model, start.clone());
        }
    }

    fn start_mismatch(&self, model: &M) -> Option<(String, String)> {
        let start = self.start.as_ref()?;
        let read = self.read(model);
        (read != *start).then(|| (format!("{start:?}"), format!("{read:?}")))
    }
}

impl<M, T: fmt::Debug> fmt::Debug for Access<M, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Access")
            .field("element", &self.element)
            .field("start", &self.start)
            .field("writable", &self.write.is_some())
            .finish_non_exhaustive()
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for i32 {}
    impl Sealed for bool {}
    impl Sealed for String {}
}

/// A Rust type that values cross the boundary as: `f64`, `i32` (integers and enumerations), `bool`, `String`.
pub trait Scalar: Clone + PartialEq + fmt::Debug + Send + Sync + 'static + sealed::Sealed {
    /// Access to a row of this type; `None` if the row is of another type.
    fn access<M>(typed: &Typed<M>) -> Option<&Access<M, Self>>;
}

impl Scalar for f64 {
    fn access<M>(typed: &Typed<M>) -> Option<&Access<M, Self>> {
        match typed {
            Typed::Real { access, .. } => Some(access),
            _ => None,
        }
    }
}

impl Scalar for i32 {
    fn access<M>(typed: &Typed<M>) -> Option<&Access<M, Self>> {
        match typed {
            Typed::Integer { access, .. } | Typed::Enumeration { access, .. } => Some(access),
            _ => None,
        }
    }
}

impl Scalar for bool {
    fn access<M>(typed: &Typed<M>) -> Option<&Access<M, Self>> {
        match typed {
            Typed::Boolean { access } => Some(access),
            _ => None,
        }
    }
}

impl Scalar for String {
    fn access<M>(typed: &Typed<M>) -> Option<&Access<M, Self>> {
        match typed {
            Typed::String { access } => Some(access),
            _ => None,
        }
    }
}
