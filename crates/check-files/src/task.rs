//! Certificates of tasks: "found", with steps.

use crate::robot::Robot;
use crate::robot::tool::{lowered, pressed};
use crate::world::task::{Action, Carrying, Group, Node, Passing, RESTING, Step, Stroke, Task};
use crate::world::{WorldFile, hung};
use cplan_check::arm::Arm;
use cplan_check::certificate::{Certificate, Done, Motion};
use cplan_check::curve::{FINE, Piece};
use cplan_check::decimal::Decimal;
use cplan_check::ends::{End, missed};
use cplan_check::free::{Chain, Edge, On, Solid, guard};
use cplan_check::interval::{Interval, Point, both_turns, length, minus, turned};
use cplan_check::motion::{SIXTY, fine, piece, well_formed};
use cplan_check::obstacle::Obstacle;
use cplan_check::overlap::Shape;
use cplan_check::polygon::Corner;
use cplan_check::scene::{Part, Present, stay_off};
use cplan_check::shapes::Counted;
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use num_bigint::{BigInt, Sign};
use std::iter::{self, Enumerate, Peekable};
use std::ops::Range;
use std::slice::Iter;

/// An object that passes is picked no farther than this from where it is to be then, metres: `10^-3`.
pub const NEAR: u32 = 3;

/// The arm may stand still for less than it is to by this, seconds: `10^-6`.
const SHORT: u32 = 6;

/// The wrist turns by less than this, radians: more than once round nobody does.
const LARGEST_TURN: i128 = 7;

/// That a motion does all steps of a task.
pub fn found(robot: &Robot, file: &WorldFile, certificate: &Certificate, done: &[Done]) -> Result<String, CheckError> {
    let (arm, world) = (&robot.arm, &file.world);
    let clearance = certificate.clearance(world)?;
    let wrong = |input: Input, message: &str| Err(CheckError::in_file(input, message));
    let Some(task) = &file.task else { return wrong(Input::World, "it has no steps") };
    if certificate.goal.is_some() || certificate.goal_tip.is_some() || certificate.bound.is_some() {
        return wrong(Input::Certificate, "that of a task has neither a goal nor a bound");
    }
    let Some(motion) = &certificate.motion else { return wrong(Input::Certificate, "it has no motion") };
    well_formed(&motion.interpolation, &motion.knots)?;
    let start = End::start(certificate, world)?.reached(arm, &motion.knots[0])?;
    let mut order = Order { left: done.iter().enumerate().peekable(), renewed: Vec::new(), matched: Vec::new() };
    order.group(&task.steps)?;
    if let Some((index, done)) = order.left.next() {
        return CheckError::fails(format!("steps[{index}] is step {}, where the world asks for no more", done.step));
    }
    let steps = order.matched;
    let stands = stands(motion, &steps)?;
    let mut replay = Replay::new(robot, world, task, motion, clearance)?;
    for (index, step) in steps.iter().enumerate() {
        let number = step.step.number;
        if motion.knots[step.done.knots[1]].iter().skip(3).take(2).any(|rate| rate.sign() != Sign::NoSign) {
            return CheckError::fails(format!("steps[{index}], step {number}: at its end the arm moves"));
        }
        replay.step(step, &steps[index + 1..]).map_err(|error| match error {
            CheckError::Fails(why) => CheckError::Fails(format!("steps[{index}], step {number}: {why}")),
            other => other,
        })?;
        if &stands[index] + &Decimal::power_of_ten(SHORT) < step.step.dwell {
            let dwell = &step.step.dwell;
            return CheckError::fails(format!(
                "after steps[{index}], step {number}, the arm does not stand for {dwell} s"
            ));
        }
    }
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let within = missed("target", &replay.off)?;
    Ok(format!(
        "a motion of \"{first}\" and \"{second}\" does all {} steps from the start{start} on{within} with clearance {clearance} ({})",
        steps.len(),
        motion.in_words()
    ))
}

/// A step of the world and how it is done.
struct Matched<'a> {
    step: &'a Step,
    done: &'a Done,
    /// Objects that lie where they lay at first again before it.
    renewed: Vec<usize>,
}

