//! Replaces shapes with many corners by simpler ones that contain them. The simplification is smaller than the margin
//! of the configuration space.

use super::covering::covering;
use cplan_geometry::{Convex, Point, SimplePolygon, Vector, cross, farthest, hull, perpendicular};
use cplan_model::{Obstacle, Scene, Shape};
use std::borrow::Cow;

/// Number of corners up to which shapes stay unchanged, because simpler ones would hardly save time.
const MAX_UNCHANGED_CORNERS: usize = 16;

/// Number of pieces of a simplified obstacle above which it is also covered by small cells. The covering is used if it
/// has fewer pieces.
const MAX_PIECES: usize = 512;

/// Number of attempts to simplify a polygon whose coarse outline crosses itself. Each attempt has a quarter of the
/// previous tolerance.
const ATTEMPTS: usize = 3;

/// Fraction of the tolerance for the corners of polygons that consist of cells.
const CELL_CORNER_SHARE: f64 = 0.25;

/// Distance by which outlines are moved outwards, as a fraction of the coordinates. It covers rounding.
const ROUNDING: f64 = 1e-13;

/// Returns a scene whose shapes contain those of `scene` and extend at most `within` metres beyond them in total. A
/// part or piece with few corners is unchanged. In an obstacle with many pieces, those that the arm cannot approach
/// within `near` may be missing. `O(n log n)`.
///
/// A configuration that is free in the coarse scene is free in `scene`.
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
    // If parts of the arm are simplified, too, arm and obstacles share the tolerance.
    let each = if parts.clone().any(|part| fine(&part.shape)) { within / 2.0 } else { within };
    let reach = reach(scene).map(|reach| reach + near);
    let can_meet = |piece: &Convex| reach.is_none_or(|reach| distance_of_bounds(piece, scene.arm().base) <= reach);
    let pieces = |obstacle: &Obstacle| {
        if !many(obstacle) {
            return obstacle.pieces.clone();
        }
        let met: Vec<Convex> = obstacle.pieces.iter().filter(|piece| can_meet(piece)).cloned().collect();
        if met.len() <= MAX_UNCHANGED_CORNERS {
            return met.iter().map(|piece| coarse_cover(piece, each)).collect();
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
        let pieces = fewer.unwrap_or_else(|| met.iter().map(|piece| coarse_cover(piece, each)).collect());
        let covered = || coarse_covers(&met, each).filter(|covered| covered.len() < pieces.len());
        if pieces.len() > MAX_PIECES { covered().unwrap_or(pieces) } else { pieces }
    };
    Cow::Owned(scene.reshaped(|part| part.shape = coarse_cover(&part.shape, each), pieces))
}

/// Returns the greatest distance of the arm from the base, metres. `None` unless both joints are revolute and nothing
/// is attached to the arm.
fn reach(scene: &Scene) -> Option<f64> {
    let turns = scene.arm().joints.iter().all(|joint| joint.joint_type.is_revolute());
    (turns && scene.attachment().is_none()).then(|| scene.arm().reach() * (1.0 + ROUNDING))
}

/// Returns the distance of a shape's bounding box from a point. It is a lower bound on the distance of the shape.
fn distance_of_bounds(shape: &Convex, from: Point) -> f64 {
    let [lower, upper] = shape.bounds();
    (0..2).map(|k| (lower[k] - from[k]).max(from[k] - upper[k]).max(0.0)).fold(0.0, f64::hypot)
}

/// Covers pieces by polygons with few corners each, see [`covering`]. `None` if a piece is rounded, or if this would
/// take too long.
fn coarse_covers(pieces: &[Convex], within: f64) -> Option<Vec<Convex>> {
    let straight = pieces.iter().all(|piece| piece.radius() == 0.0);
    let covering = if straight { covering(pieces, within * (1.0 - CELL_CORNER_SHARE)) } else { None };
    covering.map(|covering| covering.iter().map(|piece| coarse_cover(piece, within * CELL_CORNER_SHARE)).collect())
}

/// Returns a convex shape with few corners that contains `shape` and extends at most `within` beyond it. Its sides
/// are some of the shape's sides, extended until they meet. `O(n)`.
fn coarse_cover(shape: &Convex, within: f64) -> Convex {
    let core = shape.core();
    if core.len() <= MAX_UNCHANGED_CORNERS {
        return shape.clone();
    }
    Convex::trusted(around_convex(core, within).unwrap_or_else(|| core.to_vec()), shape.radius())
}

/// Returns the polygon of some extended sides of a strictly convex polygon. `None` if fewer than three sides remain.
fn around_convex(core: &[Point], within: f64) -> Option<Vec<Point>> {
    let n = core.len();
    let corner = |i: usize| core[i % n];
    let mut outline = Vec::new();
    let mut side = 0;
    while side < n {
        // Continue while this side and a later one meet close to the corners between them.
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
    let outline = hull(&outline.into_iter().map(out).collect::<Vec<_>>());
    (outline.len() > 2).then_some(outline)
}

/// Returns the point where two sides meet if the first is extended beyond its end, and the second before its start.
/// `None` if their directions differ by more than a right angle.
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

/// Returns convex pieces that cover a simple polygon, and extend at most `within` beyond it. `None` if the simplified
/// polygon crosses itself.
///
/// The outline is cut into nearly straight runs. The pieces are those of the polygon of the runs' ends, and a rectangle
/// around each run. They cover the polygon, because the polygon of the ends can be deformed into the outline within the
/// rectangles. So both have the same winding number around any point outside all rectangles.
fn around_polygon(corners: &[Point], within: f64) -> Option<Vec<Convex>> {
    let polygon = SimplePolygon::new(corners.to_vec()).ok()?;
    if polygon.is_convex() {
        return around_convex(&hull(corners), within).map(|core| vec![Convex::trusted(core, 0.0)]);
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

/// Returns convex pieces that cover a polyline, and extend at most `within` beyond it.
fn around_polyline(points: &[Point], within: f64) -> Vec<Convex> {
    let piece =
        |run: &[Point]| if run.len() > 2 { rectangle(run) } else { Convex::between(run[0], run[run.len() - 1]) };
    straight_runs(points, within).into_iter().map(piece).collect()
}

/// Cuts a polyline into runs that share their ends. Each run lies within `within / 4` of the line through its ends,
/// and extends at most that much beyond them. So no point of the rectangle around a run is farther than `within`
/// from it. Galloping search finds the runs in `O(n log n)`.
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

/// Returns the rectangle around a run with two sides parallel to the line through the run's ends.
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
