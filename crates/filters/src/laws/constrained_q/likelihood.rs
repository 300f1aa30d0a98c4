//! The density read off a bank of white accelerations: weights that maximise what the members have explained, and the entropy,
//! within bounds on the geometric mean of the density.
//!
//! Every member gathers log-likelihoods L, which fade within minutes. At each sample [`programme`] finds the weights, and what is
//! reported is the mixture under them. A second sum fades within half a minute: it stands in for the first while it clearly says
//! something else, so that neither a vent after a long quiet nor the quiet after it has to outweigh minutes of evidence. When the
//! solver does not solve, or only almost does, the last weights stay and the case is counted.

use numerics::math;

use super::programme::{self, Bounds, MEMBERS, PerMember};
use crate::error::FilterError;
use crate::laws::adaptation::Setup;
use crate::laws::bank::{Bank, Centre, LogLikelihoods, Mixture, Shared};
use crate::laws::mmae::Decades;
use crate::tunable::{Bound, Kind, Start, Tunable};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

/// Square root of the acceleration density of the quietest member, m/s^1.5; each other is half a decade above the one before.
const QUIETEST: f64 = 1e-6;
/// How many times more the short memory must say, each for its length.
const TIMES: f64 = 3.0;
/// Least that it must say, as a logarithm of odds: about fifty to one.
const LEAST: f64 = 4.0;

const ROOT_DENSITY: &str = "m/s^1.5";

/// Tunable `q_min`.
pub(super) const Q_MIN: Tunable = Tunable {
    name: "q_min",
    about: "lower bound of q, the square root of the geometric mean of the acceleration density under the weights; 0 is none",
    kind: Kind::Real {
        start: Start::Fixed(0.0),
        unit: ROOT_DENSITY,
        bound: Bound::NonNegative,
    },
};

/// Tunable `q_max`.
pub(super) const Q_MAX: Tunable = Tunable {
    name: "q_max",
    about: "upper bound of q; above the loudest member, 0.1, it is none",
    kind: Kind::Real {
        start: Start::Fixed(1.0),
        unit: ROOT_DENSITY,
        bound: Bound::Positive,
    },
};

/// Tunable `long_memory`.
pub(super) const LONG_MEMORY: Tunable = Tunable {
    name: "long_memory",
    about: "time of measuring in which a log-likelihood has faded to 1/e",
    kind: Kind::Real {
        start: Start::Fixed(600.0),
        unit: "s",
        bound: Bound::Positive,
    },
};

/// Tunable `short_memory`.
pub(super) const SHORT_MEMORY: Tunable = Tunable {
    name: "short_memory",
    about: "the same of the sum that stands in when it says otherwise; equal to long_memory: there is none",
    kind: Kind::Real {
        start: Start::Fixed(30.0),
        unit: "s",
        bound: Bound::Positive,
    },
};

/// The bank; internal units.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ByLikelihood {
    centre: Centre,
    white: Decades,
    evidence: Evidence,
    /// Of the logarithm of the density.
    bounds: Bounds,
    weights: PerMember,
    unsolved: i32,
}

/// Log-likelihoods of each member as far as they are remembered.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Evidence {
    long: Fading,
    short: Fading,
    /// Whether the short one stands in.
    alert: bool,
    /// How often it has begun to.
    alerts: i32,
}

/// A sum that fades: L <- exp(-dt / memory) L + new.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Fading {
    memory: f64,
    /// Time that it covers, memory (1 - exp(-t / memory)).
    covered: f64,
    sum: PerMember,
}

impl Fading {
    fn new(memory: f64) -> Self {
        Self {
            memory,
            covered: 0.0,
            sum: [0.0; MEMBERS],
        }
    }

    fn gather(&mut self, dt: f64, new: &[f64]) {
        let keep = math::exp(-dt / self.memory);
        self.covered = self.covered * keep + self.memory * (1.0 - keep);
        for (sum, new) in self.sum.iter_mut().zip(new) {
            *sum = *sum * keep + new;
        }
    }

    /// The member that explains most.
    fn best(&self) -> usize {
        (1..MEMBERS).fold(0, |best, k| if self.sum[k] > self.sum[best] { k } else { best })
    }

    /// What it says for a member and against another, as a logarithm of odds.
    fn says(&self, member: usize, against: usize) -> f64 {
        self.sum[member] - self.sum[against]
    }
}

impl Evidence {
    fn new(long: f64, short: f64) -> Self {
        Self {
            long: Fading::new(long),
            short: Fading::new(short),
            alert: false,
            alerts: 0,
        }
    }

    fn gather(&mut self, dt: f64, new: &[f64]) {
        self.long.gather(dt, new);
        self.short.gather(dt, new);
        let (of_long, of_short) = (self.long.best(), self.short.best());
        let short = self.short.says(of_short, of_long);
        let long = self.long.says(of_long, of_short);
        let alert = short > LEAST && short / self.short.covered > TIMES * long / self.long.covered;
        self.alerts += i32::from(alert && !self.alert);
        self.alert = alert;
    }