/// Steps as they are done, put beside those of the world.
struct Order<'a> {
    left: Peekable<Enumerate<Iter<'a, Done>>>,
    renewed: Vec<usize>,
    matched: Vec<Matched<'a>>,
}

impl<'a> Order<'a> {
    fn group(&mut self, group: &'a Group) -> Result<(), CheckError> {
        for repetition in 0..group.repeat {
            if repetition > 0 {
                self.renewed.extend(&group.renewed);
            }
            if !group.is_free {
                group.nodes.iter().try_for_each(|node| self.node(node))?;
                continue;
            }
            let mut pairs: Vec<&[Node]> = group.nodes.chunks(2).collect();
            while !pairs.is_empty() {
                let next = self.left.peek().map(|(_, done)| done.step);
                let begins = |pair: &&[Node]| matches!(&pair[0], Node::Step(step) if Some(step.number) == next);
                let pair = pairs.remove(pairs.iter().position(begins).unwrap_or(0));
                pair.iter().try_for_each(|node| self.node(node))?;
            }
        }
        Ok(())
    }

    fn node(&mut self, node: &'a Node) -> Result<(), CheckError> {
        let step = match node {
            Node::Group(group) => return self.group(group),
            Node::Step(step) => step,
        };
        match self.left.next() {
            Some((_, done)) if done.step == step.number => {
                self.matched.push(Matched { step, done, renewed: std::mem::take(&mut self.renewed) });
                Ok(())
            }
            Some((index, done)) => CheckError::fails(format!(
                "steps[{index}] is step {}, where the world asks for step {}",
                done.step, step.number
            )),
            None => CheckError::fails(format!("the world asks for step {} then, and there are no more", step.number)),
        }
    }
}

/// How long the arm stands still after each step: it does so from one to the next, before the first and after the last.
fn stands(motion: &Motion, steps: &[Matched]) -> Result<Vec<Decimal>, CheckError> {
    let knots = &motion.knots;
    let (mut last, mut all) = (0, Vec::new());
    let end = knots.len() - 1;
    let begins = steps.iter().map(|step| step.done.knots[0]).chain([end]);
    for (index, first) in begins.enumerate() {
        if first < last || first > end {
            return CheckError::fails(format!("steps[{index}] begins before the one before ends, or after the motion"));
        }
        if let Some(knot) = (last..first).find(|knot| !motion.stands(*knot)) {
            return CheckError::fails(format!("after knot {knot}, which belongs to no step, the arm moves"));
        }
        all.push(&knots[first][0] - &knots[last][0]);
        if let Some(step) = steps.get(index) {
            last = step.done.knots[1];
            if last < first || last > end {
                return CheckError::fails(format!("steps[{index}] ends before it begins, or after the motion"));
            }
        }
    }
    all.remove(0);
    Ok(all)
}

/// What the arm carries.
struct Held {
    object: usize,
    on: On,
    /// It as it lies to what it hangs on, and what of it keeps off supports if it has any.
    hanging: Obstacle,
    pressed: Option<Obstacle>,
    /// The shapes of both.
    solids: [Vec<Solid>; 2],
    /// A disc that covers it however it turns about the tip, if it is held level.
    round: Option<Solid>,
    carrying: Carrying,
}

/// How what is held keeps off an obstacle.
#[derive(PartialEq)]
enum Manner {
    Off,
    /// It presses into a support by no more than it may.
    Pressed,
    /// However it turns about the tip: held level, it turns beside what joint 1 carries.
    Round,
}

/// Where everything is between steps.
struct Replay<'a> {
    arm: &'a Arm,
    task: &'a Task,
    motion: &'a Motion,
    chain: Chain,
    tip: Point,
    /// Shapes of the arm, and whether the stroke lowers them.
    shapes: Vec<(&'a Counted, Solid, bool)>,
    /// How far they keep off, and in words.
    kept: BigInt,
    keeps: String,
    /// By how much what is carried may press into its supports.
    pressed: Interval,
    /// Obstacles and objects where they lie or as they move, then obstacles that move, then links of the robot; none while they are carried.
    present: Vec<Option<Present>>,
    /// All of them as they are at first.
    all: Vec<&'a Obstacle>,
    /// The last knot of the step before.
    knot: usize,
    held: Option<Held>,
    /// What has just been let go of, by its number among the obstacles.
    released: Option<usize>,
    /// The most by which anything misses where it is to be.
    off: BigInt,
}

