//! Reads the URDF: finds two movable joints, and projects shapes onto their plane.

use crate::files::Files;
use crate::world::WorldFile;
use cplan_check::arm::{Arm, Joint, Motion};
use cplan_check::domain::{Axis, Domain};
use cplan_check::interval::{Interval, minus};
use cplan_check::overlap::Shape;
use cplan_check::shapes::{Body, Outline};
use cplan_check::{CheckError, Input};
use num_bigint::Sign;
use plane::Plane;
use pose::{Pose, Vector, dot};
use roxmltree::{Document, Node};
use solid::Solid;
use tree::{ReadResult, Tree, child, moves};

mod bar;
mod collada;
mod drives;
mod layers;
mod manifest;
mod mesh;
mod mimic;
mod oblique;
mod own;
mod permanent;
mod plane;
mod pose;
mod quaternion;
mod shapes;
mod solid;
pub mod tool;
mod tree;

/// A robot: the arm, and the tree of its links.
pub struct Robot<'a> {
    /// The planar arm.
    pub arm: Arm,
    tree: Tree<'a>,
    /// The links that the two joints carry directly.
    children: [&'a str; 2],
    /// The link whose origin is the tip.
    tip_link: &'a str,
    plane: Plane,
}

impl<'a> Robot<'a> {
    /// Reads the URDF and finds the two joints.
    ///
    /// # Errors
    /// If the URDF does not describe a robot, or describes a robot of a kind that the checker does not know.
    pub fn read(
        document: &'a Document<'a>,
        world: &WorldFile,
        files: &'a Files,
        implied: Option<&[String; 2]>,
    ) -> ReadResult<Self> {
        let (mut tree, movable) = Tree::read(document, files)?;
        let (stated, implied) = (&world.robot.joints, implied.map(|names| names.to_vec()));
        if stated.is_some() && implied.is_some() && *stated != implied {
            return CheckError::fails("the certificate and the world name different joints");
        }
        let is_implied = implied.is_some();
        let own = || movable.iter().map(|name| (*name).to_owned()).collect();
        let chosen: Vec<String> = stated.clone().or(implied).unwrap_or_else(own);
        let [first, second] = &chosen[..] else {
            let message = format!(
                "the robot has {} movable joints: the world file must name two of them, as [robot] joints",
                chosen.len()
            );
            return Err(CheckError::in_file(Input::Urdf, message));
        };
        let node = |name: &str| match tree.named.get(name) {
            Some(node) if movable.contains(&name) => Ok(*node),
            _ => Err(CheckError::in_file(Input::Urdf, format!("the robot has no movable joint \"{name}\""))),
        };
        let carried =
            |joint: Node<'a, 'a>| child(joint, "child").and_then(|c| c.attribute("link")).expect("has been read");
        let mut joints = [node(first)?, node(second)?];
        if tree.joints_above(carried(joints[0]))?[1..].contains(&joints[1]) {
            if world.robot.joints.is_some() {
                let message = "[robot] joints: the second joint carries the first; swap them";
                return Err(CheckError::in_file(Input::World, message));
            }
            if is_implied {
                return CheckError::fails(
                    "\"joints\" of the certificate: the second joint carries the first; swap them",
                );
            }
            joints.swap(0, 1);
        }
        for name in world.robot.fixed.keys().chain(world.robot.limits.keys()) {
            let joint = tree.named.get(name.as_str()).filter(|joint| moves(joint));
            if joint.is_none_or(|joint| {
                world.robot.fixed.contains_key(name) && (joints.contains(joint) || child(*joint, "mimic").is_some())
            }) {
                let message = format!("[robot] fixed or limits: \"{name}\" cannot have such values");
                return Err(CheckError::in_file(Input::World, message));
            }
        }
        if !tree.joints_above(carried(joints[1]))?[1..].contains(&joints[0]) {
            return tree.error(joints[1], "neither of the two joints carries the other");
        }
        for name in movable {
            let joint = tree.named[name];
            let value = match world.robot.fixed.get(name) {
                _ if joints.contains(&joint) => continue,
                Some(value) => Interval::enclosing(value),
                None => tree.rest(joint, world)?,
            };
            tree.values.insert(name, value);
        }
        Self::of(tree, joints, joints.map(carried), world)
    }

