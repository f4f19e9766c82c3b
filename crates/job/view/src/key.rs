//! Signs of the legend and their meanings.

use super::figure::Pen;
use super::{Object, object};
use cplan_theme::{Rgb, role_or_hex};

/// The sign before a name.
#[derive(Debug, Clone, PartialEq)]
pub enum Sign {
    /// Start of the motion.
    Start,
    /// End of the motion.
    Goal,
    /// Intended end of a motion that does not reach it.
    Unreached,
    /// A piece of line, drawn with this pen.
    Line(Pen),
    /// A small square of this colour.
    Swatch(Rgb),
    /// A small square in the colour of this value (0 to 1) on the scale.
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

/// An entry of the legend, and the layers of the page that it explains.
pub type Layered = (Key, &'static [&'static str]);

/// Returns an entry of the legend for pages. The page hides the entry together with `layers`, the layers that it explains;
/// without layers, it always shows the entry. If `think`, it shows the entry only during the planner's search.
pub fn document(((sign, text), layers): Layered, think: bool) -> Object {
    let of = |name: &str| object!("sign": name);
    let colored = |name: &str, color: Rgb| of(name).with("color", &role_or_hex(color));
    let shown = match sign {
        Sign::Start => of("start"),
        Sign::Goal => of("goal"),
        Sign::Unreached => of("unreached"),
        Sign::Line(Pen { color, width, dash }) => colored("line", color).with("width", &width).with_any("dash", &dash),
        Sign::Swatch(color) => colored("swatch", color),
        Sign::Shade(part) => of("shade").with("part", &part),
        Sign::Dashed(color) => colored("dashed", color),
        Sign::Hatched => of("hatched"),
        Sign::Contact => of("contact"),
        Sign::Point { middle } => of(if middle { "middle" } else { "center" }),
    };
    shown.with("text", &text).with_any("layers", &layers).with_any("think", &think)
}
