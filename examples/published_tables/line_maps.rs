//! Line maps and preference files as domains of cells, as the published counts ask for.

use cplan::field::{Boundary, Cell, Domain, Levels};
use cplan::geometry::Point;
use cplan::input::{LineMap, PreferenceMap};

/// A line map and a preference file, ready to be cut into cells.
pub struct Scene {
    /// The walls as segments, with start and goal.
    pub map: LineMap,
    /// Goal and preferences.
    pub preferences: PreferenceMap,
}

impl Scene {
    /// The scene without the last so many lines of its map.
    pub fn without_last_lines(mut self, count: usize) -> Self {
        let kept = self.map.lines.len().saturating_sub(count);
        self.map.lines.truncate(kept);
        self
    }

    /// The scene with goal and preferences scaled by the bounds of the map instead of those of their own file.
    pub fn in_bounds_of_map(mut self) -> Self {
        self.preferences.bounds = self.map.bounds;
        self
    }

    /// `n x n` cells: first index `x`, second `y`, both rising. Walls are the cells of the lines and the outermost ones;
    /// the goal, which may lie on a wall, is all cells from that of its lower left to that of its upper right corner.
    pub fn domain(&self, n: usize) -> Domain {
        let mut kinds = vec![Cell::Free; n * n];
        for &[a, b] in &self.map.lines {
            for [x, y] in line(cell_of(a, self.map.bounds, n), cell_of(b, self.map.bounds, n)) {
                kinds[x * n + y] = Cell::Obstacle;
            }
        }
        for k in 0..n {
            for cell in [k, (n - 1) * n + k, k * n, k * n + n - 1] {
                kinds[cell] = Cell::Obstacle;
            }
        }
        let [low, high] = self.preferences.goal.map(|corner| cell_of(corner, self.preferences.bounds, n));
        for x in low[0]..=high[0] {
            kinds[x * n + low[1]..=x * n + high[1]].fill(Cell::Goal);
        }
        Domain::new([n, n], kinds, [Boundary::High; 2], Levels::PUBLISHED)
    }

    /// The epsilon of each cell; later rectangles of the file overwrite earlier ones. The cell of the upper right corner is
    /// outside, unlike that of a goal: so the published counts say.
    pub fn epsilon(&self, n: usize) -> Vec<f64> {
        let mut epsilon = vec![0.0; n * n];
        for rectangle in &self.preferences.rectangles {
            let [low, high] = rectangle.corners.map(|corner| cell_of(corner, self.preferences.bounds, n));
            for x in low[0]..high[0] {
                epsilon[x * n + low[1]..x * n + high[1]].fill(rectangle.epsilon);
            }
        }
        epsilon
    }
}

/// The cell of a point, `floor((x - min) / (max - min) n)`, and the last one for what lies at the upper bound.
fn cell_of(point: Point, [low, high]: [Point; 2], n: usize) -> [usize; 2] {
    let along = |at: f64, low: f64, high: f64| (((at - low) / (high - low) * n as f64) as usize).min(n - 1);
    [along(point.x, low.x, high.x), along(point.y, low.y, high.y)]
}

/// The cells of a line (Bresenham 1965), both ends included.
fn line(from: [usize; 2], to: [usize; 2]) -> Vec<[usize; 2]> {
    let [dx, dy] = [0, 1].map(|k| from[k].abs_diff(to[k]) as i64);
    let towards = |at: &mut usize, to: usize| if *at < to { *at += 1 } else { *at -= 1 };
    let (mut at, mut error, mut cells) = (from, dx - dy, vec![from]);
    while at != to {
        let twice = 2 * error;
        if twice >= -dy {
            error -= dy;
            towards(&mut at[0], to[0]);
        }
        if twice <= dx {
            error += dx;
            towards(&mut at[1], to[1]);
        }
        cells.push(at);
    }
    cells
}
