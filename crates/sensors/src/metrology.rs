//! Relative metrology: the whole state of a chaser relative to its target, position and velocity at once.
//!
//! The measured state is `rho`, `rho_dot` in the turning axes of the target's orbit (`astro::relative`). For a filter whose
//! state that is, h(x) = x and the Jacobian is the identity; one whose state stands in inertial axes has to turn it there, with
//! the axes of the target's orbit as it estimates that.

use crate::of_target::{ByState, OfTarget, Rows, Scene};
use nalgebra::{Vector3, Vector6};

/// The metrology among the sensors of the target.
pub struct Metrology;

impl OfTarget for Metrology {
    fn measure(&self, scene: &Scene) -> Rows {
        scene.lvlh.fixed_resize(0.0)
    }

    fn jacobian(&self, _scene: &Scene) -> ByState {
        ByState::identity()
    }

    fn in_lvlh(&self) -> bool {
        true
    }
}

/// What metrology measures.
///
/// * `rho`, `rho_dot`: chaser minus target, LVLH, m and m/s.
/// * returns: both, in this order.
///
/// Source: Pesce, Silvestrini and Lavagna, Eq. (20) with h(x) = x and the noise outside of h.
pub fn measure(rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(rho.x, rho.y, rho.z, rho_dot.x, rho_dot.y, rho_dot.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_position_then_velocity() {
        let z = measure(&Vector3::new(1.0, 2.0, 3.0), &Vector3::new(4.0, 5.0, 6.0));
        assert!((z - Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)).amax() < f64::MIN_POSITIVE);
    }
}
