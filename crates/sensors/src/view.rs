//! The field of view of a sensor that looks along its boresight.

use nalgebra::Vector3;

/// Whether a target lies in a square field of view in front of a sensor.
///
/// * `rho_l`: target relative to the sensor, axes L (z_L along the boresight), m.
/// * `half`: half of the full width in azimuth and in elevation, rad, within (0, pi/2).
/// * returns: false for a target in the sensor itself, behind it, or not finite.
pub fn in_view(rho_l: &Vector3<f64>, half: f64) -> bool {
    let reach = rho_l.z * half.tan();
    rho_l.z > 0.0 && rho_l.x.abs() <= reach && rho_l.y.abs() <= reach
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_is_a_square_in_front() {
        for half_deg in [0.5_f64, 2.5, 45.0, 80.0] {
            let at = |x: f64, y: f64, z: f64| {
                let place = Vector3::new(
                    (x * half_deg).to_radians().tan(),
                    (y * half_deg).to_radians().tan(),
                    1.0,
                );
                in_view(&(place * z), half_deg.to_radians())
            };
            assert!(at(0.0, 0.0, 10.0) && at(0.99, -0.99, 10.0), "{half_deg}");
            assert!(!at(1.01, 0.0, 10.0) && !at(0.0, -1.01, 10.0), "{half_deg}");
            assert!(!at(0.0, 0.0, -10.0), "behind the sensor");
        }
        assert!(!in_view(&Vector3::zeros(), 1.0) && !in_view(&Vector3::repeat(f64::NAN), 1.0));
    }
}
