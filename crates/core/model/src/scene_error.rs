//! Checks of the arm, the obstacles and the additions of a scene.

use super::{
    Additions, Arm, Attachment, Body, Dynamics, Grip, Growth, Heights, Joint, JointType, LooseObstacle, Motors,
    Obstacle, Plane, Workspace,
};
use crate::space::JointRange;
use cplan_geometry::{Convex, Point, Pose, separation};

/// Tolerance for the length of unit vectors. It is far above the rounding of normalised vectors and far below any
/// robot's accuracy.
const UNIT_ROUNDING: f64 = 1e-9;

/// Fraction of a shape's greatest distance from the origin by which rounding may move its corners.
const SHAPE_ROUNDING: f64 = 1e-9;

/// The reason why a scene cannot be made from an arm, a workspace and additions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A joint's range is empty, not finite, or too long.
    #[error(
        "joint \"{joint}\": the range from {lower} to {upper} is invalid; both numbers must be finite, the lower one first, and at most {MAX_TURN_RANGE} rad apart if the joint turns"
    )]
    Range {
        /// The joint's name in the URDF.
        joint: String,
        /// The least value as given.
        lower: f64,
        /// The greatest value as given.
        upper: f64,
    },
    /// A joint is prismatic, but its range is a circle.
    #[error("joint \"{joint}\" slides, so it needs a range instead of a circle")]
    SlidesOnCircle {
        /// The joint's name in the URDF.
        joint: String,
    },
    /// A revolute joint's sign is neither 1 nor -1, or a prismatic one's direction is not of length 1.
    #[error("joint \"{joint}\": its sign must be 1 or -1, and its direction must have length 1")]
    JointType {
        /// The joint's name in the URDF.
        joint: String,
    },
    /// A joint's limit on speed, acceleration or jerk is not positive or not finite.
    #[error("joint \"{joint}\": its {limit} must be positive and finite, is {value}")]
    Limit {
        /// The joint's name in the URDF.
        joint: String,
        /// The limited quantity: "velocity", "acceleration" or "jerk".
        limit: &'static str,
        /// The limit as given.
        value: f64,
    },
    /// The motors are described by numbers that make no sense, or limit the sum of joint values without limits of the joints.
    #[error("the motors: {what}")]
    Motors {
        /// The reason in words.
        what: &'static str,
    },
    /// A coordinate of the arm is not a number, or too large.
    #[error("the arm's {what} must be finite and within 1e15 m")]
    NotFinite {
        /// The point that has the coordinate: "base", "offset" or "tip".
        what: &'static str,
    },
    /// The plane's vectors do not have length 1, or are not at right angles.
    #[error("the plane's vectors must have length 1 and be at right angles")]
    Plane,
    /// A shape is too large, or too far from the origin.
    #[error("\"{of}\": its shape must be within 1e15 m of the origin")]
    Size {
        /// Name of the obstacle or link.
        of: String,
    },
    /// A mass or an inertia is negative or not finite, an effort is not positive, or gravity is not finite.
    #[error("masses, efforts and gravity are invalid: {what}")]
    Dynamics {
        /// The invalid quantity with its value, in words.
        what: String,
    },
    /// The inner shape of a part, which proofs use, is not within the part's outline.
    #[error("\"{of}\": the inner shape must be within the outline")]
    Inner {
        /// Name of the link.
        of: String,
    },
    /// The ends of a height range are in the wrong order, or one of them is not a number.
    #[error("\"{of}\": the heights from {lower} to {upper} are invalid; both must be finite, the lower one first")]
    Heights {
        /// Name of the obstacle, link or attachment.
        of: String,
        /// The lower end as given.
        lower: f64,
        /// The upper end as given.
        upper: f64,
    },
    /// The clearance is negative, too large or not finite.
    #[error("the clearance must be from 0 to {MAX_COORDINATE:e} m, is {clearance:?}")]
    Clearance {
        /// The clearance as given, metres.
        clearance: f64,
    },
    /// A preference's strength is not finite, or its direction does not have length 1.
    #[error("preference \"{name}\": its epsilon must be finite, and its direction must have length 1")]
    Preference {
        /// The preference's name in the world.
        name: String,
    },
    /// The attachment's pose is not finite, or the attachment is too large.
    #[error("carried object \"{object}\": its position on link 2 and its shape must be finite and within 1e15 m")]
    Grip {
        /// The attachment's name.
        object: String,
    },
    /// The index of an allowed contact or of a support is not that of an obstacle.
    #[error("obstacle number {number} does not exist: there are {count} obstacles, numbered from 0")]
    NoObstacle {
        /// The index as given; the first obstacle has index 0.
        number: usize,
        /// Number of obstacles.
        count: usize,
    },
    /// The attachment is held level, but a loose obstacle turns.
    #[error(
        "obstacle \"{moving_obstacle}\" turns, but the carried object \"{object}\" keeps its orientation; such objects cannot be carried among obstacles that turn"
    )]
    TurnsAboutLevel {
        /// The attachment's name.
        object: String,
        /// The name of the turning obstacle.
        moving_obstacle: String,
    },
}

