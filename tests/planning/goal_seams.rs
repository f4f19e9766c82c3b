//! Sets of goals that end at the seam of a circle, lie on it or cross it. The seam has no meaning, so the same set in
//! another notation gives the same result, with every planner.

use cplan::Outcome;
use cplan::engine::{Method, Planner, solve};
use cplan::model::{MotionProblem, Scene};
use cplan::space::{Configuration, GoalSet, JointRange, Path, Segment};
use cplan_cases::dice::Dice;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::arms::rr;
use cplan_testkit::problems::motion_problem;
use cplan_testkit::scenes::{discs_and_walls, scene};
use std::f64::consts::PI;

/// Number of single goals of a set for which the test plans one by one.
const TRIED: u32 = 12;

/// Goals whose distance from obstacles is less than this, in metres, may be missing in a planner's space.
const ROOMY: f64 = 0.01;

/// Draws a value at a seam, beside it, or anywhere.
fn at_seam(dice: &mut Dice) -> f64 {
    let seam = if dice.below(2) == 0 { PI } else { -PI };
    match dice.below(4) {
        0 | 1 => seam,
        2 => seam + dice.within(-0.3, 0.3),
        _ => dice.within(-PI, PI),
    }
}

/// Draws a segment along one joint, or slanted, near the seam of a circle.
fn segment(dice: &mut Dice, scene: &Scene) -> Segment {
    let axes = scene.arm().topology().ranges;
    let mut from = Configuration::from_fn(|k, _| match axes[k].domain() {
        _ if axes[k].is_circle() => at_seam(dice),
        (lower, upper) => dice.within(lower, upper),
    });
    let sign = if dice.below(2) == 0 { 1.0 } else { -1.0 };
    let length = dice.within(0.2, 3.0);
    let along = [[1.0, 0.0], [0.0, 1.0], [1.0, sign]][dice.below(3) as usize];
    let mut to = from + Configuration::from(along) * length;
    for k in 0..2 {
        let (lower, upper) = axes[k].domain();
        if !axes[k].is_circle() {
            (from[k], to[k]) = (from[k].clamp(lower, upper), to[k].clamp(lower, upper));
        }
    }
    if dice.below(2) == 0 { Segment::new(from, to) } else { Segment::new(to, from) }
}

/// Returns the same set in other notations: reversed, some turns away, and in pieces that end at each seam.
fn equivalent_goal_sets(problem: &MotionProblem, goals: Segment) -> Vec<GoalSet> {
    let axes = problem.scene().arm().topology().ranges;
    let [from, to] = goals.ends();
    let turns = [0, 1].map(|k| if axes[k].is_circle() { 1.0 - 3.0 * k as f64 } else { 0.0 });
    // Fractions of the segment at which it crosses a seam, an odd number of half turns.
    let mut cuts = vec![0.0, 1.0];
    for k in (0..2).filter(|&k| axes[k].is_circle() && from[k] != to[k]) {
        let seams = [-3.0, -1.0, 1.0, 3.0, 5.0].map(|half| (half * PI - from[k]) / (to[k] - from[k]));
        cuts.extend(seams.into_iter().filter(|share| 0.0 < *share && *share < 1.0));
    }
    cuts.sort_by(f64::total_cmp);
    let pieces = cuts.windows(2).map(|pair| Segment::new(goals.at(pair[0]), goals.at(pair[1])));
    vec![goals.into(), Segment::new(to, from).into(), goals.turned(turns).into(), pieces.collect()]
}

fn world(seed: u64) -> Option<(MotionProblem, Segment)> {
    let mut dice = Dice::new(seed.wrapping_mul(0x9E6C_63D0_876A_68DE));
    let limited = JointRange::Interval { lower: -dice.within(1.0, 4.0), upper: dice.within(1.0, 4.0) };
    let axes = match dice.below(4) {
        0 => [JointRange::Circle, limited],
        1 => [limited, JointRange::Circle],
        _ => [JointRange::Circle; 2],
    };
    let count = dice.below(6);
    let pieces = discs_and_walls(&mut dice, count, [0.4, 1.8]);
    let scene = scene(rr(axes), pieces);
    let anywhere = |dice: &mut Dice| {
        Configuration::from_fn(|k, _| {
            let (lower, upper) = axes[k].domain();
            if axes[k].is_circle() && dice.below(3) == 0 { at_seam(dice) } else { dice.within(lower, upper) }
        })
    };
    let start = (0..50).map(|_| anywhere(&mut dice)).find(|&q| scene.clearance(q) > 1e-3)?;
    let goals = segment(&mut dice, &scene);
    scene.blocked_along(&goals).is_none().then(|| (motion_problem(scene, start, goals), goals))
}

fn path_found_by(problem: &MotionProblem, planner: Planner) -> Option<Path> {
    match solve(problem, &planner.into(), &mut |_| {}).outcome {
        Outcome::Found(path) => Some(path.path().clone()),
        Outcome::Infeasible(_) | Outcome::Unknown(_) => None,
    }
}

#[test]
fn a_seam_makes_no_difference_to_any_planner() {
    let (mut worlds, mut across) = (0, 0);
    for seed in seeds(10) {
        let Some((problem, goals)) = world(seed) else { continue };
        let (scene, start) = (problem.scene(), problem.start());
        let topology = scene.arm().topology();
        let sets = equivalent_goal_sets(&problem, goals);
        across += u64::from(sets[3].pieces().len() > 1);
        worlds += 1;
        for method in Method::ALL {
            let lengths: Vec<Option<f64>> = sets
                .iter()
                .map(|set| {
                    let path = path_found_by(
                        &motion_problem(scene.clone(), start, set.clone()),
                        Planner::named(method).with_cells(96),
                    )?;
                    for set in &sets {
                        assert!(set.contains(&topology, path.goal(), 1e-9), "seed {seed}, {method}: {}", path.goal());
                    }
                    Some(path.length())
                })
                .collect();
            let least = lengths.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            // Only visibility looks for the shortest path. For other planners, rounding decides which cells or boxes
            // contain a start or goal on their sides, and so which of several almost equally near goals is chosen. The
            // farthest is less than half as far again.
            let same = if method == Method::Visibility { 1e-6 } else { 0.5 };
            let alike = |length: &Option<f64>| length.map_or(least.is_infinite(), |l| l <= least * (1.0 + same) + same);
            assert!(lengths.iter().all(alike), "seed {seed}, {method}: {lengths:?} of {sets:?} from {start}");
            if method == Method::Visibility && least.is_finite() {
                for k in 0..=TRIED {
                    let goal = goals.at(f64::from(k) / f64::from(TRIED));
                    if scene.clearance(goal) > ROOMY
                        && let Some(path) = path_found_by(
                            &motion_problem(scene.clone(), start, goal),
                            Planner::named(method).with_cells(96),
                        )
                    {
                        let other = path.length();
                        assert!(least <= other * (1.0 + 1e-9), "seed {seed}: {least}, but {other} to {goal} of them");
                    }
                }
            }
        }
    }
    assert!(!uses_default_cases() || worlds >= 6 && across > worlds / 4, "{worlds} worlds, {across} across a seam");
}
