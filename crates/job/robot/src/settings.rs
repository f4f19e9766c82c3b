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
    /// True if the wrist turns during motions, as it may in steps and along lines.
    pub wrist_turns: bool,
}
