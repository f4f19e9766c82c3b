//! Answers: their kind, one byte, and their content.

use cplan_calls::Refusal;
use serde::Serialize;
use serde_json::json;

/// The answer to a request.
pub enum Answer {
    /// A value as JSON.
    Json(Vec<u8>),
    /// The bytes of a text or of a file.
    Bytes(Vec<u8>),
}

impl Answer {
    /// Creates an answer with a value.
    ///
    /// # Errors
    /// A value that JSON does not have.
    pub fn json(value: &impl Serialize) -> Result<Self, Refusal> {
        serde_json::to_vec(value).map(Self::Json).map_err(Refusal::value)
    }

    /// Creates an answer with a text.
    pub fn text(text: String) -> Result<Self, Refusal> {
        Ok(Self::Bytes(text.into_bytes()))
    }
}

/// Returns the bytes of an answer or of a refusal.
pub fn encoded(answer: Result<Answer, Refusal>) -> Vec<u8> {
    let (kind, content) = match answer {
        Ok(Answer::Json(json)) => (b'j', json),
        Ok(Answer::Bytes(bytes)) => (b'b', bytes),
        Err(refusal) => (b'e', described(&refusal).to_string().into_bytes()),
    };
    [vec![kind], content].concat()
}

fn described(refusal: &Refusal) -> serde_json::Value {
    let kind = match refusal {
        Refusal::Input(_) => "input",
        Refusal::Value(_) => "value",
        Refusal::System(_) => "system",
    };
    let diagnostics = if let Refusal::Input(error) = refusal { error.diagnostics() } else { &[] };
    let diagnostics = diagnostics.iter().map(|diagnostic| {
        let (line, column) = diagnostic.position.map(|at| (at.line, at.column)).unzip();
        json!({
            "file": diagnostic.origin, "line": line, "column": column,
            "message": diagnostic.message, "help": diagnostic.help,
        })
    });
    json!({ "kind": kind, "message": refusal.to_string(), "diagnostics": diagnostics.collect::<Vec<_>>() })
}
