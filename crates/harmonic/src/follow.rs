//! The curve along a field's gradient, between the cells.
//!
//! [`follow`] goes along any [`Guide`]: the harmonic potential ([`Uphill`](crate::Uphill)), a relaxed field, or forces. A guide
//! tells the direction at the centres of free cells (the gradient of the logarithm, by central
//! differences); `follow` interpolates bilinearly and integrates by Runge and Kutta's fourth order in steps of a fifth of
//! a cell. After some four cells the curve must have come to a better cell than before; where it has not (at a saddle, in
//! a corridor one cell wide) the guide names the next cells, and so the promise that the cells lead to the goal is the
//! curve's, too.

use cplan_interrupt::checkpoint;

/// Row and column of a cell on the unbounded lattice: on a circle counted on.
pub type Place = [i64; 2];

/// A point in units of cells; centres of cells are whole numbers.
pub type LatticePoint = [f64; 2];

/// Length of a step, in cells: the direction, interpolated between centres, changes little on the way, and the error of
/// the integrator is far below that of the field.
pub const STEP: f64 = 0.2;

/// Steps after which the way must have come to a better cell than it was in: some four cells.
const WINDOW: usize = 20;

/// A field on the cells of a lattice, by the direction in which it is followed.
pub trait Guide {
    /// What a way may end in other than a goal.
    type Stuck;

    /// The gradient at the centre of a cell, per cell along either axis and in any unit. Neighbours' lengths weigh against
    /// each other, so that they should be those of the logarithm's gradient where values fall fast. None for what is not free, and for
    /// goals, which are not left.
    fn slope(&self, place: Place) -> Option<[f64; 2]>;

    /// Whether a cell is a goal.
    fn is_goal(&self, place: Place) -> bool;

    /// Whether the way has come on from one cell to the other. It may do so only a finite number of times.
    fn comes_on(&mut self, from: Place, to: Place) -> bool;

    /// Cells from one to a better one, each a neighbour of the one before and none but free ones.
    ///
    /// # Errors
    /// Why there is none.
    fn onward(&mut self, from: Place) -> Result<Vec<Place>, Self::Stuck>;
}

/// A curve along a field, and the goal that it comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Streamline {
    /// From the given point to one in the goal's cell, not more than [`STEP`] apart but where the field shows no direction.
    pub points: Vec<LatticePoint>,
    /// Where the goal is.
    pub place: Place,
}

/// Follows a field from a point in a free cell until it is in a goal's: the curve along the guide's gradient, in a space
/// in which cells have the sides `sides`; bilinear between the centres of free cells, by the classical Runge-Kutta method of fourth order in steps of [`STEP`].
///
/// Along walls, where only the free centres count, it leads away from the walls; a step that would leave the free cells
/// all the same slides along their sides. Where it does not come on (at a saddle, in a narrow bend) it goes to a better
/// cell as [`Guide::onward`] says. So it stays in free cells, and ends where the guide's cells do. A few microseconds a cell.
///
/// # Errors
/// [`Guide::Stuck`] where there is no way on.
pub fn follow<G: Guide>(guide: &mut G, sides: [f64; 2], from: LatticePoint) -> Result<Streamline, G::Stuck> {
    let mut points = vec![from];
    // The best cell so far, and how many points there were then.
    let mut best = (nearest(from), 1);
    let mut square = Square::new(sides);
    loop {
        checkpoint();
        for _ in 0..WINDOW {
            let at = points[points.len() - 1];
            if guide.is_goal(nearest(at)) {
                return Ok(Streamline { points, place: nearest(at) });
            }
            let Some(next) = square.step(guide, at) else { break };
            points.push(next);
        }
        let here = nearest(points[points.len() - 1]);
        if guide.is_goal(here) || guide.comes_on(best.0, here) {
            best = (here, points.len());
            continue;
        }
        points.truncate(best.1);
        let onward = guide.onward(best.0)?;
        points.extend([best.0].into_iter().chain(onward).map(center));
        best = (nearest(points[points.len() - 1]), points.len());
    }
}

/// The unit vector along which a field is followed from a point, in cells: bilinear between the gradients at the centres of free
/// cells around it, in a space in which cells have the sides `sides`. None where none of them has a gradient, or all cancel out.
pub fn direction<G: Guide>(guide: &G, sides: [f64; 2], at: LatticePoint) -> Option<[f64; 2]> {
    Square::new(sides).direction(guide, at)
}

/// Where [`follow`] comes to from a point in a free cell in so many steps of [`STEP`], for who goes a little way along a field that
/// is another one in the next moment. It stays in free cells, ends early in a goal's cell, and where there is no step that
/// stays in free cells. Nobody asks whether the way comes on.
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

/// The cell that a point lies in.
fn nearest(at: LatticePoint) -> Place {
    at.map(|x| x.round() as i64)
}

fn center(place: Place) -> LatticePoint {
    place.map(|x| x as f64)
}

/// The directions at four neighbouring centres, the least of them at `corner`; kept from step to step.
struct Square {
    /// What a gradient per cell counts for as a velocity in cells.
    weights: [f64; 2],
    corner: Option<Place>,
    slopes: [Option<[f64; 2]>; 4],
}

impl Square {
    fn new([a, b]: [f64; 2]) -> Self {
        Self { weights: [b / a, a / b], corner: None, slopes: [None; 4] }
    }

    /// The unit direction at a point; none where none of the centres around has one, or all cancel out.
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

    /// The end of a step; none where there is no direction, or none that stays in free cells.
    fn step<G: Guide>(&mut self, guide: &G, at: LatticePoint) -> Option<LatticePoint> {
        let moved = |d: [f64; 2], by: f64| [0, 1].map(|k| at[k] + by * d[k]);
        let a = self.direction(guide, at)?;
        // Beyond the free cells there may be no direction: the one before goes on.
        let b = self.direction(guide, moved(a, STEP / 2.0)).unwrap_or(a);
        let c = self.direction(guide, moved(b, STEP / 2.0)).unwrap_or(b);
        let d = self.direction(guide, moved(c, STEP)).unwrap_or(c);
        let mean = [0, 1].map(|k| (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0);
        let next = moved(mean, STEP);
        let stays = |to: LatticePoint| {
            let (here, there) = (nearest(at), nearest(to));
            let beside = |place: Place| guide.slope(place).is_some() || guide.is_goal(place);
            // A piece across a corner passes one of the two cells beside it.
            let is_across = here[0] != there[0] && here[1] != there[1];
            let is_round = !is_across || (beside([here[0], there[1]]) && beside([there[0], here[1]]));
            (beside(there) && is_round).then_some(to)
        };
        // At the side of a wall one coordinate may still move.
        stays(next).or_else(|| {
            let mut slides = [[next[0], at[1]], [at[0], next[1]]];
            slides.sort_by(|p, q| far(*q, at).total_cmp(&far(*p, at)));
            slides.into_iter().filter(|&to| to != at).find_map(stays)
        })
    }
}

fn far(a: LatticePoint, b: LatticePoint) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
