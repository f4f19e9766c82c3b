//! Lines of equal value on a grid.

use std::collections::BTreeMap;

/// Values at the crossings of a grid of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// First coordinates, ascending.
    pub x: Vec<f64>,
    /// Second coordinates, ascending.
    pub y: Vec<f64>,
    /// Values, ordered by `x`, then by `y`; not finite where the field has no value.
    pub values: Vec<f64>,
}

impl Samples {
    fn value(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.y.len() + j]
    }

    /// Returns the polylines on which the linearly interpolated values equal `level` (marching squares: Lorensen and Cline 1987,
    /// in two dimensions). A closed line ends at its first point. No line crosses a square with a missing value at a corner.
    /// `O(n log n)` for `n` squares.
    pub fn isolines(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let mut next: BTreeMap<Side, Vec<Side>> = BTreeMap::new();
        for i in 0..self.x.len().saturating_sub(1) {
            for j in 0..self.y.len().saturating_sub(1) {
                for (a, b) in self.crossings(i, j, level) {
                    next.entry(a).or_default().push(b);
                    next.entry(b).or_default().push(a);
                }
            }
        }
        let mut lines = Vec::new();
        // Follows open lines first, each from an end. Only loops remain.
        let ends: Vec<Side> = next.iter().filter(|(_, to)| to.len() == 1).map(|(side, _)| *side).collect();
        for begin in ends {
            lines.extend(self.walk(begin, &mut next, level));
        }
        while let Some((&begin, _)) = next.iter().find(|(_, to)| !to.is_empty()) {
            lines.extend(self.walk(begin, &mut next, level));
            next.retain(|_, to| !to.is_empty());
        }
        lines
    }

    /// Follows a line from `begin` to its end, and removes its sides from `next`.
    fn walk(&self, begin: Side, next: &mut BTreeMap<Side, Vec<Side>>, level: f64) -> Option<Vec<[f64; 2]>> {
        let mut line = vec![self.crossing(begin, level)];
        let mut at = begin;
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            if let Some(back) = next.get_mut(&to)
                && let Some(k) = back.iter().position(|s| *s == at)
            {
                back.swap_remove(k);
            }
            line.push(self.crossing(to, level));
            at = to;
        }
        (line.len() > 1).then_some(line)
    }

    /// Returns the pairs of sides of square `(i, j)` that lines connect. In a saddle, the mean of the corners decides which
    /// corners are connected.
    fn crossings(&self, i: usize, j: usize, level: f64) -> Vec<(Side, Side)> {
        let corners = [self.value(i, j), self.value(i + 1, j), self.value(i + 1, j + 1), self.value(i, j + 1)];
        if !corners.iter().all(|v| v.is_finite()) {
            return Vec::new();
        }
        let sides = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
        let above = corners.map(|v| v >= level);
        let crossed: Vec<Side> = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]).map(|k| sides[k]).collect();
        match crossed[..] {
            [a, b] => vec![(a, b)],
            [a, b, c, d] => {
                let middle_above = corners.iter().sum::<f64>() / 4.0 >= level;
                if middle_above == above[0] { vec![(a, b), (c, d)] } else { vec![(d, a), (b, c)] }
            }
            _ => Vec::new(),
        }
    }

    fn crossing(&self, (i, j, upright): Side, level: f64) -> [f64; 2] {
        let (to_i, to_j) = if upright { (i, j + 1) } else { (i + 1, j) };
        let (from, to) = (self.value(i, j), self.value(to_i, to_j));
        let t = (level - from) / (to - from);
        [self.x[i] + (self.x[to_i] - self.x[i]) * t, self.y[j] + (self.y[to_j] - self.y[j]) * t]
    }
}

/// A side of a square, which starts at crossing `(i, j)` and leads upwards if the third value is true, otherwise to the right.
type Side = (usize, usize, bool);

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(n: usize, f: impl Fn(f64, f64) -> f64) -> Samples {
        let axis: Vec<f64> = (0..n).map(|i| -1.0 + 2.0 * i as f64 / (n - 1) as f64).collect();
        let values = axis.iter().flat_map(|&x| axis.iter().map(move |&y| (x, y))).map(|(x, y)| f(x, y)).collect();
        Samples { x: axis.clone(), y: axis, values }
    }

    #[test]
    fn a_circle_is_one_closed_line_of_the_right_length() {
        let lines = samples(101, |x, y| -x.hypot(y)).isolines(-0.6);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        let length: f64 = lines[0].windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
        assert!((length - 0.6 * std::f64::consts::TAU).abs() < 5e-3, "{length}");
        assert!(lines[0].iter().all(|p| (p[0].hypot(p[1]) - 0.6).abs() < 1e-3));
    }

    #[test]
    fn open_lines_end_at_the_border_and_at_holes() {
        let lines = samples(11, |x, y| if y > 0.0 { f64::NEG_INFINITY } else { x }).isolines(0.05);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].len(), 6);
        assert!(lines[0].iter().all(|p| (p[0] - 0.05).abs() < 1e-12 && p[1] <= 0.0));
    }

    #[test]
    fn a_saddle_gives_two_lines() {
        for level in [-0.1, 0.1] {
            assert_eq!(samples(2, |x, y| x * y).isolines(level).len(), 2);
        }
    }

    #[test]
    fn an_empty_field_has_no_isolines() {
        assert!(samples(5, |_, _| f64::NEG_INFINITY).isolines(0.0).is_empty());
        assert!(samples(5, |_, _| 1.0).isolines(1.0).is_empty());
        assert!(Samples { x: vec![], y: vec![], values: vec![] }.isolines(0.0).is_empty());
    }

    /// Checks that lines visit each side that the level crosses once, except for the begin of a loop, which they visit twice.
    #[test]
    fn every_crossing_is_used_once() {
        let field = samples(40, |x, y| (5.0 * x).sin() * (7.0 * y).cos() + 0.3 * x);
        let level = 0.07;
        let mut crossed = 0;
        for i in 0..40 {
            for j in 0..40 {
                crossed += usize::from(i + 1 < 40 && (field.value(i, j) >= level) != (field.value(i + 1, j) >= level));
                crossed += usize::from(j + 1 < 40 && (field.value(i, j) >= level) != (field.value(i, j + 1) >= level));
            }
        }
        let used: usize = field.isolines(level).iter().map(|l| l.len() - usize::from(l[0] == l[l.len() - 1])).sum();
        assert_eq!(used, crossed);
    }
}
