//! Whether shapes stay off the sides of obstacles while the arm moves along curves.

use crate::curve::{HALVINGS, Piece, Tube};
use crate::decimal::Decimal;
use crate::interval::{BITS, Interval, Point, both_turns, dot, length, minus, rough, roughly, sum, times, turned};
use crate::overlap::Shape;
use crate::robot::{Arm, Motion};
use crate::world::{Course, Obstacle};
use num_bigint::BigInt;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::rc::Rc;

/// Shapes keep farther than the clearance by this many units, at the least: `2^-96`.
pub fn guard() -> BigInt {
    BigInt::from(1) << (BITS - 96)
}

/// Directions that may separate are written with so many binary digits, all that a double has: what is left out counts as often as an obstacle is
/// larger than the distance to it.
const DIGITS: u32 = 52;

/// Parts of a motion that are looked at before the checker gives up: some minutes' worth.
const MOST_PARTS: usize = 1_000_000;

/// A vector that turns with the joints: `R(±(s1 q1 + s2 q2)) (at + slide q)`, of whose angles those count that are named.
#[derive(Clone)]
struct Term {
    by: [bool; 2],
    back: bool,
    at: Point,
    slide: Option<(usize, Point)>,
}

/// A point by the vectors that add up to it.
type Terms = Vec<Term>;

/// How two joints move what they carry.
#[derive(Clone)]
pub struct Chain {
    motions: [Motion; 2],
    base: Point,
    offset: Point,
}

/// What a shape hangs on.
#[derive(Clone)]
pub enum On {
    /// A link, as it is seen from the link's joint.
    Link(usize),
    /// A point of the second link, about which it never turns.
    Level(Point),
}

/// A shape that is carried, and a disc round its core.
pub struct Solid {
    on: On,
    shape: Shape,
    /// How far it keeps off.
    kept: BigInt,
    corners: Vec<Terms>,
    center: Terms,
    extent: BigInt,
    /// Corners of its hull in order, for guesses.
    ring: Vec<usize>,
}

/// A side of an obstacle, or a convex shape that is one as a whole, its corners in order, as seen from the plane and from either link.
#[derive(Clone)]
pub struct Side {
    shape: Shape,
    seen: [Vec<Terms>; 2],
    center: Point,
    extent: BigInt,
}

/// What shapes keep off: what stands, or in its own frame what moves.
pub enum Edge {
    Still(Side),
    Moving(Shape, Rc<Course>),
}

/// A point of a tube's middle, and how it moves within the tube.
struct Moving {
    at: Point,
    /// By each joint.
    rates: [Point; 2],
    /// A bound on what is left of its motion beyond these.
    bend: Interval,
}

/// The arm in the middle of a tube.
struct Posture<'a> {
    chain: &'a Chain,
    tube: Tube,
    /// Sine and cosine of the turn by the first joint, the second, and both.
    turns: [[Interval; 2]; 3],
    /// The greatest deviation of these angles.
    deviations: [Interval; 3],
    /// The same of the joints' values.
    each: [Interval; 2],
}

/// A shape in the middle of a tube.
struct Placed<'a> {
    solid: &'a Solid,
    center: Moving,
    /// A bound on how far the centre moves.
    motion: BigInt,
    corners: OnceCell<Vec<Moving>>,
}

/// A stretch of a motion: whole pieces, or a part of one that was halved so often.
enum Stretch {
    Pieces(usize, usize),
    Part(Piece, u32),
}

/// What was not shown: from this knot to the next, of this shape and this edge.
pub struct Open {
    pub knot: usize,
    pub solid: usize,
    pub edge: usize,
}

fn perpendicular([x, y]: &Point) -> Point {
    [-y, x.clone()]
}

fn negative(a: &Point) -> Point {
    [-&a[0], -&a[1]]
}

/// A vector that does not turn, beside others: added to one of them, if there is one.
fn shifted(terms: &mut Terms, by: &Point) {
    match terms.iter_mut().find(|term| term.by == [false; 2]) {
        Some(still) => still.at = sum(&still.at, by),
        None => terms.push(Term { by: [false; 2], back: false, at: by.clone(), slide: None }),
    }
}

impl From<&Arm<'_>> for Chain {
    fn from(arm: &Arm) -> Self {
        let motions = arm.joints.each_ref().map(|joint| joint.motion.clone());
        Self { motions, base: arm.base.clone(), offset: arm.offset.clone() }
    }
}

impl Chain {
    /// What turns left about a point.
    pub fn about(point: &Point) -> Self {
        let offset = [0, 0].map(Interval::whole);
        Self { motions: [Motion::Turn(1), Motion::Turn(1)], base: point.clone(), offset }
    }

