//! `modelDescription.xml` of a model, and the GUID that ties a binary to it.

use std::collections::{BTreeMap, BTreeSet};

use uuid::Uuid;

use crate::log::Category;
use crate::model::{Model, ModelInfo};
use crate::table::{Causality, DefinitionError, EnumerationType, Table, Typed, Variable, is_identifier};
use crate::unit::Unit;
use crate::xml::{Element, number};

/// `modelDescription.xml` of `M`, the same text on every call and every machine.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn render<M: Model>() -> Result<String, DefinitionError> {
    let guid = braced(guid::<M>()?);
    Ok(document(M::info(), M::table(), &guid).to_document())
}

/// GUID of `M`: version 5 over its XML without GUID and its version. Any change to the interface changes it.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn guid<M: Model>() -> Result<Uuid, DefinitionError> {
    if let Some(guid) = M::table().guid.get() {
        return Ok(*guid);
    }
    check_info(M::info())?;
    if let Some(defect) = M::table().defect() {
        return Err(defect.clone());
    }
    let mut name = document(M::info(), M::table(), "").to_document();
    name.push_str(M::info().version);
    let guid = Uuid::new_v5(&Uuid::NAMESPACE_OID, name.as_bytes());
    Ok(*M::table().guid.get_or_init(|| guid))
}

/// A GUID as FMI writes it.
pub(crate) fn braced(guid: Uuid) -> String {
    format!("{{{guid}}}")
}

fn check_info(info: &ModelInfo) -> Result<(), DefinitionError> {
    if info.model_name.is_empty() {
        return Err(DefinitionError::NoModelName);
    }
    if !is_identifier(info.model_identifier) {
        return Err(DefinitionError::BadIdentifier {
            identifier: info.model_identifier.to_owned(),
        });
    }
    let positive = |seconds: f64| seconds.is_finite() && seconds > 0.0;
    if !positive(info.default_stop) || !positive(info.default_step) {
        return Err(DefinitionError::BadExperiment {
            stop: info.default_stop,
            step: info.default_step,
        });
    }
    Ok(())
}

fn document<M>(info: &ModelInfo, table: &Table<M>, guid: &str) -> Element {
    let tool = format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"));
    let sections = [
        Some(co_simulation(info)),
        unit_definitions(table),
        type_definitions(table),
        Some(log_categories()),
        Some(default_experiment(info)),
        vendor_annotations(info),
        Some(model_variables(table)),
        Some(model_structure(table)),
    ];
    Element::new("fmiModelDescription")
        .attribute("fmiVersion", "2.0")
        .attribute("modelName", info.model_name)
        .attribute("guid", guid)
        .attribute_if_any("description", info.description)
        .attribute_if_any("author", info.author)
        .attribute_if_any("version", info.version)
        .attribute_if_any("copyright", info.copyright)
        .attribute_if_any("license", info.license)
        .attribute("generationTool", tool)
        .attribute("variableNamingConvention", "structured")
        .children(sections.into_iter().flatten())
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
    for variable in table.variables() {
        if let Typed::Real {
            unit: Some(unit),
            display_unit,
            ..
        } = &variable.typed
        {
            units.entry(unit).or_default().extend(*display_unit);
        }
    }
    let elements = units.into_iter().filter_map(|(name, display_units)| {
        let display_units: Vec<_> = display_units.into_iter().collect();
        Some(Unit::parse(name)?.element(&display_units))
    });
    section("UnitDefinitions", elements)
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
            .attribute("description", category.about())
    }))
}

fn default_experiment(info: &ModelInfo) -> Element {
    Element::new("DefaultExperiment")
        .attribute("startTime", "0")
        .attribute("stopTime", number(info.default_stop))
        .attribute("stepSize", number(info.default_step))
}

fn vendor_annotations(info: &ModelInfo) -> Option<Element> {
    let tools = info.vendor_annotations.iter().map(|annotation| {
        Element::new("Tool")
            .attribute("name", annotation.tool)
            .child(annotation.content.clone())
    });
    section("VendorAnnotations", tools)
}

fn model_variables<M>(table: &Table<M>) -> Element {
    let variables = (0_u32..).zip(table.variables());
    Element::new("ModelVariables").children(variables.map(|(reference, variable)| scalar_variable(reference, variable)))
}

