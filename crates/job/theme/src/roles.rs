//! Colours by role, for a light and a dark background.

use super::{PATH_COLORS, PlannerPen, Rgb};

/// A meaning that has a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Role {
    /// Name in style sheets and in the data of pages.
    pub name: &'static str,
    /// Colour on a light background.
    pub light: Rgb,
    /// Colour on a dark background.
    pub dark: Rgb,
}

/// The background of pictures.
pub const WHITE: Rgb = Rgb(0xff, 0xff, 0xff);
/// The background of pages, around the pictures.
pub const PAGE: Rgb = Rgb(0xf6, 0xf7, 0xf8);
/// Text, paths and the arm.
pub const INK: Rgb = Rgb(0x22, 0x26, 0x2b);
/// Less important text.
pub const GRAY: Rgb = Rgb(0x5c, 0x63, 0x6b);
/// Marks for orientation: the reach, ticks.
pub const PALE: Rgb = Rgb(0xa3, 0xaa, 0xb2);
/// Grid lines behind a chart.
pub const FAINT: Rgb = Rgb(0xe9, 0xeb, 0xee);
/// Values that are valid but unwise.
pub const WARNING: Rgb = Rgb(0x8f, 0x55, 0x00);
/// The arm at its current configuration, lines of steepest ascent, and controls.
pub const ACCENT: Rgb = Rgb(0x00, 0x72, 0xb2);
/// The arm along its path.
pub const GHOST: Rgb = Rgb(0xd8, 0xdc, 0xe1);
/// What is found, certified or free.
pub const FOUND: Rgb = Rgb(0x00, 0x79, 0x5a);
/// What is infeasible, in contact or blocked.
pub const INFEASIBLE: Rgb = Rgb(0xc2, 0x2e, 0x2e);
/// Boxes of proofs that there is no path.
pub const PROOF: Rgb = Rgb(0xd9, 0x5f, 0x02);
/// Boxes of free configurations.
pub const FREE: Rgb = Rgb(0xd3, 0xee, 0xda);
/// Undecided boxes: grey, unlike any obstacle.
pub const UNDECIDED: Rgb = Rgb(0xae, 0xb3, 0xbb);
/// Edges of roadmaps, sides of cells.
pub const EDGE: Rgb = Rgb(0x7d, 0x8f, 0xa6);
/// Cells of the channel: a yellow that no obstacle has.
pub const CHANNEL: Rgb = Rgb(0xff, 0xf0, 0x70);
/// Fixed links of the robot.
pub const ROBOT: Rgb = Rgb(0x8a, 0x90, 0x98);
/// Regions that fields avoid.
pub const AVOIDED: Rgb = Rgb(0xc4, 0x6a, 0x1d);
/// Regions that fields prefer.
pub const PREFERRED: Rgb = Rgb(0x2b, 0x7a, 0x78);
/// Places that the tip can reach with one IK solution.
pub const REACHED: Rgb = Rgb(0xb8, 0xdc, 0xcb);
/// Places that the tip can reach with several IK solutions.
pub const REACHED_TWICE: Rgb = Rgb(0x4f, 0x9f, 0x83);
/// Places where the arm would be free, but which it provably cannot reach.
pub const UNREACHABLE: Rgb = Rgb(0xe8, 0xa1, 0x6b);
/// Places at which the arm would collide.
pub const OCCUPIED: Rgb = Rgb(0xe1, 0xe4, 0xe8);
/// Places for which it is unknown whether the arm can reach them.
pub const UNKNOWN: Rgb = Rgb(0xc9, 0xa7, 0xdc);

