//! A relative state in the axes in which it is said: axes N, those of a vehicle's orbit, held still or turning, or inertial
//! ones where axes N turn.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::cr3bp::{self, Cr3bpSystem};
use crate::{AstroError, Lvlh, frames};

/// Axes of a relative position and of its rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RelativeAxes {
    /// Axes N.
    N,
    /// Radial, transverse, normal of the reference vehicle's orbit ([`frames::rtn`]), held still: the velocity is the
    /// inertial one, in these components.
    Rtn,
    /// The same axes, turning with the orbit: the velocity is the rate seen in them ([`crate::relative`]).
    Lvlh,
    /// Inertial axes: axes N themselves, or in the three-body problem those from which axes N have turned.
    Inertial,
}

/// What axes N are, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AxesN {
    /// Inertial, from the centre of the body.
    Inertial,
    /// Those of the three-body problem, from the barycentre; orbits are those about the smaller body.
    Rotating {
        /// The problem.
        system: Cr3bpSystem,
        /// Angle by which N have turned about z from inertial axes, rad.
        angle: f64,
    },
}

/// A vehicle beside which another is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    axes_n: AxesN,
    lvlh: Option<Lvlh>,
}

impl Reference {
    /// A vehicle with this motion.
    ///
    /// * `r_n`, `v_n`, `a_n`: position, velocity and full acceleration as seen in axes N, m, m/s, m/s2. The acceleration
    ///   counts for [`RelativeAxes::Lvlh`] alone, see [`Lvlh::new`].
    pub fn new(axes_n: AxesN, r_n: &Vector3<f64>, v_n: &Vector3<f64>, a_n: &Vector3<f64>) -> Self {
        let (r, v, a) = match axes_n {
            AxesN::Inertial => (*r_n, *v_n, *a_n),
            AxesN::Rotating { system, .. } => {
                let (r, v) = system.about_secondary(r_n, v_n);
                let rate = system.rate();
                (r, v, a_n + rate.cross(v_n) * 2.0 + rate.cross(&rate.cross(&r)))
            }
        };
        let defined = frames::try_rtn(&r, &v).is_some();
        Self {
            axes_n,
            lvlh: defined.then(|| Lvlh::new(&r, &v, &a)),
        }
    }

    /// A relative state in axes N.
    ///
    /// * `r`, `v`: relative position and its rate in `axes`, m and m/s.
    /// * returns: relative position and velocity as seen in axes N, m and m/s.
    ///
    /// # Errors
    /// When the reference vehicle has no such axes: it moves along its radius, or not at all.
    pub fn to_n(
        &self,
        axes: RelativeAxes,
        r: &Vector3<f64>,
        v: &Vector3<f64>,
    ) -> Result<(Vector3<f64>, Vector3<f64>), AstroError> {
        let Some(Axes { dcm_n_a, omega_a }) = self.axes(axes)? else {
            return Ok((*r, *v));
        };
        let r_n = dcm_n_a * r;
        Ok((r_n, dcm_n_a * (v + omega_a.cross(r)) - self.swept(&r_n)))
    }

    /// A relative state of axes N in other axes: the inverse of [`Reference::to_n`].
    ///
    /// # Errors
    /// As there.
    pub fn from_n(
        &self,
        axes: RelativeAxes,
        r_n: &Vector3<f64>,
        v_n: &Vector3<f64>,
    ) -> Result<(Vector3<f64>, Vector3<f64>), AstroError> {
        let Some(Axes { dcm_n_a, omega_a }) = self.axes(axes)? else {
            return Ok((*r_n, *v_n));
        };
        let r = dcm_n_a.tr_mul(r_n);
        Ok((r, dcm_n_a.tr_mul(&(v_n + self.swept(r_n))) - omega_a.cross(&r)))
    }

