//! The motions of a task, each planned once.

use super::arch::overlap;
use super::least_time::least_of_tool;
use super::state::{Candidate, State, turns_on_the_way};
use super::stroke::{raising_first, stroke};
use super::tool_turn::turned_first;
use cplan_follow::{Found, Settings, WristAlong, follow_between};
use cplan_geometry::Pose;
use cplan_handling::{Action, FollowedLine, Payload, Step, Task, WristGuide};
use cplan_judge::{CertifiedPath, CheckedProof, certify};
use cplan_legs::{Overlap, StandstillScene, ToolStroke, WristMotion};
use cplan_model::space::{Configuration, Path};
use cplan_model::{Grip, MotionProblem, Outcome, Scene};
use cplan_motion::recorded::{WristTurn, wrist_turn};
use cplan_motion::{TimedMotion, TorqueLimit, nanoseconds, seconds, single};
use cplan_proofs::{Connectivity, slab_connectivity};
use cplan_solver::{Answer, BoundedPath, LARGE_PROOF_BOXES, Options, Unknown, solve};
use cplan_text::{counted, listed};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The reason why a motion is not possible.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refusal {
    /// The reason, in words for the summary.
    pub reason: String,
    /// True if it is proven that the motion is impossible; false if none was found.
    pub proven: bool,
    /// The proof that there is no path. `None` if the reason is another one.
    pub proof: Option<CheckedProof>,
    /// The objects that block the motion.
    pub blockers: Blockers,
}

/// Obstacles that prevent a motion, by their indices in [`Task::obstacles`], in ascending order.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Blockers {
    /// At the end of the motion, the arm or its payload hits all of these.
    AtEnd(Vec<usize>),
    /// Together, these block all paths to the end of the motion.
    OnTheWay(Vec<usize>),
    /// The blocking obstacles are not known.
    Unknown,
}

impl Refusal {
    /// Creates a refusal without a proof by boxes and without known blockers.
    pub fn new(reason: impl Into<String>, proven: bool) -> Self {
        Self { reason: reason.into(), proven, proof: None, blockers: Blockers::Unknown }
    }

    /// Creates a refusal with a proof that there is no path.
    fn proven(proof: CheckedProof) -> Self {
        let stuck = proof.collision_boxes();
        let reason = format!(
            "there is no path: colliding configurations separate start and goal (proven, {})",
            counted(stuck.len(), "box")
        );
        let blockers = Blockers::OnTheWay(distinct(stuck.iter().map(|stuck| stuck.pair.obstacle)));
        Self { proof: Some(proof), blockers, ..Self::new(reason, true) }
    }
}

fn distinct(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
    numbers.collect::<BTreeSet<_>>().into_iter().collect()
}

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

/// What is known about a motion's path before it is planned.
enum PathStatus {
    /// The certified straight path. No path is shorter in any metric.
    Straight(CertifiedPath),
    /// The straight path is not free, but other paths are not ruled out.
    Undecided,
    /// There is no path.
    Infeasible(Refusal),
}

/// Number of slabs that an inexpensive proof of infeasibility may use. It takes some milliseconds. If they do not
/// suffice, the planner must decide.
const DECISION_SLABS: usize = 2_000;

/// Number of attempts to plan with only some of the objects before all of them are included.
const ATTEMPTS_AMONG_FEW: usize = 3;

/// Samples per segment when collecting the objects that a path hits.
const SAMPLES_PER_SEGMENT: u32 = 16;

/// The data that determines a scene, as bits. It serves as a key.
type SceneKey = Vec<u64>;

