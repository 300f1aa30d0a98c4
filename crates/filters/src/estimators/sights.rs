//! What the sensors of the target need to know of a filter in the inertial frame: noise and size of their rows, and the relative
//! state in the axes of the estimated target.

use crate::layout::Layout;
use crate::state::RowVector;
use crate::units::Units;
use astro::relative_axes::Reference;
use astro::{AstroError, RelativeAxes};
use interface::mission::Quantity;
use interface::{Navigation, Sensor};
use nalgebra::{Matrix6, Vector6};

/// Noise variances of every sensor of a mission, internal units, in the places of its layout.
pub(super) fn noise(told: &Navigation) -> RowVector {
    let layout = Layout::of(told);
    let si = si(&layout, &Units::of(&told.units));
    let mut r = RowVector::zeros();
    for known in &told.sensors {
        for (row, sigma) in layout
            .of_sensor(known.sensor)
            .into_iter()
            .flatten()
            .zip(known.deviations())
        {
            r[row] = (sigma / si[row]).powi(2);
        }
    }
    r
}

/// SI size of the rows of every sensor, in the places of a layout.
pub(super) fn si(layout: &Layout, units: &Units) -> RowVector {
    let mut si = RowVector::repeat(1.0);
    for sensor in Sensor::ALL {
        for (row, quantity) in layout.of_sensor(sensor).into_iter().flatten().zip(sensor.quantities()) {
            si[row] = match quantity {
                Quantity::Length => units.length,
                Quantity::Velocity => units.velocity(),
                Quantity::Angle => 1.0,
            };
        }
    }
    si
}

/// The relative state as a sensor in LVLH axes sees it, and its partials.
pub(super) struct InLvlh {
    /// rho, rho_dot.
    pub state: Vector6<f64>,
    /// By r_tc and v_tc, the axes held.
    pub by_relative: Matrix6<f64>,
    /// By the target's own position and velocity, on which the axes hang.
    pub by_target: Matrix6<f64>,
}

impl InLvlh {
    /// * `relative`, `target`: r_tc, v_tc and the target's own, internal units.
    /// * `axes`: the axes of a target at some state.
    ///
    /// # Errors
    /// When the target has no such axes.
    pub(super) fn new(
        relative: &Vector6<f64>,
        target: &Vector6<f64>,
        units: &Units,
        axes: impl Fn(&Vector6<f64>) -> Reference,
    ) -> Result<Self, AstroError> {
        let (state, by_relative) = in_axes(relative, &axes(target), units)?;
        let by_target = of_axes(target, units, |target| Ok(in_axes(relative, &axes(target), units)?.0))?;
        Ok(Self {
            state,
            by_relative,
            by_target,
        })
    }
}

/// The chaser from the target, in the LVLH axes of the estimated target, and its partials by r_tc and v_tc.
///
/// Linear in r_tc and v_tc, the axes held; [`of_axes`] has what hangs on the axes.
///
/// * `target`: where its axes stand, SI.
///
/// # Errors
/// When the target has no such axes.
fn in_axes(
    relative: &Vector6<f64>,
    target: &Reference,
    units: &Units,
) -> Result<(Vector6<f64>, Matrix6<f64>), AstroError> {
    let unit = Vector6::from_fn(|i, _| units.of_state(i));
    let seen = |x: &Vector6<f64>| -> Result<Vector6<f64>, AstroError> {
        let x = -x.component_mul(&unit);
        let part = |slot: usize| x.fixed_rows::<3>(slot).into_owned();
        let (rho, rho_dot) = target.from_n(RelativeAxes::Lvlh, &part(0), &part(3))?;
        Ok(sensors::metrology::measure(&rho, &rho_dot).component_div(&unit))
    };
    let mut h = Matrix6::zeros();
    for state in 0..6 {
        let mut one = Vector6::zeros();
        one[state] = 1.0;
        h.set_column(state, &seen(&one)?);
    }
    Ok((seen(relative)?, h))
}

/// Partials of the relative state in LVLH axes by the target's own position and velocity, which turn its axes: 0.05 m/s of a low orbit's
/// speed turn them by 7e-6 rad, which over a kilometre is as much as a metrology is good for.
///
/// By central differences, for what is seen is smooth over kilometres.
///
/// * `target`: its position and velocity, internal units.
/// * `seen`: the relative state in the axes of such a target.
///
/// # Errors
/// When the target has no such axes.
fn of_axes(
    target: &Vector6<f64>,
    units: &Units,
    seen: impl Fn(&Vector6<f64>) -> Result<Vector6<f64>, AstroError>,
) -> Result<Matrix6<f64>, AstroError> {
    let mut h = Matrix6::zeros();
    for state in 0..6 {
        // A hundred metres, a tenth of a metre per second: rounding of positions of 1e-9 m is then far below the slope.
        let size = if state < 3 { 100.0 } else { 0.1 } / units.of_state(state);
        let mut step = Vector6::zeros();
        step[state] = size;
        h.set_column(
            state,
            &((seen(&(target + step))? - seen(&(target - step))?) / (2.0 * size)),
        );
    }
    Ok(h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use astro::Cr3bpSystem;
    use astro::relative_axes::AxesN;
    use nalgebra::Vector3;

    fn slopes(x: &Vector6<f64>, seen: impl Fn(&Vector6<f64>) -> Vector6<f64>) -> Matrix6<f64> {
        let mut h = Matrix6::zeros();
        for state in 0..6 {
            let size = if state < 3 { 1e-2 } else { 1e-4 };
            let mut step = Vector6::zeros();
            step[state] = size;
            h.set_column(state, &((seen(&(x + step)) - seen(&(x - step))) / (2.0 * size)));
        }
        h
    }

    fn parts(x: &Vector6<f64>) -> (Vector3<f64>, Vector3<f64>) {
        (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned())
    }

    #[test]
    fn metrology_sees_what_the_axes_of_the_target_say() {
        let x = Vector6::new(30.0, -50.0, 20.0, 0.3, 0.1, -0.2);
        let system = Cr3bpSystem::EARTH_MOON;
        let unit = |i: usize| {
            if i < 3 {
                system.length
            } else {
                system.length / system.time
            }
        };
        let nd = Vector6::new(0.9879, 1.432e-2, 2.009e-3, 7.173e-2, 0.9238, -0.8528);
        let (r, v) = parts(&Vector6::from_fn(|i, _| nd[i] * unit(i)));
        let axes = AxesN::Rotating { system, angle: 0.4 };
        let target = Reference::new(axes, &r, &v, &system.acceleration(&r, &v));
        let (seen, h) = in_axes(&x, &target, &Units::SI).unwrap();
        let (rho, rho_dot) = target.from_n(RelativeAxes::Lvlh, &-parts(&x).0, &-parts(&x).1).unwrap();
        assert!((parts(&seen).0 - rho).amax() < 1e-12 && (parts(&seen).1 - rho_dot).amax() < 1e-12);
        let expected = slopes(&x, |x| in_axes(x, &target, &Units::SI).unwrap().0);
        assert!((h - expected).amax() < 1e-8, "{h} {expected}");
    }
}
