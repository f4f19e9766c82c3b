//! The URDF: two joints that move, and shapes in the plane.

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::interval::{BITS, Interval, Point, length};
use crate::overlap::Shape;
use crate::polygon::Corner;
use crate::sweep::{Axis, Range};
use crate::world::World;
use num_bigint::Sign;
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

mod cover;

pub use cover::Covered;

/// Ranges of a joint that turns longer than this mean that it has none.
const LONGEST_TURN: i32 = 1000;

/// Steps along half of the ellipse that a cylinder's end is in the plane.
const ELLIPSE_STEPS: i32 = 16;

/// From this share of its radius on, an oblique cylinder's end is taken as a disc.
const OBLIQUE: u32 = 200;

/// A cylinder whose axis is out of the plane by less than this power of a half counts as lying.
const LYING: u64 = 44;

/// Joints of the longest chain.
const MOST_JOINTS: usize = 1000;

type Read<T> = Result<T, CheckError>;
type Vector = [Interval; 3];

/// A rotation, by its rows, and a translation.
#[derive(Clone)]
struct Pose {
    rows: [Vector; 3],
    at: Vector,
}

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
    pub axis: Axis,
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
pub struct Body {
    /// 0 or 1: the last joint that moves it.
    pub link: usize,
    pub shape: Shape,
    /// Its extent along the normal.
    heights: [Interval; 2],
}

/// Which coordinates of the root frame are those of the plane, and which is the height.
#[derive(Clone, Copy)]
struct Plane {
    across: [usize; 2],
    normal: usize,
}

impl Plane {
    /// The pose of a root frame that is turned in the plane by an angle and stands at a place there.
    fn placed(self, at: &Corner, angle: &Interval) -> Pose {
        // Of the three, the basis (x, z) with y is left-handed.
        let along = if self.normal == 1 { -1 } else { 1 };
        let axis = [0, 1, 2].map(|k| Interval::whole(if k == self.normal { along } else { 0 }));
        let mut pose = Pose::turn(&axis, angle);
        for (k, place) in self.across.into_iter().zip(at) {
            pose.at[k] = Interval::from(place);
        }
        pose
    }
}

/// Links and joints by name, and where the joints stand.
struct Tree<'a> {
    document: &'a Document<'a>,
    /// The root frame in the world.
    root: Pose,
    links: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Names of links in the order of the file.
    order: Vec<&'a str>,
    /// By the link that it carries.
    joints: BTreeMap<&'a str, Node<'a, 'a>>,
    values: BTreeMap<&'a str, Interval>,
}

fn dot(a: &Vector, b: &Vector) -> Interval {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

impl Pose {
    fn identity() -> Self {
        let whole = |n: [i32; 3]| n.map(Interval::whole);
        Self { rows: [whole([1, 0, 0]), whole([0, 1, 0]), whole([0, 0, 1])], at: whole([0, 0, 0]) }
    }

    /// A turn by an angle about an axis of unit length (Rodrigues' formula).
    fn turn(axis: &Vector, angle: &Interval) -> Self {
        let [sine, cosine] = angle.sin_cos();
        let rest = &Interval::whole(1) - &cosine;
        let entry = |i: usize, j: usize| {
            let product = &axis[i] * &axis[j];
            match (3 + j - i) % 3 {
                // Exactly 1 for the coordinate that the axis is along.
                0 => &Interval::whole(1) - &(&rest * &(&Interval::whole(1) - &product)),
                1 => &(&rest * &product) - &(&sine * &axis[3 - i - j]),
                _ => &(&rest * &product) + &(&sine * &axis[3 - i - j]),
            }
        };
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
        Self { rows, at: [0, 0, 0].map(Interval::whole) }
    }

    fn direction(&self, v: &Vector) -> Vector {
        [0, 1, 2].map(|i| dot(&self.rows[i], v))
    }

    fn point(&self, p: &Vector) -> Vector {
        let turned = self.direction(p);
        [0, 1, 2].map(|i| &turned[i] + &self.at[i])
    }

    fn after(&self, inner: &Self) -> Self {
        let column = |j: usize| [0, 1, 2].map(|k| inner.rows[k][j].clone());
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&self.rows[i], &column(j))));
        Self { rows, at: self.point(&inner.at) }
    }
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|n| n.has_tag_name(name))
}

