//! Pairs a motion with a line, whenever that is possible within a tolerance.
//!
//! The free-space diagram (Alt and Godau, 1995) has a row for each part of the motion and a column for each part of the line. A
//! pair of places is free if their distance is within the tolerance. The motion follows the line if and only if a path in the
//! free space leads from the beginning of both to their ends and never goes back. Parts are so short that they count as straight;
//! the tolerance in their cells is reduced by their deviation from chords. In a cell, the free space is convex, so the places
//! that can be reached on a side of a cell form one interval.

use crate::deviation::Foot;
use cplan_geometry::Point;

/// A part of a piece of the motion, or of the line.
pub(crate) struct Part {
    /// Index of the piece.
    pub piece: usize,
    /// The shares of the piece, or the parameters of its curve, at both ends.
    pub shares: [f64; 2],
    /// The points at both ends, metres.
    pub ends: [Point; 2],
    /// Bound on the distance of the part from its chord, metres.
    pub off: f64,
}

/// Shares of a part, from the least to the greatest.
#[derive(Clone, Copy)]
struct Interval {
    low: f64,
    high: f64,
}

/// The places of a part of the line that can be reached at the beginning of a part of the motion.
#[derive(Clone, Copy)]
struct Reached {
    part: usize,
    on: Interval,
}

/// The free-space diagram of a motion and a line.
pub(crate) struct FreeSpace {
    /// The parts of the motion.
    pub motion: Vec<Part>,
    /// The parts of the line.
    pub line: Vec<Part>,
    /// Greatest distance, metres.
    pub tolerance: f64,
}

impl FreeSpace {
    /// Returns places of the motion, each with a place on the line, from the beginning to the end of both, including the ends of
    /// all parts. A place of the motion is a part and a share of its chord. If there are none, the error is the index of the part
    /// of the motion after which no place of the line is near enough. `O(n k)` for `n` parts of the motion, with `k` parts of the
    /// line near each.
    pub fn pairs(&self) -> Result<Vec<(usize, f64, Foot)>, usize> {
        let (begins, reached) = self.reached()?;
        let mut pairs = Vec::with_capacity(self.motion.len() + self.line.len() + 1);
        let (mut part, mut share) = (self.line.len() - 1, 1.0);
        pairs.push((self.motion.len() - 1, 1.0, self.foot(part, share)));
        for row in (0..self.motion.len()).rev() {
            let before = &reached[begins[row]..begins[row + 1]];
            (part, share) = self.step_back(row, before, (part, share), &mut pairs).ok_or(row)?;
            pairs.push((row, 0.0, self.foot(part, share)));
        }
        pairs.reverse();
        Ok(pairs)
    }

    /// Returns the places of the line that can be reached at the beginning of each part of the motion: a list, and the index at
    /// which each part begins in it.
    fn reached(&self) -> Result<(Vec<usize>, Vec<Reached>), usize> {
        let mut begins = vec![0];
        let mut reached = vec![Reached { part: 0, on: Interval { low: 0.0, high: 0.0 } }];
        for row in 0..self.motion.len() {
            let (begin, end) = (begins[row], reached.len());
            begins.push(end);
            self.step(row, begin..end, &mut reached);
            if reached.len() == end {
                return Err(row);
            }
        }
        let ends = reached.last().is_some_and(|last| last.part + 1 == self.line.len() && last.on.high >= 1.0);
        if ends { Ok((begins, reached)) } else { Err(self.motion.len() - 1) }
    }

    /// Appends the places of the line that can be reached at the end of a part of the motion, from those at its beginning.
    fn step(&self, row: usize, before: std::ops::Range<usize>, reached: &mut Vec<Reached>) {
        let own = &self.motion[row];
        let mut next = before.start;
        let (mut part, mut beginning): (usize, Option<f64>) = (reached[next].part, None);
        while part < self.line.len() {
            let (line, radius) = (&self.line[part], self.radius(row, part));
            let left = (next < before.end && reached[next].part == part).then(|| reached[next].on);
            next += usize::from(left.is_some());
            let left = left.and_then(|on| near(line.ends, own.ends[0], radius)?.within(on)).map(|on| on.low);
            let bottom = beginning.and_then(|low| near(own.ends, line.ends[0], radius)?.from(low)).map(|on| on.low);
            let right = near(line.ends, own.ends[1], radius).and_then(|free| match (left, bottom) {
                (_, Some(_)) => Some(free),
                (Some(low), None) => free.from(low),
                (None, None) => None,
            });
            reached.extend(right.map(|on| Reached { part, on }));
            let top = near(own.ends, line.ends[1], radius).and_then(|free| match (left, bottom) {
                (Some(_), _) => Some(free),
                (None, Some(low)) => free.from(low),
                (None, None) => None,
            });
            beginning = top.map(|on| on.low);
            part = match beginning {
                Some(_) => part + 1,
                None if next < before.end => reached[next].part,
                None => break,
            };
        }
    }

