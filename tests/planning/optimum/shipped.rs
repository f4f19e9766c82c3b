//! The shipped workspaces: how far the bounds are from the best known paths.

use super::{ROUNDING, bound};
use cplan::Outcome;
use cplan::engine::{Method, Planner, solve};
use cplan::space::Metric;
use cplan_testkit::problems::shipped_feasible;

/// Requested gap. The best known path, which is itself within a thousandth of the optimum, must also be within this
/// gap.
const GAP: f64 = 1e-4;
const NEAR: f64 = 2e-3;

#[test]
fn bounds_come_near_the_best_known_paths() {
    let mut far = Vec::new();
    for (name, problem) in shipped_feasible() {
        let planner = Planner::named(Method::Visibility).with_gap(1e-3);
        let Outcome::Found(found) = solve(&problem, &planner.into(), &mut |_| {}).outcome else {
            panic!("{name}: no path")
        };
        let length = found.path().length();
        let lower = bound(&problem, Metric::Euclidean, 2.0 * length, GAP);
        assert!(lower <= length * (1.0 + ROUNDING), "{name}: {lower} above {length}");
        if lower < length * (1.0 - NEAR) {
            far.push((name, lower, length));
        }
    }
    assert!(far.is_empty(), "{far:?}");
}
