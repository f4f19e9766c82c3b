//! A scene prepared for contact equations, which give the values of a joint at which a part is near a piece.

use super::{CarriedPart, JointType, Pair, Scene, swept};
use crate::space::Configuration;
use cplan_geometry::{BoxTree, Features, Hits, Point, ROUNDING, Vector};
use cplan_interrupt::checkpoint;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;

/// A scene prepared for contact equations. Slices, slabs, walls and C-obstacles are computed from it.
///
/// Pairs are numbered as in [`Scene::pairs`]. Every interval of joint values is closed, and exact up to
/// [`cplan_geometry::ROUNDING`]. Intervals of a revolute joint are *unwrapped*: they start in `[-pi, pi)`, may end
/// beyond `pi`, and repeat by whole turns. Joint limits are not applied.
#[derive(Debug, Clone)]
pub struct Contacts<'a> {
    scene: &'a Scene,
    pairs: Vec<PairIndices>,
    parts: Vec<PreparedPart>,
    pieces: Vec<PreparedPiece>,
    /// Index of the first part of link 2, and of its first pair. Pairs of link 2 with link 1 count as pairs of link 2.
    second: (usize, usize),
    /// Position of joint 2 and direction of link 1's x axis, both with joint 1 at zero.
    at_zero: (Point, Vector),
}

/// A pair as indices into the vectors of [`Contacts`].
#[derive(Debug, Clone, Copy)]
struct PairIndices {
    link: u32,
    /// Index into the parts.
    part: u32,
    /// Index into the pieces.
    piece: u32,
}

/// A piece, with the greatest distance of its points from the base, metres.
#[derive(Debug, Clone)]
struct PreparedPiece {
    features: Features,
    reach: f64,
}

/// A part, prepared for the joint that carries its link.
#[derive(Debug, Clone)]
struct PreparedPart {
    /// Link of the part in its pairs, as in [`Pair::link`].
    link: usize,
    carried: CarriedPart,
    /// Upper bound on the distance of the part from the base, metres, at any value of joint 2, while joint 1 is at
    /// zero.
    reach: f64,
    /// For parts of link 2: a shape that contains the part at all values of joint 2, carried by joint 1. `None` for
    /// link 1.
    sweep: Option<CarriedPart>,
    /// The numbers of the part's pairs, which are consecutive.
    pairs: Range<usize>,
    /// The bounding boxes of the pieces in these pairs.
    pieces: BoxTree,
}

impl PreparedPart {
    /// Prepares the part of `pairs`, which all have the same part and are numbered from `from` on.
    fn new(scene: &Scene, pairs: &[Pair], from: usize) -> Self {
        let arm = scene.arm();
        let [first, second] = &arm.joints;
        let part = scene.part(pairs[0]);
        let (carried, sweep) = if pairs[0].link == 0 {
            (CarriedPart::new(first.joint_type, part), None)
        } else {
            let sweep = swept(part, second, arm.offset);
            (CarriedPart::new(second.joint_type, part), Some(CarriedPart::new(first.joint_type, &sweep)))
        };
        let pieces = BoxTree::new(pairs.iter().map(|&pair| scene.piece(pair).bounds()).collect());
        let reach = sweep.as_ref().unwrap_or(&carried).shape().reach_from(Point::zeros());
        Self { link: pairs[0].link, carried, reach, sweep, pairs: from..from + pairs.len(), pieces }
    }

    fn near(&self, elbow: Point, grow: f64, found: &mut Vec<u32>) {
        found.clear();
        match self.carried.joint_type() {
            JointType::Revolute { .. } => {
                let around = Vector::repeat(self.carried.shape().reach_from(Point::zeros()) + grow + ROUNDING);
                self.pieces.meeting(&[elbow - around, elbow + around], found);
                found.iter_mut().for_each(|index| *index += self.pairs.start as u32);
            }
            JointType::Prismatic { .. } => found.extend(self.pairs.start as u32..self.pairs.end as u32),
        }
    }
}

