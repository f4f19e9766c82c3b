//! Units of DXF files.

use crate::Unit;

const INCH: f64 = 0.0254;

/// Returns the unit for a value of DXF's `$INSUNITS`. `None` for the value 0 ("unitless") and for astronomical units.
pub(super) fn of_code(code: i64) -> Option<Unit> {
    let named = |name: &str| name.parse().ok();
    match code {
        1 => named("in"),
        2 => named("ft"),
        3 => Some(Unit::new("mi", 63360.0 * INCH)),
        4 => named("mm"),
        5 => named("cm"),
        6 => named("m"),
        7 => named("km"),
        8 => Some(Unit::new("microinch", INCH * 1e-6)),
        9 => named("mil"),
        10 => named("yd"),
        13 => named("um"),
        14 => named("dm"),
        21 => Some(Unit::new("US survey ft", 1200.0 / 3937.0)),
        _ => None,
    }
}
