//! If it is proven that no timing along a path avoids the obstacles, brute force finds none either.

use cplan::geometry::{Point, Vector};
use cplan::model::{MovingObstacle, ObstacleTrajectory, Stop, TimedWorkspace, Workspace};
use cplan::space::{Configuration, JointRange, Path};
use cplan::{Options, Outcome, Problem, plan};
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::arms::rr;
use cplan_testkit::moving::{Moving, obstacle_at as moved};
use cplan_testkit::oracle::Oracle;
use cplan_testkit::scenes::{obstacle, placed, q};
use cplan_testkit::shapes::rectangle;

/// Number of places on the path (`PLACES`), longest time between two checks in seconds (`STEP`), and largest movement
/// between them in metres (`GOES`).
const PLACES: usize = 100;
const STEP: f64 = 0.02;
const GOES: f64 = 0.05;

#[test]
fn a_flood_fill_confirms_that_no_timing_helps() {
    let (refuted, unknown) = compare_with_flood_fill(Moving::all(seeds(10)));
    println!("{refuted} refuted, {unknown} open");
    assert!(!uses_default_cases() || refuted > 0, "nothing was refuted");
}

/// Checks worlds in which some obstacles cross the workspace in hundredths of a second. Checks at regular intervals
/// would miss these obstacles.
#[test]
fn refuted_timings_agree_with_a_flood_fill() {
    let (refuted, unknown) = compare_with_flood_fill(Moving::all(seeds(8)).map(|world| world.sped_up(100.0)));
    println!("{refuted} refuted, {unknown} open");
    assert!(!uses_default_cases() || refuted > 0, "nothing was refuted");
}

