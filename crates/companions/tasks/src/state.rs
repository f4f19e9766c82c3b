//! States of a task, and the candidates for the next step.

use super::ik_solutions::{goal_ik_solutions, ik_solutions};
use super::stroke::stroke_depth;
use cplan_geometry::Pose;
use cplan_handling::{Action, Holding, Item, Object, Payload, Placement, Step, Task};
use cplan_legs::Event;
use cplan_model::space::Configuration;
use cplan_model::{Grip, Scene};
use cplan_motion::recorded::WristTurn;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The items of a task that are done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Progress {
    /// Index of the next item, or of the group that is in progress.
    pub item: usize,
    /// In a group in any order, the pairs that are done, one bit each.
    pub done: u64,
    /// In a group in any order, the pair whose object is carried.
    pub carried_pair: Option<usize>,
}

/// The state of arm and objects.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub progress: Progress,
    pub q: Configuration,
    /// Placement of each object. `None` while it is carried or still moves by itself.
    pub poses: Arc<[Option<Placement>]>,
    /// The objects that still move by themselves, in ascending order.
    pub moving: Arc<[usize]>,
    /// The payload. Its supports are the obstacles on which it rested and will rest, in ascending order.
    pub held: Option<Payload>,
    /// The object that the last step released. `None` if the last step released none.
    pub released: Option<usize>,
    /// Depth in metres from which the tool is still raised when the next motion may begin. `None` if the tool is raised.
    pub rising: Option<f64>,
    /// True if the next motion begins with that raising. Otherwise, the raising belongs to the last step.
    pub is_lowered: bool,
    /// The turn after the last step during which the next motion may begin, and its duration at rest, in seconds. `None`
    /// if the wrist does not turn, or only while the arm is at rest.
    pub turning: Option<(WristTurn, f64)>,
    /// Value of the wrist's joint, radians, after the turn of the last step. `None` unless a line of the task asks for an
    /// angle of the tool.
    pub wrist: Option<f64>,
}

/// A candidate for the next step: one possible configuration at its target, and one orientation of the object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate<'a> {
    pub step: &'a Step,
    /// Configuration in which the motion ends.
    pub to: Configuration,
    /// Angles between which the wrist must turn the object after the motion, in radians. `None` if no turn is needed.
    pub turn: Option<[f64; 2]>,
    pub event: Option<Event>,
    /// Grip of the object after a pick.
    grip: Option<Grip>,
    /// The progress after the step.
    pub progress: Progress,
}

impl Candidate<'_> {
    /// Returns the depth to which the tool is lowered at the target, in metres. `None` if it stays raised.
    pub fn depth(&self, task: &Task) -> Option<f64> {
        match self.event {
            Some(event) => stroke_depth(task, self.step, Some(event.object())),
            None => self.step.tool.lowered_by(),
        }
    }

    /// Returns true if the wrist turns at the target before the tool is lowered.
    pub fn turns_before_stroke(&self) -> bool {
        self.turn.is_some() && matches!(self.event, Some(Event::Release { .. }))
    }

    /// Returns true if the wrist turns at the target after the tool is raised.
    pub fn turns_after_stroke(&self) -> bool {
        self.turn.is_some() && matches!(self.event, Some(Event::Grasp { .. }))
    }
}

/// The candidates for a step.
pub(super) struct Candidates<'a> {
    pub step: &'a Step,
    pub ways: Vec<Candidate<'a>>,
    /// True if these are all possible candidates.
    pub all: bool,
    /// True if all IK solutions at the target are among the candidates. The wrist may have other turns.
    pub has_every_ik_solution: bool,
}

impl<'a> Candidates<'a> {
    /// Returns an empty list for a step with unknown candidates.
    fn unknown(step: &'a Step) -> Self {
        Self { step, ways: Vec::new(), all: false, has_every_ik_solution: false }
    }
}

/// Difference in radians below which two orientations count as equal. It covers rounding.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Difference in metres and radians below which two poses or configurations count as equal. It covers rounding.
const POSE_TOLERANCE: f64 = 1e-9;

/// Unit in radians to whose multiples the orientations of released rigid payloads are rounded. It is far below all
/// tolerances, and far above the rounding of doubles. So repeated cycles return to the same world, bit for bit, and are
/// planned only once.
const ORIENTATION_ROUNDING: f64 = 1e-12;

