//! What decides how a robot is read, beside its own file.

use crate::robot_table::RobotTable;
use crate::source::Source;

/// Settings for the reader of a robot, as a world file gives them.
#[derive(Debug, Clone, Copy)]
pub struct RobotSettings<'a> {
    /// The `[robot]` table.
    pub table: &'a RobotTable,
    /// The world file, whose lines messages about the table show.
    pub source: &'a Source,
    /// Whether the world has steps. While the arm does them the wrist turns.
    pub has_steps: bool,
}
