//! How two joints move what they carry.

use super::Posture;
use crate::arm::{Arm, Motion};
use crate::curve::Tube;
use crate::interval::{Interval, Point, sum};
use crate::obstacle::Obstacle;

/// A vector that turns with the joints: `R(±(s1 q1 + s2 q2)) (at + slide q)`, of whose angles those count that are named.
#[derive(Clone)]
pub(super) struct Term {
    pub(super) by: [bool; 2],
    pub(super) back: bool,
    pub(super) at: Point,
    pub(super) slide: Option<(usize, Point)>,
}

/// A point by the vectors that add up to it.
pub(super) type Terms = Vec<Term>;

/// How two joints move what they carry.
#[derive(Clone)]
pub struct Chain {
    pub(super) motions: [Motion; 2],
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

impl From<&Arm> for Chain {
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
    pub(super) fn seen(&self, link: usize, p: &Point) -> Terms {
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
    pub(super) fn sign(&self, joint: usize) -> Interval {
        Interval::whole(match self.motions[joint] {
            Motion::Turn(sign) => sign,
            Motion::Slide(_) => 0,
        })
    }

    /// Where a point is of what hangs on something.
    pub(super) fn hanging(&self, on: &On, a: &Point) -> Terms {
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

    pub(super) fn still(&self, terms: &[Term], values: &Point) -> Point {
        Posture::new(self, Tube::still(values.clone())).moving(terms).at
    }
}
