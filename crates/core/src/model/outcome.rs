//! The three answers.

use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// An answer: found, proven infeasible, or unknown, each with its own data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome<F, I, U = String> {
    /// Found and certified: the solution is in `F`.
    Found(F),
    /// Proven infeasible by `I`.
    Infeasible(I),
    /// Unknown: the reason is in `U`.
    Unknown(U),
}

impl<F, I, U> Outcome<F, I, U> {
    /// Returns the kind of the answer.
    #[must_use]
    pub fn status(&self) -> Status {
        match self {
            Outcome::Found(_) => Status::Found,
            Outcome::Infeasible(_) => Status::Infeasible,
            Outcome::Unknown(_) => Status::Unknown,
        }
    }

    /// Borrows the answer.
    #[must_use]
    pub fn as_ref(&self) -> Outcome<&F, &I, &U> {
        match self {
            Outcome::Found(found) => Outcome::Found(found),
            Outcome::Infeasible(proof) => Outcome::Infeasible(proof),
            Outcome::Unknown(why) => Outcome::Unknown(why),
        }
    }

    /// Returns the same answer with the found value converted by `with`.
    #[must_use]
    pub fn map<G>(self, with: impl FnOnce(F) -> G) -> Outcome<G, I, U> {
        match self {
            Outcome::Found(found) => Outcome::Found(with(found)),
            Outcome::Infeasible(proof) => Outcome::Infeasible(proof),
            Outcome::Unknown(why) => Outcome::Unknown(why),
        }
    }

    /// Returns the found value, if that is the answer.
    #[must_use]
    pub fn found(&self) -> Option<&F> {
        if let Outcome::Found(found) = self { Some(found) } else { None }
    }

    /// Returns the proof that there is no solution, if that is the answer.
    #[must_use]
    pub fn infeasible(&self) -> Option<&I> {
        if let Outcome::Infeasible(proof) = self { Some(proof) } else { None }
    }

    /// Returns the reason if the answer is unknown.
    #[must_use]
    pub fn unknown(&self) -> Option<&U> {
        if let Outcome::Unknown(why) = self { Some(why) } else { None }
    }
}

/// Which of the three answers it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// With a certified path.
    Found,
    /// With a proof that there is none.
    Infeasible,
    /// With neither.
    Unknown,
}

impl Status {
    /// All, in the order in which they are counted.
    pub const ALL: [Status; 3] = [Status::Found, Status::Infeasible, Status::Unknown];

    /// Returns the word for it in results, tables and files.
    #[must_use]
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
