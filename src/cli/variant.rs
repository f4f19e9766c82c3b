//! A planner with its own options, as one argument of `cplan compare`.

use crate::engine::Planner;
use crate::options::{EffortArgs, PlannerArgs, PlannerWords};
use clap::Parser;

/// A planner with options, in the grammar of `cplan plan`.
#[derive(Debug, Clone)]
pub struct Variant {
    /// The user's text, with single blanks between the words.
    pub label: String,
    planner: Planner,
    options: PlannerArgs,
}

impl Variant {
    /// Parses a variant.
    ///
    /// # Errors
    /// The defect, in one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        if words.is_empty() {
            return Err("no planner is named; write its name first, as in \"shortest --gap 0.01\"".into());
        }
        let PlannerWords { planner, options } = PlannerWords::try_parse_from(&words).map_err(|error| {
            let text = error.to_string();
            // The first line states the defect. The next line may list the valid values.
            let mut lines = text.lines();
            let first = lines.next().unwrap_or_default();
            let values = lines.next().map(str::trim).filter(|line| line.starts_with('['));
            let words: Vec<&str> = [first.strip_prefix("error: ").unwrap_or(first)].into_iter().chain(values).collect();
            words.join(" ")
        })?;
        Ok(Self { label: words.join(" "), planner: options.planner(planner)?, options })
    }

    /// Returns the planner, and its number of attempts. `base` has the settings that the variant does not state.
    pub fn completed_by(&self, base: &EffortArgs) -> (Planner, usize) {
        let effort = self.options.effort.completed_by(base);
        let planner = effort.apply_to(self.planner);
        (planner, effort.levels(&planner))
    }

    /// Returns a warning for each option that the planner ignores.
    pub fn ignored(&self) -> Vec<String> {
        self.options.effort.ignored(self.planner.method())
    }

    /// Returns the reason why the selected device is not available, with a hint. `None` if it is available.
    pub fn missing(&self) -> Option<String> {
        self.options.field.missing()
    }
}
