//! The report on a robot that may or may not be usable for planning.

use super::error::InputError;
use cplan_geometry::Point;
use cplan_handling::ObstacleTrajectory;
use cplan_model::space::JointRange;
use cplan_model::{Arm, Motors, OutlineSource, Scene};
use nalgebra::Vector3;
use serde::Serialize;
use std::path::PathBuf;

/// The report on a robot. Facts that defects of the file hide are empty or missing.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Inspection {
    /// The path of the URDF, as given.
    pub urdf: String,
    /// The world file, if one was given.
    pub world: Option<String>,
    /// The robot's name.
    pub robot: Option<String>,
    /// Root link. `None` if the links do not form a tree.
    pub root: Option<String>,
    /// Links, in the order of the file.
    pub links: Vec<LinkEntry>,
    /// Joints, in the order of the file.
    pub joints: Vec<JointEntry>,
    /// All pairs of independent joints of which the first carries the second, base first. Each entry states whether the pair
    /// forms a planar arm.
    pub pairs: Vec<PairEntry>,
    /// The two joints that the rest of the report describes, base to tip.
    pub chosen: Option<[String; 2]>,
    /// True if neither the world file nor the robot itself determines the joints. They are then the first pair that forms a
    /// planar arm.
    pub assumed: bool,
    /// Link whose origin is the tip.
    pub tip: Option<String>,
    /// The plane of motion.
    pub plane: Option<PlaneEntry>,
    /// Outlines of the two arm links. Empty if there are none.
    pub outlines: Vec<OutlineEntry>,
    /// Links of the robot that its other links can hit.
    pub self_obstacles: Vec<SelfObstacleEntry>,
    /// Reach of the arm.
    pub reach: Option<ReachEntry>,
    /// The motors of both joints. `None` if the world does not describe them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motors: Option<MotorEntry>,
    /// Ignored elements, with reasons.
    pub ignored: Vec<String>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// A table `[robot]` for the world file that makes the robot usable, unless other data is missing. Its ranges, speeds and
    /// radii are placeholders. `None` if no table is needed.
    #[serde(rename = "remedy")]
    pub help: Option<String>,
    /// Errors that prevent planning. Planning reports only the first of them.
    #[serde(skip)]
    pub errors: Vec<InputError>,
    /// The arm among the world's obstacles, for a picture. Assumed ranges and outlines replace missing ones.
    #[serde(skip)]
    pub scene: Option<Scene>,
    /// The trajectories of the scene's loose obstacles.
    #[serde(skip)]
    pub trajectories: Vec<ObstacleTrajectory>,
    /// Paths of the files that were read: the URDF, the files of its xacro, its meshes, and those of the world.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
    /// Frames, at the zero configuration, of the links that the two joints move, and of the tip's link.
    #[serde(skip)]
    pub frames: Vec<Frame>,
}

impl Inspection {
    /// Returns true if planning is possible.
    pub fn is_plannable(&self) -> bool {
        self.errors.is_empty()
    }
}

/// The motors of both joints, and the joint values that they allow.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotorEntry {
    /// Mounting of the elbow's motor, in words.
    #[serde(skip)]
    pub words: String,
    /// The motors. Limits that are those of a joint are not repeated here.
    #[serde(flatten)]
    pub motors: Motors,
    /// The least and the greatest value that each joint can take within the limits of all joints and motors, radians. `None`
    /// for a joint without limits.
    pub ranges: [Option<[f64; 2]>; 2],
}

impl MotorEntry {
    /// Describes the motors of an arm.
    pub(crate) fn new(arm: &Arm, words: String) -> Option<Self> {
        let motors = arm.motors?;
        let interval = |k: usize| match arm.joints[k].range {
            JointRange::Interval { lower, upper } => Some([lower, upper]),
            JointRange::Circle => None,
        };
        let mut ranges = [interval(0), interval(1)];
        if let (Some([least, most]), [Some(first), Some(second)], true) = (motors.range, ranges, motors.ratio != 0.0) {
            // For each value of joint 1, some value of joint 2 must give a sum within its range, and vice versa.
            let turned = [(least - second[1]) / motors.ratio, (most - second[0]) / motors.ratio];
            let own = first.map(|q1| motors.ratio * q1);
            ranges = [
                Some([first[0].max(turned[0].min(turned[1])), first[1].min(turned[0].max(turned[1]))]),
                Some([second[0].max(least - own[0].max(own[1])), second[1].min(most - own[0].min(own[1]))]),
            ];
        }
        Some(Self { words, motors, ranges })
    }
}

/// A URDF link.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinkEntry {
    /// The link's name in the URDF.
    pub name: String,
    /// The joint that moves the link. `None` for the root.
    pub above: Option<String>,
    /// Number of collision shapes.
    pub collision: usize,
    /// Number of visual shapes.
    pub visual: usize,
}

/// The role of a joint in the arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// One of the two planned joints.
    Moves,
    /// A joint on the chain or carried by it, kept at a constant value.
    Held,
    /// A joint carried by the arm, kept at the value that its mimic rule gives.
    Follows,
    /// A movable joint on which the arm does not depend.
    Ignored,
    /// A fixed joint, or a joint whose position is not a single value.
    Rigid,
    /// The role is unknown, because no two joints could be chosen.
    Undecided,
}

