//! `modelDescription.xml` of FMI 3.0: what stands below its first element. A row is one variable, whatever its shape.

use fmi_export::description::{
    annotations, default_experiment, initial, known_initially, optional, quantities, section, unit_definitions,
};
use fmi_model::{
    Access, Causality, DefinitionError, Each, Element, EnumerationType, ModelInfo, Scalar, Shape, Table, Typed,
    Variable, number, quantity,
};

use crate::rows::{TIME, type_name};

/// Unit of time.
const SECOND: &str = "s";

/// The children of `<fmiModelDescription>`.
///
/// # Errors
/// A vendor annotation that is not one element, or a row with the name of the independent variable.
pub(crate) fn sections<M>(
    info: &ModelInfo,
    table: &Table<M>,
    log_categories: Element,
) -> Result<Vec<Element>, DefinitionError> {
    if table.rows().iter().any(|row| row.name == TIME) {
        let name = TIME.to_owned();
        return Err(DefinitionError::DuplicateName { name });
    }
    let sections = [
        Some(co_simulation(info)),
        unit_definitions(table, &[SECOND]),
        section("TypeDefinitions", types(table)),
        Some(log_categories),
        Some(default_experiment(info)),
        Some(model_variables(table)),
        Some(model_structure(table)),
        section("Annotations", annotations(info, "Annotation", "type")?),
    ];
    Ok(sections.into_iter().flatten().collect())
}

fn co_simulation(info: &ModelInfo) -> Element {
    Element::new("CoSimulation")
        .attribute("modelIdentifier", info.model_identifier)
        .attribute("needsExecutionTool", "false")
        .attribute("canBeInstantiatedOnlyOncePerProcess", "false")
        .attribute("canGetAndSetFMUState", "true")
        .attribute("canSerializeFMUState", "true")
        .attribute("providesDirectionalDerivatives", "false")
        .attribute("providesAdjointDerivatives", "false")
        .attribute("providesPerElementDependencies", "false")
        .attribute("canHandleVariableCommunicationStepSize", "true")
        .attribute("maxOutputDerivativeOrder", "0")
        .attribute("providesIntermediateUpdate", "false")
        .attribute("mightReturnEarlyFromDoStep", "false")
        .attribute("canReturnEarlyAfterIntermediateUpdate", "false")
        .attribute("hasEventMode", "false")
}

/// A type for each quantity, then those of the enumerations.
fn types<M>(table: &Table<M>) -> impl Iterator<Item = Element> {
    let reals = quantities(table).map(|(name, unit, shown)| {
        Element::new("Float64Type")
            .attribute("name", name)
            .attribute("quantity", name)
            .attribute("unit", unit)
            .attribute_if_any("displayUnit", shown)
    });
    reals.chain(table.enumeration_types().map(enumeration_type))
}

fn enumeration_type(declared: &EnumerationType) -> Element {
    let items = (1_usize..).zip(&declared.items).map(|(value, item)| {
        Element::new("Item")
            .attribute("name", &item.name)
            .attribute("value", value.to_string())
            .attribute_if_any("description", &item.about)
    });
    Element::new("EnumerationType")
        .attribute("name", &declared.name)
        .attribute_if_any("description", &declared.about)
        .children(items)
}

/// Every row that has elements, and time.
fn model_variables<M>(table: &Table<M>) -> Element {
    let rows = (0_usize..).zip(table.rows());
    let rows = rows.filter(|(_, row)| row.shape.count() > 0);
    let time = Element::new("Float64")
        .attribute("name", TIME)
        .attribute("valueReference", table.rows().len().to_string())
        .attribute("description", "simulation time")
        .attribute("causality", "independent")
        .attribute("variability", "continuous")
        .attribute("unit", SECOND);
    Element::new("ModelVariables")
        .children(rows.map(|(reference, row)| variable(reference, row)))
        .child(time)
}

fn variable<M>(reference: usize, row: &Variable<M>) -> Element {
    let element = Element::new(type_name(&row.typed))
        .attribute("name", &row.name)
        .attribute("valueReference", reference.to_string())
        .attribute_if_any("description", &about(row))
        .attribute("causality", row.causality.name())
        .attribute("variability", row.variability.name())
        .attribute_if_any("initial", initial(row.causality));
    typed(element, row)
}

