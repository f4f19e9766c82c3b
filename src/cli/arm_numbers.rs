//! The numbers of an arm that `cplan init` writes: its URDF, and its size in comparison with the template's arm.

use super::init::Kind;

/// The numbers of an arm. Lengths are in metres, angles in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmNumbers {
    /// Lengths of both links. The second one is 0 if the second joint slides; both are 0 for a gantry.
    pub links: [f64; 2],
    /// Travel of the quill. 0 without one.
    pub stroke: f64,
    /// Lower limits of the joints: negative if the joint turns, 0 if it slides.
    pub lower: [f64; 2],
    /// Upper limits of the joints.
    pub limits: [f64; 2],
    /// Top speeds.
    pub speeds: [f64; 2],
    /// Mounting of the motors.
    pub drives: Option<&'static str>,
}

impl ArmNumbers {
    /// Returns the numbers of the template's arm.
    pub fn of(kind: Kind) -> Self {
        let [links, limits, speeds] = match kind {
            Kind::Rr => [[0.5, 0.43], [2.9, 2.8], [2.0, 3.0]],
            Kind::Rp => [[0.45, 0.0], [2.9, 0.6], [1.5, 0.8]],
            Kind::Pr => [[0.0, 0.0], [0.8, 2.9], [1.0, 2.0]],
            Kind::Pp => [[0.0, 0.0], [1.2, 0.9], [1.0, 1.0]],
            Kind::Scara | Kind::Arch | Kind::Cell => [[0.3, 0.25], [2.4435, 2.618], [7.243, 11.502]],
        };
        let stroke = if matches!(kind, Kind::Scara | Kind::Arch | Kind::Cell) { 0.18 } else { 0.0 };
        let lower = [0, 1].map(|k| if kind.turns()[k] { -limits[k] } else { 0.0 });
        Self { links, stroke, lower, limits, speeds, drives: None }
    }

    /// Returns the lower and the upper limit of each joint, as multiples of those of the template's arm.
    pub fn limit_ratios(&self, kind: Kind) -> [[f64; 2]; 2] {
        let usual = Self::of(kind);
        [0, 1].map(|k| {
            let lower = if usual.lower[k] < 0.0 { self.lower[k] / usual.lower[k] } else { 1.0 };
            [lower, self.limits[k] / usual.limits[k]]
        })
    }

    /// Returns the sizes of the arm along x and along y, as multiples of those of the template's arm.
    pub fn scale(&self, kind: Kind) -> [f64; 2] {
        let usual = Self::of(kind);
        match kind {
            Kind::Pp | Kind::Pr => [0, 1].map(|k| self.limits[k] / usual.limits[k]),
            Kind::Rp => [(self.links[0] + self.limits[1]) / (usual.links[0] + usual.limits[1]); 2],
            // The template's world suits an arm with two revolute joints.
            Kind::Rr | Kind::Scara | Kind::Arch | Kind::Cell => {
                let [a, b] = Self::of(Kind::Rr).links;
                [(self.links[0] + self.links[1]) / (a + b); 2]
            }
        }
    }

