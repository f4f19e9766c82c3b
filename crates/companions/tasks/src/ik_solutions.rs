//! The configurations that put a point of the arm at a target.

use cplan_geometry::Point;
use cplan_handling::{Action, Step};
use cplan_model::space::Configuration;
use cplan_model::{Arm, Elbow, Goal, equivalent_values, inverse};

/// Displacement of a joint, radians or metres, that is due to rounding. It is far above the rounding of IK solutions and
/// of units, and far below the resolution of controllers. A joint does not move by so little.
pub(super) const JOINT_ROUNDING: f64 = 1e-12;

/// Returns `preferred` if a configuration differs from it only by rounding; otherwise the configuration.
fn without_rounding(q: Configuration, preferred: Configuration) -> Configuration {
    if (q - preferred).amax() <= JOINT_ROUNDING { preferred } else { q }
}

/// Returns the reason why a step without IK solutions is impossible.
pub(super) fn unreachable(step: &Step) -> String {
    let target = if matches!(step.action, Action::Follow(_)) { "the end of the line" } else { "its target" };
    format!("no IK solution within the joint limits{} reaches {target}", Elbow::describe(step.required_elbow()))
}

/// Configurations that reach a target.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct IkSolutions {
    /// Configurations within the joint limits. Empty if the target is out of reach.
    pub configurations: Vec<Configuration>,
    /// True if these are all solutions. Whole turns of a joint without limits do not count as further solutions.
    pub all: bool,
}

/// Returns all configurations within the limits that put the tip, or another point of link 2, at `target`, with the elbow
/// on the stated side. If there are infinitely many, returns those in which the free joint has its `preferred` value. A solution that differs from
/// `preferred` only by rounding becomes `preferred`, so that the arm does not move.
pub(super) fn ik_solutions(
    arm: &Arm,
    point: Point,
    (target, elbow): (Point, Option<Elbow>),
    preferred: Configuration,
) -> IkSolutions {
    let solved = if point == arm.tip {
        inverse(arm, target, preferred)
    } else {
        inverse(&Arm { tip: point, ..arm.clone() }, target, preferred)
    };
    let solved = solved.with_elbow(arm, elbow);
    let mut configurations = Vec::new();
    for branch in &solved.branches {
        let copies =
            [0, 1].map(|k| equivalent_values(arm.joints[k].range, arm.joints[k].joint_type.is_revolute(), branch[k]));
        for &first in &copies[0] {
            let solutions = copies[1].iter().map(|&second| Configuration::new(first, second));
            configurations.extend(solutions.map(|q| without_rounding(q, preferred)));
        }
    }
    // If the arm can stay where it is, this comes first, so that it does not move without saving time.
    configurations.sort_by_key(|q| *q != preferred);
    IkSolutions { configurations, all: solved.free.is_none() }
}

/// Returns the configurations within the limits that reach the goal of a move.
pub(super) fn goal_ik_solutions(arm: &Arm, goal: &Goal, preferred: Configuration) -> IkSolutions {
    match goal {
        Goal::Joints(q) => IkSolutions { configurations: vec![without_rounding(*q, preferred)], all: true },
        Goal::Tip(tip) | Goal::TipAndElbow(tip, _) => ik_solutions(arm, arm.tip, (*tip, goal.elbow()), preferred),
        Goal::Area([low, high]) => {
            // Tasks that have been checked contain no areas.
            let middle = ik_solutions(arm, arm.tip, ((low + high) * 0.5, None), preferred);
            IkSolutions { all: false, ..middle }
        }
    }
}
