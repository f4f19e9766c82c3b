//! Reasons why there is no program.

use cplan_robot::InputError;
use thiserror::Error;

/// Reason why a plan has no program.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProgramError {
    /// A defect of the template.
    #[error(transparent)]
    Template(#[from] InputError),
    /// Something in the plan that joint moves cannot do.
    #[error("no program can be written: {0}")]
    Unsuitable(String),
    /// A written target differs too much from the plan's.
    #[error(
        "the program as written is not certified: {0}\n  hint: let the template write more decimals, such as \
         {{{{ move.joints[0] | digits(6) }}}}"
    )]
    Rounded(String),
    /// A line between written targets is not proven free.
    #[error(
        "the program as written is not certified: {0}\n  hint: use a smaller --joint-tolerance, or more --clearance"
    )]
    NotCertified(String),
}
