//! Proofs that there is no path: boxes of colliding configurations that separate the start from all goals.
//!
//! A [`Disconnection`] is a claim, which any caller can make. A [`CheckedProof`] is a true claim, which only
//! [`Disconnection::checked`] can make. The check shares no code with the search for claims. It computes depths from
//! the Minkowski difference, and displacements from chords. A sweep over the domain outside the boxes decides whether
//! these separate start and goals.

mod json;
mod separation;

pub use json::{ProofBox, ProofFormatError, read_proof};

use super::cell::Cell;
use cplan_geometry::{Convex, Vector, penetration_depth};
use cplan_model::checkpoint;
use cplan_model::space::{Configuration, GoalSet, Topology};
use cplan_model::{Arm, JointType, Pair, Scene};
use separation::not_separated;
use serde::{Serialize, Serializer};
use std::sync::Arc;
use thiserror::Error;

/// Margin by which a depth must exceed a displacement, as a fraction of the lengths in the comparison. It is far
/// greater than the rounding of both values.
const ROUNDING: f64 = 1e-12;

/// A box of configurations. In all of them, the same pair of shapes is too close.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionBox {
    /// The box.
    pub cell: Cell,
    /// The two shapes.
    pub pair: Pair,
}

impl CollisionBox {
    /// Returns true if the pair is nearer than `clearance` in the whole box, with room for rounding.
    pub fn holds(&self, scene: &Scene, clearance: f64) -> bool {
        is_collision(&scene.inner(), 0, self, clearance).is_ok()
    }
}

/// The claim that no motion leads from the start to any goal, because collision boxes separate them. The boxes are
/// its evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Disconnection {
    stuck: Vec<CollisionBox>,
}

/// A proof that no motion leads from the start to any goal. Only [`Disconnection::checked`] makes one.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedProof {
    stuck: Arc<[CollisionBox]>,
}

impl CheckedProof {
    /// Returns the boxes that separate the start from all goals.
    pub fn collision_boxes(&self) -> &[CollisionBox] {
        &self.stuck
    }

    /// Returns the proven statement in words.
    pub fn describe(&self) -> String {
        let count = self.stuck.len();
        let boxes = if count == 1 { "box" } else { "boxes" };
        format!("proven: colliding configurations separate start and goal ({count} {boxes})")
    }
}

impl Serialize for CheckedProof {
    /// Writes the proof as a list of [`ProofBox`].
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.stuck.iter().map(ProofBox::from))
    }
}

/// The reason why a claim proves nothing.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProofError {
    /// The box names shapes that do not exist, or cannot meet.
    #[error("collision box {0}: one of the two shapes does not exist, or they cannot meet")]
    UnknownPair(usize),
    /// The box is empty, or extends beyond the domain.
    #[error("collision box {0} is empty or extends beyond the configuration space")]
    NotInDomain(usize),
    /// The shapes may be apart somewhere in the box.
    #[error(
        "collision box {index}: the shapes overlap by {depth:e} m in the middle of the box, but can move by {motion:e} m within the box"
    )]
    NotColliding {
        /// Index of the box, from 0.
        index: usize,
        /// Penetration depth in the middle, clearance included, metres.
        depth: f64,
        /// Greatest displacement of the part's points from their positions in the middle of the box, metres.
        motion: f64,
    },
    /// The boxes do not separate the start from this piece of the goals.
    #[error("the collision boxes do not separate the start from goal {0}")]
    NotSeparated(usize),
}

impl Disconnection {
    /// Creates the claim that these boxes separate the start from all goals.
    pub fn new(stuck: Vec<CollisionBox>) -> Self {
        Self { stuck }
    }

    /// Returns the boxes of the claim.
    pub fn collision_boxes(&self) -> &[CollisionBox] {
        &self.stuck
    }

    /// Returns the same claim for a scene that numbers its shapes differently. `pair` translates each pair.
    pub fn of_pairs(mut self, pair: impl Fn(Pair) -> Pair) -> Self {
        self.stuck.iter_mut().for_each(|stuck| stuck.pair = pair(stuck.pair));
        self
    }

