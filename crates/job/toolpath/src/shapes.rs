//! Lines through given points: polylines with rounded corners, arcs and splines.

use crate::curve::{dot, minus, norm};
use crate::{Curve, Error, Point, arc};

/// Three points count as collinear if the middle one is nearer to the chord than this share of the chord's length. The arc's
/// radius would exceed 10 km for each metre of the chord.
const STRAIGHT: f64 = 1e-5;

/// Rounding may make the arcs at the ends of a line longer than the line by this share.
const FIT_ROUNDING: f64 = 1e-9;

/// Messages round the greatest possible radius down to a multiple of this, metres.
const RADIUS_UNIT: f64 = 1e-6;

/// A curve, and the index of the point at its end.
pub type Leg = (Curve, usize);

/// Returns the straight lines between points. At each inner point, an arc with this radius, metres, joins two lines; with the
/// radius 0, they meet in a corner. `O(n)` for `n` points.
///
/// # Errors
/// Fewer than two points, two equal points in sequence, or arcs that do not fit between the points.
pub fn polyline(points: &[Point], radius: f64) -> Result<Vec<Leg>, Error> {
    require_different(points, "points")?;
    let last = points.len() - 1;
    // For each point, the length by which its arc shortens each of the two lines there.
    let cut = |i: usize| if i == 0 || i == last { 0.0 } else { radius * half_turn(points, i).tan() };
    let cuts: Vec<f64> = (0..=last).map(cut).collect();
    let lengths: Vec<f64> = points.windows(2).map(|pair| norm(minus(pair[1], pair[0]))).collect();
    // With the radius 0, no line is shortened.
    let fit = |i: usize| if radius > 0.0 { lengths[i - 1] / (cuts[i - 1] + cuts[i]) } else { f64::INFINITY };
    if let Some(i) = (1..=last).min_by(|a, b| fit(*a).total_cmp(&fit(*b))).filter(|i| fit(*i) < 1.0 - FIT_ROUNDING) {
        let message = format!("corners rounded by {radius} m do not fit between points {i} and {}", i + 1);
        let greatest = (radius * fit(i) / RADIUS_UNIT).floor() * RADIUS_UNIT;
        let hint = match greatest > 0.0 {
            true => format!("a radius of {greatest:.6} m fits"),
            false => "leave the radius out".into(),
        };
        return Err(Error::new(None, None, message, hint));
    }
    let mut legs = Vec::new();
    let mut from = points[0];
    for i in 1..=last {
        let along = minus(points[i], points[i - 1]);
        let length = lengths[i - 1];
        let to = [0, 1].map(|k| points[i][k] - along[k] * cuts[i] / length);
        if cuts[i - 1] + cuts[i] < length {
            legs.push((Curve::Line { from, to }, i));
        }
        from = to;
        if cuts[i] > 0.0 {
            let ahead = minus(points[i + 1], points[i]);
            let end = [0, 1].map(|k| points[i][k] + ahead[k] * cuts[i] / norm(ahead));
            let is_left = along[0] * ahead[1] - along[1] * ahead[0] > 0.0;
            if let Some(curve) = arc::with_radius(from, end, radius, is_left) {
                legs.push((curve, i));
                from = curve.end();
            }
        }
    }
    Ok(legs)
}

/// Returns half the angle by which a polyline turns at an inner point, radians.
fn half_turn(points: &[Point], i: usize) -> f64 {
    let [before, after] = [minus(points[i], points[i - 1]), minus(points[i + 1], points[i])];
    let cross = before[0] * after[1] - before[1] * after[0];
    cross.abs().atan2(dot(before, after)) / 2.0
}

/// Returns the arc of a circle from the first point through the second one to the third one.
///
/// # Errors
/// Points that are equal, or on a straight line.
pub fn arc_through([from, through, to]: [Point; 3]) -> Result<Leg, Error> {
    require_different(&[from, through, to], "arc")?;
    let [a, b] = [minus(through, from), minus(to, from)];
    let cross = a[0] * b[1] - a[1] * b[0];
    if cross.abs() <= STRAIGHT * dot(b, b).max(dot(a, a)) {
        let hint = "write the straight line as points = [[x, y], [x, y]]";
        return Err(Error::new(None, None, "the three points of this arc are on a straight line", hint));
    }
    let [a2, b2] = [dot(a, a), dot(b, b)];
    let center = [from[0] + (b[1] * a2 - a[1] * b2) / (2.0 * cross), from[1] + (a[0] * b2 - b[0] * a2) / (2.0 * cross)];
    // The arc turns left if and only if the triangle of the three points does.
    let curve = arc::about(from, to, center, cross > 0.0);
    curve.map(|curve| (curve, 2)).map_err(|_| {
        let message = "the circle through the three points of this arc is too large";
        Error::new(None, None, message, "move the middle point away from the straight line")
    })
}

