//! The wall follower of S. F. dos Reis Alves, *Trabalho 2 - Campos potenciais*, algorithm 5, on a Pioneer 3-DX.

use super::forces::CYCLE;
use super::occupancy::Occupancy;
use super::robot::{Pose, Robot};
use cplan::nalgebra::{Rotation2, Vector2};

/// The sonars of a Pioneer 3-DX, from its handbook: for each, the distances ahead of the robot's middle and to the left of it,
/// metres, and the direction, degrees to the left. (The source counts the sonars from 0, and states only that there are 16.)
pub const SONARS: [(f64, f64, f64); 16] = [
    (0.069, 0.136, 90.0),
    (0.114, 0.119, 50.0),
    (0.148, 0.078, 30.0),
    (0.166, 0.027, 10.0),
    (0.166, -0.027, -10.0),
    (0.148, -0.078, -30.0),
    (0.114, -0.119, -50.0),
    (0.069, -0.136, -90.0),
    (-0.157, -0.136, -90.0),
    (-0.203, -0.119, -130.0),
    (-0.237, -0.078, -150.0),
    (-0.255, -0.027, -170.0),
    (-0.255, 0.027, 170.0),
    (-0.237, 0.078, 150.0),
    (-0.203, 0.119, 130.0),
    (-0.157, 0.136, 90.0),
];

/// Range of the sonars, metres.
const RANGE: f64 = 5.0;

/// Returns the reading of a sonar, modelled as a single ray. (Real sonars detect objects within about 15 degrees.)
pub fn sonar(robot: &Robot, k: usize) -> f64 {
    let (ahead, left, degrees) = SONARS[k];
    let Pose { at, heading } = robot.pose;
    let from = at + Rotation2::new(heading) * Vector2::new(ahead, left);
    robot.floor.range(from, heading + degrees.to_radians(), RANGE)
}

/// Follows the wall to the robot's right for this many seconds, and fills the map.
pub fn follow(robot: &mut Robot, map: &mut Occupancy, seconds: f64) {
    let (speed, gain, most) = (0.5, 10.0, 10_f64.to_radians());
    let front = |robot: &Robot| sonar(robot, 3).min(sonar(robot, 4));
    let along = |robot: &Robot| sonar(robot, 7) - sonar(robot, 8);
    let end = robot.time + seconds;
    while robot.time < end {
        map.scan(robot.floor, robot.pose);
        let mut turn = -gain * along(robot);
        if front(robot) < 4.0 {
            // A wall is ahead. The robot turns on the spot until the wall is beside it, or there is room ahead.
            turn = most;
            while along(robot).abs() > 0.1 && front(robot) < 3.0 && robot.time < end {
                robot.drive(0.0, turn, CYCLE);
                map.scan(robot.floor, robot.pose);
            }
        } else if sonar(robot, 6) == RANGE {
            // The wall has ended, so the robot drives round its end.
            turn = -most;
        }
        robot.drive(speed, turn.clamp(-most, most), CYCLE);
    }
}
