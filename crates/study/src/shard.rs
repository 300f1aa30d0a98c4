//! A part of a study's runs, for one of several processes.

use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::arguments::as_text;

/// `I/N`: part I of N, counted from 1. Every N-th run is its own, so that parts take equally long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    part: u32,
    of: NonZeroU32,
}

impl Shard {
    /// The only one.
    pub const WHOLE: Self = Self {
        part: 1,
        of: NonZeroU32::MIN,
    };

    /// How many parts there are.
    pub fn of(self) -> u32 {
        self.of.get()
    }

    /// Every part of as many.
    pub fn all(of: NonZeroU32) -> impl Iterator<Item = Self> {
        (1..=of.get()).map(move |part| Self { part, of })
    }

    /// Its runs among the first `runs`, in order.
    pub fn runs(self, runs: u32) -> Vec<u32> {
        (self.part - 1..runs).step_by(self.of.get() as usize).collect()
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not I/N, part I of N counted from 1, as in 2/8");
        let (part, of) = text.split_once('/').ok_or_else(wrong)?;
        let part: u32 = part.parse().map_err(|_| wrong())?;
        let of: NonZeroU32 = of.parse().map_err(|_| wrong())?;
        (1..=of.get())
            .contains(&part)
            .then_some(Self { part, of })
            .ok_or_else(wrong)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

as_text!(Shard);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_together_are_the_whole() {
        for (of, runs) in [(1, 5), (3, 10), (4, 2)] {
            let parts = Shard::all(NonZeroU32::new(of).unwrap());
            let mut all: Vec<u32> = parts.flat_map(|part| part.runs(runs)).collect();
            all.sort_unstable();
            assert_eq!(all, (0..runs).collect::<Vec<_>>());
        }
        assert_eq!("2/3".parse::<Shard>().unwrap().runs(8), [1, 4, 7]);
        assert_eq!("2/3".parse::<Shard>().unwrap().to_string(), "2/3");
        for bad in ["", "2", "0/3", "4/3", "1/0", "-1/2", "a/b"] {
            assert!(bad.parse::<Shard>().unwrap_err().contains("I/N"), "{bad}");
        }
    }
}
