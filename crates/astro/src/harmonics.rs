//! Gravity of a body without symmetry: a field of normalised spherical harmonics.

use nalgebra::Vector3;

/// Fully normalised coefficients of a gravity field to degree and order `N - 1`.
///
/// U = mu/r sum over n, m <= n of (R/r)^n P_nm(sin phi) (C_nm cos m lambda + S_nm sin m lambda), phi the geocentric latitude
/// and lambda the east longitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients<const N: usize> {
    /// Gravitational parameter, m3/s2.
    pub mu: f64,
    /// Reference radius R, m.
    pub r_ref: f64,
    /// C_nm at `c[n][m]`; C_00 is 1, entries with m > n are not used.
    pub c: [[f64; N]; N],
    /// S_nm at `s[n][m]`.
    pub s: [[f64; N]; N],
}

/// The Earth to degree and order 3.
///
/// Source: EGM96 (Lemoine et al., NASA/TP-1998-206861), tide-free, with its own mu and radius.
pub const EGM96: Coefficients<4> = Coefficients {
    mu: 3_986_004.415e8,
    r_ref: 6_378_136.3,
    c: [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0],
        [-0.484165371736e-3, -0.186987635955e-9, 0.243914352398e-5, 0.0],
        [
            0.957254173792e-6,
            0.202998882184e-5,
            0.904627768605e-6,
            0.721072657057e-6,
        ],
    ],
    s: [
        [0.0; 4],
        [0.0; 4],
        [0.0, 0.119528012031e-8, -0.140016683654e-5, 0.0],
        [0.0, 0.248513158716e-6, -0.619025944205e-6, 0.141435626958e-5],
    ],
};

impl<const N: usize> Coefficients<N> {
    /// Unnormalised J2 = -sqrt(5) C_20; 0 for a field without degree 2.
    pub fn j2(&self) -> f64 {
        self.c.get(2).map_or(0.0, |row| -row[0] * 5.0_f64.sqrt())
    }
}

/// A gravity field ready for evaluation: acceleration and potential in body-fixed axes.
///
/// x points to longitude 0 and z along the axis of rotation. Every function needs r != 0 and is regular at the poles.
///
/// Source: the idea is Pines (AIAA Journal 11, 1973): with u = z/r, P_nm(u) = cos^m(phi) A_nm(u), and the cosine goes to
/// ((x + i y)/r)^m, so that polynomials are left. A_nm and its derivative come column by column (fixed m) from the
/// normalised three-term recursion in n and from its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphericalHarmonics<const N: usize> {
    field: Coefficients<N>,
    /// Factors of the recursion: from A_{m-1,m-1} to A_mm on the diagonal, from A_{n-1,m} to A_nm below it.
    up: [[f64; N]; N],
}

/// One term of the sum; what is common to the degrees, mu/r, is left out.
struct Term {
    /// n + m + 1: the power with which the term falls with distance when x, y, z/r are held.
    power: f64,
    /// (R/r)^n A_nm and (R/r)^n A'_nm.
    a: (f64, f64),
    /// C Re w^m + S Im w^m with w = (x + i y)/r.
    d: f64,
    /// Derivatives of `d` by x/r and y/r.
    d_by: (f64, f64),
}

impl<const N: usize> SphericalHarmonics<N> {
    /// Field with these coefficients.
    pub fn new(field: Coefficients<N>) -> Self {
        let up = std::array::from_fn(|n| {
            std::array::from_fn(|m| {
                let (degree, order) = (n as f64, m as f64);
                match (n, m) {
                    (0, 0) => 1.0,
                    // The normalisation has a factor 2 for every order but the zeroth.
                    (1, 1) => 3.0_f64.sqrt(),
                    _ if n == m => ((2.0 * degree + 1.0) / (2.0 * degree)).sqrt(),
                    _ if n > m => ((4.0 * degree * degree - 1.0) / (degree * degree - order * order)).sqrt(),
                    _ => 0.0,
                }
            })
        });
        Self { field, up }
    }

    /// The coefficients.
    pub fn coefficients(&self) -> &Coefficients<N> {
        &self.field
    }

    /// Potential per unit mass, positive towards the body (acceleration is its gradient).
    ///
    /// * `r`: position, body-fixed, m.
    /// * returns: m2/s2.
    pub fn potential(&self, r: &Vector3<f64>) -> f64 {
        let mut sum = 0.0;
        self.visit(r, |term| sum += term.a.0 * term.d);
        self.field.mu / r.norm() * sum
    }

