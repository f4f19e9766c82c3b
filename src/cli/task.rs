//! The main job for a world with steps: from two files to a sequence of certified motions, or to the step that fails.

use super::args::PlanArgs;
use super::failure::Failure;
use super::output::{self, Sink};
use super::plan::effort;
use super::summary::{Clock, counted};
use super::task_files::TaskFiles;
use super::{DONE, INFEASIBLE, UNKNOWN, task_summary};
use crate::draw::TaskPicture;
use crate::engine::Method;
use crate::engine::task::{Manner, TaskAnswer, TaskReport, TaskVerdict, plan};
use crate::input::{LoadedScene, LoadedTask};
use crate::motion::SearchUsed;
use crate::planner::FieldPlanner;

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
    if args.optimum.gap.is_some() {
        let message = "--gap is for a single motion; what is proven of a sequence of steps is part of every answer";
        return Err(Failure::Usage(message.into()));
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
    args.message.apply_to_task(&mut report, &loaded, &answer)?;
    report.search = (args.planner == Method::Wavefront).then(|| SearchUsed::from(effort.wavefront));
    report.assumed = loaded.robot.assumed.clone();
    clock.stage("report");
    if args.timings {
        report.timings = clock.milliseconds();
    }
    let mut written = files.write(&report)?;
    for sink in sinks {
        if let Sink::Picture(format, path) = sink {
            let facts = || task_summary::facts(&loaded.task, &answer, &report);
            output::save_task_picture(*format, path, &picture(&loaded, &answer, &report), facts)?;
            written.push(path.display().to_string());
        }
    }
    clock.stage("write");
    if args.json {
        output::print_json(&report.json())?;
    } else if !args.quiet {
        output::tell(&task_summary::text(&loaded, &answer, &report, field.as_ref(), &written, &clock))?;
    }
    Ok(match answer.verdict {
        TaskVerdict::Done => DONE,
        TaskVerdict::Infeasible(_) => INFEASIBLE,
        TaskVerdict::Unknown(_) => UNKNOWN,
    })
}

/// What a picture of the task shows.
pub(super) fn picture<'a>(loaded: &'a LoadedTask, answer: &'a TaskAnswer, report: &TaskReport) -> TaskPicture<'a> {
    let steps = counted(answer.legs.len(), "step");
    let (status, detail) = match (&answer.verdict, report.clearance()) {
        (TaskVerdict::Done, clearance) => {
            let kept = clearance.map_or("nothing to hit".into(), |c| format!("proven clearance {c:.6} m"));
            ("done, certified", format!("{}: {steps} in {:.3} s, {kept}", report.planner(), answer.duration()))
        }
        (TaskVerdict::Infeasible(_), _) => ("proven", format!("{}: {steps} before it", report.planner())),
        (TaskVerdict::Unknown(_), _) => ("unknown", format!("{}: {steps} before it", report.planner())),
    };
    TaskPicture {
        title: vec![output::title_of(&loaded.scene), detail],
        status: status.into(),
        task: &loaded.task,
        answer,
        c_obstacles: output::contours,
    }
}
