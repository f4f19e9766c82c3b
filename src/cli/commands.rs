//! Converts a list of subcommands to a grammar and a dispatch.

/// Defines `Command`, clap's enum of the subcommands, from lines `Name(file::Args)`, and `Command::run`, which calls
/// the file's `run`. A line `Name(file::Args, program)` is for a `run` that also takes the
/// [`Program`](super::program::Program).
macro_rules! commands {
    ($program:ident: $($(#[$cfg:meta])? $name:ident($file:ident::$args:ident $(, $context:ident)?),)+) => {
        /// Jobs with a word of their own.
        #[derive(Debug, clap::Subcommand)]
        enum Command {
            $($(#[$cfg])? $name($file::$args),)+
        }

        impl Command {
            /// Does the job, and returns the exit code.
            fn run(&mut self, $program: &Program) -> Result<u8, Failure> {
                match self {
                    $($(#[$cfg])? Self::$name(args) => $file::run(args $(, $context)?),)+
                }
            }
        }
    };
}

pub(super) use commands;
