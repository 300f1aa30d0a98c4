//! The truth of a run so far, and which of its samples an estimate belongs to.

use std::collections::HashMap;

use crate::readers::Tag;
use crate::samples::{SAME_TIME, TruthSample};
use crate::signals::Signals;
use crate::spec::Spec;

/// The truth at every sample of a run so far, for filters that answer late.
pub(crate) struct History {
    /// By epoch; where sensors have periods of their own, not every epoch has a sample.
    samples: Vec<Option<TruthSample>>,
    /// Epoch of each ordinal.
    epochs: HashMap<i32, usize>,
    /// Ordinal of the newest sample.
    pub(crate) newest: i32,
    /// Its time, s.
    pub(crate) time: f64,
    sample_period: f64,
    /// Longest time from one sample to the next, s.
    longest: f64,
    signals: &'static Signals,
}

impl History {
    pub(crate) fn new(spec: &Spec) -> Self {
        Self {
            samples: vec![None; spec.epochs()],
            epochs: HashMap::with_capacity(spec.epochs()),
            newest: 0,
            time: 0.0,
            sample_period: spec.sample_period,
            longest: spec.sample_period,
            signals: spec.world.frame.signals(),
        }
    }

    /// Keeps a sample taken at a communication point, and says to which epoch it belongs.
    pub(crate) fn push(&mut self, now: f64, sample: TruthSample) -> Result<(), String> {
        let TruthSample { count, time, .. } = sample;
        let ordinal = self.ordinal(time);
        if (time - f64::from(ordinal) * self.sample_period).abs() > SAME_TIME {
            return Err(format!(
                "truth tags sample {count} with {time} s, which is no whole multiple of the sample period of {} s",
                self.sample_period
            ));
        }
        if (time - now).abs() > SAME_TIME {
            return Err(format!(
                "truth took sample {count} at {time} s, between communication points (now {now} s), where its state is unknown; choose --step so that samples fall on them"
            ));
        }
        if let Some(what) = sample.first_not_finite(self.signals) {
            return Err(format!("{what} at sample {count} ({time} s) of the truth"));
        }
        let epoch = usize::try_from(ordinal - 1).ok();
        let slot = epoch.and_then(|epoch| Some((epoch, self.samples.get_mut(epoch)?)));
        let (epoch, slot) = slot.ok_or_else(|| format!("truth took sample {count} at {time} s, outside the run"))?;
        *slot = Some(TruthSample { epoch, ..sample });
        self.newest = i32::try_from(count).unwrap_or(i32::MAX);
        self.epochs.insert(self.newest, epoch);
        self.longest = self.longest.max(time - self.time);
        self.time = time;
        Ok(())
    }

    /// What is wrong with a truth that has stopped sampling before the end of a run, s: no pause in it was anywhere as long.
    pub(crate) fn stalled(&self, end: f64) -> Option<String> {
        const PAUSES: f64 = 10.0;
        let silent = end - self.time;
        (self.newest == 0 || silent > PAUSES * self.longest).then(|| {
            let Self { newest, time, .. } = self;
            format!("the truth stopped sampling: sample_count stayed at {newest} from {time} s to the end at {end} s")
        })
    }

    /// Names of what is compared.
    pub(crate) fn signals(&self) -> &'static Signals {
        self.signals
    }

    /// Number of samples so far.
    pub(crate) fn taken(&self) -> u64 {
        self.samples.iter().flatten().count() as u64
    }

    /// Sample periods until a time, to the nearest.
    fn ordinal(&self, time: f64) -> i32 {
        (time / self.sample_period).round() as i32
    }

    /// The truth that an estimate is to be compared with; `None` before the first sample.
    ///
    /// * `handed`: ordinal of the newest sample the filter has been given, for one that tags nothing itself.
    pub(crate) fn tagged(&self, tag: &Tag, handed: i32) -> Result<Option<&TruthSample>, String> {
        let (name, epoch) = match (tag.count, tag.time) {
            (None, Some(time)) => {
                let ordinal = self.ordinal(time);
                (ordinal, usize::try_from(ordinal - 1).ok())
            }
            (count, _) => {
                let count = count.unwrap_or(handed);
                (count, self.epochs.get(&count).copied())
            }
        };
        if name <= 0 {
            return Ok(None);
        }
        let sample = epoch.and_then(|epoch| self.samples.get(epoch)?.as_ref());
        let sample =
            sample.ok_or_else(|| format!("estimate is tagged with sample {name}, which has not been handed over"))?;
        match tag.time {
            Some(time) if (time - sample.time).abs() > SAME_TIME => Err(format!(
                "estimate is tagged with sample {name} and {time} s, but that sample was taken at {} s",
                sample.time
            )),
            _ => Ok(Some(sample)),
        }
    }
}
