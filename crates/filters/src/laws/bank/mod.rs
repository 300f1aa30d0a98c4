//! Several filters behind one estimate: what laws share that weigh hypotheses instead of choosing one process noise.
//!
//! The estimator's own mean, the *centre*, is that of the mixture. A [`Member`] is a deviation from the centre with a covariance of
//! its own: all members share the propagation of the mean, its partials F, the rows H and what the chaser's errors add, and each
//! costs two small products a step. After every sample the law hands the mixture back as a [`Replacement`], so that partials are
//! always taken about the best estimate there is. The estimator's own covariance makes its own gain, and serves to tell what the
//! chaser's errors add; what is reported is that of the mixture.
//!
//! Everything is linear in the deviations; they are a few standard deviations long, over which the slopes hold.

mod centre;
mod member;
mod mixture;
mod rows;
mod weights;

pub(super) mod velocity_change;

pub use mixture::Replacement;

pub(super) use centre::{Centre, Shared, white};
pub(super) use member::Member;
pub(super) use mixture::Mixture;
pub(super) use weights::Weights;
