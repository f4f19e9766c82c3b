//! Certificates of tasks that cannot be done: from nowhere where the arm may be before a step does a way lead to where the step ends.

use crate::certificate::{Certificate, StuckBox, rectangles};
use crate::contacts::{Among, Carried, Contacts};
use crate::error::{CheckError, Input};
use crate::free::Chain;
use crate::interval::{Interval, Point, sum, turned};
use crate::polygon::Corner;
use crate::robot::Arm;
use crate::sweep::{Domain, Reached, Rectangle};
use crate::world::task::{Action, Group, Node, Step, Task};
use crate::world::{Goal, Obstacle, World};
use crate::{FEW_PARTS, GoalRegion, MOST_PARTS, place, shown, start, within};
use serde::Deserialize;
use std::borrow::Cow;

/// Some of the configurations from which a step may begin, and boxes of configurations that are not free then.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The step's number in the world file, from 1.
    step: usize,
    /// Where the arm is before it; the start if it does not say.
    from: Option<Rectangle>,
    boxes: Vec<StuckBox>,
}

/// That the steps of a world cannot all be done.
pub fn infeasible(arm: &Arm, world: &World, certificate: &Certificate, cases: &[Case]) -> Result<String, CheckError> {
    let Some(task) = &world.task else { return Err(CheckError::in_file(Input::World, "it has no steps")) };
    if certificate.goal.is_some() || certificate.goal_tip.is_some() {
        return Err(CheckError::in_file(Input::Certificate, "that of a task has no goal"));
    }
    let clearance = certificate.clearance(world)?;
    let domain = Domain::new(&arm.joints.each_ref().map(|joint| joint.axis.clone()));
    let mut steps = Vec::new();
    in_order(&task.steps, cases, &mut steps)?;
    let mut replay = Replay::new(arm, world, task);
    let at_start = start(arm, &domain, world, certificate)?;
    let of = |step: &Step| cases.iter().filter(|case| case.step == step.number).collect::<Vec<&Case>>();
    // Where the arm may be; none where nobody asks.
    let mut at = Some(vec![at_start.clone()]);
    for (index, step) in steps.iter().enumerate() {
        let (own, number) = (of(step), step.number);
        if own.is_empty() {
            let is_asked = steps.get(index + 1).is_some_and(|next| !of(next).is_empty());
            let all = || Ok(replay.region(&domain, step, None)?.places(arm, &domain, FEW_PARTS, |_| false));
            at = is_asked.then(all).transpose()?;
        } else {
            let from = |case: &Case| case.from.clone().unwrap_or_else(|| at_start.clone());
            let begins = |part: &Rectangle| own.iter().any(|case| within(part, &from(case)));
            if !at.is_some_and(|at| at.iter().all(begins)) {
                return CheckError::fails(format!("step {number} may begin where no case does"));
            }
            let mut left = Vec::new();
            for case in &own {
                let from = from(case);
                let boxes = rectangles(&case.boxes)?;
                let Some(reached) = Reached::new(&domain, &boxes, &from) else {
                    return CheckError::fails("the boxes leave more gaps than the checker looks at");
                };
                let region = replay.region(&domain, step, Some(&from))?;
                left.extend(region.places(arm, &domain, MOST_PARTS, |part| !reached.meets(part)));
                let among = replay.among(step, &steps[index..], &from);
                let held = Contacts::new(arm, &among, certificate, clearance).hold(arm, &case.boxes, &boxes);
                held.map_err(|why| match why {
                    CheckError::Fails(why) => CheckError::Fails(format!("a case of step {number}: {why}")),
                    input => input,
                })?;
            }
            at = Some(left);
        }
        if at.as_ref().is_some_and(Vec::is_empty) {
            let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
            let start = shown(certificate.start.as_ref());
            return Ok(format!(
                "no motion of \"{first}\" and \"{second}\" from the start{start} on does the steps up to step {number} with clearance {clearance}"
            ));
        }
        replay.after(step);
    }
    CheckError::fails("the cases leave open that all steps are done")
}

/// The steps as they are done the first time.
fn in_order<'a>(group: &'a Group, cases: &[Case], steps: &mut Vec<&'a Step>) -> Result<(), CheckError> {
    let before = steps.len();
    for node in &group.nodes {
        match node {
            Node::Step(step) => steps.push(step),
            Node::Group(group) => in_order(group, cases, steps)?,
        }
    }
    let last = cases.iter().map(|case| case.step).max();
    if group.is_free && steps[before..].iter().any(|step| Some(step.number) <= last) {
        let message = "the checker does not know proofs about steps in any order, or after them";
        return Err(CheckError::in_file(Input::Certificate, message));
    }
    Ok(())
}

/// How an object is carried.
enum Hanging {
    /// Level: as it lies to the tip.
    Level(Obstacle),
    /// Rigid, and it has just been taken where it lay.
    Taken(Obstacle),
    /// It is not known.
    Somehow,
}

/// What is carried.
struct Held<'a> {
    object: usize,
    grasp: &'a Corner,
    supports: &'a [usize],
    hanging: Hanging,
}

/// Where everything is before a step, as far as it does not depend on how the steps before it were done.
struct Replay<'a> {
    arm: &'a Arm<'a>,
    world: &'a World,
    task: &'a Task,
    chain: Chain,
    standing: Vec<Option<Cow<'a, Obstacle>>>,
    held: Option<Held<'a>>,
    released: Option<usize>,
}

