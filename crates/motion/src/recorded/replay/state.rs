//! Where everything is between the steps of a record.

use super::super::given_turn;
use super::{AT, Fault, ReplayedTurn, SHORT, angle_between};
use cplan_core::model::{Grip, Payload, Scene};
use cplan_core::space::Configuration;
use cplan_geometry::{Point, Pose};
use cplan_handling::{Action, Holding, Object, RecordedTurn, Step, Task};

/// Where the objects are, and what the arm carries.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// Of each object, where it lies; none while it is carried.
    poses: Vec<Option<Pose>>,
    /// Those that move as yet, and lie nowhere.
    moving: Vec<usize>,
    held: Option<(usize, Payload)>,
    /// The object just let go of.
    released: Option<usize>,
}

impl State {
    pub fn at_first(task: &Task) -> Self {
        let poses = task.objects.iter().map(Object::standing_at_first).collect();
        Self { poses, moving: task.moving_at_first().collect(), held: None, released: None }
    }

    pub fn renew(&mut self, task: &Task, objects: &[usize]) {
        objects.iter().for_each(|&object| self.poses[object] = Some(task.objects[object].at));
        // A new one is not the one that may be touched.
        self.released = self.released.filter(|released| !objects.contains(released));
    }

    /// Stops an object that moves where it is at a time. Whether it moved.
    pub fn stop(&mut self, task: &Task, object: usize, time: f64) -> bool {
        let moved = self.moving.iter().position(|&other| other == object);
        if let Some((place, course)) = moved.zip(task.objects[object].course.as_ref()) {
            self.moving.remove(place);
            self.poses[object] = Some(course.pose(time));
        }
        moved.is_some()
    }

    /// Where an object lies; none while it is carried.
    pub fn pose(&self, object: usize) -> Option<Pose> {
        self.poses[object]
    }

    pub fn carried(&self) -> Option<usize> {
        self.held.as_ref().map(|(object, _)| *object)
    }

    /// The object just let go of.
    pub fn released(&self) -> Option<usize> {
        self.released
    }

    /// The scene as it is, on the clock of the task. Link 2 is free to meet the object just let go of, and another one.
    pub fn scene(&self, task: &Task, allowed_contacts: Option<usize>) -> Scene {
        let allowed_contacts: Vec<usize> =
            self.released.into_iter().chain(allowed_contacts).map(|o| task.number_among(&self.moving, o)).collect();
        let payload = self.held.as_ref().map(|(_, payload)| payload.clone());
        let workspace = task.surroundings(&self.poses, &self.moving);
        Scene::handling_trusted(task.arm.clone(), workspace, payload, &allowed_contacts)
    }

    /// Takes the object that a step picks with the arm at `q`, held as it lies to the arm then; `then` is what it will rest
    /// on. What is not as asked for.
    pub fn grasp(&mut self, task: &Task, q: Configuration, step: &Step, grasp: Point, then: &[usize]) -> Option<Fault> {
        let Action::Pick { object, supports, .. } = &step.action else { return None };
        let (object, arm) = (*object, &task.arm);
        self.released = None;
        // Picks of a task find their objects.
        let lies = self.poses[object].take()?;
        let tip = arm.tip_at(q);
        let grip = match task.objects[object].holding {
            Holding::Rigid => Payload::rigid_grip(arm, q, &lies),
            Holding::Level => Grip::Level { angle: lies.rotation.angle(), point: lies.inverse() * tip },
        };
        let supports = supports.iter().chain(then).copied().collect();
        let payload = task.objects[object].carried(grip, supports);
        self.held = Some((object, payload));
        let off = (tip - lies * grasp).norm();
        (off > AT).then_some(Fault::Tip { off })
    }

    /// Lets go of what is carried with the arm at `q`. What is not as asked for.
    pub fn release(&mut self, task: &Task, q: Configuration, at: Point, angle: Option<f64>) -> Vec<Fault> {
        // Places of a task follow picks.
        let Some((object, payload)) = self.held.take() else { return Vec::new() };
        let pose = payload.pose(&task.arm, q);
        self.poses[object] = Some(pose);
        self.released = Some(object);
        let mut faults = Vec::new();
        let off = (Point::from(pose.translation.vector) - at).norm();
        if off > AT {
            faults.push(Fault::Origin { off });
        }
        if let Some(off) = angle.map(|angle| angle_between(pose.rotation.angle(), angle)).filter(|off| *off > AT) {
            faults.push(Fault::Angle { off });
        }
        faults
    }

    /// The scene with the tool, and what it holds, while it is lowered: see [`Task::lowered`].
    pub fn lowered(&self, task: &Task, is_placed: bool) -> Option<Scene> {
        let (object, payload) = self.held.as_ref()?;
        let (arm, heights) = task.lowered(*object, is_placed)?;
        let allowed_contacts: Vec<usize> = self.released.iter().map(|&object| task.obstacle_number(object)).collect();
        let payload = Payload { heights, ..payload.clone() };
        Some(Scene::handling_trusted(arm, task.obstacles(&self.poses), Some(payload), &allowed_contacts))
    }

    /// Goes on after a motion without an event.
    pub fn moved(&mut self) {
        self.released = None;
    }

    /// Judges and makes a turn of the wrist with the arm at `q`; none if nothing can turn. Adds what is not as it should be.
    pub fn turn(
        &mut self,
        task: &Task,
        q: Configuration,
        turn: Option<RecordedTurn>,
        faults: &mut Vec<Fault>,
    ) -> Option<ReplayedTurn> {
        let turn = turn?;
        match task.wrist {
            Some(wrist) => {
                let least = least_seconds((turn.to - turn.from).abs(), wrist.velocity, wrist.acceleration);
                if turn.seconds < least - SHORT {
                    faults.push(Fault::TooFast { seconds: turn.seconds, least });
                }
            }
            None => faults.push(Fault::NoWrist),
        }
        let workspace = task.obstacles(&self.poses);
        let level = self.held.as_mut().and_then(|(_, payload)| match payload.grip {
            Grip::Level { angle, point } => Some((payload, angle, point)),
            Grip::Rigid(_) => None,
        });
        let Some((payload, angle, point)) = level else {
            faults.push(Fault::Nothing);
            return None;
        };
        let verdict = given_turn(&task.arm, &workspace, payload, point, q, [turn.from, turn.to]);
        let off = angle_between(turn.from, angle);
        if off > AT {
            faults.push(Fault::Turn { off });
        }
        payload.grip = Grip::Level { angle: angle + (turn.to - turn.from), point };
        Some(ReplayedTurn { turn, verdict })
    }
}

/// Least seconds in which the tool goes down to an object and up again.
pub(super) fn stroke_seconds(task: &Task, object: usize) -> f64 {
    task.stroke.as_ref().map_or(0.0, |stroke| {
        let depth = stroke.depth(&task.objects[object]).abs();
        2.0 * least_seconds(depth, stroke.velocity, stroke.acceleration)
    })
}

/// Least seconds for a way from rest to rest: up to the top speed, along at it, and down; or, where there is no room
/// for that, up and down.
fn least_seconds(way: f64, velocity: f64, acceleration: f64) -> f64 {
    let ramps = velocity * velocity / acceleration;
    if way > ramps {
        2.0 * velocity / acceleration + (way - ramps) / velocity
    } else {
        2.0 * (way / acceleration).sqrt()
    }
}
