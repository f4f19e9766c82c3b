//! A move as a firmware plays it: with one IK solution, the tip within the tolerance of the line.
//!
//! The line is divided into parts. All configurations of the IK solution that put the tip within the tolerance of a
//! part lie in one box ([`Kinematics::solution_box`]), and the boxes of consecutive parts overlap. So the joints follow
//! the line without jumps, and the boxes bound their values. [`CurveSearch`] bounds the distance between arm and
//! obstacles over each box, and halves parts that are too long.

use crate::fault::{Cause, Fault};
use crate::{Dialect, Segments, Settings};
use cplan_deviation::{Kinematics, SolutionBox, sag};
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_judge::{CurveSearch, Deviation, Rejection, Vicinity};
use cplan_model::Scene;
use cplan_model::space::{Configuration, JointRange};
use cplan_toolpath::{Curve, Modes};
use std::f64::consts::TAU;

/// Greatest distance beyond the reach that is attributed to rounding, metres.
const REACH_ROUNDING: f64 = 1e-9;

/// Greatest excess over a joint limit that is attributed to rounding, radians or metres.
pub(crate) const LIMIT_ROUNDING: f64 = 1e-9;

/// Greatest half of a box of a revolute joint, radians. Boxes below half a turn determine the number of whole turns.
const MAX_HALF_TURN: f64 = 1.0;

/// Greatest number of parts of a move.
const MAX_PARTS: usize = 20_000;

/// Relative rounding error of the firmware's numbers of segments, which it computes with seven digits.
const FIRMWARE_ROUNDING: f64 = 1e-5;

/// Greatest number of distance computations for a part of a move.
const MAX_EVALUATIONS: usize = 200_000;

/// The joint values along a move, up to whole turns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Swept {
    pub start: Configuration,
    pub end: Configuration,
    /// Bounds on the joint values.
    pub low: Configuration,
    pub high: Configuration,
}

impl Swept {
    /// Returns the values of an arm at rest.
    pub fn at_rest(q: Configuration) -> Self {
        Self { start: q, end: q, low: q, high: q }
    }

    /// Adds whole turns to the values.
    pub fn turned(&self, by: Configuration) -> Self {
        Self { start: self.start + by, end: self.end + by, low: self.low + by, high: self.high + by }
    }

    /// Joins the values of this move and the next one.
    pub fn then(&self, next: &Self) -> Self {
        Self { start: self.start, end: next.end, low: self.low.inf(&next.low), high: self.high.sup(&next.high) }
    }
}

/// An arm that plays moves with one of its IK solutions.
pub(crate) struct Player<'a> {
    pub scene: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    vicinity: Vicinity<'a>,
    /// Number of the IK solution, 0 or 1.
    pub solution: usize,
    tolerance: f64,
    segments: Segments,
    dialect: Dialect,
}

impl<'a> Player<'a> {
    /// Creates the player for an arm and a firmware.
    pub fn new(
        scene: &'a Scene,
        kinematics: &'a Kinematics<'a>,
        solution: usize,
        settings: &Settings,
        dialect: Dialect,
    ) -> Self {
        let (vicinity, Settings { tolerance, segments, .. }) = (Vicinity::new(scene), *settings);
        Self { scene, kinematics, vicinity, solution, tolerance, segments, dialect }
    }

    /// Plays a move with its modes. The result is determined up to whole turns.
    pub fn play(&self, curve: &Curve, modes: &Modes) -> Result<Swept, Fault> {
        let swept = match self.counts(curve, modes)? {
            None => self.line(curve)?,
            Some([least, most]) if least == most => self.segments(curve, least)?,
            Some([least, most]) => {
                let (one, other) = (self.segments(curve, least)?, self.segments(curve, most)?);
                Swept { low: one.low.inf(&other.low), high: one.high.sup(&other.high), ..one }
            }
        };
        if modes.is_rapid && self.dialect.travels_by_joints() {
            self.straight(swept.start, swept.end)?;
        }
        Ok(swept)
    }

