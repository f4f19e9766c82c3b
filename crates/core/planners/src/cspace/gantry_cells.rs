//! Decides exactly which cells of a gantry's grid are entirely free.
//!
//! The C-obstacle of a pair of shapes is convex: a Minkowski difference, grown by the radii and the clearance. So it
//! covers one interval of joint 2 within a row of cells. Each end of this interval is found at one of the row's two
//! sides, or at the highest or lowest point of the C-obstacle if that lies within the row.
//!
//! A cell is blocked if its *interior* meets a C-obstacle. C-obstacles often end where cells begin. A cell that one of them only
//! touches can be used, because the straight move between the centres of two neighbouring free cells is free: an obstacle with
//! area that meets the move also meets the interior of one of the two cells. An obstacle without width, such as a thin wall for
//! a tool that is a point, may lie between two cells. It blocks all cells that it touches.

use super::slabs::Columns;
use super::{Grid, Proves, translation};
use cplan_geometry::ROUNDING;
use cplan_interrupt::checkpoint;
use cplan_model::space::Configuration;
use cplan_model::{Contacts, Scene};
use nalgebra::Matrix2;

/// Depth, radians or metres, up to which a C-obstacle counts as touching a cell. It exceeds the rounding of contacts and
/// cells.
const TOUCH_DEPTH: f64 = 2.0 * ROUNDING;

/// Blocks the cells of a grid whose interior has a configuration within `clearance` of an obstacle. `map` is the arm's
/// [`translation::joint_map`].
///
/// Each configuration of a blocked cell is within `clearance + margin` of an obstacle, where `margin` is that of the
/// grid's [`Proves::Outer`]. `O(reached rows * contacts + cells)`.
pub(super) fn block(grid: &mut Grid, scene: &Scene, map: &Matrix2<f64>, clearance: f64) {
    let [rows, columns] = Columns::both(&grid.topology, grid.cells);
    let step = grid.step();
    grid.proves = Proves::Outer { margin: step[0] + step[1] + 2.0 * TOUCH_DEPTH };
    let contacts = Contacts::new(scene);
    let count = grid.cells[1];
    let mut intervals = Vec::new();
    for index in 0..contacts.second_link_pairs().start {
        intervals.clear();
        contacts.first_link(index, clearance, &mut intervals);
        for &[start, end] in &intervals {
            let banned = rows.touched(touched_part([start, end]));
            grid.blocked[banned.start * count..banned.end * count].fill(true);
        }
    }
    let lower = grid.topology.ranges[0].domain().0;
    for index in contacts.second_link_pairs() {
        checkpoint();
        let c_obstacle = PairOutline::new(&contacts, index, map, clearance);
        for i in rows.touched(touched_part(c_obstacle.extent())) {
            let sides = [0, 1].map(|k| lower + (i + k) as f64 * step[0]);
            let Some(within) = c_obstacle.within(sides, &mut intervals) else { continue };
            let row = &mut grid.blocked[i * count..(i + 1) * count];
            row[columns.touched(touched_part(within))].fill(true);
        }
    }
}

/// Returns the interval that cells must not meet: a little less than the given one, or a little more if that has no length.
fn touched_part([start, end]: [f64; 2]) -> [f64; 2] {
    let inwards = if end - start > 2.0 * TOUCH_DEPTH { TOUCH_DEPTH } else { -TOUCH_DEPTH };
    [start + inwards, end - inwards]
}

/// The C-obstacle of a pair of link 2, by its extreme points and its slices.
struct PairOutline<'a> {
    contacts: &'a Contacts<'a>,
    index: usize,
    clearance: f64,
    /// Configurations at the ends of the C-obstacle along each axis. `None` if it covers all values of joint 1, because
    /// link 2 hits link 1.
    extremes: Option<[[Configuration; 2]; 2]>,
}

impl<'a> PairOutline<'a> {
    fn new(contacts: &'a Contacts<'a>, index: usize, map: &Matrix2<f64>, clearance: f64) -> Self {
        let scene = contacts.scene();
        let pair = scene.pairs()[index];
        let (part, piece) = (scene.part(pair), scene.piece(pair));
        let radius = part.radius() + piece.radius() + clearance;
        let extremes = (pair.link == 1).then(|| translation::extremes(scene.arm(), map, part, piece, radius));
        Self { contacts, index, clearance, extremes }
    }

    /// Returns the values of joint 1 of the C-obstacle.
    fn extent(&self) -> [f64; 2] {
        self.extremes.map_or([f64::NEG_INFINITY, f64::INFINITY], |[first, _]| first.map(|q| q[0]))
    }

    /// Returns the range of joint 2 that the C-obstacle covers between two values of joint 1; `None` if it covers nothing there.
    fn within(&self, sides: [f64; 2], intervals: &mut Vec<[f64; 2]>) -> Option<[f64; 2]> {
        let extent = self.extent();
        let inwards = [sides[0] + TOUCH_DEPTH, sides[1] - TOUCH_DEPTH];
        let [from, to] = inwards.map(|q1| q1.clamp(extent[0], extent[1]));
        let mut all: Option<[f64; 2]> = None;
        let mut include = |[start, end]: [f64; 2]| {
            all = Some(all.map_or([start, end], |[low, high]| [low.min(start), high.max(end)]));
        };
        for q1 in [from, to] {
            intervals.clear();
            let (elbow, heading) = self.contacts.elbow(q1);
            self.contacts.at_elbow(self.index, elbow, heading, self.clearance, intervals);
            intervals.iter().copied().for_each(&mut include);
        }
        let [_, second] = self.extremes.unwrap_or_default();
        second.iter().filter(|q| from < q[0] && q[0] < to).for_each(|q| include([q[1], q[1]]));
        all
    }
}
