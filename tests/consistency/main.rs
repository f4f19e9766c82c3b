//! Checks that no command contradicts another one. `plan`, `explain`, `check`, `verify`, `study`, `batch`, `follow` and
//! the independent checker answer the same random motions of two and of four joints, tasks and lines.
//!
//! ```sh
//! CPLAN_TIMES=20 cargo test --profile quick --test consistency -- --nocapture
//! ```

mod comparison;
mod program;
mod steps;
mod worlds;

use comparison::compare;
use cplan_cases::dice::Dice;
use cplan_cases::{dice, times, uses_default_cases};
use std::collections::BTreeMap;
use worlds::Case;

/// Compares random cases of a kind. Returns the number of cases with each status.
fn compare_random(stream: u64, usual: u64, draw: fn(&mut Dice) -> Case) -> BTreeMap<&'static str, usize> {
    let (mut statuses, mut failures) = (BTreeMap::new(), Vec::new());
    for number in 0..times(usual) {
        let mut dice = dice(stream << 32 | number);
        let case = draw(&mut dice);
        let (status, contradictions) = compare(&case);
        *statuses.entry(status).or_default() += 1;
        if !contradictions.is_empty() {
            let Case { urdf, world, line, .. } = &case;
            let robot = if urdf.contains("drawn") { urdf.as_str() } else { "" };
            let line = line.as_deref().unwrap_or_default();
            failures.push(format!("case {number}: {}\n{robot}\n{world}\n{line}", contradictions.join("\n")));
        }
    }
    println!("{statuses:?}");
    let count = failures.len();
    assert!(count == 0, "{count} contradictions, among them\n{}", failures[..count.min(3)].join("\n\n"));
    statuses
}

/// Checks that the default cases have at least this many answers of each status.
fn require_statuses(statuses: &BTreeMap<&'static str, usize>, least: &[(&str, usize)]) {
    let has = |(status, count): &(&str, usize)| statuses.get(status).is_some_and(|found| found >= count);
    assert!(!uses_default_cases() || least.iter().all(has), "{statuses:?}, not {least:?}");
}

#[test]
fn commands_agree_about_motions() {
    let statuses = compare_random(1, 40, worlds::motion);
    require_statuses(&statuses, &[("found", 5), ("infeasible", 2), ("error", 5)]);
}

#[test]
fn commands_agree_about_motions_of_four_joints() {
    let statuses = compare_random(2, 24, worlds::four_joints);
    require_statuses(&statuses, &[("found", 3), ("infeasible", 2), ("error", 2)]);
}

#[test]
fn commands_agree_about_tasks() {
    let statuses = compare_random(3, 24, steps::picks);
    require_statuses(&statuses, &[("found", 2), ("infeasible", 3), ("error", 1)]);
}

#[test]
fn commands_agree_about_tasks_with_lines() {
    let statuses = compare_random(4, 16, steps::line_steps);
    require_statuses(&statuses, &[("found", 2), ("infeasible", 2)]);
}

#[test]
fn commands_agree_about_lines() {
    let statuses = compare_random(5, 16, steps::line);
    require_statuses(&statuses, &[("found", 2), ("infeasible", 2)]);
}
