//! Headings of option groups in the help, the same in all commands.

/// Options that replace start, goal and clearance of the world file.
pub const QUERY: &str = "Query";
/// Options for output files and printed text.
pub const OUTPUT: &str = "Output";
/// Options for planners.
pub const PLANNER: &str = "Planner";
/// Options of `cplan init` alone.
pub const DATA_SHEET: &str = "Data sheet";
/// Options of `cplan explore` alone.
pub const EXPLORATION: &str = "Exploration";
/// Options of `cplan compare` alone.
pub const COMPARISON: &str = "Comparison";
/// Options of `cplan converge` alone.
pub const RELAXATION: &str = "Relaxation";