/// Fraction by which a path may be longer than the shortest one.
const PATH_GAP: f64 = 0.01;

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
            let overlap = Overlap::NONE;
            let deviation = Some(deviation);
            return Ok(Motion {
                timed,
                turn: None,
                raising: None,
                stroke: None,
                wrist: None,
                raises_again: false,
                overlap,
                deviation,
                tool_deviation,
                turning_before,
                turning: 0.0,
            });
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
        let motion = Motion {
            timed,
            turn,
            raising,
            stroke,
            wrist: None,
            raises_again,
            overlap,
            deviation: None,
            tool_deviation: None,
            turning_before,
            turning,
        };
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
            let lies = |(object, pose): (usize, &Option<Pose>)| pose.filter(|_| among.contains(&object));
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
        let matters = |object: usize| own().chain(carried).any(|h| h.meet(task.objects[object].heights));
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
        let found = wrist_turn(task, &task.obstacles(&with.poses).fixed, held, *point, candidate.to, turn);
        let found = found.ok_or_else(|| unproven("the object cannot be turned there, in either direction"))?;
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
        held.map_err(|error| Refusal::new(format!("{when} {error}"), false))?;
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
    Some(StandstillScene { when: "after it", scene })
}

/// Returns the wrist that turns the tool along a line.
fn wrist_along(task: &Task, guide: WristGuide) -> Result<WristAlong, Refusal> {
    let along = task.wrist.and_then(|wrist| {
        let (velocity, acceleration) = (wrist.velocity, wrist.acceleration);
        Some(WristAlong { guide, joint: wrist.joint?, velocity, acceleration })
    });
    along.ok_or_else(|| Refusal::new("the line asks for an angle of the tool, but the arm has no known wrist", false))
}

/// Returns the options for planning the motions of a task. A task minimises duration, not length, and a slightly longer
/// path permits faster motions.
pub(super) fn of_legs(options: &Options) -> Options {
    let planner = options.planner.with_gap(options.planner.gap().unwrap_or(PATH_GAP));
    Options { planner, bounded: false, ..*options }
}

/// Distance of the neighbours of an IK solution that are checked as well, in radians and metres. IK solutions are
/// rounded, so a collision is certain only if the neighbours collide, too.
const NEIGHBOR_DISTANCE: f64 = 1e-9;

/// Refuses a configuration with collisions. `when` is a phrase for the message: when the arm is there.
pub(super) fn require_unobstructed(scene: &Scene, q: Configuration, when: &str) -> Result<(), Refusal> {
    let hits = scene.obstructions(q);
    if hits.is_empty() {
        return Ok(());
    }
    let words: Vec<String> = hits.iter().map(|hit| scene.explain(hit)).collect();
    let blockers = Blockers::AtEnd(distinct(hits.iter().map(|hit| hit.contact.pair.obstacle)));
    let certain = scene.inner();
    let beside = [
        [0.0, 0.0],
        [NEIGHBOR_DISTANCE, 0.0],
        [-NEIGHBOR_DISTANCE, 0.0],
        [0.0, NEIGHBOR_DISTANCE],
        [0.0, -NEIGHBOR_DISTANCE],
    ];
    let is_proven = beside.iter().all(|&by| !certain.obstructions(q + Configuration::from(by)).is_empty());
    Err(Refusal { blockers, ..Refusal::new(format!("{when} {}", listed(&words)), is_proven) })
}

/// Plans with only a few objects, and adds those that the path hits. Returns a path that is free among all objects, or
/// a proof that there is no path even among the few. Returns `None` if the path must be planned among all objects. The
/// first `own` obstacles are not objects. `plan` plans a path among some objects.
fn plan_among_few(
    scene: &Scene,
    own: usize,
    mut plan: impl FnMut(&BTreeSet<usize>) -> Result<CertifiedPath, Refusal>,
) -> Option<Result<CertifiedPath, Refusal>> {
    let hit_at = |q: Configuration| {
        let hits = scene.obstructions(q).into_iter().map(|hit| hit.contact.pair.obstacle);
        hits.filter_map(|obstacle| obstacle.checked_sub(own)).collect::<Vec<_>>()
    };
    let mut among: BTreeSet<usize> = BTreeSet::new();
    for _ in 0..ATTEMPTS_AMONG_FEW {
        let found = match plan(&among) {
            Ok(found) => found.path().clone(),
            Err(refusal) if refusal.proven => return Some(Err(refusal)),
            Err(_) => return None,
        };
        if let Ok(path) = certify(scene, found.clone()) {
            return Some(Ok(path));
        }
        let before = among.len();
        for ends in found.waypoints().windows(2) {
            for part in 0..=SAMPLES_PER_SEGMENT {
                among.extend(hit_at(ends[0].lerp(&ends[1], f64::from(part) / f64::from(SAMPLES_PER_SEGMENT))));
            }
        }
        if among.len() == before {
            return None;
        }
    }
    None
}

