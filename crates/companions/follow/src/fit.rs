//! Places a line where the arm can follow it with one IK solution.
//!
//! For each IK solution, a grid over the reach has the distance of each cell from the nearest excluded place. At an
//! excluded place, the tip is out of reach, or the solution is outside the limits or collides. The *room* of a
//! placement is the least of these distances along the line. If the line moves, its room changes by at most the length
//! of the move. So branch and bound finds the placement with the most room. The grid proves nothing: [`follow`] judges
//! the placements with the most room, one after the other.

use crate::proof::{Cause, Infeasible};
use crate::{FollowError, Followed, Settings, follow};
use cplan_deviation::{Kinematics, Line, Place};
use cplan_geometry::{Point, Vector};
use cplan_interrupt::checkpoint;
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Outcome, Scene};
use cplan_text::{counted, length};
use cplan_toolpath::{Placement, Toolpath};
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// Number of cells of the grid along the longer side of the reach.
const CELLS: f64 = 192.0;

/// Number of values per joint at which the extent of the reach is sampled.
const REACH_SAMPLES: u32 = 65;

/// Extension of the sampled reach on each side, as a share of its extent, because samples miss its border.
const REACH_MARGIN: f64 = 0.02;

/// Greatest number of points of the line that are compared with the grid.
const MAX_POINTS: usize = 4000;

/// Greatest number of points of a piece. Only pieces that are far larger than the reach would need more.
const MAX_PIECE_POINTS: f64 = 1e5;

/// Size of the smallest boxes of displacements, and accuracy of the room, in cells.
const RESOLUTION: f64 = 0.125;

/// Greatest number of boxes of displacements in one search.
const MAX_BOXES: usize = 50_000;

/// Greatest number of placements that are followed.
const MAX_FOLLOWED: usize = 12;

/// Number of directions in which the width of the line is measured.
const WIDTH_DIRECTIONS: u32 = 180;

/// A line at the place where it was placed.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The chosen placement.
    pub placement: Placement,
    /// The line at this place.
    pub path: Toolpath,
    /// Approximate distance between the line and the nearest place that excludes the IK solution, metres. `None` if no
    /// placement was found.
    pub room: Option<f64>,
    /// The motion along the line; or the reason why the line was not placed.
    pub answer: Followed,
}

/// Searches for a placement of a line at which the arm can follow it without a change of its IK solution. Displacements
/// are free; turns come from a list. Placements far from all excluded places are preferred. The scale of `placement`
/// applies. `progress` is called after each turn. At most twelve placements are followed, so the time is bounded.
///
/// The answer is infeasible only if two points of the line are farther apart than any two places of the tip.
///
/// # Errors
/// Same as for [`follow`].
pub fn fit(
    scene: &Scene,
    path: &Toolpath,
    placement: &Placement,
    turns: &[f64],
    settings: &Settings,
    progress: &mut dyn FnMut(),
) -> Result<Fitted, FollowError> {
    settings.check()?;
    let (kinematics, first) = (Kinematics::new(scene.arm()), turns.first().copied().unwrap_or_default());
    let at = |turn: f64, shift: Vector| Placement { turn, shift: shift.into(), ..*placement };
    let unplaced = |answer: Followed| {
        let placement = at(first, Vector::zeros());
        let path = path.placed(&placement).unwrap_or_else(|_| path.clone());
        Fitted { placement, path, room: None, answer }
    };
    if let Some(infeasible) = too_large(&kinematics, path, placement.scale, settings.tolerance) {
        return Ok(unplaced(Outcome::Infeasible(infeasible)));
    }
    let field = |solution: usize| Field::new(scene, &kinematics, solution);
    let fields: Vec<Field> = (0..if kinematics.has_two_solutions() { 2 } else { 1 }).map(field).collect();
    let points = points(path, fields[0].cell / placement.scale);
    let points: Vec<Point> = points.into_iter().map(|point| point * placement.scale).collect();
    let mut candidates: Vec<Candidate> = Vec::new();
    for &turn in turns {
        let (sin, cos) = turn.sin_cos();
        let turned: Vec<Point> =
            points.iter().map(|p| Point::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos)).collect();
        let own = fields.iter().map(|field| Candidate::new(field, turn, turned.clone()));
        candidates.extend(own);
        progress();
    }
    let mut first_reason = None;
    for followed in 0..MAX_FOLLOWED {
        // Choose another turn only if it gives more room by at least the error of the grid.
        let more = |a: &Candidate, b: &Candidate| b.room > a.room + if a.room > 0.0 { b.field.cell } else { 0.0 };
        let best = candidates.iter_mut().reduce(|a, b| if more(a, b) { b } else { a }).expect("a turn");
        if best.room <= 0.0 {
            let count = |noun: &str| counted(turns.len(), noun);
            let searched = format!("the search tried {}, with cells of {}", count("turn"), length(best.field.cell));
            let why = match first_reason {
                Some(why) => format!("{} tried without success; the first one: {why}", counted(followed, "placement")),
                None => {
                    let by = length(-best.room);
                    format!(
                        "even at the best placement, the line extends about {by} beyond the area that one IK solution reaches"
                    )
                }
            };
            return Ok(unplaced(Outcome::Unknown(format!("no placement was found: {why}; {searched}"))));
        }
        let placement = at(best.turn, best.shift);
        let reason = match path.placed(&placement) {
            Err(error) => error.to_string(),
            Ok(path) => match follow(scene, &path, settings)? {
                Outcome::Found(found) if found.changes.is_empty() => {
                    return Ok(Fitted { placement, path, room: Some(best.room), answer: Outcome::Found(found) });
                }
                Outcome::Found(_) => "the arm would have to change its IK solution".to_owned(),
                Outcome::Infeasible(infeasible) => infeasible.describe(),
                Outcome::Unknown(why) => why,
            },
        };
        let [x, y] = placement.shift;
        first_reason = first_reason.or(Some(format!("moved to {x}, {y} m, {reason}")));
        best.exclude();
    }
    let why = format!(
        "no placement was found: the {MAX_FOLLOWED} placements with the most room were tried without success; the first one: {}",
        first_reason.unwrap_or_default()
    );
    Ok(unplaced(Outcome::Unknown(why)))
}