/// Returns the cubic spline through points. Its parameter grows by the distance between successive points. Its first and second
/// derivatives are continuous; at the ends, the second derivative is zero. If the last point equals the first, the spline is
/// closed and as smooth there as elsewhere. `O(n)` for `n` points.
///
/// # Errors
/// Fewer than two points, or two equal points in sequence.
pub fn spline(points: &[Point]) -> Result<Vec<Leg>, Error> {
    require_different(points, "spline")?;
    let steps: Vec<f64> = points.windows(2).map(|pair| norm(minus(pair[1], pair[0]))).collect();
    let slopes: Vec<Point> = {
        let [x, y] = [0, 1].map(|k| {
            let secants: Vec<f64> = (0..steps.len()).map(|i| (points[i + 1][k] - points[i][k]) / steps[i]).collect();
            slopes(&steps, &secants, points.first() == points.last())
        });
        x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
    };
    let curve = |i: usize| {
        let [a, d] = [points[i], points[i + 1]];
        let b = [0, 1].map(|k| a[k] + slopes[i][k] * steps[i] / 3.0);
        let c = [0, 1].map(|k| d[k] - slopes[i + 1][k] * steps[i] / 3.0);
        (Curve::Cubic([a, b, c, d]), i + 1)
    };
    Ok((0..steps.len()).map(curve).collect())
}

/// Returns the first derivatives of a cubic spline at its points, for one coordinate. `steps` are the lengths of the intervals,
/// `secants` the slopes of the chords.
fn slopes(steps: &[f64], secants: &[f64], is_closed: bool) -> Vec<f64> {
    let last = steps.len();
    // The equation of a point: the factors of the slopes before it, at it and after it, and the right-hand side.
    let inner = |before: usize, after: usize| {
        let share = steps[after] / (steps[before] + steps[after]);
        let right = 3.0 * (share * secants[before] + (1.0 - share) * secants[after]);
        [share, 2.0, 1.0 - share, right]
    };
    if !is_closed {
        let mut rows = vec![[0.0, 2.0, 1.0, 3.0 * secants[0]]];
        rows.extend((1..last).map(|i| inner(i - 1, i)));
        rows.push([1.0, 2.0, 0.0, 3.0 * secants[last - 1]]);
        return tridiagonal(&rows);
    }
    // The last point equals the first. The matrix then has two entries outside its three diagonals, which a correction of rank
    // one replaces (Sherman and Morrison).
    let mut rows: Vec<[f64; 4]> = (0..last).map(|i| inner(if i == 0 { last - 1 } else { i - 1 }, i)).collect();
    if last < 3 {
        // With two intervals of equal length, the slopes follow from symmetry.
        return vec![(secants[0] + secants[last - 1]) / 2.0; last + 1];
    }
    let (first_before, last_after) = (rows[0][0], rows[last - 1][2]);
    let gamma = -rows[0][1];
    rows[0][1] -= gamma;
    rows[last - 1][1] -= first_before * last_after / gamma;
    let free = tridiagonal(&rows);
    let mut correction = vec![0.0; last];
    (correction[0], correction[last - 1]) = (gamma, last_after);
    let corrected: Vec<[f64; 4]> =
        rows.iter().zip(&correction).map(|(&[before, at, after, _], &right)| [before, at, after, right]).collect();
    let correction = tridiagonal(&corrected);
    let off = |x: &[f64]| x[0] + first_before / gamma * x[last - 1];
    let factor = off(&free) / (1.0 + off(&correction));
    let mut slopes: Vec<f64> = free.iter().zip(&correction).map(|(a, b)| a - factor * b).collect();
    slopes.push(slopes[0]);
    slopes
}

/// Solves a linear system whose matrix is tridiagonal and diagonally dominant. A row has the entries before, on and after the
/// diagonal, and the right-hand side.
fn tridiagonal(rows: &[[f64; 4]]) -> Vec<f64> {
    let mut reduced: Vec<[f64; 2]> = Vec::with_capacity(rows.len());
    for &[before, at, after, right] in rows {
        let [above, solved] = reduced.last().copied().unwrap_or([0.0; 2]);
        let pivot = at - before * above;
        reduced.push([after / pivot, (right - before * solved) / pivot]);
    }
    let mut solution = vec![0.0; rows.len()];
    for i in (0..rows.len()).rev() {
        let next = solution.get(i + 1).copied().unwrap_or(0.0);
        solution[i] = reduced[i][1] - reduced[i][0] * next;
    }
    solution
}

/// Refuses fewer than two points, and two equal points in sequence. `key` is the key of the points in TOML.
fn require_different(points: &[Point], key: &str) -> Result<(), Error> {
    if points.len() < 2 {
        let message = format!("a line needs two points or more, not {}", points.len());
        return Err(Error::new(None, None, message, format!("{key} = [[x, y], [x, y]]")));
    }
    match points.windows(2).position(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(i) => {
            let message = format!("points {} and {} of this line are equal", i + 1, i + 2);
            Err(Error::new(None, None, message, "remove one of them"))
        }
    }
}
