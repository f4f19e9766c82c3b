//! Values of both joints as the world file has them.

use super::reader::Reader;
use cplan_core::model::Joint;
use cplan_robot::{Diagnostic, Number, Source, Written};
use std::ops::Range;
use toml::Spanned;

/// Values of both joints, base to tip, and where those stand that are in degrees.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointPair {
    pub values: [f64; 2],
    pub degrees: [Option<Range<usize>>; 2],
}

impl JointPair {
    /// Refuses degrees of joints that slide.
    ///
    /// # Errors
    /// At the first such value.
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

impl Reader<'_> {
    /// Converts an angle or the value of a joint.
    pub fn quantity(&self, written: &Written, what: &str) -> Result<f64, Diagnostic> {
        self.source.finite(&Number::new(written.span(), written.get_ref().value), what)
    }

    /// Values of both joints.
    pub fn joint_pair(&self, written: &Spanned<Vec<Written>>, what: &str) -> Result<JointPair, Diagnostic> {
        let [a, b] = &written.get_ref()[..] else {
            let message = format!("{what}: expected two numbers, found {}", written.get_ref().len());
            return Err(self.source.diagnostic_at(written.span(), message).help("joints = [q1, q2], base to tip"));
        };
        let values = [self.quantity(a, what)?, self.quantity(b, what)?];
        Ok(JointPair { values, degrees: [a, b].map(|w| w.get_ref().in_degrees.then(|| w.span())) })
    }
}
