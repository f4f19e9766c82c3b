//! A point that two slides move. Its configuration space is the plane, up to a linear map, and its shortest paths are
//! known.

use super::{LIMITS, ROUNDING, bound};
use cplan::geometry::{Convex, Point};
use cplan::model::MotionProblem;
use cplan::space::{Configuration, GoalSet, Metric};
use cplan_testkit::arms::slides;
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::{q, scene};
use cplan_testkit::shapes::{convex, disc, rectangle};
use std::f64::consts::TAU;

/// Half the range of each slide, metres.
pub const REACH: f64 = 2.0;

/// Returns a tool without extent whose slides point along `angles`, among `pieces`.
pub fn gantry(angles: [f64; 2], pieces: Vec<Convex>, start: Configuration, goals: &[Configuration]) -> MotionProblem {
    let arm = slides(angles, [-REACH, REACH], vec![disc(Point::zeros(), 0.0)]);
    motion_problem(scene(arm, pieces), start, goals.iter().copied().collect::<GoalSet>())
}

/// Returns the gantry with slides along x and y.
pub fn square(pieces: Vec<Convex>, start: Configuration, goal: Configuration) -> MotionProblem {
    gantry([0.0, TAU / 4.0], pieces, start, &[goal])
}

/// Checks that the bound is within the gap below a known length, whatever limit of the length the search starts from.
fn assert_bound_near(problem: &MotionProblem, length: f64) {
    for factor in LIMITS {
        let found = bound(problem, Metric::Euclidean, factor * length, 1e-5 / factor);
        assert!(found <= length * (1.0 + ROUNDING) && found >= length * (1.0 - 1e-4), "{found}, not {length}");
    }
}

#[test]
fn the_bound_around_a_block_is_known() {
    let block = rectangle(-0.5, 0.5, -2.5, 0.25);
    assert_bound_near(&square(vec![block], q(-1.5, 0.0), q(1.5, 0.0)), 1.0 + 2.0 * 1.0_f64.hypot(0.25));
}

/// Checks a path out of a U, around one of its sides, and along its outside: four straight pieces.
#[test]
fn the_bound_out_of_a_trap_is_known() {
    let walls =
        vec![rectangle(-0.6, 0.6, -0.6, -0.5), rectangle(-0.6, -0.5, -0.6, 0.7), rectangle(0.5, 0.6, -0.6, 0.8)];
    let (start, goal) = (q(0.1, -0.3), q(0.05, -1.2));
    let out = |side: f64, top: f64| {
        let corners = [start, q(side * 0.5, top), q(side * 0.6, top), q(side * 0.6, -0.6), goal];
        corners.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>()
    };
    assert_bound_near(&square(walls.clone(), start, goal), out(-1.0, 0.7).min(out(1.0, 0.8)));
    // The same U, turned by a right angle.
    let turned = walls.iter().map(|w| convex(w.core().iter().map(|p| Point::new(-p.y, p.x)).collect(), 0.0));
    let turn = |p: Configuration| q(-p[1], p[0]);
    assert_bound_near(&square(turned.collect(), turn(start), turn(goal)), out(-1.0, 0.7).min(out(1.0, 0.8)));
}

/// Checks a wall that spans the whole space except for a slot a hundredth wide.
#[test]
fn the_bound_through_a_slot_is_known() {
    let walls = vec![rectangle(-0.05, 0.05, -3.0, 0.7), rectangle(-0.05, 0.05, 0.71, 3.0)];
    let length = 2.0 * 0.95_f64.hypot(0.7) + 0.1;
    assert_bound_near(&square(walls.clone(), q(-1.0, 0.0), q(1.0, 0.0)), length);
    let turned = walls.iter().map(|w| convex(w.core().iter().map(|p| Point::new(-p.y, p.x)).collect(), 0.0));
    assert_bound_near(&square(turned.collect(), q(0.0, -1.0), q(0.0, 1.0)), length);
}

/// Checks two slots in walls behind one another, far apart. The path leads to one slot, and then back to the other.
#[test]
fn the_bound_through_two_slots_is_known() {
    let wall = |x: f64, slot: f64| [rectangle(x, x + 0.1, -3.0, slot), rectangle(x, x + 0.1, slot + 0.01, 3.0)];
    let walls = [wall(-0.5, 0.7), wall(0.4, -0.9)].concat();
    let corners = [q(-1.0, 0.0), q(-0.5, 0.7), q(-0.4, 0.7), q(0.4, -0.89), q(0.5, -0.89), q(1.0, 0.0)];
    let length = corners.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    assert_bound_near(&square(walls, q(-1.0, 0.0), q(1.0, 0.0)), length);
}

/// Checks a path around a disc, which consists of two tangents and an arc.
#[test]
fn the_bound_around_a_disc_is_known() {
    let tangent = (1.5_f64 * 1.5 - 0.5 * 0.5).sqrt();
    let arc = 0.5 * (TAU / 2.0 - 2.0 * (0.5_f64 / 1.5).acos());
    let round = disc(Point::zeros(), 0.5);
    assert_bound_near(&square(vec![round], q(-1.5, 0.0), q(1.5, 0.0)), 2.0 * tangent + arc);
    // The same for a point with a clearance.
    let smaller = square(vec![disc(Point::zeros(), 0.2)], q(-1.5, 0.0), q(1.5, 0.0));
    let scene = smaller.scene().clone().with_clearance(0.3).unwrap();
    assert_bound_near(&motion_problem(scene, q(-1.5, 0.0), q(1.5, 0.0)), 2.0 * tangent + arc);
}

/// Checks a wall from side to side. It leaves no path, so the bound exceeds any limit.
#[test]
fn no_path_is_shorter_than_any_limit() {
    let problem = square(vec![rectangle(-0.1, 0.1, -3.0, 3.0)], q(-1.0, 0.0), q(1.0, 0.0));
    for limit in [3.0, 50.0] {
        let found = bound(&problem, Metric::Euclidean, limit, 1e-4);
        assert!(found <= limit && found >= limit * (1.0 - 1e-8), "{found}");
    }
}
