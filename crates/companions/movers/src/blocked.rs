//! Times at which moving obstacles block the arm at a configuration. The times are exact up to the tolerances below.

use cplan_geometry::{
    Convex, Interval, Point, Pose, Vector, cross, merge_in_place, separation, separation_at, sliding,
};
use cplan_handling::{TimedScene, TrajectoryLeg};
use cplan_interrupt::checkpoint;
use cplan_judge::{Deviation, Posture};
use cplan_model::space::Configuration;
use cplan_model::{Pair, Scene};
use std::cell::OnceCell;

/// Relative enlargement of shapes, as a fraction of the distances and sizes involved. It covers rounding errors.
const SHAPE_ENLARGEMENT: f64 = 1e-9;

/// Longest motion of a turning obstacle in one time step, as a fraction of the distances and sizes involved. A quarter
/// of the deviation of the arm's part is also allowed, if that is more. A contact may seem to begin one step too early,
/// and to end one step too late.
const TURN_STEP: f64 = 1e-3;

/// The set of deviations of a single configuration: only zero.
pub const NO_DEVIATION: Deviation = Deviation::Box([0.0; 2]);

/// The moving obstacles of a scene, prepared for the computation of contact times.
pub struct MovingObstacles<'a> {
    scene: &'a Scene,
    clearance: f64,
    /// One entry for each moving obstacle, each of its pieces, and each leg of its trajectory.
    stretches: Vec<Stretch>,
    /// All pairs of a part of the arm and a piece of an obstacle that can meet, at all times.
    pub(crate) meetings: Vec<Meeting>,
}

/// A part of the arm, and a piece of a moving obstacle on one leg of its trajectory, within an interval of time.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    pair: Pair,
    within: Interval,
    stretch: usize,
}

impl Meeting {
    /// Returns the same meeting within another interval of time.
    #[must_use]
    pub fn during(self, within: Interval) -> Self {
        Self { within, ..self }
    }
}

/// A part of the arm at a posture, with a bound on its deviation from there. Shared by all pairs that contain the part.
pub struct PartDeviation<'a> {
    pair: Pair,
    /// The part in its own frame.
    part: &'a Convex,
    /// The pose of the part's frame.
    pose: Pose,
    /// The part at its pose, with its size. Computed when first needed.
    placed: OnceCell<(Convex, f64)>,
    /// A disc that contains the part: centre and radius.
    disc: (Point, f64),
    /// Upper bound on the deviation of a point of the part, in metres.
    pub moves: f64,
}

impl<'a> PartDeviation<'a> {
    /// Returns the entry for the part of a meeting. Returns `known` if it belongs to the same part.
    pub fn of<'k>(
        known: &'k mut Option<Self>,
        movers: &MovingObstacles<'a>,
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

    fn placed(&self) -> &(Convex, f64) {
        self.placed.get_or_init(|| {
            let placed = self.part.at(&self.pose);
            let reach = placed.reach_from(Point::zeros());
            (placed, reach)
        })
    }
}

/// A piece of a moving obstacle along one leg of its trajectory.
struct Stretch {
    leg: TrajectoryLeg,
    /// The piece in its own frame, and a disc around it.
    own: Convex,
    own_disc: (Point, f64),
    /// The piece at the beginning of the leg.
    piece: Convex,
    /// Largest distance of a point of the piece from the origin, and the disc around it, at the beginning of the leg.
    reach: f64,
    disc: (Point, f64),
    /// Direction and speed of the piece. `None` if it turns.
    slide: Option<(Vector, f64)>,
    /// Largest speed of a point of the piece, in metres per second.
    speed: f64,
}

impl Stretch {
    fn new(piece: &Convex, leg: TrajectoryLeg) -> Self {
        let placed = piece.at(&leg.pose(leg.from));
        let speed = leg.velocity.norm();
        Self {
            leg,
            own: piece.clone(),
            own_disc: disc(piece),
            reach: placed.reach_from(Point::zeros()),
            disc: disc(&placed),
            piece: placed,
            slide: (leg.turn == 0.0 && speed > 0.0).then(|| (leg.velocity / speed, speed)),
            speed: leg.speed(piece.reach_from(Point::zeros())),
        }
    }

