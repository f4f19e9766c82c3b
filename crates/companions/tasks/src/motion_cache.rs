//! The motions of a task, each planned once.

use super::arch::overlap;
use super::least_time::least_of_tool;
use super::motion_path::{PathStatus, examine_path, of_legs, path, plan_among_few};
use super::refusal::{Refusal, require_unobstructed};
use super::state::{Candidate, State, turns_on_the_way};
use super::stroke::{raising_first, stroke};
use super::tool_turn::turned_first;
use cplan_follow::{Found, Settings, WristAlong, follow_between};
use cplan_geometry::Pose;
use cplan_handling::{Action, FollowedLine, Payload, Placement, Step, Task, WristGuide};
use cplan_judge::CertifiedPath;
use cplan_legs::{Overlap, StandstillScene, ToolStroke, WristMotion};
use cplan_model::{Grip, Outcome, Scene};
use cplan_motion::recorded::{TurnAtRest, WristTurn};
use cplan_motion::{TimedMotion, TorqueLimit, nanoseconds, seconds, single};
use cplan_solver::Options;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A motion, with the turn and the stroke that follow it.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub timed: Arc<TimedMotion>,
    pub turn: Option<(WristTurn, f64)>,
    /// The stroke with which it begins, if the tool is lowered there.
    pub raising: Option<ToolStroke>,
    pub stroke: Option<ToolStroke>,
    /// The turn of the wrist from one value of its joint to another.
    pub wrist: Option<WristMotion>,
    /// True if the tool is raised again at the end of the motion, because the gripper has acted.
    raises_again: bool,
    pub overlap: Overlap,
    /// Proven bound on the distance of the tip from the line, in metres, if the motion follows one.
    pub deviation: Option<f64>,
    /// Proven bound on the difference between the tool's angle and the one that the line asks for, in radians.
    pub tool_deviation: Option<f64>,
    /// Duration of the turn after the step before, in seconds, if the motion may begin during it. It counts for this
    /// motion, since it may be hidden in it.
    pub turning_before: f64,
    /// Duration of the own turn, in seconds, unless it counts for the next motion.
    turning: f64,
}

impl Motion {
    /// Creates a motion of the arm alone.
    fn of(timed: Arc<TimedMotion>) -> Self {
        Self {
            timed,
            turn: None,
            raising: None,
            stroke: None,
            wrist: None,
            raises_again: false,
            overlap: Overlap::NONE,
            deviation: None,
            tool_deviation: None,
            turning_before: 0.0,
            turning: 0.0,
        }
    }

    /// Returns the time from the end of the step before to the end of this one, without its dwell, in seconds. A step
    /// ends when the tool is raised. If the arm departs earlier, the time is shorter than that of the motion. A turn
    /// after a pick that may overlap with the next motion counts for that motion.
    pub fn seconds(&self) -> f64 {
        let strokes = if self.raises_again { 2.0 } else { 1.0 };
        let stroke = self.stroke.map_or(0.0, |stroke| strokes * stroke.seconds);
        let moving =
            self.timed.trajectory.duration() - self.overlap.seconds() + self.before_departure() + self.turning + stroke;
        // All times are whole nanoseconds. Rounding must not decide between motions during which the wrist turns equally long.
        let waiting = self.wrist.map_or(0.0, |wrist| wrist.waiting);
        if waiting > 0.0 { seconds(nanoseconds(moving + waiting)) } else { moving }
    }

    /// Returns the time of the turn and the stroke before the departure that count for this motion, in seconds. A part of
    /// it may overlap with the motion.
    pub fn before_departure(&self) -> f64 {
        self.turning_before + self.raising.map_or(0.0, |raising| raising.seconds)
    }
}

/// A motion along a line, with proven bounds.
#[derive(Debug, Clone)]
struct LineMotion {
    timed: Arc<TimedMotion>,
    /// Bound on the distance of the tip from the line, in metres.
    deviation: f64,
    /// Bound on the difference between the tool's angle and the one that the line asks for, in radians.
    tool_deviation: Option<f64>,
}

/// The data that determines a scene, as bits. It serves as a key.
type SceneKey = Vec<u64>;

