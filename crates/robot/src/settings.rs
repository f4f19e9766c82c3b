//! Settings for reading a robot, in addition to its own file.

use crate::robot_table::RobotTable;
use crate::source::Source;

/// The settings of a world file for reading a robot.
#[derive(Debug, Clone, Copy)]
pub struct RobotSettings<'a> {
    /// The `[robot]` table.
    pub table: &'a RobotTable,
    /// The world file. Messages quote its lines.
    pub source: &'a Source,
    /// True if the world is a task, during which the wrist turns.
    pub is_task: bool,
}
