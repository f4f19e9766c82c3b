//! The controller that follows a moving point: its closed form, and cells of a wave and of A\* that it follows.

use super::plain::{least_gap, to_segment};
use cplan::engine::{CellCounts, GridSpace, Method, Planner, Setting};
use cplan::model::{Scene, Workspace};
use cplan::planner::{GridSearch, PathKind};
use cplan::{Options, Point, Problem, plan};
use cplan_cases::{dice, seeds};
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::robot::Robot;
use cplan_testkit::mobile::tanh::{AHEAD, CYCLE, PASSED, speeds};
use cplan_testkit::mobile::tracking::{Tracking, desired, track};
use cplan_testkit::mobile::{START, TARGETS};

const LAW: Tracking = Tracking { gain: 1.0, speed: 0.5 };

/// Checks that the error follows `e' = -k e`, for any motion of the desired point.
#[test]
fn the_distance_to_the_desired_point_falls_exponentially() {
    let hall = Floor::load("explore/hall.toml").unwrap_or_else(|e| panic!("{e}"));
    let floor = Floor::new(Scene::new(hall.scene.arm().clone(), Workspace::new([])).unwrap());
    for seed in seeds(30) {
        let mut dice = dice(seed);
        let corners: Vec<[f64; 2]> = (0..5).map(|_| [0, 1].map(|_| dice.within(-4.0, 4.0))).collect();
        let law = Tracking { gain: dice.within(0.5, 2.0), speed: dice.within(0.2, 1.0) };
        let mut robot = Robot::new(&floor, [dice.within(-4.0, 4.0), dice.within(-4.0, 4.0)], dice.within(-3.1, 3.1));
        let first = desired(&corners, law.speed, 0.0).at - robot.pose.ahead(AHEAD);
        // Commands are frequent here, so that the motion is nearly continuous.
        let cycle = CYCLE / 20.0;
        for step in 0..8000 {
            let time = f64::from(step) * cycle;
            let (point, aim) = (robot.pose.ahead(AHEAD), desired(&corners, law.speed, time));
            let expected = first * (-law.gain * time).exp();
            let off = (aim.at - point - expected).norm();
            assert!(off < 2e-3 * (1.0 + first.norm()), "seed {seed}, step {step}: {off} m from the closed form");
            let [ahead, about] = speeds(law.velocity(point, aim), robot.pose.heading);
            robot.drive(ahead, about, cycle);
        }
    }
}

#[test]
fn the_desired_point_goes_along_the_line_and_rests_at_its_end() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]];
    let at = |time: f64| desired(&corners, 0.5, time);
    assert_eq!((at(1.0).at, at(1.0).velocity.x), (Point::new(0.5, 0.0), 0.5));
    assert_eq!((at(5.0).at, at(5.0).velocity.y), (Point::new(2.0, 0.5), 0.5));
    assert_eq!((at(6.0).at, at(60.0).velocity.norm()), (Point::new(2.0, 1.0), 0.0));
}

/// Returns the distance of a point to a line through corners.
fn distance_to_line(p: Point, corners: &[[f64; 2]]) -> f64 {
    corners.windows(2).map(|w| to_segment(p, w[0].into(), w[1].into())).fold(f64::INFINITY, f64::min)
}

/// Checks the tracking controller on paths of the wave and of A*, in the rooms of the mission, and with the map, cells,
/// start and goal of the source.
#[test]
fn cells_of_the_wave_and_of_a_star_are_followed() {
    for (robot, world, cells, space, start, goal) in [
        ("mobile_robot", "explore/hall.toml", [40, 20], GridSpace::Rows, START, TARGETS[0].1),
        ("mobile_robot", "explore/house.toml", [40, 20], GridSpace::Rows, START, TARGETS[0].1),
        ("stage_robot", "published/obstacle_map.toml", [12, 20], GridSpace::Centers, [-12.0, 11.0], [15.0, -17.0]),
    ] {
        let floor = Floor::of_robot(robot, world).unwrap_or_else(|e| panic!("{e}"));
        let (arm, workspace) = floor.scene.clone().into_parts();
        let problem = Problem::new(arm, workspace, start, goal).unwrap();
        for search in [GridSearch::Wave, GridSearch::AStar] {
            let planner = Planner::named(Method::Wavefront).with_path(PathKind::Own).with_space(space);
            let planner = planner.with(Setting::GridSearch, |s| s.grid_search = search);
            let options = Options { levels: 1, ..Options::from(planner.with_cell_counts(CellCounts(cells))) };
            let path = plan(&problem, &options).unwrap().waypoints().expect("cells");
            let heading = (path[1][1] - path[0][1]).atan2(path[1][0] - path[0][0]);
            let behind = [start[0] - AHEAD * heading.cos(), start[1] - AHEAD * heading.sin()];
            let mut driven = Robot::new(&floor, behind, heading);
            let tracked = track(&mut driven, &LAW, &path, 600.0);
            let what = format!("{world}, {search}");
            assert!(tracked.arrived && driven.refused.is_empty(), "{what}: {tracked:?}");
            assert!((driven.pose.ahead(AHEAD) - Point::from(goal)).norm() <= PASSED, "{what}: {}", driven.pose.at);
            assert!(least_gap(&floor.scene, &driven.way()) > 0.0, "{what}: it touches something");
            // The robot begins at the desired point, and a command lasts a hundredth of a second.
            assert!(tracked.farthest < 3.0 * LAW.speed * CYCLE, "{what}: {tracked:?}");
            let off = driven.way().into_iter().map(|p| distance_to_line(p, &path)).fold(0.0, f64::max);
            assert!(off < AHEAD + 3.0 * LAW.speed * CYCLE, "{what}: {off} m off the cells");
            let length: f64 = path.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
            assert!((driven.time - length / LAW.speed).abs() < 0.1, "{what}: {} s for {length} m", driven.time);
        }
    }
}
