//! Which rows the sensors of the target have.

use crate::sample::Sample;
use crate::state::{MAX_ROWS, RowVector};
use interface::{Navigation, Sensor};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Places of the rows of a mission's sensors, one behind the other: the same at every epoch, whichever of them measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layout {
    /// First row of each sensor of [`Sensor::ALL`] that is on board.
    first: [Option<usize>; Sensor::COUNT],
    rows: usize,
}

impl Layout {
    /// The sensors of the target that a mission has.
    pub fn of(navigation: &Navigation) -> Self {
        let on_board: Vec<Sensor> = navigation.sensors.iter().map(|known| known.sensor).collect();
        Self::new(&on_board)
    }

    /// These sensors, in the order of [`Sensor::ALL`].
    pub fn new(sensors: &[Sensor]) -> Self {
        let mut layout = Self::default();
        for (place, sensor) in layout.first.iter_mut().zip(Sensor::ALL) {
            if sensors.contains(&sensor) {
                *place = Some(layout.rows);
                layout.rows += sensor.rows();
            }
        }
        layout
    }

    /// Rows of all of them.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Rows of one; `None` when it is not on board.
    pub fn of_sensor(&self, sensor: Sensor) -> Option<Range<usize>> {
        self.first[sensor as usize].map(|first| first..first + sensor.rows())
    }

    /// Whether any of them samples at this epoch.
    pub(crate) fn any_due(&self, sample: &Sample) -> bool {
        let due = |sensor: Sensor| self.of_sensor(sensor).is_some() && sample[sensor].is_due();
        Sensor::ALL.into_iter().any(due)
    }

    /// From the places of the mission's rows to those of all channels.
    pub(crate) fn to_channels(self, rows: &RowVector) -> RowVector {
        let mut channels = RowVector::zeros();
        for sensor in Sensor::ALL {
            if let Some(own) = self.of_sensor(sensor) {
                for (channel, row) in sensor.channels().zip(own) {
                    channels[channel] = rows[row];
                }
            }
        }
        channels
    }
}

/// Rows that were measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Measured([bool; MAX_ROWS]);

impl Measured {
    /// Adds rows.
    pub fn mark(&mut self, rows: Range<usize>) {
        self.0[rows].fill(true);
    }

    /// Whether a row was measured.
    pub fn has(&self, row: usize) -> bool {
        self.0.get(row).copied().unwrap_or_default()
    }

    /// How many were.
    pub fn count(&self) -> usize {
        self.0.iter().filter(|m| **m).count()
    }

    /// Whether none was.
    pub fn is_empty(&self) -> bool {
        self.count() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_channels() {
        let layout = Layout::new(&[Sensor::Camera, Sensor::Metrology]);
        assert_eq!(layout.rows(), 8);
        assert_eq!(layout.of_sensor(Sensor::Metrology), Some(2..8));
        assert_eq!(layout.of_sensor(Sensor::Lidar), None);
        assert_eq!(Sensor::Metrology.channels(), 7..13);
        let all = layout.to_channels(&RowVector::from_fn(|i, _| (i + 1) as f64));
        let expected = [0, 0, 0, 1, 2, 0, 0, 3, 4, 5, 6, 7, 8].map(f64::from);
        assert_eq!(all.as_slice()[..13], expected);
        let mut measured = Measured::default();
        assert!(measured.is_empty());
        measured.mark(2..4);
        assert!(measured.count() == 2 && measured.has(3) && !measured.has(4));
    }
}
