//! Which arm passes first: a monotone way through the coordination diagram, and the earliest departures that follow it.
//!
//! Both motions consist of legs from rest to rest. A way through the diagram from the beginning of both to the end of both
//! passes each rectangle on one side, so one arm leaves it before the other enters. For these orders, the earliest
//! departures of all legs are the longest paths in a graph of differences.

use crate::diagram::Rectangle;
use cplan_interrupt::checkpoint;

/// Greatest number of cells of the grid along the longer motion. It only decides about orders, not about times.
const CELLS: usize = 160;

/// Seconds by which departures are later than the rectangles require. Times are rounded to nanoseconds.
const SPARE: f64 = 1e-4;

/// Relative size of a part of a cell that counts as none. Ends of rectangles and cells may differ by rounding.
const CELL_ROUNDING: f64 = 1e-9;

/// The motions of both arms, in time without any waits.
#[derive(Debug, Clone)]
pub(crate) struct Diagram {
    /// For each arm, the times at which legs begin, and the end of the last.
    pub legs: [Vec<f64>; 2],
    pub rectangles: Vec<Rectangle>,
}

/// A way through the diagram: the times of both arms, each never decreasing.
#[derive(Debug, Clone)]
pub(crate) struct Way {
    places: Vec<[f64; 2]>,
}

/// The places at which an arm may wait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Waits {
    /// Between legs, and at the start and the goal.
    BetweenLegs,
    /// Anywhere. A wait within a leg costs these seconds, because the arm must brake there.
    Anywhere {
        /// For each arm, the cost of a wait, seconds.
        cost: [f64; 2],
    },
}

/// Motion of the arms in one step of the way.
const BOTH: usize = 2;

impl Diagram {
    /// Returns the fastest way through the diagram, as far as the grid shows. `None` if there is none.
    pub fn way(&self, waits: Waits) -> Option<Way> {
        let grid = Grid::new(self);
        let [n, m] = [0, 1].map(|arm| grid.bounds[arm].len() - 1);
        let is_stop = |arm: usize, k: usize| {
            let at = grid.bounds[arm][k];
            self.legs[arm].iter().any(|time| (time - at).abs() <= CELL_ROUNDING * (1.0 + at))
        };
        let stops = [0, 1].map(|arm| (0..grid.bounds[arm].len()).map(|k| is_stop(arm, k)).collect::<Vec<_>>());
        // Returns the cost of beginning a wait of an arm at a boundary. `None` if it cannot wait there.
        let wait = |arm: usize, k: usize| match waits {
            _ if stops[arm][k] => Some(0.0),
            Waits::BetweenLegs => None,
            Waits::Anywhere { cost } => Some(cost[arm]),
        };
        // The least cost from each node to the end, and the next step there. The last index is the step before: an arm
        // that moves alone, or both. An arm that already waits pays nothing.
        let index = |i: usize, j: usize, before: usize| (i * (m + 1) + j) * 3 + before;
        let mut costs = vec![(f64::INFINITY, BOTH); (n + 1) * (m + 1) * 3];
        for (i, j) in (0..=n).rev().flat_map(|i| (0..=m).rev().map(move |j| (i, j))) {
            checkpoint();
            for before in 0..3 {
                if (i, j) == (n, m) {
                    costs[index(i, j, before)] = (0.0, BOTH);
                    continue;
                }
                let mut best = (f64::INFINITY, BOTH);
                let mut offer = |cost: f64, step: usize| {
                    if cost < best.0 {
                        best = (cost, step);
                    }
                };
                if i < n && j < m && grid.is_free(i, j) {
                    offer(1.0 + costs[index(i + 1, j + 1, BOTH)].0, BOTH);
                }
                if let Some(cost) = wait(1, j).filter(|_| i < n && grid.is_open([i, j], 0)) {
                    let cost = if before == 0 { 0.0 } else { cost / grid.step };
                    offer(1.0 + cost + costs[index(i + 1, j, 0)].0, 0);
                }
                if let Some(cost) = wait(0, i).filter(|_| j < m && grid.is_open([i, j], 1)) {
                    let cost = if before == 1 { 0.0 } else { cost / grid.step };
                    offer(1.0 + cost + costs[index(i, j + 1, 1)].0, 1);
                }
                costs[index(i, j, before)] = best;
            }
        }
        costs[index(0, 0, BOTH)].0.is_finite().then(|| {
            let (mut i, mut j, mut before, mut places) = (0, 0, BOTH, Vec::new());
            loop {
                places.push([grid.bounds[0][i], grid.bounds[1][j]]);
                if (i, j) == (n, m) {
                    return Way { places };
                }
                let step = costs[index(i, j, before)].1;
                (i, j, before) = (i + usize::from(step != 1), j + usize::from(step != 0), step);
            }
        })
    }

