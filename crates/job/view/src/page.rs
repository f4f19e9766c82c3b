//! The page: titles, workspace, configuration spaces, steps of a task, and legend.

use super::figure::{Anchor, Figure, Item, Rect, bold, bold_text_width, label, shortened};
use super::grid::Grid;
use super::key::Key;
use super::legend;
use super::view::{PanelView, View};
use super::{chart, cspace, followed, steps, strip, workspace};
use cplan_model::Status;
use cplan_theme::{FOUND, GRAY, INFEASIBLE, INK, Rgb};

/// Width of every picture, in pixels.
const PAGE_WIDTH: f64 = 1400.0;
/// Height of pictures of a single motion, and least height of other pictures, in pixels.
const MIN_PAGE_HEIGHT: f64 = 720.0;
/// Margin on all sides, in pixels.
const PAGE_MARGIN: f64 = 28.0;
/// Room below panels, in pixels: values and titles of the axes, and the gap before the next item.
const AXES_HEIGHT: f64 = 58.0;

/// Room between two panels, in pixels, for values and title of an axis.
const PAIR_GAP: f64 = RIGHT_COLUMN.x - LEFT_COLUMN.x - LEFT_COLUMN.width;
/// Width and height of the workspace alone, in pixels.
const WORKSPACE_SIZE: [f64; 2] = [370.0, 350.0];

/// Least width of two panels of the same size, in pixels.
const MIN_PAIR_WIDTH: f64 = 420.0;

/// Place of the left column. Its height depends on the available room.
const LEFT_COLUMN: Rect = Rect { x: 84.0, y: 0.0, width: 570.0, height: 0.0 };
/// Place of the right column. Its height depends on the available room.
const RIGHT_COLUMN: Rect = Rect { x: 760.0, y: 0.0, width: 612.0, height: 0.0 };
/// Column of a single configuration space, with room for a scale of colours beside it.
const SCALED_COLUMN: Rect = Rect { x: 770.0, y: 0.0, width: 530.0, height: 0.0 };
/// Least and greatest height of the workspace in the picture of a task, in pixels.
const WORKSPACE_HEIGHTS: [f64; 2] = [520.0, 640.0];
/// Largest number of payload states that a picture shows, in addition to that of a failed step. With more, the page would be too
/// long.
const MAX_PAYLOAD_STATES: usize = 24;

/// Upper bound on the ratio of the widths of a bold text and a normal one.
const BOLD_SHARE: f64 = 1.1;

/// Composes the whole page of a view.
pub fn compose(view: &View) -> Figure {
    explained(view, legend::keys(view))
}

/// Composes the page with the given legend. All pictures of an animation have the same legend, so that nothing else moves when
/// the content changes.
pub fn explained(view: &View, keys: Vec<Key>) -> Figure {
    let mut items = titles(&view.title, verdict(view.ending, &view.status), PAGE_WIDTH);
    let lines = 18.0 * view.title.len().max(1) as f64;
    let keys = legend::layout(keys, PAGE_WIDTH - 2.0 * PAGE_MARGIN);
    let height = match &view.still.panels[..] {
        // Without configuration spaces, the workspace takes the whole page.
        [] => {
            let top = 44.0 + lines;
            let width = PAGE_WIDTH - LEFT_COLUMN.x - PAGE_MARGIN;
            items.extend(workspace::panel(
                view,
                Rect { y: top, width, height: MIN_PAGE_HEIGHT - AXES_HEIGHT - top, ..LEFT_COLUMN },
            ));
            MIN_PAGE_HEIGHT
        }
        [panel] if !view.is_task() => {
            let top = 62.0 + lines;
            let legend = 14.0 + legend::ROW_HEIGHT * keys.len() as f64;
            let height = MIN_PAGE_HEIGHT - legend - AXES_HEIGHT - top;
            let [left, right] = pair(view, top, height);
            items.extend(workspace::panel(view, left));
            items.extend(cspace::panel(view, panel, right));
            let below = top + height + AXES_HEIGHT;
            let page_height = MIN_PAGE_HEIGHT + strips(view, [left.x, right.right()], below, &mut items);
            items.push(heading(left, top - 12.0, "Workspace"));
            items.push(heading(right, top - 12.0, &space_title(view, panel)));
            items.extend(legend::items(&keys, PAGE_WIDTH / 2.0, page_height - legend));
            page_height
        }
        panels => task(view, panels, &keys, 112.0 + lines, &mut items),
    };
    Figure { width: PAGE_WIDTH, height, items, is_dark: view.still.is_dark }
}