/// Returns the first defect of the contents of a scene. `O(n)` in parts, obstacles and preferences. Shapes are valid
/// by their type.
pub(super) fn check(arm: &Arm, workspace: &Workspace, additions: &Additions) -> Result<(), SceneError> {
    check_arm(arm)?;
    check_motors(arm)?;
    check_workspace(workspace)?;
    let Additions { loose, attachment, allowed_contacts } = additions;
    loose.iter().try_for_each(|loose| check_obstacle(&loose.obstacle))?;
    let count = workspace.obstacles.len();
    let known = |numbers: &[usize], count: usize| match numbers.iter().find(|number| **number >= count) {
        Some(&number) => Err(SceneError::NoObstacle { number, count }),
        None => Ok(()),
    };
    if let Some(attachment) = attachment {
        check_attachment(attachment, loose)?;
        known(&attachment.supports, count)?;
    }
    known(allowed_contacts, count + loose.len())
}

fn check_attachment(attachment: &Attachment, loose: &[LooseObstacle]) -> Result<(), SceneError> {
    let Attachment { name, heights, grip, parts, .. } = attachment;
    check_heights(name, *heights)?;
    let is_finite = match grip {
        Grip::Rigid(pose) => is_pose(pose),
        Grip::Level { angle, point } => are_small([*angle, point.x, point.y]),
    };
    if !is_finite || !parts.iter().all(|part| is_small(&part.shape)) {
        return Err(SceneError::Grip { object: name.clone() });
    }
    match loose.iter().find(|loose| grip.is_level() && loose.angle.is_none()) {
        Some(loose) => {
            let (object, moving_obstacle) = (name.clone(), loose.obstacle.name.clone());
            Err(SceneError::TurnsAboutLevel { object, moving_obstacle })
        }
        None => Ok(()),
    }
}

fn check_arm(arm: &Arm) -> Result<(), SceneError> {
    arm.joints.iter().try_for_each(check_joint)?;
    for (what, place) in [("base", arm.base), ("offset", arm.offset), ("tip", arm.tip)] {
        if !are_small(place.iter().copied()) {
            return Err(SceneError::NotFinite { what });
        }
    }
    let Plane { u, v, normal } = arm.plane;
    // Heights may be measured in either direction.
    let off = [u.norm() - 1.0, v.norm() - 1.0, normal.norm() - 1.0, u.dot(&v), u.dot(&normal), v.dot(&normal)];
    if !off.iter().all(|off| off.abs() <= UNIT_ROUNDING) {
        return Err(SceneError::Plane);
    }
    arm.dynamics.as_ref().map_or(Ok(()), check_dynamics)?;
    arm.self_obstacles.iter().map(|own| &own.obstacle).try_for_each(check_obstacle)?;
    arm.links.iter().flat_map(|link| &link.parts).try_for_each(|part| {
        check_size(&part.body, [&part.shape])?;
        if part.inner.as_ref().is_some_and(|inner| !covers(&part.shape, inner)) {
            return Err(SceneError::Inner { of: part.body.clone() });
        }
        check_heights(&part.body, part.heights)
    })
}

