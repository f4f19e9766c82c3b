//! Values of the joints that do not move: stated by the world, determined by a mimic rule, or else the default.

use super::chain::{Chooser, is_movable, unit};
use super::limits::{Limits, Range};
use crate::error::{Diagnostic, InputError};
use crate::quantity::{Quantity, find};
use cplan_model::space::JointRange;
use urdf_rs::{JointType, Mimic};

/// Values of all joints, with the list of held joints whose values affect the arm.
pub(super) struct HeldValues {
    pub values: Vec<f64>,
    pub held: Vec<usize>,
    pub notes: Vec<String>,
}

impl Chooser<'_> {
    fn mimicked_joint(&self, joint: usize, mimic: &Mimic) -> Result<usize, Diagnostic> {
        self.joint(&mimic.joint).ok_or_else(|| {
            let message = format!("mimics joint \"{}\", which does not exist", mimic.joint);
            self.mimic_diagnostic(joint, &message)
        })
    }

    /// Returns the joint at the end of a chain of mimic rules.
    pub(super) fn leader(&self, joint: usize) -> Result<usize, Diagnostic> {
        let mut at = joint;
        for _ in 0..=self.all().len() {
            match &self.all()[at].mimic {
                None => return Ok(at),
                Some(mimic) => at = self.mimicked_joint(at, mimic)?,
            }
        }
        Err(self.mimic_diagnostic(joint, "mimics itself, through a cycle of <mimic> elements"))
    }

    /// Returns the joint that a joint follows, with factor and offset. A joint without a mimic rule follows itself, with 1 and 0.
    pub(super) fn rule(&self, joint: usize) -> Result<(usize, f64, f64), Diagnostic> {
        let leader = self.leader(joint)?;
        let mut value = Affine { factor: 1.0, offset: 0.0 };
        let mut at = joint;
        while let Some(mimic) = &self.all()[at].mimic {
            value = value.compose_mimic(mimic);
            at = self.mimicked_joint(at, mimic)?;
        }
        Ok((leader, value.factor, value.offset))
    }

    /// Returns the value of every joint, and notes about the joints that matter to the arm.
    pub(super) fn values(&self, chosen: [usize; 2]) -> Result<HeldValues, InputError> {
        for name in self.settings.table.fixed.keys() {
            if chosen.iter().any(|j| self.all()[*j].name == *name.get_ref()) {
                let message = format!("[robot] fixed: joint \"{}\" is one of the two planned joints", name.get_ref());
                return Err(self
                    .in_world(name, message)
                    .help("remove the joint from `fixed`, or choose other `joints`")
                    .into());
            }
        }
        let mut values = vec![0.0; self.all().len()];
        let (mut held, mut notes) = (Vec::new(), Vec::new());
        for (j, joint) in self.all().iter().enumerate() {
            if chosen.contains(&j) || !is_movable(joint) || joint.mimic.is_some() {
                continue;
            }
            values[j] = self.held_at(j)?;
            if self.tree.carries(j, self.tree.child[chosen[1]]) || self.tree.carries(chosen[0], self.tree.child[j]) {
                held.push(j);
                notes.push(format!("joint \"{}\" is held at {} {}", joint.name, values[j], unit(joint)));
            }
        }
        for (j, joint) in self.all().iter().enumerate().filter(|(_, joint)| is_movable(joint)) {
            if joint.mimic.is_none() {
                continue;
            }
            let (leader, factor, offset) = self.rule(j)?;
            if let Some(name) = self.settings.table.fixed.keys().find(|n| *n.get_ref() == joint.name) {
                let message = format!("[robot] fixed: joint \"{}\" mimics \"{}\"", joint.name, self.all()[leader].name);
                return Err(self.in_world(name, message).help("state the value of the mimicked joint instead").into());
            }
            values[j] = factor * values[leader] + offset;
            if self.tree.carries(chosen[0], self.tree.child[j]) {
                let leader = &self.all()[leader].name;
                held.push(j);
                notes.push(format!(
                    "joint \"{}\" follows joint \"{leader}\": held at {} {}",
                    joint.name,
                    values[j],
                    unit(joint)
                ));
            }
        }
        Ok(HeldValues { values, held, notes })
    }

    /// Returns the value of a joint that does not move: that in the world, or else 0, or the limit nearest to 0.
    fn held_at(&self, index: usize) -> Result<f64, Diagnostic> {
        let joint = &self.all()[index];
        let range = Limits { document: self.document, settings: self.settings }.range(index)?;
        let Some(value) = find(&self.settings.table.fixed, &joint.name) else {
            return Ok(match range {
                Range::Known(JointRange::Interval { lower, upper })
                | Range::Taken(JointRange::Interval { lower, upper }, _) => 0f64.clamp(lower, upper),
                Range::Known(JointRange::Circle) | Range::Taken(JointRange::Circle, _) | Range::Unset(_) => 0.0,
            });
        };
        let Quantity { value: number, in_degrees } = *value.get_ref();
        if in_degrees && joint.joint_type == JointType::Prismatic {
            let message = format!("[robot] fixed: joint \"{}\" slides: its value cannot be in degrees", joint.name);
            return Err(self.in_world(value, message).help("write its value in metres, without \"deg\""));
        }
        if !number.is_finite() {
            return Err(self.in_world(value, format!("[robot] fixed: the value of \"{}\" is not finite", joint.name)));
        }
        match range {
            Range::Known(JointRange::Interval { lower, upper }) if number < lower || number > upper => {
                let unit = unit(joint);
                let message = format!(
                    "[robot] fixed: {number} {unit} is outside the limits of joint \"{}\", [{lower}, {upper}] {unit}",
                    joint.name
                );
                Err(self.in_world(value, message).help("choose a value within, or override [robot] limits"))
            }
            _ => Ok(number),
        }
    }
}

/// The map `x -> factor * x + offset`, composed along a chain of mimic rules.
struct Affine {
    factor: f64,
    offset: f64,
}

impl Affine {
    /// Composes this map with that of a mimic rule, which is applied first.
    fn compose_mimic(self, mimic: &Mimic) -> Self {
        let (multiplier, offset) = (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
        Affine { factor: self.factor * multiplier, offset: self.factor * offset + self.offset }
    }
}
