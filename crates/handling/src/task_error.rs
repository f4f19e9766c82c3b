//! What arm, objects and steps must be to make a task.

use super::{Action, Holding, Item, Object, Step, Stroke, Task};
use cplan_core::model::{
    Goal, LARGEST, LATEST, MotionProblem, MotionProblemError, Scene, SceneError, are_small, is_pose, is_small,
};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Nothing takes longer, seconds: as motions.
const LONGEST: f64 = 1e6;

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
    /// A group without steps.
    #[error("a group of steps in any order has no steps")]
    EmptyGroup,
    /// Something moves, and what is asked for is done among what stands alone.
    #[error("\"{mover}\" moves, and {why}")]
    Moves {
        /// The name of an obstacle or object that does.
        mover: String,
        /// What is asked for.
        why: &'static str,
    },
    /// Objects begin anew that cannot.
    #[error("an object is renewed that does not exist, or moves, or is carried then")]
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
        let at_first: Vec<_> = self.objects.iter().map(Object::standing_at_first).collect();
        let moving: Vec<usize> = self.moving_at_first().collect();
        self.objects.iter().try_for_each(check_object)?;
        let scene = Scene::new(self.arm.clone(), self.surroundings(&at_first, &moving))?;
        if let Some((mover, why)) = self.unmoved() {
            return Err(TaskError::Moves { mover, why });
        }
        let mut names: BTreeSet<&str> = self.workspace.all().map(|o| o.name.as_str()).collect();
        if let Some(object) = self.objects.iter().find(|object| !names.insert(&object.name)) {
            return Err(TaskError::Object { object: object.name.clone(), why: "something else has this name" });
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
        };
        self.items.iter().try_for_each(|item| state.item(item))?;
        let first = scene.frozen(0.0);
        Ok(MotionProblem::new(first, self.start, self.start).map(|_| scene)?)
    }

    /// What of the task is done among what stands alone, where something moves, and the name of what does.
    #[must_use]
    pub fn unmoved(&self) -> Option<(String, &'static str)> {
        let own = self.objects.iter().filter_map(|object| Some((&object.name, object.course.as_ref()?)));
        let movers = self.workspace.movers.iter().map(|mover| (&mover.obstacle.name, &mover.course));
        let courses: Vec<_> = movers.chain(own).collect();
        let (first, _) = courses.first()?;
        let turns = |step: &Step| matches!(step.action, Action::Place { angle: Some(_), .. });
        if self.stroke.is_some() {
            return Some(((*first).clone(), "the tool is lowered and raised among what stands"));
        }
        if self.wrist.is_some() && self.steps().any(turns) {
            return Some(((*first).clone(), "a wrist turns objects among what stands"));
        }
        let (turning, _) = courses.iter().find(|(_, course)| course.turns())?;
        let is_level = self.objects.iter().any(|object| object.holding == Holding::Level);
        is_level.then(|| ((*turning).clone(), "objects are held level where nothing that moves turns"))
    }

    fn check_tool(&self) -> Result<(), TaskError> {
        let wrist = self.wrist.iter().map(|wrist| (wrist.velocity, wrist.acceleration, TAU));
        let farthest = |stroke: &Stroke| self.objects.iter().map(|object| stroke.depth(object)).fold(0.0, f64::max);
        let stroke = self.stroke.iter().map(|stroke| (stroke.velocity, stroke.acceleration, farthest(stroke)));
        let why = if !wrist.chain(stroke).all(|(velocity, acceleration, way)| is_drive(velocity, acceleration, way)) {
            "speeds and accelerations must be positive and finite, and such that it takes no more than a million seconds"
        } else if self.stroke.iter().any(|s| !s.joint.is_sound() || s.joint.range.is_circle()) {
            "its joint needs a sign of 1 or -1, a range, and a rest within that"
        } else if self.stroke.iter().filter_map(|s| s.travel).any(|travel| !travel.is_finite() || travel < 0.0) {
            "its travel must be finite and not negative"
        } else if self.stroke.iter().any(|stroke| !self.objects.iter().all(|object| stroke.reaches(object))) {
            "an object lies too deep for the stroke"
        } else {
            return Ok(());
        };
        Err(TaskError::Tool { why })
    }
}

