//! Checks that shapes keep away from the sides of obstacles while the arm moves along curves.

mod chain;
mod guess;

pub use chain::{Attachment, Chain};

use crate::arm::Motion;
use crate::curve::{MAX_HALVINGS, Piece, Tube};
use crate::decimal::Decimal;
use crate::interval::{BITS, Interval, Point, both_turns, dot, length, minus, rough, roughly, sum, times, turned};
use crate::obstacle::ObstacleTrajectory;
use crate::overlap::Shape;
use chain::{Term, Terms};
use guess::{direction, ring};
use num_bigint::BigInt;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::rc::Rc;

/// Returns the margin by which distances must exceed the clearance: `2^-96` m, in units of [`Interval`].
pub fn guard() -> BigInt {
    BigInt::from(1) << (BITS - 96)
}

/// Number of binary digits of a separating direction, as in a double. A rounded direction separates slightly less well.
/// The loss is proportional to the size of an obstacle divided by its distance.
const DIRECTION_BITS: u32 = 52;

/// Number of tested parts of a motion after which the checker gives up. This takes some minutes.
const MAX_MOTION_PARTS: usize = 1_000_000;

/// A shape that the arm moves, with a disc that encloses its core.
pub struct Solid {
    on: Attachment,
    shape: Shape,
    /// Required distance from sides, in units of [`Interval`].
    kept: BigInt,
    corners: Vec<Terms>,
    center: Terms,
    extent: BigInt,
    /// Indices of the corners of its convex hull, in order. They serve to guess directions.
    ring: Vec<usize>,
}

/// A side of an obstacle, or a whole convex obstacle, with its corners in order. `seen` has the corners in the frames
/// of both links.
#[derive(Clone)]
pub struct Side {
    shape: Shape,
    seen: [Vec<Terms>; 2],
    center: Point,
    extent: BigInt,
}

/// A side of an obstacle from which shapes must keep away.
pub enum Edge {
    /// A side of a static obstacle.
    Still(Side),
    /// A side of a moving obstacle, in the obstacle's frame, with the obstacle's motion.
    Moving(Shape, Rc<dyn ObstacleTrajectory>),
}

/// The position of a point in the middle of a tube, and bounds on its motion within the tube.
struct Moving {
    at: Point,
    /// Derivatives of the position with respect to the joint values.
    rates: [Point; 2],
    /// Upper bound on the difference between the displacement of the point and its linear part, which `rates` determine.
    bend: Interval,
}

/// The arm in the middle of a tube.
struct Posture<'a> {
    chain: &'a Chain,
    tube: Tube,
    /// Sine and cosine of three turns: by the first joint, by the second, and by both.
    turns: [[Interval; 2]; 3],
    /// Greatest deviation of each of these three angles within the tube.
    deviations: [Interval; 3],
    /// Greatest deviation of each joint's value within the tube.
    each: [Interval; 2],
}

/// A shape in the middle of a tube.
struct Placed<'a> {
    solid: &'a Solid,
    center: Moving,
    /// Upper bound on the displacement of the centre within the tube.
    motion: BigInt,
    corners: OnceCell<Vec<Moving>>,
}

/// A stretch of a motion: a range of whole pieces, or a part of a piece with the number of its halvings.
enum Stretch {
    Pieces(usize, usize),
    Part(Piece, u32),
}

/// A stretch of a motion on which a shape is not proven to keep its distance from an edge.
pub struct EvidenceGap {
    /// Index of the knot before the stretch.
    pub knot: usize,
    /// Index of the shape.
    pub solid: usize,
    /// Index of the edge.
    pub edge: usize,
}

fn perpendicular([x, y]: &Point) -> Point {
    [-y, x.clone()]
}

impl Solid {
    /// Makes a shape that must keep more than `kept` units away from sides.
    pub fn new(chain: &Chain, on: Attachment, shape: &Shape, kept: &BigInt) -> Self {
        let (center, extent) = disc(&shape.points);
        Self {
            corners: shape.points.iter().map(|a| chain.attached_point(&on, a)).collect(),
            center: chain.attached_point(&on, &center),
            extent,
            ring: ring(&shape.points.iter().map(rough).collect::<Vec<_>>()),
            shape: shape.clone(),
            kept: kept.clone(),
            on,
        }
    }

    /// Returns the position of the shape's first corner in a configuration.
    pub fn corner_at(&self, chain: &Chain, values: &Point) -> Point {
        chain.sum_at(&self.corners[0], values)
    }
}

impl Edge {
    /// Returns a static side that contains the edge at all times of a span.
    pub fn side_during(&self, chain: &Chain, time: [&Decimal; 2]) -> Cow<'_, Side> {
        match self {
            Self::Still(side) => Cow::Borrowed(side),
            Self::Moving(shape, trajectory) => Cow::Owned(Side::new(chain, &trajectory.swept_shape(shape, time))),
        }
    }
}

