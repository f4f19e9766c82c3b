//! Files and streams.

use super::failure::Failure;
use super::terminal;
use crate::draw::View;
use crate::input::{FileIdentity, read_from};
use crate::motion::{Format, check_writable, write_whole};
use crate::output::{CSpaceFormat, PictureFormat};
use crate::text::{plain, plain_json};
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
    /// A picture.
    Picture(PictureFormat, PathBuf),
    /// The evidence for the answer.
    Certificate(PathBuf),
}

impl Sink {
    /// The file.
    pub fn path(&self) -> &Path {
        match self {
            Sink::Result(_, path) | Sink::CSpace(_, path) | Sink::Picture(_, path) | Sink::Certificate(path) => path,
        }
    }
}

/// What the file names ask for, checked before any work is done.
///
/// # Errors
/// Extensions that are none of ours or not in this program, and files that cannot be written.
pub fn sinks(results: &[PathBuf], pictures: &[PathBuf]) -> Result<Vec<Sink>, Failure> {
    sinks_with(results, pictures, None)
}

/// The same with a certificate.
///
/// # Errors
/// As [`sinks`].
pub fn sinks_with(results: &[PathBuf], pictures: &[PathBuf], certificate: Option<&Path>) -> Result<Vec<Sink>, Failure> {
    let mut sinks: Vec<Sink> = certificate.map(|path| Sink::Certificate(path.to_owned())).into_iter().collect();
    for path in results {
        sinks.push(match CSpaceFormat::from_path(path) {
            Some(format) => Sink::CSpace(format, path.clone()),
            None => Sink::Result(Format::from_path(path)?, path.clone()),
        });
    }
    for path in pictures {
        sinks.push(Sink::Picture(PictureFormat::from_path(path)?, path.clone()));
    }
    sinks.iter().try_for_each(|sink| check_writable(sink.path()))?;
    distinct(sinks.iter().map(Sink::path))?;
    Ok(sinks)
}

/// What each file is to hold, by the end of its name; `told` says what ends there are. Checked before any work is done.
///
/// # Errors
/// Ends that are none of these, and files that cannot be written.
pub fn outputs<T: Copy>(paths: &[PathBuf], ends: &[(&str, T)], told: &str) -> Result<Vec<(PathBuf, T)>, Failure> {
    let of = |path: &PathBuf| {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let known = ends.iter().find(|(end, _)| *end == extension);
        known
            .map(|(_, content)| (path.clone(), *content))
            .ok_or_else(|| Failure::Usage(format!("{}: {told}", path.display())))
    };
    let outputs = paths.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    outputs.iter().try_for_each(|(path, _)| check_writable(path))?;
    Ok(outputs)
}

/// Whether a file is a result in JSON that is written anyway: then a certificate has a place in it.
#[must_use]
pub fn is_json_among(path: &Path, results: &[PathBuf]) -> bool {
    let is_json = CSpaceFormat::from_path(path).is_none() && matches!(Format::from_path(path), Ok(Format::Json));
    is_json && results.iter().any(|result| result == path)
}

/// Refuses to write two outputs onto one file, however they are spelt.
///
/// # Errors
/// When two are one; both are named.
pub fn distinct<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut known: Vec<(&Path, FileIdentity)> = Vec::new();
    for path in outputs {
        let Some(identity) = FileIdentity::of(path) else { continue };
        if let Some((other, _)) = known.iter().find(|(_, other)| other.is(&identity)) {
            let (one, other) = (path.display(), other.display());
            let message = format!("the outputs {other} and {one} are one file; nothing was written");
            return Err(Failure::Option(format!("{message}\n  cure: give each a file of its own")));
        }
        known.push((path, identity));
    }
    Ok(())
}

/// Refuses to overwrite what has been read, also through links: to be asked when all inputs have been.
///
/// # Errors
/// When an output is an input; both are named.
pub fn spare_inputs<'a>(mut outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let onto = outputs.find_map(|path| Some((path, read_from(path)?)));
    onto.map_or(Ok(()), |(path, input)| {
        let (path, input) = (path.display(), input.display());
        let message = format!("the output {path} is the input {input}; nothing was written");
        Err(Failure::Option(format!("{message}\n  cure: give the output a file of its own")))
    })
}

/// Says on stderr that a format has no room for a result without its content: a trajectory, or a grid.
pub fn warn_unwritten(path: &Path, content: &str) {
    let is_old = if path.exists() { "; what it has is from before" } else { "" };
    say(&format!("warning: {} is not written: there is no {content} to put into it{is_old}", path.display()));
}

/// Writes a picture.
///
/// # Errors
/// I/O, or a picture that cannot be made of pixels.
pub fn save_picture(format: PictureFormat, path: &Path, view: &View) -> Result<(), Failure> {
    Ok(write_whole(path, &format.bytes(view)?)?)
}

/// Prints a line on stderr: progress, warnings and errors. Nobody may be listening there; that stops no job.
pub fn say(text: &str) {
    let _ = writeln!(anstream::stderr(), "{}", terminal::said(&plain(text)));
}

/// Prints for people on stdout: as [`print`], but what names hold that would act on a terminal is seen instead.
///
/// # Errors
/// I/O.
pub fn tell(text: &str) -> Result<(), Failure> {
    print(&plain(text))
}

/// The same of a summary, whose verdict has the colour of the exit code, and whose lines are as wide as the terminal at the most.
///
/// # Errors
/// I/O.
pub fn sum_up(text: &str, code: u8) -> Result<(), Failure> {
    printed(anstream::stdout().lock(), &terminal::summary(&plain(text), code))
}

/// JSON that people read, too, with a line feed at its end.
///
/// # Errors
/// What has no form in JSON.
pub fn pretty(value: &impl Serialize) -> Result<String, Failure> {
    let json = serde_json::to_string_pretty(value).map_err(|error| Failure::Option(error.to_string()))?;
    Ok(json + "\n")
}

/// Prints JSON on stdout, in which names do nothing to a terminal, either.
///
/// # Errors
/// I/O.
pub fn print_json(json: &str) -> Result<(), Failure> {
    print(&plain_json(json))
}

/// Prints on stdout. A reader that has seen enough (`cplan ... | head`) is no error.
///
/// # Errors
/// I/O.
pub fn print(text: &str) -> Result<(), Failure> {
    printed(std::io::stdout().lock(), text)
}

fn printed(mut stdout: impl Write, text: &str) -> Result<(), Failure> {
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Option(format!("stdout: {error}"))),
        _ => Ok(()),
    }
}
