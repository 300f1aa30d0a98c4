//! Where the time of a run goes.

use std::time::Duration;

use crate::clock;

/// One step of so many is timed.
const BLOCK: u64 = 16;

/// Time that one slave has taken while the run was stepping: CPU time of the thread that steps, on Unix; what a slave sleeps,
/// waits or computes on other threads is not in it. Elsewhere it is time on the wall, since no clock of a thread is fine enough.
///
/// Reading the clock of a thread costs more than many a call that it would measure, so one step in each 16 is timed, drawn among them,
/// with the callback after it, and multiplied to the number of steps that the slave has taken; what reading takes is subtracted. The
/// first step, in which memory is cold, counts like the others but is itself timed only for runs that have no other.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SlaveTiming {
    /// Its name.
    pub name: String,
    /// Handing over inputs.
    pub set: Duration,
    /// Stepping.
    pub step: Duration,
    /// Fetching outputs, and reading samples.
    pub get: Duration,
}

/// What is timed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Part {
    Set,
    Step,
    Get,
}

/// What was timed of one slave.
#[derive(Debug, Clone, Default)]
struct Laps {
    /// By [`Part`], with what reading the clock took.
    spent: [Duration; 3],
    /// How many intervals that is.
    intervals: [u32; 3],
    /// Steps begun, timed or not.
    begun: u32,
    /// Those that were timed.
    timed: u32,
}

/// Takes the time of slaves at some steps of a run. While it is off it only asks whether it is.
#[derive(Debug)]
pub(crate) struct Meter {
    on: bool,
    now: fn() -> Duration,
    /// Whether the present step is timed, with the callback after it.
    running: bool,
    /// End of the interval before, with which the next one begins.
    last: Option<Duration>,
    /// Steps begun.
    begun: u64,
    /// What an empty interval takes.
    empty: Duration,
    laps: Vec<Laps>,
}

impl Meter {
    /// * `count`: of slaves.
    pub(crate) fn new(on: bool, count: usize) -> Self {
        Self::by(clock::now, on, count)
    }

    /// * `now`: the clock.
    fn by(now: fn() -> Duration, on: bool, count: usize) -> Self {
        Self {
            on,
            now,
            running: false,
            last: None,
            begun: 0,
            empty: if on { empty_interval(now) } else { Duration::ZERO },
            laps: vec![Laps::default(); count],
        }
    }

    /// A step begins.
    pub(crate) fn next_step(&mut self) {
        if !self.on {
            return;
        }
        let step = self.begun;
        self.begun += 1;
        (self.running, self.last) = (is_timed(step), None);
        if step == 1 {
            // There is a better one than the first.
            for laps in &mut self.laps {
                (laps.spent, laps.intervals, laps.timed) = Default::default();
            }
        }
    }

    /// Runs `action` of slave `i`, right after the one before.
    pub(crate) fn take<T>(&mut self, i: usize, part: Part, action: impl FnOnce() -> T) -> T {
        if !self.on {
            return action();
        }
        let laps = &mut self.laps[i];
        if let Part::Step = part {
            // A mean of so many will do for more.
            laps.begun = laps.begun.saturating_add(1);
            laps.timed += u32::from(self.running);
        }
        if !self.running {
            return action();
        }
        let begin = self.last.unwrap_or_else(self.now);
        let result = action();
        let end = (self.now)();
        laps.spent[part as usize] += end.saturating_sub(begin);
        laps.intervals[part as usize] += 1;
        self.last = Some(end);
        result
    }

    /// The same for what the callback asks for, which works in between.
    pub(crate) fn take_apart<T>(&mut self, i: usize, part: Part, action: impl FnOnce() -> T) -> T {
        self.last = None;
        self.take(i, part, action)
    }

    /// By slave, in the order of their `names`; empty if it was off.
    pub(crate) fn finish<'a>(self, names: impl Iterator<Item = &'a str>) -> Vec<SlaveTiming> {
        if !self.on {
            return Vec::new();
        }
        let timing = |(name, laps): (&str, Laps)| {
            let [set, step, get] = std::array::from_fn(|part| {
                // The sum less the sum: of one interval each by itself, what is below 0 would be lost and what is above not.
                let spent = laps.spent[part].saturating_sub(self.empty.saturating_mul(laps.intervals[part]));
                spent.saturating_mul(laps.begun) / laps.timed.max(1)
            });
            SlaveTiming {
                name: name.to_owned(),
                set,
                step,
                get,
            }
        };
        names.zip(self.laps).map(timing).collect()
    }
}

