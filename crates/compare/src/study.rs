//! Several planners on many problems.

use super::comparison::Comparison;
use super::measure::Measure;
use super::row::Row;
use super::spread::Spread;
use cplan_core::model::Status;

/// Random start-goal pairs instead of the worlds' own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// Pairs a world.
    pub queries: usize,
    /// Their seed.
    pub seed: u64,
}

/// The results of the same planners on many problems.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Title.
    pub title: String,
    /// The sampling, if start and goal were drawn at random.
    pub sampling: Option<Sampling>,
    /// One comparison per problem, each with the same planners in the same order.
    pub comparisons: Vec<Comparison>,
    /// Omitted worlds with reasons, one per line.
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
    #[must_use]
    pub fn planners(&self) -> Vec<&str> {
        self.comparisons.first().map_or_else(Vec::new, |c| c.rows.iter().map(|row| row.planner.as_str()).collect())
    }

    /// Iterates over a planner's runs, each with its problem.
    pub fn runs(&self, planner: usize) -> impl Iterator<Item = (&Comparison, &Row)> {
        self.comparisons.iter().filter_map(move |c| c.rows.get(planner).map(|row| (c, row)))
    }

    /// Returns the number of a planner's runs by status, in the order of [`Status::ALL`].
    #[must_use]
    pub fn tally(&self, planner: usize) -> [usize; 3] {
        Status::ALL.map(|outcome| self.runs(planner).filter(|(_, row)| row.outcome == outcome).count())
    }

    /// Returns the distribution of a planner's values, or `None` if it has no values.
    #[must_use]
    pub fn spread(&self, planner: usize, measure: Measure) -> Option<Spread> {
        Spread::of(self.runs(planner).filter_map(|(comparison, row)| measure.of(comparison, row)))
    }

    /// Returns the number of problems by the joint knowledge of all planners, in the order of [`Status::ALL`]: with a
    /// path, proven infeasible, and unsettled. Contradictory ones count as solved.
    #[must_use]
    pub fn settled(&self) -> [usize; 3] {
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
    #[must_use]
    pub fn alarms(&self) -> Vec<String> {
        self.comparisons.iter().filter_map(Comparison::alarm).collect()
    }
}
