//! Motions with limited jerks, along smooth curves in joint space near the line.
//!
//! Between two stops, the curve is a cubic B-spline. Its control points begin as configurations with the tip on the
//! line. Each is then moved outwards by a sixth of the second difference, so that the spline almost passes through
//! these configurations, and rounds corners. Where the spline is too far from the line, the control points are placed
//! more densely. The crate `cplan-motion` finds the fastest motion along the spline.
//!
//! If a hairpin of the line is narrower than the tolerance, the check of the distance may assign a place of the motion
//! to the second leg too early, and then finds everything after it too far from the line. Denser control points do not
//! help. A curve within a small share of the tolerance does, because the check changes to the second leg only if that
//! is nearer by such a share.

use crate::follower::SLACK_SHARE;
use crate::motion::Driver;
use crate::search::Route;
use crate::spacing::Spacing;
use crate::{FollowError, MIN_TOLERANCE};
use cplan_handling::Piece;
use cplan_interrupt::checkpoint;
use cplan_judge::CertifiedPath;
use cplan_model::Motors;
use cplan_model::space::Configuration;
use cplan_motion::{CertifiedCurve, CurveDrive, JointCurve, TimedMotion, along_curve, along_joint_curve};
use std::cell::Cell;

/// Shares of the tolerance for the curve. They are tried in turn until a motion is found without a vain round.
const TOLERANCE_SHARES: [f64; 3] = [1.0, 0.1, 0.01];

/// Share of the tolerance that the curve may use. The motion along the curve needs the rest, because it cuts bends, too.
const CURVE_SHARE: f64 = 0.6;

/// Size of a waypoint's neighbourhood: the waypoint is this far from the chord of the neighbourhood, as a multiple of
/// the tolerance. The first spacing of the control points is proportional to this size. So the spacing depends on the
/// line's bends, and not on the number of pieces in the file.
const BULGE_TOLERANCES: f64 = 3.0;

/// First spacing of the control points, as a multiple of half the size of a neighbourhood.
const FIRST_SPACING: f64 = 3.0;

/// Least number of spacings on a stretch. More of them would slow down the beginning of the motion, which passes the
/// first ones in a fixed sequence of jerks.
const MIN_SPACINGS: f64 = 16.0;

/// Least spacing at the ends of a stretch, as a share of the greatest spacing.
const MIN_END_SHARE: f64 = 0.01;

/// Greatest number of rounds. Each round places control points more densely.
const MAX_ROUNDS: usize = 24;

/// Number of vain rounds after which the search for a curve ends. In a vain round, more pieces are too far from the
/// line than before, although the control points are denser. Usually, one round leaves only a few.
const MAX_VAIN_ROUNDS: usize = 2;

/// Greatest number of control points of a stretch.
const MAX_POINTS: usize = 50_000;

/// Greatest number of steps of a motion per piece of its curve, if the motion is too far from the line. Six halvings of
/// the steps reduce the distance between motion and curve by a factor of four thousand.
const MAX_STEPS_PER_PIECE: usize = 64;

/// Number of steps up to which halving is always allowed.
const FREE_STEPS: usize = 20_000;

/// Number of iterations that find the point of the line next to a point of a leg.
const FOOT_STEPS: u32 = 3;

/// The result of the search for a curve.
struct Search {
    /// The curve; `None` if every curve tried is too far from the line.
    curve: Option<JointCurve>,
    vain_rounds: usize,
}

/// A part of a route between two stops.
pub(crate) struct Stretch<'a> {
    pub driver: &'a Driver<'a>,
    pub route: &'a Route,
    /// The first and the last waypoint.
    pub ends: [usize; 2],
    pub path: &'a CertifiedPath,
    pub drive: CurveDrive<'a>,
    /// Distance of each waypoint from the first one along the path, in joint space.
    distances: Vec<f64>,
}

impl<'a> Stretch<'a> {
    pub fn new(
        driver: &'a Driver<'a>,
        route: &'a Route,
        ends: [usize; 2],
        path: &'a CertifiedPath,
        drive: CurveDrive<'a>,
    ) -> Self {
        let mut distances = vec![0.0];
        for (a, b) in path.path().segments() {
            distances.push(distances[distances.len() - 1] + (b - a).norm());
        }
        Self { driver, route, ends, path, drive, distances }
    }

