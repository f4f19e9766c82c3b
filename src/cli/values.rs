//! Parsers for numbers on the command line.

use crate::options::{finite, number_in};
use cplan_follow::MIN_TOLERANCE;
use cplan_text::metres;

/// Longest accepted time limit, in seconds: about thirty years.
const MAX_JOB_SECONDS: f64 = 1e9;

/// Parses a least distance from obstacles: metres, or a length with its unit.
pub fn clearance(text: &str) -> Result<f64, String> {
    let range = "must be a length such as 0.02 or 20mm, finite and not negative";
    metres(text).ok().filter(|x| x.is_finite() && *x >= 0.0).ok_or_else(|| range.to_owned())
}

/// Parses the greatest distance of the tip from a line: metres, or a length with its unit.
pub fn tolerance(text: &str) -> Result<f64, String> {
    let range = || format!("must be a length such as 0.00005 or 0.05mm, finite and at least {MIN_TOLERANCE} m");
    metres(text).ok().filter(|x| x.is_finite() && *x >= MIN_TOLERANCE).ok_or_else(range)
}

/// Parses a time limit, in seconds.
pub fn time_limit(text: &str) -> Result<f64, String> {
    number_in(
        text,
        |x| x > 0.0 && x <= MAX_JOB_SECONDS,
        &format!("of seconds, greater than 0 and at most {MAX_JOB_SECONDS:e}"),
    )
}

/// Greatest displacement of a drawing or a line, in metres. Their coordinates are at most half of this.
const MAX_MOVE: f64 = 2e12;

/// Parses a displacement `x,y`, in metres.
pub fn displacement(text: &str) -> Result<[f64; 2], String> {
    let (x, y) = text.split_once(',').ok_or("expected two numbers separated by a comma, such as -0.4,1")?;
    let length =
        |text: &str| number_in(text.trim(), |x| x.abs() <= MAX_MOVE, &format!("of metres, {MAX_MOVE:e} at most"));
    Ok([length(x)?, length(y)?])
}

/// Parses an angle in radians, or in degrees if it ends in `deg`. Returns radians.
pub fn turn(text: &str) -> Result<f64, String> {
    match text.strip_suffix("deg") {
        Some(degrees) => Ok(finite(degrees.trim_end())?.to_radians()),
        None => finite(text),
    }
}
