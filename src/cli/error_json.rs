//! Errors for scripts: with `--json` they are JSON on stdout.

use super::failure::Failure;
use crate::input::{Diagnostic, DiagnosticKind};
use serde::Serialize;

/// An error as a JSON object. The fields from `file` to `help` are those of the first diagnostic. `diagnostics` has all of them.
#[derive(Debug, Serialize)]
pub struct ErrorJson {
    /// The status, which is always `error`. No result has this status.
    status: &'static str,
    /// The kind of error: `usage` for a wrong command line; `start` or `goal` if that is missing, out of range or not
    /// free; `input` for everything else.
    kind: &'static str,
    #[serde(flatten)]
    first: DiagnosticJson,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "defects")]
    diagnostics: Vec<DiagnosticJson>,
}

/// One defect of the input.
#[derive(Debug, Serialize)]
struct DiagnosticJson {
    /// The file with the defect. `None` for a defect of an option.
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
    #[serde(rename = "cure")]
    help: Option<String>,
}

impl DiagnosticJson {
    fn plain(message: String, help: Option<String>) -> Self {
        Self { file: None, line: None, column: None, message, help }
    }
}

impl From<&Diagnostic> for DiagnosticJson {
    fn from(diagnostic: &Diagnostic) -> Self {
        let is_option = diagnostic.origin.starts_with('-');
        Self {
            file: (!is_option).then(|| diagnostic.origin.clone()),
            line: diagnostic.position.map(|p| p.line),
            column: diagnostic.position.map(|p| p.column),
            message: if is_option {
                format!("{}: {}", diagnostic.origin, diagnostic.message)
            } else {
                diagnostic.message.clone()
            },
            help: diagnostic.help.clone(),
        }
    }
}

impl ErrorJson {
    /// Describes the failure that ended a command.
    pub fn of_failure(failure: &Failure) -> Self {
        let diagnostics = match failure {
            Failure::Input(error) | Failure::Blocked(error, _) => error.diagnostics(),
            _ => &[],
        };
        let kind = match (failure, diagnostics.first().map(|diagnostic| diagnostic.kind)) {
            (Failure::Usage(_), _) => "usage",
            (_, Some(DiagnosticKind::Start)) => "start",
            (_, Some(DiagnosticKind::Goal)) => "goal",
            _ => "input",
        };
        let first =
            diagnostics.first().map_or_else(|| DiagnosticJson::plain(failure.to_string(), None), DiagnosticJson::from);
        let diagnostics =
            if diagnostics.len() > 1 { diagnostics.iter().map(DiagnosticJson::from).collect() } else { Vec::new() };
        Self { status: "error", kind, first, diagnostics }
    }

    /// Describes a command line that cannot be parsed.
    pub fn of_usage(error: &clap::Error) -> Self {
        let text = error.to_string();
        let line_after =
            |mark: &str| text.lines().find_map(|line| Some(line.trim().strip_prefix(mark)?.trim().to_owned()));
        let message: Vec<&str> = text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim).collect();
        let message = message.join(" ").trim_start_matches("error:").trim().to_owned();
        let help = line_after("tip:").or_else(|| line_after("Usage:").map(|usage| format!("usage: {usage}")));
        Self { status: "error", kind: "usage", first: DiagnosticJson::plain(message, help), diagnostics: Vec::new() }
    }

    /// Returns the error as a JSON document that ends in a newline.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).map_or_else(|error| error.to_string(), |json| json + "\n")
    }
}
