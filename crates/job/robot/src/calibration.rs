//! Errors of a robot and its world that a motion must allow for: `[robot] calibration`, an obstacle's `calibration`, and the
//! option `--calibration`.

use super::quantity::{MAX_LENGTH, Quantity};
#[cfg(feature = "schema")]
use super::schema::*;
use super::toml_values::{FromToml, TomlError, TomlValue, number};
use crate::toml_table;
use cplan_model::Calibration;
use cplan_text::metres;
use std::fmt;
use std::str::FromStr;

/// Greatest errors of a length and of an angle, as files state them: `"0.5 mm, 0.05deg"`, `"1 mm"`, or a number in metres.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorBound {
    /// Greatest error of a length, metres.
    pub length: f64,
    /// Greatest error of an angle, radians.
    pub angle: f64,
}

/// Greatest error of an angle: a quarter turn.
const MAX_ANGLE: f64 = std::f64::consts::FRAC_PI_2;

impl FromStr for ErrorBound {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let no_number = |number: &str| format!("\"{}\" is not a number", number.trim());
        let mut bound = [None; 2];
        for item in text.split(',').map(str::trim) {
            let (is_angle, value) = match (item.strip_suffix("deg"), item.strip_suffix("rad")) {
                (Some(number), _) => (true, Quantity::degrees(item).ok_or_else(|| no_number(number))?.value),
                (None, Some(number)) => (true, number.trim_end().parse().map_err(|_| no_number(number))?),
                (None, None) if item.ends_with(|c: char| c.is_ascii_alphabetic()) => (false, metres(item)?),
                (None, None) => return Err(format!("\"{item}\" has no unit: write 0.5 mm or 0.05deg")),
            };
            if bound[usize::from(is_angle)].replace(value).is_some() {
                let twice = if is_angle { "angles" } else { "lengths" };
                return Err(format!("\"{text}\" has two {twice}"));
            }
        }
        let [length, angle] = bound.map(Option::unwrap_or_default);
        Self { length, angle }.checked()
    }
}

impl ErrorBound {
    fn checked(self) -> Result<Self, String> {
        match ((0.0..=MAX_LENGTH).contains(&self.length), (0.0..=MAX_ANGLE).contains(&self.angle)) {
            (false, _) => Err(format!("an error of a length must be from 0 to {MAX_LENGTH:e} m")),
            (_, false) => Err("an error of an angle must be from 0 to 90 degrees".into()),
            _ => Ok(self),
        }
    }

    /// Returns the bound without its angle.
    ///
    /// # Errors
    /// If there is an angle.
    fn only_length(self) -> Result<Self, String> {
        if self.angle == 0.0 { Ok(self) } else { Err("this is the error of a length, such as 0.2 mm".into()) }
    }
}

impl FromToml for ErrorBound {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let expected = "an error such as \"0.5 mm\" or \"0.05deg\", or a number in metres";
        let read = match value.get_ref().as_str() {
            Some(text) => text.parse(),
            None => Self { length: number(value, expected)?, angle: 0.0 }.checked(),
        };
        read.map_err(|message| TomlError::new(value, message))
    }
}

/// The error of a length alone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LengthError(pub f64);

impl FromToml for LengthError {
    fn read(value: &TomlValue) -> Result<Self, TomlError> {
        let bound = ErrorBound::read(value)?.only_length().map_err(|message| TomlError::new(value, message))?;
        Ok(Self(bound.length))
    }
}

toml_table! {
    /// Greatest errors of the robot and of the obstacles' positions. A motion must be free for all errors up to these.
    /// Lengths are in m unless they have a unit.
    #[derive(Debug, Clone, Copy, Default, PartialEq)]
    #[cfg_attr(feature = "schema", derive(JsonSchema), schemars(deny_unknown_fields, rename = "calibration"))]
    pub struct CalibrationTable {
        /// Displacement of the robot's base in any direction, and its rotation about joint 1: `"0.5 mm, 0.05deg"`.
        #[cfg_attr(feature = "schema", schemars(with = "Option<StatedError>"))]
        pub base: Option<ErrorBound>,
        /// Displacement of each point of a link from its place on the link, in any direction: `"0.2 mm"`.
        #[cfg_attr(feature = "schema", schemars(with = "Option<StatedError>"))]
        pub links: Option<LengthError>,
        /// Error of each joint's zero, an angle for revolute and a length for prismatic joints: `"0.02deg, 0.1 mm"`.
        #[cfg_attr(feature = "schema", schemars(with = "Option<StatedError>"))]
        pub zeros: Option<ErrorBound>,
        /// Displacement of each obstacle in any direction; an obstacle's own `calibration` replaces it.
        #[cfg_attr(feature = "schema", schemars(with = "Option<StatedError>"))]
        pub obstacles: Option<LengthError>,
    }
}

