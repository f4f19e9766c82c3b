//! The paths of fields follow the fields. The program's paths are compared with an equation that the test solves on
//! cells of its own.

use crate::cli::shipped;
use cplan::input::{Overrides, load};
use cplan::model::Scene;
use cplan::space::Configuration;
use cplan_testkit::judged::plan_result;
use serde_json::Value;

/// Returns the program's result in a world. Fails if it is not a path.
fn plan_path(robot: &str, world: &str, options: &str) -> Value {
    let robot = shipped(robot);
    let result = plan_result(robot.as_ref(), world.as_ref(), &format!("--planner harmonic {options}"));
    assert_eq!(result["status"], "found", "{world} {options}");
    result
}

fn waypoints(result: &Value) -> Vec<[f64; 2]> {
    let pair = |q: &Value| [0, 1].map(|k| q[k].as_f64().unwrap());
    result["path"].as_array().unwrap().iter().map(pair).collect()
}

/// Returns places along a path, `apart` from each other, each with the direction of the path there.
fn places_along(path: &[[f64; 2]], apart: f64) -> Vec<([f64; 2], [f64; 2])> {
    let mut places = Vec::new();
    for piece in path.windows(2) {
        let d = [piece[1][0] - piece[0][0], piece[1][1] - piece[0][1]];
        let length = d[0].hypot(d[1]);
        let n = (length / apart).ceil().max(1.0);
        for k in 0..n as usize {
            let t = (k as f64 + 0.5) / n;
            places.push(([0, 1].map(|i| piece[0][i] + t * d[i]), d.map(|x| x / length)));
        }
    }
    places
}

/// Returns the angle between two vectors, degrees.
fn angle(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).abs().to_degrees()
}

/// The configuration space, divided into square cells, and the solution of Laplace's equation on them. A cell is free
/// if the arm at its centre touches nothing.
struct Oracle<'a> {
    scene: &'a Scene,
    cells: [usize; 2],
    step: [f64; 2],
    /// Values of the cells; 0 in blocked cells.
    values: Vec<f64>,
}

impl<'a> Oracle<'a> {
    /// Solves the equation with about `n x n` cells.
    fn new(scene: &'a Scene, goal: Configuration, n: f64) -> Self {
        let extents = scene.arm().topology().ranges.map(|axis| axis.extent());
        let side = (extents[0] * extents[1]).sqrt() / n;
        let cells = extents.map(|extent| (extent / side).round() as usize);
        let step = [0, 1].map(|k| extents[k] / cells[k] as f64);
        let mut oracle = Self { scene, cells, step, values: vec![0.0; cells[0] * cells[1]] };
        let center = |cell: usize| {
            let at = [cell / cells[1], cell % cells[1]];
            let [a, b] = [0, 1].map(|k| scene.arm().topology().ranges[k].domain().0 + (at[k] as f64 + 0.5) * step[k]);
            Configuration::new(a, b)
        };
        let free: Vec<usize> = (0..oracle.values.len()).filter(|&cell| scene.clearance(center(cell)) > 0.0).collect();
        let nearest = |a: &&usize, b: &&usize| {
            let apart = |cell: usize| scene.arm().topology().distance(center(cell), goal);
            apart(**a).total_cmp(&apart(**b))
        };
        let source = *free.iter().min_by(nearest).unwrap();
        oracle.values[source] = 1.0;
        // Over-relaxes row by row, forwards and backwards, until no value changes by more than a millionth. Values far
        // below those along a path need not converge.
        let neighbors: Vec<[Option<usize>; 4]> = (0..oracle.values.len()).map(|cell| oracle.neighbors(cell)).collect();
        for sweep in 0..20_000 {
            let mut change = 0.0_f64;
            let mut relax = |cell: usize| {
                if cell != source {
                    let value = |next: Option<usize>| next.map_or(0.0, |next| oracle.values[next]);
                    let mean = neighbors[cell].map(value).iter().sum::<f64>() / 4.0;
                    let new = (oracle.values[cell] + 1.8 * (mean - oracle.values[cell])).max(0.0);
                    change = change.max((new - oracle.values[cell]).abs() / new.max(1e-100));
                    oracle.values[cell] = new;
                }
            };
            if sweep % 2 == 0 {
                free.iter().for_each(|&cell| relax(cell))
            } else {
                free.iter().rev().for_each(|&cell| relax(cell))
            }
            if change < 1e-6 {
                return oracle;
            }
        }
        panic!("the oracle does not converge");
    }

    fn neighbors(&self, cell: usize) -> [Option<usize>; 4] {
        let at = [cell / self.cells[1], cell % self.cells[1]].map(|x| x as i64);
        [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|d| self.cell([at[0] + d[0], at[1] + d[1]]))
    }

