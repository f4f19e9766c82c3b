//! Explorations of random worlds, compared with brute force. Free cells are free, an explored world shows nothing new,
//! an unreachable goal is unreachable, and the arm moves only where it may.
//!
//! `CPLAN_WORLDS=50` tries 50 of each kind of arm, and prints the lengths of the paths and the endings.

use super::flood::{Truth, connected};
use cplan::explore::{Ending, Exploration, Settings, Strategy, explore, map_description, map_picture};
use cplan::geometry::Convex;
use cplan::input::{Occupancy, OccupancyMap};
use cplan::model::{MotionProblem, Mount, Scene, Sensor};
use cplan::space::{Configuration, Path, Topology};
use cplan::{Point, engine};
use cplan_cases::seeds;
use cplan_testkit::flood::Cells;
use cplan_testkit::oracle::Oracle;
use cplan_testkit::solid::{Solid, V};
use cplan_testkit::world::{KINDS, world};
use std::f64::consts::TAU;

const STRATEGIES: [Strategy; 5] =
    [Strategy::Goal, Strategy::Nearest, Strategy::Harmonic, Strategy::View, Strategy::Wall];

/// Allowance for the rounding of a distance, in metres.
const ROUNDING: f64 = 1e-9;

/// If a ray meets two sides of cells within this distance, rounding decides which cell it meets first, in metres.
const CORNER: f64 = 1e-9;

/// Number of cells along both axes of joint space.
const GRID: [usize; 2] = [36, 40];

/// Returns a sensor whose rays do not run along the map's sides.
fn sensor(scene: &Scene, seed: u64) -> Sensor {
    let usual = Sensor::default_for(scene.arm());
    let mount = if seed.is_multiple_of(5) { Mount::Base } else { Mount::Tip };
    let noise = if seed % 3 == 1 { 0.3 * usual.cell } else { 0.0 };
    Sensor { mount, rays: 97, field_of_view: TAU - 0.1, noise, seed, ..usual }
}

fn explored(problem: &MotionProblem, sensor: &Sensor, strategy: Strategy) -> Exploration {
    explored_from(None, problem, sensor, strategy)
}

fn explored_from(
    known: Option<OccupancyMap>,
    problem: &MotionProblem,
    sensor: &Sensor,
    strategy: Strategy,
) -> Exploration {
    let options = engine::Options { boxes: 2000, levels: 1, ..Settings::default().options };
    let settings = Settings { strategy, cells: GRID, known, decisions: 3000, options, ..Settings::default() };
    let (scene, start) = (problem.scene(), problem.start());
    explore(scene, sensor, start, Some(problem.goals()), &settings, &mut |_| ()).expect("an exploration")
}

fn square(map: &OccupancyMap, cell: usize) -> [Point; 4] {
    let [width, height] = map.size;
    let (x, y) = ((cell % width) as f64, (height - 1 - cell / width) as f64);
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[u, v]| map.pose.point(Point::new((x + u) * map.resolution, (y + v) * map.resolution)))
}

/// Checks that free cells contain no obstacle, and occupied ones do.
fn map_is_true(scene: &Scene, map: &OccupancyMap) {
    let obstacles: Vec<Solid> =
        scene.workspace().obstacles.iter().flat_map(|obstacle| obstacle.pieces.iter().map(Solid::new)).collect();
    for cell in 0..map.cells.len() {
        let square = Solid::new(&Convex::new(square(map, cell).to_vec(), 0.0).expect("a square"));
        let nearest = obstacles.iter().map(|obstacle| square.distance(obstacle)).fold(f64::INFINITY, f64::min);
        match map.cells[cell] {
            Occupancy::Free => assert!(nearest > -ROUNDING, "free cell {cell} is {nearest} from an obstacle"),
            Occupancy::Occupied => assert!(nearest < ROUNDING, "occupied cell {cell} is {nearest} from an obstacle"),
            Occupancy::Unknown => {}
        }
    }
}

