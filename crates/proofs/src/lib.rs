//! Where proofs and bounds are found: slabs and boxes that tell whether there is a path, and lower bounds on how short one can
//! be. What it finds passes [`cplan_core::check`], which shares no code with it but the kernels of geometry and
//! [`cplan_core::check::Deviation`].
//!
//! [`slab_connectivity`] is asked first: in a slab of `q1`, contact angles with obstacles grown by the slab's motion
//! leave what is free all over it, those with shapes eroded by it name what is stuck all over it, and slabs are halved
//! where the connection is undecided. What slabs leave open (shapes without thickness) goes to the boxes
//! ([`connectivity()`]). Proofs of both are stuck boxes, paths of both a channel of free boxes: both pass the checks.
//!
//! [`least_length`] bounds the optimum from below. Slices at some dozens of values of `q1` say exactly what is closed
//! there; between two slices straight barriers are proven to be closed. A search in the manner of Polyanya, over all turns
//! at once, finds the shortest way around both, which no motion is shorter than. Slices are added where that way passes
//! what is closed, so along smooth boundaries what is left falls with the square of their spacing. [`short_motion`] is
//! the same search among obstacles grown by a hair.
//!
//! ```
//! use cplan_core::model::{Arm, MotionProblem, Obstacle, Scene, Workspace};
//! use cplan_proofs::{Connectivity, slab_connectivity};
//! use cplan_core::space::Configuration;
//!
//! // Beyond the elbow nothing gets past two posts that leave less room between them than the arm is thick.
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
mod tiles;

pub use channel::Channel;
pub use connectivity::{Connectivity, Exploration, Occupancy, connectivity, explore};
pub use evidence::{BoundEvidence, ClosedSegment};
pub use optimum::{Motions, Proposed, Refused, ShortMotion, bound_evidence, least_length, short_motion};
pub use slabs::{slab_boxes, slab_connectivity};
pub use slim::slimmed;
