//! Recognises files that are not plain URDF: xacro, SDF, other XML, and damaged XML.

use super::document::tag;
use crate::error::Diagnostic;
use crate::source::{Position, Source};
use roxmltree::{Document, Error, Node};

/// Namespace of xacro.
const XACRO_NAMESPACE: &str = "ros.org/wiki/xacro";

/// Adds the hint that xacro must be expanded first.
fn xacro(diagnostic: Diagnostic) -> Diagnostic {
    diagnostic.help(
        "save this text as a .xacro file, which cplan expands: `cplan robot.urdf.xacro world.toml`; `cplan inspect robot.urdf.xacro --expanded robot.urdf` writes the plain URDF",
    )
}

/// Refuses documents that define entities, because entities can expand without end. Other document types are harmless
/// and ignored.
pub(super) fn without_entities(source: &Source) -> Result<(), Diagnostic> {
    const ENTITY_DECLARATION: &str = "<!ENTITY";
    match source.text().find(ENTITY_DECLARATION).filter(|at| source.text()[..*at].contains("<!DOCTYPE")) {
        None => Ok(()),
        Some(at) => {
            let diagnostic = source.diagnostic_at(
                at..at + ENTITY_DECLARATION.len(),
                "the document type defines entities, which cplan does not read",
            );
            Err(diagnostic.help("write the entities' values directly, and remove the <!DOCTYPE ...>"))
        }
    }
}

/// Returns the diagnostic of broken XML.
pub(super) fn malformed(source: &Source, error: &Error) -> Diagnostic {
    let at = error.pos();
    if matches!(error, Error::UnknownNamespace(prefix, _) if prefix == "xacro") {
        let diagnostic = source.diagnostic(format!("line {}: this text is xacro, not a plain URDF", at.row));
        return xacro(diagnostic);
    }
    let (line, column) = (at.row as usize, at.col as usize);
    let line_start: usize = source.text().split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let in_line: usize = source.text()[line_start..].chars().take(column.saturating_sub(1)).map(char::len_utf8).sum();
    let offset = line_start + in_line;
    let mut message = error.to_string();
    // The parser's message repeats the position, which is already shown before it.
    if let Some(cut) = message.rfind(&format!(" at {}:{}", at.row, at.col)) {
        message.truncate(cut);
    }
    let diagnostic = source.diagnostic_at(offset..offset + 1, format!("this is not well-formed XML: {message}"));
    Diagnostic { position: Some(Position { line, column }), ..diagnostic }
        .help("the URDF comes first, then the world file; an XML editor shows where a tag is not closed")
}

/// Refuses documents that are not URDF. Accepts URDF that only declares the namespace of xacro.
pub(super) fn recognize(source: &Source, root: Node) -> Result<(), Diagnostic> {
    let at = |node: Node, message: &str| source.diagnostic_at(tag(node), message);
    match root.tag_name().name() {
        "robot" => {}
        "sdf" | "world" | "model" => {
            return Err(at(root, "this is an SDF file (Gazebo), not a URDF").help(
                "use the URDF from which the SDF was made, if there is one, or convert this file, e.g. with `sdf2urdf`",
            ));
        }
        "mujoco" => return Err(at(root, "this is a MuJoCo model, not a URDF").help("use the robot's URDF")),
        other => {
            let message = format!("this is not a URDF: the root element is <{other}>, not <robot>");
            return Err(at(root, &message).help("give the URDF first and the world file second"));
        }
    }
    match xacro_trace(root.document()).filter(|_| !source.is_converted()) {
        Some(node) => Err(xacro(at(node, "this text is xacro, not a plain URDF"))),
        None => Ok(()),
    }
}

/// Returns the first element that only xacro understands. `None` if there is none, as in a file that only declares the namespace
/// of xacro.
fn xacro_trace<'a, 'i>(document: &'a Document<'i>) -> Option<Node<'a, 'i>> {
    document.descendants().filter(Node::is_element).find(|node| {
        let tag = document.input_text()[node.range()].trim_start_matches('<');
        let has_prefix = tag.find([':', '>', '/']).is_some_and(|end| tag[end..].starts_with(':'))
            && !tag[..tag.find(':').unwrap_or(0)].contains(char::is_whitespace);
        let namespace = node.tag_name().namespace().filter(|_| has_prefix);
        namespace.is_some_and(|name| name.contains(XACRO_NAMESPACE) || name.ends_with("/xacro"))
            || node.attributes().any(|a| a.value().contains("${") || a.value().contains("$("))
    })
}
