//! A world in which the arm moves: obstacles, payload, pairs of shapes that can meet, and C-obstacles.

use super::numbers::{Chain, RoundingSteps, ShapeView, number, outline};
use super::trace::{ScaleView, TraceView};
use cplan_geometry::{Convex, Point};
use cplan_handling::{ObstacleTrajectory, TimedScene};
use cplan_judge::CheckedProof;
use cplan_model::space::Configuration;
use cplan_model::{Carrier, Grip, LooseObstacle, Obstacle, Pair, Preference, Region, Scene, Shape};
use cplan_planners::cspace::{CObstacle, beyond_sum};
use cplan_theme::Rgb;
use serde::{Serialize, Serializer};

/// Largest number of obstacles that are named. If there are more, all are numbered.
pub const MAX_NAMED_OBSTACLES: usize = 16;

/// An obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObstacleView {
    /// Name.
    pub name: String,
    /// Colour, the same in both spaces.
    pub color: Rgb,
    /// Shape in the world file. If the file has none, it is the union of the pieces.
    #[serde(serialize_with = "outline")]
    pub outline: Shape,
    /// Number of pieces of the obstacle itself. Further pieces replace these in collisions with a payload. For a level payload,
    /// they are its Minkowski differences with the obstacle, which the tip must not enter. For supports, they are shapes that the
    /// payload may approach more closely than the clearance.
    own: usize,
    pieces: Vec<ShapeView>,
}

impl ObstacleView {
    /// Creates the view of obstacle `number` of a world.
    pub fn new(obstacle: &Obstacle, number: usize, grain: RoundingSteps) -> Self {
        Self {
            name: obstacle.name.clone(),
            color: cplan_theme::obstacle(number),
            outline: grain.outline(&obstacle.shape),
            own: obstacle.pieces.len(),
            pieces: obstacle.pieces.iter().map(|piece| grain.shape(piece)).collect(),
        }
    }

    /// Gives the obstacle the colour of the robot's links.
    fn of_robot(self) -> Self {
        Self { color: cplan_theme::ROBOT, ..self }
    }

    /// Creates the view of the limits of the elbow's motor, which are an obstacle only in the configuration space.
    fn of_motor() -> Self {
        let (outline, pieces) = (Shape::Pieces, Vec::new());
        Self { name: "elbow motor".into(), color: cplan_theme::ROBOT, outline, own: 0, pieces }
    }

    /// Returns the pieces of the obstacle itself. Empty for a carried object.
    pub fn own(&self) -> impl Iterator<Item = &Convex> {
        self.pieces[..self.own].iter().map(|piece| &piece.0)
    }

    /// Returns true if the obstacle has a place, and false for a carried object.
    pub fn lies(&self) -> bool {
        self.own > 0
    }
}

/// A moving obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MovingObstacleView {
    /// Shape in its own frame.
    #[serde(flatten)]
    pub obstacle: ObstacleView,
    /// Stops: time, both coordinates and angle of the frame.
    stops: Vec<[f64; 4]>,
    /// Velocity after the last stop, in m/s.
    velocity: [f64; 2],
    /// Time at which the arm picks the obstacle, in seconds. `None` if it never does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    #[serde(skip)]
    trajectory: ObstacleTrajectory,
}

impl MovingObstacleView {
    fn new(obstacle: &Obstacle, trajectory: &ObstacleTrajectory, color: usize, grain: RoundingSteps) -> Self {
        let velocity = trajectory.velocity();
        Self {
            obstacle: ObstacleView::new(obstacle, color, grain),
            stops: trajectory
                .stops()
                .iter()
                .map(|s| [number(s.time), grain.length(s.at.x), grain.length(s.at.y), number(s.angle)])
                .collect(),
            velocity: [grain.length(velocity.x), grain.length(velocity.y)],
            until: None,
            trajectory: trajectory.clone(),
        }
    }

