//! The contract of the project, said once and used by both FMUs and by the harness: what a mission file may say, which
//! quantities cross between models, what a status means and which values are accepted.
//!
//! Nothing here computes motion, estimates or statistics. Start reading at [`mission::Mission`].

pub mod annotation;
pub mod bound;
pub mod mission;
pub mod ports;
pub mod render;
pub mod signals;
pub mod status;
pub mod text;

pub use bound::{Bound, OutOfRange};
pub use mission::{Mission, MissionError, Navigation, Sensor};
pub use signals::Signals;
pub use status::Status;
