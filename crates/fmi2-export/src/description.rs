//! `modelDescription.xml` of a model, and the GUID that ties a binary to it.

use std::collections::{BTreeMap, BTreeSet};

use fmi_model::{
    Category, Causality, DefinitionError, Element, Entry, EnumerationType, Model, ModelInfo, Table, Typed, Unit,
    Variable, braced, number,
};
use uuid::Uuid;

/// Stands for a GUID that the build makes: a committed description cannot know it.
const MADE_BY_THE_BUILD: &str = "{made-by-the-build}";

/// `modelDescription.xml` of `M`, the same text on every call and every machine; with a placeholder for a GUID that the build
/// has a part in ([`ModelInfo::guid`]). Whoever packs the FMU replaces it by [`guid`], which follows from this text.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn render<M: Model>() -> Result<String, DefinitionError> {
    let own = guid::<M>()?;
    let guid = M::info()
        .guid
        .map_or_else(|| braced(own), |_| MADE_BY_THE_BUILD.to_owned());
    Ok(document(M::info(), M::table(), &guid)?.to_document())
}

/// GUID of `M`, which any change to the interface changes, so that a library refuses a description of another table: version 5
/// over what [`render`] gives, in the namespace of the build's GUID; without one, over the XML without GUID and the version.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn guid<M: Model>() -> Result<Uuid, DefinitionError> {
    M::info().check()?;
    if let Some(defect) = M::table().defect() {
        return Err(defect.clone());
    }
    let text = |guid| Ok(document(M::info(), M::table(), guid)?.to_document());
    Ok(match M::info().guid {
        Some(build) => Uuid::new_v5(&build, text(MADE_BY_THE_BUILD)?.as_bytes()),
        None => Uuid::new_v5(&Uuid::NAMESPACE_OID, (text("")? + M::info().version).as_bytes()),
    })
}

