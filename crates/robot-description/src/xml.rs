//! Elements of XML.

use std::io;

use quick_xml::{
    Writer,
    events::{BytesEnd, BytesStart, BytesText, Event},
};

/// An element with its attributes and what stands inside.
#[derive(Clone)]
pub(crate) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Vec<Content>,
}

#[derive(Clone)]
enum Content {
    Element(Element),
    Comment(&'static str),
}

impl Element {
    /// An empty element.
    pub(crate) fn new(name: &'static str) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            content: Vec::new(),
        }
    }

    /// Adds an attribute.
    pub(crate) fn text(mut self, key: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((key, value.into()));
        self
    }

    /// Adds an attribute of numbers, separated by blanks.
    pub(crate) fn numbers(self, key: &'static str, values: &[f64]) -> Self {
        let words: Vec<_> = values.iter().map(|value| number(*value)).collect();
        self.text(key, words.join(" "))
    }

    /// Adds an element inside.
    pub(crate) fn child(mut self, child: Self) -> Self {
        self.content.push(Content::Element(child));
        self
    }

    /// Adds elements inside.
    pub(crate) fn children(self, children: impl IntoIterator<Item = Self>) -> Self {
        children.into_iter().fold(self, Self::child)
    }

    /// Adds a comment inside.
    pub(crate) fn comment(mut self, text: &'static str) -> Self {
        self.content.push(Content::Comment(text));
        self
    }

    /// The document of which this is the root.
    pub(crate) fn document(&self) -> String {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        self.write(&mut writer).expect("memory takes all bytes");
        let mut bytes = writer.into_inner();
        bytes.push(b'\n');
        String::from_utf8(bytes).expect("it was made of text")
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
        let attributes = self.attributes.iter();
        let start = BytesStart::new(self.name)
            .with_attributes(attributes.map(|(key, value)| (*key, value.as_str())));
        if self.content.is_empty() {
            return writer.write_event(Event::Empty(start));
        }
        writer.write_event(Event::Start(start))?;
        for content in &self.content {
            match content {
                Content::Element(element) => element.write(writer)?,
                Content::Comment(text) => {
                    writer.write_event(Event::Comment(BytesText::from_escaped(*text)))?;
                }
            }
        }
        writer.write_event(Event::End(BytesEnd::new(self.name)))
    }
}

/// A number with up to 12 digits after the point: sums of lengths show no trace of binary fractions.
fn number(value: f64) -> String {
    let rounded = (value * 1e12).round() / 1e12;
    // Without the sign of a zero.
    format!("{}", rounded + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_is_indented_and_escaped() {
        let root = Element::new("a")
            .text("name", "Q&A")
            .comment(" why ")
            .child(Element::new("b").numbers("pos", &[0.1 + 0.2, -0.0, 1e-9]));
        let expected =
            "<a name=\"Q&amp;A\">\n  <!-- why -->\n  <b pos=\"0.3 0 0.000000001\"/>\n</a>\n";
        assert_eq!(root.document(), expected);
    }
}
