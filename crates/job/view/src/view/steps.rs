//! The steps of a task, in words.

use super::task_picture::TaskPicture;
use cplan_handling::{Object, Step};
use cplan_legs::{Leg, TaskAnswer};
use cplan_model::Outcome;
use cplan_theme::{GRAY, INFEASIBLE, INK, Rgb};

/// Largest number of rows that a list shows.
const MAX_ROWS: usize = 26;
/// Largest number of lines with reasons why a step fails.
const MAX_REASONS: usize = 4;

/// A row: the step's number, its action, and its end time.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    pub number: String,
    pub text: String,
    pub time: String,
    pub color: Rgb,
    /// Number of the step in the file, if it differs.
    pub file_number: Option<usize>,
}

impl Row {
    fn new(number: impl ToString, text: impl Into<String>, time: impl Into<String>, color: Rgb) -> Self {
        Self { number: number.to_string(), text: text.into(), time: time.into(), color, file_number: None }
    }

    fn of(step: &Step, order: &Order, objects: &[Object], time: impl Into<String>, color: Rgb) -> Self {
        let number = order.number(step);
        let file_number = (number != step.number).then_some(step.number);
        Self { file_number, ..Self::new(number, step.action.describe(objects), time, color) }
    }
}

/// Numbers of steps in pictures, in the order of first execution. The order in the file can differ.
pub struct Order(Vec<usize>);

impl Order {
    pub fn of(answer: &TaskAnswer) -> Self {
        let done = answer.legs.iter().map(|leg| leg.step.number);
        let mut order: Vec<usize> = Vec::new();
        for number in done.chain(answer.failed().map(|fails| fails.step.number)) {
            if !order.contains(&number) {
                order.push(number);
            }
        }
        Self(order)
    }

    /// Returns the number of a step.
    pub fn number(&self, step: &Step) -> usize {
        self.0.iter().position(|&number| number == step.number).map_or(step.number, |place| place + 1)
    }

    /// Describes the action of a step, with the step's number in the file if it differs.
    pub fn describe(&self, step: &Step, objects: &[Object]) -> String {
        let what = step.action.describe(objects);
        if self.number(step) == step.number { what } else { format!("{what} ({} in the file)", step.number) }
    }

    /// Returns a step's number and description: `3. pick "part"`.
    pub fn named(&self, step: &Step, objects: &[Object]) -> String {
        format!("{}. {}", self.number(step), self.describe(step, objects))
    }
}

/// Returns the number of repetitions.
pub fn rounds(legs: &[Leg]) -> usize {
    legs.iter().map(|leg| leg.step.cycle).max().unwrap_or(1)
}

/// Returns the rows of the list: the names of the columns, each step at its first execution, and the failed step.
pub fn rows(picture: &TaskPicture) -> Vec<Row> {
    let objects = &picture.task.objects;
    let (order, rounds) = (Order::of(picture.answer), rounds(&picture.answer.legs));
    let which = if rounds > 1 { format!("ends at, first of {rounds} rounds") } else { "ends at".to_owned() };
    let mut seen = std::collections::BTreeSet::new();
    let mut rows = vec![Row::new("", "step", which, GRAY)];
    for leg in picture.answer.legs.iter().filter(|leg| seen.insert(leg.step.number)) {
        rows.push(Row::of(&leg.step, &order, objects, format!("{:.2} s", leg.end()), INK));
    }
    if rows.len() > 1 + MAX_ROWS {
        let text = format!("and {} further steps", rows.len() - 1 - MAX_ROWS);
        rows.truncate(1 + MAX_ROWS);
        rows.push(Row::new("", text, "", GRAY));
    }
    if let Some(failed) = picture.answer.failed() {
        let time = match picture.answer.outcome {
            Outcome::Infeasible(_) => "impossible",
            _ => "unknown",
        };
        let step = &failed.step;
        rows.push(Row::of(step, &order, objects, time, INFEASIBLE));
    }
    rows
}

/// Returns the lines of the title, and the status.
pub fn words(picture: &TaskPicture) -> (Vec<String>, String) {
    let mut lines = picture.title.clone();
    let Some(failed) = picture.answer.failed() else { return (lines, picture.status.clone()) };
    let (order, step) = (Order::of(picture.answer), &failed.step);
    let number = order.number(step);
    let round = if step.cycle > 1 { format!(", round {}", step.cycle) } else { String::new() };
    let status = format!("step {number}{round} fails: {}", picture.status);
    let heading = format!("step {number}, {}:", order.describe(step, &picture.task.objects));
    let reasons = &failed.reasons;
    if let [reason] = &reasons[..] {
        lines.push(format!("{heading} {reason}"));
        return (lines, status);
    }
    lines.push(heading);
    let shown = if reasons.len() > MAX_REASONS { MAX_REASONS - 1 } else { reasons.len() };
    lines.extend(reasons[..shown].iter().cloned());
    if shown < reasons.len() {
        lines.push(format!("and {} further reasons", reasons.len() - shown));
    }
    (lines, status)
}
