//! Leader and follower on one eccentric orbit: Pesce, Silvestrini and Lavagna, Sec. IV.

use std::sync::LazyLock;

use astro::harmonics::EGM96;
use astro::{
    ClohessyWiltshire, Elements, SphericalHarmonics, ZonalGravity, atmosphere, earth_rotation, epoch, radiation,
    sun_moon,
};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::initial::InitialSigma;
use crate::{Ambient, Instrument, Params, Start, Surroundings, Timeline, TruthError, Vehicles, World, WorldEntry};

/// The registry line.
pub(crate) const ENTRY: WorldEntry = WorldEntry {
    name: "formation",
    about: "leader-follower formation on an eccentric low Earth orbit, relative state measured in full",
    // Three orbits of 7313 s.
    duration: 21_939.0,
    grid: 0.5,
    world: &Formation,
};

/// Orbit of both vehicles (Table 1).
///
/// Deviation: the eccentricity, printed as 0.14, has the digits that Eq. (34) needs.
const AXIS: f64 = 8143.1e3;
const ECCENTRICITY: f64 = 0.1413;
const INCLINATION: f64 = 98.2 * DEGREE;
const ARGUMENT_OF_PERIGEE: f64 = 85.9 * DEGREE;
const NODE: f64 = 79.2 * DEGREE;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// True anomalies at the start (Table 1).
const CHASER_ANOMALY: f64 = 0.0;
const TARGET_ANOMALY: f64 = 1e-4 * DEGREE;

/// Cross sections (Table 1), m2.
const CHASER_AREA: f64 = 1.2;
const TARGET_AREA: f64 = 0.2;

/// Coefficients of radiation pressure and of drag. The paper prints none; these are usual for a compact satellite.
const CR: f64 = 1.3;
const CD: f64 = 2.2;

/// Julian date of the start: 2020 January 1, 0 h. The paper prints none.
const EPOCH_JD: f64 = 2_458_849.5;

static GEOPOTENTIAL: LazyLock<SphericalHarmonics> = LazyLock::new(|| SphericalHarmonics::new(EGM96.coefficients()));
/// What the J2 relative model knows of it.
static OBLATE_EARTH: LazyLock<ZonalGravity> = LazyLock::new(|| ZonalGravity {
    mu: EGM96.mu,
    r_ref: EGM96.r_ref,
    j: [EGM96.j2(), 0.0, 0.0, 0.0, 0.0],
});

/// What acts on both vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Forces {
    /// Everything that Sec. IV.A names.
    #[default]
    Full,
    /// Two-body gravity and J2, the truth of the disturbance experiment (Sec. IV.B).
    J2,
}

impl Forces {
    /// Names and meanings, in the order of the variants.
    pub(crate) const ITEMS: &[(&str, &str)] = &[
        (
            "full",
            "gravity to degree and order 3, Sun and Moon, sunlight with the Earth's shadow, drag",
        ),
        ("j2", "two-body gravity and J2 alone"),
    ];

    /// From a place in [`Forces::ITEMS`], counted from 1; any other means the default.
    pub(crate) fn from_ordinal(ordinal: i32) -> Self {
        match ordinal {
            2 => Self::J2,
            _ => Self::default(),
        }
    }
}

/// Axes N are inertial: Earth-centred, mean equator and equinox of date. The chaser looks at the target.
struct Formation;

impl World for Formation {
    fn start(&self, _params: &Params) -> Result<Start, TruthError> {
        let (r_t, v_t) = orbit(TARGET_ANOMALY).to_state(EGM96.mu)?;
        let (r_c, v_c) = orbit(CHASER_ANOMALY).to_state(EGM96.mu)?;
        Ok(Start {
            state: Vehicles { r_t, v_t, r_c, v_c },
            timeline: Timeline::default(),
        })
    }

    fn surroundings(&self, params: &Params, t: f64, state: &Vehicles) -> Surroundings {
        match params.formation_forces {
            Forces::J2 => Surroundings::field(state, |r, _| OBLATE_EARTH.acceleration(r)),
            Forces::Full => {
                let sky = Sky::at(t);
                Surroundings {
                    target: sky.act_on(&state.r_t, &state.v_t, TARGET_AREA / params.target_mass),
                    chaser: sky.act_on(&state.r_c, &state.v_c, CHASER_AREA / params.chaser_mass),
                }
            }
        }
    }

    fn orbit_normal(&self, r: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        r.cross(v)
    }

    fn instrument(&self) -> Instrument {
        Instrument::Metrology(ClohessyWiltshire::from_semi_major_axis(AXIS, EGM96.mu))
    }

    fn initial_sigma(&self, params: &Params) -> InitialSigma {
        InitialSigma {
            position: params.metrology_sigma_position,
            velocity: params.metrology_sigma_velocity,
            // There is no estimate of either.
            acceleration: 0.0,
            bias: 0.0,
        }
    }
}

fn orbit(true_anomaly: f64) -> Elements {
    Elements {
        a: AXIS,
        e: ECCENTRICITY,
        inclination: INCLINATION,
        node: NODE,
        argument_of_periapsis: ARGUMENT_OF_PERIGEE,
        mean_anomaly: Elements::mean_from_true_anomaly(true_anomaly, ECCENTRICITY),
    }
}

/// What stands about both vehicles at one instant.
struct Sky {
    dcm_f_n: Matrix3<f64>,
    sun: Vector3<f64>,
    moon: Vector3<f64>,
}

impl Sky {
    /// `t`: s since the start of the run.
    fn at(t: f64) -> Self {
        let days = epoch::days_since_j2000(EPOCH_JD, t);
        Self {
            dcm_f_n: earth_rotation::dcm_f_n(days),
            sun: sun_moon::sun(days),
            moon: sun_moon::moon(days),
        }
    }

    /// On a vehicle at `r` with velocity `v`, axes N.
    ///
    /// * `area_per_mass`: cross section over mass, m2/kg.
    fn act_on(&self, r: &Vector3<f64>, v: &Vector3<f64>, area_per_mass: f64) -> Ambient {
        let earth = self.dcm_f_n.tr_mul(&GEOPOTENTIAL.acceleration(&(self.dcm_f_n * r)));
        Ambient {
            gravity: earth
                + sun_moon::third_body(sun_moon::SUN_MU, &self.sun, r)
                + sun_moon::third_body(sun_moon::MOON_MU, &self.moon, r),
            surface: radiation::acceleration(r, &self.sun, EGM96.r_ref, CR * area_per_mass)
                + atmosphere::drag(r, v, CD * area_per_mass),
        }
    }
}