    /// Returns the fastest motion found, from rest to rest without a stop in between.
    pub fn motion(&self) -> Result<Option<TimedMotion>, FollowError> {
        if self.ends[1] - self.ends[0] <= 1 {
            let curve = CertifiedCurve::from(self.path.clone());
            return Ok(Some(along_curve(self.driver.scene, curve, self.drive)?));
        }
        let mut best: Option<TimedMotion> = None;
        for share in TOLERANCE_SHARES {
            let tolerance = share * self.driver.settings.tolerance;
            if share < 1.0 && tolerance < MIN_TOLERANCE {
                break;
            }
            let Search { curve, vain_rounds } = self.curve(tolerance);
            let found = curve.and_then(|curve| self.motion_along(&curve, tolerance));
            let duration = |timed: &TimedMotion| timed.trajectory.duration();
            best = best.into_iter().chain(found).min_by(|a, b| duration(a).total_cmp(&duration(b)));
            if best.is_some() && vain_rounds == 0 {
                break;
            }
        }
        Ok(best)
    }

    /// Returns the fastest motion found along a curve, within a tolerance of the line.
    fn motion_along(&self, curve: &JointCurve, tolerance: f64) -> Option<TimedMotion> {
        let most = FREE_STEPS.max(MAX_STEPS_PER_PIECE * curve.pieces().len());
        // Beyond the allowed number of steps, report no piece as too far, so that the search ends. Its result is then dropped.
        let is_dropped = Cell::new(false);
        let too_far = |pieces: &[Piece]| {
            let far = if is_dropped.get() { vec![] } else { self.too_far(pieces, tolerance, 1.0) };
            if far.is_empty() || pieces.len() <= most {
                return far;
            }
            is_dropped.set(true);
            vec![]
        };
        let timed = along_joint_curve(self.driver.scene, self.path, curve, self.drive, &too_far)?;
        (!is_dropped.get()).then_some(timed)
    }

    /// Returns the indices of the pieces whose distance from the line exceeds a share of the tolerance.
    fn too_far(&self, pieces: &[Piece], tolerance: f64, share: f64) -> Vec<usize> {
        let tolerance = share * tolerance;
        let mut deviation = self.driver.deviation(self.route, self.ends);
        deviation.tolerance = tolerance;
        let bounds = deviation.of_pieces(pieces);
        (0..bounds.len()).filter(|&i| bounds[i] > tolerance).collect()
    }

    /// Searches for a smooth curve that is within a tolerance of the line and within the limits of the joints.
    fn curve(&self, tolerance: f64) -> Search {
        let mut spacing = self.first_spacing(tolerance);
        let (mut vain_rounds, mut before) = (0, usize::MAX);
        for _ in 0..MAX_ROUNDS {
            checkpoint();
            let distances = spacing.distances();
            if distances.len() > MAX_POINTS {
                break;
            }
            let curve = JointCurve::new(&self.control(&distances));
            let pieces = curve.pieces();
            let mut far = self.too_far(&pieces, tolerance, CURVE_SHARE);
            if far.is_empty() {
                // With the whole tolerance, the check may assign pieces to other places of the line.
                far = self.too_far(&pieces, tolerance, 1.0);
            }
            if far.is_empty() {
                return Search { curve: Some(curve), vain_rounds };
            }
            vain_rounds += usize::from(far.len() > before);
            if vain_rounds == MAX_VAIN_ROUNDS {
                break;
            }
            before = far.len();
            let mut is_marked = vec![false; distances.len()];
            for piece in far {
                // A piece lies between two points, but also depends on their neighbours.
                let until = (piece + 2).min(distances.len());
                is_marked[piece.saturating_sub(2)..until].fill(true);
            }
            spacing = spacing.finer(&distances, &is_marked);
        }
        Search { curve: None, vain_rounds }
    }

    /// Returns the first spacing, which follows from the bends at the waypoints.
    fn first_spacing(&self, tolerance: f64) -> Spacing {
        let length = self.distances[self.distances.len() - 1];
        let widest = length / MIN_SPACINGS;
        let last = self.distances.len() - 1;
        let end = |leg: usize| self.start_distance(leg).clamp(MIN_END_SHARE * widest, widest);
        let inner =
            (1..last).map(|w| [self.distances[w], widest.min(FIRST_SPACING * self.half_neighborhood(w, tolerance))]);
        let mut places: Vec<[f64; 2]> =
            [[0.0, end(0)]].into_iter().chain(inner).chain([[length, end(last - 1)]]).collect();
        // Legs may be so short that their distances are equal after rounding.
        places.dedup_by(|next, place| next[0] <= place[0]);
        Spacing::new(places)
    }

