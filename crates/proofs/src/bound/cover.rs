//! What is closed, over all turns of the joints that a short way could take.

use cplan_core::space::{Configuration, JointRange, Measure, Segment, Topology};
use cplan_geometry::{Point, merge_in_place};
use std::f64::consts::TAU;

/// A slice with what was seen closed: gaps between walls, ascending, over one turn of a joint 2 on a circle.
pub(super) struct HeldSlice {
    pub q1: f64,
    gaps: Vec<Gap>,
    /// Across the strip after it.
    pub barriers: Vec<[f64; 2]>,
}

/// Values of joint 2 that no wall closes; infinite where nothing does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gap {
    /// The least and the greatest.
    pub ends: [f64; 2],
    /// Whether a wall begins there, so that ways may turn there; or else the domain ends.
    pub turns: [bool; 2],
}

impl HeldSlice {
    /// The slice with these walls. On a circle they may lead across the seam.
    pub fn new(topology: &Topology, q1: f64, walls: &[[f64; 2]]) -> Self {
        Self { q1, gaps: gaps(topology.ranges[1], walls), barriers: Vec::new() }
    }

    /// Whether a value of joint 2 is in a wall, or at its end.
    fn is_closed(&self, range: JointRange, q2: f64) -> bool {
        let value = range.wrap(q2);
        let holds = |gap: &Gap, value: f64| gap.ends[0] < value && value < gap.ends[1];
        !self.gaps.iter().any(|gap| holds(gap, value) || range.is_circle() && holds(gap, value + TAU))
    }

    /// What the walls leave of goals at the slice; all of them if they are elsewhere.
    pub fn leaves(&self, topology: &Topology, piece: &Segment) -> Vec<Segment> {
        let [from, to] = piece.ends();
        if from[0] != to[0] || from[0] != self.q1 {
            return vec![*piece];
        }
        let turns = if topology.ranges[1].is_circle() { vec![-TAU, 0.0, TAU] } else { vec![0.0] };
        let left = turns.iter().flat_map(|turn| {
            let within = move |gap: &Gap| piece.within([from[0], gap.ends[0] + turn], [from[0], gap.ends[1] + turn]);
            self.gaps.iter().filter_map(within)
        });
        left.collect()
    }
}

/// What walls leave of the domain of joint 2.
fn gaps(axis: JointRange, walls: &[[f64; 2]]) -> Vec<Gap> {
    let (bottom, top) = axis.domain();
    let mut walls: Vec<[f64; 2]> = walls.to_vec();
    if axis.is_circle() {
        if walls.iter().any(|[lower, upper]| upper - lower >= TAU) {
            return Vec::new();
        }
        for wall in &mut walls {
            let width = wall[1] - wall[0];
            wall[0] = axis.wrap(wall[0]);
            wall[1] = wall[0] + width;
        }
    }
    merge_in_place(&mut walls);
    let (Some(&first), Some(&last)) = (walls.first(), walls.last()) else {
        let ends = if axis.is_circle() { [f64::NEG_INFINITY, f64::INFINITY] } else { [bottom, top] };
        return vec![Gap { ends, turns: [false; 2] }];
    };
    let between = walls.windows(2).map(|w| Gap { ends: [w[0][1], w[1][0]], turns: [true; 2] });
    let mut gaps: Vec<Gap> = Vec::new();
    if axis.is_circle() {
        // Round the circle the last wall may cover the first ones.
        gaps.extend(between.filter(|gap| gap.ends[1] > last[1] - TAU));
        for gap in &mut gaps {
            gap.ends[0] = gap.ends[0].max(last[1] - TAU);
        }
        if last[1] < first[0] + TAU {
            gaps.push(Gap { ends: [last[1], first[0] + TAU], turns: [true; 2] });
        }
    } else {
        gaps.extend((bottom < first[0]).then_some(Gap { ends: [bottom, first[0]], turns: [false, true] }));
        gaps.extend(between);
        gaps.extend((last[1] < top).then_some(Gap { ends: [last[1], top], turns: [true, false] }));
    }
    gaps
}

/// A slice on one turn of joint 1.
pub(super) struct CoverSlice {
    pub q1: f64,
    /// Ascending.
    pub gaps: Vec<Gap>,
    /// Number of the first of its gaps among those of all slices.
    pub first: usize,
}

/// All slices, barriers and goals that ways below a limit may come by.
pub(super) struct Cover {
    /// Ascending.
    pub slices: Vec<CoverSlice>,
    /// Barriers across the strip before each slice and after the last, ascending at both slices.
    pub strips: Vec<Vec<[f64; 2]>>,
    pub goals: Vec<Segment>,
}

/// A part of a strip between two barriers; infinite ends where there are none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub lower: [f64; 2],
    pub upper: [f64; 2],
}