impl<'a> Contacts<'a> {
    /// Prepares a scene. `O(n log n)` in its size.
    pub fn new(scene: &'a Scene) -> Self {
        let (mut parts, mut pieces, mut pairs) = (Vec::new(), Vec::new(), Vec::with_capacity(scene.pairs().len()));
        let mut piece_of = HashMap::new();
        for of_part in scene.pairs().chunk_by(|a, b| (a.link, a.part) == (b.link, b.part)) {
            parts.push(PreparedPart::new(scene, of_part, pairs.len()));
            for &pair in of_part {
                checkpoint();
                let piece = *piece_of.entry((pair.obstacle, pair.piece)).or_insert_with(|| {
                    let piece = scene.piece(pair);
                    let reach = piece.reach_from(scene.arm().base);
                    pieces.push(PreparedPiece { features: Features::new(piece), reach });
                    pieces.len() as u32 - 1
                });
                pairs.push(PairIndices { link: pair.link as u32, part: parts.len() as u32 - 1, piece });
            }
        }
        let first_part = parts.partition_point(|part: &PreparedPart| part.sweep.is_none());
        let second = (first_part, parts.get(first_part).map_or(pairs.len(), |part| part.pairs.start));
        let at_zero = elbow(scene, 0.0);
        Self { scene, pairs, parts, pieces, second, at_zero }
    }

    fn part(&self, pair: PairIndices) -> &PreparedPart {
        &self.parts[pair.part as usize]
    }

    fn piece(&self, pair: PairIndices) -> &Features {
        &self.pieces[pair.piece as usize].features
    }

    /// Returns the moving shape of pair `index`, with the joint that moves it.
    pub fn moving(&self, index: usize) -> &CarriedPart {
        &self.part(self.pairs[index]).carried
    }

    /// Returns the fixed shape of pair `index`.
    pub fn static_shape(&self, index: usize) -> &Features {
        self.piece(self.pairs[index])
    }

    /// Returns the number of the part in pair `index`. Only parts that are in some pair are numbered.
    pub fn part_of(&self, index: usize) -> usize {
        self.pairs[index].part as usize
    }

    /// Returns the numbers of the parts of link 2; those of link 1 come before.
    pub fn second_link_parts(&self) -> Range<usize> {
        self.second.0..self.parts.len()
    }

    /// Fills `found` with numbers of pairs of a part of link 2, ascending. These are all pairs in which the part can be
    /// within `grow` of its piece with joint 2 at `elbow`, and possibly some others.
    pub fn near(&self, part: usize, elbow: Point, grow: f64, found: &mut Vec<u32>) {
        let part = &self.parts[part];
        part.near(if part.link == 2 { self.at_zero.0 } else { elbow }, grow, found);
    }

    /// Returns the place of joint 2, and the direction of link 1's x axis, to use for pair `index` of link 2. They are
    /// `here`, with one exception: if joint 1 also carries the obstacle, they are those with joint 1 at zero.
    pub fn frame(&self, index: usize, here: (Point, Vector)) -> (Point, Vector) {
        if self.pairs[index].link == 2 { self.at_zero } else { here }
    }

    /// Returns the scene that was prepared.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Appends to `out` the values of joint 1 at which pair `index`, of link 1, is within `grow` of contact.
    ///
    /// # Panics
    /// If the pair is of link 2, or there is no pair of that number.
    pub fn first_link(&self, index: usize, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let pair = self.pairs[index];
        assert_eq!(pair.link, 0, "a pair of link 1");
        self.part(pair).carried.hits(self.scene.arm().base, Vector::x(), self.piece(pair), grow, out)
    }

    /// Appends to `out` the values of joint 2 at which pair `index`, of link 2, is within `grow` of contact, with joint
    /// 1 at `q1`.
    ///
    /// # Panics
    /// If the pair is of link 1, or there is no pair of that number.
    pub fn second_link(&self, index: usize, q1: f64, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let (elbow, heading) = self.elbow(q1);
        self.at_elbow(index, elbow, heading, grow, out)
    }

