//! What a mission must satisfy beyond its syntax. Every finding is reported, not the first alone.

use std::collections::BTreeSet;

use super::events::{Distribution, FirstTable, Which};
use super::{
    At, Axes, Body, Burn, First, Frame, Gravity, Magnitude, Mission, Orbit, Profile, Sensor, UnitsChoice, Vehicle, Vent,
};
use crate::bound::Bound;

/// Something that is wrong.
pub(super) struct Finding {
    /// The key.
    pub path: String,
    /// What is wrong and what is allowed.
    pub what: String,
}

/// Most vents of one kind and epochs of one run: a slip in a period should not fill the memory.
const MOST_VENTS: u32 = 100_000;
const MOST_INTERVALS: f64 = 1e8;

/// Most passes of an update; it is done or does not converge long before.
const MOST_PASSES: u32 = 100;

/// Years of which the places of Sun and Moon are given.
const YEARS: std::ops::RangeInclusive<u16> = 1900..=2100;
/// Times this close are one, s.
const SAME: f64 = 1e-6;

/// Everything that is wrong with a mission.
pub(super) fn findings(mission: &Mission) -> Vec<Finding> {
    let mut c = Check { found: Vec::new() };
    c.head(mission);
    c.time(mission);
    c.gravity(mission, "environment.gravity", &mission.environment.gravity);
    c.environment(mission);
    c.vehicles(mission);
    c.burns(mission);
    c.vents(mission);
    c.unmodelled(mission);
    c.sensors(mission);
    c.navigation(mission);
    c.study(mission);
    c.found
}

struct Check {
    found: Vec<Finding>,
}

impl Check {
    fn say(&mut self, path: impl Into<String>, what: impl Into<String>) {
        self.found.push(Finding {
            path: path.into(),
            what: what.into(),
        });
    }

    /// Holds a value against its bound; the unit is read off the key.
    fn hold(&mut self, path: impl Into<String>, value: f64, bound: Bound) {
        let path = path.into();
        if !bound.allows(value) {
            let what = format!("{path} = {value}: it must be {}", bound.words(unit(&path)));
            self.say(path, what);
        }
    }

    fn hold_some(&mut self, path: impl Into<String>, value: Option<f64>, bound: Bound) {
        if let Some(value) = value {
            self.hold(path, value, bound);
        }
    }

    fn direction(&mut self, path: String, direction: &[f64; 3]) {
        if direction.iter().all(|v| *v == 0.0) {
            self.say(path.clone(), format!("{path} is zero: it must point somewhere"));
        }
    }

    fn head(&mut self, mission: &Mission) {
        if mission.mission != super::FORMAT {
            let what = format!(
                "mission = {} is no format: it must be {}",
                mission.mission,
                super::FORMAT
            );
            self.say("mission", what);
        }
        self.name("name", &mission.name);
    }

    fn name(&mut self, path: impl Into<String>, name: &str) {
        let sound = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
        if !sound {
            self.say(path, format!("name {name:?}: it must be letters, digits, `_` and `-`"));
        }
    }

    fn time(&mut self, mission: &Mission) {
        let time = &mission.time;
        self.hold("time.duration_s", time.duration_s, Bound::Positive);
        self.hold("time.sample_period_s", time.sample_period_s, Bound::AtLeast(1e-3));
        self.hold("time.grid_s", time.grid_s, Bound::AtLeast(1e-4));
        self.hold("time.scored_from_s", time.scored_from_s, Bound::NonNegative);
        if time.scored_from_s >= time.duration_s {
            let what = format!(
                "time.scored_from_s = {}: it must lie before the end of the run at {} s",
                time.scored_from_s, time.duration_s
            );
            self.say("time.scored_from_s", what);
        }
        if time.duration_s / time.grid_s > MOST_INTERVALS {
            let what = format!(
                "time.grid_s = {} cuts the run into more than {MOST_INTERVALS} intervals",
                time.grid_s
            );
            self.say("time.grid_s", what);
        }
        self.epoch(mission);
        let at_end = [&mission.target, &mission.chaser].map(|v| v.orbit.as_ref().is_some_and(|o| o.at.is_end()));
        let whole = (time.duration_s / time.grid_s).round() * time.grid_s;
        if at_end.contains(&true) && (time.duration_s - whole).abs() > SAME {
            let what = format!(
                "time.grid_s = {}: orbits with at = \"end\" are taken back from the end of the run, so time.duration_s = {} must be \
                 a multiple of it",
                time.grid_s, time.duration_s
            );
            self.say("time.grid_s", what);
        }
    }