impl<'a> Tree<'a> {
    fn error<T>(&self, node: Node, message: impl Into<String>) -> Read<T> {
        Err(CheckError::at(Input::Urdf, self.document.input_text(), node.range().start, message))
    }

    fn text(&self, node: Node<'a, 'a>, name: &str) -> Read<&'a str> {
        node.attribute(name).map_or_else(|| self.error(node, format!("the attribute {name} is missing")), Ok)
    }

    fn numbers<const N: usize>(&self, node: Node<'a, 'a>, name: &str) -> Read<[Decimal; N]> {
        let numbers: Result<Vec<Decimal>, String> = self.text(node, name)?.split_whitespace().map(str::parse).collect();
        match numbers.map(<[Decimal; N]>::try_from) {
            Ok(Ok(numbers)) => Ok(numbers),
            Ok(Err(_)) => self.error(node, format!("{name} has not {N} numbers")),
            Err(why) => self.error(node, why),
        }
    }

    fn number(&self, node: Node<'a, 'a>, name: &str) -> Read<Decimal> {
        self.numbers::<1>(node, name).map(|[n]| n)
    }

    fn vector(&self, node: Node<'a, 'a>, name: &str) -> Read<Vector> {
        Ok(self.numbers::<3>(node, name)?.each_ref().map(Interval::from))
    }

    /// The `<origin>`: a translation after a turn by roll, pitch and yaw about the fixed axes x, y and z.
    fn origin(&self, node: Node<'a, 'a>) -> Read<Pose> {
        let mut pose = Pose::identity();
        let Some(origin) = child(node, "origin") else { return Ok(pose) };
        if origin.has_attribute("quat_xyzw") {
            return self.error(origin, "the checker does not know quat_xyzw: write rpy");
        }
        if origin.has_attribute("rpy") {
            let angles = self.vector(origin, "rpy")?;
            let axes = Pose::identity().rows;
            let [roll, pitch, yaw] = [0, 1, 2].map(|k| Pose::turn(&axes[k], &angles[k]));
            pose = yaw.after(&pitch).after(&roll);
        }
        if origin.has_attribute("xyz") {
            pose.at = self.vector(origin, "xyz")?;
        }
        Ok(pose)
    }

    /// A joint's axis in its frame, of unit length; by default x.
    fn axis(&self, joint: Node<'a, 'a>) -> Read<Vector> {
        let Some(axis) = child(joint, "axis") else { return Ok([1, 0, 0].map(Interval::whole)) };
        let numbers = self.numbers::<3>(axis, "xyz")?;
        let signs = numbers.each_ref().map(Decimal::sign);
        match signs.iter().filter(|s| **s != Sign::NoSign).count() {
            0 => self.error(axis, "the axis has no direction"),
            1 => Ok(signs.map(|s| {
                Interval::whole(match s {
                    Sign::Minus => -1,
                    Sign::NoSign => 0,
                    Sign::Plus => 1,
                })
            })),
            _ => {
                let axis = numbers.each_ref().map(Interval::from);
                let length = dot(&axis, &axis).sqrt();
                if length.lower.sign() != Sign::Plus {
                    return self.error(joint, "the axis is too short");
                }
                Ok(axis.map(|c| c.divided(&length)))
            }
        }
    }

    /// The pose of a link in the world.
    fn pose(&self, link: &'a str) -> Read<Pose> {
        let below = |pose: Read<Pose>, joint: &Node<'a, 'a>| Ok(pose?.after(&self.step(*joint)?));
        self.above(link)?.iter().rev().fold(Ok(self.root.clone()), below)
    }

    /// The pose of a joint's child in the frame of its parent.
    fn step(&self, joint: Node<'a, 'a>) -> Read<Pose> {
        let origin = self.origin(joint)?;
        let value = || {
            let zero = Interval::whole(0);
            let value = joint.attribute("name").and_then(|name| self.values.get(name));
            match child(joint, "mimic") {
                Some(mimic) => self.error(mimic, "the checker does not know joints that mimic others"),
                None => Ok(value.cloned().unwrap_or(zero)),
            }
        };
        match self.text(joint, "type")? {
            "fixed" => Ok(origin),
            "revolute" | "continuous" => Ok(origin.after(&Pose::turn(&self.axis(joint)?, &value()?))),
            "prismatic" => {
                let (axis, value) = (self.axis(joint)?, value()?);
                Ok(origin.after(&Pose { at: axis.map(|c| &c * &value), ..Pose::identity() }))
            }
            other => self.error(joint, format!("the checker does not know joints of type {other}")),
        }
    }

    fn parent(&self, joint: Node<'a, 'a>) -> Read<&'a str> {
        child(joint, "parent").map_or_else(|| self.error(joint, "the joint has no parent"), |p| self.text(p, "link"))
    }

    /// The joints above a link, from there to the root.
    fn above(&self, mut link: &'a str) -> Read<Vec<Node<'a, 'a>>> {
        let mut above = Vec::new();
        while let Some(&joint) = self.joints.get(link) {
            if above.len() > MOST_JOINTS {
                return self.error(joint, "the joints form a ring, or a chain that is too long");
            }
            above.push(joint);
            link = self.parent(joint)?;
        }
        Ok(above)
    }

    /// The range of a joint: the world's, else the URDF's. Soft limits are not looked at: they leave less.
    fn range(&self, joint: Node<'a, 'a>, world: &World) -> Read<Axis> {
        let turns = joint.attribute("type") != Some("prismatic");
        let range = match (world.limits.get(self.text(joint, "name")?), child(joint, "limit")) {
            (Some([[low, _], [_, high]]), _) => [low.clone(), high.clone()],
            (None, _) if joint.attribute("type") == Some("continuous") => return Ok(Axis::Circle),
            (None, None) => return self.error(joint, "the joint has no <limit>"),
            (None, Some(limit)) => [self.number(limit, "lower")?, self.number(limit, "upper")?],
        };
        if range[0] >= range[1] || (turns && &range[1] - &range[0] > Decimal::whole(LONGEST_TURN)) {
            return self.error(joint, "the joint's limits are none");
        }
        Ok(Axis::Line(range))
    }
}

