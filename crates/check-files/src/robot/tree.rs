//! The URDF as a tree of links and joints.

use super::pose::{Pose, Vector, dot};
use crate::files::Files;
use crate::world::WorldFile;
use cplan_check::decimal::Decimal;
use cplan_check::domain::Range;
use cplan_check::interval::Interval;
use cplan_check::{CheckError, Input};
use num_bigint::{BigInt, Sign};
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, BTreeSet};

/// Greatest range of a revolute joint, radians. A joint with a greater range counts as continuous.
const MAX_TURN_RANGE: i32 = 1000;

/// Least absolute value of a limit that counts as no limit, radians or metres.
const MAX_LIMIT: i32 = 1_000_000;

/// Maximum number of joints in a chain.
pub const MAX_JOINTS: usize = 1000;

pub type ReadResult<T> = Result<T, CheckError>;

/// Links and joints by name, and the values of the joints.
pub struct Tree<'a> {
    pub files: &'a Files,
    pub document: &'a Document<'a>,
    /// Pose of the root frame in the world.
    pub root: Pose,
    pub links: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Names of links, in the order of the file.
    pub order: Vec<&'a str>,
    /// Joints by the link that they carry.
    pub joints: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Joints by name.
    pub named: BTreeMap<&'a str, Node<'a, 'a>>,
    pub values: BTreeMap<&'a str, Interval>,
}

/// The limits of a joint.
pub enum Limits {
    /// The file states no limits.
    Unset,
    /// The joint is continuous.
    Endless,
    /// Enclosures of the lower and of the upper limit.
    Ends([Range; 2]),
}

/// Iterates over the children of a node that have a name, in the node's own namespace. Elements of other namespaces do
/// not describe the robot.
pub fn children<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    let namespace = node.tag_name().namespace();
    node.children().filter(move |n| n.tag_name().name() == name && n.tag_name().namespace() == namespace)
}

/// Returns true if an element belongs to xacro. Such a file must be expanded first.
fn is_xacro(node: &Node, robot: &Node) -> bool {
    let namespace = node.tag_name().namespace().filter(|namespace| Some(*namespace) != robot.tag_name().namespace());
    namespace.is_some_and(|namespace| namespace.ends_with("/xacro"))
        || node.attributes().any(|attribute| attribute.value().contains("${") || attribute.value().contains("$("))
}

pub fn child<'a>(node: Node<'a, 'a>, name: &'static str) -> Option<Node<'a, 'a>> {
    children(node, name).next()
}

/// Returns true if a joint is movable, and its value is a single number.
pub fn moves(joint: &Node) -> bool {
    matches!(joint.attribute("type"), Some("revolute" | "continuous" | "prismatic"))
}

impl<'a> Tree<'a> {
    /// Reads the tree. Also returns the names of the joints that can move independently.
    ///
    /// # Errors
    /// If the document does not describe a robot.
    pub fn read(document: &'a Document<'a>, files: &'a Files) -> ReadResult<(Self, Vec<&'a str>)> {
        let (links, joints, named, values) = Default::default();
        let root = Pose::identity();
        let mut tree = Self { files, document, root, links, order: Vec::new(), joints, named, values };
        let robot = document.root_element();
        if robot.tag_name().name() != "robot" {
            return tree.error(robot, "this is not a URDF: it has no <robot>");
        }
        if let Some(node) = document.descendants().find(|node| is_xacro(node, &robot)) {
            let message =
                "this is xacro, not a plain URDF; `cplan inspect FILE --expanded robot.urdf` writes the URDF to check";
            return tree.error(node, message);
        }
        for node in children(robot, "link") {
            if tree.links.insert(tree.text(node, "name")?, node).is_some() {
                return tree.error(node, "two links have this name");
            }
            tree.order.push(tree.text(node, "name")?);
            for shape in ["collision", "visual"].into_iter().flat_map(|kind| children(node, kind)) {
                tree.has_one(shape, &["origin", "geometry"])?;
            }
        }
        let mut movable = Vec::new();
        for node in children(robot, "joint") {
            tree.has_one(node, &["origin", "parent", "child", "axis", "limit", "mimic", "safety_controller"])?;
            let (name, parent) = (tree.text(node, "name")?, tree.parent(node)?);
            let Some(carried) = child(node, "child") else { return tree.error(node, "the joint has no child") };
            let carried = tree.text(carried, "link")?;
            // Only the root link may be undeclared.
            if !tree.links.contains_key(carried) || !(tree.links.contains_key(parent) || parent == "world") {
                return tree.error(node, "the parent or child link of this joint does not exist");
            }
            let is_second = tree.named.insert(name, node).is_some();
            if is_second || tree.joints.insert(carried, node).is_some() {
                return tree.error(node, "another joint has the same name or the same child link");
            }
            tree.text(node, "type")?;
            movable.extend((moves(&node) && child(node, "mimic").is_none()).then_some(name));
        }
        let parents = tree.named.values().map(|joint| tree.parent(*joint)).collect::<ReadResult<Vec<_>>>()?;
        let all: BTreeSet<&str> = tree.order.iter().copied().chain(parents).collect();
        if all.iter().filter(|link| !tree.joints.contains_key(**link)).count() > 1 {
            return tree.error(
                robot,
                "the robot has several root links (links that are no joint's child), but needs exactly one",
            );
        }
        Ok((tree, movable))
    }

