//! Units of length.

use std::fmt;
use std::str::FromStr;

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    name: &'static str,
    metres: f64,
}

/// The error that a word is not the name of a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownUnit(String);

impl fmt::Display for UnknownUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = NAMED_UNITS.map(|unit| unit.name).join(", ");
        write!(f, "\"{}\" is not a known unit; the units are {names}", self.0)
    }
}

impl std::error::Error for UnknownUnit {}

/// All units that a user can name.
const NAMED_UNITS: [Unit; 11] = [
    Unit::MILLIMETER,
    Unit::new("cm", 1e-2),
    Unit::new("dm", 1e-1),
    Unit::METER,
    Unit::new("km", 1e3),
    Unit::new("um", 1e-6),
    Unit::new("mil", INCH / 1000.0),
    Unit::new("in", INCH),
    Unit::new("ft", 12.0 * INCH),
    Unit::new("yd", 36.0 * INCH),
    Unit::PIXEL,
];

const INCH: f64 = 0.0254;

impl Unit {
    /// Creates a unit with a name and a length in metres. It cannot be parsed, unless it is one of the units that users can name.
    pub const fn new(name: &'static str, metres: f64) -> Self {
        Self { name, metres }
    }

    /// The millimetre.
    pub const MILLIMETER: Unit = Unit::new("mm", 1e-3);
    /// The metre.
    pub const METER: Unit = Unit::new("m", 1.0);
    /// The pixel of style sheets, 96 per inch.
    pub const PIXEL: Unit = Unit::new("px", INCH / 96.0);

    /// Returns the length of the unit in metres.
    pub fn metres(self) -> f64 {
        self.metres
    }
}

/// Reads a length such as `20mm`, `0.5 in` or `0.02`, in metres.
///
/// # Errors
/// The reason, without the text.
pub fn metres(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, unit) = text.split_at(text.trim_end_matches(|c: char| c.is_ascii_alphabetic()).len());
    let unit =
        if unit.is_empty() { Unit::METER } else { unit.parse().map_err(|error: UnknownUnit| error.to_string())? };
    let number: f64 =
        number.trim_end().parse().map_err(|_| "must be a number of metres, or a length such as 0.05mm")?;
    let per_metre = unit.metres().recip();
    // Dividing by a whole number rounds once, so `7mm` is exactly the number 0.007.
    Ok(if per_metre.fract() == 0.0 { number / per_metre } else { number * unit.metres() })
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl FromStr for Unit {
    type Err = UnknownUnit;

    fn from_str(text: &str) -> Result<Self, UnknownUnit> {
        NAMED_UNITS.into_iter().find(|unit| unit.name == text).ok_or_else(|| UnknownUnit(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_rounded_once() {
        for (text, expected) in [
            ("20mm", 0.02),
            ("7 mm", 0.007),
            ("12.3mm", 0.0123),
            (" -1e1 cm ", -0.1),
            ("50um", 0.000_05),
            ("2in", 0.0508),
            ("0.25", 0.25),
            ("3 km", 3000.0),
        ] {
            assert_eq!(metres(text), Ok(expected), "{text}");
        }
        for text in ["", "mm", "20 m m", "20 feet", "20deg", "1,5mm"] {
            assert!(metres(text).is_err(), "{text}");
        }
    }
}
