//! The cells of a map from which an unknown cell may be visible. Rays need not be traced from any other cell.

use super::survey::Survey;
use super::views::CellsByRow;
use cplan_world::Occupancy;
use std::f64::consts::SQRT_2;

/// The unknown cells next to free ones, and the cells from which a ray may reach one of them.
#[derive(Debug)]
pub struct Edges {
    pub rows: CellsByRow,
    /// For each cell, true if a ray from it may reach an unknown cell, or if the cell is itself unknown.
    within_sight: Vec<bool>,
}

/// Represents a cell from which no path leads to an unknown cell.
const NO_EDGE: u32 = u32::MAX;

impl Edges {
    /// Computes the cells for the current map and for rays no longer than `range`.
    ///
    /// A ray moves from cell to cell through free cells, and always crosses the same two of the four sides. If no path
    /// of this kind leads from a cell to an unknown one, then no ray does. Linear in the number of cells.
    pub fn new(survey: &Survey, range: f64) -> Self {
        let rows = survey.edges();
        let known = &survey.map().cells;
        let [width, height] = survey.map().size;
        // Largest number of sides that a ray crosses. Along each axis, this is one more than the whole cells within the
        // range, and one for rounding.
        let most_sides = (range / survey.map().resolution * SQRT_2 + 3.0).min(f64::from(NO_EDGE - 1)) as u32;
        let mut is_edge = vec![false; known.len()];
        rows.iter().for_each(|(row, columns)| columns.iter().for_each(|column| is_edge[row * width + column] = true));
        let mut within_sight: Vec<bool> = known.iter().map(|&cell| cell == Occupancy::Unknown).collect();
        // For each column, the number of sides between a cell of the previous row and the nearest unknown cell. Then
        // the same for the current row.
        let mut sides = vec![NO_EDGE; width];
        for (is_down, is_right) in [(false, false), (false, true), (true, false), (true, true)] {
            sides.fill(NO_EDGE);
            for row in (0..height).map(|k| if is_down { height - 1 - k } else { k }) {
                let mut beside = NO_EDGE;
                for column in (0..width).map(|k| if is_right { width - 1 - k } else { k }) {
                    let cell = row * width + column;
                    beside = match known[cell] {
                        Occupancy::Free => beside.min(sides[column]).saturating_add(1),
                        _ if is_edge[cell] => 0,
                        _ => NO_EDGE,
                    };
                    sides[column] = beside;
                    within_sight[cell] |= beside <= most_sides;
                }
            }
        }
        Self { rows, within_sight }
    }

    /// Returns true if a ray from a cell may reach an unknown cell.
    pub fn may_be_seen_from(&self, cell: usize) -> bool {
        self.within_sight[cell]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::Point;
    use cplan_model::space::SplitMix64;
    use cplan_model::{Arm, Scene, Workspace};
    use cplan_world::Sensor;
    use proptest::prelude::*;

    /// Returns a map around an arm, and a sensor. `label` determines each cell by its column and row.
    fn survey(label: impl Fn(usize, usize) -> Occupancy) -> (Survey, Sensor) {
        let arm = Arm::rr([1.0, 0.5], 0.05).expect("a good arm");
        let sensor = Sensor { cell: 0.1, range: 0.8, rays: 90, ..Sensor::default_for(&arm) };
        let scene = Scene::new(arm, Workspace::new([])).expect("a good scene");
        let mut survey = Survey::new(&scene, sensor.cell).expect("few cells");
        let width = survey.known.size[0];
        for cell in 0..survey.known.cells.len() {
            survey.known.cells[cell] = label(cell % width, cell / width);
        }
        (survey, sensor)
    }

    #[test]
    fn hidden_or_distant_cells_are_not_visible() {
        // From the left: free, a wall, free, unknown.
        let (survey, sensor) = survey(|x, _| match x {
            5 => Occupancy::Occupied,
            x if x < 25 => Occupancy::Free,
            _ => Occupancy::Unknown,
        });
        let edges = Edges::new(&survey, sensor.range);
        let [width, height] = survey.known.size;
        for (row, x) in (0..height).flat_map(|row| (0..width).map(move |x| (row, x))) {
            // From a distance, at most 8 cells along and 8 across, even if that is no straight ray.
            let expected = x >= 25 || x > 5 && 25 - x <= 14;
            assert_eq!(edges.may_be_seen_from(row * width + x), expected, "{x} in row {row}");
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(96))]

        /// Compares the result with tracing all rays.
        #[test]
        fn cells_seen_by_rays_are_visible(seed: u64, unknown in 0.0..0.1, occupied in 0.0..0.4, cells in 1.0..9.0) {
            let labels = std::cell::RefCell::new(SplitMix64::new(seed));
            let (survey, sensor) = survey(|_, _| match labels.borrow_mut().unit() {
                share if share < unknown => Occupancy::Unknown,
                share if share < unknown + occupied => Occupancy::Occupied,
                _ => Occupancy::Free,
            });
            let mut draws = labels.into_inner();
            let sensor = Sensor { range: cells * sensor.cell, ..sensor };
            let edges = Edges::new(&survey, sensor.range);
            for _ in 0..100 {
                // A point on the map, or slightly outside.
                let at = Point::new(3.6 * draws.unit() - 1.8, 3.6 * draws.unit() - 1.8);
                let sensor_pose = (at, 7.0 * draws.unit() - 3.5);
                let found = survey.reachable_unknown(&sensor, sensor_pose, Some(&edges));
                let all = survey.first_unknown_cells(&sensor, sensor_pose);
                prop_assert_eq!(found.is_some(), !all.is_empty(), "{:?} of {:?} at {:?}", found, all, sensor_pose);
                prop_assert!(found.is_none_or(|found| all.contains(&found)));
            }
        }
    }
}
