//! Report on a robot, usable for planning or not.

use super::error::InputError;
use cplan_core::model::{OutlineSource, Scene};
use cplan_geometry::Point;
use cplan_handling::ObstacleTrajectory;
use nalgebra::Vector3;
use serde::Serialize;
use std::path::PathBuf;

/// The report on a robot. Facts that are unknown because of defects in the file are empty or missing.
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
    /// Every two joints of a chain that move on their own, and whether they form a planar arm; base first.
    pub pairs: Vec<PairEntry>,
    /// The two joints that the rest of the report is about, base to tip.
    pub chosen: Option<[String; 2]>,
    /// True if the joints were not chosen: they are the first pair that forms a planar arm.
    pub assumed: bool,
    /// Link whose origin is the tip.
    pub tip: Option<String>,
    /// The plane of motion.
    pub plane: Option<PlaneEntry>,
    /// Outlines of the two links, if they could be made.
    pub outlines: Vec<OutlineEntry>,
    /// Links of the robot that its other links can hit.
    pub self_obstacles: Vec<SelfObstacleEntry>,
    /// Reach of the arm.
    pub reach: Option<ReachEntry>,
    /// Ignored elements, with reasons.
    pub ignored: Vec<String>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// A `[robot]` table for the world file with which the robot loads, if nothing else is missing. Ranges, speeds and
    /// radii in it are placeholders.
    #[serde(rename = "remedy")]
    pub help: Option<String>,
    /// Errors that prevent planning, in the order of the stages. Planning would report the first one.
    #[serde(skip)]
    pub errors: Vec<InputError>,
    /// The arm among the world's obstacles, for a picture. Missing ranges and outlines are replaced by assumed ones.
    #[serde(skip)]
    pub scene: Option<Scene>,
    /// The trajectories of the scene's loose obstacles.
    #[serde(skip)]
    pub courses: Vec<ObstacleTrajectory>,
    /// Paths of the files that were read: the URDF, the files of its xacro, its meshes, and those of the world.
    #[serde(skip)]
    pub files: Vec<PathBuf>,
    /// Frames of the two joints' links and of the tip's link at the zero configuration.
    #[serde(skip)]
    pub frames: Vec<Frame>,
}

impl Inspection {
    /// Returns true if planning is possible.
    #[must_use]
    pub fn is_plannable(&self) -> bool {
        self.errors.is_empty()
    }
}

/// A URDF link.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinkEntry {
    /// The link's name in the URDF.
    pub name: String,
    /// The joint above it; `None` for the root.
    pub above: Option<String>,
    /// Number of collision shapes.
    pub collision: usize,
    /// Number of visual shapes.
    pub visual: usize,
}

/// Role of a joint in the arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// One of the two planned joints.
    Moves,
    /// On the chain or carried by it, and held still.
    Held,
    /// Carried by the arm and held where its mimic puts it.
    Follows,
    /// Can move, but the arm does not depend on it.
    Ignored,
    /// A fixed joint, or another type without a single value.
    Rigid,
    /// Unknown, because no two joints could be chosen.
    Undecided,
}

/// A URDF joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointEntry {
    /// The joint's name in the URDF.
    pub name: String,
    /// Joint type in the words of the file.
    #[serde(rename = "type")]
    pub kind: String,
    /// True for a prismatic joint, whose values are metres, not radians.
    #[serde(skip)]
    pub slides: bool,
    /// Line of the URDF.
    pub line: usize,
    /// The link that carries the joint.
    pub parent: String,
    /// The link that the joint carries.
    pub child: String,
    /// For movable joints: axis in the joint's own frame, of unit length.
    pub axis: Option<[f64; 3]>,
    /// The axis in the root frame, with the chosen joints at zero and the others at their held values.
    pub direction: Option<[f64; 3]>,
    /// The joint that it mimics.
    pub mimics: Option<String>,
    /// Role in the arm.
    pub role: Role,
    /// Value in the arm's zero configuration, radians or metres; `None` for rigid joints.
    pub value: Option<f64>,
    /// For movable joints: range.
    pub limits: Option<LimitEntry>,
    /// For movable joints: top speed, per second, if there is one.
    pub velocity: Option<RateEntry>,
    /// For movable joints with a top speed: acceleration, per second squared.
    pub acceleration: Option<RateEntry>,
    /// For movable joints with a jerk limit: jerk, per second cubed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk: Option<RateEntry>,
}

