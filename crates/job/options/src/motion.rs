//! Options for the motion along a path.

use super::names::{OBJECTIVES, word};
use super::number::{number_in, seconds};
use clap::Args;
use cplan_motion::{Drive, Objective};

/// Options for the motion along a path.
#[derive(Debug, PartialEq, Args)]
#[command(next_help_heading = "Motion limits")]
pub struct MotionArgs {
    /// Quantity to minimise: the length of the path, or the duration of the motion (this changes the shape of the
    /// path).
    #[arg(long, value_parser = word(OBJECTIVES), value_name = "WHAT", default_value = "length")]
    pub optimize: Objective,
    /// Time between two samples of the trajectory, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds, allow_hyphen_values = true)]
    pub period: f64,
    /// Radius within which the motion may round each corner of the path, in joint space (a radian counts like a metre).
    /// With "none", the arm stops at every corner; "auto" derives the radius from the clearance and the path.
    #[arg(long, value_name = "RADIUS", default_value = "auto", value_parser = radius, allow_hyphen_values = true)]
    pub blend: f64,
    /// Greatest speed of the tip, metres per second [default: only the joints' speeds are limited].
    #[arg(long, value_name = "M_PER_S", value_parser = tip_speed, allow_hyphen_values = true)]
    pub tip_speed: Option<f64>,
    /// Keep the joints' torques within the effort limits of the URDF or the world. Torques are computed from the masses
    /// of links and objects.
    #[arg(long)]
    pub torque: bool,
    /// Greatest jerk of each joint instead of the world's, such as 200,none: rad/s3 or m/s3, or "none" for no limit.
    #[arg(long, value_name = "j1,j2", value_parser = jerk, allow_hyphen_values = true)]
    pub jerk: Option<[Option<f64>; 2]>,
}

/// Parses the radius of blends, as in [`Drive::blend`].
fn radius(text: &str) -> Result<f64, String> {
    match (text, text.parse::<f64>()) {
        ("none", _) => Ok(0.0),
        ("auto", _) => Ok(f64::INFINITY),
        (_, Ok(radius)) if radius.is_finite() && radius > 0.0 => Ok(radius),
        _ => Err("must be none, auto, or a number greater than 0 (radians or metres of joint space)".into()),
    }
}

fn tip_speed(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "greater than 0 (metres per second)")
}

fn jerk(text: &str) -> Result<[Option<f64>; 2], String> {
    let one = |part: &str| match (part.trim(), part.trim().parse::<f64>()) {
        ("none", _) => Some(None),
        (_, Ok(jerk)) if jerk.is_finite() && jerk > 0.0 => Some(Some(jerk)),
        _ => None,
    };
    match text.split(',').map(one).collect::<Vec<_>>()[..] {
        [Some(first), Some(second)] => Ok([first, second]),
        _ => Err("must be two values, each a number greater than 0 (rad/s3 or m/s3) or none, such as 200,none".into()),
    }
}

impl MotionArgs {
    /// Returns the options as settings for driving.
    pub fn drive(&self) -> Drive {
        let Self { period, blend, tip_speed, torque, .. } = *self;
        Drive { optimize: self.optimize, period, blend, tip_speed, torque }
    }
}
