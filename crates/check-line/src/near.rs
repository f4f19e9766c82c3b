//! Checks of certificates with the answer "found": the tip follows the line.

use crate::bezier;
use crate::curve::Curve;
use crate::text::{Line, index, parameter};
use crate::tip;
use cplan_check::arm::Arm;
use cplan_check::certificate::{Certificate, Motion};
use cplan_check::curve::{FRACTION_BITS, Piece};
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, double, length, minus, roughly, times};
use cplan_check::motion::{check_arm_clear, check_knots, piece};
use cplan_check::world::World;
use cplan_check::{CheckError, Input};
use num_bigint::BigInt;

/// Maximum number of halvings of a span. A hundredth of a second then becomes less than a nanosecond.
const MAX_HALVINGS: u32 = 24;

/// Maximum number of parts of spans for each interpolation of a motion. They take some minutes.
const MAX_PARTS: usize = 4_000_000;

/// Bound on the rounding error of control points of joint values, in units of `2^-FRACTION_BITS`.
const ROUNDING_UNITS: i32 = 2;

/// Binary digits of guesses after the point.
const GUESS_BITS: u32 = 52;

/// A part of the motion between two knots, and a part of a piece of the line.
struct Span {
    /// The knot, counted from the first one, and a range of the time until the next knot, as shares of that time in
    /// units of [`Interval`].
    knot: usize,
    shares: [BigInt; 2],
    /// The piece, and a range of its parameter, in units of [`Interval`].
    piece: usize,
    parameters: [BigInt; 2],
}

/// A moment at which the tip is compared with a place of the line.
#[derive(Clone)]
struct Pairing {
    /// The parameter of the piece, in units of [`Interval`].
    u: BigInt,
    /// Upper bound on the distance between the tip and this place, in units.
    off: BigInt,
}

impl Pairing {
    fn new(curve: &Curve, tip: &Point, u: BigInt) -> Self {
        let off = length(&minus(tip, &curve.at(&Interval::exact(u.clone())))).upper;
        Self { u, off }
    }
}

/// Checks that the tip follows the line within the tolerance, and that the arm keeps its limits and the clearance.
pub fn follows(arm: &Arm, world: &World, certificate: &Certificate, line: &Line) -> Result<String, CheckError> {
    let clearance = certificate.clearance(world)?;
    let Some(motion) = &certificate.motion else {
        return Err(CheckError::in_file(Input::Certificate, "it has no motion"));
    };
    let Motion { interpolation, knots } = motion;
    check_knots(interpolation, knots)?;
    let pieces = (0..knots.len().max(2) - 1).map(|knot| piece(arm, interpolation, knots, knot));
    let pieces = pieces.collect::<Result<Vec<Piece>, CheckError>>()?;
    stays_near(arm, line, &pieces)?;
    check_arm_clear(arm, world, &pieces, [&knots[0][1], &knots[0][2]], clearance)?;
    let [first, second] = arm.joints.each_ref().map(|joint| &joint.name);
    let (tip, tolerance) = (&arm.tip_link, &line.tolerance);
    Ok(format!(
        "a motion of \"{first}\" and \"{second}\" leads the tip \"{tip}\" along {line}, within {tolerance} of the line and \
         in its order, with clearance {clearance} ({})",
        motion.in_words()
    ))
}

/// Checks that the tip follows the line within the tolerance, with the elbow on the required side, for each
/// interpolation of a motion.
///
/// # Errors
/// Those of [`spans`], and the first part of the motion on which the tip is not shown to follow the line.
pub fn stays_near(arm: &Arm, line: &Line, pieces: &[Piece]) -> Result<(), CheckError> {
    if let Some(elbow) = line.elbow {
        elbow.of_arm(arm)?;
        elbow.check_pieces(arm, pieces)?;
    }
    let spans = spans(line, pieces.len())?;
    for reading in 0..pieces[0].curves.len() {
        let mut follower = Follower { arm, line, tolerance: Interval::from(&line.tolerance).lower, parts: 0 };
        spans.iter().try_for_each(|span| follower.check_span(span, &pieces[span.knot], reading))?;
    }
    Ok(())
}

/// Pairs parts of the motion with parts of the line, from beginning to end.
///
/// # Errors
/// Places that do not begin or end with the motion and the line, that move backwards, or that omit a knot or the end of a piece.
fn spans(line: &Line, knots: usize) -> Result<Vec<Span>, CheckError> {
    let places = &line.places;
    let is_at = |place: Option<&[Decimal; 2]>, ends: [usize; 2]| {
        place.is_some_and(|place| (0..2).all(|k| place[k] == Decimal::whole(ends[k] as i32)))
    };
    if !is_at(places.first(), [0, 0]) || !is_at(places.last(), [knots, line.pieces.len()]) {
        return CheckError::fails("the first and last of \"places\" are not the ends of the motion and of the line");
    }
    let one = BigInt::from(1) << BITS;
    let span = |(number, pair): (usize, &[[Decimal; 2]])| {
        let [from, to] = pair else { unreachable!("windows of two") };
        let (knot, piece) = (index(&from[0], knots), index(&from[1], line.pieces.len()));
        let of = |k: usize, whole: usize| [from, to].map(|place| parameter(&place[k], whole));
        let (shares, parameters) = (of(0, knot), of(1, piece));
        let fits = |[a, b]: &[BigInt; 2]| BigInt::ZERO <= *a && a <= b && *b <= one;
        match fits(&shares) && fits(&parameters) {
            true => Ok(Span { knot, shares, piece, parameters }),
            false => {
                CheckError::fails(format!("places[{}] goes back, or skips a knot or the end of a piece", number + 1))
            }
        }
    };
    places.windows(2).enumerate().map(span).collect()
}

