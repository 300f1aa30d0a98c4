//! What the chaser is commanded to do, where a filter is told of it.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Times this close are one, s.
const SAME: f64 = 1e-6;

/// Most changes that are kept between two samples; where more come, the oldest become their mean.
const MOST: usize = 4096;

/// A command as it stands over a communication step, SI, axes N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Command {
    /// Acceleration of the chaser, m/s2.
    pub a_cmd_c_n: Vector3<f64>,
    /// Change of its velocity, m/s, made at once when `impulse_count` changes.
    pub impulse_c_n: Vector3<f64>,
    /// Ordinal of that change.
    pub impulse_count: i32,
}

/// The commands since the last sample, and before it those that the next reading of an accelerometer holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Commands {
    /// When each acceleration begins, s, and what it is, m/s2; in order, each until the next one begins.
    accelerations: Vec<(f64, Vector3<f64>)>,
    /// When each impulse was given, s, and what it is, m/s; in order.
    impulses: Vec<(f64, Vector3<f64>)>,
    count: i32,
}

impl Commands {
    /// Counting of impulses begins here.
    pub(crate) fn begin(count: i32) -> Self {
        Self {
            count,
            ..Self::default()
        }
    }

    /// Takes the command of a step that begins at `t_s`.
    pub(crate) fn take(&mut self, t_s: f64, command: &Command) {
        if command.impulse_count != self.count {
            self.count = command.impulse_count;
            self.impulses.push((t_s, command.impulse_c_n));
        }
        let a = command.a_cmd_c_n;
        match self.accelerations.last_mut() {
            None if a == Vector3::zeros() => (),
            Some((_, last)) if *last == a => (),
            Some((from, last)) if t_s - *from < SAME => *last = a,
            _ => self.accelerations.push((t_s, a)),
        }
        if let [(first, a), (second, b), (third, _), ..] = self.accelerations[..]
            && self.accelerations.len() > MOST
        {
            let mean = (a * (second - first) + b * (third - second)) / (third - first);
            self.accelerations.remove(1);
            self.accelerations[0].1 = mean;
        }
        if self.impulses.len() > MOST {
            let (_, oldest) = self.impulses.remove(0);
            self.impulses[0].1 += oldest;
        }
    }

    /// Forgets what ended before `t_s`.
    pub(crate) fn forget_before(&mut self, t_s: f64) {
        // The one that acts at that time began before it.
        let passed = self
            .accelerations
            .iter()
            .filter(|(from, _)| *from <= t_s + SAME)
            .count();
        self.accelerations.drain(..passed.saturating_sub(1));
        if let [(_, a)] = self.accelerations[..]
            && a == Vector3::zeros()
        {
            self.accelerations.clear();
        }
        self.impulses.retain(|(at, _)| *at > t_s - SAME);
    }

    /// Whether there is nothing to be told.
    pub(crate) fn is_silent(&self) -> bool {
        self.accelerations.is_empty() && self.impulses.is_empty()
    }

    /// Acceleration just after `t_s`, m/s2.
    pub(crate) fn at(&self, t_s: f64) -> Vector3<f64> {
        let begun = |(from, _): &&(f64, Vector3<f64>)| *from <= t_s;
        self.accelerations
            .iter()
            .rev()
            .find(begun)
            .map_or_else(Vector3::zeros, |(_, a)| *a)
    }

    /// Mean acceleration over an interval, m/s2; over one without length, that just before it.
    pub(crate) fn mean(&self, from_s: f64, to_s: f64) -> Vector3<f64> {
        if to_s - from_s < SAME {
            return self.at(to_s - SAME);
        }
        let mut sum = Vector3::zeros();
        for (k, (begin, a)) in self.accelerations.iter().enumerate() {
            let end = self.accelerations.get(k + 1).map_or(to_s, |(next, _)| next.min(to_s));
            sum += a * (end - begin.max(from_s)).max(0.0);
        }
        sum / (to_s - from_s)
    }

    /// Change of velocity over an interval, by acceleration and impulses, its begin included and its end not, m/s.
    pub(crate) fn gained(&self, from_s: f64, to_s: f64) -> Vector3<f64> {
        self.mean(from_s, to_s) * (to_s - from_s) + self.impulse(from_s, to_s)
    }

