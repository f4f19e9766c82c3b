//! Free and colliding values of joint 2 while joint 1 stays within a short interval, a *slab*.
//!
//! At a fixed `q1`, closed forms give the values of `q2` at which a pair touches (contact angles). While joint 1 moves by at most
//! `h` from the middle of the slab, link 2 moves rigidly, and those of its points that can touch the obstacle move by at most a
//! chord `m` about the base. So if the distance of the pair exceeds `m` in the middle, it is free all over the slab. If a point
//! is more than `m` deep in both shapes, the pair collides all over the slab.

use cplan_geometry::{Convex, Features, Hits, Point, ROUNDING, Vector};
use cplan_interrupt::checkpoint;
use cplan_judge::{Cell, Deviation, Posture};
use cplan_model::{CarriedPart, Contacts, Pair, Scene, on_axis};

/// Assumed error of closed forms, metres: twice the error that they state. The rest covers the rounding of sums of a few lengths,
/// and of angles with whole turns.
pub(super) const CLOSED_FORM_ERROR: f64 = 2.0 * ROUNDING;

/// Overlap that shapes need to collide in a whole slab, as a multiple of their motion over half the slab. With the excess, the
/// boxes of a proof have some height at the ends of a colliding interval, where joint 2 may move the shapes by a quarter of that
/// motion.
const REQUIRED_OVERLAP: f64 = 1.25;

/// A part of link 2, or a piece of an obstacle, in a pair of link 2.
struct PairShape {
    /// Greatest depth of any point of the shape, metres.
    depth: f64,
    /// For each level of slabs so far, this shape eroded, if it is the deeper one of a pair. The outer `None` means not computed
    /// yet, the inner `None` that nothing is left. An eroded part is stored only if it is the same for all pieces.
    eroded: Vec<Option<Option<ErodedShape>>>,
}

impl PairShape {
    fn new(shape: &Convex) -> Self {
        Self { depth: shape.depth(), eroded: Vec::new() }
    }
}

/// An eroded shape of a pair.
pub(super) enum ErodedShape {
    Part(CarriedPart),
    Piece(Features),
    /// Not eroded but grown by this length, metres, because the clearance exceeds the required overlap.
    Grown(f64),
}

impl ErodedShape {
    /// Erodes the deeper of the two shapes by `overlap - clearance`. Returns `None` if nothing is left.
    pub fn new(part: &CarriedPart, piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        if part.shape().depth() > piece.depth() {
            Self::part(part, piece, overlap, clearance)
        } else {
            Self::piece(piece, overlap, clearance)
        }
    }

    fn part(part: &CarriedPart, piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        let grow = clearance - overlap;
        let by = missing_radius(piece) - grow;
        if by <= 0.0 {
            return Some(Self::Grown(grow));
        }
        part.shape().eroded(by).map(|shape| Self::Part(CarriedPart::new(part.joint_type(), &shape)))
    }

    fn piece(piece: &Convex, overlap: f64, clearance: f64) -> Option<Self> {
        let grow = clearance - overlap;
        if missing_radius(piece) <= grow {
            return Some(Self::Grown(grow));
        }
        piece.eroded(-grow).map(|shape| Self::Piece(Features::new(&shape)))
    }

    /// Finds the values of the joint at which the eroded shape meets the other shape of the pair. There, the original shapes
    /// overlap by at least the erosion.
    pub fn hits(
        &self,
        part: &CarriedPart,
        piece: &Features,
        pivot: Point,
        heading: Vector,
        out: &mut Vec<[f64; 2]>,
    ) -> Hits {
        match self {
            Self::Part(eroded) => eroded.hits(pivot, heading, piece, missing_radius(piece.shape()), out),
            Self::Piece(eroded) => part.hits(pivot, heading, eroded, 0.0, out),
            Self::Grown(by) => part.hits(pivot, heading, piece, *by, out),
        }
    }
}

/// Returns the growth of a piece with a negative radius that makes the radius zero; 0 for other pieces. Only with a radius of at
/// least zero does a distance from the core give one from the piece.
fn missing_radius(piece: &Convex) -> f64 {
    (-piece.radius()).max(0.0)
}

