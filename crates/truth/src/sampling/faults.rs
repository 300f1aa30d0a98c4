//! Dropouts, outliers and the limits of sight, which the sensors of the target share.

use interface::mission;
use nalgebra::Vector3;
use numerics::Generator;
use numerics::streams::{Source, named_stream, stream};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::overrides::Run;

/// What can go wrong with the samples of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Faults {
    max_range: f64,
    dropout_probability: f64,
    outlier_probability: f64,
    outlier_scale: f64,
    dropout: Generator,
    outlier: Generator,
}

/// What went wrong with a sample.
pub(super) struct Fault {
    /// Nothing was received.
    pub dropped: bool,
    /// By how much the noise is larger.
    pub scale: f64,
}

impl Faults {
    /// * `plain`: whether the sensor has the streams without a name, as the only sensor of the target in the papers' missions
    ///   does; any other has streams of its own, so that no two share their faults.
    pub(super) fn new(of: mission::Faults, run: &Run, name: &str, plain: bool) -> Self {
        let generator = |source| {
            if plain {
                stream(run.study_seed, run.run, source)
            } else {
                named_stream(run.study_seed, run.run, source, name)
            }
        };
        Self {
            max_range: of.max_range_m,
            dropout_probability: of.dropout_probability,
            outlier_probability: of.outlier_probability,
            outlier_scale: of.outlier_scale,
            dropout: generator(Source::Dropout),
            outlier: generator(Source::Outlier),
        }
    }

    /// Draws what goes wrong with the next sample.
    ///
    /// * `range`: distance of the target, m.
    pub(super) fn draw(&mut self, range: f64) -> Fault {
        let dropped = self.dropout.random::<f64>() < self.dropout_probability;
        let outlier = self.outlier.random::<f64>() < self.outlier_probability;
        Fault {
            dropped: dropped || range > self.max_range,
            scale: if outlier { self.outlier_scale } else { 1.0 },
        }
    }
}

/// A square field of view in front of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct View {
    /// Tangent of half of its width.
    reach: f64,
}

impl View {
    /// * `width`: full, rad, below pi.
    pub(super) fn of_width(width: f64) -> Self {
        Self {
            reach: (0.5 * width).tan(),
        }
    }

    /// Whether a target lies in it.
    ///
    /// * `rho_l`: target relative to the sensor, axes L (boresight z), m.
    pub(super) fn holds(&self, rho_l: &Vector3<f64>) -> bool {
        let reach = rho_l.z * self.reach;
        rho_l.z > 0.0 && rho_l.x.abs() <= reach && rho_l.y.abs() <= reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_is_a_square_in_front() {
        let view = View::of_width(5.0_f64.to_radians());
        let at = |x_deg: f64, y_deg: f64, z: f64| {
            let place = Vector3::new(x_deg.to_radians().tan() * z, y_deg.to_radians().tan() * z, z);
            view.holds(&place)
        };
        assert!(at(0.0, 0.0, 10.0) && at(2.49, -2.49, 10.0));
        assert!(!at(2.51, 0.0, 10.0) && !at(0.0, -2.51, 10.0));
        assert!(!at(0.0, 0.0, -10.0), "behind the sensor");
        assert!(!view.holds(&Vector3::zeros()) && !view.holds(&Vector3::repeat(f64::NAN)));
    }
}
