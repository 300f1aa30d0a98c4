//! A part of the reproduction, and what all parts share.

use super::notebook::{Laboratory, Notebook};
use super::request::Request;
use crate::HarnessError;

/// The paper of the venting scenarios.
pub(crate) const MILTON_PAPER: &str = "Mamich and Zanetti";
/// The paper of the formation.
pub(crate) const NETWORK_PAPER: &str = "Pesce, Silvestrini and Lavagna";

/// Largest difference from a table of that paper, as a share of it.
pub(crate) const SHARE: f64 = 0.15;

/// A part of the reproduction.
pub struct Chapter {
    /// Its heading.
    pub title: &'static str,
    /// The studies it runs, and what it only flies for the truth of run 0.
    pub requests: fn() -> Vec<Request>,
    /// Runs them and writes down what they show.
    pub write: fn(&mut dyn Laboratory, &mut Notebook) -> Result<(), HarnessError>,
}
