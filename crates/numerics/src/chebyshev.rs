//! Polynomials in place of a smooth function that costs much.

use nalgebra::SVector;

use crate::math;

/// A function of [-1, 1] by its first `N` Chebyshev polynomials: it meets the function at their `N` nodes, and between them
/// is off by max |f^(N)| / (2^(N-1) N!) at most.
#[derive(Debug, Clone, PartialEq)]
pub struct Chebyshev<const N: usize, const D: usize> {
    coefficients: [SVector<f64, D>; N],
}

impl<const N: usize, const D: usize> Chebyshev<N, D> {
    /// The polynomial of degree `N - 1` through `f` at the nodes.
    pub fn through(f: impl Fn(f64) -> SVector<f64, D>) -> Self {
        let step = std::f64::consts::PI / N as f64;
        let angle = |k: usize| (k as f64 + 0.5) * step;
        let values: [_; N] = std::array::from_fn(|k| f(math::cos(angle(k))));
        Self {
            coefficients: std::array::from_fn(|n| {
                let terms = values.iter().enumerate();
                let sum: SVector<f64, D> = terms.map(|(k, value)| value * math::cos(n as f64 * angle(k))).sum();
                sum * (if n == 0 { 1.0 } else { 2.0 } / N as f64)
            }),
        }
    }

    /// Its value at `s`, which is to lie within [-1, 1]; by Clenshaw's recursion.
    #[inline]
    pub fn at(&self, s: f64) -> SVector<f64, D> {
        let [first, others @ ..] = self.coefficients.as_slice() else {
            return SVector::zeros();
        };
        let (mut next, mut after) = (SVector::zeros(), SVector::zeros());
        for c in others.iter().rev() {
            (next, after) = (c + next * (2.0 * s) - after, next);
        }
        first + next * s - after
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector1, Vector2};

    #[test]
    fn a_polynomial_is_met_everywhere() {
        let f = |s: f64| Vector2::new(1.0 - 2.0 * s + 3.0 * s * s, 0.5 * s.powi(3) - s);
        let same = Chebyshev::<4, 2>::through(f);
        for k in -10..=10 {
            let s = f64::from(k) / 10.0;
            // Rounding of values of up to 6, eight times.
            assert!((same.at(s) - f(s)).amax() < 8e-15, "{s}");
        }
        let one = Chebyshev::<1, 1>::through(|_| Vector1::new(7.0));
        assert!((one.at(-0.3).x - 7.0).abs() < 1e-15);
    }

    /// The bound holds, and is not far off: the sine of a radian has derivatives of up to 1.
    #[test]
    fn between_the_nodes_it_is_off_by_the_next_derivative() {
        let worst = |at: &dyn Fn(f64) -> f64| {
            let errors = (-1000..=1000)
                .map(|k| f64::from(k) / 1e3)
                .map(|s| (at(s) - s.sin()).abs());
            errors.fold(0.0, f64::max)
        };
        let (three, six) = (
            Chebyshev::<3, 1>::through(|s| Vector1::new(s.sin())),
            Chebyshev::<6, 1>::through(|s| Vector1::new(s.sin())),
        );
        let (three, six) = (worst(&|s| three.at(s).x), worst(&|s| six.at(s).x));
        assert!((0.5..=1.0).contains(&(three * 4.0 * 6.0)), "{three}");
        assert!((0.1..=1.0).contains(&(six * 32.0 * 720.0)), "{six}");
    }
}
