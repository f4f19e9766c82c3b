//! Replays a planned task. It shares no code with the library, except the types of its input and output. Positions of objects,
//! the payload and the allowed contacts follow from the task alone.

mod frames;
mod overlaps;

use crate::moving::{obstacle_at, state_between};
use crate::solid::{Solid, V, norm, rotate, sub};
use cplan::engine::task::{Event, TaskAnswer};
use cplan::model::{Action, Goal, Holding, Item, Joint, Obstacle, Part, Step, Task};
use cplan::motion::Trajectory;
use frames::inverse;
pub use frames::{Frame, compose, frames, pose_on_trajectory};
use overlaps::{MotionTurns, Turn, check_overlaps, depth_of, stroke_height, stroke_time, turned_share};

/// Tolerance of positions, metres: inverse kinematics is exact to a few nanometres.
const NEAR: f64 = 1e-7;

/// Number of samples of each motion.
const LOOKS: usize = 300;

/// Greatest depth to which an object may press into its support, as a fraction of the arm's reach.
const PENETRATION_ALLOWANCE: f64 = 1e-4;

/// Overlap of heights, in metres, up to which an object counts as resting, as the book states.
const RESTING_TOLERANCE: f64 = 1e-6;

/// Number of a moving obstacle, which may never be touched.
const MOVER: usize = usize::MAX;

/// An object that the gripper holds.
struct Held {
    object: usize,
    /// Pose of the object: for a rigid payload in link 2's frame; for a level one relative to the tip, in the plane's directions.
    frame: Frame,
    level: bool,
    supports: Vec<usize>,
    grasp: V,
}

/// The world during a task.
pub struct World<'a> {
    task: &'a Task,
    /// Time since the beginning of the task, seconds.
    time: f64,
    lies: Vec<Option<Frame>>,
    /// True for each object that is still on its trajectory.
    moving: Vec<bool>,
    held: Option<Held>,
    released: Option<usize>,
    /// Height of the tool above its raised position, metres; negative while it is lowered.
    tool: f64,
    /// True while the arm moves. The tool may then touch the objects that it handles only if it also does so when raised.
    arm_moves: bool,
}