/// Whether step `k`, from 0, is timed: the first two, then one in each block. Its place in the block is drawn, by a hash of the
/// block's number, so that work which comes in every n-th step, for whatever n, is met as often as it comes.
fn is_timed(k: u64) -> bool {
    let Some(after) = k.checked_sub(1) else { return true };
    let (block, place) = (after / BLOCK, after % BLOCK);
    let mixed = block.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 32)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    mixed >> (u64::BITS - BLOCK.ilog2()) == place
}

/// What the clock says of nothing: the median, since a thread is interrupted now and then.
fn empty_interval(now: fn() -> Duration) -> Duration {
    let mut intervals: [Duration; 31] = std::array::from_fn(|_| {
        let begin = now();
        now().saturating_sub(begin)
    });
    intervals.sort_unstable();
    intervals[intervals.len() / 2]
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn one_step_in_sixteen_is_timed_and_the_first_two() {
        assert!(is_timed(0) && is_timed(1));
        for block in 0..1000 {
            let first = 1 + block * BLOCK;
            assert_eq!((first..first + BLOCK).filter(|k| is_timed(*k)).count(), 1, "{block}");
        }
    }

    /// A filter that gets a sample at every n-th step works there and nowhere else.
    #[test]
    fn work_at_every_nth_step_is_met_as_often_as_it_comes() {
        let timed: Vec<u64> = (1..1_600_000).filter(|k| is_timed(*k)).collect();
        for n in 2..=64 {
            let mut met = vec![0_u32; n];
            timed.iter().for_each(|k| met[*k as usize % n] += 1);
            let expected = timed.len() as f64 / n as f64;
            // Five sigma of a fair draw.
            let bound = 5.0 * expected.sqrt();
            let even = met.iter().all(|met| (f64::from(*met) - expected).abs() < bound);
            assert!(even, "every {n}: {expected} times each, met {met:?}");
        }
    }

    thread_local! {
        static NOW: Cell<Duration> = const { Cell::new(Duration::ZERO) };
    }

    fn pass(microseconds: u64) {
        NOW.set(NOW.get() + Duration::from_micros(microseconds));
    }

    /// A clock that takes 5 us to read.
    fn slow_clock() -> Duration {
        pass(5);
        NOW.get()
    }

    #[test]
    fn what_was_timed_stands_for_all_steps_but_the_first_only_where_it_is_alone() {
        let run = |steps: u64| {
            let mut meter = Meter::by(slow_clock, true, 2);
            for k in 0..steps {
                meter.next_step();
                meter.take(0, Part::Set, || pass(2));
                meter.take(0, Part::Step, || pass(if k == 0 { 1000 } else { 30 }));
                if k == 0 {
                    meter.take(1, Part::Step, || pass(1));
                }
                meter.take(0, Part::Get, || pass(1));
                for _ in 0..2 {
                    pass(100);
                    meter.take_apart(0, Part::Get, || pass(1));
                }
                pass(100);
            }
            let timings = meter.finish(["one", "left"].into_iter());
            timings
                .into_iter()
                .map(|t| (t.name, [t.set, t.step, t.get].map(|d| d.as_micros())))
        };
        let timing = |name: &str, parts: [u128; 3]| (name.to_owned(), parts);
        let left = timing("left", [0, 0, 0]);
        assert!(run(0).eq([timing("one", [0, 0, 0]), left.clone()]));
        assert!(run(1).eq([timing("one", [2, 1000, 3]), timing("left", [0, 1, 0])]));
        assert!(run(2).eq([timing("one", [4, 60, 6]), left.clone()]));
        assert!(run(1000).eq([timing("one", [2000, 30_000, 3000]), left]));
        assert!(
            Meter::by(slow_clock, false, 2)
                .finish(["one", "left"].into_iter())
                .is_empty()
        );
    }
}