    /// Gravitational acceleration.
    ///
    /// * `r`: position, body-fixed, m.
    /// * returns: same axes, m/s2.
    pub fn acceleration(&self, r: &Vector3<f64>) -> Vector3<f64> {
        let dist = r.norm();
        let e = r / dist;
        let mut direct = Vector3::zeros();
        let mut radial = 0.0;
        self.visit(r, |term| {
            let (a, slope) = term.a;
            direct.x += a * term.d_by.0;
            direct.y += a * term.d_by.1;
            direct.z += slope * term.d;
            radial += (term.power * a + e.z * slope) * term.d;
        });
        (direct - e * radial) * (self.field.mu / (dist * dist))
    }

    fn visit(&self, r: &Vector3<f64>, mut each: impl FnMut(Term)) {
        let inv = 1.0 / r.norm();
        let (x, y, u) = (r.x * inv, r.y * inv, r.z * inv);
        let q = self.field.r_ref * inv;
        // w^m and w^(m-1) as (real, imaginary); the sector A_mm does not depend on u.
        let (mut w, mut w_low) = ((1.0, 0.0), (0.0, 0.0));
        let (mut sector, mut q_m) = (1.0, 1.0);
        for m in 0..N {
            let order = m as f64;
            sector *= self.up[m][m];
            if m > 0 {
                q_m *= q;
                w_low = w;
                w = (x * w_low.0 - y * w_low.1, x * w_low.1 + y * w_low.0);
            }
            let (mut low, mut mid, mut q_n) = ((0.0, 0.0), (sector, 0.0), q_m);
            for n in m..N {
                if n > m {
                    let up = self.up[n][m];
                    // The sector has nothing below it, and `low` is 0 there.
                    let down = if n > m + 1 { up / self.up[n - 1][m] } else { 0.0 };
                    let high = (up * u * mid.0 - down * low.0, up * (mid.0 + u * mid.1) - down * low.1);
                    (low, mid) = (mid, high);
                    q_n *= q;
                }
                let (c, s) = (self.field.c[n][m], self.field.s[n][m]);
                each(Term {
                    power: (n + m + 1) as f64,
                    a: (q_n * mid.0, q_n * mid.1),
                    d: c * w.0 + s * w.1,
                    d_by: (order * (c * w_low.0 + s * w_low.1), order * (s * w_low.0 - c * w_low.1)),
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ZonalGravity;

    const POSITIONS: [[f64; 3]; 5] = [
        [5.1e6, -3.3e6, 3.1e6],
        [-6.878e6, 0.0, 0.0],
        [1.0e6, 2.0e6, -6.6e6],
        [0.0, 0.0, 7.0e6],
        [1e-3, 0.0, -7.0e6],
    ];

    /// EGM96, and one field for each coefficient, exaggerated, so that no term hides behind another.
    fn fields() -> Vec<SphericalHarmonics<4>> {
        let mut fields = vec![SphericalHarmonics::new(EGM96)];
        for n in 1..4 {
            for m in 0..=n {
                let mut one = Coefficients {
                    c: [[0.0; 4]; 4],
                    s: [[0.0; 4]; 4],
                    ..EGM96
                };
                one.c[0][0] = 1.0;
                one.c[n][m] = 0.1;
                one.s[n][m] = -0.07;
                fields.push(SphericalHarmonics::new(one));
            }
        }
        fields
    }

    /// Central difference of order four.
    fn difference<T>(f: impl Fn(f64) -> T, h: f64) -> T
    where
        T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        (f(h) - f(-h)) * (2.0 / (3.0 * h)) - (f(2.0 * h) - f(-2.0 * h)) * (1.0 / (12.0 * h))
    }

    fn moved(r: &Vector3<f64>, axis: usize, by: f64) -> Vector3<f64> {
        let mut r = *r;
        r[axis] += by;
        r
    }

    /// Legendre functions in closed form, normalised by sqrt(k (2n + 1) (n - m)! / (n + m)!), k = 1 for m = 0, else 2.
    #[test]
    fn potential_uses_the_normalised_legendre_functions() {
        let (lat, lon): (f64, f64) = (0.6, -2.2);
        let r = Vector3::new(lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin()) * 7.1e6;
        let (sin, cos) = lat.sin_cos();
        let closed = [
            (1, 0, 3.0_f64.sqrt() * sin),
            (1, 1, 3.0_f64.sqrt() * cos),
            (2, 0, 5.0_f64.sqrt() * (3.0 * sin * sin - 1.0) / 2.0),
            (2, 1, (5.0_f64 / 3.0).sqrt() * 3.0 * sin * cos),
            (2, 2, (5.0_f64 / 12.0).sqrt() * 3.0 * cos * cos),
            (3, 0, 7.0_f64.sqrt() * (5.0 * sin.powi(3) - 3.0 * sin) / 2.0),
            (3, 1, (7.0_f64 / 6.0).sqrt() * cos * (15.0 * sin * sin - 3.0) / 2.0),
            (3, 2, (7.0_f64 / 60.0).sqrt() * 15.0 * sin * cos * cos),
            (3, 3, (7.0_f64 / 360.0).sqrt() * 15.0 * cos.powi(3)),
        ];
        for (field, (n, m, p)) in fields()[1..].iter().zip(closed) {
            let (q, turn) = (EGM96.r_ref / 7.1e6, f64::from(m) * lon);
            // S_n0 has no effect.
            let expected = 1.0 + q.powi(n) * p * (0.1 * turn.cos() - 0.07 * turn.sin());
            let ratio = field.potential(&r) / (EGM96.mu / 7.1e6);
            assert!(
                (ratio - expected).abs() < 1e-14,
                "degree {n}, order {m}: {ratio} and {expected}"
            );
        }
    }

    #[test]
    fn acceleration_is_the_gradient_of_the_potential() {
        for field in fields() {
            for r in POSITIONS.map(Vector3::from) {
                let a = field.acceleration(&r);
                for i in 0..3 {
                    let slope = difference(|d| field.potential(&moved(&r, i, d)), 2e3);
                    // Rounding of the potential, 1e-8 m2/s2, over a step of 2 km.
                    assert!((a[i] - slope).abs() < 5e-11, "{field:?} at {r}: {} and {slope}", a[i]);
                }
            }
        }
    }

    #[test]
    fn acceleration_has_no_divergence_and_no_curl() {
        for field in fields() {
            for r in POSITIONS.map(Vector3::from) {
                let column = |i| difference(|d| field.acceleration(&moved(&r, i, d)), 2e3);
                let g = nalgebra::Matrix3::from_columns(&[column(0), column(1), column(2)]);
                // Rounding of the acceleration, 1e-15 m/s2, over 2 km; entries are 1e-6 / s2.
                assert!(g.trace().abs() < 1e-17, "{field:?} at {r}: {}", g.trace());
                assert!((g - g.transpose()).amax() < 1e-17, "{field:?} at {r}: {g}");
            }
        }
    }

    #[test]
    fn zonal_terms_alone_agree_with_the_zonal_model() {
        let mut c = [[0.0; 4]; 4];
        c[0][0] = 1.0;
        c[2][0] = EGM96.c[2][0];
        c[3][0] = EGM96.c[3][0];
        let field = SphericalHarmonics::new(Coefficients {
            c,
            s: [[0.0; 4]; 4],
            ..EGM96
        });
        let j3 = -EGM96.c[3][0] * 7.0_f64.sqrt();
        let zonal = ZonalGravity {
            mu: EGM96.mu,
            r_ref: EGM96.r_ref,
            j: [EGM96.j2(), j3, 0.0, 0.0, 0.0],
        };
        // The value that textbooks print.
        assert!((EGM96.j2() - 1.082_626_68e-3).abs() < 5e-12, "{}", EGM96.j2());
        for r in POSITIONS.map(Vector3::from) {
            let difference = field.acceleration(&r) - zonal.acceleration(&r);
            assert!(difference.amax() < 1e-14, "at {r}: {difference}");
        }
    }

    /// The equator bulges towards 15 W and 165 E. What is pulled eastwards climbs and falls back, so a geostationary satellite
    /// is held where the pull points away: over the hollows between, known to lie at 75.1 E and 105.3 W.
    #[test]
    fn geostationary_satellites_rest_over_75_e() {
        let field = SphericalHarmonics::new(EGM96);
        let transverse = |lon: f64| {
            let r = Vector3::new(lon.cos(), lon.sin(), 0.0) * 42_164e3;
            field.acceleration(&r).dot(&Vector3::new(-lon.sin(), lon.cos(), 0.0))
        };
        for lon in [75.1_f64, -105.3] {
            let lon = lon.to_radians();
            // Degree 4 and above move the points by less than a degree.
            assert!(transverse(lon + 0.02) > 0.0 && transverse(lon - 0.02) < 0.0, "{lon}");
        }
        // Largest pull about 6e-8 m/s2, halfway between.
        let largest = (0..360)
            .map(|d| transverse(f64::from(d).to_radians()).abs())
            .fold(0.0, f64::max);
        assert!((5e-8..7.5e-8).contains(&largest), "{largest}");
    }
}
