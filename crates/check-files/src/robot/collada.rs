//! Reads Collada meshes: geometries, and the scene of nodes that places them. Coordinates are in the file's unit and
//! frame; the declared up axis has no effect.

use super::pose::{Pose, Vector, size};
use cplan_check::decimal::Decimal;
use cplan_check::interval::Interval;
use num_bigint::Sign;
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum depth of nested nodes.
const MAX_NODE_DEPTH: usize = 64;
/// Maximum number of nodes in the scene.
const MAX_NODES: usize = 1 << 16;
/// Maximum number of vertices that the scene shows.
const MAX_POINTS: usize = 1 << 22;

/// Elements that transform the coordinates of a node.
const TRANSFORM_ELEMENTS: [&str; 6] = ["matrix", "translate", "rotate", "scale", "lookat", "skew"];
/// Maximum number of transformations per node.
const MAX_TRANSFORM_ELEMENTS: usize = 16;

/// Negative binary logarithm of the difference below which numbers count as equal.
const EQUALITY_BITS: u32 = 40;

/// A linear map followed by a translation. It is stored as a pose, but usually is no rotation.
type Affine = Pose;

struct Scene<'a> {
    ids: BTreeMap<&'a str, Node<'a, 'a>>,
    nodes: usize,
    numbers: usize,
    points: Vec<Vector>,
}

/// Returns the vertices of all geometries that the scene shows, metres.
pub fn vertices(bytes: &[u8]) -> Result<Vec<Vector>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is not text")?;
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let text = text.trim_start_matches('\u{feff}');
    // Drop comments before the declaration.
    let before = text.find("<?xml").filter(|at| is_comment(&text[..*at]));
    let text = &text[before.unwrap_or(0)..];
    let document = Document::parse_with_options(text, options).map_err(|error| error.to_string())?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err("it is not Collada".into());
    }
    let metres = child(root, "asset").and_then(|a| child(a, "unit")).and_then(|unit| unit.attribute("meter"));
    let metres = Decimal::read(metres.unwrap_or("1").trim())?;
    if metres.sign() != Sign::Plus {
        return Err("its unit is not a positive length".into());
    }
    let ids = document.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect();
    let mut scene = Scene { ids, nodes: 0, numbers: 0, points: Vec::new() };
    let shown = child(root, "scene").and_then(|scene| child(scene, "instance_visual_scene"));
    let shown =
        shown.and_then(|instance| scene.target(instance)).or_else(|| children_named(root, "visual_scene").next());
    let to_file = scaled([(); 3].map(|()| Interval::from(&metres)));
    if let Some(shown) = shown {
        scene.show(shown, &to_file, 0)?;
    }
    // If the scene shows nothing, use all meshes in their own coordinates.
    if scene.points.is_empty() {
        let meshes = children_named(root, "geometry").filter_map(|geometry| child(geometry, "mesh"));
        meshes.collect::<Vec<_>>().into_iter().try_for_each(|mesh| scene.positions(mesh, &to_file))?;
    }
    if scene.points.is_empty() { Err("it has no mesh".into()) } else { Ok(scene.points) }
}

/// Returns true if a text consists of comments and white space only.
fn is_comment(text: &str) -> bool {
    match text.trim().strip_prefix("<!--") {
        Some(comment) => comment.split_once("-->").is_some_and(|(_, after)| is_comment(after)),
        None => text.trim().is_empty(),
    }
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.tag_name().name() == name)
}

fn children_named<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.descendants().filter(move |node| node.tag_name().name() == name)
}

impl<'a> Scene<'a> {
    /// Returns the element to which a node refers by its URL.
    fn target(&self, node: Node<'a, 'a>) -> Option<Node<'a, 'a>> {
        let id = node.attribute("url").or(node.attribute("source"))?.strip_prefix('#')?;
        self.ids.get(id).copied()
    }