impl Side {
    /// Makes a side, and computes its coordinates in the frames of a chain's links.
    pub fn new(chain: &Chain, shape: &Shape) -> Self {
        let (center, extent) = disc(&shape.points);
        let seen = [0, 1].map(|link| shape.points.iter().map(|p| chain.coordinates_in_link(link, p)).collect());
        Self { shape: shape.clone(), seen, center, extent }
    }

    /// Returns one of the side's points.
    pub fn point(&self) -> &Point {
        &self.shape.points[0]
    }
}

/// Returns a point in the middle of some points, and an upper bound on its distance from them.
fn disc(points: &[Point]) -> (Point, BigInt) {
    let middle = |k: usize| {
        let values = || points.iter().map(|p| p[k].middle().0);
        let ends = [values().min(), values().max()].map(|end| end.expect("a shape has points"));
        Interval::exact((&ends[0] + &ends[1]) >> 1u32)
    };
    let center = [middle(0), middle(1)];
    let extent = points.iter().map(|p| length(&minus(p, &center)).upper).max().expect("a shape has points");
    (center, extent)
}

impl<'a> Posture<'a> {
    fn new(chain: &'a Chain, tube: Tube) -> Self {
        let [s1, s2] = [0, 1].map(|k| chain.sign(k));
        let zero = Interval::whole(0);
        let turn = |sign: &Interval, value: &Interval| match sign.is_whole(0) {
            true => [zero.clone(), Interval::whole(1)],
            false => (sign * value).sin_cos(),
        };
        let [first, second] = [turn(&s1, &tube.middle[0]), turn(&s2, &tube.middle[1])];
        let both = both_turns(&first, &second);
        let greatest = |g: [&Interval; 2]| tube.greatest(&g.map(Clone::clone));
        let deviations = [greatest([&s1, &zero]), greatest([&zero, &s2]), greatest([&s1, &s2])];
        let one = &Interval::whole(1);
        let each = [greatest([one, &zero]), greatest([&zero, one])];
        Self { chain, tube, turns: [first, second, both], deviations, each }
    }

    /// Returns the index in [`Self::turns`] of the angle by which the given joints turn a vector. `None` if no joint turns it.
    fn angle(by: [bool; 2]) -> Option<usize> {
        match by {
            [false, false] => None,
            [true, false] => Some(0),
            [false, true] => Some(1),
            [true, true] => Some(2),
        }
    }

    /// Expands the position of a point by Taylor's formula about the middle of the tube. `docs/certificate_checks.md`
    /// derives the bound on the remainder.
    fn moving(&self, terms: &[Term]) -> Moving {
        let zero = || [0, 0].map(Interval::whole);
        let mut moving = Moving { at: zero(), rates: [zero(), zero()], bend: Interval::whole(0) };
        for term in terms {
            let mut inner = term.at.clone();
            if let Some((joint, direction)) = &term.slide {
                inner = sum(&inner, &times(direction, &self.tube.middle[*joint]));
            }
            let angle = Self::angle(term.by);
            let turn = angle.map(|which| {
                let [sine, cosine] = &self.turns[which];
                [if term.back { -sine } else { sine.clone() }, cosine.clone()]
            });
            let place = |v: &Point| turn.as_ref().map_or_else(|| v.clone(), |turn| turned(v, turn));
            let at = place(&inner);
            for joint in (0..2).filter(|joint| term.by[*joint]) {
                let sign = self.chain.sign(joint);
                let rate = times(&perpendicular(&at), &if term.back { -&sign } else { sign });
                moving.rates[joint] = sum(&moving.rates[joint], &rate);
            }
            if let Some(which) = angle {
                let deviation = &self.deviations[which];
                let second = (&(deviation * deviation) * &length(&inner)).half();
                moving.bend = &moving.bend + &second;
            }
            if let Some((joint, direction)) = &term.slide {
                moving.rates[*joint] = sum(&moving.rates[*joint], &place(direction));
                if let Some(which) = angle {
                    let mixed = &(&self.deviations[which] * &self.each[*joint]) * &length(direction);
                    moving.bend = &moving.bend + &mixed;
                }
            }
            moving.at = sum(&moving.at, &at);
        }
        moving
    }

    /// Returns an upper bound on the displacement of a point within the tube.
    fn motion(&self, moving: &Moving) -> BigInt {
        let [first, second] = &moving.rates;
        let across = [0, 1].map(|k| self.tube.greatest(&[first[k].clone(), second[k].clone()]));
        (&length(&across) + &moving.bend).upper
    }

    /// Returns true if lines perpendicular to `n` separate the moving points from the static ones in the whole tube,
    /// with a gap of more than `apart`.
    fn separates(&self, n: &Point, moving: &[Moving], still: &[Point], apart: &BigInt) -> bool {
        let size = length(n);
        let reached = moving.iter().map(|point| {
            let rates = point.rates.each_ref().map(|rate| dot(n, rate));
            (&(&dot(n, &point.at) + &self.tube.greatest(&rates)) + &(&size * &point.bend)).upper
        });
        let (Some(most), Some(least)) = (reached.max(), still.iter().map(|p| dot(n, p).lower).min()) else {
            return false;
        };
        least - most > (&size * &Interval::exact(apart.clone())).upper
    }

