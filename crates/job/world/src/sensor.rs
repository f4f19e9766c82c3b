//! The range sensor in the world file's `[sensor]`.

use super::reader::Reader;
#[cfg(test)]
use super::schema::*;
use crate::{Mount, Sensor};
use cplan_robot::{Diagnostic, Length, Number, Spanned, Written, toml_table};
use std::f64::consts::TAU;

const MAX_RAYS: u64 = 100_000;

/// Least distance between readings, in joint space. With it, a path of many turns already has millions of readings.
const MIN_READING_STEP: f64 = 1e-4;

toml_table! {
    /// The sensor of an exploration (`cplan explore`). Every key has a default. Rays are as wide as the map cells that they
    /// cross.
    #[derive(Debug, Clone)]
    #[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields, rename = "sensor"))]
    pub(super) struct SensorTable {
        /// Place where the sensor is attached: "tip" or "base"; by default "tip". At the tip, it looks in the direction
        /// from joint 2 to the tip.
        #[cfg_attr(test, schemars(with = "Option<SensorOn>"))]
        on: Option<Spanned<String>>,
        /// Number of rays; by default 360.
        #[cfg_attr(test, schemars(range(min = 1, max = 100_000)))]
        rays: Option<Spanned<u64>>,
        /// Angle over which the rays are spread, rad; at most a whole turn, which is the default.
        field_of_view: Option<Written>,
        /// Range, m; by default half the arm's reach.
        #[cfg_attr(test, schemars(with = "Option<PositiveLength>"))]
        range: Option<Length>,
        /// Distance on the path between two readings, in joint space (rad and m are added); by default 0.1.
        #[cfg_attr(test, schemars(with = "Option<Positive>"))]
        step: Option<Number>,
        /// Greatest error of a distance, m; by default 0. Errors are distributed uniformly.
        #[cfg_attr(test, schemars(with = "Option<NotNegativeLength>"))]
        noise: Option<Length>,
        /// Seed of the errors; by default 0.
        seed: Option<u64>,
        /// Side of the cells of the map, m; by default a fortieth of the arm's reach.
        #[cfg_attr(test, schemars(with = "Option<PositiveLength>"))]
        cell: Option<Length>,
    }
}

/// The properties of the sensor that the file states.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct SensorWishes {
    mount: Option<Mount>,
    rays: Option<usize>,
    field_of_view: Option<f64>,
    range: Option<f64>,
    step: Option<f64>,
    noise: Option<f64>,
    seed: Option<u64>,
    cell: Option<f64>,
}

impl SensorTable {
    /// Checks the values, and returns them.
    ///
    /// # Errors
    /// Invalid words and numbers.
    pub fn read(&self, reader: &Reader) -> Result<SensorWishes, Diagnostic> {
        let mount = |word: &Spanned<String>| match word.get_ref().as_str() {
            "tip" => Ok(Mount::Tip),
            "base" => Ok(Mount::Base),
            other => {
                let message = format!("a sensor is on \"tip\" or \"base\", not on \"{other}\"");
                Err(reader.source.diagnostic_at(word.span(), message).help("write on = \"tip\", or leave it out"))
            }
        };
        let rays = |rays: &Spanned<u64>| match *rays.get_ref() {
            n @ 1..=MAX_RAYS => Ok(n as usize),
            n => {
                let message = format!("a sensor has 1 to {MAX_RAYS} rays, not {n}");
                Err(reader.source.diagnostic_at(rays.span(), message).help("write a number of rays, such as 360"))
            }
        };
        let positive = |number: &Option<Length>, what: &str| {
            let read = |number: &Length| match reader.source.finite(number, what)? {
                value if value > 0.0 => Ok(value),
                value => {
                    let message = format!("{what} must be positive, is {value}");
                    Err(reader.source.diagnostic_at(number.span(), message).help("write a number above 0"))
                }
            };
            number.as_ref().map(read).transpose()
        };
        let step = |number: &Number| match reader.source.finite(number, "sensor step")? {
            value if value >= MIN_READING_STEP => Ok(value),
            value => {
                let message = format!("sensor step must be at least {MIN_READING_STEP}, is {value}");
                Err(reader.source.diagnostic_at(number.span(), message).help("a distance in joint space, such as 0.1"))
            }
        };
        let field_of_view = |written: &Written| match reader.quantity(written, "sensor field_of_view")? {
            value if 0.0 < value && value <= TAU * (1.0 + f64::EPSILON) => Ok(value),
            value => {
                let message = format!("sensor field_of_view must be above 0 and at most a whole turn, is {value} rad");
                Err(reader.source.diagnostic_at(written.span(), message).help("radians, or \"360deg\""))
            }
        };
        Ok(SensorWishes {
            mount: self.on.as_ref().map(mount).transpose()?,
            rays: self.rays.as_ref().map(rays).transpose()?,
            field_of_view: self.field_of_view.as_ref().map(field_of_view).transpose()?,
            range: positive(&self.range, "sensor range")?,
            step: self.step.as_ref().map(step).transpose()?,
            noise: self.noise.as_ref().map(|n| reader.not_negative(n, "sensor noise")).transpose()?,
            seed: self.seed,
            cell: positive(&self.cell, "sensor cell")?,
        })
    }
}

impl SensorWishes {
    /// Returns the sensor with the properties that the file states, and otherwise those of `usual`.
    pub fn completed_by(&self, usual: Sensor) -> Sensor {
        Sensor {
            mount: self.mount.unwrap_or(usual.mount),
            rays: self.rays.unwrap_or(usual.rays),
            field_of_view: self.field_of_view.unwrap_or(usual.field_of_view),
            range: self.range.unwrap_or(usual.range),
            step: self.step.unwrap_or(usual.step),
            noise: self.noise.unwrap_or(usual.noise),
            seed: self.seed.unwrap_or(usual.seed),
            cell: self.cell.unwrap_or(usual.cell),
            ..usual
        }
    }
}
