//! The smooth curve in joint space along a route.
//!
//! Between two waypoints on a piece of the line, the joints move along a cubic. Its tangents are those of the curve in
//! joint space that puts the tip exactly on the line. Such cubics deviate from the line by far less than straight
//! motions. Where consecutive cubics have the same tangent, the motion needs no blend. So its acceleration follows the
//! bends of the line, and does not alternate between chords and blends.
//!
//! A leg stays straight if it is a whole straight piece of the line, as in a curve that a file writes as short lines.
//! It also stays straight near singular places, where tangents vary too much.

use crate::motion::Driver;
use crate::nodes::Part;
use crate::search::Route;
use crate::wrist::{Turns, WristAlong};
use cplan_geometry::Vector;
use cplan_handling::{ToolAngle, WristJoint};
use cplan_model::space::Configuration;
use cplan_motion::CurvedLeg;
use cplan_toolpath::{Curve, wrapped};

/// Least cosine of the angle between a leg and a tangent at its end. Other legs stay straight.
const MIN_COSINE: f64 = 0.7;

/// Least sine of the angle between the two directions in which the joints move the tip.
const MIN_SINE: f64 = 1e-6;

/// Greatest difference between the tangents of two legs that needs no blend, as a share of the turn along the legs.
const SMOOTH_SHARE: f64 = 0.01;

/// Greatest difference of tangents that is attributed to rounding.
const SMOOTH_TURN: f64 = 1e-7;

/// Greatest difference of the wrist's slopes that needs no blend, as a share of 1 plus the slope.
const SMOOTH_SLOPE_SHARE: f64 = 1e-3;

/// Greatest angle, radians, between the tool and a piece that is attributed to rounding.
const ANGLE_ROUNDING: f64 = 1e-9;

/// The directions of the joints and the wrist at both ends of each leg of a route.
pub(crate) struct Course {
    /// Unit tangents of curved legs; `None` for straight legs.
    pub tangents: Vec<Option<[Configuration; 2]>>,
    /// Derivatives of the wrist's value with respect to the distance in joint space; 0 without a wrist.
    pub slopes: Vec<[f64; 2]>,
    /// True for each waypoint that is passed without a blend.
    pub is_smooth: Vec<bool>,
    /// Displacements of the joints along the legs.
    chords: Vec<Configuration>,
}

impl Course {
    /// Returns the smooth course of a motion along a route.
    pub fn new(driver: &Driver, route: &Route, wrist: Option<(WristAlong, &Turns)>) -> Self {
        let q = route.path.path().waypoints();
        let chords: Vec<Configuration> = q.windows(2).map(|leg| leg[1] - leg[0]).collect();
        let legs = || 0..chords.len();
        // A path without corners must be straight, because results state only a path with the extents of its corners.
        let tangents = |leg| if chords.len() == 1 { None } else { driver.tangents(route, leg, chords[leg]) };
        let tangents: Vec<_> = legs().map(tangents).collect();
        let slope = |leg: usize| wrist.map_or([0.0; 2], |wrist| driver.slopes(route, leg, tangents[leg], wrist));
        let slopes = legs().map(slope).collect();
        let mut course = Self { tangents, slopes, is_smooth: vec![false; q.len()], chords };
        for waypoint in 1..q.len().saturating_sub(1) {
            if !driver.must_stop(q, route, waypoint) {
                course.smooth(waypoint);
            }
        }
        course
    }

    /// Returns the unit direction at an end of a leg.
    pub fn direction(&self, leg: usize, end: usize) -> Configuration {
        self.tangents[leg].map_or_else(|| self.chords[leg] / self.chords[leg].norm(), |tangents| tangents[end])
    }

    /// Returns the length of a leg if it is curved.
    pub fn curved_length(&self, leg: usize) -> Option<f64> {
        self.tangents[leg].map(|_| self.chords[leg].norm())
    }

    /// Makes a waypoint smooth if both legs have almost the same directions there.
    fn smooth(&mut self, waypoint: usize) {
        let (before, after) = (waypoint - 1, waypoint);
        let [Some([first, a]), Some([b, last])] = [before, after].map(|leg| self.tangents[leg]) else { return };
        let most = SMOOTH_TURN.max(SMOOTH_SHARE * (a - first).norm().max((last - b).norm()));
        let [slope, next] = [self.slopes[before][1], self.slopes[after][0]];
        let is_even = (next - slope).abs() <= SMOOTH_SLOPE_SHARE * (1.0 + slope.abs());
        if (b - a).norm() <= most && is_even {
            let (mean, slope) = ((a + b).normalize(), (slope + next) / 2.0);
            (self.tangents[before], self.tangents[after]) = (Some([first, mean]), Some([mean, last]));
            (self.slopes[before][1], self.slopes[after][0]) = (slope, slope);
            self.is_smooth[waypoint] = true;
        }
    }
}

