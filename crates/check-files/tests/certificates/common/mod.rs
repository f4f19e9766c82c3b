//! Robots and verdicts that several files use.

pub mod gantry;
pub mod plane;
pub mod robots;
pub mod scara;
pub mod verdict;
