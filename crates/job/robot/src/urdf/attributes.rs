//! Checks of single URDF elements and attributes, with their positions.

use super::document::{escape_attribute, tag};
use crate::error::Diagnostic;
use crate::quantity::MAX_LENGTH;
use crate::source::Source;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// Numeric attributes of links, joints and their elements, except those in [`UNLIMITED_ATTRIBUTES`].
const NUMERIC_ATTRIBUTES: [&str; 22] = [
    "xyz",
    "rpy",
    "quat_xyzw",
    "size",
    "radius",
    "length",
    "scale",
    "multiplier",
    "offset",
    "k_position",
    "k_velocity",
    "damping",
    "friction",
    "rising",
    "falling",
    "value",
    "ixx",
    "ixy",
    "ixz",
    "iyy",
    "iyz",
    "izz",
];

/// Numeric attributes in which an infinity means that there is no limit.
const UNLIMITED_ATTRIBUTES: [&str; 9] = [
    "lower",
    "upper",
    "effort",
    "velocity",
    "acceleration",
    "deceleration",
    "jerk",
    "soft_lower_limit",
    "soft_upper_limit",
];

const JOINT_TYPES: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];

/// Reads attributes of a link or joint and collects their defects.
pub(super) struct Attributes<'a> {
    pub source: &'a Source,
    pub diagnostics: &'a mut Vec<Diagnostic>,
    /// Name of the link or joint. Every message begins with it.
    pub what: &'a str,
}

/// Iterates over the child elements with a name, in the parent's namespace.
pub(super) fn children<'a, 'i>(node: Node<'a, 'i>, name: &'a str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |n| {
        n.is_element() && n.tag_name().name() == name && n.tag_name().namespace() == node.tag_name().namespace()
    })
}

/// Returns roll, pitch and yaw of a quaternion (x, y, z, w) of any length. `None` if its length is zero. The angles are extracted
/// one after the other, so that they reproduce the rotation even if the pitch is a right angle and the other two angles turn
/// about the same axis. (There, `urdf-rs` is wrong by up to 5e-3.)
fn roll_pitch_yaw(quaternion: &[f64]) -> Option<[f64; 3]> {
    let &[x, y, z, w] = quaternion else { return None };
    let quaternion = Quaternion::new(w, x, y, z);
    let unit = (1e-9..1e9).contains(&quaternion.norm()).then(|| UnitQuaternion::new_normalize(quaternion))?;
    let turn = unit.to_rotation_matrix();
    let yaw = turn[(1, 0)].atan2(turn[(0, 0)]);
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), -yaw) * turn;
    let pitch = (-turn[(2, 0)]).atan2(turn[(0, 0)]);
    let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), -pitch) * turn;
    Some([turn[(2, 1)].atan2(turn[(1, 1)]), pitch, yaw])
}