    /// That which counts.
    fn get(&self) -> &PerMember {
        if self.alert { &self.short.sum } else { &self.long.sum }
    }
}

impl ByLikelihood {
    /// # Errors
    /// When a tunable is out of range, or the bounds leave no density.
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self, FilterError> {
        let t = &setup.tunables;
        let roots: PerMember = std::array::from_fn(|k| QUIETEST * math::powf(10.0, 0.5 * k as f64));
        let (q_min, q_max) = (t.real(Q_MIN.name)?, t.real(Q_MAX.name)?);
        let (long, short) = (t.real(LONG_MEMORY.name)?, t.real(SHORT_MEMORY.name)?);
        if short > long {
            let permitted = format!("at most {}.{} = {long} s", t.law, LONG_MEMORY.name);
            return Err(t.refused(SHORT_MEMORY.name, short, permitted));
        }
        if q_min >= q_max {
            let permitted = format!("less than {}.{} = {q_max}", t.law, Q_MAX.name);
            return Err(t.refused(Q_MIN.name, q_min, permitted));
        }
        if q_min >= roots[MEMBERS - 1] {
            let permitted = format!("less than {:.0e}, the loudest member", roots[MEMBERS - 1]);
            return Err(t.refused(Q_MIN.name, q_min, permitted));
        }
        if q_max <= roots[0] {
            let permitted = format!("greater than {:.0e}, the quietest member", roots[0]);
            return Err(t.refused(Q_MAX.name, q_max, permitted));
        }
        // The factor of a study of mistuning is on the bounds as it is on the members.
        let unit = setup.units.root_acceleration_density();
        let log = |q: f64| math::ln((q / unit).powi(2) * setup.off_nominal);
        let white = Decades::new(&roots, setup);
        let mut law = Self {
            centre: Centre::new(setup.r, 0.0),
            white,
            evidence: Evidence::new(long / setup.units.time, short / setup.units.time),
            bounds: Bounds {
                of: roots.map(log),
                low: log(q_min),
                high: log(q_max),
            },
            weights: [1.0 / MEMBERS as f64; MEMBERS],
            unsolved: 0,
        };
        law.weigh();
        law.centre = Centre::new(setup.r, law.density());
        Ok(law)
    }

    fn weigh(&mut self) {
        match programme::weights(self.evidence.get(), &self.bounds) {
            Ok(weights) => self.weights = weights,
            Err(_) => self.unsolved += 1,
        }
    }
}

impl Bank for ByLikelihood {
    fn centre(&self) -> &Centre {
        &self.centre
    }

    fn centre_mut(&mut self) -> &mut Centre {
        &mut self.centre
    }

    fn take(&mut self, shared: &Shared) {
        let mut likelihoods = LogLikelihoods::new();
        self.white.take(shared, &mut likelihoods);
        // Where nothing was measured all likelihoods are alike, and time passes.
        self.evidence.gather(shared.dt, &likelihoods);
        self.weigh();
    }

    fn mixture(&self) -> Mixture {
        self.white.mixture(&self.weights)
    }

    fn density(&self) -> f64 {
        self.white.density(&self.weights)
    }

    fn shift(&mut self, by: &Vector6<f64>) {
        self.white.shift(by);
    }

    fn decisions(&self) -> i32 {
        self.evidence.alerts
    }

