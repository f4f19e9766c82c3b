//! The arguments of `cplan follow`.

use super::fit::Freedom;
use super::wrist::{tool_angle, tool_tolerance};
use crate::cli::files::Files;
use crate::cli::headings::OUTPUT;
use crate::cli::print_args::PrintArgs;
use crate::cli::theme::ThemeArgs;
use crate::cli::values::{clearance, displacement, tolerance, turn};
use crate::input::CalibrationTable;
use crate::model::Elbow;
use crate::options::{positive, word};
use clap::{Args, ValueHint};
use cplan_follow::Settings;
use cplan_handling::ToolAngle;
use cplan_toolpath::{Placement, Unit};
use std::path::PathBuf;

/// Move the tip along a line: G-code, SVG or TOML.
#[derive(Debug, Args)]
#[command(after_help = "\
The tip stays within the tolerance of the line and follows it in its order, also
between samples. The motion is certified free of collision, and as fast as the
limits of the joints and of the tip allow. If there is no motion, the answer
names the place. The line is scaled, then turned, then moved.

Examples:
  cplan follow robots/planar_2r.urdf workspaces/follow/engraving.toml \\
    workspaces/follow/plate.gcode
  cplan follow robots/planar_2r.urdf workspaces/follow/engraving.toml \\
    workspaces/follow/plate.gcode --speed 0.1 --output plate.yaml \\
    --picture plate.html
  cplan follow robots/planar_2r.urdf workspaces/follow/engraving.toml \\
    workspaces/follow/plate.gcode --tolerance 0.0001 --move 0.05,0 --json
  cplan follow robots/planar_2r.urdf workspaces/follow/engraving.toml \\
    workspaces/follow/plate.gcode --fit --output plate.yaml

Exit codes: 0 found and certified, 1 bad input or I/O, 2 wrong command line, 3
proven infeasible, 4 unknown.")]
pub struct FollowArgs {
    #[command(flatten)]
    pub files: Files,
    /// Line: G-code (.gcode, .nc, .ngc, .tap), a drawing (.svg), or the keys of a step's `follow` (.toml).
    #[arg(value_name = "PATH", value_hint = ValueHint::FilePath)]
    pub path: PathBuf,
    /// Greatest distance of the tip from the line, metres or with a unit such as 0.05mm [default: the tolerance in a
    /// TOML line, or else 0.00001].
    #[arg(long, value_name = "LENGTH", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Greatest speed of the tip, metres per second, instead of the speeds (F) of the file.
    #[arg(long, value_name = "M/S", value_parser = positive)]
    pub speed: Option<f64>,
    /// Time for which the arm rests at both ends of each travel, so that the pen can move, seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub pen_time: Option<f64>,
    /// Angle of the tool, which the wrist keeps along the line: radians from the x axis, or degrees such as 90deg;
    /// tangent for the direction of the line; or tangent+ANGLE. Replaces the angle in a TOML line.
    #[arg(long, value_name = "ANGLE", value_parser = tool_angle, allow_hyphen_values = true)]
    pub wrist: Option<ToolAngle>,
    /// Greatest difference from the angle of the tool, radians [default: the value in a TOML line, or else 0.01].
    #[arg(long, value_name = "RADIANS", value_parser = tool_tolerance)]
    pub wrist_tolerance: Option<f64>,
    /// Side of the elbow along the line, seen from joint 1 towards the tip. Replaces the side in a TOML line. By
    /// default, both sides are allowed.
    #[arg(long, value_name = "SIDE", value_parser = word(Elbow::ALL.map(|own| (own, own.name(), ""))))]
    pub elbow: Option<Elbow>,
    /// Unit of the line's numbers, instead of the unit that the file states: mm, cm, dm, m, km, um, mil, in, ft, yd or
    /// px.
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Factor by which the line is scaled about its origin. Speeds of the file stay the same.
    #[arg(long, value_name = "FACTOR", value_parser = positive, default_value_t = 1.0)]
    pub scale: f64,
    /// Angle by which the line is turned about its origin: radians, or degrees such as 90deg.
    #[arg(long, value_name = "ANGLE", value_parser = turn, allow_hyphen_values = true, default_value_t = 0.0)]
    pub turn: f64,
    /// New position of the line's origin, metres.
    #[arg(long = "move", value_name = "x,y", value_parser = displacement, allow_hyphen_values = true)]
    pub shift: Option<[f64; 2]>,
    /// Search for a position of the line's origin (--fit), or also for its angle in steps of 10 degrees (--fit=turn).
    /// There, the arm can follow the whole line without a change of the IK solution, far from places that it cannot
    /// reach. The answer states the options that repeat the placement.
    #[arg(long, value_name = "turn", num_args = 0..=1, require_equals = true, default_missing_value = "move",
        value_parser = word([(Freedom::Move, "move", ""), (Freedom::Turn, "turn", "")]), conflicts_with = "shift")]
    pub fit: Option<Freedom>,
    /// Least distance to keep from every obstacle, metres or as in 20mm, instead of the world's.
    #[arg(long, value_name = "METRES", value_parser = clearance)]
    pub clearance: Option<f64>,
    /// Errors within which the answer holds, instead of the world's, such as
    /// "base=0.5mm,0.05deg; links=0.2mm; zeros=0.02deg; obstacles=1mm".
    #[arg(long, value_name = "KEY=VALUE,..")]
    pub calibration: Option<CalibrationTable>,
    /// Time between two samples of the motion, seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = Settings::default().period)]
    pub period: f64,
    /// Write the answer (.json) or the motion (.csv, .yaml for a ROS 2 JointTrajectory). Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub output: Vec<PathBuf>,
    /// Draw the line and the motion in workspace and configuration space: .svg, .png or .html. Can be repeated.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub picture: Vec<PathBuf>,
    /// Write the evidence for the answer, found or infeasible. `cplan-check URDF WORLD FILE` checks it in exact
    /// arithmetic. If FILE is also a .json of --output, the evidence becomes the member `certificate` of that file.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = OUTPUT)]
    pub certificate: Option<PathBuf>,
    #[command(flatten)]
    pub theme: ThemeArgs,
    #[command(flatten)]
    pub print: PrintArgs,
    /// Also print the pieces of the line, and each change of the IK solution.
    #[arg(long, short, help_heading = OUTPUT)]
    pub verbose: bool,
}

impl FollowArgs {
    /// Returns the place of the line in the plane. If a placement is searched for, the line is read without one.
    pub(super) fn placement(&self) -> Placement {
        match self.fit {
            Some(_) => Placement { unit: self.unit, ..Placement::default() },
            None => self.stated_placement(),
        }
    }

    /// Returns the placement that the options state.
    pub(super) fn stated_placement(&self) -> Placement {
        Placement { unit: self.unit, scale: self.scale, turn: self.turn, shift: self.shift.unwrap_or_default() }
    }
}
