//! What another model does to the world through its inputs.

use nalgebra::{Matrix3, Vector3};
use numerics::rotation;
use serde::{Deserialize, Serialize};

use crate::{Push, TruthError};

/// How far the rows of a commanded attitude may be from orthonormal: what single precision leaves.
const NOT_A_ROTATION: f64 = 1e-6;

/// Inputs as set at a communication point.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Inputs {
    /// Acceleration of the chaser, axes N, m/s2; its accelerometer feels it.
    pub a_cmd_c_n: Vector3<f64>,
    /// Acceleration of the target, axes N, m/s2.
    pub a_dist_t_n: Vector3<f64>,
    /// Force on the target, its body axes, N: what a vent's mass flow and exhaust velocity make.
    pub f_dist_t_bt: Vector3<f64>,
    /// Change of the chaser's velocity, axes N, m/s, made at once whenever `impulse_count` changes.
    pub impulse_c_n: Vector3<f64>,
    /// Ordinal of that change.
    pub impulse_count: i32,
    /// Attitude that the chaser holds: axes N to its body axes; all zero: the mission's own.
    pub dcm_cmd_bc_n: Matrix3<f64>,
}

impl Inputs {
    /// Adds what they do.
    ///
    /// * `target_kg`: mass of the target, kg.
    pub(crate) fn add_to(&self, mut push: Push, target_kg: f64) -> Push {
        push.chaser.n += self.a_cmd_c_n;
        push.target.n += self.a_dist_t_n;
        if self.f_dist_t_bt != Vector3::zeros() {
            push.target.turning.get_or_insert_default().body += self.f_dist_t_bt / target_kg;
        }
        push.unannounced |= self.a_dist_t_n != Vector3::zeros() || self.f_dist_t_bt != Vector3::zeros();
        push.dcm_cmd_bc_n = (self.dcm_cmd_bc_n != Matrix3::zeros()).then_some(self.dcm_cmd_bc_n);
        push
    }

    /// Whether what acts as long as it stays is the same.
    pub(crate) fn push_as(&self, other: &Self) -> bool {
        (self.a_cmd_c_n, self.a_dist_t_n, self.f_dist_t_bt) == (other.a_cmd_c_n, other.a_dist_t_n, other.f_dist_t_bt)
            && self.dcm_cmd_bc_n == other.dcm_cmd_bc_n
    }

    /// Refuses what is no number, and an attitude that is none.
    ///
    /// * `t`: communication point to be gone to, s.
    pub(crate) fn check(&self, t: f64) -> Result<(), TruthError> {
        let vectors = [
            ("a_cmd_c_n", "m/s2", &self.a_cmd_c_n),
            ("a_dist_t_n", "m/s2", &self.a_dist_t_n),
            ("f_dist_t_bt", "N", &self.f_dist_t_bt),
            ("impulse_c_n", "m/s", &self.impulse_c_n),
        ];
        for (name, unit, vector) in vectors {
            for (axis, &value) in (1..).zip(vector) {
                if !value.is_finite() {
                    return Err(TruthError::Input {
                        name,
                        axis,
                        value,
                        unit,
                        t,
                    });
                }
            }
        }
        let attitude = &self.dcm_cmd_bc_n;
        if *attitude != Matrix3::zeros() {
            let defect = rotation::defect(attitude);
            if defect.is_nan() || defect > NOT_A_ROTATION || attitude.determinant() < 0.0 {
                return Err(TruthError::NotARotation { defect, t });
            }
        }
        Ok(())
    }
}
