//! The proof that a task cannot be done, for a certificate: step by step, from all IK solutions at the target of the step before.

use super::state::{Progress, State};
use cplan_core::check::StuckBox;
use cplan_core::model::{Action, Arm, Grip, Holding, Item, JointType, Payload, Scene, Step, Task};
use cplan_core::space::Configuration;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A case of a step: where the arm is before it, and what rules out that it comes from there to where the step ends; nothing where that is
/// not ruled out.
#[derive(Clone)]
pub struct RefutedCase {
    /// The step's number in the world file.
    pub step: usize,
    /// In free order: the picks of the pairs that are done before, the last one last (of a place in whichever order); none where it holds
    /// whichever they are.
    pub after: Option<Vec<usize>>,
    /// None at the start.
    pub from: Option<Configuration>,
    /// What the arm holds then.
    pub held: Option<usize>,
    /// What it has let go of, turned as it happened to be; none where that is no matter.
    pub turned: Vec<Turned>,
    /// What is where for certain: objects smaller by the room, and what the arm holds as it presses into its supports at least.
    pub scene: Scene,
    /// Configurations that are not free.
    pub stuck: Vec<StuckBox>,
    /// What is where while the tool is lowered where the step ends, and configurations that are not free then.
    pub lowered: Option<(Scene, Vec<StuckBox>)>,
}

/// An object that lies turned as it happened to be when it was let go of.
#[derive(Clone)]
pub struct Turned {
    pub object: usize,
    /// From where to where the arm has carried it.
    pub carried: [Configuration; 2],
}

impl RefutedCase {
    fn rules_out(&self) -> bool {
        !self.stuck.is_empty() || self.lowered.as_ref().is_some_and(|(_, stuck)| !stuck.is_empty())
    }
}

/// What rules out motions from one configuration to another; none where that is not known.
type RuleOut<'r> = &'r mut dyn FnMut(&Scene, [Configuration; 2]) -> Option<Vec<StuckBox>>;

/// Whether some cases can be written down.
type Accepts<'r> = &'r dyn Fn(&[RefutedCase]) -> bool;

/// States beyond these are not looked at for one step.
const MOST_STATES: usize = 256;

/// Grasps that are nearer to the origin of what is grasped, metres, are there: rounding.
const AT_THE_TIP: f64 = 1e-12;

/// Groups in free order of more pairs are not looked at in all orders, nor from wherever others end.
const MOST_PAIRS: usize = 8;

/// What rules out all ways to do the steps up to the one of a number, as far as it is accepted; none where that is not known, or not of the kind
/// that the checker knows. Turns of a wrist and IK solutions that leave a joint free are not. Evidence has `room`, metres, for how objects lie
/// and hang.
pub fn refuted(task: &Task, last: usize, room: f64, rule_out: RuleOut, accepts: Accepts) -> Option<Vec<RefutedCase>> {
    // One pair alone is done in its order.
    let in_order = |item: &Item| match item {
        Item::AnyOrder(pairs) if pairs.len() == 1 => pairs[0].clone().map(Item::Step).into(),
        other => vec![other.clone()],
    };
    let task = &Task { items: task.items.iter().flat_map(in_order).collect(), ..task.clone() };
    let last = task.items.iter().position(|item| steps(item).any(|step| step.number == last))?;
    // As a rule it is enough that the last cannot be done from anywhere.
    // How something lies that was turned is looked at only where nothing else helps: it doubles the cases.
    let is_long = last > 0 || matches!(task.items[0], Item::AnyOrder(_));
    let mut attempts = vec![(last, false), (0, false)];
    attempts.dedup();
    attempts.extend(is_long.then_some((0, true)));
    attempts.into_iter().find_map(|(first, tells_turned)| {
        let rule_out = &mut *rule_out;
        let (cases, hidden) = (Vec::new(), Vec::new());
        let mut walk = Walk { task, first, room, tells_turned, rule_out, accepts, cases, hidden };
        let left = walk.until(last, vec![At { is_start: true, ..At::from(State::at_start(task)) }])?;
        (left.is_empty() || walk.cannot_stay(&left)).then_some(walk.cases).filter(|cases| accepts(cases))
    })
}

