//! Errors for scripts: with `--json` they are JSON on stdout, too.

use super::failure::Failure;
use crate::input::{Defect, DefectKind};
use serde::Serialize;

/// An error as an object. `file` to `cure` are those of the first defect; `defects` has all.
#[derive(Debug, Serialize)]
pub struct ErrorJson {
    /// Always `error`, so that scripts tell it from a result.
    status: &'static str,
    /// `usage` for a wrong command line, `start` or `goal` for one that is missing, out of range or not free, else `input`.
    kind: &'static str,
    #[serde(flatten)]
    first: DefectJson,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    defects: Vec<DefectJson>,
}

/// One thing that is wrong.
#[derive(Debug, Serialize)]
struct DefectJson {
    /// None if it is in an option.
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
    cure: Option<String>,
}

impl DefectJson {
    fn plain(message: String, cure: Option<String>) -> Self {
        Self { file: None, line: None, column: None, message, cure }
    }
}

impl From<&Defect> for DefectJson {
    fn from(defect: &Defect) -> Self {
        let is_option = defect.origin.starts_with('-');
        Self {
            file: (!is_option).then(|| defect.origin.clone()),
            line: defect.position.map(|p| p.line),
            column: defect.position.map(|p| p.column),
            message: if is_option { format!("{}: {}", defect.origin, defect.message) } else { defect.message.clone() },
            cure: defect.cure.clone(),
        }
    }
}

impl ErrorJson {
    /// What ended a job.
    pub fn of_failure(failure: &Failure) -> Self {
        let defects = match failure {
            Failure::Input(error) => error.defects(),
            _ => &[],
        };
        let kind = match (failure, defects.first().map(|defect| defect.kind)) {
            (Failure::Usage(_), _) => "usage",
            (_, Some(DefectKind::Start)) => "start",
            (_, Some(DefectKind::Goal)) => "goal",
            _ => "input",
        };
        let first = defects.first().map_or_else(|| DefectJson::plain(failure.to_string(), None), DefectJson::from);
        let defects = if defects.len() > 1 { defects.iter().map(DefectJson::from).collect() } else { Vec::new() };
        Self { status: "error", kind, first, defects }
    }

    /// A command line that cannot be read.
    pub fn of_usage(error: &clap::Error) -> Self {
        let text = error.to_string();
        let line_after =
            |mark: &str| text.lines().find_map(|line| Some(line.trim().strip_prefix(mark)?.trim().to_owned()));
        let message: Vec<&str> = text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim).collect();
        let message = message.join(" ").trim_start_matches("error:").trim().to_owned();
        let cure = line_after("tip:").or_else(|| line_after("Usage:").map(|usage| format!("usage: {usage}")));
        Self { status: "error", kind: "usage", first: DefectJson::plain(message, cure), defects: Vec::new() }
    }

    /// A JSON document and a line feed.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).map_or_else(|error| error.to_string(), |json| json + "\n")
    }
}
