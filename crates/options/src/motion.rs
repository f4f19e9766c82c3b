//! How to drive along a path.

use super::names::word;
use super::number::{number_in, seconds};
use clap::Args;
use cplan_motion::{Drive, Objective};

/// How to drive along a path.
#[derive(Debug, Args)]
pub struct MotionArgs {
    /// What is to be the least: the length of the path, or the time of the motion, for which the path is given another shape.
    #[arg(long, value_parser = word::<Objective>(), value_name = "WHAT", default_value = "length")]
    pub optimize: Objective,
    /// Time between two samples of the trajectory, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01, value_parser = seconds, allow_hyphen_values = true)]
    pub period: f64,
    /// Greatest distance from a corner at which the motion may leave the path to round it, in joint space (radians and
    /// metres as they come): "none" stops at every corner, "auto" lets the clearance and the path decide.
    #[arg(long, value_name = "RADIUS", default_value = "auto", value_parser = radius, allow_hyphen_values = true)]
    pub blend: f64,
    /// Greatest speed of the tip, metres a second; without it the joints alone have limits.
    #[arg(long, value_name = "M_PER_S", value_parser = tip_speed, allow_hyphen_values = true)]
    pub tip_speed: Option<f64>,
    /// Keep the joints' torques within the efforts that the URDF or the world gives, by the links' and objects' masses.
    #[arg(long)]
    pub torque: bool,
    /// Greatest jerk of each joint instead of the world's, such as 200,none: rad/s3 or m/s3, "none" for a joint without.
    #[arg(long, value_name = "j1,j2", value_parser = jerk, allow_hyphen_values = true)]
    pub jerk: Option<Jerk>,
}

/// Greatest jerk of each joint that has one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jerk(pub [Option<f64>; 2]);

/// As [`Drive::blend`] has it.
fn radius(text: &str) -> Result<f64, String> {
    match (text, text.parse::<f64>()) {
        ("none", _) => Ok(0.0),
        ("auto", _) => Ok(f64::INFINITY),
        (_, Ok(radius)) if radius.is_finite() && radius > 0.0 => Ok(radius),
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
    /// Jerks in place of the joints' own, if any are given.
    pub fn jerk(&self) -> Option<[Option<f64>; 2]> {
        self.jerk.map(|Jerk(jerk)| jerk)
    }

    /// The same for the trajectory.
    pub fn drive(&self) -> Drive {
        let Self { period, blend, tip_speed, torque, .. } = *self;
        Drive { optimize: self.optimize, period, blend, tip_speed, torque }
    }
}
