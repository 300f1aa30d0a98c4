//! The document as a tree in which every element knows its line and what to call it.

use std::collections::BTreeMap;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};

use crate::finding::Findings;
use crate::rules::xml as rules;

/// Elements inside each other, at most; the schema needs six and annotations are anybody's.
const DEPTH: usize = 200;

/// Elements of a document, at most: three for each variable, and a million of those.
const ELEMENTS: usize = 3_000_000;

/// Longest attribute, bytes, but for those of [`LONG`] and in annotations. What many variables share is looked at as often.
const ATTRIBUTE: usize = 4096;

/// Attributes that may be long.
const LONG: [&str; 4] = ["dependencies", "dependenciesKind", "description", "start"];

/// Bytes of a path, and of one name in it, that findings show.
const SHOWN: [usize; 2] = [400, 100];

/// The beginning of a text.
fn short(text: &str, length: usize) -> &str {
    let mut end = length.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    &text[..end]
}

/// An element.
#[derive(Debug, Default)]
pub(crate) struct Node {
    pub(crate) name: String,
    /// What findings call it.
    pub(crate) path: String,
    pub(crate) attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Node>,
    pub(crate) line: usize,
    /// Whether there is text right inside it.
    pub(crate) text: bool,
}

impl Node {
    /// The value of an attribute.
    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        self.attributes
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, value)| value.as_str())
    }

    /// The first child of this name.
    pub(crate) fn child(&self, name: &str) -> Option<&Node> {
        self.children.iter().find(|child| child.name == name)
    }

    /// All children of this name.
    pub(crate) fn named(&self, name: &'static str) -> impl Iterator<Item = &Node> + use<'_> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// Children of a child, where there is such a child.
    pub(crate) fn inside<'a>(&'a self, list: &str, name: &'static str) -> impl Iterator<Item = &'a Node> + use<'a> {
        self.child(list).into_iter().flat_map(move |list| list.named(name))
    }

    /// Calls it and everything below by paths from the root, whose own name is left out.
    fn call(&mut self, path: String) {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for child in &self.children {
            *counts.entry(child.name.clone()).or_default() += 1;
        }
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for place in 0..self.children.len() {
            let name = self.children[place].name.clone();
            let own = self.children[place].get("name").unwrap_or_default();
            let own = if self.name == "ModelVariables" {
                own
            } else {
                short(own, SHOWN[1])
            };
            let before = seen.entry(name.clone()).or_default();
            *before += 1;
            let (before, many) = (*before, counts.get(&name).is_some_and(|count| *count > 1));
            let step = if name == "ScalarVariable" && !own.is_empty() {
                own.to_owned()
            } else if self.name == "ScalarVariable" {
                path.clone()
            } else {
                let place = match own {
                    "" if many => format!("[{before}]"),
                    "" => String::new(),
                    own => format!("[@name='{own}']"),
                };
                let above = if path.is_empty() {
                    String::new()
                } else {
                    format!("{path}/")
                };
                format!("{above}{name}{place}")
            };
            let longest = SHOWN[0].max(own.len());
            self.children[place].call(short(&step, longest).to_owned());
        }
        self.path = if path.is_empty() { self.name.clone() } else { path };
    }
}

/// Reads the document; nothing where it is no document, which is a finding.
pub(crate) fn parse(bytes: &[u8], findings: &mut Findings) -> Option<Node> {
    const FILE: &str = "modelDescription.xml";
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(error) => {
            let line = bytes[..error.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
            findings.at(line, &rules::ENCODING, FILE, "the bytes are not UTF-8");
            // Latin-1 reads every byte, so that the rest can be checked; a UTF-16 file says nothing in it.
            bytes.iter().map(|byte| char::from(*byte)).collect()
        }
    };
    match grow(text.trim_start_matches('\u{feff}'), findings) {
        Ok(mut root) => {
            if root.name != "fmiModelDescription" {
                let what = format!("the root element is {}", root.name);
                findings.at(root.line, &rules::ROOT, root.name, what);
                return None;
            }
            root.call(String::new());
            Some(root)
        }
        Err((line, what)) => {
            findings.at(line, &rules::WELL_FORMED, FILE, what);
            None
        }
    }
}

type Failure = (usize, String);

