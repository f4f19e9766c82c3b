//! What is known about all values of joint 2 while joint 1 stays within a short interval, a *slab*.
//!
//! At a fixed `q1` the values of `q2` at which a pair meets are known in closed form (contact angles). While joint 1
//! moves by at most `h` from the middle of the slab, link 2 moves rigidly, and a point of it that touches the obstacle
//! moves by at most a chord `m` about the base. So where the pair keeps more than `m` apart at the middle, it is free all
//! over the slab; where a point of it lies more than `m` deep in both shapes, it is stuck all over the slab.

use crate::check::Cell;
use crate::check::StuckBox;
use crate::check::{Deviation, Posture};
use crate::geometry::{BoxTree, Convex, Features, Hits, Point, ROUNDING, Vector};
use crate::interrupt::checkpoint;
use crate::model::{Carried, JointType, Pair, Scene, on_axis, swept};
use crate::space::Configuration;
use std::f64::consts::PI;

/// Distance by which closed forms are taken to be wrong, metres: twice what they state, so that adding up a few numbers
/// of the arm's size, and angles to whole turns, is covered as well.
pub(super) const OUTWARD: f64 = 2.0 * ROUNDING;

/// By how much more than a slab's motion shapes must overlap to count as stuck: the rest is what joint 2 may move by in
/// the boxes that state the proof (about as far, at the ends of a stuck interval, as joint 1 moves over a quarter of the
/// slab).
const OVERLAP: f64 = 1.25;

/// Boxes into which a stuck interval of a slab is cut at most: shallow ends need boxes about as high as the slab is wide.
const MOST_TILES: usize = 4096;

/// A pair of link 2, prepared.
struct Prepared<'a> {
    pair: Pair,
    /// Into the parts.
    part: usize,
    piece: &'a Convex,
    features: Features,
    /// Reach from the base of the piece grown by the clearance, metres.
    reach: f64,
    /// How deep the piece is, metres.
    depth: f64,
    /// The eroded piece (or the part, for this piece alone) for every width of slab that it was asked for; none where nothing is
    /// left.
    eroded: Vec<Option<Option<Eroded>>>,
}

/// A part of link 2, prepared, and the pairs with it.
struct PreparedPart {
    carried: Carried,
    /// Reach from the base of all that the part can occupy, metres.
    reach: f64,
    /// How deep it is, metres.
    depth: f64,
    /// The part when it is the deeper shape, eroded for every width of slab.
    eroded: Vec<Option<Option<Eroded>>>,
    /// Number of its first pair, and the boxes of the pieces of all of them.
    first: usize,
    pieces: BoxTree,
}

/// A shape of a pair that is nearer to the bone.
pub(super) enum Eroded {
    Part(Carried),
    Piece(Features),
    /// Neither: the clearance to keep is more than what has to be taken away; by how much.
    Grown(f64),
}

impl Eroded {
    /// Whichever shape is deeper, eroded by `overlap` less `clearance`; none where nothing is left.
    pub fn new(part: &Carried, piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        if part.shape().depth() > piece.depth() {
            Self::part(part, piece, overlap, clearance)
        } else {
            Self::piece(piece, overlap, clearance)
        }
    }

    fn part(part: &Carried, piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        let grow = clearance - overlap;
        let by = lacking(piece) - grow;
        if by <= 0.0 {
            return Some(Self::Grown(grow));
        }
        part.shape().eroded(by).map(|shape| Self::Part(Carried::new(part.joint_type(), &shape)))
    }

    fn piece(piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        let grow = clearance - overlap;
        if lacking(piece) <= grow {
            return Some(Self::Grown(grow));
        }
        piece.eroded(-grow).map(|shape| Self::Piece(Features::new(&shape)))
    }

    /// Values of the joint at which the pair's shapes overlap by at least as much as one of them was eroded by.
    pub fn hits(
        &self,
        part: &Carried,
        piece: &Features,
        pivot: Point,
        heading: Vector,
        out: &mut Vec<[f64; 2]>,
    ) -> Hits {
        match self {
            Self::Part(eroded) => eroded.hits(pivot, heading, piece, lacking(piece.shape()), out),
            Self::Piece(eroded) => part.hits(pivot, heading, eroded, 0.0, out),
            Self::Grown(by) => part.hits(pivot, heading, piece, *by, out),
        }
    }
}

