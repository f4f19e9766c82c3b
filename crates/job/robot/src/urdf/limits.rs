//! Ranges, top speeds, accelerations and jerks of the joints.

use super::document::Document;
use crate::Spanned;
use crate::error::Diagnostic;
use crate::quantity::{MAX_LENGTH, PerJoint, Written, find};
use crate::settings::RobotSettings;
use cplan_model::space::JointRange;
use cplan_model::{DEFAULT_SLIDING_SPEED, DEFAULT_TURNING_SPEED, MAX_TURN_RANGE, assumed_acceleration};
use std::f64::consts::{PI, TAU};
use urdf_rs::JointType;

/// Longest range of a prismatic joint, in metres. It spans all coordinates that a world may have.
const MAX_SLIDE: f64 = 2.0 * MAX_LENGTH;

/// If both limits of a revolute joint have at least this absolute value, in radians, there is no limit. Simulators write 1e16 for
/// this, and exporters 1e9 or infinity. No valid start is that far out.
const UNLIMITED_TURN: f64 = MAX_LENGTH;

/// Limits of a revolute joint between this value (four turns in radians) and [`MAX_LIMIT_LIKE_DEGREES`] may be degrees.
const MIN_LIMIT_LIKE_DEGREES: f64 = 4.0 * TAU;

/// Two turns in degrees. No joint has a larger range, in radians or in degrees.
const MAX_LIMIT_LIKE_DEGREES: f64 = 720.0;

/// A limit within this distance, in radians, of a multiple of half a turn is rounded to it. It covers the rounding to three
/// decimals.
const HALF_TURN_ROUNDING: f64 = 1e-3;

/// What is known about the range of a joint.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Range {
    Known(JointRange),
    /// A range that differs from that of the file, with a note that explains it.
    Taken(JointRange, String),
    /// No range is known, with the reason.
    Unset(String),
}

/// Top speed, acceleration limit and jerk limit of an arm joint.
pub(super) struct Rates {
    pub velocity: f64,
    pub acceleration: f64,
    pub jerk: Option<f64>,
    /// The assumed limits, which the files lack.
    pub assumed: MissingRates,
}

/// One flag for each limit, true if the limit is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct MissingRates {
    pub velocity: bool,
    pub acceleration: bool,
}

/// Limits of joints, from the URDF and the world file.
pub(super) struct Limits<'a> {
    pub document: &'a Document,
    pub settings: RobotSettings<'a>,
}

