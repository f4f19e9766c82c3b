//! Arch motions: the tool is lowered or raised while the arm moves.

use super::{Replay, ToolHeights};
use crate::robot::tool::{LiftAxis, heights_to};
use crate::task::REST_TOLERANCE_DECIMALS;
use crate::task::order::MatchedStep;
use crate::task::stroke::StrokeCurve;
use crate::world::task::{Action, Arch};
use cplan_check::CheckError;
use cplan_check::certificate::ExecutedStep;
use cplan_check::curve::{FRACTION_BITS, MAX_PRIOR_HALVINGS, Piece};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point};
use num_bigint::BigInt;

/// The stroke and the turn that overlap with one end of a motion.
#[derive(Default)]
pub(super) struct EndCurves {
    /// The stroke that begins or ends during the motion.
    pub(super) stroke: Option<StrokeCurve>,
    /// The turn that begins or ends during the motion, and its angle.
    pub(super) turn: Option<(StrokeCurve, Interval)>,
}

impl Replay<'_> {
    /// Reads the strokes and the turn of a step that overlap with its own motion, or with the next one. Checks that the
    /// world allows them, and that the tool stays lowered for the step's dwell.
    pub(super) fn overlaps(
        &self,
        matched: &MatchedStep,
        next: Option<&MatchedStep>,
    ) -> Result<[EndCurves; 2], CheckError> {
        let MatchedStep { step, done, .. } = matched;
        let turn = self.turn_on_the_way(matched, next)?;
        let given = [&done.lowering, &done.raising];
        if given.iter().all(|knots| knots.is_none()) {
            return self.with_turn(matched, [None, None], turn);
        }
        let (object, is_place) = match (&step.action, &self.held) {
            (Action::Pick { object, .. }, _) => (*object, false),
            (Action::Place { .. }, Some(held)) => (held.object, true),
            (Action::Move(_), _) => {
                let stroke = self.lowering_at_goal(done, next)?;
                return self.with_turn(matched, [Some(stroke), None], turn);
            }
            _ => return CheckError::fails("this step has a stroke, but neither picks nor places an object"),
        };
        let (Some(axis), Some(depth)) = (&self.lift, self.task.depth(object)) else {
            return CheckError::fails("this step has a stroke, but the robot has no joint that lowers the tool");
        };
        let Some(arch) = self.task.stroke.as_ref().and_then(|stroke| stroke.arch.as_ref()) else {
            return CheckError::fails(
                "a stroke overlaps with a motion, but the world requires the arm to rest during strokes",
            );
        };
        if done.turn.is_some() && turn.is_none() && given[usize::from(!is_place)].is_some() {
            return CheckError::fails("a stroke overlaps with a motion, but the wrist turns in between");
        }
        if done.raising.is_some() && next.is_none() {
            return CheckError::fails("the raising overlaps with a motion, but the task ends with this step");
        }
        let (raised, lowered) = (Interval::whole(0), -&Interval::from(&(depth - &self.elevation)));
        let start = &self.motion.knots[0][0];
        let read = |knots: &Option<Vec<[Decimal; 3]>>, name: &str, ends: [&Interval; 2]| {
            let curve = knots.as_ref().map(|knots| StrokeCurve::new(knots, start, axis, ends)).transpose();
            curve.map_err(|error| match error {
                CheckError::Fails(why) => CheckError::Fails(format!("the {name} is wrong: {why}")),
                other => other,
            })
        };
        let lowering = read(&done.lowering, "lowering", [&raised, &lowered])?;
        let raising = read(&done.raising, "raising", [&lowered, &raised])?;
        // The arm rests from its arrival to its departure. For a part of this time, the tool must be lowered.
        let arrival = self.time(done.knots[1]);
        let departure = self.time(next.map_or(self.motion.knots.len() - 1, |next| next.done.knots[0]));
        let mut down = lowering.as_ref().map_or(&arrival, |lowering| lowering.end()).max(&arrival);
        let mut up = raising.as_ref().map_or(&departure, |raising| raising.begin()).min(&departure);
        match &turn {
            Some((turn, _)) if is_place => down = down.max(turn.end()),
            Some((turn, _)) => up = up.min(turn.begin()),
            None => {}
        }
        let tolerance = Decimal::power_of_ten(REST_TOLERANCE_DECIMALS);
        if &(up - down) + &tolerance < step.dwell {
            return CheckError::fails(format!("the tool is not lowered for {} s", step.dwell));
        }
        if let Some(lowering) = &lowering {
            if lowering.end() + &tolerance < arrival || !lowering.is_at(up, &lowered) {
                return CheckError::fails("the lowering does not end between the arrival of the arm and the raising");
            }
            if !lowering.is_away(&arrival, &lowered, &arch.fall) {
                return CheckError::fails(format!("the arm arrives with the tool lower than {} m", arch.fall));
            }
        }
        if let Some(raising) = &raising {
            if *raising.begin() > &departure + &tolerance || !raising.is_at(down, &lowered) {
                return CheckError::fails(
                    "the raising does not begin between the lowering and the departure of the arm",
                );
            }
            if !raising.is_away(&departure, &lowered, &arch.rise) {
                return CheckError::fails(format!("the arm departs before the tool has risen by {} m", arch.rise));
            }
        }
        self.with_turn(matched, [lowering, raising], turn)
    }

    /// Checks the stroke that raises the tool before the first step, if the tool is lowered at the start. `from` is the
    /// configuration there.
    pub(super) fn raise_first(&mut self, done: &ExecutedStep, from: &Point) -> Result<(), CheckError> {
        let lowered = self.lowered[0].take();
        let (Some(height), knot) = (lowered, done.knots[0]) else {
            return match done.raising_first {
                Some(_) => CheckError::fails("this step has a \"raising_first\", but the tool is raised at the start"),
                None => Ok(()),
            };
        };
        self.require_static("a stroke of the tool")?;
        let still = self.pieces(knot..knot)?;
        self.free(&still, from, None, ToolHeights::At(&heights_to(&height)))?;
        let Some(knots) = &done.raising_first else { return Ok(()) };
        let (axis, arch) = self.axis_and_arch()?;
        let curve = StrokeCurve::new(knots, &self.motion.knots[0][0], axis, [&height, &Interval::whole(0)])?;
        let tolerance = Decimal::power_of_ten(REST_TOLERANCE_DECIMALS);
        let departure = self.time(knot);
        if curve.begin() + &tolerance < Decimal::whole(0) || *curve.begin() > &departure + &tolerance {
            return CheckError::fails(
                "\"raising_first\" does not begin between the start and the departure of the arm",
            );
        }
        if !curve.is_away(&departure, &height, &arch.rise) {
            return CheckError::fails(format!("the arm departs before the tool has risen by {} m", arch.rise));
        }
        self.before.stroke = Some(curve);
        Ok(())
    }

    /// Returns the stroke that lowers the tool at the end of the motion to the goal.
    fn lowering_at_goal(&self, done: &ExecutedStep, next: Option<&MatchedStep>) -> Result<StrokeCurve, CheckError> {
        let (Some(knots), Some(height), None, None) = (&done.lowering, &self.lowered[1], &done.raising, next) else {
            return CheckError::fails("this step has a stroke, but neither picks nor places an object");
        };
        let (axis, arch) = self.axis_and_arch()?;
        let curve = StrokeCurve::new(knots, &self.motion.knots[0][0], axis, [&Interval::whole(0), height])?;
        let tolerance = Decimal::power_of_ten(REST_TOLERANCE_DECIMALS);
        let (arrival, end) = (self.time(done.knots[1]), self.time(self.motion.knots.len() - 1));
        if curve.end() + &tolerance < arrival || *curve.end() > &end + &tolerance {
            return CheckError::fails(
                "the lowering does not end between the arrival of the arm and the end of the motion",
            );
        }
        if !curve.is_away(&arrival, height, &arch.fall) {
            return CheckError::fails(format!("the arm arrives with the tool lower than {} m", arch.fall));
        }
        Ok(curve)
    }

    /// Returns the joint that lowers the tool, and the least heights for strokes during motions.
    fn axis_and_arch(&self) -> Result<(&LiftAxis, &Arch), CheckError> {
        let arch = self.task.stroke.as_ref().and_then(|stroke| stroke.arch.as_ref());
        match (&self.lift, arch) {
            (Some(axis), Some(arch)) => Ok((axis, arch)),
            _ => CheckError::fails(
                "a stroke overlaps with a motion, but the world requires the arm to rest during strokes",
            ),
        }
    }

    /// Checks the motion of a step with the strokes and turns that overlap with its beginning and its end. `pieces` are
    /// the motion from departure to arrival. The second link may touch the obstacle with the index `also`.
    pub(super) fn free_during_overlaps(
        &mut self,
        [before, own]: [&EndCurves; 2],
        pieces: &[Piece],
        also: Option<usize>,
    ) -> Result<(), CheckError> {
        self.free_during_turns([before, own], pieces)?;
        let (raising, lowering) = (before.stroke.as_ref(), own.stroke.as_ref());
        if raising.is_none() && lowering.is_none() {
            return Ok(());
        }
        self.require_static("a stroke of the tool")?;
        let (departure, arrival) = (&pieces[0].time[0], &pieces[pieces.len() - 1].time[1]);
        let raised = Interval::whole(0);
        let until = lowering.map_or(arrival, |lowering| lowering.begin().min(arrival));
        let since = raising.map_or(departure, |raising| raising.end().max(departure));
        let is_raised = |stroke: Option<&StrokeCurve>, at| stroke.is_none_or(|stroke| stroke.is_at(at, &raised));
        if !is_raised(raising, until) || !is_raised(lowering, since) {
            return CheckError::fails("the tool is not completely raised between the two strokes of a motion");
        }
        let first = raising.map_or(0, |raising| pieces.partition_point(|piece| piece.time[0] < *raising.end()));
        let last = lowering
            .map_or(pieces.len(), |lowering| pieces.partition_point(|piece| piece.time[1] <= *lowering.begin()));
        // The object has another orientation before a turn that follows a pick, and after a turn that precedes a place.
        if let Some(stroke) = raising {
            let angle = before.turn.as_ref().map(|(_, angle)| -angle);
            self.with_object_turned(angle.as_ref(), |replay| {
                replay.free_at_heights(stroke, &pieces[..first], also, 0)
            })?;
        }
        if let Some(stroke) = lowering {
            let angle = own.turn.as_ref().map(|(_, angle)| angle);
            self.with_object_turned(angle, |replay| replay.free_at_heights(stroke, &pieces[last..], also, 0))?;
        }
        Ok(())
    }

    /// Checks pieces of motion during a stroke, first with all heights that the stroke has in this time. If that fails,
    /// checks both halves. `halvings` is the number of times that a piece was halved.
    fn free_at_heights(
        &self,
        stroke: &StrokeCurve,
        pieces: &[Piece],
        also: Option<usize>,
        halvings: u32,
    ) -> Result<(), CheckError> {
        let ([first, ..], [.., last]) = (pieces, pieces) else { return Ok(()) };
        let times = [&first.time[0], &last.time[1]];
        if stroke.is_raised_during(times) {
            return Ok(());
        }
        let heights = stroke.range(times);
        // All curves begin in one tube that no side touches, so any of them can be tested.
        let from = first.curves[0][0].map(|value| Interval::exact(BigInt::from(value) << (BITS - FRACTION_BITS)));
        let checked = self.free(pieces, &from, also, ToolHeights::At(&heights));
        let Err(CheckError::Fails(why)) = checked else { return checked };
        if let [piece] = pieces {
            if halvings == MAX_PRIOR_HALVINGS {
                return CheckError::fails(format!("during a stroke, {why}"));
            }
            let halves = piece.halves();
            return halves
                .iter()
                .try_for_each(|half| self.free_at_heights(stroke, std::slice::from_ref(half), also, halvings + 1));
        }
        let (first, second) = pieces.split_at(pieces.len() / 2);
        [first, second].into_iter().try_for_each(|half| self.free_at_heights(stroke, half, also, halvings))
    }
}