    /// Returns true if no coordination of these motions exists, not even if the arms also move back along them: proven
    /// collisions form a wall between the beginning of both motions and their end.
    pub fn is_deadlock(&self) -> bool {
        let walls: Vec<&Rectangle> = self.rectangles.iter().filter(|rectangle| rectangle.is_collision).collect();
        let [end, top] = self.legs.each_ref().map(|legs| legs[legs.len() - 1]);
        let is_upper = |rectangle: &Rectangle| rectangle.times[0][0] <= 0.0 || rectangle.times[1][1] >= top;
        let is_lower = |rectangle: &Rectangle| rectangle.times[0][1] >= end || rectangle.times[1][0] <= 0.0;
        let touch = |a: &Rectangle, b: &Rectangle| {
            (0..2).all(|arm| a.times[arm][0] <= b.times[arm][1] && b.times[arm][0] <= a.times[arm][1])
        };
        let (mut open, mut others): (Vec<_>, Vec<_>) = walls.into_iter().partition(|wall| is_upper(wall));
        while let Some(wall) = open.pop() {
            checkpoint();
            if is_lower(wall) {
                return true;
            }
            let (met, rest): (Vec<_>, Vec<_>) = others.into_iter().partition(|other| touch(wall, other));
            others = rest;
            open.extend(met);
        }
        false
    }

    /// Returns the earliest departures of all legs of both arms that follow a way, although the clock of one arm may be ahead
    /// of the other's by `skew` seconds. `None` if there are none.
    pub fn departures(&self, way: &Way, skew: f64) -> Option<[Vec<f64>; 2]> {
        let counts = self.legs.each_ref().map(|legs| legs.len() - 1);
        let node = |arm: usize, leg: usize| if arm == 0 { leg } else { counts[0] + leg };
        // Each entry states that the second node is later than the first by at least some seconds.
        let mut later = vec![vec![f64::NEG_INFINITY; counts[0] + counts[1]]; counts[0] + counts[1]];
        for arm in 0..2 {
            for leg in 1..counts[arm] {
                later[node(arm, leg - 1)][node(arm, leg)] = self.legs[arm][leg] - self.legs[arm][leg - 1];
            }
        }
        for rectangle in &self.rectangles {
            let (first, second) = if way.passes_first(rectangle) == 0 { (0, 1) } else { (1, 0) };
            let [leaves, enters] = [rectangle.times[first][1], rectangle.times[second][0]];
            let since = |arm: usize, time: f64| time - self.legs[arm][rectangle.legs[arm]];
            let gap = since(first, leaves) - since(second, enters) + skew + SPARE;
            let entry = &mut later[node(first, rectangle.legs[first])][node(second, rectangle.legs[second])];
            *entry = entry.max(gap);
            // The first arm stays at its goal, and the second is at its start from the beginning on.
            if leaves >= self.legs[first][counts[first]] || enters <= 0.0 {
                return None;
            }
        }
        let mut departs = vec![0.0_f64; later.len()];
        for _ in 0..=later.len() {
            let mut is_settled = true;
            for (from, row) in later.iter().enumerate() {
                for (to, gap) in row.iter().enumerate() {
                    if departs[from] + gap > departs[to] {
                        departs[to] = departs[from] + gap;
                        is_settled = false;
                    }
                }
            }
            if is_settled {
                let second = departs.split_off(counts[0]);
                return Some([departs, second]);
            }
        }
        None
    }
}

impl Way {
    /// Returns the arm that passes a rectangle first.
    fn passes_first(&self, rectangle: &Rectangle) -> usize {
        let [x, y] = rectangle.times.map(|[from, to]| f64::midpoint(from, to));
        let next = self.places.partition_point(|[a, _]| *a < x).clamp(1, self.places.len() - 1);
        let [[a, b], [c, d]] = [self.places[next - 1], self.places[next]];
        let along = if c > a { b + (d - b) * ((x - a) / (c - a)) } else { b };
        // Where the way is above, the second arm is farther.
        usize::from(along > y)
    }

