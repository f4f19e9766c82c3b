//! What arm, objects and steps must be to make a task.

use super::scene_error::check_range;
use super::{
    Action, Goal, Holding, Item, MotionProblem, MotionProblemError, Object, Payload, Scene, SceneError, Step, Task,
};
use crate::geometry::Pose;
use crate::space::JointRange;
use std::collections::BTreeSet;

/// Rotations may be off by this: as other unit vectors of a scene.
const UNIT_ROUNDING: f64 = 1e-9;

/// Why an arm, objects and steps make no task.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// The arm, the obstacles, or the objects where they lie at first.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The start.
    #[error(transparent)]
    Start(#[from] MotionProblemError),
    /// An object.
    #[error("object \"{object}\": {why}")]
    Object {
        /// The object's name.
        object: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// The stroke of the tool, or the wrist.
    #[error("the tool: {why}")]
    Tool {
        /// What is wrong with it.
        why: &'static str,
    },
    /// A step.
    #[error("step {number} (cycle {cycle}): {why}")]
    Step {
        /// The step's number in the world file.
        number: usize,
        /// Which repetition of it.
        cycle: usize,
        /// What is wrong with it.
        why: &'static str,
    },
    /// There is nothing to do.
    #[error("there are no steps")]
    NoSteps,
    /// Objects begin anew that cannot.
    #[error("an object is renewed that does not exist, or is carried then")]
    Renewed,
}

impl Task {
    /// The scene at first: the arm, empty-handed, among obstacles and objects where they lie. `O(n)` in parts, obstacles, objects
    /// and steps.
    ///
    /// # Errors
    /// The first thing that makes it no task: numbers that make no sense, a start that is not free, picks of what is not there,
    /// places of nothing, and the like; see [`TaskError`].
    pub fn check(&self) -> Result<Scene, TaskError> {
        let at_first: Vec<_> = self.objects.iter().map(|object| Some(object.at)).collect();
        self.objects.iter().try_for_each(check_object)?;
        let scene = Scene::new(self.arm.clone(), self.obstacles(&at_first))?;
        let mut names: BTreeSet<&str> = self.workspace.obstacles.iter().map(|o| o.name.as_str()).collect();
        if let Some(object) = self.objects.iter().find(|object| !names.insert(&object.name)) {
            return Err(TaskError::Object { object: object.name.clone(), why: "something else has this name" });
        }
        self.check_tool()?;
        if self.steps().next().is_none() {
            return Err(TaskError::NoSteps);
        }
        let mut state =
            Gripper { task: self, carried: None, turned: self.objects.iter().map(angle_at_first).collect() };
        self.items.iter().try_for_each(|item| state.item(item))?;
        Ok(MotionProblem::new(scene, self.start, self.start)?.into_scene())
    }

    fn check_tool(&self) -> Result<(), TaskError> {
        let wrist = self.wrist.iter().flat_map(|wrist| [wrist.velocity, wrist.acceleration]);
        let stroke = self.stroke.iter().flat_map(|stroke| [stroke.velocity, stroke.acceleration]);
        let why = if !wrist.chain(stroke).all(|limit| limit.is_finite() && limit > 0.0) {
            "speeds and accelerations must be positive and finite"
        } else if self.stroke.iter().any(|s| s.joint.sign.abs() != 1.0 || !s.joint.rest.is_finite()) {
            "its joint needs a sign of 1 or -1 and a finite rest"
        } else if self.stroke.iter().filter_map(|s| s.travel).any(|travel| !travel.is_finite() || travel < 0.0) {
            "its travel must be finite and not negative"
        } else if self.stroke.iter().any(|s| check_range(&s.joint.name, s.joint.range).is_err()) {
            "its joint needs a range"
        } else if self.stroke.iter().any(|stroke| self.objects.iter().any(|object| is_too_deep(stroke, object))) {
            "an object lies too deep for the stroke"
        } else {
            return Ok(());
        };
        Err(TaskError::Tool { why })
    }
}

fn is_too_deep(stroke: &super::Stroke, object: &Object) -> bool {
    let JointRange::Interval { lower, upper } = stroke.joint.range else { return false };
    let at = stroke.lowered(stroke.depth(object));
    at < lower || at > upper
}

fn angle_at_first(object: &Object) -> f64 {
    object.at.rotation.angle()
}

fn is_pose(pose: &Pose) -> bool {
    let is_finite = pose.translation.vector.iter().chain([&pose.rotation.re, &pose.rotation.im]).all(|x| x.is_finite());
    is_finite && (pose.rotation.as_ref().norm() - 1.0).abs() <= UNIT_ROUNDING
}

fn check_object(object: &Object) -> Result<(), TaskError> {
    let why = if !is_pose(&object.at) {
        "where it lies is no finite pose"
    } else if !(object.lift.is_finite() && object.lift >= 0.0) {
        "its lift must be finite and not negative"
    } else {
        return Ok(());
    };
    Err(TaskError::Object { object: object.name.clone(), why })
}

/// What the gripper holds from step to step.
struct Gripper<'a> {
    task: &'a Task,
    carried: Option<usize>,
    /// The orientation of each object, radians, while it is known: that of rigid payloads is not.
    turned: Vec<f64>,
}

