//! Which file of this crate says what a sensor of the target measures.

use interface::Sensor;

use crate::of_target::OfTarget;

macro_rules! registry {
    ($($module:ident: $sensor:ident),+ $(,)?) => {
        /// What a sensor measures.
        pub fn of(sensor: Sensor) -> &'static dyn OfTarget {
            match sensor {
                $(Sensor::$sensor => &crate::$module::$sensor,)+
            }
        }
    };
}

registry! {
    camera: Camera,
    lidar: Lidar,
    metrology: Metrology,
    radio: Radio,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::of_target::Scene;
    use nalgebra::{Vector3, Vector6};

    /// Whatever a sensor is: its Jacobian is the derivative, and it has as many rows as the list says.
    #[test]
    fn every_jacobian_is_the_derivative_and_every_row_counts() {
        let scene = Scene {
            r_tc_n: Vector3::new(40.0, 300.0, -25.0),
            v_tc_n: Vector3::new(0.3, -0.8, 0.2),
            dcm_l_n: astro::frames::lidar_from_body(),
            lvlh: Vector6::new(30.0, -280.0, 55.0, 0.1, 0.7, -0.4),
        };
        for sensor in Sensor::ALL {
            let (model, rows) = (of(sensor), sensor.rows());
            let (z, h) = (model.measure(&scene), model.jacobian(&scene));
            assert!(
                z.iter().all(|v| v.is_finite()) && z.iter().skip(rows).all(|v| *v == 0.0),
                "{sensor:?}: {z}"
            );
            for state in 0..6 {
                let size = if state < 3 { 1e-2 } else { 1e-4 };
                let moved = |d: f64| {
                    let mut moved = scene;
                    if model.in_lvlh() {
                        moved.lvlh[state] += d;
                    } else if state < 3 {
                        moved.r_tc_n[state] += d;
                    } else {
                        moved.v_tc_n[state - 3] += d;
                    }
                    model.measure(&moved)
                };
                let slope = (moved(size) - moved(-size)) / (2.0 * size);
                // Rounding of 300 m over 1e-2 m; truncation (1e-2 / 300)^2.
                assert!(
                    (h.column(state) - slope).amax() < 1e-8,
                    "{sensor:?} {state}: {h} {slope}"
                );
            }
            for row in 0..Sensor::MOST_ROWS {
                assert_eq!(h.row(row).amax() > 0.0, row < rows, "{sensor:?}: row {row}");
            }
        }
    }
}