    /// Checks the claim. In each box, its pair must be nearer than `clearance` or touch. Together, the boxes must separate the
    /// start from all goals. `O(n log n)` for `n` boxes, times the number of boxes at one value of joint 1.
    ///
    /// # Errors
    /// The first [`ProofError`] found.
    pub fn checked(
        self,
        scene: &Scene,
        start: Configuration,
        goals: &GoalSet,
        clearance: f64,
    ) -> Result<CheckedProof, ProofError> {
        let (scene, topology) = (&*scene.inner(), scene.arm().topology());
        for (index, stuck) in self.stuck.iter().enumerate() {
            is_in_space(scene, &topology, index, stuck)?;
        }
        // Test the separation first, because that is faster than the test of overlaps.
        if let Some(goal) = not_separated(&topology, &self.stuck, start, goals) {
            return Err(ProofError::NotSeparated(goal));
        }
        for (index, stuck) in self.stuck.iter().enumerate() {
            is_collision(scene, index, stuck, clearance)?;
            checkpoint();
        }
        Ok(CheckedProof { stuck: self.stuck.into() })
    }
}

/// Checks that the box is part of the domain, and that its shapes can meet.
fn is_in_space(scene: &Scene, topology: &Topology, index: usize, stuck: &CollisionBox) -> Result<(), ProofError> {
    let cell = &stuck.cell;
    for k in 0..2 {
        let (lower, upper) = topology.ranges[k].domain();
        if !(lower <= cell.lower[k] && cell.lower[k] < cell.upper[k] && cell.upper[k] <= upper) {
            return Err(ProofError::NotInDomain(index));
        }
    }
    scene.pairs().binary_search(&stuck.pair).map(|_| ()).map_err(|_| ProofError::UnknownPair(index))
}

/// Checks that the shapes of the box are nearer than `clearance` in the whole box.
fn is_collision(scene: &Scene, index: usize, stuck: &CollisionBox, clearance: f64) -> Result<(), ProofError> {
    let cell = &stuck.cell;
    let middle = Configuration::from_fn(|k, _| (cell.lower[k] + cell.upper[k]) / 2.0);
    // The middle is rounded, so use the greater one of the distances to both ends.
    let half = [0, 1].map(|k| (cell.upper[k] - middle[k]).max(middle[k] - cell.lower[k]));
    let part = scene.part(stuck.pair).at(&scene.arm().pose(stuck.pair.link, middle));
    let piece = scene.piece(stuck.pair).grown(clearance);
    let depth = penetration_depth(&part, &piece);
    let motion = farthest_displacement(scene.arm(), stuck.pair.link, scene.part(stuck.pair), middle, half);
    let scale = part.reach_from(scene.arm().base) + piece.reach_from(scene.arm().base) + scene.arm().base.norm();
    if depth > motion + ROUNDING * scale { Ok(()) } else { Err(ProofError::NotColliding { index, depth, motion }) }
}

/// Returns an upper bound on the displacement of the corners of a part, metres, while each joint moves by at most `half`
/// from `q`. `link` is that of [`Pair::link`]. A turn by `t` about a point at distance `r` moves a corner by the chord
/// `2 r sin(t / 2)`.
pub fn farthest_displacement(arm: &Arm, link: usize, part: &Convex, q: Configuration, half: [f64; 2]) -> f64 {
    let chord = |angle: f64| 2.0 * (angle.min(std::f64::consts::PI) / 2.0).sin();
    let of_corner = |a: Vector| match (link, arm.joints[0].joint_type, arm.joints[1].joint_type) {
        (0, JointType::Revolute { .. }, _) => a.norm() * chord(half[0]),
        (0, JointType::Prismatic { .. }, _) => half[0],
        (2, _, JointType::Revolute { .. }) => a.norm() * chord(half[1]),
        (2, _, JointType::Prismatic { .. }) => half[1],
        (_, JointType::Revolute { .. }, JointType::Revolute { .. }) => {
            arm.offset.norm() * chord(half[0]) + a.norm() * chord(half[0] + half[1])
        }
        (_, JointType::Revolute { .. }, JointType::Prismatic { direction }) => {
            let at = |slide: f64| (arm.offset + direction * (q[1] + slide) + a).norm();
            // Move joint 2 first, and then turn joint 1. Distance is convex, so it is greatest at an end of joint 2's range.
            half[1] + at(half[1]).max(at(-half[1])) * chord(half[0])
        }
        (_, JointType::Prismatic { .. }, JointType::Revolute { .. }) => half[0] + a.norm() * chord(half[1]),
        (_, JointType::Prismatic { .. }, JointType::Prismatic { .. }) => half[0] + half[1],
    };
    part.core().iter().map(|&p| of_corner(p)).fold(0.0, f64::max)
}
