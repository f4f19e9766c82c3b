//! Parsers of numbers.

use cplan_motion::MIN_INTERVAL;

/// Parses a number for which `allowed` returns true.
///
/// # Errors
/// Any other text. `range` describes the allowed numbers in the message.
pub fn number_in(text: &str, allowed: impl Fn(f64) -> bool, range: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if allowed(value) => Ok(value),
        _ => Err(format!("must be a number {range}")),
    }
}

/// Parses a finite number.
///
/// # Errors
/// Infinities, and text that is not a number.
pub fn finite(text: &str) -> Result<f64, String> {
    number_in(text, f64::is_finite, "that is finite")
}

/// Parses a number greater than 0.
///
/// # Errors
/// Any other text.
pub fn positive(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "greater than 0")
}

/// Parses the time between two samples, seconds.
///
/// # Errors
/// A time that is too short for controllers.
pub fn seconds(text: &str) -> Result<f64, String> {
    let range = format!("of seconds, finite and at least {MIN_INTERVAL}");
    number_in(text, |x| x.is_finite() && x >= MIN_INTERVAL, &range)
}
