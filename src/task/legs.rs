//! The motions of a task, each planned once.

use super::Manner;
use super::least_time::rest_to_rest;
use super::state::{Candidate, Held, State};
use super::stroke::{ToolStroke, stroke};
use crate::certify::{StuckBox, WristTurn, certify, wrist_turn};
use crate::model::{Goal, Grip, Problem, Scene, Step, Task};
use crate::solve::{Effort, Method, Verdict, solve};
use crate::space::{Configuration, Path};
use crate::trajectory::{Timed, single};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Why a motion is not possible.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refusal {
    /// In words.
    pub reason: String,
    /// Whether that is proven, or just what came of trying.
    pub proven: bool,
    /// Boxes of colliding configurations that bar the way, where that is the reason.
    pub proof: Rc<[StuckBox]>,
}

impl Refusal {
    /// A reason without boxes.
    pub fn new(reason: impl Into<String>, proven: bool) -> Self {
        Self { reason: reason.into(), proven, proof: Rc::new([]) }
    }
}

/// A motion with the turn and the stroke that follow it.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub timed: Rc<Timed>,
    pub turn: Option<(WristTurn, f64)>,
    pub stroke: Option<ToolStroke>,
}

impl Motion {
    /// Seconds that the arm moves, and stands still after it for more than the step's dwell.
    pub fn seconds(&self) -> f64 {
        let turn = self.turn.map_or(0.0, |(_, seconds)| seconds);
        self.timed.trajectory.duration() + turn + self.stroke.map_or(0.0, |stroke| 2.0 * stroke.seconds)
    }
}

/// What a scene depends on, bit by bit.
type SceneKey = Vec<u64>;

/// Plans motions, and remembers them: the same motion among the same things that can be hit is planned once.
pub(super) struct Legs<'a> {
    task: &'a Task,
    manner: Manner,
    /// Scenes as far as they matter, by number.
    numbers: BTreeMap<SceneKey, usize>,
    motions: BTreeMap<(usize, [u64; 5]), Result<Rc<Timed>, Refusal>>,
    /// Whole scenes, for answers.
    scenes: BTreeMap<SceneKey, Rc<Scene>>,
}

impl<'a> Legs<'a> {
    pub fn new(task: &'a Task, manner: Manner) -> Self {
        // Tasks bound times, not the lengths of paths.
        let effort = Effort { bounded: false, ..manner.effort };
        Self {
            task,
            manner: Manner { effort, ..manner },
            numbers: BTreeMap::new(),
            motions: BTreeMap::new(),
            scenes: BTreeMap::new(),
        }
    }

    /// Motions planned so far.
    pub fn planned(&self) -> usize {
        self.motions.len()
    }

    /// The scene of a motion; the same one for the same state of the world.
    pub fn scene(&mut self, from: &State, step: &Step) -> Rc<Scene> {
        let key = scene_key(from, step, |_| true);
        self.scenes.entry(key).or_insert_with(|| Rc::new(from.scene(self.task, step.action.picked()))).clone()
    }

    /// The motion to a candidate's target and the turn there.
    pub fn motion(&mut self, from: &State, candidate: &Candidate) -> Result<Motion, Refusal> {
        let task = self.task;
        let after = from.after(task, candidate, candidate.to);
        if after.is_done(task) {
            // No motion follows that would begin there.
            unobstructed(&after.scene(task, from.released), candidate.to, "after it")?;
        }
        let carried = from.held.as_ref().map(|held| task.objects[held.object].carried_heights());
        let own = || task.arm.links.iter().flat_map(|link| &link.parts).map(|part| part.heights);
        let matters = |object: usize| own().chain(carried).any(|h| h.meet(task.objects[object].heights));
        let key = scene_key(from, candidate.step, matters);
        let next = self.numbers.len();
        let number = *self.numbers.entry(key).or_insert(next);
        let (q, to, speed) = (from.q, candidate.to, candidate.step.speed);
        let key = (number, [q[0], q[1], to[0], to[1], speed].map(f64::to_bits));
        let manner = self.manner;
        let plan = || planned(&from.scene(task, candidate.step.action.picked()), q, to, speed, &manner).map(Rc::new);
        let timed = self.motions.entry(key).or_insert_with(plan).clone()?;
        let turn = candidate.turn.map(|turn| self.turn(from, candidate, turn)).transpose()?;
        let stroke = stroke(task, from, candidate)?;
        Ok(Motion { timed, turn, stroke })
    }

