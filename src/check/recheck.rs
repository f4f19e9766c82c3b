//! Checking a proof of disconnection without trusting who made it.
//!
//! Shares no code with the search that made the proof: depths come from the Minkowski difference, motions from chords,
//! and that the boxes separate start and goals is decided by a sweep over what they leave of the domain.

use super::disconnection::{Disconnection, StuckBox};
use crate::geometry::penetration_depth;
use crate::interrupt::checkpoint;
use crate::model::{Motion, Scene};
use crate::space::{Configuration, GoalSet, Segment, Topology};
use petgraph::unionfind::UnionFind;
use thiserror::Error;

/// Share of the lengths involved by which a depth must exceed the motion, far above the rounding of either.
const ROUNDING: f64 = 1e-12;

/// Why a claimed proof proves nothing.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProofDefect {
    /// The box names shapes that cannot meet, or do not exist.
    #[error("stuck box {0} names a pair of shapes that the scene does not have")]
    UnknownPair(usize),
    /// The box is empty, or not within the domain.
    #[error("stuck box {0} is no part of the configuration space")]
    NotInDomain(usize),
    /// Its shapes could come apart within the box.
    #[error(
        "stuck box {index}: the shapes overlap by {depth:e} m in its middle, but can move by {motion:e} m within it"
    )]
    NotStuck {
        /// Which box.
        index: usize,
        /// Penetration depth in the middle, clearance included, metres.
        depth: f64,
        /// How far points of the link can move from there, metres.
        motion: f64,
    },
    /// The start and some of this piece of the goals lie in one connected part of what the boxes leave.
    #[error("the stuck boxes do not separate the start from goal {0}")]
    NotSeparated(usize),
}

impl Disconnection {
    /// Checks this proof against the problem; see [`recheck`].
    ///
    /// # Errors
    /// The first [`ProofDefect`].
    pub fn recheck(
        &self,
        scene: &Scene,
        start: Configuration,
        goals: &GoalSet,
        clearance: f64,
    ) -> Result<(), ProofDefect> {
        recheck(self.stuck(), scene, start, goals, clearance)
    }
}

/// Checks a claim, wherever it comes from: that in each of the boxes its pair is nearer than `clearance` (or touches),
/// and that together they separate the start from all goals. `O(n log n)` for `n` boxes, times the number of boxes above
/// one another.
///
/// # Errors
/// The first [`ProofDefect`].
pub fn recheck(
    stuck: &[StuckBox],
    scene: &Scene,
    start: Configuration,
    goals: &GoalSet,
    clearance: f64,
) -> Result<(), ProofDefect> {
    let topology = scene.arm().topology();
    for (index, stuck) in stuck.iter().enumerate() {
        check_box(scene, &topology, index, stuck, clearance)?;
        checkpoint();
    }
    let slabs = Slabs::new(&topology, stuck);
    // A start or goal inside a stuck box is not free: nothing leads there.
    let Some(from) = slabs.locate(topology.wrap(start)) else { return Ok(()) };
    let groups = slabs.groups(&topology);
    let joined = |goals: Segment| slabs.holding(&goals).into_iter().any(|to| groups.equiv(to, from));
    goals.wrapped(&topology).position(joined).map_or(Ok(()), |goal| Err(ProofDefect::NotSeparated(goal)))
}

fn check_box(
    scene: &Scene,
    topology: &Topology,
    index: usize,
    stuck: &StuckBox,
    clearance: f64,
) -> Result<(), ProofDefect> {
    let cell = &stuck.cell;
    for k in 0..2 {
        let (lower, upper) = topology.axes[k].domain();
        if !(lower <= cell.lower[k] && cell.lower[k] < cell.upper[k] && cell.upper[k] <= upper) {
            return Err(ProofDefect::NotInDomain(index));
        }
    }
    if scene.pairs().binary_search(&stuck.pair).is_err() {
        return Err(ProofDefect::UnknownPair(index));
    }
    let middle = Configuration::from_fn(|k, _| (cell.lower[k] + cell.upper[k]) / 2.0);
    // The middle is rounded: the farther of the two ends counts.
    let half = [0, 1].map(|k| (cell.upper[k] - middle[k]).max(middle[k] - cell.lower[k]));
    let part = scene.part(stuck.pair).at(&scene.arm().pose(stuck.pair.link, middle));
    let piece = scene.piece(stuck.pair).grown(clearance);
    let depth = penetration_depth(&part, &piece);
    let motion = farthest(scene, stuck, middle, half);
    let scale = part.reach_from(scene.arm().base) + piece.reach_from(scene.arm().base) + scene.arm().base.coords.norm();
    if depth > motion + ROUNDING * scale { Ok(()) } else { Err(ProofDefect::NotStuck { index, depth, motion }) }
}

