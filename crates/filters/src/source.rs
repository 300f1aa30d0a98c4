//! What comes from the source of samples: the next one, one that was here before, a count that begins again, or nothing for too long.

use crate::sample::Sample;
use interface::Navigation;
use serde::{Deserialize, Serialize};

/// Periods without a new sample after which an estimate is stale.
const PATIENCE: f64 = 3.0;

/// What a sample is to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// Nothing new: the one looked at last, or one that is older.
    Known,
    /// A new ordinal, and an epoch that is not beyond the last.
    Duplicate,
    /// The next.
    New,
}

/// The samples so far, and how long none has come.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Source {
    /// Ordinal of the sample looked at last; 0 before the first.
    count: i32,
    /// Epoch of the last one used, s; `None` before the first.
    time: Option<f64>,
    /// The longest of the sensors' periods, s.
    longest: f64,
    /// Time between the last two samples, s.
    spacing: f64,
    /// Communication time since the last sample, s.
    waited: f64,
    duplicates: i32,
    restarts: i32,
}

impl Source {
    /// * `told`: the mission, for the periods of its sensors.
    pub(crate) fn new(told: &Navigation) -> Self {
        let periods = told.sensors.iter().map(|sensor| sensor.period_s);
        let all = periods.chain(told.accelerometer.map(|sensor| sensor.period_s));
        Self {
            count: 0,
            time: None,
            longest: all.fold(0.0, f64::max),
            spacing: 0.0,
            waited: 0.0,
            duplicates: 0,
            restarts: 0,
        }
    }

    /// What a sample is to those before it.
    ///
    /// A source that begins to count again is known by an ordinal below the last one with an epoch beyond it. The ordinal of the last
    /// one is that sample, whatever its time: a filter acts once for each new count, and times may move in between, as where a master
    /// interpolates Reals or a source stamps what it holds anew. So a source that begins again with the very ordinal that was last, as
    /// one does that had said no more than its first, is heard from its next one on, and its beginning is not counted.
    pub(crate) fn arrival(&self, sample: &Sample) -> Arrival {
        let beyond = self.time.is_none_or(|last| sample.time > last);
        let lower = sample.count < self.count;
        if sample.count <= 0 || sample.count == self.count || (lower && !beyond) {
            Arrival::Known
        } else if beyond || sample.time.is_nan() {
            Arrival::New
        } else {
            Arrival::Duplicate
        }
    }

    /// Takes note of one that is passed by as [`Arrival::Duplicate`].
    pub(crate) fn pass_by(&mut self, sample: &Sample) {
        self.count = sample.count;
        self.duplicates += 1;
    }

    /// Takes note of one that is used.
    pub(crate) fn take(&mut self, sample: &Sample) {
        self.restarts += i32::from(sample.count < self.count);
        self.count = sample.count;
        self.spacing = self.time.map_or(0.0, |last| sample.time - last);
        self.time = Some(sample.time);
        self.waited = 0.0;
    }

    /// Lets communication time pass that has brought no new sample, s.
    pub(crate) fn waits(&mut self, length_s: f64) {
        self.waited += length_s;
    }

    /// Whether a sample is overdue: none for three times the longest period, or the last spacing where that is longer.
    ///
    /// Time is counted from the step that brought the last one, whatever its epoch: a master may hand over late, and may take steps
    /// that are longer than a period.
    pub(crate) fn is_stale(&self) -> bool {
        self.time.is_some() && self.waited > PATIENCE * self.longest.max(self.spacing) + 1e-9 * self.waited
    }

    /// Samples of an epoch that was here before.
    pub(crate) fn duplicates(&self) -> i32 {
        self.duplicates
    }

    /// How often a count began again.
    pub(crate) fn restarts(&self) -> i32 {
        self.restarts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Arrival::{Duplicate, Known, New};

    fn source(mission: &str) -> Source {
        let mission = interface::mission::embedded(mission).unwrap();
        Source::new(&mission.mission().unwrap().navigation())
    }

    /// Does with a sample what a filter does.
    fn arrives(source: &mut Source, count: i32, time: f64) -> Arrival {
        let sample = Sample::blank(count, time);
        let arrival = source.arrival(&sample);
        match arrival {
            Known => (),
            Duplicate => source.pass_by(&sample),
            New => source.take(&sample),
        }
        arrival
    }

    /// One after the other: ordinal, epoch, and what the sample is.
    fn arrive(source: &mut Source, samples: &[(i32, f64, Arrival)]) {
        for (count, time, arrival) in samples {
            assert_eq!(arrives(source, *count, *time), *arrival, "{count} at {time} s");
        }
    }

    #[test]
    fn ordinals_and_epochs_tell_what_a_sample_is() {
        let mut source = source("leo_venting");
        let samples = [
            (0, 0.0, Known),
            (1, 1.0, New),
            (1, 1.0, Known),
            (2, 2.0, New),
            // One that is handed over again, and the same.
            (3, 2.0, Duplicate),
            (3, 2.0, Known),
            (4, 1.5, Duplicate),
            // Old values again: no new sequence.
            (2, 2.0, Known),
            (5, 3.0, New),
            // The source begins anew.
            (1, 4.0, New),
            (1, 4.0, Known),
            (2, 5.0, New),
        ];
        arrive(&mut source, &samples);
        assert_eq!((source.duplicates(), source.restarts()), (2, 1));
    }

    #[test]
    fn the_last_ordinal_is_the_last_sample_whatever_its_time() {
        let mut source = source("leo_venting");
        let samples = [
            (1, 1.0, New),
            // A source that begins again with the ordinal that was last cannot be told from times that move.
            (1, 1.5, Known),
            (1, 0.5, Known),
            (1, 10.0, Known),
            // It is heard from its next.
            (2, 11.0, New),
            (3, 12.0, New),
            (2, 20.0, New),
        ];
        arrive(&mut source, &samples);
        assert_eq!((source.duplicates(), source.restarts()), (0, 1));
    }

    /// Steps of any length, handed over at once or one step late, of a source of one second, and of one that is sampled more rarely.
    #[test]
    fn a_source_that_goes_on_is_never_stale() {
        for step in [0.1, 0.25, 1.0, 2.0, 10.0, 40.0] {
            for late in [0.0, 1.0] {
                let mut source = source("leo_venting");
                for k in 1..=1000 {
                    let epoch = ((f64::from(k) - late) * step + 1e-9).floor();
                    if arrives(&mut source, epoch as i32, epoch) == Known {
                        source.waits(step);
                    }
                    assert!(!source.is_stale(), "steps of {step} s, {k}");
                }
            }
        }
    }

    #[test]
    fn a_source_that_stalls_is_stale_after_three_periods() {
        for (period, step) in [(1.0, 0.25), (1.0, 1.0), (60.0, 1.0), (60.0, 7.0)] {
            let mut source = source("leo_venting");
            source.longest = period;
            assert_eq!(arrives(&mut source, 1, 1.0), New);
            let mut waited = 0.0;
            while !source.is_stale() {
                source.waits(step);
                waited += step;
            }
            assert!(
                waited > 3.0 * period && waited - step <= 3.0 * period,
                "{period} {step}: {waited}"
            );
            assert_eq!(arrives(&mut source, 2, 500.0), New);
            assert!(!source.is_stale());
        }
        let mut source = source("leo_venting");
        source.waits(1e3);
        assert!(!source.is_stale(), "before the first sample it is initialising");
    }
}
