//! Certificates of tasks that cannot be done: from nowhere where the arm may be before a step does a way lead to where the step ends.

use crate::certificate::{Case, Certificate, StuckBox, rectangles};
use crate::contacts::{Among, Carried, Contacts};
use crate::decimal::Decimal;
use crate::domain::{Rectangle, within};
use crate::ends::{End, MOST_PARTS, Region};
use crate::error::{CheckError, Input};
use crate::free::{Chain, On, guard};
use crate::interval::{Interval, Point, length, minus, sum, turned};
use crate::polygon::Corner;
use crate::robot::{Arm, Joint, Motion};
use crate::sweep::Reached;
use crate::task::NEAR;
use crate::world::task::{Action, Carrying, Group, Node, Step, Stroke, Task};
use crate::world::{Goal, Obstacle, World};
use std::borrow::Cow;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::rc::Rc;

/// Corners that turn inwards are moved by less than this share less than others: see [`Obstacle::pressed`].
const LESS: u32 = 29;

/// Ways to be somewhere in the course of free orders beyond these are not followed.
const MOST_BRANCHES: usize = 1000;

/// That the steps of a world cannot all be done.
pub fn infeasible(arm: &Arm, world: &World, certificate: &Certificate, cases: &[Case]) -> Result<String, CheckError> {
    let Some(task) = &world.task else { return Err(CheckError::in_file(Input::World, "it has no steps")) };
    if certificate.goal.is_some() || certificate.goal_tip.is_some() {
        return Err(CheckError::in_file(Input::Certificate, "that of a task has no goal"));
    }
    let clearance = certificate.clearance(world)?;
    let start = End::start(certificate, world)?;
    let at_start = start.configuration(arm)?;
    let (mut steps, mut repeated) = (Vec::new(), Vec::new());
    in_file_order(&task.steps, &mut steps, &mut repeated);
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let proven = |last: usize, why: &str| {
        let start = start.named(arm);
        Ok(format!(
            "no motion of \"{first}\" and \"{second}\" from the start{start} on does the steps up to step {last} with clearance {clearance}{why}"
        ))
    };
    if let Some(step) = out_of_reach(arm, world, task, &steps) {
        return proven(step.number, ", since what it picks is never within reach then");
    }
    if world.obstacles.iter().any(|obstacle| obstacle.course.is_some()) {
        let message =
            "an object moves: the checker knows no other proof of such tasks than that one is never within reach";
        return Err(CheckError::in_file(Input::World, message));
    }
    let begin = Branch {
        replay: Replay::new(arm, world, task, (&steps, &repeated)),
        at: Some(vec![at_start.clone()]),
        ends: Ok(Vec::new()),
        done: None,
        turned: Vec::new(),
    };
    let proof = Proof { arm, certificate, clearance, cases, at_start: &at_start };
    let mut last = 0;
    let done = proof.group(&task.steps, vec![begin], &mut last)?;
    if !done.is_empty() && proof.stays(done, steps[steps.len() - 1])? {
        return CheckError::fails("the cases leave open that all steps are done");
    }
    proven(last, "")
}

/// A step that picks an object on its way, as no other does, which is never within reach when it is to be picked.
fn out_of_reach<'a>(arm: &Arm, world: &World, task: &Task, steps: &[&'a Step]) -> Option<&'a Step> {
    let picks = |step: &Step, wanted: usize| matches!(&step.action, Action::Pick { object, .. } if *object == wanted);
    let is_out = |step: &&&Step| {
        let Action::Pick { object, grasp, passing, .. } = &step.action else { return false };
        let Some(course) = &world.obstacles[task.first + object].course else { return false };
        let reach = arm.tip_reach() + length(&grasp.each_ref().map(Interval::from)).upper;
        let (begin, end) = match &passing.window {
            Some([begin, end]) => (begin.clone(), Some(end)),
            None => (Decimal::whole(0), None),
        };
        let near = Interval::from(&Decimal::power_of_ten(NEAR)).upper;
        let is_far = |at: &Point| length(&minus(at, &arm.base)).lower > &reach + &near;
        steps.iter().filter(|step| picks(step, *object)).count() == 1
            && (course.nearest(&arm.base, &begin, end) > reach || passing.at.as_ref().is_some_and(is_far))
    };
    steps.iter().find(is_out).copied()
}

