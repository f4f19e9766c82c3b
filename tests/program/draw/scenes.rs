//! Made-up arms and obstacles.

use cplan::geometry::{Convex, Point, Vector};
use cplan::model::{Arm, Growth, Heights, JointType, Obstacle, Scene, Shape, Workspace};
use cplan::space::JointRange;
use cplan_testkit::arms::{self, joint, link};
use cplan_testkit::scenes::placed;
use cplan_testkit::shapes::{self, convex, disc};

pub const TURN: JointType = JointType::Revolute { sign: 1.0 };

pub fn slide(x: f64, y: f64) -> JointType {
    JointType::Prismatic { direction: Vector::new(x, y) }
}

pub fn interval(lower: f64, upper: f64) -> JointRange {
    JointRange::Interval { lower, upper }
}

/// Returns an arm whose links are bars along x.
pub fn arm(
    names: [&str; 2],
    motions: [JointType; 2],
    axes: [JointRange; 2],
    lengths: [f64; 2],
    [first, second]: [Convex; 2],
) -> Arm {
    let joints = [0, 1].map(|k| joint(names[k], motions[k], axes[k]));
    let links = [link("link0", vec![first]), link("link1", vec![second])];
    arms::arm(joints, links, Vector::new(lengths[0], 0.0), Point::new(lengths[1], 0.0))
}

pub fn capsule(length: f64, radius: f64) -> Convex {
    shapes::wall(Point::zeros(), Point::new(length, 0.0)).grown(radius)
}

pub fn block(x0: f64, y0: f64, x1: f64, y1: f64) -> Convex {
    convex(vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)], 0.0)
}

pub fn polygon(name: &str, corners: &[(f64, f64)]) -> Obstacle {
    let corners: Vec<Point> = corners.iter().map(|c| Point::new(c.0, c.1)).collect();
    obstacle(name, Shape::Polygon(corners.clone()), vec![convex(corners, 0.0)])
}

pub fn circle(name: &str, x: f64, y: f64, radius: f64) -> Obstacle {
    let center = Point::new(x, y);
    obstacle(name, Shape::Circle { center, radius }, vec![disc(center, radius)])
}

pub fn wall(name: &str, corners: &[(f64, f64)]) -> Obstacle {
    let corners: Vec<Point> = corners.iter().map(|c| Point::new(c.0, c.1)).collect();
    let pieces = corners.windows(2).map(|w| shapes::wall(w[0], w[1])).collect();
    obstacle(name, Shape::Polyline(corners), pieces)
}

fn obstacle(name: &str, shape: Shape, pieces: Vec<Convex>) -> Obstacle {
    Obstacle { name: name.to_owned(), shape, pieces, heights: Heights::ALL, growth: Growth::default() }
}

pub fn scene(arm: Arm, obstacles: Vec<Obstacle>) -> Scene {
    placed(arm, Workspace { name: "test".to_owned(), obstacles, clearance: 0.0, preferences: Vec::new() })
}
