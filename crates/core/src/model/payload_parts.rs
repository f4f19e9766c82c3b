//! What is carried, as parts of link 2: whole, and for its supports smaller by what it may press into them.

use super::pairing::{Kind, Reading, obstacles};
use super::{Arm, Carrier, Grip, Part, Payload, Workspace};
use cplan_geometry::{Convex, Point, drawn_in};
use nalgebra::{Isometry2, Translation2};
use std::ops::Range;

/// Which share of what a payload may press into its supports its corners are moved by: a little less, so that a checker that moves them farther
/// has room.
const AT_MOST: f64 = 1.0 - 1e-3;

/// What a payload's part can meet.
#[derive(Clone, Copy, PartialEq)]
pub enum Meets {
    /// Everything but the payload's supports.
    Others,
    /// The supports: the part is smaller by what it may press into them.
    Supports,
}

/// Which pieces of each obstacle, and of each mover after them, something can meet.
pub(super) type Meetable = Vec<Range<usize>>;

impl Payload {
    /// It as parts of link 2, each with what it can meet, numbered by the pieces that they are of; what is made of the obstacles' pieces for it is added to
    /// `differences`.
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
                    let about_tip = Isometry2::rotation(angle) * Translation2::from(-point.coords);
                    (Convex::point(arm.tip), Some(shape.at(&about_tip)))
                }
            };
            let mut meetable = Vec::new();
            for (number, (kind, obstacle)) in obstacles(arm, workspace).enumerate() {
                let own = obstacle.pieces.len();
                // How something level lies to what joint 1 carries is not known: it is covered all round, which is no evidence.
                let is_folding = matches!(kind, Kind::Own(own) if own.carrier == Carrier::FirstJoint);
                let is_turned = level.is_some() && is_folding;
                let meets = self.meets(part_meets, number) && !(is_turned && reading.is_evidence());
                let nearer = part_meets.nearer(workspace.clearance);
                if !meets || (level.is_none() && nearer == 0.0) {
                    meetable.push(0..if meets { own } else { 0 });
                    continue;
                }
                // What moves has its pieces in its own frame, which does not turn where something level is carried.
                let seen = |level: &Convex| match kind {
                    Kind::Moving(mover) => level.at(&Isometry2::rotation(-mover.course.stops()[0].angle)),
                    Kind::Standing | Kind::Own(_) => level.clone(),
                };
                let all_round =
                    |level: &Convex| Convex::trusted(vec![Point::origin()], level.reach_from(Point::origin()));
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

    /// Its pieces, and smaller ones for its supports, in its own frame.
    pub fn parts(&self, arm: &Arm) -> impl Iterator<Item = (Convex, Meets)> {
        self.parts_read(arm, &Reading::ALL).into_iter().map(|(_, shape, kind)| (shape, kind))
    }

    /// The same, after the number of the piece that each is of.
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

    /// Whether its parts of that kind can meet an obstacle.
    pub fn meets(&self, kind: Meets, obstacle: usize) -> bool {
        match kind {
            Meets::Others => !self.supports.contains(&obstacle),
            Meets::Supports => self.supports.contains(&obstacle),
        }
    }
}

impl Meets {
    /// How much nearer than the clearance the part may come to what it meets.
    pub fn nearer(self, clearance: f64) -> f64 {
        match self {
            Meets::Others => 0.0,
            Meets::Supports => clearance,
        }
    }
}
