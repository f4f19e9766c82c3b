//! Several planners on many problems.

use super::comparison::Comparison;
use super::measure::Measure;
use super::row::Row;
use super::spread::Spread;
use cplan_model::Status;

/// Start-goal pairs that are drawn at random, instead of those of the world files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// Number of pairs per world.
    pub queries: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The results of the same planners on many problems.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Title.
    pub title: String,
    /// How start and goal were drawn. `None` if they are those of the world files.
    pub sampling: Option<Sampling>,
    /// One comparison per problem, each with the same planners in the same order.
    pub comparisons: Vec<Comparison>,
    /// Worlds that were left out, each as one line with the reason.
    pub left_out: Vec<String>,
    /// Problems that could not be run.
    pub refused: Vec<Refusal>,
}

/// A problem that could not be run: its files cannot be read, or its start or goal is blocked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The problem's name in tables.
    pub problem: String,
    /// `input`, `start` or `goal`.
    pub kind: &'static str,
    /// The defect, on one line.
    pub reason: String,
}

impl Study {
    /// Returns the planners' names, in the order of the tables.
    pub fn planners(&self) -> Vec<&str> {
        self.comparisons.first().map_or_else(Vec::new, |c| c.rows.iter().map(|row| row.planner.as_str()).collect())
    }

    /// Iterates over a planner's runs, each with its problem.
    pub fn runs(&self, planner: usize) -> impl Iterator<Item = (&Comparison, &Row)> {
        self.comparisons.iter().filter_map(move |c| c.rows.get(planner).map(|row| (c, row)))
    }

    /// Returns the numbers of a planner's runs by status, in the order of [`Status::ALL`].
    pub fn tally(&self, planner: usize) -> [usize; 3] {
        Status::ALL.map(|outcome| self.runs(planner).filter(|(_, row)| row.outcome == outcome).count())
    }

    /// Returns the distribution of a planner's values. `None` without values.
    pub fn spread(&self, planner: usize, measure: Measure) -> Option<Spread> {
        Spread::of(self.runs(planner).filter_map(|(comparison, row)| measure.of(comparison, row)))
    }

    /// Returns the numbers of problems by the outcome of all planners together, in the order of [`Status::ALL`]: a path, a proof
    /// that there is none, or neither. A contradictory problem counts as one with a path.
    pub fn outcome_counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for comparison in &self.comparisons {
            let best = Status::ALL.iter().position(|o| comparison.rows.iter().any(|row| row.outcome == *o));
            if let Some(best) = best {
                counts[best] += 1;
            }
        }
        counts
    }

    /// Describes each contradiction between planners.
    pub fn alarms(&self) -> Vec<String> {
        self.comparisons.iter().filter_map(Comparison::alarm).collect()
    }
}
