//! cplan: a configuration-space planner for planar two-joint arms.
#![forbid(unsafe_code)]

pub mod geometry;
pub mod space;
pub mod model;
pub mod input;
pub mod cspace;
pub mod field;
pub mod plan;
pub mod certify;
pub mod solve;
pub mod trajectory;
pub mod draw;
pub mod report;
pub mod cli;
