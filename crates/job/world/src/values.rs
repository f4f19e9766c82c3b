//! Joint values and points given on the command line.

use super::LoadedScene;
use super::reasons::{Notation, hint_for_degrees};
use cplan_dynamics::keep_efforts;
use cplan_geometry::Point;
use cplan_model::space::Configuration;
use cplan_model::{Elbow, Goal, Joint, Scene, SceneError, check_clearance};
use cplan_robot::{CalibrationTable, Diagnostic, InputError, MAX_LENGTH};
use cplan_text::metres;
use std::fmt;
use std::str::FromStr;

/// Values on the command line that override the world file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overrides {
    /// The value of `--start`.
    pub start: Option<JointValues>,
    /// The value of `--goal`. It excludes `goal_tip`.
    pub goal: Option<JointValues>,
    /// The value of `--goal-tip`, in plane coordinates, in metres.
    pub goal_tip: Option<TipPoint>,
    /// The value of `--elbow`. It needs `goal_tip`.
    pub elbow: Option<Elbow>,
    /// The value of `--clearance`, metres.
    pub clearance: Option<f64>,
    /// The value of `--calibration`.
    pub calibration: Option<CalibrationTable>,
}

impl Overrides {
    pub(super) fn tip_goal(&self) -> Option<Goal> {
        let TipPoint(tip) = self.goal_tip?;
        Some(self.elbow.map_or(Goal::Tip(tip), |elbow| Goal::TipAndElbow(tip, elbow)))
    }
}

impl LoadedScene {
    /// Overrides the world's clearance, in metres, and the errors for which motions must stay free. `None` keeps those of the
    /// world.
    ///
    /// # Errors
    /// A clearance that is negative or not finite; errors in a world with steps.
    pub fn with_margins(
        mut self,
        clearance: Option<f64>,
        errors: Option<CalibrationTable>,
    ) -> Result<Self, InputError> {
        if let Some(stated) = errors {
            self.world.replace_errors(stated);
            if self.is_task() && self.world.has_errors() {
                return Err(self.world.task_with_errors().into());
            }
        }
        let Some(clearance) = clearance.or(errors.map(|_| self.scene.workspace().clearance)) else { return Ok(self) };
        let refused = |diagnostic: SceneError| {
            Diagnostic::new("--clearance", diagnostic.to_string()).help("metres: 0 or more, such as 0.02")
        };
        if !self.world.has_errors() && errors.is_none() {
            self.scene = self.scene.with_clearance(clearance).map_err(refused)?;
            return Ok(self);
        }
        check_clearance(clearance).map_err(refused)?;
        // The growth of obstacles by errors depends on the clearance.
        self.world.workspace.fixed.clearance = clearance;
        let Self { scene, world, arm, robot, .. } = self;
        let mut changed = Self::unchecked(world, arm, robot);
        let limited = changed.scene.arm_mut();
        (limited.joints, limited.dynamics) = (scene.arm().joints.clone(), scene.arm().dynamics);
        Ok(changed)
    }

    /// Returns the scene without arches, as with `arch = false`: the arm rests during strokes and turns of the wrist.
    #[must_use]
    pub fn without_arches(mut self) -> Self {
        self.robot.joints.stroke.iter_mut().for_each(|stroke| stroke.arch = None);
        self.world.wrist.iter_mut().for_each(|(wrist, _)| wrist.turns_on_the_way = false);
        self
    }

    /// Requires that motions respect the efforts of the joints, even if the world file does not.
    ///
    /// # Errors
    /// A robot that lacks the necessary data.
    pub fn keeping_efforts(mut self) -> Result<Self, InputError> {
        if self.scene.arm().dynamics.is_none() {
            let why = self.robot.no_dynamics.as_deref().unwrap_or("the arm has no masses");
            return Err(Diagnostic::new("--torque", why)
                .help("`cplan inspect` reports the masses in the robot's file")
                .into());
        }
        keep_efforts(self.scene.arm_mut());
        // Effort limits replace assumed acceleration limits.
        self.robot.assumed.acceleration.clear();
        Ok(self)
    }
}

/// Two joint values as the user writes them: `-0.9,0.4` or `10deg, 20deg`. Values without the suffix `deg` are in radians, or in
/// metres if the joint is prismatic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointValues {
    numbers: [f64; 2],
    degrees: [bool; 2],
}

impl JointValues {
    /// Returns the values in radians and metres.
    ///
    /// # Errors
    /// A value of a prismatic joint with the suffix `deg`. `option` names the option in the message.
    pub fn resolve(&self, joints: &[Joint; 2], option: &str) -> Result<Configuration, Diagnostic> {
        let mut q = Configuration::zeros();
        for i in 0..2 {
            q[i] = match (self.degrees[i], joints[i].joint_type.is_revolute()) {
                (false, _) => self.numbers[i],
                (true, true) => self.numbers[i].to_radians(),
                (true, false) => {
                    let message = format!("joint \"{}\" slides: its value cannot be in degrees", joints[i].name);
                    return Err(Diagnostic::new(option, message).help("write its value in metres, without \"deg\""));
                }
            };
        }
        Ok(q)
    }
}

