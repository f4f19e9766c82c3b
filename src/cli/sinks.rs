//! Output streams.

use super::failure::Failure;
use super::terminal;
use crate::text::{plain, plain_json};
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Warns on stderr that a file is not written, because the result lacks `content` (a trajectory or a grid).
pub fn warn_unwritten(path: &Path, content: &str) {
    let is_old = if path.exists() { "; the existing file of this name is from an earlier run" } else { "" };
    print_status(&format!("warning: {} is not written: the result has no {content}{is_old}", path.display()));
}

/// Prints progress, warnings or errors on stderr. Ignores a closed stream.
pub fn print_status(text: &str) {
    let _ = writeln!(anstream::stderr(), "{}", terminal::message(&plain(text)));
}

/// Prints text on stdout. Control characters become visible characters, so that they do not affect the terminal.
///
/// # Errors
/// I/O.
pub fn report(text: &str) -> Result<(), Failure> {
    print(&plain(text))
}

/// Prints text with styles on stdout. Names in the text must not contain control characters. Outputs without colours
/// get plain text.
///
/// # Errors
/// I/O.
pub fn print_styled(text: &str) -> Result<(), Failure> {
    printed(anstream::stdout().lock(), text)
}

/// Prints a summary on stdout. The exit code determines the colour of its verdict. Lines are at most as wide as the
/// terminal.
///
/// # Errors
/// I/O.
pub fn sum_up(text: &str, code: u8) -> Result<(), Failure> {
    printed(anstream::stdout().lock(), &terminal::summary(&plain(text), code))
}

/// Returns indented JSON that ends in a newline.
///
/// # Errors
/// A value that JSON cannot represent.
pub fn pretty(value: &impl Serialize) -> Result<String, Failure> {
    let json = serde_json::to_string_pretty(value).map_err(|error| Failure::Refused(error.to_string()))?;
    Ok(json + "\n")
}

/// Prints JSON on stdout. Control characters in names are escaped.
///
/// # Errors
/// I/O.
pub fn print_json(json: &str) -> Result<(), Failure> {
    print(&plain_json(json))
}

/// Prints on stdout. A reader that closes the stream early (`cplan ... | head`) causes no error.
///
/// # Errors
/// I/O.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(std::io::stdout().lock(), text)
}

fn printed(mut stdout: impl Write, text: &str) -> Result<(), Failure> {
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Io(format!("stdout: {error}"))),
        _ => Ok(()),
    }
}
