//! Lines of steepest ascent through a field. They begin at points all over it.

use super::isolines::Samples;
use cplan_model::space::Topology;

/// Number of starting points along each axis.
const STARTS_PER_AXIS: usize = 16;
/// Length of a step, in cells.
const STEP_LENGTH: f64 = 0.5;
/// Length of the shortest step, in cells. On a ridge, a long step would cross to the other side; short ones follow it.
const MIN_STEP_LENGTH: f64 = 0.03;
/// Greatest length of a line, in widths of the grid. Longer lines wind around and do not make the picture clearer.
const MAX_LINE_LENGTH: f64 = 4.0;
/// One of this number of consecutive points of a line is kept.
const POINTS_PER_KEPT_POINT: usize = 4;

/// Returns lines of steepest ascent, as polylines. A line ends at the goal, at a local maximum, where the field has no value, or,
/// on a circle, where it leaves the domain, at most a cell beyond the seam.
pub fn lines(samples: &Samples, topology: &Topology) -> Vec<Vec<[f64; 2]>> {
    let size = [samples.x.len(), samples.y.len()];
    if size.iter().any(|&n| n < 2) {
        return Vec::new();
    }
    let Some(extent) = extent(samples) else { return Vec::new() };
    let begin = |k: usize, i: usize| {
        let [low, high] = extent[k].map(|at| at as f64);
        low + (i as f64 + 0.5) / STARTS_PER_AXIS as f64 * (high - low)
    };
    let beginnings = (0..STARTS_PER_AXIS).flat_map(|i| (0..STARTS_PER_AXIS).map(move |j| [i, j]));
    let lines = beginnings.map(|[i, j]| line(samples, [begin(0, i), begin(1, j)]));
    let domain = topology.ranges.map(|axis| axis.domain());
    let clamp = |q: [f64; 2]| [0, 1].map(|k| q[k].clamp(domain[k].0, domain[k].1));
    lines.filter(|line| line.len() > 2).map(|line| line.into_iter().map(clamp).collect()).collect()
}

/// Returns the first and the last index with a value along each axis. `None` without values.
fn extent(samples: &Samples) -> Option<[[usize; 2]; 2]> {
    let columns = samples.y.len();
    let known = || samples.values.iter().enumerate().filter(|(_, value)| value.is_finite()).map(|(at, _)| at);
    let along = |place: fn(usize, usize) -> usize| {
        let places = || known().map(|at| place(at, columns));
        Some([places().min()?, places().max()?])
    };
    Some([along(|at, columns| at / columns)?, along(|at, columns| at % columns)?])
}

fn line(samples: &Samples, begin: [f64; 2]) -> Vec<[f64; 2]> {
    let steps = (MAX_LINE_LENGTH * samples.x.len().max(samples.y.len()) as f64 / STEP_LENGTH) as usize;
    let mut points = Vec::new();
    let Some((mut here, mut direction)) = slope(samples, begin) else { return points };
    let (mut at, mut length) = (begin, STEP_LENGTH);
    for taken in 0..steps {
        if taken % POINTS_PER_KEPT_POINT == 0 {
            points.push(place(samples, at));
        }
        // At a maximum or on a plateau, no step leads up.
        let Some(next) = (loop {
            let middle = [0, 1].map(|k| at[k] + length / 2.0 * direction[k]);
            let along = slope(samples, middle).map_or(direction, |(_, middle)| middle);
            let next = [0, 1].map(|k| at[k] + length * along[k]);
            match slope(samples, next).filter(|(there, _)| *there > here) {
                Some((there, onwards)) => break Some((next, there, onwards)),
                None if length > MIN_STEP_LENGTH => length /= 2.0,
                None => break None,
            }
        }) else {
            break;
        };
        (at, here, direction) = next;
        length = (2.0 * length).min(STEP_LENGTH);
    }
    points
}

