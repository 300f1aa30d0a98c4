//! Elementary functions that give the same bits on every platform and processor.
//!
//! `f64::exp` and its like are the C library's: another one on every system, and in glibc one by the processor, with fused
//! multiply-add where there is one. What flies in truth or in a filter takes these instead, from the Rust crate `libm`, as
//! `numerics::math`; clippy holds it to that. What IEEE 754 rounds exactly (`sqrt`, `floor`, `%`, `to_radians`'s product) is the
//! same everywhere and stays a method.
//!
//! Libraries that we build on call the C library by name. [`linking`] gives them these functions too.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod linking;

/// Sine of an angle, rad.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of an angle, rad.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Sine and cosine of an angle, rad; the bits of [`sin`] and [`cos`].
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Tangent of an angle, rad.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Arc tangent, rad, within -pi/2 and pi/2.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// Angle of the point (x, y), rad, from -pi to pi.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Length of the hypotenuse, without overflow on the way.
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// e to the power of `x`.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// exp(x) - 1, exact to rounding near zero too.
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Natural logarithm; NaN below zero.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// ln(1 + x), exact to rounding near zero too.
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// Logarithm to base 2; NaN below zero.
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// `x` to the power of `y`.
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Units in the last place between two numbers of one sign.
    fn apart(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    /// Arguments over many decades, both signs.
    fn arguments() -> impl Iterator<Item = f64> {
        (0..4000).map(|k| f64::from(k - 2000) / 100.0 * 1.01_f64.powi(k % 700 - 350))
    }

    /// The C library of the machine is another road to the same values; both claim less than one unit in the last place.
    #[test]
    fn they_are_the_c_librarys_to_two_units_in_the_last_place() {
        type Pair = (&'static str, fn(f64) -> f64, fn(f64) -> f64);
        let pairs: [Pair; 10] = [
            ("sin", sin, f64::sin),
            ("cos", cos, f64::cos),
            ("tan", tan, f64::tan),
            ("atan", atan, f64::atan),
            ("exp", exp, f64::exp),
            ("exp_m1", exp_m1, f64::exp_m1),
            ("ln", |x| ln(x.abs()), |x| x.abs().ln()),
            ("ln_1p", |x| ln_1p(x.abs()), |x| x.abs().ln_1p()),
            ("log2", |x| log2(x.abs()), |x| x.abs().log2()),
            ("powf", |x| powf(x.abs(), 2.5), |x| x.abs().powf(2.5)),
        ];
        for (name, ours, theirs) in pairs {
            for x in arguments() {
                assert!(
                    apart(ours(x), theirs(x)) <= 2,
                    "{name}({x:e}): {:e}, {:e}",
                    ours(x),
                    theirs(x)
                );
            }
        }
        for (x, y) in arguments().zip(arguments().skip(777)) {
            assert!(apart(atan2(y, x), y.atan2(x)) <= 2, "atan2({y:e}, {x:e})");
            assert!(apart(hypot(x, y), x.hypot(y)) <= 2, "hypot({x:e}, {y:e})");
            assert_eq!(sin_cos(x).0.to_bits(), sin(x).to_bits(), "sin({x:e})");
            assert_eq!(sin_cos(x).1.to_bits(), cos(x).to_bits(), "cos({x:e})");
        }
    }

    /// Bits as they are on every platform, computed once with `libm` 0.2.16 on x86_64 Linux.
    #[test]
    fn regress_bits() {
        let mut sum = 0_u64;
        for x in arguments() {
            for y in [
                sin(x),
                cos(x),
                tan(x),
                atan(x),
                exp(x),
                exp_m1(x),
                ln(x.abs()),
                ln_1p(x.abs()),
                log2(x.abs()),
            ] {
                sum = sum.rotate_left(7) ^ y.to_bits();
            }
            for y in [powf(x.abs(), 1.3), atan2(x, 0.7), hypot(x, 0.7)] {
                sum = sum.rotate_left(7) ^ y.to_bits();
            }
        }
        assert_eq!(sum, 0x9294_0c39_2e6e_37bf, "{sum:#x}");
    }
}
