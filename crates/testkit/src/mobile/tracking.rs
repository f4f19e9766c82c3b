//! The controller of a differential drive of R. F. Gonçalves da Silva, *Trabalho Prático 1*, equation 5. The robot follows a
//! point that moves along a line, such as a path of a wavefront or of A\*.

use super::robot::Robot;
use super::tanh::{AHEAD, CYCLE, PASSED, speeds};
use cplan::Point;
use cplan::nalgebra::Vector2;

/// The controller's constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracking {
    /// Gain towards the desired point, 1/s (`k`; 1 in the source).
    pub gain: f64,
    /// Speed of the desired point, m/s. The source does not state it.
    pub speed: f64,
}

impl Tracking {
    /// Returns the velocity of the controlled point: `k (xd - x) + xd'`. Its distance from the desired point decreases by the
    /// factor `exp(-k t)`, however that point moves.
    pub fn velocity(&self, point: Point, desired: Desired) -> Vector2<f64> {
        self.gain * (desired.at - point) + desired.velocity
    }
}

/// Position and velocity of the desired point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Desired {
    /// Position, in metres.
    pub at: Point,
    /// Velocity, in metres per second.
    pub velocity: Vector2<f64>,
}

/// Returns the desired point at a time. It moves along a line of at least one corner, and rests at the end.
pub fn desired(corners: &[[f64; 2]], speed: f64, time: f64) -> Desired {
    let mut left = speed * time;
    for pair in corners.windows(2) {
        let [a, b] = [0, 1].map(|k| Point::from(pair[k]));
        let length = (b - a).norm();
        if left < length {
            let along = (b - a) / length;
            return Desired { at: a + along * left, velocity: along * speed };
        }
        left -= length;
    }
    Desired { at: corners.last().map_or(Point::zeros(), |&end| end.into()), velocity: Vector2::zeros() }
}

/// The result of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tracked {
    /// True if the controlled point has reached the end of the line.
    pub arrived: bool,
    /// The greatest distance between the controlled point and the desired one, metres.
    pub farthest: f64,
}

/// Follows a line to its end, for at most this many seconds.
pub fn track(robot: &mut Robot, law: &Tracking, corners: &[[f64; 2]], seconds: f64) -> Tracked {
    let begun = robot.time;
    let mut tracked = Tracked { arrived: false, farthest: 0.0 };
    while robot.time - begun < seconds {
        let point = robot.pose.ahead(AHEAD);
        let desired = desired(corners, law.speed, robot.time - begun);
        let distance = (desired.at - point).norm();
        tracked.farthest = tracked.farthest.max(distance);
        if desired.velocity == Vector2::zeros() && distance <= PASSED {
            tracked.arrived = true;
            break;
        }
        let [ahead, about] = speeds(law.velocity(point, desired), robot.pose.heading);
        robot.drive(ahead, about, CYCLE);
    }
    tracked
}
