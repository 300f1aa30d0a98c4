//! A tree of XML elements and its one rendering: two spaces of indent, LF, attributes in the order given, final newline.

use quick_xml::escape::escape;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

/// An element with more attributes than this gets a line for each, so that a diff shows which one changed.
const ATTRIBUTES_ON_A_LINE: usize = 6;

/// Why a text is no [`Element`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum XmlError {
    /// It is not well-formed.
    #[error("not well-formed at byte {position}: {reason}")]
    Malformed {
        /// Where reading ended, from 0.
        position: u64,
        /// What the XML reader said.
        reason: String,
    },
    /// There is something between the tags.
    #[error("text {text:?} between tags, where only elements may stand")]
    Text {
        /// What was found.
        text: String,
    },
    /// There is no element, or more than one.
    #[error("{count} elements at the top, where one is needed")]
    Roots {
        /// So many.
        count: usize,
    },
}

/// An element with attributes and child elements. Values are escaped when it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    children: Vec<Element>,
}

impl Element {
    /// An element without attributes and children.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            attributes: Vec::new(),
            children: Vec::new(),
        }
    }

    /// Reads one element with all inside it. Comments, declarations and blanks are passed over.
    ///
    /// # Errors
    /// Why the text is no tree of elements with attributes.
    pub fn parse(text: &str) -> Result<Self, XmlError> {
        let mut reader = Reader::from_str(text);
        let malformed = |reader: &Reader<&[u8]>, reason: String| XmlError::Malformed {
            position: reader.error_position(),
            reason,
        };
        // The document, then every element that is open.
        let mut open = vec![Self::new("")];
        loop {
            let event = reader.read_event().map_err(|e| malformed(&reader, e.to_string()))?;
            let tag = |start: &BytesStart<'_>| Self::start(start).map_err(|reason| malformed(&reader, reason));
            let closed = match event {
                Event::Start(start) => {
                    open.push(tag(&start)?);
                    continue;
                }
                Event::Empty(start) => tag(&start)?,
                Event::End(_) => open.pop().unwrap_or_else(|| Self::new("")),
                Event::Eof => break,
                Event::Text(text) if text.trim().is_empty() => continue,
                Event::Text(_) | Event::CData(_) | Event::GeneralRef(_) => {
                    return Err(XmlError::Text {
                        text: event.to_string(),
                    });
                }
                _ => continue,
            };
            if let Some(parent) = open.last_mut() {
                parent.children.push(closed);
            }
        }
        if open.len() > 1 {
            let reason = format!("the text ends with {} element(s) open", open.len() - 1);
            return Err(malformed(&reader, reason));
        }
        let mut roots = open.pop().map(|document| document.children).unwrap_or_default();
        let count = roots.len();
        match roots.pop() {
            Some(root) if count == 1 => Ok(root),
            _ => Err(XmlError::Roots { count }),
        }
    }

    /// An element from its tag.
    fn start(tag: &BytesStart<'_>) -> Result<Self, String> {
        let mut element = Self::new(tag.name().as_ref());
        for attribute in tag.attributes() {
            let attribute = attribute.map_err(|e| e.to_string())?;
            let value = attribute
                .normalized_value(XmlVersion::Implicit1_0)
                .map_err(|e| e.to_string())?;
            element = element.attribute(attribute.key.as_ref(), value);
        }
        Ok(element)
    }

    /// Appends an attribute.
    #[must_use]
    pub fn attribute(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.attributes.push((name.into(), value.into()));
        self
    }

    /// Appends an attribute unless its value is empty.
    #[must_use]
    pub fn attribute_if_any(self, name: &str, value: &str) -> Self {
        if value.is_empty() {
            self
        } else {
            self.attribute(name, value)
        }
    }

    /// Appends a child.
    #[must_use]
    pub fn child(mut self, child: Self) -> Self {
        self.children.push(child);
        self
    }

    /// Appends children in order.
    #[must_use]
    pub fn children(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        self.children.extend(children);
        self
    }

    /// The element as a document of its own.
    pub fn to_document(&self) -> String {
        let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
        self.write(&mut text, "");
        text
    }

    fn write(&self, text: &mut String, indent: &str) {
        let deeper = format!("{indent}  ");
        let separator = if self.attributes.len() > ATTRIBUTES_ON_A_LINE {
            format!("\n{deeper}")
        } else {
            " ".to_owned()
        };
        text.extend([indent, "<", &self.name]);
        for (name, value) in &self.attributes {
            text.extend([&separator, name, "=\"", &*escape(value), "\""]);
        }
        if self.children.is_empty() {
            text.push_str("/>\n");
            return;
        }
        text.push_str(">\n");
        for child in &self.children {
            child.write(text, &deeper);
        }
        text.extend([indent, "</", &self.name, ">\n"]);
    }
}

/// A number in the shortest form that reads back to the same bits; integers without a point.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_escaped_and_order_is_kept() {
        let element = Element::new("a")
            .attribute("z", "1 < 2 & \"q\"")
            .attribute("b", "")
            .attribute_if_any("left_out", "")
            .child(Element::new("c"));
        assert_eq!(
            element.to_document(),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <a z=\"1 &lt; 2 &amp; &quot;q&quot;\" b=\"\">\n  <c/>\n</a>\n"
        );
    }

    #[test]
    fn what_is_written_is_read_again() {
        let element = Element::new("a")
            .attribute("z", "1 < 2 & \"q\" \u{e9}")
            .attribute("b", "")
            .child(Element::new("c").child(Element::new("d").attribute("e", "f")))
            .child(Element::new("c"));
        assert_eq!(Element::parse(&element.to_document()).unwrap(), element);
        assert_eq!(
            Element::parse("<a><!-- c --> <b/></a>").unwrap(),
            Element::new("a").child(Element::new("b"))
        );
    }

    #[test]
    fn what_is_no_tree_of_elements_says_why() {
        for (text, why) in [
            ("", "0 elements at the top"),
            ("<a/><b/>", "2 elements at the top"),
            ("<a>", "1 element(s) open"),
            ("<a></b>", "not well-formed"),
            ("<a b=c/>", "not well-formed at byte"),
            ("<a>text</a>", "text \"text\" between tags"),
            ("<a>&amp;</a>", "between tags"),
        ] {
            let error = Element::parse(text).unwrap_err().to_string();
            assert!(error.contains(why), "{text}: {error}");
        }
    }

    #[test]
    fn many_attributes_get_a_line_each() {
        let element = |count: usize| {
            let names = ["a", "b", "c", "d", "e", "f", "g"];
            let element = Element::new("x");
            names[..count]
                .iter()
                .fold(element, |element, name| element.attribute(*name, "1"))
        };
        let parent = Element::new("p").children([element(6), element(7)]);
        let lines: Vec<_> = parent.to_document().lines().map(str::to_owned).collect();
        assert_eq!(lines.len(), 1 + 1 + 1 + 8 + 1);
        assert_eq!(lines[3..5], ["  <x", "    a=\"1\""]);
        assert_eq!(lines[10..], ["    g=\"1\"/>", "</p>"]);
    }

    #[test]
    fn numbers_read_back() {
        for (value, text) in [
            (0.0, "0"),
            (-1.0, "-1"),
            (1e-5, "1e-5"),
            (0.1, "0.1"),
            (3.433e-6, "3.433e-6"),
            (21939.0, "21939"),
        ] {
            assert_eq!(number(value), text);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }
}
