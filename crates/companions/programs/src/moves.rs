//! The joint moves of a plan, and the scenes in which they are certified.

use crate::error::ProgramError;
use crate::tolerance::JointTolerance;
use cplan_engine::{Detail, Plan, Problem};
use cplan_handling::{Action, Driver, Drives, Holding, RobotJoint, RobotJoints, Stroke, Task, WristJoint};
use cplan_legs::{Event, Leg};
use cplan_model::space::{JointRange, Path};
use cplan_model::{Arm, Heights, Scene};

/// Displacement of a joint that is due to rounding, radians or metres.
const ROUNDING: f64 = 1e-9;

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

/// The joint moves of a plan.
#[derive(Debug)]
pub struct Program {
    pub(crate) robot: String,
    pub(crate) world: String,
    pub(crate) joints: Vec<ProgramJoint>,
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
    /// Names of the input files, and their SHA-256 in hexadecimal.
    pub(crate) digests: Vec<[String; 2]>,
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
            return unsuitable("obstacles move, and the times of a program are the controller's".into());
        }
        let mut steps = problem.task().into_iter().flat_map(Task::steps);
        match steps.find(|step| matches!(step.action, Action::Follow(_))) {
            Some(step) => unsuitable(format!("step {} follows a line, which joint moves do not", step.number)),
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
        Self::check(problem)?;
        let no_motion = || ProgramError::Unsuitable("the plan has no motion".into());
        let (robot, arm) = (&problem.robot().joints, plan.arm());
        let mut builder = Builder::new(robot, arm);
        let (length, kept) = match plan.detail() {
            Detail::Motion { answer, .. } => {
                let motion = answer.outcome.found().ok_or_else(no_motion)?;
                builder.motion(problem.scene(), motion.timed.curve.curve().path());
                (motion.path.path().length(), motion.timed.curve.clearance())
            }
            Detail::Task { task, answer } => {
                answer.outcome.found().ok_or_else(no_motion)?;
                if answer.legs.iter().any(|leg| leg.overlap.seconds() > 0.0) {
                    let why = "strokes or turns overlap with motions of the arm; load the world `without_arches`";
                    return Err(ProgramError::Unsuitable(why.into()));
                }
                let start = &task.start_tool;
                if let Some(stroke) = &robot.stroke {
                    builder.drives.stroke = stroke.lowered(start.depth);
                }
                builder.drives.wrist = start.wrist.unwrap_or(builder.drives.wrist);
                builder.drives.planned = task.start.into();
                let holding = |object: usize| task.objects[object].holding;
                let name = |object: usize| task.objects[object].name.clone();
                for leg in &answer.legs {
                    let action = match leg.event {
                        Some(Event::Grasp { .. }) => "pick",
                        Some(Event::Release { .. }) => "place",
                        None => "move",
                    };
                    builder.steps.push(ProgramStep {
                        number: leg.step.number,
                        cycle: leg.step.cycle,
                        action,
                        text: leg.step.action.describe(&task.objects),
                        object: leg.event.map(|event| name(event.object())),
                        carried: leg.carried.map(name),
                        speed: leg.step.speed,
                    });
                    builder.leg(leg, leg.carried.map(holding), widened(leg, task.stroke.as_ref(), tolerance));
                }
                (answer.legs.iter().map(|leg| leg.path().length()).sum(), answer.clearance())
            }
        };
        let Builder { joints, steps, moves, travels, .. } = builder;
        let kept = if kept.is_finite() { kept - tolerance.room(problem) } else { clearance };
        let program = Self {
            robot: arm.name.clone(),
            world: problem.scene().workspace().name.clone(),
            length,
            tolerance,
            clearance: kept.max(clearance),
            required: kept.max(clearance) + tolerance.room_as_written(problem),
            joints: joints.into_iter().map(|(joint, _)| joint).collect(),
            steps,
            moves,
            travels,
            digests: Vec::new(),
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
        format!("{} joint moves; {}", self.moves.len() - 1, self.guarantee())
    }

    /// States the guarantee in one sentence.
    pub(crate) fn guarantee(&self) -> String {
        let kept = match self.clearance > 0.0 {
            true => format!("keep {} from all obstacles", cplan_text::length_down(self.clearance)),
            false => "are free of collision".to_owned(),
        };
        let tolerance = self.tolerance;
        format!("certified: straight joint lines that end at rest {kept}, within a tolerance of {tolerance}")
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

/// Returns the scene of a step's motion, with the tool and its payload at all heights that the tolerance allows.
fn widened(leg: &Leg, stroke: Option<&Stroke>, tolerance: JointTolerance) -> Scene {
    let by = tolerance.slide + JointTolerance::ROUNDING.slide;
    let Some(stroke) = stroke else { return Scene::clone(&leg.scene) };
    let scene = leg.scene.changed(|arm, _| *arm = stroke.swept(arm, &[by, -by]));
    let heights = scene.attachment().map(|attachment| attachment.heights);
    heights.map_or(scene.clone(), |Heights { lower, upper }| {
        scene.with_attached_heights(Heights { lower: lower - by, upper: upper + by })
    })
}

/// Collects the moves in the order of their execution.
struct Builder<'a> {
    robot: &'a RobotJoints,
    arm: &'a Arm,
    /// The joints of the program, with their places among the joints of the robot.
    joints: Vec<(ProgramJoint, usize)>,
    /// The present values.
    drives: Drives,
    steps: Vec<ProgramStep>,
    moves: Vec<Move>,
    travels: Vec<Travel>,
}

impl<'a> Builder<'a> {
    fn new(robot: &'a RobotJoints, arm: &'a Arm) -> Self {
        let joints = robot.joints.iter().enumerate();
        let joints = joints.filter_map(|(index, joint)| Some((program_joint(robot, arm, joint)?, index))).collect();
        let drives = robot.at_rest([0.0; 2]);
        Self { robot, arm, joints, drives, steps: Vec::new(), moves: Vec::new(), travels: Vec::new() }
    }

    /// Adds a single motion.
    fn motion(&mut self, scene: &Scene, path: &Path) {
        self.drives.planned = path.start().into();
        let (text, speed) = ("move to the goal".to_owned(), 1.0);
        self.steps.push(ProgramStep { number: 1, cycle: 1, action: "move", text, object: None, carried: None, speed });
        self.travel(path, scene.clone(), |_, _, wrist| wrist);
    }

    /// Adds a step of a task, whose scene during the motion is `scene`.
    fn leg(&mut self, leg: &Leg, carried: Option<Holding>, scene: Scene) {
        if let Some(raising) = leg.raising {
            self.add(MoveKind::Raise, Drives { stroke: raising.raised, ..self.drives });
        }
        let (sign, rest) = self.robot.wrist.as_ref().map_or((0.0, 0.0), |wrist| (wrist.sign, wrist.rest));
        let (arm, turn, first) = (self.arm, leg.wrist.map(|wrist| wrist.angle), leg.path().start());
        self.travel(leg.path(), scene, |planned, share, from| match (turn, carried) {
            (Some(angle), None) => from + angle * share,
            (_, Some(Holding::Rigid)) => from,
            (_, Some(Holding::Level)) => {
                from - sign * WristJoint::link_2_angle(arm, [planned[0] - first[0], planned[1] - first[1]])
            }
            (_, None) if share > 0.0 => from + (rest - from) * share,
            (_, None) => from,
        });
        let is_placed = matches!(leg.event, Some(Event::Release { .. }));
        if is_placed {
            self.turn(leg, sign);
        }
        if let Some(stroke) = leg.stroke {
            self.add(MoveKind::Lower, Drives { stroke: stroke.lowered, ..self.drives });
        }
        let grip = leg.event.map(|_| if is_placed { "open" } else { "close" });
        self.act(grip, leg.step.dwell);
        if let Some(stroke) = leg.stroke.filter(|_| leg.event.is_some()) {
            self.add(MoveKind::Raise, Drives { stroke: stroke.raised, ..self.drives });
        }
        if !is_placed {
            self.turn(leg, sign);
        }
    }

    /// Adds the moves along a path. `wrist` returns the wrist's value from the planned values, the share of the path so
    /// far, and the wrist's value at the start.
    fn travel(&mut self, path: &Path, scene: Scene, wrist: impl Fn([f64; 2], f64, f64) -> f64) {
        if self.moves.is_empty() {
            self.add(MoveKind::Start, self.drives);
        }
        let (first, from) = (self.moves.len() - 1, self.drives.wrist);
        let (mut so_far, whole) = (0.0, path.length());
        for (a, b) in path.segments() {
            so_far += (b - a).norm();
            let share = if whole > 0.0 { so_far / whole } else { 0.0 };
            let planned: [f64; 2] = b.into();
            self.add(MoveKind::Travel, Drives { planned, wrist: wrist(planned, share, from), ..self.drives });
        }
        if whole == 0.0 {
            // Without a path, only the stated turn of the wrist is left.
            let planned = self.drives.planned;
            let turned = wrist(planned, 1.0, from);
            self.add(MoveKind::Turn, Drives { wrist: turned, ..self.drives });
        }
        self.travels.push(Travel { scene, moves: [first, self.moves.len() - 1] });
    }

    /// Adds the turn of the wrist that a step states for its payload.
    fn turn(&mut self, leg: &Leg, sign: f64) {
        if let Some((turn, _)) = leg.turn {
            self.add(MoveKind::Turn, Drives { wrist: self.drives.wrist + sign * (turn.to - turn.from), ..self.drives });
        }
    }

    /// Adds a move to these values, unless no joint moves.
    fn add(&mut self, kind: MoveKind, drives: Drives) {
        // The arm stands at the start before anything else moves.
        if self.moves.is_empty() {
            self.push(MoveKind::Start, self.drives);
        }
        if drives != self.drives {
            self.push(kind, drives);
        }
    }

    fn push(&mut self, kind: MoveKind, drives: Drives) {
        self.drives = drives;
        let all = self.robot.values(&drives);
        let values = self.joints.iter().map(|(_, index)| all[*index]).collect();
        let step = self.steps.len() - 1;
        self.moves.push(Move { kind, step, values, drives, grip: None, dwell: 0.0 });
    }

    /// Adds an action of the gripper and a rest to the last move. If that move belongs to another step or already has
    /// them, a move that stays in its place has them.
    fn act(&mut self, grip: Option<&'static str>, dwell: f64) {
        if grip.is_none() && dwell == 0.0 {
            return;
        }
        let step = self.steps.len() - 1;
        let is_free = |last: &Move| last.step == step && last.grip.is_none() && last.dwell == 0.0;
        if !self.moves.last().is_some_and(is_free) {
            self.push(MoveKind::Travel, self.drives);
        }
        if let Some(last) = self.moves.last_mut() {
            (last.grip, last.dwell) = (grip, dwell);
        }
    }
}

/// Returns a joint of the robot as a joint of the program. `None` for a joint that follows another one.
fn program_joint(robot: &RobotJoints, arm: &Arm, joint: &RobotJoint) -> Option<ProgramJoint> {
    let leads = |name: &str| joint.name == name;
    let (leads, slides, range) = match joint.driver {
        Driver::Planned(k) => {
            let planned = &arm.joints[k];
            (leads(&planned.name), !planned.joint_type.is_revolute(), Some(planned.range))
        }
        Driver::Stroke => robot.stroke.as_ref().map(|s| (leads(&s.joint.name), true, Some(s.joint.range)))?,
        Driver::Wrist => robot.wrist.as_ref().map(|wrist| (leads(&wrist.name), false, Some(wrist.range)))?,
        Driver::Held(_) => (joint.factor == 1.0 && joint.offset == 0.0, joint.slides, None),
    };
    leads.then(|| ProgramJoint { name: joint.name.clone(), slides, driver: joint.driver, range })
}
