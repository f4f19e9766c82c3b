//! Figures of wavefronts and potential fields, on small grids.

use super::Sketch;
use cplan::Point;
use cplan::view::Frame;
use cplan::view::figure::{Figure, Item, Raster, Style};
use cplan_theme::{ACCENT, GRAY, INFEASIBLE, INK, PALE, ROBOT, WHITE, scale};

/// The grid of the wavefront: `#` is an obstacle, `S` the start, and `G` the goal.
const ROOM: [&str; 6] = [
    "..............", //
    "..##....####..",
    "..##......##.G",
    "S.####....##..",
    "....##..####..",
    "..............",
];
/// The grid of the fields.
const TRAP: [&str; 12] = [
    "............................",
    "............................",
    "................####........",
    "...................#........",
    "...................#........",
    "...................#........",
    "...S...............#.....G..",
    "...................#........",
    "...................#........",
    "................####........",
    "............................",
    "............................",
];
/// Number of shades of a field.
const SHADES: usize = 9;

/// Cells of a grid, row by row from above.
struct Grid {
    columns: usize,
    rows: usize,
    is_blocked: Vec<bool>,
    start: usize,
    goal: usize,
}

impl Grid {
    fn new(rows: &[&str]) -> Self {
        let all: Vec<char> = rows.iter().flat_map(|row| row.chars()).collect();
        let at = |c: char| all.iter().position(|other| *other == c).expect("the grid has both ends");
        let is_blocked = all.iter().map(|c| *c == '#').collect();
        Self { columns: all.len() / rows.len(), rows: rows.len(), is_blocked, start: at('S'), goal: at('G') }
    }

    /// Returns the neighbours of a cell along the axes: right, left, below, above.
    fn neighbors(&self, cell: usize) -> Vec<usize> {
        let (i, j) = (cell % self.columns, cell / self.columns);
        let mut all = Vec::new();
        all.extend((i + 1 < self.columns).then_some(cell + 1));
        all.extend((i > 0).then(|| cell - 1));
        all.extend((j + 1 < self.rows).then_some(cell + self.columns));
        all.extend((j > 0).then(|| cell - self.columns));
        all
    }

    fn free_neighbors(&self, cell: usize) -> impl Iterator<Item = usize> {
        self.neighbors(cell).into_iter().filter(|&other| !self.is_blocked[other])
    }

    fn middle(&self, cell: usize) -> Point {
        Point::new((cell % self.columns) as f64 + 0.5, (self.rows - cell / self.columns) as f64 - 0.5)
    }

    /// Returns the lower left and the upper right corner of a cell.
    fn corners(&self, cell: usize) -> [Point; 2] {
        [-0.5, 0.5].map(|by| self.middle(cell) + Point::new(by, by))
    }

    /// Returns the number of moves from the goal to each cell.
    fn moves(&self) -> Vec<Option<usize>> {
        let mut labels = vec![None; self.is_blocked.len()];
        labels[self.goal] = Some(0);
        let (mut front, mut count) = (vec![self.goal], 0);
        while !front.is_empty() {
            count += 1;
            let mut next = Vec::new();
            for cell in front.into_iter().flat_map(|cell| self.free_neighbors(cell).collect::<Vec<_>>()) {
                if labels[cell].is_none() {
                    labels[cell] = Some(count);
                    next.push(cell);
                }
            }
            front = next;
        }
        labels
    }

    /// Returns the cells of a descent from the start to a cell without a lower neighbour.
    fn descent(&self, value: impl Fn(usize) -> f64) -> Vec<usize> {
        let mut path = vec![self.start];
        while let Some(next) = self.free_neighbors(path[path.len() - 1]).min_by(|&a, &b| value(a).total_cmp(&value(b)))
        {
            if value(next) >= value(path[path.len() - 1]) {
                break;
            }
            path.push(next);
        }
        path
    }

    fn frame(&self) -> Frame {
        Sketch::frame([10.0, 8.0, 700.0, 300.0], (0.0, self.columns as f64), (0.0, self.rows as f64))
    }