fn grow(text: &str, findings: &mut Findings) -> Result<Node, Failure> {
    let mut reader = quick_xml::Reader::from_str(text);
    let (mut line, mut counted) = (1, 0);
    let mut open: Vec<Node> = Vec::new();
    let (mut root, mut elements) = (None, 0);
    loop {
        // The line on which the event begins.
        let begin = usize::try_from(reader.buffer_position())
            .unwrap_or(text.len())
            .min(text.len());
        line += text.as_bytes()[counted..begin].iter().filter(|b| **b == b'\n').count();
        counted = begin;
        let event = reader.read_event().map_err(|error| (line, error.to_string()))?;
        match event {
            Event::Eof => break,
            Event::Decl(declaration) => {
                let said = declaration.encoding().and_then(Result::ok).unwrap_or_default();
                // Without a word XML is UTF-8.
                if !said.is_empty() && !said.eq_ignore_ascii_case("utf-8") {
                    let what = format!("the declared encoding is {said}");
                    findings.at(line, &rules::ENCODING, "modelDescription.xml", what);
                }
            }
            Event::Start(_) | Event::Empty(_) if elements == ELEMENTS => {
                return Err((line, format!("there are more than {ELEMENTS} elements")));
            }
            Event::Start(_) | Event::Empty(_) if root.is_some() && open.is_empty() => {
                return Err((line, "there is a second root element".to_owned()));
            }
            Event::Start(tag) => {
                if open.len() == DEPTH {
                    return Err((line, format!("elements lie more than {DEPTH} deep")));
                }
                elements += 1;
                open.push(node(&tag, line, annotated(&open))?);
            }
            Event::Empty(tag) => {
                elements += 1;
                close(node(&tag, line, annotated(&open))?, &mut open, &mut root);
            }
            Event::End(_) => {
                if let Some(done) = open.pop() {
                    close(done, &mut open, &mut root);
                }
            }
            Event::Text(text) if text.chars().any(|c| !c.is_whitespace()) => said(&mut open, line)?,
            Event::CData(_) => said(&mut open, line)?,
            Event::GeneralRef(_) => said(&mut open, line)?,
            _ => (),
        }
    }
    match (open.last(), root) {
        (Some(last), _) => Err((line, format!("the file ends inside {}", last.name))),
        (None, Some(root)) => Ok(root),
        (None, None) => Err((line, "there is no element".to_owned())),
    }
}

fn said(open: &mut [Node], line: usize) -> Result<(), Failure> {
    match open.last_mut() {
        Some(node) => {
            node.text = true;
            Ok(())
        }
        None => Err((line, "there is text outside the root element".to_owned())),
    }
}

fn close(done: Node, open: &mut [Node], root: &mut Option<Node>) {
    match open.last_mut() {
        Some(parent) => parent.children.push(done),
        None => *root = Some(done),
    }
}

/// Whether what comes next stands in an annotation, where anything may.
fn annotated(open: &[Node]) -> bool {
    open.iter().any(|node| node.name == "Tool")
}

fn node(tag: &BytesStart<'_>, line: usize, annotated: bool) -> Result<Node, Failure> {
    let mut node = Node {
        name: tag.name().as_ref().to_owned(),
        line,
        ..Node::default()
    };
    for attribute in tag.attributes() {
        let attribute = attribute.map_err(|error| (line, format!("in {}: {error}", node.name)))?;
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(|error| (line, format!("in {}: {error}", node.name)))?;
        let key: &str = attribute.key.as_ref();
        if value.len() > ATTRIBUTE && !annotated && !LONG.contains(&key) {
            let what = format!(
                "{} of {} is longer than {ATTRIBUTE} bytes",
                short(key, SHOWN[1]),
                node.name
            );
            return Err((line, what));
        }
        node.attributes.push((key.to_owned(), value.into_owned()));
    }
    Ok(node)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> (Option<Node>, Findings) {
        let mut findings = Findings::default();
        let root = parse(text.as_bytes(), &mut findings);
        (root, findings)
    }

    #[test]
    fn elements_are_called_by_what_tells_them_apart() {
        let (root, findings) = of(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription>\n<UnitDefinitions>\
            <Unit name=\"m/s\"/></UnitDefinitions>\n<ModelVariables>\n<ScalarVariable name=\"a[1]\"><Real/></ScalarVariable>\
            <ScalarVariable/></ModelVariables><ModelStructure><Outputs><Unknown/><Unknown/></Outputs></ModelStructure>\
            </fmiModelDescription>",
        );
        assert!(findings.0.is_empty(), "{findings:?}");
        let root = root.unwrap();
        assert_eq!(root.path, "fmiModelDescription");
        let unit = &root.children[0].children[0];
        assert_eq!(
            (unit.path.as_str(), unit.line),
            ("UnitDefinitions/Unit[@name='m/s']", 3)
        );
        let variables = &root.children[1].children;
        assert_eq!((variables[0].path.as_str(), variables[0].line), ("a[1]", 5));
        assert_eq!(variables[0].children[0].path, "a[1]");
        assert_eq!(variables[1].path, "ModelVariables/ScalarVariable[2]");
        assert_eq!(
            root.children[2].children[0].children[1].path,
            "ModelStructure/Outputs/Unknown[2]"
        );
    }

    #[test]
    fn what_is_no_document_is_told_with_its_line() {
        for (text, line, what) in [
            ("<a>\n<b>\n</a>", 3, "expected"),
            ("<a>\n<b>", 2, "ends inside b"),
            ("\n<a x=1/>", 2, "in a"),
            ("<a x=\"1\" x=\"2\"/>", 1, "in a"),
            ("<a>&nothing;</a>\n<b/>", 2, "second root"),
            ("<a/>\nmore", 1, "outside"),
            ("", 1, "no element"),
            ("<a x=\"&no;\"/>", 1, "in a"),
        ] {
            let (root, findings) = of(text);
            assert!(root.is_none());
            let finding = &findings.0[0];
            assert_eq!(
                (finding.rule.id, finding.line),
                ("xml.well-formed", Some(line)),
                "{text}"
            );
            assert!(finding.what.contains(what), "{text}: {}", finding.what);
        }
        let deep = "<a>".repeat(100_000);
        assert_eq!(of(&deep).1.0[0].rule.id, "xml.well-formed");
    }
}
