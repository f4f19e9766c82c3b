//! The judgement of a program as written.

use crate::error::ProgramError;
use crate::moves::Travel;
use crate::program::Program;
use crate::tolerance::JointTolerance;
use cplan_handling::Driver;
use cplan_judge::{Rejection, certify_at};
use cplan_model::space::{Configuration, Path};
use cplan_text::{length, short};

impl Program {
    /// Certifies the straight lines between the written targets, given as the values of all joints, radians and metres.
    ///
    /// The judge checks the lines of the two planned joints again, each step in its own scene. All other facts follow from
    /// the plan: its clearance during strokes and turns includes the displacement by the rounding and the tolerance.
    ///
    /// # Errors
    /// A target that differs from the plan by more than rounding, and a line that is not proven free.
    pub(crate) fn certify(&self, targets: &[Vec<f64>]) -> Result<(), ProgramError> {
        for (target, (one, written)) in self.moves.iter().zip(targets).enumerate() {
            for (joint, (exact, written)) in self.joints.iter().zip(one.values.iter().zip(written)) {
                if (exact - written).abs() > joint.of(JointTolerance::ROUNDING) {
                    let (unit, size) = if joint.slides { ("mm", 1e-3) } else { ("deg", 1_f64.to_radians()) };
                    let [exact, off] = [*exact, (exact - written).abs()].map(|value| short(value / size));
                    return Err(ProgramError::Rounded(format!(
                        "joint \"{}\" of {}: the written value differs by {off} {unit} from {exact} {unit}",
                        joint.name,
                        self.describe(target)
                    )));
                }
            }
        }
        self.travels.iter().try_for_each(|travel| self.certify_travel(travel, targets))
    }

    /// Returns the values of the two planned joints at targets. Each target has the values of all joints.
    ///
    /// # Errors
    /// A robot without one of these joints.
    pub fn configurations(&self, targets: &[Vec<f64>]) -> Result<Vec<Configuration>, ProgramError> {
        let planned = |k: usize| self.joints.iter().position(|joint| joint.driver == Driver::Planned(k));
        let Some((one, two)) = planned(0).zip(planned(1)) else {
            return Err(ProgramError::Unsuitable("the robot does not have both planned joints".into()));
        };
        Ok(targets.iter().map(|values| Configuration::new(values[one], values[two])).collect())
    }

    fn certify_travel(
        &self,
        Travel { scene, moves: [first, last] }: &Travel,
        targets: &[Vec<f64>],
    ) -> Result<(), ProgramError> {
        let corners = self.configurations(&targets[*first..=*last])?;
        let refused = match certify_at(scene, Path::new(corners), self.required) {
            Ok(_) => return Ok(()),
            Err(refused) => refused,
        };
        let why = match refused {
            Rejection::OutOfLimits { waypoint, limited } => {
                let limited = scene.arm().describe_limit(limited);
                format!("{limited} leaves its limits at {}", self.describe(first + waypoint))
            }
            Rejection::TooClose(nearest) | Rejection::Undecided(nearest) => {
                let (pair, least) = (scene.describe(nearest.contact.pair), nearest.contact.separation.distance);
                let place = self.describe(*last);
                match least > 0.0 {
                    true => {
                        let [least, needed] = [least, self.required].map(length);
                        format!("before {place}, {pair} are only {least} apart, but the tolerance needs {needed}")
                    }
                    false => format!("before {place}, {pair} can touch within the tolerance of the heights"),
                }
            }
        };
        Err(ProgramError::NotCertified(why))
    }
}