/// Where shapes are looked at that a stroke of the tool lowers: as they are, or at all heights of it; or what is held where it is going to lie.
#[derive(Clone, Copy, PartialEq)]
enum Tool {
    Raised,
    Swept,
    Lying,
}

impl<'a> Replay<'a> {
    fn new(
        robot: &'a Robot,
        world: &'a World,
        task: &'a Task,
        motion: &'a Motion,
        clearance: &Decimal,
    ) -> Result<Self, CheckError> {
        let arm = &robot.arm;
        let chain = Chain::from(arm);
        let kept = Interval::from(clearance).upper + guard();
        let shape = |shape: &'a Counted| {
            let around = &shape.around;
            let is_lowered = task.stroke.as_ref().map_or(Ok(false), |stroke| robot.lowers(&stroke.joint, shape))?;
            Ok((shape, Solid::new(&chain, On::Link(around.link), &around.shape, &kept), is_lowered))
        };
        let shapes = arm.shapes.iter().map(shape).collect::<Result<_, CheckError>>()?;
        let present = world.all().chain(&arm.own).map(|obstacle| Present::new(&chain, obstacle.clone()).map(Some));
        let present = present.collect::<Result<_, _>>()?;
        Ok(Self {
            arm,
            task,
            motion,
            tip: arm.tip.shape.points[0].clone(),
            keeps: format!("farther than {clearance} from"),
            pressed: Interval::exactly(pressed(arm).lower - guard()),
            chain,
            shapes,
            kept,
            present,
            all: world.all().chain(&arm.own).collect(),
            knot: 0,
            held: None,
            released: None,
            off: BigInt::ZERO,
        })
    }

    /// The motion from a knot to another; at least where it stands at the first.
    fn pieces(&self, knots: Range<usize>) -> Result<Vec<Piece>, CheckError> {
        let until = &self.motion.knots[..=knots.end];
        let piece = |knot: usize| piece(self.arm, &self.motion.interpolation, until, knot);
        (knots.start..knots.end.max(knots.start + 1)).map(piece).collect()
    }

    /// Does a step.
    fn step(&mut self, Matched { step, done, renewed }: &Matched, after: &[Matched]) -> Result<(), CheckError> {
        // What is to be renewed lies there while the arm stands.
        if !renewed.is_empty() {
            let at = [1, 2].map(|k| Interval::from(&self.motion.knots[self.knot][k]));
            self.free(&self.pieces(self.knot..done.knots[0])?, &at, None, Tool::Raised)?;
        }
        for object in renewed {
            let number = self.task.first + object;
            if self.held.as_ref().is_some_and(|held| held.object == *object) {
                return CheckError::fails("an object is carried of which there is to be a new one");
            }
            if self.all[number].course.is_some() {
                return CheckError::fails("there is to be a new one of an object that moves");
            }
            self.present[number] = Some(Present::new(&self.chain, self.all[number].clone())?);
            // It is another one that may be touched.
            self.released = self.released.filter(|released| *released != number);
        }
        // Where a step leaves the arm it stands until its next motion begins.
        let (first, last) = (std::mem::replace(&mut self.knot, done.knots[1]), done.knots[1]);
        let (motion, released) = (self.motion, self.released);
        let (pieces, still) = (self.pieces(first..last)?, self.pieces(last..last)?);
        let rest = after.is_empty().then(|| self.pieces(last..motion.knots.len() - 1)).transpose()?;
        let [from, to] = [first, last].map(|knot| [1, 2].map(|k| Interval::from(&motion.knots[knot][k])));
        let time = &still[0].time[0];
        let target = match &step.action {
            Action::Pick { object, .. } => Some(self.task.first + object),
            _ => None,
        };
        self.free(&pieces, &from, target, Tool::Raised)?;
        match &step.action {
            Action::Pick { object, grasp, supports, passing } => {
                let places = |step: &&Step| matches!(step.action, Action::Place { .. });
                let placing = after.iter().map(|next| next.step).find(places);
                let carrying = self.task.carrying(*object, supports, placing);
                self.grasp(*object, grasp, carrying, &to, (time, passing))?;
                self.free(&still, &to, None, Tool::Swept)?;
                self.turn(done, &to)?;
            }
            Action::Place { at, angle, .. } => {
                self.turn(done, &to)?;
                let tool = if self.task.stroke.is_some() { Tool::Swept } else { Tool::Lying };
                self.free(&still, &to, None, tool)?;
                self.release(at, angle.as_ref(), &to)?;
            }
            Action::Move(goal) => {
                self.misses(self.arm.away(&motion.knots[last], goal))?;
                self.turn(done, &to)?;
                self.released = None;
            }
        }
        // The last leaves it there, by what it came by.
        if let Some(rest) = rest {
            self.free(&rest, &to, released, Tool::Raised)?;
        }
        Ok(())
    }

    fn misses(&mut self, off: BigInt) -> Result<(), CheckError> {
        missed("target", &off)?;
        self.off = off.max(std::mem::take(&mut self.off));
        Ok(())
    }

    /// How what is held is to keep off an obstacle, if it can meet it.
    fn meets(&self, held: &Held, obstacle: usize, tool: Tool) -> Option<Manner> {
        let own = self.task.first + held.object;
        let [heights, others] = [own, obstacle].map(|number| self.all[number].heights.as_ref());
        if let (Some(lying), Some([low, high])) = (heights, others) {
            let carried = lying.each_ref().map(|height| height + &self.task.objects[held.object].lift);
            let [least, most] = match tool {
                Tool::Raised => carried,
                Tool::Lying => lying.clone(),
                Tool::Swept => [lying[0].clone().min(carried[0].clone()), lying[1].clone().max(carried[1].clone())],
            };
            if most < *low || *high <= &least + &Decimal::power_of_ten(RESTING) {
                return None;
            }
        }
        // What moves is where it lies later on, or not.
        let moves = |present: &Present| present.obstacle.course.is_some();
        if tool == Tool::Lying && self.present[obstacle].as_ref().is_some_and(moves) {
            return None;
        }
        (obstacle != own).then(|| match held.carrying.supports.contains(&obstacle) {
            true => Manner::Pressed,
            false if held.round.is_some() && self.all[obstacle].is_carried() => Manner::Round,
            false => Manner::Off,
        })
    }

    /// The parts of what is held.
    fn hanging<'h>(&'h self, held: &'h Held, solids: &'h [Vec<Solid>; 2], tool: Tool) -> Vec<Part<'h>> {
        let all = 0..self.present.len();
        let part = |solid, keeps, manner: Manner| {
            let is_met = |obstacle| self.meets(held, obstacle, tool).is_some_and(|of| of == manner);
            let meets = all.clone().map(is_met).collect();
            Part { name: "what is carried".to_owned(), keeps, solid, meets }
        };
        let [others, supports] = solids;
        let supported = supports.iter().map(|solid| part(solid, "no deeper than it may press into", Manner::Pressed));
        let round = held.round.iter().map(|solid| part(solid, &*self.keeps, Manner::Round));
        others.iter().map(|solid| part(solid, &*self.keeps, Manner::Off)).chain(supported).chain(round).collect()
    }

    /// That no obstacle begins within what is held, or no support within what of it keeps off these.
    fn surrounds_none(&self, held: &Held, values: &Point, time: &Decimal, tool: Tool) -> Result<(), CheckError> {
        let of_second = [Interval::whole(0), values[1].clone()];
        let pressed = held.pressed.iter().map(|own| (own, Manner::Pressed));
        for (hanging, manner) in iter::once((&held.hanging, Manner::Off)).chain(pressed) {
            let [lying, beside] = [values, &of_second].map(|at| self.chain.lying(&held.on, hanging, at));
            for (number, present) in self.present.iter().enumerate() {
                if self.meets(held, number, tool).is_some_and(|of| of == manner) {
                    let lying = if self.all[number].is_carried() { &beside } else { &lying };
                    let mut edges = present.iter().flat_map(|present| &present.edges);
                    let side = |edge: &Edge| edge.during(&self.chain, [time, time]).point().clone();
                    if edges.any(|edge| lying.surrounds(&side(edge), &guard()) != Some(false)) {
                        return CheckError::fails(format!(
                            "{} is inside what is carried",
                            self.all[number].called(number)
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    /// That the arm, with what it holds, is free on pieces that begin at a configuration. The second link may meet what has just been let
    /// go of, and another obstacle.
    fn free(&self, pieces: &[Piece], from: &Point, also: Option<usize>, tool: Tool) -> Result<(), CheckError> {
        let stroke = match (tool, &self.task.stroke, &self.held) {
            (Tool::Raised | Tool::Lying, ..) => None,
            (Tool::Swept, Some(Stroke { travel, .. }), Some(held)) => {
                Some(travel.as_ref().unwrap_or(&self.task.objects[held.object].lift))
            }
            (Tool::Swept, ..) => return Ok(()),
        };
        if stroke.is_some() {
            self.nothing_moves("a stroke of the tool")?;
        }
        let own = |shape| {
            let (counted, solid, is_lowered): &(&Counted, Solid, bool) = shape;
            let body = &counted.around;
            let lowered = stroke.filter(|_| *is_lowered).map(|by| lowered(body, by));
            let heights = lowered.as_ref().unwrap_or(body);
            let meets = |(number, obstacle): (usize, &&Obstacle)| {
                let is_allowed = body.link == 1 && [self.released, also].contains(&Some(number));
                !is_allowed && counted.meets(heights, obstacle)
            };
            let meets = self.all.iter().enumerate().map(meets).collect();
            Part { name: counted.to_string(), keeps: &self.keeps, solid, meets }
        };
        let mut parts: Vec<Part> = self.shapes.iter().map(own).collect();
        if let Some(held) = &self.held {
            parts.extend(self.hanging(held, &held.solids, tool));
            self.surrounds_none(held, from, &pieces[0].time[0], tool)?;
        }
        stay_off(&self.chain, pieces, from, &parts, &self.present)
    }

    /// The shapes of an object as it hangs on something, and of what of it keeps off its supports.
    fn hung(
        &self,
        chain: &Chain,
        on: &On,
        hanging: &Obstacle,
        pressed: Option<&Obstacle>,
    ) -> Result<[Vec<Solid>; 2], CheckError> {
        let solids = |own: &Obstacle, kept: &BigInt| {
            hung::solids(own).map(|all| all.iter().map(|shape| Solid::new(chain, on.clone(), shape, kept)).collect())
        };
        Ok([solids(hanging, &self.kept)?, pressed.map_or(Ok(Vec::new()), |own| solids(own, &guard()))?])
    }

    /// A disc about the tip that covers what is held level however it turns.
    fn round(&self, hanging: &Obstacle) -> Result<Solid, CheckError> {
        let all = hung::solids(hanging)?;
        let reach = |shape: &Shape| {
            let points = shape.points.iter().map(length);
            points.map(|off| off.upper + &shape.radius.upper).max()
        };
        let radius = Interval::exactly(all.iter().filter_map(reach).max().unwrap_or_default());
        let disc = Shape { points: vec![self.tip.clone()], radius };
        Ok(Solid::new(&self.chain, On::Link(1), &disc, &self.kept))
    }

    /// For what is not looked at in time.
    fn nothing_moves(&self, what: &str) -> Result<(), CheckError> {
        let moves = |present: &Present| present.obstacle.course.is_some();
        match self.present.iter().flatten().any(moves) {
            true => CheckError::fails(format!("the checker does not know {what} while something moves")),
            false => Ok(()),
        }
    }

    /// Takes an object as it lies at a time, or passes, with the tip where it is at a configuration.
    fn grasp(
        &mut self,
        object: usize,
        grasp: &Corner,
        carrying: Carrying,
        at: &Point,
        (time, passing): (&Decimal, &Passing),
    ) -> Result<(), CheckError> {
        let (None, Some(present)) = (&self.held, self.present[self.task.first + object].take()) else {
            return CheckError::fails("something is carried when an object is picked");
        };
        let lying = present.obstacle.at_time(time).into_owned();
        if passing.window.as_ref().is_some_and(|[low, high]| time < low || high < time) {
            return CheckError::fails("the object is picked outside its window of time");
        }
        let near = Interval::from(&Decimal::power_of_ten(NEAR)).lower;
        if passing.at.as_ref().is_some_and(|at| length(&minus(&lying.at, at)).upper > near) {
            return CheckError::fails("the object is not picked where it is to be then");
        }
        let tip = self.chain.point_at(&On::Link(1), &self.tip, at);
        self.misses(length(&minus(&tip, &lying.placed(&grasp.each_ref().map(Interval::from)))).upper)?;
        let (on, hanging, round) = if self.task.objects[object].is_level {
            let (at, turn) = (minus(&lying.at, &tip), lying.turn.clone());
            let hanging = lying.moved(at, turn);
            let round = self.round(&hanging)?;
            (On::Level(self.tip.clone()), hanging, Some(round))
        } else {
            (On::Link(1), self.chain.hung(&lying, at), None)
        };
        let pressed = (!carrying.supports.is_empty()).then(|| hung::pressed(&hanging, &self.pressed)).transpose()?;
        let solids = self.hung(&self.chain, &on, &hanging, pressed.as_ref())?;
        self.held = Some(Held { object, on, hanging, pressed, solids, round, carrying });
        self.released = None;
        Ok(())
    }

    /// Lets go of what is carried.
    fn release(&mut self, at: &Point, angle: Option<&Interval>, values: &Point) -> Result<(), CheckError> {
        let Some(held) = self.held.take() else { return CheckError::fails("nothing is carried that could be placed") };
        let lying = self.chain.lying(&held.on, &held.hanging, values);
        self.misses(length(&minus(&lying.at, at)).upper)?;
        if let Some(angle) = angle {
            self.misses(length(&minus(&lying.turn, &angle.sin_cos())).upper)?;
        }
        let number = self.task.first + held.object;
        self.present[number] = Some(Present::new(&self.chain, lying)?);
        self.released = Some(number);
        Ok(())
    }

    /// Turns what is held about the tip, while the arm stands at a configuration.
    fn turn(&mut self, done: &Done, at: &Point) -> Result<(), CheckError> {
        let Some(by) = &done.turn else { return Ok(()) };
        self.nothing_moves("a turn of the wrist")?;
        let Some(mut held) = self.held.take_if(|held| held.carrying.may_turn && matches!(held.on, On::Level(_))) else {
            return CheckError::fails("there is no wrist, or nothing that it is to turn");
        };
        let wrist = Chain::about(&self.chain.point_at(&On::Link(1), &self.tip, at));
        let Some(end) = fine(&(by * &Decimal::whole(SIXTY))).filter(|end| end.abs() < LARGEST_TURN << FINE) else {
            return CheckError::fails("the wrist turns by more than a turn");
        };
        let time = [0, 1].map(Decimal::whole);
        let swept = Piece { knot: done.knots[1], curves: vec![vec![[0, 0], [end, 0]]], time };
        let solids = self.hung(&wrist, &On::Link(0), &held.hanging, held.pressed.as_ref())?;
        let seen = |(number, present): (usize, &Option<Present>)| {
            // A disc about the tip has been looked at.
            let meets = || self.meets(&held, number, Tool::Raised).is_some_and(|of| of != Manner::Round);
            let met = present.as_ref().filter(|_| meets());
            met.map(|present| Present::new(&wrist, present.obstacle.clone())).transpose()
        };
        let present = self.present.iter().enumerate().map(seen).collect::<Result<Vec<_>, _>>()?;
        let parts = self.hanging(&held, &solids, Tool::Raised);
        self.surrounds_none(&held, at, &swept.time[0], Tool::Raised)?;
        stay_off(&wrist, &[swept], &[0, 0].map(Interval::whole), &parts, &present)?;
        let angle = Interval::from(by).sin_cos();
        for own in iter::once(&mut held.hanging).chain(&mut held.pressed) {
            own.at = turned(&own.at, &angle);
            own.turn = both_turns(&own.turn, &angle);
        }
        held.solids = self.hung(&self.chain, &held.on, &held.hanging, held.pressed.as_ref())?;
        self.held = Some(held);
        Ok(())
    }
}