/// All steps, those of a group in free order as they stand in the file, and the numbers of those that are repeated together.
fn in_file_order<'a>(group: &'a Group, steps: &mut Vec<&'a Step>, repeated: &mut Vec<Range<usize>>) {
    let first = steps.len() + 1;
    for node in &group.nodes {
        match node {
            Node::Step(step) => steps.push(step),
            Node::Group(group) => in_file_order(group, steps, repeated),
        }
    }
    repeated.extend((group.repeat > 1).then_some(first..steps.len() + 1));
}

/// What has been done, and where the arm may be then.
#[derive(Clone)]
struct Branch<'a> {
    replay: Replay<'a>,
    /// All configurations in which it may be; if it is not known, those in which the step before ends at all.
    at: Option<Vec<Rectangle>>,
    /// Where the step before ends.
    ends: Result<Vec<Region>, CheckError>,
    /// In a group in free order, if that counts: the picks of the pairs that are done, the last one last.
    done: Option<Vec<usize>>,
    /// From where to where it has carried what lies as a turning arm has let go of it.
    turned: Vec<[Rectangle; 2]>,
}

/// What a certificate says of steps, as far as it is true.
#[derive(Clone, Copy)]
struct Proof<'a> {
    arm: &'a Arm<'a>,
    certificate: &'a Certificate,
    clearance: &'a Decimal,
    cases: &'a [Case],
    at_start: &'a Rectangle,
}

