//! Weights of the members of a bank from what each has explained, within bounds on what they stand for on average.

use super::conic::{self, Almost, NoAnswer};
use crate::laws::bank::reweigh;
use arrayvec::ArrayVec;
use clarabel::solver::{ExponentialConeT, NonnegativeConeT, SupportedConeT, ZeroConeT};
use serde::{Deserialize, Serialize};

/// Members of the bank.
pub(super) const MEMBERS: usize = 11;
/// Unknowns of the programme: a weight w and a share t <= -w ln w of the entropy for each member.
const UNKNOWNS: usize = 2 * MEMBERS;

/// Cones at most: the sum of the weights, two bounds, and one for each member.
const CONES: usize = 3 + MEMBERS;
/// Rows at most, three for each member.
const ROWS: usize = 3 + 3 * MEMBERS;

/// One number for each member.
pub(super) type PerMember = [f64; MEMBERS];

/// Bounds of the mean of a quantity under the weights; infinite where there is none.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Bounds {
    /// The quantity, one for each member.
    pub of: PerMember,
    /// Least mean.
    pub low: f64,
    /// Largest mean.
    pub high: f64,
}

impl Bounds {
    /// The mean under these weights.
    pub(super) fn mean(&self, weights: &PerMember) -> f64 {
        self.of.iter().zip(weights).map(|(of, w)| of * w).sum()
    }
}

/// The weights on the simplex that maximise sum w L - sum w ln w with the mean within its bounds: the softmax of L where that is
/// within, else the answer of the cone programme.
///
/// * `evidence`: L, log-likelihoods.
///
/// # Errors
/// See [`NoAnswer`].
pub(super) fn weights(evidence: &PerMember, bounds: &Bounds) -> Result<PerMember, NoAnswer> {
    let free = softmax(evidence);
    if !free.iter().all(|w| w.is_finite()) {
        return Err(None);
    }
    if (bounds.low..=bounds.high).contains(&bounds.mean(&free)) {
        Ok(free)
    } else {
        by_cones(evidence, bounds)
    }
}

/// exp(L) over its sum: the maximum over the whole simplex.
fn softmax(evidence: &PerMember) -> PerMember {
    let mut weights = [1.0; MEMBERS];
    reweigh(&mut weights, evidence, 0.0);
    weights
}

