//! The field of view of a sensor that looks along its boresight.

use nalgebra::Vector3;
use numerics::math;
use serde::{Deserialize, Serialize};

/// A square field of view in front of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// Tangent of half of its width.
    reach: f64,
}

impl View {
    /// * `width`: full width in azimuth and in elevation, rad, within (0, pi).
    pub fn of_width(width: f64) -> Self {
        Self {
            reach: math::tan(0.5 * width),
        }
    }

    /// Whether a target lies in it.
    ///
    /// * `rho_l`: target relative to the sensor, axes L (z_L along the boresight), m.
    /// * returns: false for a target in the sensor itself, behind it, or not finite.
    pub fn holds(&self, rho_l: &Vector3<f64>) -> bool {
        let reach = rho_l.z * self.reach;
        rho_l.z > 0.0 && rho_l.x.abs() <= reach && rho_l.y.abs() <= reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_is_a_square_in_front() {
        for half_deg in [0.5_f64, 2.5, 45.0, 80.0] {
            let view = View::of_width(2.0 * half_deg.to_radians());
            let at = |x: f64, y: f64, z: f64| {
                let slope = |part: f64| (part * half_deg).to_radians().tan();
                view.holds(&(Vector3::new(slope(x), slope(y), 1.0) * z))
            };
            assert!(at(0.0, 0.0, 10.0) && at(0.99, -0.99, 10.0), "{half_deg}");
            assert!(!at(1.01, 0.0, 10.0) && !at(0.0, -1.01, 10.0), "{half_deg}");
            assert!(!at(0.0, 0.0, -10.0), "behind the sensor");
            assert!(!view.holds(&Vector3::zeros()) && !view.holds(&Vector3::repeat(f64::NAN)));
        }
    }
}