    /// Where a point of a link is that is at `a` as seen from the link's joint.
    fn carried(&self, link: usize, a: &Point) -> Terms {
        let mut terms = Terms::new();
        shifted(&mut terms, a);
        for joint in (0..=link).rev() {
            self.moved(&mut terms, joint, false);
            shifted(&mut terms, [&self.base, &self.offset][joint]);
        }
        terms
    }

    /// Where a point of the plane is as seen from the link's joint: the inverse of [`Arm::carried`].
    fn seen(&self, link: usize, p: &Point) -> Terms {
        let mut terms = Terms::new();
        shifted(&mut terms, p);
        for joint in 0..=link {
            shifted(&mut terms, &negative([&self.base, &self.offset][joint]));
            self.moved(&mut terms, joint, true);
        }
        terms
    }

    /// Moves the sum of vectors by a joint, or back.
    fn moved(&self, terms: &mut Terms, joint: usize, back: bool) {
        match &self.motions[joint] {
            Motion::Turn(_) => {
                for term in terms {
                    term.by[joint] = true;
                    term.back = back;
                }
            }
            Motion::Slide(direction) => {
                let slide = Some((joint, if back { negative(direction) } else { direction.clone() }));
                match terms.iter_mut().find(|term| term.by == [false; 2] && term.slide.is_none()) {
                    Some(still) => still.slide = slide,
                    None => terms.push(Term { by: [false; 2], back, at: [0, 0].map(Interval::whole), slide }),
                }
            }
        }
    }

    /// How a joint's angle counts: left 1, right -1, a slide 0.
    fn sign(&self, joint: usize) -> Interval {
        Interval::whole(match self.motions[joint] {
            Motion::Turn(sign) => sign,
            Motion::Slide(_) => 0,
        })
    }

    /// Where a point is of what hangs on something.
    fn hanging(&self, on: &On, a: &Point) -> Terms {
        match on {
            On::Link(link) => self.carried(*link, a),
            On::Level(point) => {
                let mut terms = self.carried(1, point);
                shifted(&mut terms, a);
                terms
            }
        }
    }

    /// The same at a configuration.
    pub fn point_at(&self, on: &On, a: &Point, values: &Point) -> Point {
        self.still(&self.hanging(on, a), values)
    }

    /// What lies in the plane, as it hangs on the second link that takes it at a configuration.
    pub fn hung(&self, lying: &Obstacle, values: &Point) -> Obstacle {
        lying.clone().moved(self.seen_at(&lying.at, values), self.turn(1, &lying.turn, true, values))
    }

    /// What hangs on something, in the plane, at a configuration.
    pub fn lying(&self, on: &On, hanging: &Obstacle, values: &Point) -> Obstacle {
        let turn = match on {
            On::Level(_) => hanging.turn.clone(),
            On::Link(link) => self.turn(*link, &hanging.turn, false, values),
        };
        hanging.clone().moved(self.point_at(on, &hanging.at, values), turn)
    }

    /// Sine and cosine of how what hangs on a link lies, or back.
    fn turn(&self, link: usize, [sine, cosine]: &[Interval; 2], back: bool, values: &Point) -> [Interval; 2] {
        let by = [0, 1].map(|joint| joint <= link && matches!(self.motions[joint], Motion::Turn(_)));
        let [x, y] = self.still(&[Term { by, back, at: [cosine.clone(), sine.clone()], slide: None }], values);
        [y, x]
    }

    /// A point of the plane as it is seen from the second link's joint at a configuration.
    fn seen_at(&self, p: &Point, values: &Point) -> Point {
        self.still(&self.seen(1, p), values)
    }

    fn still(&self, terms: &[Term], values: &Point) -> Point {
        Posture::new(self, Tube::still(values.clone())).moving(terms).at
    }
}

impl Solid {
    /// A shape that is to keep farther than `kept` units from sides.
    pub fn new(chain: &Chain, on: On, shape: &Shape, kept: &BigInt) -> Self {
        let (center, extent) = disc(&shape.points);
        Self {
            corners: shape.points.iter().map(|a| chain.hanging(&on, a)).collect(),
            center: chain.hanging(&on, &center),
            extent,
            ring: ring(&shape.points.iter().map(rough).collect::<Vec<_>>()),
            shape: shape.clone(),
            kept: kept.clone(),
            on,
        }
    }

    /// A corner of it at a configuration.
    pub fn corner_at(&self, chain: &Chain, values: &Point) -> Point {
        chain.still(&self.corners[0], values)
    }
}

