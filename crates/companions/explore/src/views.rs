//! Predicted readings of a sensor on a map: the cells that its rays cross.

use super::sight::Edges;
use super::survey::Survey;
use cplan_geometry::{Point, Vector};
use cplan_world::{Occupancy, Sensor};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Radius of a disc that contains a cell, in units of a cell's side. It is larger than half a diagonal, to allow for
/// rounding.
pub(super) const CELL_RADIUS: f64 = 0.75;

/// Allowance for the rounding of distances, in cells.
const DISTANCE_SLACK: f64 = 1e-6;

/// Position of a sensor, and the angle of its forward direction in radians, as from [`Sensor::pose`].
pub type SensorPose = (Point, f64);

/// Cells of a map by rows, from the top. Each row has its index, and its columns in ascending order. Rows without cells
/// are omitted.
pub type CellsByRow = Vec<(usize, Vec<usize>)>;

/// Returns the rows that have at least one column.
fn rows(height: usize, columns: impl Fn(usize) -> Vec<usize>) -> CellsByRow {
    (0..height).map(|row| (row, columns(row))).filter(|(_, columns)| !columns.is_empty()).collect()
}

/// A cell that a ray crosses.
pub(super) struct Crossing {
    pub cell: usize,
    /// Distance at which the ray enters it, metres.
    pub enters: f64,
}

impl Survey {
    /// Iterates, in order, over the cells that a ray crosses from side to side within the range of the sensor
    /// (Amanatides, Woo 1987).
    pub(super) fn crossings(&self, from: Point, angle: f64, range: f64) -> impl Iterator<Item = Crossing> + use<> {
        let cell = self.known.resolution;
        let (size, local) = (self.known.size, (from - self.origin()) / cell);
        let ahead = [angle.cos(), angle.sin()];
        let step = ahead.map(|d| if d > 0.0 { 1_i64 } else { -1 });
        // Distance along the ray from one side of a cell to the next, for each axis.
        let across = ahead.map(|d| cell / d.abs());
        let mut at = [local.x, local.y].map(|v| v.floor() as i64);
        let mut next = [0, 1].map(|k| {
            let to_side = if step[k] > 0 { at[k] as f64 + 1.0 - local[k] } else { local[k] - at[k] as f64 };
            if ahead[k] == 0.0 { f64::INFINITY } else { to_side * across[k] }
        });
        let mut enters = 0.0;
        std::iter::from_fn(move || {
            let inside = (0..2).all(|k| 0 <= at[k] && at[k] < size[k] as i64);
            let k = usize::from(next[1] < next[0]);
            let leaves = next[k];
            if !inside || leaves > range {
                return None;
            }
            let crossing = Crossing { cell: (size[1] - 1 - at[1] as usize) * size[0] + at[0] as usize, enters };
            enters = leaves;
            at[k] += step[k];
            next[k] += across[k];
            Some(crossing)
        })
    }

    /// Returns an unknown cell that a reading would show. `None` if it would show nothing new. If `edges` are given,
    /// traces only rays that may reach an unknown cell.
    pub fn reachable_unknown(&self, sensor: &Sensor, sensor_pose: SensorPose, edges: Option<&Edges>) -> Option<usize> {
        match edges {
            Some(edges) if self.cell_at(sensor_pose.0).is_none_or(|cell| !edges.may_be_seen_from(cell)) => None,
            Some(edges) => self.first_towards(sensor, sensor_pose, &edges.rows, |_| true),
            None => self.first_unknown(sensor, sensor_pose).next(),
        }
    }

    /// Returns true if one of the `wanted` cells is the first unknown cell of some ray of a reading.
    pub fn shows_any(&self, sensor: &Sensor, sensor_pose: SensorPose, wanted: &CellsByRow) -> bool {
        let width = self.known.size[0];
        let is_wanted = |cell: usize| {
            let row = wanted.binary_search_by_key(&(cell / width), |(row, _)| *row);
            row.is_ok_and(|row| wanted[row].1.binary_search(&(cell % width)).is_ok())
        };
        self.first_towards(sensor, sensor_pose, wanted, is_wanted).is_some()
    }

    /// Returns the first unknown cell of a ray for which `is_asked` is true. Traces only rays that may cross one of the
    /// given cells. If the sensor itself is in an unknown cell, traces all rays.
    fn first_towards(
        &self,
        sensor: &Sensor,
        sensor_pose @ (from, ahead): SensorPose,
        cells: &CellsByRow,
        is_asked: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        if self.cell_at(from).is_some_and(|cell| self.is_unknown(cell)) {
            return self.first_unknown(sensor, sensor_pose).find(|&cell| is_asked(cell));
        }
        let mut is_tried = vec![false; sensor.rays];
        self.near(cells, from, sensor.range).find_map(|cell| {
            let mut rays = self.rays_to(sensor, from, ahead, cell);
            rays.find_map(|ray| {
                let is_new = !std::mem::replace(&mut is_tried[ray], true);
                let mut view = self.crossings(from, sensor.ray(ahead, ray), sensor.range).map(|crossing| crossing.cell);
                let first = is_new.then(|| view.find(|&cell| self.known.cells[cell] != Occupancy::Free)).flatten();
                first.filter(|&cell| self.is_unknown(cell) && is_asked(cell))
            })
        })
    }

