//! Scheduled pushes: what acts when, beside gravity.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Accelerations, beside gravity, that act over one interval of the time grid, m/s2.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Push {
    /// On the target, fixed in its body axes (they turn with the state).
    pub target_bt: Vector3<f64>,
    /// On the target, axes N.
    pub target_n: Vector3<f64>,
    /// On the chaser, axes N.
    pub chaser_n: Vector3<f64>,
}

impl std::ops::Add for Push {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            target_bt: self.target_bt + other.target_bt,
            target_n: self.target_n + other.target_n,
            chaser_n: self.chaser_n + other.chaser_n,
        }
    }
}

/// One push with its time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Begin, s since the start of the run.
    pub start: f64,
    /// Length, s.
    pub duration: f64,
    /// What it does while it acts.
    pub push: Push,
}

impl Event {
    /// Whether the event acts at `t`, s since the start of the run; its last instant is excluded.
    pub fn acts_at(&self, t: f64) -> bool {
        self.start <= t && t < self.start + self.duration
    }
}

/// All events of a run, in any order; they add where they overlap.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Timeline {
    /// The events.
    pub events: Vec<Event>,
}

impl Timeline {
    /// What acts over the grid interval around `midpoint`, s since the start of the run.
    ///
    /// An event acts over whole intervals, those whose midpoint it contains: exact for events on the grid, rounded to it for
    /// others.
    pub fn push_around(&self, midpoint: f64) -> Push {
        self.events
            .iter()
            .filter(|event| event.acts_at(midpoint))
            .fold(Push::default(), |sum, event| sum + event.push)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_round_to_whole_intervals_and_add() {
        let event = |start, duration, x| Event {
            start,
            duration,
            push: Push {
                target_n: Vector3::new(x, 0.0, 0.0),
                ..Push::default()
            },
        };
        let timeline = Timeline {
            events: vec![event(2.0, 2.0, 1.0), event(2.6, 2.0, 10.0), event(7.6, 0.3, 100.0)],
        };
        let acting: Vec<f64> = (0..9)
            .map(|k| timeline.push_around(f64::from(k) + 0.5).target_n.x)
            .collect();
        // The second event covers the midpoints 3.5 and 4.5, the third none.
        assert_eq!(acting, [0.0, 0.0, 1.0, 11.0, 10.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
