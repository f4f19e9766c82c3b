//! The motion in time along a sequence of configurations.

use crate::deviation::bounds;
use crate::nodes::Nodes;
use crate::search::Route;
use crate::smooth::Stretch;
use crate::{FollowError, Settings};
use cplan_core::check::{CertifiedPath, certify};
use cplan_core::model::Scene;
use cplan_core::space::{Configuration, Path};
use cplan_deviation::{Deviation, Foot, Kinematics, Line};
use cplan_interrupt::checkpoint;
use cplan_motion::{CurveDrive, TimedMotion, TipSpeed, along_curve, blend_up_to};

/// Cosine of the angle between two legs beyond which the motion stops between them: it almost returns on itself.
const REVERSAL_COSINE: f64 = -0.95;

/// Cosine of the angle by which the tip may turn at a corner that a motion with limited jerk passes without a stop.
const SMOOTH_CORNER_COSINE: f64 = 0.985;

/// The input of a motion.
pub(crate) struct Driver<'a> {
    pub scene: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    pub line: &'a Line<'a>,
    pub nodes: &'a Nodes,
    pub settings: &'a Settings,
    /// Greatest distance of a blend from its corner, for the tip, metres.
    pub blend: f64,
}

impl Driver<'_> {
    /// Returns the fastest motion along a route that is found, with a bound on its distance from the line, metres.
    pub fn motion(&self, route: &Route) -> Result<(TimedMotion, f64), FollowError> {
        let joints = &self.scene.arm().joints;
        let is_smooth = joints.iter().any(|joint| joint.jerk.is_some());
        let speeds = self.leg_speeds(route);
        let q = route.path.path().waypoints();
        let parts = if is_smooth { self.smooth_parts(route, &speeds)? } else { vec![self.blended(route, &speeds)?] };
        let joined = |mut before: TimedMotion, next: TimedMotion| {
            before.trajectory.then(0.0, &next.trajectory);
            TimedMotion { curve: before.curve.then(&next.curve), ..before }
        };
        let whole = parts.into_iter().reduce(joined);
        let timed = whole.expect("at least one part");
        let deviation = self.deviation(route, [0, q.len() - 1]);
        let greatest = bounds(&deviation, &timed.trajectory, is_smooth).into_iter().reduce(f64::max);
        let bound = greatest.unwrap_or_else(|| deviation.at_rest(timed.curve.straight().path().start()));
        Ok((timed, bound))
    }

    /// Returns the motion along a whole route with blends.
    fn blended(&self, route: &Route, speeds: &[f64]) -> Result<TimedMotion, FollowError> {
        let q = route.path.path().waypoints();
        let radii: Vec<f64> = (0..q.len()).map(|w| self.radius(q, route, w)).collect();
        let greatest = speeds.iter().copied().fold(0.0, f64::max);
        let shares: Vec<f64> = speeds.iter().map(|speed| speed / greatest).collect();
        let drive = self.drive(greatest, &shares);
        let curve = blend_up_to(self.scene, &route.path, &radii, self.scene.workspace().clearance);
        Ok(along_curve(self.scene, curve, drive)?)
    }

    /// Returns the motions with limits on jerks from each stop of a route to the next one. The arm stops where it must,
    /// at corners of the line, and where the limit on the tip's speed changes.
    fn smooth_parts(&self, route: &Route, speeds: &[f64]) -> Result<Vec<TimedMotion>, FollowError> {
        let q = route.path.path().waypoints();
        let last = q.len() - 1;
        let is_corner = |w: usize| self.is_corner(route.nodes[w]) || speeds[w] != speeds[w - 1];
        let is_stop = |w: &usize| self.must_stop(q, route, *w) || is_corner(*w);
        let stops: Vec<usize> = [0].into_iter().chain((1..last).filter(is_stop)).chain([last]).collect();
        // A stretch without a motion is halved, with a stop between the halves.
        let mut open: Vec<[usize; 2]> = stops.windows(2).rev().map(|pair| [pair[0], pair[1]]).collect();
        let mut parts = Vec::new();
        while let Some([from, to]) = open.pop() {
            checkpoint();
            let path = self.part_of_path(route, [from, to])?;
            let drive = self.drive(speeds.get(from).copied().unwrap_or(0.0), &[]);
            match Stretch::new(self, route, [from, to], &path, drive).motion()? {
                Some(part) => parts.push(part),
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
        // The whole path is certified, so the part is as well, unless the search takes another course.
        let clearance = self.scene.workspace().clearance;
        certify(self.scene, Path::new(waypoints.to_vec()), clearance).map_err(|_| FollowError::Uncertified)
    }

    /// Returns the options of a motion with a limit on the tip's speed, which legs use in shares.
    fn drive<'b>(&'b self, speed: f64, legs: &'b [f64]) -> CurveDrive<'b> {
        let is_limited = speed.is_finite() && speed > 0.0;
        let tip = is_limited.then(|| TipSpeed { legs, ..TipSpeed::new(self.scene.arm(), speed) });
        CurveDrive { tip, share: self.settings.share, period: self.settings.period }
    }

    /// Returns the check of the distance between the line and a motion from one waypoint to another.
    pub(crate) fn deviation(&self, route: &Route, waypoints: [usize; 2]) -> Deviation<'_> {
        let parts = &self.nodes.parts;
        let foot = |node: usize| match node.checked_sub(1) {
            Some(part) => Foot { piece: parts[part].piece, u: parts[part].ends[1] },
            None => Foot { piece: 0, u: 0.0 },
        };
        let last = route.nodes.len() - 1;
        // The first and the last waypoints stand for the ends of the line, even if the arm rests on a part of it.
        let ends = waypoints.map(|w| match w {
            0 => foot(0),
            w if w == last => foot(self.nodes.nodes.len() - 1),
            w => foot(route.nodes[w]),
        });
        Deviation { kinematics: self.kinematics, line: self.line, tolerance: self.settings.tolerance, ends }
    }

    /// Returns the greatest speed of the tip on each leg, metres per second; infinite without a limit.
    ///
    /// The limits of the joints bound the tip's speed as well, so legs without a limit get a finite speed if others have
    /// one.
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
        // Between waypoints the tip's reach is hardly greater than at them.
        let bound = 2.0 * route.path.path().waypoints().iter().map(at).fold(0.0, f64::max);
        speeds.into_iter().map(|speed| speed.unwrap_or(bound)).collect()
    }

    /// Returns the greatest radius of the blend at a waypoint: the tip's path stays within the allowed distance.
    fn radius(&self, q: &[Configuration], route: &Route, w: usize) -> f64 {
        if w == 0 || w + 1 >= q.len() || self.must_stop(q, route, w) {
            return 0.0;
        }
        let tips = legs(q, w).map(|d| self.kinematics.velocity(q[w], d));
        // The middle of a blend is at a quarter of this times the radius from the corner.
        let off = (tips[1] - tips[0]).norm();
        if off > 0.0 { 4.0 * self.blend / off } else { f64::INFINITY }
    }

    /// Returns true if every motion stops at an inner waypoint: a travel begins or ends there, or the joints turn back.
    fn must_stop(&self, q: &[Configuration], route: &Route, w: usize) -> bool {
        let [before, after] = legs(q, w);
        self.is_stop(route.nodes[w]) || before.dot(&after) < REVERSAL_COSINE
    }

    /// Returns true if two pieces of the line meet at a node, and their directions differ too much for a motion with
    /// limited jerk.
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
        let is_travel = |part: usize| self.nodes.parts.get(part).map(|part| self.line.pieces[part.piece].is_travel);
        node > 0 && is_travel(node - 1) != is_travel(node)
    }
}

/// Returns the unit directions of the legs before and after an inner waypoint.
fn legs(q: &[Configuration], w: usize) -> [Configuration; 2] {
    [q[w] - q[w - 1], q[w + 1] - q[w]].map(|leg| leg / leg.norm())
}