    /// Returns the least and the greatest number of segments into which the firmware may divide a move. They differ
    /// only by its rounding. `None` if the segments are short enough for the tolerance.
    fn counts(&self, curve: &Curve, modes: &Modes) -> Result<Option<[f64; 2]>, Fault> {
        let of_length = |length: f64| Some([(curve.length() / length).ceil().max(1.0); 2]);
        let (rate, least, arcs) = match self.segments {
            Segments::Short => return Ok(None),
            Segments::OfLength(length) => return Ok(of_length(length)),
            Segments::PerSecond { rate, least, arcs } => (rate, least.or(self.dialect.least_segment()), arcs),
        };
        let (Curve::Line { .. }, Some(feed), Some(least)) = (curve, modes.feed, least) else {
            return Ok(of_length(arcs));
        };
        // Marlin includes the height, and drops a fraction of a segment. RepRapFirmware rounds to the nearest number.
        let (rise, half) = if self.dialect == Dialect::Marlin { (modes.rise, 0.0) } else { (Some(0.0), 0.5) };
        let rise = if modes.words[2].is_some() { rise } else { Some(0.0) };
        let Some(rise) = rise else {
            let why = "the number of segments depends on the height (Z) before the move, but the file does not state this height";
            return Err(Fault::undecided(curve.start().into(), why.into()));
        };
        let length = curve.length().hypot(rise);
        let count = (length / feed * rate).min(length / least);
        Ok(Some([-1.0, 1.0].map(|sign| (count * (1.0 + sign * FIRMWARE_ROUNDING) + half).floor().max(1.0))))
    }

    /// Returns the joint values that put the tip at a point.
    pub fn at(&self, point: Point) -> Result<Configuration, Fault> {
        let out = self.kinematics.distance_out_of_reach(point);
        if out > REACH_ROUNDING {
            return Err(Fault::out_of_reach(point, out));
        }
        let solutions = self.kinematics.reachable(point, REACH_ROUNDING).and_then(|p| self.kinematics.solutions(p));
        solutions.map(|both| both[self.solution]).ok_or_else(|| Fault::singular(point, true))
    }

    /// Returns the first and the last number of whole turns that bring all values of a joint within its limits. If the
    /// first exceeds the last, no number does.
    pub fn turns(&self, joint: usize, [low, high]: [f64; 2]) -> [f64; 2] {
        let own = &self.kinematics.arm.joints[joint];
        match own.range {
            JointRange::Circle => [0.0, 0.0],
            JointRange::Interval { lower, upper } => {
                let [first, last] = [lower - low - LIMIT_ROUNDING, upper - high + LIMIT_ROUNDING];
                match own.joint_type.is_revolute() {
                    true => [(first / TAU).ceil(), (last / TAU).floor()],
                    false => [if first <= 0.0 { 0.0 } else { 1.0 }, if last >= 0.0 { 0.0 } else { -1.0 }],
                }
            }
        }
    }

    /// Returns the first joint for which no whole turn brings all values of a box within the limits.
    pub fn joint_outside(&self, low: Configuration, high: Configuration) -> Option<usize> {
        (0..2).find(|&k| {
            let [first, last] = self.turns(k, [low[k], high[k]]);
            first > last
        })
    }

    /// Checks that the elbow's motor stays within its range over a box of joint values, given its middle and half of
    /// its size, at a place of the tip.
    pub fn keeps_motor_range(&self, point: Point, q: Configuration, half: [f64; 2]) -> Result<(), Fault> {
        let Some(sum) = self.kinematics.arm.topology().sum else { return Ok(()) };
        let turns = [0, 1].map(|k| self.turns(k, [q[k]; 2]));
        // If the range of a joint exceeds a turn, the sum of the joints, and so the motor's angle, is ambiguous.
        if turns.iter().any(|[first, last]| first != last) {
            return Err(Fault::motor(point, false));
        }
        let turned = q + Configuration::from(turns.map(|[turn, _]| turn * TAU));
        let is_inside = |off: f64| sum.narrowed(off - LIMIT_ROUNDING).contains(turned);
        match is_inside(sum.ratio.abs() * half[0] + half[1]) {
            true => Ok(()),
            false => Err(Fault::motor(point, !is_inside(0.0))),
        }
    }

