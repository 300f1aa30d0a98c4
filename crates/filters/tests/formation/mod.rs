//! The formation as the J2 relative model has it, measured in full, and what it has in common with the other world.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
#![allow(missing_docs, reason = "part of test binaries")]
#![allow(dead_code, reason = "each binary uses its own part")]

use crate::common::OwnWorld;
use astro::{ClohessyWiltshire, Elements, J2RelativeMotion, Lvlh, TargetOrbit};
use filters::state::State;
use filters::{Reading, Sample};
use interface::Sensor;
use nalgebra::{SVector, Vector6};
use numerics::{Generator, Source, rk4, stream};
use rand_distr::{Distribution, StandardNormal};

/// What a test drives a filter with.
pub trait World {
    /// One second of truth and the sample at its end.
    fn step(&mut self) -> Sample;
    /// True relative position, velocity and unmodelled acceleration, SI.
    fn truth(&self) -> SVector<f64, 9>;
}

impl World for OwnWorld {
    fn step(&mut self) -> Sample {
        OwnWorld::step(self)
    }
    fn truth(&self) -> SVector<f64, 9> {
        self.x.fixed_rows::<9>(0).into_owned()
    }
}

const MU: f64 = astro::earth::FILTER.mu;
const SEMI_MAJOR_AXIS: f64 = 8.1431e6;

/// Leader and follower under J2, as the relative model has it, measured in full.
pub struct Formation {
    model: J2RelativeMotion,
    /// rho, rho_dot, then the target's orbit.
    x: SVector<f64, 12>,
    g: Generator,
    k: i32,
}

impl Formation {
    /// The formation of Pesce, Silvestrini and Lavagna, Table 1, and a first measurement of it.
    pub fn new(run: u64) -> (Self, State) {
        let degree = std::f64::consts::PI / 180.0;
        let elements = |mean_anomaly: f64| Elements {
            a: SEMI_MAJOR_AXIS,
            e: 0.1413,
            inclination: 98.2 * degree,
            node: 79.2 * degree,
            argument_of_periapsis: 85.9 * degree,
            mean_anomaly,
        };
        // At periapsis a true anomaly of 1e-4 deg is this much mean anomaly.
        let e: f64 = 0.1413;
        let ahead = 1e-4 * degree * (1.0 - e).powf(1.5) / (1.0 + e).sqrt();
        let (r_t, v_t) = elements(ahead).to_state(MU).unwrap();
        let (r_c, v_c) = elements(0.0).to_state(MU).unwrap();
        let model = J2RelativeMotion {
            mu: MU,
            r_ref: astro::earth::FILTER.r_ref,
            j2: astro::earth::FILTER.j[0],
        };
        let lvlh = Lvlh::new(&r_t, &v_t, &astro::earth::FILTER.acceleration(&r_t));
        let (rho, rho_dot) = lvlh.relative(&r_c, &v_c);
        let mut x = SVector::<f64, 12>::zeros();
        x.fixed_rows_mut::<3>(0).copy_from(&rho);
        x.fixed_rows_mut::<3>(3).copy_from(&rho_dot);
        x.fixed_rows_mut::<6>(6)
            .copy_from(&TargetOrbit::from_state(&r_t, &v_t).to_vector());
        let mut world = Self {
            model,
            x,
            g: stream(11, run, Source::Metrology),
            k: 0,
        };
        let first = world.measured();
        (world, first.fixed_resize(0.0))
    }

    fn measured(&mut self) -> Vector6<f64> {
        let sigma = Vector6::from_fn(|i, _| if i < 3 { 1e-2 } else { 1e-4 });
        self.x.fixed_rows::<6>(0) + sigma.component_mul(&Vector6::from_fn(|_, _| StandardNormal.sample(&mut self.g)))
    }

    fn orbit(&self) -> TargetOrbit {
        TargetOrbit::from_vector(&self.x.fixed_rows::<6>(6).into_owned())
    }
}

impl World for Formation {
    fn step(&mut self) -> Sample {
        let model = self.model;
        self.x = rk4::step(0.0, &self.x, 1.0, |_, y| model.rate(y));
        self.k += 1;
        let mut sample = Sample {
            target_orbit: self.orbit(),
            ..Sample::blank(self.k, f64::from(self.k))
        };
        sample[Sensor::Metrology] = Reading::of(self.measured().as_slice());
        sample
    }

    fn truth(&self) -> SVector<f64, 9> {
        let part = |i: usize| self.x.fixed_rows::<3>(i).into_owned();
        let (rho, rho_dot) = (part(0), part(3));
        let circular = ClohessyWiltshire::from_semi_major_axis(SEMI_MAJOR_AXIS, MU);
        let d = self.model.acceleration(&self.orbit(), &rho, &rho_dot) - circular.acceleration(&rho, &rho_dot);
        let mut x = SVector::<f64, 9>::zeros();
        for (i, of) in [rho, rho_dot, d].iter().enumerate() {
            x.fixed_rows_mut::<3>(3 * i).copy_from(of);
        }
        x
    }
}
