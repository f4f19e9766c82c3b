//! What is closed: for joint 1, for joint 2 at one value of joint 1, and along straight motions.

use crate::certify::deviation::{Deviation, Posture, STUCK_ROUNDING};
use crate::certify::slab::{Eroded, OUTWARD};
use crate::geometry::{Convex, Features, Hits, Point, Pose, Vector, common, merge_in_place, perpendicular, separation};
use crate::interrupt::checkpoint;
use crate::model::{Carried, Pair, Scene, on_axis};
use crate::space::Configuration;
use std::f64::consts::PI;

/// Times that a motion is halved before it counts as not proven.
const HALVINGS: usize = 4;

/// Values of joint 2 at which a pair is too near: within the domain on an interval; on a circle an arc whose end may be
/// beyond its domain, by no more than a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wall {
    /// Number of the pair, among those of link 2.
    pub pair: usize,
    pub lower: f64,
    pub upper: f64,
}

/// A pair of link 2.
struct Prepared {
    part: Carried,
    piece: Features,
    /// None where the shapes are too thin to overlap by as much as rounding may amount to.
    eroded: Option<Eroded>,
    /// Half-planes of the cores of part and piece.
    sides: [Vec<(Vector, f64)>; 2],
}

/// All that link 2 can meet.
pub(super) struct Closed<'a> {
    scene: &'a Scene,
    clearance: f64,
    pairs: Vec<Prepared>,
    scratch: Vec<[f64; 2]>,
}

