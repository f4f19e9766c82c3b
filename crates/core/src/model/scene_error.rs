//! What arm, obstacles and what is carried must be to make a scene.

use super::{Arm, Body, Dynamics, Grip, Heights, Joint, JointType, Obstacle, Payload, Plane, Workspace};
use crate::space::JointRange;
use cplan_geometry::{Convex, Point, Pose, separation};

/// Unit vectors may be off by this: far above the rounding of what is normalised, far below any robot's accuracy.
const UNIT_ROUNDING: f64 = 1e-9;

/// Share of its farthest point's distance by which rounding may move a shape's corners.
const SHAPE_ROUNDING: f64 = 1e-9;

/// Why arm and workspace make no scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A joint's range is empty, not finite, or longer than makes sense.
    #[error("joint \"{joint}\": no range from {lower} to {upper}")]
    Range {
        /// The joint's name in the URDF.
        joint: String,
        /// The least value, as it was given.
        lower: f64,
        /// The greatest value, as it was given.
        upper: f64,
    },
    /// A joint slides, and yet its values are said to repeat with whole turns.
    #[error("joint \"{joint}\" slides: it needs a range, not a circle")]
    SlidesOnCircle {
        /// The joint's name in the URDF.
        joint: String,
    },
    /// A turning joint's sign is neither 1 nor -1, or a sliding one's direction not of length 1.
    #[error("joint \"{joint}\": a sign is 1 or -1, a direction of length 1")]
    JointType {
        /// The joint's name in the URDF.
        joint: String,
    },
    /// A joint's greatest speed, acceleration or jerk is not positive or not finite.
    #[error("joint \"{joint}\": its {limit} must be positive and finite, is {value}")]
    Limit {
        /// The joint's name in the URDF.
        joint: String,
        /// The quantity that is limited, in words.
        limit: &'static str,
        /// The limit, as it was given.
        value: f64,
    },
    /// A coordinate of the arm is not a number, or larger than makes sense.
    #[error("the arm's {what} is no place within 1e15 m")]
    NotFinite {
        /// The point that has it, in words.
        what: &'static str,
    },
    /// The plane's vectors are not of length 1 and at right angles.
    #[error("the plane's vectors are not of length 1 and at right angles")]
    Plane,
    /// A shape is larger than makes sense, or far away.
    #[error("\"{of}\": its shape is not within 1e15 m")]
    Size {
        /// Name of the obstacle or link.
        of: String,
    },
    /// A mass, an inertia, an effort or the gravity is negative or not finite, or there is no effort at all.
    #[error("masses, efforts and gravity make no sense: {what}")]
    Dynamics {
        /// Of what.
        what: String,
    },
    /// What proofs are to rest on is not within the outline.
    #[error("\"{of}\": its inner shape is not within its outline")]
    Inner {
        /// Name of the link.
        of: String,
    },
    /// Something ends below where it begins, or at no number.
    #[error("\"{of}\": no heights from {lower} to {upper}")]
    Heights {
        /// Name of the obstacle, link or payload.
        of: String,
        /// The lower end, as it was given.
        lower: f64,
        /// The upper end, as it was given.
        upper: f64,
    },
    /// The distance to keep is negative, too large or not finite.
    #[error("the clearance must be from 0 to {LARGEST:e} m, is {clearance:?}")]
    Clearance {
        /// The distance, as it was given.
        clearance: f64,
    },
    /// A preference's strength is not finite, or its direction not of length 1.
    #[error("preference \"{name}\": its epsilon must be finite, its direction of length 1")]
    Preference {
        /// The preference's name in the world.
        name: String,
    },
    /// What is carried is held at no place, or larger than makes sense.
    #[error("payload \"{object}\": its grip is no place and angle within 1e15 m, or its shape larger")]
    Grip {
        /// The object's name in the world.
        object: String,
    },
    /// There is no obstacle of this number whose contact to allow, or to rest on.
    #[error("there is no obstacle number {number} among {count}")]
    NoObstacle {
        /// The number that was given; the first obstacle is 0.
        number: usize,
        /// How many there are.
        count: usize,
    },
    /// What is carried keeps its orientation, and something moves that turns.
    #[error("payload \"{object}\" is held level, and \"{mover}\" turns")]
    TurnsAboutLevel {
        /// The object's name in the world.
        object: String,
        /// The name of what turns.
        mover: String,
    },
}

/// The first defect of what is to make a scene. `O(n)` in parts, obstacles and preferences; shapes are valid by their type.
pub(super) fn check(
    arm: &Arm,
    workspace: &Workspace,
    payload: Option<&Payload>,
    allowed_contacts: &[usize],
) -> Result<(), SceneError> {
    check_arm(arm)?;
    check_workspace(workspace)?;
    if let Some(payload) = payload {
        check_heights(&payload.object, payload.heights)?;
        if !is_mass(payload.mass) {
            return Err(SceneError::Dynamics { what: format!("\"{}\" of {} kg", payload.object, payload.mass) });
        }
        let is_finite = match payload.grip {
            Grip::Rigid(pose) => is_pose(&pose),
            Grip::Level { angle, point } => are_small([angle, point.x, point.y]),
        };
        if !is_finite || !payload.pieces.iter().all(is_small) {
            return Err(SceneError::Grip { object: payload.object.clone() });
        }
    }
    let level = payload.filter(|payload| matches!(payload.grip, Grip::Level { .. }));
    if let Some((payload, mover)) = level.zip(workspace.movers.iter().find(|mover| mover.course.turns())) {
        let (object, mover) = (payload.object.clone(), mover.obstacle.name.clone());
        return Err(SceneError::TurnsAboutLevel { object, mover });
    }
    let count = workspace.obstacles.len();
    let supports = payload.map_or(&[][..], |payload| &payload.supports);
    let all = count + workspace.movers.len();
    let unknown = |numbers: &[usize], count: usize| {
        let number = numbers.iter().copied().find(|&number| number >= count);
        number.map_or(Ok(()), |number| Err(SceneError::NoObstacle { number, count }))
    };
    unknown(allowed_contacts, all)?;
    unknown(supports, count)
}

