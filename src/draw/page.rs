//! The page: titles, two panels, legend.

use super::color::{GREY, INK, Rgb};
use super::figure::{Anchor, Figure, Item, Label, Pen, Rect, Step, Style, shortened, text_width};
use super::{ArmPicture, Picture, color, cspace, frames, legend, workspace};

/// Width of every picture, pixels.
pub const WIDTH: f64 = 1400.0;
/// Height of pictures of one motion, and least height of all, pixels.
pub const HEIGHT: f64 = 720.0;
/// Beside everything, pixels.
pub const MARGIN: f64 = 28.0;

/// The pen of path `index` out of `count`: a single one is drawn in ink.
pub fn path_pen(index: usize, count: usize) -> Pen {
    let (color, dash): (Rgb, &[f64]) = if count == 1 { (INK, &[]) } else { color::path(index) };
    Pen { color, width: 2.4, dash }
}

/// The paths, visible on any ground by the broad pale line under each. Those come first, so that no path hides in the
/// gaps of another's dashes.
pub fn path_items(outlines: Vec<Vec<Step>>) -> Vec<Item> {
    let count = outlines.len();
    lines(outlines.into_iter().enumerate().map(|(i, steps)| (steps, path_pen(i, count))))
}

/// Lines with a broad pale one under each, all of which come first.
pub fn lines(outlines: impl IntoIterator<Item = (Vec<Step>, Pen)>) -> Vec<Item> {
    let (mut halos, mut lines) = (Vec::new(), Vec::new());
    for (steps, pen) in outlines {
        halos.push(Item::Outline(steps.clone(), Style::line(color::WHITE, pen.width + 2.6).faded(0.85)));
        lines.push(Item::Outline(steps, Style { pen: Some(pen), ..Style::line(pen.color, pen.width) }));
    }
    halos.extend(lines);
    halos
}

/// The whole page: workspace, configuration space, title and legend.
#[must_use]
pub fn compose(picture: &Picture) -> Figure {
    let mut items = titles(&picture.title, &picture.status);
    let top = 62.0 + 18.0 * picture.title.len().max(1) as f64;
    let keys = legend::layout(legend::keys(picture), WIDTH - 2.0 * MARGIN);
    let legend_top = HEIGHT - 14.0 - legend::ROW * keys.len() as f64;
    let height = legend_top - 58.0 - top;
    let left = Rect { x: 84.0, y: top, width: 570.0, height };
    let right = Rect { x: 770.0, y: top, width: 530.0, height };
    items.extend(workspace::panel(picture, left));
    items.extend(cspace::panel(picture, right));
    items.push(heading("Workspace", left));
    items.push(heading("Configuration space", right));
    items.extend(legend::items(&keys, WIDTH / 2.0, legend_top));
    Figure { width: WIDTH, height: HEIGHT, items }
}

/// Draws an arm in one configuration: the workspace takes the whole page.
#[must_use]
pub fn compose_arm(arm_picture: &ArmPicture) -> Figure {
    let picture = arm_picture.picture();
    let mut items = titles(&picture.title, &picture.status);
    let top = 44.0 + 18.0 * picture.title.len().max(1) as f64;
    let area = Rect { x: 84.0, y: top, width: WIDTH - 84.0 - MARGIN, height: HEIGHT - 58.0 - top };
    items.extend(workspace::panel(&picture, area));
    items.extend(frames::items(&workspace::frame(&picture, area), &arm_picture.frames));
    Figure { width: WIDTH, height: HEIGHT, items }
}

fn heading(text: &str, area: Rect) -> Item {
    let at = [area.x + area.width / 2.0, area.y - 12.0];
    label(at, text.to_owned(), 16.0, Anchor::Middle, INK)
}

/// The title and the lines below it, and the status in the opposite corner.
pub fn titles(lines: &[String], status: &str) -> Vec<Item> {
    let mut items = Vec::new();
    let status_width = text_width(status, 18.0);
    items.push(label([WIDTH - MARGIN, 36.0], status.to_owned(), 18.0, Anchor::End, INK));
    for (i, line) in lines.iter().enumerate() {
        let (size, color, y) = if i == 0 { (22.0, INK, 36.0) } else { (14.0, GREY, 40.0 + 18.0 * i as f64) };
        let room = WIDTH - 2.0 * MARGIN - if i == 0 { status_width + 30.0 } else { 0.0 };
        items.push(label([MARGIN, y], shortened(line, size, room), size, Anchor::Start, color));
    }
    items
}

/// A text that reads to the right.
pub fn label(at: [f64; 2], text: String, size: f64, anchor: Anchor, color: Rgb) -> Item {
    Item::Text(Label { at, text, size, anchor, upwards: false, color })
}
