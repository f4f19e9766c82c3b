//! The YAML file that describes a map's picture.

use super::picture::{Occupancy, Shade};
use crate::parsers::yaml_diagnostic;
use cplan_robot::{Diagnostic, MAX_LENGTH, Source, quoted};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_saphyr::Spanned;
use std::collections::BTreeMap;

/// The keys of the file.
#[derive(Deserialize)]
struct File {
    image: Spanned<String>,
    resolution: Spanned<f64>,
    origin: Spanned<Vec<f64>>,
    negate: Spanned<Negate>,
    occupied_thresh: Spanned<f64>,
    free_thresh: Spanned<f64>,
    mode: Option<Spanned<String>>,
}

/// The keys that this reader uses. Other programs add more keys.
const READ_KEYS: [&str; 7] = ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"];

/// Darkness (0 to 255) of unseen cells in pictures that ROS's map savers write: the shade 205, whatever `free_thresh` is. With
/// their usual `free_thresh: 0.25`, such a cell would otherwise count as free.
const UNSEEN_DARKNESS: f64 = 50.0;

/// The key `negate`. ROS writes 0 or 1; people also write false or true.
#[derive(Deserialize)]
#[serde(untagged)]
enum Negate {
    Word(bool),
    Number(i64),
    Neither(serde::de::IgnoredAny),
}

/// A valid description of how to convert a picture to a map.
pub(super) struct Description {
    pub image: Spanned<String>,
    pub resolution: f64,
    pub origin: [f64; 3],
    negate: bool,
    occupied: f64,
    free: f64,
    /// Keys of the file that this reader ignores.
    unused: Vec<String>,
}

impl Description {
    pub fn read(source: &Source) -> Result<Self, Diagnostic> {
        let file: File = serde_saphyr::from_str(source.text()).map_err(|error| {
            yaml_diagnostic(source, &error)
                .help("a map of ROS's map server needs image, resolution, origin, negate, occupied_thresh, free_thresh")
        })?;
        let keys: BTreeMap<String, IgnoredAny> = serde_saphyr::from_str(source.text()).unwrap_or_default();
        let unused = keys.into_keys().filter(|key| !READ_KEYS.contains(&key.as_str())).collect();
        let resolution = file.resolution.value;
        if !(resolution > 0.0 && resolution <= MAX_LENGTH) {
            let message = format!("resolution: {resolution} is not a valid length of a pixel's side");
            return Err(diagnostic(source, &file.resolution, message).help("give metres per pixel, such as 0.05"));
        }
        let origin = <[f64; 3]>::try_from(file.origin.value.as_slice()).map_err(|_| {
            let message = format!("origin: expected three numbers, found {}", file.origin.value.len());
            diagnostic(source, &file.origin, message).help("origin: [x, y, yaw], metres and radians")
        })?;
        if let Some(bad) = origin.iter().find(|v| v.is_nan() || v.abs() > MAX_LENGTH) {
            let message = format!("origin: {bad} is not finite, or too large (at most {MAX_LENGTH:e})");
            let help = format!("origin: [x, y, yaw], metres and radians, from -{MAX_LENGTH:e} to {MAX_LENGTH:e}");
            return Err(diagnostic(source, &file.origin, message).help(help));
        }
        let negate = match file.negate.value {
            Negate::Word(negate) => negate,
            Negate::Number(0) => false,
            Negate::Number(1) => true,
            Negate::Number(_) | Negate::Neither(_) => {
                return Err(diagnostic(source, &file.negate, "negate: the value is neither 0 nor 1")
                    .help("write 0 if dark pixels are occupied, 1 if light pixels are"));
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
                    "mode: cplan cannot read raw maps, which contain costs instead of occupied cells",
                )
                .help("save the map with mode trinary or scale (map_saver_cli --mode trinary)"));
            }
            Some(mode) if mode.value != "trinary" && mode.value != "scale" => {
                return Err(diagnostic(source, mode, format!("mode: \"{}\" is unknown", mode.value))
                    .help("use trinary or scale, or leave it out"));
            }
            _ => {}
        }
        Ok(Self { image: file.image, resolution, origin, negate, occupied, free, unused })
    }

    /// Returns the darkness of a shade: 0 for white and `white` for black, or the reverse if `negate` is set.
    fn dark(&self, Shade { value, white }: Shade) -> f64 {
        if self.negate { value } else { white - value }
    }

    /// Returns true for the shade of unseen cells. Computes with integers, so nothing is rounded.
    fn is_unseen(&self, shade: Shade) -> bool {
        self.dark(shade) * 255.0 == UNSEEN_DARKNESS * shade.white
    }

    /// Returns the occupancy of a cell, given its shade; `None` for a transparent pixel. A quotient that should equal a threshold
    /// also does so in floating point, because both are rounded alike.
    pub fn judge(&self, shade: Option<Shade>) -> Occupancy {
        match shade.map(|shade| (self.dark(shade) / shade.white, self.is_unseen(shade))) {
            Some((p, _)) if p > self.occupied => Occupancy::Occupied,
            Some((p, false)) if p < self.free => Occupancy::Free,
            _ => Occupancy::Unknown,
        }
    }

    /// Returns notes for the user about the map. `has_unknown` is true if the map has unknown cells.
    pub fn notes(&self, has_unknown: bool) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.unused.is_empty() {
            notes.push(format!("unused keys: {}", quoted(&self.unused)));
        }
        if has_unknown && self.free > UNSEEN_DARKNESS / 255.0 {
            notes.push(format!(
                "shade {} counts as unknown, as in ROS's map savers, although it would be free by free_thresh {}; to treat unknown cells as free, write unknown = \"free\" in the world file",
                if self.negate { 50 } else { 205 },
                self.free
            ));
        }
        notes
    }
}

fn diagnostic<T>(source: &Source, value: &Spanned<T>, message: impl Into<String>) -> Diagnostic {
    source.diagnostic_at_position(value.referenced.line() as usize, value.referenced.column() as usize, message)
}
