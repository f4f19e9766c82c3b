//! The journal of a study: rows are saved while it runs, so that an interrupted study can continue.

use super::Study;
use super::row::Row;
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use thiserror::Error;

/// Longest time before appended rows are written to disk.
const MAX_WRITE_DELAY: Duration = Duration::from_millis(200);

/// The reason why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// The file has the rows of another study, or is not a journal.
    #[error("{} contains rows of another study, of other files, or of another version of cplan: remove the file, or begin again with --fresh", path.display())]
    Other {
        /// Path of the journal.
        path: PathBuf,
    },
    /// Another run is writing to the journal.
    #[error("{}: another process is running this study: wait until it ends, or choose another first --output", path.display())]
    Busy {
        /// Path of the journal.
        path: PathBuf,
    },
    /// The operating system reported an error.
    #[error("{}: {source}", path.display())]
    System {
        /// Path of the journal.
        path: PathBuf,
        /// The error.
        source: io::Error,
    },
}

/// The inputs on which the rows depend. They are the first line of a journal.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct JournalHeader {
    cplan: String,
    study: String,
    world: String,
    urdf: String,
}

/// The journal of a study: a file with one row per line, in order.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: BufWriter<File>,
    written: Instant,
}

impl Journal {
    /// Opens the journal of a study and reads its rows, which are those of the first layouts, without a gap. Drops an
    /// incomplete last line, as it remains if the program is killed while writing.
    ///
    /// With `fresh`, drops all rows, even if they belong to another study. A file that is not a journal is never changed.
    ///
    /// # Errors
    /// A journal of another study, a file that is not a journal, a journal in use by another run, and errors of the
    /// operating system.
    pub fn open(path: &Path, study: &Study, fresh: bool) -> Result<(Self, Vec<Row>), JournalError> {
        let system = |source| JournalError::System { path: path.to_owned(), source };
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(system)?;
        // If the system cannot lock files, two runs may use the same journal.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(JournalError::Busy { path: path.to_owned() });
        }
        let head = study.head();
        let mut reader = BufReader::new(&mut file);
        let (mut rows, mut line, mut length) = (Vec::new(), Vec::new(), 0);
        loop {
            line.clear();
            let read = reader.read_until(b'\n', &mut line).map_err(system)?;
            if line.last() != Some(&b'\n') {
                break;
            }
            if length == 0 {
                match serde_json::from_slice::<JournalHeader>(&line) {
                    Ok(found) if found == head && !fresh => {}
                    Ok(_) if fresh => break,
                    _ => return Err(JournalError::Other { path: path.to_owned() }),
                }
            } else {
                match serde_json::from_slice::<Row>(&line) {
                    Ok(row) if row.layout == rows.len() => rows.push(row),
                    _ => break,
                }
            }
            length += read as u64;
        }
        // A file without a complete line is a journal only if it is the beginning of this journal's first line.
        if length == 0
            && line.last() != Some(&b'\n')
            && !line.is_empty()
            && !head_text(&head).as_bytes().starts_with(&line)
        {
            return Err(JournalError::Other { path: path.to_owned() });
        }
        file.set_len(length).and_then(|()| file.seek(SeekFrom::Start(length))).map_err(system)?;
        let mut journal = Self { path: path.to_owned(), file: BufWriter::new(file), written: Instant::now() };
        if length == 0 {
            journal.file.write_all(head_text(&head).as_bytes()).and_then(|()| journal.file.flush()).map_err(system)?;
        }
        Ok((journal, rows))
    }

    /// Returns the path of the journal.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends the next row.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn add(&mut self, row: &Row) -> Result<(), JournalError> {
        let mut written = serde_json::to_writer(&mut self.file, row).map_err(io::Error::from);
        written = written.and_then(|()| self.file.write_all(b"\n"));
        if self.written.elapsed() >= MAX_WRITE_DELAY {
            written = written.and_then(|()| self.file.flush());
            self.written = Instant::now();
        }
        written.map_err(|source| JournalError::System { path: self.path.clone(), source })
    }

    /// Writes appended rows to disk.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn flush(&mut self) -> Result<(), JournalError> {
        self.file.flush().map_err(|source| JournalError::System { path: self.path.clone(), source })
    }

    /// Removes the journal. For use after the table is written.
    ///
    /// # Errors
    /// Errors of the operating system.
    pub fn remove(self) -> Result<(), JournalError> {
        std::fs::remove_file(&self.path).map_err(|source| JournalError::System { path: self.path.clone(), source })
    }
}

fn head_text(head: &JournalHeader) -> String {
    serde_json::to_string(head).unwrap_or_default() + "\n"
}

impl Study {
    fn head(&self) -> JournalHeader {
        let [world, urdf] = [&self.world, &self.urdf].map(|template| template.source().text().to_owned());
        JournalHeader { cplan: env!("CARGO_PKG_VERSION").into(), study: self.source.text().into(), world, urdf }
    }
}
