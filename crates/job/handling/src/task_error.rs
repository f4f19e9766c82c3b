//! Checks that an arm, objects and steps form a valid task.

use super::{Action, Holding, Item, MAX_STOP_TIME, Object, Step, Stroke, Task, TimedScene, ToolLimits, ToolValues};
use cplan_geometry::Point;
use cplan_model::{
    Goal, MAX_COORDINATE, MotionProblem, MotionProblemError, Scene, SceneError, are_small, is_pose, is_small,
};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Limit on the duration of each part of a task, seconds. It is the same as for motions.
const MAX_PART_DURATION: f64 = 1e6;

/// Greatest distance, metres, between a line's beginning and the target of the previous move. A smaller one is due to rounding.
const LINE_START_TOLERANCE: f64 = 1e-9;

/// The reason why an arm, objects and steps do not form a valid task.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// The arm, the obstacles or the initial poses of the objects are invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The start is invalid.
    #[error(transparent)]
    Start(#[from] MotionProblemError),
    /// An object is invalid.
    #[error("object \"{object}\": {why}")]
    Object {
        /// The object's name.
        object: String,
        /// Description of the problem.
        why: &'static str,
    },
    /// The stroke of the tool or the wrist is invalid.
    #[error("the tool: {why}")]
    Tool {
        /// Description of the problem.
        why: &'static str,
    },
    /// A step is invalid.
    #[error("step {number} (cycle {cycle}): {why}")]
    Step {
        /// The step's number in the world file, from 1.
        number: usize,
        /// Number of the step's repetition, from 1.
        cycle: usize,
        /// Description of the problem.
        why: &'static str,
    },
    /// There are no steps.
    #[error("there are no steps")]
    NoSteps,
    /// A group has no steps.
    #[error("a group of steps in any order is empty")]
    EmptyGroup,
    /// An obstacle or object moves, but the task needs a feature that supports only static obstacles.
    #[error("\"{mover}\" moves, but {why}")]
    Moves {
        /// Name of a moving obstacle or object.
        mover: String,
        /// The feature, in words.
        why: &'static str,
    },
    /// An object cannot be renewed.
    #[error("an object cannot be renewed, because it does not exist, moves, or is still carried")]
    Renewed,
}

impl Task {
    /// Checks the task, and returns the initial scene: the arm without a load, and obstacles and objects at their initial poses.
    /// Linear in the number of parts, obstacles, objects and steps.
    ///
    /// # Errors
    /// The first problem, such as invalid numbers, a start that is not free, picks of missing objects, or places without a load;
    /// see [`TaskError`].
    pub fn check(&self) -> Result<Scene, TaskError> {
        let at_first: Vec<_> = self.objects.iter().map(Object::initial_static_pose).collect();
        let moving: Vec<usize> = self.initially_moving().collect();
        self.objects.iter().try_for_each(check_object)?;
        let scene = self.surroundings(&at_first, &moving).scene(self.arm.clone())?;
        if let Some((mover, why)) = self.static_only_feature() {
            return Err(TaskError::Moves { mover, why });
        }
        let mut names: BTreeSet<&str> = self.workspace.all().map(|o| o.name.as_str()).collect();
        if let Some(object) = self.objects.iter().find(|object| !names.insert(&object.name)) {
            return Err(TaskError::Object {
                object: object.name.clone(),
                why: "another obstacle or object has this name",
            });
        }
        self.check_tool()?;
        if self.steps().next().is_none() {
            return Err(TaskError::NoSteps);
        }
        let mut state = Gripper {
            task: self,
            carried: None,
            picked: BTreeSet::new(),
            turned: self.objects.iter().map(angle_at_first).collect(),
            tip: None,
        };
        self.items.iter().try_for_each(|item| state.item(item))?;
        let first = TimedScene { scene: &scene, trajectories: &self.trajectories(&moving) }.frozen(0.0);
        Ok(MotionProblem::new(first, self.start, self.start).map(|_| scene)?)
    }

