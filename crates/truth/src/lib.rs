//! The simulated world: two vehicles, what pushes them, and what the chaser's sensors say of it.
//!
//! [`Simulation`] runs any mission (`interface::mission`): it owns the time grid, the inputs, the sensor samples and the random
//! streams. The mission's numbers are data; the models are Rust, one file each with a registry line: `environment/` (gravity,
//! third bodies, radiation, drag), `attitude/` (pointing laws), `disturbances/` (burns, vents and their profiles), `sampling/`
//! (sensors and their faults). Filters, FMI and studies are told nothing of what lives here.
//!
//! ```
//! use truth::{Inputs, Params, Simulation};
//!
//! let mut run = Simulation::new(&Params::default(), 0.0, &Inputs::default())?;
//! run.advance_to(10.0, &Inputs::default())?;
//! assert_eq!(run.sample().count, 10);
//! # Ok::<(), truth::TruthError>(())
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod attitude;
mod axes;
mod disturbances;
mod environment;
mod error;
mod initial;
mod inputs;
mod overrides;
mod relative;
mod sampling;
mod simulation;
mod start;
mod timeline;
mod untold;
mod vehicles;
mod world;

pub use disturbances::profiles;
pub use error::TruthError;
pub use inputs::Inputs;
pub use overrides::{Forces, OWN, PARAMETERS, Parameter, Params};
pub use relative::Relative;
pub use sampling::{AccelerometerSample, SensorSample};
pub use simulation::{Moment, Simulation};
pub use timeline::{Event, Push, Side, Thrust, Timeline, Turning, Vector};
pub use untold::Untold;
pub use vehicles::Vehicles;
