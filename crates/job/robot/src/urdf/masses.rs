//! Masses of the two arm links, and efforts of their joints.

use super::bodies::Bodies;
use super::limits::key;
use super::plane::project;
use super::tree::isometry;
use crate::error::Diagnostic;
use crate::quantity::find;
use crate::settings::RobotSettings;
use cplan_dynamics::{Torques, joined};
use cplan_geometry::Vector;
use cplan_model::{Arm, Body, Dynamics};
use nalgebra::{Matrix3, Vector3};

/// Default acceleration of free fall, in m/s2, in the root frame, whose z axis points up.
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Relative size of rounding errors. A joint moves no mass if the determinant of an inertia matrix is below this share of the
/// product of its diagonal. An effort counts as zero if it is below this share of the effort for the greatest inertia.
const NEGLIGIBLE_SHARE: f64 = 1e-12;

/// Checks the world's efforts and gravity, even if they are not used.
///
/// # Errors
/// The first invalid value.
pub(super) fn check(settings: RobotSettings) -> Result<(), Diagnostic> {
    let bad =
        settings.table.effort.iter().find(|(_, effort)| !(effort.get_ref().is_finite() && *effort.get_ref() > 0.0));
    if let Some((joint, effort)) = bad {
        let (joint, value) = (joint.get_ref(), effort.get_ref());
        let message = format!("[robot] effort of \"{joint}\" must be positive, is {value}");
        return Err(settings.source.diagnostic_at(effort.span(), message).help("N m, or N for a joint that slides"));
    }
    let Some(given) = &settings.table.gravity else { return Ok(()) };
    let numbers: Vec<f64> = given.get_ref().iter().map(|number| *number.get_ref()).collect();
    if numbers.len() == 3 && numbers.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    let message = format!("[robot] gravity: expected three finite numbers, found {numbers:?}");
    let help = "gravity = [0, 0, -9.81], m/s2 in the robot's root frame";
    Err(settings.source.diagnostic_at(given.span(), message).help(help))
}

impl Bodies<'_> {
    /// Returns masses and efforts of an arm. `motors` has the efforts of the joints according to those of the motors.
    ///
    /// # Errors
    /// Links without mass, joints without effort, and values that are impossible for a rigid body.
    pub fn dynamics(&self, arm: &Arm, assumed: [bool; 2], motors: [Option<f64>; 2]) -> Result<Dynamics, Diagnostic> {
        check(self.settings)?;
        let effort = |k: usize| match (self.effort(k), motors[k]) {
            (Ok(own), Some(motor)) => Ok(own.min(motor)),
            (Err(_), Some(motor)) => Ok(motor),
            (own, None) => own,
        };
        let effort = [effort(0)?, effort(1)?];
        let bodies = [self.body(0)?, self.body(1)?];
        let gravity = self.gravity();
        let gravity = Vector::new(gravity.dot(&self.plane.u), gravity.dot(&self.plane.v));
        let dynamics = Dynamics { bodies, gravity, effort, assumed, limits: false };
        let torques = Torques { arm, dynamics };
        let inertia = torques.greatest_inertia();
        let acceleration = torques.greatest_accelerations();
        if inertia.iter().flatten().chain(&acceleration).all(|value| value.is_finite())
            && (0..2).all(|k| effort[k] > NEGLIGIBLE_SHARE * inertia[k][k] * acceleration[k])
        {
            return Ok(dynamics);
        }
        let is_moved = torques.least_determinant() > NEGLIGIBLE_SHARE * inertia[0][0] * inertia[1][1];
        let (message, help) = if is_moved {
            (
                "the efforts of the joints are far too small for the velocities, masses and gravity",
                "check the units: kg, m, N m (N for a joint that slides), rad/s (m/s), m/s2",
            )
        } else {
            ("one of the two joints moves no inertia", "add an <inertial> with <mass> and <inertia> to its link")
        };
        Err(self.document.source.diagnostic(message).help(help))
    }

    fn effort(&self, index: usize) -> Result<f64, Diagnostic> {
        let joint = &self.document.robot.joints[self.chain.joints[index]];
        let place = &self.document.joints[self.chain.joints[index]];
        if let Some(given) = find(&self.settings.table.effort, &joint.name) {
            return Ok(*given.get_ref());
        }
        if joint.limit.effort.is_finite() && joint.limit.effort > 0.0 && place.limit.is_some() {
            return Ok(joint.limit.effort);
        }
        let message = format!("joint \"{}\" has no effort", joint.name);
        let help = format!(
            "effort=\"50\" in its <limit>, or in the world file: [robot] effort = {{ {} = 50 }} (N m, or N for a joint that slides)",
            key(&joint.name)
        );
        Err(self.document.diagnostic_at(place.limit.as_ref().unwrap_or(&place.at), message).help(help))
    }

    /// Returns the mass properties of an arm link, in its frame.
    fn body(&self, index: usize) -> Result<Body, Diagnostic> {
        let joint = self.joint_at(index).0;
        let mut whole = Body::NONE;
        for body in self.bodies(index) {
            let link = &self.document.robot.links[body];
            let inertial = &link.inertial;
            let mass = inertial.mass.value;
            let pose = self.poses[body] * isometry(&inertial.origin);
            let i = &inertial.inertia;
            let tensor = Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
            let normal = pose.inverse_transform_vector(&self.plane.normal);
            let inertia = normal.dot(&(tensor * normal));
            if mass < 0.0 || inertia < 0.0 {
                let message =
                    format!("link \"{}\" has a mass of {mass} kg and an inertia of {inertia} kg m2", link.name);
                let at = &self.document.links[body].at;
                return Err(self.document.diagnostic_at(at, message).help("neither can be negative"));
            }
            let center = project(self.plane, &pose.translation.vector) - joint;
            whole = joined(&whole, &Body { mass, center, inertia });
        }
        if whole.mass > 0.0 {
            return Ok(whole);
        }
        let link = self.tree.child[self.chain.joints[index]];
        let message = format!("link \"{}\" has no mass", self.tree.links[link]);
        let help = "give it an <inertial> with <origin>, <mass> and <inertia>";
        Err(self.document.source.diagnostic(message).help(help))
    }

    fn gravity(&self) -> Vector3<f64> {
        let given = self.settings.table.gravity.as_ref();
        let numbers = given.map(|given| given.get_ref().iter().map(|number| *number.get_ref()));
        numbers.map_or(GRAVITY.into(), Vector3::from_iterator)
    }
}
