//! When the arm may not be somewhere: the times at which what moves is in the way, exact in time as slices are in joint space.

use crate::check::{Deviation, Posture};
use crate::geometry::{Convex, Interval, Point, Vector, cross, merge_in_place, separation, sliding};
use crate::interrupt::checkpoint;
use crate::model::{Leg, Mover, Pair, Scene};

/// What is looked at is larger than it is by this share of the lengths involved: far more than rounding, far less than anybody sees.
const ROOM: f64 = 1e-9;

/// Obstacles that turn are followed in steps in which they move by no more than this share of the lengths involved, or than the arm's part does: contact
/// may seem to begin so much earlier and to end so much later.
const STEP: f64 = 1e-3;

/// What moves, prepared for the question when.
pub struct Movers<'a> {
    scene: &'a Scene,
    clearance: f64,
    /// Of each mover, of each of its pieces, its legs.
    legs: Vec<Vec<Vec<Stretch>>>,
}

/// A part of the arm at a posture, and how far it deviates from there: all pairs with it share that.
pub struct Around {
    part: (usize, usize),
    /// A disc that holds it.
    disc: (Point, f64),
    /// Farthest that a point of it moves, metres.
    moves: f64,
}

impl Around {
    /// That of a pair's part; what is known if it is of the same.
    pub fn of<'k>(known: &'k mut Option<Self>, posture: &Posture, deviation: Deviation, pair: Pair) -> &'k Self {
        let part = (pair.link, pair.part);
        if known.as_ref().is_none_or(|known| known.part != part) {
            let (disc, moves) = (posture.place(pair, deviation), posture.farthest_motion(pair, deviation));
            *known = Some(Self { part, disc, moves });
        }
        known.as_ref().expect("just made")
    }

    /// Farthest that a point of the part moves, metres.
    pub fn moves(&self) -> f64 {
        self.moves
    }
}

/// A piece of a mover along a leg of its course.
struct Stretch {
    leg: Leg,
    /// Where the leg begins, ...
    piece: Convex,
    /// ... and a disc around it there.
    disc: (Point, f64),
    /// Of what slides: its direction and speed.
    slide: Option<(Vector, f64)>,
    /// Farthest that a point of it moves in a second, metres.
    speed: f64,
}

