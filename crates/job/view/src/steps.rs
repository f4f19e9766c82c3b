//! The list of the steps of a task.

use super::figure::{Anchor, Item, Rect, Step, Style, bold, label, shortened, text_width};
use super::view::Row;
use cplan_theme::{FAINT, GRAY};

/// Height of a row, in pixels.
pub const ROW_HEIGHT: f64 = 22.0;
const TEXT_SIZE: f64 = 14.0;
/// Size of the column with numbers of steps in the file.
const SMALL_SIZE: f64 = 12.0;
/// Width of that column, to the left of the times, in pixels.
const FILE_NUMBER_WIDTH: f64 = 64.0;
/// Name of that column.
const FILE_NUMBER_HEAD: &str = "in the file";
/// Width of the column with numbers, in pixels.
const NUMBER_WIDTH: f64 = 26.0;

/// Draws a list of steps in the upper part of `area`: first the names of the columns, then a row for each step, with a
/// line below each.
pub fn items(head: &Row, rows: &[Row], area: Rect) -> Vec<Item> {
    let mut items = Vec::new();
    let has_file_numbers = rows.iter().any(|row| row.file_number.is_some());
    let times = rows.iter().chain([head]).map(|row| text_width(&row.time, TEXT_SIZE)).fold(0.0, f64::max) + 20.0;
    for (i, row) in std::iter::once(head).chain(rows).enumerate() {
        let Row { number, text, time, color, file_number } = row;
        let (top, y) = (area.y + ROW_HEIGHT * i as f64, area.y + ROW_HEIGHT * (i as f64 + 0.68));
        let file = if has_file_numbers { FILE_NUMBER_WIDTH } else { 0.0 };
        let room = area.width - NUMBER_WIDTH - 10.0 - times - file;
        let text = shortened(text, TEXT_SIZE, room);
        let write = if i == 0 { bold } else { label };
        items.push(write([area.x + NUMBER_WIDTH, y], number.clone(), TEXT_SIZE, Anchor::End, *color));
        items.push(write([area.x + NUMBER_WIDTH + 10.0, y], text, TEXT_SIZE, Anchor::Start, *color));
        items.push(write([area.right(), y], time.clone(), TEXT_SIZE, Anchor::End, *color));
        let in_file =
            if i == 0 { FILE_NUMBER_HEAD.to_owned() } else { file_number.map_or_else(String::new, |n| n.to_string()) };
        if has_file_numbers {
            items.push(label([area.right() - times, y], in_file, SMALL_SIZE, Anchor::End, GRAY));
        }
        let bottom = top + ROW_HEIGHT;
        let steps = vec![Step::Move([area.x, bottom]), Step::Line([area.right(), bottom])];
        items.push(Item::Outline(steps, Style::line(FAINT, 1.0)));
    }
    items
}
