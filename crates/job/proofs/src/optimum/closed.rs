//! *Closed* configurations, in which shapes are too near. Finds the closed values of joint 1, and those of joint 2 at a value of
//! joint 1. Proves that straight motions are closed.

use crate::slab::{CLOSED_FORM_ERROR, ErodedShape};
use cplan_geometry::{Convex, Hits, Point, Pose, Vector, common, merge_in_place, perpendicular, separation};
use cplan_interrupt::checkpoint;
use cplan_judge::{COLLISION_ROUNDING, Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Contacts, Pair, Scene, on_axis};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Largest number of times that a motion is halved. If that does not suffice for a proof, the motion counts as not proven.
const MAX_MOTION_HALVINGS: usize = 4;

/// An interval of joint 2 in which a pair is too near. It is within the domain of a joint with limits. With a continuous joint,
/// it may extend beyond the domain by at most a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wall {
    /// Index of the pair among those of link 2.
    pub pair: usize,
    pub lower: f64,
    pub upper: f64,
}

/// Largest number of pairs of link 2 that are examined. If pairs are omitted, fewer configurations count as closed, so the bound
/// stays valid. It becomes hardly lower, because the link usually collides with several of so many pieces at once.
pub(super) const MAX_PAIRS: usize = 4096;

/// Largest product of the numbers of slices and pairs. It corresponds to some seconds.
const MAX_SLICE_TESTS: usize = 4_000_000;

/// A pair of link 2, with data to find its walls.
struct PreparedPair {
    /// Index among all pairs.
    index: usize,
    /// The eroded shape of the pair. `None` if the shapes are too thin to overlap by more than rounding errors.
    eroded: Option<ErodedShape>,
    /// The piece's core as an intersection of half-planes.
    sides: Vec<(Vector, f64)>,
}

/// The pairs of link 2, prepared to find its walls.
pub(super) struct SecondLinkWalls<'a> {
    contacts: Contacts<'a>,
    clearance: f64,
    /// For each part of link 2, its core as an intersection of half-planes.
    sides: Vec<Vec<(Vector, f64)>>,
    pairs: Vec<PreparedPair>,
    /// Index in `pairs` of each pair.
    numbers: BTreeMap<Pair, usize>,
    scratch: Vec<[f64; 2]>,
}

