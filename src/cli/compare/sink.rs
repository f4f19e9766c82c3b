//! Files with results of a comparison.

use crate::cli::failure::Failure;
use crate::motion::check_writable;
use std::path::{Path, PathBuf};

/// A format of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// Tables in Markdown.
    Markdown,
    /// A line a run.
    Csv,
    /// All there is.
    Json,
    /// A page with charts and paths.
    Html,
    /// A benchmark log for OMPL's Planner Arena.
    Arena,
}

/// A file to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportSink {
    /// What goes into it.
    pub format: ReportFormat,
    /// The path of the file.
    pub path: PathBuf,
}

/// What the file names ask for, checked before any work is done.
///
/// # Errors
/// Extensions that are none of ours, files named twice, files that cannot be written.
pub fn report_sinks(paths: &[PathBuf]) -> Result<Vec<ReportSink>, Failure> {
    let mut sinks: Vec<ReportSink> = Vec::new();
    for path in paths {
        if sinks.iter().any(|sink| sink.path == *path) {
            return Err(Failure::Usage(format!("{}: the same file is asked for twice", path.display())));
        }
        sinks.push(ReportSink { format: format(path)?, path: path.clone() });
    }
    sinks.iter().try_for_each(|sink| check_writable(&sink.path))?;
    Ok(sinks)
}

fn format(path: &Path) -> Result<ReportFormat, Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("md") => Ok(ReportFormat::Markdown),
        Some("csv") => Ok(ReportFormat::Csv),
        Some("json") => Ok(ReportFormat::Json),
        Some("html") => Ok(ReportFormat::Html),
        Some("log") => Ok(ReportFormat::Arena),
        _ => {
            let message = "a comparison's name must end in .md, .csv, .json, .html or .log";
            Err(Failure::Usage(format!("{}: {message}", path.display())))
        }
    }
}