/// By how much a piece has to grow until its radius is none: what is to be kept from it then is to be kept from its core.
fn lacking(piece: &Convex) -> f64 {
    (-piece.radius()).max(0.0)
}

/// Link 2 and all that it can meet, for slabs of joint 1.
pub(super) struct SecondLink<'a> {
    scene: &'a Scene,
    clearance: f64,
    parts: Vec<PreparedPart>,
    pairs: Vec<Prepared<'a>>,
    scratch: Vec<[f64; 2]>,
    near: Vec<u32>,
}

/// The forbidden values of joint 2 in a slab, within the domain; each list by pair, as numbers of [`SecondLink`].
#[derive(Default)]
pub(super) struct Verdicts {
    /// Outside these intervals no pair comes too near anywhere in the slab.
    pub outer: Vec<[f64; 2]>,
    /// Within each of these its pair is too near all over the slab.
    pub inner: Vec<(usize, [f64; 2])>,
}

impl<'a> SecondLink<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let joint = &scene.arm().joints[1];
        let of_second: Vec<Pair> = scene.pairs().iter().filter(|p| p.link == 1).copied().collect();
        let (mut parts, mut pairs) = (Vec::new(), Vec::with_capacity(of_second.len()));
        for of_part in of_second.chunk_by(|a, b| a.part == b.part) {
            let shape = scene.part(of_part[0]);
            let first = pairs.len();
            for &pair in of_part {
                checkpoint();
                let piece = scene.piece(pair);
                pairs.push(Prepared {
                    pair,
                    part: parts.len(),
                    piece,
                    features: Features::new(piece),
                    reach: piece.reach_from(scene.arm().base) + clearance,
                    depth: piece.depth(),
                    eroded: Vec::new(),
                });
            }
            parts.push(PreparedPart {
                carried: Carried::new(joint.joint_type, shape),
                reach: swept(shape, joint, scene.arm().offset).reach_from(Point::origin()),
                depth: shape.depth(),
                eroded: Vec::new(),
                first,
                pieces: BoxTree::new(of_part.iter().map(|&pair| scene.piece(pair).bounds()).collect()),
            });
        }
        Self { scene, clearance, parts, pairs, scratch: Vec::new(), near: Vec::new() }
    }

    /// Farthest that a point at distance `reach` from the base moves while joint 1 moves by at most `half`, metres.
    fn motion(&self, reach: f64, half: f64) -> f64 {
        match self.scene.arm().joints[0].joint_type {
            JointType::Revolute { .. } => 2.0 * reach * (half.min(PI) / 2.0).sin(),
            JointType::Prismatic { .. } => half,
        }
    }

    /// What is known in the slab `from <= q1 <= to`, which is no wider than twice `half`, the half width of all slabs of
    /// this `level`.
    pub fn judge(&mut self, from: f64, to: f64, level: usize, half: f64, verdicts: &mut Verdicts) {
        checkpoint();
        verdicts.outer.clear();
        verdicts.inner.clear();
        let middle = (from + to) / 2.0;
        let width = (to - middle).max(middle - from);
        let (elbow, heading) = self.elbow(middle);
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut near = std::mem::take(&mut self.near);
        for part in 0..self.parts.len() {
            self.near(part, elbow, width, &mut near);
            for &index in &near {
                let index = index as usize;
                let (pair, part) = (&self.pairs[index], &self.parts[part]);
                let grow = self.clearance + self.motion(part.reach.min(pair.reach), width) + OUTWARD;
                scratch.clear();
                let hits = part.carried.hits(elbow, heading, &pair.features, grow, &mut scratch);
                if hits == Hits::Never {
                    continue;
                }
                let joint = &self.scene.arm().joints[1];
                on_axis(joint, hits, &scratch, |interval| verdicts.outer.push(interval));
                let overlap = self.motion(part.reach, half) * OVERLAP + OUTWARD;
                scratch.clear();
                let hits = self.stuck(index, level, overlap, elbow, heading, &mut scratch);
                let joint = &self.scene.arm().joints[1];
                on_axis(joint, hits, &scratch, |interval| {
                    if interval[0] < interval[1] {
                        verdicts.inner.push((index, interval));
                    }
                });
            }
        }
        (self.scratch, self.near) = (scratch, near);
    }

    /// The numbers of a part's pairs, ascending, that it can come near to in a slab at most `width` to either side of where
    /// joint 2 is, and some others.
    fn near(&self, part: usize, elbow: Point, width: f64, found: &mut Vec<u32>) {
        let PreparedPart { carried, reach, first, pieces, .. } = &self.parts[part];
        found.clear();
        match carried.joint_type() {
            JointType::Revolute { .. } => {
                let grow = self.clearance + self.motion(*reach, width) + 2.0 * OUTWARD;
                let around = Vector::repeat(carried.shape().reach_from(Point::origin()) + grow);
                pieces.meeting(&[elbow - around, elbow + around], found);
                found.iter_mut().for_each(|index| *index += *first as u32);
            }
            JointType::Prismatic { .. } => {
                let end = self.parts.get(part + 1).map_or(self.pairs.len(), |next| next.first);
                found.extend(*first as u32..end as u32);
            }
        }
    }

    /// Values of joint 2 at which the shapes of a pair overlap by more than `overlap` less the clearance; `overlap` depends on
    /// the part and the level alone.
    fn stuck(
        &mut self,
        index: usize,
        level: usize,
        overlap: f64,
        elbow: Point,
        heading: Vector,
        out: &mut Vec<[f64; 2]>,
    ) -> Hits {
        let (clearance, pair) = (self.clearance, &mut self.pairs[index]);
        let part = &mut self.parts[pair.part];
        let of_part = part.depth > pair.depth;
        // What is to be kept from all pieces is the part's own.
        let shared = of_part && lacking(pair.piece) == 0.0;
        let known = if shared { &mut part.eroded } else { &mut pair.eroded };
        if known.len() <= level {
            known.resize_with(level + 1, || None);
        }
        let eroded = known[level].get_or_insert_with(|| match of_part {
            true => Eroded::part(&part.carried, pair.piece, overlap, clearance),
            false => Eroded::piece(pair.piece, overlap, clearance),
        });
        match eroded {
            None => Hits::Never,
            Some(eroded) => eroded.hits(&part.carried, &pair.features, elbow, heading, out),
        }
    }

    /// The boxes that state that pair `index` is stuck for `q2` in `interval`, all over the slab. Whether the bounds that
    /// boxes are judged by see it.
    pub fn tile(&self, from: f64, to: f64, index: usize, interval: [f64; 2], boxes: &mut Vec<StuckBox>) -> bool {
        let pair = self.pairs[index].pair;
        let begin = boxes.len();
        let mut open = vec![interval];
        while let Some([lower, upper]) = open.pop() {
            checkpoint();
            let cell = Cell { lower: [from, lower], upper: [to, upper] };
            if is_stuck(self.scene, pair, &cell, self.clearance) {
                boxes.push(StuckBox { cell, pair });
                continue;
            }
            let middle = (lower + upper) / 2.0;
            if open.len() + boxes.len() - begin > MOST_TILES || middle <= lower || middle >= upper {
                return false;
            }
            open.push([middle, upper]);
            open.push([lower, middle]);
        }
        true
    }

    /// Where joint 2 is at `q1`, and the direction of link 1's x axis.
    fn elbow(&self, q1: f64) -> (Point, Vector) {
        let pose = self.scene.arm().pose(0, Configuration::new(q1, 0.0));
        (pose * Point::from(self.scene.arm().offset), pose * Vector::x())
    }
}

