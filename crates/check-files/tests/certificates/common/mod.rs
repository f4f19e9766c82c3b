//! Robots and verdicts that several files use.

pub mod code;
pub mod gantry;
pub mod scara;
pub mod two_bars;