impl<'a> SecondLinkWalls<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let contacts = Contacts::new(scene);
        let sides = scene.arm().links[1].parts.iter().map(|part| half_planes(part.shape.core())).collect();
        let (pairs, numbers) = (Vec::new(), BTreeMap::new());
        let mut this = Self { contacts, clearance, sides, pairs, numbers, scratch: Vec::new() };
        this.add_numbers(&chosen(&this.contacts, clearance));
        this
    }

    fn scene(&self) -> &'a Scene {
        self.contacts.scene()
    }

    /// Adds some more pairs of link 2.
    pub fn add(&mut self, pairs: &[Pair]) {
        let all = self.scene().pairs();
        let numbers: Vec<usize> = pairs.iter().filter_map(|pair| all.binary_search(pair).ok()).collect();
        self.add_numbers(&numbers);
    }

    fn add_numbers(&mut self, indices: &[usize]) {
        for &index in indices {
            checkpoint();
            let (moving, piece) = (self.contacts.moving(index), self.contacts.static_shape(index).shape());
            let eroded = ErodedShape::new(moving, piece, CLOSED_FORM_ERROR, self.clearance);
            self.numbers.insert(self.scene().pairs()[index], self.pairs.len());
            self.pairs.push(PreparedPair { index, eroded, sides: half_planes(piece.core()) });
        }
    }

    /// Returns the pairs in use: first those of link 1 (none if there are too many), then those of link 2.
    pub fn pairs(&self) -> Vec<Pair> {
        let first = self.contacts.second_link_pairs().start;
        let few = first <= MAX_PAIRS;
        self.scene().pairs()[..first].iter().filter(|_| few).chain(self.numbers.keys()).copied().collect()
    }

    /// Returns the number of slices that can be examined in a few seconds.
    pub fn max_slices(&self) -> usize {
        MAX_SLICE_TESTS / self.pairs.len().max(1)
    }

    /// Returns the values of joint 1 at which link 1 is too near: disjoint intervals, ascending.
    pub fn bands(&self) -> Vec<[f64; 2]> {
        let arm = self.scene().arm();
        let joint = &arm.joints[0];
        let (mut bands, mut arcs) = (Vec::new(), Vec::new());
        for index in 0..self.contacts.second_link_pairs().start {
            let (part, piece) = (self.contacts.moving(index), self.contacts.static_shape(index));
            let Some(eroded) = ErodedShape::new(part, piece.shape(), CLOSED_FORM_ERROR, self.clearance) else {
                continue;
            };
            arcs.clear();
            let hits = eroded.hits(part, piece, arm.base, Vector::x(), &mut arcs);
            on_axis(joint, hits, &arcs, |band| bands.push(band));
        }
        bands.retain(|[lower, upper]| lower < upper);
        merge_in_place(&mut bands);
        bands
    }

    /// Returns the walls at `q1`, in the order of the pairs.
    pub fn walls(&mut self, q1: f64) -> Vec<Wall> {
        checkpoint();
        let mut walls = Vec::new();
        let frame = self.contacts.elbow(q1);
        for number in 0..self.pairs.len() {
            self.add_walls(number, frame, &mut walls);
        }
        walls
    }

    /// Returns the walls of one pair at `q1`.
    pub fn walls_of(&mut self, number: usize, q1: f64) -> Vec<Wall> {
        let mut walls = Vec::new();
        self.add_walls(number, self.contacts.elbow(q1), &mut walls);
        walls
    }

    /// Returns the pairs in the order of their numbers.
    pub fn by_number(&self) -> Vec<Pair> {
        let mut pairs: Vec<(usize, Pair)> = self.numbers.iter().map(|(pair, number)| (*number, *pair)).collect();
        pairs.sort_unstable();
        pairs.into_iter().map(|(_, pair)| pair).collect()
    }

    /// Returns the index of a pair in `self.pairs`. `None` if the pair has not been added.
    pub fn number(&self, pair: Pair) -> Option<usize> {
        self.numbers.get(&pair).copied()
    }

    fn add_walls(&mut self, number: usize, (elbow, heading): (Point, Vector), walls: &mut Vec<Wall>) {
        let pair = &self.pairs[number];
        let Some(eroded) = &pair.eroded else { return };
        let joint = &self.contacts.scene().arm().joints[1];
        self.scratch.clear();
        let (part, piece) = (self.contacts.moving(pair.index), self.contacts.static_shape(pair.index));
        let (elbow, heading) = self.contacts.frame(pair.index, (elbow, heading));
        let hits = eroded.hits(part, piece, elbow, heading, &mut self.scratch);
        let mut add = |[lower, upper]: [f64; 2]| {
            if lower < upper {
                walls.push(Wall { pair: number, lower, upper });
            }
        };
        match hits {
            Hits::Always if joint.range.is_circle() => add([-PI, PI]),
            Hits::Within if joint.range.is_circle() => self.scratch.iter().copied().for_each(add),
            _ => on_axis(joint, hits, &self.scratch, add),
        }
    }

    /// Returns true if a pair is proven to be too near along the whole straight motion between two configurations. False means
    /// unknown.
    pub fn all_along(&self, pair: usize, from: Configuration, to: Configuration) -> bool {
        self.halved(&self.pairs[pair], [from, to], MAX_MOTION_HALVINGS)
    }

    fn halved(&self, pair: &PreparedPair, ends: [Configuration; 2], halvings: usize) -> bool {
        let middle = (ends[0] + ends[1]) / 2.0;
        let posture = Posture::new(self.scene(), middle);
        if self.follows(pair, &posture, ends) {
            return true;
        }
        let pose = self.scene().arm().pose(self.link(pair), middle);
        let (part, piece) = self.shapes(pair);
        halvings > 0
            && separation(&part.at(&pose), piece).distance < self.clearance
            && self.halved(pair, [ends[0], middle], halvings - 1)
            && self.halved(pair, [middle, ends[1]], halvings - 1)
    }

    /// Returns the link of a pair, as in [`Pair::link`].
    fn link(&self, pair: &PreparedPair) -> usize {
        self.scene().pairs()[pair.index].link
    }

    /// Returns the part and the piece of a pair.
    fn shapes(&self, pair: &PreparedPair) -> (&Convex, &Convex) {
        (self.contacts.moving(pair.index).shape(), self.contacts.static_shape(pair.index).shape())
    }

    /// Returns true if some point of one of the two shapes is proven to stay in both along the whole motion.
    ///
    /// A point of the part deviates from the straight motion between its end positions by at most half the bound on its second
    /// derivative. The distance from a convex set, negative inside, is a convex function. So along the motion, the point's
    /// distance from the piece is at most the greater of its distances at the two ends, plus that deviation. The same holds for a
    /// point of the piece as seen from the link. If the point's distances from both cores add up to at most `radius`, so does the
    /// distance of the cores.
    fn follows(&self, pair: &PreparedPair, posture: &Posture, ends: [Configuration; 2]) -> bool {
        let (part, piece) = self.shapes(pair);
        let of_part = &self.sides[self.scene().pairs()[pair.index].part];
        let of_piece = &pair.sides;
        let link = self.link(pair);
        let poses = ends.map(|q| self.scene().arm().pose(link, q));
        let deviation = Deviation::Along((ends[1] - ends[0]) / 2.0);
        let slack = COLLISION_ROUNDING * posture.scale(part.at(&poses[0]).core(), part.radius(), piece);
        let radius = part.radius() + piece.radius() + self.clearance - slack;
        let (in_link, in_plane) =
            (posture.curvature_in_link(link, deviation), posture.curvature_in_plane(link, deviation));
        let of_world = |p: Point, from_piece: f64| {
            let allowed = radius - from_piece - in_link.of(p) / 2.0;
            poses.iter().all(|pose| is_nearer_than(pose.inverse_point(p), part.core(), of_part, allowed))
        };
        let of_link = |a: Point, from_part: f64| {
            let allowed = radius - from_part - in_plane.of(a) / 2.0;
            poses.iter().all(|pose| is_nearer_than(pose.point(a), piece.core(), of_piece, allowed))
        };
        if piece.core().iter().any(|p| of_world(*p, 0.0)) || part.core().iter().any(|a| of_link(*a, 0.0)) {
            return true;
        }
        let pose = self.scene().arm().pose(link, (ends[0] + ends[1]) / 2.0);
        middle_point(part, piece, &pose).is_some_and(|p| {
            let a = pose.inverse_point(p);
            of_world(p, signed_distance(p, piece.core(), of_piece))
                || of_link(a, signed_distance(a, part.core(), of_part))
        })
    }
}

