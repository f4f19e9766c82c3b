//! `cplan completions`: scripts with which a shell completes commands, options and the values of options.

use super::exit::DONE;
use super::failure::Failure;
use super::{grammar, sinks};
use clap::{Arg, Args, Command};
use clap_complete::Shell;

/// Print a script that completes commands, options and values.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan completions bash > ~/.local/share/bash-completion/completions/cplan
  cplan completions zsh > ~/.zfunc/_cplan
  cplan completions fish > ~/.config/fish/completions/cplan.fish
  cplan completions powershell >> $PROFILE
  cplan completions elvish >> ~/.config/elvish/rc.elv

For zsh, the folder must be in the path of functions: put fpath+=~/.zfunc before
compinit in ~/.zshrc. The completions work in a new shell.

Exit codes: 0 printed, 1 I/O, 2 wrong command line.")]
pub struct CompletionsArgs {
    /// Name of the shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Prints the shell's script.
///
/// # Errors
/// I/O.
pub fn run(args: &CompletionsArgs) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut grammar(), "cplan", &mut script);
    let script = String::from_utf8_lossy(&script);
    // The generator would add a subcommand `help` of its own.
    let script = if args.shell == Shell::Fish { for_fish(&script, &grammar()) } else { script.into_owned() };
    sinks::print(&script)?;
    Ok(DONE)
}

/// Returns a corrected script for fish. The generated one has three defects. It mistakes the first file for a subcommand, so it
/// does not complete options after the files of `cplan URDF WORLD`. It completes nothing after an option without its value, or
/// after `help`, because it lacks the subcommands of `help`. And it lacks the values of positional arguments.
fn for_fish(script: &str, grammar: &Command) -> String {
    let rules = script.find("complete -c").map_or("", |at| &script[at..]);
    let is_known = |line: &&str| !line.contains("__fish_cplan_using_subcommand help");
    let rules: String = rules.split_inclusive('\n').filter(is_known).collect();
    let of_main_job = |rules: String, option: &str| {
        let generated = format!("\"__fish_cplan_needs_command\" {option}");
        rules.replace(&generated, &format!("\"not __fish_cplan_using_subcommand $__fish_cplan_commands\" {option}"))
    };
    let rules = ["-s ", "-l "].into_iter().fold(rules, of_main_job);
    let names: Vec<&str> = grammar.get_subcommands().map(Command::get_name).chain(["help"]).collect();
    let values = grammar.get_subcommands().flat_map(|command| {
        let values = command.get_positionals().flat_map(Arg::get_possible_values);
        values.map(|value| values_rule(command.get_name(), value.get_name()))
    });
    let topics = names.iter().map(|name| values_rule("help", name));
    let values: String = values.chain(topics).collect();
    format!("set -g __fish_cplan_commands {}\n\n{FISH_RULE}\n{rules}{values}", names.join(" "))
}

fn values_rule(command: &str, value: &str) -> String {
    format!("complete -c cplan -n \"__fish_cplan_using_subcommand {command}\" -f -a \"{value}\"\n")
}

/// Rule for fish: the first word is the subcommand, if there is one.
const FISH_RULE: &str = "\
function __fish_cplan_needs_command
    test (count (commandline -opc)) -eq 1
end

function __fish_cplan_using_subcommand
    set -l words (commandline -opc)
    contains -- \"$words[2]\" $argv
end
";
