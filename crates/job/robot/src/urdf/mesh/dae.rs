//! Collada: geometries, and the scene of nodes that place them, in the unit of the file.
//!
//! As in RViz and MoveIt, the axis that the file declares as up does not matter: coordinates are those of the file.

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::HashMap;

/// Largest depth of nested nodes (`MAX_NODE_DEPTH`), and largest number of nodes in the scene.
const MAX_NODE_DEPTH: usize = 64;
const MAX_NODES: usize = 1 << 16;
/// Largest number of vertices in all instances of geometries together.
const MAX_POINTS: usize = 1 << 24;

/// Reads the vertices of all geometries of the scene, in metres.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<Point3<f64>>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "the file is not UTF-8 text".to_owned())?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(from_declaration(text), options)
        .map_err(|error| format!("the file is not well-formed XML: {error}"))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err(format!("the file is not Collada: its root element is <{}>", root.tag_name().name()));
    }
    let metres = child(root, "asset").and_then(|asset| child(asset, "unit")).and_then(|unit| unit.attribute("meter"));
    let metres: f64 = match metres {
        Some(text) => {
            let number = text.trim().parse().ok().filter(|x: &f64| *x > 0.0);
            number.ok_or_else(|| format!("the unit of the file, \"{text}\" metres, is not a positive number"))?
        }
        None => 1.0,
    };
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect();
    let mut scene = Scene { ids, points: Vec::new(), nodes: 0 };
    let shown = child(root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
    let shown = shown.and_then(|instance| scene.target(instance));
    let shown = shown.or_else(|| descendants_named(document.root_element(), "visual_scene").next());
    let pose = Matrix4::new_scaling(metres);
    if let Some(shown) = shown {
        scene.children(shown, &pose, 0)?;
    }
    // Some programs write geometries without a scene. Then the coordinates of the geometries are used as they are.
    if scene.points.is_empty() {
        descendants_named(root, "geometry").try_for_each(|geometry| scene.geometry(geometry, &pose))?;
    }
    if scene.points.is_empty() {
        return Err("the file has no mesh".into());
    }
    Ok(scene.points)
}

/// Returns the text from its XML declaration on, if only comments precede it. XML forbids these comments, but some programs write
/// them.
fn from_declaration(text: &str) -> &str {
    let text = text.trim_start_matches('\u{feff}');
    let mut rest = text.trim_start();
    while let Some((_, after)) = rest.strip_prefix("<!--").and_then(|comment| comment.split_once("-->")) {
        rest = after.trim_start();
    }
    if rest.starts_with("<?xml") { rest } else { text }
}

/// Returns the first child with a name.
fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.tag_name().name() == name)
}

/// Iterates over all descendants with a name.
fn descendants_named<'a, 'i>(node: Node<'a, 'i>, name: &'a str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.descendants().filter(move |node| node.tag_name().name() == name)
}

struct Scene<'a, 'i> {
    ids: HashMap<&'a str, Node<'a, 'i>>,
    points: Vec<Point3<f64>>,
    nodes: usize,
}

impl<'a, 'i> Scene<'a, 'i> {
    /// Returns the element to which the attribute `url` or `source` of an element refers.
    fn target(&self, node: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
        let id = node.attribute("url").or(node.attribute("source"))?.strip_prefix('#')?;
        self.ids.get(id).copied()
    }

    /// Reads the nodes and geometries in a node. `pose` maps the node's coordinates to those of the file.
    fn children(&mut self, node: Node<'a, 'i>, pose: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        self.nodes += 1;
        if depth > MAX_NODE_DEPTH || self.nodes > MAX_NODES {
            return Err("a node contains itself, or too many nodes".into());
        }
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "node" => self.children(child, &(pose * transform(child)?), depth + 1)?,
                "instance_node" => {
                    let target = self.target(child).ok_or("a node refers to a node that does not exist")?;
                    self.children(target, &(pose * transform(target)?), depth + 1)?;
                }
                "instance_geometry" => {
                    let geometry = self.target(child).ok_or("a node refers to a geometry that does not exist")?;
                    self.geometry(geometry, pose)?;
                }
                "instance_controller" => {
                    return Err("the file has controllers, which deform meshes; cplan does not read them".into());
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Reads the positions of a geometry's mesh.
    fn geometry(&mut self, geometry: Node<'a, 'i>, pose: &Matrix4<f64>) -> Result<(), String> {
        for vertices in descendants_named(geometry, "vertices") {
            let mut inputs = vertices.children().filter(|input| input.attribute("semantic") == Some("POSITION"));
            let source = inputs.next().and_then(|input| self.target(input)).ok_or("a mesh has no positions")?;
            let array = child(source, "float_array").ok_or("a mesh has no positions")?;
            let numbers = numbers(array)?;
            let accessor = descendants_named(source, "accessor").next();
            let stride = accessor.and_then(|accessor| accessor.attribute("stride")?.trim().parse().ok()).unwrap_or(3);
            if stride < 3 || numbers.len() % stride != 0 {
                return Err(format!(
                    "a mesh has {} numbers for positions, which is not a multiple of three",
                    numbers.len()
                ));
            }
            if self.points.len() + numbers.len() / stride > MAX_POINTS {
                return Err("the scene contains too many meshes".into());
            }
            self.points.extend(numbers.chunks(stride).map(|p| pose.transform_point(&Point3::new(p[0], p[1], p[2]))));
        }
        Ok(())
    }
}

/// Returns the numbers in an element's text.
fn numbers(node: Node) -> Result<Vec<f64>, String> {
    let words = node.text().unwrap_or_default().split_whitespace();
    words.map(|word| word.parse().map_err(|_| format!("\"{word}\" is not a number"))).collect()
}

/// Returns the map from a node's coordinates to those of its parent: the product of the node's transformations. The last one is
/// applied first.
fn transform(node: Node) -> Result<Matrix4<f64>, String> {
    let mut all = Matrix4::identity();
    for part in node.children() {
        let kind = part.tag_name().name();
        if !["matrix", "translate", "rotate", "scale", "lookat", "skew"].contains(&kind) {
            continue;
        }
        all *= match (kind, &numbers(part)?[..]) {
            ("matrix", values) if values.len() == 16 => Matrix4::from_row_slice(values),
            ("translate", &[x, y, z]) => Matrix4::new_translation(&Vector3::new(x, y, z)),
            ("rotate", &[x, y, z, degrees]) => {
                let axis = Unit::try_new(Vector3::new(x, y, z), 0.0);
                axis.map_or_else(Matrix4::identity, |axis| {
                    Rotation3::from_axis_angle(&axis, degrees.to_radians()).to_homogeneous()
                })
            }
            ("scale", &[x, y, z]) => Matrix4::new_nonuniform_scaling(&Vector3::new(x, y, z)),
            _ => return Err(format!("a node has a <{kind}> that cplan does not read")),
        };
    }
    Ok(all)
}
