//! What depends on time alone: how the central body has turned and where other bodies are.

use std::sync::{Arc, OnceLock};

use astro::{AstroError, CentralBody, ThirdBody, UniformRotation, attitude, earth_rotation, epoch};
use interface::mission::{self, Mission};
use nalgebra::{Matrix3, SVector, Vector3};
use numerics::Chebyshev;
use serde::{Deserialize, Serialize};

use crate::TruthError;

/// Most bodies beside the central one.
pub(super) const MOST_BODIES: usize = 2;

/// Length of a page of the almanac, s.
const PAGE_S: f64 = 3600.0;

/// Epochs of a page at which the series are summed. About the Earth the Moon goes 1 rad in 4.3 days: a page is off by
/// 3.8e8 m (1800 s / 4.3 d)^5 / (2^4 5!), 5e-7 m, less than the digits of its argument, which come in steps of 1e-4 m.
const NODES: usize = 5;

/// Most pages: six weeks.
const MOST_PAGES: f64 = 1000.0;

/// Places of the bodies over a page, one after the other, N, m.
type Page = Chebyshev<NODES, { 3 * MOST_BODIES }>;

/// From what the sky of a mission follows.
///
/// Places of Sun, Earth and Moon are some forty sines each time, and so are interpolated within its pages. A page is written
/// when it is first opened, and depends on the mission and on its number alone: a sky does not know what was asked for before.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Recipe", into = "Recipe")]
pub(crate) struct Almanac {
    recipe: Recipe,
    /// The central body, where its place among the others or its turn matters.
    centre: Option<CentralBody>,
    /// The bodies whose places are asked for.
    bodies: Vec<ThirdBody>,
    /// Pages of the mission's length, which clones share; outside it the series are summed each time.
    pages: Arc<[OnceLock<Page>]>,
}

/// As it is saved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Recipe {
    body: mission::Body,
    /// Julian date of the start.
    epoch_jd: Option<f64>,
    /// Turn of body-fixed axes, where the mission states one.
    rotation: Option<UniformRotation>,
    /// Whether a model asks for the turn.
    turn: bool,
    /// Names of the bodies whose places are asked for.
    bodies: Vec<String>,
    /// Length of the mission, s.
    duration: f64,
}

/// The sky at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sky {
    /// s since the start of the run.
    pub t: f64,
    /// Maps N to body-fixed axes of the central body; zero where no model asks for it.
    pub dcm_f_n: Matrix3<f64>,
    /// Bodies from the central one, N, m, in the order of [`Almanac::bodies`].
    pub places: [Vector3<f64>; MOST_BODIES],
}

/// A sky of which nothing is asked.
const EMPTY: Sky = Sky {
    t: 0.0,
    dcm_f_n: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    places: [Vector3::new(0.0, 0.0, 0.0); MOST_BODIES],
};

impl Almanac {
    /// The almanac that the models of a mission ask for.
    ///
    /// # Errors
    /// When the date makes no sense, or a body is not known or not known about this centre.
    pub(super) fn of(mission: &Mission) -> Result<Self, TruthError> {
        let environment = &mission.environment;
        let mut bodies = environment.third_bodies.clone();
        if environment.radiation.is_some() && !bodies.iter().any(|name| name == SUN) {
            bodies.push(SUN.to_owned());
        }
        let date = mission.time.epoch_utc.as_deref();
        let rotation = environment.rotation.map(|r| UniformRotation {
            rate: r.rate_deg_s.to_radians(),
            angle: r.angle_deg.to_radians(),
        });
        let recipe = Recipe {
            body: environment.body,
            epoch_jd: date.map(epoch::julian_date).transpose()?,
            rotation,
            turn: matches!(environment.gravity, mission::Gravity::Harmonics(_)),
            bodies,
            duration: mission.time.duration_s,
        };
        Ok(recipe.try_into()?)
    }

    /// The bodies whose places are in the sky, in their order.
    pub(super) fn bodies(&self) -> &[ThirdBody] {
        &self.bodies
    }

    /// Place of the Sun among them.
    pub(super) fn sun(&self) -> Option<usize> {
        self.bodies.iter().position(|body| body.name() == SUN)
    }

