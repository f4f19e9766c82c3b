//! The distance of a controller's motion from the straight lines of a program, and its effect on the arm.

use cplan_engine::Problem;
use cplan_handling::Action;
use cplan_judge::{Deviation, Posture};
use cplan_model::space::{Configuration, JointRange};
use std::fmt;
use std::str::FromStr;

/// Largest difference between a written target and the plan's, radians: a thousandth of a degree. It exceeds the rounding
/// of three decimals in degrees, and displaces the tip of a large arm by less than its repeatability.
const ROUNDING_TURN: f64 = 1e-3 * std::f64::consts::PI / 180.0;

/// Largest difference for sliding joints, metres: a thousandth of a millimetre.
const ROUNDING_SLIDE: f64 = 1e-6;

/// Greatest tolerance, radians and metres. Larger values are mistakes of units.
const MAX_TURN: f64 = 0.2;
const MAX_SLIDE: f64 = 0.1;

/// Factor for the rounding of sums, so that a difference of two distances is never too small.
const FLOATING: f64 = 1.0 + 1e-9;

/// Greatest deviation of the joints from the straight lines of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointTolerance {
    /// Deviation of joints that turn, radians.
    pub turn: f64,
    /// Deviation of joints that slide, metres.
    pub slide: f64,
}

impl Default for JointTolerance {
    /// Returns 0.05 degrees and 0.05 mm: a few times the repeatability of SCARAs.
    fn default() -> Self {
        Self { turn: 0.05_f64.to_radians(), slide: 5e-5 }
    }
}

impl fmt::Display for JointTolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [degrees, millimetres] = [self.turn.to_degrees(), 1e3 * self.slide].map(cplan_text::short);
        write!(f, "{degrees} deg, {millimetres} mm")
    }
}

impl FromStr for JointTolerance {
    type Err = String;

    /// Parses one or two values, such as `0.02deg` or `0.02deg,0.1mm`. The other one has its default.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut tolerance = Self::default();
        let mut stated = [false; 2];
        for part in text.split(',').map(str::trim) {
            // A number without a unit is an angle in degrees.
            let units = [("deg", true, 1_f64.to_radians()), ("rad", true, 1.0), ("mm", false, 1e-3), ("m", false, 1.0)];
            let unit = units.into_iter().find_map(|(unit, turns, size)| Some((part.strip_suffix(unit)?, turns, size)));
            let (number, turns, size) = unit.unwrap_or((part, true, 1_f64.to_radians()));
            let value = number.trim().parse::<f64>().map(|number| number * size);
            if std::mem::replace(&mut stated[usize::from(turns)], true) {
                let kind = if turns { "angles" } else { "lengths" };
                return Err(format!(
                    "has two {kind}, but must have one angle and one length, with units, such as 0.05deg,0.1mm"
                ));
            }
            let most = if turns { MAX_TURN } else { MAX_SLIDE };
            match value {
                Ok(value) if (0.0..=most).contains(&value) && turns => tolerance.turn = value,
                Ok(value) if (0.0..=most).contains(&value) => tolerance.slide = value,
                _ => {
                    return Err(
                        "must be an angle, a length or both, such as 0.05deg,0.1mm; at most 0.2rad, 0.1m".into()
                    );
                }
            }
        }
        Ok(tolerance)
    }
}

impl JointTolerance {
    /// The greatest rounding of written targets.
    pub(crate) const ROUNDING: Self = Self { turn: ROUNDING_TURN, slide: ROUNDING_SLIDE };

    /// Returns the tolerance plus some times the rounding of the digits.
    fn with_rounding(self, times: f64) -> Self {
        let Self { turn, slide } = Self::ROUNDING;
        Self { turn: self.turn + times * turn, slide: self.slide + times * slide }
    }

    /// Returns the clearance that a plan needs beyond that of its program, metres. It covers the tolerance, the rounding of
    /// the digits, and the rounding that the judge adds when it checks the digits.
    pub fn room(self, problem: &Problem) -> f64 {
        self.with_rounding(2.0).displacement(problem) * FLOATING
    }

    /// Returns the clearance that the lines between written targets need beyond that of the program, metres.
    pub fn room_as_written(self, problem: &Problem) -> f64 {
        self.with_rounding(1.0).displacement(problem)
    }

    /// Returns the distance by which the height of a tool may deviate from that of the plan, metres, for written targets.
    pub fn height_as_written(self) -> f64 {
        self.with_rounding(1.0).slide
    }

    /// Returns an upper bound on the distance, metres, by which deviations of the joints move a point of the arm or of a
    /// payload.
    ///
    /// An object in the gripper moves with the tip, and turns about it by the sum of the deviations of all joints that turn:
    /// a level payload, too, because the wrist compensates for the stated values of the joints, not for the real ones.
    fn displacement(self, problem: &Problem) -> f64 {
        let scene = problem.scene();
        let arm = scene.arm();
        let turns = arm.joints.each_ref().map(|joint| joint.joint_type.is_revolute());
        let deviation = Deviation::Box(turns.map(|turns| if turns { self.turn } else { self.slide }));
        // If joint 1 turns and joint 2 slides, the bound depends on joint 2. It is convex, so the ends of the range suffice.
        let ends = match arm.joints[1].range {
            JointRange::Interval { lower, upper } => [lower, upper],
            JointRange::Circle => [0.0; 2],
        };
        let postures = ends.map(|second| Posture::new(scene, Configuration::new(0.0, second)));
        let farthest = |link: usize, reach: f64| {
            postures.iter().map(|posture| posture.farthest_motion_within(link, reach, deviation)).fold(0.0, f64::max)
        };
        let reach = |link: usize| {
            scene.own_parts(link).iter().map(|part| part.shape.reach_from(Configuration::zeros())).fold(0.0, f64::max)
        };
        let turning = [turns[0], turns[1], problem.robot().joints.wrist.is_some()];
        let turning = turning.iter().filter(|turns| **turns).count() as f64 * self.turn;
        let payload = farthest(1, arm.tip.norm()) + turning * payload_reach(problem);
        farthest(0, reach(0)).max(farthest(1, reach(1))).max(payload)
    }
}

/// Returns the greatest distance between the tip and a point of an object in the gripper, metres.
fn payload_reach(problem: &Problem) -> f64 {
    let Some(task) = problem.task() else { return 0.0 };
    let picked = task.steps().filter_map(|step| match step.action {
        Action::Pick { object, grasp, .. } => Some((object, grasp)),
        _ => None,
    });
    let reaches =
        picked.flat_map(|(object, grasp)| task.objects[object].pieces.iter().map(move |piece| piece.reach_from(grasp)));
    reaches.fold(0.0, f64::max)
}