    /// The date, where one is given or needed.
    fn epoch(&mut self, mission: &Mission) {
        let (environment, body) = (&mission.environment, mission.environment.body);
        if let Some(text) = &mission.time.epoch_utc {
            if let Some(wrong) = wrong_with_date(text) {
                let what = format!(
                    "time.epoch_utc = {text:?} {wrong}: it must be year, month, day and time of day in universal time, as in \
                     \"2020-01-01T00:00:00\""
                );
                self.say("time.epoch_utc", what);
            }
            return;
        }
        let turns_as_body = environment.rotation.is_none() && body != Body::Other;
        let reasons = [
            (!environment.third_bodies.is_empty(), "the places of Sun and Moon"),
            (environment.radiation.is_some(), "the place of the Sun"),
            (turns_with_body(mission) && turns_as_body, "the turn of the body's axes"),
            (
                environment.drag.is_some() && turns_as_body && body != Body::Earth,
                "the turn of the air",
            ),
        ];
        if let Some((_, reason)) = reasons.into_iter().find(|(needed, _)| *needed) {
            let what = format!("time.epoch_utc is missing: {reason} needs a date, as \"2020-01-01T00:00:00\"");
            self.say("time", what);
        }
    }

    fn gravity(&mut self, mission: &Mission, path: &str, gravity: &Gravity) {
        match gravity {
            Gravity::TwoBody(g) => {
                self.hold(format!("{path}.mu_m3_s2"), g.mu_m3_s2, Bound::Positive);
                self.hold(format!("{path}.radius_m"), g.radius_m, Bound::Positive);
            }
            Gravity::Zonal(g) => {
                self.hold(format!("{path}.mu_m3_s2"), g.mu_m3_s2, Bound::Positive);
                self.hold(format!("{path}.radius_m"), g.radius_m, Bound::Positive);
                if g.j.is_empty() || g.j.len() > 5 {
                    let what = format!("{path}.j has {} entries: J2 to J6 at most, one at least", g.j.len());
                    self.say(format!("{path}.j"), what);
                }
            }
            Gravity::Harmonics(g) => {
                match (&g.field, &g.file) {
                    (Some(field), None) if field != "egm96_3x3" => {
                        let what =
                            format!("{path}.field = {field:?} is not known: it must be \"egm96_3x3\", or give a file");
                        self.say(format!("{path}.field"), what);
                    }
                    (None, Some(file)) if !mission.locate(file).is_file() => {
                        let what = format!("{path}.file: there is no file {}", mission.locate(file).display());
                        self.say(format!("{path}.file"), what);
                    }
                    (None, None) | (Some(_), Some(_)) => {
                        self.say(path, format!("{path}: give either field or file"));
                    }
                    _ => (),
                }
                if g.degree.is_some_and(|n| !(2..=20).contains(&n)) {
                    self.say(format!("{path}.degree"), format!("{path}.degree: it must be 2 to 20"));
                }
                if g.order.is_some_and(|m| m > g.degree.unwrap_or(20)) {
                    self.say(
                        format!("{path}.order"),
                        format!("{path}.order: it must be at most the degree"),
                    );
                }
            }
            Gravity::Cr3bp(g) => {
                self.hold(format!("{path}.mass_ratio"), g.mass_ratio, Bound::Positive);
                if g.mass_ratio > 0.5 {
                    let what = format!(
                        "{path}.mass_ratio = {}: it must be at most 0.5, the smaller body's share",
                        g.mass_ratio
                    );
                    self.say(format!("{path}.mass_ratio"), what);
                }
                self.hold(format!("{path}.length_m"), g.length_m, Bound::Positive);
                self.hold(format!("{path}.time_s"), g.time_s, Bound::Positive);
            }
        }
    }

