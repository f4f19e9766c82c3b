//! The greatest distance of a recorded motion from a planned one.
//!
//! The distance of a place of the recorded motion is that to the nearest place of the planned motion, at whatever time:
//! a controller may begin later, or move more slowly. Chords replace the planned motion up to a small tolerance.
//! Between two places of the recorded motion, the distance changes by at most as much as the arm moves. This bounds the
//! distance in intervals, which are halved until the greatest distance is known.

use cplan_geometry::Point;
use cplan_handling::{Piece, Recording};
use cplan_interrupt::checkpoint;
use cplan_model::Arm;
use cplan_model::space::Configuration;
use cplan_motion::distance_to_leg;
use cplan_motion::recorded::Moment;
use std::cell::Cell;
use std::f64::consts::TAU;

/// Greatest deviation of the chords from the planned motion, radians or metres.
const CHORD_TOLERANCE: f64 = 1e-6;

/// Greatest number of chords per piece of the planned motion.
const MAX_CHORDS: f64 = 4096.0;

/// Relative accuracy of the greatest distance.
const RELATIVE_TOLERANCE: f64 = 1e-2;

/// Absolute accuracy of the greatest distance, radians or metres. The coarser of both accuracies applies.
const TOLERANCE: f64 = 1e-5;

/// Greatest number of halvings of a piece of the recorded motion.
const MAX_HALVINGS: u32 = 20;

/// Number of chords that share a bounding box.
const CHORDS_PER_BOX: usize = 32;

/// The place of a recorded motion that is farthest from a planned one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarthestPlace {
    /// Distance from the planned motion, radians or metres. The greatest distance exceeds it by at most 1 % or 1e-5,
    /// whichever is more.
    pub distance: f64,
    /// The place.
    pub moment: Moment,
}

/// Returns two places of a recorded motion: the one farthest from the planned motion, by Euclidean distance in joint
/// space, and the one where the tip is farthest from the path of the planned tip. Whole turns of continuous joints
/// between the two motions do not count.
pub fn farthest_from_plan(arm: &Arm, recording: &Recording, plan: &Recording) -> [FarthestPlace; 2] {
    let shift = turns_between(arm, recording.positions()[0], plan.positions()[0]);
    let pieces = recording.pieces();
    let (chords, of_tip) = chords(arm, plan);
    let [of_joints, of_tip] = [Chords::new(chords), Chords::new(of_tip)];
    let reach = tip_rates(arm, recording);
    let joints = |q: Configuration| of_joints.distance(q + shift);
    let tip = |q: Configuration| of_tip.distance(arm.tip_at(q));
    let norm = |moved: [f64; 2]| moved[0].hypot(moved[1]);
    let of_reach = |moved: [f64; 2]| moved[0] * reach[0] + moved[1] * reach[1];
    [farthest(&pieces, &joints, &norm), farthest(&pieces, &tip, &of_reach)]
}

/// Returns the whole turns of continuous joints from one configuration to another.
fn turns_between(arm: &Arm, from: Configuration, to: Configuration) -> Configuration {
    let topology = arm.topology();
    let turns = |k: usize| if topology.ranges[k].is_circle() { ((to[k] - from[k]) / TAU).round() * TAU } else { 0.0 };
    Configuration::new(turns(0), turns(1))
}

/// Returns bounds on the speed of the tip per unit of speed of each joint.
fn tip_rates(arm: &Arm, recording: &Recording) -> [f64; 2] {
    let [first, second] = arm.joints.each_ref().map(|joint| joint.joint_type.is_revolute());
    let pieces = recording.pieces();
    let slide = pieces.iter().flat_map(Piece::control).map(|q| q[1].abs()).fold(0.0, f64::max);
    let out = arm.offset.norm() + arm.tip.norm() + if second { 0.0 } else { slide };
    [if first { out } else { 1.0 }, if second { arm.tip.norm() } else { 1.0 }]
}

