//! Parsers for numbers on the command line.

use crate::grammar::number_in;

/// Longest time limit that a command accepts, in seconds: some thirty years.
const MAX_JOB_SECONDS: f64 = 1e9;

/// Parses a least distance from obstacles, in metres.
pub fn clearance(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x >= 0.0, "of metres, finite and not negative")
}

/// Parses a time limit, in seconds.
pub fn time_limit(text: &str) -> Result<f64, String> {
    number_in(
        text,
        |x| x > 0.0 && x <= MAX_JOB_SECONDS,
        &format!("of seconds, greater than 0 and at most {MAX_JOB_SECONDS:e}"),
    )
}
