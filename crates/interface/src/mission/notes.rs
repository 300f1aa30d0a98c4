//! What a user should know of a mission that is legal and yet asks for trouble.

use super::{AccelerometerOutput, Attitude, Axes, Mission, Which};

/// Times this close are one, s.
const SAME: f64 = 1e-6;

impl Mission {
    /// Notes for the log and for a study's report; empty for a mission without pitfalls.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let period = |own: Option<f64>| own.unwrap_or(self.time.sample_period_s);
        let Some(accelerometer) = &self.sensors.accelerometer else {
            if self.burns.iter().any(|b| b.vehicle == Which::Chaser && !b.told) {
                notes.push(
                    "the chaser burns, has no accelerometer and does not tell the filter: give [sensors.accelerometer] or told = true"
                        .to_owned(),
                );
            }
            return notes;
        };
        let held = period(accelerometer.period_s);
        let on_grid = |t: f64| (t - (t / held).round() * held).abs() <= SAME;
        let target = self.sensors.of_the_target();
        let fastest = target.map(|s| period(s.period_s)).fold(f64::INFINITY, f64::min);
        if accelerometer.output == AccelerometerOutput::Instantaneous {
            for burn in self
                .burns
                .iter()
                .filter(|b| b.vehicle == Which::Chaser && b.duration_s > 0.0)
            {
                let turns = matches!(burn.axes, Axes::Body | Axes::Rtn);
                let spin = match self.chaser.attitude {
                    Attitude::SpinDegS([x, y, z]) => (x * x + y * y + z * z).sqrt(),
                    _ => 0.0,
                };
                if !on_grid(burn.start_s) || !on_grid(burn.start_s + burn.duration_s) {
                    notes.push(format!(
                        "instantaneous accelerometer samples every {held} s are held over the edges of burn {:?} ({} s to {} s): the \
                         filter will be wrong without knowing; use output = \"mean\"",
                        burn.name,
                        burn.start_s,
                        burn.start_s + burn.duration_s
                    ));
                } else if turns && (held > 5.0 || spin * held > 0.5) {
                    notes.push(format!(
                        "instantaneous accelerometer samples are held for {held} s while burn {:?} turns with the vehicle; use output = \
                         \"mean\"",
                        burn.name
                    ));
                }
            }
        } else if held > fastest + SAME {
            notes.push(format!(
                "mean accelerometer readings come every {held} s, slower than a sensor of the target every {fastest} s: between them the \
                 filter holds the last one"
            ));
        }
        notes
    }
}
