//! Checks of certificates with the answer "found": a motion is free.

use crate::arm::Arm;
use crate::certificate::{Certificate, Interpolation, Motion};
use crate::curve::{FRACTION_BITS, INTEGER_BITS, Piece, Values, halves};
use crate::decimal::Decimal;
use crate::ends::End;
use crate::error::{CheckError, Input};
use crate::free::{Attachment, Chain, Solid, guard};
use crate::interval::Interval;
use crate::obstacle::Obstacle;
use crate::scene::{Part, PlacedObstacle, check_parts_clear};
use crate::shapes::CollisionShape;
use crate::world::World;

/// Maximum number of halvings of a piece of the motion for the check of joint limits.
const MAX_PIECE_HALVINGS: u32 = 40;

/// Number of decimals of the angle, in radians, by which the elbow's motor may exceed its limits. The rounding of joint
/// values makes motions along a limit exceed it.
const SUM_DIGITS: u32 = 9;

/// Factor that makes control points exact decimals: a common multiple of the denominators in all interpolations.
pub const CONTROL_POINT_FACTOR: i32 = 60;

impl Interpolation {
    fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Cubic => "cubic",
            Self::Quartic => "quartic",
            Self::Quintic => "quintic",
        }
    }

    /// Returns how many numbers of a knot this interpolation needs, including the time.
    fn columns(self) -> usize {
        match self {
            Self::Linear => 3,
            Self::Cubic => 5,
            Self::Quartic | Self::Quintic => 7,
        }
    }

    /// Computes the control points of a joint's curve between two knots, times [`CONTROL_POINT_FACTOR`].
    fn control(self, a: &[Decimal], b: &[Decimal], joint: usize) -> Vec<Decimal> {
        let h = &b[0] - &a[0];
        let value = |knot: &[Decimal]| &knot[1 + joint] * &Decimal::whole(CONTROL_POINT_FACTOR);
        let speed = |knot: &[Decimal], by: i32| &(&knot[3 + joint] * &h) * &Decimal::whole(by);
        let bend = |knot: &[Decimal], by: i32| &(&(&knot[5 + joint] * &h) * &h) * &Decimal::whole(by);
        let (from, to) = (value(a), value(b));
        match self {
            Self::Linear => vec![from, to],
            Self::Cubic => vec![from.clone(), &from + &speed(a, 20), &to - &speed(b, 20), to],
            Self::Quartic => {
                let third = &(&from + &speed(a, 30)) + &bend(a, 5);
                vec![from.clone(), &from + &speed(a, 15), third, &to - &speed(b, 15), to]
            }
            Self::Quintic => {
                let third = &(&from + &speed(a, 24)) + &bend(a, 3);
                let fourth = &(&to - &speed(b, 24)) + &bend(b, 3);
                vec![from.clone(), &from + &speed(a, 12), third, fourth, &to - &speed(b, 12), to]
            }
        }
    }
}

impl Motion {
    /// Describes the number of knots and the interpolations in words.
    pub fn in_words(&self) -> String {
        let read: Vec<&str> = self.interpolation.iter().map(|method| method.name()).collect();
        format!("{} knots, read as {}", self.knots.len(), read.join(" or "))
    }

    /// Returns true if the arm is at rest from the given knot to the next, with each interpolation.
    pub fn rests_after_knot(&self, knot: usize) -> bool {
        let [from, to] = [knot, knot + 1].map(|knot| &self.knots[knot]);
        let stands = |method: &Interpolation, joint: usize| {
            let control = method.control(from, to, joint);
            control.iter().all(|point| *point == control[0])
        };
        self.interpolation.iter().all(|method| (0..2).all(|joint| stands(method, joint)))
    }
}

/// Checks that a motion leads from the start to the goal within the limits, and keeps more than the clearance from all
/// obstacles, including the arm's own links.
pub fn check_motion(arm: &Arm, world: &World, certificate: &Certificate) -> Result<String, CheckError> {
    let clearance = certificate.clearance(world)?;
    let Some(motion) = &certificate.motion else {
        return Err(CheckError::in_file(Input::Certificate, "it has no motion"));
    };
    let Motion { interpolation, knots } = motion;
    check_knots(interpolation, knots)?;
    let start = End::start(certificate, world)?.reached(arm, &knots[0])?;
    let goal = End::goal(certificate, world)?.reached(arm, &knots[knots.len() - 1])?;
    let pieces = (0..knots.len().max(2) - 1).map(|knot| piece(arm, interpolation, knots, knot));
    let pieces = pieces.collect::<Result<Vec<Piece>, CheckError>>()?;
    check_arm_clear(arm, world, &pieces, [&knots[0][1], &knots[0][2]], clearance)?;
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    Ok(format!(
        "a motion of \"{first}\" and \"{second}\" leads from the start{start} to the goal{goal} with clearance {clearance} ({})",
        motion.in_words()
    ))
}

/// Checks the number of knots, the columns of each knot, and the order of their times.
pub fn check_knots(interpolation: &[Interpolation], knots: &[Vec<Decimal>]) -> Result<(), CheckError> {
    let bad = |message: String| Err(CheckError::in_file(Input::Certificate, message));
    let Some(columns) = interpolation.iter().map(|method| method.columns()).max() else {
        return bad("the motion does not state the interpolation between its knots".into());
    };
    if knots.is_empty() {
        return bad("the motion has no knots".into());
    }
    if let Some(odd) = knots.iter().position(|knot| knot.len() != columns) {
        return bad(format!("knot {odd} has {} numbers, but the interpolation needs {columns}", knots[odd].len()));
    }
    match knots.windows(2).position(|k| k[0][0] >= k[1][0]) {
        Some(late) => {
            CheckError::fails(format!("the time of knot {} is not after that of the previous knot", late + 1))
        }
        None => Ok(()),
    }
}

