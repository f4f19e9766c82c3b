//! The state between the steps of a record: the places of all objects, and the load.

use super::{Fault, PLACE_TOLERANCE, ReplayedTurn, TIME_TOLERANCE, angle_between};
use cplan_geometry::{Point, Pose};
use cplan_handling::{
    Action, ArchScene, Holding, Object, ObstacleTrajectory, Payload, Placement, RecordedOverlap, RecordedTurn,
    RecordedWrist, Step, Stroke, Task,
};
use cplan_model::space::Configuration;
use cplan_model::{Grip, Scene};
use cplan_motion::recorded::{TurnAtRest, WristTurn, turn_angle, turn_profile};

/// The places of the objects, and the load.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// Placement of each object; `None` while it is carried.
    poses: Vec<Option<Placement>>,
    /// Objects that are still moving, and so have no fixed pose.
    moving: Vec<usize>,
    held: Option<Payload>,
    /// The object that was released last. Link 2 may touch it during the next motion.
    released: Option<usize>,
    /// Depth from which the tool is raised before the next motion, metres. `None` if it is raised.
    lowered: Option<f64>,
    /// The object that was released last if another arm takes it away, with its pose.
    left: Option<(usize, Pose)>,
}

impl State {
    pub fn initial(task: &Task) -> Self {
        let poses = task.objects.iter().map(Object::initial_static_pose).collect();
        let lowered = task.start_tool.lowered_by();
        Self { poses, moving: task.initially_moving().collect(), held: None, released: None, lowered, left: None }
    }

    /// Raises the tool before the next motion. Returns its previous depth, and the scene with the tool lowered.
    pub fn raise(&mut self, task: &Task) -> Option<(f64, Scene)> {
        let depth = self.lowered.take()?;
        Some((depth, task.empty_lowered_scene(depth, &self.poses, self.released)?))
    }

    /// Lowers the tool at the end of a move, if the step requires it. Returns the scene with the tool lowered.
    pub fn lower(&mut self, task: &Task, step: &Step) -> Option<Scene> {
        self.lowered = step.tool.lowered_by();
        task.empty_lowered_scene(self.lowered?, &self.poses, None)
    }

    pub fn renew(&mut self, task: &Task, objects: &[usize]) {
        objects.iter().for_each(|&object| self.poses[object] = Some(task.objects[object].at.into()));
        // A renewed object is not the one that was released, so contact with it is not permitted.
        self.released = self.released.filter(|released| !objects.contains(released));
    }

    /// Stops a moving object where it is at this time. Returns true if it was moving.
    pub fn stop(&mut self, task: &Task, object: usize, time: f64) -> bool {
        let moved = self.moving.iter().position(|&other| other == object);
        if let Some((place, trajectory)) = moved.zip(task.objects[object].trajectory.as_ref()) {
            self.moving.remove(place);
            self.poses[object] = Some(trajectory.pose(time).into());
        }
        moved.is_some()
    }

    /// Returns the pose of an object, or `None` while it is carried. An object that was left for another arm keeps its pose.
    pub fn pose(&self, object: usize) -> Option<Pose> {
        let left = self.left.filter(|(left, _)| *left == object).map(|(_, pose)| pose);
        self.poses[object].map(|lies| lies.pose).or(left)
    }

    pub fn carried(&self) -> Option<usize> {
        self.held.as_ref().map(|payload| payload.object)
    }

    /// Returns the object that was released last. `None` after the next motion.
    pub fn released(&self) -> Option<usize> {
        self.released
    }

    /// Returns the current scene. Link 2 may touch the object that was released last, and the object `touched`.
    pub fn scene(&self, task: &Task, touched: Option<usize>) -> Scene {
        task.scene(&self.poses, &self.moving, self.held.as_ref(), self.released.into_iter().chain(touched))
    }

    /// Returns the trajectories of the moving obstacles, on a clock that starts at the time `begin` of the task.
    pub fn trajectories(&self, task: &Task, begin: f64) -> Vec<ObstacleTrajectory> {
        task.trajectories_since(&self.moving, begin)
    }

    /// Grasps the object of a pick step, with the arm at `q`. The object keeps its current pose relative to the
    /// gripper. `then` lists the objects that will support it next. Returns the difference from the required grasp.
    pub fn grasp(&mut self, task: &Task, q: Configuration, step: &Step, grasp: Point, then: &[usize]) -> Option<Fault> {
        let Action::Pick { object, supports, .. } = &step.action else { return None };
        let (object, arm) = (*object, &task.arm);
        self.released = None;
        // In a task, every pick has an object at its place; it may have arrived there only now.
        let lies = self.poses[object].take().or_else(|| task.objects[object].arrival())?.pose;
        let tip = arm.tip_at(q);
        let grip = match task.objects[object].holding {
            Holding::Rigid => Grip::rigid(arm, q, &lies),
            Holding::Level => Grip::Level { angle: lies.rotation.angle(), point: lies.inverse().point(tip) },
        };
        let supports = supports.iter().chain(then).copied().collect();
        self.held = Some(Payload { object, grip, supports });
        let off = (tip - lies.point(grasp)).norm();
        (off > PLACE_TOLERANCE).then_some(Fault::Tip { off })
    }