    /// Returns a feature of the task that supports only static obstacles, with the name of a moving obstacle or object. `None` if
    /// the task has no such feature, or nothing moves.
    pub fn static_only_feature(&self) -> Option<(String, &'static str)> {
        let own = self.objects.iter().filter_map(|object| Some((&object.name, object.trajectory.as_ref()?)));
        let movers = self.workspace.movers.iter().map(|mover| (&mover.obstacle.name, &mover.trajectory));
        let trajectories: Vec<_> = movers.chain(own).collect();
        let (first, _) = trajectories.first()?;
        if self.steps().any(|step| matches!(step.action, Action::Follow(_))) {
            return Some(((*first).clone(), "lines can be followed only if all obstacles are static"));
        }
        let turns = |step: &Step| matches!(step.action, Action::Place { angle: Some(_), .. });
        if self.stroke.is_some() {
            return Some(((*first).clone(), "a tool can be lowered and raised only if all obstacles are static"));
        }
        if self.wrist.is_some() && self.steps().any(turns) {
            return Some(((*first).clone(), "a wrist can turn objects only if all obstacles are static"));
        }
        if self.steps().any(|step| step.tool.wrist.is_some()) {
            return Some(((*first).clone(), "a wrist can turn to a value only if all obstacles are static"));
        }
        let (turning, _) = trajectories.iter().find(|(_, trajectory)| trajectory.turns())?;
        let is_level = self.objects.iter().any(|object| object.holding == Holding::Level);
        is_level.then(|| ((*turning).clone(), "objects can be held level only if no moving obstacle turns"))
    }

    /// Checks the stroke and the wrist: limits, ranges and durations.
    ///
    /// # Errors
    /// [`TaskError::Tool`].
    pub fn check_tool(&self) -> Result<(), TaskError> {
        let tools = || self.steps().map(|step| step.tool).chain([self.start_tool]);
        let turned = self.steps().filter_map(|step| self.wrist_turn(step)).map(f64::abs).fold(TAU, f64::max);
        let wrist = self.wrist.iter().map(|wrist| (wrist.limits(), turned));
        let farthest = |stroke: &Stroke| {
            let depths = self.objects.iter().map(|object| stroke.depth(object).abs());
            depths.chain(tools().map(|tool| tool.depth.abs())).fold(0.0, f64::max)
        };
        let is_reached = |tool: ToolValues| {
            let Some(depth) = tool.lowered_by() else { return true };
            self.stroke.as_ref().is_some_and(|stroke| stroke.joint.range.contains(stroke.lowered(depth)))
        };
        let stroke = self.stroke.iter().map(|stroke| (stroke.limits(), farthest(stroke)));
        let why = if !wrist.chain(stroke).all(|(limits, distance)| is_drive(limits, distance)) {
            "speeds, accelerations and jerks must be positive, finite, and large enough for at most a million seconds"
        } else if self.stroke.iter().any(|s| !s.joint.is_sound() || s.joint.range.is_circle()) {
            "the joint of the tool needs a sign of 1 or -1, a range, and a rest value within the range"
        } else if self.stroke.iter().filter_map(|s| s.travel).any(|travel| !travel.is_finite()) {
            "the travel must be finite"
        } else if self.stroke.iter().filter_map(|s| s.arch).any(|arch| !arch.is_valid()) {
            "the heights of the arch must be finite and not negative"
        } else if self.stroke.iter().any(|stroke| !self.objects.iter().all(|object| stroke.reaches(object))) {
            "an object lies too deep for the stroke"
        } else if self.step_beyond_stroke().is_some() {
            "a place is too low or too high for the stroke"
        } else if !tools().all(is_reached) {
            "the tool is lowered beyond its range, or has no stroke"
        } else if !tools().filter_map(|tool| tool.wrist).all(f64::is_finite) {
            "the value of the wrist must be finite"
        } else {
            return Ok(());
        };
        Err(TaskError::Tool { why })
    }
}