    /// The turn of the wrist at a candidate's target, and the seconds that it takes.
    fn turn(&self, from: &State, candidate: &Candidate, turn: [f64; 2]) -> Result<(WristTurn, f64), Refusal> {
        let unproven = |reason: &str| Refusal::new(reason, false);
        // The object is no obstacle to itself: it lies nowhere before it is let go of, or from when it is taken.
        let after = from.after(self.task, candidate, candidate.to);
        let with = if after.held.is_some() { &after } else { from };
        let Some(held @ Held { grip: Grip::Level { point, .. }, .. }) = &with.held else {
            return Err(unproven("nothing is held that could be turned"));
        };
        let Some(wrist) = self.task.wrist else {
            return Err(unproven("the arm has no wrist that could turn the object"));
        };
        let (arm, workspace) = (&self.task.arm, self.task.obstacles(&with.poses));
        let found = wrist_turn(arm, &workspace, &held.payload(self.task), *point, candidate.to, turn);
        let way = found.ok_or_else(|| unproven("the object cannot be turned there, neither way round"))?;
        let turning = single((way.to - way.from).abs(), wrist.velocity, wrist.acceleration);
        Ok((way, turning.last().map_or(0.0, |[seconds, ..]| *seconds)))
    }

    /// A lower bound on the seconds that a turn takes.
    pub fn least_turn(&self, [from, to]: [f64; 2]) -> f64 {
        let ahead = (to - from).rem_euclid(std::f64::consts::TAU);
        let least = ahead.min(std::f64::consts::TAU - ahead);
        self.task.wrist.map_or(0.0, |wrist| rest_to_rest(least, wrist.velocity, wrist.acceleration))
    }
}

/// Refuses a configuration in which something is hit; `when` is when the arm is there, in words.
pub(super) fn unobstructed(scene: &Scene, q: Configuration, when: &str) -> Result<(), Refusal> {
    let hits: Vec<String> = scene.obstructions(q).iter().map(|hit| scene.explain(hit)).collect();
    if hits.is_empty() { Ok(()) } else { Err(Refusal::new(format!("{when} {}", hits.join("; ")), true)) }
}

/// A motion from one configuration to another.
fn planned(
    scene: &Scene,
    from: Configuration,
    to: Configuration,
    speed: f64,
    manner: &Manner,
) -> Result<Timed, Refusal> {
    unobstructed(scene, from, "at its beginning")?;
    unobstructed(scene, to, "at its end")?;
    let clearance = scene.workspace.clearance;
    let straight = || {
        let path = Path::new(vec![from, scene.arm.topology().lift(to, from)]);
        certify(scene, path, clearance).ok()
    };
    // Nothing is shorter than straight, whatever the metric.
    let found = (manner.method == Method::Visibility).then(straight).flatten();
    let path = match found {
        Some(path) => path,
        None => {
            let problem = Problem { scene: scene.clone(), start: from, goal: Goal::Joints(to), goals: to.into() };
            match solve(&problem, manner.method, &manner.effort, &mut |_| {}).verdict {
                Verdict::Found(path) => path,
                Verdict::Infeasible(proof) => {
                    let boxes = proof.stuck().len();
                    let reason = format!("there is no way: {boxes} boxes of colliding configurations bar it (proven)");
                    return Err(Refusal { proof: proof.stuck().into(), ..Refusal::new(reason, true) });
                }
                Verdict::Unknown(reason) => return Err(Refusal::new(reason, false)),
            }
        }
    };
    manner.drive.along(scene, &path, speed).map_err(|error| Refusal::new(error.to_string(), false))
}

/// What the scene of a motion depends on, of the objects that matter.
fn scene_key(from: &State, step: &Step, matters: impl Fn(usize) -> bool) -> SceneKey {
    let mut key = Vec::new();
    let picked = step.action.picked();
    for (object, pose) in from.poses.iter().enumerate().filter(|(object, _)| matters(*object)) {
        let spared = from.released == Some(object) || picked == Some(object);
        key.extend([object as u64, u64::from(spared)]);
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
