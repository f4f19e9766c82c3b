//! The YAML beside a picture.

use super::Occupancy;
use super::picture::Shade;
use crate::input::error::Diagnostic;
use crate::input::source::Source;
use crate::input::world::LARGEST;
use serde::Deserialize;
use serde_saphyr::Spanned;

/// As the file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    image: Spanned<String>,
    resolution: Spanned<f64>,
    origin: Spanned<Vec<f64>>,
    negate: Spanned<Negate>,
    occupied_thresh: Spanned<f64>,
    free_thresh: Spanned<f64>,
    mode: Option<Spanned<String>>,
}

/// ROS writes 0 or 1, people also false or true.
#[derive(Deserialize)]
#[serde(untagged)]
enum Negate {
    Word(bool),
    Number(i64),
    Neither(serde::de::IgnoredAny),
}

/// How a picture becomes a map: valid.
pub(super) struct Description {
    pub image: Spanned<String>,
    pub resolution: f64,
    pub origin: [f64; 3],
    negate: bool,
    occupied: f64,
    free: f64,
}

impl Description {
    pub fn read(source: &Source) -> Result<Self, Diagnostic> {
        let file: File = serde_saphyr::from_str(&source.text).map_err(|error| {
            source
                .yaml_diagnostic(&error)
                .help("a map of ROS's map server needs image, resolution, origin, negate, occupied_thresh, free_thresh")
        })?;
        let resolution = file.resolution.value;
        if !(resolution > 0.0 && resolution <= LARGEST) {
            let message = format!("resolution: {resolution} is no length of a pixel's side");
            return Err(diagnostic(source, &file.resolution, message).help("give metres a pixel, such as 0.05"));
        }
        let origin = <[f64; 3]>::try_from(file.origin.value.as_slice()).map_err(|_| {
            let message = format!("origin: expected three numbers, found {}", file.origin.value.len());
            diagnostic(source, &file.origin, message).help("origin: [x, y, yaw], metres and radians")
        })?;
        if let Some(bad) = origin.iter().find(|v| v.is_nan() || v.abs() > LARGEST) {
            let message = format!("origin: {bad} is not finite, or too large (at most {LARGEST:e})");
            let help = format!("origin: [x, y, yaw], metres and radians, from -{LARGEST:e} to {LARGEST:e}");
            return Err(diagnostic(source, &file.origin, message).help(help));
        }
        let negate = match file.negate.value {
            Negate::Word(negate) => negate,
            Negate::Number(0) => false,
            Negate::Number(1) => true,
            Negate::Number(_) | Negate::Neither(_) => {
                return Err(diagnostic(source, &file.negate, "negate: it is neither 0 nor 1")
                    .help("0 if dark is occupied, 1 if light is"));
            }
        };
        for (key, threshold) in [("occupied_thresh", &file.occupied_thresh), ("free_thresh", &file.free_thresh)] {
            if !(0.0..=1.0).contains(&threshold.value) {
                let message = format!("{key}: {} is not between 0 and 1", threshold.value);
                return Err(diagnostic(source, threshold, message).help("ROS's usual values are 0.65 and 0.196"));
            }
        }
        let (occupied, free) = (file.occupied_thresh.value, file.free_thresh.value);
        if free > occupied {
            let message = format!("free_thresh: {free} is above occupied_thresh, {occupied}");
            return Err(diagnostic(source, &file.free_thresh, message).help("ROS's usual values are 0.65 and 0.196"));
        }
        match &file.mode {
            Some(mode) if mode.value == "raw" => {
                return Err(diagnostic(
                    source,
                    mode,
                    "mode: raw has costs for values, which do not say what is occupied",
                )
                .help("use trinary or scale, whose shades do"));
            }
            Some(mode) if mode.value != "trinary" && mode.value != "scale" => {
                return Err(diagnostic(source, mode, format!("mode: \"{}\" is unknown", mode.value))
                    .help("use trinary or scale, or leave it out"));
            }
            _ => {}
        }
        Ok(Self { image: file.image, resolution, origin, negate, occupied, free })
    }

    /// What a shade, from 0 for black to that of white, says of its cell; none is of a pixel that one can see through. Of whole numbers the
    /// quotient that is held against the thresholds is rounded as they are, so that it is no less than one that it equals.
    pub fn judge(&self, shade: Option<Shade>) -> Occupancy {
        let dark = |Shade { value, white }| {
            let dark = if self.negate { value } else { white - value };
            dark / white
        };
        match shade.map(dark) {
            Some(p) if p > self.occupied => Occupancy::Occupied,
            Some(p) if p < self.free => Occupancy::Free,
            _ => Occupancy::Unknown,
        }
    }
}

/// A diagnostic where the value is.
fn diagnostic<T>(source: &Source, value: &Spanned<T>, message: impl Into<String>) -> Diagnostic {
    source.diagnostic_at_position(value.referenced.line() as usize, value.referenced.column() as usize, message)
}
