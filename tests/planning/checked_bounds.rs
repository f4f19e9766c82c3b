//! Lower bounds, checked by the judge: those that hold are seen to hold, and false ones are not.

use crate::common::random::{seeds, usual};
use crate::common::{self, Benchmark, shipped_feasible};
use crate::random_worlds::world;
use cplan::Outcome;
use cplan::check::{CheckedBound, LengthClaim};
use cplan::engine::{Bound, Criterion, Method, Planner, solve};
use cplan::model::MotionProblem;
use cplan::search::{Motions, claimed_length};
use cplan::space::Metric;
use std::time::Instant;

/// What the judge may not see, as a share of the length: walls whose ends it does not see to the last.
const UNSEEN: f64 = 1e-6;

/// The length of a path that is about the shortest.
fn length(problem: &MotionProblem, criterion: Criterion) -> Option<f64> {
    let planner = Planner::named(Method::Shortest).with_criterion(criterion);
    let answer = solve(problem, &planner.into(), &mut |_| {});
    let Bound { upper, .. } = answer.bound()?;
    matches!(answer.outcome, Outcome::Found(_)).then_some(upper)
}

fn claim(problem: &MotionProblem, metric: Metric, limit: f64) -> LengthClaim {
    let (scene, start, goals) = (problem.scene(), problem.start(), problem.goals());
    let motions = Motions { scene, start, goals, clearance: scene.workspace().clearance, metric };
    claimed_length(&motions, limit, 1e-4, &[])
}

fn checked(problem: &MotionProblem, metric: Metric, claim: &LengthClaim) -> CheckedBound {
    let scene = problem.scene();
    claim.checked(scene, problem.start(), problem.goals(), scene.workspace().clearance, metric)
}

/// Which of these the judge sees less closed for, in words; panics where it sees more than is true.
fn unseen(problems: impl IntoIterator<Item = (String, MotionProblem, Criterion)>) -> (usize, Vec<String>) {
    let (mut count, mut unseen) = (0, Vec::new());
    for (name, problem, criterion) in problems {
        let metric = criterion.metric(problem.scene().arm());
        let Some(limit) = length(&problem, criterion) else { continue };
        let claim = claim(&problem, metric, limit);
        let clock = Instant::now();
        let found = checked(&problem, metric, &claim);
        let share = 1.0 - found.length() / claim.length;
        let words = format!("{name}: {} slices, less by {share:.1e}, {} refused", claim.slices.len(), found.refused());
        println!("{words}, {:.0?}", clock.elapsed());
        count += 1;
        unseen.extend((share > UNSEEN).then_some(words));
        // However much is claimed, what is seen is true.
        let boast = LengthClaim { length: 2.0 * limit, ..claim };
        let length = checked(&problem, metric, &boast).length();
        assert!(length <= limit, "{name}: {length} beyond a path of {limit}");
    }
    (count, unseen)
}

#[test]
fn bounds_of_all_shipped_workspaces_are_seen_to_hold() {
    let problems = shipped_feasible().into_iter().map(|(name, problem)| (name, problem, Criterion::Euclidean));
    let (count, unseen) = unseen(problems);
    assert!(count >= 15 && unseen.is_empty(), "{count}, but {unseen:#?}");
}

#[test]
fn bounds_in_random_worlds_are_seen_to_hold() {
    let problems = seeds(24).filter_map(|seed| {
        let kind = world::KINDS[(seed % 4) as usize];
        let problem = world::world(kind, seed)?;
        let criteria = [Criterion::Euclidean, Criterion::Weighted([1.0, 0.4]), Criterion::Time];
        Some((format!("{kind} {seed}"), problem, criteria[(seed / 4 % 3) as usize]))
    });
    let (count, unseen) = unseen(problems);
    assert!(!usual() || count >= 10 && 10 * unseen.len() <= count, "{count}, but {unseen:#?}");
}

/// Evidence that is not true is not taken for true.
#[test]
fn false_evidence_proves_nothing() {
    let problem = common::problem(Benchmark::A);
    let (scene, metric) = (problem.scene(), Metric::Euclidean);
    let straight = problem.goals().distance(&scene.arm().topology(), metric, problem.start());
    let claim = claim(&problem, metric, 6.43);
    assert!(claim.length > 6.42 && straight < 3.0, "{} {straight}", claim.length);
    let shifted = |by: f64| {
        let mut claim = claim.clone();
        claim.slices.iter_mut().flat_map(|row| &mut row.walls).for_each(|wall| {
            wall.lower += by;
            wall.upper += by;
        });
        checked(&problem, metric, &claim)
    };
    assert_eq!(shifted(0.0).refused(), 0);
    // Walls wide of the mark are refused, and then barriers end nowhere.
    assert!(shifted(1.0).refused() > 20 && shifted(1.0).length() < 6.0, "{:?}", shifted(1.0));
    let swapped = {
        let mut claim = claim.clone();
        claim.slices.swap(3, 4);
        checked(&problem, metric, &claim)
    };
    // A slice out of order counts for nothing, and then no barrier does.
    assert!(swapped.refused() > 0 && swapped.length() < claim.length - 0.1, "{swapped:?}");
    let none = LengthClaim { slices: Vec::new(), ..claim.clone() };
    assert!(checked(&problem, metric, &none).length() <= straight);
    // Another scene, in which the way is open elsewhere.
    let other = common::problem(Benchmark::B);
    let elsewhere = checked(&other, metric, &claim);
    assert!(elsewhere.refused() > 0, "{elsewhere:?}");
}
