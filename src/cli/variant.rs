//! A planner with options of its own, as one word of `compare`'s command line.

use crate::engine::Planner;
use crate::grammar::{EffortArgs, PlannerArgs, PlannerWords};
use clap::Parser;

/// A planner with options, in the grammar of the main job.
#[derive(Debug, Clone)]
pub struct Variant {
    /// As the user wrote it, single blanks between the words.
    pub label: String,
    planner: Planner,
    options: PlannerArgs,
}

impl Variant {
    /// Reads one.
    ///
    /// # Errors
    /// What is wrong with it, in one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        if words.is_empty() {
            return Err("it names no planner: the name comes first, as in \"shortest --gap 0.01\"".into());
        }
        let PlannerWords { planner, options } = PlannerWords::try_parse_from(&words).map_err(|error| {
            let text = error.to_string();
            // The first line says what is wrong, the next one, where it is so, what would be right.
            let mut lines = text.lines();
            let first = lines.next().unwrap_or_default();
            let values = lines.next().map(str::trim).filter(|line| line.starts_with('['));
            let words: Vec<&str> = [first.strip_prefix("error: ").unwrap_or(first)].into_iter().chain(values).collect();
            words.join(" ")
        })?;
        Ok(Self { label: words.join(" "), planner: options.planner(planner)?, options })
    }

    /// The planner, and how many attempts it has, where it says nothing of `base` itself.
    pub fn over(&self, base: &EffortArgs) -> (Planner, usize) {
        let effort = self.options.effort.over(base);
        let planner = effort.put_into(self.planner);
        (planner, effort.levels(&planner))
    }

    /// Why what its field is relaxed on cannot be had, if it cannot, with the cure.
    pub fn missing(&self) -> Option<String> {
        self.options.missing()
    }
}
