//! Files to write: results and pictures.

use super::failure::Failure;
use crate::input::FileIdentity;
use crate::motion::{check_writable, write_whole_set};
use crate::output::PictureFormat;
use crate::view::View;
use std::cell::OnceCell;
use std::path::{Path, PathBuf};

/// The files that a command writes. Their names are checked before any computation.
pub struct Outputs<T = ()> {
    /// The results, with the contents that their names determine.
    pub results: Vec<(PathBuf, T)>,
    /// The pictures and pages.
    pub pictures: Vec<(PathBuf, PictureFormat)>,
    /// Other files, such as a certificate.
    others: Vec<PathBuf>,
}

/// Files with their bytes.
pub type FileBytes = Vec<(PathBuf, Vec<u8>)>;

impl<T: Copy> Outputs<T> {
    /// Checks the names of files. `content` returns the content of a result by its name.
    ///
    /// # Errors
    /// The errors of `content`, extensions of pictures that are unknown or that this program does not support, outputs
    /// that are the same file, and files that cannot be written.
    pub fn new(
        results: &[PathBuf],
        content: impl Fn(&Path) -> Result<T, Failure>,
        pictures: &[PathBuf],
        others: impl IntoIterator<Item = PathBuf>,
    ) -> Result<Self, Failure> {
        let results = results.iter().map(|path| Ok((path.clone(), content(path)?)));
        let results = results.collect::<Result<Vec<_>, Failure>>()?;
        let pictures = pictures.iter().map(|path| Ok((path.clone(), PictureFormat::from_path(path)?)));
        let pictures = pictures.collect::<Result<Vec<_>, Failure>>()?;
        let outputs = Self { results, pictures, others: others.into_iter().collect() };
        outputs.paths().try_for_each(check_writable)?;
        distinct(outputs.paths())?;
        Ok(outputs)
    }

    /// Returns the outputs if no picture is an animation. `what` is the subject of the pictures.
    ///
    /// # Errors
    /// An animated picture.
    pub fn without_animation(self, what: &str) -> Result<Self, Failure> {
        let is_gif = |(_, format): &&(PathBuf, PictureFormat)| format.is_animated() && *format != PictureFormat::Html;
        match self.pictures.iter().find(is_gif) {
            Some((path, _)) => {
                Err(Failure::Usage(format!("{}: a picture of {what} must be .svg, .png or .html", path.display())))
            }
            None => Ok(self),
        }
    }

    /// Returns the names of all files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let results = self.results.iter().map(|(path, _)| path.as_path());
        let pictures = self.pictures.iter().map(|(path, _)| path.as_path());
        self.others.iter().map(PathBuf::as_path).chain(results).chain(pictures)
    }

    /// Writes all files, or none if a problem can be foreseen. `others` are further files. `result` returns the bytes
    /// of a result, or `None` if there is none. `picture` returns those of a picture or a page.
    ///
    /// # Errors
    /// I/O, and the errors of `result` and `picture`.
    pub fn write(
        &self,
        others: FileBytes,
        result: impl Fn(&Path, T) -> Result<Option<Vec<u8>>, Failure>,
        picture: impl Fn(PictureFormat) -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        let mut files = others;
        for (path, content) in &self.results {
            files.extend(result(path, *content)?.map(|bytes| (path.clone(), bytes)));
        }
        for (path, format) in &self.pictures {
            files.push((path.clone(), picture(*format)?));
        }
        Ok(write_whole_set(&files)?)
    }

    /// Writes the results of a command that has no pictures.
    ///
    /// # Errors
    /// The errors of [`Outputs::write`].
    #[cfg(feature = "study")]
    pub fn write_results(&self, result: impl Fn(&Path, T) -> Result<Option<Vec<u8>>, Failure>) -> Result<(), Failure> {
        self.write(vec![], result, |_| Ok(vec![]))
    }
}

impl Outputs {
    /// Checks the names of pictures and other files.
    ///
    /// # Errors
    /// The errors of [`Outputs::new`].
    pub fn of_pictures(pictures: &[PathBuf], others: impl IntoIterator<Item = PathBuf>) -> Result<Self, Failure> {
        Self::new(&[], |_| Ok(()), pictures, others)
    }

    /// Writes all pictures, and other files.
    ///
    /// # Errors
    /// The errors of [`Outputs::write`].
    pub fn write_pictures(
        &self,
        others: FileBytes,
        picture: impl Fn(PictureFormat) -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        self.write(others, |_, ()| Ok(None), picture)
    }
}

/// Returns a function that determines the content of a file by its extension. `ends` has the known extensions, and
/// `expected` is the message that lists them.
pub fn by_extension<T: Copy>(ends: &[(&str, T)], expected: &str) -> impl Fn(&Path) -> Result<T, Failure> {
    move |path| {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let known = ends.iter().find(|(end, _)| *end == extension);
        known.map(|(_, content)| *content).ok_or_else(|| Failure::Usage(format!("{}: {expected}", path.display())))
    }
}

/// Returns a function that draws a view in a format. The view is made at the first call.
pub fn drawn(view: impl Fn() -> View) -> impl Fn(PictureFormat) -> Result<Vec<u8>, Failure> {
    let made = OnceCell::new();
    move |format| Ok(format.bytes(made.get_or_init(&view))?)
}

/// Checks that no two outputs are the same file, also with different spellings.
///
/// # Errors
/// Two outputs that are the same file. The message names both.
pub fn distinct<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut known: Vec<(&Path, FileIdentity)> = Vec::new();
    for path in outputs {
        let Some(identity) = FileIdentity::of(path) else { continue };
        if let Some((other, _)) = known.iter().find(|(_, other)| other.is_same_file(&identity)) {
            let (one, other) = (path.display(), other.display());
            let message = format!("nothing was written: the outputs {other} and {one} are the same file");
            return Err(Failure::Refused(format!("{message}\n  hint: give each output its own file")));
        }
        known.push((path, identity));
    }
    Ok(())
}

/// Checks that no output would overwrite a file that was read, also through links.
///
/// # Errors
/// An output that is an input. The message names both.
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
        let message = format!("nothing was written: the output {path} is the input file {input}");
        Err(Failure::Refused(format!("{message}\n  hint: choose another file for the output")))
    })
}
