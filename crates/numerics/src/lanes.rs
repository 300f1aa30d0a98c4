//! One formula for one number, or for two at a time.
//!
//! Every processor that we build for has registers of two `f64`. A formula over [`Lanes`] takes for both little more than for
//! one, and gives either the bits that it has alone: each operation is one that IEEE 754 rounds, and none crosses lanes.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub, SubAssign};

use nalgebra::Vector3;
use wide::f64x2;

/// A number, or two side by side.
pub trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// The same number in every lane.
    fn all(x: f64) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;
}

impl Lanes for f64 {
    #[inline(always)]
    fn all(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
}

impl Lanes for f64x2 {
    #[inline(always)]
    fn all(x: f64) -> Self {
        Self::splat(x)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
}

/// Two vectors, one in each lane.
#[inline(always)]
pub fn beside([a, b]: [&Vector3<f64>; 2]) -> [f64x2; 3] {
    std::array::from_fn(|i| f64x2::new([a[i], b[i]]))
}

/// The vectors in the lanes.
#[inline(always)]
pub fn apart(components: [f64x2; 3]) -> [Vector3<f64>; 2] {
    let [x, y, z] = components.map(f64x2::to_array);
    [0, 1].map(|lane| Vector3::new(x[lane], y[lane], z[lane]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn every_operation<T: Lanes>([x, y, z]: [T; 3]) -> [T; 3] {
        let mut sum = x / y;
        sum += z * T::all(0.1);
        sum -= y;
        sum *= z;
        [sum, (x * x + y * y).sqrt(), z - x]
    }

    #[test]
    fn either_lane_has_the_bits_of_one_number() {
        for k in 0..1000 {
            let k = f64::from(k);
            let [a, b] = [k, k + 0.5].map(|k| Vector3::new(k.sin() * 1e6, (2.0 * k).cos(), (3.0 * k).sin() * 1e-9));
            let alone = [a, b].map(|r| Vector3::from(every_operation([r.x, r.y, r.z])).map(f64::to_bits));
            let beside = apart(every_operation(beside([&a, &b]))).map(|r| r.map(f64::to_bits));
            assert_eq!(alone, beside, "{k}");
        }
    }
}
