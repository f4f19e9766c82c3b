//! Writes elements as XML, and records the place from which each part comes.

use crate::document::{Element, Node, Place};
use std::ops::Range;

/// A part of the written text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Span {
    /// Range of bytes in the written text.
    pub range: Range<usize>,
    /// True for a start tag, false for an attribute.
    pub is_tag: bool,
    /// The place from which the part comes.
    pub place: Place,
}

/// Returns an element and its content as XML, with the spans of its parts. The root's start tag declares `namespaces`.
pub(crate) fn write(root: &Element, namespaces: &[(String, String)]) -> (String, Vec<Span>) {
    let mut writer = Writer { text: "<?xml version=\"1.0\"?>\n".to_owned(), spans: Vec::new() };
    writer.element(root, 0, namespaces);
    writer.text.push('\n');
    (writer.text, writer.spans)
}

struct Writer {
    text: String,
    spans: Vec<Span>,
}

impl Writer {
    fn element(&mut self, element: &Element, depth: usize, namespaces: &[(String, String)]) {
        let begin = self.text.len();
        let tag = self.spans.len();
        self.spans.push(Span { range: begin..begin, is_tag: true, place: element.place.clone() });
        self.text.push('<');
        self.text += &element.name;
        for (prefix, uri) in namespaces {
            self.attribute(&format!("xmlns:{prefix}"), uri);
        }
        for attribute in &element.attributes {
            let from = self.attribute(&attribute.name, &attribute.value);
            let range = from..self.text.len();
            self.spans.push(Span { range, is_tag: false, place: attribute.place.clone() });
        }
        if element.children.is_empty() {
            self.text += "/>";
            self.spans[tag].range.end = self.text.len();
            return;
        }
        self.text.push('>');
        self.spans[tag].range.end = self.text.len();
        let has_text = element.children.iter().any(|child| child.element().is_none());
        for child in &element.children {
            if !has_text {
                self.new_line(depth + 1);
            }
            match child {
                Node::Element(child) => self.element(child, depth + 1, &[]),
                Node::Text(text, _) => self.write_escaped(text),
            }
        }
        if !has_text {
            self.new_line(depth);
        }
        self.text += "</";
        self.text += &element.name;
        self.text.push('>');
    }

    fn new_line(&mut self, depth: usize) {
        self.text.push('\n');
        self.text.extend(std::iter::repeat_n("  ", depth));
    }

    /// Writes an attribute. Returns the position of its beginning.
    fn attribute(&mut self, name: &str, value: &str) -> usize {
        self.text.push(' ');
        let from = self.text.len();
        self.text += name;
        self.text += "=\"";
        self.write_escaped(value);
        self.text.push('"');
        from
    }

    fn write_escaped(&mut self, text: &str) {
        for c in text.chars() {
            match c {
                '<' => self.text += "&lt;",
                '>' => self.text += "&gt;",
                '&' => self.text += "&amp;",
                '"' => self.text += "&quot;",
                '\n' | '\t' | '\r' => self.text.push(' '),
                c => self.text.push(c),
            }
        }
    }
}
