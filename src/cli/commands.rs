//! Macro that converts a list of subcommands to a grammar, a dispatch, and groups for the help.

use clap::Command;
use std::fmt::Write as _;

/// Defines clap's enum `Command` of the subcommands, with `Command::read_alone`, and with `Command::run`, which calls
/// `run` in the file of a subcommand. The input consists of groups of lines `Name(file::Args)`, or `Name(file::Args,
/// meter)` if `run` also takes the counter of the process's memory. `GROUPS` lists the names in each group.
macro_rules! commands {
    ($meter:ident: $($group:literal {
        $($(#[$cfg:meta])? $name:ident($file:ident::$args:ident $(, $context:ident)?),)+
    })+) => {
        /// The subcommands.
        #[derive(Debug, clap::Subcommand)]
        enum Command {
            $($($(#[$cfg])? $name($file::$args),)+)+
        }

        /// Headings of the help, with the subcommands below each.
        const GROUPS: &[(&str, &[&str])] = &[$(($group, &[$($(#[$cfg])? stringify!($name),)+])),+];

        impl Command {
            /// Reads the command line of a subcommand with the grammar of this subcommand alone. The first word is the
            /// subcommand. `None` if the line is wrong, or asks for help.
            fn read_alone(line: &[OsString]) -> Option<Self> {
                let name = line.first()?;
                $($($(#[$cfg])?
                if name == stringify!($name).to_lowercase().as_str() {
                    return read(line).map(Self::$name);
                })+)+
                None
            }

            /// Runs the subcommand, and returns the exit code.
            fn run(&mut self, $meter: Option<MemoryMeter>) -> Result<u8, Failure> {
                match self {
                    $($($(#[$cfg])? Self::$name(args) => $file::run(args $(, $context)?),)+)+
                }
            }
        }
    };
}

pub(super) use commands;

/// Returns a help template that lists the subcommands in groups. It replaces clap's own list, which has no groups and
/// must be hidden.
pub fn help_template(grammar: &Command, groups: &[(&str, &[&str])]) -> String {
    let header = grammar.get_styles().get_header();
    let literal = grammar.get_styles().get_literal();
    let width = grammar.get_subcommands().map(|command| command.get_name().len()).max().unwrap_or(0);
    let mut listed = String::new();
    for (heading, names) in groups {
        let _ = writeln!(listed, "\n{header}{heading}:{header:#}");
        for name in names.iter().map(|name| name.to_lowercase()) {
            let about = grammar.find_subcommand(&name).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let blanks = " ".repeat(width - name.len());
            let _ = writeln!(listed, "  {literal}{name}{literal:#}{blanks}  {about}");
        }
    }
    format!("{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{listed}\n{{all-args}}{{after-help}}")
}