impl<'a> Proof<'a> {
    /// What may be after the steps of a group; nothing if they cannot all be done. `last` is the last one that was looked at.
    fn group(self, group: &'a Group, before: Vec<Branch<'a>>, last: &mut usize) -> Result<Vec<Branch<'a>>, CheckError> {
        let after = self.once(group, before.clone(), last)?;
        if group.repeat == 1 || after.is_empty() {
            return Ok(after);
        }
        // What rules something out the first time need not do so the last time, with new objects in the stead of some.
        let mut before = before;
        for Branch { replay, .. } in &mut before {
            for number in group.renewed.iter().map(|object| replay.task.first + object) {
                replay.standing[number] = Some(Cow::Borrowed(&replay.world.obstacles[number]));
                replay.released.retain(|released| *released != number);
            }
        }
        Self { cases: &[], ..self }.once(group, before, last)
    }

    fn once(self, group: &'a Group, before: Vec<Branch<'a>>, last: &mut usize) -> Result<Vec<Branch<'a>>, CheckError> {
        if group.is_free {
            let mut steps = Vec::new();
            in_file_order(group, &mut steps, &mut Vec::new());
            *last = steps[steps.len() - 1].number;
            let after = before.into_iter().map(|branch| self.in_any_order(&steps, branch));
            return Ok(after.collect::<Result<Vec<_>, _>>()?.concat());
        }
        let mut branches = before;
        for node in group.nodes.iter() {
            branches = match node {
                _ if branches.is_empty() => break,
                Node::Group(group) => self.group(group, branches, last)?,
                Node::Step(step) => {
                    *last = step.number;
                    let after = branches.into_iter().map(|branch| self.followed(branch, step));
                    let after = merged(after.collect::<Result<Vec<_>, _>>()?.into_iter().flatten());
                    if after.len() > MOST_BRANCHES {
                        return CheckError::fails("steps can be done in more ways than the checker looks at");
                    }
                    after
                }
            };
        }
        Ok(branches)
    }

    /// Whether the arm can stay where the last step ends. It has come there by what may be touched until then.
    fn stays(self, branches: Vec<Branch<'a>>, last: &Step) -> Result<bool, CheckError> {
        let own: Vec<&Case> = self.cases.iter().filter(|case| case.step == last.number + 1).collect();
        // What was let go of before a pick may be touched until the arm goes on.
        if own.is_empty() || !matches!(last.action, Action::Place { .. }) {
            return Ok(true);
        }
        for branch in &branches {
            let own = own.iter().copied().filter(|case| case.is_after(&branch.turned));
            if !self.left(branch, last.number + 1, None, &own.collect::<Vec<_>>())?.is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// What may be after a step; where something is let go of that has been turned, and later cases tell, each way to do so by itself.
    fn followed(self, branch: Branch<'a>, step: &'a Step) -> Result<Vec<Branch<'a>>, CheckError> {
        let is_told = |case: &Case| case.turned.as_ref().is_some_and(|turned| turned.len() > branch.turned.len());
        let carried = match (&step.action, &branch.replay.held) {
            (Action::Place { angle: None, at, .. }, Some(Held { hanging: Hanging::Taken(lying), object, .. }))
                if self.cases.iter().any(is_told) =>
            {
                Some((at, lying.clone(), branch.replay.task.first + object))
            }
            _ => None,
        };
        let own = self.cases_about(&branch, step);
        let (Some((at, lying, number)), false) = (carried, own.is_empty()) else {
            return Ok(self.step(branch, step)?.into_iter().collect());
        };
        let own = self.begun(&branch, step.number, &own)?;
        let mut all = Vec::new();
        for case in own {
            let from = self.from(case);
            let hanging = branch.replay.chain.hung(&lying, &values(&from));
            for place in self.left_by(&branch, step.number, Some(step), case)? {
                let mut branch = branch.clone();
                let ends = branch.replay.region(step, Some(&from)).map(|region| vec![region]);
                branch.replay.after(step);
                let let_go = branch.replay.chain.lying(&On::Link(1), &hanging, &values(&place));
                let turn = let_go.turn.clone();
                branch.replay.standing[number] = Some(Cow::Owned(let_go.moved(at.clone(), turn)));
                branch.turned.push([from.clone(), place.clone()]);
                all.push(Branch { at: Some(vec![place]), ends, ..branch });
            }
        }
        Ok(all)
    }

    fn cases_about(self, branch: &Branch, step: &Step) -> Vec<&'a Case> {
        let is_about = |case: &&Case| case.is_about(step, branch.done.as_deref()) && case.is_after(&branch.turned);
        self.cases.iter().filter(is_about).collect()
    }

    /// What may be after a step; nothing if it cannot be done.
    fn step(self, mut branch: Branch<'a>, step: &'a Step) -> Result<Option<Branch<'a>>, CheckError> {
        let own = self.cases_about(&branch, step);
        let at = if own.is_empty() { None } else { Some(self.left(&branch, step.number, Some(step), &own)?) };
        if at.as_ref().is_some_and(Vec::is_empty) {
            return Ok(None);
        }
        let ends = branch.replay.region(step, None).map(|region| vec![region]);
        branch.replay.after(step);
        Ok(Some(Branch { at, ends, ..branch }))
    }

    /// Where a step may end as far as its cases tell; without a step where the arm may stay.
    fn left(
        self,
        branch: &Branch,
        number: usize,
        step: Option<&Step>,
        own: &[&Case],
    ) -> Result<Vec<Rectangle>, CheckError> {
        let own = self.begun(branch, number, own)?;
        let left = own.iter().map(|case| self.left_by(branch, number, step, case));
        Ok(left.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Where the arm is before a step of a case.
    fn from(self, case: &Case) -> Rectangle {
        case.from.clone().unwrap_or_else(|| self.at_start.clone())
    }

    /// The cases of a step in which it may begin, if it begins nowhere else.
    fn begun<'c>(self, branch: &Branch, number: usize, own: &[&'c Case]) -> Result<Vec<&'c Case>, CheckError> {
        let at = self.at(branch)?;
        let holds = |case: &Case, part: &Rectangle| within(part, &self.from(case));
        match at.iter().all(|part| own.iter().any(|case| holds(case, part))) {
            true => Ok(own.iter().copied().filter(|case| at.iter().any(|part| holds(case, part))).collect()),
            false => CheckError::fails(format!("step {number} may begin where no case does")),
        }
    }

    /// Where a step may end from where a case begins.
    fn left_by(
        self,
        branch: &Branch,
        number: usize,
        step: Option<&Step>,
        case: &Case,
    ) -> Result<Vec<Rectangle>, CheckError> {
        let from = self.from(case);
        let boxes = rectangles(&case.boxes)?;
        let Some(reached) = Reached::new(&self.arm.domain, &boxes, &from) else {
            return CheckError::fails("the boxes leave more gaps than the checker looks at");
        };
        let lowered = rectangles(case.lowered.as_deref().unwrap_or_default())?;
        let region = match step {
            Some(step) => branch.replay.region(step, Some(&from))?,
            None => Region::Configuration(from.clone()),
        };
        let is_left_out = |part: &Rectangle| !reached.meets(part) || lowered.iter().any(|all| within(part, all));
        let left = region.places(self.arm, MOST_PARTS, is_left_out);
        let hold = |among: &Among, stuck: &[StuckBox], boxes: &[Rectangle], when: &str| {
            let contacts = Contacts::new(self.arm, among, self.certificate, self.clearance);
            contacts.hold(self.arm, stuck, boxes).map_err(|why| match why {
                CheckError::Fails(why) => CheckError::Fails(format!("a case of step {number}{when}: {why}")),
                input => input,
            })
        };
        let picked = step.and_then(|step| branch.replay.picked(step));
        hold(&branch.replay.among(picked, &from), &case.boxes, &boxes, "")?;
        if let Some(stuck) = &case.lowered {
            let Some(among) = step.and_then(|step| branch.replay.lowered(step, &from)) else {
                return CheckError::fails(format!("at step {number} no tool is lowered"));
            };
            hold(&among, stuck, &lowered, ", the tool lowered")?;
        }
        Ok(left)
    }

    /// Where the arm may be.
    fn at(self, branch: &Branch) -> Result<Vec<Rectangle>, CheckError> {
        if let Some(at) = &branch.at {
            return Ok(at.clone());
        }
        let places = |region: &Region| region.places(self.arm, MOST_PARTS, |_| false);
        Ok(branch.ends.as_ref().map_err(Clone::clone)?.iter().flat_map(places).collect())
    }

    /// What may be after pairs of a pick and a place in any order.
    fn in_any_order(self, steps: &[&'a Step], entry: Branch<'a>) -> Result<Vec<Branch<'a>>, CheckError> {
        let pairs: Vec<&[&Step]> = steps.chunks(2).collect();
        let numbers: Vec<usize> = steps.iter().filter_map(|step| entry.replay.picked(step)).collect();
        if (1..numbers.len()).any(|k| numbers[..k].contains(&numbers[k])) {
            return CheckError::fails("an object is picked more than once in free order");
        }
        let own_cases = |pair: &[&Step], is_ordered: bool| {
            let about = |case: &Case| pair.iter().any(|step| step.number == case.step);
            self.cases.iter().any(|case| case.after.is_some() == is_ordered && about(case))
        };
        // What holds with others of its objects nowhere holds in whichever order.
        let alone = |own: usize| {
            let mut replay = entry.replay.clone();
            numbers.iter().filter(|other| **other != numbers[own]).for_each(|other| replay.standing[*other] = None);
            replay
        };
        let after = |own: usize| {
            let mut replay = alone(own);
            replay.after(pairs[own][0]);
            let end = replay.region(pairs[own][1], None);
            replay.after(pairs[own][1]);
            (end, replay.standing[numbers[own]].take())
        };
        let (ends, lying): (Vec<_>, Vec<_>) = (0..pairs.len()).map(after).unzip();
        let all_but = |own: Option<usize>| {
            let others = ends.iter().enumerate().filter(|(other, _)| Some(*other) != own);
            others.map(|(_, end)| end.clone()).collect::<Result<Vec<_>, _>>()
        };
        for own in (0..pairs.len()).filter(|own| own_cases(pairs[*own], false)) {
            let others = Branch { at: None, ends: all_but(Some(own)), ..entry.clone() };
            let anywhere = || Ok([self.at(&entry)?, self.at(&others)?].concat());
            let at = own_cases(&pairs[own][..1], false).then(anywhere).transpose()?;
            let picked = self.step(Branch { replay: alone(own), at, ..entry.clone() }, pairs[own][0])?;
            if picked.map(|branch| self.step(branch, pairs[own][1])).transpose()?.flatten().is_none() {
                return Ok(Vec::new());
            }
        }
        if !own_cases(steps, true) {
            let mut all = Branch { at: None, ends: all_but(None), ..entry };
            for (number, lying) in numbers.iter().zip(lying) {
                all.replay.standing[*number] = lying;
            }
            all.replay.released = numbers;
            return Ok(vec![all]);
        }
        let mut branches = vec![Branch { done: Some(Vec::new()), ..entry }];
        for _ in 0..pairs.len() {
            let mut next = Vec::new();
            for branch in &branches {
                let done = branch.done.as_deref().unwrap_or_default();
                for pair in pairs.iter().filter(|pair| !done.contains(&pair[0].number)) {
                    for picked in self.followed(branch.clone(), pair[0])? {
                        let placed = self.followed(picked, pair[1])?.into_iter();
                        let done = Some([done, &[pair[0].number]].concat());
                        next.extend(placed.map(|placed| Branch { done: done.clone(), ..placed }));
                    }
                }
            }
            branches = merged(next);
            if branches.len() > MOST_BRANCHES {
                return CheckError::fails("steps in free order can be done in more ways than the checker looks at");
            }
        }
        branches.iter_mut().for_each(|branch| branch.done = None);
        Ok(branches)
    }
}

