//! Adaptation laws: how a filter chooses its process noise.
//!
//! A law is one file that exports an `ENTRY`, a type with `new` that implements [`Adaptation`], and one line in [`registry`].
//! That line makes it appear in the FMU's `filter` enumeration, its tunables in the model description, and itself in
//! `trade-harness list` and in every test that loops over [`FILTERS`].

mod adaptation;
mod bank;
mod change_point;
mod clairvoyant;
mod constrained_q;
pub mod correlation;
mod dmc;
mod ekf_j2;
mod entry;
mod fixed_q;
mod hybrid;
mod imm;
mod learner;
mod milton;
mod mmae;
pub mod network;
mod observer;
mod rbfnn_aekf;
mod rbfnn_ekf;
pub mod registry;
mod snc;
mod step_noise;
mod times_known;
mod window;

pub use adaptation::{Adaptation, Hindsight, Setup, Step};
pub use bank::Replacement;
pub use entry::{FilterEntry, Motion, Search, Update};
pub use registry::{FILTERS, Law};
