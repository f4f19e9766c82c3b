//! Motion of points that two joints carry.

use super::Posture;
use crate::arm::{Arm, Motion};
use crate::curve::Tube;
use crate::interval::{Interval, Point, sum};
use crate::obstacle::Obstacle;

/// A vector that turns and grows with the joints: `R(±(s1 q1 + s2 q2)) (at + direction q)`. `by` states which joints
/// turn it. `back` means that the sign is minus. `slide` is the joint whose value `q` moves it along `direction`.
#[derive(Clone)]
pub(super) struct Term {
    pub(super) by: [bool; 2],
    pub(super) back: bool,
    pub(super) at: Point,
    pub(super) slide: Option<(usize, Point)>,
}

/// The position of a point, as a sum of vectors.
pub(super) type Terms = Vec<Term>;

/// The motions that two joints give to their links.
#[derive(Clone)]
pub struct Chain {
    pub(super) motions: [Motion; 2],
    base: Point,
    offset: Point,
}

/// The frame to which a shape is attached.
#[derive(Clone)]
pub enum Attachment {
    /// A link. Coordinates are relative to the link's joint.
    Link(usize),
    /// A point of the second link. The shape follows the point but never turns.
    Level(Point),
}

fn negative(a: &Point) -> Point {
    [-&a[0], -&a[1]]
}

/// Adds a vector that does not turn to a sum of vectors. Merges it with an existing one if possible.
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
    /// Returns a chain whose two joints both turn left about a point.
    pub fn turning_about(point: &Point) -> Self {
        let offset = [0, 0].map(Interval::whole);
        Self { motions: [Motion::Turn(1), Motion::Turn(1)], base: point.clone(), offset }
    }

    /// Returns the position of a point that is fixed to a link, given its coordinates `a` relative to the link's joint.
    fn link_point(&self, link: usize, a: &Point) -> Terms {
        let mut terms = Terms::new();
        shifted(&mut terms, a);
        for joint in (0..=link).rev() {
            self.moved(&mut terms, joint, false);
            shifted(&mut terms, [&self.base, &self.offset][joint]);
        }
        terms
    }

    /// Returns the coordinates of a point of the plane relative to the link's joint: the inverse of [`Self::link_point`].
    pub(super) fn coordinates_in_link(&self, link: usize, p: &Point) -> Terms {
        let mut terms = Terms::new();
        shifted(&mut terms, p);
        for joint in 0..=link {
            shifted(&mut terms, &negative([&self.base, &self.offset][joint]));
            self.moved(&mut terms, joint, true);
        }
        terms
    }

    /// Applies the motion of a joint to a sum of vectors, or the inverse motion if `back`.
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

    /// Returns the sense in which positive values of a joint turn: 1 for left, -1 for right, and 0 for a prismatic joint.
    pub(super) fn sign(&self, joint: usize) -> Interval {
        Interval::whole(match self.motions[joint] {
            Motion::Turn(sign) => sign,
            Motion::Slide(_) => 0,
        })
    }

    /// Returns the position of a point that is attached to a link, or to a shape that never turns.
    pub(super) fn attached_point(&self, on: &Attachment, a: &Point) -> Terms {
        match on {
            Attachment::Link(link) => self.link_point(*link, a),
            Attachment::Level(point) => {
                let mut terms = self.link_point(1, point);
                shifted(&mut terms, a);
                terms
            }
        }
    }

    /// Returns the position of an attached point in a configuration.
    pub fn point_at(&self, on: &Attachment, a: &Point, values: &Point) -> Point {
        self.sum_at(&self.attached_point(on, a), values)
    }

    /// Converts an object from plane coordinates to the frame of the second link, which picks it up in this configuration.
    pub fn obstacle_in_second_link(&self, lying: &Obstacle, values: &Point) -> Obstacle {
        lying.clone().moved(self.coordinates_in_second_link(&lying.at, values), self.turn(1, &lying.turn, true, values))
    }

    /// Converts an attached object to the plane coordinates that it has in this configuration.
    pub fn attached_obstacle_in_plane(&self, on: &Attachment, hanging: &Obstacle, values: &Point) -> Obstacle {
        let turn = match on {
            Attachment::Level(_) => hanging.turn.clone(),
            Attachment::Link(link) => self.turn(*link, &hanging.turn, false, values),
        };
        hanging.clone().moved(self.point_at(on, &hanging.at, values), turn)
    }

    /// Returns the sine and cosine of an object's orientation after the turn of a link, or after the inverse turn if
    /// `back`.
    fn turn(&self, link: usize, [sine, cosine]: &[Interval; 2], back: bool, values: &Point) -> [Interval; 2] {
        let by = [0, 1].map(|joint| joint <= link && matches!(self.motions[joint], Motion::Turn(_)));
        let [x, y] = self.sum_at(&[Term { by, back, at: [cosine.clone(), sine.clone()], slide: None }], values);
        [y, x]
    }

    /// Returns the coordinates of a point of the plane relative to the second link's joint in a configuration.
    fn coordinates_in_second_link(&self, p: &Point, values: &Point) -> Point {
        self.sum_at(&self.coordinates_in_link(1, p), values)
    }

    pub(super) fn sum_at(&self, terms: &[Term], values: &Point) -> Point {
        Posture::new(self, Tube::at_configuration(values.clone())).moving(terms).at
    }
}
