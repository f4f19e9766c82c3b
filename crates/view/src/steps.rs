//! The list of the steps of a task.

use super::figure::{Anchor, Item, Rect, label, shortened, text_width};
use super::view::Row;

/// Height of a row, in pixels.
pub const ROW_HEIGHT: f64 = 19.0;
const TEXT_SIZE: f64 = 13.0;

/// Draws the list in the upper part of `area`.
#[must_use]
pub fn items(rows: &[Row], area: Rect) -> Vec<Item> {
    let mut items = Vec::new();
    for (i, Row { number, text, time, color }) in rows.iter().enumerate() {
        let y = area.y + ROW_HEIGHT * (i as f64 + 0.75);
        let room = area.width - 34.0 - text_width(time, TEXT_SIZE) - 16.0;
        items.push(label([area.x + 24.0, y], number, TEXT_SIZE, Anchor::End, *color));
        items.push(label([area.x + 34.0, y], shortened(text, TEXT_SIZE, room), TEXT_SIZE, Anchor::Start, *color));
        items.push(label([area.right(), y], time, TEXT_SIZE, Anchor::End, *color));
    }
    items
}
