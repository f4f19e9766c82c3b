//! A world that the arm moves in: obstacles, what it carries, which pairs can meet, and the C-obstacles.

use super::arm::ShapeView;
use super::round::Grain;
use super::trace::TraceView;
use crate::check::CheckedProof;
use crate::cspace::CObstacle;
use crate::draw::color;
use crate::geometry::Convex;
use crate::model::{Grip, Obstacle, Pair, Region, Scene, Shape};
use crate::planner::Trace;
use crate::space::{Configuration, Topology};
use serde::Serialize;

/// An obstacle's shape as the user gave it; without one, it is the union of its pieces.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
enum OutlineView {
    Polygon(Vec<f64>),
    Circle([f64; 3]),
    Polyline(Vec<f64>),
    Pieces,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct ObstacleView {
    name: String,
    color: String,
    outline: OutlineView,
    /// How many of the pieces are the obstacle itself; those that follow are what a payload meets in their place: what
    /// a level one makes of them, which the tip must not enter, and supports, nearer than the clearance.
    own: usize,
    pieces: Vec<ShapeView>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
enum GripView {
    /// Coordinates and angle in link 2's frame.
    Rigid([f64; 3]),
    /// Angle in the plane, and the point at the tip.
    Level([f64; 3]),
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct PayloadView {
    object: String,
    color: String,
    /// In its own frame.
    pieces: Vec<ShapeView>,
    grip: GripView,
    /// What it is to link 2, in whose frame these are: parts that follow the link's own.
    parts: Vec<ShapeView>,
}

/// The contour of a part of a C-obstacle, one value after the other.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ContourView {
    obstacle: usize,
    link: usize,
    contour: Vec<f64>,
}

/// A region that fields prefer (negative) or avoid.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct RegionView {
    name: String,
    epsilon: f64,
    /// Whether the corners are configurations, rather than places of the tip.
    joints: bool,
    corners: Vec<f64>,
}

/// A world as the page draws it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorldView {
    /// What there is to say of it, in a word or two.
    label: String,
    clearance: f64,
    obstacles: Vec<ObstacleView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    payload: Option<PayloadView>,
    /// Which shapes can meet: link, part, obstacle, first piece, and the one after the last.
    pairs: Vec<[usize; 5]>,
    c_obstacles: Vec<ContourView>,
    regions: Vec<RegionView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace: Option<TraceView>,
    /// Boxes that prove that there is no path: least and greatest values of each.
    proof: Vec<f64>,
    /// Configurations that were to be reached and are not.
    unreached: Vec<[f64; 2]>,
}

impl WorldView {
    /// A scene, what there is to say of it, and the contours of its C-obstacles.
    pub fn new(scene: &Scene, label: String, c_obstacles: &[CObstacle], grain: Grain) -> Self {
        let contour = |c: &CObstacle| ContourView {
            obstacle: c.obstacle,
            link: c.link,
            contour: grain.configurations(c.contour.iter().map(|p| &p.coords)),
        };
        let obstacles = scene.workspace().obstacles.iter().enumerate();
        Self {
            label,
            clearance: scene.workspace().clearance,
            obstacles: obstacles.map(|(number, o)| obstacle(scene, number, o, grain)).collect(),
            payload: payload(scene, grain),
            pairs: ranges(scene.pairs()),
            c_obstacles: c_obstacles.iter().map(contour).collect(),
            regions: regions(scene, grain),
            trace: None,
            proof: Vec::new(),
            unreached: Vec::new(),
        }
    }

    /// The same with what a planner saw.
    pub fn traced(self, trace: &Trace, topology: &Topology, grain: Grain) -> Self {
        Self { trace: TraceView::new(trace, topology, grain), ..self }
    }

    /// The same with configurations that are not reached.
    pub fn without(self, unreached: Vec<[f64; 2]>) -> Self {
        Self { unreached, ..self }
    }

    /// The same with proofs.
    pub fn proven<'a>(self, proofs: impl IntoIterator<Item = &'a CheckedProof>, grain: Grain) -> Self {
        let boxes =
            proofs.into_iter().flat_map(CheckedProof::stuck).flat_map(|stuck| [stuck.cell.lower, stuck.cell.upper]);
        Self { proof: boxes.flat_map(|corner| grain.configuration(Configuration::from(corner))).collect(), ..self }
    }
}

fn obstacle(scene: &Scene, number: usize, obstacle: &Obstacle, grain: Grain) -> ObstacleView {
    let own = obstacle.pieces.len();
    let last = scene.pairs().iter().filter(|pair| pair.obstacle == number).map(|pair| pair.piece + 1).max();
    let made = (own..last.unwrap_or(own)).map(|piece| scene.piece(Pair { link: 1, part: 0, obstacle: number, piece }));
    ObstacleView {
        name: obstacle.name.clone(),
        color: color::obstacle(number).to_string(),
        outline: match &obstacle.shape {
            Shape::Polygon(corners) => OutlineView::Polygon(grain.points(corners)),
            Shape::Circle { center, radius } => {
                let [x, y] = grain.point(*center);
                OutlineView::Circle([x, y, grain.length(*radius)])
            }
            Shape::Polyline(points) => OutlineView::Polyline(grain.points(points)),
            Shape::Pieces => OutlineView::Pieces,
        },
        own,
        pieces: obstacle.pieces.iter().chain(made).map(|piece| ShapeView::new(piece, grain)).collect(),
    }
}

fn payload(scene: &Scene, grain: Grain) -> Option<PayloadView> {
    let payload = scene.payload()?;
    let shapes = |pieces: &[Convex]| pieces.iter().map(|piece| ShapeView::new(piece, grain)).collect();
    let own = scene.own_parts(1).len();
    Some(PayloadView {
        object: payload.object.clone(),
        color: crate::draw::arm::payload_color(scene).to_string(),
        pieces: shapes(&payload.pieces),
        grip: match payload.grip {
            Grip::Rigid(pose) => GripView::Rigid(
                [pose.translation.x, pose.translation.y, pose.rotation.angle()].map(|x| grain.number(x)),
            ),
            Grip::Level { angle, point } => GripView::Level([angle, point.x, point.y].map(|x| grain.number(x))),
        },
        parts: scene.arm().links[1].parts[own..].iter().map(|part| ShapeView::new(&part.shape, grain)).collect(),
    })
}

/// Pairs with consecutive pieces as one.
fn ranges(pairs: &[Pair]) -> Vec<[usize; 5]> {
    let mut ranges: Vec<[usize; 5]> = Vec::new();
    for pair in pairs {
        match ranges.last_mut() {
            Some([link, part, obstacle, _, end])
                if [*link, *part, *obstacle, *end] == [pair.link, pair.part, pair.obstacle, pair.piece] =>
            {
                *end += 1;
            }
            _ => ranges.push([pair.link, pair.part, pair.obstacle, pair.piece, pair.piece + 1]),
        }
    }
    ranges
}

fn regions(scene: &Scene, grain: Grain) -> Vec<RegionView> {
    let preferences = scene.workspace().preferences.iter();
    let region = |preference: &crate::model::Preference| {
        let (joints, corners) = match &preference.region {
            Region::Configurations(polygon) => {
                (true, grain.configurations(polygon.corners().iter().map(|p| &p.coords)))
            }
            Region::Tip(polygon) => (false, grain.points(polygon.corners())),
        };
        RegionView { name: preference.name.clone(), epsilon: preference.epsilon, joints, corners }
    };
    preferences.map(region).collect()
}
