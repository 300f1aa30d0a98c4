//! The Earth as the LEO venting study models it: Mamich and Zanetti, Table 2.

use crate::ZonalGravity;

/// Gravitational parameter, m3/s2 (Table 2).
pub const MU: f64 = 3.986e14;

/// Equatorial radius, m (Table 2).
pub const RADIUS: f64 = 6.378e6;

/// Zonal coefficients J2 to J6 (Table 2).
pub const ZONALS: [f64; 5] = [1.083e-3, -2.532e-6, -1.620e-6, -2.278e-7, 5.407e-7];

/// Gravity of the simulated world: two-body and J2 to J6, Eq. (34).
pub const TRUTH: ZonalGravity = ZonalGravity {
    mu: MU,
    r_ref: RADIUS,
    j: ZONALS,
};

/// Gravity that the navigation filter believes in: two-body and J2 to J4, Eq. (34).
pub const FILTER: ZonalGravity = ZonalGravity {
    mu: MU,
    r_ref: RADIUS,
    j: [ZONALS[0], ZONALS[1], ZONALS[2], 0.0, 0.0],
};

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Over the pole P_n = 1, so the term of degree n is (n + 1) mu J_n R^n / r^(n + 2), outwards.
    #[test]
    fn truth_and_filter_differ_by_j5_and_j6_of_the_table() {
        let r: f64 = 7.0e6;
        let q: f64 = 6.378e6 / r;
        let term = |n: i32, j: f64| f64::from(n + 1) * 3.986e14 / (r * r) * j * q.powi(n);
        let place = Vector3::new(0.0, 0.0, r);
        let felt = FILTER.acceleration(&place);
        let common = term(2, 1.083e-3) + term(3, -2.532e-6) + term(4, -1.620e-6) - 3.986e14 / (r * r);
        let extra = term(5, -2.278e-7) + term(6, 5.407e-7);
        // Rounding of an acceleration of 8 m/s2; J5 is worth 7e-6 m/s2.
        assert!((felt.z - common).abs() < 1e-14, "{}", felt.z - common);
        let more = TRUTH.acceleration(&place).z - felt.z;
        assert!((more - extra).abs() < 1e-14, "{more} and {extra}");
    }
}
