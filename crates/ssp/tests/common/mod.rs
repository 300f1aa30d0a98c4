//! Structures written by hand.

#![allow(dead_code, reason = "each test binary uses its own part")]
#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

use ssp::{Flat, Package, SspError, flatten};
use std::fs;

const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<s:SystemStructureDescription version="1.0" name="hand"
    xmlns:s="http://ssp-standard.org/SSP1/SystemStructureDescription"
    xmlns="http://ssp-standard.org/SSP1/SystemStructureCommon"
    xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
    xmlns:ssm="http://ssp-standard.org/SSP1/SystemStructureParameterMapping">
"#;

/// A structure whose system holds this; its prefixes are not the usual ones, which is what namespaces are for.
pub fn structure(inside: &str, after: &str) -> String {
    format!("{HEAD}<s:System name=\"top\">\n{inside}\n</s:System>\n{after}</s:SystemStructureDescription>\n")
}

pub fn read_folder(files: &[(&str, &str)]) -> Result<Package, SspError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    Package::open(folder.path())
}

pub fn read(inside: &str) -> Result<Flat, SspError> {
    flatten(read_folder(&[("SystemStructure.ssd", &structure(inside, ""))])?.structure())
}

pub fn component(name: &str, connectors: &str, more: &str) -> String {
    format!(
        "<s:Component name=\"{name}\" source=\"resources/{name}.fmu\"><s:Connectors>{connectors}</s:Connectors>{more}</s:Component>"
    )
}

pub fn real(name: &str, kind: &str) -> String {
    format!("<s:Connector name=\"{name}\" kind=\"{kind}\"><Real unit=\"m\"/></s:Connector>")
}

pub fn wire(from: &str, to: &str, inside: &str) -> String {
    let end = |side: &str, text: &str| match text.split_once('.') {
        Some((element, connector)) => format!("{side}Element=\"{element}\" {side}Connector=\"{connector}\""),
        None => format!("{side}Connector=\"{text}\""),
    };
    format!(
        "<s:Connection {} {}>{inside}</s:Connection>",
        end("start", from),
        end("end", to)
    )
}

pub fn linear(factor: f64, offset: f64) -> String {
    format!("<LinearTransformation factor=\"{factor}\" offset=\"{offset}\"/>")
}

pub fn set(parameters: &str) -> String {
    format!(
        "<ssv:ParameterSet version=\"1.0\" name=\"given\"><ssv:Parameters>{parameters}</ssv:Parameters></ssv:ParameterSet>"
    )
}

pub fn inline(parameters: &str, more: &str) -> String {
    format!(
        "<s:ParameterBindings><s:ParameterBinding><s:ParameterValues>{}</s:ParameterValues>{more}</s:ParameterBinding></s:ParameterBindings>",
        set(parameters)
    )
}

pub fn value(name: &str, text: &str) -> String {
    format!("<ssv:Parameter name=\"{name}\"><ssv:Real value=\"{text}\"/></ssv:Parameter>")
}