/// Replays the answer to a task and checks every motion.
///
/// # Errors
/// A description of the fault.
pub fn replay(task: &Task, answer: &TaskAnswer, all: bool) -> Result<(), String> {
    let mut world = World::at_first(task);
    let renewed = order(task, answer, all)?;
    let mut q = [task.start[0], task.start[1]];
    let mut clock = 0.0;
    // Depth from which the tool rises when the next motion may begin, and that time.
    let mut risen_from = 0.0;
    // The turn after the previous step.
    let mut turned_before = None;
    for (index, leg) in answer.legs.iter().enumerate() {
        for &object in &renewed[index] {
            world.lies[object] = Some(pose_on_trajectory(&task.objects[object], 0.0));
        }
        let t = &leg.timed.trajectory;
        let say = |what: &str| format!("leg {index}, step {}: {what}", leg.step.number);
        if norm(sub(t.position[0], q)) > 1e-12 {
            return Err(say("does not begin where the arm is"));
        }
        let [raising, lowering] = [leg.overlap.raising, leg.overlap.lowering];
        let turns = MotionTurns::new(leg, turned_before);
        let [departure, arrival] = turns.ends([raising, lowering], t.duration()).map_err(|what| say(&what))?;
        if (leg.begin - (clock - departure)).abs() > 1e-9 {
            return Err(say("does not begin when the step before ends"));
        }
        let sinks_to = depth_of(task, leg);
        check_overlaps(task, t.duration(), [(risen_from, raising), (sinks_to, lowering)]).map_err(|what| say(&what))?;
        let target = match &leg.step.action {
            Action::Pick { object, .. } => Some(*object),
            _ => None,
        };
        let clearance = leg.clearance();
        if clearance < task.workspace.fixed.clearance {
            return Err(say("keeps less than the clearance"));
        }
        // The stated clearance is that from static obstacles.
        let is_stated = clearance.is_finite() && !world.anything_moves();
        let keep = if is_stated { clearance } else { task.workspace.fixed.clearance };
        let looks = match t.time.len() {
            1 => 0,
            count if world.anything_moves() => LOOKS.max(2 * count),
            _ => LOOKS,
        };
        for look in 0..=looks {
            let at = t.duration() * look as f64 / looks.max(1) as f64;
            world.time = leg.begin + at;
            let (position, velocity) = state(t, at);
            limits(&task.arm.joints, position, velocity, leg.step.speed).map_err(|what| say(&what))?;
            let rises = stroke_height(task, risen_from, stroke_time(task, risen_from) - raising + at);
            let sinks = stroke_height(task, sinks_to, stroke_time(task, sinks_to) - (at - (t.duration() - lowering)));
            world.tool = (rises - risen_from).min(sinks - sinks_to).min(0.0);
            world.arm_moves = true;
            turns.hold(&mut world, at);
            turns.limits(task, t, at).map_err(|what| say(&format!("at {at} s: {what}")))?;
            world.check(position, target, keep).map_err(|what| say(&format!("at {at} s: {what}")))?;
        }
        for k in 0..t.time.len() {
            for joint in 0..2 {
                let most = task.arm.joints[joint].acceleration * leg.step.speed.powi(2);
                if t.acceleration[k][joint].abs() > most * (1.0 + 1e-6) {
                    return Err(say("exceeds an acceleration limit"));
                }
            }
        }
        q = *t.position.last().ok_or_else(|| say("has no samples"))?;
        let strokes = leg.stroke.map_or(0.0, |stroke| 2.0 * stroke.seconds);
        clock = leg.begin + t.duration() - arrival
            + leg.step.dwell
            + leg.turn.map_or(0.0, |(_, seconds)| seconds)
            + strokes;
        (world.tool, world.arm_moves) = (0.0, false);
        turns.hold_at_rest(&mut world);
        turned_before = leg
            .turn
            .map(|(turn, seconds)| ([turn.from, turn.to], seconds))
            .filter(|_| matches!(leg.step.action, Action::Pick { .. }));
        risen_from = sinks_to;
        let then = next_supports(task, answer, index);
        let before = world.released;
        world
            .finish(q, &leg.step, &then, leg.turn.map(|(turn, _)| [turn.from, turn.to]), keep)
            .map_err(|what| say(&what))?;
        if let Action::Place { .. } = leg.step.action
            && !matches!(leg.event, Some(Event::Release { object, .. }) if world.released == Some(object))
        {
            return Err(say("releases another object"));
        }
        // While the arm rests, other obstacles may come, and an object lies where it was released. An arm that cannot continue is
        // not considered after its last step.
        let goes_on = all || index + 1 < answer.legs.len();
        let looks = if goes_on && world.anything_moves() { 11 } else { 0 };
        for k in 0..looks {
            world.time = leg.begin + t.duration() + leg.step.dwell * f64::from(k) / 10.0;
            world
                .check(q, before, task.workspace.fixed.clearance)
                .map_err(|what| say(&format!("at rest at {} s: {what}", world.time)))?;
        }
    }
    Ok(())
}

/// Returns the objects that may be touched at the target of the object that a leg picks.
fn next_supports(task: &Task, answer: &TaskAnswer, index: usize) -> Vec<usize> {
    let picked = &answer.legs[index].step;
    let follows = |step: &&Step| (step.cycle, step.number) > (picked.cycle, picked.number);
    // A pick and its place stay together, except for moves in between, and the place has the number after that of the pick.
    task.steps()
        .filter(follows)
        .find_map(|step| match &step.action {
            Action::Place { supports, .. } => Some(supports.clone()),
            _ => None,
        })
        .unwrap_or_default()
}

/// Returns, for each leg, the objects that are supplied before it.
///
/// # Errors
/// If the steps have an order that the task does not allow.
fn order(task: &Task, answer: &TaskAnswer, all: bool) -> Result<Vec<Vec<usize>>, String> {
    let mut renewed = vec![Vec::new(); answer.legs.len() + 1];
    let mut next = 0;
    let take = |next: &mut usize| {
        *next += 1;
        answer.legs.get(*next - 1).map(|leg| leg.step.number)
    };
    for item in &task.items {
        match item {
            Item::Step(step) => match take(&mut next) {
                Some(number) if number == step.number => {}
                None if !all => return Ok(renewed),
                other => return Err(format!("step {} is missing: {other:?}", step.number)),
            },
            Item::AnyOrder(pairs) => {
                let mut open: Vec<[usize; 2]> = pairs.iter().map(|pair| [pair[0].number, pair[1].number]).collect();
                while !open.is_empty() {
                    match (take(&mut next), take(&mut next)) {
                        (Some(pick), Some(place)) if open.contains(&[pick, place]) => {
                            open.retain(|pair| *pair != [pick, place]);
                        }
                        (Some(pick), None) if !all && open.iter().any(|pair| pair[0] == pick) => return Ok(renewed),
                        (None, None) if !all => return Ok(renewed),
                        other => return Err(format!("{other:?} is no pair")),
                    }
                }
            }
            Item::Renew(objects) => renewed[next].extend(objects),
        }
    }
    if next < answer.legs.len() { Err("more steps than asked for".into()) } else { Ok(renewed) }
}

