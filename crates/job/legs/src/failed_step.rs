//! The step of a task that fails.

use cplan_handling::Step;
use cplan_judge::CheckedProof;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use std::sync::Arc;

/// An IK solution at the target of a step that the arm cannot reach, or is not known to reach.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedIkSolution {
    /// The values of both joints.
    pub ik_solution: Configuration,
    /// The reason, in words.
    pub reason: String,
    /// Proof that boxes of colliding configurations separate the solution from the arm's configuration. `None` if the
    /// reason is another one.
    pub proof: Option<CheckedProof>,
}

/// A step that cannot be done, or that is not known to be possible. The same then holds in every other order of the
/// task.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedStep {
    /// The first step that cannot be done, in the order in which the most steps can be done before that.
    pub step: Step,
    /// Reasons in words, with the motions that were tried. Some of these motions begin with other IK solutions or other
    /// grips than those at the end of the answer's steps.
    pub reasons: Vec<String>,
    /// The world after the earlier steps, with the payload of the motion that fails.
    pub scene: Arc<Scene>,
    /// The objects that still move by themselves at that time.
    pub moving: Arc<[usize]>,
    /// Configuration of the arm after the earlier steps.
    pub from: Configuration,
    /// The IK solutions to which motions from there were tried. Empty if no IK solution within the joint limits reaches
    /// the target.
    pub ik_solutions: Vec<RefusedIkSolution>,
    /// Standstills before and after the motions that were tried. Before them, the tool is raised. After them, the tool
    /// is lowered, or objects have changed. A solution with several standstills can be used if one of them is free.
    pub standstills: [Vec<Standstill>; 2],
}

/// A configuration at an end of a motion, with the scenes in which the arm stands still there: while its tool is
/// lowered, or after objects have changed their places. The obstacles of all scenes have the numbers that they have
/// during the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Standstill {
    /// The configuration.
    pub at: Configuration,
    /// The scenes. The arm must be free in all of them.
    pub scenes: Vec<StandstillScene>,
}

/// A scene in which the arm stands still.
#[derive(Debug, Clone, PartialEq)]
pub struct StandstillScene {
    /// The time of the scene as a phrase for messages, such as `while the tool is lowered`.
    pub when: &'static str,
    /// The arm with its tool at the heights of this time, among the obstacles of this time.
    pub scene: Scene,
}

impl Standstill {
    /// Returns the index of the first scene in which the arm is not free. `None` if it is free in all of them.
    pub fn blocked_scene(&self) -> Option<usize> {
        self.scenes.iter().position(|standing| !standing.scene.obstructions(self.at).is_empty())
    }
}
