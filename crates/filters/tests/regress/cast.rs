//! Who runs where.

use super::approach::Approach;
use super::common::navigation;
use super::formation::{Formation, World};
use astro::cr3bp::Cr3bpSystem;
use filters::laws::{FILTERS, FilterEntry};
use filters::state::State;
use filters::tunable::{Kind, Value};
use filters::{Navigator, Reading, Sample, Settings};
use interface::mission::Embedded;
use nalgebra::Vector6;

/// A preset that is another law than its filter's first.
const OTHER_LAWS: [(&str, &str); 1] = [("constrained_q", "regression")];

/// Every filter, and every other law, in every mission in which it has a meaning.
pub fn everywhere() -> impl Iterator<Item = (String, Navigator, Box<dyn World>, State)> {
    Embedded::scenarios().flat_map(|entry| {
        let told = navigation(entry.name);
        let meant = FILTERS
            .iter()
            .enumerate()
            .filter(|(_, law)| law.no_meaning_in(&told).is_none());
        let casts = meant.flat_map(|(filter, law)| {
            let others = OTHER_LAWS.iter().filter(|(name, _)| *name == law.name);
            std::iter::once((filter, law, None)).chain(others.map(move |(_, preset)| (filter, law, Some(*preset))))
        });
        let runs = casts.map(|(filter, law, preset)| {
            let mut settings = Settings {
                filter,
                run: 3,
                ..Settings::default()
            };
            for (tunable, text) in preset.map_or(&[][..], |preset| sets(law, preset)) {
                *settings.tunable_mut(law.name, tunable).unwrap() = value(law, tunable, text);
            }
            let (world, start) = world(entry.name, law.bound);
            let nav = Navigator::new(&told, &settings, 0.0).unwrap();
            let label = preset.map_or_else(|| law.name.to_owned(), |preset| format!("{}@{preset}", law.name));
            (format!("{label} in {}", entry.name), nav, world, start)
        });
        runs.collect::<Vec<_>>()
    })
}

fn sets(law: &FilterEntry, preset: &str) -> &'static [(&'static str, &'static str)] {
    law.presets.iter().find(|p| p.name == preset).unwrap().sets
}

fn value(law: &FilterEntry, tunable: &str, text: &str) -> Value {
    match law.tunables.iter().find(|t| t.name == tunable).unwrap().kind {
        Kind::Choice { items, .. } => Value::Choice(items.iter().position(|(item, _)| *item == text).unwrap()),
        kind => panic!("{tunable} is set to {text}, and is {kind:?}"),
    }
}

/// * `pushed`: whether something unannounced pushes the target.
fn world(mission: &str, pushed: bool) -> (Box<dyn World>, State) {
    match mission {
        "leo_venting" => {
            let chaser = Vector6::new(6.878e6, 0.0, 0.0, 0.0, 7350.0, 1970.0);
            let (world, start) =
                Approach::new(|r, _| astro::earth::FILTER.acceleration(r), &chaser, [8.0, 0.1], pushed);
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
            let (world, start) = Approach::new(
                |r, v| Cr3bpSystem::EARTH_MOON.acceleration(r, v),
                &chaser,
                [9.0, 2e-8],
                pushed,
            );
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