/// Returns an unknown cell that a ray of the sensor would show. Considers all sides of cells that the ray meets, in
/// order.
fn shown_by_ray(map: &OccupancyMap, from: Point, angle: f64, range: f64) -> Option<usize> {
    let local = map.pose.inverse_point(from) / map.resolution;
    let (from, ahead, far) = ([local.x, local.y], [angle.cos(), angle.sin()], range / map.resolution);
    let mut sides = vec![0.0];
    for k in 0..2 {
        sides
            .extend((0..=map.size[k]).map(|side| (side as f64 - from[k]) / ahead[k]).filter(|t| 0.0 < *t && *t <= far));
    }
    sides.sort_by(f64::total_cmp);
    for ends in sides.windows(2) {
        if ends[1] - ends[0] < CORNER {
            return None;
        }
        let middle = f64::midpoint(ends[0], ends[1]);
        let at = [0, 1].map(|k| (from[k] + ahead[k] * middle).floor());
        if (0..2).any(|k| at[k] < 0.0 || at[k] >= map.size[k] as f64) {
            return None;
        }
        let cell = (map.size[1] - 1 - at[1] as usize) * map.size[0] + at[0] as usize;
        match map.cells[cell] {
            Occupancy::Free => {}
            Occupancy::Occupied => return None,
            Occupancy::Unknown => return Some(cell),
        }
    }
    None
}

/// Returns the middles of the grid's cells that can be reached from the end of the exploration, by brute force in the
/// known part of the world.
fn reachable(oracle: &Oracle, topology: &Topology, from: Configuration) -> Vec<Configuration> {
    let cells = Cells { count: GRID, circles: topology.ranges.map(|axis| axis.is_circle()) };
    let domain: [V; 2] = topology.ranges.map(|axis| axis.domain().into());
    let middles: Vec<Configuration> = (0..GRID[0] * GRID[1]).map(|cell| cells.middle(domain, cell).into()).collect();
    let is_free: Vec<bool> = middles.iter().map(|at| oracle.room(*at) > ROUNDING).collect();
    let goes = |from: Configuration, to: Configuration| {
        let way = topology.displacement(from, to);
        oracle.violation(&Path::new(vec![from, from + way]), 0.0, 1e-2).is_none()
    };
    let is_near = |cell: &usize| {
        let way = topology.displacement(from, middles[*cell]);
        let step = [0, 1].map(|k| topology.ranges[k].extent() / GRID[k] as f64);
        is_free[*cell] && (0..2).all(|k| way[k].abs() <= 1.01 * step[k]) && goes(from, middles[*cell])
    };
    let near = (0..middles.len()).filter(is_near);
    let seen = cells.flood(near, |cell, next| is_free[next] && goes(middles[cell], middles[next]));
    middles.into_iter().zip(seen).filter_map(|(middle, seen)| seen.then_some(middle)).collect()
}

/// Checks all claims of an exploration. Returns in a word how it ended.
fn is_true(problem: &MotionProblem, sensor: &Sensor, done: &Exploration) -> &'static str {
    let (scene, arm) = (problem.scene(), problem.scene().arm());
    let (topology, map) = (arm.topology(), done.survey.map());
    map_is_true(scene, map);
    let oracle = Oracle::new(scene);
    let mut at = problem.start();
    for leg in &done.legs {
        let path = leg.curve.curve().path();
        assert!((path.start() - at).norm() < ROUNDING, "a leg begins elsewhere");
        assert_eq!(oracle.violation(path, -ROUNDING, 1e-3), None);
        at = path.goal();
    }
    let clearance = scene.workspace().clearance;
    match &done.ending {
        Ending::Reached => {
            assert!(problem.goals().contains(&topology, at, ROUNDING));
            let end = done.trajectory.as_ref().map_or(problem.start(), |t| t.position[t.position.len() - 1].into());
            assert!((end - at).norm() < ROUNDING);
        }
        Ending::Explored { given_up, .. } => {
            assert!(*given_up == 0 || sensor.noise > 0.0, "{given_up} given up without errors");
            // With a complete map, the arm need not move.
            if sensor.noise == 0.0 {
                let again = explored_from(Some(map.clone()), problem, sensor, Strategy::Nearest);
                assert!(again.legs.len() < 2 && again.survey.map() == map, "{} legs more", again.legs.len());
            }
            let known = done.survey.scene(arm, clearance, false);
            for q in reachable(&Oracle::new(&known), &topology, at) {
                let (from, ahead) = sensor.pose(arm, q.into());
                let new = sensor.rays(ahead).find_map(|angle| shown_by_ray(map, from, angle, sensor.range));
                // If distances have errors, a reading may have shown nothing there.
                assert!(new.is_none() || *given_up > 0, "cell {new:?} of the map can be seen from {q:?}");
            }
        }
        Ending::Unreachable(why) => {
            // Occupied cells are solid, both in the optimistic path's world and in the known part.
            let unknown_is_free = !why.contains("in what is known");
            let solid = Oracle::new(&done.survey.scene(arm, clearance, unknown_is_free));
            let goals: Vec<Configuration> = problem.goals().points().collect();
            assert_ne!(connected(&solid, at, &goals, 256), Truth::Connected, "{why}");
        }
        Ending::Unknown(_) => {}
    }
    done.ending.name()
}

