//! Names of the planners that read a setting, for help and errors.

use cplan_solver::{Method, Setting};

/// Lists the planners that read one of these settings: `visibility, trapezoid or prm`. Those that read the first setting come
/// first. `last` is the text before the last name.
pub fn readers(settings: &[Setting], last: &str) -> String {
    let of = |&setting| Method::ALL.into_iter().filter(move |method| method.reads(setting));
    listed(&settings.iter().flat_map(of).map(Method::name).collect::<Vec<_>>(), last)
}

/// Checks that the planner uses `option`. In the message, `why` follows the planner's name.
///
/// # Errors
/// A planner that uses none of these settings.
pub fn require(option: &str, settings: &[Setting], planner: Method, why: &str) -> Result<(), String> {
    if settings.iter().any(|&setting| planner.reads(setting)) {
        return Ok(());
    }
    Err(format!("{option} needs --planner {}: {planner} {why}", readers(settings, " or ")))
}

/// Joins names by commas, with `last` before the last name.
pub fn listed(names: &[&str], last: &str) -> String {
    match names.split_last() {
        Some((name, [])) => (*name).to_owned(),
        Some((name, others)) => format!("{}{last}{name}", others.join(", ")),
        None => String::new(),
    }
}
