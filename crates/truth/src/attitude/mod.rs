//! How vehicles point: one file for each law and one line in the registry.

mod inertial;
mod line_of_sight;
mod rtn;
mod spin;

use interface::mission;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use inertial::Inertial;
use line_of_sight::LineOfSight;
use rtn::Rtn;
use spin::Spin;

/// What a pointing law may look at; axes N, SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sight {
    /// s since the start of the run.
    pub t: f64,
    /// Position relative to the central body (in the three-body problem the smaller one), m.
    pub r: Vector3<f64>,
    /// Inertial velocity relative to it, m/s.
    pub v: Vector3<f64>,
    /// Position of the other vehicle relative to this one, m.
    pub r_other: Vector3<f64>,
    /// Velocity likewise, as seen in axes N, m/s.
    pub v_other: Vector3<f64>,
    /// Normal of this vehicle's orbit, any length.
    pub normal: Vector3<f64>,
    /// Maps inertial axes to N.
    pub dcm_n_i: Matrix3<f64>,
}

/// A pointing law.
pub(crate) trait Law {
    /// Maps N to body axes.
    fn dcm_b_n(&self, sight: &Sight) -> Matrix3<f64>;
}

macro_rules! registry {
    ($($name:ident => $from:pat, $made:expr;)*) => {
        /// The pointing law of a vehicle.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        pub(crate) enum Attitude { $($name($name)),* }

        impl Attitude {
            /// The law that a mission asks for.
            pub(crate) fn of(attitude: mission::Attitude) -> Self {
                match attitude { $($from => Self::$name($made)),* }
            }

            /// Maps N to body axes.
            pub(crate) fn dcm_b_n(&self, sight: &Sight) -> Matrix3<f64> {
                match self { $(Self::$name(law) => law.dcm_b_n(sight)),* }
            }
        }
    };
}

registry! {
    LineOfSight => mission::Attitude::LineOfSight, LineOfSight;
    Rtn => mission::Attitude::Rtn, Rtn;
    Inertial => mission::Attitude::Inertial, Inertial;
    Spin => mission::Attitude::SpinDegS(rate), Spin::deg_s(rate);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sight(t: f64) -> Sight {
        Sight {
            t,
            r: Vector3::new(7e6, 0.0, 0.0),
            v: Vector3::new(0.0, 0.0, 7.5e3),
            r_other: Vector3::new(0.0, 100.0, 0.0),
            v_other: Vector3::new(0.0, 0.0, 1.0),
            normal: Vector3::new(0.0, -1.0, 0.0),
            dcm_n_i: Matrix3::identity(),
        }
    }

    #[test]
    fn each_law_points_where_it_says() {
        let of = |law: mission::Attitude, t: f64| Attitude::of(law).dcm_b_n(&sight(t));
        let los = of(mission::Attitude::LineOfSight, 0.0);
        assert!(
            (los * Vector3::y() - Vector3::y()).amax() < 1e-14,
            "body y to the other"
        );
        let rtn = of(mission::Attitude::Rtn, 0.0);
        // Radial x, transverse z, normal -y.
        let expected = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0);
        assert!((rtn - expected).amax() < 1e-14, "{rtn}");
        assert!((of(mission::Attitude::Inertial, 5.0) - Matrix3::identity()).amax() < 1e-15);
        // A quarter turn about z in 9 s: body x then points along inertial y.
        let spun = of(mission::Attitude::SpinDegS([0.0, 0.0, 10.0]), 9.0);
        assert!((spun.tr_mul(&Vector3::x()) - Vector3::y()).amax() < 1e-14, "{spun}");
    }
}