    fn cell(&self, at: [i64; 2]) -> Option<usize> {
        let on = |k: usize| {
            let n = self.cells[k] as i64;
            let i = if self.scene.arm().topology().ranges[k].is_circle() { at[k].rem_euclid(n) } else { at[k] };
            usize::try_from(i).ok().filter(|&i| i < self.cells[k])
        };
        Some(on(0)? * self.cells[1] + on(1)?)
    }

    /// Returns the direction of the gradient, bilinearly interpolated from central differences. Returns `None` beside
    /// obstacles.
    fn gradient(&self, q: [f64; 2]) -> Option<[f64; 2]> {
        let at = [0, 1].map(|k| (q[k] - self.scene.arm().topology().ranges[k].domain().0) / self.step[k] - 0.5);
        let least = at.map(|x| x.floor() as i64);
        let mut sum = [0.0; 2];
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let part = |k: usize, up: i64| {
                let x = at[k] - least[k] as f64;
                if up == 1 { x } else { 1.0 - x }
            };
            let cell = self.cell([least[0] + i, least[1] + j])?;
            let weight = part(0, i) * part(1, j) / self.values[cell];
            let [down, up, left, right] = self.neighbors(cell).map(|next| next.map_or(0.0, |next| self.values[next]));
            let slope = [(up - down) / self.step[0], (right - left) / self.step[1]];
            sum = [0, 1].map(|k| sum[k] + weight * slope[k]);
        }
        sum.iter().all(|x| x.is_finite()).then_some(sum)
    }

    /// Returns the median angle between a path and the gradient, without the last cells before the goal.
    fn median_angle(&self, path: &[[f64; 2]]) -> f64 {
        let end = path[path.len() - 1];
        let far = |q: [f64; 2]| (q[0] - end[0]).hypot(q[1] - end[1]) > 3.0 * self.step[0];
        let places = places_along(path, 0.5 * self.step[0]);
        let all = places.len();
        let mut angles: Vec<f64> = places
            .into_iter()
            .filter(|(q, _)| far(*q))
            .filter_map(|(q, direction)| Some(angle(direction, self.gradient(q)?)))
            .collect();
        assert!(2 * angles.len() > all, "only {} of {all} places have a gradient", angles.len());
        angles.sort_by(f64::total_cmp);
        angles[angles.len() / 2]
    }
}

/// Worlds of different kinds: two revolute joints with limits and without, a gantry, a revolute and a prismatic joint.
const WORLDS: [(&str, &str); 5] = [
    ("robots/planar_2r.urdf", "workspaces/shelf.toml"),
    ("robots/planar_2r.urdf", "workspaces/u_trap.toml"),
    ("robots/gantry.urdf", "workspaces/gantry_maze.toml"),
    ("robots/polar.urdf", "workspaces/polar_gate.toml"),
    ("robots/planar_2r_continuous.urdf", "workspaces/torus_open.toml"),
];

#[test]
fn harmonic_paths_follow_the_gradient_of_an_equation_solved_elsewhere() {
    for (robot, world) in WORLDS {
        let problem = load(shipped(robot), shipped(world).as_ref(), &Overrides::default()).unwrap().problem;
        let own = plan_path(robot, &shipped(world), "");
        assert_eq!(own["path_kind"], "own");
        let path = waypoints(&own);
        let end = path[path.len() - 1];
        let oracle = Oracle::new(problem.scene(), Configuration::new(end[0], end[1]), 120.0);
        let median = oracle.median_angle(&path);
        assert!(median <= 5.0, "{world}: {median} degrees off the gradient");
        let relaxed = plan_path(robot, &shipped(world), "--relaxation sor --levels 1");
        let median = oracle.median_angle(&waypoints(&relaxed));
        assert!(median <= 5.0, "{world}, relaxed: {median} degrees off the gradient");
        if world.contains("shelf") {
            // For comparison, a taut path through the same cells.
            let taut = plan_path(robot, &shipped(world), "--path taut");
            assert_eq!(taut["path_kind"], "taut");
            let median = oracle.median_angle(&waypoints(&taut));
            assert!(median > 20.0, "{median} degrees: the measure tells no difference");
        }
    }
}

/// Writes a world: a room of 2 m x 1.5 m without obstacles.
fn write_empty_room(place: &tempfile::TempDir, start: [f64; 2], goal: [f64; 2], rest: &str) -> String {
    let file = place.path().join("room.toml");
    let text = format!("[start]\njoints = {start:?}\n[goal]\njoints = {goal:?}\n{rest}");
    std::fs::write(&file, text).unwrap();
    file.display().to_string()
}

const GANTRY: &str = "robots/gantry.urdf";

