//! The URDF as a tree of links and joints.

use super::pose::{Pose, Vector, dot};
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::files::Files;
use crate::interval::Interval;
use crate::sweep::Axis;
use crate::world::World;
use num_bigint::Sign;
use roxmltree::{Document, Node};
use std::collections::BTreeMap;

/// Ranges of a joint that turns longer than this mean that it has none.
const LONGEST_TURN: i32 = 1000;

/// Joints of the longest chain.
const MOST_JOINTS: usize = 1000;

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
    pub values: BTreeMap<&'a str, Interval>,
}

pub fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|n| n.has_tag_name(name))
}

impl<'a> Tree<'a> {
    pub fn error<T>(&self, node: Node, message: impl Into<String>) -> Read<T> {
        Err(CheckError::at(Input::Urdf, self.document.input_text(), node.range().start, message))
    }

    pub fn text(&self, node: Node<'a, 'a>, name: &str) -> Read<&'a str> {
        node.attribute(name).map_or_else(|| self.error(node, format!("the attribute {name} is missing")), Ok)
    }

    pub fn numbers<const N: usize>(&self, node: Node<'a, 'a>, name: &str) -> Read<[Decimal; N]> {
        let numbers: Result<Vec<Decimal>, String> = self.text(node, name)?.split_whitespace().map(str::parse).collect();
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

    /// The range of a joint: the world's, else the URDF's. Soft limits are not looked at: they leave less.
    pub fn range(&self, joint: Node<'a, 'a>, world: &World) -> Read<Axis> {
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

    /// Where a joint is held of which nothing is said: at 0, or the limit next to it.
    pub fn rest(&self, joint: Node<'a, 'a>, world: &World) -> Read<Interval> {
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
