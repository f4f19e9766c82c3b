//! From a certified path to a motion: corners and time.

use super::args::{number_in, seconds};
use super::failure::Failure;
use crate::certify::{CertifiedCurve, CertifiedPath, blend};
use crate::model::{Joint, Problem};
use crate::trajectory::{Limits, Timed, TipSpeed, time};
use clap::Args;

/// How to drive along a path.
#[derive(Debug, Args)]
pub struct MotionArgs {
    /// Time between two samples of the trajectory, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds, allow_hyphen_values = true)]
    pub period: f64,
    /// Greatest distance from a corner at which the motion may leave the path to round it, in joint space (radians and
    /// metres as they come): "none" stops at every corner, "auto" lets the clearance and the path decide. With a limit on
    /// a jerk the motion stops at every corner.
    #[arg(long, value_name = "RADIUS", default_value = "auto", value_parser = radius, allow_hyphen_values = true)]
    pub blend: Radius,
    /// Greatest speed of the tip, metres a second; without it the joints alone have limits.
    #[arg(long, value_name = "M_PER_S", value_parser = tip_speed, allow_hyphen_values = true)]
    pub tip_speed: Option<f64>,
    /// Greatest jerk of each joint instead of the world's, such as 200,none: rad/s3 or m/s3, "none" for a joint without.
    #[arg(long, value_name = "j1,j2", value_parser = jerk, allow_hyphen_values = true)]
    pub jerk: Option<Jerk>,
}

/// Greatest jerk of each joint that has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jerk(pub [Option<f64>; 2]);

/// How far corners may be rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Radius {
    /// Not at all.
    None,
    /// Up to a radius, which may be infinite.
    UpTo(f64),
}

fn radius(text: &str) -> Result<Radius, String> {
    match (text, text.parse::<f64>()) {
        ("none", _) => Ok(Radius::None),
        ("auto", _) => Ok(Radius::UpTo(f64::INFINITY)),
        (_, Ok(radius)) if radius.is_finite() && radius > 0.0 => Ok(Radius::UpTo(radius)),
        _ => Err("must be none, auto, or a number of more than 0 (radians or metres of joint space)".into()),
    }
}

fn tip_speed(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "of more than 0 (metres a second)")
}

fn jerk(text: &str) -> Result<Jerk, String> {
    let one = |part: &str| match (part.trim(), part.trim().parse::<f64>()) {
        ("none", _) => Some(None),
        (_, Ok(jerk)) if jerk.is_finite() && jerk > 0.0 => Some(Some(jerk)),
        _ => None,
    };
    match text.split(',').map(one).collect::<Vec<_>>()[..] {
        [Some(first), Some(second)] => Ok(Jerk([first, second])),
        _ => Err("must be two numbers of more than 0 (rad/s3 or m/s3), or none, such as 200,none".into()),
    }
}

impl MotionArgs {
    /// Puts the limits that the command line gives in place of the joints' own.
    pub fn override_limits(&self, joints: &mut [Joint; 2]) {
        if let Some(Jerk(jerk)) = self.jerk {
            for (joint, jerk) in joints.iter_mut().zip(jerk) {
                joint.jerk = jerk;
            }
        }
    }

    /// The motion along a path.
    ///
    /// # Errors
    /// A motion that lasts too long, or has too many samples.
    pub fn drive(&self, problem: &Problem, path: &CertifiedPath) -> Result<Timed, Failure> {
        let arm = &problem.scene.arm;
        let tip = self.tip_speed.map(|speed| TipSpeed { arm, speed });
        let limits = Limits { tip, ..Limits::from(&arm.joints) };
        let curve = match self.blend {
            Radius::UpTo(greatest) if !limits.stops_at_corners() => {
                blend(&problem.scene, path, greatest, problem.scene.workspace.clearance)
            }
            _ => CertifiedCurve::from(path.clone()),
        };
        Ok(time(curve, &limits, self.period)?)
    }
}
