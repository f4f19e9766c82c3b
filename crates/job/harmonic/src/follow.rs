//! Follows a field along its gradient, as a curve that is not bound to the centres of cells.
//!
//! [`follow`] works with any [`Guide`]: the harmonic potential, a relaxed field, or forces. A guide gives the direction at the
//! centres of free cells; for a potential, it is the gradient of the logarithm, by central differences. `follow` interpolates it
//! bilinearly, and integrates by the fourth-order Runge-Kutta method, in steps of a fifth of a cell.
//!
//! If the curve does not reach a better cell within about four cells (at a saddle, or in a corridor one cell wide), the guide
//! gives the next cells. So the curve reaches a goal whenever a path from cell to cell does.

use cplan_interrupt::checkpoint;
use cplan_planners::planner::grid_path::Place;

/// A point in units of cells. Centres of cells have integer coordinates.
pub type LatticePoint = [f64; 2];

/// Length of a step, in cells. Within a step, the interpolated direction changes little, and the error of the integrator is far
/// below that of the field.
pub const STEP_LENGTH: f64 = 0.2;

/// Number of steps within which the curve must reach a better cell: about four cells.
const PROGRESS_WINDOW: usize = 20;

/// A field on the cells of a lattice, given by the direction to follow.
pub trait Guide {
    /// Reasons why a curve ends without reaching a goal.
    type DeadEnd;

    /// Returns the gradient at the centre of a cell, per cell along each axis, in any unit. Returns `None` for goals
    /// and for cells that are not free.
    ///
    /// The curve interpolates between the gradients of neighbouring cells, so longer gradients have more weight. For
    /// values that fall fast, use the gradient of the logarithm.
    fn slope(&self, place: Place) -> Option<[f64; 2]>;

    /// Returns true if a cell is a goal.
    fn is_goal(&self, place: Place) -> bool;

    /// Returns true if a move from one cell to the other is progress. It may return true only finitely often.
    fn is_progress(&mut self, from: Place, to: Place) -> bool;

    /// Returns the cells that lead from a cell to a better one. Each is free, and a neighbour of the previous one.
    ///
    /// # Errors
    /// Returns the reason why no such cells exist.
    fn next_cells(&mut self, from: Place) -> Result<Vec<Place>, Self::DeadEnd>;
}

/// A curve along a field, and the goal that it reaches.
#[derive(Debug, Clone, PartialEq)]
pub struct Streamline {
    /// Points of the curve, from the given point to a point in the goal's cell. Consecutive points are at most
    /// [`STEP_LENGTH`] apart, except where the field has no direction.
    pub points: Vec<LatticePoint>,
    /// Cell of the goal.
    pub place: Place,
}

/// Follows a field from a point in a free cell to a goal's cell, along the guide's gradient. `sides` are the side lengths of a
/// cell. Takes a few microseconds per cell. The gradient is interpolated bilinearly between the centres of free cells, and
/// integrated by the classical fourth-order Runge-Kutta method in steps of [`STEP_LENGTH`]. Beside walls, only the centres of
/// free cells count, which leads the curve away from walls. A step that would still leave the free cells slides along their
/// sides. Where the curve makes no progress (at a saddle, or in a narrow bend), it moves to a better cell by
/// [`Guide::next_cells`]. So the curve stays in free cells, and reaches a goal if the guide's cells lead to one.
///
/// # Errors
/// [`Guide::DeadEnd`] if the guide has no further cells.
pub fn follow<G: Guide>(guide: &mut G, sides: [f64; 2], from: LatticePoint) -> Result<Streamline, G::DeadEnd> {
    let mut points = vec![from];
    // The best cell so far, and the number of points when the curve reached it.
    let mut best = (nearest(from), 1);
    let mut square = Square::new(sides);
    loop {
        checkpoint();
        for _ in 0..PROGRESS_WINDOW {
            let at = points[points.len() - 1];
            if guide.is_goal(nearest(at)) {
                return Ok(Streamline { points, place: nearest(at) });
            }
            let Some(next) = square.step(guide, at) else { break };
            points.push(next);
        }
        let here = nearest(points[points.len() - 1]);
        if guide.is_goal(here) || guide.is_progress(best.0, here) {
            best = (here, points.len());
            continue;
        }
        points.truncate(best.1);
        let onward = guide.next_cells(best.0)?;
        points.extend([best.0].into_iter().chain(onward).map(center));
        best = (nearest(points[points.len() - 1]), points.len());
    }
}

