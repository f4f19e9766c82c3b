//! Formats text for a terminal: lines within its width, and colours. Other outputs get unchanged text, for scripts.

use super::exit::{DONE, INFEASIBLE, UNKNOWN};
use crate::text::{SECOND_COLUMN, wrapped};
use anstream::{AutoStream, ColorChoice};
use clap::builder::styling::{AnsiColor, Style};
use std::io::IsTerminal;

#[cfg(not(target_family = "wasm"))]
use terminal_size::terminal_size_of;
use terminal_size::{Height, Width};

/// Least width of wrapped lines, in characters. Narrower lines would have hardly more than one word.
const MIN_WIDTH: usize = 40;

/// Greatest width of messages and help, in characters. Longer lines are hard to read.
pub const WIDEST: usize = 80;

/// The escape sequences before and after the best value of a column: bold.
pub const BEST_VALUE: [&str; 2] = ["\u{1b}[1m", "\u{1b}[0m"];

/// Returns the number of characters per line of a terminal, from the variable `COLUMNS` or the terminal's size. `None`
/// for other outputs.
fn width(is_terminal: bool, size: Option<(Width, Height)>) -> Option<usize> {
    let stated = || std::env::var("COLUMNS").ok()?.parse().ok();
    let seen = || size.map(|(Width(width), _)| usize::from(width));
    let width = is_terminal.then(|| stated().or_else(seen)).flatten().filter(|width| *width > 0);
    width.map(|width| width.max(MIN_WIDTH))
}

/// Returns the size of a terminal, which WebAssembly does not know.
#[cfg(target_family = "wasm")]
fn terminal_size_of<T>(_: T) -> Option<(Width, Height)> {
    None
}

/// Returns a summary wrapped to the terminal's width. If the output shows colours, the exit code determines the colour and
/// the sign of the verdict.
pub fn summary(text: &str, code: u8) -> String {
    let stdout = std::io::stdout();
    let width = width(stdout.is_terminal(), terminal_size_of(&stdout));
    let text = width.map_or_else(|| text.to_owned(), |width| wrap_summary(text, width));
    if AutoStream::choice(&stdout) == ColorChoice::Never { text } else { style_lines(&color_verdict(&text, code)) }
}

/// Returns a message for stderr with a coloured label. On a terminal, its lines are wrapped.
pub fn message(text: &str) -> String {
    let stderr = std::io::stderr();
    let width = width(stderr.is_terminal(), terminal_size_of(&stderr));
    let text = width.map_or_else(|| text.to_owned(), |width| wrap_message(text, width.min(WIDEST)));
    for (label, color) in [("error:", AnsiColor::Red), ("warning:", AnsiColor::Yellow)] {
        if let Some(rest) = text.strip_prefix(label) {
            return format!("{}{rest}", in_color(label, color));
        }
    }
    text
}

/// Beginning of a command. Lines that begin with it are not wrapped, so that they can be copied.
const COMMAND: &str = "cplan ";

/// Wraps the lines of a message, except commands and lines quoted from files. Carets below a quoted line point to one
/// of its columns.
fn wrap_message(text: &str, width: usize) -> String {
    let folded = |line: &str| {
        let blanks = line.chars().take_while(|c| *c == ' ').count();
        let is_command = line.trim_start().strip_prefix("hint: ").is_some_and(|hint| hint.starts_with(COMMAND));
        if is_command || line.contains(" | ") { line.to_owned() } else { wrapped(line, width, blanks + 2) }
    };
    text.split('\n').map(folded).collect::<Vec<_>>().join("\n")
}

/// Wraps the lines of a summary, except commands. Continuation lines begin at the second column.
fn wrap_summary(text: &str, width: usize) -> String {
    let narrowed = |line: &str| {
        let blanks = line.chars().take_while(|c| *c == ' ').count();
        if line.get(SECOND_COLUMN..).is_some_and(|text| text.starts_with(COMMAND)) {
            return line.to_owned() + "\n";
        }
        let has_key = line.chars().nth(SECOND_COLUMN - 1) == Some(' ');
        wrapped(line, width, if blanks == 0 && has_key { SECOND_COLUMN } else { blanks }) + "\n"
    };
    text.lines().map(narrowed).collect()
}

