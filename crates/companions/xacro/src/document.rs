//! XML files as trees. Each element has its place in the file.

use crate::error::Error;
use crate::limits::MAX_DEPTH;
use roxmltree::{Document, Node as XmlNode, ParsingOptions};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// Largest number of elements and texts in one file. Descriptions of robots have far fewer.
const MAX_NODES: u32 = 1_000_000;

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Path of the file.
    pub path: PathBuf,
    /// Text of the file.
    pub text: Arc<str>,
}

impl File {
    /// Returns the line of a byte, counted from 1.
    pub fn line(&self, offset: usize) -> usize {
        1 + self.text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
    }
}

/// A part of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Index of the file, in the order of reading.
    pub file: usize,
    /// Range of bytes in the file's text.
    pub range: Range<usize>,
}

/// A part of an element's content.
#[derive(Debug, Clone)]
pub(crate) enum Node {
    Element(Rc<Element>),
    Text(Rc<str>, Place),
}

impl Node {
    pub fn element(&self) -> Option<&Rc<Element>> {
        match self {
            Self::Element(element) => Some(element),
            Self::Text(..) => None,
        }
    }
}

/// An element. Its name includes the prefix that it has in the file.
#[derive(Debug)]
pub(crate) struct Element {
    pub name: String,
    pub attributes: Vec<Attribute>,
    pub children: Vec<Node>,
    /// The start tag.
    pub place: Place,
}

#[derive(Debug, Clone)]
pub(crate) struct Attribute {
    pub name: String,
    pub value: String,
    pub place: Place,
}

impl Element {
    /// Returns the attribute with a name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// Returns the name after `xacro:`.
    pub fn directive(&self) -> Option<&str> {
        self.name.strip_prefix("xacro:")
    }
}

/// The root element of a file, and the namespaces that the file declares, except xacro's own.
#[derive(Debug)]
pub(crate) struct Tree {
    pub root: Rc<Element>,
    pub namespaces: Vec<(String, String)>,
}

fn is_xacro_namespace(uri: &str) -> bool {
    uri.contains("ros.org/wiki/xacro") || uri.contains("ros.org/xacro") || uri.ends_with("/xacro")
}

pub(crate) fn uses_xacro(text: &str) -> bool {
    // Parse the text only if it may use xacro.
    if !text.contains("xacro") && !text.contains("${") && !text.contains("$(") {
        return false;
    }
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    match Document::parse_with_options(text, options) {
        Err(error) => matches!(error, roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro"),
        Ok(document) => document.descendants().filter(XmlNode::is_element).any(|node| {
            is_directive(text, &node) || node.attributes().any(|a| a.value().contains("${") || a.value().contains("$("))
        }),
    }
}

/// Returns the name of an element as written, with its prefix.
fn written_name<'t>(text: &'t str, node: &XmlNode) -> &'t str {
    let tag = text[node.range()].strip_prefix('<').unwrap_or_default();
    let end = tag.find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(tag.len());
    &tag[..end]
}

/// Returns true if an element is in xacro's namespace, with any prefix.
fn is_directive(text: &str, node: &XmlNode) -> bool {
    let name = written_name(text, node);
    name.starts_with("xacro:") || name.contains(':') && node.tag_name().namespace().is_some_and(is_xacro_namespace)
}

fn start_tag(text: &str, node: &XmlNode) -> Range<usize> {
    let range = node.range();
    let behind = node.attributes().map(|a| a.range().end).max().unwrap_or(range.start);
    let end = text[behind..range.end].find('>').map_or(range.end, |at| behind + at + 1);
    range.start..end
}

pub(crate) fn read(file: &File, index: usize) -> Result<Tree, Error> {
    let text = &*file.text;
    let wrong = |range: Range<usize>, message: String, hint: &str| Error {
        path: file.path.clone(),
        place: Some(Box::new((file.clone(), Place { file: index, range }))),
        message,
        hint: Some(hint.to_owned()),
    };
    if let Some(at) = text.find("<!ENTITY").filter(|at| text[..*at].contains("<!DOCTYPE")) {
        let message = "the document type defines entities, which cplan does not read".to_owned();
        return Err(wrong(
            at..at + 8,
            message,
            "write their values where they are used, and remove the <!DOCTYPE ...>",
        ));
    }
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        let at = offset(text, error.pos());
        match error {
            roxmltree::Error::UnknownNamespace(prefix, _) => wrong(
                at..at + 1,
                format!("the prefix \"{prefix}\" is not declared"),
                "declare it in the root element: xmlns:xacro=\"http://www.ros.org/wiki/xacro\"",
            ),
            error => {
                let mut message = error.to_string();
                if let Some(cut) = message.rfind(" at ") {
                    message.truncate(cut);
                }
                let message = format!("this is not well-formed XML: {message}");
                wrong(at..at + 1, message, "an XML editor shows where a tag is not closed")
            }
        }
    })?;
    let mut namespaces: Vec<(String, String)> = Vec::new();
    for node in document.descendants().filter(XmlNode::is_element) {
        let declared = node.namespaces().filter_map(|namespace| Some((namespace.name()?, namespace.uri())));
        for (prefix, uri) in
            declared.filter(|(prefix, uri)| *prefix != "xml" && *prefix != "xacro" && !is_xacro_namespace(uri))
        {
            if !namespaces.iter().any(|(known, _)| known == prefix) {
                namespaces.push((prefix.to_owned(), uri.to_owned()));
            }
        }
    }
    // Refuse elements that are nested too deeply before walking them.
    if let Some(node) = document.descendants().find(|node| node.ancestors().take(MAX_DEPTH + 2).count() > MAX_DEPTH + 1)
    {
        let message = format!("elements are nested more than {MAX_DEPTH} deep");
        return Err(wrong(node.range(), message, "reduce the nesting"));
    }
    Ok(Tree { root: element(text, document.root_element(), index), namespaces })
}

fn element(text: &str, node: XmlNode, file: usize) -> Rc<Element> {
    let place = |range: Range<usize>| Place { file, range };
    let name = match is_directive(text, &node) {
        true => format!("xacro:{}", node.tag_name().name()),
        false => written_name(text, &node).to_owned(),
    };
    let attributes = node.attributes().map(|attribute| {
        let range = attribute.range();
        let name = text[range.clone()].split('=').next().unwrap_or_default().trim().to_owned();
        Attribute { name, value: attribute.value().to_owned(), place: place(range) }
    });
    let children = node.children().filter_map(|child| match () {
        () if child.is_element() => Some(Node::Element(element(text, child, file))),
        () if child.is_text() => Some(Node::Text(child.text().unwrap_or_default().into(), place(child.range()))),
        () => None,
    });
    Rc::new(Element {
        name,
        attributes: attributes.collect(),
        children: children.collect(),
        place: place(start_tag(text, &node)),
    })
}

/// Returns the byte offset of a line and a column, both counted from 1.
fn offset(text: &str, at: roxmltree::TextPos) -> usize {
    let line: usize = text.split_inclusive('\n').take((at.row as usize).saturating_sub(1)).map(str::len).sum();
    let inside = text[line.min(text.len())..].chars().take((at.col as usize).saturating_sub(1));
    line + inside.map(char::len_utf8).sum::<usize>()
}

/// Reads a text file, without a byte order mark.
pub(crate) fn text(path: &Path, read: fn(&Path) -> std::io::Result<Vec<u8>>) -> Result<String, String> {
    let bytes = read(path).map_err(|error| format!("cannot be read: {error}"))?;
    let text = String::from_utf8(bytes).map_err(|_| "is not UTF-8 text".to_owned())?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}
