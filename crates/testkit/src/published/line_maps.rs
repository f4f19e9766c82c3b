//! The worlds of published line maps as domains of cells that reproduce the published counts.

use crate::root;
use cplan::field::{Boundary, Cell, Domain, Levels};
use cplan::geometry::Point;
use cplan::input::{Overrides, load_scene};
use cplan::model::{MotionProblem, Obstacle, Preference, Region, Shape};
use std::error::Error;

/// A line map with a goal and preferences, in millimetres as in the source, for division into cells.
pub struct Scene {
    /// Lower left and upper right corner.
    bounds: [Point; 2],
    /// The walls as segments.
    lines: Vec<[Point; 2]>,
    /// Lower left and upper right corner of the goal.
    goal: [Point; 2],
    /// The corners of each preference, and its epsilon.
    rectangles: Vec<([Point; 2], f64)>,
}

impl Scene {
    /// Reads a world of `workspaces/maps`, in which the gantry's limits are the bounds of the map. Leaves out the
    /// obstacle `without`.
    ///
    /// # Errors
    /// Defects of the files, and a preference that is not a region of the tip.
    pub fn read(world: &str, without: Option<&str>) -> Result<Self, Box<dyn Error>> {
        let world = root().join("workspaces/maps").join(world).with_extension("toml");
        let loaded = load_scene(root().join("robots/room_gantry.urdf"), &world)?;
        let problem = loaded.problem(&Overrides::default())?.problem;
        let workspace = problem.scene().workspace();
        let obstacles = workspace.obstacles.iter().filter(|obstacle| Some(&*obstacle.name) != without);
        let rectangles = workspace.preferences.iter().map(rectangle).collect::<Option<_>>();
        Ok(Self {
            bounds: bounds(&problem),
            lines: obstacles.flat_map(segments).collect(),
            // The gantry's joints are coordinates of its tip.
            goal: hull(problem.goals().pieces().iter().flat_map(|piece| piece.ends())),
            rectangles: rectangles.ok_or("a preference is no region of the tip")?,
        })
    }

    /// Returns `n x n` cells. The first index is that of `x`, the second that of `y`, both ascending. Walls are the cells of the
    /// lines and the outermost cells. The goal, which may be on a wall, has all cells from that of its lower left corner to that
    /// of its upper right one.
    pub fn domain(&self, n: usize) -> Domain {
        let mut kinds = vec![Cell::Free; n * n];
        for &[a, b] in &self.lines {
            for [x, y] in line(cell_of(a, self.bounds, n), cell_of(b, self.bounds, n)) {
                kinds[x * n + y] = Cell::Obstacle;
            }
        }
        for k in 0..n {
            for cell in [k, (n - 1) * n + k, k * n, k * n + n - 1] {
                kinds[cell] = Cell::Obstacle;
            }
        }
        let [low, high] = self.goal.map(|corner| cell_of(corner, self.bounds, n));
        for x in low[0]..=high[0] {
            kinds[x * n + low[1]..=x * n + high[1]].fill(Cell::Goal);
        }
        Domain::new([n, n], kinds, [Boundary::High; 2], Levels::PUBLISHED)
    }

    /// Returns the epsilon of each cell. Later rectangles of the world overwrite earlier ones. As the published counts show, the
    /// cell of the upper right corner does not belong to a rectangle, in contrast to a goal.
    pub fn epsilon(&self, n: usize) -> Vec<f64> {
        let mut epsilon = vec![0.0; n * n];
        for (rectangle, strength) in &self.rectangles {
            let [low, high] = rectangle.map(|corner| cell_of(corner, self.bounds, n));
            for x in low[0]..high[0] {
                epsilon[x * n + low[1]..x * n + high[1]].fill(*strength);
            }
        }
        epsilon
    }
}

/// Converts a point from metres to millimetres, without the rounding errors of metres.
fn millimetres(point: Point) -> Point {
    point.map(|metres| (1000.0 * metres).round())
}

fn bounds(problem: &MotionProblem) -> [Point; 2] {
    let [x, y] = problem.scene().arm().topology().ranges.map(|range| range.domain());
    [Point::new(x.0, y.0), Point::new(x.1, y.1)].map(millimetres)
}

/// Returns the segments of a wall; none unless the obstacle is a polyline.
fn segments(obstacle: &Obstacle) -> Vec<[Point; 2]> {
    match &obstacle.shape {
        Shape::Polyline(points) => points.windows(2).map(|ends| [ends[0], ends[1]].map(millimetres)).collect(),
        _ => Vec::new(),
    }
}

fn rectangle(preference: &Preference) -> Option<([Point; 2], f64)> {
    match &preference.region {
        Region::Tip(polygon) => Some((hull(polygon.corners().iter().copied()), preference.epsilon)),
        Region::Configurations(_) => None,
    }
}

/// Returns the lower left and the upper right corner of the bounding box.
fn hull(points: impl Iterator<Item = Point>) -> [Point; 2] {
    let none = [Point::new(f64::INFINITY, f64::INFINITY), Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY)];
    points.map(millimetres).fold(none, |[low, high], point| [low.inf(&point), high.sup(&point)])
}

/// Returns the cell of a point, `floor((x - min) / (max - min) n)`, or the last cell at the upper bound.
fn cell_of(point: Point, [low, high]: [Point; 2], n: usize) -> [usize; 2] {
    let along = |at: f64, low: f64, high: f64| (((at - low) / (high - low) * n as f64) as usize).min(n - 1);
    [along(point.x, low.x, high.x), along(point.y, low.y, high.y)]
}

/// Returns the cells of a line, including both ends (Bresenham 1965).
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
