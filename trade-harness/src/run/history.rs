//! The truth of a run so far, and which of its samples an estimate belongs to.

use super::{SAME_TIME, Spec};
use crate::signals::{Tag, TruthSample};

/// The truth at every sample of a run so far, for filters that answer late.
pub(super) struct History {
    samples: Vec<Option<TruthSample>>,
    /// Ordinal of the newest sample.
    pub(super) newest: i32,
    /// Its epoch, s.
    pub(super) time: f64,
    sample_period: f64,
}

impl History {
    pub(super) fn new(spec: &Spec) -> Self {
        Self {
            samples: vec![None; spec.epochs()],
            newest: 0,
            time: 0.0,
            sample_period: spec.sample_period,
        }
    }

    /// Keeps a sample taken at a communication point.
    pub(super) fn push(&mut self, spec: &Spec, now: f64, sample: TruthSample) -> Result<(), String> {
        let TruthSample { count, time, .. } = sample;
        let expected = f64::from(count) * spec.sample_period;
        if (time - expected).abs() > SAME_TIME {
            return Err(format!(
                "truth tags sample {count} with {time} s, expected {expected} s at a sample period of {} s",
                spec.sample_period
            ));
        }
        if (time - now).abs() > SAME_TIME {
            return Err(format!(
                "truth took sample {count} at {time} s, between communication points (now {now} s), where its state is unknown; choose --step so that samples fall on them"
            ));
        }
        let slot = self.samples.get_mut(count as usize - 1);
        *slot.ok_or_else(|| format!("truth counts {count} samples, more than fit the run"))? = Some(sample);
        self.newest = i32::try_from(count).unwrap_or(i32::MAX);
        self.time = time;
        Ok(())
    }

    /// The truth that an estimate is to be compared with; `None` before the first sample.
    ///
    /// * `handed`: ordinal of the newest sample the filter has been given, for one that tags nothing itself.
    pub(super) fn tagged(&self, tag: &Tag, handed: i32) -> Result<Option<&TruthSample>, String> {
        let by_time = || tag.time.map(|t| (t / self.sample_period).round() as i32);
        let count = tag.count.or_else(by_time).unwrap_or(handed);
        if count <= 0 {
            return Ok(None);
        }
        let sample = self.samples.get(count as usize - 1).and_then(Option::as_ref);
        let sample =
            sample.ok_or_else(|| format!("estimate is tagged with sample {count}, which has not been handed over"))?;
        match tag.time {
            Some(time) if (time - sample.time).abs() > SAME_TIME => Err(format!(
                "estimate is tagged with sample {count} and {time} s, but that sample was taken at {} s",
                sample.time
            )),
            _ => Ok(Some(sample)),
        }
    }
}