/// The room of the places of one IK solution.
struct Field {
    /// The corner of the grid with the least coordinates.
    low: Point,
    /// Size of a cell, metres.
    cell: f64,
    size: [usize; 2],
    /// Signed distance of each cell's centre from the border of the excluded places, metres. Negative for excluded cells.
    room: Vec<f64>,
    /// The least and the greatest coordinates of the reach.
    reach: [Point; 2],
}

impl Field {
    fn new(scene: &Scene, kinematics: &Kinematics, solution: usize) -> Self {
        let arm = scene.arm();
        let values = arm.topology().ranges.map(|range| {
            let (lower, upper) = range.domain();
            (0..REACH_SAMPLES).map(move |k| lower + (upper - lower) * f64::from(k) / f64::from(REACH_SAMPLES - 1))
        });
        let [first, second] = values;
        let tips = first.flat_map(|q1| second.clone().map(move |q2| arm.tip_at(Configuration::new(q1, q2))));
        let ends = tips.fold(None, |ends: Option<[Point; 2]>, tip| {
            Some(ends.map_or([tip; 2], |[low, high]| [low.inf(&tip), high.sup(&tip)]))
        });
        let [low, high] = ends.expect("a joint value");
        let margin = (high - low) * REACH_MARGIN;
        let reach = [low - margin, high + margin];
        let extent = reach[1] - reach[0];
        let cell = extent.amax() / CELLS;
        // A ring of excluded cells surrounds the reach.
        let low = reach[0] - Vector::new(cell, cell);
        let size = [0, 1].map(|k| (extent[k] / cell).ceil() as usize + 2);
        let center =
            |index: usize| low + Vector::new((index % size[0]) as f64 + 0.5, (index / size[0]) as f64 + 0.5) * cell;
        let is_ring = |index: usize| {
            let (x, y) = (index % size[0], index / size[0]);
            x == 0 || y == 0 || x + 1 == size[0] || y + 1 == size[1]
        };
        let is_free = |index: usize| {
            checkpoint();
            !is_ring(index) && is_free(scene, kinematics, center(index), solution)
        };
        let free: Vec<bool> = (0..size[0] * size[1]).map(is_free).collect();
        let [excluded, allowed] = [false, true].map(|wanted| distances(&free, size, wanted));
        let of_cell = |index: usize| match free[index] {
            true => (excluded[index] - 0.5) * cell,
            false => (0.5 - allowed[index]) * cell,
        };
        let room = (0..free.len()).map(of_cell).collect();
        Self { low, cell, size, room, reach }
    }

