//! `cplan man`: manual pages, generated from the texts of the help.

use super::exit::DONE;
use super::failure::Failure;
use super::fresh::folder;
use super::{grammar, sinks};
use crate::motion::write_whole_set;
use clap::{Args, Command, ValueHint};
use clap_mangen::Man;
use std::io;
use std::path::PathBuf;

/// Print the manual page, or write the pages of all commands.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan man > cplan.1
  cplan man man1

`man ./cplan.1` shows a page. Pages in ~/.local/share/man/man1 are found by
name, such as `man cplan-check`.

Exit codes: 0 the pages are written, 1 I/O, 2 wrong command line.")]
pub struct ManArgs {
    /// Folder for the pages of all commands; existing pages are replaced. Without it, the main page is printed.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub dir: Option<PathBuf>,
}

/// Prints the main page, or writes all pages.
///
/// # Errors
/// I/O.
pub fn run(args: &ManArgs) -> Result<u8, Failure> {
    let mut command = grammar().disable_help_subcommand(true);
    // This gives the subcommands their full names.
    command.build();
    let failed = |error: io::Error| Failure::Io(format!("manual page: {error}"));
    let Some(dir) = &args.dir else {
        sinks::print(&String::from_utf8_lossy(&page(&command).map_err(failed)?))?;
        return Ok(DONE);
    };
    folder(dir)?;
    let all = std::iter::once(&command).chain(command.get_subcommands());
    let pages =
        all.map(|c| Ok((dir.join(Man::new(c.clone()).get_filename()), page(c)?))).collect::<io::Result<Vec<_>>>();
    let pages = pages.map_err(failed)?;
    write_whole_set(&pages)?;
    let names: Vec<String> = pages.iter().map(|(path, _)| path.display().to_string() + "\n").collect();
    sinks::print(&names.concat())?;
    Ok(DONE)
}

fn page(command: &Command) -> io::Result<Vec<u8>> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut page)?;
    }
    page.extend(sections(&command.get_after_help().map(ToString::to_string).unwrap_or_default()).into_bytes());
    if command.get_version().is_some() {
        man.render_version_section(&mut page)?;
    }
    Ok(page)
}

/// Returns sections in roff from the texts that the help has below the options: examples, exit codes, and notes.
fn sections(text: &str) -> String {
    let mut found: [(&str, &str, Vec<&str>); 3] =
        [("", "NOTES", Vec::new()), ("Exit codes:", "EXIT STATUS", Vec::new()), ("Examples:", "EXAMPLES", Vec::new())];
    for paragraph in text.split("\n\n").filter(|paragraph| !paragraph.is_empty()) {
        // Every text begins with the empty heading, which is that of the notes.
        if let Some((heading, _, paragraphs)) = found.iter_mut().rev().find(|f| paragraph.starts_with(f.0)) {
            paragraphs.push(&paragraph[heading.len()..]);
        }
    }
    found.iter().filter(|f| !f.2.is_empty()).map(|(_, title, paragraphs)| section(title, paragraphs)).collect()
}

/// Formats a section. Indented lines, such as examples, are not joined into paragraphs.
fn section(title: &str, paragraphs: &[&str]) -> String {
    let mut roff = format!(".SH \"{title}\"\n");
    for (i, paragraph) in paragraphs.iter().enumerate() {
        if i > 0 {
            roff += ".PP\n";
        }
        let mut in_lines = false;
        for line in paragraph.lines().filter(|line| !line.trim().is_empty()) {
            let is_indented = line.starts_with("  ");
            if is_indented != in_lines {
                roff += if is_indented { ".EX\n" } else { ".EE\n" };
                in_lines = is_indented;
            }
            roff += &format!("{}\n", escape_roff(line.trim()));
        }
        if in_lines {
            roff += ".EE\n";
        }
    }
    roff
}

/// Returns text without escapes and requests of roff, from which hyphens can be copied.
fn escape_roff(line: &str) -> String {
    let text = line.replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq");
    if text.starts_with('.') { format!("\\&{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_keep_their_lines_and_come_last() {
        let text =
            "A note\nin two lines.\n\nExamples:\n  cplan a --b 'c'\n  .d\nEach is one.\n\nExit codes: 0 done.\n\nMore.";
        let expected = ".SH \"NOTES\"\nA note\nin two lines.\n.PP\nMore.\n.SH \"EXIT STATUS\"\n0 done.\n\
                        .SH \"EXAMPLES\"\n.EX\ncplan a \\-\\-b \\(aqc\\(aq\n\\&.d\n.EE\nEach is one.\n";
        assert_eq!(sections(text), expected);
        assert_eq!(sections(""), "");
    }
}