fn steps(item: &Item) -> impl Iterator<Item = &Step> {
    let (one, pairs) = match item {
        Item::Step(step) => (Some(step), None),
        Item::AnyOrder(pairs) => (None, Some(pairs)),
        Item::Renew(_) => (None, None),
    };
    one.into_iter().chain(pairs.into_iter().flatten().flatten())
}

/// The objects of a group in free order.
fn picked(pairs: &[[Step; 2]]) -> Vec<usize> {
    pairs.iter().filter_map(|[pick, _]| pick.action.picked()).collect()
}

/// Whether each object is picked once.
fn is_once(pairs: &[[Step; 2]]) -> bool {
    let objects = picked(pairs);
    objects.iter().collect::<BTreeSet<_>>().len() == objects.len()
}

/// How far a task may be.
#[derive(Clone)]
struct At {
    state: State,
    is_start: bool,
    /// Whether the step before is a pick.
    has_just_picked: bool,
    /// In free order the pick of the pair that is done last, until another one is picked.
    last: Option<usize>,
    /// What it has turned and let go of, as far as that is told.
    turned: Vec<Turned>,
}

impl From<State> for At {
    fn from(state: State) -> Self {
        Self { state, is_start: false, has_just_picked: false, last: None, turned: Vec::new() }
    }
}

impl At {
    /// In free order the picks of the pairs that are done, the one done last last.
    fn done(&self, task: &Task) -> Option<Vec<usize>> {
        let Progress { item, done, .. } = self.state.progress;
        let Item::AnyOrder(pairs) = &task.items[item] else { return None };
        let picks =
            pairs.iter().enumerate().filter(|(pair, _)| done & (1 << pair) != 0).map(|(_, [pick, _])| pick.number);
        let others = picks.filter(|pick| Some(*pick) != self.last);
        Some(others.chain(self.last).collect())
    }
}

/// A walk over the steps, as they are done the first time.
struct Walk<'a> {
    task: &'a Task,
    /// The first item of which it is looked what rules it out.
    first: usize,
    /// For how objects lie and hang, metres.
    room: f64,
    /// Whether it is told how what lies that was turned.
    tells_turned: bool,
    rule_out: RuleOut<'a>,
    accepts: Accepts<'a>,
    cases: Vec<RefutedCase>,
    /// Objects that the second link may touch in the next step, as far as is known.
    hidden: Vec<usize>,
}

/// The cases of a step, in free order after certain pairs, and what may be after it.
#[derive(Default)]
struct Tried {
    cases: Vec<RefutedCase>,
    next: Vec<At>,
    is_asked: bool,
}