/// A URDF joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEntry {
    /// The joint's name in the URDF.
    pub name: String,
    /// Type of the joint, as in the file.
    #[serde(rename = "type")]
    pub kind: String,
    /// True for a prismatic joint, whose values are in metres; false for joints with values in radians.
    #[serde(skip)]
    pub slides: bool,
    /// Number of the joint's line in the URDF.
    pub line: usize,
    /// The link that carries the joint.
    pub parent: String,
    /// The link that the joint carries.
    pub child: String,
    /// Axis in the joint's own frame, of unit length. `None` for joints that cannot move.
    pub axis: Option<[f64; 3]>,
    /// Axis in the root frame, with the chosen joints at zero and the others at their constant values. `None` for joints that
    /// cannot move.
    pub direction: Option<[f64; 3]>,
    /// The joint that this joint mimics.
    pub mimics: Option<String>,
    /// The joint's role in the arm.
    pub role: Role,
    /// Value in the arm's zero configuration, radians or metres; `None` for rigid joints.
    pub value: Option<f64>,
    /// Range of the joint. `None` for joints that cannot move.
    pub limits: Option<LimitEntry>,
    /// Top speed, in rad/s or m/s. `None` for joints that cannot move or have no top speed.
    pub velocity: Option<RateEntry>,
    /// Acceleration limit, in rad/s² or m/s². `None` for joints without a top speed.
    pub acceleration: Option<RateEntry>,
    /// Jerk limit, in rad/s³ or m/s³. `None` for joints without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk: Option<RateEntry>,
}

/// The source of a joint's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitSource {
    /// The URDF's `<limit>`.
    Urdf,
    /// The URDF's `<limit>`, narrowed by the soft limits of the `<safety_controller>`.
    Soft,
    /// The key `limits` of `[robot]` in the world file.
    World,
    /// The joint is continuous, so it needs no range.
    Continuous,
    /// No known range is suitable for planning.
    Unset,
}

/// A joint's range, radians or metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LimitEntry {
    /// Source of the range.
    pub source: LimitSource,
    /// Least and greatest value. `None` for a continuous joint or a missing range.
    pub range: Option<[f64; 2]>,
}

/// The source of a top speed, an acceleration limit or a jerk limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RateSource {
    /// The URDF's `<limit>`.
    Urdf,
    /// The world file.
    World,
    /// Not stated. The assumed limit is proportional to the top speed.
    Default,
}

/// A top speed, acceleration or jerk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RateEntry {
    /// Value of the limit: radians or metres per second, per second squared or per second cubed.
    pub value: f64,
    /// Source of the value.
    pub source: RateSource,
}

/// Two joints of one chain, which may or may not form a planar arm.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairEntry {
    /// Names of the joints, base to tip.
    pub joints: [String; 2],
    /// `RR`, `RP`, `PR` or `PP`.
    pub kind: String,
    /// True if they form a planar arm.
    pub planar: bool,
    /// Description of the plane if they form a planar arm, otherwise the reason why they do not.
    pub reason: String,
}

/// The plane of motion, in the root frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlaneEntry {
    /// Direction of the first coordinate.
    pub u: [f64; 3],
    /// Direction of the second coordinate.
    pub v: [f64; 3],
    /// Direction in which heights increase.
    pub normal: [f64; 3],
    /// Description of the plane.
    pub words: String,
}

/// A link's outline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutlineEntry {
    /// The URDF link that the joint carries.
    pub link: String,
    /// Source of the shapes: `collision`, `visual`, `bar` or `none`.
    pub source: &'static str,
    /// Number of convex parts.
    pub parts: usize,
    /// Sum of the parts' areas, in square metres. Overlapping areas count twice.
    pub area: f64,
    /// Least and greatest height, in metres. `None` without parts.
    pub heights: Option<[f64; 2]>,
    /// The URDF links to which the parts belong.
    pub bodies: Vec<BodyEntry>,
}

/// The part of an outline that one URDF link contributes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyEntry {
    /// The URDF link.
    pub link: String,
    /// Number of convex parts.
    pub parts: usize,
    /// Sum of their areas, square metres.
    pub area: f64,
}

/// A link of the robot, or a layer of it, that links further along the chain can hit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SelfObstacleEntry {
    /// The URDF link.
    pub link: String,
    /// True if joint 1 carries the link; false if the link is fixed.
    pub moves: bool,
    /// Least and greatest height, in metres.
    pub heights: [f64; 2],
    /// Links further along the chain whose contact with this link is ignored, because the world file allows it, or because their
    /// shapes meet in every configuration.
    pub ignored: Vec<String>,
}

/// Reach of the arm.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReachEntry {
    /// Position of the tip at the zero configuration, in plane coordinates, in metres.
    pub tip: [f64; 2],
    /// Least and greatest distance of the tip from joint 1, without joint limits, in metres. `None` unless both joints are
    /// revolute.
    pub distances: Option<[f64; 2]>,
    /// Upper bound on the distance of any part of the arm from joint 1, in metres, with prismatic joints at zero.
    pub outline: f64,
}

/// A frame in plane coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Name of the joint, or of the tip's link.
    pub name: String,
    /// Origin in plane coordinates, in metres.
    pub at: Point,
    /// Directions of the axes x, y and z, by components along `u`, `v` and the normal.
    pub axes: [Vector3<f64>; 3],
}

pub(crate) fn source_name(source: OutlineSource) -> &'static str {
    match source {
        OutlineSource::Collision => "collision",
        OutlineSource::Visual => "visual",
        OutlineSource::Bar => "bar",
        OutlineSource::None => "none",
    }
}
