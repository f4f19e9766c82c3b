//! The program of a plan.

use crate::builder::{Builder, Moves};
use crate::error::ProgramError;
use crate::moves::{Move, ProgramJoint, ProgramStep, Travel};
use crate::tolerance::JointTolerance;
use cplan_engine::{Detail, Plan, Problem};
use cplan_handling::{Action, Holding, RobotJoints, Task};
use cplan_legs::Leg;
use cplan_model::Motors;
use cplan_model::space::{JointRange, Path};

/// Displacement of a joint that is due to rounding, radians or metres.
const ROUNDING: f64 = 1e-9;

/// The part of a step to which a move belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MovePart {
    /// The tool is raised before the arm moves.
    Raising,
    /// The arm moves.
    Travel,
    /// The arm rests while the tool acts.
    Acts,
}

/// The joint moves of a plan.
#[derive(Debug)]
pub struct Program {
    pub(crate) robot: String,
    pub(crate) world: String,
    pub(crate) joints: Vec<ProgramJoint>,
    /// The motors of both joints; `None` if they are unknown.
    pub(crate) motors: Option<Motors>,
    pub(crate) steps: Vec<ProgramStep>,
    pub(crate) moves: Vec<Move>,
    pub(crate) travels: Vec<Travel>,
    /// Length of the path in joint space.
    pub(crate) length: f64,
    pub(crate) tolerance: JointTolerance,
    /// Lower bound, metres, on the distance to obstacles within the tolerance. It is proven as soon as the written targets
    /// are certified.
    pub(crate) clearance: f64,
    /// The distance that the lines between written targets must keep, metres.
    pub(crate) required: f64,
    /// True if objects must keep their orientation, but the world does not name the joint that does this.
    pub(crate) needs_wrist: bool,
    /// Names of the input files, and their SHA-256 in hexadecimal.
    pub(crate) digests: Vec<[String; 2]>,
    /// The arm whose program shares signals with this one.
    pub(crate) interlocked_with: Option<String>,
}

impl Program {
    /// Checks that a problem can have a program.
    ///
    /// # Errors
    /// Moving obstacles, and lines that the tip follows.
    pub fn check(problem: &Problem) -> Result<(), ProgramError> {
        let unsuitable =
            |why: String| Err(ProgramError::Unsuitable(format!("{why}\n  hint: write .yaml or .csv files")));
        if !problem.timed().trajectories.is_empty() {
            return unsuitable("obstacles move, but the times of a program depend on the controller".into());
        }
        let mut steps = problem.task().into_iter().flat_map(Task::steps);
        match steps.find(|step| matches!(step.action, Action::Follow(_))) {
            Some(step) => {
                unsuitable(format!("step {} follows a line, but a program consists of joint moves", step.number))
            }
            None => Ok(()),
        }
    }

    /// Returns the program of a plan. The plan must stop at each corner of its path, at strokes and at turns
    /// (`LoadedScene::without_arches`). It must have been made with the clearance `clearance` plus
    /// [`JointTolerance::room`], metres.
    ///
    /// # Errors
    /// The errors of [`Program::check`], a plan without a motion, and a wrist that leaves its range.
    pub fn of(plan: &Plan, tolerance: JointTolerance, clearance: f64) -> Result<Self, ProgramError> {
        let problem = plan.problem();
        let no_motion = || ProgramError::Unsuitable("the plan has no motion".into());
        let joints = &problem.robot().joints;
        match plan.detail() {
            Detail::Motion { answer, .. } => {
                let motion = answer.outcome.found().ok_or_else(no_motion)?;
                let curve = &motion.timed.curve;
                Self::of_motion(problem, joints, (curve.curve().path(), curve.clearance()), tolerance, clearance)
            }
            Detail::Task { task, answer } => {
                answer.outcome.found().ok_or_else(no_motion)?;
                let builder = Builder::new(joints, problem.scene().arm());
                Self::of_legs(problem, builder, (task, &answer.legs), tolerance, clearance)
            }
        }
    }

    /// Returns the program of a motion along a path that keeps the distance `kept` from all obstacles, with the conditions
    /// of [`Program::of`]. `joints` are those that the program moves.
    ///
    /// # Errors
    /// The errors of [`Program::check`].
    pub fn of_motion(
        problem: &Problem,
        joints: &RobotJoints,
        (path, kept): (&Path, f64),
        tolerance: JointTolerance,
        clearance: f64,
    ) -> Result<Self, ProgramError> {
        Self::check(problem)?;
        let mut builder = Builder::new(joints, problem.scene().arm());
        builder.motion(problem.scene(), path);
        Self::of_moves(problem, builder.into_moves(), path.length(), kept, tolerance, clearance)
    }