    fn environment(&mut self, mission: &Mission) {
        let environment = &mission.environment;
        let cr3bp = environment.gravity.cr3bp().is_some();
        let known: &[&str] = match environment.body {
            Body::Earth => &["sun", "moon"],
            Body::Moon => &["sun", "earth"],
            Body::Other => &[],
        };
        for body in &environment.third_bodies {
            if cr3bp {
                self.say(
                    "environment.third_bodies",
                    "environment.third_bodies: none beside the two bodies of cr3bp",
                );
            } else if !known.contains(&body.as_str()) {
                let what = format!(
                    "environment.third_bodies: {body:?} is not known about body = {:?}: it must be one of {known:?}",
                    environment.body
                );
                self.say("environment.third_bodies", what);
            }
        }
        if environment.radiation.is_some() && (cr3bp || environment.body == Body::Other) {
            self.say(
                "environment.radiation",
                "environment.radiation: the Sun's place is known about the Earth and the Moon only",
            );
        }
        let mut named = BTreeSet::new();
        if let Some(twice) = environment.third_bodies.iter().find(|body| !named.insert(*body)) {
            let what = format!("environment.third_bodies: {twice:?} is named twice");
            self.say("environment.third_bodies", what);
        }
        if turns_with_body(mission) && environment.body == Body::Other && environment.rotation.is_none() {
            self.say(
                "environment.gravity",
                "environment.rotation is missing: nothing is known of how the axes of body = \"other\" turn, as { rate_deg_s = 0.004 }",
            );
        }
        let Some(drag) = environment.drag else { return };
        let layer = [drag.density_kg_m3, drag.reference_altitude_m, drag.scale_height_m];
        let given = layer.iter().flatten().count();
        if given != 0 && given != 3 {
            self.say(
                "environment.drag",
                "environment.drag: density_kg_m3, reference_altitude_m and scale_height_m go together",
            );
        }
        if cr3bp || (given == 0 && environment.body != Body::Earth) {
            self.say("environment.drag", "environment.drag: only the Earth's air is known; for another body state density_kg_m3, reference_altitude_m, scale_height_m");
        }
        if given == 0 && environment.rotation.is_some() {
            self.say(
                "environment.rotation",
                "environment.rotation: the Earth's air turns with the Earth; leave it out, or state density_kg_m3, \
                 reference_altitude_m and scale_height_m of the air",
            );
        }
        self.hold_some("environment.drag.density_kg_m3", drag.density_kg_m3, Bound::Positive);
        self.hold_some("environment.drag.scale_height_m", drag.scale_height_m, Bound::Positive);
    }

    fn vehicles(&mut self, mission: &Mission) {
        for (name, vehicle) in [("target", &mission.target), ("chaser", &mission.chaser)] {
            self.hold(format!("{name}.mass_kg"), vehicle.mass_kg, Bound::AtLeast(1e-3));
            self.hold(format!("{name}.area_m2"), vehicle.area_m2, Bound::NonNegative);
            self.hold(format!("{name}.cd"), vehicle.cd, Bound::NonNegative);
            self.hold(format!("{name}.cr"), vehicle.cr, Bound::NonNegative);
            match (&vehicle.orbit, &vehicle.relative) {
                (Some(orbit), None) => self.orbit(name, orbit, mission),
                (None, Some(_)) => (),
                _ => self.say(name, format!("{name}: give either {name}.orbit or {name}.relative")),
            }
        }
        let (target, chaser) = (&mission.target, &mission.chaser);
        if target.orbit.is_none() && chaser.orbit.is_none() {
            self.say(
                "chaser",
                "neither vehicle has an orbit: give one [target.orbit] or [chaser.orbit]",
            );
        }
        let at = |v: &Vehicle| v.orbit.as_ref().map(|o| o.at).or(v.relative.map(|r| r.at));
        if at(target).is_some() && at(chaser).is_some() && at(target) != at(chaser) {
            self.say(
                "chaser",
                "target and chaser are given at different times: both `at` must be \"start\" or both \"end\"",
            );
        }
    }

