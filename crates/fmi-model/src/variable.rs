//! One row of the table: a variable with its shape, whatever a standard makes of it.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use crate::bounds::Bounds;

/// What a variable is to the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set before the first step, then fixed.
    Parameter,
    /// Read by the host; follows from parameters at initialization, then fixed.
    CalculatedParameter,
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
            Self::CalculatedParameter => "calculatedParameter",
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

/// The elements of a row. Elements count from 0, those of a matrix row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One value.
    Scalar,
    /// So many values.
    Vector(usize),
    /// Rows and columns.
    Matrix(usize, usize),
}

impl Shape {
    /// Number of elements.
    pub fn count(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(n) => n,
            Self::Matrix(rows, columns) => rows * columns,
        }
    }

    /// What the structured naming convention of FMI calls an element of the row `name`: `name`, `name[i]` or `name[i,j]`,
    /// with indices from 1.
    pub fn element_name(self, name: &str, element: usize) -> Cow<'_, str> {
        match self {
            Self::Scalar => Cow::Borrowed(name),
            Self::Vector(_) => Cow::Owned(format!("{name}[{}]", element + 1)),
            Self::Matrix(_, columns) => {
                Cow::Owned(format!("{name}[{},{}]", element / columns + 1, element % columns + 1))
            }
        }
    }
}

/// An attribute of the elements of a row: one for all, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub enum Each<T> {
    /// All elements have this one.
    Same(T),
    /// Each element has its own, in order.
    Own(Vec<T>),
}

impl<T> Each<T> {
    /// The attribute of one element; `None` past the last.
    pub fn get(&self, element: usize) -> Option<&T> {
        match self {
            Self::Same(value) => Some(value),
            Self::Own(values) => values.get(element),
        }
    }
}

impl<T: PartialEq> Each<T> {
    /// The attribute that all elements share, for a standard in which an array has only one; `None` if they differ.
    pub fn shared(&self) -> Option<&T> {
        match self {
            Self::Same(value) => Some(value),
            Self::Own(values) => {
                let first = values.first()?;
                values.iter().all(|value| value == first).then_some(first)
            }
        }
    }
}

/// A row of the table: a scalar, vector or matrix.
#[derive(Debug)]
pub struct Variable<M> {
    /// Unique structured name without indices, e.g. `est.r_tc_n`.
    pub name: String,
    /// How many elements it has, and in which order.
    pub shape: Shape,
    /// Number of its first element, counted from 0 over the elements of all rows; see [`Table::entry`](crate::Table::entry).
    pub first: u32,
    /// One sentence, or empty.
    pub about: Each<String>,
    /// What it is to the host.
    pub causality: Causality,
    /// When it may change.
    pub variability: Variability,
    /// Inputs, without indices, that its value depends on at initialization.
    pub initial_inputs: Vec<&'static str>,
    /// Type and access.
    pub typed: Typed<M>,
}

impl<M> Variable<M> {
    /// Its elements, in order.
    pub fn entries(&self) -> impl Iterator<Item = Entry<'_, M>> {
        (0..self.shape.count()).map(|element| Entry { row: self, element })
    }
}

/// One element of a row: what a standard without arrays calls a variable.
#[derive(Debug)]
pub struct Entry<'t, M> {
    /// The row it belongs to.
    pub row: &'t Variable<M>,
    /// Its place in the row, from 0.
    pub element: usize,
}

// Derived, they would ask for the same of `M`.
impl<M> Clone for Entry<'_, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M> Copy for Entry<'_, M> {}

