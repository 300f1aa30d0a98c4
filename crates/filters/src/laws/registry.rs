//! The registry of filters: one line each.

use super::adaptation::{Setup, one_of_laws};
use super::entry::FilterEntry;
use crate::error::FilterError;
use interface::Navigation;
use serde::{Deserialize, Serialize};

/// Makes the registry: the list of entries, the constructors, and the closed set of laws that a saved FMU state can hold.
macro_rules! registry {
    ($($variant:ident => $module:ident;)*) => {
        /// Every filter, in the order reports list them.
        pub const FILTERS: &[FilterEntry] = &[$(super::$module::ENTRY),*];

        const LAWS: &[fn(&Setup<'_>) -> Result<Law, FilterError>] =
            &[$(|setup| Ok(Law::$variant(Box::new(super::$module::$variant::new(setup)?)))),*];

        /// The law of a running filter.
        #[allow(missing_docs)]
        #[derive(Clone, Debug, Serialize, Deserialize)]
        pub enum Law { $($variant(Box<super::$module::$variant>)),* }

        one_of_laws!(Law: $($variant),*);
    };
}

registry! {
    FixedQ => fixed_q;
    Snc => snc;
    Dmc => dmc;
    Milton => milton;
    ConstrainedQ => constrained_q;
    RbfnnAekf => rbfnn_aekf;
    RbfnnEkf => rbfnn_ekf;
    Observer => observer;
    EkfJ2 => ekf_j2;
    ChangePoint => change_point;
    Hybrid => hybrid;
    Imm => imm;
    Mmae => mmae;
    Clairvoyant => clairvoyant;
    TimesKnown => times_known;
}

impl Law {
    /// The law of a filter of [`FILTERS`].
    ///
    /// # Errors
    /// When a tunable is out of range, or there is no such filter.
    pub fn new(filter: usize, setup: &Setup<'_>) -> Result<Self, FilterError> {
        let build = LAWS.get(filter).ok_or_else(|| unknown(filter))?;
        build(setup)
    }
}

/// The filter of this place in [`FILTERS`].
///
/// # Errors
/// When there is none.
pub fn entry(filter: usize) -> Result<&'static FilterEntry, FilterError> {
    FILTERS.get(filter).ok_or_else(|| unknown(filter))
}

/// The place in [`FILTERS`] of a filter counted from 1.
///
/// # Errors
/// When there is none.
pub fn of_ordinal(ordinal: i32) -> Result<usize, FilterError> {
    let place = usize::try_from(i64::from(ordinal) - 1);
    let known = place.ok().filter(|place| *place < FILTERS.len());
    known.ok_or_else(|| FilterError::UnknownFilter {
        name: format!("number {ordinal}"),
        known: (1..)
            .zip(FILTERS)
            .map(|(n, f)| format!("{n} ({})", f.name))
            .collect::<Vec<_>>()
            .join(", "),
    })
}

/// Refuses a mission that states a start value which no law takes from it.
///
/// # Errors
/// [`FilterError::UnknownStart`], with what there is.
pub fn check_names(navigation: &Navigation) -> Result<(), FilterError> {
    let derived = |entry: &FilterEntry, name: &str| entry.tunables.iter().any(|t| t.name == name && t.kind.derived());
    for name in navigation.law.keys() {
        let (law, tunable) = name.split_once('.').unwrap_or((name, ""));
        if !FILTERS.iter().any(|entry| entry.name == law && derived(entry, tunable)) {
            let all = FILTERS.iter().flat_map(|entry| {
                let own = entry.tunables.iter().filter(|t| t.kind.derived());
                own.map(|t| format!("{}.{}", entry.name, t.name))
            });
            return Err(FilterError::UnknownStart {
                name: name.clone(),
                mission: navigation.mission.clone(),
                known: all.collect::<Vec<_>>().join(", "),
            });
        }
    }
    Ok(())
}

fn unknown(filter: usize) -> FilterError {
    FilterError::UnknownFilter {
        name: format!("number {}", filter + 1),
        known: FILTERS.iter().map(|f| f.name).collect::<Vec<_>>().join(", "),
    }
}