impl JointValues {
    /// Returns the hint that degrees may be meant, if a value in radians is more than a turn and outside the limits of the scene's
    /// joints, but would be within them in degrees. Otherwise `None`. `q` holds the resolved values.
    pub fn hint_for_degrees(&self, scene: &Scene, q: Configuration) -> Option<String> {
        hint_for_degrees(scene, q, self.notation())
    }

    pub(super) fn notation(&self) -> Notation {
        Notation { in_file: false, in_degrees: self.degrees }
    }

    /// Formats the values as in the world file.
    pub fn in_toml(&self) -> String {
        let value = |i: usize| match (self.numbers[i], self.degrees[i]) {
            (degrees, true) => format!("\"{degrees}deg\""),
            (number, false) => format!("{number:?}"),
        };
        format!("[{}, {}]", value(0), value(1))
    }
}

/// Formats the values as an option states them: `-0.9,20deg`.
impl fmt::Display for JointValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second] = [0, 1].map(|i| if self.degrees[i] { "deg" } else { "" });
        write!(f, "{}{first},{}{second}", self.numbers[0], self.numbers[1])
    }
}

impl From<Configuration> for JointValues {
    /// Creates values from radians and metres.
    fn from(q: Configuration) -> Self {
        Self { numbers: q.into(), degrees: [false; 2] }
    }
}

impl FromStr for JointValues {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut values = Self { numbers: [0.0; 2], degrees: [false; 2] };
        for (i, item) in pair(text)?.into_iter().enumerate() {
            let number = item.strip_suffix("deg").map(str::trim_end);
            values.degrees[i] = number.is_some();
            values.numbers[i] = finite(number.unwrap_or(item))?;
        }
        Ok(values)
    }
}

/// A point of the plane as the user writes it: `0.35,0.5`, in metres, or `350mm,0.5`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipPoint(pub Point);

impl FromStr for TipPoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let [x, y] = pair(text)?;
        Ok(Self(Point::new(length(x)?, length(y)?)))
    }
}

fn pair(text: &str) -> Result<[&str; 2], String> {
    let items: Vec<&str> = text.split(',').map(str::trim).collect();
    <[&str; 2]>::try_from(items)
        .map_err(|items| format!("expected two values separated by a comma, such as -0.9,0.4; found {}", items.len()))
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= MAX_LENGTH => Ok(value),
        Ok(value) if value.is_finite() => Err(format!("{value:e} is too large (at most {MAX_LENGTH:e})")),
        Ok(_) => Err(format!("\"{text}\" is not a finite number")),
        Err(_) => Err(format!("\"{text}\" is not a number")),
    }
}

fn length(text: &str) -> Result<f64, String> {
    metres(text).map_or_else(|_| finite(text), |value| finite(&value.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_geometry::Vector;
    use cplan_model::JointType;
    use cplan_model::space::JointRange;

    fn joints() -> [Joint; 2] {
        let joint = |name: &str, motion| Joint {
            name: name.into(),
            joint_type: motion,
            range: JointRange::Circle,
            velocity: 1.0,
            acceleration: 1.0,
            jerk: None,
        };
        [
            joint("turn", JointType::Revolute { sign: 1.0 }),
            joint("slide", JointType::Prismatic { direction: Vector::x() }),
        ]
    }

    #[test]
    fn values_may_be_in_degrees_one_by_one() {
        let q = " 90deg , -0.25 ".parse::<JointValues>().unwrap().resolve(&joints(), "--start").unwrap();
        assert_eq!(q, Configuration::new(std::f64::consts::FRAC_PI_2, -0.25));
        let q = "-0.9,4e-1".parse::<JointValues>().unwrap().resolve(&joints(), "--start").unwrap();
        assert_eq!(q, Configuration::new(-0.9, 0.4));
        assert_eq!("10 deg,1".parse::<JointValues>().unwrap().degrees, [true, false]);
        assert_eq!("10 deg,-1.0".parse::<JointValues>().unwrap().to_string(), "10deg,-1");
    }

    #[test]
    fn degrees_on_a_sliding_joint_are_refused() {
        let error = "0,10deg".parse::<JointValues>().unwrap().resolve(&joints(), "--goal").unwrap_err().to_string();
        assert!(error.starts_with("--goal: joint \"slide\" slides") && error.contains("metres"), "{error}");
    }

    #[test]
    fn malformed_values_are_explained() {
        for (text, part) in [
            ("1", "two values"),
            ("1,2,3", "found 3"),
            ("a,2", "\"a\" is not a number"),
            ("1,nan", "finite"),
            ("inf,1", "finite"),
            ("1e300,0", "too large"),
            ("deg,1", "not a number"),
            ("", "found 1"),
        ] {
            let error = text.parse::<JointValues>().unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        assert!("1deg,2".parse::<TipPoint>().unwrap_err().contains("not a number"));
        assert_eq!("0.35, 0.5".parse::<TipPoint>().unwrap(), TipPoint(Point::new(0.35, 0.5)));
        assert_eq!("350mm,5 dm".parse::<TipPoint>().unwrap(), TipPoint(Point::new(0.35, 0.5)));
    }
}