    /// Returns the room of a place, metres.
    fn at(&self, point: Point) -> f64 {
        let index = [0, 1].map(|k| ((point[k] - self.low[k]) / self.cell).floor());
        let inside = [0, 1].map(|k| index[k].clamp(0.0, (self.size[k] - 1) as f64));
        let outside = [0, 1].map(|k| (index[k] - inside[k]).abs() * self.cell);
        self.room[inside[1] as usize * self.size[0] + inside[0] as usize] - outside[0].max(outside[1])
    }
}

/// Returns true if an IK solution is within the limits and free at a place of the tip.
fn is_free(scene: &Scene, kinematics: &Kinematics, point: Point, solution: usize) -> bool {
    let solutions = kinematics.reachable(point, 0.0).and_then(|point| kinematics.solutions(point));
    let Some(q) = solutions.map(|both| both[solution]) else { return false };
    let arm = scene.arm();
    let values = [0, 1].map(|k| match arm.joints[k].range {
        JointRange::Circle => vec![q[k]],
        JointRange::Interval { lower, upper } => {
            let turn = if arm.joints[k].joint_type.is_revolute() { TAU } else { f64::INFINITY };
            let first = if turn.is_finite() { ((lower - q[k]) / turn).ceil() * turn } else { 0.0 };
            let values = std::iter::successors(Some(q[k] + first), |value| Some(value + turn));
            values.take_while(|value| *value <= upper).filter(|value| *value >= lower).collect()
        }
    });
    let sum = arm.topology().sum;
    let is_within = |q: Configuration| sum.is_none_or(|sum| sum.contains(q));
    let mut pairs = values[0].iter().flat_map(|a| values[1].iter().map(|b| Configuration::new(*a, *b)));
    pairs.any(is_within) && scene.clearance(q) > scene.workspace().clearance
}

/// Returns the distance of each cell's centre from the nearest cell with the wanted value, in cells.
fn distances(cells: &[bool], [width, height]: [usize; 2], wanted: bool) -> Vec<f64> {
    let mut along = vec![f64::INFINITY; cells.len()];
    for x in 0..width {
        for order in [(0..height).collect::<Vec<_>>(), (0..height).rev().collect()] {
            let mut last = f64::INFINITY;
            for y in order {
                last = if cells[y * width + x] == wanted { 0.0 } else { last + 1.0 };
                along[y * width + x] = along[y * width + x].min(last);
            }
        }
    }
    let nearest = |index: usize| {
        let (x, row) = (index % width, &along[index / width * width..][..width]);
        let mut least = row[x];
        for off in (1..width).take_while(|off| (*off as f64) < row[x]) {
            let beside = [x.checked_sub(off), Some(x + off)].into_iter().flatten().filter_map(|x| row.get(x));
            least = beside.fold(least, |least, across| least.min(across.hypot(off as f64)));
        }
        least
    };
    (0..cells.len()).map(nearest).collect()
}

/// Returns points along a line: at most one per square of side `cell`, or of a larger square if there would be too
/// many. Points far from the middle come first.
fn points(path: &Toolpath, cell: f64) -> Vec<Point> {
    let mut size = cell;
    loop {
        let mut seen = BTreeSet::new();
        let mut points = Vec::new();
        for piece in path.pieces() {
            let count = (2.0 * piece.curve.length() / size).ceil().clamp(1.0, MAX_PIECE_POINTS);
            for k in 0..=count as u32 {
                checkpoint();
                let point = Point::from(piece.curve.at(f64::from(k) / count));
                if seen.insert([0, 1].map(|k| (point[k] / size).floor() as i64)) {
                    points.push(point);
                }
            }
        }
        if points.len() <= MAX_POINTS {
            let middle = points.iter().sum::<Point>() / points.len() as f64;
            points.sort_by(|a, b| (b - middle).norm_squared().total_cmp(&(a - middle).norm_squared()));
            return points;
        }
        size *= 2.0;
    }
}

