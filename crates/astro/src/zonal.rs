//! Gravity of a body of revolution: two-body attraction and zonal harmonics.

use nalgebra::{Matrix3, Vector3};
use numerics::lanes::{self, Lanes};
use serde::{Deserialize, Serialize};

use crate::AstroError;
use crate::error::{finite, positive};

/// Degree of the first entry of [`ZonalGravity::j`].
const FIRST_DEGREE: usize = 2;

/// Two-body gravity with zonal harmonics J2 to J6; the body's axis of symmetry is z.
///
/// U = mu/r (1 - sum over n of J_n (R/r)^n P_n(z/r)). Coefficients that a model leaves out are zero.
/// Every function needs r != 0.
///
/// Source: Vallado, Fundamentals of Astrodynamics, the potential behind Mamich and Zanetti, Eq. (34). In Cartesian axes the
/// term of degree n is a_n = mu J_n/r^2 (R/r)^n (P'_{n+1}(u) r_hat - P'_n(u) z_hat), u = z/r, by the identity
/// (n + 1) P_n + u P'_n = P'_{n+1}.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ZonalGravity {
    /// Gravitational parameter, m3/s2.
    pub mu: f64,
    /// Reference radius R of the coefficients, m.
    pub r_ref: f64,
    /// J2, J3, J4, J5, J6, unnormalised.
    pub j: [f64; 5],
}

/// Sums over the degrees, each with the weight c_n = mu J_n R^n / r^(n+2).
struct Sums {
    /// c_n P'_{n+1} and c_n P'_n.
    d1: (f64, f64),
    /// (n + 2) c_n P'_{n+1}.
    degree_d1: f64,
    /// c_n P''_{n+1} and c_n P''_n.
    d2: (f64, f64),
}

impl ZonalGravity {
    /// Gravity of a body.
    ///
    /// * `mu`: gravitational parameter, m3/s2.
    /// * `r_ref`: reference radius of the coefficients, m.
    /// * `j`: J2, J3, ... unnormalised, as many as are known up to J6; empty for two-body gravity.
    ///
    /// # Errors
    /// When `mu` or `r_ref` is not positive, a coefficient not finite, or there are more than five.
    pub fn new(mu: f64, r_ref: f64, j: &[f64]) -> Result<Self, AstroError> {
        let mut all = [0.0; 5];
        if j.len() > all.len() {
            return Err(AstroError::Zonals {
                given: j.len(),
                allowed: all.len(),
            });
        }
        for (place, value) in all.iter_mut().zip(j) {
            *place = finite("zonal coefficient", *value, "(no unit)")?;
        }
        Ok(Self {
            mu: positive("gravitational parameter", mu, "m3/s2")?,
            r_ref: positive("reference radius", r_ref, "m")?,
            j: all,
        })
    }

    /// Potential per unit mass, positive towards the body (acceleration is its gradient).
    ///
    /// * `r`: position, body-centred, z along the axis of symmetry, m.
    /// * returns: m2/s2.
    pub fn potential(&self, r: &Vector3<f64>) -> f64 {
        let dist = r.norm();
        let u = r.z / dist;
        let q = self.r_ref / dist;
        let (mut p_low, mut p) = (1.0, u);
        let mut q_n = q;
        let mut sum = 1.0;
        for (i, j_n) in self.j.iter().enumerate() {
            let n = (i + FIRST_DEGREE) as f64;
            (p_low, p) = (p, ((2.0 * n - 1.0) * u * p - (n - 1.0) * p_low) / n);
            q_n *= q;
            sum -= j_n * q_n * p;
        }
        self.mu / dist * sum
    }

    /// Gravitational acceleration.
    ///
    /// * `r`: position, body-centred, z along the axis of symmetry, m.
    /// * returns: same axes, m/s2.
    #[inline]
    pub fn acceleration(&self, r: &Vector3<f64>) -> Vector3<f64> {
        self.in_lanes([r.x, r.y, r.z]).into()
    }