impl<'a> Arm<'a> {
    /// Reads the URDF and finds the two joints.
    ///
    /// # Errors
    /// What is no robot, or one that the checker does not know.
    pub fn read(document: &'a Document<'a>, world: &World) -> Read<Self> {
        let mut tree = Tree {
            document,
            root: Pose::identity(),
            links: BTreeMap::new(),
            order: Vec::new(),
            joints: BTreeMap::new(),
            values: BTreeMap::new(),
        };
        let root = document.root_element();
        if !root.has_tag_name("robot") {
            return tree.error(root, "this is not a URDF: it has no <robot>");
        }
        let mut names: BTreeMap<&str, Node> = BTreeMap::new();
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
            let is_second = names.insert(name, node).is_some();
            if is_second || tree.joints.insert(tree.text(carried, "link")?, node).is_some() {
                return tree.error(node, "a second joint of this name or with this child");
            }
            let moves = matches!(tree.text(node, "type")?, "revolute" | "continuous" | "prismatic");
            movable.extend((moves && child(node, "mimic").is_none()).then_some(name));
        }
        let chosen: Vec<&str> =
            world.joints.as_ref().map_or(movable.clone(), |j| j.iter().map(String::as_str).collect());
        let [first, second] = chosen[..] else {
            let message = format!("{} joints can move: the world file has to name two, [robot] joints", chosen.len());
            return Err(CheckError::in_file(Input::Urdf, message));
        };
        let node = |name: &str| match names.get_key_value(name) {
            Some((_, node)) if movable.contains(&name) => Ok(*node),
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
        for (name, joint) in &names {
            let is_held = movable.contains(name) && !joints.contains(joint);
            let value = match world.fixed.get(*name) {
                _ if !is_held => continue,
                Some(value) => Interval::around(value),
                None => tree.rest(*joint, world)?,
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
        // About z the plane is (x, y), about y (x, z), about x (y, z).
        let planes = [([0, 1], 2), ([0, 2], 1), ([1, 2], 0)].map(|(across, normal)| Plane { across, normal });
        let moves_in = |plane: &&Plane| {
            let along = |axis: &Vector| plane.across.iter().all(|k| axis[*k].is_whole(0));
            axes.iter()
                .zip(slides)
                .all(|(axis, slides)| if slides { axis[plane.normal].is_whole(0) } else { along(axis) })
        };
        let Some(&plane) = planes.iter().find(moves_in) else {
            return tree
                .error(nodes[1], "the joints do not move, exactly, in one plane of two of the root frame's axes");
        };
        tree.root = plane.placed(&world.at, &world.angle);
        let [(first, first_axis), (second, second_axis)] = seen(&tree)?;
        let (poses, axes) = ([first, second], [first_axis, second_axis]);
        let in_plane = |v: &Vector| plane.across.map(|k| v[k].clone());
        let joint = |k: usize| {
            let turns_left = axes[k][plane.normal].lower.sign() == Sign::Plus;
            // Of the three, the basis (x, z) with y is left-handed.
            let sign = if turns_left == (plane.normal != 1) { 1 } else { -1 };
            let motion = if slides[k] { Motion::Slide(in_plane(&axes[k])) } else { Motion::Turn(sign) };
            Ok(Joint { name: tree.text(nodes[k], "name")?.to_owned(), motion, axis: tree.range(nodes[k], world)? })
        };
        let joints = [joint(0)?, joint(1)?];
        let [base, second] = [in_plane(&poses[0].at), in_plane(&poses[1].at)];
        let offset = [0, 1].map(|k| &second[k] - &base[k]);
        let (tip, bar) = (world.tip.clone(), world.bar.clone());
        Ok(Self { joints, base, offset, tree, children, plane, tip, bar })
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
        self.project(last, &self.tree.pose(name)?.after(&self.tree.origin(*node)?), solid)
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
        let heights =
            [self.tree.pose(self.children[last])?, self.tree.pose(next)?].map(|p| p.at[self.plane.normal].clone());
        let [a, b] = heights;
        let least = Interval { lower: (&a.lower).min(&b.lower).clone(), upper: (&a.upper).min(&b.upper).clone() };
        let most = Interval { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper) };
        let heights = [&least - &radius, &most + &radius];
        let shape = Shape { points: vec![[Interval::whole(0), Interval::whole(0)], end], radius };
        Ok(Body { link: last, shape, heights })
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
            solids.extend(self.solid(geometry)?.map(|solid| (node, solid)));
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
        Ok((link, self.project(1, &self.tree.pose(link)?, &point)?))
    }

    /// A solid of the URDF; none if it has no size.
    fn solid(&self, node: Node<'a, 'a>) -> Read<Option<Solid>> {
        let half = |n: &Decimal| Interval::from(n).half();
        let read = |name: &str| self.tree.number(node, name);
        let is_nothing = |numbers: &[&Decimal]| numbers.iter().all(|n| n.sign() == Sign::NoSign);
        let (numbers, solid) = match node.tag_name().name() {
            "box" => {
                let size = self.tree.numbers::<3>(node, "size")?;
                (size.to_vec(), Solid::Box(size.each_ref().map(half)))
            }
            "sphere" => {
                let radius = read("radius")?;
                (vec![radius.clone()], Solid::Capsule { radius: Interval::from(&radius), half: Interval::whole(0) })
            }
            kind @ ("cylinder" | "capsule") => {
                let (radius, length) = (read("radius")?, read("length")?);
                let (r, half) = (Interval::from(&radius), half(&length));
                let is_round = kind == "capsule";
                let solid =
                    if is_round { Solid::Capsule { radius: r, half } } else { Solid::Cylinder { radius: r, half } };
                (vec![radius, length], solid)
            }
            other => return self.tree.error(node, format!("the checker does not know the shape {other} yet")),
        };
        let numbers: Vec<&Decimal> = numbers.iter().collect();
        if numbers.iter().any(|n| n.sign() == Sign::Minus) {
            return self.tree.error(node, "a size is negative");
        }
        Ok((!is_nothing(&numbers)).then_some(solid))
    }

    /// What a solid covers in the plane, or a part of that where the solid is an oblique cylinder.
    fn project(&self, link: usize, pose: &Pose, solid: &Solid) -> Read<Body> {
        let Plane { across, normal } = self.plane;
        let joint = if link == 0 { self.base.clone() } else { [0, 1].map(|k| &self.base[k] + &self.offset[k]) };
        let center = [0, 1].map(|k| &pose.at[across[k]] - &joint[k]);
        let zero = Interval::whole(0);
        let unit = pose.direction(&[zero.clone(), zero.clone(), Interval::whole(1)]);
        let (along, tilt) = (across.map(|k| unit[k].clone()), unit[normal].abs());
        let beside = |by: &Point| [[0, 1].map(|k| &center[k] + &by[k]), [0, 1].map(|k| &center[k] - &by[k])];
        let (points, radius, reach) = match solid {
            Solid::Box(half) => {
                let corner = |i: usize| {
                    let signed = |k: usize| if i >> k & 1 == 0 { half[k].clone() } else { -&half[k] };
                    pose.direction(&[signed(0), signed(1), signed(2)])
                };
                let corners: Vec<Vector> = (0..8).map(corner).collect();
                let reach = corners.iter().map(|c| c[normal].clone()).max_by_key(|c| c.lower.clone()).expect("eight");
                let mut points: Vec<Point> = Vec::new();
                for c in corners {
                    let point = [0, 1].map(|k| &center[k] + &c[across[k]]);
                    points.extend((!points.contains(&point)).then_some(point));
                }
                (points, zero, reach)
            }
            Solid::Capsule { radius, half } => {
                let points =
                    if half.is_whole(0) { vec![center.clone()] } else { beside(&along.map(|c| &c * half)).to_vec() };
                (points, radius.clone(), &(half * &tilt) + radius)
            }
            Solid::Cylinder { radius, half } => {
                let end = along.each_ref().map(|c| c * half);
                let flat = length(&along);
                let reach = &(half * &tilt) + &(radius * &flat);
                if tilt.is_whole(1) {
                    (vec![center.clone()], radius.clone(), half.clone())
                } else if flat.lower.sign() != Sign::Plus || is_nearly_one(&tilt) {
                    // The ends are ellipses that hold discs of this radius.
                    (beside(&end).to_vec(), radius * &tilt, reach)
                } else {
                    // Half an ellipse at each end, from side to side.
                    let onward = along.each_ref().map(|c| c.divided(&flat));
                    let across = [-&(&onward[1] * radius), &onward[0] * radius];
                    let onward = onward.map(|c| &(&c * radius) * &tilt);
                    let steps = if tilt.upper.bits() + LYING < u64::from(BITS) { 1 } else { ELLIPSE_STEPS };
                    let around = (0..=steps).flat_map(|k| {
                        let [sine, cosine] = (Interval::pi() * &Interval::whole(k)).over(steps as u32).sin_cos();
                        let by = [0, 1].map(|i| &(&end[i] + &(&across[i] * &cosine)) + &(&onward[i] * &sine));
                        beside(&by)
                    });
                    (around.collect(), zero, reach)
                }
            }
        };
        let height = &pose.at[normal];
        Ok(Body { link, shape: Shape { points, radius }, heights: [height - &reach, height + &reach] })
    }
}

impl<'a> Tree<'a> {
    /// Where a joint is held of which nothing is said: at 0, or the limit next to it.
    fn rest(&self, joint: Node<'a, 'a>, world: &World) -> Read<Interval> {
        let has_limits = joint.attribute("type") != Some("continuous") && child(joint, "limit").is_some();
        if child(joint, "safety_controller").is_some() {
            return self
                .error(joint, "the checker does not know where soft limits hold a joint: [robot] fixed says it");
        }
        if !has_limits && !world.limits.contains_key(self.text(joint, "name")?) {
            return Ok(Interval::whole(0));
        }
        let Axis::Line([low, high]) = self.range(joint, world)? else { return Ok(Interval::whole(0)) };
        Ok(Interval::from(&Decimal::whole(0).max(low).min(high)))
    }
}

/// Whether a cosine is such that a cylinder's end is taken as a disc.
fn is_nearly_one(tilt: &Interval) -> bool {
    tilt.lower >= (&Interval::whole(1) - &Interval::whole(1).over(OBLIQUE)).lower
}

/// A solid about its origin; cylinders and capsules along z.
enum Solid {
    Box([Interval; 3]),
    Cylinder {
        radius: Interval,
        half: Interval,
    },
    /// `half` is half the length between the centres of the caps: 0 for a sphere.
    Capsule {
        radius: Interval,
        half: Interval,
    },
}

impl Body {
    /// Whether its heights and these are known to have some in common.
    pub fn is_at(&self, heights: Option<&Range>) -> bool {
        let Some([low, high]) = heights.map(|range| range.each_ref().map(Interval::from)) else { return true };
        self.heights[0].upper <= high.lower && low.upper <= self.heights[1].lower
    }
}