fn check_dynamics(dynamics: &Dynamics) -> Result<(), SceneError> {
    let error = |what: String| Err(SceneError::Dynamics { what });
    for (k, Body { mass, center, inertia }) in dynamics.bodies.iter().enumerate() {
        if !is_mass(*mass) || !is_mass(*inertia) || !are_small(center.iter().copied()) {
            return error(format!(
                "link {} of {mass} kg, {inertia} kg m2, its centre at {{{}, {}}}",
                k + 1,
                center.x,
                center.y
            ));
        }
    }
    if let Some(effort) = dynamics.effort.into_iter().find(|effort| !(is_mass(*effort) && *effort > 0.0)) {
        return error(format!("an effort of {effort}"));
    }
    if are_small(dynamics.gravity.iter().copied()) { Ok(()) } else { error("the gravity".into()) }
}

fn is_mass(value: f64) -> bool {
    (0.0..=MAX_COORDINATE).contains(&value)
}

fn check_motors(arm: &Arm) -> Result<(), SceneError> {
    let Some(Motors { ratio, gear, zero, range, velocity, acceleration, jerk, effort }) = arm.motors else {
        return Ok(());
    };
    let error = |what| Err(SceneError::Motors { what });
    let numbers = [ratio].into_iter().chain(gear).chain(zero).chain(range.into_iter().flatten());
    if !are_small(numbers) || gear.contains(&0.0) {
        return error("ratio, gears, zeros and limits must be finite, and no gear 0");
    }
    if [velocity, acceleration, jerk, effort].into_iter().flatten().any(|limit| !(limit.is_finite() && limit > 0.0)) {
        return error("speeds, accelerations, jerks and efforts must be positive and finite");
    }
    if !arm.only_turns() {
        return error("both joints must turn");
    }
    match range {
        Some([lower, upper]) if lower >= upper => error("the least sum of the joint values is not below the greatest"),
        Some(_) if arm.joints.iter().any(|joint| joint.range.is_circle()) => {
            error("a range of the sum of the joint values is given, but not both joints have limits")
        }
        _ => Ok(()),
    }
}

/// Returns true if `shape` covers `inner`, up to rounding: each corner of the inner core lies inside `shape`, at
/// least the inner radius from its boundary.
fn covers(shape: &Convex, inner: &Convex) -> bool {
    let room = SHAPE_ROUNDING * shape.reach_from(Point::zeros());
    let beyond = |corner: &Point| separation(shape, &Convex::point(*corner)).distance + inner.radius();
    inner.core().iter().all(|corner| beyond(corner) <= room)
}

fn check_joint(joint: &Joint) -> Result<(), SceneError> {
    let name = || joint.name.clone();
    check_range(&joint.name, joint.range)?;
    if let JointRange::Interval { lower, upper } = joint.range
        && joint.joint_type.is_revolute()
        && upper - lower > MAX_TURN_RANGE
    {
        return Err(SceneError::Range { joint: name(), lower, upper });
    }
    if joint.range.is_circle() && !joint.joint_type.is_revolute() {
        return Err(SceneError::SlidesOnCircle { joint: name() });
    }
    let is_unit = match joint.joint_type {
        JointType::Revolute { sign } => sign.abs() == 1.0,
        JointType::Prismatic { direction } => (direction.norm() - 1.0).abs() <= UNIT_ROUNDING,
    };
    if !is_unit {
        return Err(SceneError::JointType { joint: name() });
    }
    let limits = [("velocity", Some(joint.velocity)), ("acceleration", Some(joint.acceleration)), ("jerk", joint.jerk)];
    match limits.into_iter().find_map(|(limit, value)| Some((limit, value.filter(|v| !(v.is_finite() && *v > 0.0))?))) {
        Some((limit, value)) => Err(SceneError::Limit { joint: name(), limit, value }),
        None => Ok(()),
    }
}

