//! The design of all pages and pictures: colours by role, for a light and a dark background, and sizes of type and spacing. For
//! pages it is a style sheet ([`css`]), for pictures constants. The font is Inter, which is part of every page and, for pictures
//! in pixels, of the program.

mod color;
#[cfg(test)]
mod contrast;
mod planners;
mod roles;

pub use color::{PATH_COLORS, Rgb, SCALE_STOPS, obstacle, path, recolored, scale};
pub use planners::{PlannerFamily, PlannerPen};
pub use roles::*;

use cplan_text::base64;

/// Fonts of pictures: the built-in one, and substitutes for readers of SVG files without it.
pub const PICTURE_FONTS: &str = "Inter, 'DejaVu Sans', Helvetica, Arial, sans-serif";

/// The built-in font of pictures in pixels: Inter Regular with Latin, Greek and Cyrillic letters and signs.
pub const PICTURE_FONT: &[u8] = include_bytes!("../fonts/inter-regular.ttf");

/// Inter SemiBold with the same letters.
pub const BOLD_PICTURE_FONT: &[u8] = include_bytes!("../fonts/inter-semibold.ttf");

/// The built-in fonts of pages, each for a range of weights. They have Latin letters and the signs that pages use.
const PAGE_FONTS: [(&str, &[u8]); 2] = [
    ("100 500", include_bytes!("../fonts/inter-regular.woff2")),
    ("501 900", include_bytes!("../fonts/inter-semibold.woff2")),
];

/// Sizes of type, spacing and corners, which are the same for both backgrounds.
const SIZES: &str = include_str!("tokens.css");

/// Returns the style sheet with which all pages begin: the variables of `tokens.css`, a variable `--NAME` for each role,
/// `--path-0` to `--path-5`, and one for each colour of planners. Colours are light or dark, according to the reader's system.
pub fn css() -> String {
    let variables = |is_dark: bool| -> String {
        let roles = ROLES.iter().map(|role| (role.name.to_owned(), role.light, role.dark));
        let paths = (0..).zip(PATH_COLORS).map(|(index, (light, dark))| (format!("path-{index}"), light, dark));
        let planners = PlannerPen::all().map(|pen| (pen.name(), pen.light(), pen.dark()));
        let variable = |(name, light, dark)| format!(" --{name}: {};", if is_dark { dark } else { light });
        roles.chain(paths).chain(planners).map(variable).collect()
    };
    let [light, dark] = [variables(false), variables(true)];
    let face = |(range, bytes): (&str, &[u8])| {
        let data = base64(bytes);
        format!("@font-face {{ font-family: Inter; font-weight: {range}; src: url(data:font/woff2;base64,{data}); }}\n")
    };
    let faces: String = PAGE_FONTS.into_iter().map(face).collect();
    format!(
        "{faces}{SIZES}:root {{ color-scheme: light dark; --dark: 0;{light} }}\n\
         @media (prefers-color-scheme: dark) {{\n:root {{ --dark: 1;{dark} }}\n}}\n"
    )
}

/// Iterates over the names of the colours of roles and planners in style sheets.
pub fn names() -> impl Iterator<Item = String> {
    ROLES.iter().map(|role| role.name.to_owned()).chain(PlannerPen::all().map(PlannerPen::name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_style_sheet_has_both_colors_of_each_role() {
        let sheet = css();
        let (light, dark) = sheet.split_once("@media (prefers-color-scheme: dark)").unwrap();
        for role in ROLES {
            assert!(light.contains(&format!(" --{}: {};", role.name, role.light)), "{}", role.name);
            assert!(dark.contains(&format!(" --{}: {};", role.name, role.dark)), "{}", role.name);
        }
    }
}