    /// Checks the joint limits and the range of the elbow's motor at a place of the tip.
    pub fn check_limits(&self, point: Point, q: Configuration) -> Result<(), Fault> {
        match self.joint_outside(q, q) {
            Some(joint) => Err(Fault::limit(self.scene, point, joint, q, true)),
            None => self.keeps_motor_range(point, q, [0.0; 2]),
        }
    }

    /// Plays a line as segments on which the joints move straight.
    fn segments(&self, curve: &Curve, count: f64) -> Result<Swept, Fault> {
        if count > MAX_PARTS as f64 {
            let why = format!("the move needs more than {MAX_PARTS} segments");
            return Err(Fault::undecided(curve.start().into(), why));
        }
        let mut places = vec![self.at(curve.start().into())?];
        for k in 0..=count as u32 {
            let point = Point::from(curve.at(f64::from(k) / count));
            let before = places[places.len() - 1];
            let q = self.kinematics.near(self.at(point)?, before);
            self.check_limits(point, q)?;
            let joints = &self.kinematics.arm.joints;
            if (0..2).any(|k| joints[k].joint_type.is_revolute() && (q[k] - before[k]).abs() > MAX_HALF_TURN) {
                return Err(Fault::singular(point, false));
            }
            places.push(q);
        }
        first_fault(places.windows(2).map(|pair| self.straight(pair[0], pair[1])))?;
        let swept = places.iter().map(|q| Swept::at_rest(*q)).reduce(|all, next| all.then(&next));
        Ok(swept.expect("a segment has ends"))
    }

    /// Plays a line along which the tip moves straight.
    fn line(&self, curve: &Curve) -> Result<Swept, Fault> {
        let mut swept = Swept::at_rest(self.at(curve.start().into())?);
        let mut parts: Vec<([f64; 2], SolutionBox)> = Vec::new();
        let mut open = vec![[0.0, 1.0]];
        while let Some([a, b]) = open.pop() {
            checkpoint();
            let middle = (a + b) / 2.0;
            let Some((next, wide)) = self.part(curve, [a, b], swept.end)? else {
                open.extend([[middle, b], [a, middle]]);
                continue;
            };
            swept = swept.then(&next);
            parts.push(([a, b], wide));
            if parts.len() + open.len() > MAX_PARTS {
                let why = format!("the move needs more than {MAX_PARTS} parts");
                return Err(Fault::undecided(curve.at(middle).into(), why));
            }
        }
        first_fault(parts.iter().map(|(ends, wide)| self.keeps_clear(curve, *ends, wide)))?;
        Ok(swept)
    }

    /// Plays a part of a line. Its joint values continue `before`. Also returns the box of the IK solution within the
    /// tolerance of the part. `None` if the part must be divided.
    fn part(
        &self,
        curve: &Curve,
        [a, b]: [f64; 2],
        before: Configuration,
    ) -> Result<Option<(Swept, SolutionBox)>, Fault> {
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        let point = Point::from(curve.at(middle));
        self.check_limits(point, self.at(point)?)?;
        let near = distance_from_middle(curve, middle, half);
        let is_short = near <= self.tolerance;
        let ends = [a, b].map(|u| Point::from(curve.at(u)));
        let is_apart = self.kinematics.distance_from_singular(ends, sag(curve, [a, b])) > 0.0;
        let boxes = self.small_box(point, near).zip(self.small_box(point, near + self.tolerance));
        let Some((exact, wide)) = boxes.filter(|_| is_apart || is_short) else {
            return if is_short { Err(Fault::singular(point, false)) } else { Ok(None) };
        };
        let q = self.kinematics.near(exact.middle, before);
        let [low, high] = [-1.0, 1.0].map(|sign| q + Configuration::from(exact.half) * sign);
        let fault = match self.joint_outside(low, high) {
            Some(joint) => Some(Fault::limit(self.scene, point, joint, q, false)),
            None => self.keeps_motor_range(point, q, exact.half).err(),
        };
        match fault {
            Some(fault) if near <= LIMIT_ROUNDING => Err(fault),
            Some(_) => Ok(None),
            None => {
                let end = self.kinematics.near(self.at(ends[1])?, q);
                Ok(Some((Swept { start: q, end, low, high }, wide)))
            }
        }
    }

