//! Numbers, angles, joint values and lengths as in world files: `0.5`, `"30deg"` or `"20 mm"`.

use super::error::Diagnostic;
use super::source::Source;
use super::toml_values::{FromToml, TomlError, TomlValue, number};
use crate::Spanned;
use cplan_text::metres;
use std::collections::BTreeMap;

/// A joint's value or an angle, in radians or metres. The file may state it in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Value in radians or metres.
    pub value: f64,
    /// True if the file states degrees. Such a value cannot be a length.
    pub in_degrees: bool,
}

/// A value with its position in the file.
pub type Written = Spanned<Quantity>;

/// A number with its position in the file.
pub type Number = Spanned<f64>;

/// Several numbers, with the position of the list and of each number.
pub type Numbers = Spanned<Vec<Number>>;

/// A length in metres. The file may state it with a unit, such as "20 mm".
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metres(pub f64);

/// A length with its position in the file.
pub type Length = Spanned<Metres>;

/// Several lengths, with the position of the list and of each length.
pub type Lengths = Spanned<Vec<Length>>;

/// Values by joint name. Names and values have their positions in the file.
pub type PerJoint<T> = BTreeMap<Spanned<String>, T>;

/// Returns a joint's entry in one of the world's tables.
pub(crate) fn find<'a, T>(table: &'a PerJoint<T>, name: &str) -> Option<&'a T> {
    table.iter().find(|(k, _)| k.get_ref() == name).map(|(_, v)| v)
}

/// Greatest length or coordinate, in metres. Above it, products of coordinates would lose the last micrometre. No arm is that
/// large.
pub const MAX_LENGTH: f64 = 1e6;

impl Quantity {
    /// Returns the angle that a text such as "30deg" states in degrees.
    pub fn degrees(text: &str) -> Option<Self> {
        let degrees: f64 = text.trim().strip_suffix("deg")?.trim_end().parse().ok()?;
        Some(Self { value: degrees.to_radians(), in_degrees: true })
    }
}

impl FromToml for Quantity {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let expected = "a number, or an angle such as \"30deg\"";
        match value.get_ref().as_str() {
            Some(text) => Self::degrees(text)
                .ok_or_else(|| TomlError::new(value, format!("expected {expected}, found \"{text}\""))),
            None => Ok(Self { value: number(value, expected)?, in_degrees: false }),
        }
    }
}

impl From<Metres> for f64 {
    fn from(length: Metres) -> Self {
        length.0
    }
}

impl FromToml for Metres {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        length(value, "a number, or a length such as \"20 mm\"").map(Self)
    }
}

/// Returns a length in metres: a number, or a text with a unit.
///
/// # Errors
/// Any other value. The message states what is `expected`.
pub fn length(value: &TomlValue, expected: &str) -> Result<f64, TomlError> {
    let Some(text) = value.get_ref().as_str() else { return number(value, expected) };
    let has_unit = text.trim_end().ends_with(|c: char| c.is_ascii_alphabetic()) && !text.trim_end().ends_with("px");
    let read = metres(text).ok().filter(|_| has_unit);
    read.ok_or_else(|| TomlError::new(value, format!("expected {expected}, found \"{text}\"")))
}

impl Source {
    /// Returns the value of a number or length of this file. `what` names it in the message.
    ///
    /// # Errors
    /// A value that is not finite or exceeds [`MAX_LENGTH`].
    pub fn finite<T: Copy + Into<f64>>(&self, number: &Spanned<T>, what: &str) -> Result<f64, Diagnostic> {
        let value: f64 = (*number.get_ref()).into();
        if !value.is_finite() {
            let diagnostic = self.diagnostic_at(number.span(), format!("{what}: {value} is not a finite number"));
            return Err(diagnostic.help("write a number"));
        }
        if value.abs() > MAX_LENGTH {
            let message = format!("{what}: {value} is too large (at most {MAX_LENGTH:e})");
            let help = format!(
                "lengths are in metres, angles in radians, from -{MAX_LENGTH:e} to {MAX_LENGTH:e}; choose an origin near the arm"
            );
            return Err(self.diagnostic_at(number.span(), message).help(help));
        }
        Ok(value)
    }
}
