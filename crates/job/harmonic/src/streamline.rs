//! Steepest ascent of a harmonic potential along its gradient.

use super::{Component, Potential};
use crate::follow::Guide;
use cplan_planners::planner::grid_path::Place;

/// The potential as a [`Guide`]: the gradient of its logarithm, by central differences with 0 at walls.
pub struct PotentialGuide<'a, F> {
    component: &'a Component,
    potential: &'a Potential,
    /// The position at a place, or `None` for walls and beyond limits.
    at: F,
}

/// The reason why a curve ends: a cell that is no goal has no greater neighbour. Impossible if the potential
/// [navigates](Potential::navigates).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocalMaximum {
    /// Position of the cell.
    pub place: Place,
}

impl<'a, F: Fn(Place) -> Option<usize>> PotentialGuide<'a, F> {
    /// Creates the guide. `at` returns the position at a place of the lattice.
    pub fn new(component: &'a Component, potential: &'a Potential, at: F) -> Self {
        Self { component, potential, at }
    }

    fn is_greater(&self, a: Place, b: Place) -> bool {
        match ((self.at)(a), (self.at)(b)) {
            (Some(a), Some(b)) => self.potential.is_greater(a, b),
            _ => false,
        }
    }
}

impl<F: Fn(Place) -> Option<usize>> Guide for PotentialGuide<'_, F> {
    type DeadEnd = LocalMaximum;

    fn slope(&self, place: Place) -> Option<[f64; 2]> {
        let position = (self.at)(place).filter(|&position| position >= self.component.goals)?;
        let here = self.potential.at(position);
        // Doubles with a common scale, so that quotients are correct for numbers outside the range of doubles.
        let around = self.component.neighbors(position).map(|n| self.potential.at(n));
        let [down, up, left, right] = around
            .map(|value| if value.mantissa == 0.0 { 0.0 } else { value.mantissa_at(here.exponent) / here.mantissa });
        Some([(up - down) / 2.0, (right - left) / 2.0])
    }

    fn is_goal(&self, place: Place) -> bool {
        (self.at)(place).is_some_and(|position| position < self.component.goals)
    }

    fn is_progress(&mut self, from: Place, to: Place) -> bool {
        self.is_greater(to, from)
    }

    fn next_cells(&mut self, from: Place) -> Result<Vec<Place>, LocalMaximum> {
        let [i, j] = from;
        let around = [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]];
        let best = around.into_iter().fold(from, |best, next| if self.is_greater(next, best) { next } else { best });
        if best == from { Err(LocalMaximum { place: from }) } else { Ok(vec![best]) }
    }
}