/// Returns the indices, ascending, of the pairs of link 2 that can collide in some configuration. If there are too many, keeps
/// those with the largest pieces; among pieces of similar size, those that are evenly spread over the list.
fn chosen(contacts: &Contacts, clearance: f64) -> Vec<usize> {
    let arm = contacts.scene().arm();
    let in_reach = |index: &usize| {
        // On a prismatic joint, link 2 can reach any place along the axis.
        !arm.joints[0].joint_type.is_revolute()
            || least_distance(contacts.static_shape(*index).shape(), arm.base) <= contacts.reach(*index) + clearance
    };
    let mut pairs: Vec<usize> = contacts.second_link_pairs().filter(in_reach).collect();
    if pairs.len() > MAX_PAIRS {
        let bits = usize::BITS - pairs.len().leading_zeros();
        let mut ranked: Vec<(Reverse<i32>, usize, usize)> = pairs
            .into_iter()
            .enumerate()
            .map(|(number, index)| {
                let core = contacts.static_shape(index).shape().core();
                let size = core.iter().map(|p| (p - core[0]).norm()).fold(f64::MIN_POSITIVE, f64::max);
                // Ordering by reversed bits spreads the choice evenly over the list.
                (Reverse(size.log2().floor() as i32), number.reverse_bits() >> (usize::BITS - bits), index)
            })
            .collect();
        ranked.sort_unstable();
        pairs = ranked.into_iter().take(MAX_PAIRS).map(|(.., index)| index).collect();
        pairs.sort_unstable();
    }
    pairs
}

