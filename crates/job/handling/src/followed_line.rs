//! A line that the tip follows.

use super::WristGuide;
use cplan_model::Elbow;
use cplan_toolpath::{Curve, Piece, Point, Toolpath};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A line that the tip follows, with the required accuracy and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FollowedLine {
    /// The line, placed in the plane.
    pub path: Arc<Toolpath>,
    /// Greatest distance between the tip's path and the line, metres.
    pub tolerance: f64,
    /// Greatest speed of the tip, metres per second. It replaces the speeds of the line's pieces.
    pub speed: Option<f64>,
    /// The angle of the tool along the line; `None` if it does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wrist: Option<WristGuide>,
    /// Side of the elbow along the line; `None` for either side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elbow: Option<Elbow>,
}

/// Tolerance of lines that state none, metres: a hundredth of a millimetre.
pub const DEFAULT_TOLERANCE: f64 = 1e-5;

/// Least tolerance of a line, metres: a micrometre. The accuracy of robots is far below it.
pub const MIN_TOLERANCE: f64 = 1e-6;

impl From<Toolpath> for FollowedLine {
    /// Returns the line with the default tolerance and the speeds of its pieces.
    fn from(path: Toolpath) -> Self {
        Self { path: Arc::new(path), tolerance: DEFAULT_TOLERANCE, speed: None, wrist: None, elbow: None }
    }
}

/// Number of chords of a curved piece, whose total length is a lower bound on the length of the piece.
const CHORDS: u32 = 16;

impl FollowedLine {
    /// Returns true if the tolerance is finite and at least [`MIN_TOLERANCE`], the speed is finite and positive, and the required
    /// angle of the tool is valid.
    pub fn is_valid(&self) -> bool {
        let is_positive = |speed: f64| speed.is_finite() && speed > 0.0;
        self.tolerance.is_finite()
            && self.tolerance >= MIN_TOLERANCE
            && self.speed.is_none_or(is_positive)
            && self.wrist.is_none_or(|wrist| wrist.is_valid())
    }

    /// Returns a lower bound, seconds, on the duration of a motion along the line, from the speeds of the tip alone.
    pub fn least_seconds(&self) -> f64 {
        let seconds = |piece: &Piece| {
            let speed = self.speed.or(piece.speed).filter(|_| !piece.is_travel)?;
            Some(self.least_length(&piece.curve) / speed)
        };
        self.path.pieces().iter().filter_map(seconds).sum()
    }

    /// Returns a lower bound on the length of paths that follow a curve within the tolerance, metres. The tip passes near all
    /// points of the curve in order, at most the tolerance away from each.
    fn least_length(&self, curve: &Curve) -> f64 {
        let chord = |[from, to]: [Point; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
        let by_parts = |count: u32| {
            let at = |k: u32| curve.at(f64::from(k) / f64::from(count));
            (0..count).map(|k| (chord([at(k), at(k + 1)]) - 2.0 * self.tolerance).max(0.0)).sum::<f64>()
        };
        by_parts(1).max(by_parts(CHORDS))
    }
}
