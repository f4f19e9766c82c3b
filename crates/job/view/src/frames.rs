//! Coordinate frames of links, drawn by their axes.

use super::axes::Frame;
use super::figure::{Anchor, Item, Step, Style, label};
use super::view::FrameView;
use cplan_geometry::{Vector, perpendicular};
use cplan_theme::{INK, WHITE};

/// Length of an axis that lies in the plane, in pixels.
const AXIS_LENGTH: f64 = 52.0;
/// An axis whose projection is shorter than this share of its length is drawn as perpendicular to the plane.
const PERPENDICULAR_SHARE: f64 = 0.1;
const AXIS_LETTERS: [&str; 3] = ["x", "y", "z"];

/// Draws the axes of the frames, with the letters of the axes and the names of the frames.
pub fn items(panel: &Frame, frames: &[FrameView]) -> Vec<Item> {
    frames.iter().flat_map(|frame| frame_items(panel, frame)).collect()
}

fn frame_items(panel: &Frame, frame: &FrameView) -> Vec<Item> {
    let at = panel.at(frame.at[0], frame.at[1]);
    let mut items = Vec::new();
    for (k, &[u, v, w]) in frame.axes.iter().enumerate() {
        let (color, _) = cplan_theme::path(k);
        // The y axis of the page points down.
        let shadow = Vector::new(u, -v);
        let text = |at: [f64; 2]| label(at, AXIS_LETTERS[k], 14.0, Anchor::Middle, color);
        if shadow.norm() < PERPENDICULAR_SHARE {
            items.extend(perpendicular_axis(at, w > 0.0, Style::line(color, 1.8)));
            items.push(text([at[0] - 15.0, at[1] + 5.0]));
            continue;
        }
        let pen = Style::line(color, 2.4);
        let tip = moved(at, shadow * AXIS_LENGTH);
        let back = shadow.normalize() * -9.0;
        let barb = |side: f64| moved(tip, back + perpendicular(back) * (0.45 * side));
        items.push(Item::Outline(vec![Step::Move(at), Step::Line(tip)], pen));
        items.push(Item::Outline(vec![Step::Move(barb(1.0)), Step::Line(tip), Step::Line(barb(-1.0))], pen));
        items.push(text(moved(tip, shadow.normalize() * 12.0 + Vector::new(0.0, 5.0))));
    }
    items.push(label([at[0] + 9.0, at[1] + 21.0], &frame.name, 13.0, Anchor::Start, INK));
    items
}

/// Draws an axis that is perpendicular to the plane: a circle with a dot if it points towards the viewer, otherwise
/// with a cross.
fn perpendicular_axis(at: [f64; 2], towards: bool, pen: Style) -> Vec<Item> {
    const PERPENDICULAR_RADIUS: f64 = 7.0;
    let ring = Item::Disc(at, PERPENDICULAR_RADIUS, pen.filled(WHITE));
    if towards {
        return vec![ring, Item::Disc(at, 2.2, Style::fill(INK))];
    }
    let r = PERPENDICULAR_RADIUS * std::f64::consts::FRAC_1_SQRT_2;
    let stroke =
        |y: f64| Item::Outline(vec![Step::Move([at[0] - r, at[1] - y]), Step::Line([at[0] + r, at[1] + y])], pen);
    vec![ring, stroke(r), stroke(-r)]
}

fn moved(at: [f64; 2], by: Vector) -> [f64; 2] {
    [at[0] + by.x, at[1] + by.y]
}
