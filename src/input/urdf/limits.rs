//! Ranges, top speeds, accelerations and jerks of the joints.

use super::document::Document;
use crate::input::error::Diagnostic;
use crate::input::quantity::Written;
use crate::input::world::{LARGEST, World};
use crate::model::{LONGEST_TURN, SLIDING_SPEED, TIME_TO_TOP_SPEED, TURNING_SPEED, assumed_acceleration};
use crate::space::JointRange;
use toml::Spanned;
use urdf_rs::JointType;

/// Longest range of a joint that slides, metres: beyond the coordinates that a world may have nothing can be hit.
const LONGEST_SLIDE: f64 = 2.0 * LARGEST;

/// Both limits of a revolute joint beyond this many radians are none: simulators write 1e16, exporters 1e9 or infinity. No
/// start that a world may give is so far out.
const UNLIMITED: f64 = LARGEST;

/// What is known of a joint's range.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Range {
    Known(JointRange),
    /// Not as the file has it, with a note.
    Taken(JointRange, String),
    /// No limits, with the reason.
    Unset(String),
}

/// Top speed, acceleration and jerk of a moving joint, and what is to be noted about them.
pub(super) struct Rates {
    pub velocity: f64,
    pub acceleration: f64,
    pub jerk: Option<f64>,
    /// What was assumed for want of limits.
    pub assumed: Assumed,
    pub notes: Vec<String>,
}

/// Which rates nobody gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Assumed {
    pub velocity: bool,
    pub acceleration: bool,
}

/// Limits of joints as the URDF and the world file have them.
pub(super) struct Limits<'a> {
    pub document: &'a Document,
    pub world: &'a World,
}

