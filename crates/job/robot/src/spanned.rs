//! Values with their positions in a file.

use super::toml_values::{FromToml, TomlError, TomlValue};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A value with its position in a file. Values are compared without their positions.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Spanned<T>(toml::Spanned<T>);

impl<T> Spanned<T> {
    /// Creates a value that is written at a range of bytes.
    pub fn new(range: Range<usize>, value: T) -> Self {
        Self(toml::Spanned::new(range, value))
    }

    /// Returns the range of bytes at which the value is written.
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
