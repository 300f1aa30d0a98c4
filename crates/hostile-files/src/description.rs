//! `modelDescription.xml`, as masters read it, as the checker reads it, and the annotation for the harness inside.

use std::path::Path;

use fmi2_import::ModelDescription;
use interface::annotation::Filters;

use crate::cage::cage;
use crate::zips::DESCRIPTION;
use crate::{Kind, told, zips};

pub(crate) const KIND: Kind = Kind {
    name: "description",
    feed,
    seeds,
};

fn feed(bytes: &[u8]) {
    match ModelDescription::parse(bytes, Path::new("given.xml")) {
        Ok(description) => {
            for variable in &description.variables {
                assert!(description.variable(&variable.name).is_ok());
            }
            let annotations = description.vendor_annotations.iter().map(|a| a.xml.as_str());
            // It names the tag; whoever asks adds the FMU.
            let _ = Filters::read(annotations);
        }
        Err(error) => told(&error, "given.xml"),
    }
    let cage = cage();
    let path = cage.put("given.fmu", &zips::stored(&[("modelDescription.xml", bytes)]));
    let found = fmi2_check::check(&path, None);
    assert!(
        found.is_ok(),
        "what is wrong with a description is a finding: {found:?}"
    );
    cage.check(&[&path]);
}

/// Descriptions that come with the project are too long to begin with: a few variables of each kind are kept.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let all = [
        (
            "fmu-truth",
            include_str!("../../../modelDescription/fmu-truth/modelDescription.xml"),
        ),
        (
            "fmu-nav",
            include_str!("../../../modelDescription/fmu-nav/modelDescription.xml"),
        ),
        ("good", include_str!("../../fmi2-check/tests/good/modelDescription.xml")),
    ];
    let mut seeds = vec![("tank".to_owned(), DESCRIPTION.as_bytes().to_vec())];
    for (name, text) in all {
        seeds.push((name.to_owned(), shortened(text).into_bytes()));
    }
    let utf16 = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
        let text = DESCRIPTION.replace("UTF-8", "UTF-16");
        std::iter::once(0xfeff)
            .chain(text.encode_utf16())
            .flat_map(order)
            .collect()
    };
    seeds.push(("utf-16-le".to_owned(), utf16(u16::to_le_bytes)));
    seeds.push(("utf-16-be".to_owned(), utf16(u16::to_be_bytes)));
    let latin = DESCRIPTION
        .replace("UTF-8", "ISO-8859-1")
        .replace("tank-1", "t\u{e4}nk");
    seeds.push(("latin-1".to_owned(), latin.chars().map(|c| c as u8).collect()));
    seeds
}

/// The first variable of each combination of causality and type.
fn shortened(text: &str) -> String {
    let Some((head, rest)) = text.split_once("<ModelVariables>") else {
        return text.to_owned();
    };
    let Some((variables, tail)) = rest.split_once("</ModelVariables>") else {
        return text.to_owned();
    };
    let mut known = std::collections::BTreeSet::new();
    let kept: String = variables
        .split_inclusive("</ScalarVariable>")
        .filter(|variable| {
            let part = |from: &str| variable.split(from).nth(1).and_then(|rest| rest.get(..6));
            known.insert((part("causality=\""), part("\">").or_else(|| part("<R"))))
        })
        .collect();
    format!("{head}<ModelVariables>{kept}</ModelVariables>{tail}")
}
