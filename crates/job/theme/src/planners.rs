//! Colours and dashes of planners in comparisons: a hue for each family of planners, in several shades.

use super::Rgb;

/// A family of planners, which share a hue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlannerFamily {
    /// Planners that search a graph among polygons: orange.
    Roadmap,
    /// Planners that compute values on a grid: purple.
    Field,
    /// Planners that work on the scene itself: blue.
    Exact,
    /// Planners of other programs: green.
    Other,
}

impl PlannerFamily {
    /// All families.
    pub const ALL: [PlannerFamily; 4] =
        [PlannerFamily::Roadmap, PlannerFamily::Field, PlannerFamily::Exact, PlannerFamily::Other];

    /// Returns the first word of this family's variables in style sheets.
    pub fn name(self) -> &'static str {
        match self {
            PlannerFamily::Roadmap => "roadmap",
            PlannerFamily::Field => "field",
            PlannerFamily::Exact => "exact",
            PlannerFamily::Other => "other",
        }
    }

    /// Returns the shades for a light and for a dark background. Neighbours differ strongly in lightness.
    fn shades(self) -> [(Rgb, Rgb); SHADE_COUNT] {
        match self {
            PlannerFamily::Roadmap => [
                (Rgb(0xb8, 0x50, 0x08), Rgb(0xff, 0x9d, 0x47)),
                (Rgb(0x4d, 0x21, 0x04), Rgb(0xff, 0xe6, 0xcf)),
                (Rgb(0xe0, 0x69, 0x0a), Rgb(0xd9, 0x77, 0x1f)),
                (Rgb(0x7d, 0x36, 0x06), Rgb(0xff, 0xc8, 0x96)),
                (Rgb(0x9a, 0x43, 0x07), Rgb(0xb9, 0x62, 0x1a)),
            ],
            PlannerFamily::Field => [
                (Rgb(0xa2, 0x2f, 0x9f), Rgb(0xe0, 0x7f, 0xdc)),
                (Rgb(0x6a, 0x1f, 0x70), Rgb(0xf3, 0xbd, 0xf0)),
                (Rgb(0xcb, 0x63, 0xc7), Rgb(0xb8, 0x5c, 0xc4)),
                (Rgb(0x3b, 0x12, 0x3f), Rgb(0xfb, 0xe3, 0xfa)),
                (Rgb(0x86, 0x27, 0x8a), Rgb(0xcf, 0x6c, 0xcf)),
            ],
            PlannerFamily::Exact => [
                (Rgb(0x0f, 0x66, 0xb8), Rgb(0x5a, 0xae, 0xf5)),
                (Rgb(0x0a, 0x3c, 0x73), Rgb(0xa9, 0xd6, 0xff)),
                (Rgb(0x3d, 0x92, 0xdd), Rgb(0x3a, 0x84, 0xd0)),
                (Rgb(0x0a, 0x20, 0x38), Rgb(0xe0, 0xf0, 0xff)),
                (Rgb(0x2a, 0x7c, 0xc9), Rgb(0x7c, 0xc4, 0xff)),
            ],
            PlannerFamily::Other => [
                (Rgb(0x0f, 0x78, 0x4a), Rgb(0x4f, 0xc8, 0x8c)),
                (Rgb(0x0a, 0x4a, 0x2e), Rgb(0xa8, 0xee, 0xcc)),
                (Rgb(0x24, 0x9a, 0x62), Rgb(0x2f, 0x9e, 0x66)),
                (Rgb(0x06, 0x26, 0x18), Rgb(0xdd, 0xfb, 0xec)),
                (Rgb(0x18, 0x88, 0x55), Rgb(0x78, 0xdc, 0xac)),
            ],
        }
    }
}

/// Number of shades of each family. No family has more planners.
const SHADE_COUNT: usize = 5;

/// Lengths of dashes and gaps, in pixels. They distinguish the planners of a family, and paths on top of each other.
const DASHES: [&[f64]; SHADE_COUNT] = [&[], &[9.0, 4.0], &[3.0, 3.0], &[10.0, 3.0, 2.0, 3.0], &[14.0, 4.0]];

/// The line of a planner in pictures and charts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannerPen {
    /// Family of the planner.
    pub family: PlannerFamily,
    /// Index of the shade.
    pub shade: usize,
    /// Lengths of dashes and gaps in turn, in pixels; empty for a solid line.
    pub dash: &'static [f64],
}

impl PlannerPen {
    /// Returns the pen of the planner with this index within its family. When the shades repeat, the dashes change, so that the
    /// first 25 planners of a family differ.
    pub fn new(family: PlannerFamily, index: usize) -> Self {
        Self { family, shade: index % SHADE_COUNT, dash: DASHES[(index + index / SHADE_COUNT) % DASHES.len()] }
    }

    /// Returns the colour on a light background.
    pub fn light(self) -> Rgb {
        self.family.shades()[self.shade].0
    }

    /// Returns the colour on a dark background.
    pub fn dark(self) -> Rgb {
        self.family.shades()[self.shade].1
    }

    /// Returns the name of the colour in style sheets: `roadmap-0`.
    pub fn name(self) -> String {
        format!("{}-{}", self.family.name(), self.shade)
    }

    /// Iterates over one pen for each colour.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        PlannerFamily::ALL.into_iter().flat_map(|family| (0..SHADE_COUNT).map(move |index| Self::new(family, index)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ROLES;
    use crate::contrast::contrast;

    #[test]
    fn planners_stand_out_from_both_backgrounds() {
        for ground in &ROLES[..2] {
            for pen in PlannerPen::all() {
                let contrasts = [contrast(pen.light(), ground.light), contrast(pen.dark(), ground.dark)];
                assert!(contrasts.into_iter().all(|c| c >= 3.0), "{} on {}: {contrasts:?}", pen.name(), ground.name);
            }
        }
    }

    #[test]
    fn planners_of_a_family_differ_in_lightness_and_dashes() {
        for family in PlannerFamily::ALL {
            let pens: Vec<PlannerPen> = (0..SHADE_COUNT).map(|index| PlannerPen::new(family, index)).collect();
            for (i, a) in pens.iter().enumerate() {
                for b in &pens[i + 1..] {
                    let contrasts = [contrast(a.light(), b.light()), contrast(a.dark(), b.dark())];
                    assert!(contrasts.into_iter().all(|c| c >= 1.2), "{} and {}: {contrasts:?}", a.name(), b.name());
                    assert_ne!(a.dash, b.dash, "{} and {}", a.name(), b.name());
                }
            }
        }
    }

    /// Compares hues by the order of the channels, which is the same for all shades of a hue.
    #[test]
    fn each_family_has_its_own_hue() {
        for pen in PlannerPen::all() {
            for Rgb(r, g, b) in [pen.light(), pen.dark()] {
                let is_of_family = match pen.family {
                    PlannerFamily::Roadmap => r > g && g > b,
                    PlannerFamily::Field => r > g && b > g && r.abs_diff(b) <= 16,
                    PlannerFamily::Exact => b > g && g > r,
                    PlannerFamily::Other => g > b && b > r,
                };
                assert!(is_of_family, "{}", pen.name());
            }
        }
    }

    #[test]
    fn many_variants_of_a_planner_differ() {
        let pens: std::collections::BTreeSet<String> =
            (0..25).map(|index| format!("{:?}", PlannerPen::new(PlannerFamily::Field, index))).collect();
        assert_eq!(pens.len(), 25);
    }
}