impl State {
    pub fn at_start(task: &Task) -> Self {
        let state = Self {
            progress: Progress { item: 0, done: 0, carried_pair: None },
            q: task.start,
            poses: task.objects.iter().map(Object::initial_static_pose).collect(),
            moving: task.initially_moving().collect(),
            held: None,
            released: None,
            rising: task.start_tool.lowered_by(),
            is_lowered: task.start_tool.lowered_by().is_some(),
            turning: None,
            wrist: task
                .wrist
                .filter(|_| task.turns_tool_along_lines())
                .and_then(|wrist| Some(task.start_tool.wrist.unwrap_or(wrist.joint?.rest))),
        };
        state.renewed(task)
    }

    pub fn is_done(&self, task: &Task) -> bool {
        self.progress.item == task.items.len()
    }

    /// Returns a key of the state. States with the same key are equal for all later steps.
    pub fn key(&self, task: &Task) -> Vec<i64> {
        let grains = |value: f64| (value / POSE_TOLERANCE).round() as i64;
        let Progress { item, done, carried_pair } = self.progress;
        let q = task.arm.topology().wrap(self.q);
        let mut key =
            vec![item as i64, done as i64, carried_pair.map_or(-1, |pair| pair as i64), grains(q[0]), grains(q[1])];
        let mut pose = |pose: &Pose| {
            let turn = normalized(pose.rotation.angle());
            key.extend([pose.translation.x, pose.translation.y, turn].map(grains));
        };
        self.poses.iter().flatten().for_each(|lies| pose(&lies.pose));
        let elevations: Vec<i64> = self.poses.iter().flatten().map(|lies| grains(lies.elevation)).collect();
        match &self.held {
            Some(Payload { grip: Grip::Rigid(in_link), .. }) => pose(in_link),
            Some(Payload { grip: Grip::Level { angle, .. }, .. }) => key.push(grains(normalized(*angle))),
            None => {}
        }
        key.extend(elevations);
        key.extend(self.held.iter().map(|held| held.object as i64));
        key.extend(self.released.iter().map(|&object| object as i64));
        key.extend(self.turning.iter().flat_map(|(turn, _)| [turn.from, turn.to]).map(grains));
        key.extend(self.wrist.map(grains));
        key
    }

    /// Returns the state at the time when a moving object is picked. The object has the pose that it has at that time.
    pub fn at_pick(&self, task: &Task, object: usize, time: f64) -> Self {
        let mut state = self.clone();
        Arc::make_mut(&mut state.poses)[object] =
            task.objects[object].trajectory.as_ref().map(|trajectory| trajectory.pose(time).into());
        state.moving = self.moving.iter().copied().filter(|&other| other != object).collect();
        state
    }

    /// Returns the scene of this state. Link 2 may touch the object `touched`, to which it moves, and the object that
    /// was just released.
    pub fn scene(&self, task: &Task, touched: Option<usize>) -> Scene {
        task.scene(&self.poses, &self.moving, self.held.as_ref(), self.released.into_iter().chain(touched))
    }

