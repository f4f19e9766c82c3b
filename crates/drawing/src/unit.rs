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
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is not a known unit; the units are {names}", names = NAMED_UNITS.map(|unit| unit.name).join(", "))]
pub struct UnknownUnit(String);

const fn unit(name: &'static str, metres: f64) -> Unit {
    Unit { name, metres }
}

/// All units that a user can name.
const NAMED_UNITS: [Unit; 11] = [
    Unit::MILLIMETER,
    unit("cm", 1e-2),
    unit("dm", 1e-1),
    Unit::METER,
    unit("km", 1e3),
    unit("um", 1e-6),
    unit("mil", INCH / 1000.0),
    unit("in", INCH),
    unit("ft", 12.0 * INCH),
    unit("yd", 36.0 * INCH),
    Unit::PIXEL,
];

const INCH: f64 = 0.0254;

impl Unit {
    /// The millimetre.
    pub const MILLIMETER: Unit = unit("mm", 1e-3);
    /// The metre.
    pub const METER: Unit = unit("m", 1.0);
    /// The pixel of style sheets, 96 per inch.
    pub const PIXEL: Unit = unit("px", INCH / 96.0);

    /// Returns the length of the unit in metres.
    #[must_use]
    pub fn metres(self) -> f64 {
        self.metres
    }

    /// Returns the unit for a value of DXF's `$INSUNITS`. Returns `None` for the value 0 ("unitless"), and for
    /// astronomical units.
    pub(crate) fn of_dxf(code: i64) -> Option<Unit> {
        let named = |name: &str| name.parse().ok();
        match code {
            1 => named("in"),
            2 => named("ft"),
            3 => Some(unit("mi", 63360.0 * INCH)),
            4 => named("mm"),
            5 => named("cm"),
            6 => named("m"),
            7 => named("km"),
            8 => Some(unit("microinch", INCH * 1e-6)),
            9 => named("mil"),
            10 => named("yd"),
            13 => named("um"),
            14 => named("dm"),
            21 => Some(unit("US survey ft", 1200.0 / 3937.0)),
            _ => None,
        }
    }
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
