//! Gravity of a body without symmetry: a field of normalised spherical harmonics.
//!
//! Coefficients come with the crate ([`EGM96`]) or from a file ([`Coefficients::read`], whose format [`mod@file`] tells);
//! [`SphericalHarmonics`] evaluates them.

mod coefficients;
mod error;
pub mod file;
mod format;

use nalgebra::{Matrix3, Vector3};
use numerics::lanes::{self, Lanes};
use serde::{Deserialize, Serialize};

pub use coefficients::{Coefficients, EGM96, EMBEDDED, Embedded};
pub use error::{Fault, FieldError};
pub use file::Extent;
pub use format::MAX_DEGREE;

/// A gravity field ready for evaluation: potential, acceleration and gradient in body-fixed axes.
///
/// x points to longitude 0 and z along the axis of rotation. Every function needs r != 0 and is regular at the poles.
///
/// Source: the idea is Pines (AIAA Journal 11, 1973): with u = z/r, P_nm(u) = cos^m(phi) A_nm(u), and the cosine goes to
/// ((x + i y)/r)^m, so that polynomials are left. A_nm and its derivatives come column by column (fixed m) from the
/// normalised three-term recursion in n and from its derivatives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Coefficients", into = "Coefficients")]
pub struct SphericalHarmonics {
    field: Coefficients,
    /// Column by column: for each order all degrees from it on.
    terms: Vec<Coefficient>,
}

/// One coefficient with the factors of the recursion that leads to its A_nm.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Coefficient {
    c: f64,
    s: f64,
    /// From A_{m-1,m-1} to A_mm on the diagonal, from A_{n-1,m} to A_nm below it.
    up: f64,
    /// From A_{n-2,m} to A_nm; 0 where that is none.
    down: f64,
}

/// One term of the sum; what is common to the degrees, mu/r, is left out.
struct Term<T> {
    /// n + m + 1: the power with which the term falls with distance when x, y, z/r are held.
    power: f64,
    /// (R/r)^n times A_nm and its first two derivatives.
    a: [T; 3],
    /// C Re w^m + S Im w^m with w = (x + i y)/r.
    d: T,
    /// Derivatives of `d` by x/r and y/r.
    d_by: (T, T),
    /// Second derivatives of `d`: by x/r twice (by y/r twice it is the opposite), and by both.
    d_by2: (T, T),
}

/// Factor of the normalised recursion, see [`Coefficient::up`].
fn up(n: usize, m: usize) -> f64 {
    let (degree, order) = (n as f64, m as f64);
    match (n, m) {
        (0, 0) => 1.0,
        // The normalisation has a factor 2 for every order but the zeroth.
        (1, 1) => 3.0_f64.sqrt(),
        _ if n == m => ((2.0 * degree + 1.0) / (2.0 * degree)).sqrt(),
        _ => ((4.0 * degree * degree - 1.0) / (degree * degree - order * order)).sqrt(),
    }
}

impl From<Coefficients> for SphericalHarmonics {
    fn from(field: Coefficients) -> Self {
        Self::new(field)
    }
}

impl From<SphericalHarmonics> for Coefficients {
    fn from(harmonics: SphericalHarmonics) -> Self {
        harmonics.field
    }
}

impl SphericalHarmonics {
    /// Field with these coefficients.
    pub fn new(field: Coefficients) -> Self {
        let mut terms = Vec::new();
        for m in 0..=field.order() {
            for n in m..=field.degree() {
                let (c, s) = field.get(n, m);
                let down = if n > m + 1 { up(n, m) / up(n - 1, m) } else { 0.0 };
                terms.push(Coefficient {
                    c,
                    s,
                    up: up(n, m),
                    down,
                });
            }
        }
        Self { field, terms }
    }

    /// The coefficients.
    pub fn coefficients(&self) -> &Coefficients {
        &self.field
    }

