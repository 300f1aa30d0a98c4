//! How the sensors of the target see the states of the inertial frame: prediction and rows of H, one function each.

use crate::layout::{Layout, Sensor};
use crate::state::RowVector;
use crate::units::Units;
use astro::relative_axes::Reference;
use astro::{AstroError, RelativeAxes};
use interface::Navigation;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

/// A prediction and its partials by r_tc and v_tc.
pub(super) type Sight<const M: usize> = (SVector<f64, M>, SMatrix<f64, M, 6>);

/// Noise variances of every sensor of a mission, internal units, in the places of its layout.
pub(super) fn noise(told: &Navigation) -> RowVector {
    let (units, layout) = (Units::of(&told.units), Layout::of(told));
    let mut r = RowVector::zeros();
    let mut put = |sensor: Sensor, deviations: &[f64]| {
        for (row, sigma) in layout.of_sensor(sensor).into_iter().flatten().zip(deviations) {
            r[row] = sigma * sigma;
        }
    };
    if let Some(s) = told.lidar {
        put(
            Sensor::Lidar,
            &[s.sigma_range_m / units.length, s.sigma_angle_rad, s.sigma_angle_rad],
        );
    }
    if let Some(s) = told.camera {
        put(Sensor::Camera, &[s.sigma_angle_rad; 2]);
    }
    if let Some(s) = told.radio {
        put(
            Sensor::Radio,
            &[
                s.sigma_range_m / units.length,
                s.sigma_range_rate_m_s / units.velocity(),
            ],
        );
    }
    if let Some(s) = told.metrology {
        let (position, velocity) = (
            s.sigma_position_m / units.length,
            s.sigma_velocity_m_s / units.velocity(),
        );
        put(
            Sensor::Metrology,
            sensors::metrology::deviations(position, velocity).as_slice(),
        );
    }
    r
}

/// SI size of the rows of every sensor, in the places of a layout.
pub(super) fn si(layout: &Layout, units: &Units) -> RowVector {
    let mut si = RowVector::repeat(1.0);
    let mut put = |sensor: Sensor, sizes: &[f64]| {
        for (row, size) in layout.of_sensor(sensor).into_iter().flatten().zip(sizes) {
            si[row] = *size;
        }
    };
    let (length, velocity) = (units.length, units.velocity());
    put(Sensor::Lidar, &[length, 1.0, 1.0]);
    put(Sensor::Radio, &[length, velocity]);
    put(
        Sensor::Metrology,
        &[length, length, length, velocity, velocity, velocity],
    );
    si
}

/// LiDAR: range, azimuth, elevation (Mamich and Zanetti, Eqs. 7 to 11).
///
/// * `r_tc_n`: predicted relative position, axes N; `dcm_l_n`: axes N to LiDAR.
pub(super) fn lidar(r_tc_n: &Vector3<f64>, dcm_l_n: &Matrix3<f64>) -> Sight<3> {
    let mut h = SMatrix::<f64, 3, 6>::zeros();
    h.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&sensors::lidar::jacobian(r_tc_n, dcm_l_n));
    (sensors::lidar::measure(&(dcm_l_n * r_tc_n)), h)
}

/// Camera: azimuth and elevation, in the LiDAR's axes.
pub(super) fn camera(r_tc_n: &Vector3<f64>, dcm_l_n: &Matrix3<f64>) -> Sight<2> {
    let mut h = SMatrix::<f64, 2, 6>::zeros();
    h.fixed_view_mut::<2, 3>(0, 0)
        .copy_from(&sensors::camera::jacobian(r_tc_n, dcm_l_n));
    (sensors::camera::measure(&(dcm_l_n * r_tc_n)), h)
}

/// Radio: range and range rate, which are the same in turning axes.
pub(super) fn radio(r_tc_n: &Vector3<f64>, v_tc_n: &Vector3<f64>) -> Sight<2> {
    (
        sensors::radio::measure(r_tc_n, v_tc_n),
        sensors::radio::jacobian(r_tc_n, v_tc_n),
    )
}

/// Metrology: the chaser from the target, in the LVLH axes of the estimated target.
///
/// Linear in r_tc and v_tc, the axes held; [`of_axes`] has what hangs on the axes.
///
/// * `target`: where its axes stand, SI.
///
/// # Errors
/// When the target has no such axes.
pub(super) fn metrology(relative: &Vector6<f64>, target: &Reference, units: &Units) -> Result<Sight<6>, AstroError> {
    let unit = Vector6::from_fn(|i, _| units.of_state(i));
    let seen = |x: &Vector6<f64>| -> Result<Vector6<f64>, AstroError> {
        let x = -x.component_mul(&unit);
        let part = |slot: usize| x.fixed_rows::<3>(slot).into_owned();
        let (rho, rho_dot) = target.from_n(RelativeAxes::Lvlh, &part(0), &part(3))?;
        Ok(sensors::metrology::measure(&rho, &rho_dot).component_div(&unit))
    };
    let mut h = SMatrix::<f64, 6, 6>::zeros();
    for state in 0..6 {
        let mut one = Vector6::zeros();
        one[state] = 1.0;
        h.set_column(state, &seen(&one)?);
    }
    Ok((seen(relative)?, h))
}

/// Partials of what a metrology sees by the target's own position and velocity, which turn its axes: 0.05 m/s of a low orbit's
/// speed turn them by 7e-6 rad, which over a kilometre is as much as a metrology is good for.
///
/// By central differences, for what is seen is smooth over kilometres.
///
/// * `target`: its position and velocity, internal units.
/// * `seen`: what a metrology sees for such a target.
///
/// # Errors
/// When the target has no such axes.
pub(super) fn of_axes(
    target: &Vector6<f64>,
    units: &Units,
    seen: impl Fn(&Vector6<f64>) -> Result<Vector6<f64>, AstroError>,
) -> Result<SMatrix<f64, 6, 6>, AstroError> {
    let mut h = SMatrix::<f64, 6, 6>::zeros();
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

    fn slopes<const M: usize>(x: &Vector6<f64>, seen: impl Fn(&Vector6<f64>) -> SVector<f64, M>) -> SMatrix<f64, M, 6> {
        let mut h = SMatrix::<f64, M, 6>::zeros();
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
        let (seen, h) = metrology(&x, &target, &Units::SI).unwrap();
        let (rho, rho_dot) = target.from_n(RelativeAxes::Lvlh, &-parts(&x).0, &-parts(&x).1).unwrap();
        assert!((parts(&seen).0 - rho).amax() < 1e-12 && (parts(&seen).1 - rho_dot).amax() < 1e-12);
        let expected = slopes(&x, |x| metrology(x, &target, &Units::SI).unwrap().0);
        assert!((h - expected).amax() < 1e-8, "{h} {expected}");
    }
}