impl Edge {
    /// What holds it all over a span of time.
    pub fn during(&self, chain: &Chain, time: [&Decimal; 2]) -> Cow<'_, Side> {
        match self {
            Self::Still(side) => Cow::Borrowed(side),
            Self::Moving(shape, course) => Cow::Owned(Side::new(chain, &course.during(shape, time))),
        }
    }
}

impl Side {
    pub fn new(chain: &Chain, shape: &Shape) -> Self {
        let (center, extent) = disc(&shape.points);
        let seen = [0, 1].map(|link| shape.points.iter().map(|p| chain.seen(link, p)).collect());
        Self { shape: shape.clone(), seen, center, extent }
    }

    /// A point of it.
    pub fn point(&self) -> &Point {
        &self.shape.points[0]
    }
}

/// A point amid some, and a bound on their distance from there.
fn disc(points: &[Point]) -> (Point, BigInt) {
    let middle = |k: usize| {
        let values = || points.iter().map(|p| p[k].middle().0);
        let ends = [values().min(), values().max()].map(|end| end.expect("a shape has points"));
        Interval::exactly((&ends[0] + &ends[1]) >> 1u32)
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

    /// Which of the angles a vector turns by.
    fn angle(by: [bool; 2]) -> Option<usize> {
        match by {
            [false, false] => None,
            [true, false] => Some(0),
            [false, true] => Some(1),
            [true, true] => Some(2),
        }
    }

    /// A point by Taylor's formula about the middle: `docs/certificate_checks.md` has the bound.
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

    /// A bound on how far a point moves within the tube.
    fn motion(&self, moving: &Moving) -> BigInt {
        let [first, second] = &moving.rates;
        let across = [0, 1].map(|k| self.tube.greatest(&[first[k].clone(), second[k].clone()]));
        (&length(&across) + &moving.bend).upper
    }

    /// Whether all over the tube the moving points stay on the one side of a line across `n`, the still ones on the other, and the two
    /// farther from one another than that.
    fn separates(&self, n: &Point, moving: &[Moving], still: &[Point], apart: &BigInt) -> bool {
        let size = length(n);
        let reached = moving.iter().map(|point| {
            let rates = point.rates.each_ref().map(|rate| dot(n, rate));
            (&(&dot(n, &point.at) + &self.tube.greatest(&rates)) + &(&size * &point.bend)).upper
        });
        let (Some(most), Some(least)) = (reached.max(), still.iter().map(|p| dot(n, p).lower).min()) else {
            return false;
        };
        least - most > (&size * &Interval::exactly(apart.clone())).upper
    }

    fn placed<'s>(&self, solid: &'s Solid) -> Placed<'s> {
        let center = self.moving(&solid.center);
        Placed { solid, motion: self.motion(&center), center, corners: OnceCell::new() }
    }

    /// Whether it is shown that a shape keeps off a side all over the tube.
    fn keeps_off(&self, placed: &Placed, side: &Side) -> bool {
        let solid = placed.solid;
        let apart = &solid.kept + &solid.shape.radius.upper + &side.shape.radius.upper;
        let discs = &apart + &solid.extent + &side.extent + &placed.motion;
        let [x, y] = minus(&placed.center.at, &side.center).map(|c| c.abs().lower);
        if &x * &x + &y * &y > &discs * &discs {
            return true;
        }
        let corners = placed.corners.get_or_init(|| solid.corners.iter().map(|c| self.moving(c)).collect());
        // As seen from the shape, however far from the origin that is.
        let seen = |p: &Point| rough(&minus(p, &placed.center.at));
        let here: Vec<[f64; 2]> = solid.ring.iter().map(|i| seen(&corners[*i].at)).collect();
        let there: Vec<[f64; 2]> = side.shape.points.iter().map(seen).collect();
        let Some([x, y]) = direction(&here, &there, roughly(&apart)) else { return false };
        let exact = |n: [f64; 2]| {
            n.map(|c| Interval::exactly(BigInt::from((c * (1_u64 << DIGITS) as f64) as i64) << (BITS - DIGITS)))
        };
        if self.separates(&exact([x, y]), corners, &side.shape.points, &apart) {
            return true;
        }
        // The same seen from the link: the side moves, towards the shape.
        let On::Link(link) = solid.on else { return false };
        let by = [0, 1].map(|k| k <= link && matches!(self.chain.motions[k], Motion::Turn(_)));
        let [sine, cosine] = Self::angle(by).map_or([0.0, 1.0], |which| rough(&self.turns[which]));
        let turned_back = [-(cosine * x + sine * y), -(cosine * y - sine * x)];
        let moving: Vec<Moving> = side.seen[link].iter().map(|p| self.moving(p)).collect();
        self.separates(&exact(turned_back), &moving, &solid.shape.points, &apart)
    }
}

