//! The evidence that a cell is infeasible, as in answers, and its check.
//!
//! A [`Proof`] is a claim, which any file can make. [`Proof::check`] decides whether it is true for a cell. The check shares with the
//! search for proofs only the grid of the joint ranges. It computes depths from the Minkowski difference, displacements from
//! chords, and the separation by a flood fill of its own.

mod check;
mod grid;
mod separation;

pub(crate) use grid::{Grid, Index, MAX_CELLS};

use crate::{Cell, Refutation};
use cplan_judge::ProofBox;
use cplan_model::Pair;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A convex part of a link. Both numbers count from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkPart {
    /// The link, 0 or 1.
    pub link: usize,
    /// Number of the part in the outline of the link.
    pub part: usize,
}

/// A pair of goals at which the arms collide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalContact {
    /// The goal of each arm: its joint values, radians or metres.
    pub goals: [[f64; 2]; 2],
    /// The colliding part of each arm.
    pub parts: [LinkPart; 2],
}

/// Two shapes that collide in all configurations of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Contact {
    /// A part of an arm, and an obstacle. All numbers count from 0.
    Obstacle {
        /// The arm, 0 or 1.
        arm: usize,
        /// Link of the part, as in [`Pair::link`].
        link: usize,
        /// Number of the part in the outline of the link.
        part: usize,
        /// Number of the obstacle.
        obstacle: usize,
        /// Number of the convex piece of the obstacle.
        piece: usize,
    },
    /// A part of each arm.
    Arms([LinkPart; 2]),
}

impl Contact {
    /// Returns the contact of an arm with an obstacle.
    pub(crate) fn with_obstacle(arm: usize, Pair { link, part, obstacle, piece }: Pair) -> Self {
        Self::Obstacle { arm, link, part, obstacle, piece }
    }
}

/// A box of the grid in which two shapes collide. Files have a row of nine numbers: the contact, and for each joint
/// the first cell and the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(from = "[usize; 9]", into = "[usize; 9]")]
pub struct ContactBox {
    /// Index of the contact in [`BoxProof::contacts`].
    pub contact: usize,
    /// For each joint, the first cell of the box, and the one behind its last cell.
    pub cells: [[usize; 2]; 4],
}

impl From<[usize; 9]> for ContactBox {
    fn from([contact, a, b, c, d, e, f, g, h]: [usize; 9]) -> Self {
        Self { contact, cells: [[a, b], [c, d], [e, f], [g, h]] }
    }
}

impl From<ContactBox> for [usize; 9] {
    fn from(ContactBox { contact, cells: [[a, b], [c, d], [e, f], [g, h]] }: ContactBox) -> Self {
        [contact, a, b, c, d, e, f, g, h]
    }
}

/// Boxes of collisions in the space of all four joints, which separate the starts from all goals. The joints are those of the
/// first arm, then those of the second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxProof {
    /// Number of boxes that the search examined. It proves nothing.
    pub examined: usize,
    /// Least and greatest value of each joint, radians or metres. A joint that turns without end has those of one turn.
    pub ranges: [[f64; 2]; 4],
    /// Number of equal cells into which the grid divides each range.
    pub cells: [usize; 4],
    /// The contacts of the boxes.
    pub contacts: Vec<Contact>,
    /// The boxes.
    pub boxes: Vec<ContactBox>,
}

/// The claim that a cell is infeasible, with its evidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Proof {
    /// One arm alone cannot reach its goal.
    Alone {
        /// Name of the arm.
        arm: String,
        /// Boxes of collisions, in the space of its two joints.
        boxes: Vec<ProofBox>,
    },
    /// The arms collide at their starts.
    Starts {
        /// The contact in words.
        contact: String,
        /// The colliding part of each arm.
        parts: [LinkPart; 2],
    },
    /// The arms collide at every pair of their goals.
    Goals {
        /// The contact at the first pair in words.
        contact: String,
        /// All pairs of goals.
        pairs: Vec<GoalContact>,
    },
    /// Boxes in the space of all four joints.
    Boxes(BoxProof),
}

/// The reason why a proof does not hold.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProofError {
    /// The arm does not exist.
    #[error("the cell has no arm \"{0}\"")]
    UnknownArm(String),
    /// The proof for an arm alone does not hold.
    #[error("{arm}: {error}")]
    Alone {
        /// Name of the arm.
        arm: String,
        /// The reason.
        error: cplan_judge::ProofError,
    },
    /// The parts do not exist, or cannot meet.
    #[error("{0}: one of the two shapes does not exist, or they cannot meet")]
    UnknownContact(String),
    /// The shapes may be apart.
    #[error("{place}: the two shapes overlap by {depth:e} m, but can move by {motion:e} m")]
    NotColliding {
        /// The box, or the starts, or the goals.
        place: String,
        /// Penetration depth in the middle of the box, clearance included, metres.
        depth: f64,
        /// Greatest displacement of both parts together from their places in the middle of the box, metres.
        motion: f64,
    },
    /// An arm may be free of the obstacle somewhere in the box of this number, counted from 0.
    #[error("box {0}: the arm is not proven to collide with the obstacle in the whole box")]
    NotBlocked(usize),
    /// A pair of goals is missing.
    #[error("the proof has no contact for the goals ({:.6}, {:.6}) and ({:.6}, {:.6})", .0[0][0], .0[0][1], .0[1][0], .0[1][1])]
    MissingGoals([[f64; 2]; 2]),
    /// A goal leaves a joint free, so that there are more pairs of goals than a proof can list.
    #[error("the cell has more pairs of goals than the proof can list")]
    FreeJoint,
    /// The grid does not cover the joint ranges, or has no or too many cells.
    #[error(
        "the grid does not cover the ranges of all four joints of the cell, or its number of cells is not from 1 to {MAX_CELLS}"
    )]
    Grid,
    /// The box of this number, counted from 0, is empty, extends beyond the grid or has no contact.
    #[error("box {0} is empty, extends beyond the grid, or names a contact that is not in the list")]
    InvalidBox(usize),
    /// The boxes do not separate the starts from the goals.
    #[error("the boxes do not separate the starts from all goals")]
    NotSeparated,
}

impl Proof {
    /// Returns the claim of a refutation. `None` if it is about steps of an arm.
    pub fn of(refutation: &Refutation, cell: &Cell) -> Option<Self> {
        match refutation {
            Refutation::Alone { arm, proof } => Some(Self::Alone {
                arm: cell.arms[*arm].name.clone(),
                boxes: proof.collision_boxes().iter().map(ProofBox::from).collect(),
            }),
            Refutation::Step { .. } => None,
            Refutation::Starts { contact, parts } => Some(Self::Starts { contact: contact.clone(), parts: (*parts)? }),
            Refutation::Goals { contact, pairs } => {
                Some(Self::Goals { contact: contact.clone(), pairs: pairs.clone() })
            }
            Refutation::Boxes(proof) => Some(Self::Boxes(proof.clone())),
        }
    }
}
