//! Exit codes.

use crate::model::Status;

/// Exit code: a certified path was found, or another command has succeeded.
pub const DONE: u8 = 0;
/// Exit code: bad input or I/O.
pub const BAD_INPUT: u8 = 1;
/// Exit code: wrong command line, the same as clap's.
pub const USAGE: u8 = 2;
/// Exit code: it is proven that there is no path.
pub const INFEASIBLE: u8 = 3;
/// Exit code of `verify`: a proven collision, a violated limit, or a task that differs from the requested one. Exit
/// code of `check`: not the expected answer.
pub const REFUTED: u8 = 3;
/// Exit code: neither a path nor a proof was found.
pub const UNKNOWN: u8 = 4;
/// Exit code of a study that is ended by Ctrl-C, as in shells.
#[cfg(feature = "study")]
pub const INTERRUPTED: u8 = 130;

/// Returns the exit code for an answer.
pub fn code_of(status: Status) -> u8 {
    match status {
        Status::Found => DONE,
        Status::Infeasible => INFEASIBLE,
        Status::Unknown => UNKNOWN,
    }
}
