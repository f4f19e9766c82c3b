//! The shortest path through a sequence of portals.

use super::{Measure, Metric, Segment};
use cplan_geometry::{Orientation, Point, orientation};
use std::collections::VecDeque;

/// A segment that a path crosses. Left and right are as seen by someone on the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portal {
    /// The left end.
    pub left: Point,
    /// The right end.
    pub right: Point,
}

/// Returns the shortest polyline from `start` to `goal` that crosses all portals in order.
///
/// Consecutive portals must lie on the border of a common convex cell; `start` lies in the first cell and `goal` in
/// the last. This is the *funnel* algorithm (Lee, Preparata 1984), with linear cost. Turns are decided exactly, so
/// in exact arithmetic the path crosses every portal.
pub fn funnel_path(start: Point, goal: Point, portals: &[Portal]) -> Vec<Point> {
    let turns = turns(start, goal, portals).into_iter().map(|turn| turn.at);
    let mut path: Vec<Point> = std::iter::once(start).chain(turns).chain([goal]).collect();
    path.dedup();
    path
}

/// Returns the goal on a segment with the shortest funnel path through the portals.
///
/// The length is a convex function of the goal's position, so golden-section search finds the minimum approximately.
/// After its last turn the path is straight. So the function also tries the goal nearest to that turn, and returns
/// it if its path is not longer. Computes some dozens of funnel paths.
pub fn nearest_end(start: Point, goals: &Segment, portals: &[Portal]) -> Point {
    let euclid = Measure::from(Metric::Euclidean);
    let length = |share: f64| {
        let path = funnel_path(start, goals.at(share), portals);
        let last = path[path.len().saturating_sub(2)];
        (path.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>(), last)
    };
    if goals.is_point() {
        return goals.ends()[0];
    }
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut lower, mut upper) = (0.0, 1.0);
    for _ in 0..GOLDEN_SECTIONS {
        let [a, b] = [upper - golden * (upper - lower), lower + golden * (upper - lower)];
        if length(a).0 <= length(b).0 { upper = b } else { lower = a }
    }
    let tried = [0.0, f64::midpoint(lower, upper), 1.0].map(|share| (length(share), goals.at(share)));
    let [first, rest @ ..] = tried;
    let ((shortest, last), best) = rest.into_iter().fold(first, |a, b| if b.0.0 < a.0.0 { b } else { a });
    let foot = goals.nearest(euclid, last);
    let path = funnel_path(start, foot, portals);
    let to_foot: f64 = path.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    if to_foot <= shortest * (1.0 + LENGTH_ROUNDING) { foot } else { best }
}

/// Number of steps of the golden-section search: they narrow the segment to less than a millionth.
const GOLDEN_SECTIONS: usize = 30;

/// Relative rounding error allowed when two lengths are compared.
const LENGTH_ROUNDING: f64 = 1e-12;

/// Returns the turns of the funnel path, in order, without start and goal.
pub fn turns(start: Point, goal: Point, portals: &[Portal]) -> Vec<Turn> {
    let mut funnel = Funnel { apex: start, chains: Default::default(), path: Vec::new() };
    for (portal, ends) in portals.iter().enumerate() {
        funnel.narrow(portal, *ends);
    }
    if goal != funnel.apex {
        funnel.add(RIGHT_SIDE, Turn { at: goal, portal: portals.len() });
    }
    let Funnel { chains: [to_goal, _], mut path, .. } = funnel;
    path.extend(to_goal.into_iter().filter(|turn| turn.portal < portals.len()));
    path
}

/// A point at which the path may turn: an end of a portal, or the goal.
#[derive(Debug, Clone, Copy)]
pub struct Turn {
    /// The point.
    pub at: Point,
    /// Index of the portal that ends there; the number of portals for the goal.
    pub portal: usize,
}

const RIGHT_SIDE: usize = 0;
const LEFT_SIDE: usize = 1;

/// The shortest paths from the apex to both ends of a portal, as chains of turns that bend outwards.
struct Funnel {
    apex: Point,
    chains: [VecDeque<Turn>; 2],
    /// The turns of the path up to the apex, which is the last turn.
    path: Vec<Turn>,
}

impl Funnel {
    /// Narrows the funnel to the next portal.
    fn narrow(&mut self, portal: usize, Portal { left, right }: Portal) {
        if left != self.apex && right != self.apex {
            self.add(RIGHT_SIDE, Turn { at: right, portal });
            self.add(LEFT_SIDE, Turn { at: left, portal });
        }
        if left == self.apex || right == self.apex {
            // The path passes this portal at the apex, in any direction.
            self.chains.iter_mut().for_each(VecDeque::clear);
        }
    }

