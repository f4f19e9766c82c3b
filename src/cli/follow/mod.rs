//! `cplan follow`: moves the tip along a line.

mod args;
mod certificate;
mod files;
mod fit;
mod json;
mod picture;
mod read;
mod words;
mod wrist;

pub use args::FollowArgs;
pub use picture::resting;

use super::exit::code_of;
use super::failure::Failure;
use super::outputs::refuse_to_overwrite_inputs;
use super::sinks;
use crate::input::{self, Digests, InputError, LoadedScene};
use crate::model::Elbow;
use cplan_follow::{FollowError, Followed, Settings, follow};
use cplan_handling::FollowedLine;
use cplan_toolpath::Toolpath;
use std::sync::Arc;
use wrist::FollowingWrist;

/// A line with its robot, its world and the answer.
struct Answered<'a> {
    args: &'a FollowArgs,
    loaded: &'a LoadedScene,
    line: &'a Toolpath,
    /// Greatest distance of the tip from the line, metres.
    tolerance: f64,
    /// Greatest speed of the tip, metres per second, instead of the speeds of the line.
    speed: Option<f64>,
    /// The side of the elbow along the line. `None` for either side.
    elbow: Option<Elbow>,
    /// The wrist that turns the tool. `None` if the angle of the tool does not matter.
    wrist: Option<&'a FollowingWrist>,
    answer: &'a Followed,
    /// The placement that the search found.
    placed: Option<fit::Placed>,
    /// For each sample of the motion, true if the tool is on the line. Empty without a motion or without travels.
    tool: Vec<bool>,
    /// The digests of the robot's and the world's files, for a certificate.
    digests: Option<Digests>,
}

/// Follows a line, and prints and writes the answer.
///
/// # Errors
/// Bad input and I/O, and options that do not suit the robot.
pub fn run(args: &FollowArgs) -> Result<u8, Failure> {
    let load = |wrist_turns: bool| match wrist_turns {
        true => input::load_scene_with_turning_wrist(args.files.robot(), &args.files.world),
        false => input::load_scene(args.files.robot(), &args.files.world),
    };
    answer(args, load, read::line)
}

/// Follows the line from `read_line` in the scene from `load`. The argument of `load` is true if the wrist turns.
///
/// # Errors
/// Same as for [`run`].
pub fn answer(
    args: &FollowArgs,
    load: impl FnOnce(bool) -> Result<LoadedScene, InputError>,
    read_line: impl FnOnce(&FollowArgs) -> Result<FollowedLine, Failure>,
) -> Result<u8, Failure> {
    let outputs = files::outputs(args)?;
    let line = read_line(args)?;
    let loaded = load(line.wrist.is_some())?.with_margins(args.clearance, args.calibration)?;
    loaded.require_static_obstacles("lines can be followed only if all obstacles are static")?;
    let read: Vec<_> = loaded.files().into_iter().chain([args.path.clone()]).collect();
    refuse_to_overwrite_inputs(outputs.paths(), &read)?;
    let digests = || Digests::of(&args.files.robot(), &args.files.world, &loaded.files());
    let digests = args.certificate.as_ref().map(|_| digests()).transpose()?;
    let wrist = FollowingWrist::new(&line, &loaded)?;
    if !args.print.quiet {
        loaded.robot.warnings.iter().for_each(|warning| sinks::print_status(&format!("warning: {warning}")));
    }
    let FollowedLine { path, tolerance, speed, elbow, .. } = line;
    if elbow.is_some() && !loaded.scene.arm().only_turns() {
        let message = "only arms with two revolute joints have an elbow; leave out the side of the elbow";
        return Err(Failure::Refused(format!("{}: {message}", args.path.display())));
    }
    let along = wrist.as_ref().map(|wrist| wrist.along);
    let settings = Settings { tolerance, speed, period: args.period, wrist: along, elbow, ..Settings::default() };
    let (path, answer, placed) = match args.fit {
        None => (path.clone(), follow(&loaded.scene, &path, &settings).map_err(refused)?, None),
        Some(freedom) => {
            let (fitted, placed) = fit::search(args, freedom, &loaded.scene, &path, &settings)?;
            (Arc::new(fitted.path), fitted.answer, placed)
        }
    };
    let wrist = wrist.as_ref();
    let has_travels = path.pieces().iter().any(|piece| piece.is_travel);
    let found = answer.found().filter(|_| has_travels);
    let tool = found.map_or_else(Vec::new, |found| found.tool(loaded.scene.arm(), &path, tolerance));
    let (loaded, line, answer) = (&loaded, &*path, &answer);
    let answered = Answered { tool, args, loaded, line, tolerance, speed, elbow, wrist, answer, placed, digests };
    files::write(&outputs, &answered)?;
    let code = code_of(answer.status());
    args.print.report(code, || sinks::pretty(&json::object(&answered)), || words::summary(&answered))?;
    Ok(code)
}

fn refused(error: FollowError) -> Failure {
    match error {
        FollowError::Timing(error) => Failure::Trajectory(error),
        error => Failure::Refused(error.to_string()),
    }
}