impl<'a> Replay<'a> {
    fn new(arm: &'a Arm, world: &'a World, task: &'a Task) -> Self {
        let Among { standing, .. } = Among::all(world);
        Self { arm, world, task, chain: Chain::from(arm), standing, held: None, released: None }
    }

    /// The configurations in which a step may end, after one that ends in a rectangle.
    fn region(&self, domain: &Domain, step: &Step, from: Option<&Rectangle>) -> Result<GoalRegion<'a>, CheckError> {
        let unknown = || CheckError::fails(format!("where step {} ends depends on what is not known", step.number));
        let (link, tip) = self.arm.tip()?;
        let tip_at = |place: Point| Ok(GoalRegion::Tip { link, tip: Box::new(self.arm.tip()?.1), place });
        match &step.action {
            Action::Move(Goal::Tip(at)) => tip_at(at.each_ref().map(Interval::from)),
            Action::Move(goal @ Goal::Joints(_)) => {
                Ok(GoalRegion::Configuration(place(self.arm, domain, "target", None, Some(goal))?))
            }
            Action::Pick { object, grasp, .. } => match &self.standing[self.task.first + object] {
                Some(lying) => tip_at(lying.placed(&grasp.each_ref().map(Interval::from))),
                None => unknown(),
            },
            Action::Place { at, angle, .. } => {
                let Some(held) = &self.held else { return unknown() };
                let grasp = held.grasp.each_ref().map(Interval::from);
                match (&held.hanging, angle, from) {
                    (Hanging::Level(hanging), ..) => tip_at(minus(at, &hanging.at)),
                    (Hanging::Taken(lying), _, Some(from)) => {
                        let mut origin = tip;
                        origin.shape.points = vec![self.chain.seen_at(&lying.at, &values(from))];
                        Ok(GoalRegion::Tip { link, tip: Box::new(origin), place: at.clone() })
                    }
                    (_, Some(angle), _) => tip_at(sum(at, &turned(&grasp, &angle.sin_cos()))),
                    _ if grasp.iter().all(|c| c.is_whole(0)) => tip_at(at.clone()),
                    _ => unknown(),
                }
            }
        }
    }

    /// What is where while a step is done from a configuration in a rectangle; `after` are the step and those after it.
    fn among(&self, step: &Step, after: &[&Step], from: &Rectangle) -> Among<'_> {
        let picked = match &step.action {
            Action::Pick { object, .. } => Some(self.task.first + object),
            _ => None,
        };
        let carried = self.held.as_ref().and_then(|held| {
            let (hanging, is_level) = match &held.hanging {
                Hanging::Level(hanging) => (hanging.clone(), true),
                Hanging::Taken(lying) => (self.chain.hung(lying, &values(from)), false),
                Hanging::Somehow => return None,
            };
            let object = &self.task.objects[held.object];
            let then = after.iter().find_map(|next| match &next.action {
                Action::Place { supports, .. } => Some(supports.as_ref().unwrap_or(&object.supports)),
                _ => None,
            });
            let supports = held.supports.iter().chain(then.into_iter().flatten()).copied().collect();
            let lift = Interval::from(&object.lift);
            let lying = self.world.obstacles[self.task.first + held.object].heights.as_ref();
            let heights = lying.map(|range| range.each_ref().map(|height| &Interval::from(height) + &lift));
            Some(Carried { hanging, is_level, heights, supports })
        });
        let allowed = self.released.into_iter().chain(picked).collect();
        Among { standing: self.standing.clone(), allowed, carried }
    }

    /// Takes a step as done.
    fn after(&mut self, step: &'a Step) {
        let first = self.task.first;
        self.released = None;
        match &step.action {
            Action::Pick { object, grasp, supports } => {
                let lying = self.standing[first + object].take();
                let hanging = match (lying, self.task.objects[*object].is_level) {
                    (Some(lying), false) => Hanging::Taken(lying.into_owned()),
                    (Some(lying), true) if !self.task.has_wrist => {
                        let tip = lying.placed(&grasp.each_ref().map(Interval::from));
                        let (at, turn) = (minus(&lying.at, &tip), lying.turn.clone());
                        Hanging::Level(lying.into_owned().moved(at, turn))
                    }
                    _ => Hanging::Somehow,
                };
                self.held = Some(Held { object: *object, grasp, supports, hanging });
            }
            Action::Place { at, angle, .. } => {
                let Some(held) = self.held.take() else { return };
                let turn = match (angle, held.hanging) {
                    (Some(angle), _) => Some(angle.sin_cos()),
                    (None, Hanging::Level(hanging)) => Some(hanging.turn),
                    (None, Hanging::Taken(_) | Hanging::Somehow) => None,
                };
                let number = first + held.object;
                let lying = |turn| Cow::Owned(self.world.obstacles[number].clone().moved(at.clone(), turn));
                self.standing[number] = turn.map(lying);
                self.released = Some(number);
            }
            Action::Move(_) => {
                if let Some(held) = &mut self.held
                    && matches!(held.hanging, Hanging::Taken(_))
                {
                    held.hanging = Hanging::Somehow;
                }
            }
        }
    }
}

/// The values of the joints in a rectangle.
fn values(rectangle: &Rectangle) -> Point {
    rectangle.each_ref().map(Interval::around)
}

fn minus(a: &Point, b: &Point) -> Point {
    [&a[0] - &b[0], &a[1] - &b[1]]
}