impl Limits<'_> {
    /// Returns the range of a movable joint: the world's, or else the URDF's, narrowed by soft limits.
    pub fn range(&self, index: usize) -> Result<Range, Diagnostic> {
        let joint = &self.document.robot.joints[index];
        if let Some(limits) = find(&self.settings.table.limits, &joint.name) {
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
            return Ok(Range::Unset(format!("has no range: lower and upper are both {lower}, which counts as unset")));
        }
        let [lower, upper] = self.softened(index, [lower, upper])?;
        let slides = joint.joint_type == JointType::Prismatic;
        if !slides && lower <= -UNLIMITED_TURN && upper >= UNLIMITED_TURN {
            let note = format!(
                "joint \"{}\": the limits from {lower} to {upper} do not restrict it; it counts as continuous",
                joint.name
            );
            return Ok(Range::Taken(JointRange::Circle, note));
        }
        if slides && upper - lower > MAX_SLIDE {
            let (lower, upper) = (lower.max(-MAX_LENGTH), upper.min(MAX_LENGTH));
            if lower < upper {
                let note = format!("joint \"{}\": its range is cut to {lower:e} to {upper:e} m", joint.name);
                return Ok(Range::Taken(JointRange::Interval { lower, upper }, note));
            }
        }
        if !slides && are_degrees(lower, upper) {
            let turns = ((upper - lower) / TAU).round();
            return Ok(Range::Unset(format!(
                "has limits from {lower} to {upper} rad, which are {turns} turns; probably degrees are meant"
            )));
        }
        if upper - lower > if slides { MAX_SLIDE } else { MAX_TURN_RANGE } {
            return Ok(Range::Unset(format!(
                "has limits from {lower} to {upper}; this range is too long for planning"
            )));
        }
        Ok(Range::Known(JointRange::Interval { lower, upper }))
    }

    /// Returns the range of an arm joint.
    pub fn planned_range(&self, index: usize) -> Result<JointRange, Diagnostic> {
        match self.range(index)? {
            Range::Known(axis) | Range::Taken(axis, _) => Ok(axis),
            Range::Unset(reason) => {
                let joint = &self.document.robot.joints[index];
                let at = self.document.joints[index].limit.as_ref().unwrap_or(&self.document.joints[index].at);
                let (key, joint_type) = (key(&joint.name), &joint.joint_type);
                let mut help = format!("in the world file: [robot] limits = {{ {key} = {} }}", self.example(index));
                match self.degrees(index) {
                    Some([lower, upper]) => {
                        help += &format!("; if radians are meant: {{ {key} = [{lower}, {upper}] }}")
                    }
                    None if *joint_type == JointType::Revolute => {
                        help += ", or make it type=\"continuous\" in the URDF"
                    }
                    None => {}
                }
                Err(self.document.diagnostic_at(at, format!("joint \"{}\" {reason}", joint.name)).help(help))
            }
        }
    }

    /// Returns an example range for the world file, for a joint without a usable one. If the URDF's range looks like degrees, it
    /// is that range in degrees; otherwise it is a placeholder.
    pub fn example(&self, index: usize) -> String {
        match self.degrees(index) {
            Some([lower, upper]) => format!("[\"{lower}deg\", \"{upper}deg\"]"),
            None if self.document.robot.joints[index].joint_type == JointType::Prismatic => "[0.0, 0.5]".into(),
            None => "[-3.1, 3.1]".into(),
        }
    }

    /// Returns the URDF's limits of a revolute joint if they look like degrees.
    fn degrees(&self, index: usize) -> Option<[f64; 2]> {
        let joint = &self.document.robot.joints[index];
        let (lower, upper) = (joint.limit.lower, joint.limit.upper);
        (joint.joint_type == JointType::Revolute && are_degrees(lower, upper)).then_some([lower, upper])
    }

    fn overridden(&self, joint: &urdf_rs::Joint, limits: &Spanned<Vec<Written>>) -> Result<JointRange, Diagnostic> {
        let diagnostic = |message: String| {
            let message = format!("[robot] limits of \"{}\": {message}", joint.name);
            self.settings
                .source
                .diagnostic_at(limits.span(), message)
                .help("limits = { NAME = [lower, upper] }, rad or m")
        };
        let longest = if joint.joint_type == JointType::Prismatic { MAX_SLIDE } else { MAX_TURN_RANGE };
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
                "joint \"{}\": its soft limits [{soft_lower}, {soft_upper}] do not overlap its limits [{lower}, {upper}]",
                joint.name
            );
            let help = format!("in the world file: [robot] limits = {{ {} = [{lower}, {upper}] }}", key(&joint.name));
            return Err(self.document.diagnostic_at(at, message).help(help));
        }
        Ok(narrowed)
    }

    /// Returns top speed, acceleration limit and jerk limit of an arm joint.
    pub fn rates(&self, index: usize) -> Result<Rates, Diagnostic> {
        let joint = &self.document.robot.joints[index];
        let place = &self.document.joints[index];
        let name = &joint.name;
        let mut assumed = MissingRates::default();
        let slides = joint.joint_type == JointType::Prismatic;
        let given = place.limit.is_some().then_some(joint.limit.velocity).filter(|v| *v > 0.0);
        let velocity = self.positive(&self.settings.table.velocity, name, "velocity")?.or(given).unwrap_or_else(|| {
            let default = if slides { DEFAULT_SLIDING_SPEED } else { DEFAULT_TURNING_SPEED };
            assumed.velocity = true;
            default
        });
        let jerk = self.positive(&self.settings.table.jerk, name, "jerk")?;
        let given = place.acceleration.filter(|a| *a > 0.0);
        if let Some(acceleration) = self.positive(&self.settings.table.acceleration, name, "acceleration")?.or(given) {
            return Ok(Rates { velocity, acceleration, jerk, assumed });
        }
        assumed.acceleration = true;
        Ok(Rates { velocity, acceleration: assumed_acceleration(velocity), jerk, assumed })
    }

    fn positive(&self, table: &PerJoint<Spanned<f64>>, name: &str, what: &str) -> Result<Option<f64>, Diagnostic> {
        match find(table, name) {
            None => Ok(None),
            Some(value) if value.get_ref().is_finite() && *value.get_ref() > 0.0 => Ok(Some(*value.get_ref())),
            Some(value) => {
                let message = format!("[robot] {what} of \"{name}\" must be positive, is {}", value.get_ref());
                Err(self
                    .settings
                    .source
                    .diagnostic_at(value.span(), message)
                    .help("give a number above 0, in radians or metres and seconds"))
            }
        }
    }
}

/// Returns true if limits of a revolute joint look like degrees. They must exceed the range of any drive with end stops, be at
/// most two turns in degrees, and not be multiples of half a turn in radians.
fn are_degrees(lower: f64, upper: f64) -> bool {
    let is_half_turns = |limit: f64| ((limit / PI).round() * PI - limit).abs() < HALF_TURN_ROUNDING;
    let farthest = lower.abs().max(upper.abs());
    (MIN_LIMIT_LIKE_DEGREES..=MAX_LIMIT_LIKE_DEGREES).contains(&farthest)
        && !(is_half_turns(lower) && is_half_turns(upper))
}

/// Formats a name as a TOML key.
pub(super) fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { format!("{name:?}") }
}