    /// How the axes stand; `None` for N itself.
    fn axes(&self, axes: RelativeAxes) -> Result<Option<Axes>, AstroError> {
        let orbit = |axes| {
            self.lvlh.ok_or(AstroError::Axes {
                axes,
                reason: "the vehicle moves along its radius or not at all, so that its orbit has no normal",
            })
        };
        Ok(match (axes, self.axes_n) {
            (RelativeAxes::N, _) | (RelativeAxes::Inertial, AxesN::Inertial) => None,
            (RelativeAxes::Rtn, _) => Some(Axes {
                dcm_n_a: orbit("rtn")?.dcm_lvlh_n().transpose(),
                omega_a: Vector3::zeros(),
            }),
            (RelativeAxes::Lvlh, _) => {
                let lvlh = orbit("lvlh")?;
                Some(Axes {
                    dcm_n_a: lvlh.dcm_lvlh_n().transpose(),
                    omega_a: *lvlh.angular_rate(),
                })
            }
            (RelativeAxes::Inertial, AxesN::Rotating { angle, .. }) => Some(Axes {
                dcm_n_a: cr3bp::dcm_rotating_inertial(angle),
                omega_a: Vector3::zeros(),
            }),
        })
    }

    /// By how much a place that rests in axes N moves inertially, N, m/s.
    fn swept(&self, r_n: &Vector3<f64>) -> Vector3<f64> {
        match self.axes_n {
            AxesN::Inertial => Vector3::zeros(),
            AxesN::Rotating { system, .. } => Vector3::z().cross(r_n) / system.time,
        }
    }
}

/// Axes A against N and against inertial axes.
struct Axes {
    dcm_n_a: Matrix3<f64>,
    /// Rate against inertial axes, A, rad/s.
    omega_a: Vector3<f64>,
}