/// Returns a lower bound on the distance between a shape and a point.
fn least_distance(shape: &Convex, from: Point) -> f64 {
    let core = shape.core();
    let extent = core.iter().map(|p| (p - core[0]).norm()).fold(0.0, f64::max);
    (core[0] - from).norm() - extent - shape.radius()
}

/// Returns a point in the middle of the intersection of the two cores, with the part at `pose`. `None` if they do not intersect.
/// For two segments, it is the intersection of their lines, which may lie on neither segment.
fn middle_point(part: &Convex, piece: &Convex, pose: &Pose) -> Option<Point> {
    let part: Vec<Point> = part.core().iter().map(|&a| pose.point(a)).collect();
    let piece = piece.core();
    let both = match (part.as_slice(), piece) {
        (part, piece) if piece.len() > 2 => common(part, piece),
        (part, piece) if part.len() > 2 => common(piece, part),
        (&[a, b], &[c, d]) => {
            let (along, across) = (b - a, perpendicular(d - c));
            let share = across.dot(&(c - a)) / across.dot(&along);
            return share.is_finite().then(|| a + along * share);
        }
        _ => return None,
    };
    let sum: Vector = both.iter().sum();
    (!both.is_empty()).then(|| sum / both.len() as f64)
}

/// Returns the half-planes `normal . p <= offset` of a convex polygon with area.
fn half_planes(core: &[Point]) -> Vec<(Vector, f64)> {
    let n = if core.len() > 2 { core.len() } else { 0 };
    (0..n)
        .map(|i| {
            let normal = -perpendicular((core[(i + 1) % n] - core[i]).normalize());
            (normal, normal.dot(&core[i]))
        })
        .collect()
}

/// Returns the greatest distance of a point from the half-planes; negative if the point is inside all of them.
fn outside(p: Point, sides: &[(Vector, f64)]) -> f64 {
    sides.iter().map(|(normal, offset)| normal.dot(&p) - offset).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns a point's distance from a convex polygon (negative inside), a segment or a point. This is a convex function
/// of the point.
fn signed_distance(p: Point, core: &[Point], sides: &[(Vector, f64)]) -> f64 {
    let (outside, n) = (outside(p, sides), core.len());
    if outside <= 0.0 && !sides.is_empty() {
        return outside;
    }
    (0..n).map(|i| to_segment(p, core[i], core[(i + 1) % n])).fold(f64::INFINITY, f64::min)
}

/// Returns true if [`signed_distance`] is at most `allowed`. Often cheaper than the distance itself.
fn is_nearer_than(p: Point, core: &[Point], sides: &[(Vector, f64)], allowed: f64) -> bool {
    let at_least = if sides.is_empty() { 0.0 } else { outside(p, sides) };
    at_least <= allowed && (at_least < 0.0 || signed_distance(p, core, sides) <= allowed)
}

fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (along, to) = (b - a, p - a);
    let length2 = along.norm_squared();
    let t = if length2 > 0.0 { (along.dot(&to) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (to - along * t).norm()
}

#[cfg(test)]
mod tests;