/// Compares proofs that no timing is possible with a flood fill. Returns the numbers of refuted and of undecided
/// worlds.
fn compare_with_flood_fill(worlds: impl Iterator<Item = Moving>) -> (usize, usize) {
    let (mut refuted, mut unknown) = (0, 0);
    for world in worlds {
        let plan = plan(&world.problem(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Outcome::Unknown(reason) = plan.outcome() else { continue };
        if !reason.contains("obstacle") || !reason.contains("move") {
            continue;
        }
        if !reason.contains("avoids the moving obstacles (proven)") {
            unknown += 1;
            continue;
        }
        refuted += 1;
        let standing =
            cplan::plan(&world.static_problem(), &Options { bounded: false, ..Options::default() }).expect("a plan");
        let Some(trajectory) = standing.trajectory() else { panic!("{}: there was a way", world.name) };
        assert!(trajectory.duration() > 0.0);
        let path = standing.waypoints().expect("a path");
        let path = Path::new(path.iter().map(|&q| q.into()).collect());
        assert!(!gets_through(&world, &path), "{}: a flood gets through", world.name);
    }
    (refuted, unknown)
}

/// Checks a bar that blocks every configuration of the path for a thousandth of a second, and moves at thousands of
/// metres per second. The proof that no timing is possible is right, although a search that checks every hundredth of a
/// second would not see the bar.
#[test]
fn a_momentary_block_refutes_every_timing() {
    let at = |time: f64, x: f64| Stop { time, at: Point::new(x, 0.0), angle: 0.0 };
    let stops = vec![at(0.1036, 9.0), at(0.1046, 0.0), at(0.1056, 9.0)];
    let mover = MovingObstacle {
        obstacle: obstacle("bar", rectangle(0.4, 0.6, -1.0, 1.0)),
        trajectory: ObstacleTrajectory::new(stops, Vector::zeros()).expect("a trajectory"),
    };
    let workspace = TimedWorkspace { movers: vec![mover.clone()], ..Workspace::new([]).into() };
    let arm = rr([JointRange::Interval { lower: -1.5, upper: 1.5 }; 2]);
    let (start, goal) = (q(-0.5, 0.2), q(0.6, -0.3));
    let problem = Problem::new(arm.clone(), workspace, start, goal).expect("a problem");
    let plan = plan(&problem, &Options::default()).expect("a plan");
    let Outcome::Unknown(reason) = plan.outcome() else { panic!("{:?}", plan.status()) };
    assert!(reason.contains("avoids the moving obstacles (proven)"), "{reason}");
    let there = |time: f64| Oracle::new(&placed(arm.clone(), Workspace::new([moved(&mover, time)])));
    for place in 0..=100 {
        let posture = start + (goal - start) * (f64::from(place) / 100.0);
        // The overlap is deeper than the arm moves from one of these places to the next.
        assert!(there(0.1046).room(posture) < -0.02, "{posture}");
        for look in (0..=100).map(|look| f64::from(look) * 0.01) {
            assert!(there(look).room(posture) > 0.1, "{posture} at {look}");
        }
    }
}

/// Returns the times of the checks. They are at regular intervals, and more frequent while an obstacle is fast.
fn check_times(world: &Moving) -> Vec<f64> {
    let count = (world.horizon() / STEP) as usize;
    let mut looks: Vec<f64> = (0..=count).map(|look| look as f64 * STEP).collect();
    for [from, to, speed] in world.speeds().into_iter().filter(|[_, to, _]| to.is_finite()) {
        let parts = (speed * (to - from) / GOES).ceil().max(1.0) as usize;
        looks.extend((0..=parts).map(|part| from + (to - from) * (part as f64 / parts as f64)));
    }
    looks.sort_by(f64::total_cmp);
    looks.dedup();
    looks
}

/// Returns true if the end of the path can be reached by steps between places and between checks, within the joints'
/// speeds.
fn gets_through(world: &Moving, path: &Path) -> bool {
    let at = |k: usize| -> Configuration { path.part(path.length() * k as f64 / PLACES as f64, f64::MAX).start() };
    let speeds = world.arm.joints.each_ref().map(|joint| joint.velocity);
    let places: Vec<Configuration> = (0..=PLACES).map(at).collect();
    let takes =
        |a: Configuration, b: Configuration| (0..2).map(|j| (b - a)[j].abs() / speeds[j]).fold(0.0_f64, f64::max);
    // Time to reach each place without a stop, in seconds.
    let gone: Vec<f64> = (0..=PLACES)
        .scan(0.0, |gone, k| {
            *gone += takes(places[k.saturating_sub(1)], places[k]);
            Some(*gone)
        })
        .collect();
    let (trajectories, arm) = (world.speeds(), world.movers_at(0.0).speed(speeds.into()));
    // The largest movement of an obstacle between two times.
    let goes = |[from, to]: [f64; 2]| {
        let met = trajectories.iter().filter(|[begins, ends, _]| *begins < to && from < *ends);
        (to - from) * (arm + met.map(|[.., speed]| *speed).fold(0.0, f64::max))
    };
    let looks = check_times(world);
    let mut there = vec![false; PLACES + 1];
    there[0] = true;
    for k in 1..looks.len() {
        let after = looks.get(k + 1).map_or(0.0, |next| goes([looks[k], *next]));
        // A clearance with which no contact can occur between two checks: the largest movement in half of the time to
        // the previous check and to the next one.
        let apart = goes([looks[k - 1], looks[k]]).max(after) / 2.0;
        let mut next = vec![false; PLACES + 1];
        for from in (0..=PLACES).filter(|&from| there[from]) {
            let within = |to: &usize| (gone[*to] - gone[from]).abs() <= looks[k] - looks[k - 1];
            (from..=PLACES).take_while(within).for_each(|to| next[to] = true);
            (0..from).rev().take_while(within).for_each(|to| next[to] = true);
        }
        let movers = world.movers_at(looks[k]);
        for (number, place) in places.iter().enumerate() {
            next[number] = next[number] && movers.room(*place) > apart;
        }
        if next[PLACES] {
            return true;
        }
        there = next;
    }
    false
}
