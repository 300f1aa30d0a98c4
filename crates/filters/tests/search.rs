//! What a search for the best tuning may vary must be legal wherever the filter has a meaning.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use filters::laws::FILTERS;
use filters::tunable::{Kind, Value};
use filters::{Navigator, Settings};
use interface::mission::EMBEDDED;

#[test]
fn every_corner_of_a_search_is_a_legal_tuning() {
    for (filter, entry) in FILTERS.iter().enumerate() {
        for mission in EMBEDDED {
            let told = mission.mission().unwrap().navigation();
            if entry.no_meaning_in(&told).is_some() {
                continue;
            }
            for corner in 0..1_u32 << entry.search.len() {
                let mut settings = Settings {
                    filter,
                    ..Settings::default()
                };
                for (i, range) in entry.search.iter().enumerate() {
                    // A share is a matter of percents, everything else of decades.
                    let least = if range.high <= 1.0 && range.low >= 0.5 {
                        1.1
                    } else {
                        10.0
                    };
                    assert!(
                        0.0 < range.low && least * range.low <= range.high,
                        "{}.{}: too narrow to search",
                        entry.name,
                        range.tunable
                    );
                    let declared = entry.tunables.iter().find(|t| t.name == range.tunable).unwrap();
                    assert!(
                        matches!(declared.kind, Kind::Real { .. }),
                        "{}.{}",
                        entry.name,
                        range.tunable
                    );
                    if let Some((choice, item)) = range.only_with {
                        let declared = entry.tunables.iter().find(|t| t.name == choice).unwrap();
                        let Kind::Choice { items, .. } = declared.kind else {
                            panic!("{}.{choice} is no choice", entry.name);
                        };
                        let place = items.iter().position(|(own, _)| *own == item).unwrap();
                        *settings.tunable_mut(entry.name, choice).unwrap() = Value::Choice(place);
                    }
                    let end = if corner >> i & 1 == 0 { range.low } else { range.high };
                    *settings.tunable_mut(entry.name, range.tunable).unwrap() = Value::Real(end);
                }
                let built = Navigator::new(&told, &settings, 0.0);
                assert!(
                    built.is_ok(),
                    "{} in {}, corner {corner}: {:?}",
                    entry.name,
                    mission.name,
                    built.err()
                );
            }
        }
    }
}