impl Limits<'_> {
    /// The range of a movable joint: the world's, else the URDF's narrowed by its soft limits.
    pub fn range(&self, index: usize) -> Result<Range, Diagnostic> {
        let joint = &self.document.robot.joints[index];
        if let Some(limits) = find(&self.world.robot.limits, &joint.name) {
            return self.overridden(joint, limits).map(Range::Known);
        }
        if joint.joint_type == JointType::Continuous {
            return Ok(Range::Known(JointRange::Circle));
        }
        if self.document.joints[index].limit.is_none() {
            return Ok(Range::Unset("has no <limit>".into()));
        }
        let (lower, upper) = (joint.limit.lower, joint.limit.upper);
        if lower == upper {
            return Ok(Range::Unset(format!("has no range: lower and upper are both {lower}, which means unset")));
        }
        let [lower, upper] = self.softened(index, [lower, upper])?;
        let slides = joint.joint_type == JointType::Prismatic;
        if !slides && lower <= -UNLIMITED && upper >= UNLIMITED {
            let note =
                format!("joint \"{}\": limits from {lower} to {upper} are none; taken as continuous", joint.name);
            return Ok(Range::Taken(JointRange::Circle, note));
        }
        if slides && upper - lower > LONGEST_SLIDE {
            let (lower, upper) = (lower.max(-LARGEST), upper.min(LARGEST));
            if lower < upper {
                let note = format!("joint \"{}\": its range is taken as {lower:e} to {upper:e} m", joint.name);
                return Ok(Range::Taken(JointRange::Interval { lower, upper }, note));
            }
        }
        if upper - lower > if slides { LONGEST_SLIDE } else { LONGEST_TURN } {
            return Ok(Range::Unset(format!("has limits from {lower} to {upper}, a range too long to plan in")));
        }
        Ok(Range::Known(JointRange::Interval { lower, upper }))
    }

    /// The range of a joint that is to be planned for.
    pub fn planned_range(&self, index: usize) -> Result<JointRange, Diagnostic> {
        match self.range(index)? {
            Range::Known(axis) | Range::Taken(axis, _) => Ok(axis),
            Range::Unset(reason) => {
                let joint = &self.document.robot.joints[index];
                let example = if joint.joint_type == JointType::Prismatic { "[0.0, 0.5]" } else { "[-3.1, 3.1]" };
                let at = self.document.joints[index].limit.as_ref().unwrap_or(&self.document.joints[index].at);
                let mut help = format!("in the world file: [robot] limits = {{ {} = {example} }}", key(&joint.name));
                if joint.joint_type == JointType::Revolute {
                    help += ", or make it type=\"continuous\" in the URDF";
                }
                Err(self.document.diagnostic_at(at, format!("joint \"{}\" {reason}", joint.name)).help(help))
            }
        }
    }

    fn overridden(&self, joint: &urdf_rs::Joint, limits: &Spanned<Vec<Written>>) -> Result<JointRange, Diagnostic> {
        let diagnostic = |message: String| {
            let message = format!("[robot] limits of \"{}\": {message}", joint.name);
            self.world.source.diagnostic_at(limits.span(), message).help("limits = { NAME = [lower, upper] }, rad or m")
        };
        let longest = if joint.joint_type == JointType::Prismatic { LONGEST_SLIDE } else { LONGEST_TURN };
        let numbers: Vec<f64> = limits.get_ref().iter().map(|n| n.get_ref().value).collect();
        if joint.joint_type == JointType::Prismatic && limits.get_ref().iter().any(|n| n.get_ref().in_degrees) {
            return Err(diagnostic("the joint slides: its limits cannot be in degrees".into()));
        }
        let [lower, upper] = numbers[..] else {
            return Err(diagnostic(format!("expected [lower, upper], found {} numbers", numbers.len())));
        };
        if !(lower.is_finite() && upper.is_finite()) {
            return Err(diagnostic("they must be finite".into()));
        }
        if lower >= upper {
            return Err(diagnostic(format!("lower ({lower}) must be below upper ({upper})")));
        }
        if upper - lower > longest {
            return Err(diagnostic(format!("the range is longer than {longest}"))
                .help("a joint that turns without end is of type continuous in the URDF"));
        }
        Ok(JointRange::Interval { lower, upper })
    }

    fn softened(&self, index: usize, [lower, upper]: [f64; 2]) -> Result<[f64; 2], Diagnostic> {
        let joint = &self.document.robot.joints[index];
        let (Some(at), Some(soft)) = (&self.document.joints[index].soft_limits, &joint.safety_controller) else {
            return Ok([lower, upper]);
        };
        let (soft_lower, soft_upper) = (soft.soft_lower_limit, soft.soft_upper_limit);
        let narrowed = [lower.max(soft_lower), upper.min(soft_upper)];
        if narrowed[0] >= narrowed[1] {
            let message = format!(
                "joint \"{}\": its soft limits [{soft_lower}, {soft_upper}] leave nothing of its limits [{lower}, {upper}]",
                joint.name
            );
            let help = format!("in the world file: [robot] limits = {{ {} = [{lower}, {upper}] }}", key(&joint.name));
            return Err(self.document.diagnostic_at(at, message).help(help));
        }
        Ok(narrowed)
    }

    /// Top speed, acceleration and jerk of a joint that is to be planned for.
    pub fn rates(&self, index: usize) -> Result<Rates, Diagnostic> {
        let joint = &self.document.robot.joints[index];
        let place = &self.document.joints[index];
        let name = &joint.name;
        let mut notes = Vec::new();
        let mut assumed = Assumed::default();
        let slides = joint.joint_type == JointType::Prismatic;
        let unit = if slides { "m" } else { "rad" };
        let given = place.limit.is_some().then_some(joint.limit.velocity).filter(|v| *v > 0.0);
        let velocity = self.positive(&self.world.robot.velocity, name, "velocity")?.or(given).unwrap_or_else(|| {
            let default = if slides { SLIDING_SPEED } else { TURNING_SPEED };
            assumed.velocity = true;
            notes.push(format!(
                "joint \"{name}\": no top speed given; assumed {default} {unit}/s, for the timing alone"
            ));
            default
        });
        let jerk = self.positive(&self.world.robot.jerk, name, "jerk")?;
        let given = place.acceleration.filter(|a| *a > 0.0);
        if let Some(acceleration) = self.positive(&self.world.robot.acceleration, name, "acceleration")?.or(given) {
            return Ok(Rates { velocity, acceleration, jerk, assumed, notes });
        }
        let acceleration = assumed_acceleration(velocity);
        assumed.acceleration = true;
        notes.push(format!(
            "joint \"{name}\": no acceleration limit given; taken as {acceleration:.3} {unit}/s^2 (top speed in {TIME_TO_TOP_SPEED} s)"
        ));
        Ok(Rates { velocity, acceleration, jerk, assumed, notes })
    }

    fn positive(
        &self,
        table: &crate::input::world::PerJoint<Spanned<f64>>,
        name: &str,
        what: &str,
    ) -> Result<Option<f64>, Diagnostic> {
        match find(table, name) {
            None => Ok(None),
            Some(value) if value.get_ref().is_finite() && *value.get_ref() > 0.0 => Ok(Some(*value.get_ref())),
            Some(value) => {
                let message = format!("[robot] {what} of \"{name}\" must be positive, is {}", value.get_ref());
                Err(self
                    .world
                    .source
                    .diagnostic_at(value.span(), message)
                    .help("limits are magnitudes, in radians or metres and seconds"))
            }
        }
    }
}

/// A joint's entry in one of the world's tables.
pub(super) fn find<'a, T>(table: &'a crate::input::world::PerJoint<T>, name: &str) -> Option<&'a T> {
    table.iter().find(|(k, _)| k.get_ref() == name).map(|(_, v)| v)
}

/// A name as a TOML key.
pub(super) fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { format!("{name:?}") }
}