/// The same as a programme over exponential cones, (t, w, 1) with w exp(t / w) <= 1 for each member.
///
/// # Errors
/// See [`NoAnswer`].
fn by_cones(evidence: &PerMember, bounds: &Bounds) -> Result<PerMember, NoAnswer> {
    let most = evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let over_weights =
        |f: &dyn Fn(usize) -> f64| std::array::from_fn::<f64, UNKNOWNS, _>(|k| if k < MEMBERS { f(k) } else { 0.0 });
    let minus_unit = |at: usize| std::array::from_fn::<f64, UNKNOWNS, _>(|k| if k == at { -1.0 } else { 0.0 });
    let linear = std::array::from_fn(|k| if k < MEMBERS { most - evidence[k] } else { -1.0 });
    let mut rows = ArrayVec::<[f64; UNKNOWNS], ROWS>::new();
    let mut limits = ArrayVec::<f64, ROWS>::new();
    let mut cones = ArrayVec::<SupportedConeT<f64>, CONES>::new();
    rows.push(over_weights(&|_| 1.0));
    limits.push(1.0);
    cones.push(ZeroConeT(1));
    for (sign, limit) in [(-1.0, -bounds.low), (1.0, bounds.high)] {
        if limit.is_finite() {
            rows.push(over_weights(&|k| sign * bounds.of[k]));
            limits.push(limit);
            cones.push(NonnegativeConeT(1));
        }
    }
    for member in 0..MEMBERS {
        rows.extend([minus_unit(MEMBERS + member), minus_unit(member), [0.0; UNKNOWNS]]);
        limits.extend([0.0, 0.0, 1.0]);
        cones.push(ExponentialConeT());
    }
    let answer = conic::solve(
        &[[0.0; UNKNOWNS]; UNKNOWNS],
        &linear,
        &rows,
        &limits,
        &cones,
        Almost::Refused,
    )?;
    let positive: PerMember = std::array::from_fn(|k| answer[k].max(0.0));
    let sum: f64 = positive.iter().sum();
    Ok(positive.map(|w| w / sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the size that half decades of a density have.
    fn bounds(low: f64, high: f64) -> Bounds {
        Bounds {
            of: std::array::from_fn(|k| -27.6 + 2.3 * k as f64),
            low,
            high,
        }
    }

    /// Evidence that peaks at a member and falls off to either side, as a bank's does, and some without any order.
    fn evidences() -> Vec<PerMember> {
        let mut all: Vec<PerMember> = Vec::new();
        for steepness in [0.0, 0.1, 3.0, 300.0, 1e4] {
            for peak in [0.0, 4.3, 10.0] {
                all.push(std::array::from_fn(|k| -5e3 - steepness * (k as f64 - peak).powi(2)));
            }
            all.push(std::array::from_fn(|k| steepness * ((7 * k + 3) % 11) as f64));
        }
        all
    }

    fn far(a: &PerMember, b: &PerMember) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// The solver's gap of 1e-8 is one of the cost, which is flat of second order in the weights.
    const TOLERANCE: f64 = 2e-4;

    #[test]
    fn weights_are_in_proportion_to_the_likelihoods_where_no_bound_acts() {
        let doubling = std::array::from_fn(|k| 2_f64.powi(k as i32).ln() - 1e4);
        let expected = std::array::from_fn(|k| 2_f64.powi(k as i32) / 2047.0);
        let none = bounds(f64::NEG_INFINITY, f64::INFINITY);
        assert!(far(&weights(&doubling, &none).unwrap(), &expected) < 1e-12);
    }

    #[test]
    fn the_programme_is_the_softmax_where_no_bound_acts() {
        for evidence in evidences() {
            for (low, high) in [(f64::NEG_INFINITY, f64::INFINITY), (-30.0, f64::INFINITY), (-30.0, 0.0)] {
                let ours = by_cones(&evidence, &bounds(low, high)).unwrap();
                assert!(far(&ours, &softmax(&evidence)) < TOLERANCE, "{evidence:?}: {ours:?}");
            }
        }
    }

    /// Where a bound acts the weights are proportional to exp(L + l ln q), l the multiplier of the bound: found by bisection.
    fn by_bisection(evidence: &PerMember, bounds: &Bounds, mean: f64) -> PerMember {
        let tilted = |l: f64| softmax(&std::array::from_fn(|k| evidence[k] + l * bounds.of[k]));
        let (mut low, mut high) = (-1e6, 1e6);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if bounds.mean(&tilted(middle)) < mean {
                low = middle;
            } else {
                high = middle;
            }
        }
        tilted(low)
    }

    #[test]
    fn where_a_bound_acts_the_programme_is_the_tilted_softmax() {
        let mut acted = [0, 0];
        for evidence in evidences() {
            for bound in [-27.0, -20.0, -13.0, -5.1] {
                for (side, bounds) in [bounds(bound, f64::INFINITY), bounds(-40.0, bound)]
                    .into_iter()
                    .enumerate()
                {
                    let free = bounds.mean(&softmax(&evidence));
                    if (bounds.low..=bounds.high).contains(&free) {
                        continue;
                    }
                    acted[side] += 1;
                    let ours = weights(&evidence, &bounds).unwrap();
                    let expected = by_bisection(&evidence, &bounds, bound);
                    let off = (bounds.mean(&ours) - bound).abs();
                    assert!(off < 1e-5, "{evidence:?}: the mean is off its bound by {off}");
                    assert!(
                        far(&ours, &expected) < TOLERANCE,
                        "{evidence:?}, {bound}: {ours:?} and {expected:?}"
                    );
                }
            }
        }
        assert!(acted[0] > 20 && acted[1] > 20, "{acted:?}");
    }

    #[test]
    fn evidence_without_sense_has_no_answer() {
        let none = bounds(f64::NEG_INFINITY, f64::INFINITY);
        assert!(weights(&[f64::NAN; MEMBERS], &none).is_err());
        assert!(weights(&[f64::NEG_INFINITY; MEMBERS], &none).is_err());
        // Nobody stands for as much.
        assert!(weights(&[0.0; MEMBERS], &bounds(1.0, f64::INFINITY)).is_err());
    }
}
