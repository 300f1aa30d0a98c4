//! When burns and vents happen, as far as the mission tells.

use serde::Serialize;
use serde_json::Value;

/// Time in which something happens.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Event {
    pub name: String,
    /// `burn` or `vent`.
    pub kind: &'static str,
    pub from_s: f64,
    pub to_s: f64,
    /// Whether runs draw the time: then it lies somewhere in the interval.
    pub drawn: bool,
}

/// Burns and vents of a mission as `manifest.json` holds it; what cannot be understood is left out.
pub(crate) fn events(mission: &Value) -> Vec<Event> {
    let list = |key: &str| mission[key].as_array().cloned().unwrap_or_default();
    let mut events: Vec<Event> = list("burn").iter().filter_map(burn).collect();
    let vents = list("vent");
    events.extend(vents.iter().flat_map(|v| repeated(v, &vents)));
    events
}

fn burn(burn: &Value) -> Option<Event> {
    let from_s = burn["start_s"].as_f64()?;
    Some(Event {
        name: burn["name"].as_str()?.to_owned(),
        kind: "burn",
        from_s,
        to_s: from_s + burn["duration_s"].as_f64()?,
        drawn: false,
    })
}

fn repeated(vent: &Value, all: &[Value]) -> Vec<Event> {
    let known = || {
        let first = first(vent, all, all.len())?;
        Some((vent["name"].as_str()?, first, vent["duration_s"].as_f64()?))
    };
    let Some((name, [low, high], duration)) = known() else {
        return Vec::new();
    };
    let count = vent["count"].as_u64().unwrap_or(1);
    let period = vent["period_s"].as_f64().unwrap_or(0.0);
    let event = |n: u64| Event {
        name: name.to_owned(),
        kind: "vent",
        from_s: low + n as f64 * period,
        to_s: high + n as f64 * period + duration,
        drawn: high > low,
    };
    (0..count).map(event).collect()
}

/// Earliest and latest begin of the first vent of a kind, s; `depth` ends references in a circle.
fn first(vent: &Value, all: &[Value], depth: usize) -> Option<[f64; 2]> {
    let told = &vent["first_s"];
    if let Some(at) = told.as_f64() {
        return Some([at, at]);
    }
    for key in ["uniform_integer", "uniform"] {
        if let Some([low, high]) = told[key].as_array().map(Vec::as_slice) {
            return Some([low.as_f64()?, high.as_f64()?]);
        }
    }
    let after = told["after"].as_str()?;
    let other = all.iter().find(|v| v["name"] == after)?;
    let offset = told["offset_s"].as_f64().unwrap_or(0.0);
    let begin = first(other, all, depth.checked_sub(1)?)?;
    Some(begin.map(|t| t + offset))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn burns_vents_and_vents_after_vents_have_their_times() {
        let mission = serde_json::json!({
            "burn": [{"name": "capture", "start_s": 50.0, "duration_s": 5.0}, {"name": "no time"}],
            "vent": [
                {"name": "a", "first_s": {"uniform_integer": [100, 300]}, "count": 2, "period_s": 600.0, "duration_s": 10.0},
                {"name": "b", "first_s": {"after": "a", "offset_s": 40.0}, "duration_s": 1.0},
                {"name": "circle", "first_s": {"after": "circle", "offset_s": 1.0}, "duration_s": 1.0},
            ],
        });
        let times: Vec<_> = events(&mission)
            .iter()
            .map(|e| (e.name.clone(), e.from_s, e.to_s, e.drawn))
            .collect();
        let expected = [
            ("capture", 50.0, 55.0, false),
            ("a", 100.0, 310.0, true),
            ("a", 700.0, 910.0, true),
            ("b", 140.0, 341.0, true),
        ];
        assert_eq!(times, expected.map(|(n, a, b, d)| (n.to_owned(), a, b, d)));
    }
}
