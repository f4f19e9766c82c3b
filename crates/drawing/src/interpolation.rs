//! Curves through given points, as CAD programs draw a spline of which a file has fit points alone: cubic, with chords' lengths as
//! the parameter, and without a jump of curvature.

use crate::Point;

/// How the curve leaves its first point and comes to its last.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Ends {
    /// In these directions where they are given, else without curvature.
    Open([Option<Point>; 2]),
    /// The last point is followed by the first.
    Closed,
}

/// Points on either side of a closed curve's that repeat it: each of them halves what an end tells of itself, at least.
const REPEATED: usize = 64;

/// The curve as Bézier curves of degree 3, each beginning where the last one ends. Two points that follow each other are apart.
pub(crate) fn interpolated(points: &[Point], ends: Ends) -> Vec<[Point; 4]> {
    match ends {
        _ if points.len() < 2 => Vec::new(),
        Ends::Open(directions) => open(points, directions),
        Ends::Closed => {
            let around = (0..points.len() + 2 * REPEATED + 1).map(|i| {
                let back = points.len() - REPEATED % points.len();
                points[(i + back) % points.len()]
            });
            open(&around.collect::<Vec<_>>(), [None; 2])[REPEATED..REPEATED + points.len()].to_vec()
        }
    }
}

/// By Thomas's algorithm for the derivatives at the points.
fn open(points: &[Point], directions: [Option<Point>; 2]) -> Vec<[Point; 4]> {
    let last = points.len() - 1;
    let steps: Vec<f64> = points.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).collect();
    let slopes: Vec<Point> =
        points.windows(2).zip(&steps).map(|(w, step)| [0, 1].map(|k| (w[1][k] - w[0][k]) / step)).collect();
    let [first_direction, last_direction] = directions.map(|direction| direction.and_then(unit));
    // Before, at and after a point, and what they come to.
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

/// None if there is no direction.
fn unit([x, y]: Point) -> Option<Point> {
    let length = x.hypot(y);
    (length > 0.0).then(|| [x / length, y / length])
}