    fn orbit(&mut self, name: &str, orbit: &Orbit, mission: &Mission) {
        let path = format!("{name}.orbit");
        match (&orbit.elements, &orbit.state) {
            (Some(e), None) => {
                let path = format!("{path}.elements");
                if mission.environment.gravity.cr3bp().is_some() {
                    self.say(
                        path.clone(),
                        format!("{path}: the three-body problem has none; give {name}.orbit.state"),
                    );
                }
                self.hold(format!("{path}.a_m"), e.a_m, Bound::Positive);
                if !(0.0..1.0).contains(&e.e) {
                    self.say(
                        format!("{path}.e"),
                        format!("{path}.e = {}: it must be at least 0 and below 1", e.e),
                    );
                } else if let Some(radius) = mission.environment.gravity.radius_m()
                    && e.a_m * (1.0 - e.e) < radius
                {
                    let what = format!(
                        "{path}: periapsis at {:.4e} m lies below the surface at {radius:.4e} m",
                        e.a_m * (1.0 - e.e)
                    );
                    self.say(path.clone(), what);
                }
                if e.mean_anomaly_deg.is_some() == e.true_anomaly_deg.is_some() {
                    self.say(
                        path.clone(),
                        format!("{path}: give either mean_anomaly_deg or true_anomaly_deg"),
                    );
                }
            }
            (None, Some(s)) => {
                let si = (s.r_m.is_some(), s.v_m_s.is_some());
                let nd = (s.r_nd.is_some(), s.v_nd.is_some());
                let cr3bp = mission.environment.gravity.cr3bp().is_some();
                let sound = match (si, nd) {
                    ((true, true), (false, false)) => true,
                    ((false, false), (true, true)) => cr3bp,
                    _ => false,
                };
                let path = format!("{path}.state");
                if !sound {
                    self.say(
                        path.clone(),
                        format!("{path}: give r_m and v_m_s (in cr3bp also r_nd and v_nd)"),
                    );
                }
                if let (Some(r), Some(radius)) = (s.r_m, mission.environment.gravity.radius_m())
                    && r.iter().map(|x| x * x).sum::<f64>().sqrt() < radius
                {
                    self.say(
                        path.clone(),
                        format!("{path}.r_m lies below the surface at {radius:.4e} m"),
                    );
                } else if let (Some(r), Some(v)) = (s.r_m, s.v_m_s) {
                    self.periapsis(&path, &r, &v, mission);
                }
            }
            _ => self.say(path.clone(), format!("{path}: give either elements or state")),
        }
    }

    /// Refuses a state whose orbit leads below the surface.
    fn periapsis(&mut self, path: &str, r: &[f64; 3], v: &[f64; 3], mission: &Mission) {
        let gravity = &mission.environment.gravity;
        let (Some(mu), Some(radius)) = (gravity.mu_m3_s2(), gravity.radius_m()) else {
            return;
        };
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (rr, vv, rv) = (dot(r, r), dot(v, v), dot(r, v));
        let momentum = rr * vv - rv * rv;
        let energy = vv / 2.0 - mu / rr.sqrt();
        let e = (1.0 + 2.0 * energy * momentum / (mu * mu)).max(0.0).sqrt();
        let lowest = momentum / mu / (1.0 + e);
        // An open orbit that leads away never comes to its periapsis.
        if lowest < radius && (energy < 0.0 || rv < 0.0) {
            self.say(
                path,
                format!("{path}: periapsis at {lowest:.4e} m lies below the surface at {radius:.4e} m"),
            );
        }
    }