    /// Returns true if the piece keeps more than `distance` from a disc during the whole interval of time.
    fn is_beyond(&self, (point, radius): (Point, f64), distance: f64, [from, to]: Interval) -> bool {
        let far =
            |between: f64, own: f64| distance + radius + own + SHAPE_ENLARGEMENT * (distance + radius + own + between);
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
                let between = (self.leg.pose(f64::midpoint(from, to)).point(self.own_disc.0) - point).norm();
                between > far(between, self.own_disc.1) + self.speed * (to - from) / 2.0
            }
        }
    }

    /// Returns the distance of the piece from a part of the arm at a time. `None` if it exceeds `most`, metres.
    fn distance(&self, around: &PartDeviation, time: f64, most: f64) -> Option<f64> {
        let pose = self.leg.pose(time);
        let ((at, extent), (center, radius)) = (around.disc, self.own_disc);
        let between = (pose.point(center) - at).norm();
        let is_far = between - extent - radius > most + SHAPE_ENLARGEMENT * (between + extent + radius);
        let distance = (!is_far).then(|| separation_at(&self.own, &pose, &around.placed().0, |_, here| here.distance));
        distance.filter(|distance| *distance <= most)
    }

    /// Finds the times at which the distance of a turning piece from a part is at most `grow`. The result may include
    /// other times. The piece moves by at most `step` in each time step.
    fn turning(&self, around: &PartDeviation, within: Interval, [grow, step]: [f64; 2], out: &mut Vec<Interval>) {
        // The piece is near during the whole interval, or the interval is too short to decide.
        let decide = |most: f64, drifts: f64, _| (most <= grow || drifts <= step).then_some(true);
        self.divide(around, within, grow, decide, out);
    }

    /// Finds times at which the piece overlaps a part by more than `deeper`. The ends of the intervals are accurate to
    /// `shortest` seconds, so short overlaps may be missing.
    fn overlap_times(
        &self,
        around: &PartDeviation,
        within: Interval,
        [deeper, shortest]: [f64; 2],
        out: &mut Vec<Interval>,
    ) {
        let decide = |most: f64, _, lasts: f64| Some(most < -deeper).filter(|is_deep| *is_deep || lasts <= shortest);
        self.divide(around, within, -deeper, decide, out);
    }

    /// Divides an interval of time, and collects the subintervals that `decide` accepts. The arguments of `decide` are
    /// an upper bound on the distance during the subinterval, the motion of the piece from the middle to an end, and
    /// the duration. `Some(true)` accepts the subinterval, `Some(false)` rejects it, and `None` divides it further.
    /// Subintervals during which the distance exceeds `near` are skipped.
    fn divide(
        &self,
        around: &PartDeviation,
        within: Interval,
        near: f64,
        decide: impl Fn(f64, f64, f64) -> Option<bool>,
        out: &mut Vec<Interval>,
    ) {
        let mut open = vec![within];
        while let Some([from, to]) = open.pop() {
            checkpoint();
            let (middle, drifts) = (f64::midpoint(from, to), self.speed * (to - from) / 2.0);
            let Some(distance) = self.distance(around, middle, near + drifts) else { continue };
            match decide(distance + drifts, drifts, to - from) {
                Some(is_met) => out.extend(is_met.then_some([from, to])),
                None => open.extend([[middle, to], [from, middle]]),
            }
        }
    }

    /// Finds the same times as [`Stretch::overlap_times`], for a piece that slides without turning. The distance between two
    /// convex sets is a convex function of their offset, so the depth is a concave function of time. At both `ends`, the depth
    /// is `round`, the sum of both radii. So the depth is at least that of a chord from an end to a time with a greater depth.
    fn deep_in_passing(
        &self,
        around: &PartDeviation,
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

impl<'a> MovingObstacles<'a> {
    /// Prepares the moving obstacles of a scene. `clearance` is the distance to keep from them, in metres.
    pub fn new(timed: TimedScene<'a>, clearance: f64) -> Self {
        let TimedScene { scene, trajectories } = timed;
        let mut stretches = Vec::new();
        // Index of the first stretch of each piece.
        let mut first = Vec::new();
        for (mover, trajectory) in (0..scene.loose_obstacles().len()).zip(trajectories) {
            let of = |piece: &Convex| {
                let begins = stretches.len();
                stretches.extend(trajectory.legs().iter().map(|leg| Stretch::new(piece, *leg)));
                begins
            };
            first.push(scene.pieces_of_loose(mover).map(of).collect::<Vec<_>>());
        }
        let mut meetings = Vec::new();
        for &pair in timed.moving_pairs() {
            let Some((mover, trajectory)) = scene.loose_index(pair).zip(timed.trajectory(pair)) else { continue };
            let legs = trajectory.legs();
            meetings.extend(legs.iter().enumerate().map(|(leg, TrajectoryLeg { from, to, .. })| Meeting {
                pair,
                within: [*from, *to],
                stretch: first[mover][pair.piece] + leg,
            }));
        }
        Self { scene, clearance, stretches, meetings }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Returns the times at which each moving obstacle is nearer to the arm at `q` than the clearance, in order and
    /// disjoint. They are exact up to the tolerances of this module.
    pub fn blocked_times(&self, q: Configuration) -> Vec<Vec<Interval>> {
        let (posture, mut known) = (Posture::new(self.scene, q), None);
        let mut times = vec![Vec::new(); self.scene.loose_obstacles().len()];
        for &meeting in &self.meetings {
            let Some(mover) = self.scene.loose_index(meeting.pair) else { continue };
            let around = PartDeviation::of(&mut known, self, &posture, NO_DEVIATION, meeting);
            self.near(around, meeting, &mut times[mover]);
        }
        times.iter_mut().for_each(merge_in_place);
        times
    }

    /// Finds the times of a meeting at which some deviation of the part may be nearer to the obstacle than the
    /// clearance. The result includes all such times, possibly others, and is unordered. Returns true if it added any.
    ///
    /// A shape that slides past another one meets it during a single interval of time, which has a closed form
    /// ([`sliding`]); the other shape is grown by the deviation of the arm's part. If the shape turns, the time is
    /// halved repeatedly.
    pub(crate) fn near(&self, around: &PartDeviation, meeting: Meeting, out: &mut Vec<Interval>) -> bool {
        let (stretch, before) = (&self.stretches[meeting.stretch], out.len());
        let Stretch { leg, piece, slide, .. } = stretch;
        let [earliest, latest] = meeting.within;
        if stretch.is_beyond(around.disc, self.clearance, meeting.within) {
            return false;
        }
        let (part, reach) = around.placed();
        let scale = reach + stretch.reach;
        let grow = around.moves + self.clearance + SHAPE_ENLARGEMENT * scale;
        match slide {
            // Seen from the obstacle, the part slides backwards.
            Some((direction, speed)) => {
                let met = sliding(part, -direction, piece, grow);
                let met = met.map(|[first, last]| {
                    [leg.from + first / speed - SHAPE_ENLARGEMENT, leg.from + last / speed + SHAPE_ENLARGEMENT]
                });
                out.extend(met.and_then(|met| common(met, meeting.within)));
            }
            None if leg.turn == 0.0 => {
                let is_near = separation(part, piece).distance <= grow;
                out.extend(is_near.then_some([earliest, latest]));
            }
            None => stretch.turning(around, meeting.within, [grow, (around.moves / 4.0).max(TURN_STEP * scale)], out),
        }
        out.len() > before
    }

    /// Finds times of a meeting at which the part, grown by the clearance, overlaps the obstacle at every deviation.
    /// The result may omit some such times, and is unordered. Its ends are accurate to `shortest` seconds.
    ///
    /// The overlap must be deeper than the deviation of the part.
    pub(crate) fn collision_times(
        &self,
        around: &PartDeviation,
        meeting: Meeting,
        shortest: f64,
        out: &mut Vec<Interval>,
    ) {
        let stretch = &self.stretches[meeting.stretch];
        let Stretch { leg, piece, slide, .. } = stretch;
        if stretch.is_beyond(around.disc, self.clearance, meeting.within) {
            return;
        }
        let (part, reach) = around.placed();
        let deeper = around.moves - self.clearance + SHAPE_ENLARGEMENT * (reach + stretch.reach);
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
                    // In the middle of the interval, the overlap is not deep enough.
                    stretch.overlap_times(around, within, [deeper, shortest], out);
                }
            }
            None if leg.turn == 0.0 => {
                out.extend((-separation(part, piece).distance > deeper).then_some(meeting.within));
            }
            None => stretch.overlap_times(around, meeting.within, [deeper, shortest], out),
        }
    }

    /// Returns the times, in order, at which no moving obstacle is nearer than the clearance to the arm at a posture.
    pub fn safe_intervals(&self, posture: &Posture) -> Vec<Interval> {
        let (mut near, mut known) = (Vec::new(), None);
        for &meeting in &self.meetings {
            self.near(PartDeviation::of(&mut known, self, posture, NO_DEVIATION, meeting), meeting, &mut near);
        }
        merge_in_place(&mut near);
        complement(&near)
    }

    /// Returns true if no moving obstacle is ever nearer than the clearance to the arm at a posture.
    pub(crate) fn is_always_safe(&self, posture: &Posture) -> bool {
        let (mut near, mut known) = (Vec::new(), None);
        let mut meetings = self.meetings.iter();
        meetings.all(|&meeting| {
            !self.near(PartDeviation::of(&mut known, self, posture, NO_DEVIATION, meeting), meeting, &mut near)
        })
    }
}

/// Returns the intersection of two intervals.
fn common([a, b]: Interval, [from, to]: Interval) -> Option<Interval> {
    let both = [a.max(from), b.min(to)];
    (both[0] <= both[1]).then_some(both)
}

fn disc(shape: &Convex) -> (Point, f64) {
    let [low, high] = shape.bounds();
    ((low + high) * 0.5, (high - low).norm() / 2.0)
}

/// Returns the times after 0 that are not inside the given intervals. The ends of the given intervals count as outside.
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
