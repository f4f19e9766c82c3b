//! The motion in time along a sequence of configurations.

use crate::course::Course;
use crate::deviation::{bounds, tool_bound};
use crate::fixed_angle;
use crate::merge::Merged;
use crate::nodes::Nodes;
use crate::search::Route;
use crate::smooth::Stretch;
use crate::wrist::{Turns, WristAlong, values_between};
use crate::{FollowError, Settings};
use cplan_deviation::{Deviation, Foot, Kinematics, Line, ToolDeviation};
use cplan_geometry::Point;
use cplan_handling::WristJoint;
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, certify};
use cplan_model::Scene;
use cplan_model::space::{Configuration, Path};
use cplan_motion::{BlendedPath, CurveDrive, TimedMotion, TipSpeed, WristLimit, along_curve, blend_curved};

/// Cosine of the angle between two legs below which the motion stops between them, because it almost reverses.
const REVERSAL_COSINE: f64 = -0.95;

/// Cosine of the greatest turn of the tip at a corner that a motion with limited jerks passes without a stop.
const SMOOTH_CORNER_COSINE: f64 = 0.985;

/// Greatest deviation of a blend from its waypoint, as a share of the tolerance that the waypoint itself does not use.
const BLEND_ROOM_SHARE: f64 = 0.7;

/// Greatest change of the tool's angle by a blend, as a share of the tolerance of this angle.
const BLEND_TOOL_SHARE: f64 = 0.2;

/// Greatest radius of a blend beside a curved leg, as a share of the leg. The blend leaves the line along its tangent,
/// so the remaining leg is curved more strongly.
const CURVED_LEG_SHARE: f64 = 0.25;

/// Number of times that a motion is slowed down for the wrist.
const SLOWDOWNS: u32 = 8;

/// Excess over the limits of the wrist that is attributed to rounding, as a share.
const WRIST_ROUNDING: f64 = 2e-7;

/// Extra factor by which a motion is slowed down, beyond the excess of the wrist.
const SLOWDOWN_MARGIN: f64 = 1.01;

/// A motion along a route, with proven bounds.
pub(crate) struct Motion {
    pub timed: TimedMotion,
    /// Bound on the distance of the tip from the line, metres.
    pub deviation: f64,
    /// Bound on the difference between the tool's angle and the required one, radians; `None` without a wrist.
    pub tool: Option<f64>,
    /// Position of the tip where the bound on its distance is greatest, metres.
    pub farthest: Point,
}

/// The input of a motion.
pub(crate) struct Driver<'a> {
    pub scene: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    /// The line of the file.
    pub written: &'a Line<'a>,
    /// The line after the merging of tiny pieces.
    pub line: &'a Line<'a>,
    pub merged: &'a Merged,
    pub nodes: &'a Nodes,
    pub settings: &'a Settings,
    /// Greatest distance of the tip on a blend from the corner, metres.
    pub blend: f64,
}

