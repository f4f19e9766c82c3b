//! The tool's angle along a line, on the command line and in words.

use super::FollowArgs;
use crate::cli::failure::Failure;
use crate::cli::values::turn;
use crate::input::LoadedScene;
use crate::motion::{JointMotion, Trajectory};
use crate::options::number_in;
use crate::text::short;
use cplan_follow::WristAlong;
use cplan_handling::{
    DEFAULT_WRIST_TOLERANCE, Driver, FollowedLine, MAX_WRIST_TOLERANCE, MIN_WRIST_TOLERANCE, RobotJoint, RobotJoints,
    ToolAngle, WristGuide,
};
use serde_json::{Value, json};

/// The wrist for a line, with the name of its joint.
pub struct FollowingWrist {
    pub along: WristAlong,
    pub joint: String,
    /// A note about assumed limits of the wrist, if there are any.
    pub note: Option<String>,
}

/// Parses the angle of a tool: an angle, or `tangent` with an angle to add.
pub fn tool_angle(text: &str) -> Result<ToolAngle, String> {
    let Some(offset) = text.strip_prefix("tangent") else {
        return turn(text)
            .map(ToolAngle::Fixed)
            .map_err(|_| "must be an angle such as 0.5 or 30deg, tangent, or tangent+0.5".into());
    };
    if offset.is_empty() {
        return Ok(ToolAngle::Tangent(0.0));
    }
    let signed = offset.starts_with(['+', '-']).then(|| turn(offset.trim_start_matches('+')).ok()).flatten();
    signed.map(ToolAngle::Tangent).ok_or_else(|| "after tangent, give a signed angle, such as tangent+90deg".into())
}

/// Parses the tolerance of a tool's angle, radians.
pub fn tool_tolerance(text: &str) -> Result<f64, String> {
    let range = format!("of radians from {MIN_WRIST_TOLERANCE} to {MAX_WRIST_TOLERANCE}");
    number_in(text, |x| (MIN_WRIST_TOLERANCE..=MAX_WRIST_TOLERANCE).contains(&x), &range)
}

/// Returns the requirement on the tool's angle, from the arguments or else from the line.
///
/// # Errors
/// A tolerance without an angle.
pub fn guide(args: &FollowArgs, line: Option<WristGuide>) -> Result<Option<WristGuide>, Failure> {
    let own = |angle: ToolAngle| WristGuide { angle, tolerance: DEFAULT_WRIST_TOLERANCE };
    let angle = args.wrist.map(|angle| line.map_or(own(angle), |line| WristGuide { angle, ..line }));
    match (angle.or(line), args.wrist_tolerance) {
        (None, Some(_)) => {
            Err(Failure::Usage("--wrist-tolerance needs an angle of the tool, by --wrist or in the line's file".into()))
        }
        (guide, None) => Ok(guide),
        (guide, Some(tolerance)) => Ok(guide.map(|guide| WristGuide { tolerance, ..guide })),
    }
}

impl FollowingWrist {
    /// Returns the wrist for a line that requires an angle of the tool. `None` for other lines.
    ///
    /// # Errors
    /// A world that does not name the wrist's joint.
    pub fn new(line: &FollowedLine, loaded: &LoadedScene) -> Result<Option<Self>, Failure> {
        let Some(guide) = line.wrist else { return Ok(None) };
        let (wrist, joint, note) = loaded.wrist_for_line()?;
        let along = wrist.joint.map(|joint| {
            let (velocity, acceleration) = (wrist.velocity, wrist.acceleration);
            WristAlong { guide, joint, velocity, acceleration }
        });
        Ok(along.map(|along| Self { along, joint: joint.to_owned(), note: note.map(str::to_owned) }))
    }

    /// Returns the motion of the two planned joints and the wrist.
    pub fn motion(&self, planned: &[String; 2], trajectory: &Trajectory) -> JointMotion {
        let wrist = RobotJoint::driven(self.joint.clone(), Driver::Wrist);
        let mut robot = RobotJoints::only_planned(planned);
        robot.joints.push(wrist);
        JointMotion::new(&robot, trajectory, false)
    }

    /// Describes the tool's angle along a motion, with a proven bound on the difference from it.
    pub fn fact(&self, deviation: f64) -> String {
        let kept = match self.along.guide.angle {
            ToolAngle::Fixed(angle) => format!("keeps the tool at {} rad", short(angle)),
            ToolAngle::Tangent(0.0) => "turns the tool along the line".into(),
            ToolAngle::Tangent(offset) => format!("keeps the tool at {} rad to the line", short(offset)),
        };
        format!("joint \"{}\" {kept}, within {} rad", self.joint, upwards(deviation))
    }

    /// Returns the wrist as JSON, with the proven bound of a motion.
    pub fn to_json(&self, deviation: Option<f64>) -> Value {
        let (name, angle) = match self.along.guide.angle {
            ToolAngle::Fixed(angle) => ("angle", angle),
            ToolAngle::Tangent(offset) => ("tangent", offset),
        };
        json!({ "joint": self.joint, name: angle, "tolerance": self.along.guide.tolerance, "deviation": deviation })
    }
}

/// Formats a bound on an angle, rounded up to the fourth decimal.
fn upwards(angle: f64) -> f64 {
    short((angle * 1e4).ceil() / 1e4)
}
