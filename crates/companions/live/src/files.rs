//! Results and pictures as files, for a page to save.

use super::options::Options;
use cplan_engine::{Problem, plan};
use cplan_tasks::SEARCHES;
use cplan_view::output::{FileFormat, PlanOutput as _};
use cplan_world::{LoadedScene, Overrides};
use std::path::Path;

/// Returns the content of a file.
///
/// # Errors
/// An unknown format, bad input, or a result without the data for the format.
pub fn content(loaded: LoadedScene, options: &Options, format: &str) -> Result<Vec<u8>, String> {
    let in_words = |error: &dyn ToString| error.to_string();
    let format = FileFormat::from_path(Path::new(&format!("plan.{format}"))).map_err(|error| in_words(&error))?;
    let options = options.for_scene(&loaded.scene)?;
    let problem = Problem::of_scene(loaded, &Overrides::default()).map_err(|error| in_words(&error))?;
    let plan = plan(&problem, options, SEARCHES, &mut |_| ()).map_err(|error| in_words(&error))?;
    let bytes = plan.bytes(format).map_err(|error| in_words(&error))?;
    bytes.ok_or_else(|| "the result has no trajectory".to_owned())
}
