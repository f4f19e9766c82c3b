//! The controller of a differential drive of R. F. Gonçalves da Silva, *Trabalho Prático 1*, equations 1 to 4, and a
//! plan that it follows.

use super::robot::{Pose, Robot};
use cplan::Point;
use cplan::field::Repulsion;
use cplan::nalgebra::{Rotation2, Vector2};
use std::f64::consts::TAU;

/// Distance of the controlled point ahead of the middle between the wheels, metres (`d` in the source).
pub const AHEAD: f64 = 0.1;

/// Time between two commands, in seconds.
pub const CYCLE: f64 = 0.01;

/// Range of the scanner in metres (`RANGE`), and the number of its rays. The source states neither of them.
const RANGE: f64 = 8.0;
const RAYS: u32 = 360;

/// Constants of the controller. The source states no values for them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tanh {
    /// Gain of the attraction, 1/m (`zeta`).
    pub pull: f64,
    /// Gain of the repulsion (`eta`).
    pub push: f64,
    /// Distance beyond which obstacles are ignored, metres (`Q`).
    pub range: f64,
}

/// The nearest obstacle that the scanner measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance from the middle between the wheels, metres.
    pub distance: f64,
    /// Direction, in radians counter-clockwise from x.
    pub angle: f64,
}

/// Returns the nearest reading of the robot's scanner.
pub fn nearest(robot: &Robot) -> Nearest {
    let Pose { at, heading } = robot.pose;
    let rays = (0..RAYS).map(|ray| heading + TAU * f64::from(ray) / f64::from(RAYS));
    let readings = rays.map(|angle| Nearest { distance: robot.floor.range(at, angle, RANGE), angle });
    readings.min_by(|a, b| a.distance.total_cmp(&b.distance)).expect("there are rays")
}

impl Tanh {
    /// Returns the velocity of the controlled point, m/s: towards the target, and away from the nearest obstacle.
    ///
    /// If `D` points away from the obstacle, the source's terms `tanh(zeta (x - goal))` and `tanh(eta (1/Q - 1/d) / d^2 D)` are
    /// gradients: the first points away from the goal, and the second, whose factor is negative within `Q`, towards the obstacle.
    /// The velocity is opposite to both. (As printed, `U` is their sum: equation 3 lacks a sign.) Neither term has a component
    /// above 1.
    pub fn velocity(&self, point: Point, target: Point, nearest: Nearest) -> Vector2<f64> {
        let attraction = (self.pull * (point - target)).map(f64::tanh);
        let away = -(Rotation2::new(nearest.angle) * Vector2::x());
        let law = Repulsion::Ranged { gain: self.push, range: self.range };
        let repulsion = (-law.force(nearest.distance) * away).map(f64::tanh);
        -attraction - repulsion
    }
}

/// Returns the linear and the angular speed that give the controlled point this velocity (equation 4).
pub fn speeds(velocity: Vector2<f64>, heading: f64) -> [f64; 2] {
    let own = Rotation2::new(-heading) * velocity;
    [own.x, own.y / AHEAD]
}

/// Greatest distance between consecutive waypoints, metres.
pub const SPACING: f64 = 0.2;

/// A waypoint is passed when the controlled point is within this distance of it, in metres.
pub const PASSED: f64 = 0.01;

/// Greatest distance of the robot's middle from its line, metres, if nothing repels it. Each component of the controlled point
/// approaches that of the waypoint without overshooting, so the point stays in the rectangle between its last position and the
/// waypoint. No point of it is farther from the diagonal than half the diagonal, and the diagonal begins at most [`PASSED`] off
/// the line. The middle is [`AHEAD`] behind the point. The last term allows for steps of finite length.
pub const DEVIATION: f64 = 0.5 * (SPACING + PASSED) + PASSED + AHEAD + 0.01;

/// Returns the corners of a line, and points in between.
pub fn waypoints(corners: &[[f64; 2]]) -> Vec<Point> {
    let mut points: Vec<Point> = corners.first().map(|&corner| corner.into()).into_iter().collect();
    for pair in corners.windows(2) {
        let [a, b] = [0, 1].map(|k| Point::from(pair[k]));
        let pieces = ((b - a).norm() / SPACING).ceil() as usize;
        points.extend((1..=pieces).map(|k| a + (b - a) * (k as f64 / pieces as f64)));
    }
    points
}

/// The result of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Number of waypoints passed.
    pub passed: usize,
    /// Number of commands with a repelling obstacle.
    pub repelled: usize,
    /// Greatest linear and angular speed, m/s and rad/s.
    pub fastest: [f64; 2],
}

/// Drives from waypoint to waypoint until the last one is passed. Stops after this many seconds.
pub fn follow(robot: &mut Robot, law: &Tanh, waypoints: &[Point], seconds: f64) -> Drive {
    let end = robot.time + seconds;
    let mut drive = Drive { passed: 0, repelled: 0, fastest: [0.0; 2] };
    while robot.time < end {
        let point = robot.pose.ahead(AHEAD);
        while waypoints.get(drive.passed).is_some_and(|next| (next - point).norm() <= PASSED) {
            drive.passed += 1;
        }
        let Some(&target) = waypoints.get(drive.passed) else { break };
        let nearest = nearest(robot);
        drive.repelled += usize::from(nearest.distance < law.range);
        let [ahead, about] = speeds(law.velocity(point, target, nearest), robot.pose.heading);
        drive.fastest = [drive.fastest[0].max(ahead.abs()), drive.fastest[1].max(about.abs())];
        robot.drive(ahead, about, CYCLE);
    }
    drive
}
