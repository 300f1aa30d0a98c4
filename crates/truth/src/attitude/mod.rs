//! How vehicles point: one file for each law and one line in the registry.

mod inertial;
mod line_of_sight;
mod rtn;
mod spin;

use interface::mission;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::axes::Axes;
use inertial::Inertial;
use line_of_sight::LineOfSight;
use rtn::Rtn;
use spin::Spin;

/// What a pointing law may look at; axes N, SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sight<'a> {
    /// s since the start of the run.
    pub t: f64,
    /// How axes N stand.
    pub axes: &'a Axes,
    /// Position of the vehicle, m.
    pub r: &'a Vector3<f64>,
    /// Velocity, m/s.
    pub v: &'a Vector3<f64>,
    /// Position of the other vehicle relative to this one, m.
    pub r_other: Vector3<f64>,
    /// Velocity likewise, m/s.
    pub v_other: Vector3<f64>,
}

impl Sight<'_> {
    /// Position and inertial velocity relative to the body that is orbited, m and m/s.
    fn orbit(&self) -> (Vector3<f64>, Vector3<f64>) {
        self.axes.about_body(self.r, self.v)
    }

    /// Maps inertial axes to N.
    fn dcm_n_i(&self) -> Matrix3<f64> {
        self.axes.dcm_n_i(self.t)
    }
}

/// A pointing law.
pub(crate) trait Law {
    /// Maps N to body axes.
    fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64>;
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
            pub(crate) fn dcm_b_n(&self, sight: &Sight<'_>) -> Matrix3<f64> {
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

    const R: Vector3<f64> = Vector3::new(7e6, 0.0, 0.0);
    const V: Vector3<f64> = Vector3::new(0.0, 0.0, 7.5e3);

    fn sight(axes: &Axes, t: f64) -> Sight<'_> {
        Sight {
            t,
            axes,
            r: &R,
            v: &V,
            r_other: Vector3::new(0.0, 100.0, 0.0),
            v_other: Vector3::new(0.0, 0.0, 1.0),
        }
    }

    #[test]
    fn each_law_points_where_it_says() {
        let of = |law: mission::Attitude, t: f64| Attitude::of(law).dcm_b_n(&sight(&Axes::Inertial, t));
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