impl Driver<'_> {
    /// Returns the part of the line along a leg. `None` unless the leg has exactly one part.
    fn part_of_leg(&self, route: &Route, leg: usize) -> Option<Part> {
        let [from, to] = [route.nodes[leg], route.nodes[leg + 1]];
        (from + 1 == to).then(|| self.nodes.parts[from])
    }

    /// Returns the derivative of the joint values with respect to the parameter of the line, at an end of a leg.
    fn pace(&self, route: &Route, leg: usize, end: usize) -> Option<Configuration> {
        let part = self.part_of_leg(route, leg)?;
        let [x, y] = self.line.curve(part.piece).derivative(part.ends[end]);
        let arm = self.scene.arm();
        let [first, second] = arm.jacobian(1, arm.tip, route.path.path().waypoints()[leg + end]);
        let determinant = first.perp(&second);
        let along = Vector::new(x, y);
        let pace = Configuration::new(along.perp(&second), first.perp(&along)) / determinant;
        let is_regular = determinant.abs() > MIN_SINE * first.norm() * second.norm();
        (is_regular && pace.iter().all(|rate| rate.is_finite()) && pace.norm() > 0.0).then_some(pace)
    }

    /// Returns the unit tangents at both ends of a leg; `None` if it stays straight.
    fn tangents(&self, route: &Route, leg: usize, chord: Configuration) -> Option<[Configuration; 2]> {
        let part = self.part_of_leg(route, leg)?;
        if part.ends == [0.0, 1.0] && matches!(self.line.curve(part.piece), Curve::Line { .. }) {
            return None;
        }
        let tangents = [self.pace(route, leg, 0)?.normalize(), self.pace(route, leg, 1)?.normalize()];
        tangents.iter().all(|tangent| tangent.dot(&chord) >= MIN_COSINE * chord.norm()).then_some(tangents)
    }

    /// Returns the derivatives of the wrist's value with respect to the distance in joint space, at both ends of a leg.
    fn slopes(
        &self,
        route: &Route,
        leg: usize,
        tangents: Option<[Configuration; 2]>,
        (wrist, turns): (WristAlong, &Turns),
    ) -> [f64; 2] {
        let ends = [0, 1].map(|end| route.path.path().waypoints()[leg + end]);
        let values = [turns[leg][1], turns[leg + 1][0]];
        let length = tangents.map_or((ends[1] - ends[0]).norm(), |tangents| CurvedLeg::new(ends, tangents).length);
        let even = [(values[1] - values[0]) / length; 2];
        let Some((tangents, part)) = tangents.zip(self.part_of_leg(route, leg)) else { return even };
        let piece = &self.line.pieces[part.piece];
        let arm = self.scene.arm();
        // At an end: the turning rate of the tool, and the difference between its angle and the required one.
        let at_end = |end: usize| match wrist.guide.angle {
            ToolAngle::Fixed(_) => Some([0.0; 2]),
            ToolAngle::Tangent(offset) if !piece.is_travel => {
                let (u, pace) = (part.ends[end], self.pace(route, leg, end)?);
                let angle = wrist.joint.tool_angle(arm, ends[end].into(), values[end]);
                let off = wrapped(angle - piece.curve.heading(u)? - offset);
                let off = if off.abs() > ANGLE_ROUNDING { off } else { 0.0 };
                Some([piece.curve.turning(u)? / pace.norm(), off])
            }
            ToolAngle::Tangent(_) => None,
        };
        let Some(known) = at_end(0).zip(at_end(1)) else { return even };
        let ([first, off], [last, next]) = known;
        // At a slight corner, the angle of the tool is between those of both pieces. Along a leg, it departs from that
        // of the piece gradually.
        let gradual = match [off == 0.0, next == 0.0] {
            [true, _] => [0.0, 2.0 * next / length],
            [_, true] => [-2.0 * off / length, 0.0],
            _ => [(next - off) / length; 2],
        };
        let turning = [first + gradual[0], last + gradual[1]];
        [0, 1].map(|end| {
            let of_arm = WristJoint::link_2_angle(arm, tangents[end].into());
            wrist.joint.sign * (turning[end] - of_arm)
        })
    }
}
