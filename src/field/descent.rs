//! The way to a goal, from cell to cell.

use super::{Cell, Domain, Neighbor};

/// Where a descent ended without a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stuck {
    /// The cell.
    pub cell: usize,
    /// Its value.
    pub value: f64,
    /// Whether all free neighbours have the very same value; otherwise theirs are worse.
    pub flat: bool,
}

/// Goes from cell to neighbouring cell, always to the one whose value is nearest to the goals' (the first of equals), until
/// it comes to a goal: down if obstacles are high, up if they are low. At most one step a cell.
///
/// # Errors
/// [`Stuck`] where no free neighbour has a strictly better value. The fields of monotone equations, relaxed to
/// convergence, have no such cell, but where their values differ by less than doubles can tell.
///
/// # Panics
/// If there is not one value a cell, or `from` is no cell.
pub fn descend(domain: &Domain, values: &[f64], from: usize) -> Result<Vec<usize>, Stuck> {
    assert_eq!(values.len(), domain.kinds().len(), "one value a cell");
    let height = |cell: usize| domain.levels().orientation() * values[cell];
    let mut cells = vec![from];
    let mut at = from;
    while domain.kinds()[at] != Cell::Goal {
        let neighbors = || {
            domain.neighbors(at).into_iter().filter_map(|neighbor| match neighbor {
                Neighbor::Cell(next) if domain.kinds()[next] != Cell::Obstacle => Some(next),
                _ => None,
            })
        };
        let lowest = neighbors().fold(at, |best, next| if height(next) < height(best) { next } else { best });
        if lowest == at {
            let flat = neighbors().all(|next| values[next] == values[at]);
            return Err(Stuck { cell: at, value: values[at], flat });
        }
        at = lowest;
        cells.push(at);
    }
    Ok(cells)
}
