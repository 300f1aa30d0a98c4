//! `modelDescription.xml` to [`ModelDescription`].
//!
//! `encoding` makes text of the bytes, `raw` mirrors the schema, `resolve` turns it into what the rest of the crate works with.

mod encoding;
mod raw;
mod resolve;

use std::path::Path;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use serde::Deserialize;

use crate::ImportError;
use crate::description::{ModelDescription, VendorAnnotation};
use raw::{RawDescription, RawRoot};
use resolve::Resolver;

/// Reads a `modelDescription.xml` in the encoding that it declares; `path` is the FMU, for messages.
///
/// # Errors
/// [`ImportError::MalformedXml`], [`ImportError::FmiVersion`], [`ImportError::NotCoSimulation`] or
/// [`ImportError::InvalidDescription`].
pub(crate) fn parse(xml: &[u8], path: &Path) -> Result<ModelDescription, ImportError> {
    let xml = &*encoding::decode(xml).map_err(|(offset, reason)| malformed(path, xml, offset, reason))?;
    let annotations = walk(xml, path)?;
    // The version comes first: other versions of the standard have other elements.
    let root: RawRoot = deserialize(xml, path)?;
    if root.fmi_version != "2.0" {
        return Err(ImportError::FmiVersion {
            path: path.to_owned(),
            found: root.fmi_version,
        });
    }
    let raw: RawDescription = deserialize(xml, path)?;
    Resolver { path }.description(raw, annotations)
}

impl ModelDescription {
    /// Reads a `modelDescription.xml` that stands by itself.
    ///
    /// * `origin`: what messages call it.
    ///
    /// # Errors
    /// As for a description in an archive, [`ImportError`].
    pub fn parse(xml: &[u8], origin: &Path) -> Result<Self, ImportError> {
        parse(xml, origin)
    }
}

/// Elements inside each other, at most; the schema needs six and annotations are anybody's.
const DEPTH: usize = 200;

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

/// Walks all tags, since the reader behind serde skips over elements that nobody asked for and ends at the root's end tag; on
/// the way it takes down what stands inside vendor annotations, which is not ours to read.
fn walk(xml: &str, path: &Path) -> Result<Vec<VendorAnnotation>, ImportError> {
    const TOOL: [&str; 3] = ["fmiModelDescription", "VendorAnnotations", "Tool"];
    let mut reader = quick_xml::Reader::from_str(xml);
    let mut open: Vec<String> = Vec::new();
    let mut found = Vec::new();
    // Of the annotation that is open: the tool, and where its content begins.
    let mut tool: Option<(String, usize)> = None;
    loop {
        let before = offset(reader.buffer_position());
        let fail = |reader: &quick_xml::Reader<&[u8]>, reason: String| {
            malformed(path, xml.as_bytes(), offset(reader.error_position()), reason)
        };
        match reader.read_event().map_err(|e| fail(&reader, e.to_string()))? {
            Event::Eof if open.is_empty() => return Ok(found),
            Event::Eof => {
                let reason = format!("the file ends with {} element(s) open", open.len());
                return Err(malformed(path, xml.as_bytes(), xml.len(), reason));
            }
            Event::Start(_) if open.len() == DEPTH => {
                let reason = format!("elements lie more than {DEPTH} deep");
                return Err(malformed(path, xml.as_bytes(), before, reason));
            }
            Event::Start(tag) => {
                open.push(tag.name().as_ref().to_owned());
                if open == TOOL {
                    let name = tool_name(&tag).map_err(|reason| fail(&reader, reason))?;
                    tool = Some((name, offset(reader.buffer_position())));
                }
            }
            Event::Empty(tag) if open == TOOL[..2] && tag.name().as_ref() == TOOL[2] => {
                found.push(VendorAnnotation {
                    tool: tool_name(&tag).map_err(|reason| fail(&reader, reason))?,
                    xml: String::new(),
                });
            }
            Event::End(_) => {
                if open == TOOL
                    && let Some((tool, begin)) = tool.take()
                {
                    let content = xml.get(begin..before).unwrap_or_default();
                    found.push(VendorAnnotation {
                        tool,
                        xml: content.trim().to_owned(),
                    });
                }
                open.pop();
            }
            _ => {}
        }
    }
}

fn tool_name(tag: &BytesStart<'_>) -> Result<String, String> {
    let name = tag.try_get_attribute("name").map_err(|e| e.to_string())?;
    let text = name.map(|name| name.normalized_value(XmlVersion::Implicit1_0));
    let text = text.transpose().map_err(|e| e.to_string())?;
    Ok(text.unwrap_or_default().into_owned())
}

/// A position of the XML reader as an index.
fn offset(position: u64) -> usize {
    usize::try_from(position).unwrap_or(usize::MAX)
}

fn deserialize<'de, T: Deserialize<'de>>(xml: &'de str, path: &Path) -> Result<T, ImportError> {
    let mut source = quick_xml::de::Deserializer::from_str(xml);
    T::deserialize(&mut source).map_err(|e| {
        let end = offset(source.get_ref().get_ref().buffer_position());
        malformed(path, xml.as_bytes(), end, e.to_string().replace("`@", "`"))
    })
}