    /// Potential per unit mass, positive towards the body (acceleration is its gradient).
    ///
    /// * `r`: position, body-fixed, m.
    /// * returns: m2/s2.
    pub fn potential(&self, r: &Vector3<f64>) -> f64 {
        let mut sum = 0.0;
        self.visit(&[r.x, r.y, r.z], |term| sum += term.a[0] * term.d);
        self.field.mu() / r.norm() * sum
    }

    /// Gravitational acceleration.
    ///
    /// * `r`: position, body-fixed, m.
    /// * returns: same axes, m/s2.
    pub fn acceleration(&self, r: &Vector3<f64>) -> Vector3<f64> {
        self.in_lanes([r.x, r.y, r.z]).into()
    }

    /// [`SphericalHarmonics::acceleration`] at two places, to the bit.
    pub fn accelerations(&self, r: [&Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        lanes::apart(self.in_lanes(lanes::beside(r)))
    }

    #[inline]
    fn in_lanes<T: Lanes>(&self, r: [T; 3]) -> [T; 3] {
        let dist = norm(&r);
        let e = r.map(|component| component / dist);
        let mut direct = [T::all(0.0); 3];
        let mut radial = T::all(0.0);
        self.visit(&r, |term| {
            let [a, slope, _] = term.a;
            direct[0] += a * term.d_by.0;
            direct[1] += a * term.d_by.1;
            direct[2] += slope * term.d;
            radial += (T::all(term.power) * a + e[2] * slope) * term.d;
        });
        let scale = T::all(self.field.mu()) / (dist * dist);
        std::array::from_fn(|i| (direct[i] - e[i] * radial) * scale)
    }

    /// Gravity gradient, the derivative of [`SphericalHarmonics::acceleration`] by position.
    ///
    /// A term is G D with G = A(z/r) / r^p, p = n + m + 1, and D a polynomial in x and y alone, so that the gradient is
    /// D G'' + G' D' + D' G' + G D''.
    ///
    /// * `r`: position, body-fixed, m.
    /// * returns: 3x3, same axes, 1/s2, symmetric and free of trace.
    pub fn gradient(&self, r: &Vector3<f64>) -> Matrix3<f64> {
        let dist = r.norm();
        let e = r / dist;
        let u = e.z;
        // Sums over the terms, by what they multiply: 1, e e', k e' + e k', k k', and x, y parts.
        let (mut isotropic, mut by_ee, mut by_ek, mut by_kk) = (0.0, 0.0, 0.0, 0.0);
        // D' times A' (beside k) and times p A + u A' (beside e).
        let (mut with_k, mut with_e) = (Vector3::zeros(), Vector3::zeros());
        let (mut xx, mut xy) = (0.0, 0.0);
        self.visit(&[r.x, r.y, r.z], |term| {
            let [a, slope, bend] = term.a;
            let p = term.power;
            let fall = p * a + u * slope;
            let fall_slope = (p + 1.0) * slope + u * bend;
            isotropic -= fall * term.d;
            by_ee += ((p + 2.0) * fall + u * fall_slope) * term.d;
            by_ek -= fall_slope * term.d;
            by_kk += bend * term.d;
            let d_by = Vector3::new(term.d_by.0, term.d_by.1, 0.0);
            with_k += d_by * slope;
            with_e -= d_by * fall;
            xx += a * term.d_by2.0;
            xy += a * term.d_by2.1;
        });
        // One half of a symmetric sum; the other is its transpose.
        let mut half = e * (e * (0.5 * by_ee) + with_e).transpose();
        half.set_column(2, &(half.column(2) + e * by_ek + with_k));
        let mut g = half + half.transpose();
        g[(0, 0)] += isotropic + xx;
        g[(1, 1)] += isotropic - xx;
        g[(2, 2)] += isotropic + by_kk;
        g[(0, 1)] += xy;
        g[(1, 0)] += xy;
        g * (self.field.mu() / (dist * dist * dist))
    }

    #[inline]
    fn visit<T: Lanes>(&self, r: &[T; 3], mut each: impl FnMut(Term<T>)) {
        let of = T::all;
        let inv = of(1.0) / norm(r);
        let [x, y, u] = r.map(|component| component * inv);
        let q = of(self.field.r_ref()) * inv;
        // w^m, w^(m-1) and w^(m-2) as (real, imaginary); the sector A_mm does not depend on u.
        let nothing = (of(0.0), of(0.0));
        let (mut w, mut w_low, mut w_lowest) = ((of(1.0), of(0.0)), nothing, nothing);
        let (mut sector, mut q_m) = (1.0, of(1.0));
        let mut terms = self.terms.as_slice();
        for m in 0..=self.field.order() {
            let (column, later) = terms.split_at(self.field.degree() + 1 - m);
            terms = later;
            if m > 0 {
                q_m *= q;
                w_lowest = w_low;
                w_low = w;
                w = (x * w_low.0 - y * w_low.1, x * w_low.1 + y * w_low.0);
            }
            let order = m as f64;
            let pairs = order * (order - 1.0);
            let (mut low, mut mid, mut q_n) = ([of(0.0); 3], [of(0.0); 3], q_m);
            for (above, term) in column.iter().enumerate() {
                let [c, s, up, down] = [term.c, term.s, term.up, term.down].map(of);
                if above == 0 {
                    sector *= term.up;
                    mid = [of(sector), of(0.0), of(0.0)];
                } else {
                    let high = [
                        up * u * mid[0] - down * low[0],
                        up * (mid[0] + u * mid[1]) - down * low[1],
                        up * (of(2.0) * mid[1] + u * mid[2]) - down * low[2],
                    ];
                    (low, mid) = (mid, high);
                    q_n *= q;
                }
                each(Term {
                    power: (above + 2 * m + 1) as f64,
                    a: mid.map(|a| q_n * a),
                    d: c * w.0 + s * w.1,
                    d_by: (
                        of(order) * (c * w_low.0 + s * w_low.1),
                        of(order) * (s * w_low.0 - c * w_low.1),
                    ),
                    d_by2: (
                        of(pairs) * (c * w_lowest.0 + s * w_lowest.1),
                        of(pairs) * (s * w_lowest.0 - c * w_lowest.1),
                    ),
                });
            }
        }
    }
}

#[inline]
fn norm<T: Lanes>([x, y, z]: &[T; 3]) -> T {
    (*x * *x + *y * *y + *z * *z).sqrt()
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

    /// A field of one exaggerated term beside the point mass.
    fn single(n: usize, m: usize, c: f64, s: f64) -> SphericalHarmonics {
        let field = Coefficients::point_mass(EGM96.mu, EGM96.r_ref, n, m).unwrap();
        SphericalHarmonics::new(field.with(n, m, c, s).unwrap())
    }

    /// EGM96, and one field for each coefficient, exaggerated, so that no term hides behind another.
    fn fields() -> Vec<SphericalHarmonics> {
        let mut fields = vec![SphericalHarmonics::new(EGM96.coefficients())];
        for n in 1..4 {
            fields.extend((0..=n).map(|m| single(n, m, 0.1, -0.07)));
        }
        fields
    }

    /// Every coefficient to degree and order 20, of the size that Kaula's rule gives those of the Earth, 1e-5 / n^2.
    fn full() -> SphericalHarmonics {
        let mut field = Coefficients::point_mass(EGM96.mu, EGM96.r_ref, 20, 20).unwrap();
        for n in 2..=20 {
            for m in 0..=n {
                let angle = (31 * n + 7 * m) as f64;
                let size = 1e-5 / (n * n) as f64;
                let s = if m > 0 { angle.cos() } else { 0.0 };
                field = field.with(n, m, size * angle.sin(), size * s).unwrap();
            }
        }
        SphericalHarmonics::new(field)
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
        let egm96 = EGM96.coefficients();
        let field = SphericalHarmonics::new(egm96.truncated(3, 0).unwrap());
        let j3 = -egm96.get(3, 0).0 * 7.0_f64.sqrt();
        let zonal = ZonalGravity {
            mu: EGM96.mu,
            r_ref: EGM96.r_ref,
            j: [EGM96.j2(), j3, 0.0, 0.0, 0.0],
        };
        for r in POSITIONS.map(Vector3::from) {
            let difference = field.acceleration(&r) - zonal.acceleration(&r);
            assert!(difference.amax() < 1e-14, "at {r}: {difference}");
        }
    }

    /// The equator bulges towards 15 W and 165 E. What is pulled eastwards climbs and falls back, so a geostationary satellite
    /// is held where the pull points away: over the hollows between, known to lie at 75.1 E and 105.3 W.
    #[test]
    fn val_geostationary_satellites_rest_over_75_e() {
        let field = SphericalHarmonics::new(EGM96.coefficients());
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

    #[test]
    fn gradient_is_the_derivative_of_the_acceleration() {
        for field in fields().iter().chain([&full()]) {
            for r in POSITIONS.map(Vector3::from) {
                let g = field.gradient(&r);
                for i in 0..3 {
                    let slope = difference(|d| field.acceleration(&moved(&r, i, d)), 1e3);
                    // Rounding of the acceleration, 1e-15 m/s2, over 1 km, and (1 km / r)^4 of high degrees; g is 1e-6 / s2.
                    assert!((g.column(i) - slope).amax() < 2e-17, "axis {i} at {r}: {g} and {slope}");
                }
                assert!(g.trace().abs() < 1e-20, "Laplace at {r}: {}", g.trace());
                assert!((g - g.transpose()).amax() < f64::MIN_POSITIVE);
            }
        }
    }

    /// The harmonics of a sphere can be turned: sum over m of P_nm(a) P_nm(b) cos m(l_a - l_b) = (2n + 1) P_n(cos of the
    /// angle between a and b). So a field that is zonal about a tilted axis has coefficients P_nm(axis) / (2n + 1), and its
    /// potential follows from Legendre's polynomials, which the code never forms.
    #[test]
    fn potential_of_every_degree_obeys_the_addition_theorem() {
        let legendre = |n: usize, u: f64| {
            let (mut low, mut mid) = (1.0, u);
            for k in 1..n {
                let k = k as f64;
                (low, mid) = (mid, ((2.0 * k + 1.0) * u * mid - k * low) / (k + 1.0));
            }
            mid
        };
        let unit = |lat: f64, lon: f64| Vector3::new(lat.cos() * lon.cos(), lat.cos() * lon.sin(), lat.sin());
        for n in 1..=20 {
            for (lat, lon) in [(0.3_f64, 1.1_f64), (-1.2, -2.9), (0.0, 0.0), (1.5, 4.0)] {
                let axis = unit(lat, lon);
                let mut field = Coefficients::point_mass(1.0, 1.0, n, n).unwrap();
                for m in 0..=n {
                    // P_nm at the axis: what one coefficient adds to the potential of a unit mass on the unit sphere.
                    let part = |c, s| {
                        let field = Coefficients::point_mass(1.0, 1.0, n, m).unwrap();
                        SphericalHarmonics::new(field.with(n, m, c, s).unwrap()).potential(&axis) - 1.0
                    };
                    let scale = 1.0 / (2 * n + 1) as f64;
                    field = field
                        .with(n, m, part(1.0, 0.0) * scale, part(0.0, 1.0) * scale)
                        .unwrap();
                }
                let field = SphericalHarmonics::new(field);
                for place in [unit(0.7, -0.4), unit(-0.1, 2.0), unit(1.57, 0.0), axis, -axis] {
                    let expected = 1.0 + legendre(n, axis.dot(&place));
                    let potential = field.potential(&place);
                    assert!(
                        (potential - expected).abs() < 1e-13,
                        "degree {n}: {potential} and {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn zonal_fields_have_the_gradient_of_the_zonal_model() {
        for n in 2_usize..=6 {
            let mut j = [0.0; 5];
            j[n - 2] = 0.3;
            let zonal = ZonalGravity {
                mu: EGM96.mu,
                r_ref: EGM96.r_ref,
                j,
            };
            let field = single(n, 0, -0.3 / ((2 * n + 1) as f64).sqrt(), 0.0);
            for r in POSITIONS.map(Vector3::from) {
                let (a, g) = (zonal.acceleration(&r), zonal.gradient(&r));
                // At the poles the exaggerated term and the point mass cancel to a fifth of either.
                assert!(
                    (field.acceleration(&r) - a).amax() < 1e-13 * a.amax(),
                    "degree {n} at {r}"
                );
                assert!((field.gradient(&r) - g).amax() < 1e-13 * g.amax(), "degree {n} at {r}");
            }
        }
    }

    #[test]
    fn acceleration_of_a_high_field_is_the_gradient_of_its_potential() {
        let field = full();
        for r in POSITIONS.map(Vector3::from) {
            let a = field.acceleration(&r);
            for i in 0..3 {
                let slope = difference(|d| field.potential(&moved(&r, i, d)), 2e3);
                assert!((a[i] - slope).abs() < 5e-11, "at {r}: {} and {slope}", a[i]);
            }
        }
        // Low orders alone are the same field as all orders with zeros beyond.
        let low = field.coefficients().truncated(20, 2).unwrap();
        let mut padded = Coefficients::point_mass(EGM96.mu, EGM96.r_ref, 20, 20).unwrap();
        for n in 2..=20 {
            for m in 0..=2 {
                let (c, s) = low.get(n, m);
                padded = padded.with(n, m, c, s).unwrap();
            }
        }
        let [low, padded] = [low, padded].map(SphericalHarmonics::new);
        for r in POSITIONS.map(Vector3::from) {
            assert!(
                (low.acceleration(&r) - padded.acceleration(&r)).amax() < 1e-15,
                "at {r}"
            );
        }
    }

    #[test]
    fn two_places_at_once_have_the_bits_of_either() {
        for field in [SphericalHarmonics::new(EGM96.coefficients()), full()] {
            for pair in POSITIONS.map(Vector3::from).windows(2) {
                let alone = [0, 1].map(|i| field.acceleration(&pair[i]).map(f64::to_bits));
                let both = field.accelerations([&pair[0], &pair[1]]);
                assert_eq!(both.map(|a| a.map(f64::to_bits)), alone);
            }
        }
    }

    /// Accelerations and potentials when the degree was fixed at compile time.
    #[test]
    fn regress_egm96_3x3() {
        let field = SphericalHarmonics::new(EGM96.coefficients());
        for (r, (a, potential)) in POSITIONS.iter().zip([
            (
                [-6.40868376162953, 4.146887356656429, -3.906484413772593],
                58457944.17470323,
            ),
            (
                [8.437761368731072, 9.6218202527069e-5, 5.621393505701776e-6],
                57980251.782148264,
            ),
            (
                [-1.1722657731330401, -2.34468431835039, 7.758657125768199],
                57156458.04033752,
            ),
            (
                [8.095077590985746e-5, 9.941933876546537e-6, -8.112830452290824],
                56891848.16666596,
            ),
            (
                [8.095940196606704e-5, 9.879405302288372e-6, 8.112705772737351],
                56891629.97744736,
            ),
        ]) {
            let r = Vector3::from(*r);
            assert_eq!(field.acceleration(&r), Vector3::from(a));
            assert!((field.potential(&r) - potential).abs() < f64::MIN_POSITIVE);
        }
    }

    #[test]
    fn saved_fields_come_back_and_damaged_ones_do_not() {
        for field in [
            full(),
            SphericalHarmonics::new(full().coefficients().truncated(7, 3).unwrap()),
        ] {
            let text = serde_json::to_string(&field).unwrap();
            let back: SphericalHarmonics = serde_json::from_str(&text).unwrap();
            assert_eq!(back, field);
            let short = text.replacen("[0.0,0.0],", "", 1);
            let error = serde_json::from_str::<SphericalHarmonics>(&short)
                .unwrap_err()
                .to_string();
            assert!(error.contains("is missing"), "{error}");
        }
    }
}