/// Returns the problem of a motion, and the planner's answer to it, computed as in [`MotionCache`]. `None` if the path
/// is straight, which needs no planner.
pub(super) fn planned_again(
    scene: &Scene,
    own: usize,
    [from, to]: [Configuration; 2],
    options: &Options,
) -> Option<(MotionProblem, Answer)> {
    let asked = |scene: Scene| {
        let problem = MotionProblem::trusted(scene, from, to);
        let answer = solve(&problem, options, &mut |_| {});
        (problem, answer)
    };
    if !options.planner.method().optimizes() {
        return Some(asked(scene.clone()));
    }
    if certified_straight_path(scene, from, to).is_some() {
        return None;
    }
    let mut last = None;
    let found = plan_among_few(scene, own, |among| {
        let (_, answer) = last.insert(asked(scene_with_objects(scene, own, among)));
        path_or_refusal(answer.outcome.clone())
    });
    match found {
        Some(Ok(_)) => last,
        _ => Some(asked(scene.clone())),
    }
}

/// Returns the scene with only some of its objects. The others keep their indices, but have no shape.
fn scene_with_objects(scene: &Scene, own: usize, among: &BTreeSet<usize>) -> Scene {
    let mut number = 0;
    scene.reshaped(
        |_| {},
        |obstacle| {
            number += 1;
            let stays = number <= own || among.contains(&(number - 1 - own));
            if stays { obstacle.pieces.clone() } else { Vec::new() }
        },
    )
}

/// Returns the straight path between two configurations. `None` if it is not certified.
fn certified_straight_path(scene: &Scene, from: Configuration, to: Configuration) -> Option<CertifiedPath> {
    let straight = Path::new(vec![from, scene.arm().topology().lift(to, from)]);
    certify(scene, straight).ok()
}

/// Examines the path between two configurations by inexpensive checks.
fn examine_path(scene: &Scene, from: Configuration, to: Configuration) -> PathStatus {
    let ends = require_unobstructed(scene, from, "at its beginning")
        .map_err(|refusal| Refusal { blockers: Blockers::Unknown, ..refusal })
        .and_then(|()| require_unobstructed(scene, to, "at its end"));
    if let Err(refusal) = ends {
        return PathStatus::Infeasible(refusal);
    }
    let clearance = scene.workspace().clearance;
    if let Some(path) = certified_straight_path(scene, from, to) {
        return PathStatus::Straight(path);
    }
    let goal = to.into();
    match slab_connectivity(scene, from, &goal, clearance, DECISION_SLABS, LARGE_PROOF_BOXES) {
        Connectivity::Disconnected(proof) => proof
            .checked(scene, from, &goal, clearance)
            .map_or(PathStatus::Undecided, |proof| PathStatus::Infeasible(Refusal::proven(proof))),
        _ => PathStatus::Undecided,
    }
}

/// Returns the planner's path from one configuration to another.
fn path(scene: &Scene, from: Configuration, to: Configuration, options: &Options) -> Result<CertifiedPath, Refusal> {
    let problem = MotionProblem::trusted(scene.clone(), from, to);
    path_or_refusal(solve(&problem, options, &mut |_| {}).outcome)
}

/// Converts the planner's outcome to a path, or to the reason why there is none.
fn path_or_refusal(outcome: Outcome<BoundedPath, CheckedProof, Unknown>) -> Result<CertifiedPath, Refusal> {
    match outcome {
        Outcome::Found(path) => Ok(path.certified),
        Outcome::Infeasible(proof) => Err(Refusal::proven(proof)),
        Outcome::Unknown(unknown) => Err(Refusal::new(unknown.reason, false)),
    }
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
            Some(pose) => key.extend([pose.translation.x, pose.translation.y, pose.rotation.angle()].map(f64::to_bits)),
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