    /// Appends values of joint 1 at which pair `index`, of link 2, may be within `grow` of contact for some value of
    /// joint 2. At all other values the pair is farther apart. The intervals are those at which the part's sweep meets
    /// the piece. For a revolute joint 2 the sweep is the disc about the elbow that contains the part at every angle.
    /// For a prismatic one it is a capsule that contains the part over the joint's whole range.
    ///
    /// # Panics
    /// If the pair is of link 1, or there is no pair of that number.
    pub fn reach_range(&self, index: usize, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let pair = self.pairs[index];
        if pair.link == 2 {
            return Hits::Always;
        }
        let sweep = self.part(pair).sweep.as_ref().expect("a pair of link 2");
        sweep.hits(self.scene.arm().base, Vector::x(), self.piece(pair), grow, out)
    }

    /// Returns the numbers of the pairs of link 2; those of link 1 come before.
    pub fn second_link_pairs(&self) -> Range<usize> {
        self.second.1..self.pairs.len()
    }

    /// Returns an upper bound, in metres, on how far points move while joint 1 moves by at most `step` and joint 2
    /// stands still. The points are those of pair `index`'s part that are within `clearance` of the piece.
    pub fn motion(&self, index: usize, step: f64, clearance: f64) -> f64 {
        let pair = self.pairs[index];
        if pair.link == 2 {
            return 0.0;
        }
        let touched = self.pieces[pair.piece as usize].reach + clearance;
        self.chord(self.part(pair).reach.min(touched), step)
    }

    /// Returns an upper bound on the motion of all points of a part, metres, while joint 1 moves by at most `step`
    /// and joint 2 stands still.
    pub fn motion_of(&self, part: usize, step: f64) -> f64 {
        let part = &self.parts[part];
        if part.link == 2 { 0.0 } else { self.chord(part.reach, step) }
    }

    /// Returns an upper bound on the distance of pair `index`'s part from the base, metres, at any value of joint 2,
    /// while joint 1 is at zero.
    pub fn reach(&self, index: usize) -> f64 {
        self.part(self.pairs[index]).reach
    }

    /// Returns the distance, metres, that a point at distance `reach` from the base moves while joint 1 moves by
    /// `step`.
    fn chord(&self, reach: f64, step: f64) -> f64 {
        match self.scene.arm().joints[0].joint_type {
            JointType::Prismatic { .. } => step,
            JointType::Revolute { .. } => 2.0 * reach * (step.min(PI) / 2.0).sin(),
        }
    }

    /// Returns an upper bound on the motion of the part of pair `index` per unit of the joint that carries its link:
    /// metres per radian or metre.
    pub fn lever(&self, index: usize) -> f64 {
        let part = &self.part(self.pairs[index]).carried;
        part.joint_type().lever(part.shape().reach_from(Point::zeros()))
    }

    /// Returns the place of joint 2 at `q1`, and the direction of link 1's x axis.
    pub fn elbow(&self, q1: f64) -> (Point, Vector) {
        elbow(self.scene, q1)
    }

    /// Does the same as [`Contacts::second_link`], for a given place of joint 2 (`elbow`) and direction of link 1's x
    /// axis (`heading`).
    ///
    /// # Panics
    /// If the pair is of link 1, or there is no pair of that number.
    pub fn at_elbow(&self, index: usize, elbow: Point, heading: Vector, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let pair = self.pairs[index];
        assert_ne!(pair.link, 0, "a pair of link 2");
        let (elbow, heading) = self.frame(index, (elbow, heading));
        self.part(pair).carried.hits(elbow, heading, self.piece(pair), grow, out)
    }
}

/// Returns the place of joint 2 at `q1`, and the direction of link 1's x axis.
fn elbow(scene: &Scene, q1: f64) -> (Point, Vector) {
    let pose = scene.arm().pose(0, Configuration::new(q1, 0.0));
    (pose.point(scene.arm().offset), pose.direction(Vector::x()))
}