    fn placed<'s>(&self, solid: &'s Solid) -> Placed<'s> {
        let center = self.moving(&solid.center);
        Placed { solid, motion: self.motion(&center), center, corners: OnceCell::new() }
    }

    /// Returns true if a shape is proven to keep its required distance from a side in the whole tube.
    fn keeps_distance(&self, placed: &Placed, side: &Side) -> bool {
        let solid = placed.solid;
        let apart = &solid.kept + &solid.shape.radius.upper + &side.shape.radius.upper;
        let discs = &apart + &solid.extent + &side.extent + &placed.motion;
        let [x, y] = minus(&placed.center.at, &side.center).map(|c| c.abs().lower);
        if &x * &x + &y * &y > &discs * &discs {
            return true;
        }
        let corners = placed.corners.get_or_init(|| solid.corners.iter().map(|c| self.moving(c)).collect());
        // Relative to the shape, coordinates stay accurate far from the origin.
        let seen = |p: &Point| rough(&minus(p, &placed.center.at));
        let here: Vec<[f64; 2]> = solid.ring.iter().map(|i| seen(&corners[*i].at)).collect();
        let there: Vec<[f64; 2]> = side.shape.points.iter().map(seen).collect();
        let Some([x, y]) = direction(&here, &there, roughly(&apart)) else { return false };
        let exact = |n: [f64; 2]| {
            n.map(|c| {
                Interval::exact(BigInt::from((c * (1_u64 << DIRECTION_BITS) as f64) as i64) << (BITS - DIRECTION_BITS))
            })
        };
        if self.separates(&exact([x, y]), corners, &side.shape.points, &apart) {
            return true;
        }
        // Try again in the frame of the link, where the shape is at rest and the side moves.
        let Attachment::Link(link) = solid.on else { return false };
        let by = [0, 1].map(|k| k <= link && matches!(self.chain.motions[k], Motion::Turn(_)));
        let [sine, cosine] = Self::angle(by).map_or([0.0, 1.0], |which| rough(&self.turns[which]));
        let turned_back = [-(cosine * x + sine * y), -(cosine * y - sine * x)];
        let moving: Vec<Moving> = side.seen[link].iter().map(|p| self.moving(p)).collect();
        self.separates(&exact(turned_back), &moving, &solid.shape.points, &apart)
    }
}

/// Checks that shapes keep their required distances from edges, along consecutive pieces.
///
/// # Errors
/// Returns the first stretch, shape and edge for which this is not shown.
pub fn check_distances(
    chain: &Chain,
    pieces: &[Piece],
    (solids, edges): (&[&Solid], &[&Edge]),
    pairs: Vec<[usize; 2]>,
) -> Result<(), EvidenceGap> {
    let mut stack = vec![(Stretch::Pieces(0, pieces.len()), pairs)];
    let mut parts = 0;
    while let Some((stretch, mut pairs)) = stack.pop() {
        parts += 1;
        let of = match &stretch {
            Stretch::Pieces(from, to) => &pieces[*from..*to],
            Stretch::Part(piece, _) => std::slice::from_ref(piece),
        };
        let posture = Posture::new(chain, Tube::containing(of));
        let placed: Vec<OnceCell<Placed>> = solids.iter().map(|_| OnceCell::new()).collect();
        let sides: Vec<OnceCell<Cow<Side>>> = edges.iter().map(|_| OnceCell::new()).collect();
        let time = [&of[0].time[0], &of[of.len() - 1].time[1]];
        pairs.retain(|&[solid, edge]| {
            let placed = placed[solid].get_or_init(|| posture.placed(solids[solid]));
            !posture.keeps_distance(placed, sides[edge].get_or_init(|| edges[edge].side_during(chain, time)))
        });
        let Some(&[solid, edge]) = pairs.first() else { continue };
        let (first, second) = match stretch {
            Stretch::Pieces(from, to) if to - from > 1 => {
                let middle = from + (to - from) / 2;
                (Stretch::Pieces(from, middle), Stretch::Pieces(middle, to))
            }
            Stretch::Part(piece, halvings) if halvings >= MAX_HALVINGS || parts > MAX_MOTION_PARTS => {
                return Err(EvidenceGap { knot: piece.knot, solid, edge });
            }
            Stretch::Pieces(from, _) => halved(&pieces[from], 0),
            Stretch::Part(piece, halvings) => halved(&piece, halvings),
        };
        stack.push((second, pairs.clone()));
        stack.push((first, pairs));
    }
    Ok(())
}

fn halved(piece: &Piece, halvings: u32) -> (Stretch, Stretch) {
    let [first, second] = piece.halves();
    (Stretch::Part(first, halvings + 1), Stretch::Part(second, halvings + 1))
}