    /// Returns the candidates for each step that can be next.
    pub fn candidates<'a>(&self, task: &'a Task) -> Vec<Candidates<'a>> {
        let Some(item) = task.items.get(self.progress.item) else { return Vec::new() };
        match (item, self.progress.carried_pair) {
            (Item::Step(step), _) => {
                let place = following_place(task, self.progress.item);
                vec![self.candidates_for(task, step, place, None)]
            }
            (Item::AnyOrder(pairs), Some(carried_pair)) => {
                vec![self.candidates_for(task, &pairs[carried_pair][1], None, Some(carried_pair))]
            }
            (Item::AnyOrder(pairs), None) => {
                let open = (0..pairs.len()).filter(|pair| self.progress.done & (1 << pair) == 0);
                open.map(|pair| self.candidates_for(task, &pairs[pair][0], Some(&pairs[pair][1]), Some(pair))).collect()
            }
            // Renewals happen before the next step, so no state has one as its next item.
            (Item::Renew(_), _) => Vec::new(),
        }
    }

    /// Returns the candidates for a step. `place` is the step that places the object after a pick.
    fn candidates_for<'a>(
        &self,
        task: &'a Task,
        step: &'a Step,
        place: Option<&Step>,
        pair: Option<usize>,
    ) -> Candidates<'a> {
        let progress = self.progress.after(&step.action, pair, task);
        let mut ways = Vec::new();
        let mut add = |to: Configuration, turn: Option<[f64; 2]>, event: Option<Event>, grip: Option<Grip>| {
            ways.push(Candidate { step, to, turn, event, grip, progress });
        };
        let (arm, elbow) = (&task.arm, step.required_elbow());
        let reach = match (&step.action, &self.held) {
            (Action::Move(goal), _) => {
                let reach = goal_ik_solutions(arm, goal, self.q);
                reach.configurations.iter().for_each(|&to| add(to, None, None, None));
                reach
            }
            (Action::Follow(line), _) => {
                let reach = ik_solutions(arm, arm.tip, (line.path.end().into(), elbow), self.q);
                reach.configurations.iter().for_each(|&to| add(to, None, None, None));
                reach
            }
            (Action::Pick { object, grasp, .. }, None) => {
                let there = self.poses[*object].or_else(|| task.objects[*object].arrival());
                let Some(Placement { pose: lies, .. }) = there else { return Candidates::unknown(step) };
                let reach = ik_solutions(arm, arm.tip, (lies.point(*grasp), elbow), self.q);
                let wanted = place.and_then(|place| match place.action {
                    Action::Place { angle, .. } => angle,
                    _ => None,
                });
                let event = Some(Event::Grasp { object: *object });
                for &to in &reach.configurations {
                    match task.objects[*object].holding {
                        Holding::Rigid => add(to, None, event, Some(Grip::rigid(arm, to, &lies))),
                        Holding::Level => {
                            let angle = lies.rotation.angle();
                            add(to, None, event, Some(Grip::Level { angle, point: *grasp }));
                            if let Some(wanted) = wanted.filter(|wanted| !same_angle(*wanted, angle)) {
                                let grip = Grip::Level { angle: wanted, point: *grasp };
                                add(to, Some([angle, wanted]), event, Some(grip));
                            }
                        }
                    }
                }
                reach
            }
            (Action::Place { at, angle, .. }, Some(held)) => {
                let object = held.object;
                match held.grip {
                    Grip::Rigid(in_link) => {
                        let reach = ik_solutions(arm, in_link.translation, (*at, elbow), self.q);
                        for &to in &reach.configurations {
                            let turned = (arm.pose(1, to) * in_link).rotation.angle();
                            let turned = (turned / ORIENTATION_ROUNDING).round() * ORIENTATION_ROUNDING;
                            let pose = Pose::new(*at, turned);
                            add(to, None, Some(Event::Release { object, pose }), None);
                        }
                        reach
                    }
                    Grip::Level { angle: carried, point } => {
                        let wanted = angle.unwrap_or(carried);
                        let pose = Pose::new(*at, wanted);
                        let reach = ik_solutions(arm, arm.tip, (pose.point(point), elbow), self.q);
                        let turn = (!same_angle(carried, wanted)).then_some([carried, wanted]);
                        let event = Some(Event::Release { object, pose });
                        reach.configurations.iter().for_each(|&to| add(to, turn, event, None));
                        reach
                    }
                }
            }
            // The loader guarantees that picks and places alternate.
            (Action::Pick { .. }, Some(_)) | (Action::Place { .. }, None) => {
                return Candidates::unknown(step);
            }
        };
        // A turn during the motion would be another candidate.
        let turns = ways.iter().any(|candidate| candidate.turn.is_some());
        Candidates { step, ways, all: reach.all && !turns, has_every_ik_solution: reach.all }
    }

    /// Returns the state after a candidate's step, with the arm at `q`. Includes all renewals before the next step.
    pub fn after(&self, task: &Task, candidate: &Candidate, q: Configuration) -> Self {
        self.after_step(task, candidate, q).renewed(task)
    }

    /// Returns the state directly after a candidate's step, with the arm at `q`, before any renewals. The turn at the end
    /// of the step is not known here.
    pub fn after_step(&self, task: &Task, candidate: &Candidate, q: Configuration) -> Self {
        let mut poses = self.poses.clone();
        let may_depart = !candidate.turns_after_stroke() || turns_on_the_way(task);
        let rising = candidate.depth(task).filter(|_| may_depart);
        let mut after = Self {
            progress: candidate.progress,
            q,
            released: None,
            rising,
            is_lowered: rising.is_some() && candidate.event.is_none(),
            turning: None,
            ..self.clone()
        };
        match candidate.event {
            Some(Event::Grasp { object }) => {
                Arc::make_mut(&mut poses)[object] = None;
                after.moving = self.moving.iter().copied().filter(|&other| other != object).collect();
                let supports = supports(candidate.step, self.progress.place(task, candidate));
                after.held = candidate.grip.map(|grip| Payload { object, grip, supports });
            }
            Some(Event::Release { object, pose }) => {
                let placement = Placement { pose, elevation: candidate.step.elevation };
                Arc::make_mut(&mut poses)[object] = task.objects[object].left_at(placement);
                (after.held, after.released) = (None, Some(object));
            }
            None => {}
        }
        Self { poses, ..after }
    }

    /// Returns true if objects are renewed before the next step. Then the world of the next motion differs from that at
    /// the end of the last one.
    pub fn needs_renewal(&self, task: &Task) -> bool {
        matches!(task.items.get(self.progress.item), Some(Item::Renew(_)))
    }

    /// Renews objects if that is the next item of the task.
    pub fn renewed(mut self, task: &Task) -> Self {
        while let Some(Item::Renew(objects)) = task.items.get(self.progress.item) {
            let poses = Arc::make_mut(&mut self.poses);
            objects.iter().for_each(|&object| poses[object] = Some(task.objects[object].at.into()));
            // A renewed object is a new one, which the arm must not touch.
            self.released = self.released.filter(|released| !objects.contains(released));
            self.progress.item += 1;
        }
        self
    }
}