#[test]
fn in_an_empty_room_a_drift_decides_from_where_the_goal_is_reached() {
    let place = tempfile::tempdir().unwrap();
    let goal = [1.0, 0.75];
    for k in 0..8 {
        let angle_of = f64::from(k) * std::f64::consts::FRAC_PI_4;
        let (sin, cos) = angle_of.sin_cos();
        // The start is to the side of the goal, so that the straight direction to the goal is off by 80 degrees.
        let (aside, ahead) = (angle_of + 100_f64.to_radians()).sin_cos();
        let world = write_empty_room(&place, [goal[0] + 0.5 * ahead, goal[1] + 0.5 * aside], goal, "");
        let options = format!("--cells 96 --field oriented --epsilon 1 --direction {cos},{sin}");
        let path = waypoints(&plan_path(GANTRY, &world, &options));
        // Checks the last piece, and the straight line to the goal from the last place that is more than two cells
        // away.
        let far = |q: &[f64; 2]| (q[0] - goal[0]).hypot(q[1] - goal[1]) > 2.0 * 0.018;
        let within = places_along(&path, 1e-3).into_iter().rev().find(|(q, _)| far(q)).unwrap().0;
        for from in [path[path.len() - 2], within] {
            let off = angle([goal[0] - from[0], goal[1] - from[1]], [cos, sin]);
            assert!(off <= 10.0, "direction ({cos:.2}, {sin:.2}): {off} degrees off from {from:?}");
        }
    }
}

/// Compares the bending of paths with figure 3.7 of the sources.
#[test]
fn the_path_bends_the_more_the_greater_epsilon_is() {
    let place = tempfile::tempdir().unwrap();
    let world = write_empty_room(&place, [0.5, 0.9], [1.5, 0.9], "");
    let mut before = -1.0;
    for epsilon in [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5] {
        let options = format!("--cells 64 --field oriented --epsilon {epsilon} --direction 0,1");
        let path = waypoints(&plan_path(GANTRY, &world, &options));
        let bend = path.iter().map(|q| 0.9 - q[1]).fold(0.0, f64::max);
        assert!(bend > before + if epsilon > 0.0 { 1e-3 } else { 0.0 }, "epsilon {epsilon}: {bend} after {before}");
        before = bend;
    }
    assert!(before > 0.1, "{before}");
}

#[test]
fn the_share_of_a_path_in_a_region_falls_with_its_preference() {
    let place = tempfile::tempdir().unwrap();
    for field in ["bvp", "bvp2"] {
        let shares: Vec<f64> = [-1.0, -0.5, 0.0, 0.5]
            .into_iter()
            .map(|epsilon: f64| {
                let block = "[[obstacle]]\nname = \"block\"\npolygon = [[0.8, 0.55], [1.2, 0.55], [1.2, 0.95], [0.8, 0.95]]\nheight = [0.0, 0.3]\n";
                let region = format!(
                    "{block}[[preference]]\nname = \"above\"\nepsilon = {epsilon}\nconfigurations = [[0.5, 0.75], [1.5, 0.75], [1.5, 1.5], [0.5, 1.5]]\n"
                );
                let world = write_empty_room(&place, [0.2, 0.78], [1.8, 0.75], &region);
                let path = waypoints(&plan_path(GANTRY, &world, &format!("--cells 64 --field {field}")));
                let places = places_along(&path, 0.005);
                let inside = places.iter().filter(|(q, _)| (0.5..1.5).contains(&q[0]) && q[1] > 0.75).count();
                inside as f64 / places.len() as f64
            })
            .collect();
        assert!(shares.windows(2).all(|pair| pair[1] < pair[0] - 0.01), "{field}: {shares:?}");
        assert!(shares[3] < 0.05, "{field}: {shares:?}");
    }
}

/// Checks that a curve of many pieces is driven like a curve: the arm does not stop at its corners.
#[test]
fn a_motion_along_a_streamline_is_not_many_times_slower_than_a_taut_one() {
    for (robot, world) in WORLDS {
        let [own, taut] =
            ["own", "taut"].map(|kind| plan_path(robot, &shipped(world), &format!("--cells 96 --path {kind}")));
        let number = |result: &Value, key: &str| result[key].as_f64().unwrap();
        let slower = number(&own, "duration") / number(&taut, "duration");
        let longer = number(&own, "length") / number(&taut, "length");
        assert!(slower < 1.6 * longer, "{world}: {slower} times the time, {longer} times the length");
        let corners = own["path"].as_array().unwrap().len() - 2;
        assert!(own["blends"]["count"].as_u64().unwrap() as usize >= corners * 9 / 10, "{world}: {}", own["blends"]);
        assert!(number(&own, "clearance") > number(&taut, "clearance"), "{world}");
    }
}