/// Returns true if a motion over the distance takes a finite, plausible time within these limits.
fn is_drive(limits: ToolLimits, distance: f64) -> bool {
    let ToolLimits { velocity, acceleration, jerk } = limits;
    let is_limit = |limit: f64| limit.is_finite() && limit > 0.0;
    // The time that each limit alone would allow.
    let seconds = [
        distance / velocity,
        2.0 * (distance / acceleration).sqrt(),
        jerk.map_or(0.0, |jerk| 4.0 * (distance / (2.0 * jerk)).cbrt()),
    ];
    [velocity, acceleration, jerk.unwrap_or(1.0)].into_iter().all(is_limit)
        && seconds.into_iter().all(|seconds| seconds <= MAX_PART_DURATION)
}

fn angle_at_first(object: &Object) -> f64 {
    object.at.rotation.angle()
}

fn check_object(object: &Object) -> Result<(), TaskError> {
    let why = if !is_pose(&object.at) {
        "the pose must be finite"
    } else if !(0.0..=MAX_COORDINATE).contains(&object.lift) {
        "the lift must be from 0 to 1e15 m"
    } else if !(0.0..=MAX_COORDINATE).contains(&object.mass) {
        "the mass must be from 0 to 1e15 kg"
    } else if !object.pieces.iter().all(is_small) {
        "it is larger than 1e15 m"
    } else {
        return Ok(());
    };
    Err(TaskError::Object { object: object.name.clone(), why })
}

/// The state of the gripper from step to step.
struct Gripper<'a> {
    task: &'a Task,
    carried: Option<usize>,
    /// The objects that have been picked.
    picked: BTreeSet<usize>,
    /// Orientation of each object, radians. The orientation of rigid payloads is ignored.
    turned: Vec<f64>,
    /// Target of the tip if the last step moved there.
    tip: Option<Point>,
}

