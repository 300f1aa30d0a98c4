//! How the sensors of the target see the states of the inertial frame: prediction and rows of H, one function each.

use crate::layout::{Layout, Sensor};
use crate::state::RowVector;
use crate::units::Units;
use astro::relative_axes::Reference;
use astro::{AstroError, RelativeAxes};
use interface::Navigation;
use nalgebra::{Matrix3, SMatrix, SVector, Vector2, Vector3, Vector6};

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

/// Camera: the angles of the LiDAR.
pub(super) fn camera(r_tc_n: &Vector3<f64>, dcm_l_n: &Matrix3<f64>) -> Sight<2> {
    let (predicted, h) = lidar(r_tc_n, dcm_l_n);
    (
        predicted.fixed_rows::<2>(1).into_owned(),
        h.fixed_rows::<2>(1).into_owned(),
    )
}

/// Radio: range and range rate u . v_tc with u along the line of sight.
///
/// In turning axes the inertial velocity is v + omega x r, but omega x r has no part along r: the rate of a distance is the
/// same in any axes, and so are its partials.
pub(super) fn radio(r_tc_n: &Vector3<f64>, v_tc_n: &Vector3<f64>) -> Sight<2> {
    let range = r_tc_n.norm();
    let u = r_tc_n / range;
    let rate = u.dot(v_tc_n);
    let across = (v_tc_n - u * rate) / range;
    let mut h = SMatrix::<f64, 2, 6>::zeros();
    for axis in 0..3 {
        h[(0, axis)] = u[axis];
        h[(1, axis)] = across[axis];
        h[(1, 3 + axis)] = u[axis];
    }
    (Vector2::new(range, rate), h)
}

/// Metrology: the chaser from the target, in the LVLH axes of the estimated target.
///
/// Linear in r_tc and v_tc. The axes hang on the target's estimate too: 10 m of it turn them by 1e-6 rad in a low orbit, which
/// over a kilometre is a millimetre; these partials are left out.
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
    fn rows_are_central_differences() {
        let x = Vector6::new(30.0, -50.0, 20.0, 0.3, 0.1, -0.2);
        let dcm = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0).into_inner();
        let (r, v) = parts(&x);
        // Truncation of second differences, (1e-2 m / 60 m)^2 of a slope.
        let close = |ours: f64, expected: f64| (ours - expected).abs() < 1e-6;
        let ours = camera(&r, &dcm);
        let expected = slopes(&x, |x| camera(&parts(x).0, &dcm).0);
        assert!(ours.1.iter().zip(expected.iter()).all(|(a, b)| close(*a, *b)));
        let ours = radio(&r, &v);
        let expected = slopes(&x, |x| radio(&parts(x).0, &parts(x).1).0);
        assert!(ours.1.iter().zip(expected.iter()).all(|(a, b)| close(*a, *b)));
        assert!((ours.0[1] - v.dot(&r.normalize())).abs() < 1e-15);
    }

    /// The rate of the distance by a finite step of an inertial motion, in axes that turn.
    #[test]
    fn range_rate_needs_no_turning_of_the_axes() {
        let (omega, dt) = (0.3, 1e-4);
        let (r, v) = (Vector3::new(3.0, -5.0, 2.0), Vector3::new(0.3, 0.1, -0.2));
        // Seen in axes that turn by omega about z, a point that moves by v there.
        let inertial = |t: f64| nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), omega * t) * (r + v * t);
        let rate = (inertial(dt).norm() - inertial(-dt).norm()) / (2.0 * dt);
        assert!((radio(&r, &v).0[1] - rate).abs() < 1e-7);
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
