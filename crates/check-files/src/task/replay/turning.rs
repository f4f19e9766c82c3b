//! Turns of the wrist while the arm moves.

use super::arch::EndCurves;
use super::held::HeldObject;
use super::{Replay, ToolHeights};
use crate::task::order::MatchedStep;
use crate::task::stroke::StrokeCurve;
use crate::world::carried_shapes;
use crate::world::task::Action;
use cplan_check::CheckError;
use cplan_check::curve::{FRACTION_BITS, MAX_PRIOR_HALVINGS, Piece};
use cplan_check::free::{Solid, guard};
use cplan_check::interval::{BITS, Interval, Point, length, turned};
use cplan_check::obstacle::Obstacle;
use cplan_check::overlap::Shape;
use cplan_check::scene::check_parts_clear;
use num_bigint::BigInt;

/// Greatest angle, radians, for which a hull covers the rotations of an object. For greater angles, a disc covers them.
/// It is below half a turn, as the hull requires.
const MAX_HULL_ANGLE: i32 = 1;

/// Greatest angle, radians, by which a wrist turns during a motion.
const MAX_TURN: i32 = 7;

/// Reason for refusing a turn that is not between the strokes of two steps.
const TURNS_LOWERED: &str = "a turn of the wrist overlaps with a stroke of the tool or with another turn";

/// A turn during a motion, and the angle at which the object is when the whole motion is checked.
struct Window<'a> {
    turn: &'a StrokeCurve,
    /// Angle of the object, relative to the beginning of the turn, at which the whole motion is checked.
    checked_at: Interval,
}