    /// Estimates the distance in which a motion along a leg reaches its top speed from rest with the limited jerk. The
    /// first spacing after a stop has a fixed sequence of jerks.
    fn start_distance(&self, leg: usize) -> f64 {
        let (q, arm) = (self.path.path().waypoints(), self.driver.scene.arm());
        let joints = &arm.joints;
        let direction = (q[leg + 1] - q[leg]) / (q[leg + 1] - q[leg]).norm();
        let along = |limits: [f64; 2]| (limits[0] / direction[0].abs()).min(limits[1] / direction[1].abs());
        let tip = self.driver.kinematics.velocity(q[leg], direction).norm();
        let tip_speed = self.drive.tip.map_or(f64::INFINITY, |limit| limit.speed / tip);
        let share = self.drive.share;
        let speed = (share * along([0, 1].map(|k| joints[k].velocity))).min(tip_speed);
        let of_sum = |motors: Motors| Some(motors.jerk? / motors.joint_sum(direction).abs());
        let of_sum = arm.motors.and_then(of_sum).unwrap_or(f64::INFINITY);
        let jerk = share.powi(3) * along([0, 1].map(|k| joints[k].jerk.unwrap_or(f64::INFINITY))).min(of_sum);
        if jerk.is_finite() { speed * (speed / jerk).sqrt() } else { f64::INFINITY }
    }

    /// Returns half the size of a neighbourhood of an inner waypoint in which the path is almost straight.
    fn half_neighborhood(&self, w: usize, tolerance: f64) -> f64 {
        let (q, d) = (self.path.path().waypoints(), &self.distances);
        let most = BULGE_TOLERANCES * tolerance;
        let (mut half, mut around) = (0.0, 1);
        loop {
            let [from, to] = [w.saturating_sub(around), (w + around).min(d.len() - 1)];
            let share = (d[w] - d[from]) / (d[to] - d[from]);
            let off = q[w] - (q[from] + (q[to] - q[from]) * share);
            let off = self.driver.kinematics.velocity(q[w], off).norm();
            let own = (d[w] - d[from]).min(d[to] - d[w]);
            if off > most {
                // On a bend, the distance from the chord grows with the square of the size.
                return f64::max(half, own * (most / off).sqrt());
            }
            half = own;
            if from == 0 || to + 1 == d.len() {
                // Near an end, the neighbourhood extends at least to that end.
                return half;
            }
            around *= 2;
        }
    }

    /// Returns control points of a spline near the line, one for each of these distances along the path.
    fn control(&self, distances: &[f64]) -> Vec<Configuration> {
        let mut leg = 0;
        let on_line = |&distance: &f64| {
            while leg + 2 < self.distances.len() && self.distances[leg + 1] < distance {
                leg += 1;
            }
            self.at(leg, distance)
        };
        let points: Vec<Configuration> = distances.iter().map(on_line).collect();
        let mut control = points.clone();
        for (own, three) in control[1..].iter_mut().zip(points.windows(3)) {
            *own = self.within_limits(three[1] - (three[0] - three[1] * 2.0 + three[2]) / 6.0);
        }
        control
    }

    /// Returns the configuration that puts the tip on the line, at a distance along the path in joint space.
    fn at(&self, leg: usize, distance: f64) -> Configuration {
        let q = self.path.path().waypoints();
        let (from, along) = (q[leg], q[leg + 1] - q[leg]);
        let length = self.distances[leg + 1] - self.distances[leg];
        let share = if length > 0.0 { (distance - self.distances[leg]) / length } else { 1.0 };
        let straight = if share >= 1.0 { q[leg + 1] } else { from + along * share };
        let nodes = [0, 1].map(|k| self.route.nodes[self.ends[0] + leg + k]);
        if share <= 0.0 || share >= 1.0 || nodes[0] + 1 != nodes[1] {
            return straight;
        }
        let part = &self.driver.nodes.parts[nodes[0]];
        let on_line = |u: f64| self.solution_near(straight, part.piece, u);
        // Find the parameter at which the configuration of the line is level with the straight one. The distance along
        // the leg increases with the parameter.
        let [mut low, mut high] = [(part.ends[0], -share), (part.ends[1], 1.0 - share)];
        let mut found = straight;
        for _ in 0..FOOT_STEPS {
            let u = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            let Some(near) = on_line(u) else { return straight };
            found = near;
            let ahead = (near - straight).dot(&along) / along.norm_squared();
            *(if ahead < 0.0 { &mut low } else { &mut high }) = (u, ahead);
        }
        self.within_limits(found)
    }

    /// Returns the IK solution at a place of the line that is closest to a configuration.
    fn solution_near(&self, near: Configuration, piece: usize, u: f64) -> Option<Configuration> {
        let kinematics = self.driver.kinematics;
        let slack = SLACK_SHARE * self.driver.settings.tolerance;
        let target = kinematics.reachable(self.driver.line.curve(piece).at(u).into(), slack)?;
        let off = |q: &Configuration| (q - near).norm_squared();
        kinematics
            .solutions(target)?
            .into_iter()
            .map(|q| kinematics.near(q, near))
            .min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    fn within_limits(&self, q: Configuration) -> Configuration {
        Configuration::from_fn(|k, _| self.driver.scene.arm().joints[k].range.clamp(q[k]))
    }
}
