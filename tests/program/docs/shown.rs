//! Compares the output on a page with that of the program. `[...]` leaves out lines, or the rest of a line. Times may
//! differ.

use crate::rounding;

/// Mark for omitted output.
const OUT: &str = "[...]";

/// Placeholder for a value that differs from run to run.
const ANY: &str = "~";

/// Splits a table line into cells, which two blanks or more separate.
fn cells(line: &str) -> Vec<&str> {
    line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

/// Replaces a number by the placeholder.
fn timeless(word: &str) -> &str {
    if word.trim_end_matches(',').parse::<f64>().is_ok() { ANY } else { word }
}

/// Returns the lines of a text in a form that can be compared: without times and memory, and without the widths of the
/// columns beside them. Units may be below their headers.
fn lines(text: &str) -> Vec<String> {
    let is_volatile = |head: &str| head.ends_with("[ms]") || head.ends_with("[MiB]");
    // Volatile columns of the current table, counted from the last.
    let mut volatile: Vec<usize> = Vec::new();
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        let cells = cells(line);
        let from_last = |k: usize| cells.len() - 1 - k;
        let heads = (0..cells.len()).filter(|&k| cells.len() > 1 && is_volatile(cells[k]));
        let heads: Vec<usize> = heads.map(from_last).collect();
        let begins = !heads.is_empty();
        if begins || line.is_empty() {
            volatile = heads;
        }
        if begins && line.starts_with(' ') {
            let above = lines.pop().unwrap_or_default();
            lines.push(self::cells(&above).join("  "));
        }
        let cell = |k: usize| if volatile.contains(&from_last(k)) { ANY } else { cells[k] };
        lines.push(match (begins, volatile.is_empty()) {
            (true, _) => cells.join("  "),
            (_, false) if line.chars().all(|c| c == '-' || c == ' ') => "---".into(),
            (_, false) => (0..cells.len()).map(cell).collect::<Vec<_>>().join("  "),
            _ if line.starts_with("time ") => line.split(' ').map(timeless).collect::<Vec<_>>().join(" "),
            _ => line.trim_end().into(),
        });
    }
    lines
}

/// Returns true if a printed line matches the line on the page.
fn is_line(shown: &str, report: &str) -> bool {
    match shown.strip_suffix(OUT) {
        Some(begin) => (0..=report.len())
            .filter(|&k| report.is_char_boundary(k))
            .any(|k| rounding::same(begin.trim_end(), report[..k].trim_end())),
        None => rounding::same(shown, report),
    }
}

fn are_lines(shown: &[String], report: &[String]) -> bool {
    match shown {
        [] => report.is_empty(),
        [first, rest @ ..] if first.trim() == OUT => (0..=report.len()).any(|k| are_lines(rest, &report[k..])),
        [first, rest @ ..] => report.first().is_some_and(|line| is_line(first, line)) && are_lines(rest, &report[1..]),
    }
}

/// Returns `None` if `shown` matches `report`. Otherwise returns the difference.
pub fn difference(shown: &str, report: &str) -> Option<String> {
    let (shown, heard) = (lines(shown), lines(report));
    if are_lines(&shown, &heard) {
        return None;
    }
    let missing: Vec<&String> =
        shown.iter().filter(|line| line.trim() != OUT && !heard.iter().any(|report| is_line(line, report))).collect();
    let what = match missing.first() {
        Some(line) => format!("it does not say\n    {line}"),
        None => "it says that in another order, or more".into(),
    };
    Some(format!("{what}\n  but\n    {}", report.trim_end().replace('\n', "\n    ")))
}

#[test]
fn differences_from_the_shown_output_are_found() {
    let report = "arm        two\ntime       load 0.7, query 2.3 ms\nfile       plan.json\n           plan.svg\n";
    for shown in [
        report,
        "[...]\nfile       plan.json\n[...]\n",
        "arm        t[...]\n[...]\n",
        "[...]\ntime       load 9.1, query 12.3 ms\n[...]\n",
    ] {
        assert_eq!(difference(shown, report), None, "{shown}");
    }
    for shown in [
        "",
        "arm        two\n",
        "[...]\narm        two\n",
        "file       plan.json\n[...]\narm[...]\n[...]\n",
        "[...]\ntime       load 0.7, bound 2.3 ms\n[...]\n",
    ] {
        assert!(difference(shown, report).is_some(), "{shown}");
    }
    let table = |time: &str, length: &str| {
        format!("planner  length  total [ms]\n-------  ------  ----------\nfirst    {length}  {time}\n\n")
    };
    assert_eq!(difference(&table("     1.5", "1.50"), &table("  123.5", "1.51")), None);
    assert!(difference(&table("1.5", "1.50"), &table("1.5", "1.52")).is_some());
}
