//! Shortest way through a sequence of portals.

use crate::geometry::{Orientation, Point, orientation};
use crate::space::{Measure, Metric, Segment};

/// A portal as seen by one who passes it: its ends to the left and to the right hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portal {
    /// The end to the left.
    pub left: Point,
    /// The end to the right.
    pub right: Point,
}

/// The shortest polyline from `start` to `goal` that crosses all portals in order: the path that the funnel algorithm pulls taut.
///
/// Consecutive portals must lie on the border of a common convex cell; start and goal in the first and the last one.
/// The *funnel* algorithm (Lee, Preparata 1984) in its scanning form: the funnel is kept as its apex and one point
/// a side, and after a turn the scan resumes at the new apex. Linear when turns are found soon after they are passed,
/// quadratic at worst. Turns are decided exactly, so every piece passes its portals in exact arithmetic.
#[must_use]
pub fn funnel_path(start: Point, goal: Point, portals: &[Portal]) -> Vec<Point> {
    let turns = turns(start, goal, portals).into_iter().map(|turn| turn.at);
    let mut path: Vec<Point> = std::iter::once(start).chain(turns).chain([goal]).collect();
    path.dedup();
    path
}

/// The place on a segment to which the funnel path through the portals is shortest.
///
/// That length is a convex function of the place, whose least value a search by golden section closes in on; as the string is
/// straight after its last turn, the place nearest to that turn is the very least if it is as good. Some dozens of strings.
#[must_use]
pub fn nearest_end(start: Point, goals: &Segment, portals: &[Portal]) -> Point {
    let euclid = Measure::from(Metric::Euclidean);
    let length = |share: f64| {
        let path = funnel_path(start, Point::from(goals.at(share)), portals);
        let last = path[path.len().saturating_sub(2)];
        (path.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>(), last)
    };
    if goals.is_point() {
        return goals.corners()[0];
    }
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut lower, mut upper) = (0.0, 1.0);
    for _ in 0..SECTIONS {
        let [a, b] = [upper - golden * (upper - lower), lower + golden * (upper - lower)];
        if length(a).0 <= length(b).0 { upper = b } else { lower = a }
    }
    let tried = [0.0, f64::midpoint(lower, upper), 1.0].map(|share| (length(share), goals.at(share)));
    let [first, rest @ ..] = tried;
    let ((shortest, last), best) = rest.into_iter().fold(first, |a, b| if b.0.0 < a.0.0 { b } else { a });
    let foot = Point::from(goals.nearest(euclid, last.coords));
    let path = funnel_path(start, foot, portals);
    let to_foot: f64 = path.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    if to_foot <= shortest * (1.0 + SETTLED) { foot } else { Point::from(best) }
}

/// Golden sections: they leave less than a millionth of the segment.
const SECTIONS: usize = 30;

/// Share by which a length may be greater for rounding.
const SETTLED: f64 = 1e-12;

/// Where the funnel path turns, in order, start and goal left out.
pub(super) fn turns(start: Point, goal: Point, portals: &[Portal]) -> Vec<Turn> {
    let mut path = Vec::new();
    let mut funnel = Funnel { apex: start, left: None, right: None };
    let mut at = 0;
    while at <= portals.len() {
        let portal = portals.get(at).copied().unwrap_or(Portal { left: goal, right: goal });
        match funnel.narrow(at, portal) {
            Some(turn) => {
                path.push(turn);
                funnel = Funnel { apex: turn.at, left: None, right: None };
                at = turn.portal + 1;
            }
            None => at += 1,
        }
    }
    path
}

/// An end of a portal that bounds the funnel, and at which the string may turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub at: Point,
    /// Which portal.
    pub portal: usize,
}

/// Directions from the apex that cross all portals since: from `right` counter-clockwise to `left`.
struct Funnel {
    apex: Point,
    left: Option<Turn>,
    right: Option<Turn>,
}

impl Funnel {
    /// Narrows the funnel to the portal, or returns the point at which the string must turn to reach it.
    fn narrow(&mut self, portal: usize, Portal { left, right }: Portal) -> Option<Turn> {
        if left == self.apex || right == self.apex {
            // Passed at the apex itself, in any direction.
            (self.left, self.right) = (None, None);
            return None;
        }
        if !self.turns(self.right, right, Orientation::Clockwise) {
            if self.turns(self.left, right, Orientation::CounterClockwise) {
                return self.left;
            }
            self.right = Some(Turn { at: right, portal });
        }
        if !self.turns(self.left, left, Orientation::CounterClockwise) {
            if self.turns(self.right, left, Orientation::Clockwise) {
                return self.right;
            }
            self.left = Some(Turn { at: left, portal });
        }
        None
    }

    /// Whether `point` lies strictly to that side of the ray from the apex through a bound.
    fn turns(&self, bound: Option<Turn>, point: Point, side: Orientation) -> bool {
        bound.is_some_and(|bound| orientation(self.apex, bound.at, point) == side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn portal(left: (f64, f64), right: (f64, f64)) -> Portal {
        Portal { left: Point::new(left.0, left.1), right: Point::new(right.0, right.1) }
    }

    fn points(path: &[(f64, f64)]) -> Vec<Point> {
        path.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn without_portals_the_path_is_straight() {
        let [a, b] = [Point::new(0.0, 0.0), Point::new(1.0, 2.0)];
        assert_eq!(funnel_path(a, b, &[]), vec![a, b]);
        assert_eq!(funnel_path(a, a, &[]), vec![a]);
    }

    #[test]
    fn an_open_portal_does_not_bend_it() {
        let open = portal((1.0, 1.0), (1.0, -1.0));
        let path = funnel_path(Point::new(0.0, 0.0), Point::new(2.0, 0.5), &[open]);
        assert_eq!(path, points(&[(0.0, 0.0), (2.0, 0.5)]));
    }

    #[test]
    fn it_turns_at_the_nearer_end_of_a_portal_aside() {
        let above = [portal((1.0, 3.0), (1.0, 2.0)), portal((2.0, 3.0), (2.0, 1.5))];
        let path = funnel_path(Point::new(0.0, 0.0), Point::new(3.0, 0.0), &above);
        assert_eq!(path, points(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.5), (3.0, 0.0)]));
    }

    #[test]
    fn a_turn_back_on_one_vertical_goes_around_what_is_between() {
        // Right below the wall, left above it; the wall ends at (2, 1) and (2, 1.5).
        let wall = [portal((2.0, 1.0), (2.0, 0.0)), portal((2.0, 1.5), (2.0, 3.0))];
        let path = funnel_path(Point::new(0.0, 0.5), Point::new(0.0, 2.0), &wall);
        assert_eq!(path, points(&[(0.0, 0.5), (2.0, 1.0), (2.0, 1.5), (0.0, 2.0)]));
    }

    #[test]
    fn a_start_on_the_line_of_a_portal_follows_it() {
        let below = [portal((0.0, -1.0), (0.0, -2.0)), portal((1.0, 5.0), (1.0, -5.0))];
        let path = funnel_path(Point::new(0.0, 0.0), Point::new(2.0, 0.0), &below);
        assert_eq!(path, points(&[(0.0, 0.0), (0.0, -1.0), (2.0, 0.0)]));
    }

    #[test]
    fn collinear_ends_do_not_bend_it() {
        let along = [portal((1.0, 1.0), (1.0, 0.0)), portal((2.0, 1.0), (2.0, 0.0))];
        let path = funnel_path(Point::new(0.0, 0.0), Point::new(3.0, 0.0), &along);
        assert_eq!(path, points(&[(0.0, 0.0), (3.0, 0.0)]));
    }
}
