//! Signs and what they mean.

use super::color::{self, Rgb};
use super::figure::Pen;
use serde::Serialize;

/// What stands before a name.
#[derive(Debug, Clone, PartialEq)]
pub enum Sign {
    /// Where the motion begins.
    Start,
    /// Where it ends.
    Goal,
    /// Where it would end.
    Unreached,
    /// A piece of line, drawn with this pen.
    Line(Pen),
    /// A small square of this colour.
    Swatch(Rgb),
    /// The same in a colour of the scale, from 0 to 1.
    Shade(f64),
    /// A dashed outline.
    Dashed(Rgb),
    /// The hatch of a proof.
    Hatched,
    /// A point of a channel: the middle of a door, or the centre of a cell.
    Point {
        /// Whether it is the middle of a door.
        middle: bool,
    },
}

/// A sign and what it means.
pub type Key = (Sign, String);

/// A key as pages read it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeyView {
    sign: &'static str,
    /// That of a line or a square: its name, if it means something, or `#rrggbb`.
    #[serde(skip_serializing_if = "Option::is_none")]
    color: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(skip_serializing_if = "<[f64]>::is_empty")]
    dash: &'static [f64],
    /// Of a colour of the scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<f64>,
    text: String,
    /// Of which layers it is: those of a page can be hidden. None of what is always there.
    #[serde(skip_serializing_if = "<[&str]>::is_empty")]
    layers: &'static [&'static str],
    /// Whether it is there only while it is told how the planner came to it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    think: bool,
}

/// A key, and the layers that it is of.
pub type Layered = (Key, &'static [&'static str]);

impl KeyView {
    /// A key as pages read it.
    #[must_use]
    pub fn new(((sign, text), layers): Layered, think: bool) -> Self {
        let name = match sign {
            Sign::Start => "start",
            Sign::Goal => "goal",
            Sign::Unreached => "unreached",
            Sign::Line(_) => "line",
            Sign::Swatch(_) => "swatch",
            Sign::Shade(_) => "shade",
            Sign::Dashed(_) => "dashed",
            Sign::Hatched => "hatched",
            Sign::Point { middle: true } => "middle",
            Sign::Point { middle: false } => "center",
        };
        let bare = Self { sign: name, color: None, width: None, dash: &[], part: None, text, layers, think };
        match sign {
            Sign::Line(Pen { color, width, dash }) => {
                Self { color: Some(color::tint(color)), width: Some(width), dash, ..bare }
            }
            Sign::Swatch(color) | Sign::Dashed(color) => Self { color: Some(color::tint(color)), ..bare },
            Sign::Shade(part) => Self { part: Some(part), ..bare },
            Sign::Start | Sign::Goal | Sign::Unreached | Sign::Hatched | Sign::Point { .. } => bare,
        }
    }
}
