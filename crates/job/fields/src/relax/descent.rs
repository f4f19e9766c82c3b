//! Descent to a goal: from cell to cell, and along the gradient as a curve.

use super::{Cell, Domain, Neighbor};
use cplan_harmonic::follow::Guide;
use cplan_planners::planner::grid_path::Place;
use std::collections::{BTreeMap, VecDeque};

/// A cell at which a descent ended without a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeadEnd {
    /// The cell in which the descent ended.
    pub cell: usize,
    /// The value of the field there.
    pub value: f64,
    /// True if a free neighbour has exactly the same value. If false, all neighbours are worse.
    pub flat: bool,
}

/// Moves from cell to neighbouring cell until it reaches a goal, and returns the cells. Each move leads to the neighbour whose
/// value is nearest to the goals' level (the first of equals): down if obstacles are high, up if they are low.
///
/// If no neighbour is better, the path crosses cells of equal value to the nearest better cell, because a field may be level
/// around a point of symmetry. It does not cross cells with exactly the level of obstacles or goals, where the field gives no
/// direction. No cell is visited twice.
///
/// # Errors
/// [`DeadEnd`] if there is no better cell. Converged fields of monotone equations have such cells only where values differ by
/// less than the precision of doubles, and where only goals bound a region, so that the field is constant.
///
/// # Panics
/// If there is not one value per cell, or `from` is not a cell.
pub fn descend(domain: &Domain, values: &[f64], from: usize) -> Result<Vec<usize>, DeadEnd> {
    assert_eq!(values.len(), domain.kinds().len(), "one value a cell");
    let slope = Values { domain, values };
    let mut cells = vec![from];
    let mut at = from;
    while domain.kinds()[at] != Cell::Goal {
        match slope.lowest(at) {
            Some(next) => cells.push(next),
            None => cells.extend(slope.cross_plateau(at)?),
        }
        at = cells[cells.len() - 1];
    }
    Ok(cells)
}

#[derive(Clone, Copy)]
struct Values<'a> {
    domain: &'a Domain,
    values: &'a [f64],
}

impl Values<'_> {
    fn neighbors(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        self.domain.neighbors(cell).into_iter().filter_map(|neighbor| match neighbor {
            Neighbor::Cell(next) if self.domain.kinds()[next] != Cell::Obstacle => Some(next),
            _ => None,
        })
    }

    /// Returns the value of a cell, with the sign changed if obstacles are low.
    fn height(&self, cell: usize) -> f64 {
        self.domain.levels().orientation() * self.values[cell]
    }

    /// Returns the best neighbour of a cell, if it is better than the cell.
    fn lowest(&self, cell: usize) -> Option<usize> {
        let lower = |best, next| if self.height(next) < self.height(best) { next } else { best };
        let best = self.neighbors(cell).fold(cell, lower);
        (best != cell).then_some(best)
    }

    /// Returns the cells after `from`, all with the same value, up to the nearest cell with a better neighbour.
    fn cross_plateau(&self, from: usize) -> Result<Vec<usize>, DeadEnd> {
        let value = self.values[from];
        let is_level = |cell: usize| self.values[cell] == value && self.domain.kinds()[cell] == Cell::Free;
        let stuck = DeadEnd { cell: from, value, flat: self.neighbors(from).any(|next| self.values[next] == value) };
        let levels = self.domain.levels();
        if value == levels.obstacle || value == levels.goal {
            return Err(stuck);
        }
        let mut before = BTreeMap::from([(from, from)]);
        let mut queue = VecDeque::from([from]);
        while let Some(cell) = queue.pop_front() {
            if cell != from && self.lowest(cell).is_some() {
                let mut path = vec![cell];
                while before[&path[path.len() - 1]] != from {
                    path.push(before[&path[path.len() - 1]]);
                }
                path.reverse();
                return Ok(path);
            }
            for next in self.neighbors(cell).filter(|&next| is_level(next)) {
                before.entry(next).or_insert_with(|| {
                    queue.push_back(next);
                    cell
                });
            }
        }
        Err(stuck)
    }
}

/// The values of a field as a [`Guide`] for a curve towards the goals. The curve follows the gradient of the logarithm of the
/// difference between the value and the obstacles' level, by central differences.
pub struct ValueGuide<'a, F> {
    values: Values<'a>,
    /// Returns the cell at a place; `None` beyond limits.
    at: F,
}

impl<'a, F: Fn(Place) -> Option<usize>> ValueGuide<'a, F> {
    /// Creates the guide. `at` returns the cell at a place of the lattice.
    ///
    /// # Panics
    /// If there is not one value per cell.
    pub fn new(domain: &'a Domain, values: &'a [f64], at: F) -> Self {
        assert_eq!(values.len(), domain.kinds().len(), "one value a cell");
        Self { values: Values { domain, values }, at }
    }

    /// Returns the cell at a place, if it is of this kind.
    fn of_kind(&self, place: Place, kind: Cell) -> Option<usize> {
        (self.at)(place).filter(|&cell| self.values.domain.kinds()[cell] == kind)
    }
}

impl<F: Fn(Place) -> Option<usize>> Guide for ValueGuide<'_, F> {
    type DeadEnd = DeadEnd;

    fn slope(&self, place: Place) -> Option<[f64; 2]> {
        let cell = self.of_kind(place, Cell::Free)?;
        let Values { domain, values } = self.values;
        let depth = |value: f64| (domain.levels().obstacle - value) * domain.levels().orientation();
        let here = depth(values[cell]);
        let [down, up, left, right] = domain.neighbors(cell).map(|neighbor| match neighbor {
            Neighbor::Cell(next) => depth(values[next]),
            Neighbor::Limit => 0.0,
            Neighbor::Mirror => here,
        });
        // If an equation is not monotone, a value may be beyond the obstacles' level, and have no logarithm.
        let scale = if here > 0.0 { 2.0 * here } else { 1.0 };
        // A displacement in cells, steepest in lengths. Along axis 2, a cell is shorter by the factor `beta`.
        Some([(up - down) / scale, domain.beta() * domain.beta() * (right - left) / scale])
    }

    fn is_goal(&self, place: Place) -> bool {
        self.of_kind(place, Cell::Goal).is_some()
    }

    fn is_progress(&mut self, from: Place, to: Place) -> bool {
        match ((self.at)(from), (self.at)(to)) {
            (Some(from), Some(to)) => self.values.height(to) < self.values.height(from),
            _ => false,
        }
    }

    fn next_cells(&mut self, from: Place) -> Result<Vec<Place>, DeadEnd> {
        let cell = (self.at)(from).unwrap_or_else(|| unreachable!("a way stays in free cells"));
        let cells = self.values.lowest(cell).map_or_else(|| self.values.cross_plateau(cell), |next| Ok(vec![next]))?;
        let mut place = from;
        let step = |next: usize| {
            let [i, j] = place;
            let around = [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]];
            place = around.into_iter().find(|&to| (self.at)(to) == Some(next))?;
            Some(place)
        };
        Ok(cells.into_iter().map_while(step).collect())
    }
}
