//! A line a step, for people.

use crate::text::counted;

/// Repetitions of a step that are shown; of the others only how many there are.
const SHOWN_CYCLES: usize = 3;

/// A step: which repetition it is, whether it is shown whichever that is, and its line in four columns.
pub struct StepLine {
    pub cycle: usize,
    pub matters: bool,
    pub columns: [String; 4],
}

/// The lines; runs of later cycles in one each.
pub fn step_lines(steps: &[StepLine]) -> Vec<String> {
    let shown = |step: &StepLine| step.matters || step.cycle <= SHOWN_CYCLES;
    let width = |k: usize| {
        let rows = steps.iter().filter(|step| shown(step));
        rows.map(|step| step.columns[k].chars().count()).max().unwrap_or(0)
    };
    let [a, b, c] = [0, 1, 2].map(width);
    let mut lines = Vec::new();
    for run in steps.chunk_by(|a, b| shown(a) == shown(b)) {
        if shown(&run[0]) {
            lines.extend(run.iter().map(|StepLine { columns: [number, action, carried, motion], .. }| {
                format!("{number:<a$}  {action:<b$}  {carried:<c$}  {motion}")
            }));
        } else {
            let cycles = run.iter().map(|step| step.cycle);
            let (first, last) =
                cycles.fold((usize::MAX, 0), |(first, last), cycle| (first.min(cycle), last.max(cycle)));
            let which = if first == last { format!("cycle {first}") } else { format!("cycles {first} to {last}") };
            lines.push(format!("... {} in {which}", counted(run.len(), "step")));
        }
    }
    lines
}
