//! `modelDescription.xml` to [`ModelDescription`].
//!
//! `raw` mirrors the schema, `resolve` turns it into what the rest of the crate works with.

mod raw;
mod resolve;

use std::path::Path;

use quick_xml::events::Event;
use serde::Deserialize;

use crate::ImportError;
use crate::description::ModelDescription;
use raw::{RawDescription, RawRoot};
use resolve::Resolver;

/// Reads the text of a `modelDescription.xml`; `path` is the FMU, for messages.
///
/// # Errors
/// [`ImportError::MalformedXml`], [`ImportError::FmiVersion`], [`ImportError::NotCoSimulation`] or
/// [`ImportError::InvalidDescription`].
pub(crate) fn parse(xml: &[u8], path: &Path) -> Result<ModelDescription, ImportError> {
    let xml = std::str::from_utf8(xml).map_err(|e| malformed(path, xml, e.valid_up_to(), "not UTF-8".to_owned()))?;
    check_well_formed(xml, path)?;
    // The version comes first: other versions of the standard have other elements.
    let root: RawRoot = deserialize(xml, path)?;
    if root.fmi_version != "2.0" {
        return Err(ImportError::FmiVersion {
            path: path.to_owned(),
            found: root.fmi_version,
        });
    }
    let raw: RawDescription = deserialize(xml, path)?;
    Resolver { path }.description(raw)
}

fn malformed(path: &Path, xml: &[u8], offset: usize, reason: String) -> ImportError {
    let before = &xml[..offset.min(xml.len())];
    let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    ImportError::MalformedXml {
        path: path.to_owned(),
        line: before.iter().filter(|&&b| b == b'\n').count() + 1,
        column: before.len() - line_start + 1,
        reason,
    }
}

/// Walks all tags, since the reader behind serde skips over elements that nobody asked for and ends at the root's end tag.
fn check_well_formed(xml: &str, path: &Path) -> Result<(), ImportError> {
    let mut reader = quick_xml::Reader::from_str(xml);
    let mut open: usize = 0;
    loop {
        match reader.read_event() {
            Ok(Event::Eof) if open == 0 => return Ok(()),
            Ok(Event::Eof) => {
                return Err(malformed(
                    path,
                    xml.as_bytes(),
                    xml.len(),
                    format!("the file ends with {open} element(s) open"),
                ));
            }
            Ok(Event::Start(_)) => open += 1,
            Ok(Event::End(_)) => open = open.saturating_sub(1),
            Ok(_) => {}
            Err(e) => {
                let offset = usize::try_from(reader.error_position()).unwrap_or(usize::MAX);
                return Err(malformed(path, xml.as_bytes(), offset, e.to_string()));
            }
        }
    }
}

fn deserialize<'de, T: Deserialize<'de>>(xml: &'de str, path: &Path) -> Result<T, ImportError> {
    let mut source = quick_xml::de::Deserializer::from_str(xml);
    T::deserialize(&mut source).map_err(|e| {
        let offset = usize::try_from(source.get_ref().get_ref().buffer_position()).unwrap_or(usize::MAX);
        malformed(path, xml.as_bytes(), offset, e.to_string().replace("`@", "`"))
    })
}