    /// Returns for each arm the times on its motion at which it waits, without those at its start and goal.
    pub fn waits(&self) -> [Vec<f64>; 2] {
        let ends = self.places[self.places.len() - 1];
        [0, 1].map(|arm| {
            let is_wait = |w: &&[[f64; 2]]| w[0][arm] == w[1][arm] && w[0][arm] > 0.0 && w[0][arm] < ends[arm];
            let mut waits: Vec<f64> =
                self.places.windows(2).map(|w| [w[0], w[1]]).filter(|w| is_wait(&&w[..])).map(|w| w[0][arm]).collect();
            waits.dedup();
            waits
        })
    }
}

/// A grid on the diagram. Legs have whole numbers of cells.
struct Grid {
    /// For each arm, the times between cells.
    bounds: [Vec<f64>; 2],
    /// Length of a cell, seconds.
    step: f64,
    is_blocked: Vec<bool>,
}

impl Grid {
    fn new(diagram: &Diagram) -> Self {
        let end = |arm: usize| *diagram.legs[arm].last().expect("an end");
        let step = (end(0).max(end(1)) / CELLS as f64).max(f64::MIN_POSITIVE);
        let bounds = diagram.legs.each_ref().map(|legs| {
            let mut bounds = vec![legs[0]];
            for leg in legs.windows(2) {
                let (from, lasts) = (leg[0], leg[1] - leg[0]);
                let count = if lasts > 0.0 { (lasts / step).ceil().max(1.0) as usize } else { 0 };
                bounds.extend((1..count).map(|k| from + lasts * (k as f64 / count as f64)));
                bounds.extend((count > 0).then_some(leg[1]));
            }
            bounds
        });
        let [n, m] = [0, 1].map(|arm| bounds[arm].len() - 1);
        let mut is_blocked = vec![false; n * m];
        for rectangle in &diagram.rectangles {
            let cells = [0, 1].map(|arm| {
                let [from, to] = rectangle.times[arm];
                let near = CELL_ROUNDING * step;
                let first = bounds[arm].partition_point(|at| *at <= from + near).max(1) - 1;
                let end = bounds[arm].partition_point(|at| *at < to - near).min(bounds[arm].len() - 1);
                first..end
            });
            for i in cells[0].clone() {
                cells[1].clone().for_each(|j| is_blocked[i * m + j] = true);
            }
        }
        Self { bounds, step, is_blocked }
    }

    fn is_free(&self, i: usize, j: usize) -> bool {
        !self.is_blocked[i * (self.bounds[1].len() - 1) + j]
    }

