//! The controller of a differential drive: the signs of its terms, its closed form, and plans that it follows.

use super::plain::least_gap;
use cplan::model::{Arm, Obstacle, Scene, Workspace};
use cplan::nalgebra::Vector2;
use cplan::{Options, Outcome, Point, Problem, plan};
use cplan_cases::plane::distance_to_segment;
use cplan_cases::{dice, seeds, uses_default_cases};
use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::robot::{Pose, Robot};
use cplan_testkit::mobile::tanh::{AHEAD, CYCLE, DEVIATION, Nearest, PASSED, Tanh, follow, nearest, speeds, waypoints};
use cplan_testkit::mobile::{START, TARGETS};

const LAW: Tanh = Tanh { pull: 10.0, push: 1.0, range: 0.26 };

fn hall() -> Floor {
    Floor::load("explore/hall.toml").unwrap_or_else(|e| panic!("{e}"))
}

fn arm() -> Arm {
    hall().scene.arm().clone()
}

/// Checks the closed form: with zeta (x - goal) = s, sinh s falls by exp(-zeta t).
#[test]
fn without_obstacles_each_component_follows_its_closed_form() {
    let scene = Scene::new(arm(), Workspace::new([])).unwrap();
    let floor = Floor::new(scene);
    for seed in seeds(30) {
        let mut dice = dice(seed);
        let mut robot = Robot::new(&floor, [0.0, 0.0], dice.within(-3.1, 3.1));
        let goal = Point::new(dice.within(-4.0, 4.0), dice.within(-4.0, 4.0));
        let law = Tanh { pull: dice.within(0.3, 3.0), ..LAW };
        let first = law.pull * (robot.pose.ahead(AHEAD) - goal);
        let mut last = robot.pose.ahead(AHEAD);
        // Commands are frequent here, so that the motion is nearly continuous.
        let cycle = CYCLE / 10.0;
        for step in 1..6000 {
            let point = robot.pose.ahead(AHEAD);
            let [ahead, about] = speeds(law.velocity(point, goal, nearest(&robot)), robot.pose.heading);
            robot.drive(ahead, about, cycle);
            let fallen = (-law.pull * cycle * f64::from(step)).exp();
            let expected = goal + first.map(|s| (s.sinh() * fallen).asinh() / law.pull);
            let now = robot.pose.ahead(AHEAD);
            assert!((now - expected).norm() < 5e-3, "seed {seed}, step {step}: {now}, not {expected}");
            for k in 0..2 {
                let [before, after] = [last, now].map(|p| (p[k] - goal[k]).abs());
                assert!(
                    after <= before + 1e-4,
                    "seed {seed}, step {step}: component {k} goes from {before} to {after}"
                );
            }
            last = now;
        }
    }
}

/// Checks that equation 4 inverts the motion of a point ahead of the wheels.
#[test]
fn the_point_ahead_follows_its_command() {
    for seed in seeds(200) {
        let mut dice = dice(seed);
        let pose = Pose { at: Point::new(dice.within(-5.0, 5.0), 1.0), heading: dice.within(-4.0, 4.0) };
        let velocity = Vector2::new(dice.within(-2.0, 2.0), dice.within(-2.0, 2.0));
        let [ahead, about] = speeds(velocity, pose.heading);
        let h = 1e-6;
        let moved = (pose.after(ahead, about, h).ahead(AHEAD) - pose.after(ahead, about, -h).ahead(AHEAD)) / (2.0 * h);
        assert!((moved - velocity).norm() < 1e-6, "seed {seed}: {moved}, not {velocity}");
    }
}

#[test]
fn repulsion_pushes_away_and_its_printed_sign_does_not() {
    for seed in seeds(200) {
        let mut dice = dice(seed);
        let at = Point::new(dice.within(-5.0, 5.0), dice.within(-5.0, 5.0));
        let law = Tanh { pull: 1.0, push: dice.within(0.01, 2.0), range: dice.within(0.5, 3.0) };
        let nearest = Nearest { distance: dice.within(0.05, law.range - 0.01), angle: dice.within(-3.1, 3.1) };
        let away = -Vector2::new(nearest.angle.cos(), nearest.angle.sin());
        // At the target there is no attraction, so only the obstacle has an effect.
        let velocity = law.velocity(at, at, nearest);
        assert!(velocity.dot(&away) > 0.0, "seed {seed}: {velocity}");
        assert!(velocity.iter().all(|u| u.abs() <= 1.0), "seed {seed}: {velocity}");
        let d = nearest.distance;
        let printed = (law.push * (1.0 / law.range - 1.0 / d) / (d * d) * away).map(f64::tanh);
        assert!(printed.dot(&away) < 0.0 && (printed + velocity).norm() < 1e-9, "seed {seed}: {printed}");
        // The printed attraction leads away from the goal.
        let goal = at + Vector2::new(dice.within(-3.0, 3.0), 1.0);
        let printed = (law.pull * (at - goal)).map(f64::tanh);
        let far = Nearest { distance: law.range, ..nearest };
        assert!(
            printed.dot(&(goal - at)) < 0.0 && (printed + law.velocity(at, goal, far)).norm() < 1e-9,
            "seed {seed}"
        );
    }
}