/// Returns the title of a configuration space. Among moving obstacles, it states the time for which C-obstacles are drawn.
fn space_title(view: &View, panel: &PanelView) -> String {
    let movers = &view.worlds[panel.worlds[0]].movers;
    match (movers.is_empty(), view.still.now, view.duration()) {
        (true, ..) => panel.title.clone(),
        (false, None, Some(_)) => {
            format!("{} at {} s; dashed: stops of moving obstacles", panel.title, view.still.time)
        }
        (false, ..) => format!("{} at {:.2} s", panel.title, view.still.time),
    }
}

/// Returns the places of the workspace and of a single configuration space. Both have the same size if the axes of the
/// configuration space have the same scale.
fn pair(view: &View, top: f64, height: f64) -> [Rect; 2] {
    let has_scale = view.first_world().scale.is_some();
    let column = if has_scale { SCALED_COLUMN } else { RIGHT_COLUMN };
    let natural = chart::one_scale(&view.arm).map(|proportion| height / proportion);
    let width = natural.filter(|width| *width <= column.width && *width >= MIN_PAIR_WIDTH).unwrap_or(LEFT_COLUMN.width);
    let right = width.min(column.width);
    // Both panels are in the middle of the page, and the room between them suffices only for the values of an axis.
    let beside = if has_scale { PAGE_WIDTH - PAGE_MARGIN - SCALED_COLUMN.right() } else { 0.0 };
    let total = width + PAIR_GAP + right + beside;
    let x = (PAGE_WIDTH - total + LEFT_COLUMN.x - PAGE_MARGIN) / 2.0;
    [Rect { x, y: top, width, height }, Rect { x: x + width + PAIR_GAP, y: top, width: right, height }]
}

/// Draws the strip over time at `top`: that of a motion along a line, or that among moving obstacles. Returns the strip's height,
/// or 0 without a strip.
fn strips(view: &View, [left, right]: [f64; 2], top: f64, items: &mut Vec<Item>) -> f64 {
    let area = Rect { x: left, y: top, width: right - left, height: 0.0 };
    if let Some(line) = view.still.line.as_ref().filter(|line| line.motion.is_some()) {
        items.extend(followed::strip::items(line, view, area));
        return followed::strip::HEIGHT;
    }
    let Some(strip) = &view.strip else { return 0.0 };
    items.extend(strip::items(strip, view, area));
    strip::HEIGHT
}

/// Composes a picture of the workspace alone.
pub fn workspace_figure(view: &View) -> Figure {
    let [width, height] = WORKSPACE_SIZE;
    let area = Rect { x: 56.0, y: 8.0, width: width - 66.0, height: height - 8.0 - 50.0 };
    Figure { width, height, items: workspace::panel(view, area), is_dark: view.still.is_dark }
}

/// Composes a page with a single panel and a legend below it. If the page has room, the panel's height is `aspect` times its
/// width.
pub fn single_panel_page(
    title: &[String],
    keys: Vec<Key>,
    aspect: f64,
    panel: impl FnOnce(Rect) -> Vec<Item>,
) -> Figure {
    const PAGE_HEIGHTS: [f64; 2] = [300.0, 960.0];
    const MIN_PANEL_WIDTH: f64 = 600.0;
    let widest = PAGE_WIDTH - LEFT_COLUMN.x - PAGE_MARGIN;
    let height = (widest * aspect).clamp(PAGE_HEIGHTS[0], PAGE_HEIGHTS[1]);
    let room = Rect { width: (height / aspect).clamp(MIN_PANEL_WIDTH, widest), height, ..LEFT_COLUMN };
    let width = room.right() + PAGE_MARGIN;
    let mut items = titles(title, (String::new(), INK), width);
    let room = Rect { y: 44.0 + 18.0 * title.len().max(1) as f64, ..room };
    let keys = legend::layout(keys, width - 2.0 * PAGE_MARGIN);
    items.extend(panel(room));
    let below = room.bottom() + AXES_HEIGHT;
    items.extend(legend::items(&keys, width / 2.0, below));
    let height = below + legend::ROW_HEIGHT * keys.len() as f64 + 14.0;
    Figure { width, height, items, is_dark: false }
}

