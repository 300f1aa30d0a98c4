//! What pushes the vehicles beside their surroundings: burns and vents, drawn once for a run.

mod burns;
pub mod profiles;
pub(crate) mod unmodelled;
mod vents;

use numerics::Generator;
use numerics::streams::{Source, named_stream, stream};

use crate::overrides::Run;
use crate::timeline::{Event, Side, Timeline, Vector};

/// The events of a run.
pub(crate) fn schedule(run: &Run) -> Timeline {
    let mut events = vents::draw(run);
    events.extend(run.mission.burns.iter().map(burns::event));
    if run.target_burn.duration > 0.0 {
        events.push(Event {
            start: run.target_burn.start,
            duration: run.target_burn.duration,
            profile: profiles::Profile::OnOff(profiles::OnOff),
            side: Side::Target,
            acceleration: Vector::N(run.target_burn.a_t_n),
            back_propagated: false,
            told: false,
        });
    }
    Timeline::new(events)
}

/// The stream of a cause for an entry of the mission; those that the papers' missions had before entries had names.
fn entry_stream(run: &Run, source: Source, name: &str) -> Generator {
    let plain = match (source, name) {
        (Source::VentTiming, "co2") => Some(Source::VentTiming),
        (Source::VentSize, "co2") => Some(Source::VentSizeCo2),
        (Source::VentSize, "waste_water") => Some(Source::VentSizeWater),
        _ => None,
    };
    match plain {
        Some(plain) => stream(run.study_seed, run.run, plain),
        None => named_stream(run.study_seed, run.run, source, name),
    }
}
