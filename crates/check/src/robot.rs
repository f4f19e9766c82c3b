//! The URDF: two joints that move, and shapes in the plane.

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::files::Files;
use crate::interval::{Interval, Point};
use crate::overlap::Shape;
use crate::sweep::{Axis, Range};
use crate::world::World;
use num_bigint::Sign;
use plane::Plane;
use pose::{Pose, Vector, dot};
use roxmltree::{Document, Node};
use solid::{Outline, Solid};
use std::collections::BTreeMap;
use tree::{Read, Tree, child};

mod collada;
mod cover;
mod mesh;
mod plane;
mod pose;
mod solid;
mod tree;

pub use cover::Covered;

/// Directions within `10^-12` of one another are not told apart in words.
const ROUNDED: u32 = 12;

/// How a joint moves what it carries, in the plane.
#[derive(Debug, Clone)]
pub enum Motion {
    /// By its value, left (1) or right (-1).
    Turn(i32),
    /// Along a direction of unit length.
    Slide(Point),
}

/// One of the two joints.
pub struct Joint {
    pub name: String,
    pub motion: Motion,
    /// What holds all its values, ...
    pub axis: Axis,
    /// ... and what they are known to be within, if they have limits.
    pub within: Option<Range>,
}

/// An arm in the plane. Where its parts are is said for both joints at 0.
pub struct Arm<'a> {
    pub joints: [Joint; 2],
    /// Origins of the two joints, the second as seen from the first.
    pub base: Point,
    pub offset: Point,
    tree: Tree<'a>,
    /// Links that the joints move, one by one.
    children: [&'a str; 2],
    plane: Plane,
    /// The link whose origin is the tip, and the radius of bars, if the world has them.
    tip: Option<String>,
    bar: Option<Decimal>,
}

/// A collision shape in the plane, as seen from the origin of its joint.
#[derive(Clone)]
pub struct Body {
    /// 0 or 1: the last joint that moves it.
    pub link: usize,
    pub shape: Shape,
    /// Its extent along the normal; none: everywhere.
    pub heights: Option<[Interval; 2]>,
}

impl<'a> Arm<'a> {
    /// Reads the URDF and finds the two joints.
    ///
    /// # Errors
    /// What is no robot, or one that the checker does not know.
    pub fn read(
        document: &'a Document<'a>,
        world: &World,
        files: &'a Files,
        implied: Option<&[String; 2]>,
    ) -> Read<Self> {
        let mut tree = Tree {
            files,
            document,
            root: Pose::identity(),
            links: BTreeMap::new(),
            order: Vec::new(),
            joints: BTreeMap::new(),
            named: BTreeMap::new(),
            values: BTreeMap::new(),
        };
        let root = document.root_element();
        if !root.has_tag_name("robot") {
            return tree.error(root, "this is not a URDF: it has no <robot>");
        }
        let mut movable = Vec::new();
        for node in root.children().filter(|n| n.has_tag_name("link")) {
            if tree.links.insert(tree.text(node, "name")?, node).is_some() {
                return tree.error(node, "a second link of this name");
            }
            tree.order.push(tree.text(node, "name")?);
        }
        for node in root.children().filter(|n| n.has_tag_name("joint")) {
            let name = tree.text(node, "name")?;
            let Some(carried) = child(node, "child") else { return tree.error(node, "the joint has no child") };
            let is_second = tree.named.insert(name, node).is_some();
            if is_second || tree.joints.insert(tree.text(carried, "link")?, node).is_some() {
                return tree.error(node, "a second joint of this name or with this child");
            }
            let moves = matches!(tree.text(node, "type")?, "revolute" | "continuous" | "prismatic");
            movable.extend((moves && child(node, "mimic").is_none()).then_some(name));
        }
        let said: Option<Vec<&str>> = world.joints.as_ref().map(|names| names.iter().map(String::as_str).collect());
        let implied: Option<Vec<&str>> = implied.map(|names| names.iter().map(String::as_str).collect());
        if said.is_some() && implied.is_some() && said != implied {
            return CheckError::fails("it is about other joints than the world");
        }
        let chosen = said.or(implied).unwrap_or_else(|| movable.clone());
        let [first, second] = chosen[..] else {
            let message = format!("{} joints can move: the world file has to name two, [robot] joints", chosen.len());
            return Err(CheckError::in_file(Input::Urdf, message));
        };
        let node = |name: &str| match tree.named.get(name) {
            Some(node) if movable.contains(&name) => Ok(*node),
            _ => Err(CheckError::in_file(Input::Urdf, format!("there is no joint \"{name}\" that can move"))),
        };
        let carried =
            |joint: Node<'a, 'a>| child(joint, "child").and_then(|c| c.attribute("link")).expect("has been read");
        let mut joints = [node(first)?, node(second)?];
        if tree.above(carried(joints[0]))?[1..].contains(&joints[1]) {
            joints.swap(0, 1);
        }
        if !tree.above(carried(joints[1]))?[1..].contains(&joints[0]) {
            return tree.error(joints[1], "neither of the two joints carries the other");
        }
        for name in movable {
            let joint = tree.named[name];
            let value = match world.fixed.get(name) {
                _ if joints.contains(&joint) => continue,
                Some(value) => Interval::around(value),
                None => tree.rest(joint, world)?,
            };
            tree.values.insert(name, value);
        }
        Self::of(tree, joints, joints.map(carried), world)
    }

