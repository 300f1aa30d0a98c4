//! The simulated world: two vehicles, what pushes them, and what the chaser's sensors say of it.
//!
//! [`Simulation`] runs any entry of [`WORLDS`]; it owns the time grid, the inputs, the sensor samples with their faults and
//! the random streams. A world is one file under `worlds/`: its forces, its events and its start. Filters, FMI and studies
//! are told nothing of what lives here. Start reading at [`Simulation`], then `worlds/leo_venting.rs`.

mod error;
mod initial;
mod params;
mod relative;
mod sampling;
mod simulation;
mod timeline;
mod vehicles;
mod vents;
mod world;
mod worlds;

pub use error::TruthError;
pub use initial::InitialSigma;
pub use params::{Bound, CHOICES, Choice, PARAMETERS, Parameter, Params};
pub use relative::Relative;
pub use sampling::{LidarSample, MetrologySample, SensorSample};
pub use simulation::{Inputs, Moment, Simulation};
pub use timeline::{Event, Push, Timeline};
pub use vehicles::Vehicles;
pub use world::{Ambient, Instrument, Scenario, Start, Surroundings, WORLDS, World, WorldEntry};
pub use worlds::formation::Forces;
