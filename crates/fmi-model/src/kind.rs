//! The kinds of rows, one for each type, and the attributes that only they have.

use std::sync::Arc;

use crate::bounds::Bounds;
use crate::variable::{Access, Each, EnumerationType, Scalar, Shape, Typed};

/// What a row needs beyond a name, by type.
pub trait Kind {
    /// The type of its values in Rust.
    type Value: Scalar;

    /// The typed part of a row.
    fn typed<M>(self, shape: Shape, access: Access<M, Self::Value>) -> Typed<M>;

    /// Whether values may change between communication points unless the row says otherwise.
    const CONTINUOUS: bool = false;

    /// Start value of an input that states none.
    fn neutral(&self) -> Self::Value;
}

/// An attribute of a row whose shape is not known yet.
pub(crate) enum ByElement<T> {
    /// All elements have this one.
    Same(T),
    /// The attribute of each element, by its row-major index from 0.
    By(Box<dyn Fn(usize) -> T>),
}

impl<T> ByElement<T> {
    /// The attributes of a row of this shape.
    pub(crate) fn over(self, shape: Shape) -> Each<T> {
        match self {
            Self::Same(value) => Each::Same(value),
            Self::By(attribute) => Each::Own((0..shape.count()).map(attribute).collect()),
        }
    }
}

/// Attributes of a Real row.
#[derive(Default)]
pub struct Real {
    pub(crate) unit: Option<ByElement<String>>,
    pub(crate) display_unit: Option<&'static str>,
    pub(crate) nominal: Option<ByElement<f64>>,
    pub(crate) bounds: Bounds<f64>,
}

impl Kind for Real {
    type Value = f64;
    const CONTINUOUS: bool = true;

    fn typed<M>(self, shape: Shape, access: Access<M, f64>) -> Typed<M> {
        Typed::Real {
            access,
            unit: self.unit.map(|unit| unit.over(shape)),
            display_unit: self.display_unit,
            nominal: self.nominal.map(|nominal| nominal.over(shape)),
            bounds: self.bounds,
        }
    }

    fn neutral(&self) -> f64 {
        0.0
    }
}

/// Attributes of an Integer row.
#[derive(Default)]
pub struct Integer {
    pub(crate) bounds: Bounds<i32>,
}

impl Kind for Integer {
    type Value = i32;

    fn typed<M>(self, _shape: Shape, access: Access<M, i32>) -> Typed<M> {
        Typed::Integer {
            access,
            bounds: self.bounds,
        }
    }

    fn neutral(&self) -> i32 {
        0
    }
}

/// Attributes of an enumeration row.
pub struct Enumeration {
    pub(crate) declared: Arc<EnumerationType>,
}

impl Kind for Enumeration {
    type Value = i32;

    fn typed<M>(self, _shape: Shape, access: Access<M, i32>) -> Typed<M> {
        Typed::Enumeration {
            access,
            declared: self.declared,
        }
    }

    fn neutral(&self) -> i32 {
        1
    }
}

/// A Boolean row has no further attributes.
pub struct Boolean;

impl Kind for Boolean {
    type Value = bool;

    fn typed<M>(self, _shape: Shape, access: Access<M, bool>) -> Typed<M> {
        Typed::Boolean { access }
    }

    fn neutral(&self) -> bool {
        false
    }
}

/// A String row has no further attributes.
pub struct Text;

impl Kind for Text {
    type Value = String;

    fn typed<M>(self, _shape: Shape, access: Access<M, String>) -> Typed<M> {
        Typed::String { access }
    }

    fn neutral(&self) -> String {
        String::new()
    }
}