impl Gripper<'_> {
    fn item(&mut self, item: &Item) -> Result<(), TaskError> {
        match item {
            Item::Step(step) => self.step(step),
            Item::AnyOrder(pairs) => {
                let mut picked = BTreeSet::new();
                pairs.iter().try_for_each(|[pick, place]| {
                    let is_place = matches!(place.action, Action::Place { .. });
                    match pick.action.picked() {
                        Some(object) if is_place && picked.insert(object) => {}
                        _ => return Err(wrong(pick, "in any order there are picks of different objects and places")),
                    }
                    self.step(pick)?;
                    self.step(place)
                })
            }
            Item::Renew(objects) => {
                for &object in objects {
                    let renewed = self.task.objects.get(object).filter(|_| self.carried != Some(object));
                    self.turned[object] = angle_at_first(renewed.ok_or(TaskError::Renewed)?);
                }
                Ok(())
            }
        }
    }

    fn step(&mut self, step: &Step) -> Result<(), TaskError> {
        if step.number == 0 || step.cycle == 0 {
            return Err(wrong(step, "numbers begin with 1"));
        }
        if !(step.speed > 0.0 && step.speed <= 1.0 && step.dwell.is_finite() && step.dwell >= 0.0) {
            return Err(wrong(step, "its speed must be more than 0 and at most 1, its dwell finite and not negative"));
        }
        match &step.action {
            Action::Pick { object, grasp, supports } => {
                if *object >= self.task.objects.len() || self.carried.is_some() {
                    return Err(wrong(step, "it picks what does not exist, or while something is carried"));
                }
                self.carried = Some(*object);
                self.rest(step, *object, supports, grasp.iter().all(|x| x.is_finite()))
            }
            Action::Place { at, angle, supports } => {
                let Some(object) = self.carried.take() else {
                    return Err(wrong(step, "nothing is carried to be placed"));
                };
                if let Some(angle) = *angle {
                    let is_turned = angle != std::mem::replace(&mut self.turned[object], angle);
                    let is_level = self.task.objects[object].holding == Holding::Level;
                    if !is_level || is_turned && self.task.wrist.is_none() {
                        return Err(wrong(step, "what it places cannot be turned"));
                    }
                }
                let is_finite = at.iter().chain(angle).all(|x| x.is_finite());
                self.rest(step, object, supports, is_finite)
            }
            Action::Move(Goal::Joints(q)) => {
                let mut values = self.task.arm.joints.iter().zip(q.iter());
                let is_within = values.all(|(joint, value)| joint.range.contains(*value));
                is_within.then_some(()).ok_or_else(|| wrong(step, "it goes beyond the joint limits"))
            }
            Action::Move(Goal::Tip(tip)) => {
                let is_finite = tip.iter().all(|x| x.is_finite());
                is_finite.then_some(()).ok_or_else(|| wrong(step, "it goes to no finite place"))
            }
        }
    }

    /// Where an object is picked or placed.
    fn rest(&self, step: &Step, object: usize, supports: &[usize], is_finite: bool) -> Result<(), TaskError> {
        let task = self.task;
        let count = task.obstacle_number(task.objects.len());
        let by = Payload::penetration_allowance(&task.arm);
        let is_thick = || task.objects[object].pieces.iter().any(|piece| piece.eroded(by).is_some());
        if !is_finite {
            Err(wrong(step, "it goes to no finite place"))
        } else if supports.iter().any(|&support| support >= count || support == task.obstacle_number(object)) {
            Err(wrong(step, "it rests on itself, or on what does not exist"))
        } else if !supports.is_empty() && !is_thick() {
            Err(wrong(step, "its object is too thin to rest on anything"))
        } else {
            Ok(())
        }
    }
}

fn wrong(step: &Step, why: &'static str) -> TaskError {
    TaskError::Step { number: step.number, cycle: step.cycle, why }
}