/// Returns the proof that a line is too large for every placement: two of its points are farther apart than any two
/// places of the tip.
fn too_large(kinematics: &Kinematics, path: &Toolpath, scale: f64, tolerance: f64) -> Option<Infeasible> {
    let arm = kinematics.arm;
    let reach = 2.0 * (arm.offset.norm() + arm.tip.norm());
    let line = Line::new(path);
    let ends: Vec<Place> = (0..path.pieces().len()).flat_map(|k| [0.0, 0.5, 1.0].map(|u| line.place(k, u))).collect();
    let farthest = |direction: Vector| {
        let along = |place: &&Place| place.point.dot(&direction);
        ends.iter().max_by(|a, b| along(a).total_cmp(&along(b))).expect("a line has an end")
    };
    let pairs = (0..WIDTH_DIRECTIONS).map(|k| {
        let (sin, cos) = (PI * f64::from(k) / f64::from(WIDTH_DIRECTIONS)).sin_cos();
        [1.0, -1.0].map(|sign| farthest(Vector::new(cos, sin) * sign))
    });
    let widths = pairs.map(|[a, b]| (scale * (a.point - b.point).norm(), *a));
    let (width, place) = widths.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_large = arm.only_turns() && width > (reach + 2.0 * tolerance) * (1.0 + 1e-9);
    is_large.then(|| Infeasible { cause: Cause::TooLarge { width, reach }, place, evidence: Vec::new() })
}

/// The displacement with the most room, for a turn and an IK solution.
struct Candidate<'a> {
    field: &'a Field,
    turn: f64,
    /// The points of the turned line.
    points: Vec<Point>,
    shift: Vector,
    room: f64,
    /// Displacements that failed. Displacements close to them are not tried.
    excluded: Vec<Vector>,
}

impl<'a> Candidate<'a> {
    fn new(field: &'a Field, turn: f64, points: Vec<Point>) -> Self {
        let mut own =
            Self { field, turn, points, shift: Vector::zeros(), room: f64::NEG_INFINITY, excluded: Vec::new() };
        own.search();
        own
    }

    /// Searches for the displacement with the most room among those that are not excluded.
    fn search(&mut self) {
        let ends = self.points.iter().fold([self.points[0]; 2], |[low, high], p| [low.inf(p), high.sup(p)]);
        let [first, last] = [0, 1].map(|k| self.field.reach[k] - ends[k]);
        let (middle, half) = ((first + last) / 2.0, (last - first).map(|x| x.max(0.0)) / 2.0);
        let resolution = RESOLUTION * self.field.cell;
        self.room = f64::NEG_INFINITY;
        let mut open = vec![(middle, half, f64::INFINITY)];
        for _ in 0..MAX_BOXES {
            let Some((middle, half, bound)) = open.pop() else { break };
            checkpoint();
            if bound <= self.room + resolution {
                continue;
            }
            let shift = self.rounded(middle);
            // Only a room that lets the box improve on the known room must be computed exactly.
            let room = self.room_at(shift, self.room.min(self.room + resolution - half.norm()));
            let (bound, is_excluded) = (room + half.norm() + (shift - middle).norm(), self.is_excluded(shift));
            if room > self.room && !is_excluded {
                (self.shift, self.room) = (shift, room);
            }
            if bound > self.room + resolution && half.amax() > resolution {
                let half = half / 2.0;
                let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
                open.extend(corners.map(|[x, y]| (middle + Vector::new(x * half.x, y * half.y), half, bound)));
            }
        }
    }

    /// Excludes the current displacement, and searches again.
    fn exclude(&mut self) {
        self.excluded.push(self.shift);
        self.search();
    }

    fn is_excluded(&self, shift: Vector) -> bool {
        self.excluded.iter().any(|other| (shift - other).norm() < 2.0 * self.field.cell)
    }

    /// Returns the room of a displacement. If it is less than `enough`, the result may be anything from the room to `enough`.
    fn room_at(&self, shift: Vector, enough: f64) -> f64 {
        let mut least = f64::INFINITY;
        for point in &self.points {
            least = least.min(self.field.at(point + shift));
            if least < enough {
                break;
            }
        }
        least
    }

    /// Rounds a displacement to the few digits that options state.
    fn rounded(&self, shift: Vector) -> Vector {
        let decimals = (-(RESOLUTION * self.field.cell).log10()).ceil().clamp(0.0, 12.0) as usize;
        shift.map(|x| format!("{x:.decimals$}").parse::<f64>().unwrap_or(x) + 0.0)
    }
}
