//! The radial-basis network that learns an unmodelled acceleration (Pesce, Silvestrini and Lavagna, Sec. II.A); SI.

use super::adaptation::Setup;
use super::entry::Search;
use crate::disturbance::Disturbance;
use crate::error::FilterError;
use crate::tunable::{Bound, Kind, Scales, Start, Tunable};
use nalgebra::{SMatrix, Vector3, Vector6};
use numerics::{Source, math, stream};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// Inputs of the network: relative position and velocity.
const INPUTS: usize = 6;

/// The tunables that every law with a network declares, before its own.
const TUNABLES: [Tunable; 9] = [
    Tunable {
        name: "neurons",
        about: "neurons of the hidden layer",
        kind: Kind::Integer {
            start: 60,
            min: 1,
            max: 2000,
        },
    },
    Tunable {
        name: "shape",
        about: "sharpness of the Gaussians, eta of Eq. (3), over the scaled inputs",
        kind: real(Start::Fixed(0.06), "1", Bound::Positive),
    },
    Tunable {
        name: "learning_rate",
        about: "eta / xi of Eq. (17): acceleration per velocity error and second",
        kind: real(Start::Derived(|_| 0.165), "1/s2", Bound::NonNegative),
    },
    Tunable {
        name: "gain_limit",
        about: "most of a velocity error that one step of learning turns into acceleration over the interval; beyond some tenths the loop of network and filter is unstable, at long intervals or with few neurons",
        kind: real(Start::Fixed(0.05), "1", Bound::Positive),
    },
    Tunable {
        name: "relaxation",
        about: "factor on the weights at each step, psi of Eq. (18)",
        kind: real(Start::Derived(relaxation), "1", Bound::Fraction),
    },
    Tunable {
        name: "start_weights",
        about: "standard deviation of the random weights at the start",
        kind: real(Start::Fixed(1e-6), "m/s2", Bound::NonNegative),
    },
    Tunable {
        name: "error",
        about: "what is learnt from where velocity is measured: the innovation, or the residual after the update",
        kind: Kind::Choice {
            type_name: "LearningError",
            about: "error of velocity from which a network learns",
            items: &[
                ("innovation", "measured minus predicted, before the update"),
                ("residual", "measured minus estimated, after it"),
            ],
        },
    },
    Tunable {
        name: "scale_position",
        about: "position that makes an input of one; the centres lie between -1 and 1",
        kind: real(Start::Derived(input_scale), "m", Bound::Positive),
    },
    Tunable {
        name: "scale_velocity",
        about: "velocity that makes an input of one",
        kind: real(
            Start::Derived(|scales| input_scale(scales) / ORBITAL_TIME),
            "m/s",
            Bound::Positive,
        ),
    },
];

/// Inverse rate of a low orbit, s: relative motion covers its own size in about this time.
const ORBITAL_TIME: f64 = 1000.0;

/// What was learnt fades in five times the disturbance's own length, so that it outlives one and does not stay.
fn relaxation(scales: &Scales) -> f64 {
    math::exp(-scales.period / (5.0 * scales.time))
}

/// A hundred initial deviations: the network then sees all of an approach that starts about as far away as it is known.
fn input_scale(scales: &Scales) -> f64 {
    100.0 * scales.position
}

/// The network's tunables and then a law's `own`; ALL is the number of both.
pub(super) const fn with<const OWN: usize, const ALL: usize>(own: [Tunable; OWN]) -> [Tunable; ALL] {
    assert!(
        ALL == TUNABLES.len() + OWN,
        "ALL counts the tunables of network and law"
    );
    let mut all = [TUNABLES[0]; ALL];
    let mut i = 0;
    while i < ALL {
        all[i] = if i < TUNABLES.len() {
            TUNABLES[i]
        } else {
            own[i - TUNABLES.len()]
        };
        i += 1;
    }
    all
}

/// How a search varies the learning rate.
pub(super) const SEARCH_LEARNING_RATE: Search = Search {
    tunable: "learning_rate",
    low: 1e-4,
    high: 1.0,
    only_with: None,
};

/// How a search varies the shape.
pub(super) const SEARCH_SHAPE: Search = Search {
    tunable: "shape",
    low: 1e-3,
    high: 1.0,
    only_with: None,
};

const fn real(start: Start, unit: &'static str, bound: Bound) -> Kind {
    Kind::Real { start, unit, bound }
}

/// A normalised radial-basis network with six inputs and three outputs.
///
/// `d(x) = W^T Phi(x)`, Eq. (6), with `Phi_i = exp(-shape |u - c_i|^2)` over its sum, Eqs. (3) and (4), and u the scaled
/// input. Nothing is allocated once it is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Network {
    shape: f64,
    relaxation: f64,
    /// Per input: what makes it one.
    scale: Vector6<f64>,
    centres: Vec<Vector6<f64>>,
    weights: Vec<Vector3<f64>>,
    /// The normalised basis where it was evaluated last.
    phi: Vec<f64>,
}