/// Whether the pair is too near all over the box, by the bounds that boxes are judged by.
pub(super) fn is_stuck(scene: &Scene, pair: Pair, cell: &Cell, clearance: f64) -> bool {
    Posture::new(scene, cell.center()).greatest(pair, Deviation::Box(cell.half())) < clearance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::hull;
    use crate::model::{Arm, Heights, Joint, Link, Obstacle, OutlineSource, Part, Plane, Shape, Workspace};
    use crate::space::JointRange;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn shape(spread: f64) -> impl Strategy<Value = Convex> {
        let points = prop::collection::vec((-spread..spread, -spread..spread), 1..6);
        (points, prop_oneof![Just(0.0), 0.0..0.2f64]).prop_map(|(points, radius)| {
            let points: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            Convex::trusted(hull(&points), radius)
        })
    }

    fn joint(turns: bool, range: JointRange) -> Joint {
        let motion = if turns {
            JointType::Revolute { sign: -1.0 }
        } else {
            JointType::Prismatic { direction: Vector::new(0.6, 0.8) }
        };
        Joint { name: "joint".into(), joint_type: motion, range, velocity: 1.0, acceleration: 1.0, jerk: None }
    }

    fn scene(kinds: (bool, bool), offset: Vector, part: Convex, piece: Convex) -> Scene {
        let long = JointRange::Interval { lower: -4.0, upper: 4.0 };
        let link = |parts| Link { name: "link".into(), parts, source: OutlineSource::Collision };
        let part = Part { shape: part, heights: Heights::ALL, body: "body".into() };
        let arm = Arm {
            name: "arm".into(),
            joints: [joint(kinds.0, long), joint(kinds.1, if kinds.1 { JointRange::Circle } else { long })],
            links: [link(vec![]), link(vec![part])],
            base: Point::new(0.1, -0.2),
            offset,
            tip: Point::origin(),
            tip_name: "tip".into(),
            plane: Plane { u: Vector3::x(), v: Vector3::y(), normal: Vector3::z() },
        };
        let shape = Shape::Polygon(piece.core().to_vec());
        let obstacle = Obstacle { name: "o".into(), shape, pieces: vec![piece], heights: Heights::ALL };
        Scene::trusted(
            arm,
            Workspace { name: "w".into(), obstacles: vec![obstacle], clearance: 0.0, preferences: Vec::new() },
        )
    }

    proptest! {
        #![proptest_config(crate::random::cases(600))]

        /// The oracle is the distance of the shapes at sampled configurations, which knows no contact angles.
        #[test]
        fn what_is_said_of_a_slab_holds_all_over_it(
            kinds in (any::<bool>(), any::<bool>()), offset in (-1.0..1.0f64, -1.0..1.0f64),
            part in shape(0.8), piece in shape(0.6), at in (-1.2..1.2f64, -1.2..1.2f64),
            middle in -3.0..3.0f64, half in prop_oneof![0.001..0.02f64, 0.02..0.3f64],
            clearance in prop_oneof![Just(0.0), 0.0..0.2f64],
            samples in prop::collection::vec((-1.0..=1.0f64, 0.0..=1.0f64), 40),
        ) {
            let moved = piece.core().iter().map(|p| p + Vector::new(at.0, at.1)).collect();
            let scene = scene(kinds, Vector::new(offset.0, offset.1), part, Convex::trusted(moved, piece.radius()));
            let mut second = SecondLink::new(&scene, clearance);
            let mut verdicts = Verdicts::default();
            let (from, to) = (middle - half, middle + half);
            second.judge(from, to, 0, half * (1.0 + 1e-6), &mut verdicts);
            let Verdicts { mut outer, inner } = verdicts;
            crate::geometry::merge_in_place(&mut outer);
            let (bottom, top) = scene.arm().joints[1].range.domain();
            for (u, v) in samples {
                let q1 = (middle + u * half).clamp(from, to);
                let q2 = bottom + v * (top - bottom);
                if !outer.iter().any(|i| i[0] <= q2 && q2 <= i[1]) {
                    let distance = scene.clearance(Configuration::new(q1, q2));
                    prop_assert!(distance > 0.0 && distance >= clearance, "{distance} at {q1} {q2}");
                }
                for (_, [lower, upper]) in &inner {
                    prop_assert!(outer.iter().any(|i| i[0] <= *lower && *upper <= i[1]));
                    let distance = scene.clearance(Configuration::new(q1, lower + v * (upper - lower)));
                    prop_assert!(distance < clearance.max(0.0) || distance < 0.0, "{distance}");
                }
            }
            // The boxes that state it say neither more nor less.
            for &(pair, interval) in &inner {
                let mut boxes = Vec::new();
                prop_assert!(second.tile(from, to, pair, interval, &mut boxes), "{interval:?}");
                boxes.sort_by(|a, b| a.cell.lower[1].total_cmp(&b.cell.lower[1]));
                prop_assert!(boxes.windows(2).all(|w| w[0].cell.upper[1] == w[1].cell.lower[1]));
                prop_assert_eq!([boxes[0].cell.lower[1], boxes[boxes.len() - 1].cell.upper[1]], interval);
            }
        }
    }
}
