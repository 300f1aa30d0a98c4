//! Motion of a chaser relative to a target, in the target's turning axes.
//!
//! LVLH axes stand in the target: x along its geocentric position, z along its angular momentum, y completes (along the
//! motion of a circular orbit). They are the axes of [`crate::frames::rtn`]; here they also turn. The relative state is
//! chaser minus target: `rho`, m, and `rho_dot`, m/s, the rate that an observer turning with the axes sees.

use nalgebra::{Matrix3, Vector3};
use numerics::rotation;
use serde::{Deserialize, Serialize};

use crate::frames;

/// LVLH axes of a target at one instant, with their angular rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lvlh {
    r_t_n: Vector3<f64>,
    v_t_n: Vector3<f64>,
    a_t_n: Vector3<f64>,
    axes: LvlhAxes,
}

/// How LVLH axes stand and turn, wherever their origin is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LvlhAxes {
    /// Direction cosine matrix from inertial axes N to LVLH.
    pub dcm_lvlh_n: Matrix3<f64>,
    /// Angular rate of LVLH against N, LVLH axes, rad/s.
    pub omega: Vector3<f64>,
}

impl LvlhAxes {
    /// Inertial components of a relative state (`rho`, `rho_dot`) that stands in these axes, m and m/s.
    pub fn to_n(&self, rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let dcm_n_lvlh = self.dcm_lvlh_n.transpose();
        (dcm_n_lvlh * rho, dcm_n_lvlh * (rho_dot + self.omega.cross(rho)))
    }

    /// The same axes after `dt` seconds at a constant rate.
    pub fn after(&self, dt: f64) -> Self {
        let turn = rotation::by(&(self.omega * -dt)).into_inner();
        Self {
            dcm_lvlh_n: turn * self.dcm_lvlh_n,
            omega: self.omega,
        }
    }
}

impl Lvlh {
    /// Axes of a target with this inertial state.
    ///
    /// The acceleration counts: its part across the orbit turns the axes about x, at r a_n / h. Left at zero, J2 in a low
    /// orbit costs 6e-7 rad/s, micrometres per second over 10 m.
    ///
    /// * `r_t_n`, `v_t_n`, `a_t_n`: position, velocity and full acceleration of the target, N, m, m/s, m/s2; position and
    ///   velocity not parallel, or rates are not finite.
    pub fn new(r_t_n: &Vector3<f64>, v_t_n: &Vector3<f64>, a_t_n: &Vector3<f64>) -> Self {
        let dcm_lvlh_n = frames::rtn(r_t_n, v_t_n);
        let r = r_t_n.norm();
        let h = r_t_n.cross(v_t_n).norm();
        let across = (dcm_lvlh_n * a_t_n).z;
        Self {
            r_t_n: *r_t_n,
            v_t_n: *v_t_n,
            a_t_n: *a_t_n,
            axes: LvlhAxes {
                dcm_lvlh_n,
                omega: Vector3::new(r * across / h, 0.0, h / (r * r)),
            },
        }
    }

    /// How they stand and turn.
    pub fn axes(&self) -> &LvlhAxes {
        &self.axes
    }

    /// Direction cosine matrix from inertial axes N to LVLH.
    pub fn dcm_lvlh_n(&self) -> &Matrix3<f64> {
        &self.axes.dcm_lvlh_n
    }

    /// Angular rate of LVLH against N, LVLH axes, rad/s; its y component is zero.
    pub fn angular_rate(&self) -> &Vector3<f64> {
        &self.axes.omega
    }

    /// Angular acceleration of LVLH against N, LVLH axes, rad/s2.
    ///
    /// * `jerk_t_n`: time derivative of the target's acceleration along its path, N, m/s3.
    pub fn angular_acceleration(&self, jerk_t_n: &Vector3<f64>) -> Vector3<f64> {
        let r = self.r_t_n.norm();
        let omega = &self.axes.omega;
        let h = r * r * omega.z;
        let r_dot = self.r_t_n.dot(&self.v_t_n) / r;
        let a = self.axes.dcm_lvlh_n * self.a_t_n;
        let h_dot = r * a.y;
        // The normal turns with the axes: a_n changes by the jerk and by -omega_x times the transverse part.
        let a_n_dot = (self.axes.dcm_lvlh_n * jerk_t_n).z - omega.x * a.y;
        Vector3::new(
            (r_dot * a.z + r * a_n_dot - r * a.z * h_dot / h) / h,
            0.0,
            h_dot / (r * r) - 2.0 * omega.z * r_dot / r,
        )
    }

    /// Relative state (`rho`, `rho_dot`) of a chaser, from its inertial position and velocity.
    pub fn relative(&self, r_c_n: &Vector3<f64>, v_c_n: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let LvlhAxes { dcm_lvlh_n, omega } = &self.axes;
        let rho = dcm_lvlh_n * (r_c_n - self.r_t_n);
        let rho_dot = dcm_lvlh_n * (v_c_n - self.v_t_n) - omega.cross(&rho);
        (rho, rho_dot)
    }

    /// Inertial position and velocity of a chaser with this relative state: the inverse of [`Lvlh::relative`].
    pub fn absolute(&self, rho: &Vector3<f64>, rho_dot: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let (r, v) = self.axes.to_n(rho, rho_dot);
        (self.r_t_n + r, self.v_t_n + v)
    }