impl Walk<'_> {
    /// The states after the items up to the last one; none where not all are known.
    fn until(&mut self, last: usize, mut states: Vec<At>) -> Option<Vec<At>> {
        let mut seen = BTreeSet::new();
        loop {
            let index = states[0].state.progress.item;
            let item = &self.task.items[index];
            let is_new = steps(item).all(|step| !seen.contains(&step.number));
            seen.extend(steps(item).map(|step| step.number));
            // What is turned again and again a checker does not follow.
            if self.tells_turned && !is_new {
                return None;
            }
            match item {
                Item::AnyOrder(pairs) if !is_once(pairs) => return None,
                Item::AnyOrder(pairs) if is_new && index >= self.first => {
                    let whichever = (0..pairs.len()).find_map(|own| self.whichever_the_order(&states, pairs, own));
                    if let Some(mut cases) = whichever {
                        self.cases.append(&mut cases);
                        return Some(Vec::new());
                    }
                    if pairs.len() > MOST_PAIRS {
                        return None;
                    }
                    for _ in pairs.iter().flatten() {
                        states = self.step(&states, is_new)?;
                        if states.is_empty() {
                            break;
                        }
                    }
                    // A case of what follows holds for whichever was last.
                    self.hidden = picked(pairs);
                }
                Item::AnyOrder(pairs) => states = self.unknown_order(&states, pairs)?,
                Item::Step(_) | Item::Renew(_) => states = self.step(&states, is_new)?,
            }
            if states.is_empty() || index >= last {
                return Some(states);
            }
            states.iter_mut().for_each(|at| at.last = None);
        }
    }

    /// Whether what is let go of in the last step is in the way of all the states that it leaves; the cases are that.
    fn cannot_stay(&mut self, states: &[At]) -> bool {
        let task = self.task;
        let is_last = states.iter().all(|at| at.state.is_done(task) && at.state.released.is_some());
        let Some(last) = task.steps().map(|step| step.number).max().filter(|_| is_last) else { return false };
        states.iter().all(|at| {
            // After a group in free order a checker may not know which of its objects was let go of last.
            let mut poses = at.state.poses.clone();
            let others = self.hidden_after(at).iter().filter(|object| Some(**object) != at.state.released);
            others.for_each(|object| Arc::make_mut(&mut poses)[*object] = None);
            let scene = self.certain(State { poses, ..at.state.clone() }.scene(task, None));
            let stuck = (self.rule_out)(&scene, [at.state.q; 2]).unwrap_or_default();
            let is_ruled_out = !stuck.is_empty();
            let from = Some(at.state.q);
            let (held, turned) = (None, at.turned.clone());
            self.cases.push(RefutedCase {
                step: last + 1,
                after: None,
                from,
                held,
                turned,
                scene,
                stuck,
                lowered: None,
            });
            is_ruled_out
        })
    }

    /// The states after the next step, whichever it is; none where not all are known.
    fn step(&mut self, states: &[At], is_new: bool) -> Option<Vec<At>> {
        let task = self.task;
        let mut all: BTreeMap<(usize, Option<Vec<usize>>), Tried> = BTreeMap::new();
        for at in states {
            let Progress { item, half, .. } = at.state.progress;
            for candidates in at.state.candidates(task) {
                let step = candidates.step;
                let is_open = self.first <= item + 1 && is_open(task, &at.state, step);
                if !candidates.all || (is_open && !(is_new && at.has_just_picked)) {
                    return None;
                }
                let after = at.done(task);
                let from = (!at.is_start).then_some(at.state.q);
                let (scene, lowered) = (self.scene(at, step), self.lowered(at, step).map(|scene| (scene, Vec::new())));
                let (number, stuck) = (step.number, Vec::new());
                let held = at.state.held.as_ref().map(|held| held.object);
                let tried = all.entry((number, after.clone())).or_default();
                let turned = at.turned.clone();
                let mut case = RefutedCase { step: number, after, from, held, turned, scene, stuck, lowered };
                let turns = leaves_turned(task, &at.state, step);
                let is_told = turns && self.tells_turned && at.has_just_picked;
                for way in &candidates.ways {
                    if is_new && self.first <= item && self.is_ruled_out(&mut case, at.state.q, way.to) {
                        continue;
                    }
                    let after = at.state.after(task, way, way.to);
                    let turned =
                        held.filter(|_| is_told).map(|object| Turned { object, carried: [at.state.q, after.q] });
                    tried.next.push(At {
                        has_just_picked: step.action.picked().is_some(),
                        last: half.and_then(|pair| steps(&task.items[item]).nth(2 * pair)).map(|pick| pick.number),
                        turned: at.turned.iter().cloned().chain(turned).collect(),
                        ..At::from(if turns && !is_told { unknown(after) } else { after })
                    });
                }
                tried.is_asked |= is_open || is_told;
                tried.cases.push(case);
            }
        }
        self.hidden.clear();
        let mut next = Vec::new();
        for mut tried in all.into_values() {
            if tried.is_asked || tried.next.is_empty() || tried.cases.iter().any(RefutedCase::rules_out) {
                self.cases.append(&mut tried.cases);
            }
            next.append(&mut tried.next);
        }
        self.distinct(next)
    }

    /// Whether a way to do a step is ruled out; the case says by what.
    fn is_ruled_out(&mut self, case: &mut RefutedCase, from: Configuration, to: Configuration) -> bool {
        if let Some(mut stuck) = (self.rule_out)(&case.scene, [from, to]) {
            case.stuck.append(&mut stuck);
            return true;
        }
        let Some((scene, all)) = &mut case.lowered else { return false };
        let q = self.task.arm.topology().wrap(to);
        (self.rule_out)(scene, [q, q]).is_some_and(|mut stuck| {
            all.append(&mut stuck);
            true
        })
    }

    /// Each once; none where they are too many.
    fn distinct(&self, mut states: Vec<At>) -> Option<Vec<At>> {
        let key = |at: &At| {
            let ends = at.turned.iter().flat_map(|turned| turned.carried);
            let turned: Vec<[u64; 2]> = ends.map(|q| [q[0].to_bits(), q[1].to_bits()]).collect();
            (at.state.key(self.task), at.last, turned)
        };
        states.sort_by_cached_key(key);
        states.dedup_by_key(|at| key(at));
        (states.len() <= MOST_STATES).then_some(states)
    }

    /// Before a pair of a group in free order, without the objects that other pairs pick.
    fn alone(at: &At, pairs: &[[Step; 2]], own: usize) -> At {
        let mut poses = at.state.poses.clone();
        let others = pairs.iter().enumerate().filter(|(other, _)| *other != own);
        let others = others.filter_map(|(_, [pick, _])| pick.action.picked());
        others.for_each(|object| Arc::make_mut(&mut poses)[object] = None);
        let progress = Progress { item: 0, done: 0, half: None };
        let state = State { progress, poses, moving: Arc::default(), held: None, released: None, q: at.state.q };
        At { is_start: at.is_start, ..At::from(state) }
    }

    /// Where a pair of a group can end; none where that depends on what is not known, and is asked.
    fn ends(&self, entry: &At, pairs: &[[Step; 2]], own: usize, is_asked: bool) -> Option<Vec<At>> {
        let task = self.only(&pairs[own]);
        let first = if is_asked { 0 } else { usize::MAX };
        let rule_out: RuleOut = &mut |_, _| None;
        let (accepts, room, cases, hidden) = (self.accepts, self.room, Vec::new(), Vec::new());
        let mut walk = Walk { task: &task, first, room, tells_turned: false, rule_out, accepts, cases, hidden };
        let picked = walk.step(&[Self::alone(entry, pairs, own)], false)?;
        walk.step(&picked, false)
    }

    /// The cases if a pair of a group cannot be done, wherever the other objects of the group are then.
    fn whichever_the_order(&mut self, states: &[At], pairs: &[[Step; 2]], own: usize) -> Option<Vec<RefutedCase>> {
        let mut starts: Vec<At> = states.iter().map(|at| Self::alone(at, pairs, own)).collect();
        for other in (0..pairs.len()).filter(|other| *other != own) {
            let ends = self.ends(&states[0], pairs, other, true)?;
            let alone = starts[0].state.clone();
            starts.extend(ends.iter().map(|end| At::from(State { q: end.state.q, ..alone.clone() })));
        }
        let released = states.iter().filter_map(|at| at.state.released);
        let hidden: Vec<usize> = self.hidden.iter().copied().chain(released).collect();
        let task = self.only(&pairs[own]);
        // Where only what is carried is looked at it is no matter how many pairs there are.
        let firsts = if pairs.len() > MOST_PAIRS { 1..2 } else { 0..2 };
        firsts.rev().find_map(|first| {
            let (rule_out, accepts, room) = (&mut *self.rule_out, self.accepts, self.room);
            let (cases, hidden) = (Vec::new(), hidden.clone());
            let mut walk = Walk { task: &task, first, room, tells_turned: false, rule_out, accepts, cases, hidden };
            walk.until(1, starts.clone())?.is_empty().then_some(walk.cases).filter(|cases| accepts(cases))
        })
    }

    /// A task that is a pair of a group and nothing else.
    fn only(&self, pair: &[Step; 2]) -> Task {
        Task { items: pair.clone().map(Item::Step).into(), ..self.task.clone() }
    }

    /// The states after a group in free order of which it is not looked what rules it out.
    fn unknown_order(&mut self, states: &[At], pairs: &[[Step; 2]]) -> Option<Vec<At>> {
        let item = states[0].state.progress.item;
        let mut poses = states[0].state.poses.clone();
        let mut ends = Vec::new();
        for (own, [pick, _]) in pairs.iter().enumerate() {
            let own = self.ends(&states[0], pairs, own, self.first <= item + 1)?;
            if let (Some(object), Some(end)) = (pick.action.picked(), own.first()) {
                Arc::make_mut(&mut poses)[object] = end.state.poses[object];
            }
            ends.extend(own);
        }
        self.hidden = picked(pairs);
        let progress = Progress { item: item + 1, done: 0, half: None };
        let after = |end: At| {
            let state = State {
                progress,
                poses: poses.clone(),
                moving: Arc::default(),
                held: None,
                released: None,
                q: end.state.q,
            };
            At::from(state.settled(self.task))
        };
        self.distinct(ends.into_iter().map(after).collect())
    }

    /// Objects that may be the last one that was let go of; none where the case tells how all of them were.
    fn hidden_after(&self, at: &At) -> &[usize] {
        let is_told = |object: &usize| at.turned.iter().any(|turned| turned.object == *object);
        if self.hidden.iter().all(is_told) { &[] } else { &self.hidden }
    }

    /// What is where while a step is done, as far as a checker knows.
    fn scene(&self, at: &At, step: &Step) -> Scene {
        self.certain(self.known(at, step))
    }

    fn certain(&self, scene: Scene) -> Scene {
        scene.certain(self.task.obstacle_number(0), self.room)
    }

    /// The same, with all as large as it is.
    fn known(&self, at: &At, step: &Step) -> Scene {
        let is_known = |grip: Grip| match grip {
            Grip::Rigid(_) => at.has_just_picked || is_gantry(&self.task.arm),
            Grip::Level { .. } => self.task.wrist.is_none() || !at.state.may_turn(self.task),
        };
        let held = at.state.held.clone().filter(|held| is_known(held.grip));
        let mut poses = at.state.poses.clone();
        self.hidden_after(at).iter().for_each(|object| Arc::make_mut(&mut poses)[*object] = None);
        State { held, poses, ..at.state.clone() }.scene(self.task, step.action.picked())
    }

    /// What is where while the tool is lowered where a step ends, but for what is picked, as far as a checker knows.
    fn lowered(&self, at: &At, step: &Step) -> Option<Scene> {
        let task = self.task;
        let object = step.action.picked().or(at.state.held.as_ref().map(|held| held.object));
        let object = object.filter(|_| !matches!(step.action, Action::Move(_)))?;
        let (arm, heights) = task.lowered(object, matches!(step.action, Action::Place { .. }))?;
        let scene = self.known(at, step);
        let payload = scene.payload().cloned().map(|payload| Payload { heights, ..payload });
        let mut workspace = scene.workspace().clone();
        workspace.obstacles[task.obstacle_number(object)] = task.objects[object].lying(None);
        Some(self.certain(Scene::handling_trusted(arm, workspace, payload, &[])))
    }
}

/// Whether it depends on where an object was taken where the arm lets go of it.
fn is_open(task: &Task, state: &State, step: &Step) -> bool {
    let (Action::Place { angle: None, .. }, Some(held)) = (&step.action, &state.held) else { return false };
    match held.grip {
        Grip::Rigid(_) if is_gantry(&task.arm) => false,
        Grip::Rigid(in_link) => (in_link.translation.vector - task.arm.tip.coords).norm() > AT_THE_TIP,
        Grip::Level { .. } => false,
    }
}

/// Whether nothing turns what the arm carries.
fn is_gantry(arm: &Arm) -> bool {
    arm.joints.iter().all(|joint| matches!(joint.joint_type, JointType::Prismatic { .. }))
}

/// Whether it depends on how the steps were done how something lies that a step lets go of.
fn leaves_turned(task: &Task, state: &State, step: &Step) -> bool {
    let (Action::Place { angle: None, .. }, Some(held)) = (&step.action, &state.held) else { return false };
    task.objects[held.object].holding != Holding::Level && !is_gantry(&task.arm)
}

/// Without the object that was let go of.
fn unknown(mut state: State) -> State {
    if let Some(object) = state.released {
        Arc::make_mut(&mut state.poses)[object] = None;
    }
    state
}
