//! Lower bounds and their evidence, which is computed again: evidence confirms true bounds, and none confirms a false
//! one.

use crate::common::random::{seeds, usual};
use crate::common::shipped_feasible;
use crate::random_worlds::world;
use cplan::Outcome;
use cplan::engine::{Bound, Criterion, Method, Planner, certificate_of_bound, solve};
use cplan::input::Overrides;
use cplan::model::MotionProblem;

/// Share of a bound that its evidence may miss, because walls are found at finitely many points: that of `cplan recheck`.
const MISSED: f64 = 1e-3;

/// Returns the bound that accompanies a path close to the shortest.
fn stated(problem: &MotionProblem, criterion: Criterion) -> Option<Bound> {
    let planner = Planner::named(Method::Shortest).with_criterion(criterion);
    let answer = solve(problem, &planner.into(), &mut |_| {});
    answer.bound().filter(|_| matches!(answer.outcome, Outcome::Found(_)))
}

/// Returns the number of bounds, and a description of each bound for which the evidence shows less. Panics if evidence
/// shows more than is true.
fn unseen(problems: impl IntoIterator<Item = (String, MotionProblem, Criterion)>) -> (usize, Vec<String>) {
    let (mut count, mut unseen) = (0, Vec::new());
    for (name, problem, criterion) in problems {
        let Some(stated) = stated(&problem, criterion) else { continue };
        let seen = |stated: &Bound| certificate_of_bound(&problem, stated, &Overrides::default());
        // Goals that leave a joint free have no certificate.
        let Some(found) = seen(&stated) else { continue };
        let share = 1.0 - found.length / stated.lower;
        let words = format!("{name}: {} walls, less by {share:.1e}", found.walls);
        println!("{words}");
        count += 1;
        unseen.extend((share > MISSED).then_some(words));
        // However much is claimed, what is seen is true.
        let boast = Bound { lower: 1.1 * stated.upper, upper: 1.1 * stated.upper, ..stated };
        let length = seen(&boast).map_or(0.0, |found| found.length);
        assert!(length <= stated.upper, "{name}: {length} beyond a path of {}", stated.upper);
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
    assert!(!usual() || count >= 10 && unseen.is_empty(), "{count}, but {unseen:#?}");
}
