//! XML as elements with their lines; names are those of the standard's namespaces.

use quick_xml::NsReader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::name::ResolveResult;

use crate::SspError;

/// How the namespaces of SSP 1.0 begin; the rest names the part.
const SSP1: &str = "http://ssp-standard.org/SSP1/";

/// The namespaces of SSP 1.0 by the prefix that the standard gives them.
pub(crate) const SPACES: [(&str, &str); 5] = [
    ("ssc", "SystemStructureCommon"),
    ("ssd", "SystemStructureDescription"),
    ("ssv", "SystemStructureParameterValues"),
    ("ssm", "SystemStructureParameterMapping"),
    ("ssb", "SystemStructureSignalDictionary"),
];

/// URI of a namespace.
pub(crate) fn namespace(part: &str) -> String {
    format!("{SSP1}{part}")
}

/// Deepest nesting that is read; what is deeper is no system structure.
const DEEPEST: usize = 200;

/// Elements of all files of a structure, at most: the parts of a structure are held against each other.
pub(crate) const ELEMENTS: usize = 200_000;

/// Longest attribute, bytes, but for [`LONG`]: names go into those of everything inside.
const ATTRIBUTE: usize = 1000;

/// Attributes that may be long.
const LONG: [&str; 2] = ["description", "value"];

/// An element.
#[derive(Debug)]
pub(crate) struct Node {
    /// The standard's prefix and the name, as `ssd:System`; the name alone in any other namespace.
    pub(crate) name: String,
    /// Line where it begins.
    pub(crate) line: usize,
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Node>,
}

impl Node {
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes
            .iter()
            .find(|(key, _)| key == name)
            .map(|(_, value)| value.as_str())
    }

    pub(crate) fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|child| child.name == name)
    }

    /// Children of the first child of this name.
    pub(crate) fn list(&self, name: &str) -> &[Self] {
        self.child(name).map_or(&[], |child| child.children.as_slice())
    }

    /// The element and its name, for messages.
    pub(crate) fn label(&self) -> String {
        match self.attribute("name") {
            Some(name) => format!("{} '{name}'", self.name),
            None => self.name.clone(),
        }
    }
}

/// Reads a document.
///
/// * `file`: what messages call it.
/// * `left`: elements that may still be read.
pub(crate) fn parse(file: &str, bytes: &[u8], left: &mut usize) -> Result<Node, SspError> {
    let wrong = |line: usize, problem: String| SspError::Xml {
        file: file.to_owned(),
        line,
        problem,
    };
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count();
        wrong(line, "is not UTF-8".to_owned())
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = NsReader::from_str(text);
    let mut place = Place { text, at: 0, line: 1 };
    let mut open: Vec<Node> = Vec::new();
    let mut root = None;
    loop {
        let line = place.line_at(reader.buffer_position());
        let (space, event) = reader
            .read_resolved_event()
            .map_err(|error| wrong(line, error.to_string()))?;
        if matches!(event, Event::Start(_) | Event::Empty(_)) {
            let fewer = left.checked_sub(1);
            *left = fewer.ok_or_else(|| wrong(line, format!("the structure has more than {ELEMENTS} elements")))?;
        }
        let closed = match event {
            Event::Start(start) => {
                if open.len() == DEEPEST {
                    return Err(wrong(line, format!("more than {DEEPEST} elements inside each other")));
                }
                open.push(node(&space, &start, line).map_err(|problem| wrong(line, problem))?);
                None
            }
            Event::Empty(start) => Some(node(&space, &start, line).map_err(|problem| wrong(line, problem))?),
            Event::End(_) => open.pop(),
            Event::Eof => break,
            _ => None,
        };
        let Some(closed) = closed else { continue };
        match open.last_mut() {
            Some(parent) => parent.children.push(closed),
            None if root.is_none() => root = Some(closed),
            None => return Err(wrong(line, "a second element beside the first".to_owned())),
        }
    }
    let line = place.line_at(text.len() as u64);
    match (open.last(), root) {
        (Some(node), _) => Err(wrong(line, format!("the file ends inside {}", node.label()))),
        (None, None) => Err(wrong(line, "no element".to_owned())),
        (None, Some(root)) => Ok(root),
    }
}

/// Counts lines as the reader goes on.
struct Place<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl Place<'_> {
    fn line_at(&mut self, position: u64) -> usize {
        let to = usize::try_from(position).unwrap_or(usize::MAX).min(self.text.len());
        let passed = self.text.as_bytes().get(self.at..to).unwrap_or_default();
        self.line += passed.iter().filter(|byte| **byte == b'\n').count();
        self.at = self.at.max(to);
        self.line
    }
}

fn node(space: &ResolveResult<'_>, start: &BytesStart<'_>, line: usize) -> Result<Node, String> {
    let local = start.local_name();
    let local: &str = local.as_ref();
    let name = match space {
        ResolveResult::Bound(uri) => {
            let uri: &str = uri.as_ref();
            let part = uri.strip_prefix(SSP1);
            let known = part.and_then(|part| SPACES.iter().find(|(_, name)| *name == part));
            known.map_or_else(|| local.to_owned(), |(prefix, _)| format!("{prefix}:{local}"))
        }
        ResolveResult::Unbound => local.to_owned(),
        ResolveResult::Unknown(prefix) => {
            return Err(format!("prefix '{prefix}' of element '{local}' is not declared"));
        }
    };
    let mut attributes = Vec::new();
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(|error| error.to_string())?;
        let key: &str = attribute.key.as_ref();
        if value.len() > ATTRIBUTE && !LONG.contains(&key) {
            return Err(format!("an attribute of {local} is longer than {ATTRIBUTE} bytes"));
        }
        attributes.push((key.to_owned(), value.into_owned()));
    }
    Ok(Node {
        name,
        line,
        attributes,
        children: Vec::new(),
    })
}
