//! Exit codes.

/// Exit code: a path was found, and it is certified; or the job is done.
pub const DONE: u8 = 0;
/// Exit code: bad input or I/O.
pub const BAD_INPUT: u8 = 1;
/// Exit code: wrong command line, the same as clap's.
pub const USAGE: u8 = 2;
/// Exit code: there is no path, proven.
pub const INFEASIBLE: u8 = 3;
/// Exit code of `verify`: a proven collision, a violated limit, or a task that differs from the requested one.
pub const REFUTED: u8 = 3;
/// Exit code: neither found nor proven infeasible.
pub const UNKNOWN: u8 = 4;
