//! Proof that a link part and an obstacle piece overlap all over a quadrilateral of configurations.

use super::chord::PairMotion;
use crate::geometry::{Convex, Point, Pose, Vector, common, perpendicular, segments_cross};
use crate::interrupt::checkpoint;
use crate::model::Arm;
use crate::space::Configuration;
use std::cell::Cell;

/// A quadrilateral of configurations as two of its sides, each at one value of `q1` from its lower end to its upper.
pub(super) type Quad = [[Configuration; 2]; 2];

/// Times that a quadrilateral is halved across the strip, before it counts as not proven.
const HALVINGS: u32 = 24;

/// Quadrilaterals looked at for one pair: a hundred times what contours within a millionth of the reach take, and some
/// tenths of a second. Pairs that graze each other all along a curve could take without end.
const MOST_LOOKS: u32 = 400_000;

/// After so many halvings without success the middle is looked at.
const LOOK: u32 = 6;

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
    /// Half-planes of the cores.
    sides: [Vec<(Vector, f64)>; 2],
    motion: PairMotion<'a>,
    radius: f64,
    /// Looks at single quadrilaterals that are left.
    looks: Cell<u32>,
}

/// A corner of a quadrilateral and the link there.
type Corner = (Configuration, Pose);

impl<'a> Overlaps<'a> {
    /// The pair; `part` in link 2's frame.
    pub fn new(arm: &'a Arm, part: &'a Convex, piece: &'a Convex, radius: f64) -> Self {
        let sides = [half_planes(part.core()), half_planes(piece.core())];
        Self {
            arm,
            part,
            piece,
            sides,
            motion: PairMotion::new(arm, part, piece),
            radius,
            looks: Cell::new(MOST_LOOKS),
        }
    }

    /// Bound on the motion of the shapes relative to each other per unit of `q1`.
    pub fn speed(&self) -> f64 {
        self.motion.speed()
    }

    /// Whether so much has been looked at that nothing more will be proven.
    pub fn is_spent(&self) -> bool {
        self.looks.get() == 0
    }

    /// Whether the pair is proven to overlap at every configuration of the quadrilateral. True says so; false says
    /// nothing.
    pub fn everywhere(&self, quad: &Quad) -> bool {
        self.halved(&quad.map(|side| side.map(|q| self.corner(q))), HALVINGS)
    }

    /// How much farther apart the cores may be at `q`.
    pub fn depth(&self, q: Configuration) -> f64 {
        self.radius - self.motion.separation(q).distance - self.part.radius() - self.piece.radius()
    }

    fn corner(&self, q: Configuration) -> Corner {
        (q, self.arm.pose(1, q))
    }

    fn halved(&self, quad: &[[Corner; 2]; 2], halvings: u32) -> bool {
        checkpoint();
        self.looks.set(self.looks.get().saturating_sub(1));
        if self.follows(quad) {
            return true;
        }
        if halvings == 0 || self.is_spent() {
            return false;
        }
        let middle = quad.map(|[lower, upper]| self.corner((lower.0 + upper.0) / 2.0));
        // Where the middle is free no halving will help.
        (!halvings.is_multiple_of(LOOK) || self.depth((middle[0].0 + middle[1].0) / 2.0) >= 0.0)
            && self.halved(&[[quad[0][0], middle[0]], [quad[1][0], middle[1]]], halvings - 1)
            && self.halved(&[[middle[0], quad[0][1]], [middle[1], quad[1][1]]], halvings - 1)
    }

    /// Whether one point or one crossing stands for the whole quadrilateral.
    fn follows(&self, quad: &[[Corner; 2]; 2]) -> bool {
        let [world, link] = self.deviations(quad);
        let corners = [quad[0][0], quad[0][1], quad[1][0], quad[1][1]];
        let (part, piece) = (self.part.core(), self.piece.core());
        let [of_part, of_piece] = &self.sides;
        let from_world =
            |x: &Point| corners.iter().all(|(_, pose)| within(pose * x, piece, of_piece, self.radius - world));
        let from_link = |y: &Point| {
            corners.iter().all(|(_, pose)| within(pose.inverse_transform_point(y), part, of_part, self.radius - link))
        };
        if piece.iter().any(from_link) || part.iter().any(from_world) {
            return true;
        }
        let mean = |f: fn(&Corner) -> Configuration| corners.iter().map(f).sum::<Configuration>() / 4.0;
        let center = self.arm.pose(1, mean(|corner| corner.0));
        if let Some(y) = self.common_point(&center) {
            return from_link(&y) || from_world(&center.inverse_transform_point(&y));
        }
        self.radius >= 0.0 && self.cross(&corners.map(|corner| corner.1), world, link)
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
    fn deviations(&self, quad: &[[Corner; 2]; 2]) -> [f64; 2] {
        let [u, v] = quad.map(|side| side.map(|corner| corner.0));
        let along = [self.motion.curvatures(u[0], v[0]), self.motion.curvatures(u[1], v[1])];
        let across = [self.motion.curvatures(u[0], u[1]), self.motion.curvatures(v[0], v[1])];
        [0, 1].map(|k| (along[0][k].max(along[1][k]) + across[0][k].max(across[1][k])) / 8.0)
    }
}

/// The half-planes `normal . p <= offset` of a convex polygon with area.
fn half_planes(core: &[Point]) -> Vec<(Vector, f64)> {
    let n = if core.len() > 2 { core.len() } else { 0 };
    (0..n)
        .map(|i| {
            let normal = -perpendicular((core[(i + 1) % n] - core[i]).normalize());
            (normal, normal.dot(&core[i].coords))
        })
        .collect()
}

/// Whether a point's signed distance from a convex polygon (negative inside), segment or point, a convex function of it,
/// is at most `allowed`.
fn within(p: Point, core: &[Point], sides: &[(Vector, f64)], allowed: f64) -> bool {
    let outside = sides.iter().map(|(normal, offset)| normal.dot(&p.coords) - offset).fold(f64::NEG_INFINITY, f64::max);
    if outside > allowed {
        return false;
    }
    if outside <= 0.0 && !sides.is_empty() {
        return true;
    }
    let n = core.len();
    allowed >= 0.0 && (0..n).any(|i| to_segment(p, core[i], core[(i + 1) % n]) <= allowed)
}

fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (along, to) = (b - a, p - a);
    let length2 = along.norm_squared();
    let t = if length2 > 0.0 { (along.dot(&to) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (to - along * t).norm()
}