impl Driver<'_> {
    /// Returns the fastest motion found along a route. `turns` are the values of the wrist.
    pub fn motion(&self, route: &Route, turns: Option<&Turns>) -> Result<Motion, FollowError> {
        let is_smooth = self.scene.arm().limits_jerks();
        let speeds = self.leg_speeds(route);
        let wrist = self.settings.wrist.zip(turns);
        let mut share = self.settings.share;
        if !is_smooth {
            return Ok(self.judged(route, self.within_wrist(route, &speeds, wrist)?, is_smooth));
        }
        for _ in 0..SLOWDOWNS {
            let parts = self.smooth_parts(route, &speeds, share)?;
            let join = |(first, before), (from, next)| (first, joined(before, self.dwell(route, from), next));
            let (_, mut timed) = parts.into_iter().reduce(join).expect("at least one part");
            let Some((wrist, turns)) = wrist else { return Ok(self.judged(route, timed, is_smooth)) };
            fixed_angle::add_wrist(self.scene.arm(), &wrist, turns[0][1], &mut timed.trajectory);
            let excess = fixed_angle::excess(&wrist, self.settings.share, &timed.trajectory);
            if excess <= 1.0 {
                return Ok(self.judged(route, timed, is_smooth));
            }
            share /= excess * SLOWDOWN_MARGIN;
        }
        Err(FollowError::WristTooSlow)
    }

    /// Returns the blended motion along a whole route. If the wrist exceeds a limit between samples because of
    /// rounding, plans again with lower limits for the wrist.
    fn within_wrist(
        &self,
        route: &Route,
        speeds: &[f64],
        wrist: Option<(WristAlong, &Turns)>,
    ) -> Result<TimedMotion, FollowError> {
        let Some((limits, turns)) = wrist else { return self.blended(route, speeds, None) };
        let mut slower = limits;
        for _ in 0..SLOWDOWNS {
            let timed = self.blended(route, speeds, Some((slower, turns)))?;
            let excess = fixed_angle::excess(&limits, self.settings.share, &timed.trajectory);
            if excess <= 1.0 + WRIST_ROUNDING {
                return Ok(timed);
            }
            slower.velocity /= excess * excess;
            slower.acceleration /= excess.powi(3);
        }
        Err(FollowError::WristTooSlow)
    }

    /// Computes bounds on the deviations of a motion.
    fn judged(&self, route: &Route, timed: TimedMotion, is_smooth: bool) -> Motion {
        let deviation = self.deviation(route, [0, route.nodes.len() - 1]);
        let bounds = bounds(&deviation, &timed.trajectory, is_smooth).into_iter().enumerate();
        let (piece, bound) = bounds
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or_else(|| (0, deviation.at_rest(timed.curve.straight().path().start())));
        let farthest = self.kinematics.arm.tip_at(timed.trajectory.position[piece].into());
        let tool = self.settings.wrist.map(|WristAlong { guide, joint, .. }| {
            tool_bound(&ToolDeviation { deviation, guide }, &joint, &timed.trajectory, is_smooth)
        });
        Motion { timed, deviation: bound, tool, farthest }
    }

    /// Returns the motion along a whole route, with curved legs and blends. The arm stops for dwells, and where the
    /// wrist turns while the arm rests.
    fn blended(
        &self,
        route: &Route,
        speeds: &[f64],
        wrist: Option<(WristAlong, &Turns)>,
    ) -> Result<TimedMotion, FollowError> {
        let (q, course) = (route.path.path().waypoints(), Course::new(self, route, wrist));
        let radius = |w: usize| {
            let tool = wrist.map_or(f64::INFINITY, |(wrist, _)| self.tool_radius(&course, &wrist, w));
            self.radius(q, route, &course, w).min(tool)
        };
        let radii: Vec<f64> = (0..q.len()).map(radius).collect();
        let turn_at = |w: usize| wrist.map(|(_, turns)| turns[w]).filter(|[from, to]| from != to);
        let last = q.len() - 1;
        let stops = (1..last.max(1)).filter(|w| turn_at(*w).is_some() || self.dwell(route, *w).is_some());
        let stops: Vec<usize> = [0].into_iter().chain(stops).chain([last]).collect();
        let share = self.settings.share;
        let mut whole: Option<TimedMotion> = None;
        for pair in stops.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let own = &speeds[from..to];
            let greatest = own.iter().copied().fold(0.0, f64::max);
            let shares: Vec<f64> = own.iter().map(|speed| speed / greatest).collect();
            let values = wrist.map(|(wrist, turns)| (wrist, values_between(turns, from, to)));
            let limit = values.as_ref().map(|(WristAlong { velocity, acceleration, .. }, values)| WristLimit {
                values,
                slopes: &course.slopes[from..to],
                velocity: *velocity,
                acceleration: *acceleration,
            });
            let drive = CurveDrive { wrist: limit, ..self.drive(greatest, &shares, share) };
            let path = self.part_of_path(route, [from, to])?;
            let mut is_smooth = course.is_smooth[from..=to].to_vec();
            (is_smooth[0], is_smooth[to - from]) = (false, false);
            let curve = BlendedPath::from(path.path().clone()).curved(course.tangents[from..to].to_vec(), is_smooth);
            let curve = blend_curved(self.scene, &path, curve, &radii[from..=to], self.scene.workspace().clearance);
            let part = along_curve(self.scene, curve, drive)?;
            whole = Some(match whole {
                None => part,
                Some(mut before) => {
                    if let Some(([_, to], (wrist, _))) = turn_at(from).zip(wrist) {
                        before.trajectory.append_turn(to, share * wrist.velocity, share * share * wrist.acceleration);
                    }
                    joined(before, self.dwell(route, from), part)
                }
            });
        }
        Ok(whole.expect("at least one part"))
    }

    /// Returns motions with limited jerks between consecutive stops of a route, each with the waypoint where it begins.
    /// The arm stops where it must, at corners of the line, and where the limit on the tip's speed changes. `share` is
    /// the share of the joints' top speeds to use.
    fn smooth_parts(
        &self,
        route: &Route,
        speeds: &[f64],
        share: f64,
    ) -> Result<Vec<(usize, TimedMotion)>, FollowError> {
        let q = route.path.path().waypoints();
        let last = q.len() - 1;
        let is_corner = |w: usize| self.is_corner(route.nodes[w]) || speeds[w] != speeds[w - 1];
        let is_stop = |w: &usize| self.must_stop(q, route, *w) || is_corner(*w);
        let stops: Vec<usize> = [0].into_iter().chain((1..last).filter(is_stop)).chain([last]).collect();
        // If no motion is found for a stretch, it is halved, with a stop in the middle.
        let mut open: Vec<[usize; 2]> = stops.windows(2).rev().map(|pair| [pair[0], pair[1]]).collect();
        let mut parts = Vec::new();
        while let Some([from, to]) = open.pop() {
            checkpoint();
            let path = self.part_of_path(route, [from, to])?;
            let drive = self.drive(speeds.get(from).copied().unwrap_or(0.0), &[], share);
            match Stretch::new(self, route, [from, to], &path, drive).motion()? {
                Some(part) => parts.push((from, part)),
                None => {
                    let middle = from.midpoint(to);
                    open.extend([[middle, to], [from, middle]]);
                }
            }
        }
        Ok(parts)
    }

    /// Returns the certified path between two waypoints of a route.
    fn part_of_path(&self, route: &Route, [from, to]: [usize; 2]) -> Result<CertifiedPath, FollowError> {
        let waypoints = &route.path.path().waypoints()[from..=to];
        if waypoints.len() == route.path.path().waypoints().len() {
            return Ok(route.path.clone());
        }
        // A part of a certified path can be certified, unless the search for its certificate fails.
        certify(self.scene, Path::new(waypoints.to_vec())).map_err(|_| FollowError::Uncertified)
    }

    /// Returns the options of a motion whose tip has at most this speed. `legs` has the limit of each leg as a share of it.
    fn drive<'b>(&'b self, speed: f64, legs: &'b [f64], share: f64) -> CurveDrive<'b> {
        let is_limited = speed.is_finite() && speed > 0.0;
        let tip = is_limited.then(|| TipSpeed { legs, ..TipSpeed::new(self.scene.arm(), speed) });
        CurveDrive { tip, share, period: self.settings.period, wrist: None }
    }

    /// Returns the check of the distance between a motion and the line, from one waypoint to another.
    pub(crate) fn deviation(&self, route: &Route, waypoints: [usize; 2]) -> Deviation<'_> {
        let parts = &self.nodes.parts;
        let foot = |node: usize| match node.checked_sub(1) {
            Some(part) => self.merged.foot(Foot { piece: parts[part].piece, u: parts[part].ends[1] }),
            None => Foot { piece: 0, u: 0.0 },
        };
        let (last, end) = (route.nodes.len() - 1, Foot { piece: self.written.pieces.len() - 1, u: 1.0 });
        // The first and the last waypoint represent the ends of the line, even if the arm rests on a part of it.
        let ends = waypoints.map(|w| match w {
            0 => foot(0),
            w if w == last => end,
            w => foot(route.nodes[w]),
        });
        Deviation { kinematics: self.kinematics, line: self.written, tolerance: self.settings.tolerance, ends }
    }

    /// Returns the greatest speed of the tip on each leg, metres per second. All are infinite if no leg has a limit. If
    /// only some legs have a limit, the others get a finite speed that exceeds what the joints can do.
    fn leg_speeds(&self, route: &Route) -> Vec<f64> {
        let speed = |leg: usize| {
            let part = route.nodes[leg + 1].saturating_sub(1);
            let piece = &self.line.pieces[self.nodes.parts[part].piece];
            let stated = if piece.is_travel { None } else { self.settings.speed.or(piece.speed) };
            stated.into_iter().chain(self.settings.tip_speed).reduce(f64::min)
        };
        let speeds: Vec<Option<f64>> = (0..route.nodes.len().saturating_sub(1)).map(speed).collect();
        if speeds.iter().all(Option::is_none) {
            return vec![f64::INFINITY; speeds.len()];
        }
        let arm = self.scene.arm();
        let fastest = Configuration::from_fn(|k, _| arm.joints[k].velocity);
        let at = |q: &Configuration| self.kinematics.motion_within(*q, Configuration::zeros(), fastest);
        // Between waypoints, the joints move the tip hardly faster than at waypoints.
        let bound = 2.0 * route.path.path().waypoints().iter().map(at).fold(0.0, f64::max);
        speeds.into_iter().map(|speed| speed.unwrap_or(bound)).collect()
    }

    /// Returns the greatest radius of the blend at a waypoint with which the tip's path stays within the allowed distance.
    fn radius(&self, q: &[Configuration], route: &Route, course: &Course, w: usize) -> f64 {
        if w == 0 || w + 1 >= q.len() || self.must_stop(q, route, w) {
            return 0.0;
        }
        let directions = [course.direction(w - 1, 1), course.direction(w, 0)];
        let tips = directions.map(|d| self.kinematics.velocity(q[w], d));
        // The middle of a blend is `radius * off / 4` from the corner.
        let off = (tips[1] - tips[0]).norm();
        // At the border of the reach, the waypoint itself is not on the line.
        let room = self.blend.min(BLEND_ROOM_SHARE * (self.settings.tolerance - self.nodes.nodes[route.nodes[w]].off));
        let of_legs = [w - 1, w].into_iter().filter_map(|leg| Some(CURVED_LEG_SHARE * course.curved_length(leg)?));
        let most = of_legs.fold(f64::INFINITY, f64::min);
        if off > 0.0 { most.min(4.0 * room / off) } else { most }
    }

    /// Returns the greatest radius of the blend at a waypoint with which the tool keeps its angle.
    fn tool_radius(&self, course: &Course, wrist: &WristAlong, w: usize) -> f64 {
        if w == 0 || w >= course.slopes.len() {
            return 0.0;
        }
        let slope = |leg: usize, end: usize| {
            let of_arm = WristJoint::link_2_angle(self.scene.arm(), course.direction(leg, end).into());
            of_arm + wrist.joint.sign * course.slopes[leg][end]
        };
        // In the middle of a blend, the angle differs by `radius * off / 4`.
        let off = (slope(w, 0) - slope(w - 1, 1)).abs();
        if off > 0.0 { 4.0 * BLEND_TOOL_SHARE * wrist.guide.tolerance / off } else { f64::INFINITY }
    }

    /// Returns true if every motion must stop at an inner waypoint: a travel begins or ends there, the line has a dwell
    /// there, or the joints turn back.
    pub(crate) fn must_stop(&self, q: &[Configuration], route: &Route, w: usize) -> bool {
        let [before, after] = legs(q, w);
        self.is_stop(route.nodes[w]) || self.dwell(route, w).is_some() || before.dot(&after) < REVERSAL_COSINE
    }

    /// Returns the duration of the dwell at a waypoint, seconds. `None` if the line has none there.
    fn dwell(&self, route: &Route, w: usize) -> Option<f64> {
        // A waypoint represents all nodes after the previous waypoint.
        let first = w.checked_sub(1).map_or(0, |before| route.nodes[before] + 1);
        let parts = (first.max(1)..=route.nodes[w]).map(|node| self.nodes.parts[node - 1]);
        let ends = parts.filter(|part| part.ends[1] == 1.0);
        ends.filter_map(|part| self.line.pieces[part.piece].dwell).reduce(|a, b| a + b)
    }

    /// Returns true if two pieces of the line meet at a node, and a motion with limited jerks must stop there.
    fn is_corner(&self, node: usize) -> bool {
        let parts = &self.nodes.parts;
        let Some((before, after)) = node.checked_sub(1).and_then(|part| parts.get(part).zip(parts.get(node))) else {
            return false;
        };
        let ends = [(before.piece, 1.0), (after.piece, 0.0)];
        let directions = ends.map(|(piece, end)| self.line.curve(piece).direction(end));
        let [Some(a), Some(b)] = directions else { return true };
        before.piece != after.piece && a[0] * b[0] + a[1] * b[1] < SMOOTH_CORNER_COSINE
    }

    /// Returns true if the tip stops at a node because a travel begins or ends there.
    fn is_stop(&self, node: usize) -> bool {
        let piece = |part: usize| self.nodes.parts.get(part).map(|part| part.piece);
        let ends = node.checked_sub(1).and_then(piece).zip(piece(node));
        ends.is_some_and(|(before, after)| before != after && self.merged.stops[after])
    }
}

/// Joins two motions. `dwell` is the rest in between, seconds.
fn joined(mut before: TimedMotion, dwell: Option<f64>, next: TimedMotion) -> TimedMotion {
    before.trajectory.then(dwell.unwrap_or(0.0), &next.trajectory);
    TimedMotion { curve: before.curve.then(&next.curve), ..before }
}

/// Returns the unit directions of the legs before and after an inner waypoint.
fn legs(q: &[Configuration], w: usize) -> [Configuration; 2] {
    [q[w] - q[w - 1], q[w + 1] - q[w]].map(|leg| leg / leg.norm())
}
