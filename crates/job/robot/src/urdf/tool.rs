//! The joints of the tool: the wrist, and the joint that lowers the tool.

use super::chain::{Chooser, is_movable};
use super::limits::Limits;
use super::plane::project;
use super::reduction::Reduction;
use super::tree;
use crate::Spanned;
use crate::error::Diagnostic;
use crate::quantity::{Length, Number};
use crate::stroke::{ArchTable, ArchValue, StrokeTable};
use cplan_handling::{Arch, Driver, RobotJoint, RobotJoints, Stroke, ToolJoint};
use cplan_model::{Plane, assumed_acceleration};
use nalgebra::Vector3;
use urdf_rs::JointType;

/// An axis counts as parallel to the plane's normal if the cosine of their angle differs from 1 by at most this. It covers
/// rounding.
pub(super) const PARALLEL_TOLERANCE: f64 = 1e-9;

/// The tip counts as on the wrist's axis within this distance, in metres. It covers rounding.
const AXIS_TOLERANCE: f64 = 1e-6;

/// A frame's x axis gives the direction of the tool if the axis's projection onto the plane is longer than this.
const LEAST_PROJECTION: f64 = 1e-3;

/// The function of a tool's joint.
#[derive(Clone, Copy, PartialEq)]
enum Tool {
    /// The joint lowers the tool.
    Stroke,
    /// The joint turns the tool.
    Wrist,
}

impl Tool {
    /// Returns the name of the joint's table in the world file.
    fn table(self) -> &'static str {
        match self {
            Self::Stroke => "stroke",
            Self::Wrist => "wrist",
        }
    }
}