/// Returns position and velocity between samples, as documented for trajectories.
fn state(t: &Trajectory, time: f64) -> (V, V) {
    // A single sample does not move.
    if let [at] = t.position[..] {
        return (at, [0.0; 2]);
    }
    let k = t.time.partition_point(|&at| at <= time).clamp(1, t.time.len() - 1) - 1;
    let [position, velocity, _] = state_between(t, k, time - t.time[k]);
    (position.into(), velocity.into())
}

fn limits(joints: &[Joint; 2], position: V, velocity: V, share: f64) -> Result<(), String> {
    for k in 0..2 {
        let (lower, upper) = joints[k].range.domain();
        if !joints[k].range.is_circle() && !(lower - 1e-9..=upper + 1e-9).contains(&position[k]) {
            return Err(format!("joint {k} at {} is beyond its limits", position[k]));
        }
        if velocity[k].abs() > joints[k].velocity * share * (1.0 + 1e-6) {
            return Err(format!("joint {k} moves at {}", velocity[k]));
        }
    }
    Ok(())
}

impl<'a> World<'a> {
    /// Returns the world at the beginning of a task, with all objects at their first places.
    pub fn at_first(task: &'a Task) -> Self {
        let lies = task.objects.iter().map(|object| Some(pose_on_trajectory(object, 0.0))).collect();
        let moving = task.objects.iter().map(|object| object.trajectory.is_some()).collect();
        World { task, time: 0.0, lies, moving, held: None, released: None, tool: 0.0, arm_moves: false }
    }

    /// Returns true if an obstacle or an object moves by itself.
    fn anything_moves(&self) -> bool {
        !self.task.workspace.movers.is_empty() || self.moving.contains(&true)
    }

    /// Returns the frame of an object that is not held.
    fn lying(&self, object: usize) -> Option<Frame> {
        match self.moving[object] {
            true => Some(pose_on_trajectory(&self.task.objects[object], self.time)),
            false => self.lies[object],
        }
    }

    /// Returns the world after an object was gripped by the arm at `q`.
    pub fn carrying(mut self, object: usize, q: V, supports: Vec<usize>) -> Self {
        let (frames, tip) = frames(&self.task.arm, q);
        if let Some(lies) = self.lies[object].take() {
            let level = self.task.objects[object].holding == Holding::Level;
            let frame = if level { (lies.0, sub(lies.1, tip)) } else { compose(inverse(frames[1]), lies) };
            self.held = Some(Held { object, frame, level, supports, grasp: [0.0; 2] });
        }
        self
    }

    /// Returns the pose of the carried object.
    fn carried_pose(&self, held: &Held, q: V) -> Frame {
        let (frames, tip) = frames(&self.task.arm, q);
        if held.level { compose(([1.0, 0.0], tip), held.frame) } else { compose(frames[1], held.frame) }
    }

    /// Returns all bodies that can be hit: number, body, heights.
    fn obstacles(&self) -> Vec<(usize, Solid, [f64; 2])> {
        let mut bodies = Vec::new();
        for (number, obstacle) in self.task.workspace.fixed.obstacles.iter().enumerate() {
            let heights = [obstacle.heights.lower, obstacle.heights.upper];
            bodies.extend(obstacle.pieces.iter().map(|piece| (number, Solid::new(piece), heights)));
        }
        for mover in &self.task.workspace.movers {
            let Obstacle { pieces, heights, .. } = obstacle_at(mover, self.time);
            bodies.extend(pieces.iter().map(|piece| (MOVER, Solid::new(piece), [heights.lower, heights.upper])));
        }
        let fixed = self.task.workspace.fixed.obstacles.len();
        for (index, object) in self.task.objects.iter().enumerate() {
            let Some((turn, place)) = self.lying(index) else { continue };
            let heights = [object.heights.lower, object.heights.upper];
            let placed = |piece| (fixed + index, Solid::new(piece).placed(turn, place), heights);
            bodies.extend(object.pieces.iter().map(placed));
        }
        bodies
    }

