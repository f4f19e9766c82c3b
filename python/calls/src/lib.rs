//! Functions of the Python package on plain types: problems, findings, predicates and tables of studies.
//!
//! The package has two back ends, which share these functions: the extension module (PyO3), and the WebAssembly module
//! for Pythons without one. This crate decides nothing. [`cplan::input`] reads the texts of arms and worlds, options are
//! words of the program's command line, and plans come from [`cplan::plan`].
#![forbid(unsafe_code)]

mod error;
mod findings;
mod geometry;
mod grading;
mod plan;
mod problem;
mod study;

pub use error::Refusal;
pub use findings::{
    ComparedProblem, Motion, check, compare, compared_problems, explanation, explanation_drawn, slices, verify,
};
pub use geometry::{PolygonTest, minkowski_difference, penetration_depth, polygon_test};
pub use grading::{DrawnAnswer, JointBox, Verdict, drawn, joint_ranges, judge_boxes, separate};
pub use plan::{Trajectory, plan, restored, trajectory};
pub use problem::{Arm, ArmNumbers, Options, World, notes, problem};
pub use study::{
    Column, Table, layout, layout_values, parameter_names, read_study, study_description, study_of_sources,
    study_sources, table,
};
