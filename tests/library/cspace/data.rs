//! Configuration spaces as data, compared with distances by parry2d: free places are free, and blocked places are near
//! obstacles, as far as the stated guarantee says.

use cplan::PlanOutput as _;
use cplan::cli::read_words;
use cplan::cspace::Proves;
use cplan::engine::Method;
use cplan::model::{Carrier, Part, Scene};
use cplan::output::{CSpaces, Polygons, Values};
use cplan::{Configuration, Problem, plan};
use cplan_cases::{dice, times};
use cplan_testkit::parry::core_distance;
use std::path::Path;

fn plan_shipped(robot: &str, world: &str, planner: &str) -> (Problem, CSpaces) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (options, overrides) = read_words(&[format!("--planner={planner}")]).unwrap();
    let [urdf, world] = [format!("robots/{robot}.urdf"), format!("workspaces/{world}.toml")].map(|f| root.join(f));
    let problem = Problem::load_with(urdf, world, &overrides).unwrap();
    let spaces = plan(&problem, &options).unwrap().cspaces();
    (problem, spaces)
}

/// Returns the distance between the arm and obstacle `number`. Numbers beyond those of the obstacles stand for links of
/// the robot, which later links of the chain can hit.
fn distance(scene: &Scene, q: Values, number: usize) -> f64 {
    let arm = scene.arm();
    let own = number.checked_sub(scene.workspace().obstacles.len()).map(|link| &arm.self_obstacles[link]);
    let obstacle = own.map_or_else(|| &scene.workspace().obstacles[number], |own| &own.obstacle);
    let is_carried = own.is_some_and(|own| own.carrier == Carrier::FirstJoint);
    // If joint 1 carries the link, only joint 2 moves the one relative to the other.
    let poses = arm.poses(Configuration::from(if is_carried { [0.0, q[1]] } else { q }));
    let mut least = f64::INFINITY;
    for (index, (link, pose)) in arm.links.iter().zip(&poses).enumerate().skip(usize::from(is_carried)) {
        let can_meet = |(number, part): &(usize, &Part)| match own {
            None => part.heights.meet(obstacle.heights),
            Some(own) => part.heights.overlap(obstacle.heights) && !own.ignores(index, *number, &part.body),
        };
        for (_, part) in link.parts.iter().enumerate().filter(can_meet) {
            let shape = part.shape.at(pose);
            let apart = obstacle
                .pieces
                .iter()
                .filter_map(|piece| Some(core_distance(&shape, piece)? - shape.radius() - piece.radius()));
            least = apart.fold(least, f64::min);
        }
    }
    least
}

fn free(scene: &Scene, q: Values) -> f64 {
    (0..scene.workspace().obstacles.len()).map(|o| distance(scene, q, o)).fold(f64::INFINITY, f64::min)
}

/// Returns true if a point is within the polygons, that is, if a ray from it crosses an odd number of sides.
fn is_inside(polygons: &Polygons, [x, y]: Values) -> bool {
    let sides = polygons.iter().flatten().flat_map(|ring| ring.windows(2));
    sides
        .filter(|s| {
            (s[0][1] > y) != (s[1][1] > y) && x < s[0][0] + (s[1][0] - s[0][0]) * (y - s[0][1]) / (s[1][1] - s[0][1])
        })
        .count()
        % 2
        == 1
}

fn interpolate([a, b]: [Values; 2], share: f64) -> Values {
    [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)
}

#[test]
fn c_obstacles_contain_collisions_tightly() {
    for (robot, world) in [
        ("planar_2r", "shelf"),
        ("planar_2r_continuous", "wrap_around"),
        ("scara", "scara_cell"),
        ("gantry", "gantry_maze"),
        ("polar", "polar_gate"),
    ] {
        let (problem, spaces) = plan_shipped(robot, world, "shortest");
        let (scene, [space]) = (problem.scene(), &spaces.spaces[..]) else { panic!("one space") };
        let Proves::Outer { margin } = space.proves else { panic!("{:?}", space.proves) };
        let clearance = scene.workspace().clearance;
        let [first, second] = &spaces.axes;
        let mut random = dice(7);
        let mut blocked = 0;
        for _ in 0..times(3000) {
            let q = [random.within(first.lower, first.upper), random.within(second.lower, second.upper)];
            for (number, region) in space.c_obstacles.iter().enumerate() {
                let apart = distance(scene, q, number);
                if is_inside(&region.polygons, q) {
                    blocked += 1;
                    assert!(apart <= clearance + margin, "{world}: {q:?} is {apart} m from {}", region.obstacle);
                } else {
                    assert!(apart > clearance, "{world}: {q:?} is {apart} m from {}", region.obstacle);
                }
            }
        }
        assert!(blocked > 100, "{world}: {blocked}");
        for ring in space.c_obstacles.iter().flat_map(|region| region.polygons.iter().flatten()) {
            assert_eq!(ring.first(), ring.last());
            let inside = |q: &Values| (0..2).all(|k| (spaces.axes[k].lower..=spaces.axes[k].upper).contains(&q[k]));
            assert!(ring.len() > 3 && ring.iter().all(inside));
        }
    }
}

