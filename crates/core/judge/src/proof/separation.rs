//! Decides whether collision boxes separate the start from all goals.

use super::{Cell, CollisionBox};
use cplan_model::checkpoint;
use cplan_model::space::{Configuration, GoalSet, Segment, Topology};
use petgraph::unionfind::UnionFind;

/// Returns the index of the first goal with a part that is connected with the start outside the boxes. Indices are
/// those of [`GoalSet::wrapped`]. `None` if the boxes separate all goals from the start.
pub(super) fn not_separated(
    topology: &Topology,
    boxes: &[CollisionBox],
    start: Configuration,
    goals: &GoalSet,
) -> Option<usize> {
    let mut cells: Vec<Cell> = boxes.iter().map(|stuck| stuck.cell).collect();
    cells.extend(beyond_sum(topology, &cells));
    let slabs = Slabs::new(topology, &cells);
    // A start or goal inside a collision box is not free, so no path leads there.
    let from = slabs.locate(topology.wrap(start))?;
    let groups = slabs.groups(topology);
    let joined = |goals: Segment| slabs.gaps_meeting(&goals).into_iter().any(|to| groups.equiv(to, from));
    goals.wrapped(topology).position(joined)
}

/// Number of parts into which the range of joint 1 is cut, in addition to cuts at the ends of boxes. In each part,
/// boxes cover the configurations with a forbidden sum of joint values.
const SUM_PARTS: u32 = 4096;

/// Returns boxes in which all sums of joint values are forbidden.
fn beyond_sum(topology: &Topology, cells: &[Cell]) -> Vec<Cell> {
    if topology.sum.is_none() {
        return Vec::new();
    }
    let (left, right) = topology.ranges[0].domain();
    let mut ends: Vec<f64> = cells.iter().flat_map(|cell| [cell.lower[0], cell.upper[0]]).collect();
    ends.extend((0..=SUM_PARTS).map(|k| left + (right - left) * f64::from(k) / f64::from(SUM_PARTS)));
    ends.retain(|end| left <= *end && *end <= right);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let of_part = |ends: &[f64]| {
        let [from, to] = [ends[0], ends[1]];
        let closed = topology.closed_by_sum([from, to]);
        closed.map(move |[lower, upper]| Cell { lower: [from, lower], upper: [to, upper] })
    };
    ends.windows(2).flat_map(of_part).collect()
}

/// The part of the domain outside the closed boxes. It consists of strips of `q1` between sides of the boxes. Each
/// strip consists of gaps in `q2`, which are open intervals.
struct Slabs {
    /// Values of `q1` at the ends of the strips, ascending.
    ends: Vec<f64>,
    /// The gaps of all strips, strip by strip, ascending in each strip.
    gaps: Vec<[f64; 2]>,
    /// For each strip, the index of its first gap in `gaps`, followed by the number of gaps.
    first: Vec<usize>,
}

