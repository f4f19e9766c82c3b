//! Simpler shapes around shapes with many corners, since no configuration space shows more detail than its margin.

use super::covering::covering;
use crate::model::{Obstacle, Scene, Shape};
use cplan_geometry::{Convex, Point, SimplePolygon, Vector, cross, farthest, perpendicular};
use std::borrow::Cow;

/// Shapes with at most this many corners stay unchanged.
const MAX_UNCHANGED_CORNERS: usize = 16;

/// An obstacle of more pieces, however its outline is simplified, is covered by polygons made of small cells, if these are fewer.
const MAX_PIECES: usize = 512;

/// Number of attempts to simplify a polygon whose coarse outline crosses itself, each with a quarter of the tolerance.
const ATTEMPTS: usize = 3;

/// Share of the tolerance for the corners of polygons made of cells.
const CELL_CORNER_SHARE: f64 = 0.25;

/// Outlines are moved out by this share of the coordinates, more than what rounding takes off them.
const ROUNDING: f64 = 1e-13;

/// Returns a scene whose shapes contain those of the given one and extend at most `within` metres beyond them in total.
/// Parts and pieces with few corners are unchanged. For obstacles with many pieces, pieces may be omitted that the arm
/// keeps farther than `near` away in all configurations. `O(n log n)`.
///
/// Configurations that are free among coarse shapes are free among the true ones.
pub(super) fn coarse(scene: &Scene, within: f64, near: f64) -> Cow<'_, Scene> {
    let fine = |shape: &Convex| shape.core().len() > MAX_UNCHANGED_CORNERS;
    let many = |obstacle: &Obstacle| {
        let outlined = matches!(obstacle.shape, Shape::Polygon(_) | Shape::Polyline(_));
        outlined && obstacle.pieces.len() > MAX_UNCHANGED_CORNERS || obstacle.pieces.iter().any(fine)
    };
    let parts = scene.own_parts(0).iter().chain(scene.own_parts(1));
    if within <= 0.0 || !parts.clone().any(|part| fine(&part.shape)) && !scene.workspace().obstacles.iter().any(many) {
        return Cow::Borrowed(scene);
    }
    // If parts of the arm become coarser as well, they share the allowance with the obstacles.
    let each = if parts.clone().any(|part| fine(&part.shape)) { within / 2.0 } else { within };
    let reach = reach(scene).map(|reach| reach + near);
    let can_meet = |piece: &Convex| reach.is_none_or(|reach| distance_of_bounds(piece, scene.arm().base) <= reach);
    let pieces = |obstacle: &Obstacle| {
        if !many(obstacle) {
            return obstacle.pieces.clone();
        }
        let met: Vec<Convex> = obstacle.pieces.iter().filter(|piece| can_meet(piece)).cloned().collect();
        if met.len() <= MAX_UNCHANGED_CORNERS {
            return met.iter().map(|piece| around(piece, each)).collect();
        }
        let simplified = match &obstacle.shape {
            Shape::Polygon(corners) => around_polygon(corners, each),
            Shape::Polyline(points) => Some(around_polyline(points, each)),
            Shape::Circle { .. } | Shape::Pieces => None,
        };
        let simplified = simplified.map(|mut pieces| {
            pieces.retain(can_meet);
            pieces
        });
        let fewer = simplified.filter(|pieces| pieces.len() < met.len());
        let pieces = fewer.unwrap_or_else(|| met.iter().map(|piece| around(piece, each)).collect());
        let covered = || covered(&met, each).filter(|covered| covered.len() < pieces.len());
        if pieces.len() > MAX_PIECES { covered().unwrap_or(pieces) } else { pieces }
    };
    Cow::Owned(scene.reshaped(|part| part.shape = around(&part.shape, each), pieces))
}

/// Returns the greatest distance of the arm from the base, in simple cases: two revolute joints and no attachment.
fn reach(scene: &Scene) -> Option<f64> {
    let turns = scene.arm().joints.iter().all(|joint| joint.joint_type.is_revolute());
    (turns && scene.attachment().is_none()).then(|| scene.arm().reach() * (1.0 + ROUNDING))
}

/// Returns the distance of a shape's bounds from a point, which is at most that of the shape.
fn distance_of_bounds(shape: &Convex, from: Point) -> f64 {
    let [lower, upper] = shape.bounds();
    (0..2).map(|k| (lower[k] - from[k]).max(from[k] - upper[k]).max(0.0)).fold(0.0, f64::hypot)
}

/// [`covering`] of pieces without curves, with few corners each.
fn covered(pieces: &[Convex], within: f64) -> Option<Vec<Convex>> {
    let straight = pieces.iter().all(|piece| piece.radius() == 0.0);
    let covering = if straight { covering(pieces, within * (1.0 - CELL_CORNER_SHARE)) } else { None };
    covering.map(|covering| covering.iter().map(|piece| around(piece, within * CELL_CORNER_SHARE)).collect())
}

/// Returns a convex shape with few corners that contains a given one and extends at most `within` beyond it: some of
/// its sides, extended until they meet. `O(n)`.
fn around(shape: &Convex, within: f64) -> Convex {
    let core = shape.core();
    if core.len() <= MAX_UNCHANGED_CORNERS {
        return shape.clone();
    }
    Convex::trusted(around_convex(core, within).unwrap_or_else(|| core.to_vec()), shape.radius())
}

