//! A tree of XML elements and its one rendering: two spaces of indent, LF, attributes in the order given, final newline.

use quick_xml::escape::escape;

/// An element with more attributes than this gets a line for each, so that a diff shows which one changed.
const ATTRIBUTES_ON_A_LINE: usize = 6;

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
    pub(crate) fn to_document(&self) -> String {
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
pub(crate) fn number(value: f64) -> String {
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
