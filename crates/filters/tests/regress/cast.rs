//! Who runs where.

use super::approach::Approach;
use super::common::navigation;
use super::formation::{Formation, World};
use astro::cr3bp::Cr3bpSystem;
use filters::laws::FILTERS;
use filters::state::State;
use filters::{Navigator, Reading, Sample, Settings};
use interface::mission::Embedded;
use nalgebra::Vector6;

/// Every filter in every mission in which it has a meaning.
pub fn everywhere() -> impl Iterator<Item = (String, Navigator, Box<dyn World>, State)> {
    Embedded::scenarios().flat_map(|entry| {
        let told = navigation(entry.name);
        let meant = FILTERS
            .iter()
            .enumerate()
            .filter(|(_, law)| law.no_meaning_in(&told).is_none());
        let runs = meant.map(|(filter, law)| {
            let settings = Settings {
                filter,
                run: 3,
                ..Settings::default()
            };
            let (world, start) = world(entry.name);
            let nav = Navigator::new(&told, &settings, 0.0).unwrap();
            (format!("{} in {}", law.name, entry.name), nav, world, start)
        });
        runs.collect::<Vec<_>>()
    })
}

fn world(mission: &str) -> (Box<dyn World>, State) {
    match mission {
        "leo_venting" => {
            let chaser = Vector6::new(6.878e6, 0.0, 0.0, 0.0, 7350.0, 1970.0);
            let (world, start) = Approach::new(|r, _| astro::earth::FILTER.acceleration(r), &chaser, [8.0, 0.1]);
            (Box::new(world), start)
        }
        "nrho_venting" => {
            let system = Cr3bpSystem::EARTH_MOON;
            let unit = |i: usize| {
                if i < 3 {
                    system.length
                } else {
                    system.length / system.time
                }
            };
            let chaser = Vector6::new(0.9879, 1.432e-2, 2.009e-3, 7.173e-2, 0.9238, -0.8528);
            let chaser = Vector6::from_fn(|i, _| chaser[i] * unit(i));
            let (world, start) = Approach::new(|r, v| Cr3bpSystem::EARTH_MOON.acceleration(r, v), &chaser, [9.0, 2e-8]);
            (Box::new(world), start)
        }
        _ => {
            let (world, start) = Formation::new(3);
            (Box::new(world), start)
        }
    }
}

/// Nothing is seen of the target.
pub fn lose(sample: &mut Sample) {
    sample.sensors.fill(Reading::Lost);
}