/// Index of a scene, with the bits of the start and the end of a path.
type PathKey = (usize, [u64; 4]);

/// Plans motions and caches them. A motion among the same relevant obstacles is planned only once. Tasks that differ
/// only in their items can share a cache.
pub(super) struct MotionCache {
    options: Options,
    /// The index of each scene. Scenes that differ only in objects that cannot affect the motion share an index.
    numbers: BTreeMap<SceneKey, usize>,
    path_statuses: BTreeMap<PathKey, PathStatus>,
    /// Paths among the static obstacles and some of the objects.
    fewer: BTreeMap<(SceneKey, [u64; 4]), Result<CertifiedPath, Refusal>>,
    /// Motions by path and speed.
    motions: BTreeMap<(PathKey, u64), Result<Arc<TimedMotion>, Refusal>>,
    /// Motions along lines, by scene, ends and number of the step.
    lines: BTreeMap<SceneKey, Result<LineMotion, Refusal>>,
    /// Scenes with all objects, for answers.
    scenes: BTreeMap<SceneKey, Arc<Scene>>,
    /// Overlaps by scene, objects of the strokes, ends and speed.
    overlaps: BTreeMap<SceneKey, Overlap>,
}

impl MotionCache {
    pub fn new(options: &Options) -> Self {
        Self {
            options: of_legs(options),
            numbers: BTreeMap::new(),
            path_statuses: BTreeMap::new(),
            fewer: BTreeMap::new(),
            motions: BTreeMap::new(),
            lines: BTreeMap::new(),
            scenes: BTreeMap::new(),
            overlaps: BTreeMap::new(),
        }
    }

    /// Returns the number of motions planned so far.
    pub fn planned(&self) -> usize {
        self.motions.len() + self.lines.len()
    }

    /// Returns the number of paths examined so far, including those of motions.
    pub fn examined_paths(&self) -> usize {
        self.path_statuses.len()
    }

    /// Returns the scene of a motion. The same state of the world gives the same scene.
    pub fn scene(&mut self, task: &Task, from: &State, step: &Step) -> Arc<Scene> {
        let key = scene_key(from, step, |_| true);
        self.scenes.entry(key).or_insert_with(|| Arc::new(from.scene(task, step.action.picked()))).clone()
    }

    /// Returns the motion to a candidate's target with the turn and the stroke there.
    pub fn motion(&mut self, task: &Task, from: &State, candidate: &Candidate) -> Result<Motion, Refusal> {
        if let Action::Follow(line) = &candidate.step.action {
            let LineMotion { mut timed, deviation, tool_deviation } = self.line(task, from, candidate, line)?;
            if let Some((begin, wrist)) = from.wrist.zip(task.wrist) {
                timed = turned_first(&from.scene(task, None), &timed, begin, &wrist, candidate.step.speed);
            }
            let turning_before = from.turning.map_or(0.0, |(_, seconds)| seconds);
            let deviation = Some(deviation);
            return Ok(Motion { deviation, tool_deviation, turning_before, ..Motion::of(timed) });
        }
        let key = self.checked_path_key(task, from, candidate)?;
        let speed = candidate.step.speed;
        let known = self.motions.get(&(key, speed.to_bits())).cloned();
        let timed = known.unwrap_or_else(|| {
            let planned = self.planned_motion(task, from, candidate, key);
            self.motions.insert((key, speed.to_bits()), planned.clone());
            planned
        })?;
        let mut turn = candidate.turn.map(|turn| self.turn(task, from, candidate, turn)).transpose()?;
        let raising = raising_first(task, from)?;
        let stroke = stroke(task, from, candidate)?;
        let own_turn = turn.filter(|_| candidate.turns_before_stroke());
        let overlap = self.overlap(task, from, candidate, (&timed, stroke.as_ref(), own_turn));
        if let (Some((_, seconds)), Some(stretched)) = (&mut turn, overlap.turn_seconds.filter(|_| own_turn.is_some()))
        {
            *seconds = stretched;
        }
        let counts = own_turn.is_some() || !turns_on_the_way(task);
        let turning = turn.filter(|_| counts).map_or(0.0, |(_, seconds)| seconds);
        let turning_before = from
            .turning
            .map_or(0.0, |(_, seconds)| overlap.turn_seconds.filter(|_| own_turn.is_none()).unwrap_or(seconds));
        let raises_again = candidate.event.is_some();
        let overlaps = Motion { overlap, turning_before, turning, ..Motion::of(timed) };
        let motion = Motion { turn, raising, stroke, raises_again, ..overlaps };
        let departure = motion.before_departure() - motion.overlap.departure();
        let wrist = task.wrist_turn(candidate.step).zip(task.wrist).map(|(angle, limits)| {
            let ends = [departure + motion.timed.trajectory.duration(), motion.seconds() + candidate.step.dwell];
            WristMotion::new(&limits, angle, departure, ends)
        });
        Ok(Motion { wrist, ..motion })
    }

