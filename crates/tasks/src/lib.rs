//! Plans tasks as sequences of certified motions. The IK solution at each target, the grip and the order are chosen
//! together, for the least total time.
//!
//! Each motion has its own scene: objects lie where earlier steps have left them, and the payload is part of the arm.
//! Link 2 may touch the object that a motion leads to, and the one just released, because the gripper must reach into
//! them. For link 1 and for payloads, both are obstacles.
//!
//! [`plan`] searches a layered graph by A* over times. A node states the steps done, the poses of arm and
//! objects, and the payload. Motions are planned only when they matter. Until then, an edge counts as the
//! time that the joints would take without obstacles, which is a lower bound for every motion. The sum of these times
//! to the end, over all IK solutions and orders (by a table of subsets), is the heuristic. At the start it is a lower
//! bound for the whole task.
//!
//! # Scenes
//!
//! - A rigid payload is a union of parts of link 2.
//! - A level payload only translates with the tip. So its part is the tip, a point, and its obstacles are the Minkowski
//!   differences of the obstacles' pieces and the payload's pieces. Planners, C-obstacles, certificates and proofs
//!   therefore need no third link.
//! - Against its supports, each corner of a payload's outline is moved inwards by the allowed penetration (`inset_union`).
//!   No clearance is required there, so supports count as farther away by it in every distance (`Convex::receding`).
//! - Motions are shared (`legs`) among worlds that differ only in objects which cannot be hit because of their heights.
//!
//! # Orders
//!
//! If a group has more than ten pairs, or the search takes too long, one order is chosen (`order`). The bound still
//! covers all orders.
//!
//! - A local search (`tour`) proposes an order by times without obstacles.
//! - `walk` goes through it with checks that cost a tenth of a motion: is the path straight, do slabs rule it out?
//! - The first pair that cannot be done gives a `condition`: the object that was hit, or blocked the path, must be
//!   moved earlier or later. The ends of all motions give such conditions in advance (`ends`).
//! - If no order satisfies all conditions, one is built pair by pair.
//! - The search also tries the file's own order. Then the tour learns the real durations of motions, and proposes
//!   again.
//!
//! # Moving obstacles
//!
//! If there are moving obstacles, or objects that are picked while they move, another search is used (`among_movers`),
//! over the next steps and their times.
//!
//! # Verdicts
//!
//! If the search has tried everything and every motion was refused with a proof, the task is infeasible. If a choice
//! was left out (a turn of the wrist during a motion, orders not tried), the answer is unknown. That no order can be
//! done is proven by a `part` of the group: one or two pairs that cannot be done even without all other objects.

mod among_movers;
mod answer;
mod failed_step;
mod motion_cache;
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
