//! When the arm may not be somewhere: the times at which what moves is in the way, exact in time as slices are in joint space.

use cplan_core::check::{Deviation, Posture};
use cplan_core::model::{Leg, Mover, Pair, Scene};
use cplan_geometry::{
    Convex, Interval, Point, Pose, Vector, cross, merge_in_place, separation, separation_at, sliding,
};
use cplan_interrupt::checkpoint;
use std::cell::OnceCell;

/// What is looked at is larger than it is by this share of the lengths involved: far more than rounding, far less than anybody sees.
const ROOM: f64 = 1e-9;

/// Obstacles that turn are followed in steps in which they move by no more than this share of the lengths involved, or than a quarter of what the arm's
/// part does: contact may seem to begin so much earlier and to end so much later.
const STEP: f64 = 1e-3;

/// A single posture.
pub const STILL: Deviation = Deviation::Box([0.0; 2]);

/// What moves, prepared for the question when.
pub struct Movers<'a> {
    scene: &'a Scene,
    clearance: f64,
    /// Of each mover, of each of its pieces, of each of its legs.
    stretches: Vec<Stretch>,
    /// All that can meet.
    meetings: Vec<Meeting>,
}

/// A part of the arm and a piece of a mover on a leg of its course, within some time.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    pair: Pair,
    /// The times of interest.
    within: Interval,
    stretch: usize,
}

impl Meeting {
    /// The same within other times.
    #[must_use]
    pub fn in_time(self, within: Interval) -> Self {
        Self { within, ..self }
    }
}

/// A part of the arm at a posture, and how far it deviates from there: all pairs with it share that.
pub struct Around<'a> {
    pair: Pair,
    /// In its own frame, ...
    part: &'a Convex,
    /// ... where that is, ...
    pose: Pose,
    /// ... and itself there, once it is needed, with its size.
    placed: OnceCell<(Convex, f64)>,
    /// A disc that holds it.
    disc: (Point, f64),
    /// Farthest that a point of it moves, metres.
    moves: f64,
}

impl<'a> Around<'a> {
    /// That of a meeting's part; what is known if it is of the same.
    pub fn of<'k>(
        known: &'k mut Option<Self>,
        movers: &Movers<'a>,
        posture: &Posture,
        deviation: Deviation,
        Meeting { pair, .. }: Meeting,
    ) -> &'k Self {
        if known.as_ref().is_none_or(|known| (known.pair.link, known.pair.part) != (pair.link, pair.part)) {
            let (disc, moves) = (posture.place(pair, deviation), posture.farthest_motion(pair, deviation));
            let (part, pose) = (movers.scene.part(pair), posture.pose(pair.link));
            *known = Some(Self { pair, part, pose, placed: OnceCell::new(), disc, moves });
        }
        known.as_ref().expect("just made")
    }

    /// Farthest that a point of the part moves, metres.
    pub fn moves(&self) -> f64 {
        self.moves
    }

    fn placed(&self) -> &(Convex, f64) {
        self.placed.get_or_init(|| {
            let placed = self.part.at(&self.pose);
            let reach = placed.reach_from(Point::origin());
            (placed, reach)
        })
    }
}

/// A piece of a mover along a leg of its course.
struct Stretch {
    leg: Leg,
    /// In its own frame, with a disc around it.
    own: Convex,
    own_disc: (Point, f64),
    /// Where the leg begins, ...
    piece: Convex,
    /// ... its size and a disc around it there.
    reach: f64,
    disc: (Point, f64),
    /// Of what slides: its direction and speed.
    slide: Option<(Vector, f64)>,
    /// Farthest that a point of it moves in a second, metres.
    speed: f64,
}

impl Stretch {
    fn new(piece: &Convex, leg: Leg) -> Self {
        let placed = piece.at(&leg.pose(leg.from));
        let speed = leg.velocity.norm();
        Self {
            leg,
            own: piece.clone(),
            own_disc: disc(piece),
            reach: placed.reach_from(Point::origin()),
            disc: disc(&placed),
            piece: placed,
            slide: (leg.turn == 0.0 && speed > 0.0).then(|| (leg.velocity / speed, speed)),
            speed: leg.speed(piece.reach_from(Point::origin())),
        }
    }