/// Link 2 and the obstacles that it can hit, prepared for slabs of joint 1.
pub(super) struct SecondLink<'a> {
    contacts: Contacts<'a>,
    clearance: f64,
    /// The parts of link 2.
    parts: Vec<PairShape>,
    /// The pieces of obstacles in the pairs of link 2.
    pieces: Vec<PairShape>,
    scratch: Vec<[f64; 2]>,
    near: Vec<u32>,
}

/// The values of joint 2, within the domain, at which pairs collide in a slab. Lists are ordered by pair, numbered as in
/// [`Contacts`].
#[derive(Default)]
pub(super) struct Verdicts {
    /// Intervals outside which no pair comes too near anywhere in the slab.
    pub outer: Vec<[f64; 2]>,
    /// Pairs by number, each with an interval in which it is too near all over the slab.
    pub inner: Vec<(usize, [f64; 2])>,
    /// Intervals in which the sum of joint values is not allowed anywhere in the slab.
    pub beyond: Vec<[f64; 2]>,
}

impl<'a> SecondLink<'a> {
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let contacts = Contacts::new(scene);
        let of_pairs = &scene.pairs()[contacts.second_link_pairs()];
        let parts = of_pairs
            .chunk_by(|a, b| (a.link, a.part) == (b.link, b.part))
            .map(|of_part| PairShape::new(scene.part(of_part[0])))
            .collect();
        let piece = |pair: &Pair| {
            checkpoint();
            PairShape::new(scene.piece(*pair))
        };
        let pieces = of_pairs.iter().map(piece).collect();
        Self { contacts, clearance, parts, pieces, scratch: Vec::new(), near: Vec::new() }
    }

    /// Returns the required clearance, metres.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Returns the prepared contacts of the scene.
    pub fn contacts(&self) -> &Contacts<'a> {
        &self.contacts
    }

    /// Computes the intervals of joint 2 for the slab `from <= q1 <= to`. Slabs of a `level` have about the same width, at most
    /// twice `half`.
    pub fn judge(&mut self, from: f64, to: f64, level: usize, half: f64, verdicts: &mut Verdicts) {
        checkpoint();
        verdicts.outer.clear();
        verdicts.inner.clear();
        let topology = self.contacts.scene().arm().topology();
        verdicts.outer.extend([from, to].into_iter().flat_map(|end| topology.closed_by_sum([end; 2])));
        verdicts.beyond.clear();
        verdicts.beyond.extend(topology.closed_by_sum([from, to]));
        let middle = (from + to) / 2.0;
        let width = (to - middle).max(middle - from);
        let (elbow, heading) = self.contacts.elbow(middle);
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut near = std::mem::take(&mut self.near);
        for part in self.contacts.second_link_parts() {
            let far = self.clearance + self.contacts.motion_of(part, width) + 2.0 * CLOSED_FORM_ERROR;
            self.contacts.near(part, elbow, far, &mut near);
            let overlap = self.contacts.motion_of(part, half) * REQUIRED_OVERLAP + CLOSED_FORM_ERROR;
            for &index in &near {
                let index = index as usize;
                let grow = self.clearance + self.contacts.motion(index, width, self.clearance) + CLOSED_FORM_ERROR;
                scratch.clear();
                let hits = self.contacts.at_elbow(index, elbow, heading, grow, &mut scratch);
                if hits == Hits::Never {
                    continue;
                }
                let joint = &self.contacts.scene().arm().joints[1];
                on_axis(joint, hits, &scratch, |interval| verdicts.outer.push(interval));
                scratch.clear();
                let frame = self.contacts.frame(index, (elbow, heading));
                let hits = self.collision_boxes(index, level, overlap, frame, &mut scratch);
                on_axis(joint, hits, &scratch, |interval| {
                    if interval[0] < interval[1] {
                        verdicts.inner.push((index, interval));
                    }
                });
            }
        }
        (self.scratch, self.near) = (scratch, near);
    }

    /// Finds the values of joint 2 at which the shapes of a pair overlap by more than `overlap` minus the clearance. `overlap`
    /// must depend only on the part and the level, because eroded shapes are stored.
    fn collision_boxes(
        &mut self,
        index: usize,
        level: usize,
        overlap: f64,
        (elbow, heading): (Point, Vector),
        out: &mut Vec<[f64; 2]>,
    ) -> Hits {
        let (moving, standing) = (self.contacts.moving(index), self.contacts.static_shape(index));
        let (clearance, shape) = (self.clearance, standing.shape());
        let part = &mut self.parts[self.contacts.part_of(index) - self.contacts.second_link_parts().start];
        let piece = &mut self.pieces[index - self.contacts.second_link_pairs().start];
        let of_part = part.depth > piece.depth;
        // In this case, the eroded part is the same for all pieces.
        let shared = of_part && missing_radius(shape) == 0.0;
        let known = if shared { &mut part.eroded } else { &mut piece.eroded };
        if known.len() <= level {
            known.resize_with(level + 1, || None);
        }
        let eroded = known[level].get_or_insert_with(|| match of_part {
            true => ErodedShape::part(moving, shape, overlap, clearance),
            false => ErodedShape::piece(shape, overlap, clearance),
        });
        match eroded {
            None => Hits::Never,
            Some(eroded) => eroded.hits(moving, standing, elbow, heading, out),
        }
    }
}