impl CalibrationTable {
    /// Returns this table with its errors replaced by those that `other` states.
    #[must_use]
    pub fn replaced_by(self, other: Self) -> Self {
        Self {
            base: other.base.or(self.base),
            links: other.links.or(self.links),
            zeros: other.zeros.or(self.zeros),
            obstacles: other.obstacles.or(self.obstacles),
        }
    }

    /// Returns the errors of the robot.
    pub fn of_robot(&self) -> Calibration {
        let [base, zeros] = [self.base, self.zeros].map(Option::unwrap_or_default);
        Calibration {
            base_shift: base.length,
            base_turn: base.angle,
            links: self.links.unwrap_or_default().0,
            zero_turn: zeros.angle,
            zero_slide: zeros.length,
        }
    }
}

/// Writes the errors as the option states them, in metres and radians.
impl fmt::Display for CalibrationTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let both = |bound: ErrorBound| format!("{}m,{}rad", bound.length, bound.angle);
        let length = |error: LengthError| format!("{}m", error.0);
        let stated = [
            ("base", self.base.map(both)),
            ("links", self.links.map(length)),
            ("zeros", self.zeros.map(both)),
            ("obstacles", self.obstacles.map(length)),
        ];
        let stated = stated.into_iter().filter_map(|(key, value)| Some(format!("{key}={}", value?)));
        f.write_str(&stated.collect::<Vec<_>>().join("; "))
    }
}

/// Reads the option: `base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm`. Commas separate keys, too.
impl FromStr for CalibrationTable {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const KEYS: [&str; 4] = ["base", "links", "zeros", "obstacles"];
        let mut values: [Option<String>; 4] = [const { None }; 4];
        let mut last = None;
        for item in text.split([';', ',']).map(str::trim).filter(|item| !item.is_empty()) {
            let (key, value) = match item.split_once('=') {
                Some((name, value)) => {
                    let name = name.trim();
                    let key = KEYS.iter().position(|key| *key == name);
                    (key.ok_or_else(|| format!("\"{name}\" is none of {}", KEYS.join(", ")))?, value.trim())
                }
                None => (last.ok_or_else(|| format!("\"{item}\" has no key: write base=0.5mm"))?, item),
            };
            if last != Some(key) && values[key].is_some() {
                return Err(format!("{} is given twice", KEYS[key]));
            }
            last = Some(key);
            let known = values[key].get_or_insert_default();
            *known = if known.is_empty() { value.to_owned() } else { format!("{known}, {value}") };
        }
        if last.is_none() {
            return Err("give an error: base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".into());
        }
        let of = |key: usize| {
            let read = values[key].as_deref().map(str::parse::<ErrorBound>).transpose();
            read.map_err(|why| format!("{}: {why}", KEYS[key]))
        };
        let length = |key: usize| {
            let read = of(key)?.map(ErrorBound::only_length).transpose();
            read.map(|bound| bound.map(|bound| LengthError(bound.length)))
                .map_err(|why| format!("{}: {why}", KEYS[key]))
        };
        Ok(Self { base: of(0)?, links: length(1)?, zeros: of(2)?, obstacles: length(3)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_option_states_each_error_once() {
        let read = |text: &str| text.parse::<CalibrationTable>();
        let all = read("base=0.5mm,0.05deg; links=0.2 mm; zeros=0.02deg; obstacles=1mm").unwrap();
        let robot = all.of_robot();
        assert_eq!((robot.base_shift, robot.links, robot.zero_slide), (0.5e-3, 0.2e-3, 0.0));
        assert_eq!(
            (robot.base_turn, robot.zero_turn),
            (0.05_f64 * (std::f64::consts::PI / 180.0), 0.02 * (std::f64::consts::PI / 180.0))
        );
        assert_eq!(all.obstacles, Some(LengthError(1e-3)));
        assert_eq!(read(&all.to_string()).unwrap(), all);
        assert_eq!(read("base=0.5mm,links=0.2mm").unwrap().links, Some(LengthError(0.2e-3)));
        assert_eq!(read("zeros=0.1mm,1e-4rad").unwrap().zeros, Some(ErrorBound { length: 1e-4, angle: 1e-4 }));
        for (text, why) in [
            ("", "give an error"),
            ("0.5mm", "has no key"),
            ("base=0.5", "no unit"),
            ("base=0.5mm,1mm", "two lengths"),
            ("base=1mm; links=1mm; base=2mm", "twice"),
            ("links=1deg", "links: this is the error of a length"),
            ("bases=1mm", "none of base, links, zeros, obstacles"),
            ("zeros=-1deg", "from 0 to 90 degrees"),
            ("links=nanm", "links: "),
            ("zeros=xdeg", "\"x\" is not a number"),
            ("zeros=xrad", "\"x\" is not a number"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