    /// Returns the motion along a line, with proven bounds.
    fn line(
        &mut self,
        task: &Task,
        from: &State,
        candidate: &Candidate,
        line: &FollowedLine,
    ) -> Result<LineMotion, Refusal> {
        require_free_after(task, from, candidate)?;
        let step = candidate.step;
        let mut key = scene_key(from, step, |_| true);
        key.extend([from.q[0], from.q[1], candidate.to[0], candidate.to[1]].map(f64::to_bits));
        key.push(step.number as u64);
        if let Some(known) = self.lines.get(&key) {
            return known.clone();
        }
        let drive = &self.options.drive;
        let settings = Settings {
            tolerance: line.tolerance,
            speed: line.speed,
            tip_speed: drive.tip_speed,
            share: step.speed,
            period: drive.period,
            wrist: line.wrist.map(|guide| wrist_along(task, guide)).transpose()?,
            elbow: line.elbow,
        };
        let scene = from.scene(task, None);
        let planned = match follow_between(&scene, &line.path, &settings, [from.q, candidate.to]) {
            Ok(Outcome::Found(Found { timed, deviation, tool_deviation, .. })) => {
                Ok(LineMotion { timed: Arc::new(timed), deviation, tool_deviation })
            }
            Ok(Outcome::Infeasible(why)) => Err(Refusal::new(why, true)),
            Ok(Outcome::Unknown(why)) => Err(Refusal::new(why, false)),
            Err(error) => Err(Refusal::new(error.to_string(), false)),
        };
        self.lines.insert(key, planned.clone());
        planned
    }

    /// Returns the overlap of strokes and turns with a motion.
    fn overlap(
        &mut self,
        task: &Task,
        from: &State,
        candidate: &Candidate,
        (timed, stroke, turn): (&TimedMotion, Option<&ToolStroke>, Option<(WristTurn, f64)>),
    ) -> Overlap {
        let mut key = scene_key(from, candidate.step, |_| true);
        let bits = |depth: Option<f64>| depth.map_or(u64::MAX, f64::to_bits);
        key.extend([bits(from.rising), bits(candidate.depth(task)), u64::from(candidate.turns_before_stroke())]);
        key.extend([from.q[0], from.q[1], candidate.to[0], candidate.to[1], candidate.step.speed].map(f64::to_bits));
        key.extend(turn.iter().chain(&from.turning).flat_map(|(turn, _)| [turn.from, turn.to]).map(f64::to_bits));
        *self.overlaps.entry(key).or_insert_with(|| overlap(task, from, candidate, timed, (stroke, turn)))
    }

    fn planned_motion(
        &mut self,
        task: &Task,
        from: &State,
        candidate: &Candidate,
        key: PathKey,
    ) -> Result<Arc<TimedMotion>, Refusal> {
        let scene = from.scene(task, candidate.step.action.picked());
        let path = match &self.path_statuses[&key] {
            _ if !self.options.planner.method().optimizes() => path(&scene, from.q, candidate.to, &self.options)?,
            PathStatus::Straight(path) => path.clone(),
            PathStatus::Undecided | PathStatus::Infeasible(_) => self.shortest(task, from, candidate, &scene)?,
        };
        let timed = self.options.drive.along(&scene, &path, candidate.step.speed);
        timed.map(Arc::new).map_err(|error| Refusal::new(error.to_string(), false))
    }

