//! Judges recorded motions and tasks of any origin, and the claims in their files.
//!
//! - [`verify`] returns the verdict on a recording with all findings, as `cplan verify` prints it. [`verify_task`] does the same
//!   for a task that another program has read.
//! - [`replay()`] repeats a recorded task: it matches the recorded steps with those of the task (`order`), computes the
//!   places of the objects and of the load from the recorded configurations (`state`), and judges each motion among the
//!   objects as they are at that time.
//! - [`false_claims`] judges the claims of a result. The samples are the motion, and all other members are claims about
//!   it.
//! - [`farthest_from_plan`] compares a recorded motion with the planned one.
//!
//! [`cplan_motion::recorded`] judges collisions, limits and turns, both for recordings and for the motions that cplan
//! plans itself.

mod claims;
mod ends;
mod findings;
mod margins;
mod plan_distance;
mod replay;
mod verify;

pub use claims::{FalseClaim, false_claims, false_step_claims, false_task_claims};
pub use ends::{END_TOLERANCE, EndpointError, endpoint_errors};
pub use findings::{
    CollisionFinding, EncounterFinding, FarthestFinding, Judgement, LimitFinding, MomentFinding, MotionFindings,
    PlanFinding, StepFinding, TurnContactFinding, TurnFinding,
};
pub use plan_distance::{FarthestPlace, farthest_from_plan};
pub use replay::{
    Fault, GripperEvent, MisplacedJoint, OrderDeviation, PLACE_TOLERANCE, Replay, ReplayedStep, ReplayedTurn, StepTool,
    TIME_TOLERANCE, misplaced_joints, replay,
};
pub use verify::{verify, verify_task};
