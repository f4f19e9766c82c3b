//! From a certified path to a motion: corners and time.

use super::args::{number_in, seconds};
use super::failure::Failure;
use crate::certify::{CertifiedCurve, CertifiedPath, blend};
use crate::model::Problem;
use crate::trajectory::{Limits, Timed, TipSpeed, time};
use clap::Args;

/// How to drive along a path.
#[derive(Debug, Args)]
pub struct MotionArgs {
    /// Time between two samples of the trajectory, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds, allow_hyphen_values = true)]
    pub period: f64,
    /// Greatest distance from a corner at which the motion may leave the path to round it, in joint space (radians and
    /// metres as they come): "none" stops at every corner, "auto" lets the clearance and the path decide.
    #[arg(long, value_name = "RADIUS", default_value = "auto", value_parser = radius, allow_hyphen_values = true)]
    pub blend: Radius,
    /// Greatest speed of the tip, metres a second; without it the joints alone have limits.
    #[arg(long, value_name = "M_PER_S", value_parser = tip_speed, allow_hyphen_values = true)]
    pub tip_speed: Option<f64>,
}

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

impl MotionArgs {
    /// The motion along a path.
    ///
    /// # Errors
    /// A motion that lasts too long, or has too many samples.
    pub fn drive(&self, problem: &Problem, path: &CertifiedPath) -> Result<Timed, Failure> {
        let curve = match self.blend {
            Radius::None => CertifiedCurve::from(path.clone()),
            Radius::UpTo(greatest) => blend(&problem.scene, path, greatest, problem.scene.workspace.clearance),
        };
        let arm = &problem.scene.arm;
        let tip = self.tip_speed.map(|speed| TipSpeed { arm, speed });
        Ok(time(curve, &Limits { tip, ..Limits::from(&arm.joints) }, self.period)?)
    }
}
