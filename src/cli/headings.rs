//! Headings of option groups in the help, the same in all commands.

/// Options that replace start, goal and clearance of the world file.
pub const QUERY: &str = "Query";
/// Options for output files and printed text.
pub const OUTPUT: &str = "Output";
/// Options for planners.
pub const PLANNER: &str = "Planner";
/// Options only of `cplan init`.
pub const DATA_SHEET: &str = "Data sheet";
/// Options only of `cplan explore`.
pub const EXPLORATION: &str = "Exploration";
/// Options only of `cplan compare`.
pub const COMPARISON: &str = "Comparison";
/// Options only of `cplan converge`.
pub const RELAXATION: &str = "Relaxation";