/// Returns the distance between a point and a line through corners.
fn distance_to_line(p: Point, corners: &[[f64; 2]]) -> f64 {
    let side = |w: &[[f64; 2]]| distance_to_segment([p.x, p.y], [w[0], w[1]]);
    corners.windows(2).map(side).fold(f64::INFINITY, f64::min)
}

/// Plans among the obstacles and follows the plan. Returns true if there was a plan.
fn plan_and_follow(arm: &Arm, obstacles: Vec<Obstacle>, start: [f64; 2], goal: [f64; 2], what: &str) -> bool {
    let workspace = Workspace { clearance: DEVIATION, ..Workspace::new(obstacles) };
    let Ok(problem) = Problem::new(arm.clone(), workspace, start, goal) else { return false };
    let plan = plan(&problem, &Options { bounded: false, ..Options::default() }).unwrap();
    let Outcome::Found(_) = plan.outcome() else { return false };
    let path = plan.waypoints().unwrap();
    let floor = Floor::new(problem.scene().clone());
    let heading = (path[1][1] - path[0][1]).atan2(path[1][0] - path[0][0]);
    let behind = [start[0] - AHEAD * heading.cos(), start[1] - AHEAD * heading.sin()];
    let mut robot = Robot::new(&floor, behind, heading);
    let marks = waypoints(&path);
    let drive = follow(&mut robot, &LAW, &marks, 600.0);
    assert_eq!((drive.passed, drive.repelled, robot.refused.len()), (marks.len(), 0, 0), "{what}");
    assert!((robot.pose.ahead(AHEAD) - Point::from(goal)).norm() <= PASSED + 1e-9, "{what}: {}", robot.pose.at);
    assert!(least_gap(&floor.scene, &robot.way()) > 0.0, "{what}: it touches something");
    let off = robot.way().into_iter().map(|p| distance_to_line(p, &path)).fold(0.0, f64::max);
    assert!(off <= DEVIATION, "{what}: {off} m off the plan");
    // Neither component of the point's velocity exceeds 1.
    let most = std::f64::consts::SQRT_2;
    assert!(drive.fastest[0] <= most && drive.fastest[1] <= most / AHEAD, "{what}: {:?}", drive.fastest);
    true
}

#[test]
fn plans_in_both_rooms_are_followed() {
    for world in ["explore/hall.toml", "explore/house.toml"] {
        let floor = Floor::load(world).unwrap_or_else(|e| panic!("{e}"));
        let obstacles = floor.scene.workspace().obstacles.clone();
        assert!(plan_and_follow(floor.scene.arm(), obstacles, START, TARGETS[0].1, world), "{world}: no plan");
    }
}

#[test]
fn plans_in_random_worlds_are_followed() {
    let (arm, mut plans) = (arm(), 0);
    for seed in seeds(12) {
        let mut dice = dice(seed);
        let obstacles = (0..8).map(|k| {
            let (name, x, y) = (format!("o{k}"), dice.within(-4.0, 4.0), dice.within(-4.0, 4.0));
            let (a, b) = (dice.within(0.1, 1.2), dice.within(0.1, 1.2));
            match k % 3 {
                0 => Obstacle::circle(&name, [x, y], a).unwrap(),
                1 => Obstacle::polygon(&name, [[x, y], [x + a, y], [x + a, y + b], [x, y + b]]).unwrap(),
                _ => Obstacle::polyline(&name, [[x, y], [x + a, y + b], [x, y + 2.0]]).unwrap(),
            }
        });
        let obstacles = obstacles.collect();
        let [start, goal] = [-5.5, 5.5].map(|x| [x, dice.within(-4.0, 4.0)]);
        plans += usize::from(plan_and_follow(&arm, obstacles, start, goal, &format!("seed {seed}")));
    }
    assert!(plans >= 8 || !uses_default_cases(), "only {plans} plans");
}

/// Checks that the controller without a plan passes free-standing obstacles, and that corners of a room trap it, as the
/// source reports.
#[test]
fn without_a_plan_the_controller_arrives_in_the_open_and_is_trapped_in_corners() {
    let law = Tanh { pull: 1.0, push: 1.0, range: 1.0 };
    let ends = ["explore/hall.toml", "explore/house.toml"].map(|world| {
        let floor = Floor::load(world).unwrap_or_else(|e| panic!("{e}"));
        let mut robot = Robot::new(&floor, START, 0.0);
        let goal = TARGETS[0].1.into();
        let drive = follow(&mut robot, &law, &[goal], 200.0);
        assert!(least_gap(&floor.scene, &robot.way()) > 0.0, "{world}: it touches something");
        (drive.passed, (robot.pose.at - goal).norm())
    });
    assert!(ends[0].0 == 1 && ends[1].0 == 0 && ends[1].1 > 5.0, "{ends:?}");
}