impl Reduction<'_> {
    /// Returns the movable joints in the order of the file, and which of them move the tool.
    ///
    /// # Errors
    /// A stroke or wrist with an unsuitable joint, and mimic rules about joints that do not exist or about themselves.
    pub fn robot_joints(&self, plane: &Plane) -> Result<RobotJoints, Diagnostic> {
        let chooser = Chooser { document: self.document, tree: self.tree, settings: self.settings };
        let robot = &self.settings.table;
        // As a switch, `arch` also states whether the wrist turns during motions.
        let is_needless = |arch: &&Spanned<ArchValue>| {
            let is_switch = matches!(arch.get_ref(), ArchValue::Switch(_));
            robot.stroke.is_none() && !(is_switch && robot.wrist.is_some())
        };
        if let Some(arch) = robot.arch.as_ref().filter(is_needless) {
            let message = "[robot] arch needs a joint that lowers the tool";
            let help = "add stroke = { joint = \"NAME\" }, or remove arch";
            return Err(self.settings.source.diagnostic_at(arch.span(), message).help(help));
        }
        let stroke = robot.stroke.as_ref().map(|table| self.stroke(&chooser, table, plane)).transpose()?;
        let wrist = robot.wrist_joint().map(|name| self.tool_joint(&chooser, name, Tool::Wrist, plane)).transpose()?;
        let driver = |leader: usize| {
            let is = |joint: Option<&ToolJoint>| joint.is_some_and(|joint| joint.name == chooser.all()[leader].name);
            match self.chain.joints.iter().position(|chosen| *chosen == leader) {
                Some(k) => Driver::Planned(k),
                None if is(stroke.as_ref().map(|stroke| &stroke.joint)) => Driver::Stroke,
                None if is(wrist.as_ref()) => Driver::Wrist,
                None => Driver::Held(self.chain.values[leader]),
            }
        };
        let joints = chooser.all().iter().enumerate().filter(|(_, joint)| is_movable(joint));
        let joints = joints.map(|(index, joint)| {
            let (leader, factor, offset) = chooser.rule(index)?;
            let slides = joint.joint_type == JointType::Prismatic;
            Ok(RobotJoint { name: joint.name.clone(), driver: driver(leader), factor, offset, slides })
        });
        Ok(RobotJoints { joints: joints.collect::<Result<_, Diagnostic>>()?, stroke, wrist })
    }

    fn stroke(&self, chooser: &Chooser, table: &StrokeTable, plane: &Plane) -> Result<Stroke, Diagnostic> {
        let joint = self.tool_joint(chooser, &table.joint, Tool::Stroke, plane)?;
        let source = self.settings.source;
        let given = |number: &Option<Number>, what: &str, allowed: fn(f64) -> bool, how: &str| match number {
            None => Ok(None),
            Some(number) => match source.finite(number, &format!("[robot] stroke, {what}"))? {
                value if allowed(value) => Ok(Some(value)),
                value => {
                    let message = format!("[robot] stroke: {what} must be {how}, is {value}");
                    Err(source
                        .diagnostic_at(number.span(), message)
                        .help("stroke = { joint = \"NAME\", travel = 0.1 }, in metres"))
                }
            },
        };
        let travel = table.travel.as_ref().map(|travel| Number::new(travel.span(), travel.get_ref().0));
        let travel = given(&travel, "travel", |x| x != 0.0, "other than 0")?;
        let velocity = given(&table.velocity, "velocity", |x| x > 0.0, "positive")?;
        let acceleration = given(&table.acceleration, "acceleration", |x| x > 0.0, "positive")?;
        let jerk = given(&table.jerk, "jerk", |x| x > 0.0, "positive")?;
        let index = chooser.named(&table.joint, Tool::Stroke.table())?;
        let rates = Limits { document: self.document, settings: self.settings }.rates(index)?;
        let (velocity, own) = match velocity {
            Some(velocity) => (velocity, assumed_acceleration(velocity)),
            None => (rates.velocity, rates.acceleration),
        };
        let below = |link: &usize| self.tree.carries(index, *link);
        let bodies = (0..self.tree.links.len()).filter(below).map(|link| self.tree.links[link].clone()).collect();
        let (acceleration, arch) = (acceleration.unwrap_or(own), self.arch()?);
        Ok(Stroke { joint, travel, velocity, acceleration, jerk: jerk.or(rates.jerk), bodies, arch })
    }

    /// Returns the least heights at which strokes may overlap with motions. `None` if the arm is at rest during strokes.
    fn arch(&self) -> Result<Option<Arch>, Diagnostic> {
        let height = |number: &Option<Length>, what: &str| match number {
            None => Ok(0.0),
            Some(number) => match self.settings.source.finite(number, &format!("[robot] arch, {what}"))? {
                value if value >= 0.0 => Ok(value),
                value => {
                    let message = format!("[robot] arch: {what} must not be negative, is {value}");
                    let help = "arch = { rise = 0.02, fall = 0.02 }, in metres, or arch = false";
                    Err(self.settings.source.diagnostic_at(number.span(), message).help(help))
                }
            },
        };
        Ok(match self.settings.table.arch.as_ref().map(Spanned::get_ref) {
            Some(ArchValue::Switch(false)) => None,
            None | Some(ArchValue::Switch(true)) => Some(Arch::default()),
            Some(ArchValue::Heights(ArchTable { rise, fall })) => {
                Some(Arch { rise: height(rise, "rise")?, fall: height(fall, "fall")? })
            }
        })
    }

    /// Returns the name of a joint that mimics a joint of the tool and moves the tip or a link that can collide. `None` if there
    /// is none.
    fn follower_with_shapes(&self, chooser: &Chooser, leader: usize) -> Result<Option<String>, Diagnostic> {
        for (index, joint) in chooser.all().iter().enumerate().filter(|(_, joint)| joint.mimic.is_some()) {
            let counts = chooser.has_shapes(index) || self.tree.carries(index, self.chain.tip);
            if counts && chooser.leader(index)? == leader {
                return Ok(Some(joint.name.clone()));
            }
        }
        Ok(None)
    }

    /// Returns the joint that moves the tool along the plane's normal or turns it about the normal.
    ///
    /// # Errors
    /// An unsuitable joint.
    fn tool_joint(
        &self,
        chooser: &Chooser,
        name: &Spanned<String>,
        tool: Tool,
        plane: &Plane,
    ) -> Result<ToolJoint, Diagnostic> {
        let table = tool.table();
        let index = chooser.named(name, table)?;
        let joint = &chooser.all()[index];
        let diagnostic = |why: &str, help: &str| {
            let message = format!("[robot] {table}: joint \"{}\" {why}", joint.name);
            Err(chooser.in_world(name, message).help(help))
        };
        if self.chain.joints.contains(&index) {
            return diagnostic("is one of the two planned joints", "name a joint of the tool");
        }
        if let Some(mimic) = &joint.mimic {
            return diagnostic(&format!("mimics joint \"{}\"", mimic.joint), "name the mimicked joint instead");
        }
        match (tool, joint.joint_type == JointType::Prismatic) {
            (Tool::Stroke, false) => return diagnostic("turns", "a stroke needs a joint that slides"),
            (Tool::Wrist, true) => return diagnostic("slides", "a wrist needs a joint that turns"),
            _ => {}
        }
        let [_, second] = self.chain.joints;
        if !self.tree.carries(second, self.tree.child[index]) {
            let second = &chooser.all()[second].name;
            return diagnostic(&format!("is not carried by joint \"{second}\""), "name a joint of the tool");
        }
        if let Some(follower) = self.follower_with_shapes(chooser, index)? {
            let why = format!("is mimicked by joint \"{follower}\", but cplan would not move the links of that joint");
            return diagnostic(
                &why,
                "in a copy of the file, make that joint fixed, or remove the geometry of its links",
            );
        }
        let direction = self.poses[self.tree.child[index]] * tree::axis(joint);
        let along = direction.dot(&plane.normal);
        if along.abs() < 1.0 - PARALLEL_TOLERANCE {
            let why = "is not parallel to the normal of the plane that the arm moves in";
            return diagnostic(why, "name a joint of the tool whose axis is parallel to the normal");
        }
        let tip = self.chain.tip;
        let tip_link = &self.tree.links[tip];
        if !self.tree.carries(index, tip) {
            let why = format!("does not carry the tip \"{tip_link}\"");
            return diagnostic(&why, "name a joint of the tool, or another tip: [robot] tip = \"LINK\"");
        }
        let to_tip = self.poses[tip].translation.vector - self.poses[self.tree.child[index]].translation.vector;
        let off = (to_tip - plane.normal * to_tip.dot(&plane.normal)).norm();
        if tool == Tool::Wrist && off > AXIS_TOLERANCE {
            let why = format!("moves the tip \"{tip_link}\", which is {off:.2e} m away from the axis of the joint");
            return diagnostic(&why, "name a link on the axis: [robot] tip = \"LINK\"");
        }
        let axis = Limits { document: self.document, settings: self.settings }.planned_range(index)?;
        let [x, y] = [Vector3::x(), Vector3::y()].map(|axis| project(plane, &(self.poses[tip] * axis)));
        let seen = if x.norm() > LEAST_PROJECTION { x } else { y };
        Ok(ToolJoint {
            name: joint.name.clone(),
            rest: self.chain.values[index],
            sign: along.signum(),
            range: axis,
            direction: if tool == Tool::Wrist { seen.y.atan2(seen.x) } else { 0.0 },
        })
    }
}
