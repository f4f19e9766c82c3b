//! The values that one joint can have at given times, if it begins and ends at rest and its acceleration and speed are limited.

use std::rc::Rc;

/// Widening of limits because of rounding, as a share of them.
const ROUNDING: f64 = 1e-9;

/// Widening of common parts because of rounding, in the unit of the joint.
const COMMON_ROUNDING: f64 = 1e-8;

/// Least difference of the values at the ends of a side that bounds a common part. The direction of a shorter side depends on
/// rounding: corners are exact to some 1e-15, so the line through this side is exact to [`COMMON_ROUNDING`] over more than ten units.
const LEAST_SIDE: f64 = 1e-5;

/// Greatest number of steps towards an end of a common part.
const MAX_NEWTON_STEPS: usize = 12;

/// A motion of one joint.
#[derive(Debug, Clone)]
pub(crate) struct Reach {
    /// Value at the start, and at the goal.
    pub ends: [f64; 2],
    pub velocity: f64,
    pub acceleration: f64,
    /// The least and the greatest value of the joint.
    pub range: [f64; 2],
}

/// A convex polygon of pairs: the value of the joint at a time, and its mean speed until the next time. Counter-clockwise.
type Polygon = Vec<[f64; 2]>;

/// A polygon of pairs, with the lines through its sides.
#[derive(Debug)]
struct Pairs {
    corners: Polygon,
    /// The least and the greatest value.
    range: [f64; 2],
    /// The slopes of the lines below and above the polygon, and their speeds at the value 0.
    lines: [Vec<[f64; 2]>; 2],
}

/// All motions of one joint that are in given intervals at some times.
///
/// An acceleration of at most `a` changes the mean speed between two times by at most `a h` up to the next mean speed. From
/// rest to the first mean speed and from the last one to rest, the change is at most `a h / 2`. So the pairs of a value
/// and the next mean speed that can be reached from the start are a convex polygon, and so are those from which the goal can be
/// reached.
#[derive(Debug, Clone)]
pub(crate) struct Tube {
    /// The values of the joint at times that are `step` seconds apart, the first at the start and the last at the goal.
    pub intervals: Vec<[f64; 2]>,
    step: f64,
    /// For each time except the last one, the pairs that can be reached from the start.
    forward: Vec<Rc<Pairs>>,
    /// For each time except the last one, the pairs from which the goal can be reached.
    backward: Vec<Rc<Pairs>>,
}

impl Reach {
    /// Returns the motions of the joint that are in these intervals at times that are `step` seconds apart. Returns `None` if there
    /// are no such motions.
    pub fn tube(&self, mut intervals: Vec<[f64; 2]>, step: f64) -> Option<Tube> {
        let last = intervals.len() - 1;
        for (k, end) in [0, last].into_iter().zip(self.ends) {
            let slack = ROUNDING * (1.0 + end.abs());
            intervals[k] = [intervals[k][0].max(end - slack), intervals[k][1].min(end + slack)];
        }
        let near_rest = (self.acceleration * step * (1.0 + ROUNDING) / 2.0).min(self.velocity * (1.0 + ROUNDING));
        let rectangle = |[a, b]: [f64; 2]| vec![[a, -near_rest], [b, -near_rest], [b, near_rest], [a, near_rest]];
        let ends = [rectangle(intervals[0]), sheared(rectangle(intervals[last]), -step)];
        // Those of all other times are replaced.
        let [forward, backward] = ends.map(|polygon| {
            let pairs = Rc::new(Pairs::new(polygon));
            vec![pairs; last]
        });
        let mut tube = Tube { intervals, step, forward, backward };
        let is_possible = |[from, to]: &[f64; 2]| from <= to;
        (tube.intervals.iter().all(is_possible) && self.narrow(&mut tube, [0, last - 1])).then_some(tube)
    }

    /// Returns the motions of a tube that are in an interval at a time, which is not the last one. Returns `None` if there are no such
    /// motions.
    pub fn halved(&self, tube: &Tube, time: usize, half: [f64; 2]) -> Option<Tube> {
        let mut next = tube.clone();
        next.intervals[time] = half;
        let forward = clipped(tube.forward[time].corners.clone(), 0, half);
        if forward.is_empty() {
            return None;
        }
        next.forward[time] = Rc::new(Pairs::new(forward));
        self.narrow(&mut next, [time, time]).then_some(next)
    }

