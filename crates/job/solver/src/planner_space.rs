//! The requirements of the solver on a planner's representation of free space.

use super::Space;
use cplan_model::space::Configuration;
use cplan_planners::cspace::{Grid, Proves, Regions, ZonedGrid};

/// A planner's representation of free space. It may not admit a free start or goal, because it is not exact. Then the search uses
/// a *stand-in*: an admitted configuration nearby.
pub(super) trait PlannerSpace {
    /// Returns true if a planner can begin or end at `q`.
    fn admits(&self, q: Configuration) -> bool;
    /// Describes the space in a few words.
    fn describe(&self) -> String;
    /// Returns the space as part of an answer.
    fn into_space(self) -> Space;
}

impl PlannerSpace for Regions {
    fn admits(&self, q: Configuration) -> bool {
        self.component(q).is_some()
    }

    fn describe(&self) -> String {
        format!("polygons ({})", self.proves)
    }

    fn into_space(self) -> Space {
        Space::Regions(Box::new(self))
    }
}

impl PlannerSpace for Grid {
    fn admits(&self, q: Configuration) -> bool {
        !self.blocked[self.locate(q)]
    }

    fn describe(&self) -> String {
        let kind = if self.proves == Proves::Sampled { " by their centres" } else { "" };
        format!("{} x {} cells{kind}", self.cells[0], self.cells[1])
    }

    fn into_space(self) -> Space {
        Space::Grid(Box::new(self))
    }
}

impl PlannerSpace for ZonedGrid {
    fn admits(&self, q: Configuration) -> bool {
        self.grid.admits(q)
    }

    fn describe(&self) -> String {
        self.grid.describe()
    }

    fn into_space(self) -> Space {
        self.grid.into_space()
    }
}
