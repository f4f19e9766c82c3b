//! Decides which arm passes first: a monotone route through the coordination diagram, and the earliest departures that follow it.
//!
//! Both motions consist of legs from rest to rest. A route through the diagram from the beginning of both to the end of both
//! passes each rectangle on one side, so one arm leaves it before the other enters. For these orders, the earliest
//! departures of all legs are the longest paths in a graph of differences.

use crate::diagram::Rectangle;
use cplan_interrupt::checkpoint;
use std::ops::Range;

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

/// A route through the diagram: the times of both arms, each never decreasing.
#[derive(Debug, Clone)]
pub(crate) struct Route {
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

/// Motion of the arms in one step of the route.
const BOTH: usize = 2;

impl Diagram {
    /// Returns the fastest route through the diagram, as far as the grid shows, for clocks that differ by `skew` seconds.
    /// Returns `None` if all routes are blocked.
    pub fn route(&self, waits: Waits, skew: f64) -> Option<Route> {
        let grid = Grid::new(self, skew + 2.0 * SPARE);
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
                    return Route { places };
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

    /// Returns the earliest departures of all legs of both arms that follow a route, although the clock of one arm may be ahead
    /// of the other's by `skew` seconds. Returns `None` if the orders contradict
    /// each other.
    pub fn departures(&self, route: &Route, skew: f64) -> Option<[Vec<f64>; 2]> {
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
            let (first, second) = if route.passes_first(rectangle) == 0 { (0, 1) } else { (1, 0) };
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

impl Route {
    /// Returns the arm that passes a rectangle first.
    fn passes_first(&self, rectangle: &Rectangle) -> usize {
        let [x, y] = rectangle.times.map(|[from, to]| f64::midpoint(from, to));
        let next = self.places.partition_point(|[a, _]| *a < x).clamp(1, self.places.len() - 1);
        let [[a, b], [c, d]] = [self.places[next - 1], self.places[next]];
        let along = if c > a { b + (d - b) * ((x - a) / (c - a)) } else { b };
        // Where the route is above, the second arm is farther.
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
    /// For each cell, true if both arms must not move in it.
    is_blocked: Vec<bool>,
    /// For each arm that waits at a boundary while the other moves through a cell: true if rectangles lie before the
    /// boundary, and after it.
    beside: [Vec<[bool; 2]>; 2],
}

impl Grid {
    /// Creates the grid. Rectangles are longer by `wider` seconds for steps of both arms.
    fn new(diagram: &Diagram, wider: f64) -> Self {
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
        // Before the start and after the goal, there is no route.
        let beside = [(0, n, m), (1, m, n)].map(|(_, own, other)| {
            let boundary = |k: usize| [k == 0, k == own];
            (0..=own).flat_map(|k| std::iter::repeat_n(boundary(k), other)).collect::<Vec<_>>()
        });
        let mut grid = Self { bounds, step, is_blocked: vec![false; n * m], beside };
        for rectangle in &diagram.rectangles {
            let [from, to] = rectangle.times[0];
            for i in grid.cells(0, [from - wider, to + wider]) {
                grid.cells(1, rectangle.times[1]).for_each(|j| grid.is_blocked[i * m + j] = true);
            }
            for arm in 0..2 {
                let other = 1 - arm;
                let ([from, to], others) = (rectangle.times[arm], grid.bounds[other].len() - 1);
                let near = CELL_ROUNDING * step;
                for k in 0..grid.bounds[arm].len() {
                    let at = grid.bounds[arm][k];
                    let sides = [from + near < at && at <= to + near, from - near <= at && at < to - near];
                    if sides[0] || sides[1] {
                        for cell in grid.cells(other, rectangle.times[other]) {
                            let known = &mut grid.beside[arm][k * others + cell];
                            *known = [known[0] || sides[0], known[1] || sides[1]];
                        }
                    }
                }
            }
        }
        grid
    }

    /// Returns the cells of an arm that an interval of time meets.
    fn cells(&self, arm: usize, [from, to]: [f64; 2]) -> Range<usize> {
        let (bounds, near) = (&self.bounds[arm], CELL_ROUNDING * self.step);
        let first = bounds.partition_point(|at| *at <= from + near).max(1) - 1;
        first..bounds.partition_point(|at| *at < to - near).min(bounds.len() - 1)
    }

    fn is_free(&self, i: usize, j: usize) -> bool {
        !self.is_blocked[i * (self.bounds[1].len() - 1) + j]
    }

    /// Returns true if an arm may move alone from a node to the next one, while the other one waits: if no rectangle lies
    /// before the place of the other arm, or none after it.
    fn is_open(&self, node: [usize; 2], arm: usize) -> bool {
        let other = 1 - arm;
        let cells = self.bounds[arm].len() - 1;
        let [before, after] = self.beside[other][node[other] * cells + node[arm]];
        !(before && after) || self.bounds[other].len() == 1
    }
}

#[cfg(test)]
mod brute_force;

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

    /// Returns true if no rectangle has both arms in it at once with these departures.
    fn is_safe(diagram: &Diagram, departs: [f64; 2]) -> bool {
        diagram.rectangles.iter().all(|rectangle| {
            let [one, two] = [0, 1].map(|arm| rectangle.times[arm].map(|time| departs[arm] + time));
            one[0].max(two[0]) >= one[1].min(two[1])
        })
    }

    #[test]
    fn departures_are_the_earliest_that_brute_force_finds() {
        let mut delayed = 0;
        for seed in cplan_cases::seeds(60) {
            let diagram = random(seed);
            let ends = diagram.legs.each_ref().map(|legs| legs[1]);
            let last = |departs: [f64; 2]| (departs[0] + ends[0]).max(departs[1] + ends[1]);
            // Only the difference of the departures matters. A route through a single point of the diagram does not count.
            let delays = [0.0].into_iter().chain((0..=20).map(|delay| f64::from(delay) + 0.02));
            let candidates = delays.flat_map(|delay| [[delay, 0.0], [0.0, delay]]);
            let best = candidates.filter(|departs| is_safe(&diagram, *departs)).map(last).fold(f64::INFINITY, f64::min);
            let route = diagram.route(Waits::BetweenLegs, 0.0);
            let found =
                route.and_then(|route| diagram.departures(&route, 0.0)).map(|departs| [departs[0][0], departs[1][0]]);
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
        let route = diagram.route(Waits::BetweenLegs, 0.0).unwrap();
        let later = |skew: f64| {
            let [one, two] = diagram.departures(&route, skew).unwrap();
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
        assert!(closed.is_deadlock() && closed.route(Waits::Anywhere { cost: [0.1; 2] }, 0.0).is_none());
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
        let route = diagram.route(Waits::BetweenLegs, 0.0).unwrap();
        let [one, two] = diagram.departures(&route, 0.0).unwrap();
        // The first arm waits at its stop until the second has passed.
        assert!(two[0] < 0.01 && one[0] == 0.0 && (one[1] - 6.0).abs() < 0.01, "{one:?} {two:?}");
        let without = Diagram {
            legs: [vec![0.0, 10.0], vec![0.0, 10.0]],
            rectangles: vec![first, Rectangle { legs: [0, 0], ..second }],
        };
        let route = without.route(Waits::BetweenLegs, 0.0).and_then(|route| without.departures(&route, 0.0));
        assert!(route.is_none(), "{route:?}");
        let stops = without.route(Waits::Anywhere { cost: [0.5; 2] }, 0.0).unwrap().waits();
        assert!(!stops[0].is_empty() && stops[1].is_empty(), "{stops:?}");
    }
}
