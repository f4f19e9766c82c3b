//! Units in the names of columns: `elbow [deg]`, `lift (mm)`, `time [ms]`.

use super::columns::{Meaning, Quantity};

/// The dimension of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dimension {
    Angle,
    Length,
    Time,
}

/// A unit as a multiple of radians, metres or seconds. The factor is the quotient of two numbers, so that a conversion rounds
/// decimal factors only once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    pub dimension: Dimension,
    multiple: f64,
    divisor: f64,
}

/// Names of units, with the dimension and the two numbers of the factor.
const KNOWN_UNITS: [(&[&str], Dimension, f64, f64); 8] = [
    (&["rad", "radian", "radians"], Dimension::Angle, 1.0, 1.0),
    (&["deg", "degree", "degrees", "\u{b0}"], Dimension::Angle, std::f64::consts::PI, 180.0),
    (&["m", "metre", "metres", "meter", "meters"], Dimension::Length, 1.0, 1.0),
    (&["cm"], Dimension::Length, 1.0, 100.0),
    (&["mm"], Dimension::Length, 1.0, 1000.0),
    (&["s", "sec", "second", "seconds"], Dimension::Time, 1.0, 1.0),
    (&["ms"], Dimension::Time, 1.0, 1e3),
    (&["ns"], Dimension::Time, 1.0, 1e9),
];

/// The known units, as messages list them.
pub(super) const KNOWN_UNITS_TEXT: &str =
    "rad, deg, m, cm, mm, s, ms or ns, with /s for velocities and /s^2 for accelerations";

/// Splits a column's name from the unit in brackets after it.
pub(super) fn split(column: &str) -> Option<(&str, &str)> {
    let closed = [('[', ']'), ('(', ')')];
    closed.into_iter().find_map(|(open, close)| {
        let (name, unit) = column.trim_end().strip_suffix(close)?.rsplit_once(open)?;
        // A number in brackets is an index, not a unit.
        let is_index = unit.trim().bytes().all(|byte| byte.is_ascii_digit());
        (!is_index).then(|| (name.trim_end(), unit.trim()))
    })
}

/// Returns the unit that a column's name states. Velocities have units such as `deg/s`, accelerations `deg/s^2`.
pub(super) fn unit(name: &str, meaning: Meaning) -> Option<Unit> {
    let suffixes: &[&str] = match meaning {
        Meaning::Of(_, Quantity::Velocity) => &["/s"],
        Meaning::Of(_, Quantity::Acceleration) => &["/s^2", "/s2", "/s\u{b2}", "/s/s"],
        _ => &[""],
    };
    suffixes.iter().find_map(|suffix| {
        let base = name.strip_suffix(suffix)?;
        let (_, dimension, multiple, divisor) = KNOWN_UNITS.into_iter().find(|(names, ..)| names.contains(&base))?;
        Some(Unit { dimension, multiple, divisor })
    })
}

impl Unit {
    /// Returns false for radians, metres and seconds.
    pub fn is_converted(&self) -> bool {
        (self.multiple, self.divisor) != (1.0, 1.0)
    }

    /// Converts a value to radians, metres or seconds.
    pub fn convert(&self, value: f64) -> f64 {
        value * self.multiple / self.divisor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_column_names_in_brackets() {
        assert_eq!(split("elbow [deg]"), Some(("elbow", "deg")));
        assert_eq!(split("lift(mm) "), Some(("lift", "mm")));
        for column in ["elbow", "position[0]", "elbow]", "elbow []"] {
            assert_eq!(split(column), None, "{column}");
        }
    }

    #[test]
    fn values_are_converted_as_their_meaning_has_it() {
        let of = |quantity| Meaning::Of(0, quantity);
        let converted = |name, meaning, value| unit(name, meaning).map(|unit| unit.convert(value));
        assert_eq!(converted("deg", of(Quantity::Position), 180.0), Some(std::f64::consts::PI));
        assert_eq!(converted("mm/s", of(Quantity::Velocity), 3.0), Some(0.003));
        assert_eq!(converted("rad/s^2", of(Quantity::Acceleration), 2.0), Some(2.0));
        assert_eq!(converted("ms", Meaning::Time, 1.0), Some(0.001));
        assert_eq!(converted("deg", of(Quantity::Velocity), 1.0), None);
        assert_eq!(converted("turns", of(Quantity::Position), 1.0), None);
    }
}
