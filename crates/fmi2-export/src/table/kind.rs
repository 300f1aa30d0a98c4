//! The kinds of rows, one for each FMI type, and the attributes that only they have.

use std::sync::Arc;

use super::bounds::Bounds;
use super::variable::{Access, EnumerationType, Scalar, Typed};

/// What a row needs beyond a name, by FMI type.
pub trait Kind {
    /// The type of its values in Rust.
    type Value: Scalar;

    /// The typed part of element `element`, in row-major order from 0.
    fn typed<M>(&self, element: usize, access: Access<M, Self::Value>) -> Typed<M>;

    /// Whether values may change between communication points unless the row says otherwise.
    const CONTINUOUS: bool = false;

    /// Start value of an input that states none.
    fn neutral(&self) -> Self::Value;
}

/// An attribute of each element, by its row-major index from 0.
pub(super) type ByElement<T> = Box<dyn Fn(usize) -> T>;

/// Attributes of a Real row.
#[derive(Default)]
pub struct Real {
    pub(super) unit: Option<ByElement<String>>,
    pub(super) display_unit: Option<&'static str>,
    pub(super) bounds: Bounds<f64>,
}

impl Kind for Real {
    type Value = f64;
    const CONTINUOUS: bool = true;

    fn typed<M>(&self, element: usize, access: Access<M, f64>) -> Typed<M> {
        Typed::Real {
            access,
            unit: self.unit.as_ref().map(|unit| unit(element)),
            display_unit: self.display_unit,
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
    pub(super) bounds: Bounds<i32>,
}

impl Kind for Integer {
    type Value = i32;

    fn typed<M>(&self, _element: usize, access: Access<M, i32>) -> Typed<M> {
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
    pub(super) declared: Arc<EnumerationType>,
}

impl Kind for Enumeration {
    type Value = i32;

    fn typed<M>(&self, _element: usize, access: Access<M, i32>) -> Typed<M> {
        Typed::Enumeration {
            access,
            declared: Arc::clone(&self.declared),
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

    fn typed<M>(&self, _element: usize, access: Access<M, bool>) -> Typed<M> {
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

    fn typed<M>(&self, _element: usize, access: Access<M, String>) -> Typed<M> {
        Typed::String { access }
    }

    fn neutral(&self) -> String {
        String::new()
    }
}