/// Draws the workspace, a configuration space for each payload state, and the steps. Returns the height of the page.
fn task(view: &View, panels: &[PanelView], keys: &[Vec<Key>], top: f64, items: &mut Vec<Item>) -> f64 {
    let going = panels.iter().filter(|panel| panel.fails.is_none());
    let left_out = going.clone().count().saturating_sub(MAX_PAYLOAD_STATES);
    let shown: Vec<&PanelView> =
        going.take(MAX_PAYLOAD_STATES).chain(panels.iter().filter(|panel| panel.fails.is_some())).collect();
    let grid = Grid::new(shown.len(), &view.arm, RIGHT_COLUMN.width);
    let notes = if left_out > 0 { 22.0 } else { 0.0 };
    let legend = 14.0 + legend::ROW_HEIGHT * keys.len() as f64;
    let Some((head, rows)) = view.still.steps.split_first() else { return MIN_PAGE_HEIGHT };
    let Layout { workspace, lists, height } = layout(top, grid.height() + notes, rows.len());
    items.extend(workspace::panel(view, workspace));
    items.extend(grid.items(view, &shown, left_out, [RIGHT_COLUMN.x, top]));
    let (left, right) = rows.split_at(lists[0].1);
    for (list, rows) in lists.iter().zip([left, right]).filter(|(_, rows)| !rows.is_empty()) {
        items.extend(steps::items(head, rows, list.0));
    }
    items.push(heading(LEFT_COLUMN, top - 26.0, "Workspace"));
    let note = "objects at their initial positions, and dashed where they are placed";
    items.push(label([LEFT_COLUMN.x + LEFT_COLUMN.width / 2.0, top - 9.0], note, 13.0, Anchor::Middle, GRAY));
    items.push(heading(RIGHT_COLUMN, top - 56.0, "Configuration space for each payload"));
    let height = height + strips(view, [LEFT_COLUMN.x, RIGHT_COLUMN.right()], height, items);
    items.extend(legend::items(keys, PAGE_WIDTH / 2.0, height));
    height + legend
}

/// Places of the parts of a page, in pixels.
struct Layout {
    workspace: Rect,
    /// Places of the lists of steps below the workspace and below the configuration spaces, each with its number of rows, which
    /// determines its height.
    lists: [(Rect, usize); 2],
    /// Distance from the top of the page to the lower end of all parts.
    height: f64,
}

/// Places the list of steps below the workspace or below the configuration spaces (which are `grid` pixels high), or divides it
/// between both, so that the page is as low as possible. Short lists are not divided.
fn layout(top: f64, grid: f64, rows: usize) -> Layout {
    const MIN_DIVIDED_ROWS: usize = 9;
    let list = |rows: usize| if rows == 0 { 0.0 } else { AXES_HEIGHT + steps::ROW_HEIGHT * (rows + 1) as f64 };
    let needed = |left: usize| (WORKSPACE_HEIGHTS[0] + list(left)).max(grid + list(rows - left));
    let divided = (1..rows).filter(|_| rows >= MIN_DIVIDED_ROWS);
    let left = [rows, 0].into_iter().chain(divided).min_by(|a, b| needed(*a).total_cmp(&needed(*b))).unwrap_or(rows);
    let height = needed(left).max(MIN_PAGE_HEIGHT - top - 2.0 * AXES_HEIGHT);
    let room = height - list(left);
    let workspace = Rect { y: top, height: room.min(WORKSPACE_HEIGHTS[1]), ..LEFT_COLUMN };
    let below = |column: Rect, y: f64| Rect { y: y + AXES_HEIGHT, ..column };
    let lists = [(below(LEFT_COLUMN, workspace.bottom()), left), (below(RIGHT_COLUMN, top + grid), rows - left)];
    Layout { workspace, lists, height: top + height + AXES_HEIGHT }
}

/// Draws the title of a panel above the middle of its column.
pub fn heading(column: Rect, y: f64, text: &str) -> Item {
    bold([column.x + column.width / 2.0, y], text, 16.0, Anchor::Middle, INK)
}

/// Returns the words of a status with the sign and the colour of the outcome: green with a tick, or red with a cross.
pub fn verdict(ending: Option<Status>, words: &str) -> (String, Rgb) {
    let (sign, color) = match ending {
        Some(Status::Found) => ("\u{2713} ", FOUND),
        Some(Status::Infeasible) => ("\u{2717} ", INFEASIBLE),
        Some(Status::Unknown) | None => ("", INK),
    };
    (format!("{sign}{words}"), color)
}

/// Draws the title and the lines below it on the left, and the status on the right.
pub fn titles(lines: &[String], (status, color): (String, Rgb), width: f64) -> Vec<Item> {
    let mut items = Vec::new();
    let status_width = bold_text_width(&status, 18.0);
    items.push(bold([width - PAGE_MARGIN, 36.0], status, 18.0, Anchor::End, color));
    for (i, line) in lines.iter().enumerate() {
        let (size, color, y) = if i == 0 { (22.0, INK, 36.0) } else { (14.0, GRAY, 40.0 + 18.0 * i as f64) };
        let room = width - 2.0 * PAGE_MARGIN - if i == 0 { status_width + 30.0 } else { 0.0 };
        let write = if i == 0 { bold } else { label };
        let text = shortened(line, if i == 0 { size * BOLD_SHARE } else { size }, room);
        items.push(write([PAGE_MARGIN, y], text, size, Anchor::Start, color));
    }
    items
}