    fn unique<'a>(&mut self, list: &str, names: impl Iterator<Item = &'a str>) {
        let mut seen = BTreeSet::new();
        for (number, name) in (1..).zip(names) {
            self.name(format!("{list}.{number}.name"), name);
            if !seen.insert(name) {
                self.say(
                    format!("{list}.{number}.name"),
                    format!("two entries of [[{list}]] are named {name:?}"),
                );
            }
        }
    }

    fn burns(&mut self, mission: &Mission) {
        self.unique("burn", mission.burns.iter().map(|b| b.name.as_str()));
        let accelerometer = mission.sensors.accelerometer.is_some();
        for burn in &mission.burns {
            let Burn { name, .. } = burn;
            let path = |key: &str| format!("burn.{name}.{key}");
            self.hold(path("start_s"), burn.start_s, Bound::NonNegative);
            self.hold(path("duration_s"), burn.duration_s, Bound::NonNegative);
            self.hold(path("acceleration_m_s2"), burn.acceleration_m_s2, Bound::NonNegative);
            self.direction(path("direction"), &burn.direction);
            let end = burn.start_s + burn.duration_s;
            if end > mission.time.duration_s {
                let what = format!(
                    "burn {name:?} ends at {end} s, after the run ({} s)",
                    mission.time.duration_s
                );
                self.say(path("start_s"), what);
            }
            let lvlh = mission.navigation.frame == Frame::Lvlh;
            if lvlh && burn.told && burn.axes != Axes::Rtn {
                let what = format!(
                    "burn {name:?}: a filter with navigation.frame = \"lvlh\" knows the axes of the orbit alone, so axes of a told \
                     burn must be rtn"
                );
                self.say(path("axes"), what);
            }
            if burn.told && burn.vehicle == Which::Chaser && accelerometer && !lvlh {
                self.say(
                    path("told"),
                    format!("burn {name:?}: the accelerometer tells the filter already; told must be false"),
                );
            }
            if burn.told && burn.axes == Axes::Body && burn.vehicle == Which::Target {
                self.say(path("axes"), format!("burn {name:?}: the filter does not know the target's attitude, so axes of a told burn must be n, inertial or rtn"));
            }
        }
    }

    fn unmodelled(&mut self, mission: &Mission) {
        let unmodelled = &mission.unmodelled;
        for (key, value, bound) in [
            ("wander_sigma_m_s2", unmodelled.wander_sigma_m_s2, Bound::NonNegative),
            (
                "wander_time_constant_s",
                unmodelled.wander_time_constant_s,
                Bound::Positive,
            ),
            ("white_m_s1_5", unmodelled.white_m_s1_5, Bound::NonNegative),
        ] {
            self.hold(format!("unmodelled.{key}"), value, bound);
        }
    }

    fn vents(&mut self, mission: &Mission) {
        self.unique("vent", mission.vents.iter().map(|v| v.name.as_str()));
        for vent in &mission.vents {
            self.vent(mission, vent);
        }
    }

    fn vent(&mut self, mission: &Mission, vent: &Vent) {
        let path = |key: &str| format!("vent.{}.{key}", vent.name);
        self.hold(path("duration_s"), vent.duration_s, Bound::Positive);
        self.direction(path("direction_body"), &vent.direction_body);
        self.hold(
            path("direction_sigma_deg"),
            vent.direction_sigma_deg,
            Bound::NonNegative,
        );
        if vent.count == 0 || vent.count > MOST_VENTS {
            self.say(
                path("count"),
                format!("{} = {}: it must be 1 to {MOST_VENTS}", path("count"), vent.count),
            );
        }
        self.hold_some(path("period_s"), vent.period_s, Bound::Positive);
        if vent.count > 1 && vent.period_s.is_none() {
            self.say(
                path("count"),
                format!("vent {:?}: several vents need period_s", vent.name),
            );
        }
        match vent.profile {
            Profile::OnOff => (),
            Profile::DecayS(time) => self.hold(path("profile.decay_s"), time, Bound::Positive),
            Profile::RampS(time) => {
                self.hold(path("profile.ramp_s"), time, Bound::Positive);
                if 2.0 * time > vent.duration_s {
                    self.say(
                        path("profile"),
                        format!(
                            "vent {:?}: up and down, two ramps of {time} s do not fit into {} s",
                            vent.name, vent.duration_s
                        ),
                    );
                }
            }
        }
        let size = path("magnitude_m_s2");
        match &vent.magnitude_m_s2 {
            Magnitude::Fixed(value) => self.hold(size, *value, Bound::NonNegative),
            Magnitude::Drawn(Distribution::HalfNormal(sigma)) => self.hold(size, *sigma, Bound::NonNegative),
            Magnitude::Drawn(Distribution::Normal([_, sigma]) | Distribution::Lognormal([_, sigma])) => {
                self.hold(size, *sigma, Bound::NonNegative);
            }
            Magnitude::Drawn(Distribution::Uniform([low, high])) => self.ordered(size, *low, *high),
        }
        let first = path("first_s");
        let latest = match &vent.first_s {
            First::At(t) => {
                self.hold(first.clone(), *t, Bound::NonNegative);
                Some(*t)
            }
            First::From(table) => self.first(mission, vent, &first, table),
        };
        if let Some(latest) = latest {
            let end = latest + vent.period_s.unwrap_or(0.0) * f64::from(vent.count.max(1) - 1) + vent.duration_s;
            if end > mission.time.duration_s {
                let what = format!(
                    "vent {:?} may end at {end} s, after the run ({} s): fewer, earlier or shorter",
                    vent.name, mission.time.duration_s
                );
                self.say(if vent.count > 1 { path("period_s") } else { first }, what);
            }
        }
    }

    fn ordered(&mut self, path: String, low: f64, high: f64) {
        if low > high || low < 0.0 {
            let what = format!("{path} = [{low}, {high}]: it must be two numbers from 0 on, the smaller first");
            self.say(path, what);
        }
    }

    /// Checks a drawn first time; returns the latest it can be.
    fn first(&mut self, mission: &Mission, vent: &Vent, path: &str, table: &FirstTable) -> Option<f64> {
        match table {
            FirstTable {
                uniform_integer: Some([low, high]),
                uniform: None,
                after: None,
                offset_s: None,
            } => {
                self.ordered(path.to_owned(), f64::from(*low), f64::from(*high));
                Some(f64::from(*high))
            }
            FirstTable {
                uniform_integer: None,
                uniform: Some([low, high]),
                after: None,
                offset_s: None,
            } => {
                self.ordered(path.to_owned(), *low, *high);
                Some(*high)
            }
            FirstTable {
                uniform_integer: None,
                uniform: None,
                after: Some(other),
                offset_s,
            } => {
                let before = mission.vents.iter().take_while(|v| v.name != vent.name);
                let Some(found) = before.into_iter().find(|v| v.name == *other) else {
                    let what = format!(
                        "vent {:?} comes after {other:?}: that must be a vent that stands above it",
                        vent.name
                    );
                    self.say(path, what);
                    return None;
                };
                self.hold_some(format!("{path}.offset_s"), *offset_s, Bound::NonNegative);
                let offset = offset_s.unwrap_or(0.0);
                latest_first(mission, found).map(|t| t + offset)
            }
            _ => {
                let what = format!(
                    "{path}: give exactly one of uniform_integer = [a, b], uniform = [a, b], or after = \"name\" with offset_s"
                );
                self.say(path, what);
                None
            }
        }
    }

    fn sensors(&mut self, mission: &Mission) {
        let s = &mission.sensors;
        if !s.see_the_target() {
            let what = format!(
                "no sensor sees the target: give one at least of {}",
                tables(&Sensor::ALL)
            );
            self.say("sensors", what);
        }
        if s.metrology.is_some() && mission.environment.gravity.cr3bp().is_some() {
            self.say(
                "sensors.metrology",
                "sensors.metrology: it measures in the axes of an orbit about one body, which the three-body problem has not",
            );
        }
        let angles_alone = s.see_the_target() && !s.of_the_target().any(|x| x.sensor.tells_distance());
        let moves = s.accelerometer.is_some() || mission.burns.iter().any(|b| b.vehicle == Which::Chaser);
        if angles_alone && !moves {
            let others: Vec<Sensor> = Sensor::ALL.into_iter().filter(|x| x.tells_distance()).collect();
            let what = format!(
                "angles alone do not show the distance of a target unless the chaser manoeuvres: add one of {}, or a burn of the chaser",
                tables(&others)
            );
            self.say("sensors", what);
        }
        for sensor in s.of_the_target() {
            let name = sensor.sensor.name();
            let path = |key: &str| format!("sensors.{name}.{key}");
            self.hold_some(path("period_s"), sensor.period_s, Bound::AtLeast(1e-3));
            if sensor.period_s.unwrap_or(mission.time.sample_period_s) > mission.time.duration_s {
                let what = format!(
                    "sensors.{name} never samples: its period is longer than the run ({} s)",
                    mission.time.duration_s
                );
                self.say(path("period_s"), what);
            }
            let faults = sensor.faults;
            self.hold(path("max_range_m"), faults.max_range_m, Bound::Positive);
            self.hold(path("dropout_probability"), faults.dropout_probability, Bound::Fraction);
            self.hold(path("outlier_probability"), faults.outlier_probability, Bound::Fraction);
            self.hold(path("outlier_scale"), faults.outlier_scale, Bound::NonNegative);
            for (sigma, value) in sensor.sensor.sigmas().iter().zip(&sensor.sigmas) {
                self.hold(path(sigma.key), *value, Bound::NonNegative);
            }
            if sensor.field_of_view_deg.is_some_and(|deg| !(deg > 0.0 && deg < 180.0)) {
                let path = path("field_of_view_deg");
                self.say(path.clone(), format!("{path}: it must be above 0 and below 180 deg"));
            }
        }
        if let Some(a) = s.accelerometer {
            self.hold_some("sensors.accelerometer.period_s", a.period_s, Bound::AtLeast(1e-3));
            self.hold("sensors.accelerometer.sigma_m_s2", a.sigma_m_s2, Bound::NonNegative);
            self.hold(
                "sensors.accelerometer.bias_sigma_m_s2",
                a.bias_sigma_m_s2,
                Bound::NonNegative,
            );
            self.hold(
                "sensors.accelerometer.bias_time_constant_s",
                a.bias_time_constant_s,
                Bound::Positive,
            );
        }
    }

    fn navigation(&mut self, mission: &Mission) {
        let n = &mission.navigation;
        if let Some(gravity) = &n.gravity {
            self.gravity(mission, "navigation.gravity", gravity);
        }
        let resolved = mission.navigation();
        let cr3bp = mission.environment.gravity.cr3bp().is_some();
        if cr3bp != resolved.gravity.cr3bp().is_some() {
            self.say(
                "navigation.gravity",
                "navigation.gravity: world and filter must both be in cr3bp's rotating axes, or neither",
            );
        }
        if let (Some(world), Some(filter)) = (mission.environment.gravity.cr3bp(), resolved.gravity.cr3bp()) {
            for (key, world, filter) in [
                ("length_m", world.length_m, filter.length_m),
                ("time_s", world.time_s, filter.time_s),
            ] {
                if (world - filter).abs() > 1e-12 * world {
                    let path = format!("navigation.gravity.{key}");
                    let what = format!(
                        "{path} = {filter}: it must be environment.gravity.{key} = {world}; both sides share the rotating axes"
                    );
                    self.say(path, what);
                }
            }
        }
        if n.units == UnitsChoice::Cr3bp && !cr3bp {
            self.say(
                "navigation.units",
                "navigation.units = \"cr3bp\" needs environment.gravity.model = \"cr3bp\"",
            );
        }
        self.hold("navigation.chaser_q_c_m2_s3", n.chaser_q_c_m2_s3, Bound::NonNegative);
        self.hold_some("navigation.reference_orbit_a_m", n.reference_orbit_a_m, Bound::Positive);
        if n.update_passes.is_some_and(|passes| passes > MOST_PASSES) {
            self.say(
                "navigation.update_passes",
                format!("navigation.update_passes: it must be at most {MOST_PASSES}"),
            );
        }
        if n.frame == Frame::Lvlh {
            if mission.sensors.metrology.is_none() {
                self.say(
                    "navigation.frame",
                    "navigation.frame = \"lvlh\" needs [sensors.metrology], which measures in those axes",
                );
            }
            for sensor in mission
                .sensors
                .of_the_target()
                .filter(|x| x.sensor != Sensor::Metrology)
            {
                let path = format!("sensors.{}", sensor.sensor.name());
                let what = format!(
                    "{path}: a filter with navigation.frame = \"lvlh\" uses the metrology alone; take the sensor out or choose frame = \"inertial\""
                );
                self.say(path, what);
            }
            if cr3bp {
                self.say(
                    "navigation.frame",
                    "navigation.frame = \"lvlh\" has no meaning in the three-body problem",
                );
            }
            if resolved.reference_orbit_a_m.is_none() && !cr3bp {
                self.say(
                    "navigation.frame",
                    "navigation.frame = \"lvlh\": give navigation.reference_orbit_a_m, or elements of the target",
                );
            }
        }
        for (section, p0, bound) in [
            ("initial_error", &mission.initial_error, Bound::NonNegative),
            ("navigation.p0", &n.p0, Bound::Positive),
        ] {
            self.hold_some(format!("{section}.sigma_position_m"), p0.sigma_position_m, bound);
            self.hold_some(format!("{section}.sigma_velocity_m_s"), p0.sigma_velocity_m_s, bound);
            self.hold_some(
                format!("{section}.sigma_acceleration_m_s2"),
                p0.sigma_acceleration_m_s2,
                bound,
            );
            self.hold_some(format!("{section}.sigma_bias_m_s2"), p0.sigma_bias_m_s2, bound);
        }
        let b = &n.sensors;
        for sensor in Sensor::ALL {
            for (sigma, value) in sensor.sigmas().iter().zip(b.of(sensor)) {
                self.hold_some(format!("navigation.sensors.{}", sigma.believed), value, Bound::Positive);
            }
        }
        for (key, value) in [
            ("accelerometer_sigma_m_s2", b.accelerometer_sigma_m_s2),
            (
                "accelerometer_bias_time_constant_s",
                b.accelerometer_bias_time_constant_s,
            ),
        ] {
            self.hold_some(format!("navigation.sensors.{key}"), value, Bound::Positive);
        }
        self.hold_some(
            "navigation.sensors.accelerometer_bias_sigma_m_s2",
            b.accelerometer_bias_sigma_m_s2,
            Bound::NonNegative,
        );
        self.hold_some(
            "navigation.sensors.accelerometer_gate_m_s2",
            b.accelerometer_gate_m_s2,
            Bound::NonNegative,
        );
        self.hold(
            "navigation.scale.disturbance_m_s2",
            n.scale.disturbance_m_s2,
            Bound::Positive,
        );
        self.hold(
            "navigation.scale.disturbance_time_s",
            n.scale.disturbance_time_s,
            Bound::Positive,
        );
    }

    fn study(&mut self, mission: &Mission) {
        let study = &mission.study;
        if study.filters.is_empty() {
            self.say("study.filters", "study.filters is empty: name one at least");
        }
        self.unique("study.phase", study.phases.iter().map(|p| p.name.as_str()));
        for phase in &study.phases {
            let place = format!("study.phase.{}", phase.name);
            let ends = [phase.from_s, phase.to_s];
            if let Err(problem) = phase.check() {
                self.say(place, format!("phase {problem}"));
            } else if ends.iter().flatten().any(|t| *t > mission.time.duration_s) {
                let what = format!(
                    "phase {:?}: from_s and to_s must lie in order within the run, 0 to {} s",
                    phase.name, mission.time.duration_s
                );
                self.say(place, what);
            } else if phase.vents.is_some() && mission.navigation.frame == Frame::Lvlh {
                // There the true acceleration is what Clohessy-Wiltshire leaves out, and never nothing.
                let what = format!(
                    "phase {:?}: vents is not known with navigation.frame = \"lvlh\"; give times with from_s and to_s",
                    phase.name
                );
                self.say(place, what);
            }
        }
    }
}