    /// Returns the obstacle at its pose at a time.
    pub fn at(&self, time: f64) -> ObstacleView {
        let pose = self.trajectory.pose(time);
        let ObstacleView { name, color, outline, own, pieces } = &self.obstacle;
        let pieces = pieces.iter().map(|piece| ShapeView(piece.0.at(&pose))).collect();
        ObstacleView { name: name.clone(), color: *color, outline: outline.at(&pose), own: *own, pieces }
    }

    /// Returns the times at which the trajectory changes. The last one is the end of the motion, or of the pick if that is
    /// earlier.
    pub fn moments(&self, duration: f64) -> Vec<f64> {
        let duration = duration.min(self.until.unwrap_or(f64::INFINITY));
        let stops = self.trajectory.stops().iter().map(|stop| stop.time).filter(|&time| 0.0 < time && time < duration);
        stops.chain([duration]).collect()
    }

    /// Returns the origin of its frame at a time.
    pub fn origin(&self, time: f64) -> Point {
        self.trajectory.pose(time).translation
    }
}

/// The payload.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PayloadView {
    pub object: String,
    /// Colour of the object while it lies. An object that never lies has the next colour after those of all obstacles.
    pub color: Rgb,
    /// Shapes in its own frame.
    pub pieces: Vec<ShapeView>,
    #[serde(serialize_with = "grip")]
    pub grip: Grip,
    /// Shapes in the frame of link 2. Their numbers follow those of the link's parts.
    parts: Vec<ShapeView>,
}

impl PayloadView {
    /// Turns a level payload to an angle, in radians. Does nothing to a rigid payload.
    pub fn turn_to(&mut self, turned: f64) {
        if let Grip::Level { angle, .. } = &mut self.grip {
            *angle = turned;
        }
    }
}

/// Serialises a grip. For a rigid grip, it has coordinates and angle of the payload in the frame of link 2; for a level grip, the
/// payload's angle in the plane, and the point of the payload at the tip.
fn grip<S: Serializer>(grip: &Grip, serializer: S) -> Result<S::Ok, S::Error> {
    let (index, name, numbers) = match *grip {
        Grip::Rigid(pose) => (0, "rigid", [pose.translation.x, pose.translation.y, pose.rotation.angle()]),
        Grip::Level { angle, point } => (1, "level", [angle, point.x, point.y]),
    };
    serializer.serialize_newtype_variant("Grip", index, name, &numbers.map(number))
}

/// The contour of a part of a C-obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContourView {
    /// Index of the obstacle in the list of the world.
    pub obstacle: usize,
    link: usize,
    /// Corners.
    pub contour: Chain,
}

/// The C-obstacles of moving obstacles at a time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MomentView {
    /// Time, in seconds.
    pub time: f64,
    /// C-obstacles, each with the number of its moving obstacle.
    pub c_obstacles: Vec<ContourView>,
}

/// A region that fields seek (if `epsilon` is negative) or avoid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RegionView {
    name: String,
    pub epsilon: f64,
    /// True if the corners are configurations, false if they are positions of the tip.
    pub joints: bool,
    pub corners: Chain,
}

/// The content of a world in pictures and pages.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct WorldView {
    /// Description in a word or two.
    pub label: String,
    pub clearance: f64,
    pub obstacles: Vec<ObstacleView>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub movers: Vec<MovingObstacleView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload: Option<PayloadView>,
    /// Runs of pairs of shapes that can meet: the link, its part, the obstacle, and the range of the obstacle's pieces.
    pub pairs: Vec<[usize; 5]>,
    pub c_obstacles: Vec<ContourView>,
    /// C-obstacles of moving obstacles at some times.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moments: Vec<MomentView>,
    /// C-obstacles of obstacles into which link 2 may reach, as if it had to keep out of them. Pages do not need them, because
    /// they show one world at a time.
    #[serde(skip)]
    pub open: Vec<ContourView>,
    pub regions: Vec<RegionView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<TraceView>,
    /// Scale of the trace's colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<ScaleView>,
    /// Boxes that prove that there is no path: least and greatest values of each.
    pub proof: Chain,
    /// Goals that no motion reaches.
    pub unreached: Vec<[f64; 2]>,
}