impl Attributes<'_> {
    fn diagnostic(&mut self, node: Node, attribute: Option<&str>, message: String, help: &str) {
        let place = attribute.and_then(|a| node.attribute_node(a)).map_or_else(|| tag(node), |a| a.range());
        let diagnostic = self.source.diagnostic_at(place, format!("{}: {message}", self.what));
        self.diagnostics.push(diagnostic.help(help));
    }

    /// Refuses NaN in all numeric attributes below `node`, used or not, because the file was not written correctly. Also refuses
    /// infinities, unless they mean that there is no limit.
    pub fn finite_everywhere(&mut self, node: Node) {
        for element in node.descendants().filter(Node::is_element) {
            for attribute in element.attributes() {
                let may_be_infinite = UNLIMITED_ATTRIBUTES.contains(&attribute.name());
                if !may_be_infinite && !NUMERIC_ATTRIBUTES.contains(&attribute.name()) {
                    continue;
                }
                let bad =
                    |word: &&str| word.parse::<f64>().is_ok_and(|x| x.is_nan() || x.is_infinite() && !may_be_infinite);
                if let Some(word) = attribute.value().split_whitespace().find(bad) {
                    let message = format!("{word} in {}=\"{}\" is not finite", attribute.name(), attribute.value());
                    let help = "write a finite number; a joint without limits is of type continuous";
                    self.diagnostic(element, Some(attribute.name()), message, help);
                }
            }
        }
    }

    /// Returns the only child element with a name. `None` if it is invalid, or optional and absent.
    pub fn only<'a, 'i>(&mut self, node: Node<'a, 'i>, name: &'a str, required: bool) -> Option<Node<'a, 'i>> {
        let mut found = children(node, name);
        let first = found.next();
        if let Some(second) = found.next() {
            self.diagnostic(second, None, format!("a second <{name}>"), "remove one of them");
        }
        if first.is_none() && required {
            self.diagnostic(node, None, format!("<{name}> is missing"), &format!("add a <{name}>"));
        }
        first
    }

    /// Returns the text of a required attribute.
    pub fn text<'a>(&mut self, node: Node<'a, '_>, name: &str) -> Option<&'a str> {
        let value = node.attribute(name).filter(|v| !v.trim().is_empty());
        if value.is_none() {
            let message = format!("<{}> needs the attribute {name}", node.tag_name().name());
            self.diagnostic(node, None, message, &format!("add {name}=\"...\""));
        }
        value
    }

    /// Returns the `count` numbers of an attribute. `None` if it is absent or invalid. Another check reports numbers that are not
    /// finite.
    fn numbers(&mut self, node: Node, name: &str, count: usize) -> Option<Vec<f64>> {
        let text = node.attribute(name)?;
        let values: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
        match values {
            Ok(values) if values.len() == count => {
                let is_length = ["xyz", "size", "radius", "length"].contains(&name);
                if let Some(value) = values.iter().find(|x| is_length && x.is_finite() && x.abs() > MAX_LENGTH) {
                    let message = format!("{value:e} in {name}=\"{text}\" is too large (at most {MAX_LENGTH:e})");
                    let help = format!(
                        "lengths are in metres, from -{MAX_LENGTH:e} to {MAX_LENGTH:e}; divide lengths in millimetres by 1000"
                    );
                    self.diagnostic(node, Some(name), message, &help);
                    return None;
                }
                values.iter().all(|x| x.is_finite()).then_some(values)
            }
            Ok(values) => {
                let message = format!("{name}=\"{text}\" has {} numbers, not {count}", values.len());
                self.diagnostic(node, Some(name), message, "separate numbers by blanks, as in \"0.5 0 0\"");
                None
            }
            Err(_) => {
                let noun = if count == 1 { "a number".to_owned() } else { format!("{count} numbers") };
                self.diagnostic(
                    node,
                    Some(name),
                    format!("{name}=\"{text}\" is not {noun}"),
                    "write numbers, such as 0.5 or -1e-3",
                );
                None
            }
        }
    }

    /// Returns the number of an attribute. `None` if it is absent or invalid.
    pub fn number(&mut self, node: Node, name: &str) -> Option<f64> {
        self.numbers(node, name, 1).map(|v| v[0])
    }

    /// Returns the text of `<origin>` for the copy of the document; empty if the element is missing.
    pub fn origin(&mut self, node: Node) -> String {
        let Some(origin) = self.only(node, "origin", false) else { return String::new() };
        let mut copy = "<origin".to_owned();
        for name in ["xyz", "rpy"] {
            if self.numbers(origin, name, 3).is_some() {
                copy += &format!(" {name}=\"{}\"", escape_attribute(origin.attribute(name).unwrap_or("")));
            }
        }
        if let Some(quaternion) = self.numbers(origin, "quat_xyzw", 4) {
            match roll_pitch_yaw(&quaternion) {
                Some([roll, pitch, yaw]) => copy += &format!(" rpy=\"{roll:?} {pitch:?} {yaw:?}\""),
                None => {
                    let message = "the quaternion is zero or too large".to_owned();
                    self.diagnostic(origin, Some("quat_xyzw"), message, "write 0 0 0 1 for no rotation");
                }
            }
        }
        if origin.has_attribute("rpy") && origin.has_attribute("quat_xyzw") {
            self.diagnostic(
                origin,
                Some("quat_xyzw"),
                "the origin has both rpy and quat_xyzw".into(),
                "keep one of them",
            );
        }
        copy + "/>"
    }

    /// Returns true if an axis is valid: three numbers, not all zero.
    pub fn direction(&mut self, axis: Node) -> bool {
        let Some(xyz) = self.numbers(axis, "xyz", 3) else {
            if !axis.has_attribute("xyz") {
                self.diagnostic(
                    axis,
                    None,
                    "the <axis> has no xyz".into(),
                    "write an axis, such as <axis xyz=\"0 0 1\"/>",
                );
            }
            return false;
        };
        let length = xyz.iter().fold(0.0, |l, x| f64::hypot(l, *x));
        // A shorter axis has too few significant digits to define a direction.
        if length < 1e-9 {
            let help = "give the axis a direction, such as xyz=\"0 0 1\"; a joint that does not move is of type fixed";
            self.diagnostic(
                axis,
                Some("xyz"),
                format!("the axis ({}) is zero", axis.attribute("xyz").unwrap_or("")),
                help,
            );
            return false;
        }
        true
    }

    /// Returns the type of a joint.
    pub fn joint_type<'a>(&mut self, joint: Node<'a, '_>) -> Option<&'a str> {
        let kind = self.text(joint, "type")?;
        if JOINT_TYPES.contains(&kind) {
            return Some(kind);
        }
        let help = format!("one of {}", JOINT_TYPES.join(", "));
        self.diagnostic(joint, Some("type"), format!("type \"{kind}\" is unknown"), &help);
        None
    }

    /// Returns lower, upper, velocity and acceleration of a `<limit>`. `absent` has the defaults of lower and upper. If `ranged`,
    /// lower must not exceed upper: an excess is reported, and both are swapped so that further checks work. Other joint types
    /// ignore both.
    pub fn limit(&mut self, limit: Node, absent: [f64; 2], ranged: bool) -> [Option<f64>; 4] {
        let mut values = ["lower", "upper", "velocity", "acceleration"].map(|name| self.number(limit, name));
        for (value, name) in values.iter_mut().zip(["lower", "upper"]) {
            let infinite =
                limit.attribute(name).and_then(|text| text.trim().parse::<f64>().ok()).filter(|x| x.is_infinite());
            *value = value.or(infinite);
        }
        let [lower, upper] = [0, 1].map(|k| values[k].unwrap_or(absent[k]));
        if ranged && lower > upper {
            let missing = ["lower", "upper"].into_iter().zip(values).find(|(_, value)| value.is_none());
            let message = format!("the limits are reversed: lower {lower} is above upper {upper}");
            match missing {
                None => self.diagnostic(limit, Some("lower"), message, "swap lower and upper"),
                Some((name, _)) => {
                    let message = format!("{message} (no {name} is given)");
                    self.diagnostic(limit, None, message, &format!("give {name} as well"));
                }
            }
            values[..2].copy_from_slice(&[Some(upper), Some(lower)]);
        }
        for (name, value) in [("velocity", values[2]), ("acceleration", values[3])] {
            if value.is_some_and(|v| v < 0.0) {
                self.diagnostic(limit, Some(name), format!("the {name} limit is negative"), "limits are magnitudes");
            }
        }
        values
    }

    /// Returns the soft limits, which are 0 if they are missing. Returns `None` if both are 0: exporters write 0 for missing
    /// limits.
    pub fn soft_limits(&mut self, safety: Node) -> Option<[f64; 2]> {
        let [lower, upper] = ["soft_lower_limit", "soft_upper_limit"].map(|name| self.number(safety, name));
        let [lower, upper] = [lower, upper].map(|limit| limit.unwrap_or(0.0));
        if lower > upper {
            let message = format!("the soft limits are reversed: {lower} is above {upper}");
            self.diagnostic(safety, Some("soft_lower_limit"), message, "swap soft_lower_limit and soft_upper_limit");
        }
        (lower != 0.0 || upper != 0.0).then_some([lower.min(upper), lower.max(upper)])
    }

    /// Returns the shape in a `<geometry>`. Its sizes must be positive, or all zero, as exporters write for a missing shape.
    pub fn geometry<'a, 'i>(&mut self, geometry: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
        let mut shapes = geometry.children().filter(Node::is_element);
        let (first, second) = (shapes.next(), shapes.next());
        if let Some(second) = second {
            let message = "the <geometry> has a second shape".into();
            self.diagnostic(second, None, message, "put each shape into its own <collision>");
        }
        let Some(shape) = first else {
            self.diagnostic(
                geometry,
                None,
                "the <geometry> is empty".into(),
                "put a box, cylinder, sphere, capsule or mesh into it",
            );
            return None;
        };
        let sizes: &[(&str, usize)] = match shape.tag_name().name() {
            "box" => &[("size", 3)],
            "cylinder" | "capsule" => &[("radius", 1), ("length", 1)],
            "sphere" => &[("radius", 1)],
            "mesh" => {
                self.text(shape, "filename")?;
                if let Some(scale) = self.numbers(shape, "scale", 3)
                    && scale.contains(&0.0)
                {
                    self.diagnostic(
                        shape,
                        Some("scale"),
                        "a scale of 0 flattens the mesh".into(),
                        "use scale=\"1 1 1\" for the original size",
                    );
                }
                return Some(shape);
            }
            other => {
                let help = "box, cylinder, sphere, capsule or mesh";
                self.diagnostic(shape, None, format!("the shape <{other}> is unknown"), help);
                return None;
            }
        };
        let mut values = Vec::new();
        for (name, count) in sizes {
            self.text(shape, name)?;
            values.extend(self.numbers(shape, name, *count)?);
        }
        let all_zero = values.iter().all(|v| *v == 0.0);
        if !all_zero && values.iter().any(|v| *v <= 0.0) {
            let message = format!("the sizes of the {} must be positive", shape.tag_name().name());
            self.diagnostic(shape, Some(sizes[0].0), message, "give lengths in metres that are above 0");
        }
        Some(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the angles reproduce the rotation, also with a pitch at or near a right angle.
    #[test]
    fn angles_of_quaternions() {
        let half = std::f64::consts::FRAC_PI_2;
        for pitch in [0.3, half, -half, half - 1e-3, half - 1e-7, 1e-9 - half, 2.0] {
            for (roll, yaw) in [(0.0, 0.0), (0.4, -2.0), (-3.0, 1.0)] {
                let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
                let [x, y, z, w] = turn.coords.map(|c| 3.0 * c).into();
                let [r, p, y] = roll_pitch_yaw(&[x, y, z, w]).unwrap();
                let off = UnitQuaternion::from_euler_angles(r, p, y).angle_to(&turn);
                assert!(off < 1e-7, "{roll} {pitch} {yaw}: {off}");
                let apart = UnitQuaternion::from_euler_angles(r, p, y).to_rotation_matrix().matrix()
                    - turn.to_rotation_matrix().matrix();
                assert!(apart.abs().max() < 1e-14, "{roll} {pitch} {yaw}: {apart}");
            }
        }
        for none in [[0.0; 4], [0.0, 0.0, 1e-20, 1e-20], [0.0, 0.0, 1e200, 1e200]] {
            assert_eq!(roll_pitch_yaw(&none), None);
        }
    }
}