/// Source of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitSource {
    /// The URDF's `<limit>`.
    Urdf,
    /// The URDF's `<limit>`, narrowed by the soft limits of the `<safety_controller>`.
    Soft,
    /// `[robot] limits` of the world file.
    World,
    /// A continuous joint.
    Continuous,
    /// No range suitable for planning is given.
    Unset,
}

/// A joint's range, radians or metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LimitEntry {
    /// Source of the range.
    pub source: LimitSource,
    /// Both ends; `None` if it is continuous or unset.
    pub range: Option<[f64; 2]>,
}

/// Source of a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RateSource {
    /// The URDF's `<limit>`.
    Urdf,
    /// The world file.
    World,
    /// Not given; assumed in proportion to the top speed.
    Default,
}

/// A top speed, acceleration or jerk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RateEntry {
    /// Per second, per second squared or cubed; radians or metres.
    pub value: f64,
    /// Source of the rate.
    pub source: RateSource,
}

/// Two joints of one chain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairEntry {
    /// Base to tip.
    pub joints: [String; 2],
    /// `RR`, `RP`, `PR` or `PP`.
    pub kind: String,
    /// True if they form a planar arm.
    pub planar: bool,
    /// The plane if they do, otherwise the reason why not.
    pub reason: String,
}

/// The plane of motion, in the root frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlaneEntry {
    /// First coordinate's direction.
    pub u: [f64; 3],
    /// Second coordinate's direction.
    pub v: [f64; 3],
    /// Direction of heights.
    pub normal: [f64; 3],
    /// The plane as text.
    pub words: String,
}

/// A link's outline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutlineEntry {
    /// The link that the joint carries.
    pub link: String,
    /// `collision`, `visual`, `bar` or `none`.
    pub source: &'static str,
    /// Number of convex parts.
    pub parts: usize,
    /// Sum of the parts' areas, square metres; areas that two parts share count twice.
    pub area: f64,
    /// Extent along the plane's normal, metres; `None` without parts.
    pub heights: Option<[f64; 2]>,
    /// The URDF links that the parts belong to.
    pub bodies: Vec<BodyEntry>,
}

/// Contribution of a URDF link to an outline.
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
    /// True if joint 1 carries it; otherwise it is fixed.
    pub moves: bool,
    /// Extent along the plane's normal, metres.
    pub heights: [f64; 2],
    /// URDF links further along the chain that are free to meet it.
    pub ignored: Vec<String>,
}

/// Reach of the arm.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReachEntry {
    /// The tip at the zero configuration, plane coordinates, metres.
    pub tip: [f64; 2],
    /// For two revolute joints: least and greatest distance of the tip from joint 1 without limits, metres.
    pub distances: Option<[f64; 2]>,
    /// Bound on the distance of any part of the arm from joint 1 with prismatic joints at zero, metres.
    pub outline: f64,
}

/// A frame in plane coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Name of the joint, or of the tip's link.
    pub name: String,
    /// Origin, plane coordinates.
    pub at: Point,
    /// Directions of x, y and z: along `u`, `v` and the normal.
    pub axes: [Vector3<f64>; 3],
}

/// Returns the word for an outline's source.
pub(crate) fn source_name(source: OutlineSource) -> &'static str {
    match source {
        OutlineSource::Collision => "collision",
        OutlineSource::Visual => "visual",
        OutlineSource::Bar => "bar",
        OutlineSource::None => "none",
    }
}
