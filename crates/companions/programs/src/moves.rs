//! The parts of a program: joints, steps, moves, and the scenes in which moves are certified.

use crate::signals::SignalUse;
use crate::tolerance::JointTolerance;
use cplan_handling::{Driver, Drives, Stroke};
use cplan_legs::Leg;
use cplan_model::space::JointRange;
use cplan_model::{Heights, Scene};

/// A joint of a program.
#[derive(Debug, Clone)]
pub(crate) struct ProgramJoint {
    /// Name in the URDF.
    pub name: String,
    /// True if its values are lengths.
    pub slides: bool,
    /// Source of its value.
    pub driver: Driver,
    /// Its limits, radians or metres. `None` for a joint that the plan holds.
    pub range: Option<JointRange>,
}

impl ProgramJoint {
    /// Returns true if the plan gives the joint one value for the whole program.
    pub fn is_held(&self) -> bool {
        matches!(self.driver, Driver::Held(_))
    }

    /// Returns the share of a tolerance that applies to the joint, radians or metres.
    pub fn of(&self, tolerance: JointTolerance) -> f64 {
        if self.slides { tolerance.slide } else { tolerance.turn }
    }
}

/// The purpose of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MoveKind {
    /// The place of the arm before the program.
    Start,
    /// The arm moves. The tool is raised.
    Travel,
    /// The wrist turns. The arm stands still.
    Turn,
    /// The tool is lowered.
    Lower,
    /// The tool is raised.
    Raise,
}

/// A straight line in joint space that ends at rest.
#[derive(Debug, Clone)]
pub(crate) struct Move {
    pub kind: MoveKind,
    /// Index of its step.
    pub step: usize,
    /// Values of the program's joints at its end, radians or metres.
    pub values: Vec<f64>,
    /// Values from which they follow.
    pub drives: Drives,
    /// The gripper's action at its end: `close` or `open`.
    pub grip: Option<&'static str>,
    /// Time at rest after that, seconds.
    pub dwell: f64,
    /// Numbers of the signals that the program uses at its end, in their order.
    pub signals: Vec<(usize, SignalUse)>,
}

/// A step of a program.
#[derive(Debug, Clone)]
pub(crate) struct ProgramStep {
    pub number: usize,
    pub cycle: usize,
    /// Its kind: `pick`, `place` or `move`.
    pub action: &'static str,
    /// Its description.
    pub text: String,
    /// Name of the object that the gripper grasps or releases at its end.
    pub object: Option<String>,
    /// Name of the object in the gripper during its motion.
    pub carried: Option<String>,
    /// Fraction of the joints' top speeds, at most 1.
    pub speed: f64,
}

/// Consecutive moves with the tool raised, to be certified in one scene.
#[derive(Debug)]
pub(crate) struct Travel {
    /// The scene, with the tool and its payload at all heights that the tolerance allows.
    pub scene: Scene,
    /// Indices of the moves between which the arm travels, the first and the last one included.
    pub moves: [usize; 2],
}

/// Returns the scene of a step's motion, with the tool and its payload at all heights that the tolerance allows.
pub(crate) fn widened(leg: &Leg, stroke: Option<&Stroke>, tolerance: JointTolerance) -> Scene {
    let by = tolerance.slide + JointTolerance::ROUNDING.slide;
    let Some(stroke) = stroke else { return Scene::clone(&leg.scene) };
    let scene = leg.scene.changed(|arm, _| *arm = stroke.swept(arm, &[by, -by]));
    let heights = scene.attachment().map(|attachment| attachment.heights);
    heights.map_or(scene.clone(), |Heights { lower, upper }| {
        scene.with_attached_heights(Heights { lower: lower - by, upper: upper + by })
    })
}

/// Checks that an object meets no more obstacles at the heights that the tolerance allows (`widened`) than at its own. Then
/// the plan's certificate of its turn covers these heights.
///
/// # Errors
/// A description of shapes that it meets only because of the tolerance.
pub(crate) fn check_turn(scene: &Scene, widened: &Scene) -> Result<(), String> {
    let mut carried = widened.pairs().iter().filter(|pair| widened.is_attached(**pair));
    match carried.find(|pair| !scene.pairs().contains(pair)) {
        Some(pair) => Err(format!("{} can touch within the tolerance of the heights", widened.describe(*pair))),
        None => Ok(()),
    }
}
