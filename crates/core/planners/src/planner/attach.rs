//! Joins configurations to cells of a grid.

use super::Query;
use super::grid_path::place;
use crate::cspace::Grid;
use cplan_model::space::{Configuration, Segment};
use cplan_text::listed;

/// Number of rings of cells around a blocked cell in which a free cell is searched. An outer grid blocks some cells
/// with free configurations. Beyond these rings, the straight segment to the grid is unlikely to be free.
const SEARCHED_RINGS: i64 = 3;

/// The cells that join a configuration, or a segment of goals, to the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Attachment {
    /// The configuration's own cell if that is free. Otherwise, the free cells of the nearest ring that has any,
    /// nearest first. For a segment, all free cells that contain a part of it. There is at least one cell.
    pub cells: Vec<usize>,
    /// True if one of the cells contains the configuration. Always true for a segment.
    pub contained: bool,
}

/// A query joined to the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct JoinedQuery {
    /// The start's cells.
    pub start: Attachment,
    /// The goals that can be joined, within the domain, with their cells. There is at least one.
    pub goals: Vec<(Segment, Attachment)>,
}

impl JoinedQuery {
    /// Joins start and goals to the grid. Returns the reason if the start, or every goal, cannot be joined.
    pub fn new(grid: &Grid, query: &Query) -> Result<Self, String> {
        let start = attach(grid, query.start, "start")?;
        let (mut goals, mut reasons) = (Vec::new(), Vec::new());
        for goal in query.goals.pieces().iter().flat_map(|piece| goal_pieces_on_grid(grid, piece)) {
            match attach_goals(grid, &goal) {
                Ok(attachment) => goals.push((goal, attachment)),
                Err(reason) => reasons.push(reason),
            }
        }
        if goals.is_empty() {
            return Err(if reasons.is_empty() { "there is no goal".into() } else { listed(&reasons) });
        }
        Ok(Self { start, goals })
    }

    /// Returns the cells of all goals.
    pub fn sources(&self) -> Vec<usize> {
        self.goals.iter().flat_map(|(_, attachment)| attachment.cells.iter().copied()).collect()
    }
}

/// Returns a goal in the form that the grid needs. A segment is cut at the ends of the domain. A single configuration
/// is unchanged.
fn goal_pieces_on_grid(grid: &Grid, piece: &Segment) -> Vec<Segment> {
    if piece.is_point() { vec![*piece] } else { piece.within_domain(&grid.topology).collect() }
}

/// Joins goals within the domain to the grid. Returns the reason if they cannot be joined.
fn attach_goals(grid: &Grid, goals: &Segment) -> Result<Attachment, String> {
    let [from, to] = goals.ends();
    if goals.is_point() {
        return attach(grid, from, "goal");
    }
    if !grid.topology.contains(from) || !grid.topology.contains(to) {
        return Err(format!(
            "the goals from {} to {} extend beyond the configuration space",
            format_configuration(from),
            format_configuration(to)
        ));
    }
    let cells: Vec<usize> = cells_along(grid, goals).into_iter().filter(|&cell| !grid.blocked[cell]).collect();
    if cells.is_empty() {
        return Err(format!(
            "no goal from {} to {} is in a free cell",
            format_configuration(from),
            format_configuration(to)
        ));
    }
    Ok(Attachment { cells, contained: true })
}

fn format_configuration(q: Configuration) -> String {
    format!("({:.4}, {:.4})", q[0], q[1])
}

/// Returns the cells that contain a part of a segment in the domain, in ascending order.
fn cells_along(grid: &Grid, goals: &Segment) -> Vec<usize> {
    let step = grid.step();
    let range = |k: usize, part: &Segment| {
        let lower = grid.topology.ranges[k].domain().0;
        let [from, to] = part.ends().map(|q| ((q[k] - lower) / step[k]).max(0.0) as usize);
        let last = grid.cells[k] - 1;
        from.min(to).min(last)..=from.max(to).min(last)
    };
    let in_row = |i: usize| {
        let lower = grid.topology.ranges[0].domain().0 + step[0] * i as f64;
        let mut sides = [[lower, f64::NEG_INFINITY], [lower + step[0], f64::INFINITY]];
        let [from, to] = goals.ends();
        if from[0] == to[0] {
            // The segment lies in one row. Rounding of the sides of this row must not cut it.
            (sides[0][0], sides[1][0]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        let part = goals.within(sides[0], sides[1]);
        part.into_iter().flat_map(move |part| range(1, &part).map(move |j| i * grid.cells[1] + j))
    };
    range(0, goals).flat_map(in_row).collect()
}

/// Joins `q` to the grid. Returns the reason if it cannot be joined.
fn attach(grid: &Grid, q: Configuration, name: &str) -> Result<Attachment, String> {
    if !grid.topology.contains(q) {
        return Err(format!("the {name} ({:.4}, {:.4}) lies outside the configuration space", q[0], q[1]));
    }
    let home = grid.locate(q);
    if !grid.blocked[home] {
        return Ok(Attachment { cells: vec![home], contained: true });
    }
    let columns = grid.cells[1];
    for ring in 1..=SEARCHED_RINGS {
        let mut found: Vec<(f64, usize)> = Vec::new();
        for di in -ring..=ring {
            for dj in -ring..=ring {
                if di.abs().max(dj.abs()) != ring {
                    continue;
                }
                let i = place(grid, 0, (home / columns) as i64 + di);
                let j = place(grid, 1, (home % columns) as i64 + dj);
                if let (Some(i), Some(j)) = (i, j) {
                    let cell = i * columns + j;
                    if !grid.blocked[cell] {
                        found.push((grid.topology.distance(q, grid.center(cell)), cell));
                    }
                }
            }
        }
        if !found.is_empty() {
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            found.dedup();
            return Ok(Attachment { cells: found.into_iter().map(|(_, cell)| cell).collect(), contained: false });
        }
    }
    Err(format!("no free cell is within {SEARCHED_RINGS} cells of the {name} ({:.4}, {:.4})", q[0], q[1]))
}
