//! System structures: archives with their `.ssd`, and files of values and mappings.

use ssp::{Package, STRUCTURE, SspError, flatten};

use crate::cage::cage;
use crate::{Kind, told, zips};

pub(crate) const KIND: Kind = Kind {
    name: "ssp",
    feed,
    seeds,
};

/// What begins with the mark of an archive is one; anything else is the structure, in an archive with a file of values.
fn feed(bytes: &[u8]) {
    let archive = if bytes.starts_with(b"PK") {
        bytes.to_vec()
    } else {
        zips::stored(&[
            (STRUCTURE, bytes),
            ("values.ssv", VALUES.as_bytes()),
            ("names.ssm", MAPPING.as_bytes()),
            // The same bytes once more, for a binding that names them.
            ("again.ssv", bytes),
        ])
    };
    let cage = cage();
    let path = cage.put("given.ssp", &archive);
    match Package::open(&path) {
        Ok(mut package) => {
            // What leads out of the archive is not followed here.
            let outside = |source: &str| source.contains(':') || source.contains('%');
            match flatten(package.structure()) {
                Ok(flat) => {
                    for component in flat.components.iter().filter(|c| !outside(&c.source)).take(20) {
                        let _ = package.source("a component", &component.source);
                    }
                }
                // It names the element.
                Err(error) => assert!(error.to_string().len() > 10),
            }
            let _ = package.structure().to_xml();
        }
        // Files in the archive go by their own names.
        Err(SspError::Xml { file, line, .. } | SspError::Invalid { file, line, .. }) => {
            assert!(!file.is_empty() && line > 0);
        }
        Err(SspError::Source { by, uri: _, .. }) => assert!(!by.is_empty()),
        Err(error) => told(&error, "given.ssp"),
    }
    cage.check(&[&path]);
}

const VALUES: &str = r#"<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="1.0" name="v">
  <ssv:Parameters><ssv:Parameter name="gain"><ssv:Real value="2" unit="m"/></ssv:Parameter></ssv:Parameters>
</ssv:ParameterSet>
"#;

const MAPPING: &str = r#"<ssm:ParameterMapping xmlns:ssm="http://ssp-standard.org/SSP1/SystemStructureParameterMapping" xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon" version="1.0">
  <ssm:MappingEntry source="gain" target="k"><ssc:LinearTransformation factor="3" offset="1"/></ssm:MappingEntry>
</ssm:ParameterMapping>
"#;

const STRUCTURED: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<ssd:SystemStructureDescription xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon" xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription" xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="1.0" name="s">
  <ssd:System name="root">
    <ssd:Connectors><ssd:Connector name="u" kind="input"><ssc:Real unit="m"/></ssd:Connector></ssd:Connectors>
    <ssd:ParameterBindings>
      <ssd:ParameterBinding prefix="a." source="values.ssv"><ssd:ParameterMapping source="names.ssm"/></ssd:ParameterBinding>
      <ssd:ParameterBinding><ssd:ParameterValues><ssv:ParameterSet version="1.0" name="w"><ssv:Parameters>
        <ssv:Parameter name="inner.b.n"><ssv:Integer value="3"/></ssv:Parameter></ssv:Parameters></ssv:ParameterSet></ssd:ParameterValues></ssd:ParameterBinding>
    </ssd:ParameterBindings>
    <ssd:Elements>
      <ssd:Component name="a" source="values.ssv"><ssd:Connectors><ssd:Connector name="x" kind="output"><ssc:Real/></ssd:Connector><ssd:Connector name="k" kind="parameter"/></ssd:Connectors></ssd:Component>
      <ssd:System name="inner">
        <ssd:Connectors><ssd:Connector name="in" kind="input"/></ssd:Connectors>
        <ssd:Elements><ssd:Component name="b" source="./resources/b.fmu"><ssd:Connectors><ssd:Connector name="u" kind="input"/><ssd:Connector name="n" kind="parameter"><ssc:Integer/></ssd:Connector></ssd:Connectors></ssd:Component></ssd:Elements>
        <ssd:Connections><ssd:Connection startConnector="in" endElement="b" endConnector="u"><ssc:LinearTransformation factor="2"/></ssd:Connection></ssd:Connections>
      </ssd:System>
    </ssd:Elements>
    <ssd:Connections><ssd:Connection startElement="a" startConnector="x" endElement="inner" endConnector="in"/></ssd:Connections>
  </ssd:System>
  <ssd:Units><ssd:Unit name="m"><ssc:BaseUnit m="1"/></ssd:Unit></ssd:Units>
  <ssd:DefaultExperiment startTime="0" stopTime="10"/>
</ssd:SystemStructureDescription>
"#;

fn seeds() -> Vec<(String, Vec<u8>)> {
    let archive = |entries: &[(&str, &[u8])]| zips::deflated(entries);
    let with = |first: &[u8]| {
        archive(&[
            (STRUCTURE, first),
            ("values.ssv", VALUES.as_bytes()),
            ("names.ssm", MAPPING.as_bytes()),
        ])
    };
    vec![
        ("structure".to_owned(), STRUCTURED.as_bytes().to_vec()),
        ("archive".to_owned(), with(STRUCTURED.as_bytes())),
        ("no-structure".to_owned(), archive(&[("values.ssv", VALUES.as_bytes())])),
        ("values".to_owned(), VALUES.as_bytes().to_vec()),
        ("mapping".to_owned(), MAPPING.as_bytes().to_vec()),
        (
            "circle".to_owned(),
            STRUCTURED
                .replace(
                    "startElement=\"a\" startConnector=\"x\"",
                    "startElement=\"inner\" startConnector=\"in\"",
                )
                .into_bytes(),
        ),
        (
            "itself".to_owned(),
            STRUCTURED.replace("values.ssv", "again.ssv").into_bytes(),
        ),
        (
            "climbs".to_owned(),
            STRUCTURED.replace("values.ssv", "../../values.ssv").into_bytes(),
        ),
        (
            "climbs-encoded".to_owned(),
            STRUCTURED.replace("values.ssv", "%2e%2e/values.ssv").into_bytes(),
        ),
    ]
}
