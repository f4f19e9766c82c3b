//! Comparisons of planners, on one problem or on many, and of relaxations ([`Convergence`]): for people, for spreadsheets, for
//! programs.
//!
//! ```text
//! Row (a planner on a problem) -> Comparison (planners on a problem) -> Study (planners on problems)
//!                                      |                                   |
//!                        table, Markdown, CSV, JSON        the same, with distributions and words;
//!                                                          a page with charts; a log for Planner Arena
//! ```
//!
//! It knows figures only, and all outputs are pure functions of these. `Spread` is a distribution, `Measure` a number to
//! compare by, `words` says what a sign test over the problems bears out and nothing else. `page` writes HTML with SVG
//! charts of its own; pictures of `draw` come in as text.

mod arena;
mod comparison;
mod convergence;
mod labels;
mod measure;
pub mod page;
mod row;
mod sign;
mod spread;
mod study;
mod study_files;
mod table;
mod words;

pub use comparison::Comparison;
pub use convergence::{Convergence, Course, FactorScan, Point, Setup, StrengthScan, WeightScan, convergence};
pub use labels::labels;
pub use measure::Measure;
pub use page::{Overlay, Page, Picture};
pub use row::{Family, OtherPath, Row};
pub use sign::sign_test;
pub use spread::Spread;
pub use study::{Refusal, Sampling, Study};
pub use table::WIDTH;
pub use table::quoted;
pub use table::{Align, Column, Table};
pub use words::words;
