//! Whether a page shows what a program says: `[...]` leaves out lines, or the rest of one; times are nobody's promise.

use crate::rounding;

/// What is left out.
const OUT: &str = "[...]";

/// Stands for what differs from run to run.
const ANY: &str = "~";

/// Cells of a line of a table, which two blanks or more part.
fn cells(line: &str) -> Vec<&str> {
    line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

/// The lines of a text in a form to compare by: without the widths of columns, and without times and memory.
fn lines(text: &str) -> Vec<String> {
    let is_volatile = |head: &&str| head.ends_with("[ms]") || head.ends_with("[MiB]");
    let mut volatile: Vec<usize> = Vec::new();
    let mut lines = Vec::new();
    for line in text.lines() {
        let cells = cells(line);
        if cells.len() > 1 && cells.iter().any(|head| is_volatile(&head)) {
            volatile = (0..cells.len()).filter(|&k| is_volatile(&cells[k])).collect();
        } else if line.is_empty() {
            volatile.clear();
        }
        let rule = cells.len() > 1 && line.chars().all(|c| c == '-' || c == ' ');
        let is_time = cells.first() == Some(&"time");
        let shown = (0..cells.len()).map(|k| match (rule, volatile.contains(&k)) {
            (true, _) => "---",
            (_, true) if !is_volatile(&cells[k]) => ANY,
            _ => cells[k],
        });
        let mut shown = shown.collect::<Vec<_>>().join("  ");
        if is_time {
            shown = shown
                .split(' ')
                .map(|word| if word.trim_end_matches(',').parse::<f64>().is_ok() { ANY } else { word })
                .collect::<Vec<_>>()
                .join(" ");
        }
        lines.push(shown);
    }
    lines
}

/// Whether a line is what is shown for it.
fn is_line(shown: &str, said: &str) -> bool {
    match shown.strip_suffix(OUT) {
        Some(begin) => (0..=said.len())
            .filter(|&k| said.is_char_boundary(k))
            .any(|k| rounding::same(begin.trim_end(), said[..k].trim_end())),
        None => rounding::same(shown, said),
    }
}

fn are_lines(shown: &[String], said: &[String]) -> bool {
    match shown {
        [] => said.is_empty(),
        [first, rest @ ..] if first == OUT => (0..=said.len()).any(|k| are_lines(rest, &said[k..])),
        [first, rest @ ..] => said.first().is_some_and(|line| is_line(first, line)) && are_lines(rest, &said[1..]),
    }
}

/// Nothing if `shown` is what was `said`, else what is not.
pub fn difference(shown: &str, said: &str) -> Option<String> {
    let (shown, heard) = (lines(shown), lines(said));
    if are_lines(&shown, &heard) {
        return None;
    }
    let missing: Vec<&String> =
        shown.iter().filter(|line| *line != OUT && !heard.iter().any(|said| is_line(line, said))).collect();
    let what = match missing.first() {
        Some(line) => format!("it does not say\n    {line}"),
        None => "it says that in another order, or more".into(),
    };
    Some(format!("{what}\n  but\n    {}", said.trim_end().replace('\n', "\n    ")))
}

#[test]
fn differences_are_seen() {
    let said = "arm        two\ntime       load 0.7, query 2.3 ms\nfile       plan.json\n           plan.svg\n";
    for shown in [
        said,
        "[...]\nfile       plan.json\n[...]\n",
        "arm        t[...]\n[...]\n",
        "[...]\ntime       load 9.1, query 12.3 ms\n[...]\n",
    ] {
        assert_eq!(difference(shown, said), None, "{shown}");
    }
    for shown in [
        "",
        "arm        two\n",
        "[...]\narm        two\n",
        "file       plan.json\n[...]\narm[...]\n[...]\n",
        "[...]\ntime       load 0.7, bound 2.3 ms\n[...]\n",
    ] {
        assert!(difference(shown, said).is_some(), "{shown}");
    }
    let table = |time: &str, length: &str| {
        format!("planner  length  total [ms]\n-------  ------  ----------\nfirst    {length}  {time}\n\n")
    };
    assert_eq!(difference(&table("     1.5", "1.50"), &table("  123.5", "1.51")), None);
    assert!(difference(&table("1.5", "1.50"), &table("1.5", "1.52")).is_some());
}
