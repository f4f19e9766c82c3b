//! Margins of motions: displacements of bodies, and errors of the arm's model, for which a motion stays free.
//!
//! The bisection of [`crate::recorded`] examines each stretch of a motion. A lower bound is accepted if it is almost as large as
//! the least value seen for the same body or the same kind of error. So margins are proven and tight.

mod bodies;
mod report;
mod search;

pub use bodies::{BodyKind, BodyNames};
pub use report::{MarginReport, ToleranceReport};
pub use search::{MarginSearch, MotionStretch};

use cplan_judge::ArmErrors;
use cplan_model::space::Configuration;
use cplan_model::{Arm, JointType};

/// A proven lower bound, and the place where the least value was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// The bound, in metres or radians.
    pub size: f64,
    /// Configuration of the arm at that place.
    pub at: Configuration,
    /// Time of that place, seconds: see [`Margins::lacks_times`]. At a rounded corner, it is approximately the time at which the
    /// motion passes.
    pub time: f64,
    /// The obstacle there, and the part of the arm or the payload: indices into [`Margins::bodies`].
    pub bodies: [usize; 2],
}

/// The margin of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyMargin {
    /// Name of the obstacle, the object or the URDF link.
    pub name: String,
    /// The kind of body.
    pub kind: BodyKind,
    /// Bound on its distance from other bodies that it can meet. `None` if it can meet no other body.
    pub margin: Option<Margin>,
}

/// The largest error of one kind for which a motion is proven free.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// The kind of error.
    pub of: ErrorKind,
    /// The error. `None` if no error up to half a turn, or up to the arm's reach, leads to contact.
    pub margin: Option<Margin>,
}

/// The margins of a motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Margins {
    /// All bodies: obstacles, objects, links of the robot.
    pub bodies: Vec<BodyMargin>,
    /// The largest error of each kind, if there are no other errors.
    pub tolerances: Vec<Tolerance>,
    /// True if the motion has no times. The time of a place is then the index of the waypoint, plus the fraction of the segment
    /// to the next one.
    pub lacks_times: bool,
}

/// A kind of error in an arm's model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// Displacement of the base in any direction.
    BasePosition,
    /// Rotation of the base about the origin of the plane.
    BaseAngle,
    /// The lengths of both links.
    LinkLengths,
    /// The zeros of all revolute joints.
    TurningZeros,
    /// The zeros of all prismatic joints.
    SlidingZeros,
}

impl ErrorKind {
    /// Returns the kinds of errors that an arm can have.
    pub fn all(arm: &Arm) -> Vec<Self> {
        let all = [Self::BasePosition, Self::BaseAngle, Self::LinkLengths, Self::TurningZeros, Self::SlidingZeros];
        all.into_iter().filter(|kind| kind.errors(arm, 1.0) != ArmErrors::default()).collect()
    }

    /// Returns the errors of an arm, each of this size, in radians or metres.
    pub fn errors(self, arm: &Arm, size: f64) -> ArmErrors {
        let has_zero = |revolute: bool| {
            arm.joints.each_ref().map(|joint| if joint.joint_type.is_revolute() == revolute { size } else { 0.0 })
        };
        // A prismatic joint determines the length of the link before it.
        let has_length = [
            arm.offset.norm() > 0.0 && matches!(arm.joints[1].joint_type, JointType::Revolute { .. }),
            arm.tip.norm() > 0.0,
        ];
        let none = ArmErrors::default();
        match self {
            Self::BasePosition => ArmErrors { base: size, ..none },
            Self::BaseAngle => ArmErrors { base_angle: size, ..none },
            Self::LinkLengths => ArmErrors { lengths: has_length.map(|has| if has { size } else { 0.0 }), ..none },
            Self::TurningZeros => ArmErrors { zeros: has_zero(true), ..none },
            Self::SlidingZeros => ArmErrors { zeros: has_zero(false), ..none },
        }
    }

    /// Returns the phrase for the kind in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::BasePosition => "base position",
            Self::BaseAngle => "base angle",
            Self::LinkLengths => "link lengths",
            Self::TurningZeros | Self::SlidingZeros => "joint zeros",
        }
    }

    /// Returns true if the errors are angles.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::BaseAngle | Self::TurningZeros)
    }

    /// Returns the largest error that is examined: half a turn, or the arm's reach.
    fn largest(self, arm: &Arm) -> f64 {
        if self.is_angle() { std::f64::consts::PI } else { arm.reach() }
    }
}
