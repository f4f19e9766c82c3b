//! The main job: from two files to a certified motion, a proof, or neither.

use super::args::{Files, PlanArgs};
use super::failure::Failure;
use super::result_files::ResultFiles;
use super::sinks::{self, Sink};
use super::{DONE, INFEASIBLE, UNKNOWN, words};
use crate::engine::{Options, Plan, Planner, Problem, plan_with};
use crate::input::{self, Digests, InputError, JointValues, LoadedScene, Overrides};
use crate::model::{MotionProblem, Status};
use crate::motion::write_whole;
use crate::output::{CSpaceFormat, PlanOutput as _, summary_with};
use crate::space::Configuration;
use std::path::Path;
use std::time::Instant;

/// Plans, writes what was asked for, and returns the exit code.
///
/// # Errors
/// Bad input and I/O.
pub fn run(files: &Files, args: &PlanArgs) -> Result<u8, Failure> {
    answer(args, Some(files), || input::load_scene(files.robot(), &files.world))
}

/// The same for a scene from anywhere, if need be from no files. Nothing is loaded if the command line is wrong.
///
/// # Errors
/// Bad input and I/O.
pub fn answer(
    args: &PlanArgs,
    given: Option<&Files>,
    load: impl FnOnce() -> Result<LoadedScene, InputError>,
) -> Result<u8, Failure> {
    let certificate = args.certificate.as_deref();
    let within = certificate.filter(|path| sinks::is_json_among(path, &args.output));
    let sinks = sinks::sinks_with(&args.output, &args.picture, certificate.filter(|_| within.is_none()))?;
    let options = words::options(args.planner, &args.options, &args.motion, &args.message)?;
    let options = Options { timings: args.timings, ..options };
    require_grid(&sinks, &options.planner)?;
    let begun = Instant::now();
    let loaded = load()?;
    let given = given.filter(|_| certificate.is_some());
    let about = given.map(|files| Digests::of(&files.robot(), &files.world)).transpose()?;
    sinks::spare_inputs(sinks.iter().map(Sink::path))?;
    if args.per_step && !loaded.has_steps() {
        return Err(Failure::Usage("--per-step is for worlds with steps".into()));
    }
    let asked = args.query.overrides();
    let said = loaded.said_ends();
    // They may be why start or goal is refused.
    loaded.robot.warnings.iter().for_each(|w| args.print.say(&format!("warning: {w}")));
    let problem = Problem::of_scene(loaded, &asked)?.read_since(begun);
    if let Some(lack) = options.planner.lack(&problem.scene().workspace().preferences) {
        return Err(Failure::Usage(lack));
    }
    let steps = problem.task().map_or(1, |task| task.steps().count());
    let files = ResultFiles::new(&sinks, args.per_step, steps)?;
    let plan = plan_with(&problem, &options, &mut |text| args.print.say(text))?;
    let begun = Instant::now();
    // Where ends were found from a place of the tip, or put at a limit, the certificate says them.
    let start = problem.motion().map(MotionProblem::start).or(problem.task().map(|task| task.start));
    let goal = problem.motion().filter(|_| said[1].is_some()).map(|motion| motion.goals().pieces()[0].ends()[0]);
    let asked = with_ends(asked, said, [start, goal]);
    let written = written(&plan, &sinks, &files, (&asked, about.as_ref()), args)?;
    let after = [("write", begun.elapsed())];
    let code = match plan.status() {
        Status::Found => DONE,
        Status::Infeasible => INFEASIBLE,
        Status::Unknown => UNKNOWN,
    };
    args.print.tell(code, || Ok(plan.to_json()), || summary_with(&plan, &written, &after, args.verbose))?;
    Ok(code)
}

/// What was asked, with the start and the goal that were found where the files do not say them as joint values.
pub fn with_ends(
    asked: Overrides,
    said: [Option<Configuration>; 2],
    [start, goal]: [Option<Configuration>; 2],
) -> Overrides {
    let implied = |end: Option<Configuration>, said| end.filter(|_| end != said).map(JointValues::from);
    Overrides {
        start: asked.start.or(implied(start, said[0])),
        goal: asked.goal.or(implied(goal, said[1]).filter(|_| asked.goal_tip.is_none())),
        ..asked
    }
}

/// Refuses a matrix of a grid's values where the planner has no grid.
fn require_grid(sinks: &[Sink], planner: &Planner) -> Result<(), Failure> {
    let matrix = sinks.iter().find(|sink| matches!(sink, Sink::CSpace(CSpaceFormat::Csv, _)));
    match matrix {
        Some(sink) if planner.space().is_none() => Err(Failure::Usage(format!(
            "{} holds the values of a grid: it needs --planner wavefront or harmonic",
            sink.path().display()
        ))),
        _ => Ok(()),
    }
}

/// Writes results, then configuration spaces, pictures and the certificate. The names of the files that are written, for people.
///
/// # Errors
/// I/O, or a picture that cannot be made of pixels.
fn written(
    plan: &Plan,
    sinks: &[Sink],
    files: &ResultFiles,
    (asked, about): (&Overrides, Option<&Digests>),
    args: &PlanArgs,
) -> Result<Vec<String>, Failure> {
    let certificate = args.certificate.as_deref().and_then(|path| match plan.certificate(asked, about) {
        Ok(certificate) => Some((path, certificate)),
        Err(why) => {
            sinks::say(&format!("warning: {} is not written: {why}", shown(path, sinks)));
            None
        }
    });
    let certificate = certificate.as_ref().map(|(path, certificate)| (*path, certificate.as_str()));
    let mut written = files.write(plan, certificate)?;
    let plays = sinks.iter().any(|sink| matches!(sink, Sink::Picture(format, _) if format.plays()));
    let seen = || {
        let view = if plays { plan.view_with_replay() } else { plan.view() };
        view.with_field_lines(args.field_lines.into())
    };
    let (mut view, mut spaces) = (None, None);
    for sink in sinks {
        match sink {
            Sink::Result(..) => continue,
            Sink::CSpace(format, path) => match format.text(spaces.get_or_insert_with(|| plan.cspaces())) {
                Some(text) => write_whole(path, text.as_bytes())?,
                None => {
                    sinks::warn_unwritten(path, "grid");
                    continue;
                }
            },
            Sink::Picture(format, path) => {
                let mut progress = sinks::pictures_done(path, &args.print);
                write_whole(path, &format.bytes_with(view.get_or_insert_with(seen), &mut progress)?)?;
            }
            Sink::Certificate(path) => match certificate {
                Some((_, certificate)) => write_whole(path, certificate.as_bytes())?,
                None => continue,
            },
        }
        written.push(sink.path().display().to_string());
    }
    Ok(written)
}

/// What would be written of a certificate: a file, or a part of one.
fn shown(path: &Path, sinks: &[Sink]) -> String {
    let is_file = sinks.iter().any(|sink| matches!(sink, Sink::Certificate(own) if own == path));
    if is_file { path.display().to_string() } else { format!("the certificate in {}", path.display()) }
}