#[test]
fn cells_of_planners_are_free() {
    for planner in Method::ALL.map(Method::name).into_iter().filter(|name| *name != "first") {
        let (problem, spaces) = plan_shipped("planar_2r", "shelf", planner);
        let (scene, space) = (problem.scene(), &spaces.spaces[0]);
        let mut random = dice(8);
        let mut asked = 0;
        let mut is_free = |q: Values, what: &str| {
            asked += 1;
            assert!(free(scene, q) > 0.0, "{planner}: {what} {q:?} hits");
        };
        for path in space.paths.iter().flat_map(|path| [&path.waypoints, &path.outline]) {
            path.windows(2).for_each(|side| is_free(interpolate([side[0], side[1]], random.within(0.0, 1.0)), "path"));
        }
        if let Some(roadmap) = &space.roadmap {
            for edge in roadmap.edges.iter().take(1000) {
                is_free(interpolate(edge.map(|v| roadmap.vertices[v]), random.within(0.0, 1.0)), "edge");
            }
        }
        for corners in space.cells.iter().flat_map(|cells| &cells.corners) {
            let middle = [0, 1].map(|k| corners.iter().map(|q| q[k]).sum::<f64>() / corners.len() as f64);
            is_free(middle, "cell");
        }
        if let Some(cells) = &space.cells {
            assert!(cells.channel.len() > 1 && cells.channel.iter().all(|&cell| cell < cells.corners.len()));
        }
        space.expanded.iter().for_each(|&q| is_free(q, "expanded"));
        for row in &space.rows {
            assert_eq!(row[0][0], row[1][0]);
            is_free(interpolate(*row, random.within(1e-6, 1.0 - 1e-6)), "row");
        }
        if let Some(boxes) = &space.boxes {
            for corners in &boxes.free {
                is_free([0, 1].map(|k| random.within(corners[0][k], corners[1][k])), "box");
            }
        }
        if let Some(grid) = &space.grid {
            assert!(matches!(grid.proves, Proves::Outer { .. }));
            assert_eq!([grid.blocked.len(), grid.values.len()], [grid.shape[0] * grid.shape[1]; 2]);
            for _ in 0..1000 {
                let cell = random.below(grid.blocked.len());
                if !grid.blocked[cell] {
                    let at = [cell / grid.shape[1], cell % grid.shape[1]];
                    is_free(
                        [0, 1].map(|k| grid.lower[k] + (at[k] as f64 + random.within(0.0, 1.0)) * grid.size[k]),
                        "cell",
                    );
                } else {
                    assert!(!grid.values[cell].is_finite(), "{planner}: a value at a blocked cell");
                }
            }
            // From the start on, each cell has one step less to the goal.
            if grid.quantity == "steps" {
                let at = |q: Values| {
                    let [i, j] = [0, 1].map(|k| ((q[k] - grid.lower[k]) / grid.size[k]) as usize);
                    i * grid.shape[1] + j
                };
                assert_eq!(grid.values[at(space.goals[0][0])], 0.0);
                assert!(grid.values[at(space.start)] > 1.0);
            }
        }
        assert!(asked > 50, "{planner}: {asked}");
    }
}

#[test]
fn proofs_consist_of_collision_boxes() {
    let (problem, spaces) = plan_shipped("planar_2r", "singular_closed", "shortest");
    let (space, mut random) = (&spaces.spaces[0], dice(9));
    assert!(space.paths.is_empty() && space.proof.len() > 1);
    for corners in &space.proof {
        let q = [0, 1].map(|k| random.within(corners[0][k], corners[1][k]));
        assert!(free(problem.scene(), q) <= problem.scene().workspace().clearance, "{q:?}");
    }
}

#[test]
fn a_task_has_a_space_for_each_world() {
    let (problem, spaces) = plan_shipped("scara", "tasks/kitting_cell", "shortest");
    let objects = problem.task().unwrap().objects.len();
    let carried: Vec<&str> = spaces.spaces.iter().map(|space| space.payload.as_str()).collect();
    assert!(carried.iter().filter(|name| !name.is_empty()).count() >= objects, "{carried:?}");
    let steps: usize = spaces.spaces.iter().map(|space| space.paths.len()).sum();
    assert_eq!(steps, problem.task().unwrap().steps().count());
    assert!(spaces.spaces.iter().all(|space| space.goals.len() == space.paths.len() && !space.c_obstacles.is_empty()));
}