/// The tables of sensors, for a message: "[sensors.lidar], [sensors.camera]".
fn tables(sensors: &[Sensor]) -> String {
    let tables: Vec<String> = sensors.iter().map(|sensor| sensor.table()).collect();
    tables.join(", ")
}

/// Whether a gravity turns with the body's axes: the world's or the one that the filter knows.
fn turns_with_body(mission: &Mission) -> bool {
    let harmonic = |gravity: &Gravity| matches!(gravity, Gravity::Harmonics(_));
    harmonic(&mission.environment.gravity) || mission.navigation.gravity.as_ref().is_some_and(harmonic)
}

/// What is wrong with a date, if something is.
fn wrong_with_date(text: &str) -> Option<String> {
    let date: toml::value::Datetime = match text.parse() {
        Ok(date) => date,
        Err(error) => return Some(format!("is no date ({error})")),
    };
    let (Some(day), Some(time)) = (date.date, date.time) else {
        return Some("lacks the day or the time of day".to_owned());
    };
    if !matches!(date.offset, None | Some(toml::value::Offset::Z)) {
        return Some("has an offset".to_owned());
    }
    if !YEARS.contains(&day.year) {
        return Some(format!("is not in the years {} to {}", YEARS.start(), YEARS.end()));
    }
    (time.second.is_some_and(|s| s > 59)).then(|| "has a leap second".to_owned())
}

