//! What is done, step by step.

use super::TaskPicture;
use super::states::rounds;
use crate::draw::color::{BARRED, GREY, INK, Rgb};
use crate::draw::figure::{Anchor, Item, Rect, shortened, text_width};
use crate::draw::page::label;
use crate::engine::task::TaskVerdict;

/// Height of a row, pixels.
const ROW: f64 = 19.0;
const SIZE: f64 = 13.0;
/// More rows than this are not shown.
const MOST: usize = 26;
/// More lines than this on why a step fails are not shown.
const MOST_REASONS: usize = 4;

/// A row: the step's number, what it does, and when it is over.
struct Row {
    number: String,
    text: String,
    time: String,
    color: Rgb,
}

/// The lines of the title and the status.
#[must_use]
pub fn words(picture: &TaskPicture) -> (Vec<String>, String) {
    let mut lines = picture.title.clone();
    let Some(impossible) = picture.answer.impossible() else { return (lines, picture.status.clone()) };
    let step = &impossible.step;
    let round = if step.cycle > 1 { format!(", round {}", step.cycle) } else { String::new() };
    let status = format!("step {}{round} fails: {}", step.number, picture.status);
    let what = step.action.describe(&picture.task.objects);
    let heading = format!("step {}, {what}:", step.number);
    let reasons = &impossible.reasons;
    if let [reason] = &reasons[..] {
        lines.push(format!("{heading} {reason}"));
        return (lines, status);
    }
    lines.push(heading);
    let shown = if reasons.len() > MOST_REASONS { MOST_REASONS - 1 } else { reasons.len() };
    lines.extend(reasons[..shown].iter().cloned());
    if shown < reasons.len() {
        lines.push(format!("and {} further reasons", reasons.len() - shown));
    }
    (lines, status)
}

/// Each step once, as it is done the first time; then the one that fails.
fn rows(picture: &TaskPicture) -> Vec<Row> {
    let objects = &picture.task.objects;
    let mut seen = std::collections::BTreeSet::new();
    let mut rows = Vec::new();
    for leg in picture.answer.legs.iter().filter(|leg| seen.insert(leg.step.number)) {
        let (number, text) = (leg.step.number.to_string(), leg.step.action.describe(objects));
        rows.push(Row { number, text, time: format!("{:.2} s", leg.end()), color: INK });
    }
    if rows.len() > MOST {
        let text = format!("and {} further steps", rows.len() - MOST);
        rows.truncate(MOST);
        rows.push(Row { number: String::new(), text, time: String::new(), color: GREY });
    }
    if let Some(impossible) = picture.answer.impossible() {
        let time = match picture.answer.verdict {
            TaskVerdict::Infeasible(_) => "impossible",
            _ => "unknown",
        };
        let step = &impossible.step;
        let (number, text) = (step.number.to_string(), step.action.describe(objects));
        rows.push(Row { number, text, time: time.to_owned(), color: BARRED });
    }
    rows
}

/// Height of the list, pixels.
#[must_use]
pub fn height(picture: &TaskPicture) -> f64 {
    (1 + rows(picture).len()) as f64 * ROW
}

/// The list in the upper part of `area`.
#[must_use]
pub fn items(picture: &TaskPicture, area: Rect) -> Vec<Item> {
    let rounds = rounds(&picture.answer.legs);
    let which = if rounds > 1 { format!("end, first of {rounds} rounds") } else { "end".to_owned() };
    let heading = Row { number: String::new(), text: "step".to_owned(), time: which, color: GREY };
    let mut items = Vec::new();
    for (i, row) in [heading].into_iter().chain(rows(picture)).enumerate() {
        let y = area.y + ROW * (i as f64 + 0.75);
        let room = area.width - 34.0 - text_width(&row.time, SIZE) - 16.0;
        items.push(label([area.x + 24.0, y], row.number, SIZE, Anchor::End, row.color));
        items.push(label([area.x + 34.0, y], shortened(&row.text, SIZE, room), SIZE, Anchor::Start, row.color));
        items.push(label([area.right(), y], row.time, SIZE, Anchor::End, row.color));
    }
    items
}
