//! The sensors and the published occupancy grid.

use super::plain::{RADIUS, gap};
use cplan::Point;
use cplan::nalgebra::Vector2;
use cplan_cases::{dice, seeds};
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::forces::force;
use cplan_testkit::mobile::occupancy::{CELLS, Occupancy, SIDE, cell, place};
use cplan_testkit::mobile::robot::Pose;

fn floors() -> [Floor; 2] {
    ["explore/hall.toml", "explore/house.toml"].map(|world| Floor::load(world).unwrap_or_else(|e| panic!("{e}")))
}

/// Compares rays with walks. Each step of a walk is the distance to the nearest obstacle, and the walk ends when that
/// is 0.
#[test]
fn rays_end_where_steps_of_the_free_distance_end() {
    let floors = floors();
    let mut met = 0;
    for seed in seeds(400) {
        let mut dice = dice(seed);
        let floor = &floors[dice.below(2_usize)];
        let from = Point::new(dice.within(-19.9, 19.9), dice.within(-9.9, 9.9));
        let angle = dice.within(-3.2, 3.2);
        if gap(&floor.scene, from) < -RADIUS + 1e-3 {
            continue;
        }
        let mut t = 0.0;
        while t < 8.0 {
            let free = gap(&floor.scene, from + t * Vector2::new(angle.cos(), angle.sin())) + RADIUS;
            if free < 1e-7 {
                break;
            }
            t += free;
        }
        let (range, expected) = (floor.range(from, angle, 8.0), f64::min(t, 8.0));
        // A ray that grazes a side ends slightly earlier in the walk.
        assert!((range - expected).abs() < 1e-3, "seed {seed}: {range} from {from} at {angle}, not {expected}");
        met += usize::from(range < 8.0);
    }
    assert!(met > 100 || !cplan_cases::uses_default_cases(), "{met}");
}

#[test]
fn places_have_the_published_rows_and_columns() {
    assert_eq!(place(Point::new(-19.0, 2.0)), [16.0, 2.0]);
    assert_eq!(cell(Point::new(2.0, 4.0)), [12, 44]);
    assert_eq!(cell(Point::new(9.0, -7.0)), [34, 58]);
    // Walls belong to the outermost cells.
    assert_eq!([cell(Point::new(20.0, -10.0)), cell(Point::new(-20.0, 10.0))], [[39, 79], [0, 0]]);
}

/// Compares the cells that a scan marks with distances to the rays.
#[test]
fn a_scan_frees_what_rays_cross_and_marks_what_they_meet() {
    for floor in floors() {
        let mut map = Occupancy::unknown();
        let pose = Pose { at: Point::new(-15.3, 1.2), heading: 0.4 };
        map.scan(&floor, pose);
        for k in 0..CELLS[0] * CELLS[1] {
            let at = [k / CELLS[1], k % CELLS[1]];
            let middle = Point::new((at[1] as f64 - 39.5) * SIDE, (19.5 - at[0] as f64) * SIDE);
            let away = middle - pose.at;
            let bearing = (away.y.atan2(away.x) - pose.heading).abs();
            let behind = bearing > 1.8 && away.norm() > 2.0 * SIDE;
            let known = map.at(at);
            assert!(!behind || known == 0.5, "cell {at:?} is behind the robot, yet {known}");
            assert!(away.norm() < 8.0 + SIDE || known == 0.5, "cell {at:?} is out of sight, yet {known}");
            if known == 1.0 {
                let free = gap(&floor.scene, middle) + RADIUS;
                assert!(free <= SIDE, "cell {at:?} is marked, {free} m from anything");
            }
        }
        // The robot is in a passage, so that some cells are near obstacles and most are free.
        let [free, occupied, _] = map.counts();
        assert!(occupied > 5 && free > 100, "{free}, {occupied}");
    }
}

/// Checks the forces of a single cell, which are computed by hand. Also checks the force of a long wall, whose sum is
/// close to the integral `2 / D`.
#[test]
fn forces_of_cells_add_up() {
    let (at, target) = (Point::new(0.0, 0.0), Point::new(3.0, 4.0));
    let mut map = Occupancy::unknown();
    let alone = force(&map, target, at).unwrap();
    assert!((alone - Vector2::new(0.6, 0.8)).norm() < 1e-12, "{alone}");
    // A cell three columns west and four rows south of the robot's place, (20, 40). It is 5 cells away, so the force is
    // 1/25 towards north-east.
    map.set([24, 37], 1.0);
    let pushed = force(&map, target, at).unwrap() - alone;
    assert!((pushed - Vector2::new(0.6, 0.8) / 25.0).norm() < 1e-12, "{pushed}");
    assert_eq!(force(&map, target, Point::new(-1.4, -2.1)), None, "that is in the cell");
    let mut wall = Occupancy::unknown();
    (0..CELLS[0]).for_each(|row| wall.set([row, 37], 1.0));
    let pushed = force(&wall, target, at).unwrap() - alone;
    let ends = |n: f64| n / (3.0 * (n * n + 9.0).sqrt());
    let integral = ends(20.5) + ends(19.5);
    assert!((pushed.x - integral).abs() < 0.01, "{} instead of {integral}", pushed.x);
}
