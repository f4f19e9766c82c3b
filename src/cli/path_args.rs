//! The command line's word for which of a planner's paths is wanted.

use crate::engine::Method;
use crate::planner::PathKind;
use clap::Args;

/// Which path.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct PathArgs {
    /// Which path: the planner's own (the curve along a field's gradient, the wavefront's staircase, the middles of a
    /// decomposition's doors and cells), or that one pulled taut within the planner's cells [default: own for harmonic,
    /// taut for the others].
    #[arg(long, value_enum, value_name = "KIND")]
    pub path: Option<PathKind>,
}

impl PathArgs {
    /// What of it the planner cannot do, if there is something.
    pub fn conflict(&self, planner: Method) -> Option<String> {
        (self.path == Some(PathKind::Own) && !planner.has_own_path())
            .then(|| format!("--path own is not for {planner}: its path is taut as it is"))
    }

    /// The path that the planner is to give.
    pub fn kind(&self, planner: Method) -> PathKind {
        self.path.unwrap_or(planner.path_kind())
    }
}
