//! Slices of configuration space: at a fixed value of joint 1, exactly which values of joint 2 are forbidden.

use crate::geometry::{BoxTree, Features, Hits, Point, ROUNDING, Vector, merge_in_place};
use crate::interrupt::checkpoint;
use crate::model::{Carried, JointType, Pair, Scene, on_axis, swept};
use crate::space::Configuration;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;

/// A scene prepared for slices.
///
/// Pairs are numbered as in [`Scene::pairs`]. Every interval is closed, exact up to [`crate::geometry::ROUNDING`], and of joint
/// values: *unwrapped* for a revolute joint (start in `[-pi, pi)`, end possibly beyond `pi`, to be repeated by whole
/// turns), as they are for a prismatic one. Limits are not applied; see [`Slices::slice`] for that.
#[derive(Debug, Clone)]
pub struct Slices<'a> {
    scene: &'a Scene,
    pairs: Vec<Prepared>,
    parts: Vec<PreparedPart>,
    pieces: Vec<Features>,
}

/// A pair, by numbers.
#[derive(Debug, Clone, Copy)]
struct Prepared {
    link: u32,
    /// Into the parts.
    part: u32,
    /// Into the pieces.
    piece: u32,
}

/// A part, prepared for the joint that carries it.
#[derive(Debug, Clone)]
struct PreparedPart {
    carried: Carried,
    /// Link 2 only: the part with all its positions under joint 2, as carried by joint 1.
    sweep: Option<Carried>,
    /// The numbers of the pairs that the part is in.
    pairs: Range<usize>,
    /// The boxes of their pieces.
    pieces: BoxTree,
}

impl PreparedPart {
    /// The part of some pairs, which are the next from the number `from` on.
    fn new(scene: &Scene, pairs: &[Pair], from: usize) -> Self {
        let arm = scene.arm();
        let [first, second] = &arm.joints;
        let part = scene.part(pairs[0]);
        let (carried, sweep) = if pairs[0].link == 0 {
            (Carried::new(first.joint_type, part), None)
        } else {
            let sweep = swept(part, second, arm.offset);
            (Carried::new(second.joint_type, part), Some(Carried::new(first.joint_type, &sweep)))
        };
        let pieces = BoxTree::new(pairs.iter().map(|&pair| scene.piece(pair).bounds()).collect());
        Self { carried, sweep, pairs: from..from + pairs.len(), pieces }
    }

    /// The numbers of its pairs, ascending, that it can come near to with joint 2 at `elbow`, and some others.
    fn near(&self, elbow: Point, grow: f64, found: &mut Vec<u32>) {
        found.clear();
        match self.carried.joint_type() {
            JointType::Revolute { .. } => {
                let around = Vector::repeat(self.carried.shape().reach_from(Point::origin()) + grow + ROUNDING);
                self.pieces.meeting(&[elbow - around, elbow + around], found);
                found.iter_mut().for_each(|index| *index += self.pairs.start as u32);
            }
            JointType::Prismatic { .. } => found.extend(self.pairs.start as u32..self.pairs.end as u32),
        }
    }
}

impl<'a> Slices<'a> {
    /// Prepares a scene. Linear in its size.
    #[must_use]
    pub fn new(scene: &'a Scene) -> Self {
        let (mut parts, mut pieces, mut pairs) = (Vec::new(), Vec::new(), Vec::with_capacity(scene.pairs().len()));
        let mut piece_of = HashMap::new();
        for of_part in scene.pairs().chunk_by(|a, b| (a.link, a.part) == (b.link, b.part)) {
            parts.push(PreparedPart::new(scene, of_part, pairs.len()));
            for &pair in of_part {
                checkpoint();
                let piece = *piece_of.entry((pair.obstacle, pair.piece)).or_insert_with(|| {
                    pieces.push(Features::new(scene.piece(pair)));
                    pieces.len() as u32 - 1
                });
                pairs.push(Prepared { link: pair.link as u32, part: parts.len() as u32 - 1, piece });
            }
        }
        Self { scene, pairs, parts, pieces }
    }

    fn part(&self, pair: Prepared) -> &PreparedPart {
        &self.parts[pair.part as usize]
    }

    fn piece(&self, pair: Prepared) -> &Features {
        &self.pieces[pair.piece as usize]
    }

    /// The scene that was prepared.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Values of joint 1 at which pair `index`, of link 1, comes within `grow` of contact.
    ///
    /// # Panics
    /// If the pair is of link 2, or there is none of that number.
    pub fn first_link(&self, index: usize, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let pair = self.pairs[index];
        assert_eq!(pair.link, 0, "a pair of link 1");
        self.part(pair).carried.hits(self.scene.arm().base, Vector::x(), self.piece(pair), grow, out)
    }

    /// Values of joint 2 at which pair `index`, of link 2, comes within `grow` of contact while joint 1 is at `q1`.
    ///
    /// # Panics
    /// If the pair is of link 1, or there is none of that number.
    pub fn second_link(&self, index: usize, q1: f64, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let (elbow, heading) = self.elbow(q1);
        self.at_elbow(index, elbow, heading, grow, out)
    }

    /// Values of joint 1 outside which pair `index`, of link 2, keeps farther than `grow` from contact whatever joint 2
    /// does: those at which the part's sweep meets the piece. For a revolute joint 2 the sweep is the disc about the
    /// elbow that holds the part, for a prismatic one a capsule that holds it over the joint's whole range.
    ///
    /// # Panics
    /// If the pair is of link 1, or there is none of that number.
    pub fn reach_range(&self, index: usize, grow: f64, out: &mut Vec<[f64; 2]>) -> Hits {
        let pair = self.pairs[index];
        let sweep = self.part(pair).sweep.as_ref().expect("a pair of link 2");
        sweep.hits(self.scene.arm().base, Vector::x(), self.piece(pair), grow, out)
    }