impl Case {
    /// Whether it is about what lies so: carried from and to these rectangles, if it says where.
    fn is_after(&self, turned: &[[Rectangle; 2]]) -> bool {
        self.turned.as_ref().is_none_or(|own| {
            let mut both = turned.iter().flatten().zip(own.iter().flatten());
            own.len() == turned.len() && both.all(|(part, whole)| within(part, whole))
        })
    }

    /// Whether it is about a step, in free order after these picks. What is let go of last may be touched until the next pick has ended:
    /// up to there it counts which that is.
    fn is_about(&self, step: &Step, done: Option<&[usize]>) -> bool {
        let sorted = |picks: &[usize]| picks.iter().copied().collect::<BTreeSet<usize>>();
        let is_after = match (&self.after, done) {
            (None, None) => true,
            (Some(after), Some(done)) => {
                let is_pick = matches!(step.action, Action::Pick { .. });
                sorted(after) == sorted(done) && (!is_pick || after.last() == done.last())
            }
            _ => false,
        };
        self.step == step.number && is_after
    }
}

/// Those with the same behind them as one: in free order the same pairs, in whichever order, the same one last; and nothing turned.
fn merged<'a>(branches: impl IntoIterator<Item = Branch<'a>>) -> Vec<Branch<'a>> {
    let mut all: BTreeMap<_, Branch> = BTreeMap::new();
    for (index, branch) in branches.into_iter().enumerate() {
        let mut key = branch.done.clone().unwrap_or_default();
        key.sort_unstable();
        // How something lies that was turned is each branch's own.
        let own = (!branch.turned.is_empty()).then_some(index);
        match all.entry((key, branch.replay.released.clone(), own)) {
            Entry::Vacant(vacant) => {
                vacant.insert(branch);
            }
            Entry::Occupied(mut same) => {
                let same = same.get_mut();
                same.at = same.at.take().zip(branch.at).map(|(a, b)| [a, b].concat());
            }
        }
    }
    all.into_values().collect()
}