    /// Second derivative of `rho`, as seen in the turning axes.
    ///
    /// * `rho`, `rho_dot`: relative state.
    /// * `a_rel_n`: inertial acceleration of the chaser less that of the target, N, m/s2.
    /// * `alpha`: from [`Lvlh::angular_acceleration`].
    /// * returns: LVLH axes, m/s2.
    pub fn relative_acceleration(
        &self,
        rho: &Vector3<f64>,
        rho_dot: &Vector3<f64>,
        a_rel_n: &Vector3<f64>,
        alpha: &Vector3<f64>,
    ) -> Vector3<f64> {
        self.axes.dcm_lvlh_n * a_rel_n + turning_axes(rho, rho_dot, &self.axes.omega, alpha)
    }
}

/// What turning axes add to an acceleration: Coriolis, Euler and centrifugal.
pub(crate) fn turning_axes(
    rho: &Vector3<f64>,
    rho_dot: &Vector3<f64>,
    omega: &Vector3<f64>,
    alpha: &Vector3<f64>,
) -> Vector3<f64> {
    -omega.cross(rho_dot) * 2.0 - alpha.cross(rho) - omega.cross(&omega.cross(rho))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ZonalGravity;

    const GRAVITY: ZonalGravity = crate::earth::TRUTH;

    fn states(t: f64) -> (Lvlh, Vector3<f64>, Vector3<f64>) {
        // Two orbits, a kilometre apart, inclined and eccentric; integrated for a short time either way.
        let fly = |r: Vector3<f64>, v: Vector3<f64>| {
            let x = nalgebra::Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
            let mut x = x;
            for _ in 0..4 {
                x = numerics::rk4::step(0.0, &x, t / 4.0, |_, x| {
                    let a = GRAVITY.acceleration(&x.fixed_rows::<3>(0).into_owned());
                    nalgebra::Vector6::new(x[3], x[4], x[5], a.x, a.y, a.z)
                });
            }
            (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned())
        };
        let (r_t, v_t) = fly(Vector3::new(4.2e6, -3.1e6, 4.9e6), Vector3::new(4.0e3, 6.6e3, 1.2e3));
        let (r_c, v_c) = fly(
            Vector3::new(4.2006e6, -3.0995e6, 4.9007e6),
            Vector3::new(4.0011e3, 6.5993e3, 1.2008e3),
        );
        (Lvlh::new(&r_t, &v_t, &GRAVITY.acceleration(&r_t)), r_c, v_c)
    }

    #[test]
    fn relative_state_of_a_circular_orbit_by_hand() {
        // Target on the equator, flying east; a chaser 100 m above, at the same inertial velocity: in axes that turn at
        // n = 7500/7e6 rad/s it falls back at 100 n.
        let (r, v) = (Vector3::new(7e6, 0.0, 0.0), Vector3::new(0.0, 7500.0, 0.0));
        let lvlh = Lvlh::new(&r, &v, &Vector3::new(-8.0, 0.0, 0.0));
        let (rho, rho_dot) = lvlh.relative(&(r + Vector3::new(100.0, 0.0, 5.0)), &v);
        assert!((rho - Vector3::new(100.0, 0.0, 5.0)).amax() < 1e-12, "{rho}");
        assert!(
            (rho_dot - Vector3::new(0.0, -100.0 * 7500.0 / 7e6, 0.0)).amax() < 1e-12,
            "{rho_dot}"
        );
    }

    #[test]
    fn absolute_undoes_relative() {
        let (lvlh, r_c, v_c) = states(0.0);
        let (rho, rho_dot) = lvlh.relative(&r_c, &v_c);
        let (r, v) = lvlh.absolute(&rho, &rho_dot);
        // Rounding of 7e6 m and 8e3 m/s.
        assert!((r - r_c).amax() < 4e-9 && (v - v_c).amax() < 4e-12);
    }

    /// Rates against differences of what they are rates of.
    #[test]
    fn rates_are_derivatives() {
        let h = 0.2;
        let at = |t: f64| {
            let (lvlh, r, v) = states(t);
            (lvlh, lvlh.relative(&r, &v))
        };
        let ((before, low), (now, mid), (after, high)) = (at(-h), at(0.0), at(h));
        // Error h^2 n^2 / 6 of the differences, 1e-8, of 2 m/s, and rounding of positions.
        let rho_dot = (high.0 - low.0) / (2.0 * h);
        assert!((rho_dot - mid.1).amax() < 1e-7, "{rho_dot} and {}", mid.1);
        let turn = (after.dcm_lvlh_n() - before.dcm_lvlh_n()) / (2.0 * h) * now.dcm_lvlh_n().transpose();
        assert!((turn + now.angular_rate().cross_matrix()).amax() < 1e-9, "{turn}");
        assert!(now.angular_rate().x.abs() > 1e-7, "J2 turns the orbit");

        let a = |lvlh: &Lvlh| lvlh.a_t_n;
        let jerk = (a(&after) - a(&before)) / (2.0 * h);
        let alpha = now.angular_acceleration(&jerk);
        let expected = (after.angular_rate() - before.angular_rate()) / (2.0 * h);
        // The same h^2 n^2 / 6 of 1e-10 and of 1e-7 rad/s2.
        let off = alpha - expected;
        assert!(off.x.abs() < 1e-16 && off.z.abs() < 1e-14, "{alpha} and {expected}");

        let (_, r_c, _) = states(0.0);
        let a_rel = GRAVITY.acceleration(&r_c) - now.a_t_n;
        let rho_ddot = now.relative_acceleration(&mid.0, &mid.1, &a_rel, &alpha);
        let expected = (high.1 - low.1) / (2.0 * h);
        assert!((rho_ddot - expected).amax() < 1e-9, "{rho_ddot} and {expected}");
    }
}
