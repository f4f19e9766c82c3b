//! Proofs of disconnection in result files.

use super::{Cell, CollisionBox, Disconnection};
use cplan_model::Pair;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A collision box in result files: all configurations from `lower` to `upper`, and two shapes that are too close in
/// all of them. Indices start from 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProofBox {
    /// Least value of each joint, radians or metres.
    pub lower: [f64; 2],
    /// Greatest value of each joint, radians or metres.
    pub upper: [f64; 2],
    /// Link of the part, as in [`Pair::link`]: 0 for link 1, 1 for link 2, and 2 for link 2 if joint 1 carries the
    /// obstacle.
    pub link: usize,
    /// Index of the convex part of the link.
    pub part: usize,
    /// Index of the obstacle. The obstacles of the world file come first.
    pub obstacle: usize,
    /// Index of the convex piece of the obstacle.
    pub piece: usize,
}

impl From<&CollisionBox> for ProofBox {
    fn from(CollisionBox { cell, pair }: &CollisionBox) -> Self {
        let Pair { link, part, obstacle, piece } = *pair;
        Self { lower: cell.lower, upper: cell.upper, link, part, obstacle, piece }
    }
}

impl From<ProofBox> for CollisionBox {
    fn from(claim: ProofBox) -> Self {
        let ProofBox { lower, upper, link, part, obstacle, piece } = claim;
        Self { cell: Cell { lower, upper }, pair: Pair { link, part, obstacle, piece } }
    }
}

/// The reason why no proof can be read from a text.
#[derive(Debug, Error)]
pub enum ProofFormatError {
    /// The text is not JSON, or does not have the fields of a proof.
    #[error("not a result with a proof: {0}")]
    Malformed(#[from] serde_json::Error),
    /// The result has no proof.
    #[error("the result holds no proof: its \"status\" is not \"infeasible\"")]
    Missing,
}

/// Reads the claim in a result file: the value of its key `proof`. [`Disconnection::checked`] decides whether it is true.
///
/// # Errors
/// [`ProofFormatError`] if the text is not a result with a proof.
pub fn read_proof(json: &str) -> Result<Disconnection, ProofFormatError> {
    #[derive(Deserialize)]
    struct Claim {
        proof: Option<Vec<ProofBox>>,
    }
    let claim: Claim = serde_json::from_str(json)?;
    let boxes = claim.proof.ok_or(ProofFormatError::Missing)?;
    Ok(Disconnection::new(boxes.into_iter().map(CollisionBox::from).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_proofs_are_read_back_exactly() {
        // Values whose shortest decimal form an inaccurate reader misreads by one unit in the last place.
        let values = [0.1 + 0.2, -2.9, 1.0 / 3.0, 5e-324, 123_456.789_012_345_67, -std::f64::consts::PI];
        for &lower in &values {
            let pair = Pair { link: 1, part: 0, obstacle: 3, piece: 2 };
            let stuck = CollisionBox { cell: Cell { lower: [lower, lower / 7.0], upper: [lower / 3.0, 2.5] }, pair };
            let text = serde_json::to_string(&[ProofBox::from(&stuck)]).unwrap();
            assert_eq!(
                read_proof(&format!(r#"{{"status": "infeasible", "proof": {text}}}"#)).unwrap().collision_boxes(),
                [stuck]
            );
        }
    }

    #[test]
    fn invalid_proofs_are_refused() {
        assert!(matches!(read_proof(r#"{"status": "found"}"#), Err(ProofFormatError::Missing)));
        for text in ["", "[]", r#"{"proof": 3}"#, r#"{"proof": [{"lower": [0, 1]}]}"#] {
            assert!(matches!(read_proof(text), Err(ProofFormatError::Malformed(_))), "{text}");
        }
    }
}
