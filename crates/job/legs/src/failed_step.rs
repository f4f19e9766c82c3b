//! The step of a task that fails.

use cplan_handling::Step;
use cplan_judge::CheckedProof;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use std::sync::Arc;

/// An IK solution at the target of a failed step that the arm cannot reach, or is not known to reach.
#[derive(Debug, Clone, PartialEq)]
pub struct RefusedIkSolution {
    /// The values of both joints.
    pub ik_solution: Configuration,
    /// The reason, in words.
    pub reason: String,
    /// Proof that collision boxes separate the solution from the arm's configuration. `None` if the reason is another one.
    pub proof: Option<CheckedProof>,
}

/// A step that cannot be performed, or is not known to be possible. The same holds in every other order of the task.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedStep {
    /// The step that fails, in the order that allows the most steps before the failure.
    pub step: Step,
    /// Reasons in words, for all motions that were tried. Some of these begin with other IK solutions or other grips than those
    /// at the end of the answer's steps.
    pub reasons: Vec<String>,
    /// The world after the earlier steps, with the payload of the failing motion.
    pub scene: Arc<Scene>,
    /// The objects that still move by themselves at that time.
    pub moving: Arc<[usize]>,
    /// Configuration of the arm after the earlier steps.
    pub from: Configuration,
    /// The IK solutions of the target that motions from there tried to reach. Empty if no IK solution is within the joint limits.
    pub ik_solutions: Vec<RefusedIkSolution>,
    /// Standstills before and after the motions that were tried: before them, the tool is raised; after them, it is lowered, or
    /// objects change. If a solution has several standstills, one free standstill suffices.
    pub standstills: [Vec<Standstill>; 2],
}

/// A configuration at an end of a motion, with the scenes in which the arm stands still there: while its tool is lowered, or
/// after objects have changed their places. In all scenes, obstacles have the same numbers as during the motion.
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
    /// A phrase for messages that says when the scene applies, such as `while the tool is lowered`.
    pub when: &'static str,
    /// The arm, with its tool at the heights of that time, among the obstacles of that time.
    pub scene: Scene,
}

impl Standstill {
    /// Returns the index of the first scene in which the arm is not free. `None` if it is free in all of them.
    pub fn blocked_scene(&self) -> Option<usize> {
        self.scenes.iter().position(|standing| !standing.scene.obstructions(self.at).is_empty())
    }
}