    /// [`ZonalGravity::acceleration`] at two places, to the bit.
    #[inline]
    pub fn accelerations(&self, r: [&Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        lanes::apart(self.in_lanes(lanes::beside(r)))
    }

    #[inline]
    fn in_lanes<T: Lanes>(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let of = T::all;
        let r2 = x * x + y * y + z * z;
        let inv = of(1.0) / r2.sqrt();
        let u = z * inv;
        let q = of(self.r_ref) * inv;
        let mut c = of(self.mu) / r2 * q;
        // P'_{n-1} and P'_n, starting at n = 2.
        let (mut low, mut mid) = (of(1.0), of(3.0) * u);
        let (mut radial, mut axial) = (of(0.0), of(0.0));
        for (i, j_n) in self.j.iter().enumerate() {
            let n = (i + FIRST_DEGREE) as f64;
            let high = (of(2.0 * n + 1.0) * u * mid - of(n + 1.0) * low) / of(n);
            c *= q;
            radial += c * of(*j_n) * high;
            axial -= c * of(*j_n) * mid;
            (low, mid) = (mid, high);
        }
        let along = (radial - of(self.mu) / r2) * inv;
        [x * along, y * along, z * along + axial]
    }

    /// Gravity gradient, the derivative of [`ZonalGravity::acceleration`] by position.
    ///
    /// * `r`: position, body-centred, z along the axis of symmetry, m.
    /// * returns: 3x3, same axes, 1/s2, symmetric and free of trace.
    pub fn gradient(&self, r: &Vector3<f64>) -> Matrix3<f64> {
        let dist = r.norm();
        let e = r / dist;
        let u = e.z;
        let s = self.sums(dist, u);
        // a = radial e + axial z_hat; what follows are the derivatives of both by distance and by u.
        let radial = s.d1.0 - self.mu / (dist * dist);
        let radial_by_r = (2.0 * self.mu / (dist * dist) - s.degree_d1) / dist;
        let by_ee = radial_by_r - (radial + u * s.d2.0) / dist;
        let by_ez = s.d2.0 / dist;
        let by_zz = -s.d2.1 / dist;
        let mut g = e * e.transpose() * by_ee;
        for i in 0..3 {
            g[(i, i)] += radial / dist;
            g[(i, 2)] += by_ez * e[i];
            g[(2, i)] += by_ez * e[i];
        }
        g[(2, 2)] += by_zz;
        g
    }

    fn sums(&self, dist: f64, u: f64) -> Sums {
        let q = self.r_ref / dist;
        let mut c = self.mu / (dist * dist) * q;
        let (mut low, mut mid) = (1.0, 3.0 * u);
        let (mut low2, mut mid2) = (0.0, 3.0);
        let mut s = Sums {
            d1: (0.0, 0.0),
            degree_d1: 0.0,
            d2: (0.0, 0.0),
        };
        for (i, j_n) in self.j.iter().enumerate() {
            let n = (i + FIRST_DEGREE) as f64;
            let high = ((2.0 * n + 1.0) * u * mid - (n + 1.0) * low) / n;
            let high2 = low2 + (2.0 * n + 1.0) * mid;
            c *= q;
            let w = c * j_n;
            s.d1.0 += w * high;
            s.d1.1 += w * mid;
            s.degree_d1 += (n + 2.0) * w * high;
            s.d2.0 += w * high2;
            s.d2.1 += w * mid2;
            (low, mid) = (mid, high);
            (low2, mid2) = (mid2, high2);
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth;

    const POSITIONS: [[f64; 3]; 4] = [
        [5.1e6, -3.3e6, 3.1e6],
        [-6.878e6, 0.0, 0.0],
        [1.0e6, 2.0e6, -6.6e6],
        [0.0, 0.0, 7.0e6],
    ];

    /// Models with one exaggerated coefficient each, so that no term hides behind another.
    fn models() -> Vec<ZonalGravity> {
        let single = |i: usize| {
            let mut j = [0.0; 5];
            j[i] = 0.3;
            ZonalGravity { j, ..earth::TRUTH }
        };
        (0..5).map(single).chain([earth::TRUTH, earth::FILTER]).collect()
    }

    /// Central difference of order four.
    fn difference<T>(f: impl Fn(f64) -> T, h: f64) -> T
    where
        T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        (f(h) - f(-h)) * (2.0 / (3.0 * h)) - (f(2.0 * h) - f(-2.0 * h)) * (1.0 / (12.0 * h))
    }

    #[test]
    fn potential_uses_the_legendre_polynomials() {
        let r = Vector3::<f64>::new(5.1e6, -3.3e6, 3.1e6);
        let u = r.z / r.norm();
        let closed: [f64; 5] = [
            (3.0 * u.powi(2) - 1.0) / 2.0,
            (5.0 * u.powi(3) - 3.0 * u) / 2.0,
            (35.0 * u.powi(4) - 30.0 * u.powi(2) + 3.0) / 8.0,
            (63.0 * u.powi(5) - 70.0 * u.powi(3) + 15.0 * u) / 8.0,
            (231.0 * u.powi(6) - 315.0 * u.powi(4) + 105.0 * u.powi(2) - 5.0) / 16.0,
        ];
        for (n, (model, p)) in (2_i32..).zip(models().iter().zip(closed)) {
            let expected = model.mu / r.norm() * (1.0 - 0.3 * (model.r_ref / r.norm()).powi(n) * p);
            assert!((model.potential(&r) / expected - 1.0).abs() < 1e-14, "degree {n}");
        }
    }

    #[test]
    fn acceleration_is_the_gradient_of_the_potential() {
        for model in models() {
            for r in POSITIONS.map(Vector3::from) {
                let a = model.acceleration(&r);
                for i in 0..3 {
                    let along = |d: f64| {
                        let mut moved = r;
                        moved[i] += d;
                        model.potential(&moved)
                    };
                    // Rounding of the potential, 1e-8 m2/s2, over a step of 2 km.
                    let slope = difference(along, 2e3);
                    assert!((a[i] - slope).abs() < 3e-11, "{model:?} at {r}: {} and {slope}", a[i]);
                }
            }
        }
    }

    #[test]
    fn gradient_is_the_derivative_of_the_acceleration() {
        for model in models() {
            for r in POSITIONS.map(Vector3::from) {
                let g = model.gradient(&r);
                for i in 0..3 {
                    let along = |d: f64| {
                        let mut moved = r;
                        moved[i] += d;
                        model.acceleration(&moved)
                    };
                    // The difference's own error, (1 km / r)^4 times 1e4 for the highest degree, of g = 1e-6 / s2.
                    let slope = difference(along, 1e3);
                    assert!(
                        (g.column(i) - slope).amax() < 1e-16,
                        "{model:?} at {r}: {g} and {slope}"
                    );
                }
                assert!(g.trace().abs() < 1e-19, "Laplace: {}", g.trace());
                assert!((g - g.transpose()).amax() < 1e-22);
            }
        }
    }

    #[test]
    fn two_body_gravity_is_the_case_without_coefficients() {
        let moon = ZonalGravity::new(4.9028e12, 1.7374e6, &[]).unwrap();
        for r in POSITIONS.map(Vector3::from) {
            let pull = r * (-4.9028e12 / r.norm().powi(3));
            assert!((moon.acceleration(&r) - pull).amax() < 1e-15 * pull.amax());
            let e = r.normalize();
            let tide = (e * e.transpose() * 3.0 - Matrix3::identity()) * (4.9028e12 / r.norm().powi(3));
            assert!((moon.gradient(&r) - tide).amax() < 1e-15 * tide.amax());
        }
        assert_eq!(
            ZonalGravity::new(earth::MU, earth::RADIUS, &earth::ZONALS).unwrap(),
            earth::TRUTH
        );
        assert_eq!(
            ZonalGravity::new(earth::MU, earth::RADIUS, &earth::ZONALS[..3]).unwrap(),
            earth::FILTER
        );
    }

    #[test]
    fn two_places_at_once_have_the_bits_of_either() {
        for pair in POSITIONS.map(Vector3::from).windows(2) {
            let alone = [0, 1].map(|i| earth::TRUTH.acceleration(&pair[i]).map(f64::to_bits));
            let both = earth::TRUTH.accelerations([&pair[0], &pair[1]]);
            assert_eq!(both.map(|a| a.map(f64::to_bits)), alone);
        }
    }

    #[test]
    fn what_is_no_body_is_refused() {
        for (mu, r_ref, j, said) in [
            (0.0, 1.0, vec![], "gravitational parameter is 0 m3/s2"),
            (1.0, -2.0, vec![], "reference radius is -2 m"),
            (f64::NAN, 1.0, vec![], "NaN"),
            (1.0, 1.0, vec![1e-3, f64::INFINITY], "inf"),
            (1.0, 1.0, vec![0.0; 6], "6 zonal coefficients: J2 to J6, 5 at most"),
        ] {
            let error = ZonalGravity::new(mu, r_ref, &j).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
