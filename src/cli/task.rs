//! The main job for a world with steps: from two files to a sequence of certified motions, or to the step that fails.

use super::args::PlanArgs;
use super::failure::Failure;
use super::output::{self, Sink};
use super::plan::effort;
use super::summary::Clock;
use super::task_files::TaskFiles;
use super::{DONE, INFEASIBLE, UNKNOWN, task_summary};
use crate::input::LoadedScene;
use crate::plan::FieldPlanner;
use crate::solve::Method;
use crate::task::{Manner, TaskReport, TaskVerdict, plan};
use crate::trajectory::SearchUsed;

/// Plans, writes what was asked for, and returns the exit code.
///
/// # Errors
/// Bad input and I/O, and options that mean nothing for a sequence of motions.
pub fn run(
    loaded: LoadedScene,
    args: &PlanArgs,
    field: Option<FieldPlanner>,
    sinks: &[Sink],
    mut clock: Clock,
) -> Result<u8, Failure> {
    if let Some(conflict) = conflict(args) {
        return Err(Failure::Usage(conflict.into()));
    }
    let mut loaded = loaded.task(&args.query.overrides())?;
    args.motion.override_limits(&mut loaded.task.arm.joints);
    let task = &loaded.task;
    let files = TaskFiles::new(sinks, args.per_step, task.steps().count())?;
    clock.stage("load");
    let say = |text: &str| {
        if !args.quiet {
            output::say(text);
        }
    };
    loaded.robot.warnings.iter().for_each(|w| say(&format!("warning: {w}")));
    let effort = effort(&loaded.scene, args, field)?;
    let manner = Manner { method: args.planner, effort, drive: args.motion.drive() };
    let answer = plan(task, &manner, &mut |text| say(text));
    clock.stage("plan");
    let mut report = TaskReport::new(args.planner.name(), task, &answer);
    report.search = (args.planner == Method::Wavefront).then(|| SearchUsed::from(effort.wavefront));
    clock.stage("report");
    if args.timings {
        report.timings = clock.milliseconds();
    }
    let written = files.write(&report)?;
    clock.stage("write");
    if args.json {
        output::print(&report.json())?;
    } else if !args.quiet {
        output::print(&task_summary::text(&loaded, &answer, &report, field.as_ref(), &written, &clock))?;
    }
    Ok(match answer.verdict {
        TaskVerdict::Done => DONE,
        TaskVerdict::Infeasible(_) => INFEASIBLE,
        TaskVerdict::Unknown(_) => UNKNOWN,
    })
}

/// What of the options means nothing for steps, if there is something.
fn conflict(args: &PlanArgs) -> Option<&'static str> {
    if args.optimum.gap.is_some() {
        return Some("--gap is for a single motion; what is proven of a sequence of steps is part of every answer");
    }
    if !args.picture.is_empty() {
        return Some("--picture is for a single motion; a world with steps is not drawn");
    }
    None
}
