//! Signs and their meaning.

use super::figure::Pen;
use cplan_theme::Rgb;
use serde::Serialize;

/// The sign before a name.
#[derive(Debug, Clone, PartialEq)]
pub enum Sign {
    /// Start of the motion.
    Start,
    /// End of the motion.
    Goal,
    /// Intended end of a motion that was not found.
    Unreached,
    /// A piece of line, drawn with this pen.
    Line(Pen),
    /// A small square of this colour.
    Swatch(Rgb),
    /// A small square in a colour of the scale, from 0 to 1.
    Shade(f64),
    /// A dashed outline.
    Dashed(Rgb),
    /// The hatch of a proof.
    Hatched,
    /// A place of contact.
    Contact,
    /// A point of a channel: the middle of a portal, or the centre of a cell.
    Point {
        /// True for the middle of a portal.
        middle: bool,
    },
}

/// A sign and its meaning.
pub type Key = (Sign, String);

/// An entry of the legend, as pages read it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeyView {
    sign: &'static str,
    /// Colour of a line or a square: its name, if it has a meaning, or `#rrggbb`.
    #[serde(skip_serializing_if = "Option::is_none")]
    color: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(skip_serializing_if = "<[f64]>::is_empty")]
    dash: &'static [f64],
    /// Place on the colour scale, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<f64>,
    text: String,
    /// The layers of the page that this entry explains. The page hides the entry together with its layers. It always
    /// shows an entry without layers.
    #[serde(skip_serializing_if = "<[&str]>::is_empty")]
    layers: &'static [&'static str],
    /// True if the page shows the entry only while it shows the planner's search.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    think: bool,
}

/// An entry of the legend, and the layers of the page that it explains.
pub type Layered = (Key, &'static [&'static str]);

impl KeyView {
    /// Converts an entry of the legend to the form that pages read.
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
            Sign::Contact => "contact",
            Sign::Point { middle: true } => "middle",
            Sign::Point { middle: false } => "center",
        };
        let bare = Self { sign: name, color: None, width: None, dash: &[], part: None, text, layers, think };
        match sign {
            Sign::Line(Pen { color, width, dash }) => {
                Self { color: Some(cplan_theme::role_or_hex(color)), width: Some(width), dash, ..bare }
            }
            Sign::Swatch(color) | Sign::Dashed(color) => Self { color: Some(cplan_theme::role_or_hex(color)), ..bare },
            Sign::Shade(part) => Self { part: Some(part), ..bare },
            Sign::Start | Sign::Goal | Sign::Unreached | Sign::Hatched | Sign::Contact | Sign::Point { .. } => bare,
        }
    }
}