    fn of(mut tree: Tree<'a>, nodes: [Node<'a, 'a>; 2], children: [&'a str; 2], world: &WorldFile) -> ReadResult<Self> {
        let seen = |tree: &Tree<'a>| -> ReadResult<[(Pose, Vector); 2]> {
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
        tree.root = plane.placed(&world.robot.at, &world.robot.angle);
        let [(first, first_axis), (second, second_axis)] = seen(&tree)?;
        let (poses, axes) = ([first, second], [first_axis, second_axis]);
        let joint = |k: usize| {
            let sign = if dot(&axes[k], &plane.left()).lower.sign() == Sign::Plus { 1 } else { -1 };
            let motion = match (slides[k], plane.direction(&axes[k])) {
                (false, _) => Motion::Turn(sign),
                (true, Some(direction)) => Motion::Slide(direction),
                (true, None) => {
                    return tree.error(nodes[k], "the direction of this sliding joint does not follow from the URDF");
                }
            };
            let (axis, within) = match tree.ends(nodes[k], world)? {
                Some([outer, inner]) => (Axis::Line(outer), Some(inner)),
                None => (Axis::Circle, None),
            };
            Ok(Joint { name: tree.text(nodes[k], "name")?.to_owned(), motion, axis, within })
        };
        let mut joints = [joint(0)?, joint(1)?];
        let sum = world.robot.drives.as_ref().and_then(|drives| drives::narrow(drives, &mut joints));
        let [base, second] = poses.each_ref().map(|pose| plane.flat(&pose.at));
        let offset = minus(&second, &base);
        let nowhere = Shape { points: Vec::new(), radius: Interval::whole(0) };
        let (tip_link, tip) = (String::new(), Body { link: 1, shape: nowhere, heights: None });
        let (shapes, bases, own, notes) = Default::default();
        let domain = Domain::new(joints.each_ref().map(|joint| &joint.axis));
        let arm = Arm { joints, domain, sum, base, offset, tip_link, tip, shapes, bases, own, notes };
        let mut robot = Self { arm, tree, children, tip_link: children[1], plane };
        robot.tip_link = robot.find_tip(world.robot.tip.as_deref())?;
        robot.arm.tip_link = robot.tip_link.to_owned();
        let at = robot.tree.pose(robot.tip_link)?;
        robot.arm.tip = robot.project(Some(1), &at, &Solid::point(), Outline::Within);
        robot.count(world)?;
        robot.check_independence(&nodes)?;
        world.task.as_ref().map_or(Ok(()), |task| robot.with_tool(task))?;
        robot.arm.notes.insert_str(0, &robot.plane.idealized());
        Ok(robot)
    }

    /// Returns the last of the two joints that moves a link, 0 or 1. `None` if the link is static.
    fn moving_joint(&self, link: &'a str) -> ReadResult<Option<usize>> {
        let above = self.tree.joints_above(link)?;
        let moves = |k: &usize| above.iter().any(|joint| self.tree.joints.get(self.children[*k]) == Some(joint));
        Ok([1, 0].into_iter().find(moves))
    }

    /// Finds the link whose origin is the tip. If the world does not name it, it is the deepest link of the tree that
    /// the second joint moves.
    fn find_tip(&self, named: Option<&str>) -> ReadResult<&'a str> {
        let mut deepest = None;
        for link in self.tree.order.iter().filter(|link| named.is_none_or(|named| named == **link)) {
            let depth = self.tree.joints_above(link)?.len();
            if self.moving_joint(link)? == Some(1) && deepest.is_none_or(|(deep, _)| deep < depth) {
                deepest = Some((depth, *link));
            }
        }
        let none = || CheckError::in_file(Input::World, "the second joint moves no link that can be the tip");
        deepest.map(|(_, link)| link).ok_or_else(none)
    }
}
