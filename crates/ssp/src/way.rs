//! What becomes of a number on its way to a component: at every hop its unit is converted first, then it is transformed.

use crate::SspError;
use crate::model::{BaseUnit, Linear};

/// A unit by its name, and what it comes to where that is declared.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedUnit {
    /// Name.
    pub name: String,
    /// What it comes to in SI base units.
    pub base: Option<BaseUnit>,
}

impl NamedUnit {
    /// What turns numbers of this unit into numbers of another. Declarations go before names, which hold in their own file alone.
    ///
    /// # Errors
    /// [`SspError::Units`] for units of different dimensions, and for different names of which one is not declared.
    pub fn to(&self, other: &Self) -> Result<Linear, SspError> {
        match (self.base, other.base) {
            (Some(from), Some(to)) if from == to => Ok(Linear::NONE),
            (Some(from), Some(to)) if from.exponents == to.exponents => Ok(Linear {
                factor: from.factor / to.factor,
                offset: (from.offset - to.offset) / to.factor,
            }),
            (None, _) | (_, None) if self.name == other.name => Ok(Linear::NONE),
            _ => Err(SspError::Units {
                from: self.name.clone(),
                to: other.name.clone(),
            }),
        }
    }
}

/// What connections, mappings and connectors of systems in between make of a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    first: Hop,
    /// Connectors that are passed, and how each is left.
    rest: Vec<(Stop, Hop)>,
}

/// A connection, or a value that goes where its name or mapping says.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hop {
    transformation: Linear,
    /// Whether units are not looked at.
    suppress: bool,
}

/// The unit of a connector of a system.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Stop {
    Unit(NamedUnit),
    /// That of the connector before, which is the one inside the system where the connector is an output.
    Before,
    /// That of the connector after.
    After,
}

impl Default for Way {
    /// One hop that leaves all to units.
    fn default() -> Self {
        Self::hop(None, false)
    }
}

impl Way {
    pub(crate) fn hop(transformation: Option<Linear>, suppress: bool) -> Self {
        Self {
            first: Hop {
                transformation: transformation.unwrap_or(Linear::NONE),
                suppress,
            },
            rest: Vec::new(),
        }
    }

    /// Both, this one first.
    pub(crate) fn then(mut self, stop: Stop, next: Self) -> Self {
        self.rest.push((stop, next.first));
        self.rest.extend(next.rest);
        self
    }

    fn hops(&self) -> impl Iterator<Item = &Hop> {
        std::iter::once(&self.first).chain(self.rest.iter().map(|(_, hop)| hop))
    }

    /// Whether something is transformed.
    pub fn transforms(&self) -> bool {
        self.hops().any(|hop| hop.transformation != Linear::NONE)
    }

    /// Whether it leaves all to the units of its ends.
    pub fn is_bare(&self) -> bool {
        let stops = self.rest.iter().map(|(stop, _)| stop);
        !self.transforms()
            && self.hops().all(|hop| !hop.suppress)
            && stops.into_iter().all(|stop| !matches!(stop, Stop::Unit(_)))
    }

    /// What it makes of a number in all. Where an end has no unit, nothing is converted there.
    ///
    /// * `from`: unit where the number comes from.
    /// * `to`: unit of the variable that takes it.
    ///
    /// # Errors
    /// [`SspError::Units`] where a conversion is not suppressed and not possible.
    pub fn linear(&self, from: Option<&NamedUnit>, to: Option<&NamedUnit>) -> Result<Linear, SspError> {
        let mut total = Linear::NONE;
        for (hop, ends) in self.hops().zip(self.units(from, to).windows(2)) {
            if let ([Some(from), Some(to)], false) = (ends, hop.suppress) {
                total = total.then(from.to(to)?);
            }
            total = total.then(hop.transformation);
        }
        Ok(total)
    }

    /// Units of both ends and of the connectors in between.
    fn units<'a>(&'a self, from: Option<&'a NamedUnit>, to: Option<&'a NamedUnit>) -> Vec<Option<&'a NamedUnit>> {
        let stops = self.rest.iter().map(|(stop, _)| match stop {
            Stop::Unit(unit) => Some(unit),
            Stop::Before | Stop::After => None,
        });
        let mut units: Vec<_> = std::iter::once(from).chain(stops).chain([to]).collect();
        for (place, (stop, _)) in self.rest.iter().enumerate() {
            if *stop == Stop::Before {
                units[place + 1] = units[place];
            }
        }
        for (place, (stop, _)) in self.rest.iter().enumerate().rev() {
            if *stop == Stop::After {
                units[place + 1] = units[place + 2];
            }
        }
        // A system that hands through has nothing inside.
        for place in 1..=self.rest.len() {
            units[place] = units[place].or(units[place - 1]);
        }
        units
    }
}