/// The attributes that only its type has, start values and dimensions.
fn typed<M>(element: Element, row: &Variable<M>) -> Element {
    let element = match &row.typed {
        Typed::Real {
            access,
            unit,
            display_unit,
            nominal,
            bounds,
        } => {
            // An array has one unit, and where its elements have several the description says which.
            let unit = unit.as_ref().and_then(Each::shared);
            let shared = nominal
                .as_ref()
                .and_then(Each::shared)
                .copied()
                .filter(|n| (n - 1.0).abs() > 0.0);
            element
                .attribute_if_any(
                    "declaredType",
                    unit.and_then(|unit| quantity(unit)).map_or("", |(name, _)| name),
                )
                .attribute_if_any("unit", unit.map_or("", String::as_str))
                .attribute_if_any("displayUnit", unit.and(*display_unit).unwrap_or_default())
                .attribute_if_any("min", &optional(bounds.declared_min(), number))
                .attribute_if_any("max", &optional(bounds.max, number))
                .attribute_if_any("nominal", &optional(shared, number))
                .attribute_if_any("start", &starts(row.shape, access, |v| number(*v)))
        }
        Typed::Integer { access, bounds } => element
            .attribute_if_any("min", &optional(bounds.declared_min(), |v| v.to_string()))
            .attribute_if_any("max", &optional(bounds.max, |v| v.to_string()))
            .attribute_if_any("start", &starts(row.shape, access, i32::to_string)),
        Typed::Enumeration { access, declared } => element
            .attribute("declaredType", &declared.name)
            .attribute_if_any("start", &starts(row.shape, access, i32::to_string)),
        Typed::Boolean { access } => element.attribute_if_any("start", &starts(row.shape, access, bool::to_string)),
        Typed::String { .. } => element,
    };
    let element = element.children(dimensions(row.shape));
    match &row.typed {
        Typed::String { access } => {
            let texts = (0..row.shape.count()).filter_map(|k| access.start(k));
            element.children(texts.map(|text| Element::new("Start").attribute("value", text)))
        }
        _ => element,
    }
}

/// Start values of all elements; empty without any.
fn starts<M, T: Scalar>(shape: Shape, access: &Access<M, T>, text: impl Fn(&T) -> String) -> String {
    let values = (0..shape.count()).filter_map(|element| access.start(element));
    values.map(text).collect::<Vec<_>>().join(" ")
}

fn dimensions(shape: Shape) -> impl Iterator<Item = Element> {
    let sizes = match shape {
        Shape::Scalar => vec![],
        Shape::Vector(n) => vec![n],
        Shape::Matrix(rows, columns) => vec![rows, columns],
    };
    let dimension = |size: usize| Element::new("Dimension").attribute("start", size.to_string());
    sizes.into_iter().map(dimension)
}

/// What is said of a row: of an array whose elements have meanings or units of their own, which have which.
fn about<M>(row: &Variable<M>) -> String {
    let unit = match &row.typed {
        Typed::Real { unit: Some(unit), .. } if unit.shared().is_none() => Some(unit),
        _ => None,
    };
    let meaning = |k: usize| row.about.get(k).map_or("", String::as_str);
    let unit = |k: usize| unit.and_then(|unit| unit.get(k)).map_or("", String::as_str);
    let described = row.about.shared();
    let blocks = blocks(row.shape, |k| (meaning(k), unit(k)));
    let each = |(place, (meaning, unit)): &(String, (&str, &str))| match (described, *unit) {
        (Some(_), unit) => format!("{place} {unit}"),
        (None, "") => format!("{place} {meaning}"),
        (None, unit) => format!("{place} {meaning} ({unit})"),
    };
    match described {
        Some(text) if blocks.len() == 1 => text.clone(),
        Some(text) => {
            let units = blocks.iter().map(each).collect::<Vec<_>>().join(", ");
            if text.is_empty() {
                units
            } else {
                format!("{text}; units: {units}")
            }
        }
        None => blocks.iter().map(each).collect::<Vec<_>>().join("; "),
    }
}