    /// Groups cells by row.
    pub fn by_rows(&self, cells: &BTreeSet<usize>) -> CellsByRow {
        let width = self.known.size[0];
        rows(self.known.size[1], |y| cells.range(y * width..(y + 1) * width).map(|cell| cell % width).collect())
    }

    /// Iterates over the indices of the rays that may cross a cell.
    fn rays_to(&self, sensor: &Sensor, from: Point, ahead: f64, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let [width, height] = self.known.size;
        let middle = Vector::new((cell % width) as f64 + 0.5, (height - 1 - cell / width) as f64 + 0.5);
        let direction = middle - (from - self.origin()) / self.known.resolution;
        let sine = CELL_RADIUS / direction.norm();
        sensor.rays_about(ahead, direction.y.atan2(direction.x), if sine < 1.0 { sine.asin() } else { PI })
    }

    /// Iterates over the first unknown cell of each ray of a reading. Skips rays that end at an occupied cell before
    /// that.
    fn first_unknown(&self, sensor: &Sensor, sensor_pose: SensorPose) -> impl Iterator<Item = usize> {
        self.views(sensor, sensor_pose).filter_map(|mut view| {
            let first = view.find(|&cell| self.known.cells[cell] != Occupancy::Free);
            first.filter(|&cell| self.is_unknown(cell))
        })
    }

    /// Returns the unknown cells that rays of a reading reach first, ascending.
    pub fn first_unknown_cells(&self, sensor: &Sensor, sensor_pose: SensorPose) -> Vec<usize> {
        let mut cells: Vec<usize> = self.first_unknown(sensor, sensor_pose).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// Returns true if the rays of a reading cross all given cells before any known obstacle.
    pub fn shows_all(&self, sensor: &Sensor, (from, ahead): SensorPose, cells: &[usize]) -> bool {
        cells.iter().all(|&wanted| {
            self.rays_to(sensor, from, ahead, wanted).any(|ray| {
                let view = self.crossings(from, sensor.ray(ahead, ray), sensor.range).map(|crossing| crossing.cell);
                view.take_while(|&cell| self.known.cells[cell] != Occupancy::Occupied).any(|cell| cell == wanted)
            })
        })
    }

    /// Iterates over the unknown cells that the rays of a reading cross before known obstacles. A cell can occur more
    /// than once.
    pub fn visible_unknown(&self, sensor: &Sensor, sensor_pose: SensorPose) -> impl Iterator<Item = usize> {
        let open = |&cell: &usize| self.known.cells[cell] != Occupancy::Occupied;
        self.views(sensor, sensor_pose)
            .flat_map(move |view| view.take_while(open))
            .filter(|&cell| self.is_unknown(cell))
    }

    /// Returns the cells that each ray of a reading crosses.
    fn views(
        &self,
        sensor: &Sensor,
        (from, ahead): SensorPose,
    ) -> impl Iterator<Item = impl Iterator<Item = usize> + use<>> {
        let range = sensor.range;
        sensor.rays(ahead).map(move |angle| self.crossings(from, angle, range).map(|crossing| crossing.cell))
    }

    /// Returns the unknown cells that share a side with a free one.
    pub(super) fn edges(&self) -> CellsByRow {
        let [width, height] = self.known.size;
        let is = |x: usize, y: usize, label| self.known.cells[y * width + x] == label;
        let is_edge = |x: usize, y: usize| {
            let is_free = |x: usize, y: usize| x < width && y < height && is(x, y, Occupancy::Free);
            is(x, y, Occupancy::Unknown)
                && (is_free(x.wrapping_sub(1), y)
                    || is_free(x + 1, y)
                    || is_free(x, y.wrapping_sub(1))
                    || is_free(x, y + 1))
        };
        rows(height, |y| (0..width).filter(|&x| is_edge(x, y)).collect())
    }

    /// Iterates over the given cells that lie within a range of a point, up to rounding.
    fn near<'a>(&self, cells: &'a CellsByRow, point: Point, range: f64) -> impl Iterator<Item = usize> + use<'a> {
        let local = (point - self.origin()) / self.known.resolution;
        let [width, height] = self.known.size;
        let (x, y) = (local.x, height as f64 - local.y);
        let range = range / self.known.resolution + DISTANCE_SLACK;
        let [above, below] =
            [y - range - 1.0, y + range].map(|y| cells.partition_point(|(row, _)| (*row as f64) < y.ceil()));
        cells[above..below].iter().flat_map(move |(row, columns)| {
            let off = (*row as f64 - y).max(y - (*row + 1) as f64).max(0.0);
            let half = (range.powi(2) - off.powi(2)).max(0.0).sqrt();
            let first = columns.partition_point(|&column| (column as f64 + 1.0) < x - half);
            let near = columns[first..].iter().take_while(move |&&column| column as f64 <= x + half);
            near.map(move |column| row * width + column)
        })
    }
}
