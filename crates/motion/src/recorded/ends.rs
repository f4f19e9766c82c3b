//! Whether a motion leads from where it should begin to where it should end.

use cplan_core::model::{Arm, Goal};
use cplan_core::space::{Configuration, Recording};
use cplan_geometry::Point;
use thiserror::Error;

/// By how much a motion may miss its start or goal, radians or metres: what six printed decimals make of a tip some metres
/// from its joints, and less than any arm repeats.
pub const ENDS_WITHIN: f64 = 1e-5;

/// Where a motion does not begin or end as it should.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Miss {
    /// It begins elsewhere.
    #[error("the motion begins at ({}, {}), not at the start ({}, {})", is[0], is[1], start[0], start[1])]
    Start {
        /// Where it begins.
        is: Configuration,
        /// Where it was to begin.
        start: Configuration,
    },
    /// It ends elsewhere.
    #[error("the motion ends at ({}, {}), not at the goal ({}, {})", is[0], is[1], goal[0], goal[1])]
    Goal {
        /// Where it ends.
        is: Configuration,
        /// Where it was to end.
        goal: Configuration,
    },
    /// The tip is not where it was to be at first.
    #[error("the motion begins with the tip {off:.6} m from the start")]
    TipAtStart {
        /// How far it is from there, metres.
        off: f64,
    },
    /// The tip is not where it was to go.
    #[error("the motion ends with the tip {off:.6} m from the goal")]
    Tip {
        /// How far it is from there, metres.
        off: f64,
    },
}

/// Where a motion misses its start and its goal by more than [`ENDS_WITHIN`], if it has them; whole turns of joints on circles aside.
#[must_use]
pub fn ends_kept(arm: &Arm, recording: &Recording, start: Option<Goal>, goal: Option<Goal>) -> Vec<Miss> {
    let positions = recording.positions();
    let (first, last) = (positions[0], positions[positions.len() - 1]);
    let misses = |a: Configuration, b: Configuration| arm.topology().displacement(a, b).amax() > ENDS_WITHIN;
    let tip_off = |q: Configuration, tip: Point| Some((arm.tip_at(q) - tip).norm()).filter(|off| *off > ENDS_WITHIN);
    let start = start.and_then(|start| match start {
        Goal::Joints(start) => misses(first, start).then_some(Miss::Start { is: first, start }),
        Goal::Tip(tip) => tip_off(first, tip).map(|off| Miss::TipAtStart { off }),
    });
    let goal = goal.and_then(|goal| match goal {
        Goal::Joints(goal) => misses(last, goal).then_some(Miss::Goal { is: last, goal }),
        Goal::Tip(tip) => tip_off(last, tip).map(|off| Miss::Tip { off }),
    });
    start.into_iter().chain(goal).collect()
}