    /// Whether it stays farther from a disc than a distance within some time.
    fn is_beyond(&self, (point, radius): (Point, f64), distance: f64, [from, to]: Interval) -> bool {
        let far = |between: f64, own: f64| distance + radius + own + ROOM * (distance + radius + own + between);
        match self.slide {
            Some((direction, speed)) => {
                let between = self.disc.0 - point;
                let far = far(between.norm(), self.disc.1);
                let along = -direction.dot(&between);
                let [first, last] = [from, to].map(|time| (time - self.leg.from) * speed);
                cross(direction, between).abs() > far || along < first - far || along > last + far
            }
            None if self.leg.turn == 0.0 => {
                let between = (self.disc.0 - point).norm();
                between > far(between, self.disc.1)
            }
            None => {
                let between = (self.leg.pose(f64::midpoint(from, to)) * self.own_disc.0 - point).norm();
                between > far(between, self.own_disc.1) + self.speed * (to - from) / 2.0
            }
        }
    }

    /// How far it is from a part of the arm at a time, if that is no more than this.
    fn distance(&self, around: &Around, time: f64, most: f64) -> Option<f64> {
        let pose = self.leg.pose(time);
        let ((at, extent), (center, radius)) = (around.disc, self.own_disc);
        let between = (pose * center - at).norm();
        let is_far = between - extent - radius > most + ROOM * (between + extent + radius);
        let distance = (!is_far).then(|| separation_at(&self.own, &pose, &around.placed().0, |_, here| here.distance));
        distance.filter(|distance| *distance <= most)
    }

    /// Times within some at which a part is, or may be, no farther than this from what turns: a superset, in steps in which it moves so far.
    fn turning(&self, around: &Around, within: Interval, [grow, step]: [f64; 2], out: &mut Vec<Interval>) {
        let mut open = vec![within];
        while let Some([from, to]) = open.pop() {
            checkpoint();
            let (middle, drifts) = (f64::midpoint(from, to), self.speed * (to - from) / 2.0);
            let Some(distance) = self.distance(around, middle, grow + drifts) else { continue };
            // Near all the time, or too short a time to tell.
            if distance + drifts <= grow || drifts <= step {
                out.push([from, to]);
            } else {
                open.extend([[middle, to], [from, middle]]);
            }
        }
    }

    /// Times within some at which both overlap by more than this: a subset, whose ends are known to so many seconds.
    fn deep(&self, around: &Around, within: Interval, [deeper, shortest]: [f64; 2], out: &mut Vec<Interval>) {
        let mut open = vec![within];
        while let Some([from, to]) = open.pop() {
            checkpoint();
            let (middle, drifts) = (f64::midpoint(from, to), self.speed * (to - from) / 2.0);
            let Some(distance) = self.distance(around, middle, drifts - deeper) else { continue };
            if distance + drifts < -deeper {
                out.push([from, to]);
            } else if to - from > shortest {
                open.extend([[middle, to], [from, middle]]);
            }
        }
    }

    /// The same where it slides. How deep it is is a concave function of time, as the distance to a convex set is a convex one of the place: where the
    /// chord from an end, at which it is as deep as both are round, to a place where it is deeper, is deep enough, so is the function.
    fn deep_in_passing(
        &self,
        around: &Around,
        ends: Interval,
        round: f64,
        [deeper, shortest]: [f64; 2],
    ) -> Option<Interval> {
        let depth = |time: f64| self.distance(around, time, f64::INFINITY).map_or(0.0, |distance| -distance);
        let middle = f64::midpoint(ends[0], ends[1]);
        let most = depth(middle);
        (most > deeper).then(|| {
            ends.map(|end| {
                let (mut at, mut here) = (middle, most);
                loop {
                    let next = end + (at - end) * ((deeper - round) / (here - round)).min(1.0);
                    if (next - at).abs() < shortest {
                        return next;
                    }
                    (at, here) = (next, depth(next).max(deeper));
                }
            })
        })
    }
}

impl<'a> Movers<'a> {
    /// Those of a scene, from which this distance is to be kept, metres.
    #[must_use]
    pub fn new(scene: &'a Scene, clearance: f64) -> Self {
        let mut stretches = Vec::new();
        // Where those of a piece begin.
        let mut first = Vec::new();
        for (mover, Mover { course, .. }) in scene.workspace().movers.iter().enumerate() {
            let of = |piece: &Convex| {
                let begins = stretches.len();
                stretches.extend(course.legs().iter().map(|leg| Stretch::new(piece, *leg)));
                begins
            };
            first.push(scene.pieces_of_mover(mover).map(of).collect::<Vec<_>>());
        }
        let standing = scene.workspace().obstacles.len();
        let mut meetings = Vec::new();
        for &pair in scene.moving_pairs() {
            let mover = pair.obstacle - standing;
            let legs = scene.workspace().movers[mover].course.legs();
            meetings.extend(legs.iter().enumerate().map(|(leg, Leg { from, to, .. })| Meeting {
                pair,
                within: [*from, *to],
                stretch: first[mover][pair.piece] + leg,
            }));
        }
        Self { scene, clearance, stretches, meetings }
    }