/// How an object is carried.
#[derive(Clone)]
enum Hanging {
    /// Level: as it lies to the tip.
    Level(Obstacle),
    /// Rigid, and it has just been taken where it lay.
    Taken(Obstacle),
    /// It is not known.
    Somehow,
}

/// What is carried.
#[derive(Clone)]
struct Held<'a> {
    object: usize,
    grasp: &'a Corner,
    /// What it may touch.
    supports: Vec<usize>,
    hanging: Hanging,
}

/// Where everything is before a step, as far as it does not depend on how the steps before it were done.
#[derive(Clone)]
struct Replay<'a> {
    arm: &'a Arm<'a>,
    world: &'a World,
    task: &'a Task,
    chain: Chain,
    standing: Vec<Option<Cow<'a, Obstacle>>>,
    held: Option<Held<'a>>,
    /// What has just been let go of, or may have been.
    released: Vec<usize>,
    /// All steps in the order of the file, and the numbers of those that are repeated together.
    steps: &'a [&'a Step],
    repeated: &'a [Range<usize>],
    /// No object presses deeper than this into what supports it.
    pressed: Interval,
}

impl<'a> Replay<'a> {
    fn new(
        arm: &'a Arm,
        world: &'a World,
        task: &'a Task,
        (steps, repeated): (&'a [&'a Step], &'a [Range<usize>]),
    ) -> Self {
        let Among { standing, .. } = Among::all(world);
        let pressed = arm.pressed().upper;
        let pressed = Interval::exactly(&pressed + (&pressed >> LESS) + guard());
        let (chain, released) = (Chain::from(arm), Vec::new());
        Self { arm, world, task, chain, standing, held: None, released, steps, repeated, pressed }
    }

    /// The number of what a step picks.
    fn picked(&self, step: &Step) -> Option<usize> {
        match &step.action {
            Action::Pick { object, .. } => Some(self.task.first + object),
            _ => None,
        }
    }

