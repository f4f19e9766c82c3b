//! The elements of a world that block all motions: obstacles, links, limits of joints and the required clearance, in irreducible
//! sets.
//!
//! [`MotionQuestion`] is a query whose start or goal may be blocked, and which can be asked again in a world with fewer
//! [`Element`]s. [`blocking_set`] removes elements as long as there is no motion.

mod blockers;
mod element;
mod question;

pub use blockers::{Blocker, BlockingSet, blocking_set, blocking_sets};
pub use element::{Element, Side};
pub use question::{End, MIN_CLEARANCE, MotionQuestion, TIME_LIMIT, Target, farthest};
