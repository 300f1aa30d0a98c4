//! The worlds that our FMUs simulate: one constructor each, found by name.

use astro::cr3bp::{EARTH_MOON_LENGTH, EARTH_MOON_MASS_RATIO, EARTH_MOON_TIME};

use crate::arguments::FilterChoice;
use crate::error::StudyError;
use crate::world::{Axes, Frame, World};

/// Every world, in the order lists show them.
pub fn all() -> Vec<World> {
    vec![leo_venting(), nrho_venting(), formation()]
}

/// The world of this name.
///
/// # Errors
/// [`StudyError::UnknownScenario`], with the names that exist.
pub fn find(name: &str) -> Result<World, StudyError> {
    let worlds = all();
    let known = worlds.iter().map(|w| w.name.as_str()).collect::<Vec<_>>().join(", ");
    let found = worlds.into_iter().find(|w| w.name == name);
    found.ok_or_else(|| StudyError::UnknownScenario {
        name: name.to_owned(),
        known,
    })
}

/// Rendezvous in low Earth orbit with a target that vents.
pub fn leo_venting() -> World {
    World {
        name: "leo_venting".to_owned(),
        about: "Chaser approaches a target that vents CO2 every 600 s and waste water once; flash LiDAR and accelerometer at 1 Hz"
            .to_owned(),
        reference: "Mamich and Zanetti, Sec. IV, Tables 1-4, Figs. 1-6".to_owned(),
        duration_s: 5680.0,
        scored_from_s: 300.0,
        sample_period_s: 1.0,
        frame: Frame::Inertial,
        axes: Axes::Rtn,
        nis_rows: 3,
        filters: filters(&VENTING_FILTERS),
    }
}

/// Rendezvous on a near-rectilinear halo orbit of the Moon with a target that vents.
pub fn nrho_venting() -> World {
    World {
        name: "nrho_venting".to_owned(),
        about:
            "Chaser approaches a venting target near the Moon; dynamics and adaptation in rotating nondimensional axes"
                .to_owned(),
        reference: "Mamich and Zanetti, Sec. IV.B, Tables 5-7, Figs. 8-13".to_owned(),
        duration_s: 5500.0,
        scored_from_s: 300.0,
        sample_period_s: 1.0,
        frame: Frame::Inertial,
        axes: Axes::RtnRotating {
            body_x_m: (1.0 - EARTH_MOON_MASS_RATIO) * EARTH_MOON_LENGTH,
            time_per_radian_s: EARTH_MOON_TIME,
        },
        nis_rows: 3,
        filters: filters(&VENTING_FILTERS),
    }
}

/// Leader and follower on one eccentric orbit, seen by a relative metrology.
pub fn formation() -> World {
    World {
        name: "formation".to_owned(),
        about: "Two spacecraft 12 m apart on an eccentric orbit; relative position and velocity are measured in full at 1 Hz"
            .to_owned(),
        reference: "Pesce, Silvestrini and Lavagna, Sec. IV, Tables 1-4, Figs. 4-7".to_owned(),
        duration_s: 21939.0,
        scored_from_s: 300.0,
        sample_period_s: 1.0,
        frame: Frame::Lvlh,
        axes: Axes::Lvlh,
        nis_rows: 6,
        filters: filters(&[
            "snc",
            "fixed_q",
            "rbfnn_aekf",
            "rbfnn_aekf@repaired",
            "rbfnn_ekf",
            "observer",
            "ekf_j2",
        ]),
    }
}

/// Filters compared in the venting worlds.
const VENTING_FILTERS: [&str; 5] = [
    "fixed_q",
    "fixed_q@small",
    "milton",
    "milton@consistent",
    "constrained_q",
];

fn filters(labels: &[&str]) -> Vec<FilterChoice> {
    labels.iter().filter_map(|label| label.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_world_is_found_by_its_name_and_scores_something() {
        for world in all() {
            assert_eq!(find(&world.name).unwrap(), world);
            assert!(world.scored_from_s < world.duration_s, "{}", world.name);
            // A label that could not be read would be missing.
            let filters = if world.frame == Frame::Lvlh { 7 } else { 5 };
            assert_eq!(world.filters.len(), filters, "{}", world.name);
        }
        let error = find("leo_vent").unwrap_err().to_string();
        assert!(error.contains("leo_vent") && error.contains("leo_venting"), "{error}");
    }
}
