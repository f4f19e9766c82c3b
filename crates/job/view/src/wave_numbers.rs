//! Numbers of a wavefront, drawn in its cells.

use super::figure::{Anchor, Item, Rect, Step, Style, label, text_width};
use super::view::{LEVELS, Waves};
use cplan_theme::{INK, PALE, WHITE};

/// Smallest legible height of digits, in pixels.
const MIN_DIGIT_HEIGHT: f64 = 5.0;
/// Greatest height of digits, in pixels.
const MAX_DIGIT_HEIGHT: f64 = 13.0;
/// Fractions of a cell's width and height that digits in its corner fill, beside a path through the middles of cells. In small
/// cells, digits fill the whole cell.
const CORNER_SHARE: [f64; 2] = [0.42, 0.38];
/// First level with cells so dark that their digits are white.
const FIRST_DARK_LEVEL: usize = LEVELS * 3 / 5;

/// Draws the sides of cells, and the number of each cell that the wave reached. Draws nothing if digits would be too small to
/// read.
pub fn items(waves: &Waves, frame: &Rect) -> Vec<Item> {
    let Some(longest) = waves.numbers.iter().flatten().max() else { return Vec::new() };
    let [columns, rows] = waves.blocks;
    let cell = [frame.width / columns as f64, frame.height / rows as f64];
    let fitting = |[width, height]: [f64; 2]| {
        (width * cell[0] / text_width(&longest.to_string(), 1.0)).min(height * cell[1]).min(MAX_DIGIT_HEIGHT)
    };
    let in_corner = fitting(CORNER_SHARE) >= MIN_DIGIT_HEIGHT;
    let size = if in_corner { fitting(CORNER_SHARE) } else { fitting([0.9, 0.75]) };
    if size < MIN_DIGIT_HEIGHT {
        return Vec::new();
    }
    let mut sides = Vec::new();
    for i in 1..columns {
        let x = frame.x + i as f64 * cell[0];
        sides.extend([Step::Move([x, frame.y]), Step::Line([x, frame.bottom()])]);
    }
    for j in 1..rows {
        let y = frame.y + j as f64 * cell[1];
        sides.extend([Step::Move([frame.x, y]), Step::Line([frame.right(), y])]);
    }
    let mut items = vec![Item::Outline(sides, Style::line(PALE, 0.5).faded(0.6))];
    for (k, (number, level)) in waves.numbers.iter().zip(waves.levels()).enumerate() {
        let (Some(number), Some(level)) = (number, level) else { continue };
        let color = if level >= FIRST_DARK_LEVEL { WHITE } else { INK };
        let corner = [frame.x + (k / rows) as f64 * cell[0], frame.bottom() - (k % rows + 1) as f64 * cell[1]];
        let (at, anchor) = if in_corner {
            ([corner[0] + 1.5, corner[1] + 0.9 * size], Anchor::Start)
        } else {
            ([corner[0] + cell[0] / 2.0, corner[1] + cell[1] / 2.0 + 0.36 * size], Anchor::Middle)
        };
        items.push(label(at, number.to_string(), size, anchor, color));
    }
    items
}