    /// The scene that they are in.
    #[must_use]
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// All that can meet, at all times.
    pub(crate) fn meetings(&self) -> &[Meeting] {
        &self.meetings
    }

    /// The times of a meeting at which the part is, or may be, nearer than the clearance while it deviates as it is known to:
    /// a superset, in no order. Whether there are any.
    ///
    /// A shape that slides past another one, grown by how far the arm's part moves, meets it for one interval of time, in closed form
    /// ([`sliding`]); where it turns, time is halved.
    pub(crate) fn near(&self, around: &Around, meeting: Meeting, out: &mut Vec<Interval>) -> bool {
        let (stretch, before) = (&self.stretches[meeting.stretch], out.len());
        let Stretch { leg, piece, slide, .. } = stretch;
        let [earliest, latest] = meeting.within;
        if stretch.is_beyond(around.disc, self.clearance, meeting.within) {
            return false;
        }
        let (part, reach) = around.placed();
        let scale = reach + stretch.reach;
        let grow = around.moves + self.clearance + ROOM * scale;
        match slide {
            // Seen from the obstacle the part slides backwards.
            Some((direction, speed)) => {
                let met = sliding(part, -direction, piece, grow);
                let met = met.map(|[first, last]| [leg.from + first / speed - ROOM, leg.from + last / speed + ROOM]);
                out.extend(met.and_then(|met| common(met, meeting.within)));
            }
            None if leg.turn == 0.0 => {
                let is_near = separation(part, piece).distance <= grow;
                out.extend(is_near.then_some([earliest, latest]));
            }
            None => stretch.turning(around, meeting.within, [grow, (around.moves / 4.0).max(STEP * scale)], out),
        }
        out.len() > before
    }

    /// Times of a meeting at which both overlap, grown by the clearance, however the part deviates as it is known to: a subset, in no order, whose
    /// ends are known to so many seconds.
    ///
    /// The part is to be deeper than it moves.
    pub(crate) fn met(&self, around: &Around, meeting: Meeting, shortest: f64, out: &mut Vec<Interval>) {
        let stretch = &self.stretches[meeting.stretch];
        let Stretch { leg, piece, slide, .. } = stretch;
        if stretch.is_beyond(around.disc, self.clearance, meeting.within) {
            return;
        }
        let (part, reach) = around.placed();
        let deeper = around.moves - self.clearance + ROOM * (reach + stretch.reach);
        match slide {
            Some((direction, speed)) => {
                let round = part.radius() + piece.radius();
                let Some(met) = sliding(part, -direction, piece, -deeper.min(round)) else { return };
                let met = met.map(|gone| leg.from + gone / speed);
                if deeper <= round {
                    out.extend(common(met, meeting.within));
                } else if let Some(met) = stretch.deep_in_passing(around, met, round, [deeper, shortest]) {
                    out.extend(common(met, meeting.within));
                } else if let Some(within) = common(met, meeting.within) {
                    // Not in the middle, at least.
                    stretch.deep(around, within, [deeper, shortest], out);
                }
            }
            None if leg.turn == 0.0 => {
                out.extend((-separation(part, piece).distance > deeper).then_some(meeting.within));
            }
            None => stretch.deep(around, meeting.within, [deeper, shortest], out),
        }
    }

    /// The times at which nothing that moves is nearer to the arm at a posture than the clearance; in order.
    pub fn safe_intervals(&self, posture: &Posture) -> Vec<Interval> {
        let (mut near, mut known) = (Vec::new(), None);
        for &meeting in &self.meetings {
            self.near(Around::of(&mut known, self, posture, STILL, meeting), meeting, &mut near);
        }
        merge_in_place(&mut near);
        complement(&near)
    }

    /// Whether nothing that moves is ever nearer to the arm at a posture than the clearance.
    pub(crate) fn is_calm(&self, posture: &Posture) -> bool {
        let (mut near, mut known) = (Vec::new(), None);
        let mut meetings = self.meetings.iter();
        meetings.all(|&meeting| !self.near(Around::of(&mut known, self, posture, STILL, meeting), meeting, &mut near))
    }
}

/// What two intervals have in common.
fn common([a, b]: Interval, [from, to]: Interval) -> Option<Interval> {
    let both = [a.max(from), b.min(to)];
    (both[0] <= both[1]).then_some(both)
}

/// A disc around a shape.
fn disc(shape: &Convex) -> (Point, f64) {
    let [low, high] = shape.bounds();
    (nalgebra::center(&low, &high), (high - low).norm() / 2.0)
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