    fn of(mut tree: Tree<'a>, nodes: [Node<'a, 'a>; 2], children: [&'a str; 2], world: &World) -> Read<Self> {
        let seen = |tree: &Tree<'a>| -> Read<[(Pose, Vector); 2]> {
            let of = |k: usize| {
                let pose = tree.pose(children[k])?;
                let axis = pose.direction(&tree.axis(nodes[k])?);
                Ok((pose, axis))
            };
            Ok([of(0)?, of(1)?])
        };
        let axes = seen(&tree)?.map(|(_, axis)| axis);
        let slides = nodes.map(|node| node.attribute("type") == Some("prismatic"));
        let Some(plane) = Plane::common(&axes, slides) else {
            return tree.error(nodes[1], "the two joints do not move in one common plane");
        };
        tree.root = plane.placed(&world.at, &world.angle);
        let [(first, first_axis), (second, second_axis)] = seen(&tree)?;
        let (poses, axes) = ([first, second], [first_axis, second_axis]);
        let joint = |k: usize| {
            let sign = if dot(&axes[k], &plane.left()).lower.sign() == Sign::Plus { 1 } else { -1 };
            let motion = if slides[k] { Motion::Slide(plane.direction(&axes[k])) } else { Motion::Turn(sign) };
            let (axis, within) = match tree.ends(nodes[k], world)? {
                Some([outer, inner]) => (Axis::Line(outer), Some(inner)),
                None => (Axis::Circle, None),
            };
            Ok(Joint { name: tree.text(nodes[k], "name")?.to_owned(), motion, axis, within })
        };
        let joints = [joint(0)?, joint(1)?];
        let [base, second] = poses.each_ref().map(|pose| plane.flat(&pose.at));
        let offset = [0, 1].map(|k| &second[k] - &base[k]);
        let (tip, bar) = (world.tip.clone(), world.bar.clone());
        Ok(Self { joints, base, offset, tree, children, plane, tip, bar })
    }

    /// By how much the joints' axes are off the plane's normal that are taken to be along it, in words, if it is more than rounding.
    pub fn idealized(&self) -> String {
        let is_within = |digits: &u32| Interval::from(&Decimal::power_of_ten(*digits)).lower >= self.plane.off;
        match (2..=ROUNDED).rev().find(is_within).unwrap_or(0) {
            ROUNDED => String::new(),
            digits => {
                format!("; its joints are taken to move in one plane, from which they deviate by up to 1e-{digits}")
            }
        }
    }

    /// A shape of a kind, `collision` or `visual`, by its link and its number among those of the link that have a size. Visual ones
    /// count where nothing else that moves with the link has collision shapes.
    ///
    /// # Errors
    /// When there is none, or it is of a kind that the checker does not know.
    pub fn body(&self, link: &str, kind: &str, number: usize) -> Read<Body> {
        let Some(&name) = self.tree.order.iter().find(|name| **name == link) else {
            return CheckError::fails(format!("the robot has no link \"{link}\""));
        };
        let Some(last) = self.moved_by(name)? else {
            return CheckError::fails(format!("no joint moves link \"{link}\""));
        };
        if kind == "visual" {
            self.requires_none(last, "collision")?;
        }
        let solids = self.solids(name, kind)?;
        let Some((node, solid)) = solids.get(number) else {
            return CheckError::fails(format!("link \"{link}\" has no {kind} shape number {number}"));
        };
        Ok(self.project(last, &self.tree.pose(name)?.after(&self.tree.origin(*node)?), solid, Outline::Within))
    }

    /// The bar that the world has in place of a link without geometry: all within its radius of the segment from the link's joint to
    /// the next, or to the tip.
    ///
    /// # Errors
    /// When there is none.
    pub fn bar(&self, link: &str) -> Read<Body> {
        let (Some(radius), Some(last)) = (&self.bar, self.children.iter().position(|child| *child == link)) else {
            return CheckError::fails(format!("link \"{link}\" has no bar"));
        };
        if radius.sign() != Sign::Plus {
            return Err(CheckError::in_file(Input::World, "the radius of a bar is positive"));
        }
        self.requires_none(last, "collision")?;
        self.requires_none(last, "visual")?;
        let (next, end) = match last {
            0 => (self.children[1], self.offset.clone()),
            _ => self.tip().map(|(tip, Body { shape, .. })| (tip, shape.points[0].clone()))?,
        };
        let radius = Interval::from(radius);
        let heights = [self.tree.pose(self.children[last])?, self.tree.pose(next)?].map(|p| self.plane.height(&p.at));
        let [a, b] = heights;
        let least = Interval { lower: (&a.lower).min(&b.lower).clone(), upper: (&a.upper).min(&b.upper).clone() };
        let most = Interval { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper) };
        let heights = [&least - &radius, &most + &radius];
        let shape = Shape { points: vec![[Interval::whole(0), Interval::whole(0)], end], radius };
        Ok(Body { link: last, shape, heights: Some(heights) })
    }

    /// That nothing that moves with a joint and not with the next has a shape of a kind.
    fn requires_none(&self, last: usize, kind: &str) -> Read<()> {
        for link in &self.tree.order {
            if self.moved_by(link)? == Some(last) && !self.solids(link, kind)?.is_empty() {
                return CheckError::fails(format!("link \"{link}\" has {kind} shapes, which are what counts"));
            }
        }
        Ok(())
    }

    /// The last of the two joints that moves a link.
    fn moved_by(&self, link: &'a str) -> Read<Option<usize>> {
        let above = self.tree.above(link)?;
        let moves = |k: &usize| above.iter().any(|joint| self.tree.joints.get(self.children[*k]) == Some(joint));
        Ok([1, 0].into_iter().find(moves))
    }

    /// The shapes of a kind that a link has, but for those without a size.
    fn solids(&self, link: &'a str, kind: &str) -> Read<Vec<(Node<'a, 'a>, Solid)>> {
        let mut solids = Vec::new();
        for node in self.tree.links[link].children().filter(|n| n.has_tag_name(kind)) {
            let geometry = child(node, "geometry").and_then(|g| g.first_element_child());
            let Some(geometry) = geometry else { return self.tree.error(node, "it has no geometry") };
            solids.extend(self.tree.solid(geometry)?.map(|solid| (node, solid)));
        }
        Ok(solids)
    }

    /// The tip, and its link: a point, the origin of the link that the world names, else of the deepest that the second joint moves.
    ///
    /// # Errors
    /// When the link is not moved by the second joint.
    pub fn tip(&self) -> Read<(&'a str, Body)> {
        let mut deepest = None;
        for link in self.tree.order.iter().filter(|link| self.tip.as_deref().is_none_or(|named| named == **link)) {
            let depth = self.tree.above(link)?.len();
            if self.moved_by(link)? == Some(1) && deepest.is_none_or(|(deep, _)| deep < depth) {
                deepest = Some((depth, *link));
            }
        }
        let Some((_, link)) = deepest else {
            return Err(CheckError::in_file(Input::World, "the second joint moves no link that can be the tip"));
        };
        let zero = Interval::whole(0);
        let point = Solid::Capsule { radius: zero.clone(), half: zero };
        Ok((link, self.project(1, &self.tree.pose(link)?, &point, Outline::Within)))
    }
}
