//! Which planners read a setting: for help and errors.

use cplan_solver::{Method, Setting};

/// Returns the planners that read one of these settings, those of the first setting first: `visibility, trapezoid or prm`, with this word
/// before the last.
pub fn readers(settings: &[Setting], last: &str) -> String {
    let of = |&setting| Method::ALL.into_iter().filter(move |method| method.reads(setting));
    listed(&settings.iter().flat_map(of).map(Method::name).collect::<Vec<_>>(), last)
}

/// Refuses an option that the planner does not read. `why` follows the planner's name.
///
/// # Errors
/// None of these settings is read.
pub fn require(option: &str, settings: &[Setting], planner: Method, why: &str) -> Result<(), String> {
    if settings.iter().any(|&setting| planner.reads(setting)) {
        return Ok(());
    }
    Err(format!("{option} needs --planner {}: {planner} {why}", readers(settings, " or ")))
}

/// Returns names with commas between them, and this before the last.
pub fn listed(names: &[&str], last: &str) -> String {
    match names.split_last() {
        Some((name, [])) => (*name).to_owned(),
        Some((name, others)) => format!("{}{last}{name}", others.join(", ")),
        None => String::new(),
    }
}