    /// Returns the URDF: a template with these numbers. The lengths determine the widths of the bodies.
    pub fn urdf(&self, kind: Kind) -> String {
        let template = match kind {
            Kind::Rr => include_str!("starter/rr.urdf"),
            Kind::Rp => include_str!("starter/rp.urdf"),
            Kind::Pr => include_str!("starter/pr.urdf"),
            Kind::Pp => include_str!("starter/pp.urdf"),
            Kind::Scara | Kind::Arch | Kind::Cell => include_str!("starter/scara.urdf"),
        };
        let Self { links: [a, b], stroke, lower, limits, speeds, .. } = *self;
        let usual = Self::of(kind);
        let (widths, spans, heights) = match kind {
            Kind::Rr => {
                let s = self.scale(kind)[0];
                ([0.1 * s, 0.08 * s], [[-0.05 * s, a + 0.05 * s], [-0.03 * s, b]], [0.0; 2])
            }
            Kind::Rp => {
                let s = a / usual.links[0];
                ([0.14 * s, 0.06 * s], [[-0.1 * s, 0.3 * s], [-0.05 * s, a]], [0.1 * s, 0.08 * s])
            }
            Kind::Pp | Kind::Pr => {
                let s = limits[1] / usual.limits[1];
                ([0.08 * s, 0.1 * s], [[-0.1 * s, limits[1] + 0.1 * s], [0.0; 2]], [0.0; 2])
            }
            Kind::Scara | Kind::Arch | Kind::Cell => {
                let s = ((a + b) / (usual.links[0] + usual.links[1])).min(1.5);
                let widest = 0.8 * a.min(b);
                ([0.11 * s, 0.1 * s].map(|width| width.min(widest)), [[0.0, a], [0.0, b]], [0.0; 2])
            }
        };
        let marks = [
            ("link1", a),
            ("link2", b),
            ("lower1", lower[0]),
            ("lower2", lower[1]),
            ("limit1", limits[0]),
            ("limit2", limits[1]),
            ("speed1", speeds[0]),
            ("speed2", speeds[1]),
            ("middle1", f64::midpoint(spans[0][0], spans[0][1])),
            ("middle2", f64::midpoint(spans[1][0], spans[1][1])),
            ("size1", spans[0][1] - spans[0][0]),
            ("size2", spans[1][1] - spans[1][0]),
            ("width1", widths[0]),
            ("width2", widths[1]),
            ("radius1", widths[0] / 2.0),
            ("radius2", widths[1] / 2.0),
            ("height1", heights[0]),
            ("above2", heights[1]),
            ("stroke", stroke),
            ("base_height", 0.95 * stroke),
            ("base_middle", 0.475 * stroke),
            ("axis_1_height", stroke + 0.015),
            ("quill_length", stroke + 0.04),
            ("quill_middle", stroke / 2.0 + 0.02),
        ];
        marks.iter().fold(template.to_owned(), |text, (mark, value)| {
            text.replace(&format!("{{{{{mark}}}}}"), &format!("{:?}", rounded(*value)))
        })
    }

    /// Describes the arm in a line.
    pub fn words(&self, kind: Kind) -> String {
        let turns = kind.turns();
        let links: Vec<String> =
            self.links.iter().filter(|length| **length > 0.0).map(|length| rounded(*length).to_string()).collect();
        let links = if links.is_empty() { String::new() } else { format!("links {} m, ", links.join(" and ")) };
        let range = |k: usize| match turns[k] {
            true => {
                let [lower, upper] = [self.lower, self.limits].map(|limit| rounded(limit[k].to_degrees()));
                format!("{lower} to {upper} deg")
            }
            false => format!("0 to {} m", rounded(self.limits[k])),
        };
        let speed = |k: usize| match turns[k] {
            true => format!("{} deg/s", rounded(self.speeds[k].to_degrees())),
            false => format!("{} m/s", rounded(self.speeds[k])),
        };
        let stroke = if self.stroke > 0.0 { format!(", stroke {} m", rounded(self.stroke)) } else { String::new() };
        format!("{links}ranges {} and {}, top speeds {} and {}{stroke}", range(0), range(1), speed(0), speed(1))
    }
}

/// Rounds to a micrometre or a microradian, as in files that people read.
pub fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Returns a text in which the numbers are multiplied by the factors in turn. The first factor of a pair is for
/// negative numbers.
pub fn scaled(text: &str, factors: &[[f64; 2]]) -> String {
    let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let (mut out, mut rest, mut count) = (String::new(), text, 0);
    while let Some(begin) = rest.find(is_number) {
        let end = rest[begin..].find(|c| !is_number(c)).map_or(rest.len(), |length| begin + length);
        out.push_str(&rest[..begin]);
        match rest[begin..end].parse::<f64>() {
            Ok(number) => {
                let factor = factors[count % factors.len()][usize::from(number >= 0.0)];
                out.push_str(&format!("{:?}", rounded(number * factor)));
                count += 1;
            }
            Err(_) => out.push_str(&rest[begin..end]),
        }
        rest = &rest[end..];
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_text_are_scaled_in_turn() {
        assert_eq!(scaled("[[0.6, -0.1], [1, 2.0]]", &[[2.0; 2], [10.0; 2]]), "[[1.2, -1.0], [2.0, 20.0]]");
        assert_eq!(scaled("[-2.0, 2.0]", &[[0.5, 3.0]]), "[-1.0, 6.0]");
        assert_eq!(
            scaled("{ center = [0.1, -0.7], radius = 0.05 }", &[[0.5; 2]]),
            "{ center = [0.05, -0.35], radius = 0.025 }"
        );
        assert_eq!(scaled("none", &[[2.0; 2]]), "none");
    }
}