    /// Makes `turn` the end of a chain. If it is beyond the other chain, the path turns at the points of that chain
    /// that it passes.
    fn add(&mut self, side: usize, turn: Turn) {
        let [inwards, outwards] = match side {
            RIGHT_SIDE => [Orientation::CounterClockwise, Orientation::Clockwise],
            _ => [Orientation::Clockwise, Orientation::CounterClockwise],
        };
        let own = &mut self.chains[side];
        while let Some(last) = own.back() {
            let before = own.iter().nth_back(1).map_or(self.apex, |before| before.at);
            if orientation(before, last.at, turn.at) == outwards {
                break;
            }
            own.pop_back();
        }
        if own.is_empty() {
            let other = &mut self.chains[1 - side];
            while let Some(&first) = other.front()
                && orientation(self.apex, first.at, turn.at) == inwards
            {
                other.pop_front();
                self.apex = first.at;
                self.path.push(first);
            }
        }
        self.chains[side].push_back(turn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn paths_turn_only_where_portals_make_them() {
        let point = |(x, y): (f64, f64)| Point::new(x, y);
        let portal = |[left, right]: &[(f64, f64); 2]| Portal { left: point(*left), right: point(*right) };
        for (portals, path) in [
            (vec![], vec![(0.0, 0.0), (1.0, 2.0)]),
            (vec![], vec![(0.0, 0.0)]),
            // An open portal.
            (vec![[(1.0, 1.0), (1.0, -1.0)]], vec![(0.0, 0.0), (2.0, 0.5)]),
            // Portals to one side: their nearer ends.
            (
                vec![[(1.0, 3.0), (1.0, 2.0)], [(2.0, 3.0), (2.0, 1.5)]],
                vec![(0.0, 0.0), (1.0, 2.0), (2.0, 1.5), (3.0, 0.0)],
            ),
            // The path passes right of a wall, then left of it. The wall ends at (2, 1) and (2, 1.5).
            (
                vec![[(2.0, 1.0), (2.0, 0.0)], [(2.0, 1.5), (2.0, 3.0)]],
                vec![(0.0, 0.5), (2.0, 1.0), (2.0, 1.5), (0.0, 2.0)],
            ),
            // The start is on the line of a portal.
            (vec![[(0.0, -1.0), (0.0, -2.0)], [(1.0, 5.0), (1.0, -5.0)]], vec![(0.0, 0.0), (0.0, -1.0), (2.0, 0.0)]),
            // The ends of portals are on the path.
            (vec![[(1.0, 1.0), (1.0, 0.0)], [(2.0, 1.0), (2.0, 0.0)]], vec![(0.0, 0.0), (3.0, 0.0)]),
        ] {
            let path: Vec<Point> = path.into_iter().map(point).collect();
            let portals: Vec<Portal> = portals.iter().map(portal).collect();
            assert_eq!(funnel_path(path[0], path[path.len() - 1], &portals), path);
        }
    }

    proptest! {
        #![proptest_config(cplan_cases::cases(2000))]

        /// Compares the result with the shortest path through the ends of portals. All paths from one portal end to
        /// another are tried that cross the portals in between. On a coarse lattice many ends are collinear.
        #[test]
        fn no_path_from_end_to_end_is_shorter(
            ends in prop::collection::vec((-4..4i32, 0..4i32), 0..12), start in -4..4i32, goal in -4..4i32,
        ) {
            let gates: Vec<[Point; 2]> = std::iter::once([start; 2])
                .chain(ends.iter().map(|&(lower, size)| [lower, lower + size]))
                .chain([[goal; 2]])
                .enumerate()
                .map(|(x, gate)| gate.map(|y| Point::new(x as f64, f64::from(y))))
                .collect();
            let passes = |a: Point, b: Point| {
                gates[a.x as usize..=b.x as usize].iter().all(|[lower, upper]| {
                    let y = a.y + (b.y - a.y) * ((lower.x - a.x) / (b.x - a.x));
                    (lower.y - 1e-9..=upper.y + 1e-9).contains(&y)
                })
            };
            let mut least = vec![[f64::INFINITY; 2]; gates.len()];
            least[0] = [0.0; 2];
            for j in 1..gates.len() {
                for (i, a) in (0..j).flat_map(|i| [(i, 0), (i, 1)]) {
                    for b in 0..2 {
                        let (from, to) = (gates[i][a], gates[j][b]);
                        if passes(from, to) {
                            least[j][b] = least[j][b].min(least[i][a] + (to - from).norm());
                        }
                    }
                }
            }
            let last = gates.len() - 1;
            let portals: Vec<Portal> =
                gates[1..last].iter().map(|&[right, left]| Portal { left, right }).collect();
            let path = funnel_path(gates[0][0], gates[last][0], &portals);
            let length: f64 = path.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum();
            prop_assert!((length - least[last][0]).abs() < 1e-9, "{length}, not {}: {path:?}", least[last][0]);
            prop_assert!(path.windows(2).all(|ends| passes(ends[0], ends[1])), "{path:?}");
        }
    }
}
