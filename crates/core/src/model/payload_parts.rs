//! The payload as parts of link 2: the whole shape, and for its supports a shape that is smaller by the penetration
//! allowance.

use super::pairing::{Kind, Reading, obstacles};
use super::{Arm, Carrier, Grip, Part, Payload, Workspace};
use cplan_geometry::{Convex, Point, Pose, drawn_in};
use std::ops::Range;

/// Share of the penetration allowance by which corners are moved: a little less than 1, so that a checker that moves
/// them farther has room.
const AT_MOST: f64 = 1.0 - 1e-3;

/// The obstacles that a payload's part can meet.
#[derive(Clone, Copy, PartialEq)]
pub enum Meets {
    /// Everything except the payload's supports.
    Others,
    /// The supports: the part is smaller by the penetration allowance.
    Supports,
}

/// The ranges of pieces that a part can meet, for each obstacle and then for each mover.
pub(super) type Meetable = Vec<Range<usize>>;

impl Payload {
    /// Returns the payload as parts of link 2, each with the pieces that it can meet. Parts are numbered by their
    /// pieces. Shapes derived from the obstacles' pieces are added to `differences`.
    pub(super) fn on_link(
        &self,
        arm: &Arm,
        workspace: &Workspace,
        reading: &Reading,
        differences: &mut [Vec<Convex>],
    ) -> Vec<(Part, Meetable)> {
        let mut parts = Vec::new();
        for (piece, shape, part_meets) in self.parts_read(arm, reading) {
            let (on_link, level) = match self.grip {
                Grip::Rigid(in_link) => (shape.at(&in_link), None),
                Grip::Level { angle, point } => {
                    let about_tip = Pose::rotation(angle).shifted_in_frame(-point);
                    (Convex::point(arm.tip), Some(shape.at(&about_tip)))
                }
            };
            let mut meetable = Vec::new();
            for (number, (kind, obstacle)) in obstacles(arm, workspace).enumerate() {
                let own = obstacle.pieces.len();
                // The angle between a level payload and obstacles that joint 1 carries is unknown. So the payload is
                // covered by a disc, which is no evidence.
                let is_folding = matches!(kind, Kind::Own(own) if own.carrier == Carrier::FirstJoint);
                let is_turned = level.is_some() && is_folding;
                let meets = self.meets(part_meets, number) && !(is_turned && reading.is_evidence());
                let nearer = part_meets.nearer(workspace.clearance);
                if !meets || (level.is_none() && nearer == 0.0) {
                    meetable.push(0..if meets { own } else { 0 });
                    continue;
                }
                // A moving obstacle has its pieces in its own frame, which does not turn while something level is
                // carried.
                let seen = |level: &Convex| match kind {
                    Kind::Moving(mover) => level.at(&Pose::rotation(-mover.course.stops()[0].angle)),
                    Kind::Standing | Kind::Own(_) => level.clone(),
                };
                let all_round =
                    |level: &Convex| Convex::trusted(vec![Point::zeros()], level.reach_from(Point::zeros()));
                let level = level.as_ref().map(|level| if is_turned { all_round(level) } else { seen(level) });
                let made = &mut differences[number];
                let first = own + made.len();
                made.extend(obstacle.pieces.iter().map(|piece| match &level {
                    Some(level) => piece.receding(nearer).minkowski_difference(level),
                    None => piece.receding(nearer),
                }));
                meetable.push(first..own + made.len());
            }
            let (heights, body) = (self.heights, self.object.clone());
            parts
                .push((Part { shape: on_link, inner: None, number: piece, is_visual: false, heights, body }, meetable));
        }
        parts
    }

    /// Returns its pieces, and smaller ones for its supports, in its own frame.
    pub fn parts(&self, arm: &Arm) -> impl Iterator<Item = (Convex, Meets)> {
        self.parts_read(arm, &Reading::ALL).into_iter().map(|(_, shape, kind)| (shape, kind))
    }

    /// Returns the same parts, each after the number of its piece.
    fn parts_read(&self, arm: &Arm, reading: &Reading) -> Vec<(usize, Convex, Meets)> {
        let mut parts: Vec<_> =
            self.pieces.iter().enumerate().map(|(number, piece)| (number, piece.clone(), Meets::Others)).collect();
        if !self.supports.is_empty() {
            let left = drawn_in(&self.pieces, AT_MOST * Self::penetration_allowance(arm)).into_iter();
            let of_piece = |(number, left): (usize, Vec<Convex>)| {
                left.into_iter().map(move |shape| (number, shape, Meets::Supports))
            };
            parts.extend(left.enumerate().flat_map(of_piece));
        }
        parts.retain(|(number, ..)| !reading.takes_for_nothing(&self.pieces[*number]));
        parts
    }

    /// Returns true if its parts of that kind can meet an obstacle.
    pub fn meets(&self, kind: Meets, obstacle: usize) -> bool {
        match kind {
            Meets::Others => !self.supports.contains(&obstacle),
            Meets::Supports => self.supports.contains(&obstacle),
        }
    }
}

impl Meets {
    /// Returns the distance by which the part may come nearer than the clearance.
    pub fn nearer(self, clearance: f64) -> f64 {
        match self {
            Meets::Others => 0.0,
            Meets::Supports => clearance,
        }
    }
}
