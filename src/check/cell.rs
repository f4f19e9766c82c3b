//! Boxes of configurations.

use crate::space::Configuration;

/// A closed rectangle of configurations in the fundamental domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Least value of each joint.
    pub lower: [f64; 2],
    /// Greatest value of each joint.
    pub upper: [f64; 2],
}

impl Cell {
    /// The configuration in the middle of the box.
    #[must_use]
    pub fn center(&self) -> Configuration {
        Configuration::new((self.lower[0] + self.upper[0]) / 2.0, (self.lower[1] + self.upper[1]) / 2.0)
    }
}