/// Whether a way at these limits takes some time that can be counted.
fn is_drive(velocity: f64, acceleration: f64, way: f64) -> bool {
    let is_limit = |limit: f64| limit.is_finite() && limit > 0.0;
    is_limit(velocity) && is_limit(acceleration) && way / velocity + velocity / acceleration <= LONGEST
}

fn angle_at_first(object: &Object) -> f64 {
    object.at.rotation.angle()
}

fn check_object(object: &Object) -> Result<(), TaskError> {
    let why = if !is_pose(&object.at) {
        "where it lies is no finite pose"
    } else if !(0.0..=LARGEST).contains(&object.lift) {
        "its lift must be no negative number, and no more than 1e15 m"
    } else if !(0.0..=LARGEST).contains(&object.mass) {
        "its mass must be no negative number, and no more than 1e15 kg"
    } else if !object.pieces.iter().all(is_small) {
        "it is larger than 1e15 m"
    } else {
        return Ok(());
    };
    Err(TaskError::Object { object: object.name.clone(), why })
}

/// What the gripper holds from step to step.
struct Gripper<'a> {
    task: &'a Task,
    carried: Option<usize>,
    /// What has been picked.
    picked: BTreeSet<usize>,
    /// The orientation of each object, radians, while it is known: that of rigid payloads is not.
    turned: Vec<f64>,
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
                        _ => return Err(wrong(pick, "in any order there are picks of different objects and places")),
                    }
                    self.step(pick)?;
                    self.step(place)
                })
            }
            Item::Renew(objects) => {
                for &object in objects {
                    let renewed = self.task.objects.get(object).filter(|_| self.carried != Some(object));
                    let renewed = renewed.filter(|object| object.course.is_none());
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
        if !(step.speed > 0.0 && step.speed <= 1.0 && (0.0..=LONGEST).contains(&step.dwell)) {
            return Err(wrong(
                step,
                "its speed must be more than 0 and at most 1, its dwell at most a million seconds, and not negative",
            ));
        }
        match &step.action {
            Action::Pick { object, grasp, supports, when } => {
                if *object >= self.task.objects.len() || self.carried.is_some() {
                    return Err(wrong(step, "it picks what does not exist, or while something is carried"));
                }
                let is_first = self.task.objects[*object].course.is_some() && self.picked.insert(*object);
                let mut ends = when.iter().flatten();
                let is_timely = is_first && ends.clone().is_sorted() && ends.all(|end| (0.0..=LATEST).contains(end));
                if !when.is_empty() && !is_timely {
                    return Err(wrong(step, "only what moves is picked at times, which are in order"));
                }
                self.carried = Some(*object);
                self.rest(step, *object, supports, are_small(grasp.iter().copied()))
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
                let is_finite = are_small(at.iter().chain(angle).copied());
                self.rest(step, object, supports, is_finite)
            }
            Action::Move(Goal::Joints(q)) => {
                let mut values = self.task.arm.joints.iter().zip(q.iter());
                let is_within = values.all(|(joint, value)| joint.range.contains(*value));
                is_within.then_some(()).ok_or_else(|| wrong(step, "it goes beyond the joint limits"))
            }
            Action::Move(Goal::Area(_)) => {
                Err(wrong(step, "it goes to joint values or a place of the tip, not to an area"))
            }
            Action::Move(Goal::Tip(tip)) => {
                let is_finite = are_small(tip.iter().copied());
                is_finite.then_some(()).ok_or_else(|| wrong(step, "it goes to no finite place"))
            }
        }
    }

    /// Where an object is picked or placed.
    fn rest(&self, step: &Step, object: usize, supports: &[usize], is_finite: bool) -> Result<(), TaskError> {
        let task = self.task;
        let count = task.obstacle_number(task.objects.len());
        if !is_finite {
            Err(wrong(step, "it goes to no finite place"))
        } else if supports.iter().any(|&support| support >= count || support == task.obstacle_number(object)) {
            Err(wrong(step, "it rests on itself, or on what does not exist"))
        } else if !supports.is_empty() && !task.objects[object].can_rest(&task.arm) {
            Err(wrong(step, "its object is too thin to rest on anything"))
        } else {
            Ok(())
        }
    }
}

fn wrong(step: &Step, why: &'static str) -> TaskError {
    TaskError::Step { number: step.number, cycle: step.cycle, why }
}
