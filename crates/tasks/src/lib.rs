//! From a task to a sequence of certified motions: which IK solution to take at each target, how to grip, and in which
//! order, are chosen together, for the least total time.
//!
//! Each motion has a scene of its own: objects lie where the steps before have left them, and what is carried is part of
//! the arm. The object that a motion goes to, and the one just let go of, are no obstacles to link 2, which has to reach
//! into them; they are to link 1 and to payloads.
//!
//! [`plan`] searches a layered graph, whose nodes say what is done, where the arm and the objects are, and what is
//! carried, by A* over times. Motions are planned only when they matter: until then an edge counts as the time that the
//! joints would take if nothing were in the way, which no motion undercuts. Such times to the end, over all IK solutions (and
//! orders, by a table of subsets), are the heuristic; at the start they bound the whole task from below.
//!
//! # Scenes
//!
//! - A rigid payload is a union of parts of link 2.
//! - A level one only translates with the tip, so the part is the tip, a point, and what it can meet are the Minkowski
//!   differences of the obstacles' pieces and the payload's. So planners, C-obstacles, certificates and proofs need no
//!   third link.
//! - What a payload rests on it meets with each corner of its outline moved inwards by what it may press in
//!   (`drawn_in`); to keep no clearance there, supports are farther away by it in
//!   every distance (`Convex::receding`).
//! - Motions are shared (`legs`) among worlds that differ only in objects which the heights keep from being hit.
//!
//! # Orders
//!
//! Where a group has more than ten pairs, or the search takes too long, an order is settled on (`order`); the bound stays
//! one over all orders. A local search (`tour`) proposes one by times with nothing in the way; `walk` goes through it
//! with questions that cost a tenth of a motion (straight? barred, by slabs?). The first pair that cannot be done makes a
//! `condition`: what was hit, or barred the way, has to be moved before, or after. The ends of all motions make such
//! conditions beforehand (`ends`). If no order meets all, one is built up pair by pair. The file's own order is tried,
//! too; then motions teach the tour how long they really take, and it proposes again.
//!
//! # What moves
//!
//! Where something moves, or an object that is picked on its way, the search is another one (`among_movers`), over what is done next and when.
//!
//! # Verdicts
//!
//! If the search runs dry and every motion was refused with a proof, the task is infeasible; where a choice was left out
//! (a turn of the wrist on the way, orders not tried), it is unknown. That no order can be done is proven by a `part` of
//! the group: one pair or two that cannot be done though all other objects are out of the way.

mod among_movers;
mod answer;
mod failed_step;
mod legs;
mod least_time;
mod order;
mod heuristic;
mod part;
mod plan;
mod replay;
mod ik_solutions;
mod search;
mod sequence;
mod state;
mod stroke;

pub use answer::{Event, Leg, TaskAnswer, TaskMotion};
pub use failed_step::{FailedStep, RefusedIkSolution};
pub use least_time::rest_to_rest;
pub use plan::plan;
pub use replay::{MotionReplay, TaskReplay};
pub use sequence::Sequence;
pub use stroke::ToolStroke;
