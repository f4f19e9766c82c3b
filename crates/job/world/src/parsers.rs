//! Diagnostics of the parsers of JSON and YAML, with positions in the file.

use cplan_robot::{Diagnostic, Source};
use serde_saphyr::{MessageFormatter, UserMessageFormatter};

/// Returns the diagnostic of a JSON error, with its position, which is removed from the end of the parser's message.
pub(crate) fn json_diagnostic(source: &Source, error: &serde_json::Error) -> Diagnostic {
    let message = error.to_string();
    let message = message.lines().next().unwrap_or_default();
    let message = message.split(" at line ").next().unwrap_or(message);
    source.diagnostic_at_position(error.line(), error.column(), message)
}

/// Returns the diagnostic of a YAML error, with its position. Removes the parser's advice for programmers.
pub(crate) fn yaml_diagnostic(source: &Source, error: &serde_saphyr::Error) -> Diagnostic {
    let (line, column) = error.location().map_or((0, 0), |p| (p.line() as usize, p.column() as usize));
    source.diagnostic_at_position(line, column, UserMessageFormatter.format_message(error))
}
