//! Settings for reading a file.

use crate::Unit;

/// Settings for reading a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Greatest distance between a curve and its chords, and between ends that are joined, metres. At least
    /// [`MIN_TOLERANCE`].
    pub tolerance: f64,
    /// Unit of the file's numbers. `None` for the unit that the file states.
    pub unit: Option<Unit>,
    /// Additional factor by which everything is scaled about the drawing's origin. Positive.
    pub scale: f64,
}

impl Default for Settings {
    /// Returns settings with a tolerance of a tenth of a millimetre and the units that the file states.
    fn default() -> Self {
        Self { tolerance: 1e-4, unit: None, scale: 1.0 }
    }
}

/// Least tolerance, metres: a micrometre.
pub const MIN_TOLERANCE: f64 = 1e-6;