    /// Returns the planner's path among all objects. It first plans with only a few objects, because such a path serves
    /// many motions. If the path is free among all objects, it is the answer, as no path is shorter. Otherwise the
    /// objects that it hits are added, and the path is planned again.
    fn shortest(
        &mut self,
        task: &Task,
        from: &State,
        candidate: &Candidate,
        scene: &Scene,
    ) -> Result<CertifiedPath, Refusal> {
        let (q, to, picked) = (from.q, candidate.to, candidate.step.action.picked());
        let ends = [q[0], q[1], to[0], to[1]].map(f64::to_bits);
        let own = task.workspace.fixed.obstacles.len();
        let found = plan_among_few(scene, own, |among| {
            let lies = |(object, pose): (usize, &Option<Placement>)| pose.filter(|_| among.contains(&object));
            let poses = from.poses.iter().enumerate().map(lies).collect();
            let fewer = State { poses, ..from.clone() };
            let key = (scene_key(&fewer, candidate.step, |object| among.contains(&object)), ends);
            let options = &self.options;
            let plan = || path(&fewer.scene(task, picked), q, to, options);
            self.fewer.entry(key).or_insert_with(plan).clone()
        });
        found.unwrap_or_else(|| path(scene, q, to, &self.options))
    }

    /// Refuses a candidate if an inexpensive check rules out the motion to its target, or the turn there. Such checks
    /// find most reasons in a small part of the time for planning the motion.
    pub fn check_candidate(&mut self, task: &Task, from: &State, candidate: &Candidate) -> Result<(), Refusal> {
        if let Action::Follow(line) = &candidate.step.action {
            return self.line(task, from, candidate, line).map(|_| ());
        }
        let key = self.checked_path_key(task, from, candidate)?;
        if let Some(Err(refusal)) = self.motions.get(&(key, candidate.step.speed.to_bits())) {
            return Err(refusal.clone());
        }
        raising_first(task, from)?;
        stroke(task, from, candidate)?;
        candidate.turn.map_or(Ok(()), |turn| self.turn(task, from, candidate, turn).map(|_| ()))
    }

    /// Examines the path to a candidate's target, and returns its key. Refuses the candidate if there is provably no
    /// path.
    fn checked_path_key(&mut self, task: &Task, from: &State, candidate: &Candidate) -> Result<PathKey, Refusal> {
        require_free_after(task, from, candidate)?;
        let carried = from.held.as_ref().map(|held| task.objects[held.object].carried_heights());
        let own = || task.arm.links.iter().flat_map(|link| &link.parts).map(|part| part.heights);
        let elevation = |object: usize| from.poses[object].map_or(0.0, |lies| lies.elevation);
        let heights = |object: usize| task.objects[object].heights_at(elevation(object));
        let matters = |object: usize| own().chain(carried).any(|h| h.meet(heights(object)));
        let key = scene_key(from, candidate.step, matters);
        let next = self.numbers.len();
        let number = *self.numbers.entry(key).or_insert(next);
        let (q, to) = (from.q, candidate.to);
        let key = (number, [q[0], q[1], to[0], to[1]].map(f64::to_bits));
        let look = || examine_path(&from.scene(task, candidate.step.action.picked()), q, to);
        match self.path_statuses.entry(key).or_insert_with(look) {
            PathStatus::Infeasible(refusal) => Err(refusal.clone()),
            PathStatus::Straight(_) | PathStatus::Undecided => Ok(key),
        }
    }

