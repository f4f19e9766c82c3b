//! From the legs of a plan to joint moves.

use crate::error::ProgramError;
use crate::moves::{Move, MoveKind, ProgramJoint, ProgramStep, Travel, check_turn, widened};
use crate::tolerance::JointTolerance;
use cplan_handling::{Driver, Drives, Holding, RobotJoint, RobotJoints, Task, WristJoint};
use cplan_legs::{Event, Leg};
use cplan_model::space::Path;
use cplan_model::{Arm, Scene};

/// All joint moves of a plan.
pub(crate) struct Moves {
    pub joints: Vec<ProgramJoint>,
    pub steps: Vec<ProgramStep>,
    pub moves: Vec<Move>,
    pub travels: Vec<Travel>,
}

/// Collects the moves in the order of their execution.
pub(crate) struct Builder<'a> {
    robot: &'a RobotJoints,
    arm: &'a Arm,
    /// The joints of the program, with their places among the joints of the robot.
    joints: Vec<(ProgramJoint, usize)>,
    /// The present values.
    drives: Drives,
    steps: Vec<ProgramStep>,
    moves: Vec<Move>,
    travels: Vec<Travel>,
    /// True if each step has a travel of at least one move, and the gripper acts in moves of its own.
    has_separate_acts: bool,
}

impl<'a> Builder<'a> {
    pub fn new(robot: &'a RobotJoints, arm: &'a Arm) -> Self {
        let joints = robot.joints.iter().enumerate();
        let joints = joints.filter_map(|(index, joint)| Some((program_joint(robot, arm, joint)?, index))).collect();
        let drives = robot.at_rest([0.0; 2]);
        Self {
            robot,
            arm,
            joints,
            drives,
            steps: Vec::new(),
            moves: Vec::new(),
            travels: Vec::new(),
            has_separate_acts: false,
        }
    }

    /// Lets the gripper act in moves of its own, after the arm has arrived.
    pub fn with_separate_acts(self) -> Self {
        Self { has_separate_acts: true, ..self }
    }

    /// Adds a single motion.
    pub fn motion(&mut self, scene: &Scene, path: &Path) {
        self.drives.planned = path.start().into();
        let (text, speed) = ("move to the goal".to_owned(), 1.0);
        self.steps.push(ProgramStep { number: 1, cycle: 1, action: "move", text, object: None, carried: None, speed });
        self.travel(path, scene.clone(), |_, _, wrist| wrist);
    }

    /// Adds the steps of a task.
    pub fn task(&mut self, task: &Task, legs: &[Leg], tolerance: JointTolerance) -> Result<(), ProgramError> {
        if legs.iter().any(|leg| leg.overlap.seconds() > 0.0) {
            let why = "strokes or turns overlap with motions of the arm; load the world `without_arches`";
            return Err(ProgramError::Unsuitable(why.into()));
        }
        self.drives = Drives {
            planned: task.start.into(),
            stroke: self.robot.stroke.as_ref().map_or(0.0, |stroke| stroke.lowered(task.start_tool.depth)),
            wrist: task.start_tool.wrist.unwrap_or(self.drives.wrist),
        };
        // After a pick, the wrist turns the object before the next step.
        let mut is_turned = false;
        for leg in legs {
            if leg.turn.is_some() && self.robot.wrist.is_none() {
                return Err(ProgramError::Unsuitable(format!(
                    "step {} turns its object, but the world does not name the wrist's joint\n  hint: [robot] wrist = {{ joint \
                     = \"NAME\", velocity = 6.0 }}, in rad/s",
                    leg.step.number
                )));
            }
            self.steps.push(program_step(task, leg));
            let scene = widened(leg, task.stroke.as_ref(), tolerance);
            let is_placed = matches!(leg.event, Some(Event::Release { .. }));
            if is_turned || leg.turn.is_some() && is_placed {
                check_turn(&leg.scene, &scene).map_err(|why| {
                    ProgramError::NotCertified(format!("at the turn of the wrist for step {}, {why}", leg.step.number))
                })?;
            }
            is_turned = leg.turn.is_some() && !is_placed;
            self.leg(leg, leg.carried.map(|object| task.objects[object].holding), scene);
        }
        match is_turned && task.stroke.is_some() {
            true => Err(ProgramError::Unsuitable(
                "the task ends while the tool holds an object that the wrist has turned".into(),
            )),
            false => Ok(()),
        }
    }

    /// Returns the collected moves.
    pub fn into_moves(self) -> Moves {
        let joints = self.joints.into_iter().map(|(joint, _)| joint).collect();
        Moves { joints, steps: self.steps, moves: self.moves, travels: self.travels }
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
        if self.has_separate_acts && self.moves.len() == first + 1 {
            self.push(MoveKind::Travel, self.drives);
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
        self.moves.push(Move { kind, step, values, drives, grip: None, dwell: 0.0, signals: Vec::new() });
    }

    /// Adds an action of the gripper and a rest to the last move. If that move belongs to another step or already has
    /// them, a move that stays in its place has them.
    fn act(&mut self, grip: Option<&'static str>, dwell: f64) {
        if grip.is_none() && dwell == 0.0 {
            return;
        }
        let step = self.steps.len() - 1;
        let arrival = self.travels.last().filter(|_| self.has_separate_acts).map(|travel| travel.moves[1]);
        let has_arrived = arrival.is_none_or(|arrival| self.moves.len() > arrival + 1);
        let is_free = |last: &Move| last.step == step && last.grip.is_none() && last.dwell == 0.0 && has_arrived;
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

/// Returns the description of a step.
fn program_step(task: &Task, leg: &Leg) -> ProgramStep {
    let name = |object: usize| task.objects[object].name.clone();
    ProgramStep {
        number: leg.step.number,
        cycle: leg.step.cycle,
        action: match leg.event {
            Some(Event::Grasp { .. }) => "pick",
            Some(Event::Release { .. }) => "place",
            None => "move",
        },
        text: leg.step.action.describe(&task.objects),
        object: leg.event.map(|event| name(event.object())),
        carried: leg.carried.map(name),
        speed: leg.step.speed,
    }
}
