//! Reading robots, worlds, tasks and maps, and the diagnostics of invalid ones.

mod arms;
mod errors;
mod inspect;
mod mutations;
mod maps;
mod packages;
mod pairs;
mod places;
mod real_urdfs;
mod tasks;
mod tool_values;
mod world_schema;

/// Checks that a text has all parts of a pattern, which ` ... ` separates.
#[track_caller]
fn fits(text: &str, pattern: &str) {
    for part in pattern.split(" ... ") {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}

/// Returns a text with a piece of it replaced.
#[track_caller]
fn with_change(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// Returns the rows of a table of changes to a valid file. A row is a line of fields that ` => ` separates: a piece of the
/// file, the text in its place, a pattern of the message, and perhaps texts that its hint suggests. An indented line
/// continues a row, `"` repeats the first field of the row before, `nothing` is an empty field, and `\n` a line break.
fn changes(table: &str) -> Vec<Vec<String>> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for line in table.replace("\n    ", " ").lines().filter(|line| !line.is_empty()) {
        let mut row: Vec<String> = line.split(" => ").map(|field| field.replace("\\n", "\n")).collect();
        assert!(row.len() > 2, "{line}");
        row.iter_mut().filter(|field| *field == "nothing").for_each(String::clear);
        if row[0] == "\"" {
            row[0] = rows[rows.len() - 1][0].clone();
        }
        rows.push(row);
    }
    assert!(!rows.is_empty());
    rows
}