impl<'a> Closed<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let motion = scene.arm.joints[1].motion;
        let prepare = |&pair: &Pair| {
            let (part, piece) = (Carried::new(motion, scene.part(pair)), scene.piece(pair));
            let eroded = Eroded::new(&part, piece, OUTWARD, clearance);
            let sides = [part.shape().core(), piece.core()].map(half_planes);
            Prepared { part, piece: Features::new(piece), eroded, sides }
        };
        let pairs = scene.pairs().iter().filter(|pair| pair.link == 1).map(prepare).collect();
        Self { scene, clearance, pairs, scratch: Vec::new() }
    }

    /// The values of joint 1 at which link 1 is too near: disjoint, ascending.
    pub fn bands(&self) -> Vec<[f64; 2]> {
        let arm = &self.scene.arm;
        let joint = &arm.joints[0];
        let (mut bands, mut arcs) = (Vec::new(), Vec::new());
        for &pair in self.scene.pairs().iter().filter(|pair| pair.link == 0) {
            let (part, piece) = (Carried::new(joint.motion, self.scene.part(pair)), self.scene.piece(pair));
            let Some(eroded) = Eroded::new(&part, piece, OUTWARD, self.clearance) else { continue };
            arcs.clear();
            let hits = eroded.hits(&part, &Features::new(piece), arm.base, Vector::x(), &mut arcs);
            on_axis(joint, hits, &arcs, |band| bands.push(band));
        }
        bands.retain(|[lower, upper]| lower < upper);
        merge_in_place(&mut bands);
        bands
    }

    /// What is closed at `q1`, by pair.
    pub fn walls(&mut self, q1: f64) -> Vec<Wall> {
        checkpoint();
        let arm = &self.scene.arm;
        let pose = arm.pose(0, Configuration::new(q1, 0.0));
        let (elbow, heading) = (pose * Point::from(arm.offset), pose * Vector::x());
        let joint = &arm.joints[1];
        let mut walls = Vec::new();
        for (number, pair) in self.pairs.iter().enumerate() {
            let Some(eroded) = &pair.eroded else { continue };
            self.scratch.clear();
            let hits = eroded.hits(&pair.part, &pair.piece, elbow, heading, &mut self.scratch);
            let mut add = |[lower, upper]: [f64; 2]| {
                if lower < upper {
                    walls.push(Wall { pair: number, lower, upper });
                }
            };
            match hits {
                Hits::Always if joint.axis.is_circle() => add([-PI, PI]),
                Hits::Within if joint.axis.is_circle() => self.scratch.iter().copied().for_each(add),
                _ => on_axis(joint, hits, &self.scratch, add),
            }
        }
        walls
    }

    /// Whether a pair is proven too near all along the straight motion between two configurations. True says so; false
    /// says nothing.
    pub fn all_along(&self, pair: usize, from: Configuration, to: Configuration) -> bool {
        self.halved(&self.pairs[pair], [from, to], HALVINGS)
    }

    fn halved(&self, pair: &Prepared, ends: [Configuration; 2], halvings: usize) -> bool {
        let middle = (ends[0] + ends[1]) / 2.0;
        let posture = Posture::new(self.scene, middle);
        if self.follows(pair, &posture, ends) {
            return true;
        }
        let pose = self.scene.arm.pose(1, middle);
        halvings > 0
            && separation(&pair.part.shape().at(&pose), pair.piece.shape()).distance < self.clearance
            && self.halved(pair, [ends[0], middle], halvings - 1)
            && self.halved(pair, [middle, ends[1]], halvings - 1)
    }

    /// Whether one point of one shape is in the other all along the motion.
    ///
    /// A point of the part moves smoothly, no farther from the straight line between its places at the ends than half the
    /// bound on its second derivative; and the distance from a convex set, negative inside, is a convex function. So it
    /// is nowhere farther from the piece than at the farther end, plus that half. The same holds for a point of the piece
    /// as seen from the link. Shapes are too near each other where a point of one core is within `radius` of the other.
    fn follows(&self, pair: &Prepared, posture: &Posture, ends: [Configuration; 2]) -> bool {
        let (part, piece) = (pair.part.shape(), pair.piece.shape());
        let poses = ends.map(|q| self.scene.arm.pose(1, q));
        let deviation = Deviation::Along((ends[1] - ends[0]) / 2.0);
        let slack = STUCK_ROUNDING * posture.scale(&part.at(&poses[0]), piece);
        let radius = part.radius() + piece.radius() + self.clearance - slack;
        let [of_part, of_piece] = &pair.sides;
        let of_world = |p: Point| {
            let allowed = radius - posture.curvature_in_link(1, p, deviation) / 2.0;
            poses.iter().all(|pose| within(pose.inverse_transform_point(&p), part.core(), of_part, allowed))
        };
        let of_link = |a: Point| {
            let allowed = radius - posture.curvature_in_plane(1, a, deviation) / 2.0;
            poses.iter().all(|pose| within(pose * a, piece.core(), of_piece, allowed))
        };
        if piece.core().iter().any(|p| of_world(*p)) || part.core().iter().any(|a| of_link(*a)) {
            return true;
        }
        let pose = self.scene.arm.pose(1, (ends[0] + ends[1]) / 2.0);
        common_point(part, piece, &pose).is_some_and(|p| of_world(p) || of_link(pose.inverse_transform_point(&p)))
    }
}

/// A point in the middle of what the cores have in common with the part at `pose`.
fn common_point(part: &Convex, piece: &Convex, pose: &Pose) -> Option<Point> {
    let part: Vec<Point> = part.core().iter().map(|a| pose * a).collect();
    let piece = piece.core();
    let both = match (part.as_slice(), piece) {
        (part, piece) if piece.len() > 2 => common(part, piece),
        (part, piece) if part.len() > 2 => common(piece, part),
        (&[a, b], &[c, d]) => {
            let (along, across) = (b - a, perpendicular(d - c));
            let share = across.dot(&(c - a)) / across.dot(&along);
            return share.is_finite().then(|| a + along * share.clamp(0.0, 1.0));
        }
        _ => return None,
    };
    let sum: Vector = both.iter().map(|p| p.coords).sum();
    (!both.is_empty()).then(|| Point::from(sum / both.len() as f64))
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
