//! Where a path over polygonal regions begins and may end.

use super::Query;
use crate::cspace::Regions;
use crate::geometry::Point;

/// Ends of the paths that answer a query.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Terminals {
    pub start: Point,
    /// All copies of all goals that lie in the window and in closed free space; at least one.
    pub goals: Vec<Point>,
}

impl Terminals {
    /// The ends for a query, or in words why there are none. `is_free` says whether closed free space contains a point.
    pub fn new(regions: &Regions, query: &Query, is_free: impl Fn(Point) -> bool) -> Result<Self, String> {
        let start = Point::from(query.start);
        if !is_free(start) {
            return Err(format!("the start {} is not in the free space of the representation", shown(start)));
        }
        let (Some(first), goals) = (query.goals.first(), &query.goals) else {
            return Err("the query has no goal".to_owned());
        };
        let mut copies: Vec<Point> = goals.iter().flat_map(|goal| window_copies(regions, Point::from(*goal))).collect();
        copies.retain(|copy| is_free(*copy));
        if copies.is_empty() {
            let goal = shown(Point::from(*first));
            let others = if goals.len() > 1 { format!(" (nor {} others)", goals.len() - 1) } else { String::new() };
            return Err(format!("the goal {goal}{others} is not in the free space of the representation"));
        }
        Ok(Self { start, goals: copies })
    }

    /// Distance from `p` to the nearest goal: a lower bound on the length of any way there.
    pub fn straight_distance(&self, p: Point) -> f64 {
        self.goals.iter().map(|goal| (goal - p).norm()).fold(f64::INFINITY, f64::min)
    }
}

fn shown(p: Point) -> String {
    format!("({:.6}, {:.6})", p.x, p.y)
}

/// The copies of `p`, shifted by whole turns along circle axes, within the window; on intervals `p` as it is.
fn window_copies(regions: &Regions, p: Point) -> Vec<Point> {
    let values = |k: usize| regions.topology.axes[k].copies_within(p[k], regions.window[k]);
    values(0).flat_map(|x| values(1).map(move |y| Point::new(x, y))).collect()
}