    /// Draws obstacles, and the lines between cells.
    fn draw(&self, sketch: &mut Sketch, frame: &Frame) {
        let (width, height) = (self.columns as f64, self.rows as f64);
        let upright = (0..=self.columns).map(|i| [Point::new(i as f64, 0.0), Point::new(i as f64, height)]);
        let level = (0..=self.rows).map(|j| [Point::new(0.0, j as f64), Point::new(width, j as f64)]);
        sketch.segments(frame, &upright.chain(level).collect::<Vec<_>>(), Style::line(PALE, 0.6));
        let blocked = (0..self.is_blocked.len()).filter(|&cell| self.is_blocked[cell]);
        sketch.rectangles(frame, &blocked.map(|cell| self.corners(cell)).collect::<Vec<_>>(), Style::fill(ROBOT));
    }

    fn path(&self, sketch: &mut Sketch, frame: &Frame, cells: &[usize]) {
        sketch.path(frame, &cells.iter().map(|&cell| self.middle(cell)).collect::<Vec<_>>());
    }

    /// Draws the values of free cells in shades: `SHADES` groups of equal size. The lowest values are the lightest.
    fn shade(&self, sketch: &mut Sketch, frame: &Frame, values: &[f64]) {
        let mut order: Vec<usize> = (0..values.len()).filter(|&cell| !self.is_blocked[cell]).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let mut levels = vec![None; values.len()];
        for (rank, &cell) in order.iter().enumerate() {
            // Columns from left to right, each from the bottom up.
            let (i, j) = (cell % self.columns, self.rows - 1 - cell / self.columns);
            levels[i * self.rows + j] = Some(rank * SHADES / order.len());
        }
        let palette = (0..SHADES).map(|k| scale(0.75 * k as f64 / SHADES as f64).lighter(0.25)).collect();
        sketch.items.push(Item::Raster(Raster { rect: frame.rect, cells: [self.columns, self.rows], palette, levels }));
        let blocked = (0..values.len()).filter(|&cell| self.is_blocked[cell]);
        sketch.rectangles(frame, &blocked.map(|cell| self.corners(cell)).collect::<Vec<_>>(), Style::fill(INK));
    }

    fn ends(&self, sketch: &mut Sketch, frame: &Frame) {
        sketch.dot(frame, self.middle(self.start), 6.0, Style::line(INK, 2.2).filled(WHITE));
        sketch.dot(frame, self.middle(self.goal), 6.0, Style::line(WHITE, 1.2).filled(INK));
    }
}

/// Draws the labels of a wavefront, and a path along decreasing labels.
pub fn wave() -> Figure {
    let grid = Grid::new(&ROOM);
    let mut sketch = Sketch::new(340.0);
    let frame = grid.frame();
    let labels = grid.moves();
    grid.draw(&mut sketch, &frame);
    let path = grid.descent(|cell| labels[cell].map_or(f64::INFINITY, |count| count as f64));
    let boxes: Vec<[Point; 2]> = path.iter().map(|&cell| grid.corners(cell)).collect();
    sketch.rectangles(&frame, &boxes, Style::fill(ACCENT.lighter(0.75)));
    for (cell, count) in labels.iter().enumerate() {
        let (Some(count), p) = (count, grid.middle(cell)) else { continue };
        let [x, y] = frame.at(p.x, p.y);
        sketch.text([x, y + 5.0], count.to_string(), if path.contains(&cell) { INK } else { GRAY });
    }
    sketch.note(
        10.0,
        "Each label is the number of moves to the goal (0). From the start, every step leads to a smaller one.",
    );
    sketch.figure()
}