    /// Returns the depth by which a body may press deeper into its support. The clearance does not matter. Negative if it presses
    /// too deep.
    fn allowance_left(&self, body: &Solid, support: &Solid) -> f64 {
        body.distance(support) + PENETRATION_ALLOWANCE * self.task.arm.reach()
    }

    /// Calls `f` for each moving body and each obstacle, with their distance at `q`. If the body rests on the obstacle, `f` also
    /// receives [`Self::allowance_left`].
    fn distances(&self, q: V, target: Option<usize>, mut f: impl FnMut(&str, usize, f64, Option<f64>)) {
        let fixed = self.task.workspace.fixed.obstacles.len();
        let (frames, _) = frames(&self.task.arm, q);
        let bodies = self.task.stroke.iter().flat_map(|stroke| &stroke.bodies).collect::<Vec<_>>();
        let meets_raised = |object: usize| {
            let heights = self.task.objects[object].heights;
            let meets = |part: &Part| part.heights.lower <= heights.upper && heights.lower <= part.heights.upper;
            self.task.arm.links[1].parts.iter().any(meets)
        };
        let allowed_contacts = |number: usize| {
            let mut touched = [target, self.released].into_iter().flatten();
            touched
                .any(|object| number == fixed + object && (!self.arm_moves || self.tool == 0.0 || meets_raised(object)))
        };
        let obstacles = self.obstacles();
        for (link, frame) in frames.into_iter().enumerate() {
            for part in &self.task.arm.links[link].parts {
                let body = Solid::new(&part.shape).placed(frame.0, frame.1);
                for (number, solid, heights) in &obstacles {
                    let lift = if bodies.contains(&&part.body) { self.tool } else { 0.0 };
                    let meets = part.heights.lower + lift <= heights[1] && heights[0] <= part.heights.upper + lift;
                    if meets && (link == 0 || !allowed_contacts(*number)) {
                        f(["link 1", "link 2"][link], *number, body.distance(solid), None);
                    }
                }
            }
        }
        let Some(held) = &self.held else { return };
        let object = &self.task.objects[held.object];
        let frame = self.carried_pose(held, q);
        for piece in &object.pieces {
            let body = Solid::new(piece).placed(frame.0, frame.1);
            for (number, solid, heights) in &obstacles {
                let [lower, upper] =
                    [object.heights.lower, object.heights.upper].map(|height| height + object.lift + self.tool);
                // An object does not collide with its support.
                if lower + RESTING_TOLERANCE < heights[1] && heights[0] <= upper {
                    let rests = held.supports.contains(number);
                    f("the object", *number, body.distance(solid), rests.then(|| self.allowance_left(&body, solid)));
                }
            }
        }
    }

    /// Checks that nothing is nearer than `keep` at `q`, and that no body presses too deep into its support.
    fn check(&self, q: V, target: Option<usize>, keep: f64) -> Result<(), String> {
        const ROUNDING: f64 = 1e-8;
        let mut wrong = Ok(());
        self.distances(q, target, |what, number, distance, pressed| {
            if let Some(less) = pressed.filter(|less| *less < -ROUNDING) {
                wrong = Err(format!("{what} is {distance} from {number}, into which it presses {} too deep", -less));
            } else if pressed.is_none() && distance < keep - ROUNDING {
                wrong = Err(format!("{what} is {distance} from {number}, {keep} is promised"));
            }
        });
        wrong
    }

    /// Returns the least and the greatest possible room at `q`: the excess of the distance from obstacles over the required one.
    /// A body that does not press into its support is free; otherwise its corners decide how much deeper it may press.
    pub fn room(&self, q: V) -> [f64; 2] {
        let (mut surely, mut perhaps) = (f64::INFINITY, f64::INFINITY);
        self.distances(q, None, |_, _, distance, pressed| {
            let room = distance - self.task.workspace.fixed.clearance;
            surely = surely.min(if pressed.is_some() { distance } else { room });
            perhaps = perhaps.min(pressed.unwrap_or(room));
        });
        [surely, perhaps]
    }

