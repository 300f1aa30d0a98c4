//! Places of Sun, Earth and Moon from the pages of an almanac, against their series.

use super::*;

const START: &str = "epoch_utc = \"2021-06-01T06:00:00\"";

/// The same world, in which the series are summed each time.
fn summed(world: &World) -> World {
    World {
        environment: world.environment.without_pages(),
        ..world.clone()
    }
}

fn about_the_moon() -> World {
    surrounded(
        &format!("{MOON}\nthird_bodies = [\"sun\", \"earth\"]\nradiation = {{}}"),
        START,
    )
}

/// Over three orbits, at all times of the years for which there are series.
#[test]
fn places_on_a_page_are_those_of_the_series() {
    let earth = format!("{}\nthird_bodies = [\"moon\", \"sun\"]", MOON.replace("moon", "earth"));
    let moon = format!("{MOON}\nthird_bodies = [\"earth\", \"sun\"]");
    let (mut near, mut sun) = (0.0_f64, 0.0_f64);
    for (year, month) in [(1900, 1), (1953, 9), (2000, 1), (2020, 4), (2021, 11), (2100, 12)] {
        let date = format!("epoch_utc = \"{year}-{month:02}-03T04:05:06\"");
        for of in [&earth, &moon] {
            let world = surrounded(of, &date);
            let reference = summed(&world);
            for t in (0..DURATION).step_by(7).map(f64::from) {
                let (page, series) = (world.sky(t), reference.sky(t));
                let off = |body: usize| (page.places[body] - series.places[body]).norm();
                near = near.max(off(0));
                sun = sun.max(off(1));
            }
        }
    }
    // Rounding of either: a century off J2000.0 days come in steps of 6e-7 s, in which the Moon goes 0.6 mm and the Sun 19 mm,
    // and the largest argument of either series in steps of 1e-12 and 1.3e-13 rad, 0.4 mm and 19 mm. Five of each, which is
    // 1e-11 and 1e-12 of the distance, and three times that of the tide.
    assert!(near < 5e-3 && sun < 0.19, "{near} and {sun} m");
    assert!(near > 0.0 && sun > 0.0, "pages are in use");
}

/// The end of a flight without events.
fn fly(world: &World, mission: &Mission, start: Vehicles) -> Vehicles {
    let (mut sky, mut state) = (world.sky(0.0), start);
    for _ in 0..(mission.time.duration_s / world.grid) as u64 {
        world.step(&mut sky, &mut state, &Push::default(), world.grid);
    }
    state
}

/// Largest distance of either vehicle from where the other flight has it, m.
fn apart(one: &Vehicles, other: &Vehicles) -> f64 {
    (one.r_t - other.r_t).norm().max((one.r_c - other.r_c).norm())
}

/// The path of the formation, which has everything in its sky, with the series summed each time.
#[test]
fn formation_flies_as_with_the_series() {
    let (world, state, _, mission) = begin(&Params::of_scenario(3));
    let off = apart(&fly(&world, &mission, state), &fly(&summed(&world), &mission, state));
    // 3e-11 of a tide of 1e-6 m/s2, all one way over six hours, would be 7e-9 m: a few steps in the digits of the position.
    assert!(off < 1e-8, "{off}");
}

/// Two days on an orbit that makes much of every digit: pages do not change more than the last digit of the start does.
#[test]
fn elliptic_orbit_is_flown_as_with_the_series() {
    let text = interface::mission::embedded("elliptic_rendezvous").unwrap().text;
    let mission = Mission::parse("elliptic_rendezvous", text).unwrap();
    let world = World::new(&mission).unwrap();
    let state = start(&mission, &world, &Timeline::default()).unwrap();
    let end = fly(&world, &mission, state);
    let off = apart(&end, &fly(&summed(&world), &mission, state));
    let mut other = state;
    other.v_t.y = other.v_t.y.next_up();
    other.v_c.y = other.v_c.y.next_up();
    let digit = apart(&end, &fly(&world, &mission, other));
    assert!(off < digit && digit < 1e-3, "{off} and {digit} m");
}

/// Before the start and after the mission's end there are no pages, and nothing jumps there by more than digits.
#[test]
fn outside_the_mission_the_series_are_summed() {
    let world = about_the_moon();
    let reference = summed(&world);
    let last = 7.0 * 3600.0;
    for t in [-1e6, -1e-9, last, 1e7, f64::INFINITY, f64::NAN] {
        let (here, there) = (world.sky(t).places, reference.sky(t).places);
        assert_eq!(
            here.map(|place| place.map(f64::to_bits)),
            there.map(|place| place.map(f64::to_bits)),
            "{t}"
        );
    }
    for edge in [0.0, 3600.0, last] {
        let (before, after) = (world.sky(edge - 1e-6), world.sky(edge + 1e-6));
        for (a, b) in before.places.iter().zip(after.places) {
            assert!((a - b).norm() < 0.3, "30 km/s for 2 microseconds: {a} and {b}");
        }
    }
}

/// What a saved world is made of again gives the same to the bit, whatever either has been asked for before.
#[test]
fn worlds_are_saved_with_their_sky() {
    let world = about_the_moon();
    let later = world.sky(20_000.0);
    let copy = world.clone();
    let again: World = postcard::from_bytes(&postcard::to_stdvec(&world).unwrap()).unwrap();
    assert_eq!(world, again);
    for t in [1234.5, 0.0, 3599.0, 3601.0] {
        assert_eq!(world.sky(t), again.sky(t));
        assert_eq!(copy.sky(t), again.sky(t));
    }
    assert_eq!(later, again.sky(20_000.0));
    assert!(world.sky(0.0).places.iter().all(|place| place.norm() > 3e8));
}
