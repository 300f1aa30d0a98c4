//! When changes have come so far, and when the next is due.
//!
//! Vents come by a clock that nobody tells the filter. Each pair of changes that were found, a time T apart, speaks for another
//! one T after any of them; what was expected in this way and did not come speaks against it. So the chance of a change a lag
//! after one that was found is (pairs with this lag) / (1 + changes after which it could have come).

use arrayvec::ArrayVec;
use numerics::math;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Changes that are remembered; the oldest go.
const MOST: usize = 16;
/// Changes closer than this are one event, s.
const ONE: f64 = 60.0;
/// Chance of a change against each pair.
const DOUBT: f64 = 1.0;
/// Deviations beyond which a lag is another one.
const SAME: f64 = 4.0;

/// Times at which changes were found.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Schedule {
    events: ArrayVec<Event, MOST>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Event {
    /// s.
    at: f64,
    /// s^2.
    variance: f64,
    /// Probability that there was one.
    weight: f64,
}

impl Schedule {
    /// A change was found.
    ///
    /// * `at`: its time, s; `variance`: of that, s^2; `weight`: probability that there was one.
    pub(super) fn learn(&mut self, at: f64, variance: f64, weight: f64) {
        if let Some(last) = self.events.last_mut().filter(|last| (at - last.at).abs() < ONE) {
            last.weight = (last.weight + weight).min(1.0);
            return;
        }
        if self.events.len() == MOST {
            self.events.remove(0);
        }
        self.events.push(Event { at, variance, weight });
    }

    /// Number of changes that it expects within a short time.
    ///
    /// * `at`: the middle of it, s; `length`: s.
    /// * `seen`: age from which on a change has certainly been found, s.
    pub(super) fn expected(&self, at: f64, length: f64, seen: f64) -> f64 {
        let most = self
            .events
            .iter()
            .map(|event| self.after(event, at, length, seen))
            .fold(0.0, f64::max);
        most.min(1.0)
    }

    /// The same, after one of the events alone.
    fn after(&self, event: &Event, at: f64, length: f64, seen: f64) -> f64 {
        let lag = at - event.at;
        let (mut pairs, mut density) = (0.0, 0.0);
        for (i, later) in self.events.iter().enumerate() {
            for earlier in &self.events[..i] {
                let variance = event.variance + later.variance + earlier.variance + length * length / 6.0;
                let off = lag - (later.at - earlier.at);
                if off * off < SAME * SAME * variance {
                    let weight = later.weight * earlier.weight * math::exp(-off * off / (2.0 * variance));
                    pairs += weight;
                    density += weight / (TAU * variance).sqrt();
                }
            }
        }
        if pairs == 0.0 {
            return 0.0;
        }
        let could = self.events.iter().filter(|e| e.at < event.at - seen);
        let exposed: f64 = could.map(|e| e.weight).sum();
        event.weight * density * length / (DOUBT + exposed.max(pairs))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(times: &[f64]) -> Schedule {
        let mut schedule = Schedule::default();
        times.iter().for_each(|at| schedule.learn(*at, 4.0, 1.0));
        schedule
    }

    #[test]
    fn what_comes_by_a_clock_is_expected_when_it_is_due() {
        let expected = |times: &[f64], at: f64| after(times).expected(at, 5.0, 320.0);
        assert_eq!(expected(&[100.0], 700.0).to_bits(), 0.0_f64.to_bits());
        let (twice, often) = (
            expected(&[100.0, 700.0], 1300.0),
            expected(&[100.0, 700.0, 1300.0, 1900.0], 2500.0),
        );
        // One pair against one doubt, then three: of a normal density of variance 3 * 4 + 25 / 6, over 5 s.
        let peak = 5.0 / (TAU * (12.0 + 25.0 / 6.0)).sqrt();
        assert!((twice - 0.5 * peak).abs() < 1e-12, "{twice}");
        assert!((often - 0.75 * peak).abs() < 1e-12, "{often}");
        assert!(expected(&[100.0, 700.0], 1000.0) < 1e-12);
    }

    #[test]
    fn what_was_due_and_did_not_come_is_expected_less() {
        // After 1300 the clock is kept, or misses a beat.
        let kept = after(&[100.0, 700.0, 1300.0, 1900.0]).expected(2500.0, 5.0, 320.0);
        let missed = after(&[100.0, 700.0, 1300.0]).expected(2500.0, 5.0, 320.0);
        // Lag 1200: once after 100, not after 700.
        assert!((missed / kept - (1.0 / 3.0) / 0.75).abs() < 1e-9, "{missed} {kept}");
    }

    #[test]
    fn it_forgets_and_counts_what_is_close_once() {
        let times: Vec<f64> = (0..100).map(|k| 30.0 * f64::from(k)).collect();
        let schedule = after(&times);
        assert_eq!(schedule.events.len(), MOST);
        assert!(schedule.events.windows(2).all(|pair| pair[1].at - pair[0].at >= ONE));
    }
}