    /// The configurations in which a step may end, after one that ends in a rectangle.
    fn region(&self, step: &Step, from: Option<&Rectangle>) -> Result<Region, CheckError> {
        let unknown = || CheckError::fails(format!("where step {} ends depends on what is not known", step.number));
        let tip_at = |place: Point| Ok(Region::tip(self.arm, place));
        match &step.action {
            // A step has no areas.
            Action::Move(Goal::Areas(_)) => unknown(),
            Action::Move(Goal::Tip(at)) => tip_at(at.each_ref().map(Interval::from)),
            Action::Move(Goal::Joints(values)) => Ok(Region::Configuration(self.arm.configuration("target", values)?)),
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
                        let mut origin = self.arm.tip.clone();
                        origin.shape.points = vec![self.chain.seen_at(&lying.at, &values(from))];
                        Ok(Region::Tip { tip: Rc::new(origin), place: at.clone() })
                    }
                    (_, Some(angle), _) => tip_at(sum(at, &turned(&grasp, &angle.sin_cos()))),
                    _ if grasp.iter().all(|c| c.is_whole(0)) => tip_at(at.clone()),
                    _ => unknown(),
                }
            }
        }
    }

    /// What is where while a step is done from a configuration in a rectangle.
    fn among(&self, picked: Option<usize>, from: &Rectangle) -> Among<'_> {
        let carried = self.held.as_ref().and_then(|held| {
            let (hanging, is_level) = match &held.hanging {
                Hanging::Level(hanging) => (hanging.clone(), true),
                Hanging::Taken(lying) => (self.chain.hung(lying, &values(from)), false),
                Hanging::Somehow => return None,
            };
            let object = &self.task.objects[held.object];
            let lift = Interval::from(&object.lift);
            let lying = self.world.obstacles[self.task.first + held.object].heights.as_ref();
            let heights = lying.map(|range| range.each_ref().map(|height| &Interval::from(height) + &lift));
            let supports = held.supports.clone();
            let pressed = (!supports.is_empty()).then(|| hanging.pressed(&self.pressed));
            Some(Carried { hanging, is_level, heights, supports, pressed })
        });
        let allowed = self.released.iter().copied().chain(picked).collect();
        Among { standing: self.standing.clone(), allowed, carried, lowered: None }
    }

    /// What is where while the tool is lowered where a step ends, but for what is picked; without a stroke, what is placed where it lies.
    fn lowered(&self, step: &Step, from: &Rectangle) -> Option<Among<'_>> {
        let stroke = self.task.stroke.as_ref();
        let object = match &step.action {
            Action::Pick { object, .. } if stroke.is_some() => *object,
            Action::Place { .. } => self.held.as_ref()?.object,
            Action::Pick { .. } | Action::Move(_) => return None,
        };
        let number = self.task.first + object;
        let mut among = self.among(None, from);
        among.standing[number] = None;
        // What was let go of before is not what the tool comes down on.
        among.allowed.clear();
        let lying = self.world.obstacles[number].heights.as_ref();
        if let (Some([least, most]), Some(lying)) = (among.carried.as_mut().and_then(|c| c.heights.as_mut()), lying) {
            let [low, high] = lying.each_ref().map(Interval::from);
            *least = if stroke.is_none() || low.upper < least.upper { low } else { least.clone() };
            *most = if stroke.is_none() || high.lower > most.lower { high } else { most.clone() };
        }
        let by = |travel: &Option<Decimal>| travel.as_ref().unwrap_or(&self.task.objects[object].lift).clone();
        among.lowered = stroke.map(|Stroke { joint, travel }| (&**joint, by(travel)));
        Some(among)
    }

    /// The places of which one follows on a pick: as in the file, but where only one of the two is repeated any.
    fn placing(&self, pick: &Step) -> Vec<&'a Step> {
        let places = || self.steps.iter().copied().filter(|step| matches!(step.action, Action::Place { .. }));
        let next = places().find(|place| place.number > pick.number);
        let with = |place: &Step| {
            self.repeated.iter().all(|group| group.contains(&pick.number) == group.contains(&place.number))
        };
        match next {
            Some(place) if with(place) => vec![place],
            None if self.repeated.iter().all(|group| !group.contains(&pick.number)) => Vec::new(),
            _ => places().collect(),
        }
    }

    /// Takes a step as done.
    fn after(&mut self, step: &'a Step) {
        let first = self.task.first;
        self.released = Vec::new();
        match &step.action {
            Action::Pick { object, grasp, supports, .. } => {
                let lying = self.standing[first + object].take();
                let Carrying { supports, may_turn } = self.task.carrying(*object, supports, self.placing(step));
                // What nothing turns is level.
                let slides = |joint: &Joint| matches!(joint.motion, Motion::Slide(_));
                let is_level = self.task.objects[*object].is_level || self.arm.joints.iter().all(slides);
                let hanging = match (lying, is_level) {
                    (Some(lying), false) => Hanging::Taken(lying.into_owned()),
                    (Some(lying), true) if !may_turn => {
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
                self.released = vec![number];
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
