//! The wall follower: it aligns itself with walls, keeps moving, and touches nothing.

use super::plain::{RADIUS, gap, least_gap};
use cplan::Point;
use cplan_cases::{dice, seeds};
use cplan_testkit::mobile::START;
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::follower::{SONARS, follow, sonar};
use cplan_testkit::mobile::mission::followed;
use cplan_testkit::mobile::occupancy::Occupancy;
use cplan_testkit::mobile::robot::{Pose, Robot};

fn floor(name: &str) -> Floor {
    Floor::load(&format!("explore/{name}.toml")).unwrap_or_else(|e| panic!("{e}"))
}

/// Checks sonars 7 and 8, which look to the right, one ahead of the other, and sonar 6 ahead of them. Along a straight
/// wall, their readings follow from the angle to the wall and the distance.
#[test]
fn sonars_read_what_a_straight_wall_asks_for() {
    let floor = floor("hall");
    for seed in seeds(50) {
        let mut dice = dice(seed);
        // The south wall, y = -10, at a place without furniture.
        let (distance, angle) = (dice.within(0.6, 3.0), dice.within(-0.3, 0.3));
        let robot = Robot::new(&floor, [5.0, -10.0 + distance], angle);
        for k in [6, 7, 8] {
            let (ahead, left, degrees) = SONARS[k];
            let height = distance + ahead * angle.sin() + left * angle.cos();
            let expected = height / -(angle + degrees.to_radians()).sin();
            let read = sonar(&robot, k);
            assert!((read - expected.min(5.0)).abs() < 1e-9, "seed {seed}: sonar {k} reads {read}, not {expected}");
        }
    }
}

/// Checks that the robot turns until it is parallel to the wall, and keeps its distance: `turn = -10 (s7 - s8)` is
/// about `-2.3 tan(angle)`.
#[test]
fn the_robot_lines_up_with_a_wall() {
    let floor = floor("hall");
    for seed in seeds(20) {
        let mut dice = dice(seed);
        let angle = dice.within(-0.2, 0.2);
        let mut robot = Robot::new(&floor, [0.0, -8.0], angle);
        follow(&mut robot, &mut Occupancy::unknown(), 8.0);
        assert!(robot.pose.heading.abs() < 1e-3, "seed {seed}: from {angle} to {}", robot.pose.heading);
        assert!(
            (robot.pose.at.y + 8.0).abs() < 0.5 && (robot.length - 0.5 * robot.time).abs() < 1e-6,
            "seed {seed}: {}",
            robot.pose.at
        );
    }
}

/// Checks ten minutes in both rooms: the robot keeps moving and returns to its beginning. In the house it keeps a metre
/// from everything. In the hall it scrapes a corner of the cupboard that no sonar sees, because its rules guarantee no
/// distance. After three minutes it has seen most of the room, as the source says.
#[test]
fn the_robot_circles_both_rooms() {
    let corner = Point::new(-3.0, 7.0);
    for (name, [nearest, farthest]) in [("hall", [RADIUS, 3.0]), ("house", [1.0, 4.0])] {
        let floor = floor(name);
        let mut robot = Robot::new(&floor, START, 0.0);
        follow(&mut robot, &mut Occupancy::unknown(), 600.0);
        assert!(name == "hall" || robot.refused.is_empty(), "{name}: it pushes against something");
        assert!(robot.refused.iter().all(|p| (p - corner).norm() < RADIUS + 0.02), "{name}: {:?}", robot.refused);
        let way = robot.way();
        assert!(least_gap(&floor.scene, &way) > 0.0, "{name}: it is in something");
        let half_minute = 30 * robot.track.len() / 600;
        for part in way.chunks(half_minute) {
            let length: f64 = part.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
            let whole = part.len() as f64 / half_minute as f64;
            // The robot drives at 0.5 m/s, except while it turns on the spot.
            assert!(length > 11.0 * whole && length <= 15.01 * whole, "{name}: {length} m in half a minute");
        }
        for p in &way[half_minute..] {
            let wall = gap(&floor.scene, *p) + RADIUS;
            assert!((nearest..=farthest).contains(&wall), "{name}: {wall} m from the nearest wall at {p}");
        }
        // In the first half, it was once at its final place, with the same heading.
        let (first, last) = (&robot.track[half_minute..robot.track.len() / 2], robot.track[robot.track.len() - 1]);
        let is_same = |pose: &Pose| (pose.at - last.at).norm() < 0.3 && (pose.heading - last.heading).cos() > 0.99;
        assert!(first.iter().any(is_same), "{name}: it does not come round");
        let [free, occupied, unknown] = followed(&floor, 180.0).0.counts();
        assert!(free + occupied > 9 * unknown, "{name}: {unknown} cells are unknown");
    }
}
