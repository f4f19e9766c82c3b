//! `cplan man`: manual pages, from the same words as the help.

use super::args::Cli;
use super::failure::Failure;
use super::fresh::folder;
use super::{DONE, output};
use crate::trajectory::write_whole_set;
use clap::{Args, Command, CommandFactory, ValueHint};
use clap_mangen::Man;
use std::io;
use std::path::PathBuf;

/// Arguments of `man`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan man > cplan.1
  cplan man man1

man ./cplan.1 shows a page; pages in ~/.local/share/man/man1 are found by name, such as man cplan-check.")]
pub struct ManArgs {
    /// Folder for the pages of all commands, which replace those that are there; without it the main page is printed.
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub dir: Option<PathBuf>,
}

/// Prints the main page, or writes all pages.
///
/// # Errors
/// I/O.
pub fn run(args: &ManArgs) -> Result<u8, Failure> {
    let mut command = Cli::command().disable_help_subcommand(true);
    // Gives the subcommands their full names.
    command.build();
    let failed = |error: io::Error| Failure::Option(format!("manual page: {error}"));
    let Some(dir) = &args.dir else {
        output::print(&String::from_utf8_lossy(&page(&command).map_err(failed)?))?;
        return Ok(DONE);
    };
    folder(dir)?;
    let all = std::iter::once(&command).chain(command.get_subcommands());
    let pages =
        all.map(|c| Ok((dir.join(Man::new(c.clone()).get_filename()), page(c)?))).collect::<io::Result<Vec<_>>>();
    let pages = pages.map_err(failed)?;
    write_whole_set(&pages)?;
    let names: Vec<String> = pages.iter().map(|(path, _)| path.display().to_string() + "\n").collect();
    output::print(&names.concat())?;
    Ok(DONE)
}

/// The page of one command.
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

/// What stands below the options of a help text, in roff. A line that is not indented and ends in a colon begins a section,
/// any other text before the first one is notes; indented lines stay lines, as examples and tables have to.
fn sections(text: &str) -> String {
    let mut roff = String::new();
    let (mut in_section, mut in_lines) = (false, false);
    for line in text.lines() {
        let is_indented = line.starts_with(' ');
        if is_indented != in_lines && !line.is_empty() {
            roff += if is_indented { ".PP\n.EX\n" } else { ".EE\n" };
            in_lines = is_indented;
        }
        match line.strip_suffix(':').filter(|_| !is_indented) {
            Some(title) => {
                roff += &format!(".SH {}\n", quoted(&title.to_uppercase()));
                in_section = true;
            }
            None if line.is_empty() => roff += ".PP\n",
            None => {
                if !in_section {
                    roff += ".SH NOTES\n";
                    in_section = true;
                }
                roff += &escaped(line.strip_prefix("  ").unwrap_or(line));
                roff.push('\n');
            }
        }
    }
    if in_lines {
        roff += ".EE\n";
    }
    roff
}

fn quoted(title: &str) -> String {
    format!("\"{}\"", escaped(title).replace('"', "\\(dq"))
}

/// Text as roff takes it: no escapes, no requests, hyphens that can be copied.
fn escaped(line: &str) -> String {
    let text = line.replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq");
    if text.starts_with('.') { format!("\\&{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_stay_lines_and_text_does_not() {
        let roff = sections("A note\nin two lines.\n\nExamples:\n  cplan a --b 'c'\n  .d\n\nMore of it.");
        let expected = ".SH NOTES\nA note\nin two lines.\n.PP\n.SH \"EXAMPLES\"\n.PP\n.EX\ncplan a \\-\\-b \\(aqc\\(aq\n\
                        \\&.d\n.PP\n.EE\nMore of it.\n";
        assert_eq!(roff, expected);
    }
}
