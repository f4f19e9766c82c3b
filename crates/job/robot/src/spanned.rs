//! Values with their positions in a file.

use super::toml_values::{FromToml, TomlError, TomlValue};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A value with its position in a file. Comparison ignores the position.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Spanned<T>(toml::Spanned<T>);

impl<T> Spanned<T> {
    /// Creates a value with the range of bytes where it is written.
    pub fn new(range: Range<usize>, value: T) -> Self {
        Self(toml::Spanned::new(range, value))
    }

    /// Returns the range of bytes where the value is written.
    pub fn span(&self) -> Range<usize> {
        self.0.span()
    }

    /// Returns the value.
    pub fn get_ref(&self) -> &T {
        self.0.get_ref()
    }

    /// Returns the value without its position.
    pub fn into_inner(self) -> T {
        self.0.into_inner()
    }
}

impl<T: FromToml> FromToml for Spanned<T> {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        Ok(Self::new(value.span(), T::read(value)?))
    }
}
