//! Time of one evaluation of a gravity field: acceleration and gradient, from 3x3 to 20x20.

#![allow(missing_docs, reason = "criterion's macros make public items")]

use std::hint::black_box;

use astro::harmonics::{Coefficients, EGM96, SphericalHarmonics};
use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;

fn fields(criterion: &mut Criterion) {
    let r = Vector3::new(5.1e6, -3.3e6, 3.1e6);
    let high = Coefficients::point_mass(EGM96.mu, EGM96.r_ref, 20, 20).ok();
    for field in [Some(EGM96.coefficients()), high].into_iter().flatten() {
        let size = format!("{0}x{0}", field.degree());
        let field = SphericalHarmonics::new(field);
        criterion.bench_function(&format!("acceleration {size}"), |b| {
            b.iter(|| field.acceleration(black_box(&r)));
        });
        criterion.bench_function(&format!("gradient {size}"), |b| {
            b.iter(|| field.gradient(black_box(&r)))
        });
    }
}

criterion_group!(benches, fields);
criterion_main!(benches);
