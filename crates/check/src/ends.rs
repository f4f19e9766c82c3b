//! Start and goal of the query.

use crate::arm::Arm;
use crate::certificate::Certificate;
use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::world::{Goal, World};

mod end_error;
mod region;

pub use end_error::missed;
pub use region::{MAX_ENCLOSED_PARTS, MAX_LOCATED_PARTS};

/// The start or the goal.
pub struct End {
    what: &'static str,
    /// The configuration, tip position or area.
    pub at: Goal,
    /// Description for messages, if the certificate replaces the world's start or goal. Otherwise empty.
    own: String,
}

impl End {
    /// Returns the start: the certificate's, or else the world's.
    ///
    /// # Errors
    /// If there is no start.
    pub fn start(certificate: &Certificate, world: &World) -> Result<Self, CheckError> {
        Self::of("start", certificate.start.as_ref().map(exact_goal), world.start.as_ref())
    }

    /// Returns the goal: the certificate's, or else the world's.
    ///
    /// # Errors
    /// If there is no goal, or if there are two.
    pub fn goal(certificate: &Certificate, world: &World) -> Result<Self, CheckError> {
        let own = match (&certificate.goal, &certificate.goal_tip) {
            (Some(_), Some(_)) => return Err(CheckError::in_file(Input::Certificate, "it has two goals")),
            (joints, tip) => {
                let tip = tip.clone().map(|tip| Goal::Tip(tip, certificate.elbow));
                joints.as_ref().map(exact_goal).or(tip)
            }
        };
        Self::of("goal", own, world.goal.as_ref())
    }

    fn of(what: &'static str, own: Option<Goal>, given: Option<&Goal>) -> Result<Self, CheckError> {
        let description = match &own {
            Some(Goal::Joints([[a, _], [b, _]]) | Goal::Tip([a, b], _)) => format!(" ({a}, {b})"),
            Some(Goal::Areas(_)) | None => String::new(),
        };
        let missing = || format!("there is no {what}: [{what}] joints = [q1, q2]");
        let at = own.or_else(|| given.cloned()).ok_or_else(|| CheckError::in_file(Input::World, missing()))?;
        Ok(Self { what, at, own: description })
    }

    /// Describes the start or goal in words, with its values if they differ from the world's.
    pub fn named(&self, arm: &Arm) -> String {
        match self.at {
            Goal::Joints(_) => self.own.clone(),
            Goal::Tip(_, None) => format!("{}, a position of the tip \"{}\",", self.own, arm.tip_link),
            Goal::Tip(_, Some(elbow)) => format!(
                "{}, a position of the tip \"{}\" with the elbow on the {},",
                self.own,
                arm.tip_link,
                elbow.name()
            ),
            Goal::Areas(_) => format!("{}, an area of the tip \"{}\",", self.own, arm.tip_link),
        }
    }
}

fn exact_goal(q: &[Decimal; 2]) -> Goal {
    Goal::Joints(q.each_ref().map(|value| [value.clone(), value.clone()]))
}
