//! Checks a task by repeating its steps in order.

mod arch;
mod held;
mod turning;

use super::order::MatchedStep;
use crate::robot::Robot;
use crate::robot::tool::{LiftAxis, displaced, heights_to, penetration_depth_allowed, swept_heights};
use crate::world::task::{Action, RESTING_DECIMALS, Step, Task};
use arch::EndCurves;
use cplan_check::arm::Arm;
use cplan_check::certificate::Motion;
use cplan_check::curve::Piece;
use cplan_check::decimal::Decimal;
use cplan_check::ends::missed;
use cplan_check::free::{Attachment, Chain, Edge, Solid, guard};
use cplan_check::interval::{Interval, Point};
use cplan_check::motion::piece;
use cplan_check::obstacle::Obstacle;
use cplan_check::scene::{Part, PlacedObstacle, check_parts_clear};
use cplan_check::shapes::CollisionShape;
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use held::HeldObject;
use num_bigint::BigInt;
use std::collections::BTreeMap;
use std::iter;
use std::ops::Range;

/// The condition that a carried object must satisfy at an obstacle.
#[derive(PartialEq)]
enum ContactRule {
    Off,
    /// The obstacle is a support, into which the object may press up to the allowed depth.
    Pressed,
    /// The object must keep away in all orientations about the tip. This applies to a level object and a link that
    /// joint 1 carries, because such a link turns relative to the object.
    Round,
}

/// The state of the task between two steps.
pub(super) struct Replay<'a> {
    arm: &'a Arm,
    task: &'a Task,
    motion: &'a Motion,
    chain: Chain,
    tip: Point,
    /// Shapes of the arm. The flag is true if the stroke lowers the shape.
    shapes: Vec<(&'a CollisionShape, Solid, bool)>,
    /// Required distance of the shapes from obstacles; `keeps` describes it in words.
    kept: BigInt,
    keeps: String,
    /// Depth to which the carried object may press into its supports.
    pressed: Interval,
    /// Obstacles and objects in their current state, then moving obstacles, then links of the robot. `None` stands for
    /// the carried object.
    present: Vec<Option<PlacedObstacle>>,
    /// All obstacles and links in their initial state.
    all: Vec<&'a Obstacle>,
    /// The last knot of the previous step.
    knot: usize,
    held: Option<HeldObject>,
    /// The joint that lowers the tool.
    lift: Option<LiftAxis>,
    /// The stroke and the turn after the previous step, if they end during the next motion.
    before: EndCurves,
    /// Height of the lowered tool at the start and at the goal, relative to the raised tool. `None` if the tool is
    /// raised there, or has been raised since.
    lowered: [Option<Interval>; 2],
    /// Height of each object, relative to its initial height, where it lies or was picked, metres.
    elevations: Vec<Decimal>,
    /// Height of the current step's object, relative to its initial height, at the pick or the place, metres.
    elevation: Decimal,
    /// Objects that lie at other heights than initially, by their indices among the obstacles.
    elevated: BTreeMap<usize, Obstacle>,
    /// Index among the obstacles of the object that was released last. `None` if it must no longer be touched.
    released: Option<usize>,
    /// Greatest deviation so far of an object or the tip from its required place.
    pub(super) off: BigInt,
}

/// The heights at which shapes are checked.
#[derive(Clone, Copy, PartialEq)]
enum ToolHeights<'a> {
    /// The shapes' own heights.
    Raised,
    /// All heights during the stroke.
    Swept,
    /// The final pose of the carried object.
    Lying,
    /// The heights while the tool is in a range above its raised position. Only shapes that the stroke lowers are checked.
    At(&'a [Decimal; 2]),
}

/// Returns the least range that contains all of these.
fn spanned(ranges: &[[Decimal; 2]]) -> [Decimal; 2] {
    let mut spanned = ranges[0].clone();
    for [low, high] in &ranges[1..] {
        let [least, most] = spanned;
        spanned = [least.min(low.clone()), most.max(high.clone())];
    }
    spanned
}

