//! How a file is read.

use crate::Unit;

/// How a file is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance of a curve from its chords, and of ends that meet, metres; at least [`FINEST`].
    pub tolerance: f64,
    /// The unit of the file's numbers; by default what the file says.
    pub unit: Option<Unit>,
    /// What everything is scaled by besides, about the drawing's origin; above 0.
    pub scale: f64,
}

impl Default for Settings {
    /// A tenth of a millimetre, and what the file says.
    fn default() -> Self {
        Self { tolerance: 1e-4, unit: None, scale: 1.0 }
    }
}

/// Tolerances are not finer than this, metres: a micrometre.
pub const FINEST: f64 = 1e-6;