    /// Rate at which the central body turns about z, rad/s; 0 where nothing is known of it.
    pub(super) fn rate(&self) -> f64 {
        /// s; the Moon's pole moves by a ten-thousandth of its turn.
        const SPAN: f64 = 1000.0;
        match (self.recipe.rotation, self.recipe.body, &self.centre) {
            (Some(rotation), ..) => rotation.rate,
            (None, mission::Body::Earth, _) => earth_rotation::RATE,
            (None, _, Some(centre)) => attitude::turn(&centre.dcm_f_n(SPAN), &centre.dcm_f_n(0.0)).norm() / SPAN,
            (None, _, None) => 0.0,
        }
    }

    /// * `t`: s since the start of the run.
    #[inline]
    pub(super) fn at(&self, t: f64) -> Sky {
        let mut sky = Sky { t, ..EMPTY };
        if !self.recipe.turn && self.bodies.is_empty() {
            return sky;
        }
        match (self.recipe.turn, &self.recipe.rotation, &self.centre) {
            (true, Some(rotation), _) => sky.dcm_f_n = rotation.dcm_f_n(t),
            (true, None, Some(centre)) => sky.dcm_f_n = centre.dcm_f_n(t),
            _ => (),
        }
        sky.places = self.places(t);
        sky
    }

    /// Where the bodies are.
    ///
    /// * `t`: s since the start of the run.
    fn places(&self, t: f64) -> [Vector3<f64>; MOST_BODIES] {
        let number = (t / PAGE_S).floor();
        let Some(page) = (number >= 0.0).then(|| self.pages.get(number as usize)).flatten() else {
            return self.summed(t);
        };
        let middle = (number + 0.5) * PAGE_S;
        let page = page.get_or_init(|| {
            Page::through(|s| {
                let places = self.summed(middle + s * (0.5 * PAGE_S));
                SVector::from_fn(|i, _| places[i / 3][i % 3])
            })
        });
        let places = page.at((t - middle) / (0.5 * PAGE_S));
        std::array::from_fn(|body| Vector3::from_fn(|i, _| places[3 * body + i]))
    }

    /// Where they are by their series.
    fn summed(&self, t: f64) -> [Vector3<f64>; MOST_BODIES] {
        let mut places = EMPTY.places;
        if let Some(centre) = &self.centre {
            for (place, body) in places.iter_mut().zip(&self.bodies) {
                *place = centre.position(body, t);
            }
        }
        places
    }

    /// The same without pages, as the reference.
    #[cfg(test)]
    pub(super) fn without_pages(&self) -> Self {
        Self {
            pages: Arc::default(),
            ..self.clone()
        }
    }
}

const SUN: &str = "sun";

impl TryFrom<Recipe> for Almanac {
    type Error = AstroError;

    fn try_from(recipe: Recipe) -> Result<Self, AstroError> {
        let name = match recipe.body {
            mission::Body::Earth => Some("earth"),
            mission::Body::Moon => Some("moon"),
            mission::Body::Other => None,
        };
        let centre = name
            .zip(recipe.epoch_jd)
            .map(|(name, jd)| CentralBody::new(name, jd))
            .transpose()?;
        let bodies = centre
            .iter()
            .flat_map(|centre| recipe.bodies.iter().map(|name| centre.third_body(name)));
        let bodies: Vec<_> = bodies.collect::<Result<_, _>>()?;
        let pages = if bodies.is_empty() {
            0.0
        } else {
            recipe.duration / PAGE_S
        };
        Ok(Self {
            pages: (0..pages.min(MOST_PAGES).ceil() as usize)
                .map(|_| OnceLock::new())
                .collect(),
            bodies,
            centre,
            recipe,
        })
    }
}

impl From<Almanac> for Recipe {
    fn from(almanac: Almanac) -> Self {
        almanac.recipe
    }
}

impl PartialEq for Almanac {
    /// Equal recipes make equal almanacs.
    fn eq(&self, other: &Self) -> bool {
        self.recipe == other.recipe
    }
}