impl Replay<'_> {
    /// Reads the turn of a step that overlaps with a motion. Checks that the world allows it, and that the motion
    /// precedes a place or follows a pick.
    pub(super) fn turn_on_the_way(
        &self,
        matched: &MatchedStep,
        next: Option<&MatchedStep>,
    ) -> Result<Option<(StrokeCurve, Interval)>, CheckError> {
        let MatchedStep { step, done, .. } = matched;
        let Some(knots) = &done.turning else { return Ok(None) };
        let Some(by) = &done.turn else { return CheckError::fails("this step has \"turning\" without \"turn\"") };
        if !self.task.wrist.as_ref().is_some_and(|wrist| wrist.turns_on_the_way) {
            return CheckError::fails(
                "a turn of the wrist overlaps with a motion, but the world requires the arm to rest during turns",
            );
        }
        self.require_static("a turn of the wrist")?;
        let angle = Interval::from(by);
        if angle.magnitude() > Interval::whole(MAX_TURN).lower {
            return CheckError::fails("the wrist turns by more than one revolution");
        }
        let wrong = |why: &str| CheckError::fails(format!("the turn of the wrist is wrong: {why}"));
        let turn = match StrokeCurve::turn(knots, &self.motion.knots[0][0], by) {
            Err(CheckError::Fails(why)) => return wrong(&why),
            other => other?,
        };
        let none = Interval::whole(0);
        let [departure, arrival] = done.knots.map(|knot| self.time(knot));
        let next = next.map(|next| next.done.knots.map(|knot| self.time(knot)));
        match (&step.action, next) {
            (Action::Place { .. }, next) => {
                if !turn.is_at(&departure, &none) {
                    return wrong("the turn begins before the motion to the place");
                }
                if next.is_some_and(|[departure, _]| !turn.is_at(&departure, &angle)) {
                    return wrong("the turn ends after the departure from the place");
                }
            }
            (Action::Pick { .. }, Some([_, next_arrival])) => {
                if !turn.is_at(&arrival, &none) {
                    return wrong("the turn begins before the arrival at the pick");
                }
                if !turn.is_at(&next_arrival, &angle) {
                    return wrong("the turn ends after the motion from the pick");
                }
            }
            _ => return wrong("a turn must be before a place, or after a pick that another step follows"),
        }
        Ok(Some((turn, angle)))
    }

    /// Returns the strokes that overlap with motions, lowering first, and the turn. Checks that the tool is raised
    /// during the turn.
    pub(super) fn with_turn(
        &self,
        matched: &MatchedStep,
        [lowering, raising]: [Option<StrokeCurve>; 2],
        turn: Option<(StrokeCurve, Interval)>,
    ) -> Result<[EndCurves; 2], CheckError> {
        let MatchedStep { step, .. } = matched;
        let is_place = matches!(step.action, Action::Place { .. });
        if let Some((turn, angle)) = &turn {
            let is_raised = match is_place {
                true => lowering.as_ref().is_none_or(|lowering| turn.is_at(lowering.begin(), angle)),
                false => raising.as_ref().is_none_or(|raising| turn.is_at(raising.end(), &Interval::whole(0))),
            };
            if !is_raised {
                return CheckError::fails(TURNS_LOWERED);
            }
        }
        let (own, next) = if is_place { (turn, None) } else { (None, turn) };
        Ok([EndCurves { stroke: lowering, turn: own }, EndCurves { stroke: raising, turn: next }])
    }

    /// Calls a check with the carried object turned about the tip by an angle, radians.
    pub(super) fn with_object_turned(
        &mut self,
        angle: Option<&Interval>,
        check: impl FnOnce(&Self) -> Result<(), CheckError>,
    ) -> Result<(), CheckError> {
        let Some((angle, held)) = angle.zip(self.held.as_ref()) else { return check(self) };
        let turned = self.turned_copy(held, angle)?;
        let held = self.held.replace(turned);
        let checked = check(self);
        self.held = held;
        checked
    }

    /// Checks the carried object during turns that overlap with the beginning and the end of a motion. `pieces` are the
    /// motion from departure to arrival.
    ///
    /// The motion was checked with the object at the angle that it has between the two turns. At one end of each turn,
    /// the object has that angle. During the turn, its border touches no obstacle, so neither the object nor an
    /// obstacle can get inside the other.
    pub(super) fn free_during_turns(&self, [before, own]: [&EndCurves; 2], pieces: &[Piece]) -> Result<(), CheckError> {
        let none = Interval::whole(0);
        let ends_before = |(turn, angle): &(StrokeCurve, Interval), next: &Option<&StrokeCurve>| {
            next.is_none_or(|next| turn.is_at(next.begin(), angle))
        };
        let next = [own.stroke.as_ref(), own.turn.as_ref().map(|(turn, _)| turn)];
        let is_first = before.turn.as_ref().is_none_or(|turn| next.iter().all(|next| ends_before(turn, next)));
        let begins_after = |(turn, _): &(StrokeCurve, Interval)| {
            before.stroke.as_ref().is_none_or(|raising| turn.is_at(raising.end(), &none))
        };
        if !is_first || !own.turn.as_ref().is_none_or(begins_after) {
            return CheckError::fails(TURNS_LOWERED);
        }
        if let Some((turn, angle)) = &before.turn {
            let until = pieces.partition_point(|piece| piece.time[0] < *turn.end());
            let window = Window { turn, checked_at: angle.clone() };
            self.free_at_angles(&window, &pieces[..until], 0)?;
        }
        if let Some((turn, _)) = &own.turn {
            let from = pieces.partition_point(|piece| piece.time[1] <= *turn.begin());
            let window = Window { turn, checked_at: none };
            self.free_at_angles(&window, &pieces[from..], 0)?;
        }
        Ok(())
    }

    /// Checks pieces of motion during a turn, first with all angles that the turn has in this time. If that fails,
    /// checks both halves. `halvings` is the number of times that a piece was halved.
    fn free_at_angles(&self, window: &Window, pieces: &[Piece], halvings: u32) -> Result<(), CheckError> {
        let ([first, ..], [.., last], Some(held)) = (pieces, pieces, &self.held) else { return Ok(()) };
        let [low, high] = window.turn.range([&first.time[0], &last.time[1]]);
        let angles = [low, high].map(|angle| &Interval::from(&angle) - &window.checked_at);
        let from = first.curves[0][0].map(|value| Interval::exact(BigInt::from(value) << (BITS - FRACTION_BITS)));
        let checked = self.free_covered(held, &angles, pieces, &from);
        let Err(CheckError::Fails(why)) = checked else { return checked };
        if let [piece] = pieces {
            if halvings == MAX_PRIOR_HALVINGS {
                return CheckError::fails(format!("during a turn of the wrist, {why}"));
            }
            let halves = piece.halves();
            return halves
                .iter()
                .try_for_each(|half| self.free_at_angles(window, std::slice::from_ref(half), halvings + 1));
        }
        let (first, second) = pieces.split_at(pieces.len() / 2);
        [first, second].into_iter().try_for_each(|half| self.free_at_angles(window, half, halvings))
    }

    /// Checks that the carried object is free on pieces of motion, at all angles between two angles relative to its
    /// current orientation.
    fn free_covered(
        &self,
        held: &HeldObject,
        angles: &[Interval; 2],
        pieces: &[Piece],
        from: &Point,
    ) -> Result<(), CheckError> {
        let solids = |own: &Obstacle, kept: &BigInt| -> Result<Vec<Solid>, CheckError> {
            let shapes = carried_shapes::solids(own)?;
            Ok(shapes.iter().map(|s| Solid::new(&self.chain, held.on.clone(), &cover(s, angles), kept)).collect())
        };
        let own = solids(&held.hanging, &self.kept)?;
        let pressed = held.pressed.as_ref().map_or(Ok(Vec::new()), |own| solids(own, &guard()))?;
        let both = [own, pressed];
        let parts = self.hanging(held, &both, ToolHeights::Raised);
        check_parts_clear(&self.chain, pieces, from, &parts, &self.present)
    }
}

/// Returns a shape that covers all rotations of a shape about the origin from one angle to another.
///
/// A point of the shape's core is a mean of its corners, so in each rotation it is the same mean of the rotated corners.
/// A corner at distance `r` moves along an arc, which leaves the chord between its ends by at most `r (1 - cos(w / 2))`,
/// where `w` is the angle of the arc, up to half a turn. So each rotated core is within that distance of the hull of the
/// core at both angles.
fn cover(shape: &Shape, [from, to]: &[Interval; 2]) -> Shape {
    let farthest = shape.points.iter().map(|point| length(point).upper).max().unwrap_or_default();
    let width = (to - from).magnitude();
    if width > Interval::whole(MAX_HULL_ANGLE).lower {
        let radius = &Interval::exact(farthest) + &shape.radius;
        return Shape { points: vec![[0, 0].map(Interval::whole)], radius: Interval::exact(radius.upper) };
    }
    let [_, cosine] = Interval::exact(width).half().sin_cos();
    let sagitta = &Interval::exact(farthest) * &(&Interval::whole(1) - &cosine);
    let points = [from, to].into_iter().flat_map(|angle| {
        let angle = angle.sin_cos();
        shape.points.iter().map(|point| turned(point, &angle)).collect::<Vec<_>>()
    });
    let radius = &shape.radius + &sagitta;
    Shape { points: points.collect(), radius: Interval { lower: shape.radius.lower.clone(), upper: radius.upper } }
}