    fn unsolved(&self) -> i32 {
        self.unsolved
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::set_up;
    use super::*;
    use crate::tunable::Value;

    fn law(changes: &[(&str, Value)]) -> Result<ByLikelihood, FilterError> {
        set_up(3, changes, ByLikelihood::new)
    }

    /// 1 + x + ... + x^(n - 1) for x = exp(-1 s / memory).
    fn series(memory: f64, n: i32) -> f64 {
        let x = (-1.0 / memory).exp();
        (1.0 - x.powi(n)) / (1.0 - x)
    }

    /// Half an hour for member 0, then evidence for member 8: the closed forms of both sums say when the short one stands in, and
    /// when the long one has followed.
    #[test]
    fn the_short_memory_stands_in_while_it_says_three_times_more() {
        let (before, quiet, loud) = (1800, 0.01, 0.5);
        let said = |memory: f64, m: i32| {
            let faded = (-f64::from(m) / memory).exp();
            loud * series(memory, m) - 8.0 * quiet * series(memory, before) * faded
        };
        let expected: Vec<bool> = (0..400)
            .map(|m| {
                let (short, long) = (said(30.0, m), -said(600.0, m));
                // From where the long one is for member 8 too, both are of one mind.
                let covered = |memory: f64| memory * (1.0 - (-f64::from(before + m) / memory).exp());
                long > 0.0 && short > 4.0 && short / covered(30.0) > 3.0 * long / covered(600.0)
            })
            .collect();
        let mut evidence = Evidence::new(600.0, 30.0);
        let against = std::array::from_fn::<f64, MEMBERS, _>(|k| -quiet * k as f64);
        let in_favour = std::array::from_fn::<f64, MEMBERS, _>(|k| if k == 8 { loud } else { 0.0 });
        (0..before).for_each(|_| evidence.gather(1.0, &against));
        assert!(!evidence.alert);
        for (m, expected) in (1..).zip(&expected[1..]) {
            evidence.gather(1.0, &in_favour);
            assert_eq!(evidence.alert, *expected, "{m} s");
            let counts = if *expected { &evidence.short } else { &evidence.long };
            assert!(std::ptr::eq(evidence.get(), &counts.sum));
        }
        assert_eq!(evidence.alerts, 1);
        assert!(expected[40] && !expected[399]);
    }

    /// Little evidence is no reason, however much more than none it is.
    #[test]
    fn the_short_memory_needs_odds_of_fifty() {
        for (odds, alert) in [(3.9, false), (4.1, true)] {
            let mut evidence = Evidence::new(600.0, 30.0);
            (evidence.long.covered, evidence.short.covered) = (600.0, 30.0);
            evidence.long.sum[3] = odds + 0.05;
            evidence.gather(
                0.0,
                &std::array::from_fn::<f64, MEMBERS, _>(|k| if k == 5 { odds } else { 0.0 }),
            );
            assert_eq!(evidence.alert, alert);
        }
    }

    /// In the first minute both sums are nearly the same data: evidence that is no more frequent than before is no news.
    #[test]
    fn what_both_memories_have_gathered_alike_is_no_alert() {
        let mut evidence = Evidence::new(600.0, 30.0);
        // For member 0 at first, then for member 8, at less than three times the rate that the whole minute speaks for member 0.
        for m in 0..60 {
            let new = std::array::from_fn::<f64, MEMBERS, _>(|k| match (k, m) {
                (0, ..40) => 1.0,
                (8, 40..) => 1.1,
                _ => 0.0,
            });
            evidence.gather(1.0, &new);
            assert!(!evidence.alert, "{m} s");
        }
        assert!(evidence.short.best() == 8 && evidence.short.says(8, 0) > LEAST);
        assert!(evidence.short.says(8, 0) / 30.0 > TIMES * evidence.long.says(0, 8) / 600.0);
    }

    #[test]
    fn the_geometric_mean_is_kept_within_its_bounds() {
        let mut free = law(&[]).unwrap();
        let mut between = law(&[("q_min", Value::Real(2e-5)), ("q_max", Value::Real(3e-3))]).unwrap();
        // Peaks at 1e-6, at 1e-4 and at 1e-1.
        for (peak, mean) in [(0.0, 2e-5), (4.0, 1e-4), (10.0, 3e-3)] {
            for law in [&mut free, &mut between] {
                law.evidence.long.sum = std::array::from_fn(|k| -50.0 * (k as f64 - peak).powi(2));
                law.weigh();
            }
            let q = |law: &ByLikelihood| (0.5 * law.bounds.mean(&law.weights)).exp();
            let found = q(&between);
            assert!((found / mean - 1.0).abs() < 1e-5, "{found}, not {mean}");
            let unbound = q(&free);
            assert!(
                (unbound / (1e-6 * 10_f64.powf(0.5 * peak)) - 1.0).abs() < 1e-5,
                "{unbound}"
            );
        }
        assert_eq!((free.unsolved, between.unsolved), (0, 0));
    }

    #[test]
    fn bounds_that_leave_no_density_are_refused() {
        for (q_min, q_max, named, says) in [
            (
                1e-3,
                1e-4,
                "constrained_q.q_min",
                "less than constrained_q.q_max = 0.0001",
            ),
            (
                1e-3,
                1e-3,
                "constrained_q.q_min",
                "less than constrained_q.q_max = 0.001",
            ),
            (0.5, 2.0, "constrained_q.q_min", "less than 1e-1, the loudest member"),
            (
                0.0,
                1e-6,
                "constrained_q.q_max",
                "greater than 1e-6, the quietest member",
            ),
        ] {
            match law(&[("q_min", Value::Real(q_min)), ("q_max", Value::Real(q_max))]) {
                Err(FilterError::OutOfRange { name, permitted, .. }) => {
                    assert_eq!((name.as_str(), permitted.as_str()), (named, says));
                }
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn a_programme_without_an_answer_keeps_the_last_weights_and_is_counted() {
        let mut ours = law(&[]).unwrap();
        ours.evidence.long.sum[2] = 7.0;
        ours.weigh();
        let before = ours.weights;
        ours.evidence.long.sum[2] = f64::NAN;
        ours.weigh();
        assert_eq!(
            (ours.weights.map(f64::to_bits), ours.unsolved),
            (before.map(f64::to_bits), 1)
        );
    }
}
