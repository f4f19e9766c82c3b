//! Explains to a page why there is no path.

use super::blocked;
use cplan_explain::{MotionQuestion, TIME_LIMIT, explain, section};
use cplan_solver::Options;
use cplan_world::{LoadedScene, Overrides, Rules};
use serde_json::value::RawValue;
use std::time::Duration;

/// Returns the explanation of a world's motion as JSON. Once it is known whether there is a path, the explanation takes
/// at most `limit` or the usual time limit, whichever is shorter.
///
/// # Errors
/// The reason why this world cannot be explained.
pub fn explanation(loaded: LoadedScene, limit: Duration) -> Result<Box<RawValue>, String> {
    if loaded.is_task() || !loaded.trajectories.is_empty() {
        return Err("Worlds with steps or moving obstacles are explained only by `cplan explain`.".into());
    }
    let query = loaded.resolve(&Overrides::default(), Rules::Unchecked);
    let query = query.map_err(|error| blocked::without_places(&error))?;
    let (start, goals) = (query.problem.start(), &query.stated_goals);
    let question = MotionQuestion::of_goals(query.problem.into_scene(), start, goals);
    let question = question.with_time_limit(limit.min(TIME_LIMIT));
    let section = section(&explain(&question, &Options::default()));
    RawValue::from_string(section.data).map_err(|error| error.to_string())
}
