//! The ends of paths in polygonal free space.

use super::Query;
use super::mesh::Mesh;
use crate::cspace::Regions;
use cplan_geometry::Point;
use cplan_model::space::{Measure, Metric, Segment};
use std::f64::consts::TAU;

/// Number of evenly spaced points of a goal segment that roadmaps add as goals. The point nearest to the start is added
/// as well. The number is odd, so that the middle is among them.
const PLACES_PER_SEGMENT: usize = 17;

/// The start and the goals of the paths that answer a query.
#[derive(Debug, Clone, PartialEq)]
pub struct Terminals {
    /// The start, within the window.
    pub start: Point,
    /// The copies of goals in the window that are at least partly in closed free space. There is at least one.
    pub goals: Vec<Segment>,
    /// The parts of the goals in each convex cell of free space, with the cell's number; sorted by number.
    pub parts: Vec<(u32, Segment)>,
}

impl Terminals {
    /// Collects the ends of paths for a query. Returns the reason if the start, or every goal, is not in free space.
    /// `parts_of` returns the cells of closed free space that contain a part of a segment, with that part.
    pub fn new(
        regions: &Regions,
        query: &Query,
        parts_of: impl Fn(&Segment) -> Vec<(u32, Segment)>,
    ) -> Result<Self, String> {
        let start = query.start;
        if parts_of(&Segment::point(query.start)).is_empty() {
            return Err(format!(
                "the start {} is outside the free space that the planner searches",
                format_point(start)
            ));
        }
        let (Some(first), pieces) = (query.goals.pieces().first(), query.goals.pieces()) else {
            return Err("the query has no goal".to_owned());
        };
        let (mut goals, mut parts) = (Vec::new(), Vec::new());
        for copy in pieces.iter().flat_map(|piece| window_copies(regions, piece)) {
            let found = parts_of(&copy);
            if !found.is_empty() {
                goals.push(copy);
                parts.extend(found);
            }
        }
        if goals.is_empty() {
            let goal = format_point(first.ends()[0]);
            let others = if pieces.len() > 1 { format!(" (nor {} others)", pieces.len() - 1) } else { String::new() };
            return Err(format!("the goal {goal}{others} is outside the free space that the planner searches"));
        }
        parts.sort_by_key(|part| part.0);
        Ok(Self { start, goals, parts })
    }

    /// Returns goals as points in a mesh's free space. For a segment, these are some of its points, and the one nearest
    /// to the start.
    pub fn places<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = Point> + 'a {
        let places = self.goals.iter().flat_map(|goals| {
            let count = if goals.is_point() { 1 } else { PLACES_PER_SEGMENT };
            let along = (0..count).map(|k| goals.at(k as f64 / (PLACES_PER_SEGMENT - 1) as f64));
            along.chain([goals.nearest(Measure::from(Metric::Euclidean), self.start)])
        });
        places.filter(|&at| mesh.triangles_at(at).next().is_some())
    }

    /// Returns the parts of the goals in a cell.
    pub fn parts_in(&self, cell: u32) -> impl Iterator<Item = &(u32, Segment)> {
        let begin = self.parts.partition_point(|part| part.0 < cell);
        self.parts[begin..].iter().take_while(move |part| part.0 == cell)
    }

    /// Returns the distance from `p` to the nearest goal. It is a lower bound on the length of any path from `p` to
    /// a goal.
    pub fn distance(&self, measure: Measure, p: Point) -> f64 {
        self.goals.iter().map(|goal| goal.distance(measure, p)).fold(f64::INFINITY, f64::min)
    }
}

fn format_point(p: Point) -> String {
    format!("({:.6}, {:.6})", p.x, p.y)
}

/// Returns the copies of a segment, by whole turns on circles, whose ranges of joint values overlap the window.
fn window_copies(regions: &Regions, piece: &Segment) -> Vec<Segment> {
    let [from, to] = piece.ends();
    let turns = |k: usize| {
        let (least, greatest) = (from[k].min(to[k]), from[k].max(to[k]));
        let (lower, upper) = regions.window[k];
        // Copies from the turn at which the greater end enters the window to the turn at which the lesser end leaves it.
        let copies = regions.topology.ranges[k].copies_within(least, (lower - (greatest - least), upper));
        copies.map(move |copy| ((copy - least) / TAU).round())
    };
    turns(0).flat_map(|first| turns(1).map(move |second| piece.turned([first, second]))).collect()
}