    /// Returns a bound on the speed of any point, per unit of each joint's speed.
    pub fn speeds(&self) -> V {
        let arm = &self.task.arm;
        let own = arm
            .links
            .iter()
            .flat_map(|link| &link.parts)
            .map(|part| Solid::new(&part.shape))
            .map(|s| s.reach + s.radius);
        let carried = self.held.iter().flat_map(|held| {
            let bodies = self.task.objects[held.object].pieces.iter().map(Solid::new);
            let tip = norm([arm.tip.x, arm.tip.y]);
            bodies.map(move |body| norm(held.frame.1) + body.reach + body.radius + tip)
        });
        let second = own.chain(carried).fold(0.0, f64::max);
        let (lower, upper) = arm.joints[1].range.domain();
        let slides = if arm.joints[1].joint_type.is_revolute() { 0.0 } else { lower.abs().max(upper.abs()) };
        let first = second + slides + norm([arm.offset.x, arm.offset.y]);
        [0, 1].map(|k| if arm.joints[k].joint_type.is_revolute() { [first, second][k] } else { 1.0 })
    }

    /// Applies the event at the end of a motion. `then` lists the objects that may be touched at the next target.
    fn finish(&mut self, q: V, step: &Step, then: &[usize], turn: Option<[f64; 2]>, keep: f64) -> Result<(), String> {
        let (frames, tip) = frames(&self.task.arm, q);
        let near = |a: V, b: V| norm(sub(a, b)) < NEAR;
        match &step.action {
            Action::Move(Goal::Tip(target)) if !near(tip, [target.x, target.y]) => {
                return Err("the tip is not at its target".into());
            }
            Action::Move(Goal::Joints(target)) => {
                for k in 0..2 {
                    let off = q[k] - target[k];
                    let turns = if self.task.arm.joints[k].range.is_circle() {
                        (off / std::f64::consts::TAU).round()
                    } else {
                        0.0
                    };
                    if (off - turns * std::f64::consts::TAU).abs() > NEAR {
                        return Err("the joints are not at their target".into());
                    }
                }
            }
            Action::Move(_) | Action::Follow(_) => {}
            Action::Pick { object, grasp, supports, when } => {
                let lies = self.lying(*object).ok_or("what is picked lies nowhere")?;
                let is_in = |[from, to]: &[f64; 2]| (from - 1e-6..=to + 1e-6).contains(&self.time);
                if self.moving[*object] && !when.is_empty() && !when.iter().any(is_in) {
                    return Err(format!("picked at {} s", self.time));
                }
                (self.lies[*object], self.moving[*object]) = (None, false);
                let grasp = [grasp.x, grasp.y];
                if !near(tip, compose(lies, ([1.0, 0.0], grasp)).1) {
                    return Err("the tip is not at the object".into());
                }
                let level = self.task.objects[*object].holding == Holding::Level;
                let frame = if level {
                    (lies.0, rotate([-grasp[0], -grasp[1]], lies.0))
                } else {
                    compose(inverse(frames[1]), lies)
                };
                let mut supports = supports.clone();
                supports.extend(then);
                self.held = Some(Held { object: *object, frame, level, supports, grasp });
                self.turn(q, turn, keep)?;
                self.released = None;
            }
            Action::Place { at, angle, .. } => {
                self.turn(q, turn, keep)?;
                let held = self.held.take().ok_or("nothing is held")?;
                let frame = self.carried_pose(&held, q);
                if !near(frame.1, [at.x, at.y]) {
                    return Err("the object's origin is not at its target".into());
                }
                if let Some(angle) = angle
                    && !near(frame.0, [angle.cos(), angle.sin()])
                {
                    return Err("the object is not turned as asked for".into());
                }
                self.lies[held.object] = Some(frame);
                self.released = Some(held.object);
                return Ok(());
            }
        }
        self.released = None;
        Ok(())
    }

    fn turned_share(&self, turn: Turn, since: f64) -> f64 {
        turned_share(self.task, turn, since)
    }

    /// Gives the level payload an orientation.
    fn hold(&mut self, angle: f64) {
        if let Some(held) = self.held.as_mut() {
            let direction = [angle.cos(), angle.sin()];
            held.frame = (direction, rotate([-held.grasp[0], -held.grasp[1]], direction));
        }
    }

    /// Checks dense samples of a turn of the wrist.
    fn turn(&mut self, q: V, turn: Option<[f64; 2]>, keep: f64) -> Result<(), String> {
        let Some([from, to]) = turn else { return Ok(()) };
        let held = self.held.as_mut().ok_or("nothing is held that could be turned")?;
        if !held.level || norm(sub(held.frame.0, [from.cos(), from.sin()])) > NEAR {
            return Err("the turn does not begin at the object's orientation".into());
        }
        for look in 0..=LOOKS {
            let angle = from + (to - from) * look as f64 / LOOKS as f64;
            self.hold(angle);
            self.check(q, None, keep).map_err(|what| format!("while it turns, {what}"))?;
        }
        Ok(())
    }
}
