//! Plans tasks as sequences of certified motions. The IK solution at each target, the grip and the order are chosen
//! together, for the least total time.
//!
//! Each motion has its own scene: objects lie where earlier steps have left them, and the payload is part of the arm.
//! Link 2 may touch the object that a motion leads to, and the one just released, because the gripper must reach into
//! them. For link 1 and for payloads, both are obstacles.
//!
//! [`plan`] searches a layered graph by A* over times. A node consists of the steps that are done, the poses of arm and
//! objects, and the payload. Motions are planned only when the search reaches them. Until then, an edge costs the time
//! that the joints would take without obstacles, which is a lower bound for every motion. The heuristic is the least
//! sum of such times to the end, over all IK solutions and orders (by a table of subsets). At the start it is a lower
//! bound for the whole task.
//!
//! # Scenes
//!
//! - A rigid payload is a union of parts of link 2.
//! - A level payload only translates with the tip. So the tip, a single point, stands for it, and its obstacles are the
//!   Minkowski differences of the obstacles' pieces and the payload's pieces. Planners, C-obstacles, certificates and
//!   proofs therefore need no third link.
//! - Against its supports, each corner of a payload's outline is moved inwards by the allowed penetration
//!   (`inset_union`). No clearance is required from supports. So every distance to a support is increased by the
//!   clearance (`Convex::with_distances_increased`).
//! - Motions are shared (`legs`) among worlds that differ only in objects which cannot be hit because of their heights.
//!
//! # Orders
//!
//! If a group has more than ten pairs, or the search takes too long, one order is chosen (`order`). The bound still
//! covers all orders.
//!
//! - A local search (`tour`) proposes an order by times without obstacles.
//! - `walk` checks each step of the order at a tenth of the cost of planning its motion: is the straight path free, do
//!   slabs prove that there is no path?
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
//! was left out (a turn of the wrist during a motion, or an order), the answer is unknown. A `part` of a group can
//! prove that no order is possible: one or two pairs that cannot be done even without all other objects. Before any search,
//! each pick and place of a group is judged `alone`.

mod alone;
mod among_movers;
mod arch;
mod end_sequence;
mod failed_step;
mod motion_cache;
mod motion_path;
mod least_time;
mod order;
mod heuristic;
mod part;
mod plan;
mod refusal;
mod replay;
mod ik_solutions;
mod search;
mod standstill;
mod state;
mod stroke;
mod tool_turn;

use cplan_engine::{Searches, TaskSearch};
use cplan_handling::Task;
use cplan_legs::{TaskAnswer, TaskReplay};
use cplan_solver::Options;

pub use cplan_handling::rest_to_rest;
pub use plan::{least_duration, plan};
pub use replay::replay;
pub use standstill::raising_at_start;

/// The search for the motions of tasks, for plans.
#[derive(Debug)]
pub struct Search;

impl TaskSearch for Search {
    fn plan(&self, task: &Task, options: &Options, progress: &mut dyn FnMut(&str)) -> TaskAnswer {
        plan(task, options, progress)
    }

    fn replay(&self, task: &Task, options: &Options, answer: &TaskAnswer) -> TaskReplay {
        replay(task, options, answer)
    }
}

/// The searches for tasks and among moving obstacles, for plans.
pub const SEARCHES: Searches = Searches { tasks: Some(&Search), movers: Some(&cplan_movers::Search) };
