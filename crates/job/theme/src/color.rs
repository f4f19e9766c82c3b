//! Colours of obstacles, paths and values, which colour-blind readers can tell apart.

use super::WHITE;
use serde::{Serialize, Serializer};

/// A colour in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Returns this colour with `part` (0 to 1) of it replaced by another colour.
    pub fn mixed(self, other: Rgb, part: f64) -> Rgb {
        let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * part).round() as u8;
        Rgb(mix(self.0, other.0), mix(self.1, other.1), mix(self.2, other.2))
    }

    /// Returns this colour mixed with `part` (0 to 1) of white.
    pub fn lighter(self, part: f64) -> Rgb {
        self.mixed(WHITE, part)
    }

    /// Returns this colour mixed with `part` (0 to 1) of black.
    pub fn darker(self, part: f64) -> Rgb {
        self.mixed(Rgb(0, 0, 0), part)
    }

    /// Returns the colour of the same hue and saturation (HSL) with the opposite lightness, one minus that of this colour.
    pub fn with_reversed_lightness(self) -> Rgb {
        let Rgb(r, g, b) = self;
        // Lightness is half the sum of the least and the greatest channel. Adding a constant to all channels keeps hue and
        // chroma.
        let shift = 255 - i16::from(r.max(g).max(b)) - i16::from(r.min(g).min(b));
        let shifted = |channel: u8| (i16::from(channel) + shift).clamp(0, 255) as u8;
        Rgb(shifted(r), shifted(g), shifted(b))
    }
}