    /// Narrows the intervals of a tube: all motions within them remain within them. The pairs that can be reached are known up to
    /// the time `from`, and those from which the goal can be reached are known from the time `to` on. Returns false if there are no
    /// motions.
    fn narrow(&self, tube: &mut Tube, [from, to]: [usize; 2]) -> bool {
        let (last, step) = (tube.intervals.len() - 1, tube.step);
        let change = self.acceleration * step * (1.0 + ROUNDING);
        let fastest = self.velocity * (1.0 + ROUNDING);
        let next_speeds = |polygon: &Polygon| clipped(thickened(polygon, change), 1, [-fastest, fastest]);
        for k in from + 1..last {
            let reached = clipped(sheared(tube.forward[k - 1].corners.clone(), step), 0, tube.intervals[k]);
            if reached.is_empty() {
                return false;
            }
            tube.forward[k] = Rc::new(Pairs::new(next_speeds(&reached)));
        }
        for k in (0..to).rev() {
            let left = clipped(tube.backward[k + 1].corners.clone(), 0, tube.intervals[k + 1]);
            if left.is_empty() {
                return false;
            }
            tube.backward[k] = Rc::new(Pairs::new(sheared(next_speeds(&left), -step)));
        }
        for k in 0..last {
            let Some([least, most]) = common_range([&tube.forward[k], &tube.backward[k]]) else { return false };
            let slack = ROUNDING * (1.0 + least.abs().max(most.abs()));
            tube.intervals[k] = [tube.intervals[k][0].max(least - slack), tube.intervals[k][1].min(most + slack)];
        }
        true
    }
}

impl Pairs {
    fn new(corners: Polygon) -> Self {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut lines = [Vec::with_capacity(corners.len()), Vec::with_capacity(corners.len())];
        for (k, [x, w]) in corners.iter().enumerate() {
            range = [range[0].min(*x), range[1].max(*x)];
            let next = corners[(k + 1) % corners.len()];
            let along = next[0] - x;
            if along.abs() >= LEAST_SIDE {
                let slope = (next[1] - w) / along;
                let outward = COMMON_ROUNDING * (1.0 + slope.abs());
                let is_above = along < 0.0;
                let shift = if is_above { outward } else { -outward };
                lines[usize::from(is_above)].push([slope, w - slope * x + shift]);
            }
        }
        Self { corners, range, lines }
    }
}

/// Returns the range of the values in the common part of two polygons, and possibly of points near it. `None` if they have no
/// common part.
fn common_range(both: [&Pairs; 2]) -> Option<[f64; 2]> {
    let [a, b] = both.map(|pairs| pairs.range);
    let mut range = [a[0].max(b[0]) - COMMON_ROUNDING, a[1].min(b[1]) + COMMON_ROUNDING];
    // The height of the common part is concave. Newton's method approaches its zeros from outside.
    for end in 0..2 {
        for _ in 0..MAX_NEWTON_STEPS {
            let x = range[end];
            let at = |[slope, value]: [f64; 2]| (slope * x + value, slope);
            let lines = |side: usize| both.into_iter().flat_map(move |pairs| pairs.lines[side].iter().copied().map(at));
            let below = lines(0).reduce(|a, b| if b.0 > a.0 { b } else { a });
            let above = lines(1).reduce(|a, b| if b.0 < a.0 { b } else { a });
            let (Some(below), Some(above)) = (below, above) else { break };
            let (height, slope) = (above.0 - below.0, above.1 - below.1);
            if height >= 0.0 {
                break;
            }
            let inward = if end == 0 { slope > 0.0 } else { slope < 0.0 };
            range[end] = x - height / slope;
            if !inward || range[0] > range[1] {
                return None;
            }
        }
    }
    (range[0] <= range[1]).then_some(range)
}

/// Moves the values of a polygon by their speed for some seconds.
fn sheared(mut polygon: Polygon, time: f64) -> Polygon {
    polygon.iter_mut().for_each(|[x, w]| *x += time * *w);
    polygon
}

/// Returns the sum of a polygon and the vertical segment from `-by` to `by`.
fn thickened(polygon: &Polygon, by: f64) -> Polygon {
    let count = polygon.len();
    let extreme =
        |sign: f64| (0..count).max_by(|a, b| (sign * polygon[*a][0]).total_cmp(&(sign * polygon[*b][0]))).unwrap_or(0);
    let (left, right) = (extreme(-1.0), extreme(1.0));
    let mut sum = Vec::with_capacity(count + 2);
    // The lower side runs from the left to the right.
    let mut k = left;
    loop {
        sum.push([polygon[k][0], polygon[k][1] - by]);
        if k == right {
            break;
        }
        k = (k + 1) % count;
    }
    loop {
        sum.push([polygon[k][0], polygon[k][1] + by]);
        if k == left {
            return sum;
        }
        k = (k + 1) % count;
    }
}

/// Returns the part of a polygon in which a coordinate is within an interval.
fn clipped(polygon: Polygon, axis: usize, [lower, upper]: [f64; 2]) -> Polygon {
    let normal = if axis == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
    cut(cut(polygon, normal, upper), normal.map(|x: f64| -x), -lower)
}

