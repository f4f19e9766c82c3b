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

/// Ranges of a joint that turns longer than this mean that it has none.
const LONGEST_TURN: i32 = 1000;

/// Limits of a joint that are as far are none, radians or metres.
const FARTHEST: i32 = 1_000_000;

/// Joints of the longest chain.
pub const MOST_JOINTS: usize = 1000;

pub type Read<T> = Result<T, CheckError>;

/// Links and joints by name, and where the joints stand.
pub struct Tree<'a> {
    pub files: &'a Files,
    pub document: &'a Document<'a>,
    /// The root frame in the world.
    pub root: Pose,
    pub links: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Names of links in the order of the file.
    pub order: Vec<&'a str>,
    /// By the link that it carries.
    pub joints: BTreeMap<&'a str, Node<'a, 'a>>,
    /// By name.
    pub named: BTreeMap<&'a str, Node<'a, 'a>>,
    pub values: BTreeMap<&'a str, Interval>,
}

/// What the value of a joint may be.
pub enum Limits {
    /// Nobody says.
    Unset,
    /// Anything: it turns without end.
    Endless,
    /// From one to another, each of which is known to lie in a range.
    Ends([Range; 2]),
}

/// Children of a name, of the node's own namespace: whatever else is in the file is none of the robot's.
pub fn children<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    let namespace = node.tag_name().namespace();
    node.children().filter(move |n| n.tag_name().name() == name && n.tag_name().namespace() == namespace)
}

/// Whether an element is to be expanded before it means anything.
fn is_xacro(node: &Node, robot: &Node) -> bool {
    let namespace = node.tag_name().namespace().filter(|namespace| Some(*namespace) != robot.tag_name().namespace());
    namespace.is_some_and(|namespace| namespace.ends_with("/xacro"))
        || node.attributes().any(|attribute| attribute.value().contains("${") || attribute.value().contains("$("))
}

pub fn child<'a>(node: Node<'a, 'a>, name: &'static str) -> Option<Node<'a, 'a>> {
    children(node, name).next()
}

/// Whether a joint has one value that it can move by.
pub fn moves(joint: &Node) -> bool {
    matches!(joint.attribute("type"), Some("revolute" | "continuous" | "prismatic"))
}