    pub fn error<T>(&self, node: Node, message: impl Into<String>) -> ReadResult<T> {
        Err(CheckError::at(Input::Urdf, self.document.input_text(), node.range().start, message))
    }

    /// Checks that a node has at most one child of each of these names.
    fn has_one(&self, node: Node<'a, 'a>, names: &[&'static str]) -> ReadResult<()> {
        match names.iter().find_map(|name| children(node, name).nth(1)) {
            Some(second) => self.error(second, "a second element of this kind; remove one"),
            None => Ok(()),
        }
    }

    pub fn text(&self, node: Node<'a, 'a>, name: &str) -> ReadResult<&'a str> {
        node.attribute(name).map_or_else(|| self.error(node, format!("the attribute {name} is missing")), Ok)
    }

    pub fn numbers<const N: usize>(&self, node: Node<'a, 'a>, name: &str) -> ReadResult<[Decimal; N]> {
        let numbers: Result<Vec<Decimal>, String> =
            self.text(node, name)?.split_whitespace().map(Decimal::read).collect();
        match numbers.map(<[Decimal; N]>::try_from) {
            Ok(Ok(numbers)) => Ok(numbers),
            Ok(Err(_)) => self.error(node, format!("{name} must have {N} numbers")),
            Err(why) => self.error(node, why),
        }
    }

    pub fn number(&self, node: Node<'a, 'a>, name: &str) -> ReadResult<Decimal> {
        self.numbers::<1>(node, name).map(|[n]| n)
    }

    pub fn vector(&self, node: Node<'a, 'a>, name: &str) -> ReadResult<Vector> {
        Ok(self.numbers::<3>(node, name)?.each_ref().map(Interval::from))
    }

    /// Reads the `<origin>`: a rotation by roll, pitch and yaw about the fixed axes x, y and z, followed by a
    /// translation.
    pub fn origin(&self, node: Node<'a, 'a>) -> ReadResult<Pose> {
        let mut pose = Pose::identity();
        let Some(origin) = child(node, "origin") else { return Ok(pose) };
        if origin.has_attribute("quat_xyzw") {
            if origin.has_attribute("rpy") {
                return self.error(origin, "the origin has both rpy and quat_xyzw: remove one");
            }
            pose = self.quaternion(origin)?;
        } else if origin.has_attribute("rpy") {
            let angles = self.vector(origin, "rpy")?;
            let axes = Pose::identity().rows;
            let [roll, pitch, yaw] = [0, 1, 2].map(|k| Pose::turn(&axes[k], &angles[k]));
            pose = yaw.compose(&pitch).compose(&roll);
        }
        if origin.has_attribute("xyz") {
            pose.at = self.vector(origin, "xyz")?;
        }
        Ok(pose)
    }