/// Returns the motion from the given knot to the next one, or a motion at rest if there is only one knot.
pub fn piece(
    arm: &Arm,
    interpolation: &[Interpolation],
    knots: &[Vec<Decimal>],
    knot: usize,
) -> Result<Piece, CheckError> {
    let mut curves = Vec::new();
    for method in interpolation {
        let control = |joint: usize| match &knots.get(knot + 1) {
            Some(next) => method.control(&knots[knot], next, joint),
            None => Interpolation::Linear.control(&knots[knot], &knots[knot], joint),
        };
        let control = [control(0), control(1)];
        for (joint, control) in arm.joints.iter().zip(&control) {
            let ends = joint
                .within
                .as_ref()
                .map(|range| range.each_ref().map(|end| end * &Decimal::whole(CONTROL_POINT_FACTOR)));
            if ends.is_some_and(|[low, high]| !is_curve_within(control, &low, &high, MAX_PIECE_HALVINGS)) {
                let (name, method) = (&joint.name, method.name());
                return CheckError::fails(format!("after knot {knot} ({method}) joint \"{name}\" leaves its limits"));
            }
        }
        let [first, second] = &control;
        if let Some(sum) = &arm.sum {
            let sums: Vec<Decimal> = first.iter().zip(second).map(|(first, second)| sum.of(first, second)).collect();
            let may = Decimal::power_of_ten(SUM_DIGITS);
            let factor = Decimal::whole(CONTROL_POINT_FACTOR);
            let [low, high] = [&(&sum.limits[0][1] - &may) * &factor, &(&sum.limits[1][0] + &may) * &factor];
            if !is_curve_within(&sums, &low, &high, MAX_PIECE_HALVINGS) {
                let method = method.name();
                return CheckError::fails(format!("after knot {knot} ({method}) the elbow's motor leaves its limits"));
            }
        }
        let curve = first.iter().zip(second).map(|(a, b)| Some([fine(a)?, fine(b)?])).collect::<Option<Vec<Values>>>();
        let Some(curve) = curve else { return CheckError::fails(format!("after knot {knot} values are too large")) };
        curves.push(curve);
    }
    let time = [knot, (knot + 1).min(knots.len() - 1)].map(|knot| &knots[knot][0] - &knots[0][0]);
    Ok(Piece { knot, curves, time })
}

/// Divides a number by [`CONTROL_POINT_FACTOR`] and converts it to the units of [`Values`], with an error of less than
/// two units. Returns `None` if the number is too large.
pub fn fine(sixty: &Decimal) -> Option<i128> {
    let fine = sixty.floor(FRACTION_BITS) / CONTROL_POINT_FACTOR;
    (fine.bits() < u64::from(FRACTION_BITS + INTEGER_BITS)).then(|| i128::try_from(fine).ok()).flatten()
}

/// Returns true if a curve stays between `low` and `high`, ends included. Tests the control points of the curve. If
/// these do not decide, halves the curve up to `halvings` times.
fn is_curve_within(control: &[Decimal], low: &Decimal, high: &Decimal, halvings: u32) -> bool {
    let is_within = |value: &Decimal| low <= value && value <= high;
    if control.iter().all(is_within) {
        return true;
    }
    let ends = [&control[0], &control[control.len() - 1]];
    if halvings == 0 || !ends.into_iter().all(is_within) {
        return false;
    }
    halves(control, Decimal::middle).iter().all(|half| is_curve_within(half, low, high, halvings - 1))
}

/// Checks that all shapes of the arm keep farther than the clearance from all obstacles, along the whole motion. `start`
/// is its first configuration.
///
/// # Errors
/// The first part of the motion, shape and obstacle for which this is not shown.
pub fn check_arm_clear(
    arm: &Arm,
    world: &World,
    pieces: &[Piece],
    start: [&Decimal; 2],
    clearance: &Decimal,
) -> Result<(), CheckError> {
    let chain = Chain::from(arm);
    let present = |obstacle: &Obstacle| PlacedObstacle::new(&chain, obstacle.clone()).map(Some);
    let all = || world.all().chain(&arm.own);
    let obstacles = all().map(present).collect::<Result<Vec<_>, _>>()?;
    let kept = Interval::from(clearance).upper + guard();
    let solid = |CollisionShape { around, .. }: &CollisionShape| {
        Solid::new(&chain, Attachment::Link(around.link), &around.shape, &kept)
    };
    let solids: Vec<Solid> = arm.shapes.iter().map(solid).collect();
    let keeps = format!("farther than {clearance} from");
    let part = |(shape, solid): (&CollisionShape, _)| {
        let meets = all().map(|obstacle| shape.meets(&shape.around, obstacle)).collect();
        Part { name: shape.to_string(), keeps: &keeps, solid, meets }
    };
    let parts: Vec<Part> = arm.shapes.iter().zip(&solids).map(part).collect();
    check_parts_clear(&chain, pieces, &start.map(Interval::from), &parts, &obstacles)
}