/// Returns the extended sides of a strictly convex polygon, or `None` if too few sides are left.
fn around_convex(core: &[Point], within: f64) -> Option<Vec<Point>> {
    let n = core.len();
    let corner = |i: usize| core[i % n];
    let mut outline = Vec::new();
    let mut side = 0;
    while side < n {
        // As far on as the corner that this side and a later one make stays near the corners between them.
        let (mut next, mut meeting) = (side + 1, corner(side + 1));
        while next < n {
            let Some(at) = where_lines_meet([corner(side), corner(side + 1)], [corner(next + 1), corner(next + 2)])
            else {
                break;
            };
            if distance_from_line(at, corner(side + 1), corner(next + 1)) > within {
                break;
            }
            (next, meeting) = (next + 1, at);
        }
        outline.push(meeting);
        side = next;
    }
    let middle = outline.iter().sum::<Vector>() / outline.len() as f64;
    let out = |p: Point| p + (p - middle) * ROUNDING + (p - middle).map(f64::signum) * (ROUNDING * p.amax());
    let outline = cplan_geometry::hull(&outline.into_iter().map(out).collect::<Vec<_>>());
    (outline.len() > 2).then_some(outline)
}

/// Returns where the line of one side, beyond its end, meets that of a later side before its start, or `None` if they
/// turn by more than a right angle.
fn where_lines_meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let (u, v) = (b - a, d - c);
    let turn = cross(u, v);
    if turn <= 0.0 || u.dot(&v) <= 0.0 {
        return None;
    }
    let on = cross(c - b, v) / turn;
    (on >= 0.0).then(|| b + u * on)
}

fn distance_from_line(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    cross(along, p - a).abs() / along.norm()
}

/// Returns convex pieces around a simple polygon, none farther than `within` from it: its outline is cut into straight
/// runs; the pieces are a rectangle around each run, and the polygon of the runs' ends.
///
/// The runs can be deformed into the outline within the rectangles, so both have the same winding number around a point
/// outside of all rectangles. So each point of the polygon is in a rectangle or in the polygon of the runs. Returns
/// `None` if that polygon crosses itself.
fn around_polygon(corners: &[Point], within: f64) -> Option<Vec<Convex>> {
    let polygon = SimplePolygon::new(corners.to_vec()).ok()?;
    if polygon.is_convex() {
        return around_convex(&strictly_convex(corners), within).map(|core| vec![Convex::trusted(core, 0.0)]);
    }
    let closed: Vec<Point> = corners.iter().chain([&corners[0]]).copied().collect();
    (0..ATTEMPTS).find_map(|attempt| {
        let runs = straight_runs(&closed, within / 4_f64.powi(attempt as i32));
        let ends = runs.iter().map(|run| run[0]).collect();
        let inner = SimplePolygon::new(ends).ok()?;
        let mut pieces = inner.convex_pieces();
        pieces.extend(runs.into_iter().filter(|run| run.len() > 2).map(rectangle));
        Some(pieces)
    })
}

fn strictly_convex(corners: &[Point]) -> Vec<Point> {
    cplan_geometry::hull(corners)
}

/// Returns convex pieces around a polyline, none farther than `within` from it.
fn around_polyline(points: &[Point], within: f64) -> Vec<Convex> {
    let piece =
        |run: &[Point]| if run.len() > 2 { rectangle(run) } else { Convex::between(run[0], run[run.len() - 1]) };
    straight_runs(points, within).into_iter().map(piece).collect()
}

/// Cuts a polyline into runs that share their ends. Each lies within a band of half the width `within` around the line
/// through its ends, and hardly extends beyond them. So no point of the rectangle around it is farther than `within`
/// from it. Runs are found by galloping search: `O(n log n)`.
fn straight_runs(points: &[Point], within: f64) -> Vec<&[Point]> {
    let straight = |from: usize, to: usize| {
        let (a, b) = (points[from], points[to]);
        let Some(along) = (b - a).try_normalize(0.0) else { return false };
        let (length, slack) = ((b - a).norm(), within / 4.0);
        points[from..=to].iter().all(|p| {
            let (on, off) = (along.dot(&(p - a)), cross(along, p - a));
            off.abs() <= slack && -slack <= on && on <= length + slack
        })
    };
    let last = points.len() - 1;
    let mut runs = Vec::new();
    let mut from = 0;
    while from < last {
        let to = farthest(from + 1, last, |to| straight(from, to));
        runs.push(&points[from..=to]);
        from = to;
    }
    runs
}

/// Returns the rectangle around a run with two sides parallel to the line through its ends.
fn rectangle(run: &[Point]) -> Convex {
    let (a, b) = (run[0], run[run.len() - 1]);
    let along = (b - a).normalize();
    let across = perpendicular(along);
    let pad = ROUNDING * run.iter().map(|p| p.amax()).fold(0.0, f64::max);
    let extent = |axis: Vector| {
        let on = run.iter().map(|p| axis.dot(&(p - a)));
        let (low, high) = on.fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        (low - pad, high + pad)
    };
    let ((left, right), (low, high)) = (extent(along), extent(across));
    let corners = [(left, low), (right, low), (right, high), (left, high)];
    Convex::trusted(corners.map(|(x, y)| a + along * x + across * y).to_vec(), 0.0)
}
