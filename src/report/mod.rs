//! Comparisons as tables: for people, for spreadsheets, for programs.

mod comparison;
mod table;

pub use comparison::{Comparison, Row};