fn document<M>(info: &ModelInfo, table: &Table<M>, guid: &str) -> Result<Element, DefinitionError> {
    let tool = format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"));
    let sections = [
        Some(co_simulation(info)),
        unit_definitions(table),
        type_definitions(table),
        Some(log_categories()),
        Some(default_experiment(info)),
        vendor_annotations(info)?,
        Some(model_variables(table)),
        Some(model_structure(table)),
    ];
    let head = Element::new("fmiModelDescription")
        .attribute("fmiVersion", "2.0")
        .attribute("modelName", info.model_name)
        .attribute("guid", guid)
        .attribute_if_any("description", info.description)
        .attribute_if_any("author", info.author)
        .attribute_if_any("version", info.version)
        .attribute_if_any("copyright", info.copyright)
        .attribute_if_any("license", info.license)
        .attribute("generationTool", tool)
        .attribute("variableNamingConvention", "structured");
    Ok(head.children(sections.into_iter().flatten()))
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

/// The units in use, by name.
fn unit_definitions<M>(table: &Table<M>) -> Option<Element> {
    let mut units: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for entry in table.entries() {
        if let (Typed::Real { display_unit, .. }, Some(unit)) = (&entry.row.typed, entry.unit()) {
            units.entry(unit).or_default().extend(*display_unit);
        }
    }
    let elements = units
        .into_iter()
        .filter_map(|(name, display_units)| Some(unit_element(&Unit::parse(name)?, &display_units)));
    section("UnitDefinitions", elements)
}

/// `<Unit>` with the display units in use. A unit with a fractional exponent has no `<BaseUnit>`: FMI has no way to say it.
fn unit_element(unit: &Unit, display_units: &BTreeSet<&str>) -> Element {
    let mut element = Element::new("Unit").attribute("name", unit.name());
    if unit.is_whole() {
        let powers = unit.exponents().filter(|(_, exponent)| exponent.abs() > 0.0);
        element = element.child(powers.fold(Element::new("BaseUnit"), |base_unit, (symbol, exponent)| {
            base_unit.attribute(symbol, number(exponent))
        }));
    }
    let shown = unit.display_units().filter(|(name, _)| display_units.contains(name));
    element.children(shown.map(|(name, factor)| {
        Element::new("DisplayUnit")
            .attribute("name", name)
            .attribute("factor", number(factor))
    }))
}

fn type_definitions<M>(table: &Table<M>) -> Option<Element> {
    section("TypeDefinitions", table.enumeration_types().map(simple_type))
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

fn log_categories() -> Element {
    Element::new("LogCategories").children(Category::ALL.into_iter().map(|category| {
        Element::new("Category")
            .attribute("name", category.name())
            .attribute("description", about(category))
    }))
}

/// One sentence about a category.
fn about(category: Category) -> &'static str {
    match category {
        Category::StatusWarning => "messages of calls that end in fmi2Warning; always sent",
        Category::StatusDiscard => "messages of calls that end in fmi2Discard; always sent",
        Category::StatusError => "messages of calls that end in fmi2Error; always sent",
        Category::StatusFatal => "messages of calls that end in fmi2Fatal; always sent",
        Category::Events => "noteworthy events of the model, sent while logging is on",
        Category::All => "every message, details included",
    }
}

fn default_experiment(info: &ModelInfo) -> Element {
    Element::new("DefaultExperiment")
        .attribute("startTime", "0")
        .attribute("stopTime", number(info.default_stop))
        .attribute("stepSize", number(info.default_step))
}

fn vendor_annotations(info: &ModelInfo) -> Result<Option<Element>, DefinitionError> {
    let tools = info.vendor_annotations.iter().map(|annotation| {
        let tool = Element::new("Tool").attribute("name", annotation.tool());
        Ok(tool.child(annotation.content()?.clone()))
    });
    let tools = tools.collect::<Result<Vec<_>, DefinitionError>>()?;
    Ok(section("VendorAnnotations", tools))
}

/// FMI 2.0 has no arrays: every entry is a variable, and its number the value reference.
fn model_variables<M>(table: &Table<M>) -> Element {
    let entries = (0_u32..).zip(table.entries());
    Element::new("ModelVariables").children(entries.map(|(reference, entry)| scalar_variable(reference, entry)))
}

fn scalar_variable<M>(reference: u32, entry: Entry<'_, M>) -> Element {
    let row = entry.row;
    let initial = match row.causality {
        Causality::Parameter => "exact",
        Causality::Input => "", // must not be stated: an input always starts at its start value
        Causality::CalculatedParameter | Causality::Output | Causality::Local => "calculated",
    };
    Element::new("ScalarVariable")
        .attribute("name", entry.name())
        .attribute("valueReference", reference.to_string())
        .attribute_if_any("description", entry.about())
        .attribute("causality", row.causality.name())
        .attribute("variability", row.variability.name())
        .attribute_if_any("initial", initial)
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
            .attribute_if_any("unit", entry.unit().unwrap_or_default())
            .attribute_if_any("displayUnit", display_unit.unwrap_or_default())
            .attribute_if_any("min", &optional(bounds.declared_min(), number))
            .attribute_if_any("max", &optional(bounds.max, number))
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

fn optional<T>(value: Option<T>, show: impl Fn(T) -> String) -> String {
    value.map(show).unwrap_or_default()
}

/// Outputs follow from the state at a communication point, not from the inputs set there; at initialization they follow from the
/// parameters and the inputs that their rows name. Saying so keeps masters from seeing algebraic loops where two slaves are
/// coupled both ways.
fn model_structure<M>(table: &Table<M>) -> Element {
    let at_initialization = |unknown: &Variable<M>| {
        let known = |row: &Variable<M>| match row.causality {
            Causality::Parameter => true,
            Causality::Input => unknown.initial_inputs.contains(&row.name.as_str()),
            Causality::CalculatedParameter | Causality::Output | Causality::Local => false,
        };
        let knowns = (1_usize..).zip(table.entries()).filter(|(_, entry)| known(entry.row));
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

/// A section with these entries; FMI has no empty sections.
fn section(name: &str, entries: impl IntoIterator<Item = Element>) -> Option<Element> {
    let mut entries = entries.into_iter().peekable();
    entries.peek()?;
    Some(Element::new(name).children(entries))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fractional_exponent_has_no_base_unit() {
        let element = |name| unit_element(&Unit::parse(name).unwrap(), &BTreeSet::from(["deg"]));
        let unit = |name: &str| Element::new("Unit").attribute("name", name);
        assert_eq!(element("m/s^2.5"), unit("m/s^2.5"));
        let base = Element::new("BaseUnit").attribute("rad", "1");
        let deg = Element::new("DisplayUnit")
            .attribute("name", "deg")
            .attribute("factor", "57.29577951308232");
        assert_eq!(element("rad"), unit("rad").child(base).child(deg));
    }
}