impl<'a> Tree<'a> {
    /// Reads it, and the names of the joints that can move by themselves.
    ///
    /// # Errors
    /// What is no robot.
    pub fn read(document: &'a Document<'a>, files: &'a Files) -> Read<(Self, Vec<&'a str>)> {
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
                return tree.error(node, "a second link of this name");
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
            // Only the root may go without saying.
            if !tree.links.contains_key(carried) || !(tree.links.contains_key(parent) || parent == "world") {
                return tree.error(node, "the joint is between links that the robot does not have");
            }
            let is_second = tree.named.insert(name, node).is_some();
            if is_second || tree.joints.insert(carried, node).is_some() {
                return tree.error(node, "a second joint of this name or with this child");
            }
            tree.text(node, "type")?;
            movable.extend((moves(&node) && child(node, "mimic").is_none()).then_some(name));
        }
        let parents = tree.named.values().map(|joint| tree.parent(*joint)).collect::<Read<Vec<_>>>()?;
        let all: BTreeSet<&str> = tree.order.iter().copied().chain(parents).collect();
        if all.iter().filter(|link| !tree.joints.contains_key(**link)).count() > 1 {
            return tree.error(robot, "several links have no joint above them: a robot has one root");
        }
        Ok((tree, movable))
    }

    pub fn error<T>(&self, node: Node, message: impl Into<String>) -> Read<T> {
        Err(CheckError::at(Input::Urdf, self.document.input_text(), node.range().start, message))
    }

    /// That a node has no two children of one of these names.
    fn has_one(&self, node: Node<'a, 'a>, names: &[&'static str]) -> Read<()> {
        match names.iter().find_map(|name| children(node, name).nth(1)) {
            Some(second) => self.error(second, "a second element of this kind"),
            None => Ok(()),
        }
    }

    pub fn text(&self, node: Node<'a, 'a>, name: &str) -> Read<&'a str> {
        node.attribute(name).map_or_else(|| self.error(node, format!("the attribute {name} is missing")), Ok)
    }

    pub fn numbers<const N: usize>(&self, node: Node<'a, 'a>, name: &str) -> Read<[Decimal; N]> {
        let numbers: Result<Vec<Decimal>, String> =
            self.text(node, name)?.split_whitespace().map(Decimal::read).collect();
        match numbers.map(<[Decimal; N]>::try_from) {
            Ok(Ok(numbers)) => Ok(numbers),
            Ok(Err(_)) => self.error(node, format!("{name} has not {N} numbers")),
            Err(why) => self.error(node, why),
        }
    }

    pub fn number(&self, node: Node<'a, 'a>, name: &str) -> Read<Decimal> {
        self.numbers::<1>(node, name).map(|[n]| n)
    }

    pub fn vector(&self, node: Node<'a, 'a>, name: &str) -> Read<Vector> {
        Ok(self.numbers::<3>(node, name)?.each_ref().map(Interval::from))
    }

    /// The `<origin>`: a translation after a turn by roll, pitch and yaw about the fixed axes x, y and z.
    pub fn origin(&self, node: Node<'a, 'a>) -> Read<Pose> {
        let mut pose = Pose::identity();
        let Some(origin) = child(node, "origin") else { return Ok(pose) };
        if origin.has_attribute("quat_xyzw") {
            if origin.has_attribute("rpy") {
                return self.error(origin, "it has both rpy and quat_xyzw: keep one");
            }
            pose = self.quaternion(origin)?;
        } else if origin.has_attribute("rpy") {
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
    pub fn axis(&self, joint: Node<'a, 'a>) -> Read<Vector> {
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
    pub fn pose(&self, link: &'a str) -> Read<Pose> {
        let below = |pose: Read<Pose>, joint: &Node<'a, 'a>| Ok(pose?.after(&self.step(*joint)?));
        self.above(link)?.iter().rev().fold(Ok(self.root.clone()), below)
    }

    /// The pose of a joint's child in the frame of its parent.
    pub fn step(&self, joint: Node<'a, 'a>) -> Read<Pose> {
        let origin = self.origin(joint)?;
        let value = || self.value(joint, 0);
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

    pub fn parent(&self, joint: Node<'a, 'a>) -> Read<&'a str> {
        child(joint, "parent").map_or_else(|| self.error(joint, "the joint has no parent"), |p| self.text(p, "link"))
    }

    /// The joints above a link, from there to the root.
    pub fn above(&self, mut link: &'a str) -> Read<Vec<Node<'a, 'a>>> {
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

    /// A limit of a joint; what is farther than all is as far as anything.
    fn limit(&self, limit: Node<'a, 'a>, name: &str) -> Read<Decimal> {
        let endless = |sign: f64| Decimal::whole(10 * FARTHEST * sign as i32);
        let Some(text) = limit.attribute(name) else {
            // From version 1.2 on there is none then, before that it is 0.
            let version = self.document.root_element().attribute("version").unwrap_or("1.0").trim();
            let numbers = version.split_once('.').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
            let is_new = numbers.unwrap_or((1_u32, 0_u32)) >= (1, 2);
            return Ok(if is_new { endless(if name == "lower" { -1.0 } else { 1.0 }) } else { Decimal::whole(0) });
        };
        match text.trim().parse::<f64>() {
            Ok(number) if number.abs() > f64::from(10 * FARTHEST) => Ok(endless(number.signum())),
            _ => self.number(limit, name),
        }
    }

    /// What a joint's value may be: as the world says, else the URDF, less what its soft limits take.
    pub fn limits(&self, joint: Node<'a, 'a>, world: &WorldFile) -> Read<Limits> {
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
            // Both 0 is what exporters write where there are none.
            if ends.iter().any(|end| end.sign() != Sign::NoSign) {
                [low, high] = [low.max(ends[0].clone()), high.min(ends[1].clone())];
            }
        }
        if low >= high {
            return self.error(joint, "its limits are reversed, or its soft limits leave nothing of them");
        }
        let [least, most] = [-FARTHEST, FARTHEST].map(Decimal::whole);
        if turns && low <= least && high >= most {
            return Ok(Limits::Endless);
        }
        if !turns && &high - &low > Decimal::whole(2 * FARTHEST) {
            [low, high] = [low.max(least), high.min(most)];
            if low >= high {
                return Ok(Limits::Unset);
            }
        }
        if &high - &low > Decimal::whole(if turns { LONGEST_TURN } else { 2 * FARTHEST }) {
            return Ok(Limits::Unset);
        }
        Ok(Limits::Ends([[low.clone(), low], [high.clone(), high]]))
    }

    /// The ends of what a joint's value may be, at the most and at the least; none of one that turns without end.
    pub fn ends(&self, joint: Node<'a, 'a>, world: &WorldFile) -> Read<Option<[Range; 2]>> {
        let (name, turns) = (self.text(joint, "name")?, joint.attribute("type") != Some("prismatic"));
        match self.limits(joint, world)? {
            Limits::Endless => Ok(None),
            Limits::Ends([[least, low], [high, most]])
                if low < high && !(turns && &most - &least > Decimal::whole(LONGEST_TURN)) =>
            {
                Ok(Some([[least, most], [low, high]]))
            }
            _ => self.error(
                joint,
                format!("the joint has no limits: [robot] limits = {{ {name} = [lower, upper] }} in the world file"),
            ),
        }
    }

    /// Where a joint is held of which nothing is said: at 0, or the limit next to it.
    pub fn rest(&self, joint: Node<'a, 'a>, world: &WorldFile) -> Read<Interval> {
        let zero = Interval::whole(0);
        let Limits::Ends(ends) = self.limits(joint, world)? else { return Ok(zero) };
        let [low, high] = ends.each_ref().map(Interval::around);
        let [lower, upper] =
            [(low.lower, high.lower), (low.upper, high.upper)].map(|(low, high)| BigInt::ZERO.max(low).min(high));
        Ok(Interval { lower, upper })
    }
}