fn check_arm(arm: &Arm) -> Result<(), SceneError> {
    arm.joints.iter().try_for_each(check_joint)?;
    for (what, place) in [("base", arm.base.coords), ("offset", arm.offset), ("tip", arm.tip.coords)] {
        if !are_small(place.iter().copied()) {
            return Err(SceneError::NotFinite { what });
        }
    }
    let Plane { u, v, normal } = arm.plane;
    // Heights may be measured either way.
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
        if !is_mass(*mass) || !is_mass(*inertia) || !are_small(center.coords.iter().copied()) {
            return error(format!("link {} of {mass} kg, {inertia} kg m2, its centre at {center}", k + 1));
        }
    }
    if let Some(effort) = dynamics.effort.into_iter().find(|effort| !(is_mass(*effort) && *effort > 0.0)) {
        return error(format!("an effort of {effort}"));
    }
    if are_small(dynamics.gravity.iter().copied()) { Ok(()) } else { error("the gravity".into()) }
}

fn is_mass(value: f64) -> bool {
    (0.0..=LARGEST).contains(&value)
}

/// Whether a shape covers another one, up to rounding: the discs at the corners of one lie as deep in the other as they are large.
fn covers(shape: &Convex, inner: &Convex) -> bool {
    let room = SHAPE_ROUNDING * shape.reach_from(Point::origin());
    let beyond = |corner: &Point| separation(shape, &Convex::point(*corner)).distance + inner.radius();
    inner.core().iter().all(|corner| beyond(corner) <= room)
}

fn check_joint(joint: &Joint) -> Result<(), SceneError> {
    let name = || joint.name.clone();
    check_range(&joint.name, joint.range)?;
    if let JointRange::Interval { lower, upper } = joint.range
        && joint.joint_type.is_revolute()
        && upper - lower > LONGEST_TURN
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

/// The range of a joint that makes sense: ends in order, finite and not too large.
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
    let moving = workspace.movers.iter().map(|mover| &mover.obstacle);
    workspace.obstacles.iter().chain(moving).try_for_each(check_obstacle)?;
    let is_unit = |[x, y]: [f64; 2]| (x.hypot(y) - 1.0).abs() <= UNIT_ROUNDING;
    match workspace.preferences.iter().find(|p| !(p.epsilon.is_finite() && p.direction.is_none_or(is_unit))) {
        Some(preference) => Err(SceneError::Preference { name: preference.name.clone() }),
        None => Ok(()),
    }
}

fn check_obstacle(obstacle: &Obstacle) -> Result<(), SceneError> {
    check_size(&obstacle.name, &obstacle.pieces)?;
    check_heights(&obstacle.name, obstacle.heights)
}

pub(super) fn check_clearance(clearance: f64) -> Result<(), SceneError> {
    if (0.0..=LARGEST).contains(&clearance) { Ok(()) } else { Err(SceneError::Clearance { clearance }) }
}

/// Numbers beyond which nothing is taken, metres: predicates and distances are far from overflowing, and sums of lengths in files,
/// which are smaller, are within.
pub const LARGEST: f64 = 1e15;

/// A turning joint's range at most, radians: intervals are repeated turn after turn, and a hundred turns are enough for any wrist.
pub const LONGEST_TURN: f64 = 1e3;

/// Whether all are finite, and no larger than makes sense.
#[must_use]
pub fn are_small(values: impl IntoIterator<Item = f64>) -> bool {
    values.into_iter().all(|value| value.abs() <= LARGEST)
}

/// Whether all of a shape is where numbers make sense.
#[must_use]
pub fn is_small(shape: &Convex) -> bool {
    are_small(shape.core().iter().flat_map(|p| [p.x, p.y]).chain([shape.radius()]))
}

/// Whether a pose moves and turns, and nothing else.
#[must_use]
pub fn is_pose(pose: &Pose) -> bool {
    are_small(pose.translation.vector.iter().copied()) && (pose.rotation.as_ref().norm() - 1.0).abs() <= UNIT_ROUNDING
}

fn check_size<'a>(of: &str, shapes: impl IntoIterator<Item = &'a Convex>) -> Result<(), SceneError> {
    if shapes.into_iter().all(is_small) { Ok(()) } else { Err(SceneError::Size { of: of.to_owned() }) }
}

fn check_heights(of: &str, Heights { lower, upper }: Heights) -> Result<(), SceneError> {
    if lower <= upper { Ok(()) } else { Err(SceneError::Heights { of: of.to_owned(), lower, upper }) }
}
