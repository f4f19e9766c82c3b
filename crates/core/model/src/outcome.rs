//! The answers of cplan: found, infeasible, or unknown.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// An answer, with the data that belong to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome<F, I, U = String> {
    /// A certified solution.
    Found(F),
    /// A proof that there is no solution.
    Infeasible(I),
    /// The reason why neither was found.
    Unknown(U),
}

impl<F, I, U> Outcome<F, I, U> {
    /// Returns the answer without its data.
    pub fn status(&self) -> Status {
        match self {
            Outcome::Found(_) => Status::Found,
            Outcome::Infeasible(_) => Status::Infeasible,
            Outcome::Unknown(_) => Status::Unknown,
        }
    }

    /// Returns the answer with references to its data.
    pub fn as_ref(&self) -> Outcome<&F, &I, &U> {
        match self {
            Outcome::Found(found) => Outcome::Found(found),
            Outcome::Infeasible(proof) => Outcome::Infeasible(proof),
            Outcome::Unknown(why) => Outcome::Unknown(why),
        }
    }

    /// Returns the same answer with the found value converted by `with`.
    pub fn map<G>(self, with: impl FnOnce(F) -> G) -> Outcome<G, I, U> {
        match self {
            Outcome::Found(found) => Outcome::Found(with(found)),
            Outcome::Infeasible(proof) => Outcome::Infeasible(proof),
            Outcome::Unknown(why) => Outcome::Unknown(why),
        }
    }

    /// Returns the found value; `None` for other answers.
    pub fn found(&self) -> Option<&F> {
        if let Outcome::Found(found) = self { Some(found) } else { None }
    }

    /// Returns the proof that there is no solution; `None` for other answers.
    pub fn infeasible(&self) -> Option<&I> {
        if let Outcome::Infeasible(proof) = self { Some(proof) } else { None }
    }

    /// Returns the reason why the answer is unknown; `None` for other answers.
    pub fn unknown(&self) -> Option<&U> {
        if let Outcome::Unknown(why) = self { Some(why) } else { None }
    }
}

/// An answer without its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub enum Status {
    /// There is a certified path.
    Found,
    /// There is a proof that no path exists.
    Infeasible,
    /// There is neither a path nor a proof.
    Unknown,
}

impl Status {
    /// All answers, in the order of tables.
    pub const ALL: [Status; 3] = [Status::Found, Status::Infeasible, Status::Unknown];

    /// Returns the answer's name in results, tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Status::Found => "found",
            Status::Infeasible => "infeasible",
            Status::Unknown => "unknown",
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
