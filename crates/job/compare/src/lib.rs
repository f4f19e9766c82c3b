//! Comparisons of planners on one problem or on many, and of relaxations ([`Convergence`]): as text for people, as tables for
//! spreadsheets, and as JSON for programs.
//!
//! ```text
//! Row (a planner on a problem) -> Comparison (planners on a problem) -> Study (planners on problems)
//!                                      |                                   |
//!                        table, Markdown, CSV, JSON        the same, with distributions and words;
//!                                                          a page with charts; a log for Planner Arena
//! ```
//!
//! The crate works only on figures, and all outputs are pure functions of them. `Spread` is a distribution, `Measure` a quantity
//! to compare. `words` states only conclusions that a sign test over the problems supports. `page` writes HTML with its own SVG
//! charts; callers pass in other pictures as text.

mod arena;
mod best;
mod comparison;
mod conclusion;
mod convergence;
mod labels;
mod measure;
pub mod page;
mod pens;
mod recommendation;
mod row;
mod sign;
mod spread;
mod study;
mod study_files;
mod table;
mod words;

pub use best::Better;
pub use comparison::Comparison;
pub use convergence::{Convergence, ParameterScan, Point, RelaxationRun, Setup, convergence};
pub use cplan_solver::Family;
pub use labels::labels;
pub use measure::Measure;
pub use page::{Overlay, Page, PathPictures, Picture};
pub use pens::hue;
pub use recommendation::Purpose;
pub use row::{OtherPath, Row};
pub use sign::sign_test;
pub use spread::Spread;
pub use study::{Refusal, Sampling, Study};
pub use table::{Align, Column, Emphasis, MAX_TABLE_WIDTH, PLAIN, Table, quoted};
pub use words::words;
