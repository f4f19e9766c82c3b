//! Files with the results of a comparison.

use crate::cli::failure::Failure;
use crate::cli::sinks::outputs;
use std::path::PathBuf;

/// A format of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// Tables in Markdown.
    Markdown,
    /// One line per run.
    Csv,
    /// All data.
    Json,
    /// A page with charts and paths.
    Html,
    /// A benchmark log for OMPL's Planner Arena.
    Arena,
}

/// Returns each file name with the format that its extension states. Names are checked before any work is done.
///
/// # Errors
/// Unknown extensions, and files that cannot be written.
pub fn report_sinks(paths: &[PathBuf]) -> Result<Vec<(PathBuf, ReportFormat)>, Failure> {
    let ends = [
        ("md", ReportFormat::Markdown),
        ("csv", ReportFormat::Csv),
        ("json", ReportFormat::Json),
        ("html", ReportFormat::Html),
        ("log", ReportFormat::Arena),
    ];
    outputs(paths, &ends, "a comparison's name must end in .md, .csv, .json, .html or .log")
}