    /// Returns the program of the steps of a task, with the conditions of [`Program::of`]. The gripper acts in moves of its own,
    /// so that the program can wait for signals between the arrival of the arm and the action. Without steps, the arm stays at
    /// its start.
    ///
    /// # Errors
    /// The errors of [`Program::of`].
    pub fn of_steps(
        problem: &Problem,
        joints: &RobotJoints,
        (task, legs): (&Task, &[Leg]),
        tolerance: JointTolerance,
        clearance: f64,
    ) -> Result<Self, ProgramError> {
        if legs.is_empty() {
            let path = Path::new(vec![task.start; 2]);
            return Self::of_motion(problem, joints, (&path, f64::INFINITY), tolerance, clearance);
        }
        let builder = Builder::new(joints, problem.scene().arm()).with_separate_acts();
        Self::of_legs(problem, builder, (task, legs), tolerance, clearance)
    }

    /// Returns the program of the legs of a task.
    fn of_legs(
        problem: &Problem,
        mut builder: Builder,
        (task, legs): (&Task, &[Leg]),
        tolerance: JointTolerance,
        clearance: f64,
    ) -> Result<Self, ProgramError> {
        Self::check(problem)?;
        builder.task(task, legs, tolerance)?;
        let length = legs.iter().map(|leg| leg.path().length()).sum();
        let kept = legs.iter().map(Leg::clearance).fold(f64::INFINITY, f64::min);
        Self::of_moves(problem, builder.into_moves(), length, kept, tolerance, clearance)
    }

    /// Returns for each target except the first the index of its step, and the part of the step in which the program moves
    /// there.
    pub fn parts(&self) -> Vec<(usize, MovePart)> {
        let part = |(index, one): (usize, &Move)| {
            let [first, last] = self.travels[one.step].moves;
            let part = match index {
                index if index <= first => MovePart::Raising,
                index if index <= last => MovePart::Travel,
                _ => MovePart::Acts,
            };
            (one.step, part)
        };
        self.moves.iter().enumerate().skip(1).map(part).collect()
    }

    /// Returns the program with these moves, which keep the distance `kept` from all obstacles.
    fn of_moves(
        problem: &Problem,
        moves: Moves,
        length: f64,
        kept: f64,
        tolerance: JointTolerance,
        clearance: f64,
    ) -> Result<Self, ProgramError> {
        let (scene, robot) = (problem.scene(), problem.robot());
        let is_level = |task: &Task| task.objects.iter().any(|object| object.holding == Holding::Level);
        let Moves { joints, steps, moves, travels } = moves;
        let kept = if kept.is_finite() { (kept - tolerance.room(problem)).max(clearance) } else { clearance };
        let program = Self {
            robot: scene.arm().name.clone(),
            world: scene.workspace().name.clone(),
            joints,
            motors: scene.arm().motors,
            steps,
            moves,
            travels,
            length,
            tolerance,
            clearance: kept,
            required: kept + tolerance.room_as_written(problem),
            needs_wrist: robot.joints.wrist.is_none() && problem.task().is_some_and(is_level),
            digests: Vec::new(),
            interlocked_with: None,
        };
        program.check_ranges()?;
        Ok(program)
    }

    /// Adds the SHA-256 of input files to the program's head, each as a name and hexadecimal digits.
    #[must_use]
    pub fn with_digests(self, digests: Vec<[String; 2]>) -> Self {
        Self { digests, ..self }
    }

    /// Describes the program and its guarantee in one line.
    pub fn summary(&self) -> String {
        format!("{} joint moves; {}; the controller chooses the times", self.moves.len() - 1, self.guarantee())
    }

    /// States the guarantee in one sentence.
    pub(crate) fn guarantee(&self) -> String {
        let kept = match self.clearance > 0.0 {
            true => format!("keep {} from all obstacles", cplan_text::length_down(self.clearance)),
            false => "are free of collision".to_owned(),
        };
        let tolerance = self.tolerance;
        format!(
            "certified: straight moves in joint space, each of which ends at rest, {kept}, within a tolerance of {tolerance}"
        )
    }

    /// Describes a target for messages.
    pub(crate) fn describe(&self, target: usize) -> String {
        let step = self.moves.get(target).map(|one| &self.steps[one.step]);
        let step =
            step.map_or_else(|| "after the last one".into(), |step| format!("step {}, {}", step.number, step.text));
        format!("target {} ({step})", target + 1)
    }

    /// Checks that the joints of the tool stay within their limits.
    fn check_ranges(&self) -> Result<(), ProgramError> {
        for (target, one) in self.moves.iter().enumerate() {
            for (joint, value) in self.joints.iter().zip(&one.values) {
                if let Some(JointRange::Interval { lower, upper }) = joint.range
                    && !(lower - ROUNDING..=upper + ROUNDING).contains(value)
                {
                    let (name, unit) = (&joint.name, if joint.slides { "m" } else { "rad" });
                    return Err(ProgramError::Unsuitable(format!(
                        "at {}, joint \"{name}\" would be at {value} {unit}, outside its limits [{lower}, {upper}] {unit}",
                        self.describe(target)
                    )));
                }
            }
        }
        Ok(())
    }
}
