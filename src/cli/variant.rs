//! A planner with options of its own, as one word of `compare`'s command line.

use super::field_args::FieldArgs;
use super::path_args::PathArgs;
use super::search_args::SearchArgs;
use crate::engine::{Effort, Method};
use crate::model::Preference;
use crate::planner::PathKind;
use clap::Parser;

/// A planner with options, in the grammar of the main job.
#[derive(Debug, Clone)]
pub struct Variant {
    /// As the user wrote it, single blanks between the words.
    pub label: String,
    /// The planner.
    pub method: Method,
    field: FieldArgs,
    path: PathArgs,
    search: SearchArgs,
}

#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Grammar {
    planner: Method,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    path: PathArgs,
    #[command(flatten)]
    search: SearchArgs,
}

impl Variant {
    /// Reads one.
    ///
    /// # Errors
    /// What is wrong with it, in one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let Grammar { planner, field, path, search } = Grammar::try_parse_from(&words).map_err(|error| {
            let text = error.to_string();
            // The first line says what is wrong, the next one, where it is so, what would be right.
            let mut lines = text.lines();
            let first = lines.next().unwrap_or_default();
            let values = lines.next().map(str::trim).filter(|line| line.starts_with('['));
            let words: Vec<&str> = [first.strip_prefix("error: ").unwrap_or(first)].into_iter().chain(values).collect();
            words.join(" ")
        })?;
        field.planner(planner)?;
        match search.conflict(planner).or_else(|| path.conflict(planner)) {
            Some(conflict) => Err(conflict),
            None => Ok(Self { label: words.join(" "), method: planner, field, path, search }),
        }
    }

    /// Which of the planner's paths it gives.
    pub fn path_kind(&self) -> PathKind {
        self.path.kind(self.method)
    }

    /// The effort that it is asked to make, all else as in `base`.
    ///
    /// # Errors
    /// What it needs and these regions of the world lack.
    pub fn effort(&self, base: Effort, preferences: &[Preference]) -> Result<Effort, String> {
        match self.field.lack(preferences) {
            Some(lack) => Err(lack),
            None => {
                let (field, wavefront) = (self.field.planner(self.method)?, self.search.wavefront());
                Ok(Effort { field, wavefront, path: self.path.path, ..base })
            }
        }
    }
}
