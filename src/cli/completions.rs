//! `cplan completions`: what a shell needs to complete commands, options and their values.

use super::args::Cli;
use super::failure::Failure;
use super::{DONE, sinks};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  cplan completions bash > ~/.local/share/bash-completion/completions/cplan
  cplan completions zsh > ~/.zfunc/_cplan
  cplan completions fish > ~/.config/fish/completions/cplan.fish
  cplan completions powershell >> $PROFILE
  cplan completions elvish >> ~/.config/elvish/rc.elv

For zsh the folder has to be in its path of functions: fpath+=~/.zfunc before compinit in ~/.zshrc. A new shell knows them.

Exit codes: 0 printed, 1 I/O, 2 wrong command line.")]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Prints the shell's script.
///
/// # Errors
/// I/O.
pub fn run(args: &CompletionsArgs) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "cplan", &mut script);
    sinks::print(&String::from_utf8_lossy(&script))?;
    Ok(DONE)
}
