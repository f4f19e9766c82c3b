//! Two planar arms in one cell: motions of both on one clock, certified among the obstacles and between the arms; or a proof
//! of infeasibility.
//!
//! [`Cell::load`] reads a cell file. [`plan_cell`] plans it. The steps are:
//! - Each arm alone: the engine's plan gives the path, and the bound on its duration.
//! - Two paths are coordinated in the plane of both arms' times (`diagram`): rectangles cover the times at which the arms
//!   are not proven to be apart. A monotone route through the plane decides which arm passes first (`order`), and a graph of
//!   differences gives the earliest departures. If necessary, arms wait on their paths (`coordinate`).
//! - Steps: the sequence of each arm alone is a list of legs (`sequence`), between which the arm can wait. The bodies that
//!   move with an arm or rest change from stage to stage (`stage`, `step_stages`). Sequences of both arms are coordinated like paths
//!   (`task_search`), also others (`variants`), and those of other assignments of shared objects (`assignment`).
//! - If two paths block each other or lose time, both arms are planned at once in four joints (`joint_tree`), and an
//!   interior-point method shortens their motions (`shaping`). If that fails, one arm is planned among the other at rest,
//!   in both orders and for all IK solutions (`plan`). For arms that stop at corners, paths lose corners (`straighten`).
//! - The lower bound on the duration is raised by proofs that no motions of both arms end by a given time (`funnel`). They
//!   rest on the values that each joint can have at each time (`reach`), and on boxes in which bodies collide (`overlap`).
//! - The final motions are judged for all skews of the two clocks within a bound (`judged`). Motions of any origin are judged
//!   in the same way (`recorded`), also those with steps, whose bodies follow from the motions (`recorded_steps`). Signals between the
//!   controllers make them hold for any skew (`interlock`). For programs of joint moves this is judged again (`delays`).
//! - If nothing is found, boxes in four joints may prove that there is nothing (`refutation`).
//! - The evidence of a proof can be written, read and checked (`proof`).
//!
//! All verdicts about two arms rest on `between`: the distance of the links, with bounds on the motion of both.
#![forbid(unsafe_code)]

mod assignment;
mod between;
mod body;
mod contact;
mod coordinate;
mod curve;
mod delays;
mod diagram;
mod excerpt;
mod file;
mod file_steps;
mod funnel;
mod handover_bound;
mod interlock;
mod joint_tree;
mod judged;
mod legs;
mod motion_search;
mod order;
mod overlap;
mod picture;
mod plan;
mod proof;
mod reach;
mod recorded;
mod recorded_steps;
mod refutation;
mod schedule;
mod sequence;
mod shaping;
mod stage;
mod step_stages;
mod straighten;
mod task_search;
mod variants;

pub use coordinate::{Coordination, PlannedSteps};
pub use delays::{ProgramSteps, SignalTargets, StepPart, check_delays};
pub use file::{Cell, CellArm, ReadRobot};
pub use interlock::Interlock;
pub use judged::NearestPlace;
pub use picture::Answer;
pub use plan::{Alone, CellPlan, Refutation, Settings, plan_cell};
pub use proof::{BoxProof, Contact, ContactBox, GoalContact, LinkPart, Proof, ProofError};
pub use recorded::{BetweenFinding, NearPlace, judge_between};
pub use recorded_steps::{JudgedSteps, ToolTimes, judge_steps};
pub use schedule::{HandoverTimes, StepTimes};