/// All roles. The constants above are their colours on a light background.
pub const ROLES: [Role; 24] = [
    Role { name: "paper", light: WHITE, dark: Rgb(0x16, 0x19, 0x1d) },
    Role { name: "page", light: PAGE, dark: Rgb(0x0e, 0x10, 0x13) },
    Role { name: "ink", light: INK, dark: Rgb(0xec, 0xef, 0xf2) },
    Role { name: "grey", light: GRAY, dark: Rgb(0xa4, 0xac, 0xb5) },
    Role { name: "pale", light: PALE, dark: Rgb(0x5d, 0x66, 0x6f) },
    Role { name: "faint", light: FAINT, dark: Rgb(0x2b, 0x31, 0x38) },
    Role { name: "accent", light: ACCENT, dark: Rgb(0x56, 0xb4, 0xe9) },
    Role { name: "ghost", light: GHOST, dark: Rgb(0x3a, 0x41, 0x49) },
    Role { name: "found", light: FOUND, dark: Rgb(0x35, 0xc7, 0x95) },
    Role { name: "infeasible", light: INFEASIBLE, dark: Rgb(0xff, 0x7b, 0x6b) },
    Role { name: "warning", light: WARNING, dark: Rgb(0xff, 0xb9, 0x5c) },
    Role { name: "proof", light: PROOF, dark: Rgb(0xff, 0x9d, 0x45) },
    Role { name: "free", light: FREE, dark: Rgb(0x1d, 0x45, 0x34) },
    Role { name: "undecided", light: UNDECIDED, dark: Rgb(0x6f, 0x75, 0x7d) },
    Role { name: "edge", light: EDGE, dark: Rgb(0x7d, 0x8f, 0xa6) },
    Role { name: "channel", light: CHANNEL, dark: Rgb(0x4d, 0x44, 0x20) },
    Role { name: "robot", light: ROBOT, dark: Rgb(0x7f, 0x86, 0x8e) },
    Role { name: "avoided", light: AVOIDED, dark: Rgb(0xe5, 0x9a, 0x55) },
    Role { name: "preferred", light: PREFERRED, dark: Rgb(0x58, 0xb5, 0xb2) },
    Role { name: "reached", light: REACHED, dark: Rgb(0x2a, 0x5a, 0x49) },
    Role { name: "reached-twice", light: REACHED_TWICE, dark: Rgb(0x4f, 0xb3, 0x93) },
    Role { name: "unreachable", light: UNREACHABLE, dark: Rgb(0xb5, 0x68, 0x2f) },
    Role { name: "occupied", light: OCCUPIED, dark: Rgb(0x30, 0x36, 0x3d) },
    Role { name: "unknown", light: UNKNOWN, dark: Rgb(0x6c, 0x4f, 0x7d) },
];

/// Returns the name of the role or planner with this colour on a light background. It is also the name of a variable in style
/// sheets. `None` for other colours.
pub fn variable(color: Rgb) -> Option<String> {
    let role = ROLES.iter().find(|role| role.light == color).map(|role| role.name.to_owned());
    role.or_else(|| PlannerPen::all().find(|pen| pen.light() == color).map(PlannerPen::name))
}

/// Returns the name of the role or planner with this colour on a light background, or `#rrggbb` if there is none.
pub fn role_or_hex(color: Rgb) -> String {
    variable(color).unwrap_or_else(|| color.to_string())
}

/// Returns the colour on a dark background that corresponds to one on a light background: the other colour of its role, planner
/// or path; otherwise the same hue with reversed lightness.
pub fn on_dark(color: Rgb) -> Rgb {
    let role = ROLES.iter().find(|role| role.light == color).map(|role| role.dark);
    let planner = || PlannerPen::all().find(|pen| pen.light() == color).map(PlannerPen::dark);
    let path = || PATH_COLORS.iter().find(|(light, _)| *light == color).map(|(_, dark)| *dark);
    role.or_else(planner).or_else(path).unwrap_or_else(|| color.with_reversed_lightness())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contrast::contrast;

    #[test]
    fn text_is_legible_on_both_backgrounds() {
        let role = |name: &str| *ROLES.iter().find(|role| role.name == name).expect("a role");
        for name in ["ink", "grey", "accent", "found", "infeasible"] {
            for background in ["paper", "page"] {
                let [text, ground] = [role(name), role(background)];
                for (text, ground) in [(text.light, ground.light), (text.dark, ground.dark)] {
                    assert!(contrast(text, ground) >= 4.5, "{name} on {background}: {}", contrast(text, ground));
                }
            }
        }
    }

    #[test]
    fn surfaces_differ_on_weak_projectors() {
        for (one, other) in
            [("free", "undecided"), ("undecided", "paper"), ("reached", "reached-twice"), ("occupied", "reached-twice")]
        {
            let [one, other] = [one, other].map(|name| *ROLES.iter().find(|role| role.name == name).expect("a role"));
            for (a, b) in [(one.light, other.light), (one.dark, other.dark)] {
                assert!(contrast(a, b) >= 1.6, "{} and {}: {}", one.name, other.name, contrast(a, b));
            }
        }
        // The outline of the arm's poses along the path.
        assert!(contrast(GRAY.lighter(0.3), WHITE) >= 3.0);
    }

    #[test]
    fn colors_without_a_role_keep_their_hue_in_the_dark() {
        assert_eq!(on_dark(WHITE), ROLES[0].dark);
        assert_eq!(on_dark(Rgb(0x80, 0x10, 0x10)), Rgb(0xef, 0x7f, 0x7f));
        let pen = PlannerPen::new(crate::PlannerFamily::Field, 1);
        assert_eq!((on_dark(pen.light()), role_or_hex(pen.light())), (pen.dark(), "field-1".to_owned()));
        assert_eq!(role_or_hex(INK), "ink");
        assert_eq!(role_or_hex(Rgb(1, 2, 3)), "#010203");
    }
}