/// Returns the unit direction in which a field is followed at a point. It is interpolated bilinearly between the gradients at the
/// surrounding free cells. Coordinates are in cells, and `sides` are the side lengths of a cell. `None` if none of these cells
/// has a gradient, or if the gradients cancel.
pub fn direction<G: Guide>(guide: &G, sides: [f64; 2], at: LatticePoint) -> Option<[f64; 2]> {
    Square::new(sides).direction(guide, at)
}

/// Advances along a field by a number of steps of [`STEP_LENGTH`], and returns the last point. In contrast to [`follow`], does
/// not check for progress, because it is meant for fields that change over time. Stays in free cells; stops early in a goal's
/// cell, or if no step would stay in free cells.
pub fn advance<G: Guide>(guide: &G, sides: [f64; 2], from: LatticePoint, steps: usize) -> LatticePoint {
    let mut square = Square::new(sides);
    let mut at = from;
    for _ in 0..steps {
        if guide.is_goal(nearest(at)) {
            break;
        }
        let Some(next) = square.step(guide, at) else { break };
        at = next;
    }
    at
}

/// Returns the cell in which a point lies.
fn nearest(at: LatticePoint) -> Place {
    at.map(|x| x.round() as i64)
}

fn center(place: Place) -> LatticePoint {
    place.map(|x| x as f64)
}

/// The gradients at four neighbouring centres, cached between steps. `corner` is the one with the least coordinates.
struct Square {
    /// Factors that convert a gradient per cell to a velocity in cells.
    weights: [f64; 2],
    corner: Option<Place>,
    slopes: [Option<[f64; 2]>; 4],
}

impl Square {
    fn new([a, b]: [f64; 2]) -> Self {
        Self { weights: [b / a, a / b], corner: None, slopes: [None; 4] }
    }

    /// Returns the unit direction at a point. `None` if none of the surrounding centres has a gradient, or if the gradients
    /// cancel.
    fn direction<G: Guide>(&mut self, guide: &G, at: LatticePoint) -> Option<[f64; 2]> {
        let corner = at.map(|x| x.floor() as i64);
        if self.corner != Some(corner) {
            let [i, j] = corner;
            self.slopes = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].map(|place| guide.slope(place));
            self.corner = Some(corner);
        }
        let [u, v] = [0, 1].map(|k| at[k] - corner[k] as f64);
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let mut sum = [0.0; 2];
        for (weight, slope) in weights.into_iter().zip(self.slopes) {
            let slope = slope.unwrap_or_default();
            sum = [0, 1].map(|k| sum[k] + weight * slope[k]);
        }
        let sum = [0, 1].map(|k| self.weights[k] * sum[k]);
        let length = sum[0].hypot(sum[1]);
        (length > 0.0 && length.is_finite()).then(|| sum.map(|x| x / length))
    }

    /// Returns the end of a step. Returns `None` if no direction stays in free cells.
    fn step<G: Guide>(&mut self, guide: &G, at: LatticePoint) -> Option<LatticePoint> {
        let moved = |d: [f64; 2], by: f64| [0, 1].map(|k| at[k] + by * d[k]);
        let a = self.direction(guide, at)?;
        // Beyond the free cells, there may be no direction. Then the previous one is kept.
        let b = self.direction(guide, moved(a, STEP_LENGTH / 2.0)).unwrap_or(a);
        let c = self.direction(guide, moved(b, STEP_LENGTH / 2.0)).unwrap_or(b);
        let d = self.direction(guide, moved(c, STEP_LENGTH)).unwrap_or(c);
        let mean = [0, 1].map(|k| (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0);
        let next = moved(mean, STEP_LENGTH);
        let stays = |to: LatticePoint| {
            let (here, there) = (nearest(at), nearest(to));
            let beside = |place: Place| guide.slope(place).is_some() || guide.is_goal(place);
            // A segment across a corner passes through one of the two cells beside it.
            let is_across = here[0] != there[0] && here[1] != there[1];
            let is_round = !is_across || (beside([here[0], there[1]]) && beside([there[0], here[1]]));
            (beside(there) && is_round).then_some(to)
        };
        // Beside a wall, one coordinate may still change.
        stays(next).or_else(|| {
            let mut slides = [[next[0], at[1]], [at[0], next[1]]];
            slides.sort_by(|p, q| distance(*q, at).total_cmp(&distance(*p, at)));
            slides.into_iter().filter(|&to| to != at).find_map(stays)
        })
    }
}

fn distance(a: LatticePoint, b: LatticePoint) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
