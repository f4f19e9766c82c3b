//! The way to a goal, from cell to cell.

use super::{Cell, Domain, Neighbor};
use std::collections::{BTreeMap, VecDeque};

/// Where a descent ended without a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stuck {
    /// The cell.
    pub cell: usize,
    /// Its value.
    pub value: f64,
    /// Whether a free neighbour has the very same value; otherwise all are worse.
    pub flat: bool,
}

/// Goes from cell to neighbouring cell, always to the one whose value is nearest to the goals' (the first of equals), until
/// it comes to a goal: down if obstacles are high, up if they are low. Where all neighbours are worse or equal it crosses
/// the cells of equal value to the nearest better one: a field may be level about a point where it is symmetric. It does not
/// cross cells with the very value of obstacles or goals: there the field says nothing any more. No cell comes twice.
///
/// # Errors
/// [`Stuck`] where there is no better value to go to. The fields of monotone equations, relaxed to convergence, have no
/// such cell, but where their values differ by less than doubles can tell, and where no obstacle can be reached but by way
/// of goals: there the field is constant.
///
/// # Panics
/// If there is not one value a cell, or `from` is no cell.
pub fn descend(domain: &Domain, values: &[f64], from: usize) -> Result<Vec<usize>, Stuck> {
    assert_eq!(values.len(), domain.kinds().len(), "one value a cell");
    let slope = Slope { domain, values };
    let mut cells = vec![from];
    let mut at = from;
    while domain.kinds()[at] != Cell::Goal {
        match slope.lowest(at) {
            Some(next) => cells.push(next),
            None => cells.extend(slope.across(at)?),
        }
        at = cells[cells.len() - 1];
    }
    Ok(cells)
}

struct Slope<'a> {
    domain: &'a Domain,
    values: &'a [f64],
}

impl Slope<'_> {
    fn neighbors(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        self.domain.neighbors(cell).into_iter().filter_map(|neighbor| match neighbor {
            Neighbor::Cell(next) if self.domain.kinds()[next] != Cell::Obstacle => Some(next),
            _ => None,
        })
    }

    /// The best neighbour, if it is strictly better.
    fn lowest(&self, cell: usize) -> Option<usize> {
        let height = |cell: usize| self.domain.levels().orientation() * self.values[cell];
        let best = self.neighbors(cell).fold(cell, |best, next| if height(next) < height(best) { next } else { best });
        (best != cell).then_some(best)
    }

    /// The cells after `from`, all of its value, to the nearest one that has a better neighbour.
    fn across(&self, from: usize) -> Result<Vec<usize>, Stuck> {
        let value = self.values[from];
        let is_level = |cell: usize| self.values[cell] == value && self.domain.kinds()[cell] == Cell::Free;
        let stuck = Stuck { cell: from, value, flat: self.neighbors(from).any(|next| self.values[next] == value) };
        let levels = self.domain.levels();
        if value == levels.obstacle || value == levels.goal {
            return Err(stuck);
        }
        let mut before = BTreeMap::from([(from, from)]);
        let mut queue = VecDeque::from([from]);
        while let Some(cell) = queue.pop_front() {
            if cell != from && self.lowest(cell).is_some() {
                let mut way = vec![cell];
                while before[&way[way.len() - 1]] != from {
                    way.push(before[&way[way.len() - 1]]);
                }
                way.reverse();
                return Ok(way);
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