    /// Times after `from_s`, within the `length_s` that follow, at which a command changes, s.
    pub(crate) fn edges(&self, from_s: f64, length_s: f64) -> impl Iterator<Item = f64> {
        let all = self.accelerations.iter().chain(&self.impulses);
        all.map(move |(at, _)| at - from_s)
            .filter(move |edge| *edge > SAME && *edge < length_s - SAME)
    }

    /// Impulses given within an interval, its begin included and its end not, m/s.
    pub(crate) fn impulse(&self, from_s: f64, to_s: f64) -> Vector3<f64> {
        let within = |(at, _): &&(f64, Vector3<f64>)| *at > from_s - SAME && *at < to_s - SAME;
        self.impulses.iter().filter(within).map(|(_, dv)| dv).sum()
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "halves and whole numbers are exact")]
mod tests {
    use super::*;

    fn push(x: f64) -> Command {
        Command {
            a_cmd_c_n: Vector3::new(x, 0.0, 0.0),
            ..Command::default()
        }
    }

    fn fire(count: i32, x: f64) -> Command {
        Command {
            impulse_c_n: Vector3::new(x, 0.0, 0.0),
            impulse_count: count,
            ..Command::default()
        }
    }

    #[test]
    fn commands_act_until_the_next_one() {
        let mut commands = Commands::begin(0);
        for (t, x) in [(0.0, 0.0), (1.0, 2.0), (1.25, 2.0), (1.5, -1.0), (3.0, 0.0)] {
            commands.take(t, &push(x));
        }
        let at = |t| commands.at(t).x;
        assert_eq!(
            [0.5, 1.0, 1.49, 1.5, 2.9, 3.0, 9.0].map(at),
            [0.0, 2.0, 2.0, -1.0, -1.0, 0.0, 0.0]
        );
        // Half a second of 2 and one and a half of -1 in four; the left limit at an edge.
        assert!((commands.mean(0.0, 4.0).x - -0.125).abs() < 1e-15);
        assert!((commands.mean(1.25, 1.75).x - 0.5).abs() < 1e-15);
        assert_eq!([1.0, 1.5, 3.0].map(|t| commands.mean(t, t).x), [0.0, 2.0, -1.0]);
        assert_eq!(commands.edges(1.0, 2.0).collect::<Vec<_>>(), [0.5]);
        commands.forget_before(1.6);
        assert_eq!([1.6, 3.5].map(|t| commands.at(t).x), [-1.0, 0.0]);
        commands.forget_before(5.0);
        assert!(commands.is_silent());
    }

    #[test]
    fn an_impulse_counts_once_from_where_counting_began() {
        let mut commands = Commands::begin(4);
        for (t, count) in [(0.0, 4), (0.5, 5), (0.75, 5), (1.0, 6), (1.25, 5)] {
            commands.take(t, &fire(count, 1.0));
        }
        // The begin of an interval belongs to it, its end to the next.
        let given = |from, to| commands.impulse(from, to).x;
        assert_eq!(
            [given(0.0, 0.5), given(0.5, 1.0), given(1.0, 2.0), given(0.0, 9.0)],
            [0.0, 1.0, 2.0, 3.0]
        );
        assert_eq!(commands.edges(0.0, 1.0).collect::<Vec<_>>(), [0.5]);
        commands.forget_before(1.0);
        assert_eq!(commands.impulse(0.0, 9.0).x.to_bits(), 2.0_f64.to_bits());
    }

    /// What was commanded is not lost where it changes too often to be kept.
    #[test]
    fn many_changes_keep_their_momentum_and_little_memory() {
        let (mut commands, mut sum) = (Commands::begin(0), 0.0);
        for k in 0..3 * MOST {
            let x = ((k * 7919) % 13) as f64 - 6.0;
            commands.take(
                0.1 * k as f64,
                &Command {
                    impulse_count: k as i32,
                    ..push(x)
                },
            );
            sum += 0.1 * x;
        }
        let end = 0.1 * (3 * MOST) as f64;
        assert!((commands.mean(0.0, end).x * end - sum).abs() < 1e-9 * sum.abs().max(1.0));
        assert!(commands.accelerations.len() <= MOST && commands.impulses.len() <= MOST);
    }
}