    /// All forbidden values of joint 2 at `q1`, over the axis's domain, with obstacles grown by `grow`: those of link 2
    /// only. Reuses `slice`'s memory. `O(m log m)` in the contacts.
    pub fn slice(&self, q1: f64, grow: f64, slice: &mut Slice) {
        checkpoint();
        slice.clear();
        let (elbow, heading) = self.elbow(q1);
        let joint = &self.scene.arm().joints[1];
        let mut near = std::mem::take(&mut slice.near);
        for part in self.parts.iter().filter(|part| part.sweep.is_some()) {
            part.near(elbow, grow, &mut near);
            for &index in &near {
                slice.scratch.clear();
                let index = index as usize;
                let hits = self.at_elbow(index, elbow, heading, grow, &mut slice.scratch);
                let Slice { forbidden, scratch, .. } = slice;
                on_axis(joint, hits, scratch, |interval| forbidden.push(Forbidden { pair: index, interval }));
            }
        }
        slice.near = near;
        slice.merge();
    }

    /// All forbidden values of joint 1, over the axis's domain, with obstacles grown by `grow`: those of link 1 only.
    pub fn bands(&self, grow: f64) -> Slice {
        let mut slice = Slice::default();
        for index in 0..self.second_link_pairs().start {
            slice.scratch.clear();
            let hits = self.first_link(index, grow, &mut slice.scratch);
            let Slice { forbidden, scratch, .. } = &mut slice;
            let joint = &self.scene.arm().joints[0];
            on_axis(joint, hits, scratch, |interval| forbidden.push(Forbidden { pair: index, interval }));
        }
        slice.merge();
        slice
    }

    /// Numbers of the pairs of link 2; those of link 1 come before.
    #[must_use]
    pub fn second_link_pairs(&self) -> std::ops::Range<usize> {
        self.pairs.partition_point(|p| p.link == 0)..self.pairs.len()
    }

    /// Farthest that a point of pair `index`'s part which is within `clearance` of the piece can move, metres, while
    /// joint 1 moves by at most `step` and joint 2 not at all. About a revolute joint a point's chord grows with its
    /// distance from the base, and a point near the piece is no farther out than the piece is.
    #[must_use]
    pub fn motion(&self, index: usize, step: f64, clearance: f64) -> f64 {
        let pair = self.pairs[index];
        match self.scene.arm().joints[0].joint_type {
            JointType::Prismatic { .. } => step,
            JointType::Revolute { .. } => {
                let part = self.part(pair);
                let carried = part.sweep.as_ref().unwrap_or(&part.carried).shape().reach_from(Point::origin());
                let touched = self.piece(pair).shape().reach_from(self.scene.arm().base) + clearance;
                2.0 * carried.min(touched) * (step.min(PI) / 2.0).sin()
            }
        }
    }

    /// Farthest that a point of pair `index`'s part moves per unit of the joint that carries its link, metres.
    #[must_use]
    pub fn lever(&self, index: usize) -> f64 {
        let part = &self.part(self.pairs[index]).carried;
        match part.joint_type() {
            JointType::Prismatic { .. } => 1.0,
            JointType::Revolute { .. } => part.shape().reach_from(Point::origin()),
        }
    }

    /// Where joint 2 is at `q1`, and the direction of link 1's x axis.
    pub(super) fn elbow(&self, q1: f64) -> (Point, Vector) {
        let pose = self.scene.arm().pose(0, Configuration::new(q1, 0.0));
        (pose * Point::from(self.scene.arm().offset), pose * Vector::x())
    }

    /// [`Slices::second_link`] with the elbow at hand.
    pub(super) fn at_elbow(
        &self,
        index: usize,
        elbow: Point,
        heading: Vector,
        grow: f64,
        out: &mut Vec<[f64; 2]>,
    ) -> Hits {
        let pair = self.pairs[index];
        assert_eq!(pair.link, 1, "a pair of link 2");
        self.part(pair).carried.hits(elbow, heading, self.piece(pair), grow, out)
    }
}

/// A forbidden interval of one pair, within the axis's domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forbidden {
    /// Number of the pair in [`Scene::pairs`].
    pub pair: usize,
    /// Closed; joint values.
    pub interval: [f64; 2],
}

/// The forbidden intervals of one slice (or, for link 1, of joint 1). On a circle an interval over the seam is in two.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Slice {
    /// By pair, in the pairs' order.
    pub forbidden: Vec<Forbidden>,
    /// Their union: disjoint, ascending.
    pub merged: Vec<[f64; 2]>,
    scratch: Vec<[f64; 2]>,
    near: Vec<u32>,
}

impl Slice {
    /// Whether the joint value is forbidden. `O(log n)`.
    #[must_use]
    pub fn forbids(&self, value: f64) -> bool {
        let after = self.merged.partition_point(|i| i[0] <= value);
        after > 0 && value <= self.merged[after - 1][1]
    }

    fn clear(&mut self) {
        self.forbidden.clear();
        self.merged.clear();
    }

    fn merge(&mut self) {
        self.merged.extend(self.forbidden.iter().map(|f| f.interval));
        merge_in_place(&mut self.merged);
    }
}
