//! The steps of a task as lines of a summary.

use cplan_text::{SECOND_COLUMN, counted, wrapped};

/// Width of a line, in characters. With the first column of the summary, it fits a terminal of 80 characters.
const LINE_WIDTH: usize = 80 - SECOND_COLUMN;

/// Number of repetitions of a step that are listed. Later ones are only counted.
const MAX_SHOWN_CYCLES: usize = 3;

/// A step of a task, as a line of the summary.
pub struct StepLine {
    /// Number of the repetition, from 1.
    pub cycle: usize,
    /// True if the step is listed even if it is a late repetition.
    pub is_listed: bool,
    /// Texts of the columns: number, action, payload and motion.
    pub columns: [String; 4],
}

/// Returns the lines of the steps. Consecutive unlisted steps share one line, which counts them. If the columns do not fit in one
/// line, payload and motion are below the action.
pub fn step_lines(steps: &[StepLine]) -> Vec<String> {
    let shown = |step: &StepLine| step.is_listed || step.cycle <= MAX_SHOWN_CYCLES;
    let width = |k: usize| {
        let rows = steps.iter().filter(|step| shown(step));
        rows.map(|step| step.columns[k].chars().count()).max().unwrap_or(0)
    };
    let [a, b, c, d] = [0, 1, 2, 3].map(width);
    let is_narrow = a + b + c + d + 6 <= LINE_WIDTH;
    let row = |StepLine { columns: [number, action, carried, motion], .. }: &StepLine| {
        if is_narrow {
            return vec![format!("{number:<a$}  {action:<b$}  {carried:<c$}  {motion}")];
        }
        let below = format!("{:<a$}  {carried:<c$}  {motion}", "");
        let all = [format!("{number:<a$}  {action}"), below].map(|line| wrapped(&line, LINE_WIDTH, a + 2));
        all.iter().flat_map(|text| text.lines().map(str::to_owned)).collect()
    };
    let mut lines = Vec::new();
    for run in steps.chunk_by(|a, b| shown(a) == shown(b)) {
        if shown(&run[0]) {
            lines.extend(run.iter().flat_map(row));
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

#[cfg(test)]
mod tests {
    use super::*;

    fn line(columns: [&str; 4]) -> StepLine {
        StepLine { cycle: 1, is_listed: false, columns: columns.map(str::to_owned) }
    }

    #[test]
    fn a_table_that_fits_is_one_line_a_step() {
        let steps = [line(["1", "pick \"part\"", "empty-handed", "1.0 s"]), line(["10", "move", "", "2.5 s"])];
        assert_eq!(
            step_lines(&steps),
            ["1   pick \"part\"  empty-handed  1.0 s", "10  move                       2.5 s"]
        );
    }

    #[test]
    fn too_wide_lines_are_continued_below() {
        let action = "place at (0.6, 0.4) m, turned to 1.5708 rad, beside the box that was put there";
        let motion = "0.980 s, turn in 0.512 s, clearance 0.0008 m";
        let lines =
            step_lines(&[line(["3", action, "carrying \"part\"", motion]), line(["4", "move", "empty-handed", "1 s"])]);
        assert_eq!(
            lines,
            [
                "3  place at (0.6, 0.4) m, turned to 1.5708 rad, beside the box that",
                "   was put there",
                "   carrying \"part\"  0.980 s, turn in 0.512 s, clearance 0.0008 m",
                "4  move",
                "   empty-handed     1 s",
            ]
        );
        assert!(lines.iter().all(|line| line.len() <= LINE_WIDTH));
    }
}