impl Progress {
    /// Returns the place step for the object that a candidate picks. `None` if there is none.
    fn place<'a>(self, task: &'a Task, candidate: &Candidate) -> Option<&'a Step> {
        match (&task.items[self.item], candidate.progress.carried_pair) {
            (Item::AnyOrder(pairs), Some(pair)) => Some(&pairs[pair][1]),
            _ => following_place(task, self.item),
        }
    }

    fn after(self, action: &Action, pair: Option<usize>, task: &Task) -> Self {
        let next = Self { item: self.item + 1, done: 0, carried_pair: None };
        let Some(pair) = pair else { return next };
        if matches!(action, Action::Pick { .. }) {
            return Self { carried_pair: Some(pair), ..self };
        }
        let done = self.done | 1 << pair;
        let all = matches!(&task.items[self.item], Item::AnyOrder(pairs) if done.count_ones() as usize == pairs.len());
        if all { next } else { Self { done, carried_pair: None, ..self } }
    }
}

/// Returns true if the wrist may turn objects while the arm moves. Among moving obstacles it turns only at rest.
pub(super) fn turns_on_the_way(task: &Task) -> bool {
    task.wrist.is_some_and(|wrist| wrist.turns_on_the_way) && !task.has_moving_obstacles()
}

/// Returns the indices of the obstacles that an object may touch from its pick to its place, in ascending order.
fn supports(pick: &Step, place: Option<&Step>) -> Vec<usize> {
    let of = |step: &Step| match &step.action {
        Action::Pick { supports, .. } | Action::Place { supports, .. } => supports.clone(),
        Action::Move(_) | Action::Follow(_) => Vec::new(),
    };
    let mut both = of(pick);
    both.extend(place.map(of).unwrap_or_default());
    both.sort_unstable();
    both.dedup();
    both
}

/// Returns the place step for the object that the arm carries when an item begins.
fn following_place(task: &Task, item: usize) -> Option<&Step> {
    task.items[item..].iter().find_map(|item| match item {
        Item::Step(step) if matches!(step.action, Action::Place { .. }) => Some(step),
        _ => None,
    })
}

/// Returns true if two orientations are equal up to whole turns.
pub(super) fn same_angle(a: f64, b: f64) -> bool {
    normalized(a - b).abs() < ANGLE_TOLERANCE
}

/// Returns the orientation in `[-pi, pi)`, in radians. A value that differs from `pi` by rounding becomes `-pi`.
fn normalized(angle: f64) -> f64 {
    let turn = (angle + PI).rem_euclid(TAU) - PI;
    if turn > PI - ANGLE_TOLERANCE { -PI } else { turn }
}
