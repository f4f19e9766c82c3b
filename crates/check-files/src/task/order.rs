//! The steps of a task in the order of their execution.

use super::lines;
use crate::world::task::{Group, Node, Step};
use cplan_check::CheckError;
use cplan_check::certificate::{ExecutedStep, Motion};
use cplan_check::decimal::Decimal;
use cplan_check_line::StepLine;
use std::iter::{Enumerate, Peekable};
use std::slice::Iter;

/// A step of the world, together with its execution.
pub(super) struct MatchedStep<'a> {
    pub(super) step: &'a Step,
    pub(super) done: &'a ExecutedStep,
    /// Indices of the objects that return to their initial poses before the step.
    pub(super) renewed: Vec<usize>,
    /// The line, if the step follows one.
    pub(super) line: Option<StepLine>,
}

/// The state of matching executed steps with those of the world.
pub(super) struct Order<'a> {
    pub(super) left: Peekable<Enumerate<Iter<'a, ExecutedStep>>>,
    pub(super) renewed: Vec<usize>,
    pub(super) matched: Vec<MatchedStep<'a>>,
}

impl<'a> Order<'a> {
    pub(super) fn group(&mut self, group: &'a Group) -> Result<(), CheckError> {
        for repetition in 0..group.repeat {
            if repetition > 0 {
                self.renewed.extend(&group.renewed);
            }
            if !group.is_free {
                group.nodes.iter().try_for_each(|node| self.node(node))?;
                continue;
            }
            let mut pairs: Vec<&[Node]> = group.nodes.chunks(2).collect();
            while !pairs.is_empty() {
                let next = self.left.peek().map(|(_, done)| done.step);
                let begins = |pair: &&[Node]| matches!(&pair[0], Node::Step(step) if Some(step.number) == next);
                let pair = pairs.remove(pairs.iter().position(begins).unwrap_or(0));
                pair.iter().try_for_each(|node| self.node(node))?;
            }
        }
        Ok(())
    }

    fn node(&mut self, node: &'a Node) -> Result<(), CheckError> {
        let step = match node {
            Node::Group(group) => return self.group(group),
            Node::Step(step) => step,
        };
        match self.left.next() {
            Some((_, done)) if done.step == step.number => {
                let (renewed, line) = (std::mem::take(&mut self.renewed), lines::read(step, done)?);
                self.matched.push(MatchedStep { step, done, renewed, line });
                Ok(())
            }
            Some((index, done)) => CheckError::fails(format!(
                "steps[{index}] is step {}, but the world requires step {}",
                done.step, step.number
            )),
            None => {
                CheckError::fails(format!("the world requires step {} next, but the certificate ends", step.number))
            }
        }
    }
}

/// Returns the time for which the arm rests after each step. Checks that the arm rests between steps, before the first
/// step, and after the last one.
pub(super) fn rest_durations(motion: &Motion, steps: &[MatchedStep]) -> Result<Vec<Decimal>, CheckError> {
    let knots = &motion.knots;
    let (mut last, mut all) = (0, Vec::new());
    let end = knots.len() - 1;
    let begins = steps.iter().map(|step| step.done.knots[0]).chain([end]);
    for (index, first) in begins.enumerate() {
        if first < last || first > end {
            return CheckError::fails(format!(
                "steps[{index}] begins before the end of the previous step, or after the end of the motion"
            ));
        }
        if let Some(knot) = (last..first).find(|knot| !motion.rests_after_knot(*knot)) {
            return CheckError::fails(format!("the arm moves after knot {knot}, outside all steps"));
        }
        all.push(&knots[first][0] - &knots[last][0]);
        if let Some(step) = steps.get(index) {
            last = step.done.knots[1];
            if last < first || last > end {
                return CheckError::fails(format!(
                    "steps[{index}] ends before its own beginning, or after the end of the motion"
                ));
            }
        }
    }
    all.remove(0);
    Ok(all)
}