impl Cover {
    pub fn new(
        topology: &Topology,
        slices: Vec<HeldSlice>,
        measure: Measure,
        start: Configuration,
        goals: &[Segment],
        limit: f64,
    ) -> Self {
        let far = [0, 1].map(|k| {
            let unit = Configuration::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
            limit / measure.norm(unit)
        });
        let turns = |k: usize, value: f64| -> Vec<f64> {
            let JointRange::Circle = topology.ranges[k] else { return vec![0.0] };
            let [least, most] = [-far[k], far[k]].map(|by| ((start[k] + by - value) / TAU).floor() as i64);
            // Walls and goals lead across a seam.
            (least - 1..=most + 1).map(|turn| turn as f64 * TAU).collect()
        };
        let anchor = slices.first().map_or(0.0, |slice| slice.q1);
        let by = turns(1, 0.0);
        let count = slices.len();
        let attached: Vec<Vec<[f64; 2]>> = (0..count)
            .map(|number| {
                let next = &slices[(number + 1) % count];
                let axis = topology.ranges[1];
                let mut barriers: Vec<[f64; 2]> = slices[number]
                    .barriers
                    .iter()
                    .copied()
                    // Ways turn at the ends of walls alone.
                    .filter(|[before, after]| slices[number].is_closed(axis, *before) && next.is_closed(axis, *after))
                    .flat_map(|ends| by.iter().map(move |by| ends.map(|q2| q2 + by)))
                    .collect();
                barriers.sort_by(|a, b| a[0].total_cmp(&b[0]));
                // Those that cross others are left out: cells are convex.
                barriers.dedup_by(|next, kept| next[0] <= kept[0] || next[1] <= kept[1]);
                barriers
            })
            .collect();
        let (low, high) = (start[1] - far[1], start[1] + far[1]);
        let mut this = Self { slices: Vec::new(), strips: vec![Vec::new()], goals: Vec::new() };
        let mut first = 0;
        for turn in turns(0, anchor) {
            for (slice, barriers) in slices.iter().zip(&attached) {
                let copies = by
                    .iter()
                    .flat_map(|by| slice.gaps.iter().map(move |gap| Gap { ends: gap.ends.map(|q2| q2 + by), ..*gap }));
                let mut gaps: Vec<Gap> = copies.filter(|gap| gap.ends[0] <= high && low <= gap.ends[1]).collect();
                gaps.dedup();
                let count = gaps.len();
                this.slices.push(CoverSlice { q1: slice.q1 + turn, gaps, first });
                this.strips.push(barriers.clone());
                first += count;
            }
        }
        if let Some(last) = this.strips.last_mut() {
            // Nothing is known beyond.
            last.clear();
        }
        for piece in goals {
            for first in turns(0, piece.ends()[0][0]) {
                for second in turns(1, piece.ends()[0][1]) {
                    this.goals.push(piece.shifted(Configuration::new(first, second)));
                }
            }
        }
        this.goals.retain(|goal| goal.distance(measure, start) < limit);
        this
    }

    /// The values of joint 1 at the ends of a strip, infinite beyond all slices.
    pub fn ends(&self, strip: usize) -> [f64; 2] {
        let at = |slice: Option<usize>, none: f64| {
            slice.and_then(|slice| self.slices.get(slice)).map_or(none, |slice| slice.q1)
        };
        [at(strip.checked_sub(1), f64::NEG_INFINITY), at(Some(strip), f64::INFINITY)]
    }

    /// The cells of a strip, ascending.
    pub fn cells(&self, strip: usize) -> impl Iterator<Item = Cell> {
        let barriers = &self.strips[strip];
        (0..=barriers.len()).map(move |k| Cell {
            lower: k.checked_sub(1).map_or([f64::NEG_INFINITY; 2], |below| barriers[below]),
            upper: barriers.get(k).copied().unwrap_or([f64::INFINITY; 2]),
        })
    }

    /// The part of goals in a cell of a strip.
    pub fn within(&self, goal: &Segment, strip: usize, cell: &Cell) -> Option<Segment> {
        let [from, to] = self.ends(strip);
        let part = goal.within([from, f64::NEG_INFINITY], [to, f64::INFINITY])?;
        let above = |line: [f64; 2], part: &Segment| {
            part.ends().map(|q| if line[0].is_finite() { q[1] - on(line, [from, to], q[0]) } else { -line[0] })
        };
        let [a, b] = above(cell.lower, &part);
        let part = part.where_positive(a, b)?;
        let [a, b] = above(cell.upper, &part);
        part.where_positive(-a, -b)
    }
}

/// The value of joint 2 on a barrier at a value of joint 1; infinite where there is none.
pub(super) fn on(barrier: [f64; 2], [from, to]: [f64; 2], q1: f64) -> f64 {
    match q1 {
        _ if q1 <= from || barrier[0] == barrier[1] => barrier[0],
        _ if q1 >= to => barrier[1],
        _ => barrier[0] + (barrier[1] - barrier[0]) * ((q1 - from) / (to - from)),
    }
}

impl CoverSlice {
    /// The place of the end of a gap.
    pub fn at(&self, gap: usize, end: usize) -> Point {
        Point::new(self.q1, self.gaps[gap].ends[end])
    }
}
