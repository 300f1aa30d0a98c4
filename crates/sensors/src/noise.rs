//! Draws of unit noise.

use nalgebra::Vector3;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Three independent draws of mean 0 and variance 1.
pub fn normal3<R: Rng + ?Sized>(rng: &mut R) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(rng))
}
