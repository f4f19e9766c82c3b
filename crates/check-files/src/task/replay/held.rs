//! The carried object: picked, turned and released.

use super::{ContactRule, Replay, ToolHeights};
use crate::world::carried_shapes;
use crate::world::task::{CarryRules, MovingPick};
use cplan_check::CheckError;
use cplan_check::certificate::ExecutedStep;
use cplan_check::curve::{FRACTION_BITS, Piece};
use cplan_check::decimal::Decimal;
use cplan_check::free::{Attachment, Chain, Solid, guard};
use cplan_check::interval::{Interval, Point, both_turns, length, minus, turned};
use cplan_check::motion::{CONTROL_POINT_FACTOR, fine};
use cplan_check::obstacle::Obstacle;
use cplan_check::overlap::Shape;
use cplan_check::polygon::Corner;
use cplan_check::scene::{PlacedObstacle, check_parts_clear};
use num_bigint::BigInt;
use std::iter;

/// Number of decimals of the greatest distance of a moving object from its required position at the pick: `10^-3` m.
const PICK_TOLERANCE_DECIMALS: u32 = 3;

/// Greatest turn of the wrist in either direction, radians. More than one full turn is implausible.
const MAX_WRIST_TURN: i128 = 7;

pub(super) struct HeldObject {
    pub(super) object: usize,
    pub(super) on: Attachment,
    /// The object in the frame to which it is attached. `pressed` is the part of the object that must keep away from
    /// supports, or `None` if there are no supports.
    pub(super) hanging: Obstacle,
    pub(super) pressed: Option<Obstacle>,
    /// Shapes of `hanging`, and shapes of `pressed`.
    pub(super) solids: [Vec<Solid>; 2],
    /// A disc that covers the object in all orientations about the tip, if it is held level.
    pub(super) round: Option<Solid>,
    pub(super) carrying: CarryRules,
}

