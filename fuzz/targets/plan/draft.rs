//! Small scenes from arbitrary bytes: coarse coordinates, so that shapes touch, coincide and line up often.

use arbitrary::Arbitrary;
use cplan::geometry::{Convex, Point, Vector, hull};
use cplan::model::{
    Arm, Growth, Heights, Joint, JointType, Link, MotionProblem, Obstacle, OutlineSource, Part, Plane, Scene, Shape,
    Workspace,
};
use cplan::space::{Configuration, GoalSet, JointRange};
use nalgebra::Vector3;

#[derive(Arbitrary, Debug)]
struct JointDraft {
    turns: bool,
    circle: bool,
    reversed: bool,
    /// Direction of a slide.
    direction: (i8, i8),
    lower: u8,
    upper: u8,
}

#[derive(Arbitrary, Debug)]
struct ShapeDraft {
    corners: [(i8, i8); 5],
    count: u8,
    radius: u8,
    height: u8,
}

#[derive(Arbitrary, Debug)]
pub struct Draft {
    joints: [JointDraft; 2],
    offset: (i8, i8),
    base: (i8, i8),
    links: [(u8, [ShapeDraft; 2]); 2],
    obstacles: [ShapeDraft; 6],
    count: u8,
    clearance: u8,
    start: (i16, i16),
    goals: [(i16, i16); 2],
    pub method: u8,
}

/// Converts a number of sixteenths to a length. Such lengths are exact, and many of them are equal.
fn length(x: i8) -> f64 {
    f64::from(x) / 16.0
}

fn vector((x, y): (i8, i8), scale: f64) -> Vector {
    Vector::new(length(x), length(y)) * scale
}

impl ShapeDraft {
    fn shape(&self, scale: f64) -> Convex {
        let count = 1 + usize::from(self.count) % 5;
        let points: Vec<Point> = self.corners[..count].iter().map(|&p| vector(p, scale)).collect();
        let radius = if self.radius < 128 { 0.0 } else { f64::from(self.radius - 128) / 512.0 };
        Convex::new(hull(&points), radius).expect("a hull is convex")
    }

    fn heights(&self) -> Heights {
        match self.height {
            0..240 => Heights::ALL,
            h => Heights { lower: f64::from(h % 4), upper: f64::from(h % 4) + 1.0 },
        }
    }
}

impl JointDraft {
    fn joint(&self, name: &str) -> Option<Joint> {
        let span = |scale: f64| JointRange::Interval {
            lower: -f64::from(self.lower) * scale,
            upper: (1.0 + f64::from(self.upper)) * scale,
        };
        let (motion, axis) = if self.turns {
            let axis = if self.circle { JointRange::Circle } else { span(1.0 / 64.0) };
            (JointType::Revolute { sign: if self.reversed { -1.0 } else { 1.0 } }, axis)
        } else {
            let direction = Vector::new(f64::from(self.direction.0), f64::from(self.direction.1)).try_normalize(0.0)?;
            (JointType::Prismatic { direction }, span(1.0 / 128.0))
        };
        Some(Joint { name: name.into(), joint_type: motion, range: axis, velocity: 1.0, acceleration: 1.0, jerk: None })
    }
}

impl Draft {
    /// Returns the problem. Returns `None` unless its start and a goal are free.
    pub fn problem(&self) -> Option<MotionProblem> {
        let [a, b] = &self.joints;
        let joints = [a.joint("one")?, b.joint("two")?];
        let link = |(count, shapes): &(u8, [ShapeDraft; 2]), name: &str| {
            let parts = shapes.iter().take(usize::from(*count) % 3);
            let part = |s: &ShapeDraft| Part {
                shape: s.shape(0.125),
                inner: None,
                padding: 0.0,
                number: 0,
                is_visual: false,
                heights: s.heights(),
                body: name.into(),
            };
            Link { name: name.into(), parts: parts.map(part).collect(), source: OutlineSource::Collision }
        };
        let arm = Arm {
            name: "draft".into(),
            joints,
            links: [link(&self.links[0], "first"), link(&self.links[1], "second")],
            base: vector(self.base, 0.125),
            offset: vector(self.offset, 0.125),
            tip: Point::new(0.5, 0.0),
            tip_name: "tip".into(),
            plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
            dynamics: None,
            motors: None,
            self_obstacles: Vec::new(),
        };
        let obstacle = |s: &ShapeDraft| {
            let piece = s.shape(0.25);
            Obstacle {
                name: "obstacle".into(),
                shape: Shape::Polygon(piece.core().to_vec()),
                pieces: vec![piece],
                heights: s.heights(),
                growth: Growth::default(),
            }
        };
        let obstacles = self.obstacles.iter().take(usize::from(self.count) % 7).map(obstacle).collect();
        let clearance = if self.clearance < 192 { 0.0 } else { f64::from(self.clearance - 192) / 1024.0 };
        let scene = Scene::new(arm, Workspace { name: "draft".into(), obstacles, clearance, preferences: Vec::new() });
        let scene = scene.ok()?;
        let topology = scene.arm().topology();
        let place = |(a, b): (i16, i16)| {
            Configuration::from_fn(|k, _| {
                let (lower, upper) = topology.ranges[k].domain();
                let share = (f64::from([a, b][k]) + 32768.0) / 65535.0;
                (lower + (upper - lower) * share).clamp(lower, upper)
            })
        };
        let free = |q: &Configuration| scene.clearance(*q) > clearance;
        let start = Some(place(self.start)).filter(free)?;
        let goals: Vec<Configuration> = self.goals.iter().map(|&g| place(g)).filter(free).collect();
        if goals.is_empty() {
            return None;
        }
        Some(MotionProblem::new(scene, start, goals.into_iter().collect::<GoalSet>()).expect("its ends are free"))
    }
}