impl WorldView {
    /// Creates the world of a scene, with its description and the contours of its C-obstacles.
    pub fn new(timed: TimedScene, label: String, c_obstacles: &[CObstacle], grain: RoundingSteps) -> Self {
        let scene = timed.scene;
        let standing = scene.workspace().obstacles.len();
        let links = scene.listed_self_obstacles();
        let shown = |number| shown_number(scene, &links, number);
        let in_view = c_obstacles.iter().map(|c| CObstacle { obstacle: shown(c.obstacle), ..c.clone() });
        let mut contours = contours(&in_view.collect::<Vec<_>>(), grain);
        let obstacles = (0..standing).map(|number| obstacle(scene, number, number, grain));
        let own = links.iter().map(|&number| obstacle(scene, number, shown(number), grain).of_robot());
        let mut obstacles: Vec<ObstacleView> = obstacles.chain(own).collect();
        let beyond = beyond_sum(&scene.arm().topology()).into_iter();
        let beyond = beyond.map(|contour| CObstacle { obstacle: obstacles.len(), link: 1, contour });
        let beyond: Vec<CObstacle> = beyond.collect();
        if !beyond.is_empty() {
            contours.extend(self::contours(&beyond, grain));
            obstacles.push(ObstacleView::of_motor());
        }
        Self {
            label,
            clearance: scene.workspace().clearance,
            movers: movers(timed, grain),
            payload: payload(scene, grain),
            pairs: ranges(scene, &links),
            obstacles,
            c_obstacles: contours,
            regions: scene.workspace().preferences.iter().map(|preference| region(preference, grain)).collect(),
            ..Self::default()
        }
    }

    /// Adds the C-obstacles of moving obstacles at several times. Their `obstacle` is the index of the moving obstacle.
    pub fn timed(self, moments: &[(f64, Vec<CObstacle>)], grain: RoundingSteps) -> Self {
        let moment =
            |(time, all): &(f64, Vec<CObstacle>)| MomentView { time: number(*time), c_obstacles: contours(all, grain) };
        Self { moments: moments.iter().map(moment).collect(), ..self }
    }

    /// Returns the last moment up to this time, if there is one.
    pub fn moment(&self, time: f64) -> Option<&MomentView> {
        let next = self.moments.partition_point(|moment| moment.time <= time);
        self.moments.get(next.saturating_sub(1))
    }

    /// Adds a planner's trace.
    pub fn traced(self, trace: Option<TraceView>) -> Self {
        let scale = trace.as_ref().and_then(TraceView::scale);
        Self { trace, scale, ..self }
    }

    /// Returns the name of an obstacle, or its number if there are many obstacles.
    pub fn called(&self, obstacle: usize) -> String {
        if self.obstacles.len() > MAX_NAMED_OBSTACLES {
            (obstacle + 1).to_string()
        } else {
            self.obstacles[obstacle].name.clone()
        }
    }

    /// Adds the boxes of proofs.
    pub fn proven<'a>(self, proofs: impl IntoIterator<Item = &'a CheckedProof>, grain: RoundingSteps) -> Self {
        let boxes =
            proofs.into_iter().flat_map(CheckedProof::collision_boxes).flat_map(|s| [s.cell.lower, s.cell.upper]);
        let corners: Vec<_> = boxes.map(Configuration::from).collect();
        Self { proof: grain.configurations(&corners), ..self }
    }
}

/// Rounds contours for the document.
pub fn contours<'a>(all: impl IntoIterator<Item = &'a CObstacle>, grain: RoundingSteps) -> Vec<ContourView> {
    let contour =
        |c: &CObstacle| ContourView { obstacle: c.obstacle, link: c.link, contour: grain.configurations(&c.contour) };
    all.into_iter().map(contour).collect()
}

