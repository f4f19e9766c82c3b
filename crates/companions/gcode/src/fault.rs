//! The reasons why a machine cannot play a move.

use cplan_geometry::Point;
use cplan_judge::Nearest;
use cplan_model::Scene;
use cplan_model::space::Configuration;
use cplan_text::length_down;
use serde::Serialize;

/// The kind of a reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The tip cannot reach a place.
    OutOfReach,
    /// The tip passes the axis of joint 1, so that the joints would jump.
    Singular,
    /// A joint would leave its limits.
    JointLimit,
    /// The motor of the elbow, mounted on the base, would leave its range.
    MotorRange,
    /// The arm hits an obstacle, or comes nearer than the clearance.
    Collision,
    /// A collision while the joints move straight, as some firmwares play travels.
    JointMotion,
    /// No safe travel can replace an unsafe one.
    NoTravel,
    /// The move is too long or too complicated to decide.
    Undecided,
}

/// The reason why a machine cannot play a move.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The kind of the reason.
    pub cause: Cause,
    /// The reason in words, to follow the number of the line.
    pub reason: String,
    /// Place of the tip, metres.
    pub place: Point,
    /// True if the fault is proven. If false, the move is not proven to be safe.
    pub is_proven: bool,
}

impl Fault {
    pub(crate) fn undecided(place: Point, reason: String) -> Self {
        Self { cause: Cause::Undecided, reason, place, is_proven: false }
    }

    pub(crate) fn out_of_reach(place: Point, by: f64) -> Self {
        let reason = format!("{} is {} out of reach", shown(place), length_down(by));
        Self { cause: Cause::OutOfReach, reason, place, is_proven: true }
    }

    pub(crate) fn singular(place: Point, is_proven: bool) -> Self {
        let reason = format!("the tip passes a singular place at {}, where a joint would jump", shown(place));
        Self { cause: Cause::Singular, reason, place, is_proven }
    }

    pub(crate) fn limit(scene: &Scene, place: Point, joint: usize, q: Configuration, is_proven: bool) -> Self {
        let reason = format!("{}, at {}", scene.arm().joints[joint].explain_outside(q[joint]), shown(place));
        Self { cause: Cause::JointLimit, reason, place, is_proven }
    }

    pub(crate) fn motor(place: Point, is_proven: bool) -> Self {
        let reason = match is_proven {
            true => format!("the elbow's motor would leave its range at {}", shown(place)),
            false => format!("the elbow's motor is not proven to stay in its range at {}", shown(place)),
        };
        Self { cause: Cause::MotorRange, reason, place, is_proven }
    }

    pub(crate) fn collision(scene: &Scene, nearest: Nearest, is_proven: bool) -> Self {
        let (pair, place) = (nearest.contact.pair, scene.arm().tip_at(nearest.at));
        let reason = match is_proven {
            true => scene.explain_contact(pair),
            false => {
                let (part, obstacle) = (scene.describe_part(pair), scene.describe_obstacle(pair.obstacle));
                format!("{part} is not proven to keep clear of {obstacle}")
            }
        };
        let reason = format!("{reason} with the tip at {}", shown(place));
        Self { cause: Cause::Collision, reason, place, is_proven }
    }
}

/// Returns a place in millimetres: `(12.3, 4.5) mm`.
pub(crate) fn shown(place: Point) -> String {
    // Adding 0 makes a negative zero positive.
    let [x, y] = [place.x, place.y].map(|value| (1e4 * value).round() / 10.0 + 0.0);
    format!("({x:.1}, {y:.1}) mm")
}