impl std::fmt::Display for Rgb {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

impl Serialize for Rgb {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Replaces the colours `#rrggbb` in the attributes of an SVG document. `replaced` receives each colour and returns the new
/// text of the attribute.
pub fn recolored(svg: &str, mut replaced: impl FnMut(Rgb) -> String) -> String {
    let mut parts = svg.split("=\"#");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let channel = |k: usize| part.get(2 * k..2 * k + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok());
        let color = channel(0).zip(channel(1)).zip(channel(2)).map(|((r, g), b)| Rgb(r, g, b));
        match (color, part.get(6..)) {
            (Some(color), Some(rest)) if rest.starts_with('"') => {
                text.extend(["=\"", &replaced(color), rest]);
            }
            _ => text.extend(["=\"#", part]),
        }
    }
    text
}

/// Colours of obstacles: Paul Tol's scheme "muted" (Technical Note SRON/EPS/TN/09-002, 2021). Neighbours in the list differ
/// strongly.
const OBSTACLE_COLORS: [Rgb; 9] = [
    Rgb(0x88, 0xcc, 0xee),
    Rgb(0xcc, 0x66, 0x77),
    Rgb(0xdd, 0xcc, 0x77),
    Rgb(0x44, 0xaa, 0x99),
    Rgb(0x33, 0x22, 0x88),
    Rgb(0xaa, 0x44, 0x99),
    Rgb(0x99, 0x99, 0x33),
    Rgb(0x88, 0x22, 0x55),
    Rgb(0x11, 0x77, 0x33),
];

/// Returns the colour of the obstacle with this index. Nine hues repeat, alternately paler and deeper, so that the first 63
/// obstacles have different colours.
pub fn obstacle(index: usize) -> Rgb {
    let hue = OBSTACLE_COLORS[index % OBSTACLE_COLORS.len()];
    match index / OBSTACLE_COLORS.len() % 7 {
        0 => hue,
        1 => hue.lighter(0.4),
        2 => hue.darker(0.3),
        3 => hue.lighter(0.2),
        4 => hue.darker(0.15),
        5 => hue.lighter(0.55),
        _ => hue.darker(0.45),
    }
}

/// Colours of the paths of a comparison, on a light and on a dark background.
pub const PATH_COLORS: [(Rgb, Rgb); 6] = [
    (Rgb(0x00, 0x72, 0xb2), Rgb(0x56, 0xb4, 0xe9)),
    (Rgb(0xd5, 0x5e, 0x00), Rgb(0xff, 0x8a, 0x3d)),
    (Rgb(0x00, 0x9e, 0x73), Rgb(0x2e, 0xcc, 0x9b)),
    (Rgb(0xb0, 0x4f, 0x88), Rgb(0xe5, 0x8c, 0xc0)),
    (Rgb(0xc7, 0x8a, 0x00), Rgb(0xe6, 0xb4, 0x22)),
    (Rgb(0x2b, 0x90, 0xc9), Rgb(0x8f, 0xd3, 0xff)),
];

/// Returns colour and dashes of path `index` of a comparison. The colours are the strong half of Okabe and Ito's scheme (2008).
/// Dashes distinguish paths on top of each other; they change when the colours repeat, so that the first 36 paths differ.
pub fn path(index: usize) -> (Rgb, &'static [f64]) {
    const PATH_DASHES: [&[f64]; 6] = [&[], &[9.0, 4.0], &[3.0, 3.0], &[10.0, 3.0, 2.0, 3.0], &[5.0, 5.0], &[14.0, 4.0]];
    (PATH_COLORS[index % PATH_COLORS.len()].0, PATH_DASHES[(index + index / PATH_COLORS.len()) % PATH_DASHES.len()])
}

/// Colours of the scale of values, evenly spaced from light to dark: seaborn's "mako", reversed, without its darkest third, so
/// that a dark path stays legible on it. Pages use the same colours.
pub const SCALE_STOPS: [Rgb; 8] = [
    Rgb(0xde, 0xf5, 0xe5),
    Rgb(0xa8, 0xe1, 0xbc),
    Rgb(0x60, 0xce, 0xac),
    Rgb(0x3e, 0xb4, 0xad),
    Rgb(0x34, 0x98, 0xa9),
    Rgb(0x35, 0x7b, 0xa3),
    Rgb(0x3b, 0x5d, 0x9a),
    Rgb(0x41, 0x3f, 0x80),
];

/// Returns the colour for `value` from 0 (light) to 1 (dark) on a perceptually uniform scale.
pub fn scale(value: f64) -> Rgb {
    let at = value.clamp(0.0, 1.0) * (SCALE_STOPS.len() - 1) as f64;
    let below = (at as usize).min(SCALE_STOPS.len() - 2);
    SCALE_STOPS[below].mixed(SCALE_STOPS[below + 1], at - below as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CHANNEL;
    use crate::contrast::luminance;

    #[test]
    fn the_paths_of_many_planners_differ() {
        let pens: std::collections::BTreeSet<String> = (0..36).map(|index| format!("{:?}", path(index))).collect();
        assert_eq!(pens.len(), 36);
    }

    #[test]
    fn sixty_obstacles_have_sixty_colours() {
        let all: Vec<Rgb> = (0..60).map(obstacle).collect();
        for (i, a) in all.iter().enumerate() {
            for b in &all[i + 1..] {
                assert_ne!(a, b);
            }
        }
        assert_eq!(obstacle(63), obstacle(0));
    }

    /// Compares obstacles with the paler colours in configuration spaces. Once, an obstacle had almost the colour of the channel.
    #[test]
    fn no_obstacle_has_the_colour_of_the_channel() {
        for index in 0..63 {
            let Rgb(r, g, b) = obstacle(index).lighter(0.35);
            let off = [(r, CHANNEL.0), (g, CHANNEL.1), (b, CHANNEL.2)].map(|(x, y)| f64::from(x.abs_diff(y)).powi(2));
            assert!(off.iter().sum::<f64>().sqrt() > 45.0, "{index}");
        }
    }

    #[test]
    fn the_scale_darkens_steadily() {
        let all: Vec<f64> = (0..=100).map(|i| luminance(scale(f64::from(i) / 100.0))).collect();
        assert!(all.windows(2).all(|w| w[1] < w[0]));
        assert_eq!(scale(-1.0), scale(0.0));
        assert_eq!(scale(2.0), Rgb(0x41, 0x3f, 0x80));
    }

    #[test]
    fn only_colors_in_attributes_are_replaced() {
        let svg = "<a fill=\"#0a0B0c\" href=\"#ground\"/><b x=\"#123\">#0a0b0c \u{e9}=\"#\u{e9}\u{e9}\u{e9}\"</b>";
        let text = recolored(svg, |color| format!("[{color}]"));
        assert_eq!(text, svg.replacen("#0a0B0c", "[#0a0b0c]", 1));
        assert_eq!(recolored("", |color| color.to_string()), "");
    }

    #[test]
    fn mixing_ends_at_its_arguments() {
        let a = Rgb(10, 200, 30);
        assert_eq!(a.mixed(WHITE, 0.0), a);
        assert_eq!(a.mixed(WHITE, 1.0), WHITE);
        assert_eq!(a.to_string(), "#0ac81e");
    }
}
