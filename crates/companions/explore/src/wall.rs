//! Wall following along the boundary of the known free space.

use super::reach::BlockedMoves;
use cplan_planners::cspace::Grid;

/// A heading, in eighths of a turn from `+q1` towards `+q2`. A wall follower moves only along the axes, so its headings
/// are even.
pub type Heading = usize;

/// A place on a walk along a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// Cell of the grid.
    pub cell: usize,
    /// Heading with which the walk arrives.
    pub heading: Heading,
}

/// Returns true if a free cell touches a blocked cell or the end of the grid, at a side or a corner.
pub fn is_beside_wall(grid: &Grid, cell: usize) -> bool {
    (0..8).any(|heading| is_wall(grid, cell, heading))
}

/// Returns the next place of a walk that keeps the wall to its right (the right-hand rule of mazes, with Moore's
/// neighbours). `None` if there is no wall beside the cell, or no free neighbour.
///
/// The wall is the first blocked neighbour, counted from behind on the right round the front to behind on the left.
/// Places and headings are finitely many, so the walk eventually repeats itself.
pub fn next(grid: &Grid, closed: &BlockedMoves, at: Place) -> Option<Place> {
    let Place { cell, heading } = at;
    let wall = (0..8).map(|turn| (heading + 5 + turn) % 8).find(|&side| is_wall(grid, cell, side))?;
    let ahead = (1..8).map(|turn| (wall + turn) % 8).filter(|side| side.is_multiple_of(2));
    let open =
        |side| neighbor_towards(grid, cell, side).filter(|to| !grid.blocked[*to] && !closed.contains(&[cell, *to]));
    ahead.into_iter().find_map(|heading| open(heading).map(|cell| Place { cell, heading }))
}

fn is_wall(grid: &Grid, cell: usize, side: Heading) -> bool {
    neighbor_towards(grid, cell, side).is_none_or(|beside| grid.blocked[beside])
}

/// Returns the neighbour of a cell in the direction `side`. `None` at the end of the grid.
fn neighbor_towards(grid: &Grid, cell: usize, side: Heading) -> Option<usize> {
    match side {
        0 | 4 => grid.adjacent_cell(cell, 0, side == 0),
        2 | 6 => grid.adjacent_cell(cell, 1, side == 2),
        corner => neighbor_towards(grid, neighbor_towards(grid, cell, corner - 1)?, (corner + 1) % 8),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::{JointRange, Topology};
    use cplan_planners::cspace::Proves;

    /// Parses rows of `.` and `#`, the last row with the least `q2`.
    fn drawn(rows: &[&str], ranges: [JointRange; 2]) -> Grid {
        let (wide, high) = (rows[0].len(), rows.len());
        let at = |i: usize, j: usize| rows[high - 1 - j].as_bytes()[i] == b'#';
        let blocked = (0..wide * high).map(|cell| at(cell / high, cell % high)).collect();
        Grid { topology: Topology::new(ranges), proves: Proves::Sampled, cells: [wide, high], blocked }
    }

    fn limited() -> JointRange {
        JointRange::Interval { lower: 0.0, upper: 1.0 }
    }

    /// Returns columns and rows of the places of a walk, until one of them repeats.
    fn walked_places(grid: &Grid, closed: &BlockedMoves, from: [usize; 2], heading: Heading) -> Vec<[usize; 2]> {
        let high = grid.cells[1];
        let mut at = Place { cell: from[0] * high + from[1], heading };
        let mut seen = Vec::new();
        while let Some(place) = next(grid, closed, at).filter(|place| !seen.contains(place)) {
            seen.push(place);
            at = place;
        }
        seen.into_iter().map(|Place { cell, .. }| [cell / high, cell % high]).collect()
    }

    #[test]
    fn a_room_is_followed_leftwards_and_an_island_rightwards() {
        let grid = drawn(&["....", ".#..", "....", "...."], [limited(); 2]);
        let outer = [[1, 0], [2, 0], [3, 0], [3, 1], [3, 2], [3, 3], [2, 3], [1, 3], [0, 3], [0, 2], [0, 1], [0, 0]];
        assert_eq!(walked_places(&grid, &BlockedMoves::new(), [0, 0], 0), outer);
        let grid = drawn(&[".......", ".......", "...#...", ".......", "......."], [limited(); 2]);
        let around = walked_places(&grid, &BlockedMoves::new(), [3, 1], 4);
        assert_eq!(around, [[2, 1], [2, 2], [2, 3], [3, 3], [4, 3], [4, 2], [4, 1], [3, 1]]);
    }

    #[test]
    fn a_dead_end_is_left_again_and_a_closed_step_is_none() {
        let grid = drawn(&["...", "##."], [limited(); 2]);
        let there_and_back = [[1, 1], [0, 1], [1, 1], [2, 1], [2, 0], [2, 1]];
        assert_eq!(walked_places(&grid, &BlockedMoves::new(), [2, 1], 6), there_and_back);
        // Steps between (1, 1) and (0, 1).
        let closed = BlockedMoves::from([[3, 1], [1, 3]]);
        assert!(!walked_places(&grid, &closed, [2, 1], 6).contains(&[0, 1]));
    }

    #[test]
    fn on_a_circle_a_wall_is_followed_across_the_seam() {
        let grid = drawn(&["....", "....", "####"], [JointRange::Circle, limited()]);
        assert_eq!(walked_places(&grid, &BlockedMoves::new(), [2, 1], 0), [[3, 1], [0, 1], [1, 1], [2, 1]]);
    }

    #[test]
    fn wall_following_needs_a_wall() {
        let grid = drawn(&["...", "...", "..."], [JointRange::Circle; 2]);
        assert!(!is_beside_wall(&grid, 4));
        assert_eq!(next(&grid, &BlockedMoves::new(), Place { cell: 4, heading: 0 }), None);
    }
}