    /// Releases the load with the arm at `q`. Returns the differences from the required place.
    pub fn release(
        &mut self,
        task: &Task,
        (q, elevation): (Configuration, f64),
        at: Point,
        angle: Option<f64>,
    ) -> Vec<Fault> {
        // In a task, every place follows a pick.
        let Some(Payload { object, grip, .. }) = self.held.take() else { return Vec::new() };
        let pose = grip.pose(&task.arm, q);
        self.poses[object] = task.objects[object].left_at(Placement { pose, elevation });
        self.left = self.poses[object].is_none().then_some((object, pose));
        self.released = Some(object);
        let mut faults = Vec::new();
        let off = (pose.translation - at).norm();
        if off > PLACE_TOLERANCE {
            faults.push(Fault::Origin { off });
        }
        if let Some(off) =
            angle.map(|angle| angle_between(pose.rotation.angle(), angle)).filter(|off| *off > PLACE_TOLERANCE)
        {
            faults.push(Fault::Angle { off });
        }
        faults
    }

    /// Returns the scene with the lowered tool and its load, see [`Task::lowered_scene`].
    pub fn lowered(&self, task: &Task, elevation: f64, is_placed: bool) -> Option<Scene> {
        let payload = self.held.as_ref()?;
        task.lowered_scene((payload.object, elevation), is_placed, &self.poses, Some(payload), self.released)
    }

    /// Returns the scenes for strokes to these depths during a motion, see [`Task::arch_scene`]. `angle` is the
    /// orientation of a level payload, if it differs from the current one.
    pub fn arch_scene(
        &self,
        task: &Task,
        stroke: (&Stroke, &[f64]),
        touched: Option<usize>,
        angle: Option<f64>,
    ) -> ArchScene {
        let mut held = self.held.clone();
        if let (Some(Payload { grip: Grip::Level { angle: own, .. }, .. }), Some(angle)) = (&mut held, angle) {
            *own = angle;
        }
        task.arch_scene(stroke, &self.poses, held.as_ref(), self.released.into_iter().chain(touched))
    }

    /// Forgets the object that was released last. To be called when the arm has moved.
    pub fn moved(&mut self) {
        self.released = None;
    }

    /// Checks and performs a turn of the wrist with the arm at `q`. Returns `None` if there is no object or no wrist
    /// that could turn. Adds its faults to the list.
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
                let least = wrist.limits().least_seconds((turn.to - turn.from).abs());
                if turn.seconds < least - TIME_TOLERANCE {
                    faults.push(Fault::TooFast { seconds: turn.seconds, least });
                }
            }
            None => faults.push(Fault::NoWrist),
        }
        let workspace = task.obstacles(&self.poses);
        let level = self.held.as_mut().and_then(|payload| match payload.grip {
            Grip::Level { angle, point } => Some((payload, angle, point)),
            Grip::Rigid(_) => None,
        });
        let Some((payload, angle, point)) = level else {
            faults.push(Fault::Nothing);
            return None;
        };
        let verdict = match angles_at_rest(task, &turn) {
            [a, b] if a == b => Ok(WristTurn { from: turn.from, to: turn.to, clearance: f64::INFINITY }),
            angles => {
                let judged = TurnAtRest::new(task, &workspace.fixed, payload, point, q).judge(angles);
                judged.map(|free| WristTurn { from: turn.from, to: turn.to, ..free })
            }
        };
        let off = angle_between(turn.from, angle);
        if off > PLACE_TOLERANCE {
            faults.push(Fault::Turn { off });
        }
        payload.grip = Grip::Level { angle: angle + (turn.to - turn.from), point };
        Some(ReplayedTurn { turn, verdict })
    }
}

/// Returns the orientations between which a payload turns while the arm rests, radians.
fn angles_at_rest(task: &Task, turn: &RecordedTurn) -> [f64; 2] {
    let RecordedTurn { from, to, seconds, overlap } = *turn;
    let Some(wrist) = task.wrist.filter(|_| overlap != RecordedOverlap::default()) else { return [from, to] };
    let angle = |since: f64| turn_angle(&turn_profile(&wrist, (to - from).abs(), seconds), [from, to], since);
    match overlap.after_departure > 0.0 {
        true => [from, angle(seconds - overlap.after_departure)],
        false => [angle(overlap.before_arrival), to],
    }
}

/// Returns the least time, in seconds, in which the tool moves down to a depth. It moves up in the same time.
pub(super) fn lowering_seconds(task: &Task, depth: f64) -> f64 {
    let stroke = task.stroke.as_ref();
    stroke.map_or(0.0, |stroke| stroke.limits().least_seconds(depth.abs()))
}

/// Returns the faults of a step's turn of the wrist to a value of its joint. `end` is the time at which the step ends, in
/// seconds from the beginning of the record.
pub(super) fn wrist_faults(task: &Task, step: &Step, turn: Option<RecordedWrist>, end: f64) -> Vec<Fault> {
    let Some(((to, from), wrist)) = step.tool.wrist.zip(task.start_tool.wrist).zip(task.wrist) else {
        return turn.map(|_| Fault::WristElsewhere).into_iter().collect();
    };
    let Some(turn) = turn else { return vec![Fault::WristStays { to }] };
    let mut faults = Vec::new();
    if (turn.from - from).abs().max((turn.to - to).abs()) > PLACE_TOLERANCE {
        faults.push(Fault::WristEnds { is: [turn.from, turn.to], asked: [from, to] });
    }
    let least = wrist.limits().least_seconds(task.wrist_turn(step).unwrap_or(0.0).abs());
    if turn.seconds < least - TIME_TOLERANCE {
        faults.push(Fault::TooFast { seconds: turn.seconds, least });
    }
    if turn.begin < -TIME_TOLERANCE || turn.begin + turn.seconds > end + TIME_TOLERANCE {
        faults.push(Fault::WristOutside { begin: turn.begin, until: turn.begin + turn.seconds, end });
    }
    faults
}
