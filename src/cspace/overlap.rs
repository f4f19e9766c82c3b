//! Proof that a link part and an obstacle piece overlap all over a quadrilateral of configurations.

use super::chord::PairMotion;
use crate::geometry::{Convex, Point, Pose, Vector, common, perpendicular, segments_cross};
use crate::model::Arm;
use crate::space::Configuration;

/// A quadrilateral of configurations as two of its sides, each at one value of `q1` from its lower end to its upper.
pub(super) type Quad = [[Configuration; 2]; 2];

/// Times that a quadrilateral is halved across the strip, before it counts as not proven.
const HALVINGS: u32 = 24;

/// A part of link 2 and an obstacle piece, which *overlap* where their cores are at most `radius` apart.
///
/// The bound of [`Overlaps::everywhere`]. Follow one point `x` of the part over a quadrilateral. Its place in the world is
/// a smooth function of the two coordinates of the quadrilateral, no farther from the bilinear interpolation of its
/// places at the four corners than an eighth of the sum of the second derivatives. The distance of a point from a convex
/// set, negative inside, is a convex function. So `x` is nowhere farther from the piece than at the farthest of the
/// corners, plus that eighth; and where `x` is within `radius` of the piece they overlap. The same holds for a point of
/// the piece as seen from the link. Shapes without area may cross with no point inside either: then the ends of each core
/// stay on different sides of the line through the other, by the same argument.
pub(super) struct Overlaps<'a> {
    arm: &'a Arm,
    part: &'a Convex,
    piece: &'a Convex,
    motion: PairMotion<'a>,
    radius: f64,
}

impl<'a> Overlaps<'a> {
    /// The pair; `part` in link 2's frame.
    pub fn new(arm: &'a Arm, part: &'a Convex, piece: &'a Convex, radius: f64) -> Self {
        Self { arm, part, piece, motion: PairMotion::new(arm, part, piece), radius }
    }

    /// Bound on the motion of the shapes relative to each other per unit of `q1`.
    pub fn speed(&self) -> f64 {
        self.motion.speed()
    }

    /// Whether the pair is proven to overlap at every configuration of the quadrilateral. True says so; false says
    /// nothing.
    pub fn everywhere(&self, quad: &Quad) -> bool {
        self.halved(quad, HALVINGS)
    }

    fn halved(&self, quad: &Quad, halvings: u32) -> bool {
        self.follows(quad)
            || halvings > 0 && {
                let middle = quad.map(|[lower, upper]| (lower + upper) / 2.0);
                let below = [[quad[0][0], middle[0]], [quad[1][0], middle[1]]];
                let above = [[middle[0], quad[0][1]], [middle[1], quad[1][1]]];
                // Where the middle is free no halving will help.
                self.depth((middle[0] + middle[1]) / 2.0) >= 0.0
                    && self.halved(&below, halvings - 1)
                    && self.halved(&above, halvings - 1)
            }
    }

    /// How much farther apart the cores may be at `q`.
    pub fn depth(&self, q: Configuration) -> f64 {
        self.radius - self.motion.separation(q).distance - self.part.radius() - self.piece.radius()
    }

    /// Whether one point or one crossing stands for the whole quadrilateral.
    fn follows(&self, quad: &Quad) -> bool {
        let [world, link] = self.deviations(quad);
        let corners = [quad[0][0], quad[0][1], quad[1][0], quad[1][1]];
        let poses = corners.map(|q| self.arm.pose(1, q));
        let (part, piece) = (self.part.core(), self.piece.core());
        let from_world = |x: &Point| poses.iter().all(|pose| distance(pose * x, piece) + world <= self.radius);
        let from_link = |y: &Point| poses.iter().all(|pose| distance(pose.inverse() * y, part) + link <= self.radius);
        if world <= self.radius + self.depth_of(piece) && part.iter().any(from_world) {
            return true;
        }
        if link <= self.radius + self.depth_of(part) && piece.iter().any(from_link) {
            return true;
        }
        let center = self.arm.pose(1, (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0);
        if let Some(y) = self.common_point(&center) {
            return from_link(&y) || from_world(&(center.inverse() * y));
        }
        self.radius == 0.0 && self.cross(&poses, world, link)
    }

    /// An upper bound on how deep a point can lie in a core.
    fn depth_of(&self, core: &[Point]) -> f64 {
        if core.len() > 2 { f64::INFINITY } else { 0.0 }
    }

    /// The middle of what the cores have in common with the link at `pose`, if one of them has area.
    fn common_point(&self, pose: &Pose) -> Option<Point> {
        let part: Vec<Point> = self.part.core().iter().map(|a| pose * a).collect();
        let piece = self.piece.core();
        let both = match (part.len() > 2, piece.len() > 2) {
            (_, true) => common(&part, piece),
            (true, false) => common(piece, &part),
            (false, false) => return None,
        };
        let sum: Vector = both.iter().map(|p| p.coords).sum();
        (!both.is_empty()).then(|| Point::from(sum / both.len() as f64))
    }

    /// Whether two segments cross with the link at any of `poses`, and between them as far as the deviations go.
    fn cross(&self, poses: &[Pose; 4], world: f64, link: f64) -> bool {
        let (&[a, b], &[c, d]) = (self.part.core(), self.piece.core()) else { return false };
        let first = &poses[0];
        if !segments_cross(first * a, first * b, c, d) {
            return false;
        }
        let parted = |line: [Point; 2], ends: &dyn Fn(&Pose) -> [Point; 2], deviation: f64| {
            let normal = perpendicular(line[1] - line[0]).normalize();
            let heights = poses.map(|pose| ends(&pose).map(|p| normal.dot(&(p - line[0]))));
            let side = heights[0][0].signum();
            heights.iter().all(|[p, q]| side * p > deviation && -side * q > deviation)
        };
        parted([c, d], &|pose| [pose * a, pose * b], world)
            && parted([a, b], &|pose| [pose.inverse() * c, pose.inverse() * d], link)
    }

    /// How far a point of the part, seen from the world, and one of the piece, seen from the link, may be from the
    /// interpolation of its places at the corners.
    fn deviations(&self, [u, v]: &Quad) -> [f64; 2] {
        let along = [self.motion.curvatures(u[0], v[0]), self.motion.curvatures(u[1], v[1])];
        let across = [self.motion.curvatures(u[0], u[1]), self.motion.curvatures(v[0], v[1])];
        [0, 1].map(|k| (along[0][k].max(along[1][k]) + across[0][k].max(across[1][k])) / 8.0)
    }
}

/// Signed distance of a point from a convex polygon (negative inside), segment or point: a convex function.
fn distance(p: Point, core: &[Point]) -> f64 {
    let n = core.len();
    let (mut inside, mut nearest) = (f64::NEG_INFINITY, f64::INFINITY);
    for (i, &a) in core.iter().enumerate() {
        let along = core[(i + 1) % n] - a;
        let length = along.norm();
        let to = p - a;
        if length > 0.0 {
            let unit = along / length;
            inside = inside.max(-perpendicular(unit).dot(&to));
            let t = unit.dot(&to).clamp(0.0, length);
            nearest = nearest.min((to - unit * t).norm());
        } else {
            nearest = nearest.min(to.norm());
        }
    }
    if n > 2 && inside <= 0.0 { inside } else { nearest }
}