    /// Returns the turn of the wrist at a candidate's target, and its duration in seconds.
    fn turn(
        &self,
        task: &Task,
        from: &State,
        candidate: &Candidate,
        turn: [f64; 2],
    ) -> Result<(WristTurn, f64), Refusal> {
        let unproven = |reason: &str| Refusal::new(reason, false);
        // While it is carried, the object has no pose, so it is no obstacle to itself.
        let left = from.after_step(task, candidate, candidate.to);
        let with = if left.held.is_some() { &left } else { from };
        let Some(held @ Payload { grip: Grip::Level { point, .. }, .. }) = &with.held else {
            return Err(unproven("the tool holds no object to turn"));
        };
        let Some(wrist) = task.wrist else {
            return Err(unproven("the arm has no wrist that could turn the object"));
        };
        let turning = TurnAtRest::new(task, &task.obstacles(&with.poses).fixed, held, *point, candidate.to);
        let found = turning
            .free(turn)
            .ok_or_else(|| unproven("the object cannot be turned at this place, in either direction"))?;
        let turning = single((found.to - found.from).abs(), &wrist.limits());
        Ok((found, turning.last().map_or(0.0, |[seconds, ..]| *seconds)))
    }

    /// Returns a lower bound on the duration of a turn, in seconds.
    pub fn min_turn_seconds(task: &Task, [from, to]: [f64; 2]) -> f64 {
        let ahead = (to - from).rem_euclid(std::f64::consts::TAU);
        let least = ahead.min(std::f64::consts::TAU - ahead);
        task.wrist.map_or(0.0, |wrist| least_of_tool(least, &wrist.limits()))
    }
}

/// Refuses a candidate if the arm collides, or cannot be held, after its step: at the end of the task, or when objects
/// are renewed.
fn require_free_after(task: &Task, from: &State, candidate: &Candidate) -> Result<(), Refusal> {
    let Some(StandstillScene { when, scene }) = scene_after(task, from, candidate) else { return Ok(()) };
    require_unobstructed(&scene, candidate.to, when)?;
    if from.after_step(task, candidate, candidate.to).is_done(task) {
        let held = TorqueLimit::check_holding_at(&scene, candidate.to);
        held.map_err(|error| Refusal::new(format!("{when}, {error}"), false))?;
    }
    Ok(())
}

/// Returns the scene after a candidate's step at the end of the task, or when objects are renewed. `None` if the next
/// motion begins in the world in which this one ends.
pub(super) fn scene_after(task: &Task, from: &State, candidate: &Candidate) -> Option<StandstillScene> {
    let left = from.after_step(task, candidate, candidate.to);
    let scene = if left.is_done(task) {
        // No later motion will begin there.
        left.scene(task, from.released)
    } else if left.needs_renewal(task) {
        // The next motion begins among other objects.
        left.scene(task, None)
    } else {
        return None;
    };
    Some(StandstillScene { when: "after this step", scene })
}

/// Returns the wrist that turns the tool along a line.
fn wrist_along(task: &Task, guide: WristGuide) -> Result<WristAlong, Refusal> {
    let along = task.wrist.and_then(|wrist| {
        let (velocity, acceleration) = (wrist.velocity, wrist.acceleration);
        Some(WristAlong { guide, joint: wrist.joint?, velocity, acceleration })
    });
    along.ok_or_else(|| Refusal::new("the line requires an angle of the tool, but the world names no wrist", false))
}

/// Returns the data that determines the scene of a motion, without objects for which `matters` is false.
fn scene_key(from: &State, step: &Step, matters: impl Fn(usize) -> bool) -> SceneKey {
    let mut key = Vec::new();
    let picked = step.action.picked();
    for (object, pose) in from.poses.iter().enumerate().filter(|(object, _)| matters(*object)) {
        let allowed_contacts = from.released == Some(object) || picked == Some(object);
        key.extend([object as u64, u64::from(allowed_contacts)]);
        match pose {
            None => key.push(u64::MAX),
            Some(Placement { pose, elevation }) => {
                let Pose { translation, rotation } = pose;
                key.extend([translation.x, translation.y, rotation.angle(), *elevation].map(f64::to_bits));
            }
        }
    }
    if let Some(held) = &from.held {
        key.push(held.object as u64);
        match held.grip {
            Grip::Rigid(p) => key.extend([p.translation.x, p.translation.y, p.rotation.angle()].map(f64::to_bits)),
            Grip::Level { angle, point } => key.extend([angle, point.x, point.y].map(f64::to_bits)),
        }
        key.extend(held.supports.iter().map(|&support| support as u64));
    }
    key
}
