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
pub(crate) use bank::positive;
pub use entry::{FilterEntry, Motion, Search, Update};
pub use registry::{FILTERS, Law};

/// The law of the examples, compiled here so that it never falls behind what a law is.
#[cfg(test)]
#[path = "../../../../examples/02_own_law/covariance_matching.rs"]
mod example;

#[cfg(test)]
mod tests {
    use super::example::{CovarianceMatching, ENTRY};
    use super::{Adaptation, FILTERS, Setup};
    use crate::error::FilterError;

    #[test]
    fn the_law_of_the_examples_is_one_that_could_be_registered() {
        fn is_a_law<L: Adaptation>(_: fn(&Setup<'_>) -> Result<L, FilterError>) {}
        is_a_law(CovarianceMatching::new);
        assert!(FILTERS.iter().all(|entry| entry.name != ENTRY.name));
        assert_eq!(ENTRY.presets[0].name, "paper");
    }
}
