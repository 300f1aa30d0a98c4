//! Mistakes in the definition of a model, found before any host sees it.

use crate::bounds::OWN_DEFAULT;
use crate::unit::{self, Unit};
use crate::variable::{Entry, Typed, Variable};

/// What is wrong with a table or the facts around it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DefinitionError {
    /// The name does not follow the structured naming convention.
    #[error(
        "variable name '{name}' is not structured: write identifiers of letters, digits and _ joined by '.'; \
         indices come from vector and matrix"
    )]
    BadName {
        /// The name.
        name: String,
    },
    /// Two rows have the same name.
    #[error("variable name '{name}' is used twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A parameter states no start value.
    #[error("parameter '{name}' needs a start value: add .start(...) or .own_default()")]
    MissingStart {
        /// The variable.
        name: String,
    },
    /// A computed variable states a start value, which FMI does not allow.
    #[error("'{name}' is computed and must not have a start value")]
    NeedlessStart {
        /// The variable.
        name: String,
    },
    /// A parameter or input cannot be set.
    #[error("'{name}' is a parameter or input and needs a setter: use rw, vector_rw or matrix_rw")]
    MissingSetter {
        /// The variable.
        name: String,
    },
    /// An output or local could be set.
    #[error("'{name}' is an output or local and must not have a setter: use get, vector or matrix")]
    NeedlessSetter {
        /// The variable.
        name: String,
    },
    /// The start value breaks the variable's own bounds.
    #[error("start value {start} of '{name}' is not {bounds}")]
    StartOutOfBounds {
        /// The variable.
        name: String,
        /// Its start value.
        start: String,
        /// What it must be.
        bounds: String,
    },
    /// -1 would be a value like any other.
    #[error("'{name}' has .own_default() but no bound that excludes -1: add .positive() or .min(0)")]
    AmbiguousOwnDefault {
        /// The variable.
        name: String,
    },
    /// The model does not read back what was set.
    #[error(
        "'{name}' was set to its start value {start} and reads {read}: its getter and setter disagree, or two rows share a field"
    )]
    StartNotKept {
        /// The variable.
        name: String,
        /// Its start value.
        start: String,
        /// What the getter gave.
        read: String,
    },
    /// The unit is not made of SI base units.
    #[error(
        "unit '{unit}' of '{name}' is not understood: spell it like m/s2, m2/s5, rad, m/s^2.5 or 1, \
         from kg, m, s, A, K, mol, cd, rad"
    )]
    UnknownUnit {
        /// The variable.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// The display unit does not belong to the unit.
    #[error(
        "display unit '{display_unit}' of '{name}' does not go with unit '{unit}': known are deg for rad, deg/s for rad/s"
    )]
    UnknownDisplayUnit {
        /// The variable.
        name: String,
        /// Its unit, or nothing.
        unit: String,
        /// Its display unit.
        display_unit: &'static str,
    },
    /// A value is said to depend on an input that is not there.
    #[error("'{name}' is said to depend on '{input}', which is no input: name one, without indices")]
    UnknownInput {
        /// The variable.
        name: String,
        /// What it is said to depend on.
        input: &'static str,
    },
    /// The enumeration type has not been declared.
    #[error("'{name}' is of enumeration '{type_name}', which has not been declared: call enumeration_type first")]
    UnknownEnumeration {
        /// The variable.
        name: String,
        /// The type.
        type_name: String,
    },
    /// The enumeration type is empty, or it or an item is declared twice.
    #[error("enumeration '{type_name}' is empty, declared twice, or has two items of one name")]
    BadEnumeration {
        /// The type.
        type_name: String,
    },
    /// The model identifier cannot be part of a C name.
    #[error("model identifier '{identifier}' is not a C identifier: it names the library in binaries/")]
    BadIdentifier {
        /// The identifier.
        identifier: String,
    },
    /// The model has no name.
    #[error("the model has no name: fill in ModelInfo::model_name")]
    NoModelName,
    /// What a tool is to be told cannot be put into the description.
    #[error("the vendor annotation for '{tool}' is not one XML element: {reason}")]
    BadAnnotation {
        /// The tool.
        tool: &'static str,
        /// What the XML writer or reader said.
        reason: String,
    },
    /// The default experiment cannot be run.
    #[error("the default experiment of {stop} s in steps of {step} s is not positive and finite")]
    BadExperiment {
        /// Default stop time, s.
        stop: f64,
        /// Default step, s.
        step: f64,
    },
}

