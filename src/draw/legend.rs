//! What the signs mean.

use super::Picture;
use super::color::{self, INK, PALE, Rgb};
use super::figure::{Anchor, Item, Label, Pen, Rect, Step, Style, rectangle, shortened, text_width};
use super::{arm, boxes, cspace, page, preferences, shapes, trace};
use crate::model::Payload;

/// Height of a row, pixels.
pub const ROW: f64 = 21.0;
const SIZE: f64 = 13.0;
const SIGN: f64 = 26.0;
const GAP: f64 = 26.0;
/// More obstacles than this are not named.
const NAMED: usize = 8;

/// What stands before a name.
#[derive(Debug, Clone, PartialEq)]
pub enum Sign {
    /// Where the motion begins.
    Start,
    /// Where it ends.
    Goal,
    /// Where it would end.
    Unreached,
    /// A piece of line, drawn with this pen.
    Line(Pen),
    /// A small square of this colour.
    Swatch(Rgb),
    /// A dashed outline.
    Dashed(Rgb),
}

/// A sign and what it means.
pub type Key = (Sign, String);

/// Everything that the picture needs explained.
#[must_use]
pub fn keys(picture: &Picture) -> Vec<Key> {
    let mut keys = vec![(Sign::Start, "start".to_owned()), (Sign::Goal, "goal".to_owned())];
    let count = picture.paths.len();
    for (i, (name, _)) in picture.paths.iter().enumerate() {
        let name = if count == 1 { "path, and trace of the tip".to_owned() } else { name.clone() };
        keys.push((Sign::Line(page::path_pen(i, count)), name));
    }
    keys.extend(picture.trace.map_or_else(Vec::new, trace::keys));
    keys.extend(picture.proof.map(|_| boxes::proof_key()));
    keys.extend(preferences::keys(&picture.scene.workspace().preferences));
    keys.push((Sign::Line(Pen { color: PALE, width: 1.0, dash: &[2.0, 4.0] }), "reach".to_owned()));
    let obstacles = &picture.scene.workspace().obstacles;
    // Obstacles without pieces lie nowhere: they are carried.
    let lying = obstacles.iter().enumerate().filter(|(_, o)| !o.pieces.is_empty());
    if lying.clone().count() <= NAMED {
        keys.extend(lying.map(|(i, o)| (Sign::Swatch(color::obstacle(i)), o.name.clone())));
    }
    let carried =
        |payload: &Payload| (Sign::Swatch(arm::payload_color(picture.scene)), format!("{}, carried", payload.object));
    keys.extend(picture.scene.payload().map(carried));
    keys
}

fn width(key: &Key) -> f64 {
    SIGN + 8.0 + text_width(&key.1, SIZE)
}

/// Breaks the keys into rows of this width.
#[must_use]
pub fn layout(keys: Vec<Key>, room: f64) -> Vec<Vec<Key>> {
    let mut rows: Vec<Vec<Key>> = vec![Vec::new()];
    let mut used = 0.0;
    for (sign, name) in keys {
        let key = (sign, shortened(&name, SIZE, room / 5.0));
        let needed = width(&key) + GAP;
        let last = rows.len() - 1;
        if used + needed > room && !rows[last].is_empty() {
            rows.push(vec![key]);
            used = needed;
        } else {
            rows[last].push(key);
            used += needed;
        }
    }
    rows
}

/// The rows, centred about `middle`, the first of them below `top`.
#[must_use]
pub fn items(rows: &[Vec<Key>], middle: f64, top: f64) -> Vec<Item> {
    let mut items = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let total = row.iter().map(|k| width(k) + GAP).sum::<f64>() - GAP;
        let (mut x, y) = (middle - total / 2.0, top + ROW * (i as f64 + 0.5));
        for key in row {
            items.extend(sign(&key.0, x, y));
            let at = [x + SIGN + 8.0, y + 4.5];
            let text = key.1.clone();
            items.push(Item::Text(Label { at, text, size: SIZE, anchor: Anchor::Start, upwards: false, color: INK }));
            x += width(key) + GAP;
        }
    }
    items
}

fn sign(sign: &Sign, x: f64, y: f64) -> Vec<Item> {
    match sign {
        Sign::Start => cspace::start_marker([x + SIGN - 9.0, y]),
        Sign::Goal => cspace::goal_marker([x + SIGN - 9.0, y], true),
        Sign::Unreached => cspace::goal_marker([x + SIGN - 9.0, y], false),
        Sign::Line(pen) => {
            let style = Style { pen: Some(*pen), ..Style::line(pen.color, pen.width) };
            vec![Item::Outline(vec![Step::Move([x, y]), Step::Line([x + SIGN, y])], style)]
        }
        Sign::Swatch(color) => {
            let style = Style::line(color.darker(0.25), 1.0).filled(color.lighter(0.25));
            vec![Item::Outline(rectangle(swatch(x, y)), style)]
        }
        Sign::Dashed(color) => {
            vec![Item::Outline(rectangle(swatch(x, y)), Style::line(*color, 1.4).dashed(shapes::DASH))]
        }
    }
}

fn swatch(x: f64, y: f64) -> Rect {
    Rect { x: x + SIGN - 16.0, y: y - 6.0, width: 16.0, height: 12.0 }
}