fn scalar_variable<M>(reference: u32, variable: &Variable<M>) -> Element {
    let initial = match variable.causality {
        Causality::Parameter => "exact",
        Causality::Input => "", // must not be stated: an input always starts at its start value
        Causality::Output | Causality::Local => "calculated",
    };
    Element::new("ScalarVariable")
        .attribute("name", &variable.name)
        .attribute("valueReference", reference.to_string())
        .attribute_if_any("description", &variable.about)
        .attribute("causality", variable.causality.name())
        .attribute("variability", variable.variability.name())
        .attribute_if_any("initial", initial)
        .child(type_element(&variable.typed))
}

fn type_element<M>(typed: &Typed<M>) -> Element {
    let element = Element::new(typed.name());
    match typed {
        Typed::Real {
            access,
            unit,
            display_unit,
            bounds,
        } => element
            .attribute_if_any("unit", unit.as_deref().unwrap_or_default())
            .attribute_if_any("displayUnit", display_unit.unwrap_or_default())
            .attribute_if_any("min", &optional(bounds.declared_min(), number))
            .attribute_if_any("max", &optional(bounds.max, number))
            .attribute_if_any("start", &optional(access.start, number)),
        Typed::Integer { access, bounds } => element
            .attribute_if_any("min", &optional(bounds.declared_min(), |v| v.to_string()))
            .attribute_if_any("max", &optional(bounds.max, |v| v.to_string()))
            .attribute_if_any("start", &optional(access.start, |v| v.to_string())),
        Typed::Enumeration { access, declared } => element
            .attribute("declaredType", &declared.name)
            .attribute_if_any("start", &optional(access.start, |v| v.to_string())),
        Typed::Boolean { access } => element.attribute_if_any("start", &optional(access.start, |v| v.to_string())),
        // the empty text is a start value, too
        Typed::String { access } => match &access.start {
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
        let known = |variable: &Variable<M>| match variable.causality {
            Causality::Parameter => true,
            Causality::Input => unknown.initial_inputs.contains(&variable.base_name()),
            Causality::Output | Causality::Local => false,
        };
        let knowns = (1_usize..).zip(table.variables()).filter(|(_, v)| known(v));
        knowns.map(|(index, _)| index.to_string()).collect::<Vec<_>>().join(" ")
    };
    let unknowns = |dependencies: &dyn Fn(&Variable<M>) -> String| -> Vec<Element> {
        let variables = (1_usize..).zip(table.variables());
        let outputs = variables.filter(|(_, variable)| variable.causality == Causality::Output);
        let unknown = |(index, variable): (usize, &Variable<M>)| {
            Element::new("Unknown")
                .attribute("index", index.to_string())
                .attribute("dependencies", dependencies(variable))
        };
        outputs.map(unknown).collect()
    };
    let sections = [
        section("Outputs", unknowns(&|_| String::new())),
        section("InitialUnknowns", unknowns(&at_initialization)),
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
    fn facts_are_checked() {
        let good = || ModelInfo {
            model_name: "a b",
            model_identifier: "a_b1",
            default_stop: 1.0,
            default_step: 0.5,
            ..ModelInfo::default()
        };
        assert_eq!(check_info(&good()), Ok(()));
        let nameless = ModelInfo {
            model_name: "",
            ..good()
        };
        assert_eq!(check_info(&nameless), Err(DefinitionError::NoModelName));
        for model_identifier in ["", "a-b", "1a", "a b", "\u{e4}"] {
            let identifier = model_identifier.to_owned();
            let info = ModelInfo {
                model_identifier,
                ..good()
            };
            assert_eq!(check_info(&info), Err(DefinitionError::BadIdentifier { identifier }));
        }
        for (default_stop, default_step) in [(0.0, 0.5), (1.0, 0.0), (f64::INFINITY, 1.0)] {
            let info = ModelInfo {
                default_stop,
                default_step,
                ..good()
            };
            let (stop, step) = (default_stop, default_step);
            assert_eq!(check_info(&info), Err(DefinitionError::BadExperiment { stop, step }));
        }
    }
}