    /// Returns a joint's axis in its frame, of unit length; x by default.
    pub fn axis(&self, joint: Node<'a, 'a>) -> ReadResult<Vector> {
        let Some(axis) = child(joint, "axis") else { return Ok([1, 0, 0].map(Interval::whole)) };
        let numbers = self.numbers::<3>(axis, "xyz")?;
        let signs = numbers.each_ref().map(Decimal::sign);
        match signs.iter().filter(|s| **s != Sign::NoSign).count() {
            0 => self.error(axis, "the axis is zero"),
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

    /// Returns the pose of a link in the world.
    pub fn pose(&self, link: &'a str) -> ReadResult<Pose> {
        let below = |pose: ReadResult<Pose>, joint: &Node<'a, 'a>| Ok(pose?.compose(&self.step(*joint)?));
        self.joints_above(link)?.iter().rev().fold(Ok(self.root.clone()), below)
    }

    /// Returns the pose of a joint's child in the frame of its parent.
    pub fn step(&self, joint: Node<'a, 'a>) -> ReadResult<Pose> {
        let origin = self.origin(joint)?;
        let value = || self.value(joint, 0);
        match self.text(joint, "type")? {
            "fixed" => Ok(origin),
            "revolute" | "continuous" => Ok(origin.compose(&Pose::turn(&self.axis(joint)?, &value()?))),
            "prismatic" => {
                let (axis, value) = (self.axis(joint)?, value()?);
                Ok(origin.compose(&Pose { at: axis.map(|c| &c * &value), ..Pose::identity() }))
            }
            other => self.error(joint, format!("the checker does not know joints of type {other}")),
        }
    }

    pub fn parent(&self, joint: Node<'a, 'a>) -> ReadResult<&'a str> {
        child(joint, "parent").map_or_else(|| self.error(joint, "the joint has no parent"), |p| self.text(p, "link"))
    }

    /// Returns the joints above a link, from the link to the root.
    pub fn joints_above(&self, mut link: &'a str) -> ReadResult<Vec<Node<'a, 'a>>> {
        let mut above = Vec::new();
        while let Some(&joint) = self.joints.get(link) {
            if above.len() > MAX_JOINTS {
                return self.error(joint, "the joints form a ring, or a chain that is too long");
            }
            above.push(joint);
            link = self.parent(joint)?;
        }
        Ok(above)
    }

    /// Reads a limit of a joint. Infinite values become very large numbers.
    fn limit(&self, limit: Node<'a, 'a>, name: &str) -> ReadResult<Decimal> {
        let endless = |sign: f64| Decimal::whole(10 * MAX_LIMIT * sign as i32);
        let Some(text) = limit.attribute(name) else {
            // From version 1.2 on, a missing limit means unlimited. Before that it means 0.
            let version = self.document.root_element().attribute("version").unwrap_or("1.0").trim();
            let numbers = version.split_once('.').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
            let is_new = numbers.unwrap_or((1_u32, 0_u32)) >= (1, 2);
            return Ok(if is_new { endless(if name == "lower" { -1.0 } else { 1.0 }) } else { Decimal::whole(0) });
        };
        match text.trim().parse::<f64>() {
            Ok(number) if number.abs() > f64::from(10 * MAX_LIMIT) => Ok(endless(number.signum())),
            _ => self.number(limit, name),
        }
    }

    /// Returns the limits of a joint: those of the world, or else those of the URDF, narrowed by its soft limits.
    pub fn limits(&self, joint: Node<'a, 'a>, world: &WorldFile) -> ReadResult<Limits> {
        let turns = joint.attribute("type") != Some("prismatic");
        if let Some(ends) = world.robot.limits.get(self.text(joint, "name")?) {
            return Ok(Limits::Ends(ends.clone()));
        }
        if joint.attribute("type") == Some("continuous") {
            return Ok(Limits::Endless);
        }
        let Some(limit) = child(joint, "limit") else { return Ok(Limits::Unset) };
        let [mut low, mut high] = [self.limit(limit, "lower")?, self.limit(limit, "upper")?];
        if low == high {
            return Ok(Limits::Unset);
        }
        if let Some(soft) = child(joint, "safety_controller") {
            let zero = || Ok(Decimal::whole(0));
            let end = |name| if soft.has_attribute(name) { self.limit(soft, name) } else { zero() };
            let ends = [end("soft_lower_limit")?, end("soft_upper_limit")?];
            // Exporters write 0 for both soft limits if the joint has none.
            if ends.iter().any(|end| end.sign() != Sign::NoSign) {
                [low, high] = [low.max(ends[0].clone()), high.min(ends[1].clone())];
            }
        }
        if low >= high {
            return self.error(joint, "the limits of the joint are reversed, or do not overlap the soft limits");
        }
        let [least, most] = [-MAX_LIMIT, MAX_LIMIT].map(Decimal::whole);
        if turns && low <= least && high >= most {
            return Ok(Limits::Endless);
        }
        if !turns && &high - &low > Decimal::whole(2 * MAX_LIMIT) {
            [low, high] = [low.max(least), high.min(most)];
            if low >= high {
                return Ok(Limits::Unset);
            }
        }
        if &high - &low > Decimal::whole(if turns { MAX_TURN_RANGE } else { 2 * MAX_LIMIT }) {
            return Ok(Limits::Unset);
        }
        Ok(Limits::Ends([[low.clone(), low], [high.clone(), high]]))
    }

    /// Returns two ranges of a joint's values. The first contains all values within the limits, and the second
    /// certainly lies within them. `None` for a continuous joint.
    pub fn ends(&self, joint: Node<'a, 'a>, world: &WorldFile) -> ReadResult<Option<[Range; 2]>> {
        let (name, turns) = (self.text(joint, "name")?, joint.attribute("type") != Some("prismatic"));
        match self.limits(joint, world)? {
            Limits::Endless => Ok(None),
            Limits::Ends([[least, low], [high, most]])
                if low < high && !(turns && &most - &least > Decimal::whole(MAX_TURN_RANGE)) =>
            {
                Ok(Some([[least, most], [low, high]]))
            }
            _ => self.error(
                joint,
                format!("the joint has no limits: [robot] limits = {{ {name} = [lower, upper] }} in the world file"),
            ),
        }
    }

    /// Returns the default value of a fixed joint: 0, or the limit nearest to 0.
    pub fn rest(&self, joint: Node<'a, 'a>, world: &WorldFile) -> ReadResult<Interval> {
        let zero = Interval::whole(0);
        let Limits::Ends(ends) = self.limits(joint, world)? else { return Ok(zero) };
        let [low, high] = ends.each_ref().map(Interval::enclosing);
        let [lower, upper] =
            [(low.lower, high.lower), (low.upper, high.upper)].map(|(low, high)| BigInt::ZERO.max(low).min(high));
        Ok(Interval { lower, upper })
    }
}