/// The latest begin of the first vent of a kind that stands above the present one.
fn latest_first(mission: &Mission, vent: &Vent) -> Option<f64> {
    match &vent.first_s {
        First::At(t) => Some(*t),
        First::From(table) => {
            let own = table
                .uniform_integer
                .map(|[_, high]| f64::from(high))
                .or(table.uniform.map(|[_, high]| high));
            let other = || {
                let before = mission.vents.iter().take_while(|v| v.name != vent.name);
                let found = before.into_iter().find(|v| Some(&v.name) == table.after.as_ref())?;
                Some(latest_first(mission, found)? + table.offset_s.unwrap_or(0.0))
            };
            own.or_else(other)
        }
    }
}

/// The unit that a key ends in, as text.
fn unit(path: &str) -> &'static str {
    const UNITS: &[(&str, &str)] = &[
        ("_m3_s2", "m3/s2"),
        ("_m2_s3", "m2/s3"),
        ("_m_s2", "m/s2"),
        ("_m_s", "m/s"),
        ("_kg_m3", "kg/m3"),
        ("_deg_s", "deg/s"),
        ("_deg", "deg"),
        ("_rad", "rad"),
        ("_kg", "kg"),
        ("_m2", "m2"),
        ("_m", "m"),
        ("_s", "s"),
    ];
    UNITS
        .iter()
        .find(|(end, _)| path.ends_with(end))
        .map_or("", |(_, unit)| unit)
}

impl At {
    /// Whether the start is found by going back.
    pub fn is_end(self) -> bool {
        self == Self::End
    }
}