impl<'a> Movers<'a> {
    /// Those of a scene, from which this distance is to be kept, metres.
    #[must_use]
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let of = |mover: &Mover, piece: &Convex| {
            let stretch = |leg: &Leg| {
                let placed = piece.at(&leg.pose(leg.from));
                let speed = leg.velocity.norm();
                Stretch {
                    leg: *leg,
                    disc: disc(&placed),
                    piece: placed,
                    slide: (leg.turn == 0.0 && speed > 0.0).then(|| (leg.velocity / speed, speed)),
                    speed: leg.speed(piece.reach_from(Point::origin())),
                }
            };
            mover.course.legs().iter().map(stretch).collect::<Vec<_>>()
        };
        let movers = scene.workspace().movers.iter();
        let legs = movers.map(|mover| mover.obstacle.pieces.iter().map(|piece| of(mover, piece)).collect()).collect();
        Self { scene, clearance, legs }
    }

    /// The scene that they are in.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    fn legs(&self, pair: Pair) -> &[Stretch] {
        &self.legs[pair.obstacle - self.scene.workspace().obstacles.len()][pair.piece]
    }

    /// The times at which a pair is, or may be, nearer than the clearance while the configuration deviates from the posture's as far as the part is known to be `around`:
    /// a superset, in no order. Whether there are any.
    ///
    /// A shape that slides past another one, grown by how far the arm's part moves, meets it for one interval of time, in closed form
    /// ([`sliding`]); where it turns, time is halved.
    pub fn near_times(&self, posture: &Posture, around: &Around, pair: Pair, out: &mut Vec<Interval>) -> bool {
        let before = out.len();
        let Around { disc: (center, around), moves, .. } = *around;
        let around = around + self.clearance;
        // The part where it is, once it is needed.
        let mut placed = None;
        for Stretch { leg, piece, disc: (at, radius), slide, speed } in self.legs(pair) {
            let between = *at - center;
            let far = around + radius + ROOM * (around + radius + between.norm());
            let is_far = match slide {
                Some((direction, speed)) => {
                    let gone = (leg.to - leg.from) * speed;
                    let along = -direction.dot(&between);
                    cross(*direction, between).abs() > far || along < -far || along > gone + far
                }
                None if leg.turn == 0.0 => between.norm() > far,
                None => between.norm() > far + speed * (leg.to - leg.from),
            };
            if is_far {
                continue;
            }
            let (part, grow, step) = placed.get_or_insert_with(|| {
                let part = self.scene.part(pair).at(&posture.pose(pair.link));
                let scale = part.reach_from(Point::origin()) + piece.reach_from(Point::origin());
                (part, moves + self.clearance + ROOM * scale, moves.max(STEP * scale))
            });
            match slide {
                // Seen from the obstacle the part slides backwards.
                Some((direction, speed)) => {
                    if let Some([first, last]) = sliding(part, -direction, piece, *grow) {
                        let met = [leg.from + first / speed - ROOM, leg.from + last / speed + ROOM];
                        let [first, last] = [met[0].max(leg.from), met[1].min(leg.to)];
                        if first <= last {
                            out.push([first, last]);
                        }
                    }
                }
                None if leg.turn == 0.0 => {
                    if separation(part, piece).distance <= *grow {
                        out.push([leg.from, leg.to]);
                    }
                }
                None => turning(part, self.scene.piece(pair), leg, [*grow, *speed, *step], out),
            }
        }
        out.len() > before
    }

    /// The times at which nothing that moves is nearer to the arm at a posture than the clearance; in order.
    pub fn safe_intervals(&self, posture: &Posture) -> Vec<Interval> {
        let (mut near, mut known) = (Vec::new(), None);
        for &pair in self.scene.moving_pairs() {
            let around = Around::of(&mut known, posture, Deviation::Box([0.0; 2]), pair);
            self.near_times(posture, around, pair, &mut near);
        }
        merge_in_place(&mut near);
        complement(&near)
    }
}

/// A disc around a shape.
fn disc(shape: &Convex) -> (Point, f64) {
    let [low, high] = shape.bounds();
    (nalgebra::center(&low, &high), (high - low).norm() / 2.0)
}

fn turning(part: &Convex, piece: &Convex, leg: &Leg, [grow, speed, step]: [f64; 3], out: &mut Vec<Interval>) {
    let mut open = vec![[leg.from, leg.to]];
    while let Some([from, to]) = open.pop() {
        checkpoint();
        let (middle, half) = (f64::midpoint(from, to), (to - from) / 2.0);
        let distance = separation(part, &piece.at(&leg.pose(middle))).distance - grow;
        let drifts = speed * half;
        if distance > drifts {
            continue;
        }
        // Near all the time, or too short a time to tell.
        if distance + drifts <= 0.0 || drifts <= step {
            out.push([from, to]);
        } else {
            open.extend([[middle, to], [from, middle]]);
        }
    }
}

/// What is left of the times from 0 on; ends of the intervals given count as theirs.
pub fn complement(intervals: &[Interval]) -> Vec<Interval> {
    let (mut left, mut from) = (Vec::new(), 0.0);
    for &[lower, upper] in intervals {
        if from < lower {
            left.push([from, lower]);
        }
        from = f64::max(from, upper);
    }
    if from < f64::INFINITY {
        left.push([from, f64::INFINITY]);
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_the_times() {
        let inf = f64::INFINITY;
        assert_eq!(complement(&[]), [[0.0, inf]]);
        assert_eq!(complement(&[[-1.0, 2.0], [3.0, 4.0]]), [[2.0, 3.0], [4.0, inf]]);
        assert_eq!(complement(&[[1.0, inf]]), [[0.0, 1.0]]);
        assert_eq!(complement(&[[0.0, inf]]), Vec::<Interval>::new());
    }
}
