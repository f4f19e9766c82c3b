//! Attraction and repulsion as a guide for the way between the cells.

use super::{ForceField, Trap};
use cplan_harmonic::{Guide, Place};
use std::collections::BTreeSet;

/// The forces as a [`Guide`]: down the potential, or, where they are saturated and have none, along them as long as they
/// lead to where the way has not been.
pub struct Downforce<'a, F> {
    field: &'a ForceField<'a>,
    goals: BTreeSet<usize>,
    visited: BTreeSet<usize>,
    /// The free cell at a place; none for others, and beyond limits.
    at: F,
}

impl<'a, F: Fn(Place) -> Option<usize>> Downforce<'a, F> {
    /// `at` tells the free cell at a place of the lattice.
    pub fn new(field: &'a ForceField<'a>, goals: &[usize], at: F) -> Self {
        Self { field, goals: goals.iter().copied().collect(), visited: BTreeSet::new(), at }
    }
}

impl<F: Fn(Place) -> Option<usize>> Guide for Downforce<'_, F> {
    type Stuck = Trap;

    fn slope(&self, place: Place) -> Option<[f64; 2]> {
        let cell = (self.at)(place).filter(|cell| !self.goals.contains(cell))?;
        let (force, step) = (self.field.force(cell), self.field.step());
        Some([0, 1].map(|k| force[k] * step[k]))
    }

    fn is_goal(&self, place: Place) -> bool {
        (self.at)(place).is_some_and(|cell| self.goals.contains(&cell))
    }

    fn comes_on(&mut self, from: Place, to: Place) -> bool {
        let (Some(from), Some(to)) = ((self.at)(from), (self.at)(to)) else { return false };
        if self.field.is_saturated() {
            self.visited.insert(from);
            return self.visited.insert(to);
        }
        self.field.potential(to) < self.field.potential(from)
    }

    fn onward(&mut self, from: Place) -> Result<Vec<Place>, Trap> {
        let cell = (self.at)(from).unwrap_or_else(|| unreachable!("a way stays in free cells"));
        self.visited.insert(cell);
        let next = self.field.next(cell, |cell| self.visited.contains(&cell))?;
        self.visited.insert(next);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [from[0] + i, from[1] + j]));
        let mut around: Vec<Place> = around.filter(|&place| (self.at)(place) == Some(next)).collect();
        // On a circle of two cells one is a neighbour both ways.
        around.truncate(1);
        Ok(around)
    }
}
