//! The values that one joint can have at given times, if it begins and ends at rest and its acceleration and speed are limited.

/// Widening of limits because of rounding, as a share of them.
const ROUNDING: f64 = 1e-9;

/// Widening of common parts because of rounding, in the unit of the joint.
const COMMON_ROUNDING: f64 = 1e-8;

/// Least length of a side that bounds a common part. The direction of a shorter side depends on rounding: corners are exact to some
/// 1e-15, so the line through this side is exact to [`COMMON_ROUNDING`] over more than ten units.
const LEAST_SIDE: f64 = 1e-5;

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

impl Reach {
    /// Narrows intervals of the joint at times that are `step` seconds apart, the first at the start and the last at the goal.
    /// All motions within them remain within them. Returns false if there are no such motions.
    ///
    /// An acceleration of at most `a` changes the mean speed between two times by at most `a h` up to the next mean speed. From
    /// rest to the first mean speed and from the last one to rest, the change is at most `a h / 2`. So the pairs of a value
    /// and the next mean speed that can be reached from the start are a convex polygon, and so are those from which the goal can be
    /// reached.
    pub fn narrow(&self, intervals: &mut [[f64; 2]], step: f64) -> bool {
        let slack = self.ends.map(|end| ROUNDING * (1.0 + end.abs()));
        let change = self.acceleration * step * (1.0 + ROUNDING);
        let fastest = self.velocity * (1.0 + ROUNDING);
        let last = intervals.len() - 1;
        for (k, end) in [0, last].into_iter().zip(0..2) {
            let [from, to] = [self.ends[end] - slack[end], self.ends[end] + slack[end]];
            if intervals[k][0] > to || intervals[k][1] < from {
                return false;
            }
            intervals[k] = [intervals[k][0].max(from), intervals[k][1].min(to)];
        }
        let near_rest = (change / 2.0).min(fastest);
        let rectangle = |[a, b]: [f64; 2]| vec![[a, -near_rest], [b, -near_rest], [b, near_rest], [a, near_rest]];
        let next_speeds = |polygon: &Polygon| clipped(thickened(polygon, change), 1, [-fastest, fastest]);
        let mut forward = vec![rectangle(intervals[0])];
        for k in 1..last {
            let polygon = clipped(sheared(forward[k - 1].clone(), step), 0, intervals[k]);
            if polygon.is_empty() {
                return false;
            }
            forward.push(next_speeds(&polygon));
        }
        let mut backward = rectangle(intervals[last]);
        for k in (0..last).rev() {
            backward = common(sheared(backward, -step), &forward[k]);
            if backward.is_empty() {
                return false;
            }
            let values = backward.iter().map(|[x, _]| *x);
            let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            intervals[k] = [intervals[k][0].max(least - slack[0]), intervals[k][1].min(most + slack[0])];
            backward = next_speeds(&backward);
        }
        true
    }
}

/// Moves the values of a polygon by their speed for some seconds.
fn sheared(mut polygon: Polygon, time: f64) -> Polygon {
    polygon.iter_mut().for_each(|[x, w]| *x += time * *w);
    polygon
}

/// Returns the common part of two polygons, and possibly points near it.
fn common(mut polygon: Polygon, other: &Polygon) -> Polygon {
    for (k, p) in other.iter().enumerate() {
        let q = other[(k + 1) % other.len()];
        let along = [q[0] - p[0], q[1] - p[1]];
        let length = along[0].hypot(along[1]);
        if length >= LEAST_SIDE {
            let normal = [along[1] / length, -along[0] / length];
            polygon = cut(polygon, normal, normal[0] * p[0] + normal[1] * p[1] + COMMON_ROUNDING);
        }
    }
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
            assert!(reach.narrow(&mut intervals, step), "seed {seed}");
            for (value, [lower, upper]) in values.iter().zip(&intervals) {
                assert!(lower <= value && value <= upper, "seed {seed}: {value} {lower} {upper}");
            }
        }
    }

    #[test]
    fn intervals_are_those_of_the_fastest_motions() {
        // One unit at 4 units/s2 takes 1 s, in two parabolas.
        let reach = Reach { ends: [0.0, 1.0], velocity: 9.0, acceleration: 4.0, range: [-5.0, 5.0] };
        let mut intervals = vec![reach.range; 9];
        assert!(reach.narrow(&mut intervals, 0.125 * (1.0 + 1e-9)));
        for (k, [lower, upper]) in intervals.into_iter().enumerate() {
            let time = 0.125 * k as f64;
            let expected = if time < 0.5 { 2.0 * time * time } else { 1.0 - 2.0 * (1.0 - time) * (1.0 - time) };
            assert!((lower - expected).abs() < 1e-3 && (upper - expected).abs() < 1e-3, "{lower} {upper} {expected}");
        }
        assert!(!reach.narrow(&mut [reach.range; 9], 0.124));
        // The speed limit makes it slower: 1 s at 1 unit/s, and a quarter of a second for speeding up and slowing down.
        let slow = Reach { velocity: 1.0, ..reach };
        let is_possible = |duration: f64| slow.narrow(&mut [slow.range; 33], duration / 32.0);
        assert!(!is_possible(1.24) && is_possible(1.25 + 1e-6));
    }
}