/// The check of one interpolation of a motion.
struct Follower<'a> {
    arm: &'a Arm,
    line: &'a Line,
    /// The tolerance, in units of [`Interval`].
    tolerance: BigInt,
    /// Number of checked parts.
    parts: usize,
}

impl Follower<'_> {
    /// Checks that the tip stays near a piece of the line during a span, for one interpolation between the span's knot
    /// and the next one.
    fn check_span(&mut self, span: &Span, motion: &Piece, reading: usize) -> Result<(), CheckError> {
        let curve = &self.line.pieces[span.piece];
        let joints = cut(joint_curve(&motion.curves[reading]), &span.shares);
        let [from, to] = &span.parameters;
        let begin = Pairing::new(curve, &tip::at(self.arm, &joints[0]), from.clone());
        let end = Pairing::new(curve, &tip::at(self.arm, &joints[joints.len() - 1]), to.clone());
        let mut open = vec![(joints, [begin, end], 0)];
        while let Some((joints, [begin, end], halvings)) = open.pop() {
            self.parts += 1;
            let off = (&begin.off).max(&end.off);
            let (bend, delay) = self.bend(curve, &joints, [&begin.u, &end.u]);
            if off + (bend >> 3u32) < self.tolerance {
                continue;
            }
            if *off > self.tolerance || halvings >= MAX_HALVINGS || self.parts >= MAX_PARTS {
                return CheckError::fails(format!(
                    "after knot {}, the tip is not proven to stay within {} of piece {} of the line",
                    motion.knot, self.line.tolerance, span.piece
                ));
            }
            let (first, second) = bezier::cut(&joints, &Interval::whole(1).half());
            let middle = self.middle(curve, &second[0], [&begin.u, &end.u], delay);
            open.push((second, [middle.clone(), end], halvings + 1));
            open.push((first, [begin, middle], halvings + 1));
        }
        Ok(())
    }

    /// Considers the difference between the tip and its place on the line as a function of the share `s` of the part.
    /// Returns a bound on its second derivative, in units. The place at `s` has the parameter `from + (to - from) (s +
    /// delay s (1 - s))`. The delay is between -1 and 1, so the place never moves backwards. Also returns the delay,
    /// which is guessed so that the bound is small.
    fn bend(&self, curve: &Curve, joints: &[Point], [from, to]: [&BigInt; 2]) -> (BigInt, f64) {
        let rates = bezier::derivative(joints);
        let bends = bezier::enclosure(&bezier::derivative(&rates));
        let [.., tip] = tip::jet(self.arm, [&bezier::enclosure(joints), &bezier::enclosure(&rates), &bends]);
        let [first, second] = curve.derivatives(&Interval { lower: from.clone(), upper: to.clone() });
        let along = Interval::exact(to - from);
        let [t, a, b] = [&tip, &first, &second].map(|v| v.each_ref().map(|c| roughly(&c.middle().0)));
        let w = roughly(&along.lower);
        let excess = (0..2).map(|k| (t[k] - b[k] * w * w) * a[k]).sum::<f64>();
        let delay = (-excess / (2.0 * w * (a[0] * a[0] + a[1] * a[1]))).clamp(-1.0, 1.0);
        let exact = Interval::exact(units(delay));
        let rate = &along * &Interval::whole(1).widened(&exact.magnitude());
        let place = [times(&second, &(&rate * &rate)), times(&first, &-&double(&(&exact * &along)))];
        (length(&minus(&minus(&tip, &place[0]), &place[1])).upper, delay)
    }

    /// Returns the pairing in the middle of a part. The place on the line lies between the places at the ends of the
    /// part, close to the point nearest to the tip.
    fn middle(&self, curve: &Curve, q: &Point, [from, to]: [&BigInt; 2], delay: f64) -> Pairing {
        let tip = tip::at(self.arm, q);
        let u = from + (((to - from) * units(0.5 + delay / 4.0)) >> BITS);
        let place = Interval::exact(u.clone());
        let [along, _] = curve.derivatives(&place);
        let [off, along] = [minus(&tip, &curve.at(&place)), along].map(|v| v.map(|c| roughly(&c.lower)));
        let step = (off[0] * along[0] + off[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let near = (&u + units(step)).clamp(from.clone(), to.clone());
        let pairings = [near, u].map(|u| Pairing::new(curve, &tip, u));
        pairings.into_iter().min_by(|a, b| a.off.cmp(&b.off)).expect("two")
    }
}

/// Returns a guess as a number of units of [`Interval`].
pub fn units(guess: f64) -> BigInt {
    BigInt::from((guess * (1_u64 << GUESS_BITS) as f64) as i64) << (BITS - GUESS_BITS)
}

/// Returns enclosures of the control points of both joints' values.
fn joint_curve(control: &[[i128; 2]]) -> Vec<Point> {
    let unit = BITS - FRACTION_BITS;
    let rounding = BigInt::from(ROUNDING_UNITS) << unit;
    let enclosed = |n: &i128| Interval::exact(BigInt::from(*n) << unit).widened(&rounding);
    control.iter().map(|values| values.each_ref().map(enclosed)).collect()
}

/// Returns the part of a curve between two shares of its parameter, in units of [`Interval`].
fn cut(joints: Vec<Point>, [from, to]: &[BigInt; 2]) -> Vec<Point> {
    let one = BigInt::from(1) << BITS;
    if *from == BigInt::ZERO && *to == one {
        return joints;
    }
    let (_, rest) = bezier::cut(&joints, &Interval::exact(from.clone()));
    if *from == one {
        return rest;
    }
    let share = Interval::exact(to - from).divided(&Interval::exact(one - from));
    bezier::cut(&rest, &share).0
}
