//! A sensor that sees the target, whichever: what it measures is told by the crate `sensors`, the rest is the same for all.

use interface::Sensor;
use interface::mission::{Frame, OnBoard};
use interface::signals::Seen;
use numerics::Generator;
use numerics::streams::{Source, named_stream, stream};
use sensors::{Rows, View, normal3};
use serde::{Deserialize, Serialize};

use super::faults::Faults;
use crate::overrides::Run;

/// The sensor with its generators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct OfTarget {
    pub(super) sensor: Sensor,
    /// Standard deviation of each row, SI and radians.
    sigma: Rows,
    /// `None` for one that looks everywhere.
    view: Option<View>,
    noise: Generator,
    faults: Faults,
}

impl OfTarget {
    pub(super) fn new(own: &OnBoard, run: &Run) -> Self {
        let sensor = own.sensor;
        let sigmas: Vec<f64> = (sensor.sigmas().iter().zip(&own.sigmas))
            .map(|(sigma, value)| sigma.quantity.to_si(*value))
            .collect();
        let mut sigma = Rows::zeros();
        for (row, value) in sigma.iter_mut().zip(sensor.by_row(&sigmas)) {
            *row = value;
        }
        let (seed, number) = (run.study_seed, run.run);
        Self {
            sensor,
            sigma,
            view: own.field_of_view_deg.map(|deg| View::of_width(deg.to_radians())),
            noise: match sensor {
                // The streams of the papers' missions; every other sensor's goes by its name.
                Sensor::Lidar => stream(seed, number, Source::Lidar),
                Sensor::Metrology => stream(seed, number, Source::Metrology),
                _ => named_stream(seed, number, Source::SensorNoise, sensor.name()),
            },
            faults: Faults::new(own.faults, run, sensor.name(), is_the_papers(sensor, run)),
        }
    }

    /// Takes a sample. Each draws the same numbers, whatever becomes of it.
    pub(super) fn sample(&mut self, seen: &mut Seen, scene: &sensors::Scene) {
        let mut unit = Rows::zeros();
        for first in (0..self.sensor.rows()).step_by(3) {
            let drawn = normal3(&mut self.noise);
            for (row, value) in unit.iter_mut().skip(first).zip(&drawn) {
                *row = *value;
            }
        }
        let fault = self.faults.draw(scene.r_tc_n.norm());
        let truth = sensors::of(self.sensor).measure(scene);
        let in_view = |view: &View| view.holds(&(scene.dcm_l_n * scene.r_tc_n));
        seen.due = true;
        seen.valid = !fault.dropped && self.view.as_ref().is_none_or(in_view) && truth.iter().all(|z| z.is_finite());
        if seen.valid {
            seen.z = (truth + unit.component_mul(&self.sigma) * fault.scale).into();
        }
    }
}

/// Whether this is the only sensor of the target in the papers' missions, which has the streams of faults without a name.
fn is_the_papers(sensor: Sensor, run: &Run) -> bool {
    match sensor {
        Sensor::Lidar => true,
        Sensor::Metrology => run.mission.navigation.frame == Frame::Lvlh,
        _ => false,
    }
}