/// Returns the index of an obstacle or a link in the list of a view.
pub fn listed_number(scene: &Scene, number: usize) -> usize {
    shown_number(scene, &scene.listed_self_obstacles(), number)
}

/// Returns the index of an obstacle in the view's list, in which the robot's links follow the obstacles of the workspace. Moving
/// obstacles have their own list.
fn shown_number(scene: &Scene, links: &[usize], number: usize) -> usize {
    links.binary_search(&number).map_or(number, |k| scene.workspace().obstacles.len() + k)
}

/// Creates the view of an obstacle from its indices in the scene and in the view. An obstacle on link 1 has no fixed place.
fn obstacle(scene: &Scene, number: usize, shown: usize, grain: RoundingSteps) -> ObstacleView {
    let mut view = ObstacleView::new(scene.obstacle(number), shown, grain);
    if scene.self_obstacle(number).is_some_and(|own| own.carrier == Carrier::FirstJoint) {
        view.own = 0;
    }
    let last = scene.pairs().iter().filter(|pair| pair.obstacle == number).map(|pair| pair.piece + 1).max();
    let made = (view.own..last.unwrap_or(view.own))
        .map(|piece| scene.piece(Pair { link: 1, part: 0, obstacle: number, piece }));
    view.pieces.extend(made.map(|piece| grain.shape(piece)));
    view
}

/// Returns the moving obstacles. Their colours follow those of static obstacles; a moving object keeps the colour that it has
/// when it lies.
fn movers(TimedScene { scene, trajectories }: TimedScene, grain: RoundingSteps) -> Vec<MovingObstacleView> {
    let obstacles = &scene.workspace().obstacles;
    let view =
        |(number, (LooseObstacle { obstacle, .. }, trajectory)): (usize, (&LooseObstacle, &ObstacleTrajectory))| {
            let lying = obstacles.iter().position(|o| o.pieces.is_empty() && o.name == obstacle.name);
            MovingObstacleView::new(obstacle, trajectory, lying.unwrap_or(obstacles.len() + number), grain)
        };
    scene.loose_obstacles().iter().zip(trajectories).enumerate().map(view).collect()
}

fn payload(scene: &Scene, grain: RoundingSteps) -> Option<PayloadView> {
    let payload = scene.attachment()?;
    let obstacles = &scene.workspace().obstacles;
    let lying = obstacles.iter().position(|o| o.name == payload.name);
    let own = scene.own_parts(1).len();
    Some(PayloadView {
        object: payload.name.clone(),
        color: cplan_theme::obstacle(lying.unwrap_or(obstacles.len())),
        pieces: payload.pieces().map(|piece| grain.shape(piece)).collect(),
        grip: payload.grip,
        parts: scene.arm().links[1].parts[own..].iter().map(|part| grain.shape(&part.shape)).collect(),
    })
}

/// Merges consecutive pairs of the same part with consecutive pieces of one obstacle.
fn ranges(scene: &Scene, links: &[usize]) -> Vec<[usize; 5]> {
    let mut ranges: Vec<[usize; 5]> = Vec::new();
    for pair in scene.pairs() {
        let pair = Pair { obstacle: shown_number(scene, links, pair.obstacle), ..*pair };
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

fn region(preference: &Preference, grain: RoundingSteps) -> RegionView {
    let (joints, polygon) = match &preference.region {
        Region::Configurations(polygon) => (true, polygon),
        Region::Tip(polygon) => (false, polygon),
    };
    let corner = |&p: &Point| if joints { grain.configuration(p).into() } else { grain.point(p) };
    let corners = Chain(polygon.corners().iter().map(corner).collect());
    RegionView { name: preference.name.clone(), epsilon: preference.epsilon, joints, corners }
}