    fn small_box(&self, point: Point, near: f64) -> Option<SolutionBox> {
        let joints = &self.kinematics.arm.joints;
        let is_small =
            |known: &SolutionBox| (0..2).all(|k| !joints[k].joint_type.is_revolute() || known.half[k] <= MAX_HALF_TURN);
        self.kinematics.solution_box(point, self.solution, near).filter(is_small)
    }

    /// Checks that the arm keeps the clearance on a part of a line while the tip is within the tolerance. `whole` is a
    /// box for the whole part.
    fn keeps_clear(&self, curve: &Curve, [a, b]: [f64; 2], whole: &SolutionBox) -> Result<(), Fault> {
        let mut search = CurveSearch::deciding(self.scene, self.scene.workspace().clearance, MAX_EVALUATIONS);
        let on_part = |middle: f64, half: f64| {
            let (u, half) = (a + (b - a) * middle, (b - a) * half);
            let point = Point::from(curve.at(u));
            let near = distance_from_middle(curve, u, half) + self.tolerance;
            let known = self.kinematics.solution_box(point, self.solution, near).unwrap_or(*whole);
            let q = self.at(point).unwrap_or(known.middle);
            let off = (self.kinematics.near(known.middle, q) - q).abs();
            (q, Deviation::Box([0, 1].map(|k| known.half[k] + off[k])))
        };
        search.curve(&self.vicinity, on_part).map_err(|rejection| self.blocked(rejection))
    }

    /// Checks that the arm keeps the clearance while the joints move straight. Each joint may deviate by as much as
    /// moves the tip by the tolerance.
    fn straight(&self, from: Configuration, to: Configuration) -> Result<(), Fault> {
        let joints = &self.kinematics.arm.joints;
        let reach = self.kinematics.arm.reach();
        let beside =
            joints.each_ref().map(|joint| self.tolerance / if joint.joint_type.is_revolute() { reach } else { 1.0 });
        let mut search = CurveSearch::deciding(self.scene, self.scene.workspace().clearance, MAX_EVALUATIONS);
        let on_part =
            |middle: f64, half: f64| (from + (to - from) * middle, Deviation::Tube((to - from) * half, beside));
        search
            .curve(&self.vicinity, on_part)
            .map_err(|rejection| Fault { cause: Cause::JointMotion, ..self.blocked(rejection) })
    }

    fn blocked(&self, rejection: Rejection) -> Fault {
        let (nearest, is_proven) = match rejection {
            Rejection::TooClose(nearest) => (nearest, true),
            Rejection::Undecided(nearest) => (nearest, false),
            Rejection::OutOfLimits { .. } => unreachable!("only paths have limits"),
        };
        Fault::collision(self.scene, nearest, is_proven)
    }
}

/// Returns the first proven fault of the parts of a move, or else the first fault.
fn first_fault(parts: impl Iterator<Item = Result<(), Fault>>) -> Result<(), Fault> {
    let mut doubtful = Ok(());
    for part in parts {
        checkpoint();
        match part {
            Err(fault) if fault.is_proven => return Err(fault),
            Err(fault) => doubtful = doubtful.and(Err(fault)),
            Ok(()) => {}
        }
    }
    doubtful
}

/// Returns an upper bound on the distance between the middle of a part of a curve and its other points, metres.
fn distance_from_middle(curve: &Curve, middle: f64, half: f64) -> f64 {
    let [x, y] = curve.derivative(middle);
    half * (x.hypot(y) + curve.bend() * half / 2.0) * (1.0 + 1e-12)
}
