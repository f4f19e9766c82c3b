//! Attraction and repulsion as a guide for a curve between the centres of cells.

use super::{Escape, ForceField, Trap};
use cplan_harmonic::follow::Guide;
use cplan_planners::planner::grid_path::Place;
use std::collections::BTreeSet;

/// The forces as a [`Guide`] for a curve. The curve descends the potential. Saturated forces have no potential; the curve follows
/// them as long as they lead to new cells.
pub struct ForceGuide<'a, F> {
    field: &'a ForceField<'a>,
    goals: BTreeSet<usize>,
    visited: BTreeSet<usize>,
    /// Returns the free cell at a place; `None` for cells that are not free, and beyond limits.
    at: F,
    /// Escape from local minima. With `None`, a local minimum ends the path.
    escape: Option<Escape>,
    escaped: EscapedMinima,
}

/// Counts of the local minima that a path has left.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EscapedMinima {
    /// Number of local minima.
    pub minima: usize,
    /// Number of moves from cell to cell that led out of these minima.
    pub moves: usize,
}

impl<'a, F: Fn(Place) -> Option<usize>> ForceGuide<'a, F> {
    /// Creates the guide. `at` returns the free cell at a place of the lattice.
    pub fn new(field: &'a ForceField<'a>, goals: &[usize], at: F) -> Self {
        let goals = goals.iter().copied().collect();
        Self { field, goals, visited: BTreeSet::new(), at, escape: None, escaped: EscapedMinima::default() }
    }

    /// Sets the escape from local minima. It has no effect with saturated forces: where they trap the path, the path ends.
    #[must_use]
    pub fn with_escape(self, escape: Option<Escape>) -> Self {
        Self { escape, ..self }
    }

    /// Returns the counts of local minima that the path has left so far.
    pub fn escaped(&self) -> EscapedMinima {
        self.escaped
    }

    /// Returns the cells that lead from a local minimum to a better cell.
    fn escape_from(&mut self, trap: Trap) -> Result<Vec<usize>, Trap> {
        let by = self.escape.filter(|_| trap.minimum).ok_or(trap)?;
        let number = self.escaped.minima as u64;
        let path = self.field.escape(trap.cell, by, number, |cell| self.goals.contains(&cell)).ok_or(trap)?;
        self.escaped.minima += 1;
        self.escaped.moves += path.len() - 1;
        Ok(path[1..].to_vec())
    }

    /// Returns the place of a neighbouring cell. On a circle of two cells, a cell is a neighbour in both directions.
    fn place_beside(&self, from: Place, cell: usize) -> Option<Place> {
        let mut around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [from[0] + i, from[1] + j]));
        around.find(|&place| (self.at)(place) == Some(cell))
    }
}

impl<F: Fn(Place) -> Option<usize>> Guide for ForceGuide<'_, F> {
    type DeadEnd = Trap;

    fn slope(&self, place: Place) -> Option<[f64; 2]> {
        let cell = (self.at)(place).filter(|cell| !self.goals.contains(cell))?;
        let (force, step) = (self.field.force(cell), self.field.step());
        Some([0, 1].map(|k| force[k] * step[k]))
    }

    fn is_goal(&self, place: Place) -> bool {
        (self.at)(place).is_some_and(|cell| self.goals.contains(&cell))
    }

    fn is_progress(&mut self, from: Place, to: Place) -> bool {
        let (Some(from), Some(to)) = ((self.at)(from), (self.at)(to)) else { return false };
        if self.field.is_saturated() {
            self.visited.insert(from);
            return self.visited.insert(to);
        }
        self.field.potential(to) < self.field.potential(from)
    }

    fn next_cells(&mut self, from: Place) -> Result<Vec<Place>, Trap> {
        let cell = (self.at)(from).unwrap_or_else(|| unreachable!("a way stays in free cells"));
        self.visited.insert(cell);
        let next = self.field.next(cell, |cell| self.visited.contains(&cell));
        let path = next.map_or_else(|trap| self.escape_from(trap), |next| Ok(vec![next]))?;
        self.visited.extend(&path);
        let mut places: Vec<Place> = Vec::with_capacity(path.len());
        for cell in path {
            let last = places.last().copied().unwrap_or(from);
            places.extend(self.place_beside(last, cell));
        }
        Ok(places)
    }
}