    /// Returns true if an arm may move alone from a node to the next one: if a cell beside the step is free.
    fn is_open(&self, [i, j]: [usize; 2], arm: usize) -> bool {
        let [n, m] = [0, 1].map(|arm| self.bounds[arm].len() - 1);
        let beside = |k: usize, count: usize| [k.checked_sub(1), Some(k).filter(|k| *k < count)];
        if arm == 0 {
            beside(j, m).into_iter().flatten().any(|j| self.is_free(i, j)) || m == 0
        } else {
            beside(i, n).into_iter().flatten().any(|i| self.is_free(i, j)) || n == 0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a diagram without stops, with rectangles at multiples of a twentieth of the longer motion.
    fn random(seed: u64) -> Diagram {
        let mut dice = cplan_cases::dice::Dice::new(seed);
        let ends = [20.0, 10.0 + dice.below(11_u32) as f64];
        let mut rectangles = Vec::new();
        for _ in 0..dice.below(5_u32) {
            let times = ends.map(|end| {
                let from = 1.0 + dice.below(end as u32 - 2) as f64;
                [from, from + 1.0 + dice.below((end - from) as u32 - 1) as f64]
            });
            rectangles.push(Rectangle { times, legs: [0, 0], is_collision: true });
        }
        Diagram { legs: ends.map(|end| vec![0.0, end]), rectangles }
    }

    /// Returns true if the motions with these departures avoid all rectangles, in steps of a twentieth of a second.
    fn is_safe(diagram: &Diagram, departs: [f64; 2]) -> bool {
        let at = |time: f64| [0, 1].map(|arm| (time - departs[arm]).clamp(0.0, diagram.legs[arm][1]));
        let is_inside = |at: [f64; 2], rectangle: &Rectangle| {
            (0..2).all(|arm| rectangle.times[arm][0] < at[arm] && at[arm] < rectangle.times[arm][1])
        };
        (0..=1200).all(|k| !diagram.rectangles.iter().any(|rectangle| is_inside(at(f64::from(k) / 20.0), rectangle)))
    }

    #[test]
    fn departures_are_the_earliest_that_brute_force_finds() {
        let mut delayed = 0;
        for seed in cplan_cases::seeds(60) {
            let diagram = random(seed);
            let ends = diagram.legs.each_ref().map(|legs| legs[1]);
            let last = |departs: [f64; 2]| (departs[0] + ends[0]).max(departs[1] + ends[1]);
            // Only the difference of the departures matters. A way through a single point of the diagram is none.
            let delays = [0.0].into_iter().chain((0..=20).map(|delay| f64::from(delay) + 0.02));
            let candidates = delays.flat_map(|delay| [[delay, 0.0], [0.0, delay]]);
            let best = candidates.filter(|departs| is_safe(&diagram, *departs)).map(last).fold(f64::INFINITY, f64::min);
            let way = diagram.way(Waits::BetweenLegs);
            let found = way.and_then(|way| diagram.departures(&way, 0.0)).map(|departs| [departs[0][0], departs[1][0]]);
            let Some(departs) = found else {
                assert!(best.is_infinite(), "seed {seed}: {best}, {diagram:?}");
                continue;
            };
            assert!(is_safe(&diagram, departs), "seed {seed}: {departs:?}, {diagram:?}");
            assert!((last(departs) - best).abs() < 0.03, "seed {seed}: {departs:?} instead of {best}, {diagram:?}");
            delayed += usize::from(best > 20.0);
        }
        assert!(delayed > 10, "{delayed}");
    }

    #[test]
    fn skew_delays_the_second_arm() {
        let rectangles = vec![Rectangle { times: [[4.0, 6.0], [4.0, 6.0]], legs: [0, 0], is_collision: true }];
        let diagram = Diagram { legs: [vec![0.0, 10.0], vec![0.0, 10.0]], rectangles };
        let way = diagram.way(Waits::BetweenLegs).unwrap();
        let later = |skew: f64| {
            let [one, two] = diagram.departures(&way, skew).unwrap();
            one[0].max(two[0])
        };
        assert!((later(0.0) - 2.0).abs() < 0.01 && (later(0.5) - 2.5).abs() < 0.01);
    }

    #[test]
    fn a_wall_from_side_to_side_is_a_deadlock() {
        let wall = |times: [[f64; 2]; 2]| Rectangle { times, legs: [0, 0], is_collision: true };
        let diagram = |rectangles| Diagram { legs: [vec![0.0, 10.0], vec![0.0, 10.0]], rectangles };
        let closed = diagram(vec![
            wall([[0.0, 4.0], [5.0, 6.0]]),
            wall([[4.0, 7.0], [4.0, 6.0]]),
            wall([[6.0, 8.0], [0.0, 4.5]]),
        ]);
        assert!(closed.is_deadlock() && closed.way(Waits::Anywhere { cost: [0.1; 2] }).is_none());
        let open = diagram(vec![
            wall([[0.0, 4.0], [5.0, 6.0]]),
            wall([[4.5, 7.0], [4.0, 6.0]]),
            wall([[7.0, 8.0], [0.0, 4.0]]),
        ]);
        assert!(!open.is_deadlock());
        let undecided = Rectangle { is_collision: false, ..wall([[0.0, 10.0], [5.0, 6.0]]) };
        assert!(!diagram(vec![undecided]).is_deadlock());
    }

    #[test]
    fn a_stop_lets_both_arms_go_first_once() {
        // At its goal, the second arm blocks the first place, and the first arm the second place.
        let first = Rectangle { times: [[2.0, 3.0], [3.0, 10.0]], legs: [0, 0], is_collision: true };
        let second = Rectangle { times: [[6.0, 10.0], [6.0, 7.0]], legs: [1, 0], is_collision: true };
        let legs = [vec![0.0, 5.0, 10.0], vec![0.0, 10.0]];
        let diagram = Diagram { legs, rectangles: vec![first, second] };
        let way = diagram.way(Waits::BetweenLegs).unwrap();
        let [one, two] = diagram.departures(&way, 0.0).unwrap();
        // The first arm waits at its stop until the second has passed.
        assert!(two[0] < 0.01 && one[0] == 0.0 && (one[1] - 6.0).abs() < 0.01, "{one:?} {two:?}");
        let without = Diagram {
            legs: [vec![0.0, 10.0], vec![0.0, 10.0]],
            rectangles: vec![first, Rectangle { legs: [0, 0], ..second }],
        };
        let way = without.way(Waits::BetweenLegs).and_then(|way| without.departures(&way, 0.0));
        assert!(way.is_none(), "{way:?}");
        let stops = without.way(Waits::Anywhere { cost: [0.5; 2] }).unwrap().waits();
        assert!(!stops[0].is_empty() && stops[1].is_empty(), "{stops:?}");
    }
}
