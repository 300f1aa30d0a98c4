//! Units of ports: whether two may be connected, and what turns values of one into the other.

use std::sync::Arc;

use fmi2_import::{BaseUnit, Unit};

use crate::Port;

/// `factor * x + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Conversion {
    pub(crate) factor: f64,
    pub(crate) offset: f64,
}

impl Conversion {
    /// Nothing for a conversion that changes no value.
    fn unless_trivial(factor: f64, offset: f64) -> Option<Self> {
        let trivial = factor.to_bits() == 1.0_f64.to_bits() && offset.abs().to_bits() == 0;
        (!trivial).then_some(Self { factor, offset })
    }

    pub(crate) fn apply(self, value: &mut f64) {
        *value = self.factor * *value + self.offset;
    }
}

/// What two units are to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Relation {
    /// Of one kind; values pass as they are, or converted.
    Same(Option<Conversion>),
    /// One of them does not say what it is.
    Unknown,
    /// Of different kinds.
    Different,
}

/// Compares the unit of an output with that of an input.
pub(crate) fn relation(output: &Port, input: &Port) -> Relation {
    match (output.unit.as_deref(), input.unit.as_deref()) {
        (None, None) => Relation::Same(None),
        (Some(from), Some(to)) if from.name == to.name && from.base == to.base => Relation::Same(None),
        (Some(Unit { base: Some(from), .. }), Some(Unit { base: Some(to), .. })) => {
            if from.exponents == to.exponents {
                let (factor, offset) = (from.factor / to.factor, (from.offset - to.offset) / to.factor);
                Relation::Same(Conversion::unless_trivial(factor, offset))
            } else {
                Relation::Different
            }
        }
        (Some(only), None) | (None, Some(only)) if is_plain_number(only) => Relation::Same(None),
        _ => Relation::Unknown,
    }
}

/// What turns the values of a port into SI base units; nothing where they are, or where it does not say.
pub(crate) fn to_si(port: &Port) -> Option<Conversion> {
    let base = port.unit.as_ref()?.base?;
    Conversion::unless_trivial(base.factor, base.offset)
}

fn is_plain_number(unit: &Unit) -> bool {
    unit.base.is_some_and(|base| {
        let plain = BaseUnit {
            exponents: [0; 8],
            factor: 1.0,
            offset: 0.0,
        };
        base == plain
    })
}

/// Text for messages.
pub(crate) fn unit_name(unit: Option<&Arc<Unit>>) -> String {
    unit.map_or_else(|| "no unit".to_owned(), |unit| format!("'{}'", unit.name))
}