impl<'t, M> Entry<'t, M> {
    /// Unique structured name, e.g. `est.r_tc_n[1]`.
    pub fn name(self) -> Cow<'t, str> {
        self.row.shape.element_name(&self.row.name, self.element)
    }

    /// One sentence, or empty.
    pub fn about(self) -> &'t str {
        self.row.about.get(self.element).map_or("", String::as_str)
    }

    /// Unit of a Real, if it has one.
    pub fn unit(self) -> Option<&'t str> {
        match &self.row.typed {
            Typed::Real { unit, .. } => unit.as_ref()?.get(self.element).map(String::as_str),
            _ => None,
        }
    }

    /// Order of magnitude of a Real where it is not 1.
    pub fn nominal(self) -> Option<f64> {
        match &self.row.typed {
            Typed::Real { nominal, .. } => nominal
                .as_ref()?
                .get(self.element)
                .copied()
                .filter(|n| (n - 1.0).abs() > 0.0),
            _ => None,
        }
    }

    /// The value now; `None` if it is of another type than `T`.
    pub fn read<T: Scalar>(self, model: &M) -> Option<T> {
        T::access(&self.row.typed).map(|access| access.read(model, self.element))
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

/// Type of a row, with what only that type has.
#[derive(Debug)]
pub enum Typed<M> {
    /// A double: `fmi2Real`, `fmi3Float64`.
    Real {
        /// Reads and writes the model.
        access: Access<M, f64>,
        /// Spelling of the unit, if it has one.
        unit: Option<Each<String>>,
        /// Unit for people, e.g. `deg` for `rad`.
        display_unit: Option<&'static str>,
        /// Order of magnitude, for hosts that scale; 1 where none is said.
        nominal: Option<Each<f64>>,
        /// Values that may be set; they must be finite, too, unless [`Bounds::any_number`] says otherwise.
        bounds: Bounds<f64>,
    },
    /// A 32-bit integer: `fmi2Integer`, `fmi3Int32`.
    Integer {
        /// Reads and writes the model.
        access: Access<M, i32>,
        /// Values that may be set.
        bounds: Bounds<i32>,
    },
    /// An enumeration, read and written as its number, counted from 1.
    Enumeration {
        /// Reads and writes the model.
        access: Access<M, i32>,
        /// Declared type.
        declared: Arc<EnumerationType>,
    },
    /// A truth value.
    Boolean {
        /// Reads and writes the model.
        access: Access<M, bool>,
    },
    /// A text.
    String {
        /// Reads and writes the model.
        access: Access<M, String>,
    },
}

impl<M> Typed<M> {
    /// The name of the type in messages.
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
    pub(crate) fn any(&self) -> &dyn AnyAccess<M> {
        match self {
            Self::Real { access, .. } => access,
            Self::Integer { access, .. } | Self::Enumeration { access, .. } => access,
            Self::Boolean { access } => access,
            Self::String { access } => access,
        }
    }
}

pub(crate) type Read<M, T> = Box<dyn Fn(&M, usize) -> T + Send + Sync>;
pub(crate) type Write<M, T> = Box<dyn Fn(&mut M, usize, T) + Send + Sync>;

/// How the elements of a row are read from the model and written to it, by their place in the row from 0.
pub struct Access<M, T> {
    pub(crate) read: Read<M, T>,
    pub(crate) write: Option<Write<M, T>>,
    pub(crate) start: Option<Each<T>>,
}

impl<M, T> Access<M, T> {
    /// The value of an element now.
    pub fn read(&self, model: &M, element: usize) -> T {
        (self.read)(model, element)
    }

    /// Sets the value of an element, unchecked; does nothing for a row that is only read.
    pub fn write(&self, model: &mut M, element: usize, value: T) {
        if let Some(write) = &self.write {
            write(model, element, value);
        }
    }

    /// The start value of an element.
    pub fn start(&self, element: usize) -> Option<&T> {
        self.start.as_ref()?.get(element)
    }
}

/// The part of [`Access`] that does not depend on the type of the value.
pub(crate) trait AnyAccess<M> {
    /// Whether a start value is declared.
    fn has_start(&self) -> bool;
    /// Whether the row can write the model.
    fn writable(&self) -> bool;
    /// Sets the start value of an element, if there is one.
    fn apply_start(&self, model: &mut M, element: usize);
    /// The start value of an element and what the model reads instead, if they differ.
    fn start_mismatch(&self, model: &M, element: usize) -> Option<(String, String)>;
}

impl<M, T: Scalar> AnyAccess<M> for Access<M, T> {
    fn has_start(&self) -> bool {
        self.start.is_some()
    }

    fn writable(&self) -> bool {
        self.write.is_some()
    }

    fn apply_start(&self, model: &mut M, element: usize) {
        if let Some(start) = self.start(element) {
            self.write(model, element, start.clone());
        }
    }

    fn start_mismatch(&self, model: &M, element: usize) -> Option<(String, String)> {
        let start = self.start(element)?;
        let read = self.read(model, element);
        (read != *start).then(|| (format!("{start:?}"), format!("{read:?}")))
    }
}

impl<M, T: fmt::Debug> fmt::Debug for Access<M, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Access")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_named_row_by_row() {
        let names = |shape: Shape| -> Vec<String> {
            let elements = 0..shape.count();
            elements.map(|k| shape.element_name("a.b", k).into_owned()).collect()
        };
        assert_eq!(names(Shape::Scalar), ["a.b"]);
        assert_eq!(names(Shape::Vector(2)), ["a.b[1]", "a.b[2]"]);
        assert_eq!(
            names(Shape::Matrix(2, 3)),
            ["a.b[1,1]", "a.b[1,2]", "a.b[1,3]", "a.b[2,1]", "a.b[2,2]", "a.b[2,3]"]
        );
    }

    #[test]
    fn an_attribute_is_shared_if_all_elements_have_the_same() {
        assert_eq!(Each::Same("m").shared(), Some(&"m"));
        assert_eq!(Each::Own(vec!["m", "m"]).shared(), Some(&"m"));
        assert_eq!(Each::Own(vec!["m", "m/s"]).shared(), None);
        assert_eq!(Each::Own(vec!["m", "m/s"]).get(1), Some(&"m/s"));
        assert_eq!(Each::Own(vec!["m", "m/s"]).get(2), None);
    }
}
