//! The lines of planners in pictures and charts.

use super::comparison::Comparison;
use cplan_solver::Family;
use cplan_theme::{PlannerFamily, PlannerPen};

impl Comparison {
    /// Returns the colour and dashes of each row. Planners of a family have one hue.
    pub fn pens(&self) -> Vec<PlannerPen> {
        let index = |k: usize| self.rows[..k].iter().filter(|row| row.family == self.rows[k].family).count();
        self.rows.iter().enumerate().map(|(k, row)| PlannerPen::new(hue(row.family), index(k))).collect()
    }

    /// Returns the index of a row among the rows that have a path. `None` if the row has none.
    pub fn path_index(&self, row: usize) -> Option<usize> {
        self.rows.get(row)?.length?;
        Some(self.rows[..row].iter().filter(|row| row.length.is_some()).count())
    }
}

/// Returns the family of colours of a family of planners.
pub fn hue(family: Family) -> PlannerFamily {
    match family {
        Family::Roadmap => PlannerFamily::Roadmap,
        Family::Field => PlannerFamily::Field,
        Family::Exact => PlannerFamily::Exact,
        Family::Other => PlannerFamily::Other,
    }
}