/// Returns the corners of two chains of chords: of the motion in joint space, and of the path of its tip.
fn chords(arm: &Arm, plan: &Recording) -> (Vec<Configuration>, Vec<Point>) {
    let reach = tip_rates(arm, plan);
    let mut corners = vec![plan.positions()[0]];
    for piece in plan.pieces() {
        let bend = piece.bend(0.0, 1.0);
        let control = piece.control();
        let speed = |k: usize| {
            let steps = control.windows(2).map(|pair| (pair[1][k] - pair[0][k]).abs());
            piece.degree() as f64 * steps.fold(0.0, f64::max)
        };
        // Bounds on the second derivatives of configuration and tip with respect to the share of the piece.
        let of_joints = bend[0].hypot(bend[1]);
        let turned = speed(0) + speed(1);
        let of_tip = reach[0] * bend[0] + reach[1] * bend[1] + (1.0 + reach[0]) * turned * turned;
        let count = (of_joints.max(of_tip) / (8.0 * CHORD_TOLERANCE)).sqrt().ceil().clamp(1.0, MAX_CHORDS) as u32;
        corners.extend((1..=count).map(|k| piece.at(f64::from(k) / f64::from(count))));
    }
    corners.dedup();
    let tips = corners.iter().map(|q| arm.tip_at(*q)).collect();
    (corners, tips)
}

/// Chords, in groups with bounding boxes.
struct Chords {
    corners: Vec<Point>,
    boxes: Vec<[Point; 2]>,
    /// The group that was nearest to the last point.
    last: Cell<usize>,
}

impl Chords {
    fn new(corners: Vec<Point>) -> Self {
        let last = corners.len() - 1;
        let bounds = |first: usize| {
            let own = &corners[first..=(first + CHORDS_PER_BOX).min(last)];
            own.iter().fold([own[0]; 2], |[low, high], corner| [low.inf(corner), high.sup(corner)])
        };
        let boxes = (0..last.max(1)).step_by(CHORDS_PER_BOX).map(bounds).collect();
        Self { corners, boxes, last: Cell::new(0) }
    }

    /// Returns the distance of a point from the nearest chord.
    fn distance(&self, at: Point) -> f64 {
        let mut least = self.of_group(at, self.last.get());
        for (group, [low, high]) in self.boxes.iter().enumerate() {
            let outside = (low - at).sup(&(at - high)).sup(&Point::zeros()).norm();
            if outside < least {
                let own = self.of_group(at, group);
                if own < least {
                    least = own;
                    self.last.set(group);
                }
            }
        }
        least
    }

    fn of_group(&self, at: Point, group: usize) -> f64 {
        let first = group * CHORDS_PER_BOX;
        let own = &self.corners[first..=(first + CHORDS_PER_BOX).min(self.corners.len() - 1)];
        let to_first = (at - own[0]).norm();
        own.windows(2).map(|chord| distance_to_leg(at, chord[0], chord[1])).fold(to_first, f64::min)
    }
}

/// Returns the place with the greatest distance. `most` converts bounds on the motion of both joints into a bound on
/// the change of the distance.
fn farthest(
    pieces: &[Piece],
    distance: &dyn Fn(Configuration) -> f64,
    most: &dyn Fn([f64; 2]) -> f64,
) -> FarthestPlace {
    let place = |piece: usize, share: f64| {
        let moment = Moment::new(piece, &pieces[piece], share);
        FarthestPlace { distance: distance(moment.at), moment }
    };
    let mut best = place(0, 0.0);
    let ends: Vec<FarthestPlace> = (0..pieces.len()).map(|piece| place(piece, 1.0)).collect();
    for end in &ends {
        if end.distance > best.distance {
            best = *end;
        }
    }
    for (piece, own) in pieces.iter().enumerate() {
        checkpoint();
        // Bound on the motion of each joint over the whole piece.
        let motion = [0, 1].map(|k| {
            let steps = own.control().windows(2).map(|pair| (pair[1][k] - pair[0][k]).abs());
            own.degree() as f64 * steps.fold(0.0, f64::max)
        });
        let mut stack = vec![([0.0, 1.0], MAX_HALVINGS)];
        while let Some(([from, to], halvings)) = stack.pop() {
            let middle = (from + to) / 2.0;
            let here = place(piece, middle);
            if here.distance > best.distance {
                best = here;
            }
            let bound = here.distance + most(motion.map(|moved| moved * (to - from) / 2.0));
            if halvings > 0 && bound > best.distance + (RELATIVE_TOLERANCE * best.distance).max(TOLERANCE) {
                stack.extend([([middle, to], halvings - 1), ([from, middle], halvings - 1)]);
            }
        }
    }
    best
}
