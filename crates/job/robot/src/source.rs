//! Text files, and positions in them.

use super::error::{Diagnostic, InputError};
use cplan_text::nearest_word;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A position in a text file. Lines and columns count from 1, and columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The number of the line.
    pub line: usize,
    /// The number of the character in its line.
    pub column: usize,
}

/// The text of an input, from a file or made by the program. It is serialised as its text and its name; deserialising it does not
/// read the file again.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Source {
    /// Path of the file, or name of a text in memory.
    path: PathBuf,
    text: String,
    /// True if the text is a file's. Only then can it refer to other files relative to it.
    is_file: bool,
    /// The files from which the text was made, to which reported positions refer.
    #[serde(skip)]
    origins: Option<Arc<dyn Origins>>,
    /// Position of every [`LINE_INDEX_INTERVAL`]th byte, computed on first use.
    #[serde(skip)]
    milestones: OnceLock<Vec<Position>>,
}

/// The files from which a text was made, and the origin of each part of the text.
pub trait Origins: Debug + Send + Sync {
    /// Returns the paths of all files.
    fn files(&self) -> Vec<PathBuf>;

    /// Returns the file from which the text at a byte offset comes, and the range in that file.
    fn place(&self, offset: usize) -> Option<(Source, Range<usize>)>;
}

/// Compares sources without the cached positions.
impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        (&self.path, &self.text, self.is_file) == (&other.path, &other.text, other.is_file)
    }
}

impl Eq for Source {}

/// Finds the positions of ascending byte offsets in one pass through the text.
#[derive(Debug)]
pub struct Cursor<'a> {
    bytes: &'a [u8],
    read: usize,
    at: Position,
}

impl Cursor<'_> {
    /// Returns line and column of a byte offset. An offset beyond the text counts as its end. If an offset is less than the
    /// previous one, the pass starts again.
    pub fn position(&mut self, offset: usize) -> Position {
        let offset = offset.min(self.bytes.len());
        if offset < self.read {
            (self.read, self.at) = (0, Position { line: 1, column: 1 });
        }
        for byte in &self.bytes[self.read..offset] {
            match byte {
                b'\n' => self.at = Position { line: self.at.line + 1, column: 1 },
                // Continuation bytes of a character do not count as columns.
                byte if byte & 0xc0 != 0x80 => self.at.column += 1,
                _ => {}
            }
        }
        self.read = offset;
        self.at
    }
}

/// Largest size of a file, in bytes. Real files, including meshes, are far smaller. The limit ends the reading of endless
/// devices.
const MAX_FILE_BYTES: u64 = 256 << 20;

/// Reads a file. In contrast to [`read_bytes`], returns the error of the operating system.
///
/// # Errors
/// I/O errors, and a file larger than 256 MiB.
pub fn read_bounded(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, MAX_FILE_BYTES)
}

fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let message = format!("it is larger than {} MiB", most >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// Largest size of a recording, in bytes. It suffices for hours of motion with a thousand samples per second in cplan's format.
/// In memory, the values need up to three times as much.
const MAX_RECORDING_BYTES: u64 = 2 << 30;

/// Positions are stored at intervals of this number of bytes.
const LINE_INDEX_INTERVAL: usize = 4096;

/// Reads a file.
///
/// # Errors
/// I/O errors, and a file larger than 256 MiB.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, InputError> {
    read_bounded(path).map_err(|error| unreadable(path, &error, "check that this is the right file").into())
}

/// Reads a recording, which may be larger than other files.
///
/// # Errors
/// I/O errors, and a recording larger than 2 GiB.
pub fn read_recorded(path: &Path) -> Result<Vec<u8>, InputError> {
    let help = "record fewer samples (cplan's --step SECONDS sets the time between them), or cut the recording into parts and verify \
                each with --anywhere";
    read_at_most(path, MAX_RECORDING_BYTES).map_err(|error| unreadable(path, &error, help).into())
}

fn unreadable(path: &Path, error: &io::Error, too_large: &str) -> Diagnostic {
    let unread = Diagnostic::new(path.display().to_string(), format!("cannot be read: {error}"));
    match (error.kind(), nearest_file(path)) {
        (io::ErrorKind::FileTooLarge, _) => unread.help(too_large),
        (io::ErrorKind::NotFound, Some(near)) => unread.help(format!("did you mean {}?", near.display())),
        _ => unread.help("check the path and the file's permissions"),
    }
}

