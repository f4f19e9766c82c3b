//! Output files and streams.

use super::failure::Failure;
use super::terminal;
use crate::input::FileIdentity;
use crate::motion::{Format, FormatError, check_writable, write_whole};
use crate::output::{CSpaceFormat, PictureFormat};
use crate::text::{plain, plain_json};
use crate::view::View;
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A file to write.
#[derive(Debug, Clone, PartialEq)]
pub enum Sink {
    /// The result.
    Result(Format, PathBuf),
    /// The configuration space as data.
    CSpace(CSpaceFormat, PathBuf),
    /// A program for a controller.
    Program(PathBuf),
    /// A picture.
    Picture(PictureFormat, PathBuf),
    /// The evidence for the answer.
    Certificate(PathBuf),
}

impl Sink {
    /// Returns the file.
    pub fn path(&self) -> &Path {
        match self {
            Sink::Result(_, path) | Sink::CSpace(_, path) | Sink::Picture(_, path) => path,
            Sink::Program(path) | Sink::Certificate(path) => path,
        }
    }
}

/// Returns the outputs for these file names, which are checked before any work is done.
///
/// # Errors
/// Extensions that are unknown or that this program does not support, and files that cannot be written.
pub fn sinks(results: &[PathBuf], pictures: &[PathBuf]) -> Result<Vec<Sink>, Failure> {
    sinks_with(results, pictures, None, |error, _| Err(error.into()))
}

/// Returns the outputs for these file names, and for a certificate. `other` returns the output for a result whose extension
/// is of no known format.
///
/// # Errors
/// The errors of [`sinks`] and of `other`.
pub fn sinks_with(
    results: &[PathBuf],
    pictures: &[PathBuf],
    certificate: Option<&Path>,
    other: impl Fn(FormatError, &Path) -> Result<Sink, Failure>,
) -> Result<Vec<Sink>, Failure> {
    let mut sinks: Vec<Sink> = certificate.map(|path| Sink::Certificate(path.to_owned())).into_iter().collect();
    for path in results {
        sinks.push(match CSpaceFormat::from_path(path) {
            Some(format) => Sink::CSpace(format, path.clone()),
            None => match Format::from_path(path) {
                Ok(format) => Sink::Result(format, path.clone()),
                Err(error) => other(error, path)?,
            },
        });
    }
    for path in pictures {
        sinks.push(Sink::Picture(PictureFormat::from_path(path)?, path.clone()));
    }
    sinks.iter().try_for_each(|sink| check_writable(sink.path()))?;
    distinct(sinks.iter().map(Sink::path))?;
    Ok(sinks)
}

/// Returns each file with its content, which its extension determines. Names are checked before any work is done.
/// `ends` has the known extensions with their contents, and `expected` is the message that lists the extensions.
///
/// # Errors
/// Unknown extensions, and files that cannot be written.
pub fn outputs<T: Copy>(paths: &[PathBuf], ends: &[(&str, T)], expected: &str) -> Result<Vec<(PathBuf, T)>, Failure> {
    let of = |path: &PathBuf| {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let known = ends.iter().find(|(end, _)| *end == extension);
        known
            .map(|(_, content)| (path.clone(), *content))
            .ok_or_else(|| Failure::Usage(format!("{}: {expected}", path.display())))
    };
    let outputs = paths.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    outputs.iter().try_for_each(|(path, _)| check_writable(path))?;
    Ok(outputs)
}

/// Returns true if the file is also a JSON result. The result then contains the certificate.
pub fn is_json_among(path: &Path, results: &[PathBuf]) -> bool {
    let is_json = CSpaceFormat::from_path(path).is_none() && matches!(Format::from_path(path), Ok(Format::Json));
    is_json && results.iter().any(|result| result == path)
}

/// Checks that no two outputs are the same file, even with different spellings.
///
/// # Errors
/// Two outputs that are the same file; the message names both.
pub fn distinct<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut known: Vec<(&Path, FileIdentity)> = Vec::new();
    for path in outputs {
        let Some(identity) = FileIdentity::of(path) else { continue };
        if let Some((other, _)) = known.iter().find(|(_, other)| other.is_same_file(&identity)) {
            let (one, other) = (path.display(), other.display());
            let message = format!("the outputs {other} and {one} are the same file; nothing was written");
            return Err(Failure::Refused(format!("{message}\n  hint: give each output its own file")));
        }
        known.push((path, identity));
    }
    Ok(())
}

/// Checks that no output would overwrite a file that was read, even through links.
///
/// # Errors
/// An output that is an input; the message names both.
pub fn refuse_to_overwrite_inputs<'a>(
    mut outputs: impl Iterator<Item = &'a Path>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().filter_map(|path| Some((path, FileIdentity::of(path)?))).collect();
    let onto = outputs.find_map(|path| {
        let output = FileIdentity::of(path)?;
        Some((path, inputs.iter().find(|(_, input)| input.is_same_file(&output))?.0))
    });
    onto.map_or(Ok(()), |(path, input)| {
        let (path, input) = (path.display(), input.display());
        let message = format!("the output {path} is the input file {input}; nothing was written");
        Err(Failure::Refused(format!("{message}\n  hint: choose another file for the output")))
    })
}

/// Warns on stderr that a file is not written, because the result lacks `content` (a trajectory or a grid).
pub fn warn_unwritten(path: &Path, content: &str) {
    let is_old = if path.exists() { "; the existing file is from an earlier run" } else { "" };
    print_status(&format!("warning: {} is not written: the result has no {content}{is_old}", path.display()));
}

/// Writes a picture.
///
/// # Errors
/// I/O, or a picture that cannot be rendered.
pub fn save_picture(format: PictureFormat, path: &Path, view: &View) -> Result<(), Failure> {
    Ok(write_whole(path, &format.bytes(view)?)?)
}

/// Prints progress, warnings or errors on stderr. Ignores a closed stream.
pub fn print_status(text: &str) {
    let _ = writeln!(anstream::stderr(), "{}", terminal::message(&plain(text)));
}

/// Prints text on stdout. Control characters in the text are shown as visible characters, so that they do not affect
/// the terminal.
///
/// # Errors
/// I/O.
pub fn report(text: &str) -> Result<(), Failure> {
    print(&plain(text))
}

/// Prints text with styles on stdout. Names in the text must have no control characters. Outputs without colours get the
/// text alone.
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

/// Prints on stdout. If the reader closes the stream early (`cplan ... | head`), that is no error.
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