/// Colours the verdict, which ends at the first punctuation mark, by the exit code. Puts a sign before it: a green tick
/// for *found*, a red cross for *infeasible*.
fn color_verdict(text: &str, code: u8) -> String {
    let (color, sign) = match code {
        DONE => (AnsiColor::Green, '\u{2713}'),
        INFEASIBLE => (AnsiColor::Red, '\u{2715}'),
        UNKNOWN => (AnsiColor::Yellow, '?'),
        _ => return text.to_owned(),
    };
    let mut lines = text.split_inclusive('\n');
    let mut before = String::new();
    for line in lines.by_ref() {
        if let Some(result) = line.strip_prefix("result ") {
            let verdict = result.trim_start();
            let blanks = &result[..result.len() - verdict.len()];
            let (verdict, rest) = verdict.split_at(verdict.find([':', ';', ',', '\n']).unwrap_or(verdict.len()));
            let rest: String = std::iter::once(rest).chain(lines).collect();
            return format!("{before}result {blanks}{}{rest}", in_color(&format!("{sign} {verdict}"), color));
        }
        before.push_str(line);
    }
    before
}

/// Dims the notes of a summary, which are less important than the result, and makes warnings yellow.
fn style_lines(text: &str) -> String {
    let styles =
        [("note ", Style::new().dimmed()), ("warning ", Style::new().fg_color(Some(AnsiColor::Yellow.into())))];
    let mut style = None;
    let line = |line: &str| {
        // A line without a key continues the previous one.
        if !line.starts_with(' ') {
            style = styles.iter().find(|(key, _)| line.starts_with(key)).map(|(_, style)| style);
        }
        let (bare, end) = line.strip_suffix('\n').map_or((line, ""), |bare| (bare, "\n"));
        style.map_or_else(|| line.to_owned(), |style| format!("{style}{bare}{style:#}{end}"))
    };
    text.split_inclusive('\n').map(line).collect()
}

fn in_color(text: &str, color: AnsiColor) -> String {
    let style = Style::new().bold().fg_color(Some(color.into()));
    format!("{style}{text}{style:#}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_dim_with_their_continuations() {
        let text = "result     found\nnote       a: is\n           assumed\nfile       b\n";
        let dim = "result     found\n\u{1b}[2mnote       a: is\u{1b}[0m\n\u{1b}[2m           assumed\u{1b}[0m\nfile       b\n";
        assert_eq!(style_lines(text), dim);
    }

    #[test]
    fn lines_go_on_below_their_second_column() {
        let text = "shelf: planar_2r\nresult     there is no path; proven\n             without it there is one\n";
        let narrow = "shelf: planar_2r\nresult     there is no\n           path;\n           proven\n             without\n             \
                      it there\n             is one\n";
        assert_eq!(wrap_summary(text, 22), narrow);
        assert_eq!(wrap_summary(text, 80), text);
    }

    #[test]
    fn only_the_verdict_is_colored() {
        let text = "shelf\nresult     free: proven\nresult     free\n";
        let green = color_verdict(text, DONE);
        assert_eq!(anstream::adapter::strip_str(&green).to_string(), text.replacen("free", "\u{2713} free", 1));
        assert_eq!(green.matches("\u{1b}[32m").count(), 1);
        assert!(green.contains("free\u{1b}[0m: proven\nresult     free\n"), "{green:?}");
        assert!(color_verdict("result     free", INFEASIBLE).contains("\u{1b}[31m\u{2715} free\u{1b}[0m"));
        assert_eq!(color_verdict("no verdict\n", DONE), "no verdict\n");
    }

    #[test]
    fn labels_are_colored() {
        assert!(
            message("error: no").ends_with("error:\u{1b}[0m no")
                && message("warning: no").ends_with("warning:\u{1b}[0m no")
        );
        assert_eq!(message("no error: none"), "no error: none");
    }

    #[test]
    fn messages_are_wrapped_but_source_lines_and_commands_are_not() {
        let quoted = "  12 | joints = [1, 2, 3]\n     | ^^^^\n";
        let command = "  hint: cplan explain a.urdf b.toml";
        let text = format!("error: one two three four\n{quoted}  hint: five six seven\n{command}");
        let narrow = format!("error: one two\n  three four\n{quoted}  hint: five\n    six seven\n{command}");
        assert_eq!(wrap_message(&text, 14), narrow);
        assert_eq!(wrap_message(&text, WIDEST), text);
        assert_eq!(wrap_summary("next       cplan explain a.urdf\n", 20), "next       cplan explain a.urdf\n");
    }
}