/// Returns the part of a polygon that is at most this far in a direction.
fn cut(polygon: Polygon, normal: [f64; 2], limit: f64) -> Polygon {
    let far = |p: &[f64; 2]| normal[0] * p[0] + normal[1] * p[1] - limit;
    if polygon.iter().all(|p| far(p) <= 0.0) {
        return polygon;
    }
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (a, b) = (far(p), far(&q));
        if a <= 0.0 {
            kept.push(*p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let share = a / (a - b);
            kept.push([p[0] + (q[0] - p[0]) * share, p[1] + (q[1] - p[1]) * share]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_cases::dice::Dice;

    /// Returns values of a random motion from rest to rest at times that are `step` seconds apart, and the motion's limits. Its
    /// acceleration is piecewise constant.
    fn random_motion(dice: &mut Dice, step: f64, times: usize) -> (Vec<f64>, Reach) {
        let parts = 40;
        let h = step * times as f64 / f64::from(parts);
        let acceleration = dice.within(0.5, 3.0);
        // Speeds at the ends of parts: a random walk that returns to 0.
        let mut speeds = vec![0.0];
        for k in 1..parts {
            let most = acceleration * h * f64::from(parts - k);
            let jump = if dice.chance(0.7) { acceleration * h } else { dice.within(0.0, acceleration * h) };
            let sign = if dice.chance(0.6) { 1.0 } else { -1.0 };
            speeds.push((speeds[speeds.len() - 1] + sign * jump).clamp(-most, most));
        }
        speeds.push(0.0);
        let from = dice.within(-1.0, 1.0);
        let mut values = vec![from];
        for w in speeds.windows(2) {
            values.push(values[values.len() - 1] + h * (w[0] + w[1]) / 2.0);
        }
        let at = |time: f64| {
            let k = ((time / h) as usize).min(speeds.len() - 2);
            let u = time - k as f64 * h;
            values[k] + speeds[k] * u + (speeds[k + 1] - speeds[k]) / h * u * u / 2.0
        };
        let sampled = (0..=times).map(|k| at(k as f64 * step)).collect();
        let velocity = speeds.iter().fold(1e-3, |most: f64, v| most.max(v.abs()));
        let greatest = speeds.windows(2).map(|w| (w[1] - w[0]).abs() / h).fold(0.0, f64::max);
        let ends = [from, values[values.len() - 1]];
        let range = [
            values.iter().fold(f64::INFINITY, |a, b| a.min(*b)),
            values.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)),
        ];
        let spread = greatest * h * h + 1e-9;
        (sampled, Reach { ends, velocity, acceleration: greatest, range: [range[0] - spread, range[1] + spread] })
    }

    #[test]
    fn no_motion_leaves_its_intervals() {
        for seed in cplan_cases::seeds(300) {
            let mut dice = Dice::new(seed);
            let (step, times) = (dice.within(0.01, 0.2), dice.below(20_usize) + 2);
            let (values, reach) = random_motion(&mut dice, step, times);
            let mut intervals = vec![reach.range; times + 1];
            // Some intervals are narrower already.
            for _ in 0..dice.below(4_usize) {
                let k = dice.below(times + 1);
                intervals[k] = [values[k] - dice.within(0.0, 0.05), values[k] + dice.within(0.0, 0.05)];
            }
            let mut tube = reach.tube(intervals, step).unwrap_or_else(|| panic!("seed {seed}"));
            for _ in 0..20 {
                for (value, [lower, upper]) in values.iter().zip(&tube.intervals) {
                    assert!(lower <= value && value <= upper, "seed {seed}: {value} {lower} {upper}");
                }
                let time = dice.below(times - 1) + 1;
                let [lower, upper] = tube.intervals[time];
                let middle = lower + (upper - lower) * dice.within(0.0, 1.0);
                let half = if values[time] <= middle { [lower, middle] } else { [middle, upper] };
                tube = reach.halved(&tube, time, half).unwrap_or_else(|| panic!("seed {seed}"));
                // The same motions, without the tube that is known.
                let again = reach.tube(tube.intervals.clone(), step).unwrap_or_else(|| panic!("seed {seed}"));
                for (known, other) in tube.intervals.iter().zip(again.intervals) {
                    assert!((known[0] - other[0]).abs().max((known[1] - other[1]).abs()) < 1e-4, "seed {seed}");
                }
            }
        }
    }

    #[test]
    fn intervals_are_those_of_the_fastest_motions() {
        // One unit at 4 units/s2 takes 1 s, in two parabolas.
        let reach = Reach { ends: [0.0, 1.0], velocity: 9.0, acceleration: 4.0, range: [-5.0, 5.0] };
        let tube = reach.tube(vec![reach.range; 9], 0.125 * (1.0 + 1e-9)).unwrap();
        for (k, [lower, upper]) in tube.intervals.into_iter().enumerate() {
            let time = 0.125 * k as f64;
            let expected = if time < 0.5 { 2.0 * time * time } else { 1.0 - 2.0 * (1.0 - time) * (1.0 - time) };
            assert!((lower - expected).abs() < 1e-3 && (upper - expected).abs() < 1e-3, "{lower} {upper} {expected}");
        }
        assert!(reach.tube(vec![reach.range; 9], 0.124).is_none());
        // The speed limit makes it slower: 1 s at 1 unit/s, and a quarter of a second for speeding up and slowing down.
        let slow = Reach { velocity: 1.0, ..reach };
        let is_possible = |duration: f64| slow.tube(vec![slow.range; 33], duration / 32.0).is_some();
        assert!(!is_possible(1.24) && is_possible(1.25 + 1e-6));
    }
}
