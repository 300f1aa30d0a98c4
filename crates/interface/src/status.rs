//! What a filter says of itself.

use serde::{Deserialize, Serialize};

/// Items of the `status` enumeration. Matched by name; a plain Integer counts in this order from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Waiting for the first sample.
    Initialising,
    /// The newest sample was measured and used.
    Tracking,
    /// A sensor was due and nothing was measured.
    Coasting,
    /// Innovations are far larger than the filter expects.
    Diverged,
    /// No new sample for three periods.
    Stale,
}

impl Status {
    /// Every item with its name and meaning, in order.
    pub const ALL: [(Self, &'static str, &'static str); 5] = [
        (Self::Initialising, "initialising", "no sample yet"),
        (Self::Tracking, "tracking", "newest sample used"),
        (
            Self::Coasting,
            "coasting",
            "newest sample had no measurement of the target",
        ),
        (
            Self::Diverged,
            "diverged",
            "innovations far too large, or no covariance left",
        ),
        (Self::Stale, "stale", "no new sample for three periods"),
    ];

    /// The item of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .find(|(_, n, _)| *n == name)
            .map(|(status, ..)| *status)
    }

    /// The item of this place, from 1.
    pub fn numbered(number: i32) -> Option<Self> {
        let place = usize::try_from(number).ok()?.checked_sub(1)?;
        Self::ALL.get(place).map(|(status, ..)| *status)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(s, ..)| *s == self)
            .map_or("", |(_, name, _)| name)
    }

    /// Its place, from 1.
    pub fn number(self) -> i32 {
        Self::ALL
            .iter()
            .zip(1..)
            .find(|((s, ..), _)| *s == self)
            .map_or(1, |(_, n)| n)
    }
}