/// Checks that the limits of a joint are in order, finite and not too large.
///
/// # Errors
/// [`SceneError::Range`].
pub fn check_range(joint: &str, range: JointRange) -> Result<(), SceneError> {
    match range {
        JointRange::Interval { lower, upper } if !(lower <= upper && are_small([lower, upper])) => {
            Err(SceneError::Range { joint: joint.to_owned(), lower, upper })
        }
        JointRange::Interval { .. } | JointRange::Circle => Ok(()),
    }
}

fn check_workspace(workspace: &Workspace) -> Result<(), SceneError> {
    check_clearance(workspace.clearance)?;
    workspace.obstacles.iter().try_for_each(check_obstacle)?;
    let is_unit = |[x, y]: [f64; 2]| (x.hypot(y) - 1.0).abs() <= UNIT_ROUNDING;
    match workspace.preferences.iter().find(|p| !(p.epsilon.is_finite() && p.direction.is_none_or(is_unit))) {
        Some(preference) => Err(SceneError::Preference { name: preference.name.clone() }),
        None => Ok(()),
    }
}

fn check_obstacle(obstacle: &Obstacle) -> Result<(), SceneError> {
    check_size(&obstacle.name, &obstacle.pieces)?;
    let Growth { clearance, error, padding, total } = obstacle.growth;
    if ![clearance, error, padding, total].iter().all(|length| (0.0..=MAX_COORDINATE).contains(length)) {
        return Err(SceneError::Size { of: obstacle.name.clone() });
    }
    check_heights(&obstacle.name, obstacle.heights)
}

/// Checks a clearance, metres.
///
/// # Errors
/// If it is negative, too large or not finite.
pub fn check_clearance(clearance: f64) -> Result<(), SceneError> {
    if (0.0..=MAX_COORDINATE).contains(&clearance) { Ok(()) } else { Err(SceneError::Clearance { clearance }) }
}

/// Greatest length that a scene accepts, metres. It keeps geometric predicates and distances far from overflow.
pub const MAX_COORDINATE: f64 = 1e15;

/// Greatest range of a revolute joint, radians. Every interval on the axis is copied once per turn, so the range
/// must be bounded. About 160 turns are enough for any wrist.
pub const MAX_TURN_RANGE: f64 = 1e3;

/// Returns true if all values are finite, and at most [`MAX_COORDINATE`] in magnitude.
pub fn are_small(values: impl IntoIterator<Item = f64>) -> bool {
    values.into_iter().all(|value| value.abs() <= MAX_COORDINATE)
}

/// Returns true if all coordinates of a shape, and its radius, are finite and at most [`MAX_COORDINATE`] in
/// magnitude.
pub fn is_small(shape: &Convex) -> bool {
    are_small(shape.core().iter().flat_map(|p| [p.x, p.y]).chain([shape.radius()]))
}

/// Returns true if a pose is a rigid motion with a translation of at most [`MAX_COORDINATE`].
pub fn is_pose(pose: &Pose) -> bool {
    are_small(pose.translation.iter().copied()) && (pose.rotation.as_ref().norm() - 1.0).abs() <= UNIT_ROUNDING
}

fn check_size<'a>(of: &str, shapes: impl IntoIterator<Item = &'a Convex>) -> Result<(), SceneError> {
    if shapes.into_iter().all(is_small) { Ok(()) } else { Err(SceneError::Size { of: of.to_owned() }) }
}

fn check_heights(of: &str, Heights { lower, upper }: Heights) -> Result<(), SceneError> {
    if lower <= upper { Ok(()) } else { Err(SceneError::Heights { of: of.to_owned(), lower, upper }) }
}