#[test]
fn explorations_report_true_results() {
    let worlds: Option<u64> = std::env::var("CPLAN_WORLDS").ok().map(|n| n.parse().expect("a number of worlds"));
    let mut endings = std::collections::BTreeMap::<&str, usize>::new();
    let mut lengths = [const { Vec::new() }; 3];
    for kind in KINDS {
        for seed in seeds(worlds.unwrap_or(2)) {
            let Some(problem) = world(kind, seed) else { continue };
            let sensor = sensor(problem.scene(), seed);
            let all = STRATEGIES.map(|strategy| explored(&problem, &sensor, strategy));
            for done in &all {
                *endings.entry(is_true(&problem, &sensor, done)).or_default() += 1;
            }
            let is_whole = |done: &&Exploration| matches!(done.ending, Ending::Explored { .. }) && done.length > 1.0;
            for (lengths, other) in lengths.iter_mut().zip(&all[2..]) {
                if [&all[1], other].iter().all(is_whole) {
                    lengths.push(other.length / all[1].length);
                }
            }
        }
    }
    if worlds.is_some() {
        println!("{endings:?}");
        for (name, lengths) in ["harmonic", "view", "wall"].iter().zip(&mut lengths) {
            lengths.sort_by(f64::total_cmp);
            let shorter = lengths.iter().filter(|&&ratio| ratio <= 1.0).count();
            println!("{name} over nearest: {shorter} of {} no longer; {lengths:.2?}", lengths.len());
        }
    }
    // Few worlds are unreachable; `program cli::explore` has one.
    for ending in ["reached", "explored"] {
        assert!(endings.get(ending).is_some_and(|count| *count > 0), "{endings:?}");
    }
}

/// Checks explorations of one world for each kind of arm. In one of them, a path has a portal that is the only one of
/// its cell, and more than half a turn of joint 2 away.
#[test]
fn a_portal_beyond_half_a_turn_ends_a_sleeve() {
    let worlds: Vec<MotionProblem> = KINDS.iter().filter_map(|kind| world(kind, 11)).collect();
    assert!(!worlds.is_empty());
    for problem in worlds {
        let sensor = sensor(problem.scene(), 11);
        is_true(&problem, &sensor, &explored(&problem, &sensor, Strategy::Goal));
    }
}

#[test]
fn explorations_are_the_same_every_time() {
    let noisy = |problem: &MotionProblem| Sensor { noise: 0.01, ..sensor(problem.scene(), 3) };
    let looks_at_things = |problem: &MotionProblem| {
        let done = explored(problem, &noisy(problem), Strategy::Nearest);
        done.readings.len() > 9 && done.survey.counts()[1] > 9
    };
    let problem = seeds(20).filter_map(|seed| world("RR", seed)).find(looks_at_things).expect("a world with room");
    let [one, other] = [0, 1].map(|_| explored(&problem, &noisy(&problem), Strategy::Nearest));
    assert_eq!(one.readings, other.readings);
    assert_eq!(one.ending, other.ending);
    let different = explored(&problem, &Sensor { seed: 4, ..noisy(&problem) }, Strategy::Nearest);
    assert!(one.readings != different.readings, "the errors do not follow from the seed");
}

#[test]
fn maps_are_read_back_as_they_were() {
    let problem = seeds(9).find_map(|seed| world("PP", seed)).expect("a world");
    let done = explored(&problem, &sensor(problem.scene(), 0), Strategy::Harmonic);
    let folder = tempfile::tempdir().unwrap();
    let [picture, description] = ["a.pgm", "a.yaml"].map(|name| folder.path().join(name));
    std::fs::write(picture, map_picture(&done.survey)).unwrap();
    std::fs::write(&description, map_description(&done.survey, "a.pgm")).unwrap();
    let read = OccupancyMap { picture: None, ..OccupancyMap::read(&description).unwrap() };
    assert_eq!(&read, done.survey.map());
    assert!(done.survey.counts()[0] > 0, "{:?}", done.survey.counts());
}