/// Parts of an array whose elements agree in `key`, as `[1..3]` or `[1..3,4..6]`: runs along the columns of rows that are alike.
fn blocks<K: PartialEq>(shape: Shape, key: impl Fn(usize) -> K) -> Vec<(String, K)> {
    let (rows, columns) = match shape {
        Shape::Scalar => (1, 1),
        Shape::Vector(n) => (1, n),
        Shape::Matrix(rows, columns) => (rows, columns),
    };
    let span = |first: usize, last: usize| {
        if first == last {
            (first + 1).to_string()
        } else {
            format!("{}..{}", first + 1, last + 1)
        }
    };
    let keys: Vec<Vec<K>> = (0..rows)
        .map(|i| (0..columns).map(|j| key(columns * i + j)).collect())
        .collect();
    let mut found = Vec::new();
    let mut row = 0;
    for alike in keys.chunk_by(|one, next| one == next) {
        let mut column = 0;
        for run in alike[0].chunk_by(|one, next| one == next) {
            let across = span(column, column + run.len() - 1);
            let place = match shape {
                Shape::Matrix(..) => format!("[{},{across}]", span(row, row + alike.len() - 1)),
                _ => format!("[{across}]"),
            };
            found.push((place, key(columns * row + column)));
            column += run.len();
        }
        row += alike.len();
    }
    found
}

/// Outputs follow from the state at a communication point, not from the inputs set there; at initialization they follow from the
/// parameters and the inputs that their rows name. Saying so keeps masters from seeing algebraic loops where two FMUs are
/// coupled both ways.
fn model_structure<M>(table: &Table<M>) -> Element {
    let rows = || (0_usize..).zip(table.rows()).filter(|(_, row)| row.shape.count() > 0);
    let unknowns = |element: &'static str, kinds: &'static [Causality]| {
        let of_kinds = rows().filter(|(_, row)| kinds.contains(&row.causality));
        of_kinds.map(move |(reference, row)| {
            let unknown = Element::new(element).attribute("valueReference", reference.to_string());
            (unknown, row)
        })
    };
    let outputs = unknowns("Output", &[Causality::Output]);
    let initially = unknowns("InitialUnknown", &[Causality::Output, Causality::CalculatedParameter]);
    let knowns = |unknown: &Variable<M>| {
        let knowns = rows().filter(|(_, known)| known_initially(unknown, known));
        knowns
            .map(|(reference, _)| reference.to_string())
            .collect::<Vec<_>>()
            .join(" ")
    };
    Element::new("ModelStructure")
        .children(outputs.map(|(unknown, _)| unknown.attribute("dependencies", "")))
        .children(initially.map(|(unknown, row)| unknown.attribute("dependencies", knowns(row))))
}

#[cfg(test)]
mod tests {
    use fmi_model::TableBuilder;

    use super::*;

    #[test]
    fn a_row_without_elements_is_no_variable() {
        let mut t = TableBuilder::<f64>::new();
        t.real("none").output().vector(0, |_, _| 0.0);
        t.real("x").output().get(|m| *m);
        let table = t.build();
        let variables = model_variables(&table).to_document();
        assert!(!variables.contains("none"), "{variables}");
        for (name, reference) in [("x", 1), (TIME, 2)] {
            let begin = format!("<Float64 name=\"{name}\" valueReference=\"{reference}\"");
            assert!(variables.contains(&begin), "{variables}");
        }
        assert!(!model_structure(&table).to_document().contains("valueReference=\"0\""));
    }

    #[test]
    fn elements_that_agree_are_named_as_blocks() {
        let places = |shape, key: &dyn Fn(usize) -> usize| -> Vec<(String, usize)> { blocks(shape, key) };
        let named = |list: &[(&str, usize)]| -> Vec<(String, usize)> {
            list.iter().map(|(place, key)| ((*place).to_owned(), *key)).collect()
        };
        assert_eq!(places(Shape::Vector(3), &|_| 7), named(&[("[1..3]", 7)]));
        assert_eq!(
            places(Shape::Vector(4), &|k| k / 3),
            named(&[("[1..3]", 0), ("[4]", 1)])
        );
        let product = |k: usize| (k / 4 / 2) + (k % 4 / 2);
        assert_eq!(
            places(Shape::Matrix(4, 4), &product),
            named(&[
                ("[1..2,1..2]", 0),
                ("[1..2,3..4]", 1),
                ("[3..4,1..2]", 1),
                ("[3..4,3..4]", 2)
            ])
        );
    }
}
