//! The page: titles, the workspace, configuration spaces, the steps of a task, legend.

use super::color::{GREY, INK};
use super::figure::{Anchor, Figure, Item, Rect, label, shortened, text_width};
use super::grid::Grid;
use super::key::Key;
use super::legend;
use super::view::{PanelView, View};
use super::{cspace, steps, workspace};

/// Width of every picture, in pixels.
const WIDTH: f64 = 1400.0;
/// Height of pictures of one motion, and least height of all pictures, in pixels.
const HEIGHT: f64 = 720.0;
/// Margin on all sides, in pixels.
const MARGIN: f64 = 28.0;
/// Space below panels, in pixels: values and titles of their axes, and the distance to the next item.
const AXES: f64 = 58.0;

/// The columns; their height depends on the available room.
const LEFT: Rect = Rect { x: 84.0, y: 0.0, width: 570.0, height: 0.0 };
const RIGHT: Rect = Rect { x: 760.0, y: 0.0, width: 612.0, height: 0.0 };
/// Column of a single configuration space, with room for a scale of colours beside it.
const SCALED: Rect = Rect { x: 770.0, y: 0.0, width: 530.0, height: 0.0 };
/// Least and greatest height of the workspace of a task, in pixels.
const WORKSPACE: [f64; 2] = [520.0, 640.0];
/// Largest number of payload states that are shown, in addition to the one in which a step fails. With more of them,
/// the page would be too long to read.
const MOST: usize = 24;

/// Composes the whole page of a view.
#[must_use]
pub fn compose(view: &View) -> Figure {
    explained(view, legend::keys(view))
}

/// Composes the page with another legend. All pictures of an animation have the same legend, so that nothing jumps.
#[must_use]
pub fn explained(view: &View, keys: Vec<Key>) -> Figure {
    let mut items = titles(&view.title, &view.status, WIDTH);
    let lines = 18.0 * view.title.len().max(1) as f64;
    let keys = legend::layout(keys, WIDTH - 2.0 * MARGIN);
    let height = match &view.still.panels[..] {
        // Without configuration spaces, the workspace takes the whole page.
        [] => {
            let top = 44.0 + lines;
            let width = WIDTH - LEFT.x - MARGIN;
            items.extend(workspace::panel(view, Rect { y: top, width, height: HEIGHT - AXES - top, ..LEFT }));
            HEIGHT
        }
        [panel] if !view.is_task() => {
            let top = 62.0 + lines;
            let height = HEIGHT - 14.0 - legend::ROW * keys.len() as f64 - AXES - top;
            items.extend(workspace::panel(view, Rect { y: top, height, ..LEFT }));
            items.extend(cspace::panel(view, panel, Rect { y: top, height, ..SCALED }));
            items.push(heading(LEFT, top - 12.0, "Workspace"));
            items.push(heading(SCALED, top - 12.0, &panel.title));
            items.extend(legend::items(&keys, WIDTH / 2.0, HEIGHT - 14.0 - legend::ROW * keys.len() as f64));
            HEIGHT
        }
        panels => task(view, panels, &keys, 84.0 + lines, &mut items),
    };
    Figure { width: WIDTH, height, items }
}

/// Composes a page with a single panel and a legend below it. The panel has this aspect, height by width, as far as
/// there is room.
#[must_use]
pub fn alone(title: &[String], keys: Vec<Key>, aspect: f64, panel: impl FnOnce(Rect) -> Vec<Item>) -> Figure {
    const HEIGHTS: [f64; 2] = [300.0, 960.0];
    const LEAST_WIDTH: f64 = 600.0;
    let widest = WIDTH - LEFT.x - MARGIN;
    let height = (widest * aspect).clamp(HEIGHTS[0], HEIGHTS[1]);
    let room = Rect { width: (height / aspect).clamp(LEAST_WIDTH, widest), height, ..LEFT };
    let width = room.right() + MARGIN;
    let mut items = titles(title, "", width);
    let room = Rect { y: 44.0 + 18.0 * title.len().max(1) as f64, ..room };
    let keys = legend::layout(keys, width - 2.0 * MARGIN);
    items.extend(panel(room));
    let below = room.bottom() + AXES;
    items.extend(legend::items(&keys, width / 2.0, below));
    Figure { width, height: below + legend::ROW * keys.len() as f64 + 14.0, items }
}

/// Draws the workspace, a configuration space for each payload state, and the steps; returns the height of the page.
fn task(view: &View, panels: &[PanelView], keys: &[Vec<Key>], top: f64, items: &mut Vec<Item>) -> f64 {
    let going = panels.iter().filter(|panel| panel.fails.is_none());
    let left_out = going.clone().count().saturating_sub(MOST);
    let shown: Vec<&PanelView> = going.take(MOST).chain(panels.iter().filter(|panel| panel.fails.is_some())).collect();
    let grid = Grid::new(shown.len(), &view.arm, RIGHT.width);
    let notes = if left_out > 0 { 22.0 } else { 0.0 };
    let legend = 14.0 + legend::ROW * keys.len() as f64;
    let list = steps::ROW * view.still.steps.len() as f64;
    let Layout { workspace, list, height } = layout(top, grid.height() + notes, list, legend);
    items.extend(workspace::panel(view, workspace));
    items.extend(grid.items(view, &shown, left_out, [RIGHT.x, top]));
    items.extend(steps::items(&view.still.steps, list));
    items.push(heading(LEFT, top - 32.0, "Workspace"));
    let note = "objects where they lie at first, and dashed where they are placed";
    items.push(label([LEFT.x + LEFT.width / 2.0, top - 9.0], note, 14.0, Anchor::Middle, GREY));
    items.push(heading(RIGHT, top - 32.0, "Configuration space of each payload state"));
    items.extend(legend::items(keys, WIDTH / 2.0, height - legend));
    height
}

/// Places of the parts of a page, in pixels.
struct Layout {
    workspace: Rect,
    /// Place of the list of steps; its height depends on the list.
    list: Rect,
    /// Height of the page.
    height: f64,
}

/// Places the list of steps below the workspace or below the configuration spaces (`grid` pixels high), depending on
/// which makes the page lower.
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

fn heading(column: Rect, y: f64, text: &str) -> Item {
    label([column.x + column.width / 2.0, y], text, 16.0, Anchor::Middle, INK)
}

/// Draws the title and the lines below it, and the status in the opposite corner.
fn titles(lines: &[String], status: &str, width: f64) -> Vec<Item> {
    let mut items = Vec::new();
    let status_width = text_width(status, 18.0);
    items.push(label([width - MARGIN, 36.0], status, 18.0, Anchor::End, INK));
    for (i, line) in lines.iter().enumerate() {
        let (size, color, y) = if i == 0 { (22.0, INK, 36.0) } else { (14.0, GREY, 40.0 + 18.0 * i as f64) };
        let room = width - 2.0 * MARGIN - if i == 0 { status_width + 30.0 } else { 0.0 };
        items.push(label([MARGIN, y], shortened(line, size, room), size, Anchor::Start, color));
    }
    items
}