/// Whether on pieces that follow one another each of the pairs of a shape and an edge keeps as far off as the shape is to; else where that
/// is not shown first.
///
/// # Errors
/// The stretch, the shape and the edge.
pub fn keep_off(
    chain: &Chain,
    pieces: &[Piece],
    (solids, edges): (&[&Solid], &[&Edge]),
    pairs: Vec<[usize; 2]>,
) -> Result<(), Open> {
    let mut stack = vec![(Stretch::Pieces(0, pieces.len()), pairs)];
    let mut parts = 0;
    while let Some((stretch, mut pairs)) = stack.pop() {
        parts += 1;
        let of = match &stretch {
            Stretch::Pieces(from, to) => &pieces[*from..*to],
            Stretch::Part(piece, _) => std::slice::from_ref(piece),
        };
        let posture = Posture::new(chain, Tube::around(of));
        let placed: Vec<OnceCell<Placed>> = solids.iter().map(|_| OnceCell::new()).collect();
        let sides: Vec<OnceCell<Cow<Side>>> = edges.iter().map(|_| OnceCell::new()).collect();
        let time = [&of[0].time[0], &of[of.len() - 1].time[1]];
        pairs.retain(|&[solid, edge]| {
            let placed = placed[solid].get_or_init(|| posture.placed(solids[solid]));
            !posture.keeps_off(placed, sides[edge].get_or_init(|| edges[edge].during(chain, time)))
        });
        let Some(&[solid, edge]) = pairs.first() else { continue };
        let (first, second) = match stretch {
            Stretch::Pieces(from, to) if to - from > 1 => {
                let middle = from + (to - from) / 2;
                (Stretch::Pieces(from, middle), Stretch::Pieces(middle, to))
            }
            Stretch::Part(piece, halvings) if halvings >= HALVINGS || parts > MOST_PARTS => {
                return Err(Open { knot: piece.knot, solid, edge });
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

// What follows only guesses: a direction that may separate. Whether it does is decided above.

/// The convex hull of points by their numbers, in order (Andrew 1979).
fn ring(points: &[[f64; 2]]) -> Vec<usize> {
    let turns = |a: usize, b: usize, c: usize| {
        let [p, q, r] = [points[a], points[b], points[c]];
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0
    };
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*a][0].total_cmp(&points[*b][0]).then(points[*a][1].total_cmp(&points[*b][1])));
    let mut ring: Vec<usize> = Vec::new();
    for back in [false, true] {
        let first = ring.len();
        for k in 0..order.len() {
            let next = order[if back { order.len() - 1 - k } else { k }];
            while ring.len() > first + 1 && !turns(ring[ring.len() - 2], ring[ring.len() - 1], next) {
                ring.pop();
            }
            ring.push(next);
        }
        ring.pop();
    }
    if ring.is_empty() { order } else { ring }
}

/// From the point of one shape that is nearest to the other, to that one; none unless they are farther apart than that.
fn direction(here: &[[f64; 2]], there: &[[f64; 2]], apart: f64) -> Option<[f64; 2]> {
    let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    // From a point to the nearest of a segment. Between its ends that is straight across it: of a way that is far shorter than the segment, computed as
    // the difference of two places, no digit would be right.
    let to_segment = |p: [f64; 2], a: [f64; 2], b: [f64; 2]| {
        let (along, to) = (minus(b, a), minus(a, p));
        let square = dot(along, along);
        let share = if square > 0.0 { -dot(to, along) / square } else { 0.0 };
        if 0.0 < share && share < 1.0 {
            let across = [-along[1], along[0]];
            return across.map(|c| c * (dot(to, across) / square));
        }
        let share = share.clamp(0.0, 1.0);
        [to[0] + share * along[0], to[1] + share * along[1]]
    };
    let mut nearest = ([0.0; 2], f64::INFINITY);
    let mut see = |way: [f64; 2]| {
        if dot(way, way) < nearest.1 {
            nearest = (way, dot(way, way));
        }
    };
    let sides = |ring: &[[f64; 2]]| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]).collect::<Vec<_>>();
    let (ours, theirs) = (sides(here), sides(there));
    for [a, _] in &ours {
        theirs.iter().for_each(|[c, d]| see(to_segment(*a, *c, *d)));
    }
    for [c, _] in &theirs {
        ours.iter().for_each(|[a, b]| see(to_segment(*c, *a, *b).map(|c| -c)));
    }
    let length = nearest.1.sqrt();
    (length > apart && length.is_finite()).then(|| nearest.0.map(|c| c / length))
}
