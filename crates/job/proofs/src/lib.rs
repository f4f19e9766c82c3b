//! Search for proofs and bounds: slabs and boxes decide whether a path exists, and lower bounds limit how short a path can be.
//! The results pass [`cplan_judge`], which shares with this crate only the kernels of geometry and its bounds on distances
//! ([`cplan_judge::Posture`], [`cplan_judge::Deviation`]).
//!
//! [`slab_connectivity`] is tried first. Within a slab of `q1`, contact angles with obstacles grown by the slab's motion give the
//! values of joint 2 that are free all over the slab; contact angles with shapes eroded by that motion give the values in
//! collision all over it. Slabs are halved where the connection is undecided. Questions that slabs leave open, such as those with
//! shapes without thickness, go to boxes ([`connectivity()`]). Slabs and boxes both prove infeasibility by collision boxes, and
//! give a path as a channel of free boxes.
//!
//! [`least_length`] bounds the optimum from below. On slices at some dozens of values of `q1`, the walls are known exactly: the
//! values of joint 2 in collision. Between slices, straight barriers are proven to be in collision. A search similar to Polyanya,
//! over all turns at once, finds the shortest path around walls and barriers. No motion is shorter. Slices are added where the
//! path crosses a collision region, so along smooth boundaries the gap falls with the square of their spacing. [`short_motion`]
//! is the same search among slightly grown obstacles.
//!
//! ```
//! use cplan_model::{Arm, MotionProblem, Obstacle, Scene, Workspace};
//! use cplan_proofs::{Connectivity, slab_connectivity};
//! use cplan_model::space::Configuration;
//!
//! // Two posts leave less space between them than the arm is thick, so nothing beyond the elbow can pass.
//! let posts = [Obstacle::circle("left", [0.55, 0.35], 0.2)?, Obstacle::circle("right", [0.55, -0.35], 0.2)?];
//! let scene = Scene::new(Arm::rr([1.0, 0.8], 0.06)?, Workspace::new(posts))?;
//! let problem = MotionProblem::new(scene, Configuration::new(0.0, 0.5), Configuration::new(2.0, 0.5))?;
//! let answer = slab_connectivity(problem.scene(), problem.start(), problem.goals(), 0.0, 10_000, 10_000);
//! assert!(matches!(answer, Connectivity::Disconnected(_)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bands;
mod boxes;
mod chain;
mod channel;
mod connectivity;
mod evidence;
mod optimum;
mod separating;
mod slab;
mod slabs;
mod slim;
#[cfg(test)]
mod tests;
mod tiles;

pub use channel::Channel;
pub use connectivity::{Connectivity, Exploration, Occupancy, connectivity, explore};
pub use evidence::{BoundEvidence, ClosedSegment};
pub use optimum::{
    BoundRound, MotionQuery, NearShortestMotion, ProposedPath, RefusalReason, bound_evidence, bound_rounds,
    least_length, short_motion,
};
pub use slabs::{slab_boxes, slab_connectivity};
pub use slim::slimmed;