impl Gripper<'_> {
    fn item(&mut self, item: &Item) -> Result<(), TaskError> {
        match item {
            Item::Step(step) => self.step(step),
            Item::AnyOrder(pairs) if pairs.is_empty() => Err(TaskError::EmptyGroup),
            Item::AnyOrder(pairs) => {
                let mut picked = BTreeSet::new();
                pairs.iter().try_for_each(|[pick, place]| {
                    let is_place = matches!(place.action, Action::Place { .. });
                    match pick.action.picked() {
                        Some(object) if is_place && picked.insert(object) => {}
                        _ => return Err(wrong(pick, "a group in any order must consist of picks of different objects, each followed by a place")),
                    }
                    self.step(pick)?;
                    self.step(place)
                })
            }
            Item::Renew(objects) => {
                for &object in objects {
                    let renewed = self.task.objects.get(object).filter(|_| self.carried != Some(object));
                    let renewed = renewed.filter(|object| object.trajectory.is_none());
                    self.turned[object] = angle_at_first(renewed.ok_or(TaskError::Renewed)?);
                }
                Ok(())
            }
        }
    }

    fn step(&mut self, step: &Step) -> Result<(), TaskError> {
        require(step.number > 0 && step.cycle > 0, step, "numbers begin with 1")?;
        require(
            step.speed > 0.0 && step.speed <= 1.0 && (0.0..=MAX_PART_DURATION).contains(&step.dwell),
            step,
            "the speed must be greater than 0 and at most 1, and the dwell from 0 to a million seconds",
        )?;
        if !step.tool.is_default() {
            let is_alone = self.task.steps().count() == 1 && self.carried.is_none();
            let why = "values of the tool's joints are possible only in a task with a move as its only step";
            require(is_alone && matches!(step.action, Action::Move(_)), step, why)?;
            let may_turn = self.task.start_tool.wrist.is_some() && self.task.wrist.is_some();
            let why = "the wrist turns from an unknown value, or there is no wrist";
            require(step.tool.wrist.is_none() || may_turn, step, why)?;
        }
        let why = "only arms with two revolute joints have an elbow";
        require(step.required_elbow().is_none() || self.task.arm.only_turns(), step, why)?;
        let tip =
            if let Action::Move(Goal::Tip(tip) | Goal::TipAndElbow(tip, _)) = step.action { Some(tip) } else { None };
        let before = std::mem::replace(&mut self.tip, tip);
        match &step.action {
            Action::Pick { object, grasp, supports, when } => {
                let why = "the picked object does not exist, or the tool already carries an object";
                require(*object < self.task.objects.len() && self.carried.is_none(), step, why)?;
                let is_first = self.task.objects[*object].trajectory.is_some() && self.picked.insert(*object);
                let mut ends = when.iter().flatten();
                let is_timely =
                    is_first && ends.clone().is_sorted() && ends.all(|end| (0.0..=MAX_STOP_TIME).contains(end));
                let why = "only the first pick of a moving object can have times, and they must be in order";
                require(when.is_empty() || is_timely, step, why)?;
                self.carried = Some(*object);
                self.check_supports(step, *object, supports, are_small(grasp.iter().copied()))
            }
            Action::Place { at, angle, supports } => {
                let why = "the step places an object, but the tool carries none";
                let object = self.carried.take().ok_or_else(|| wrong(step, why))?;
                if let Some(angle) = *angle {
                    let is_turned = angle != std::mem::replace(&mut self.turned[object], angle);
                    let is_level = self.task.objects[object].holding == Holding::Level;
                    let why = "the object cannot be turned, because it is not held level or the tool has no wrist";
                    require(is_level && (!is_turned || self.task.wrist.is_some()), step, why)?;
                }
                let is_finite = are_small(at.iter().chain(angle).copied());
                self.check_supports(step, object, supports, is_finite)
            }
            Action::Move(Goal::Joints(q)) => {
                let mut values = self.task.arm.joints.iter().zip(q.iter());
                let is_within = values.all(|(joint, value)| joint.range.contains(*value));
                require(is_within, step, "the joint values are outside the joint limits")
            }
            Action::Move(Goal::Area(_)) => {
                Err(wrong(step, "a move needs joint values or a position of the tip, not an area"))
            }
            Action::Follow(line) => {
                let start: Point = line.path.start().into();
                let why = "the tolerance must be finite and at least a micrometre, and the speed finite and positive";
                require(line.is_valid(), step, why)?;
                let is_there = before.is_some_and(|tip| (tip - start).norm() <= LINE_START_TOLERANCE);
                require(is_there, step, "the step before a line must move the tip to where the line begins")
            }
            Action::Move(Goal::Tip(tip) | Goal::TipAndElbow(tip, _)) => {
                require(are_small(tip.iter().copied()), step, "the position must be finite")
            }
        }
    }

    /// Checks the supports of a pick or a place.
    fn check_supports(&self, step: &Step, object: usize, supports: &[usize], is_finite: bool) -> Result<(), TaskError> {
        let (task, own) = (self.task, self.task.obstacle_number(object));
        let count = task.obstacle_number(task.objects.len());
        require(is_finite, step, "the position must be finite")?;
        let exist = supports.iter().all(|&support| support < count && support != own);
        require(exist, step, "the object rests on itself, or on an obstacle that does not exist")?;
        let can_rest = supports.is_empty() || task.objects[object].can_rest(&task.arm);
        require(can_rest, step, "the object is too thin to rest on anything")
    }
}

/// Refuses a step unless a condition is met.
fn require(is_met: bool, step: &Step, why: &'static str) -> Result<(), TaskError> {
    if is_met { Ok(()) } else { Err(wrong(step, why)) }
}

fn wrong(step: &Step, why: &'static str) -> TaskError {
    TaskError::Step { number: step.number, cycle: step.cycle, why }
}
