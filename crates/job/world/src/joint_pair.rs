//! Values of both joints, as the world file states them.

use cplan_model::Joint;
use cplan_robot::{Diagnostic, Source};
use std::ops::Range;

/// Values of both joints, base to tip, in radians or metres. `degrees` has the positions in the file of values in degrees.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointPair {
    pub values: [f64; 2],
    pub degrees: [Option<Range<usize>>; 2],
}

impl JointPair {
    /// Checks that no value of a prismatic joint is in degrees.
    ///
    /// # Errors
    /// The first such value.
    pub fn check(&self, source: &Source, joints: &[Joint; 2]) -> Result<(), Diagnostic> {
        for (joint, at) in joints.iter().zip(&self.degrees) {
            if let Some(at) = at.as_ref().filter(|_| !joint.joint_type.is_revolute()) {
                let message = format!("joint \"{}\" slides: its value cannot be in degrees", joint.name);
                return Err(source
                    .diagnostic_at(at.clone(), message)
                    .help("write its value in metres, without \"deg\""));
            }
        }
        Ok(())
    }
}