impl Slabs {
    fn new(topology: &Topology, cells: &[Cell]) -> Self {
        let (left, right) = topology.ranges[0].domain();
        let (bottom, top) = topology.ranges[1].domain();
        let mut ends: Vec<f64> = cells.iter().flat_map(|cell| [cell.lower[0], cell.upper[0]]).collect();
        ends.extend([left, right]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let mut order: Vec<usize> = (0..cells.len()).collect();
        order.sort_by(|&a, &b| cells[a].lower[0].total_cmp(&cells[b].lower[0]));
        let mut waiting = order.into_iter().peekable();
        let mut active: Vec<usize> = Vec::new();
        let (mut gaps, mut first) = (Vec::new(), vec![0]);
        for strip in ends.windows(2) {
            checkpoint();
            active.retain(|&b| cells[b].upper[0] > strip[0]);
            while let Some(b) = waiting.next_if(|&b| cells[b].lower[0] <= strip[0]) {
                active.push(b);
            }
            active.sort_by(|&a, &b| cells[a].lower[1].total_cmp(&cells[b].lower[1]));
            let mut from = bottom;
            for &b in &active {
                let cell = &cells[b];
                if cell.lower[1] > from {
                    gaps.push([from, cell.lower[1]]);
                }
                from = from.max(cell.upper[1]);
            }
            if from < top {
                gaps.push([from, top]);
            }
            first.push(gaps.len());
        }
        Self { ends, gaps, first }
    }

    fn strip(&self, index: usize) -> std::ops::Range<usize> {
        self.first[index]..self.first[index + 1]
    }

    /// Returns a gap that contains `q`, or has it at an end. `None` if `q` is inside a box.
    fn locate(&self, q: Configuration) -> Option<usize> {
        let beside = |i: &usize| self.ends[*i] <= q[0] && q[0] <= self.ends[*i + 1];
        let strips: Vec<usize> = (0..self.first.len() - 1).filter(beside).collect();
        let within = |strip: usize| self.strip(strip).find(|&g| self.gaps[g][0] <= q[1] && q[1] <= self.gaps[g][1]);
        strips.into_iter().find_map(within)
    }

    /// Returns the gaps that contain a part of a segment, including the sides of the gaps. For a point, returns only one gap.
    fn gaps_meeting(&self, piece: &Segment) -> Vec<usize> {
        let [from, to] = piece.ends();
        if piece.is_point() {
            return self.locate(from).into_iter().collect();
        }
        let (left, right) = (from[0].min(to[0]), from[0].max(to[0]));
        let strips = (0..self.first.len() - 1).filter(|&i| self.ends[i] <= right && left <= self.ends[i + 1]);
        let gaps = strips.flat_map(|i| self.strip(i).map(move |gap| (i, gap)));
        let meets = |&(i, gap): &(usize, usize)| {
            let [lower, upper] = self.gaps[gap];
            piece.meets([self.ends[i], lower], [self.ends[i + 1], upper])
        };
        gaps.filter(meets).map(|(_, gap)| gap).collect()
    }

    /// Joins connected gaps: gaps of neighbouring strips (also around the circle) if they overlap, and gaps of one
    /// strip at the seam of the second axis.
    fn groups(&self, topology: &Topology) -> UnionFind<usize> {
        let strips = self.first.len() - 1;
        let mut groups = UnionFind::new(self.gaps.len());
        let round = topology.ranges[0].is_circle().then_some((strips - 1, 0));
        for (a, b) in (1..strips).map(|i| (i - 1, i)).chain(round) {
            let (mut i, mut j) = (self.strip(a).start, self.strip(b).start);
            while i < self.strip(a).end && j < self.strip(b).end {
                let ([from_a, to_a], [from_b, to_b]) = (self.gaps[i], self.gaps[j]);
                if from_a.max(from_b) < to_a.min(to_b) {
                    groups.union(i, j);
                }
                if to_a < to_b { i += 1 } else { j += 1 }
            }
        }
        if topology.ranges[1].is_circle() {
            let (bottom, top) = topology.ranges[1].domain();
            for strip in (0..strips).map(|i| self.strip(i)).filter(|s| !s.is_empty()) {
                if self.gaps[strip.start][0] == bottom && self.gaps[strip.end - 1][1] == top {
                    groups.union(strip.start, strip.end - 1);
                }
            }
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::space::JointRange;
    use std::f64::consts::PI;

    /// Tests a box along a whole axis. The two remaining parts are connected across the seam if the other axis is a circle.
    #[test]
    fn a_seam_joins_what_a_band_leaves() {
        let turn = JointRange::Circle;
        let bounded = JointRange::Interval { lower: -PI, upper: PI };
        for band in [0, 1] {
            let mut cell = Cell { lower: [-PI; 2], upper: [PI; 2] };
            cell.lower[band] = 0.0;
            cell.upper[band] = 1.0;
            let (mut below, mut above) = (Configuration::zeros(), Configuration::zeros());
            below[band] = -2.0;
            above[band] = 2.0;
            for across in [turn, bounded] {
                let mut axes = [turn; 2];
                axes[band] = across;
                let topology = Topology::new(axes);
                let slabs = Slabs::new(&topology, &[cell]);
                let at = |q| slabs.locate(q).expect("no box holds it");
                let joined = slabs.groups(&topology).equiv(at(below), at(above));
                assert_eq!(joined, across.is_circle(), "band along axis {}", 1 - band);
            }
        }
    }
}
