//! Single motions and tasks.

use serde::{Deserialize, Serialize};

/// What there is of a single motion, or of a task.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind<M, T> {
    /// A single motion.
    Motion(M),
    /// A sequence of them.
    Task(T),
}

impl<M, T> Kind<M, T> {
    /// What there is of a single motion.
    pub fn motion(&self) -> Option<&M> {
        if let Self::Motion(motion) = self { Some(motion) } else { None }
    }

    /// What there is of a task.
    pub fn task(&self) -> Option<&T> {
        if let Self::Task(task) = self { Some(task) } else { None }
    }
}
