//! What descriptions of every version have in common, and the GUID that ties a library to its description.

use std::collections::{BTreeMap, BTreeSet};

use fmi_model::{
    Category, Causality, DefinitionError, Element, Model, ModelInfo, Table, Typed, Unit, Variable, braced, number,
    quantity,
};
use uuid::Uuid;

use crate::version::Version;

/// Stands for a GUID that the build makes: a committed description cannot know it.
const MADE_BY_THE_BUILD: &str = "{made-by-the-build}";

/// `modelDescription.xml` of `M`, the same text on every call and every machine; with a placeholder for a GUID that the build
/// has a part in ([`ModelInfo::guid`]). Whoever packs the FMU replaces it by [`guid`], which follows from this text.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn render<V: Version, M: Model>() -> Result<String, DefinitionError> {
    let own = guid::<V, M>()?;
    let guid = M::info()
        .guid
        .map_or_else(|| braced(own), |_| MADE_BY_THE_BUILD.to_owned());
    Ok(V::document(M::info(), M::table(), &guid)?.to_document())
}

/// GUID of `M`, which any change to the interface changes, so that a library refuses a description of another table: version 5
/// over what [`render`] gives, in the namespace of the build's GUID; without one, over the XML without GUID and the version.
///
/// # Errors
/// The first mistake in the table or in [`ModelInfo`].
pub fn guid<V: Version, M: Model>() -> Result<Uuid, DefinitionError> {
    M::info().check()?;
    if let Some(defect) = M::table().defect() {
        return Err(defect.clone());
    }
    let text = |guid| Ok(V::document(M::info(), M::table(), guid)?.to_document());
    Ok(match M::info().guid {
        Some(build) => Uuid::new_v5(&build, text(MADE_BY_THE_BUILD)?.as_bytes()),
        None => Uuid::new_v5(&Uuid::NAMESPACE_OID, (text("")? + M::info().version).as_bytes()),
    })
}

/// `<fmiModelDescription>` without children.
///
/// * `tool`: name and version of what renders it.
pub fn head<V: Version>(info: &ModelInfo, identifier: &str, tool: &str) -> Element {
    Element::new("fmiModelDescription")
        .attribute("fmiVersion", V::FMI_VERSION)
        .attribute("modelName", info.model_name)
        .attribute(V::IDENTIFIER, identifier)
        .attribute_if_any("description", info.description)
        .attribute_if_any("author", info.author)
        .attribute_if_any("version", info.version)
        .attribute_if_any("copyright", info.copyright)
        .attribute_if_any("license", info.license)
        .attribute("generationTool", tool)
        .attribute("variableNamingConvention", "structured")
}

/// The units in use, by name; those in `further`, too.
pub fn unit_definitions<M>(table: &Table<M>, further: &[&'static str]) -> Option<Element> {
    let mut units: BTreeMap<&str, BTreeSet<&str>> = further.iter().map(|unit| (*unit, BTreeSet::new())).collect();
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

/// The quantities in use, each a type of its own: name, unit and display unit, by name.
pub fn quantities<M>(table: &Table<M>) -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let mut known: BTreeMap<&'static str, (&'static str, &'static str)> = BTreeMap::new();
    for entry in table.entries() {
        if let (Typed::Real { display_unit, .. }, Some(unit)) = (&entry.row.typed, entry.unit())
            && let Some((name, unit)) = quantity(unit)
        {
            let (_, shown) = known.entry(name).or_insert((unit, ""));
            *shown = display_unit.unwrap_or(shown);
        }
    }
    known.into_iter().map(|(name, (unit, shown))| (name, unit, shown))
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

/// `<LogCategories>`.
pub fn log_categories<V: Version>() -> Element {
    Element::new("LogCategories").children(Category::ALL.into_iter().map(|category| {
        Element::new("Category")
            .attribute("name", category.name())
            .attribute("description", about::<V>(category))
    }))
}

/// One sentence about a category.
fn about<V: Version>(category: Category) -> String {
    let ended = match category {
        Category::StatusWarning => "Warning",
        Category::StatusDiscard => "Discard",
        Category::StatusError => "Error",
        Category::StatusFatal => "Fatal",
        Category::Events => return "noteworthy events of the model, sent while logging is on".to_owned(),
        Category::All => return "every message, details included".to_owned(),
    };
    format!(
        "messages of calls that end in {}{ended}, sent while logging is on",
        V::PREFIX
    )
}

/// `<DefaultExperiment>`.
pub fn default_experiment(info: &ModelInfo) -> Element {
    Element::new("DefaultExperiment")
        .attribute("startTime", "0")
        .attribute("stopTime", number(info.default_stop))
        .attribute("tolerance", number(info.default_tolerance))
        .attribute("stepSize", number(info.default_step))
}

/// What each tool is told, in an element `name` of which `key` says which tool.
///
/// # Errors
/// The first annotation that is not one element.
pub fn annotations(info: &ModelInfo, name: &str, key: &str) -> Result<Vec<Element>, DefinitionError> {
    let told = info.vendor_annotations.iter().map(|annotation| {
        let tool = Element::new(name).attribute(key, annotation.tool());
        Ok(tool.child(annotation.content()?.clone()))
    });
    told.collect()
}

/// What `initial` says of a variable of this causality. It must not be stated of an input, which always starts at its start value.
pub fn initial(causality: Causality) -> &'static str {
    match causality {
        Causality::Parameter => "exact",
        Causality::Input => "",
        Causality::CalculatedParameter | Causality::Output | Causality::Local => "calculated",
    }
}

/// Whether the value of `unknown` depends on `row` at initialization: on every parameter, and on the inputs that it names.
pub fn known_initially<M>(unknown: &Variable<M>, row: &Variable<M>) -> bool {
    match row.causality {
        Causality::Parameter => true,
        Causality::Input => unknown.initial_inputs.contains(&row.name.as_str()),
        Causality::CalculatedParameter | Causality::Output | Causality::Local => false,
    }
}

/// A section with these entries; FMI has no empty sections.
pub fn section(name: &str, entries: impl IntoIterator<Item = Element>) -> Option<Element> {
    let mut entries = entries.into_iter().peekable();
    entries.peek()?;
    Some(Element::new(name).children(entries))
}

/// The text of an attribute that may be absent, then empty.
pub fn optional<T>(value: Option<T>, show: impl Fn(T) -> String) -> String {
    value.map(show).unwrap_or_default()
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
