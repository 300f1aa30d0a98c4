//! The search for a filter's best tuning: the same for every filter, on worlds of its own.
//!
//! Every filter gets the same number of evaluations. An evaluation is one set of values, run through the same seeded
//! worlds as every other, so that two candidates differ by their values and not by luck. Start reading at
//! [`study::Tuning`]; the algorithm alone is in [`search`], what makes one candidate better than another in
//! [`standing`], the ranges in [`ranges`], who takes part in [`contender`], and what is kept of it all in [`sets`].

pub mod contender;
mod design;
pub mod notes;
pub mod ranges;
pub mod search;
pub mod sets;
pub mod standing;
pub mod study;
