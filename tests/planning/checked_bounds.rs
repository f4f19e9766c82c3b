//! Lower bounds, and evidence for them that is computed again. It confirms true bounds, and never a false one.

use cplan::Outcome;
use cplan::engine::{Bound, BoundCertificate, Criterion, Method, Planner, certificate_of_bound, solve};
use cplan::input::Overrides;
use cplan::model::MotionProblem;
use cplan_cases::{seeds, uses_default_cases};
use cplan_testkit::problems::shipped_feasible;
use cplan_testkit::world;

/// Fraction of a bound that may be lost when its evidence is computed again, because walls are found at finitely many
/// points. It is that of `cplan recheck`.
const MISSED: f64 = 1e-3;

/// Returns the bound that the program states for a path close to the shortest.
fn stated_bound(problem: &MotionProblem, criterion: Criterion) -> Option<Bound> {
    let planner = Planner::named(Method::Shortest).with_criterion(criterion);
    let answer = solve(problem, &planner.into(), &mut |_| {});
    answer.bound().filter(|_| matches!(answer.outcome, Outcome::Found(_)))
}

/// Returns the certificate of a bound. Returns `None` if the bound has none.
fn checked_certificate(problem: &MotionProblem, stated: &Bound) -> Option<BoundCertificate> {
    certificate_of_bound(problem, stated, &Overrides::default())
}

/// Returns the number of bounds, and a description of each bound that its certificate does not confirm.
fn unseen(problems: impl IntoIterator<Item = (String, MotionProblem, Criterion)>) -> (usize, Vec<String>) {
    let (mut count, mut unseen) = (0, Vec::new());
    for (name, problem, criterion) in problems {
        let Some(stated) = stated_bound(&problem, criterion) else { continue };
        // Goals that leave a joint free have no certificate.
        let Some(found) = checked_certificate(&problem, &stated) else { continue };
        let share = 1.0 - found.length / stated.lower;
        let words = format!("{name}: {} walls, less by {share:.1e}", found.walls);
        println!("{words}");
        count += 1;
        unseen.extend((share > MISSED).then_some(words));
    }
    (count, unseen)
}

#[test]
fn bounds_of_all_shipped_workspaces_are_confirmed() {
    // Certificates of bounds do not use the range of an elbow motor.
    let problems = shipped_feasible().into_iter().filter(|(_, problem)| problem.scene().arm().motors.is_none());
    let problems = problems.map(|(name, problem)| (name, problem, Criterion::Euclidean));
    let (count, unseen) = unseen(problems);
    assert!(count >= 15 && unseen.is_empty(), "{count}, but {unseen:#?}");
}

/// Iterates over random problems, each with its name and a criterion.
fn random_problems(count: u64) -> impl Iterator<Item = (String, MotionProblem, Criterion)> {
    seeds(count).filter_map(|seed| {
        let kind = world::KINDS[(seed % 4) as usize];
        let problem = world::world(kind, seed)?;
        let criteria = [Criterion::Euclidean, Criterion::Weighted([1.0, 0.4]), Criterion::Time];
        Some((format!("{kind} {seed}"), problem, criteria[(seed / 4 % 3) as usize]))
    })
}

#[test]
fn bounds_in_random_worlds_are_confirmed() {
    let (count, unseen) = unseen(random_problems(24));
    // Where shapes separate slowly, the walls between them are not found to their ends.
    assert!(!uses_default_cases() || count >= 10 && 10 * unseen.len() <= count, "{count}, but {unseen:#?}");
}

#[test]
fn evidence_for_a_false_bound_proves_only_the_truth() {
    let mut count = 0;
    // Few problems by default, because evidence with thousands of walls takes half a minute.
    for (name, problem, criterion) in random_problems(2) {
        let Some(stated) = stated_bound(&problem, criterion) else { continue };
        let boast = Bound { lower: 1.01 * stated.upper, upper: 1.01 * stated.upper, ..stated };
        let Some(found) = checked_certificate(&problem, &boast) else { continue };
        assert!(found.length <= stated.upper, "{name}: {} beyond a path of {}", found.length, stated.upper);
        count += 1;
    }
    assert!(!uses_default_cases() || count >= 2, "{count}");
}
