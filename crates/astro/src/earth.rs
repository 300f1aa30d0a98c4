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