/// Farthest that a corner of the link's part can move from where it is at `q` while each joint moves by at most `half`:
/// a turn by `t` about a point at distance `r` moves by the chord `2 r sin(t / 2)`.
fn farthest(scene: &Scene, stuck: &StuckBox, q: Configuration, half: [f64; 2]) -> f64 {
    let arm = scene.arm();
    let chord = |angle: f64| 2.0 * (angle.min(std::f64::consts::PI) / 2.0).sin();
    let of_corner = |a: nalgebra::Vector2<f64>| match (stuck.pair.link, arm.joints[0].motion, arm.joints[1].motion) {
        (0, Motion::Revolute { .. }, _) => a.norm() * chord(half[0]),
        (0, Motion::Prismatic { .. }, _) => half[0],
        (_, Motion::Revolute { .. }, Motion::Revolute { .. }) => {
            arm.offset.norm() * chord(half[0]) + a.norm() * chord(half[0] + half[1])
        }
        (_, Motion::Revolute { .. }, Motion::Prismatic { direction }) => {
            let at = |slide: f64| (arm.offset + direction * (q[1] + slide) + a).norm();
            // Joint 2 first, then the turn about the base at the farther of the two ends: distance is convex.
            half[1] + at(half[1]).max(at(-half[1])) * chord(half[0])
        }
        (_, Motion::Prismatic { .. }, Motion::Revolute { .. }) => half[0] + a.norm() * chord(half[1]),
        (_, Motion::Prismatic { .. }, Motion::Prismatic { .. }) => half[0] + half[1],
    };
    scene.part(stuck.pair).core().iter().map(|p| of_corner(p.coords)).fold(0.0, f64::max)
}

/// What closed boxes leave of the domain: strips of `q1` between the boxes' sides, and in each the open gaps of `q2`.
struct Slabs {
    /// Ends of the strips, ascending.
    ends: Vec<f64>,
    /// Gaps of all strips, strip by strip, ascending.
    gaps: Vec<[f64; 2]>,
    /// Where each strip's gaps begin in `gaps`; one more at the end.
    first: Vec<usize>,
}

impl Slabs {
    fn new(topology: &Topology, boxes: &[StuckBox]) -> Self {
        let (left, right) = topology.axes[0].domain();
        let (bottom, top) = topology.axes[1].domain();
        let mut ends: Vec<f64> = boxes.iter().flat_map(|b| [b.cell.lower[0], b.cell.upper[0]]).collect();
        ends.extend([left, right]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_by(|&a, &b| boxes[a].cell.lower[0].total_cmp(&boxes[b].cell.lower[0]));
        let mut waiting = order.into_iter().peekable();
        let mut active: Vec<usize> = Vec::new();
        let (mut gaps, mut first) = (Vec::new(), vec![0]);
        for strip in ends.windows(2) {
            checkpoint();
            active.retain(|&b| boxes[b].cell.upper[0] > strip[0]);
            while let Some(b) = waiting.next_if(|&b| boxes[b].cell.lower[0] <= strip[0]) {
                active.push(b);
            }
            active.sort_by(|&a, &b| boxes[a].cell.lower[1].total_cmp(&boxes[b].cell.lower[1]));
            let mut from = bottom;
            for &b in &active {
                let cell = &boxes[b].cell;
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

    /// The gap that holds `q`; none if a box does.
    fn locate(&self, q: Configuration) -> Option<usize> {
        let beside = |i: &usize| self.ends[*i] <= q[0] && q[0] <= self.ends[*i + 1];
        let strips: Vec<usize> = (0..self.first.len() - 1).filter(beside).collect();
        let within = |strip: usize| self.strip(strip).find(|&g| self.gaps[g][0] <= q[1] && q[1] <= self.gaps[g][1]);
        strips.into_iter().find_map(within)
    }

    /// The gaps that hold any of a segment, sides included; one of them for a point.
    fn holding(&self, piece: &Segment) -> Vec<usize> {
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

    /// Gaps that belong together: of neighbouring strips (round the circle too) where they overlap, and of one strip
    /// across the seam of the second axis.
    fn groups(&self, topology: &Topology) -> UnionFind<usize> {
        let strips = self.first.len() - 1;
        let mut groups = UnionFind::new(self.gaps.len());
        let round = topology.axes[0].is_circle().then_some((strips - 1, 0));
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
        if topology.axes[1].is_circle() {
            let (bottom, top) = topology.axes[1].domain();
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
    use crate::check::Cell;
    use crate::model::Pair;
    use crate::space::Axis;
    use std::f64::consts::PI;

    /// A box all along one axis leaves two parts, which are one across the seam of the other axis if that is a circle.
    #[test]
    fn a_seam_joins_what_a_band_leaves() {
        let turn = Axis::Circle;
        let bounded = Axis::Interval { lower: -PI, upper: PI };
        for band in [0, 1] {
            let mut cell = Cell { lower: [-PI; 2], upper: [PI; 2] };
            cell.lower[band] = 0.0;
            cell.upper[band] = 1.0;
            let pair = Pair { link: 0, part: 0, obstacle: 0, piece: 0 };
            let boxes = [StuckBox { cell, pair }];
            let (mut below, mut above) = (Configuration::zeros(), Configuration::zeros());
            below[band] = -2.0;
            above[band] = 2.0;
            for across in [turn, bounded] {
                let mut axes = [turn; 2];
                axes[band] = across;
                let topology = Topology { axes };
                let slabs = Slabs::new(&topology, &boxes);
                let at = |q| slabs.locate(q).expect("no box holds it");
                let joined = slabs.groups(&topology).equiv(at(below), at(above));
                assert_eq!(joined, across.is_circle(), "band along axis {}", 1 - band);
            }
        }
    }
}
