//! The controller by forces of S. F. dos Reis Alves, *Trabalho 2 - Campos potenciais*, algorithms 7, 9 and 11.

use super::occupancy::{Occupancy, cell, place};
use super::robot::{Robot, wrapped};
use cplan::Point;
use cplan::field::{Attraction, Repulsion};
use cplan::nalgebra::Vector2;

/// Time between two commands, in seconds. In the source, it depends on the speed of drawing, with at most ten commands per second
/// (Player).
pub const CYCLE: f64 = 0.1;

/// Greatest speed, in metres per second. The source states no limit, and forces are unbounded near obstacles.
pub const TOP_SPEED: f64 = 1.0;

/// Time without progress after which a robot counts as trapped, in seconds.
const PATIENCE: f64 = 60.0;

/// Least decrease of the distance to the target that counts as progress, in metres.
const NEARER: f64 = 0.01;

/// The end of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// The robot is at the target.
    Reached,
    /// The robot made no progress towards the target for a minute. Contains the least distance to it, in metres.
    Trapped(f64),
    /// The robot is in an obstacle cell, which has no force. (The source's program ends with an error here.)
    OnObstacle,
}

/// A version of the method: as the source prints it, or as its text describes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Manner {
    /// True to fill the map while driving (algorithm 11), false for a fixed map (algorithm 9).
    pub maps: bool,
    /// True to follow the source's text, false to follow its program. They differ in two respects. In the text, the robot stands
    /// still while it faces more than 10 degrees away from the force; the program tests whether the error is less than
    /// `degrees(10)`, which is 573, radians, so its robot never stands still. In the text, a reached target is no obstacle; the
    /// program marks the bin as an obstacle while the robot is at it.
    pub follows_text: bool,
}

/// Detects whether a robot no longer makes progress.
pub struct Patience {
    best: f64,
    since: f64,
}

impl Patience {
    /// Begins to observe a robot at its current time.
    pub fn new(robot: &Robot) -> Self {
        Self { best: f64::INFINITY, since: robot.time }
    }

    /// Returns the least distance to the target so far, if the robot has made no progress for too long; otherwise `None`.
    pub fn lost(&mut self, robot: &Robot, distance: f64) -> Option<f64> {
        if distance < self.best - NEARER {
            *self = Self { best: distance, since: robot.time };
        }
        (robot.time - self.since > PATIENCE).then_some(self.best)
    }
}

/// Returns the force at a point: 1 towards the target, and `1 / d^2`, with `d` in cells, away from each occupied cell. `None` in
/// an occupied cell.
pub fn force(map: &Occupancy, target: Point, at: Point) -> Option<Vector2<f64>> {
    if map.at(cell(at)) >= 0.9 {
        return None;
    }
    let (attraction, repulsion) = (Attraction::Constant(1.0), Repulsion::Sum(1.0));
    let [row, column] = place(at);
    let to_target = place(target);
    let to_target = Vector2::new(to_target[1] - column, to_target[0] - row);
    let d = to_target.norm();
    let mut force = if d > 0.0 { to_target * (attraction.force(d) / d) } else { Vector2::zeros() };
    for [i, j] in map.occupied() {
        // As printed, the distance is measured from the corner of the cell that its indices denote.
        let away = Vector2::new(column - j as f64, row - i as f64);
        let d = away.norm();
        force += away * (repulsion.force(d) / d);
    }
    // Rows count downwards.
    Some(Vector2::new(force.x, -force.y))
}

/// Drives to within `stop` of a target. `command` returns speed and turning rate for each distance.
pub fn approach(
    robot: &mut Robot,
    target: Point,
    stop: f64,
    mut command: impl FnMut(&Robot, f64) -> Result<[f64; 2], Ending>,
) -> Ending {
    let mut patience = Patience::new(robot);
    loop {
        let distance = (target - robot.pose.at).norm();
        if distance <= stop {
            return Ending::Reached;
        }
        if let Some(best) = patience.lost(robot, distance) {
            return Ending::Trapped(best);
        }
        match command(robot, distance) {
            Ok([speed, turn]) => robot.drive(speed, turn, CYCLE),
            Err(ending) => return ending,
        }
    }
}

/// Drives until the robot is within 1 cm of a target.
pub fn drive(robot: &mut Robot, map: &mut Occupancy, target: Point, manner: Manner) -> Ending {
    let (speed_gain, turn_gain, stop, slow) = (0.5, 1.2, 0.01, 1.0);
    approach(robot, target, stop, |robot, distance| {
        if manner.maps {
            map.scan(robot.floor, robot.pose);
        }
        let force = force(map, target, robot.pose.at).ok_or(Ending::OnObstacle)?;
        let error = wrapped(force.y.atan2(force.x) - robot.pose.heading);
        let speed = match distance {
            _ if manner.follows_text && error.abs() >= 10_f64.to_radians() => 0.0,
            d if d > slow => speed_gain * force.norm(),
            d => speed_gain * d / slow,
        };
        Ok([speed.min(TOP_SPEED), turn_gain * error])
    })
}
