//! Matches recorded steps with those of the task.

use super::OrderDeviation;
use cplan_handling::{Item, RecordedStep, Recording, Step, Task};
use cplan_model::space::Configuration;

/// A step of the task at its place in the record.
#[derive(Debug, Clone)]
pub(super) struct MatchedStep<'a> {
    pub step: &'a Step,
    /// Objects that are supplied before the step.
    pub renewed: Vec<usize>,
    /// Rest after the step's motion, seconds. `None` if the record deviates from the task after the step.
    pub rest: Option<f64>,
}

/// Returns the steps of the task in the order of the record, up to the point where the record deviates from the task.
pub(super) fn match_steps<'a>(
    task: &'a Task,
    recording: &Recording,
    recorded: &[RecordedStep],
) -> (Vec<MatchedStep<'a>>, Option<OrderDeviation>) {
    let mut order = Order { items: &task.items, item: 0, open: Vec::new(), half: None, renewed: Vec::new() };
    let mut all = Vec::new();
    let mut last = 0;
    for (index, record) in recorded.iter().enumerate() {
        let step = match order.match_next(record) {
            Ok(step) => step,
            Err(expected) => {
                let departure = OrderDeviation::Order { index, number: record.number, cycle: record.cycle, expected };
                return (all, Some(departure));
            }
        };
        let first = *record.samples.start();
        if first < last {
            return (all, Some(OrderDeviation::Overlap { index, first, last }));
        }
        match rest_duration(recording, last, first) {
            Ok(rest) => all.last_mut().into_iter().for_each(|before: &mut MatchedStep| before.rest = Some(rest)),
            Err(sample) => return (all, Some(OrderDeviation::Moves { index, sample })),
        }
        all.push(MatchedStep { step, renewed: std::mem::take(&mut order.renewed), rest: None });
        last = *record.samples.end();
    }
    if let Some(expected) = order.describe_next() {
        return (all, Some(OrderDeviation::Missing { count: recorded.len(), expected }));
    }
    match rest_duration(recording, last, recording.positions().len() - 1) {
        Ok(rest) => all.last_mut().into_iter().for_each(|before| before.rest = Some(rest)),
        Err(sample) => return (all, Some(OrderDeviation::Moves { index: recorded.len(), sample })),
    }
    (all, None)
}

/// Returns the duration, in seconds, of the rest from one sample to another.
///
/// # Errors
/// The sample at which the arm moves, or after which its place has changed. No rounding is allowed: at rest, all
/// positions are equal and all velocities 0.
fn rest_duration(recording: &Recording, first: usize, last: usize) -> Result<f64, usize> {
    let (positions, zero) = (recording.positions(), Configuration::zeros());
    for sample in first..last {
        let at_rest = |velocities: &[Configuration]| velocities[sample] == zero && velocities[sample + 1] == zero;
        if positions[sample] != positions[sample + 1] || !recording.velocities().is_some_and(at_rest) {
            return Err(sample);
        }
    }
    Ok(recording.times().map_or(0.0, |times| times[last] - times[first]))
}

/// The remaining items of a task.
struct Order<'a> {
    items: &'a [Item],
    item: usize,
    /// Remaining pairs of the free group in progress.
    open: Vec<&'a [Step; 2]>,
    /// The pair whose object is being carried.
    half: Option<&'a [Step; 2]>,
    renewed: Vec<usize>,
}

impl<'a> Order<'a> {
    /// Skips finished items, up to the next one that has a step.
    fn advance_past_done(&mut self) {
        while self.open.is_empty() && self.half.is_none() {
            match self.items.get(self.item) {
                Some(Item::Renew(objects)) => self.renewed.extend(objects),
                Some(Item::AnyOrder(pairs)) => self.open.extend(pairs),
                Some(Item::Step(_)) | None => return,
            }
            self.item += 1;
        }
    }

    /// Returns the steps that may come next; empty at the end.
    fn candidates(&mut self) -> Vec<&'a Step> {
        self.advance_past_done();
        match (self.half, self.items.get(self.item)) {
            (Some([_, place]), _) => vec![place],
            (None, _) if !self.open.is_empty() => self.open.iter().map(|pair| &pair[0]).collect(),
            (None, Some(Item::Step(step))) => vec![step],
            (None, _) => Vec::new(),
        }
    }

    /// Returns the step that a record names.
    ///
    /// # Errors
    /// A description of the expected steps.
    fn match_next(&mut self, record: &RecordedStep) -> Result<&'a Step, String> {
        let is_it = |step: &&&Step| step.number == record.number && step.cycle == record.cycle;
        let Some(&step) = self.candidates().iter().find(is_it) else {
            return Err(self.describe_next().unwrap_or_else(|| "no more steps".into()));
        };
        if self.half.take().is_some() {
            return Ok(step);
        }
        match self.open.iter().position(|pair| std::ptr::eq(&pair[0], step)) {
            Some(pair) => self.half = Some(self.open.remove(pair)),
            None => self.item += 1,
        }
        Ok(step)
    }

    /// Describes the next step, or returns `None` at the end.
    fn describe_next(&mut self) -> Option<String> {
        let candidates = self.candidates();
        let first = candidates.first()?;
        let numbers: Vec<String> = candidates.iter().map(|step| step.number.to_string()).collect();
        Some(format!("step {} (cycle {})", numbers.join(" or "), first.cycle))
    }
}