/// Returns the file whose name is most similar to that of a missing file in the same folder.
pub fn nearest_file(missing: &Path) -> Option<PathBuf> {
    let folder = missing.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    // The order of files in a folder depends on the machine.
    names.sort();
    nearest_word(missing.file_name()?.to_str()?, names.iter().map(String::as_str))
        .map(|near| missing.with_file_name(near))
}

/// Number of characters on either side of the defect that an excerpt of a long line shows.
const EXCERPT_REACH: usize = 60;

impl Source {
    /// Creates a source from a text in memory. `name` appears in messages, and names a world that does not state its name. The
    /// text cannot refer to other files such as meshes and maps.
    pub fn in_memory(name: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self { path: name.into(), text: text.into(), is_file: false, origins: None, milestones: OnceLock::new() }
    }

    /// Returns the path of the file, or the name of a text in memory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the paths of the files with the text: its own, and those of a conversion. Empty for a text in memory.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.is_file.then(|| self.path.clone()).into_iter().collect();
        files.extend(self.origins.iter().flat_map(|origins| origins.files()).filter(|path| *path != self.path));
        files
    }

    /// Returns the whole text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the source with another text, such as an editor's unsaved changes. References in the text stay relative to the
    /// same file.
    #[must_use]
    pub fn with_text(&self, text: impl Into<String>) -> Self {
        Self { is_file: self.is_file, ..Self::in_memory(self.path.clone(), text) }
    }

    /// Returns the source with a text that was made from this one and from other files.
    #[must_use]
    pub fn converted(&self, text: impl Into<String>, origins: Arc<dyn Origins>) -> Self {
        Self { origins: Some(origins), ..self.with_text(text) }
    }

    /// Returns true if the text was made from others.
    pub fn is_converted(&self) -> bool {
        self.origins.is_some()
    }

    /// Returns the file and the range of bytes from which a byte of the text comes. `None` if the text was not made from others.
    fn origin(&self, offset: usize) -> Option<(Self, Range<usize>)> {
        self.origins.as_ref()?.place(offset)
    }

    /// Reads a file as UTF-8, without a byte order mark.
    ///
    /// # Errors
    /// A file that cannot be read, is larger than 256 MiB, or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::decoded(path, read_bytes(path)?)
    }

    /// Reads a recording as UTF-8.
    ///
    /// # Errors
    /// Same as for [`Source::read`], but up to 2 GiB.
    pub fn read_recording(path: &Path) -> Result<Self, InputError> {
        Self::decoded(path, read_recorded(path)?)
    }

    fn decoded(path: &Path, bytes: Vec<u8>) -> Result<Self, InputError> {
        let text = String::from_utf8(bytes).map_err(|error| {
            Diagnostic::new(
                path.display().to_string(),
                format!("is not UTF-8 text (byte {})", error.utf8_error().valid_up_to()),
            )
            .help("save it as UTF-8")
        })?;
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        Ok(Self { is_file: true, ..Self::in_memory(path, text) })
    }

    /// Returns the path of the file, to which the names of other files are relative.
    ///
    /// # Errors
    /// A text in memory, with the reason in words.
    pub fn anchor(&self) -> Result<&Path, &'static str> {
        if self.is_file {
            Ok(&self.path)
        } else {
            Err("files are named relative to the file that names them, but this text is not in a file")
        }
    }

    /// Returns the path for messages.
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Returns the file's name without extension.
    pub fn stem(&self) -> Option<String> {
        self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned())
    }

    /// Returns line and column of a byte offset, in the original file if the text was converted. `O(1)`, except the first call,
    /// which stores positions throughout the text.
    pub fn position(&self, offset: usize) -> Position {
        if let Some((file, range)) = self.origin(offset) {
            return file.position(range.start);
        }
        let offset = offset.min(self.text.len());
        let milestones = self.milestones.get_or_init(|| {
            let mut cursor = self.cursor();
            (0..=self.text.len()).step_by(LINE_INDEX_INTERVAL).map(|at| cursor.position(at)).collect()
        });
        let passed = offset / LINE_INDEX_INTERVAL;
        let mut cursor =
            Cursor { bytes: self.text.as_bytes(), read: passed * LINE_INDEX_INTERVAL, at: milestones[passed] };
        cursor.position(offset)
    }

    /// Returns a cursor at the beginning of the text, which finds the positions of many offsets efficiently.
    pub fn cursor(&self) -> Cursor<'_> {
        Cursor { bytes: self.text.as_bytes(), read: 0, at: Position { line: 1, column: 1 } }
    }

    /// Creates a diagnostic about the whole file.
    pub fn diagnostic(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.name(), message)
    }

    /// Creates a diagnostic at a range of bytes, with the source line and carets below it.
    pub fn diagnostic_at(&self, range: Range<usize>, message: impl Into<String>) -> Diagnostic {
        if let Some((file, range)) = self.origin(range.start) {
            return file.diagnostic_at(range, message);
        }
        let position = self.position(range.start);
        Diagnostic {
            position: Some(position),
            excerpt: Some(self.excerpt(position, range).into()),
            ..Diagnostic::new(self.name(), message)
        }
    }

    /// Creates a diagnostic at a parser's line and column, both from 1, or 0 if unknown.
    pub fn diagnostic_at_position(&self, line: usize, column: usize, message: impl Into<String>) -> Diagnostic {
        if line == 0 {
            return self.diagnostic(message);
        }
        let mut lines = self.text.split_inclusive('\n');
        let before: usize = lines.by_ref().take(line - 1).map(str::len).sum();
        let inside = lines.next().unwrap_or("");
        let at = inside.char_indices().nth(column.saturating_sub(1)).map_or(inside.trim_end().len(), |(i, _)| i);
        self.diagnostic_at(before + at..before + at + 1, message)
    }

    /// Returns the part of the line around a position, with carets below the range.
    fn excerpt(&self, position: Position, range: Range<usize>) -> String {
        let start = (0..=range.start.min(self.text.len())).rev().find(|&i| self.text.is_char_boundary(i)).unwrap_or(0);
        let (before, after) = self.text.split_at(start);
        let shown = |c: char| if c.is_control() { ' ' } else { c };
        let before: Vec<char> =
            before.chars().rev().take_while(|&c| c != '\n').take(EXCERPT_REACH).map(shown).collect();
        let room = 2 * EXCERPT_REACH - before.len();
        let after: String = after.chars().take_while(|&c| c != '\n').take(room).map(shown).collect();
        let length = self.text.get(range).map_or(1, |text| text.chars().take(room).count());
        let carets = "^".repeat(length.clamp(1, after.chars().count().max(1)));
        let number = position.line.to_string();
        let margin = " ".repeat(number.len());
        let gap = " ".repeat(before.len());
        let line: String = before.into_iter().rev().chain(after.chars()).collect();
        format!("  {number} | {}\n  {margin} | {gap}{carets}", line.trim_end())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        Source::in_memory("a.toml", text)
    }

    #[test]
    fn positions_count_characters_from_one() {
        let s = source("ab\nçd = 1\n");
        assert_eq!(s.position(0), Position { line: 1, column: 1 });
        assert_eq!(s.position(5), Position { line: 2, column: 2 });
        assert_eq!(s.position(999), Position { line: 3, column: 1 });
        let mut cursor = s.cursor();
        for offset in [0, 2, 5, 5, 999, 3] {
            assert_eq!(cursor.position(offset), s.position(offset));
        }
    }

    #[test]
    fn the_caret_is_below_the_place() {
        let s = source("first\n  radius = -1\n");
        let shown = s.diagnostic_at(17..19, "bad").to_string();
        assert_eq!(shown, "a.toml: line 2, column 12: bad\n  2 |   radius = -1\n    |            ^^");
    }

    #[test]
    fn carets_count_characters() {
        let shown = source("\"\u{e4}\" = 1\n").diagnostic_at(0..4, "bad").to_string();
        assert!(shown.ends_with("| ^^^"), "{shown}");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let s = source(&format!("{}X{}", "a".repeat(500), "b".repeat(500)));
        let shown = s.diagnostic_at(500..501, "bad").to_string();
        let lines: Vec<&str> = shown.lines().collect();
        assert!(lines[1].len() < 140);
        assert_eq!(lines[1].find('X'), lines[2].find('^'));
    }
}