/// Whether `text` is a C identifier.
pub(crate) fn is_identifier(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Name of a row, before indices.
pub(crate) fn check_name(name: &str) -> Option<DefinitionError> {
    (!name.split('.').all(is_identifier)).then(|| DefinitionError::BadName { name: name.to_owned() })
}

/// Everything that can be said of one row without a model.
pub(crate) fn check_row<M>(row: &Variable<M>) -> Option<DefinitionError> {
    row.entries().find_map(check_entry)
}

fn check_entry<M>(entry: Entry<'_, M>) -> Option<DefinitionError> {
    let Entry { row, element } = entry;
    let name = || entry.name().into_owned();
    let access = row.typed.any();
    match (row.causality.settable(), access.writable()) {
        (true, false) => return Some(DefinitionError::MissingSetter { name: name() }),
        (false, true) => return Some(DefinitionError::NeedlessSetter { name: name() }),
        _ => {}
    }
    match (row.causality.settable(), access.has_start()) {
        (true, false) => return Some(DefinitionError::MissingStart { name: name() }),
        (false, true) => return Some(DefinitionError::NeedlessStart { name: name() }),
        _ => {}
    }
    match &row.typed {
        Typed::Real {
            access,
            display_unit,
            bounds,
            ..
        } => check_unit(entry, *display_unit).or_else(|| {
            check_own_default(entry, bounds.own_default, bounds.within(f64::from(OWN_DEFAULT))).or_else(|| {
                let start = access.start(element).filter(|v| !v.is_finite() || !bounds.admit(**v))?;
                Some(start_out_of_bounds(entry, start, bounds.to_string()))
            })
        }),
        Typed::Integer { access, bounds } => {
            check_own_default(entry, bounds.own_default, bounds.within(i32::from(OWN_DEFAULT))).or_else(|| {
                let start = access.start(element).filter(|v| !bounds.admit(**v))?;
                Some(start_out_of_bounds(entry, start, bounds.to_string()))
            })
        }
        Typed::Enumeration { access, declared } => {
            let start = access.start(element).filter(|v| declared.item(**v).is_none())?;
            let bounds = format!("an item of '{}'", declared.name);
            Some(start_out_of_bounds(entry, start, bounds))
        }
        Typed::Boolean { .. } | Typed::String { .. } => None,
    }
}

fn check_unit<M>(entry: Entry<'_, M>, display_unit: Option<&'static str>) -> Option<DefinitionError> {
    let name = || entry.name().into_owned();
    if let Some(unit) = entry.unit().filter(|unit| Unit::parse(unit).is_none()) {
        return Some(DefinitionError::UnknownUnit {
            name: name(),
            unit: unit.to_owned(),
        });
    }
    let unit = entry.unit().unwrap_or_default();
    display_unit
        .filter(|display_unit| !unit::displays(unit, display_unit))
        .map(|display_unit| DefinitionError::UnknownDisplayUnit {
            name: name(),
            unit: unit.to_owned(),
            display_unit,
        })
}

fn check_own_default<M>(entry: Entry<'_, M>, own_default: bool, minus_one_is_within: bool) -> Option<DefinitionError> {
    (own_default && minus_one_is_within).then(|| DefinitionError::AmbiguousOwnDefault {
        name: entry.name().into_owned(),
    })
}

fn start_out_of_bounds<M>(entry: Entry<'_, M>, start: impl std::fmt::Debug, bounds: String) -> DefinitionError {
    let finite = if bounds.is_empty() { "finite" } else { "" };
    DefinitionError::StartOutOfBounds {
        name: entry.name().into_owned(),
        start: format!("{start:?}"),
        bounds: format!("{finite}{bounds}"),
    }
}

#[cfg(test)]
mod tests {
    use super::DefinitionError as E;
    use crate::{Integer, Real, Row, Table, TableBuilder};

    /// A model with a field for each test to use.
    #[derive(Default)]
    struct Bag {
        x: f64,
        n: i32,
    }

    type RealRow<'t> = Row<'t, Bag, Real>;
    type IntegerRow<'t> = Row<'t, Bag, Integer>;

    fn defect(write: impl FnOnce(&mut TableBuilder<Bag>)) -> Option<E> {
        let mut t = TableBuilder::new();
        write(&mut t);
        t.build().defect().cloned()
    }

    fn of_real(attributes: impl FnOnce(RealRow<'_>) -> RealRow<'_>) -> Option<E> {
        defect(|t| attributes(t.real("x")).rw(|m| m.x, |m, v| m.x = v))
    }

    fn of_integer(attributes: impl FnOnce(IntegerRow<'_>) -> IntegerRow<'_>) -> Option<E> {
        defect(|t| attributes(t.integer("n")).rw(|m| m.n, |m, v| m.n = v))
    }

    #[test]
    fn names_are_structured_and_unique() {
        let named = |name: &str| defect(|t| t.real(name).get(|m| m.x));
        for name in ["a", "_a.b_2.C"] {
            assert_eq!(named(name), None);
        }
        for name in ["", ".", "a.", "1a", "a[1]", "a b", "a-b", "\u{e9}"] {
            let name = name.to_owned();
            assert_eq!(named(&name), Some(E::BadName { name }));
        }
        let twice = defect(|t| {
            t.real("a").get(|m| m.x);
            t.integer("a").get(|m| m.n);
        });
        let name = "a".to_owned();
        assert_eq!(twice, Some(E::DuplicateName { name }));
    }

    #[test]
    fn setter_and_start_go_with_the_causality() {
        let name = || "x".to_owned();
        let missing = defect(|t| t.real("x").parameter().start(1.0).get(|m| m.x));
        assert_eq!(missing, Some(E::MissingSetter { name: name() }));
        assert_eq!(of_real(|row| row.output()), Some(E::NeedlessSetter { name: name() }));
        assert_eq!(of_real(|row| row.parameter()), Some(E::MissingStart { name: name() }));
        let needless = defect(|t| t.real("x").local().start(1.0).get(|m| m.x));
        assert_eq!(needless, Some(E::NeedlessStart { name: name() }));
        assert_eq!(of_real(|row| row.input()), None);
    }

    #[test]
    fn start_values_keep_to_their_bounds() {
        let start = |x: f64| of_real(|row| row.parameter().min(0.0).max(2.0).start(x));
        assert_eq!(start(2.0), None);
        assert_eq!(
            start(3.0),
            Some(E::StartOutOfBounds {
                name: "x".to_owned(),
                start: "3.0".to_owned(),
                bounds: "at least 0.0 and at most 2.0".to_owned(),
            })
        );
        assert!(matches!(
            of_real(|row| row.parameter().start(f64::NAN)),
            Some(E::StartOutOfBounds { bounds, .. }) if bounds == "finite"
        ));
        assert!(matches!(
            of_integer(|row| row.parameter().positive().start(0)),
            Some(E::StartOutOfBounds { start, .. }) if start == "0"
        ));
    }

    #[test]
    fn own_default_needs_minus_one_for_itself() {
        let ambiguous = |name: &str| {
            let name = name.to_owned();
            Some(E::AmbiguousOwnDefault { name })
        };
        assert_eq!(of_real(|row| row.parameter().positive().own_default()), None);
        assert_eq!(of_real(|row| row.parameter().own_default()), ambiguous("x"));
        assert_eq!(of_integer(|row| row.parameter().min(-5).own_default()), ambiguous("n"));
    }

    #[test]
    fn units_are_understood() {
        assert_eq!(
            of_real(|row| row.input().unit("m/parsec")),
            Some(E::UnknownUnit {
                name: "x".to_owned(),
                unit: "m/parsec".to_owned(),
            })
        );
        for (unit, display_unit, fits) in [
            ("rad", "deg", true),
            ("rad/s", "deg/s", true),
            ("m", "deg", false),
            ("rad", "deg/s", false),
        ] {
            let found = of_real(|row| row.input().unit(unit).display_unit(display_unit));
            let expected = E::UnknownDisplayUnit {
                name: "x".to_owned(),
                unit: unit.to_owned(),
                display_unit,
            };
            assert_eq!(found, (!fits).then_some(expected));
        }
    }

    #[test]
    fn enumerations_are_declared_once_with_distinct_items() {
        let undeclared = defect(|t| t.enumeration("n", "Kind").get(|m| m.n));
        assert_eq!(
            undeclared,
            Some(E::UnknownEnumeration {
                name: "n".to_owned(),
                type_name: "Kind".to_owned(),
            })
        );
        let bad = Some(E::BadEnumeration {
            type_name: "Kind".to_owned(),
        });
        assert_eq!(
            defect(|t| t.enumeration_type("Kind", "", [("a", ""), ("b", ""), ("a", "")])),
            bad
        );
        assert_eq!(defect(|t| t.enumeration_type("Kind", "", [("", ""); 0])), bad);
        let twice = defect(|t| {
            t.enumeration_type("Kind", "", [("a", "")]);
            t.enumeration_type("Kind", "", [("b", "")]);
        });
        assert_eq!(twice, bad);
        let start = defect(|t| {
            t.enumeration_type("Kind", "", [("a", "")]);
            t.enumeration("n", "Kind")
                .parameter()
                .start(2)
                .rw(|m| m.n, |m, v| m.n = v);
        });
        assert!(matches!(
            start,
            Some(E::StartOutOfBounds { bounds, .. }) if bounds == "an item of 'Kind'"
        ));
    }

    #[test]
    fn dependencies_are_inputs() {
        let unknown = defect(|t| t.integer("n").output().initially_from("u").get(|m| m.n));
        let expected = E::UnknownInput {
            name: "n".to_owned(),
            input: "u",
        };
        assert_eq!(unknown, Some(expected));
        let known = defect(|t| {
            t.integer("n").output().initially_from("u").get(|m| m.n);
            t.real("u").input().vector_rw(2, |_, _| 0.0, |_, _, _| ());
        });
        assert_eq!(known, None);
    }

    #[test]
    fn two_rows_on_one_field_are_noticed() {
        let mut t = TableBuilder::<Bag>::new();
        t.integer("a").input().start(1).rw(|m| m.n, |m, v| m.n = v);
        t.integer("b").input().start(2).rw(|m| m.n, |m, v| m.n = v);
        let table: Table<Bag> = t.build();
        let mut model = Bag::default();
        table.apply_start(&mut model);
        assert_eq!(
            table.check_start(&model),
            Err(E::StartNotKept {
                name: "a".to_owned(),
                start: "1".to_owned(),
                read: "2".to_owned(),
            })
        );
    }
}
