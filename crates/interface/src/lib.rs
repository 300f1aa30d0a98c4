//! The contract of the project, said once and used by both FMUs and by the harness: what a mission file may say, which
//! quantities cross between models, what a status means and which values are accepted.
//!
//! Nothing here computes motion, estimates or statistics.

pub mod annotation;
