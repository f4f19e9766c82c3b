//! The check of a motion's start and goal.

use cplan_handling::Recording;
use cplan_model::space::Configuration;
use cplan_model::{Arm, Elbow, Goal};
use cplan_text::length;
use thiserror::Error;

/// Largest allowed distance between the ends of a motion and the required start and goal, in radians or metres. If
/// joint values are printed with six decimals, the tip of an arm of several metres is uncertain by about this much. The
/// tolerance is smaller than the repeatability of any arm.
pub const END_TOLERANCE: f64 = 1e-5;

/// A difference from the required start or goal.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum EndpointError {
    /// The motion begins elsewhere.
    #[error("the motion begins at ({}, {}), not at the start ({}, {})", is[0], is[1], start[0], start[1])]
    Start {
        /// The recorded start.
        is: Configuration,
        /// The required start.
        start: Configuration,
    },
    /// The motion ends elsewhere.
    #[error("the motion ends at ({}, {}), not at the goal ({}, {})", is[0], is[1], goal[0], goal[1])]
    Goal {
        /// The recorded end.
        is: Configuration,
        /// The required goal.
        goal: Configuration,
    },
    /// The tip is not at its required start.
    #[error("the motion begins with the tip {} from the start", length(*off))]
    TipAtStart {
        /// Distance of the tip from its required place, metres.
        off: f64,
    },
    /// The tip does not end at its required place.
    #[error("the motion ends with the tip {} from the goal", length(*off))]
    Tip {
        /// Distance of the tip from its required place, metres.
        off: f64,
    },
    /// The tip ends at its required place, but the elbow is on the wrong side.
    #[error("the motion ends with the elbow on the {}, not on the {}", elbow.other().name(), elbow.name())]
    Elbow {
        /// The required side.
        elbow: Elbow,
    },
}

/// Returns the differences from the start and from the goals that exceed [`END_TOLERANCE`]. Whole turns of continuous joints do
/// not count. The motion may end at any of the goals. If it ends at none, the difference from the first goal is reported.
pub fn endpoint_errors(arm: &Arm, recording: &Recording, start: Option<Goal>, goals: &[Goal]) -> Vec<EndpointError> {
    let positions = recording.positions();
    let (first, last) = (positions[0], positions[positions.len() - 1]);
    let misses = |a: Configuration, b: Configuration| arm.topology().displacement(a, b).amax() > END_TOLERANCE;
    let tip_off = |q: Configuration, goal: Goal| {
        let is = arm.tip_at(q);
        Some((is - goal.nearest_tip(is)?).norm()).filter(|off| *off > END_TOLERANCE)
    };
    let start = start.and_then(|start| match start {
        Goal::Joints(start) => misses(first, start).then_some(EndpointError::Start { is: first, start }),
        place => tip_off(first, place).map(|off| EndpointError::TipAtStart { off }),
    });
    let missed = |goal: &Goal| match goal.of_arm(arm) {
        Goal::Joints(goal) => misses(last, goal).then_some(EndpointError::Goal { is: last, goal }),
        place => {
            let elbow = place.elbow().filter(|elbow| elbow.excess(arm, last) > END_TOLERANCE);
            let elbow = elbow.map(|elbow| EndpointError::Elbow { elbow });
            tip_off(last, place).map(|off| EndpointError::Tip { off }).or(elbow)
        }
    };
    let all: Option<Vec<EndpointError>> = goals.iter().map(missed).collect();
    start.into_iter().chain(all.and_then(|misses| misses.first().copied())).collect()
}