/// State, in axes N relative to a known vehicle, of one that is given in the axes of its *own* orbit.
///
/// Its orbit depends on where it is, and that on its orbit; each round leaves a share of the separation over the distance.
///
/// * `known`: position and velocity of the known vehicle, N, m and m/s.
/// * `acceleration`: of a vehicle at a position with a velocity, as seen in axes N, m/s2.
/// * `r`, `v`: the wanted vehicle minus the known one, in `axes` of the wanted one, m and m/s.
/// * returns: wanted minus known, N, m and m/s.
///
/// # Errors
/// When the axes do not exist, or the vehicles are too far apart for them to be found.
pub fn in_own_axes(
    axes_n: AxesN,
    known: (&Vector3<f64>, &Vector3<f64>),
    acceleration: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Vector3<f64>,
    axes: RelativeAxes,
    (r, v): (&Vector3<f64>, &Vector3<f64>),
) -> Result<(Vector3<f64>, Vector3<f64>), AstroError> {
    let mut found = (Vector3::zeros(), Vector3::zeros());
    for _ in 0..100 {
        let (r_n, v_n) = (known.0 + found.0, known.1 + found.1);
        let next = Reference::new(axes_n, &r_n, &v_n, &acceleration(&r_n, &v_n)).to_n(axes, r, v)?;
        let still_moving = (next.0 - found.0).norm() > 1e-14 * known.0.norm();
        found = next;
        if !still_moving {
            return Ok(found);
        }
    }
    Err(AstroError::Axes {
        axes: "of the vehicle's own orbit",
        reason: "it is too far from the other vehicle for its orbit to be found",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth;
    use proptest::prelude::*;

    const ALL: [RelativeAxes; 4] = [
        RelativeAxes::N,
        RelativeAxes::Rtn,
        RelativeAxes::Lvlh,
        RelativeAxes::Inertial,
    ];
    const MOON: AxesN = AxesN::Rotating {
        system: Cr3bpSystem::EARTH_MOON,
        angle: 0.766,
    };

    fn low_orbit() -> [Vector3<f64>; 3] {
        let (r, v) = (Vector3::new(4.2e6, -3.1e6, 4.9e6), Vector3::new(4.0e3, 6.6e3, 1.2e3));
        [r, v, earth::TRUTH.acceleration(&r)]
    }

    fn halo() -> [Vector3<f64>; 3] {
        let system = Cr3bpSystem::EARTH_MOON;
        let (r, v) = system.to_si(
            &Vector3::new(0.9879, 1.432e-2, 2.009e-3),
            &Vector3::new(7.173e-2, 0.9238, -0.8528),
        );
        [r, v, system.acceleration(&r, &v)]
    }

    fn reference(axes_n: AxesN) -> Reference {
        let [r, v, a] = if axes_n == AxesN::Inertial { low_orbit() } else { halo() };
        Reference::new(axes_n, &r, &v, &a)
    }

    #[test]
    fn circular_orbit_by_hand() {
        // On the equator, flying east: R, T, N are x, y, z and turn at 7500 / 7e6 rad/s.
        let (r, v) = (Vector3::new(7e6, 0.0, 0.0), Vector3::new(0.0, 7500.0, 0.0));
        let circle = Reference::new(AxesN::Inertial, &r, &v, &Vector3::new(-8.0, 0.0, 0.0));
        let (place, rate) = (Vector3::new(100.0, -50.0, 5.0), Vector3::new(0.1, 0.2, 0.3));
        let n = 7500.0 / 7e6;
        for (axes, expected) in [
            (RelativeAxes::N, rate),
            (RelativeAxes::Inertial, rate),
            (RelativeAxes::Rtn, rate),
            (RelativeAxes::Lvlh, rate + Vector3::new(50.0 * n, 100.0 * n, 0.0)),
        ] {
            let (r_n, v_n) = circle.to_n(axes, &place, &rate).unwrap();
            assert!(
                (r_n - place).amax() < 1e-13 && (v_n - expected).amax() < 1e-15,
                "{axes:?}: {v_n}"
            );
        }
    }

    /// Sec. IV.B of Mamich and Zanetti: at rest to each other in inertial axes, as Table 7 prints it in rotating ones.
    #[test]
    fn val_rest_in_inertial_axes_is_table_7() {
        let system = Cr3bpSystem::EARTH_MOON;
        let angle = 0.766_384_551_757_062_3;
        let [r, v, a] = halo();
        let chaser = Reference::new(AxesN::Rotating { system, angle }, &r, &v, &a);
        let (r_tc, v_tc) = chaser
            .to_n(
                RelativeAxes::Inertial,
                &Vector3::new(-2.0, -2.0, -2.0),
                &Vector3::zeros(),
            )
            .unwrap();
        let (r_nd, v_nd) = system.to_nd(&r_tc, &v_tc);
        // Printed to four digits.
        assert!(
            (r_nd - Vector3::new(-7.357e-9, -1.399e-10, -5.203e-9)).amax() < 2e-12,
            "{r_nd}"
        );
        assert!(
            (v_nd - Vector3::new(-1.399e-10, 7.357e-9, 0.0)).amax() < 2e-12,
            "{v_nd}"
        );
    }

    /// Both ways of seeing the same motion, a short time apart: rates are derivatives of places.
    #[test]
    fn rates_in_turning_axes_are_derivatives_of_places() {
        let system = Cr3bpSystem::EARTH_MOON;
        let rates = |x: &nalgebra::Vector6<f64>| {
            let (r, v) = (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned());
            let a = system.acceleration(&r, &v);
            nalgebra::Vector6::new(v.x, v.y, v.z, a.x, a.y, a.z)
        };
        let fly = |r: &Vector3<f64>, v: &Vector3<f64>, t: f64| {
            let x = nalgebra::Vector6::new(r.x, r.y, r.z, v.x, v.y, v.z);
            let x = numerics::rk4::step(0.0, &x, t, |_, x| rates(x));
            (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned())
        };
        let [r_0, v_0, _] = halo();
        let (dr, dv) = (Vector3::new(3e3, -2e3, 1e3), Vector3::new(0.5, 0.2, -0.1));
        let at = |axes, t: f64| {
            let (r, v) = fly(&r_0, &v_0, t);
            let (r_c, v_c) = fly(&(r_0 + dr), &(v_0 + dv), t);
            let axes_n = AxesN::Rotating {
                system,
                angle: 0.766 + t / system.time,
            };
            let reference = Reference::new(axes_n, &r, &v, &system.acceleration(&r, &v));
            reference.from_n(axes, &(r_c - r), &(v_c - v)).unwrap()
        };
        let h = 2.0;
        for axes in [RelativeAxes::N, RelativeAxes::Lvlh, RelativeAxes::Inertial] {
            let slope = (at(axes, h).0 - at(axes, -h).0) / (2.0 * h);
            let rate = at(axes, 0.0).1;
            // Rounding of 4e8 m over 4 s, and h^2 / 6 of the third derivative.
            assert!((slope - rate).amax() < 1e-6, "{axes:?}: {slope} and {rate}");
        }
        // The three differ by much more than that.
        assert!((at(RelativeAxes::N, 0.0).1 - at(RelativeAxes::Inertial, 0.0).1).norm() > 1e-3);
        assert!((at(RelativeAxes::Rtn, 0.0).1 - at(RelativeAxes::Lvlh, 0.0).1).norm() > 1e-3);
    }

    #[test]
    fn axes_of_a_straight_fall_are_refused() {
        let (r, v) = (Vector3::new(7e6, 0.0, 0.0), Vector3::new(-100.0, 0.0, 0.0));
        let falling = Reference::new(AxesN::Inertial, &r, &v, &Vector3::zeros());
        let one = Vector3::x();
        for axes in [RelativeAxes::Rtn, RelativeAxes::Lvlh] {
            let error = falling.to_n(axes, &one, &one).unwrap_err().to_string();
            assert!(error.contains("along its radius"), "{error}");
            assert!(falling.from_n(axes, &one, &one).is_err());
        }
        assert_eq!(falling.to_n(RelativeAxes::N, &one, &one), Ok((one, one)));
    }

    #[test]
    fn own_axes_of_the_wanted_vehicle() {
        let [r_c, v_c, _] = low_orbit();
        let gravity = |r: &Vector3<f64>, _: &Vector3<f64>| earth::TRUTH.acceleration(r);
        for size in [1.0, 1e3, 5e5] {
            let (r, v) = (
                Vector3::new(0.6, -0.8, 0.2) * size,
                Vector3::new(1e-3, 2e-4, -3e-4) * size,
            );
            for axes in ALL {
                let (r_n, v_n) = in_own_axes(AxesN::Inertial, (&r_c, &v_c), gravity, axes, (&r, &v)).unwrap();
                // Seen in the axes of the vehicle that was placed, it is what was asked for.
                let (r_t, v_t) = (r_c + r_n, v_c + v_n);
                let placed = Reference::new(AxesN::Inertial, &r_t, &v_t, &gravity(&r_t, &v_t));
                let (r_seen, v_seen) = placed.from_n(axes, &r_n, &v_n).unwrap();
                assert!(
                    (r_seen - r).amax() < 1e-6 && (v_seen - v).amax() < 1e-9,
                    "{axes:?}, {size} m"
                );
            }
        }
        // From beyond the centre of the Earth no orbit is found.
        let far = (&Vector3::new(-3e7, 0.0, 0.0), &Vector3::zeros());
        assert!(in_own_axes(AxesN::Inertial, (&r_c, &v_c), gravity, RelativeAxes::Rtn, far).is_err());
    }

    proptest! {
        #[test]
        fn there_and_back(
            r in [-1e4..1e4_f64, -1e4..1e4_f64, -1e4..1e4_f64],
            v in [-10.0..10.0_f64, -10.0..10.0_f64, -10.0..10.0_f64],
        ) {
            let (r, v) = (Vector3::from(r), Vector3::from(v));
            for axes_n in [AxesN::Inertial, MOON] {
                let reference = reference(axes_n);
                for axes in ALL {
                    let (r_n, v_n) = reference.to_n(axes, &r, &v).unwrap();
                    let (r_back, v_back) = reference.from_n(axes, &r_n, &v_n).unwrap();
                    prop_assert!((r_back - r).amax() < 1e-11 && (v_back - v).amax() < 1e-13, "{axes:?}");
                    prop_assert!((r_n.norm() - r.norm()).abs() < 1e-11);
                }
            }
        }
    }
}