/// Returns the value and the direction of ascent of the bilinear interpolation. `None` outside, at walls, and where the field is
/// flat.
fn slope(samples: &Samples, at: [f64; 2]) -> Option<(f64, [f64; 2])> {
    let [(i, u), (j, v)] = [(at[0], samples.x.len()), (at[1], samples.y.len())].map(|(x, n)| {
        let below = x.floor().clamp(0.0, (n - 2) as f64);
        (below as usize, x - below)
    });
    let inside = |part: f64| (0.0..=1.0).contains(&part);
    let value = |i: usize, j: usize| samples.values[i * samples.y.len() + j];
    let corners = [value(i, j), value(i + 1, j), value(i, j + 1), value(i + 1, j + 1)];
    if !inside(u) || !inside(v) || !corners.iter().all(|value| value.is_finite()) {
        return None;
    }
    let [a, b, c, d] = corners;
    let along = [(b - a) * (1.0 - v) + (d - c) * v, (c - a) * (1.0 - u) + (d - b) * u];
    let length = along[0].hypot(along[1]);
    let here = (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v;
    (length > 0.0).then(|| (here, along.map(|x| x / length)))
}

fn place(samples: &Samples, at: [f64; 2]) -> [f64; 2] {
    let along = |axis: &[f64], x: f64| {
        let below = (x.floor().max(0.0) as usize).min(axis.len() - 2);
        axis[below] + (axis[below + 1] - axis[below]) * (x - below as f64)
    };
    [along(&samples.x, at[0]), along(&samples.y, at[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::JointRange;

    fn topology() -> Topology {
        Topology::new([JointRange::Interval { lower: -1.0, upper: 1.0 }; 2])
    }

    fn samples(f: impl Fn(f64, f64) -> f64) -> Samples {
        let axis: Vec<f64> = (0..65).map(|i| -1.0 + f64::from(i) / 32.0).collect();
        let values = axis.iter().flat_map(|&x| axis.iter().map(move |&y| (x, y))).map(|(x, y)| f(x, y)).collect();
        Samples { x: axis.clone(), y: axis, values }
    }

    /// Checks that lines are rays near a maximum: their angle about the maximum stays constant.
    #[test]
    fn lines_run_straight_to_a_peak() {
        let peak = [0.3, -0.2];
        let all = lines(&samples(|x, y| -((x - peak[0]).powi(2) + (y - peak[1]).powi(2))), &topology());
        assert!(all.len() > 200, "{}", all.len());
        for line in all {
            let from_peak = |q: [f64; 2]| [q[0] - peak[0], q[1] - peak[1]];
            let (first, last) = (from_peak(line[0]), from_peak(line[line.len() - 1]));
            assert!(last[0].hypot(last[1]) < 0.13, "{last:?}");
            for &q in line.iter().take(line.len() / 2) {
                let at = from_peak(q);
                let turned = (first[0] * at[1] - first[1] * at[0]) / first[0].hypot(first[1]) / at[0].hypot(at[1]);
                assert!(turned.abs() < 0.05, "{line:?}");
            }
        }
    }

    #[test]
    fn lines_rise_and_end_at_walls() {
        let field = |x: f64, y: f64| if x > 0.5 { f64::NEG_INFINITY } else { x + 0.3 * (3.0 * y).sin() };
        let all = lines(&samples(field), &topology());
        assert!(!all.is_empty());
        for line in all {
            assert!(line.iter().all(|q| q[0] <= 0.51), "{line:?}");
            let heights: Vec<f64> = line.iter().map(|q| field(q[0].min(0.5), q[1])).collect();
            assert!(heights.windows(2).all(|pair| pair[0] < pair[1] + 1e-6), "{heights:?}");
        }
    }

    #[test]
    fn flat_and_empty_fields_have_none() {
        assert!(lines(&samples(|_, _| 1.0), &topology()).is_empty());
        assert!(lines(&samples(|_, _| f64::NEG_INFINITY), &topology()).is_empty());
        assert!(lines(&Samples { x: vec![0.0], y: vec![0.0], values: vec![1.0] }, &topology()).is_empty());
    }
}