/// Draws the cells that A* expands on the same grid.
pub fn astar() -> Figure {
    let grid = Grid::new(&ROOM);
    let mut sketch = Sketch::new(340.0);
    let frame = grid.frame();
    let distance = |cell: usize| {
        let by = grid.middle(cell) - grid.middle(grid.goal);
        (by.x.abs() + by.y.abs()).round() as usize
    };
    let mut lengths = vec![usize::MAX; grid.is_blocked.len()];
    let mut before = vec![usize::MAX; lengths.len()];
    let mut expanded = Vec::new();
    let mut open = vec![grid.start];
    lengths[grid.start] = 0;
    // The open cell with the least estimate; of equals, the one nearest to the goal, then the first.
    while let Some(at) =
        (0..open.len()).min_by_key(|&k| (lengths[open[k]] + distance(open[k]), distance(open[k]), open[k]))
    {
        let cell = open.swap_remove(at);
        expanded.push(cell);
        if cell == grid.goal {
            break;
        }
        for next in grid.free_neighbors(cell) {
            if lengths[cell] + 1 < lengths[next] {
                (lengths[next], before[next]) = (lengths[cell] + 1, cell);
                open.push(next);
            }
        }
    }
    let boxes = |cells: &[usize]| cells.iter().map(|&cell| grid.corners(cell)).collect::<Vec<_>>();
    sketch.rectangles(&frame, &boxes(&expanded), Style::fill(ACCENT.lighter(0.75)));
    grid.draw(&mut sketch, &frame);
    let mut path = vec![grid.goal];
    while before[path[path.len() - 1]] != usize::MAX {
        path.push(before[path[path.len() - 1]]);
    }
    grid.path(&mut sketch, &frame, &path);
    grid.ends(&mut sketch, &frame);
    let free = grid.is_blocked.iter().filter(|is_blocked| !**is_blocked).count();
    sketch.note(
        10.0,
        &format!("A* from the start (ring) expands the {} blue ones of {free} free cells.", expanded.len()),
    );
    sketch.figure()
}

/// Draws the sum of attraction and repulsion, and the descent into its local minimum.
pub fn minimum() -> Figure {
    let grid = Grid::new(&TRAP);
    let blocked: Vec<Point> =
        (0..grid.is_blocked.len()).filter(|&cell| grid.is_blocked[cell]).map(|cell| grid.middle(cell)).collect();
    let value = |cell: usize| {
        let p = grid.middle(cell);
        let repulsion = |other: &Point| 0.6 / (p - other).norm();
        (p - grid.middle(grid.goal)).norm() + blocked.iter().map(repulsion).sum::<f64>()
    };
    let values: Vec<f64> = (0..grid.is_blocked.len()).map(value).collect();
    let path = grid.descent(|cell| values[cell]);
    let mut sketch = Sketch::new(340.0);
    let frame = grid.frame();
    grid.shade(&mut sketch, &frame, &values);
    grid.path(&mut sketch, &frame, &path);
    grid.ends(&mut sketch, &frame);
    let end = grid.middle(path[path.len() - 1]);
    sketch.dot(&frame, end, 6.0, Style::line(WHITE, 1.4).filled(INFEASIBLE));
    sketch.note(
        10.0,
        "Attraction and repulsion: the descent ends in a local minimum (red) before the wall. Darker is higher.",
    );
    sketch.figure()
}

/// Draws the harmonic potential of the same grid, and the descent to the goal.
pub fn harmonic() -> Figure {
    const SWEEPS: usize = 4000;
    let grid = Grid::new(&TRAP);
    let mut values = vec![1.0; grid.is_blocked.len()];
    values[grid.goal] = 0.0;
    for _ in 0..SWEEPS {
        for cell in (0..values.len()).filter(|&cell| !grid.is_blocked[cell] && cell != grid.goal) {
            // Cells beyond the grid count as obstacles.
            let around = grid.neighbors(cell);
            let sum: f64 = around.iter().map(|&other| values[other]).sum();
            values[cell] = (sum + (4 - around.len()) as f64) / 4.0;
        }
    }
    let path = grid.descent(|cell| values[cell]);
    let mut sketch = Sketch::new(340.0);
    let frame = grid.frame();
    grid.shade(&mut sketch, &frame, &values);
    grid.path(&mut sketch, &frame, &path);
    grid.ends(&mut sketch, &frame);
    sketch.note(
        10.0,
        "Harmonic: each value is the mean of its neighbours, so only the goal is a minimum. Darker is higher.",
    );
    sketch.figure()
}