impl Network {
    /// A network with centres uniform in [-1, 1]^6 and normal start weights, both random by run.
    ///
    /// # Errors
    /// When a tunable is out of range.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        let neurons = t.integer("neurons")? as usize;
        let start_weights = t.real("start_weights")?;
        let (position, velocity) = (t.real("scale_position")?, t.real("scale_velocity")?);
        let mut generator = stream(setup.study_seed, setup.run, Source::NetworkCentres);
        let centres = (0..neurons)
            .map(|_| Vector6::from_fn(|_, _| generator.random_range(-1.0..1.0)))
            .collect();
        let weights = (0..neurons)
            .map(|_| {
                Vector3::from_fn(|_, _| {
                    let w: f64 = StandardNormal.sample(&mut generator);
                    start_weights * w
                })
            })
            .collect();
        Ok(Self {
            shape: t.real("shape")?,
            relaxation: t.real("relaxation")?,
            scale: Vector6::from_fn(|i, _| if i < 3 { position } else { velocity }),
            centres,
            weights,
            phi: vec![0.0; neurons],
        })
    }

    /// Output at `x` and its partials, those of the normaliser included, Eq. (28); keeps the basis for [`Network::learn`].
    ///
    /// * `x`: relative position, m, and velocity, m/s.
    /// * returns: m/s2; 1/s2 and 1/s.
    pub fn evaluate(&mut self, x: &Vector6<f64>) -> Disturbance {
        let u = x.component_div(&self.scale);
        let mut least = f64::INFINITY;
        for (phi, centre) in self.phi.iter_mut().zip(&self.centres) {
            *phi = self.shape * (u - centre).norm_squared();
            least = least.min(*phi);
        }
        // The smallest exponent cancels between Phi and its sum, and without it both vanish far from all centres.
        let mut sum = 0.0;
        for phi in &mut self.phi {
            *phi = math::exp(least - *phi);
            sum += *phi;
        }
        let mut d = Vector3::zeros();
        let mut centre_mean = Vector6::zeros();
        let mut weighted = SMatrix::<f64, 3, INPUTS>::zeros();
        for ((phi, centre), weight) in self.phi.iter_mut().zip(&self.centres).zip(&self.weights) {
            *phi /= sum;
            let part = weight * *phi;
            d += part;
            centre_mean += centre * *phi;
            weighted += part * centre.transpose();
        }
        // dPhi_i/du = 2 shape Phi_i (c_i - sum_j Phi_j c_j).
        let by_u = (weighted - d * centre_mean.transpose()) * (2.0 * self.shape);
        Disturbance {
            d,
            by_x: SMatrix::from_fn(|i, j| by_u[(i, j)] / self.scale[j]),
        }
    }

    /// Sum of the squares of the normalised basis where it was evaluated last: what one unit of `delta` moves the output by.
    pub fn response(&self) -> f64 {
        self.phi.iter().map(|phi| phi * phi).sum()
    }

    /// Eq. (18): W+ = psi W + Phi delta^T with the basis of the last [`Network::evaluate`].
    ///
    /// * `delta`: interval times learning rate times velocity error, m/s2.
    pub fn learn(&mut self, delta: &Vector3<f64>) {
        for (weight, phi) in self.weights.iter_mut().zip(&self.phi) {
            *weight = *weight * self.relaxation + delta * *phi;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn network(shape: f64) -> Network {
        let mut g = stream(3, 0, Source::NetworkCentres);
        let mut uniform = || g.random_range(-1.0..1.0);
        let neurons = 17;
        Network {
            shape,
            relaxation: 0.9,
            scale: Vector6::new(10.0, 10.0, 10.0, 2e-3, 2e-3, 2e-3),
            centres: (0..neurons).map(|_| Vector6::from_fn(|_, _| uniform())).collect(),
            weights: (0..neurons).map(|_| Vector3::from_fn(|_, _| uniform())).collect(),
            phi: vec![0.0; neurons],
        }
    }

    const AT: [f64; 6] = [3.0, -12.0, 4.0, 1e-3, -3e-3, 5e-4];

    /// Straight from Eqs. (3) to (6).
    fn by_definition(n: &Network, x: &Vector6<f64>) -> Vector3<f64> {
        let basis: Vec<f64> = n
            .centres
            .iter()
            .map(|c| (-n.shape * (x.component_div(&n.scale) - c).norm().powi(2)).exp())
            .collect();
        let sum: f64 = basis.iter().sum();
        n.weights.iter().zip(&basis).map(|(w, b)| w * (b / sum)).sum()
    }

    #[test]
    fn output_is_the_definition_and_partials_are_its_differences() {
        let x = Vector6::from(AT);
        for shape in [0.06, 0.7] {
            let mut n = network(shape);
            let out = n.evaluate(&x);
            assert!((out.d - by_definition(&n, &x)).amax() < 1e-14);
            for j in 0..6 {
                let mut step = Vector6::zeros();
                step[j] = 1e-5 * n.scale[j];
                let slope = (by_definition(&n, &(x + step)) - by_definition(&n, &(x - step))) / (2.0 * step[j]);
                // Central differences: truncation 1e-10 of the slope, rounding 1e-16 / 1e-5 in units of 1 / scale.
                let miss = (slope - out.by_x.column(j)).amax() * n.scale[j];
                assert!(miss < 1e-9, "shape {shape}, input {j}: {miss}");
            }
        }
    }

    #[test]
    fn far_from_all_centres_the_nearest_neuron_answers() {
        let mut n = network(1.0);
        let x = n.scale * 1e3;
        let out = n.evaluate(&x);
        let nearest = |c: &Vector6<f64>| (x.component_div(&n.scale) - c).norm_squared();
        let (_, expected) = n
            .centres
            .iter()
            .zip(&n.weights)
            .min_by(|(a, _), (b, _)| nearest(a).total_cmp(&nearest(b)))
            .unwrap();
        assert!((out.d - expected).amax() < 1e-12, "{}", out.d);
        assert!(out.by_x.iter().all(|v| v.is_finite()));
    }

    #[test]
    fn learning_moves_the_output_by_the_squared_basis() {
        let x = Vector6::from(AT);
        let mut n = network(0.3);
        let before = n.evaluate(&x).d;
        let squared = n.response();
        let delta = Vector3::new(0.1, -0.2, 0.3);
        n.learn(&delta);
        let expected = before * n.relaxation + delta * squared;
        assert!((n.evaluate(&x).d - expected).amax() < 1e-15);
    }
}