    /// Adds the vertices of everything that a node shows. `to_file` converts the coordinates of the node's parent to
    /// those of the file.
    fn show(&mut self, node: Node<'a, 'a>, to_file: &Affine, depth: usize) -> Result<(), String> {
        self.nodes += 1;
        if depth > MAX_NODE_DEPTH || self.nodes > MAX_NODES {
            return Err("a node contains itself, or too many nodes".into());
        }
        for child in node.children().filter(Node::is_element) {
            let target =
                || self.target(child).ok_or_else(|| "a node refers to an element that is not in the file".to_owned());
            match child.tag_name().name() {
                "node" => self.show(child, &to_file.compose(&node_transform(child)?), depth + 1)?,
                "instance_node" => {
                    let target = target()?;
                    self.show(target, &to_file.compose(&node_transform(target)?), depth + 1)?;
                }
                "instance_geometry" => {
                    let target = target()?;
                    let mesh =
                        self::child(target, "mesh").ok_or("the checker reads only geometries that are a <mesh>")?;
                    self.positions(mesh, to_file)?;
                }
                "instance_controller" => return Err("the checker does not read meshes that controllers deform".into()),
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds the positions that a mesh's primitives use.
    fn positions(&mut self, mesh: Node<'a, 'a>, to_file: &Affine) -> Result<(), String> {
        let vertices = child(mesh, "vertices").ok_or("a mesh has no vertices")?;
        let source = of_semantic(vertices, "POSITION").and_then(|input| self.target(input));
        let source = source.ok_or("a mesh has no positions")?;
        let array = child(source, "float_array").ok_or("a mesh has no positions")?;
        let accessor = children_named(source, "accessor").next().ok_or("positions have no accessor")?;
        let whole = |name: &str, else_: usize| match accessor.attribute(name) {
            Some(text) => text.trim().parse().map_err(|_| format!("an accessor's {name} is not a number")),
            None => Ok(else_),
        };
        let (numbers, stride, count) = (numbers(array)?, whole("stride", 1)?, whole("count", 0)?);
        let names: Vec<_> = accessor.children().filter(Node::is_element).map(|param| param.attribute("name")).collect();
        let is_plain = whole("offset", 0)? == 0
            && self.target(accessor) == Some(array)
            && (names.is_empty() || names == [Some("X"), Some("Y"), Some("Z")]);
        self.numbers += numbers.len();
        if !is_plain || stride < 3 || count.checked_mul(stride) != Some(numbers.len()) || self.numbers > 3 * MAX_POINTS
        {
            return Err("the numbers of a mesh are not triples x, y, z, or are too many".into());
        }
        let mut shown = BTreeSet::new();
        for primitive in mesh.children().filter(Node::is_element) {
            match primitive.tag_name().name() {
                "source" | "vertices" | "extra" => continue,
                "triangles" | "polylist" | "trifans" | "tristrips" => {}
                "polygons" if children_named(primitive, "ph").next().is_none() => {}
                other => return Err(format!("the checker does not know <{other}> in a mesh")),
            }
            let offset = |input: Node| input.attribute("offset").and_then(|offset| offset.trim().parse::<usize>().ok());
            let own = of_semantic(primitive, "VERTEX").and_then(offset).ok_or("a primitive has no vertices")?;
            let each = primitive.children().filter_map(offset).max().unwrap_or(0).saturating_add(1);
            for list in primitive.children().filter(|list| list.tag_name().name() == "p") {
                let text = text_of(list);
                let indices = text.split_whitespace().map(|word| word.parse::<usize>().ok().filter(|at| *at < count));
                let indices = indices.collect::<Option<Vec<_>>>().unwrap_or_default();
                let are_whole = !indices.is_empty() && indices.len().is_multiple_of(each);
                if !are_whole && !text.trim().is_empty() {
                    return Err("a primitive refers to a vertex that the mesh does not have".into());
                }
                shown.extend(indices.into_iter().skip(own).step_by(each));
            }
        }
        let point = |at: usize| {
            let p = &numbers[stride * at..];
            to_file.point(&[p[0].clone(), p[1].clone(), p[2].clone()])
        };
        self.points.extend(shown.into_iter().map(point));
        Ok(())
    }
}

/// Returns the child `<input>` with a certain semantic.
fn of_semantic<'a>(node: Node<'a, 'a>, semantic: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|input| input.attribute("semantic") == Some(semantic))
}

/// Returns the text of a node without its comments.
fn text_of(node: Node) -> String {
    node.children().filter_map(|part| part.is_text().then(|| part.text())?).collect()
}

fn numbers(node: Node) -> Result<Vec<Interval>, String> {
    text_of(node).split_whitespace().map(|word| Decimal::read(word).map(|number| Interval::from(&number))).collect()
}

fn scaled(by: Vector) -> Affine {
    let mut map = Pose::identity();
    by.into_iter().enumerate().for_each(|(k, by)| map.rows[k][k] = by);
    map
}

/// Returns the map from a node's coordinates to those of its parent. The node's last transformation is applied first.
fn node_transform(node: Node) -> Result<Affine, String> {
    let mut all = Pose::identity();
    let is_one = |part: &Node| TRANSFORM_ELEMENTS.contains(&part.tag_name().name());
    if node.children().filter(is_one).count() > MAX_TRANSFORM_ELEMENTS {
        return Err("a node has too many transformations".into());
    }
    for part in node.children().filter(is_one) {
        let kind = part.tag_name().name();
        let values = numbers(part)?;
        let vector = || [0, 1, 2].map(|k| values[k].clone());
        // The last row must be 0 0 0 1, up to rounding.
        let is_last_row = |k: usize| {
            (&values[k] - &Interval::whole(i32::from(k == 15))).magnitude()
                < Interval::whole(1).in_halves(EQUALITY_BITS).lower
        };
        let map = match (kind, values.len()) {
            ("matrix", 16) if (12..16).all(is_last_row) => {
                let row = |i: usize| [0, 1, 2].map(|j| values[4 * i + j].clone());
                Pose { rows: [row(0), row(1), row(2)], at: [3, 7, 11].map(|k: usize| values[k].clone()) }
            }
            ("translate", 3) => Pose { at: vector(), ..Pose::identity() },
            ("scale", 3) => scaled(vector()),
            ("rotate", 4) if vector().iter().all(|c| c.is_whole(0)) => Pose::identity(),
            ("rotate", 4) => {
                let length = size(&vector());
                if length.lower.sign() != Sign::Plus {
                    return Err("a node's rotation has no axis".into());
                }
                let axis = vector().map(|c| c.divided(&length));
                Pose::turn(&axis, &(&values[3] * &Interval::pi().over(180)))
            }
            _ => return Err(format!("a node has a <{kind}> that the checker does not know")),
        };
        all = all.compose(&map);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHOWN: &str = "<scene><instance_visual_scene url=\"#v\"/></scene>";

    /// Makes a file in centimetres, with a triangle in a node without transformations.
    fn triangle(node: &str, scene: &str) -> String {
        format!(
            r##"<?xml version="1.0"?><COLLADA><asset><unit meter="0.01"/></asset><geometry id="g"><mesh>
            <source id="s"><float_array id="a" count="9">0 0 0 100 0 0 0 50 0</float_array><technique_common>
            <accessor source="#a" count="3" stride="3"><param name="X"/><param name="Y"/><param name="Z"/></accessor></technique_common></source>
            <vertices id="w"><input semantic="POSITION" source="#s"/></vertices>
            <triangles count="1"><input semantic="VERTEX" source="#w" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
            <visual_scene id="v"><node>{node}</node></visual_scene>{scene}</COLLADA>"##
        )
    }

    #[test]
    fn geometry_without_a_scene_keeps_its_own_frame() {
        let instance = "<instance_geometry url=\"#g\"/>";
        let found = |text: &str| format!("{:?}", vertices(text.as_bytes()).unwrap());
        let whole = triangle(instance, SHOWN);
        let unshown = triangle("", "").replace("visual_scene", "hidden_scene");
        for text in [&triangle("", SHOWN), &unshown, &format!("<!-- one -->\n <!-- two -->{whole}")] {
            assert_eq!(found(text), found(&whole), "{text}");
        }
        assert!(vertices(format!("text {whole}").as_bytes()).is_err());
    }
}