impl<'a> Replay<'a> {
    pub(super) fn new(
        robot: &'a Robot,
        world: &'a World,
        task: &'a Task,
        motion: &'a Motion,
        clearance: &Decimal,
    ) -> Result<Self, CheckError> {
        let arm = &robot.arm;
        let chain = Chain::from(arm);
        let kept = Interval::from(clearance).upper + guard();
        let shape = |shape: &'a CollisionShape| {
            let around = &shape.around;
            let is_lowered = task.stroke.as_ref().map_or(Ok(false), |stroke| robot.lowers(&stroke.joint, shape))?;
            Ok((shape, Solid::new(&chain, Attachment::Link(around.link), &around.shape, &kept), is_lowered))
        };
        let shapes = arm.shapes.iter().map(shape).collect::<Result<_, CheckError>>()?;
        let present =
            world.all().chain(&arm.own).map(|obstacle| PlacedObstacle::new(&chain, obstacle.clone()).map(Some));
        let present = present.collect::<Result<_, _>>()?;
        let lift = task.stroke.as_ref().map(|stroke| robot.lift_axis(&stroke.joint)).transpose()?;
        let height = |value: &Decimal| match &lift {
            Some(lift) => Ok(lift.height(value)),
            None => Err(CheckError::in_file(Input::World, "the tool is lowered, but [robot] has no `stroke`")),
        };
        let [start, goal] = task.lowered.each_ref().map(|value| value.as_ref().map(height).transpose());
        Ok(Self {
            arm,
            task,
            motion,
            tip: arm.tip.shape.points[0].clone(),
            keeps: format!("farther than {clearance} from"),
            pressed: Interval::exact(penetration_depth_allowed(arm).lower - guard()),
            chain,
            shapes,
            kept,
            present,
            all: world.all().chain(&arm.own).collect(),
            knot: 0,
            held: None,
            lift,
            before: EndCurves::default(),
            lowered: [start?, goal?],
            elevations: vec![Decimal::whole(0); task.objects.len()],
            elevation: Decimal::whole(0),
            elevated: BTreeMap::new(),
            released: None,
            off: BigInt::ZERO,
        })
    }

    /// Returns the time of a knot, seconds after the start of the motion.
    fn time(&self, knot: usize) -> Decimal {
        &self.motion.knots[knot][0] - &self.motion.knots[0][0]
    }

    /// Returns the pieces of the motion from one knot to another, or a motion at rest if both are the same.
    fn pieces(&self, knots: Range<usize>) -> Result<Vec<Piece>, CheckError> {
        let until = &self.motion.knots[..=knots.end];
        let piece = |knot: usize| piece(self.arm, &self.motion.interpolation, until, knot);
        (knots.start..knots.end.max(knots.start + 1)).map(piece).collect()
    }

    /// Checks a step, and updates the state. `after` has the steps that follow.
    pub(super) fn step(&mut self, matched: &MatchedStep, after: &[MatchedStep]) -> Result<(), CheckError> {
        let MatchedStep { step, done, renewed, line } = matched;
        // Objects return to their initial poses only after the arm has rested.
        if !renewed.is_empty() {
            let at = [1, 2].map(|k| Interval::from(&self.motion.knots[self.knot][k]));
            self.free(&self.pieces(self.knot..done.knots[0])?, &at, None, ToolHeights::Raised)?;
            // While the tool still rises, these objects count at both places.
            let pieces = self.pieces(done.knots[0]..done.knots[1])?;
            let before = std::mem::take(&mut self.before);
            self.free_during_overlaps([&before, &EndCurves::default()], &pieces, None)?;
            self.before = before;
        }
        for object in renewed {
            let number = self.task.first + object;
            if self.held.as_ref().is_some_and(|held| held.object == *object) {
                return CheckError::fails("an object is renewed while the tool carries it");
            }
            if self.all[number].trajectory.is_some() {
                return CheckError::fails("a moving object cannot be renewed");
            }
            self.present[number] = Some(PlacedObstacle::new(&self.chain, self.all[number].clone())?);
            self.elevated.remove(&number);
            self.elevations[*object] = Decimal::whole(0);
            // A renewed object is another object than the released one, so it must not be touched.
            self.released = self.released.filter(|released| *released != number);
        }
        self.elevation = self.elevation_of(step);
        // Between two motions, the arm stays where the first one ends.
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
        self.free(&pieces, &from, target, ToolHeights::Raised)?;
        self.raise_first(done, &from)?;
        let [own, next] = self.overlaps(matched, after.first())?;
        let before = std::mem::replace(&mut self.before, next);
        let moving = self.pieces(done.knots[0]..last)?;
        self.free_during_overlaps([&before, &own], &moving, target)?;
        if let Some(elbow) = step.elbow {
            elbow.of_arm(self.arm)?;
            elbow.check_knot(self.arm, &motion.knots[last])?;
        }
        match &step.action {
            Action::Pick { object, grasp, supports, passing } => {
                let places = |step: &&Step| matches!(step.action, Action::Place { .. });
                let placing = after.iter().map(|next| next.step).find(places);
                let carrying = self.task.carrying(*object, supports, placing);
                self.grasp(*object, grasp, carrying, &to, (time, passing))?;
                self.free(&still, &to, None, ToolHeights::Swept)?;
                self.turn(done, &to)?;
            }
            Action::Place { at, angle, .. } => {
                self.turn(done, &to)?;
                let tool = if self.task.stroke.is_some() { ToolHeights::Swept } else { ToolHeights::Lying };
                self.free(&still, &to, None, tool)?;
                self.release(at, angle.as_ref(), &to)?;
            }
            Action::Move(_) | Action::MoveToLine | Action::Follow(_) => {
                let next_line = after.first().and_then(|next| next.line.as_ref());
                match (&step.action, next_line, line) {
                    (Action::Move(goal), ..) => {
                        goal.check_elbow(self.arm, &motion.knots[last])?;
                        self.misses(self.arm.error_bound(&motion.knots[last], goal))?;
                    }
                    (Action::MoveToLine, Some(line), _) => {
                        self.misses(line.distance_from_start(self.arm, &motion.knots[last]))?;
                    }
                    (_, _, Some(line)) => line.check(self.arm, &moving)?,
                    _ => return CheckError::fails("the line is missing"),
                }
                self.turn(done, &to)?;
                if let Some(height) = self.lowered[1].as_ref().filter(|_| after.is_empty()) {
                    self.require_static("a stroke of the tool")?;
                    self.free(&still, &to, None, ToolHeights::At(&heights_to(height)))?;
                }
                self.released = None;
            }
        }
        // After the last step, the arm stays there, and the exemptions of that step still apply.
        if let Some(rest) = rest {
            self.free(&rest, &to, released, ToolHeights::Raised)?;
        }
        Ok(())
    }

    /// Returns the height of a step's object, relative to its initial height, at the pick or the place, metres.
    fn elevation_of(&self, step: &Step) -> Decimal {
        match (&step.action, &self.held) {
            (Action::Pick { object, .. }, _) => self.elevations[*object].clone(),
            (Action::Place { height, .. }, Some(held)) => {
                let heights = self.all[self.task.first + held.object].heights.as_ref();
                let stated = height.as_ref().zip(heights).map(|(height, [low, _])| height - low);
                stated.unwrap_or_else(|| self.elevations[held.object].clone())
            }
            _ => Decimal::whole(0),
        }
    }

    /// Returns an obstacle with its present heights.
    fn obstacle(&self, number: usize) -> &Obstacle {
        self.elevated.get(&number).unwrap_or(self.all[number])
    }

    fn misses(&mut self, off: BigInt) -> Result<(), CheckError> {
        missed("target", &off)?;
        self.off = off.max(std::mem::take(&mut self.off));
        Ok(())
    }

    /// Returns the condition that the carried object must satisfy at an obstacle. `None` if they cannot collide.
    fn meets(&self, held: &HeldObject, obstacle: usize, tool: ToolHeights) -> Option<ContactRule> {
        let own = self.task.first + held.object;
        let (heights, others) = (self.all[own].heights.as_ref(), self.obstacle(obstacle).heights.as_ref());
        if let (Some(initial), Some([low, high])) = (heights, others) {
            let lift = &self.task.objects[held.object].lift;
            let carried = initial.each_ref().map(|height| height + lift);
            let lying = initial.each_ref().map(|height| height + &self.elevation);
            let picked = initial.each_ref().map(|height| height + &self.elevations[held.object]);
            let [least, most] = match tool {
                ToolHeights::Raised => carried,
                ToolHeights::Lying => lying,
                // The object follows the tool.
                ToolHeights::At([below, above]) if self.task.depth(held.object) == Some(lift) => {
                    [&carried[0] + below, &carried[1] + above]
                }
                ToolHeights::Swept => spanned(&[lying, carried]),
                ToolHeights::At(_) => spanned(&[lying, carried, picked]),
            };
            if most < *low || *high <= &least + &Decimal::power_of_ten(RESTING_DECIMALS) {
                return None;
            }
        }
        // A moving obstacle may be elsewhere when the object arrives, so this check skips it.
        let moves = |present: &PlacedObstacle| present.obstacle.trajectory.is_some();
        if tool == ToolHeights::Lying && self.present[obstacle].as_ref().is_some_and(moves) {
            return None;
        }
        (obstacle != own).then(|| match held.carrying.supports.contains(&obstacle) {
            true => ContactRule::Pressed,
            false if held.round.is_some() && self.all[obstacle].is_carried() => ContactRule::Round,
            false => ContactRule::Off,
        })
    }

    /// Returns the parts of the carried object that must keep away from obstacles.
    fn hanging<'h>(&'h self, held: &'h HeldObject, solids: &'h [Vec<Solid>; 2], tool: ToolHeights) -> Vec<Part<'h>> {
        let all = 0..self.present.len();
        let part = |solid, keeps, manner: ContactRule| {
            let is_met = |obstacle| self.meets(held, obstacle, tool).is_some_and(|of| of == manner);
            let meets = all.clone().map(is_met).collect();
            Part { name: "the payload".to_owned(), keeps, solid, meets }
        };
        let [others, supports] = solids;
        let supported = supports.iter().map(|solid| part(solid, "within the allowed depth in", ContactRule::Pressed));
        let round = held.round.iter().map(|solid| part(solid, &*self.keeps, ContactRule::Round));
        others.iter().map(|solid| part(solid, &*self.keeps, ContactRule::Off)).chain(supported).chain(round).collect()
    }

    /// Checks, when the motion of a carried object begins, that no obstacle is inside the object, and that no support
    /// is inside the part of the object that must keep away from supports.
    fn require_outside(
        &self,
        held: &HeldObject,
        values: &Point,
        time: &Decimal,
        tool: ToolHeights,
    ) -> Result<(), CheckError> {
        let of_second = [Interval::whole(0), values[1].clone()];
        let pressed = held.pressed.iter().map(|own| (own, ContactRule::Pressed));
        for (hanging, manner) in iter::once((&held.hanging, ContactRule::Off)).chain(pressed) {
            let [lying, beside] =
                [values, &of_second].map(|at| self.chain.attached_obstacle_in_plane(&held.on, hanging, at));
            for (number, present) in self.present.iter().enumerate() {
                if self.meets(held, number, tool).is_some_and(|of| of == manner) {
                    let lying = if self.all[number].is_carried() { &beside } else { &lying };
                    let mut edges = present.iter().flat_map(|present| &present.edges);
                    let side = |edge: &Edge| edge.side_during(&self.chain, [time, time]).point().clone();
                    if edges.any(|edge| lying.surrounds(&side(edge), &guard()) != Some(false)) {
                        return CheckError::fails(format!("{} is inside the payload", self.all[number].called(number)));
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns true if a shape of the second link is at the height of an obstacle while the tool is raised.
    fn is_at_raised_height(&self, obstacle: usize) -> bool {
        let heights = self.obstacle(obstacle).heights.as_ref();
        let mut bodies = self.shapes.iter().map(|(shape, ..)| &shape.around).filter(|body| body.link == 1);
        bodies.any(|body| !body.misses_heights(heights))
    }

    /// Checks that arm and load are free on pieces of motion that begin in the configuration `from`. The second link
    /// may touch the object that was released last, and the obstacle with the index `also`.
    fn free(&self, pieces: &[Piece], from: &Point, also: Option<usize>, tool: ToolHeights) -> Result<(), CheckError> {
        let heights = match (tool, &self.held) {
            (ToolHeights::Raised | ToolHeights::Lying, _) => None,
            (ToolHeights::At(heights), _) => Some(heights.clone()),
            (ToolHeights::Swept, held) => {
                let Some(by) = held.as_ref().and_then(|held| self.task.depth(held.object)) else { return Ok(()) };
                self.require_static("a stroke of the tool")?;
                Some(swept_heights(&(by - &self.elevation)))
            }
        };
        let is_partial = matches!(tool, ToolHeights::At(_));
        let mut touched: Vec<usize> = self.released.into_iter().chain(also).collect();
        touched.retain(|number| !is_partial || self.is_at_raised_height(*number));
        let own = |shape| {
            let (counted, solid, is_lowered): &(&CollisionShape, Solid, bool) = shape;
            let body = &counted.around;
            let lowered = heights.as_ref().filter(|_| *is_lowered).map(|heights| displaced(counted, heights));
            let heights = lowered.as_ref().unwrap_or(body);
            let meets = |number: usize| {
                let is_allowed = body.link == 1 && touched.contains(&number);
                !is_allowed && counted.meets(heights, self.obstacle(number))
            };
            let meets = (0..self.all.len()).map(meets).collect();
            Part { name: counted.to_string(), keeps: &self.keeps, solid, meets }
        };
        let counted = self.shapes.iter().filter(|(.., is_lowered)| *is_lowered || !is_partial);
        let mut parts: Vec<Part> = counted.map(own).collect();
        if let Some(held) = &self.held {
            parts.extend(self.hanging(held, &held.solids, tool));
            self.require_outside(held, from, &pieces[0].time[0], tool)?;
        }
        check_parts_clear(&self.chain, pieces, from, &parts, &self.present)
    }
}