impl Replay<'_> {
    /// Returns the shapes of an attached object, and those of the part that must keep away from supports.
    fn attached_shapes(
        &self,
        chain: &Chain,
        on: &Attachment,
        hanging: &Obstacle,
        (pressed, supports): (Option<&Obstacle>, &[usize]),
    ) -> Result<[Vec<Solid>; 2], CheckError> {
        let solids = |own: &Obstacle, kept: &BigInt| {
            carried_shapes::solids(own)
                .map(|all| all.iter().map(|shape| Solid::new(chain, on.clone(), shape, kept)).collect())
        };
        // Supports are grown by their own clearance, which objects that rest on them need not keep.
        let grown = supports.iter().map(|support| &self.all[*support].grown[1].lower).min();
        let kept = guard() - grown.cloned().unwrap_or_default();
        Ok([solids(hanging, &self.kept)?, pressed.map_or(Ok(Vec::new()), |own| solids(own, &kept))?])
    }

    /// Returns a disc about the tip that covers a level object in all orientations.
    fn round(&self, hanging: &Obstacle) -> Result<Solid, CheckError> {
        let all = carried_shapes::solids(hanging)?;
        let reach = |shape: &Shape| {
            let points = shape.points.iter().map(length);
            points.map(|off| off.upper + &shape.radius.upper).max()
        };
        let radius = Interval::exact(all.iter().filter_map(reach).max().unwrap_or_default());
        let disc = Shape { points: vec![self.tip.clone()], radius };
        Ok(Solid::new(&self.chain, Attachment::Link(1), &disc, &self.kept))
    }

    /// Checks that the world has no moving obstacles. For actions that are not checked in time; `what` names the action.
    pub(super) fn require_static(&self, what: &str) -> Result<(), CheckError> {
        let moves = |present: &PlacedObstacle| present.obstacle.trajectory.is_some();
        match self.present.iter().flatten().any(moves) {
            true => CheckError::fails(format!("the checker does not judge {what} among moving obstacles or objects")),
            false => Ok(()),
        }
    }

    /// Picks an object, which may move, at the pose that it has at a time. The tip is at the position `at`.
    pub(super) fn grasp(
        &mut self,
        object: usize,
        grasp: &Corner,
        carrying: CarryRules,
        at: &Point,
        (time, passing): (&Decimal, &MovingPick),
    ) -> Result<(), CheckError> {
        let (None, Some(present)) = (&self.held, self.present[self.task.first + object].take()) else {
            return CheckError::fails("an object is picked while the tool carries another");
        };
        let lying = present.obstacle.at_time(time).into_owned();
        if passing.window.as_ref().is_some_and(|[low, high]| time < low || high < time) {
            return CheckError::fails("the object is picked outside its time window");
        }
        let near = Interval::from(&Decimal::power_of_ten(PICK_TOLERANCE_DECIMALS)).lower;
        if passing.at.as_ref().is_some_and(|at| length(&minus(&lying.at, at)).upper > near) {
            return CheckError::fails("at the time of the pick, the object is not at the stated place");
        }
        let tip = self.chain.point_at(&Attachment::Link(1), &self.tip, at);
        self.misses(length(&minus(&tip, &lying.placed(&grasp.each_ref().map(Interval::from)))).upper)?;
        let (on, hanging, round) = if self.task.objects[object].is_level {
            let (at, turn) = (minus(&lying.at, &tip), lying.turn.clone());
            let hanging = lying.moved(at, turn);
            let round = self.round(&hanging)?;
            (Attachment::Level(self.tip.clone()), hanging, Some(round))
        } else {
            (Attachment::Link(1), self.chain.obstacle_in_second_link(&lying, at), None)
        };
        let pressed = (!carrying.supports.is_empty())
            .then(|| carried_shapes::shrunk_object(&hanging, &self.pressed))
            .transpose()?;
        let solids = self.attached_shapes(&self.chain, &on, &hanging, (pressed.as_ref(), &carrying.supports))?;
        self.held = Some(HeldObject { object, on, hanging, pressed, solids, round, carrying });
        self.released = None;
        Ok(())
    }

    /// Releases the carried object.
    pub(super) fn release(&mut self, at: &Point, angle: Option<&Interval>, values: &Point) -> Result<(), CheckError> {
        let Some(held) = self.held.take() else {
            return CheckError::fails("an object is placed, but the tool carries none");
        };
        let lying = self.chain.attached_obstacle_in_plane(&held.on, &held.hanging, values);
        self.misses(length(&minus(&lying.at, at)).upper)?;
        if let Some(angle) = angle {
            self.misses(length(&minus(&lying.turn, &angle.sin_cos())).upper)?;
        }
        let number = self.task.first + held.object;
        let mut placed = self.all[number].clone();
        placed.heights = placed.heights.map(|heights| heights.each_ref().map(|height| height + &self.elevation));
        self.elevated.insert(number, placed);
        self.elevations[held.object] = self.elevation.clone();
        self.present[number] = Some(PlacedObstacle::new(&self.chain, lying)?);
        self.released = Some(number);
        Ok(())
    }

    /// Turns the carried object about the tip by the step's angle while the arm is at rest. A turn that overlaps with a
    /// motion must also be free with the arm at rest.
    pub(super) fn turn(&mut self, done: &ExecutedStep, at: &Point) -> Result<(), CheckError> {
        let Some(by) = &done.turn else { return Ok(()) };
        self.require_static("a turn of the wrist")?;
        let Some(mut held) =
            self.held.take_if(|held| held.carrying.may_turn && matches!(held.on, Attachment::Level(_)))
        else {
            return CheckError::fails(
                "the step turns an object, but there is no wrist, or the tool holds no level object",
            );
        };
        let wrist = Chain::turning_about(&self.chain.point_at(&Attachment::Link(1), &self.tip, at));
        let Some(end) = fine(&(by * &Decimal::whole(CONTROL_POINT_FACTOR)))
            .filter(|end| end.abs() < MAX_WRIST_TURN << FRACTION_BITS)
        else {
            return CheckError::fails("the wrist turns by more than one revolution");
        };
        let time = [0, 1].map(Decimal::whole);
        let swept = Piece { knot: done.knots[1], curves: vec![vec![[0, 0], [end, 0]]], time };
        let solids = self.attached_shapes(
            &wrist,
            &Attachment::Link(0),
            &held.hanging,
            (held.pressed.as_ref(), &held.carrying.supports),
        )?;
        let seen = |(number, present): (usize, &Option<PlacedObstacle>)| {
            // The disc about the tip was checked before.
            let meets = || self.meets(&held, number, ToolHeights::Raised).is_some_and(|of| of != ContactRule::Round);
            let met = present.as_ref().filter(|_| meets());
            met.map(|present| PlacedObstacle::new(&wrist, present.obstacle.clone())).transpose()
        };
        let present = self.present.iter().enumerate().map(seen).collect::<Result<Vec<_>, _>>()?;
        let parts = self.hanging(&held, &solids, ToolHeights::Raised);
        self.require_outside(&held, at, &swept.time[0], ToolHeights::Raised)?;
        check_parts_clear(&wrist, &[swept], &[0, 0].map(Interval::whole), &parts, &present)?;
        self.turn_object(&mut held, &Interval::from(by))?;
        self.held = Some(held);
        Ok(())
    }

    /// Returns a carried object turned about the tip by an angle, radians.
    pub(super) fn turned_copy(&self, held: &HeldObject, by: &Interval) -> Result<HeldObject, CheckError> {
        let mut turned = HeldObject {
            object: held.object,
            on: held.on.clone(),
            hanging: held.hanging.clone(),
            pressed: held.pressed.clone(),
            solids: [Vec::new(), Vec::new()],
            round: held.round.as_ref().map(|_| self.round(&held.hanging)).transpose()?,
            carrying: held.carrying.clone(),
        };
        self.turn_object(&mut turned, by)?;
        Ok(turned)
    }

    /// Turns a carried object about the tip by an angle, radians, without any check.
    pub(super) fn turn_object(&self, held: &mut HeldObject, by: &Interval) -> Result<(), CheckError> {
        let angle = by.sin_cos();
        for own in iter::once(&mut held.hanging).chain(&mut held.pressed) {
            own.at = turned(&own.at, &angle);
            own.turn = both_turns(&own.turn, &angle);
        }
        held.solids = self.attached_shapes(
            &self.chain,
            &held.on,
            &held.hanging,
            (held.pressed.as_ref(), &held.carrying.supports),
        )?;
        Ok(())
    }
}
