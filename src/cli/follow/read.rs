//! Reads the line.

use super::{FollowArgs, wrist};
use crate::cli::failure::Failure;
use crate::input::{self, Source, line_diagnostic, read_line};
use cplan_handling::FollowedLine;
use cplan_toolpath::{Format, Toolpath};
use std::ffi::OsStr;
use std::sync::Arc;

/// Reads the line that the arguments name, and places it. Tolerance, speed and tool angle on the command line override
/// those of the file.
///
/// # Errors
/// A file that cannot be read, or a part of it that the tip cannot follow, with line, column and a hint.
pub fn line(args: &FollowArgs) -> Result<FollowedLine, Failure> {
    let line = if args.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(OsStr::new("toml"))) {
        in_toml(args)?
    } else {
        in_other_format(args)?.into()
    };
    let (tolerance, speed) = (args.tolerance.unwrap_or(line.tolerance), args.speed.or(line.speed));
    let wrist = wrist::guide(args, line.wrist)?;
    let path = match args.pen_time {
        Some(seconds) => Arc::new(with_rests(&line.path, seconds).map_err(|error| defect(args, error))?),
        None => line.path,
    };
    Ok(FollowedLine { path, tolerance, speed, wrist, elbow: args.elbow.or(line.elbow) })
}

/// Returns a line with a rest at both ends of each travel.
fn with_rests(path: &Toolpath, seconds: f64) -> Result<Toolpath, cplan_toolpath::Error> {
    let mut pieces = path.pieces().to_vec();
    for k in 1..pieces.len() {
        if pieces[k - 1].is_travel != pieces[k].is_travel {
            let dwell = pieces[k - 1].dwell.unwrap_or(0.0) + seconds;
            pieces[k - 1].dwell = Some(dwell);
        }
    }
    Toolpath::new(pieces).map(|rested| rested.with_notes(path.notes().to_vec()))
}

/// Reads a file with the keys of a step's table `follow`. First its own keys place the line, and then the arguments do.
fn in_toml(args: &FollowArgs) -> Result<FollowedLine, Failure> {
    if args.unit.is_some() {
        return Err(Failure::Usage("a line in TOML is in metres; leave out --unit".into()));
    }
    let line = read_line(&Source::read(&args.path)?)?;
    let placed = line.path.placed(&args.placement()).map_err(|error| defect(args, error))?;
    Ok(FollowedLine { path: Arc::new(placed), ..line })
}

fn in_other_format(args: &FollowArgs) -> Result<Toolpath, Failure> {
    let format = Format::from_path(&args.path).ok_or_else(|| {
        let file = args.path.display();
        Failure::Usage(format!("{file}: the name of a line must end in .gcode, .nc, .ngc, .tap, .svg or .toml"))
    })?;
    let bytes = input::read_bytes(&args.path)?;
    cplan_toolpath::read(&bytes, format, &args.placement()).map_err(|error| defect(args, error))
}

fn defect(args: &FollowArgs, error: cplan_toolpath::Error) -> Failure {
    Failure::Input(line_diagnostic(args.path.display().to_string(), error).into())
}
