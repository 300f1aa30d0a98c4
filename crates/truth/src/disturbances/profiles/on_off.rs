//! The same from begin to end.

use serde::{Deserialize, Serialize};

use super::Shape;

/// Constant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OnOff;

impl Shape for OnOff {
    fn impulse(&self, t: f64, _duration: f64) -> f64 {
        t
    }
}