    /// Returns the place at the beginning of a part of the motion that is nearest to the tip, among those from which a place at
    /// its end can be reached. Appends the ends of the line's parts in between, in reverse order.
    fn step_back(
        &self,
        row: usize,
        before: &[Reached],
        (last, share): (usize, f64),
        pairs: &mut Vec<(usize, f64, Foot)>,
    ) -> Option<(usize, f64)> {
        let own = &self.motion[row];
        let mut best: Option<(f64, usize, f64)> = None;
        let mut passed: Vec<Interval> = Vec::new();
        let (mut part, mut high) = (last, 1.0);
        loop {
            let (line, radius) = (&self.line[part], self.radius(row, part));
            let most = if part == last { share } else { 1.0 };
            let entry = before.binary_search_by_key(&part, |reached| reached.part).ok().map(|k| before[k].on);
            let on = entry.and_then(|on| near(line.ends, own.ends[0], radius)?.within(on)?.until(most));
            if let Some(on) = on {
                let share = projected(line.ends, own.ends[0]).clamp(on.low, on.high);
                let off = (at(line.ends, share) - own.ends[0]).norm();
                if best.is_none_or(|(least, ..)| off < least) {
                    best = Some((off, part, share));
                }
            }
            if part <= before[0].part {
                break;
            }
            let both = radius.min(self.radius(row, part - 1));
            let Some(on) = near(own.ends, line.ends[0], both).and_then(|free| free.until(high)) else { break };
            high = on.high;
            passed.push(on);
            part -= 1;
        }
        let (_, first, share) = best?;
        let (mut least, begin) = (0.0_f64, pairs.len());
        for part in first..last {
            let Interval { low, high } = passed[last - part - 1];
            least = projected(own.ends, self.line[part].ends[1]).clamp(least.max(low).min(high), high);
            pairs.push((row, least, self.foot(part, 1.0)));
        }
        pairs[begin..].reverse();
        Some((first, share))
    }

    /// Returns the greatest allowed distance between the chords of two parts, metres. Moments are placed on chords, so the
    /// deviation of the motion is subtracted twice.
    fn radius(&self, row: usize, part: usize) -> f64 {
        self.tolerance - 2.0 * self.motion[row].off - self.line[part].off
    }

    fn foot(&self, part: usize, share: f64) -> Foot {
        let Part { piece, shares: [from, to], .. } = self.line[part];
        Foot { piece, u: if share >= 1.0 { to } else { from + share * (to - from) } }
    }
}

impl Interval {
    fn from(self, low: f64) -> Option<Self> {
        (low <= self.high).then(|| Self { low: self.low.max(low), ..self })
    }

    fn until(self, high: f64) -> Option<Self> {
        (self.low <= high).then(|| Self { high: self.high.min(high), ..self })
    }

    fn within(self, other: Self) -> Option<Self> {
        self.from(other.low)?.until(other.high)
    }
}

fn at([a, b]: [Point; 2], share: f64) -> Point {
    if share >= 1.0 { b } else { a + (b - a) * share }
}

/// Returns the share of a segment that is nearest to a point.
fn projected([a, b]: [Point; 2], point: Point) -> f64 {
    let along = b - a;
    let square = along.norm_squared();
    if square > 0.0 { ((point - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the shares of a segment that are at most `radius` from a point.
fn near(ends: [Point; 2], point: Point, radius: f64) -> Option<Interval> {
    let middle = projected(ends, point);
    let off = (at(ends, middle) - point).norm();
    if off > radius {
        return None;
    }
    let along = ends[1] - ends[0];
    let length = along.norm();
    if length <= radius - off {
        return Some(Interval { low: 0.0, high: 1.0 });
    }
    // The nearest share of the whole straight line, and the distance from it.
    let foot = (point - ends[0]).dot(&along) / (length * length);
    let aside = (ends[0] + along * foot - point).norm();
    let half = (radius * radius - aside * aside).max(0.0).sqrt() / length;
    Some(Interval { low: (foot - half).clamp(0.0, middle), high: (foot + half).clamp(middle, 1.0) })
}
