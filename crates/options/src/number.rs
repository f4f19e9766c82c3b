//! Numbers of options.

use cplan_motion::SHORTEST_INTERVAL;

/// A number that is allowed.
///
/// # Errors
/// Any other text; `range` says what is allowed.
pub fn number_in(text: &str, allowed: impl Fn(f64) -> bool, range: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if allowed(value) => Ok(value),
        _ => Err(format!("must be a number {range}")),
    }
}

/// Any number.
///
/// # Errors
/// Infinities, and what is no number.
pub fn finite(text: &str) -> Result<f64, String> {
    number_in(text, f64::is_finite, "that is finite")
}

/// A number of more than 0.
///
/// # Errors
/// Any other.
pub fn positive(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "of more than 0")
}

/// Seconds between two samples.
///
/// # Errors
/// Less than controllers can tell apart.
pub fn seconds(text: &str) -> Result<f64, String> {
    let range = format!("of seconds, finite and at least {SHORTEST_INTERVAL}");
    number_in(text, |x| x.is_finite() && x >= SHORTEST_INTERVAL, &range)
}
