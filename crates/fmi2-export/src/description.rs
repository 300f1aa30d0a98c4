//! `modelDescription.xml` of FMI 2.0: what stands below its first element.

use fmi_export::description::{
    annotations, default_experiment, initial, known_initially, optional, quantities, section, unit_definitions,
};
use fmi_model::{
    Causality, DefinitionError, Element, Entry, EnumerationType, ModelInfo, Table, Typed, Variable, number, quantity,
};

/// The children of `<fmiModelDescription>`.
///
/// # Errors
/// A vendor annotation that is not one element.
pub(crate) fn sections<M>(
    info: &ModelInfo,
    table: &Table<M>,
    log_categories: Element,
) -> Result<Vec<Element>, DefinitionError> {
    let sections = [
        Some(co_simulation(info)),
        unit_definitions(table, &[]),
        type_definitions(table),
        Some(log_categories),
        Some(default_experiment(info)),
        section("VendorAnnotations", annotations(info, "Tool", "name")?),
        Some(model_variables(table)),
        Some(model_structure(table)),
    ];
    Ok(sections.into_iter().flatten().collect())
}

fn co_simulation(info: &ModelInfo) -> Element {
    Element::new("CoSimulation")
        .attribute("modelIdentifier", info.model_identifier)
        .attribute("needsExecutionTool", "false")
        .attribute("canHandleVariableCommunicationStepSize", "true")
        .attribute("canInterpolateInputs", "false")
        .attribute("maxOutputDerivativeOrder", "0")
        .attribute("canRunAsynchronuously", "false")
        .attribute("canBeInstantiatedOnlyOncePerProcess", "false")
        .attribute("canNotUseMemoryManagementFunctions", "true")
        .attribute("canGetAndSetFMUstate", "true")
        .attribute("canSerializeFMUstate", "true")
        .attribute("providesDirectionalDerivative", "false")
}

fn type_definitions<M>(table: &Table<M>) -> Option<Element> {
    let reals = quantities(table).map(|(name, unit, shown)| {
        let real = Element::new("Real")
            .attribute("quantity", name)
            .attribute("unit", unit)
            .attribute_if_any("displayUnit", shown);
        Element::new("SimpleType").attribute("name", name).child(real)
    });
    section(
        "TypeDefinitions",
        reals.chain(table.enumeration_types().map(simple_type)),
    )
}

fn simple_type(declared: &EnumerationType) -> Element {
    let items = (1..).zip(&declared.items).map(|(value, item)| {
        let value: usize = value;
        Element::new("Item")
            .attribute("name", &item.name)
            .attribute("value", value.to_string())
            .attribute_if_any("description", &item.about)
    });
    Element::new("SimpleType")
        .attribute("name", &declared.name)
        .attribute_if_any("description", &declared.about)
        .child(Element::new("Enumeration").children(items))
}

/// FMI 2.0 has no arrays: every entry is a variable, and its number the value reference.
fn model_variables<M>(table: &Table<M>) -> Element {
    let entries = (0_u32..).zip(table.entries());
    Element::new("ModelVariables").children(entries.map(|(reference, entry)| scalar_variable(reference, entry)))
}

fn scalar_variable<M>(reference: u32, entry: Entry<'_, M>) -> Element {
    let row = entry.row;
    Element::new("ScalarVariable")
        .attribute("name", entry.name())
        .attribute("valueReference", reference.to_string())
        .attribute_if_any("description", entry.about())
        .attribute("causality", row.causality.name())
        .attribute("variability", row.variability.name())
        .attribute_if_any("initial", initial(row.causality))
        .child(type_element(entry))
}

fn type_element<M>(entry: Entry<'_, M>) -> Element {
    let Entry { row, element: k } = entry;
    let element = Element::new(row.typed.name());
    match &row.typed {
        Typed::Real {
            access,
            display_unit,
            bounds,
            ..
        } => element
            .attribute_if_any(
                "declaredType",
                entry.unit().and_then(quantity).map_or("", |(name, _)| name),
            )
            .attribute_if_any("unit", entry.unit().unwrap_or_default())
            .attribute_if_any("displayUnit", display_unit.unwrap_or_default())
            .attribute_if_any("min", &optional(bounds.declared_min(), number))
            .attribute_if_any("max", &optional(bounds.max, number))
            .attribute_if_any("nominal", &optional(entry.nominal(), number))
            .attribute_if_any("start", &optional(access.start(k).copied(), number)),
        Typed::Integer { access, bounds } => element
            .attribute_if_any("min", &optional(bounds.declared_min(), |v| v.to_string()))
            .attribute_if_any("max", &optional(bounds.max, |v| v.to_string()))
            .attribute_if_any("start", &optional(access.start(k), |v| v.to_string())),
        Typed::Enumeration { access, declared } => element
            .attribute("declaredType", &declared.name)
            .attribute_if_any("start", &optional(access.start(k), |v| v.to_string())),
        Typed::Boolean { access } => element.attribute_if_any("start", &optional(access.start(k), |v| v.to_string())),
        // the empty text is a start value, too
        Typed::String { access } => match access.start(k) {
            Some(start) => element.attribute("start", start),
            None => element,
        },
    }
}

/// Outputs follow from the state at a communication point, not from the inputs set there; at initialization they follow from the
/// parameters and the inputs that their rows name. Saying so keeps masters from seeing algebraic loops where two slaves are
/// coupled both ways.
fn model_structure<M>(table: &Table<M>) -> Element {
    let at_initialization = |unknown: &Variable<M>| {
        let knowns = (1_usize..)
            .zip(table.entries())
            .filter(|(_, entry)| known_initially(unknown, entry.row));
        knowns.map(|(index, _)| index.to_string()).collect::<Vec<_>>().join(" ")
    };
    let unknowns = |kinds: &[Causality], dependencies: &dyn Fn(&Variable<M>) -> String| -> Vec<Element> {
        let entries = (1_usize..).zip(table.entries());
        let of_kinds = entries.filter(|(_, entry)| kinds.contains(&entry.row.causality));
        let unknown = |(index, entry): (usize, Entry<'_, M>)| {
            Element::new("Unknown")
                .attribute("index", index.to_string())
                .attribute("dependencies", dependencies(entry.row))
        };
        of_kinds.map(unknown).collect()
    };
    let sections = [
        section("Outputs", unknowns(&[Causality::Output], &|_| String::new())),
        section(
            "InitialUnknowns",
            unknowns(&[Causality::Output, Causality::CalculatedParameter], &at_initialization),
        ),
    ];
    Element::new("ModelStructure").children(sections.into_iter().flatten())
}
