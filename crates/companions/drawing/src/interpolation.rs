//! Interpolating splines for curves that are given only by their fit points. As in CAD programs, the splines are cubic,
//! are parametrised by chord length, and have continuous curvature.

use crate::Point;

/// End conditions of the curve.
#[derive(Debug, Clone, Copy)]
pub(crate) enum EndConditions {
    /// The curve is open, with these directions at its ends. An end without a direction has zero curvature.
    Open([Option<Point>; 2]),
    /// The curve is closed: the first point follows the last.
    Closed,
}

/// Number of points that are repeated on each side of a closed curve, so that it can be computed as an open one. Each
/// repeated point at least halves the influence of the artificial end.
const REPEATED_POINTS: usize = 64;

/// Returns the curve as connected cubic Bézier curves. Consecutive points must differ.
pub(crate) fn interpolated(points: &[Point], ends: EndConditions) -> Vec<[Point; 4]> {
    match ends {
        _ if points.len() < 2 => Vec::new(),
        EndConditions::Open(directions) => open(points, directions),
        EndConditions::Closed => {
            let around = (0..points.len() + 2 * REPEATED_POINTS + 1).map(|i| {
                let back = points.len() - REPEATED_POINTS % points.len();
                points[(i + back) % points.len()]
            });
            open(&around.collect::<Vec<_>>(), [None; 2])[REPEATED_POINTS..REPEATED_POINTS + points.len()].to_vec()
        }
    }
}

/// Solves for the derivatives at the points by Thomas's algorithm.
fn open(points: &[Point], directions: [Option<Point>; 2]) -> Vec<[Point; 4]> {
    let last = points.len() - 1;
    let steps: Vec<f64> = points.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).collect();
    let slopes: Vec<Point> =
        points.windows(2).zip(&steps).map(|(w, step)| [0, 1].map(|k| (w[1][k] - w[0][k]) / step)).collect();
    let [first_direction, last_direction] = directions.map(|direction| direction.and_then(unit));
    // Coefficients of the previous, the current and the next point, and the right-hand side.
    let row = |i: usize| match (i, first_direction, last_direction) {
        (0, Some(direction), _) => ([0.0, 1.0, 0.0], direction),
        (0, None, _) => ([0.0, 2.0, 1.0], slopes[0].map(|x| 3.0 * x)),
        (i, _, Some(direction)) if i == last => ([0.0, 1.0, 0.0], direction),
        (i, _, None) if i == last => ([1.0, 2.0, 0.0], slopes[i - 1].map(|x| 3.0 * x)),
        (i, ..) => {
            let (before, after) = (steps[i - 1], steps[i]);
            let sum = [0, 1].map(|k| 3.0 * (after * slopes[i - 1][k] + before * slopes[i][k]));
            ([after, 2.0 * (before + after), before], sum)
        }
    };
    let mut reduced: Vec<(f64, Point)> = Vec::with_capacity(points.len());
    for i in 0..=last {
        let ([before, at, after], sum) = row(i);
        let (factor, known) = reduced.last().copied().unwrap_or((0.0, [0.0; 2]));
        let pivot = at - before * factor;
        reduced.push((after / pivot, [0, 1].map(|k| (sum[k] - before * known[k]) / pivot)));
    }
    let mut derivatives = vec![[0.0; 2]; points.len()];
    for i in (0..=last).rev() {
        let (factor, known) = reduced[i];
        let next = derivatives.get(i + 1).copied().unwrap_or([0.0; 2]);
        derivatives[i] = [0, 1].map(|k| known[k] - factor * next[k]);
    }
    let third = |i: usize, step: f64| [0, 1].map(|k| points[i][k] + derivatives[i][k] * step / 3.0);
    (0..last).map(|i| [points[i], third(i, steps[i]), third(i + 1, -steps[i]), points[i + 1]]).collect()
}

/// Returns the unit vector, or `None` for a zero vector.
fn unit([x, y]: Point) -> Option<Point> {
    let length = x.hypot(y);
    (length > 0.0).then(|| [x / length, y / length])
}