/// Returns true if the pair is too near in the whole box, by the same bounds as in the check of a proof.
pub(super) fn is_collision(scene: &Scene, pair: Pair, cell: &Cell, clearance: f64) -> bool {
    Posture::new(scene, cell.center()).greatest(pair, Deviation::Box(cell.half())) < clearance
}

#[cfg(test)]
mod tests {
    use super::super::tiles::tile;
    use super::*;
    use crate::tests::scene;
    use cplan_geometry::hull;
    use cplan_model::space::{Configuration, JointRange};
    use proptest::prelude::*;

    fn shape(spread: f64) -> impl Strategy<Value = Convex> {
        let points = prop::collection::vec((-spread..spread, -spread..spread), 1..6);
        (points, prop_oneof![Just(0.0), 0.0..0.2f64]).prop_map(|(points, radius)| {
            let points: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            Convex::trusted(hull(&points), radius)
        })
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(600))]

        /// Compares the verdicts with the distance of the shapes in sampled configurations, which is independent of contact
        /// angles.
        #[test]
        fn verdicts_hold_all_over_the_slab(
            kinds in any::<[bool; 2]>(), offset in (-1.0..1.0f64, -1.0..1.0f64),
            part in shape(0.8), piece in shape(0.6), at in (-1.2..1.2f64, -1.2..1.2f64),
            middle in -3.0..3.0f64, half in prop_oneof![0.001..0.02f64, 0.02..0.3f64],
            clearance in prop_oneof![Just(0.0), 0.0..0.2f64],
            samples in prop::collection::vec((-1.0..=1.0f64, 0.0..=1.0f64), 40),
        ) {
            let moved = piece.core().iter().map(|p| p + Vector::new(at.0, at.1)).collect();
            let long = JointRange::Interval { lower: -4.0, upper: 4.0 };
            let ranges = [long, if kinds[1] { JointRange::Circle } else { long }];
            let piece = Convex::trusted(moved, piece.radius());
            let scene = scene(kinds, ranges, Vector::new(offset.0, offset.1), part, piece);
            let mut second = SecondLink::new(&scene, clearance);
            let mut verdicts = Verdicts::default();
            let (from, to) = (middle - half, middle + half);
            second.judge(from, to, 0, half * (1.0 + 1e-6), &mut verdicts);
            let Verdicts { mut outer, inner, .. } = verdicts;
            cplan_geometry::merge_in_place(&mut outer);
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
            // The boxes cover exactly the interval.
            for &(pair, interval) in &inner {
                let mut boxes = Vec::new();
                let pair = scene.pairs()[pair];
                prop_assert!(tile(&scene, clearance, [from, to], pair, interval, &mut boxes), "{interval:?}");
                boxes.sort_by(|a, b| a.cell.lower[1].total_cmp(&b.cell.lower[1]));
                prop_assert!(boxes.windows(2).all(|w| w[0].cell.upper[1] == w[1].cell.lower[1]));
                prop_assert_eq!([boxes[0].cell.lower[1], boxes[boxes.len() - 1].cell.upper[1]], interval);
            }
        }
    }
}
