//! Findings about a configuration, as data.

use cplan_geometry::{CornerInside, Point, polygon_test, shapes_meet};
use cplan_model::space::Configuration;
use cplan_model::{Contact, Scene};
use cplan_planners::cspace::{NearestFree, nearest_free};
use nalgebra::Vector3;
use serde::Serialize;

/// Findings about one configuration.
#[derive(Debug, Clone, Serialize)]
pub struct ConfigurationFindings {
    /// True if the configuration is within the limits and keeps the required clearance.
    pub free: bool,
    /// Joint values, base to tip.
    pub configuration: [f64; 2],
    /// For each joint, true if it is within its limits.
    pub within_limits: [bool; 2],
    /// The motors; `None` if they are unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motors: Option<MotorFinding>,
    /// Position of the tip in plane coordinates, in metres.
    pub tip: [f64; 2],
    /// Least signed distance to an obstacle, in metres; negative if the arm penetrates it. `None` if no obstacle is
    /// within reach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// The required clearance, metres.
    pub required: f64,
    /// The plane of motion.
    pub plane: BasisFinding,
    /// All pairs in contact, or nearer than the required clearance.
    pub contacts: Vec<PairFinding>,
    /// The nearest free configuration, unless this one is free.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_free: Option<NearestFinding>,
}

/// The shafts of both motors.
#[derive(Debug, Clone, Serialize)]
pub struct MotorFinding {
    /// Angles, radians.
    pub angles: [f64; 2],
    /// False if the joint values are within the limits of both joints, but not of the elbow's motor on the base.
    pub within_limits: bool,
}

/// The nearest free configuration, within the limits and with the required clearance.
#[derive(Debug, Clone, Serialize)]
pub struct NearestFinding {
    /// Joint values, base to tip.
    pub configuration: [f64; 2],
    /// Distance in joint space. Radians and metres are added as numbers.
    pub distance: f64,
    /// Least distance to an obstacle, metres. `None` if no obstacle is within reach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
    /// Spacing of the tried values of joint 1, before refinement. For each of them, joint 2 is exact.
    pub resolution: f64,
}

/// The plane's basis in the root frame.
#[derive(Debug, Clone, Serialize)]
pub struct BasisFinding {
    /// Direction of the first coordinate.
    pub u: [f64; 3],
    /// Direction of the second coordinate.
    pub v: [f64; 3],
    /// Direction in which heights increase.
    pub normal: [f64; 3],
}

/// A link and an obstacle that are in contact, or nearer than the required clearance.
#[derive(Debug, Clone, Serialize)]
pub struct PairFinding {
    /// Name of the arm's link.
    pub link: String,
    /// Name of the URDF link whose shape is in contact. It is part of the arm's link.
    pub body: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// True if link and obstacle have a point in common.
    pub touching: bool,
    /// Penetration depth, metres. A distance is negative.
    pub depth: f64,
    /// The distance that the two must keep, metres: the clearance, and what the stated errors require.
    pub required: f64,
    /// Description of this distance.
    #[serde(skip)]
    pub least: String,
    /// Corners of the link that lie in the obstacle. Empty for rounded shapes.
    pub link_corners_inside: Vec<CornerFinding>,
    /// Corners of the obstacle that lie in the link. Empty for rounded shapes.
    pub obstacle_corners_inside: Vec<CornerFinding>,
    /// Pairs of sides that cross, the link's and the obstacle's, each given by its two corners.
    pub crossing_sides: Vec<[[[f64; 2]; 2]; 2]>,
}

/// A corner of one shape that lies in the other shape.
#[derive(Debug, Clone, Serialize)]
pub struct CornerFinding {
    /// Plane coordinates, metres.
    pub at: [f64; 2],
    /// Distance of the corner from the nearest side of the other shape, in metres.
    pub depth: f64,
}

/// Checks a configuration.
pub fn check(scene: &Scene, q: Configuration) -> ConfigurationFindings {
    let topology = scene.arm().topology();
    let within_limits = [0, 1].map(|k| topology.ranges[k].contains(q[k]));
    let required = scene.workspace().clearance;
    let contacts: Vec<PairFinding> = scene.separations(q).filter_map(|contact| finding(scene, q, contact)).collect();
    let motors = scene.arm().motors.map(|motors| MotorFinding {
        angles: motors.angles(q),
        within_limits: topology.sum.is_none_or(|sum| sum.contains(q)),
    });
    let free = topology.contains(q) && contacts.is_empty();
    let nearest = if free { None } else { nearest_free(scene, q) };
    let plane = scene.arm().plane;
    let array = |v: Vector3<f64>| [v.x, v.y, v.z];
    ConfigurationFindings {
        free,
        configuration: [q[0], q[1]],
        within_limits,
        motors,
        tip: pair(scene.arm().tip_at(q)),
        clearance: Some(scene.drawn().clearance(q)).filter(|c| c.is_finite()),
        required,
        plane: BasisFinding { u: array(plane.u), v: array(plane.v), normal: array(plane.normal) },
        contacts,
        nearest_free: nearest.map(|found: NearestFree| NearestFinding {
            configuration: [found.configuration[0], found.configuration[1]],
            distance: found.distance,
            clearance: Some(found.clearance).filter(|c| c.is_finite()),
            resolution: found.spacing,
        }),
    }
}

/// Describes a pair of shapes. `None` if they keep the required clearance.
fn finding(scene: &Scene, q: Configuration, contact: Contact) -> Option<PairFinding> {
    let Contact { pair: indices, separation } = contact;
    let at = scene.arm().pose(indices.link, q);
    if !shapes_meet(&scene.part(indices).at(&at), scene.piece(indices))
        && separation.distance >= scene.workspace().clearance
    {
        return None;
    }
    let drawn = scene.drawn();
    let (part, piece) = (drawn.part(indices).at(&at), drawn.piece(indices));
    let touching = shapes_meet(&part, piece);
    let (a, b) = (part.core(), piece.core());
    // Only polygons have corners and sides. For rounded shapes, the depth suffices.
    let sharp = part.radius() == 0.0 && piece.radius() == 0.0;
    let test = sharp.then(|| polygon_test(&part, piece));
    let inside = |corners: &[Point], found: &[CornerInside]| {
        found.iter().map(|c| CornerFinding { at: pair(corners[c.corner]), depth: c.depth }).collect()
    };
    let side = |corners: &[Point], i: usize| [pair(corners[i]), pair(corners[(i + 1) % corners.len()])];
    let link = scene.link(indices);
    Some(PairFinding {
        link: link.name.clone(),
        body: link.parts[indices.part].body.clone(),
        obstacle: scene.obstacle_name(indices).to_owned(),
        touching,
        depth: -scene.real_distance(&contact),
        required: scene.required(indices),
        least: scene.describe_required(indices),
        link_corners_inside: test.as_ref().map_or_else(Vec::new, |t| inside(a, &t.a_inside)),
        obstacle_corners_inside: test.as_ref().map_or_else(Vec::new, |t| inside(b, &t.b_inside)),
        crossing_sides: test
            .map_or_else(Vec::new, |t| t.crossings.iter().map(|&(i, k)| [side(a, i), side(b, k)]).collect()),
    })
}

fn pair(p: Point) -> [f64; 2] {
    [p.x, p.y]
}
