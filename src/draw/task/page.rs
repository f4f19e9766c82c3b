//! The page of a task.

use super::grid::Grid;
use super::panel::Panel;
use super::states::{payload_states, rounds};
use super::{TaskPicture, motion_pen, steps, workspace};
use crate::draw::color::{self, BARRED, GREY, INK, PALE, Rgb};
use crate::draw::figure::{Anchor, Figure, Pen, Rect};
use crate::draw::legend::{self, Key, Sign};
use crate::draw::page::{HEIGHT, MARGIN, WIDTH, label, titles};
use crate::draw::{boxes, preferences};

/// More payload states than this are not shown, but for the one in which a step fails: the page would be longer than
/// anyone reads.
const MOST: usize = 24;
/// More obstacles than this are not named.
const NAMED: usize = 16;

const LEFT: Rect = Rect { x: 84.0, y: 0.0, width: 570.0, height: 0.0 };
const RIGHT: Rect = Rect { x: 760.0, y: 0.0, width: 612.0, height: 0.0 };
/// Least and greatest height of the workspace, pixels.
const WORKSPACE: [f64; 2] = [520.0, 640.0];
/// Below panels, for values and titles of their axes and the space to what follows, pixels.
const AXES: f64 = 62.0;

/// The whole page of a task: the workspace, a chart for each of its worlds, and its steps.
#[must_use]
pub fn compose(picture: &TaskPicture) -> Figure {
    let (task, answer) = (picture.task, picture.answer);
    let states = payload_states(&answer.legs, &task.arm.topology());
    let rounds = rounds(&answer.legs);
    let mut panels: Vec<Panel> = states.iter().take(MOST).filter_map(|state| Panel::new(state, task, rounds)).collect();
    let left_out = states.len() - panels.len();
    panels.extend(answer.impossible().map(|fails| Panel::failing(fails, task)));
    if panels.is_empty() {
        panels.push(Panel::at_start(task));
    }
    let grid = Grid::new(panels.len(), &task.arm, RIGHT.width);
    let (lines, status) = steps::words(picture);
    let keys = legend::layout(keys(picture), WIDTH - 2.0 * MARGIN);
    let legend = 10.0 + legend::ROW * keys.len() as f64;
    let top = 84.0 + 18.0 * lines.len().max(1) as f64;
    let notes = if left_out > 0 { 22.0 } else { 0.0 };
    let Layout { workspace, list, height } = layout(top, grid.height() + notes, steps::height(picture), legend);

    let mut items = titles(&lines, &status);
    items.extend(workspace::panel(picture, &states, workspace));
    items.extend(grid.items(picture, &panels, left_out, [RIGHT.x, top]));
    items.extend(steps::items(picture, list));
    let mut heading = |side: Rect, y: f64, text: &str, size: f64, color: Rgb| {
        items.push(label([side.x + side.width / 2.0, y], text.to_owned(), size, Anchor::Middle, color));
    };
    heading(LEFT, top - 32.0, "Workspace", 16.0, INK);
    heading(LEFT, top - 9.0, "objects where they lie at first, and dashed where they are placed", 14.0, GREY);
    heading(RIGHT, top - 32.0, "Configuration space of each payload state", 16.0, INK);
    items.extend(legend::items(&keys, WIDTH / 2.0, height - legend));
    Figure { width: WIDTH, height, items }
}

/// Where things are, pixels.
struct Layout {
    workspace: Rect,
    /// The list of steps; as high as it needs.
    list: Rect,
    /// Of the page.
    height: f64,
}

/// The list of steps stands below the workspace, or below the configuration spaces (`grid` pixels high) where the page
/// becomes less high by that.
fn layout(top: f64, grid: f64, list: f64, legend: f64) -> Layout {
    let list = AXES + list;
    let [below_workspace, below_grid] = [grid.max(WORKSPACE[0] + list), WORKSPACE[0].max(grid + list)];
    let left = below_workspace <= below_grid;
    let height = (top + below_workspace.min(below_grid) + AXES + legend).max(HEIGHT);
    let room = height - top - AXES - legend - if left { list } else { 0.0 };
    let workspace = Rect { y: top, height: room.min(WORKSPACE[1]), ..LEFT };
    let list =
        if left { Rect { y: workspace.bottom() + AXES, ..LEFT } } else { Rect { y: top + grid + AXES, ..RIGHT } };
    Layout { workspace, list, height }
}

/// Everything that needs explaining.
fn keys(picture: &TaskPicture) -> Vec<Key> {
    let (task, legs) = (picture.task, &picture.answer.legs);
    let mut keys = vec![(Sign::Start, "start".to_owned()), (Sign::Goal, "end of a step".to_owned())];
    let motion = |carrying: bool, name: &str| {
        let leg = legs.iter().find(|leg| leg.carried.is_some() == carrying)?;
        Some((Sign::Line(motion_pen(task, leg)), name.to_owned()))
    };
    keys.extend(motion(false, "empty-handed"));
    keys.extend(motion(true, "carrying (object's colour)"));
    if legs.iter().any(|leg| leg.event.is_some()) {
        keys.push((Sign::Dashed(GREY), "open to link 2 (picked or placed)".to_owned()));
    }
    let unreached = || picture.answer.impossible().into_iter().flat_map(|fails| &fails.ik_solutions);
    keys.extend(unreached().next().map(|_| (Sign::Unreached, "not reached".to_owned())));
    let pen = Pen { color: BARRED, width: 1.2, dash: &[] };
    keys.extend(unreached().next().map(|_| (Sign::Line(pen), "the arm there".to_owned())));
    keys.extend(unreached().any(|unreached| unreached.proof.is_some()).then(boxes::proof_key));
    keys.extend(preferences::keys(&task.workspace.preferences));
    keys.push((Sign::Line(Pen { color: PALE, width: 1.0, dash: &[2.0, 4.0] }), "reach".to_owned()));
    let names = task.workspace.obstacles.iter().map(|o| &o.name).chain(task.objects.iter().map(|o| &o.name));
    if names.clone().count() <= NAMED {
        keys.extend(names.enumerate().map(|(i, name)| (Sign::Swatch(color::obstacle(i)), name.clone())));
    }
    keys
}
