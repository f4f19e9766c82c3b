//! The motion in time along a sequence of configurations.

use crate::deviation::bounds;
use crate::nodes::Nodes;
use crate::search::Route;
use crate::{FollowError, Settings};
use cplan_core::check::certify;
use cplan_core::model::Scene;
use cplan_core::space::{Configuration, Path};
use cplan_deviation::{Deviation, Foot, Kinematics, Line};
use cplan_motion::{CertifiedCurve, CurveDrive, TimedMotion, TipSpeed, along_curve, blend_up_to};

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
        let radii: Vec<f64> = (0..q.len()).map(|w| self.radius(q, route, w, is_smooth)).collect();
        // With limits on jerks, one motion has one limit on the tip's speed.
        let cut = |w: &usize| is_smooth && speeds[*w] != speeds[*w - 1];
        let mut ends: Vec<usize> = (1..q.len().saturating_sub(1)).filter(cut).collect();
        ends.insert(0, 0);
        ends.push(q.len() - 1);
        let mut whole: Option<TimedMotion> = None;
        for pair in ends.windows(2) {
            let part = self.part(route, [pair[0], pair[1]], &radii, &speeds, is_smooth)?;
            whole = Some(match whole {
                None => part,
                Some(mut before) => {
                    before.trajectory.then(0.0, &part.trajectory);
                    TimedMotion { curve: before.curve.then(&part.curve), ..before }
                }
            });
        }
        let timed = whole.expect("at least one part");
        let deviation = self.deviation(route, [0, q.len() - 1]);
        let greatest = bounds(&deviation, &timed.trajectory, is_smooth).into_iter().reduce(f64::max);
        let bound = greatest.unwrap_or_else(|| deviation.at_rest(timed.curve.straight().path().start()));
        Ok((timed, bound))
    }

    /// Returns the motion between two waypoints of a route.
    fn part(
        &self,
        route: &Route,
        ends: [usize; 2],
        radii: &[f64],
        speeds: &[f64],
        is_smooth: bool,
    ) -> Result<TimedMotion, FollowError> {
        let [from, to] = ends;
        let clearance = self.scene.workspace().clearance;
        let path = if to - from + 1 == route.path.path().waypoints().len() {
            route.path.clone()
        } else {
            let waypoints = route.path.path().waypoints()[from..=to].to_vec();
            // The whole path is certified, so the part is as well, unless the search takes another course.
            certify(self.scene, Path::new(waypoints), clearance).map_err(|_| FollowError::Uncertified)?
        };
        let greatest = speeds.get(from..to).unwrap_or_default().iter().copied().fold(0.0, f64::max);
        let shares: Vec<f64> = speeds[from..to].iter().map(|speed| speed / greatest).collect();
        let is_limited = greatest.is_finite() && greatest > 0.0;
        let tip = is_limited.then(|| TipSpeed { legs: &shares, ..TipSpeed::new(self.scene.arm(), greatest) });
        let drive = CurveDrive { tip, share: self.settings.share, period: self.settings.period };
        let deviation = self.deviation(route, ends);
        let tolerance = self.settings.tolerance;
        let too_far = |pieces: &[cplan_handling::Piece]| {
            let bounds = deviation.of_pieces(pieces);
            (0..bounds.len()).filter(|&i| bounds[i] > tolerance).collect::<Vec<_>>()
        };
        let curve = blend_up_to(self.scene, &path, &radii[from..=to], clearance);
        let timed = along_curve(self.scene, curve, drive, &too_far)?;
        if is_smooth && !too_far(&timed.trajectory.pieces()).is_empty() {
            // Stopping everywhere stays on the path.
            return Ok(along_curve(self.scene, CertifiedCurve::from(path), drive, &too_far)?);
        }
        Ok(timed)
    }

    fn deviation(&self, route: &Route, waypoints: [usize; 2]) -> Deviation<'_> {
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
    fn radius(&self, q: &[Configuration], route: &Route, w: usize, is_smooth: bool) -> f64 {
        if w == 0 || w + 1 >= q.len() || self.is_stop(route.nodes[w]) {
            return 0.0;
        }
        let [before, after] = [q[w] - q[w - 1], q[w + 1] - q[w]].map(|leg| leg / leg.norm());
        if before.dot(&after) < REVERSAL_COSINE {
            return 0.0;
        }
        let tips = [before, after].map(|d| self.kinematics.velocity(q[w], d));
        if is_smooth && tips[0].dot(&tips[1]) < SMOOTH_CORNER_COSINE * tips[0].norm() * tips[1].norm() {
            return 0.0;
        }
        // The middle of a blend is at a quarter of this times the radius from the corner.
        let off = (tips[1] - tips[0]).norm();
        if off > 0.0 { 4.0 * self.blend / off } else { f64::INFINITY }
    }

    /// Returns true if the tip stops at a node because a travel begins or ends there.
    fn is_stop(&self, node: usize) -> bool {
        let is_travel = |part: usize| self.nodes.parts.get(part).map(|part| self.line.pieces[part.piece].is_travel);
        node > 0 && is_travel(node - 1) != is_travel(node)
    }
}
