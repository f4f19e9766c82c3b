//! The main job: from two files to a certified trajectory, a proof, or neither.

use super::args::{Files, PlanArgs};
use super::failure::Failure;
use super::field_report::field_report;
use super::motion::MotionArgs;
use super::output::{self, Sink};
use super::planned::Planned;
use super::summary::{self, Clock};
use super::{DONE, INFEASIBLE, UNKNOWN, task};
use crate::check::{CertifiedCurve, ProofBox};
use crate::engine::{Answer, Bound, Effort, Method, Verdict, percent, solve};
use crate::input::{self, InputError, LoadedScene};
use crate::model::{Problem, Scene};
use crate::motion::{Optimum, Report, SearchUsed, Timed};
use crate::planner::{FieldPlanner, Wavefront};
use crate::space::Metric;

/// Plans, writes what was asked for, and returns the exit code.
///
/// # Errors
/// Bad input and I/O.
pub fn run(files: &Files, args: &PlanArgs) -> Result<u8, Failure> {
    answer(args, || input::load_scene(&files.urdf, &files.world))
}

/// The same for a scene from anywhere. Nothing is loaded if the command line is wrong.
///
/// # Errors
/// Bad input and I/O.
pub fn answer(args: &PlanArgs, load: impl FnOnce() -> Result<LoadedScene, InputError>) -> Result<u8, Failure> {
    let sinks = output::sinks(&args.output, &args.picture)?;
    let conflict = args.optimum.conflict(args.planner).or_else(|| args.search.conflict(args.planner));
    if let Some(conflict) = conflict.or_else(|| args.path.conflict(args.planner)) {
        return Err(Failure::Usage(conflict));
    }
    let field = args.field.planner(args.planner).map_err(Failure::Usage)?;
    let mut clock = Clock::start();
    let loaded = load()?;
    output::spare_inputs(sinks.iter().map(Sink::path))?;
    if loaded.has_steps() {
        return task::run(loaded, args, field, &sinks, clock);
    }
    if args.per_step {
        return Err(Failure::Usage("--per-step is for worlds with steps".into()));
    }
    let mut loaded = loaded.problem(&args.query.overrides())?;
    args.motion.override_limits(loaded.problem.joints_mut());
    clock.stage("load");
    let say = |text: &str| {
        if !args.quiet {
            output::say(text);
        }
    };
    loaded.robot.warnings.iter().for_each(|w| say(&format!("warning: {w}")));
    let problem = &loaded.problem;
    let effort = effort(problem.scene(), args, field)?;
    let answer = solve(problem, args.planner, &effort, &mut |text| say(text));
    clock.stages(&answer.stages);
    if let (Some(bound), Some(gap)) = (&answer.bound, args.optimum.gap)
        && bound.gap() > gap
    {
        say(&format!(
            "warning: the gap of {} asked for is not reached: {} is proven at the finest level ({}); more --levels or a \
             smaller --margin may do",
            percent(gap),
            percent(bound.gap()),
            effort.levels
        ));
    }
    let (mut report, curve) = report(problem, &answer, &args.motion)?;
    args.message.apply(&mut report, &loaded.robot.joints)?;
    tell_how(&mut report, &answer, &effort);
    report.assumed = loaded.robot.assumed.clone();
    clock.stage("trajectory");
    if args.timings {
        report.timings = clock.milliseconds();
    }
    let planned = Planned { problem, answer: &answer, curve: curve.as_ref(), report: &report, field: field.as_ref() };
    for sink in &sinks {
        match sink {
            Sink::Result(format, path) => output::write_result(*format, path, &report)?,
            Sink::Picture(format, path) => planned.save(*format, path)?,
        }
    }
    clock.stage("write");
    if args.json {
        output::print_json(&report.json())?;
    } else if !args.quiet {
        output::tell(&summary::text(&loaded, &planned, &sinks, &clock))?;
    }
    Ok(match answer.verdict {
        Verdict::Found(_) => DONE,
        Verdict::Infeasible(_) => INFEASIBLE,
        Verdict::Unknown(_) => UNKNOWN,
    })
}

/// How hard to try, and what for.
///
/// # Errors
/// A field that follows preferences of the world, which has none.
pub fn effort(scene: &Scene, args: &PlanArgs, field: Option<FieldPlanner>) -> Result<Effort, Failure> {
    if let Some(lack) = args.field.lack(&scene.workspace().preferences) {
        return Err(Failure::Usage(lack));
    }
    let metric = args.optimum.metric(scene.arm().joints.each_ref().map(|joint| joint.velocity));
    let wavefront = args.search.wavefront();
    Ok(Effort { metric, gap: args.optimum.gap, field, path: args.path.path, wavefront, ..args.effort.effort() })
}

/// The result file's content, and what the motion follows.
pub(super) fn report(
    problem: &Problem,
    answer: &Answer,
    motion: &MotionArgs,
) -> Result<(Report, Option<CertifiedCurve>), Failure> {
    let joints = &problem.scene().arm().joints;
    let planner = answer.method.name();
    let mut followed = None;
    let mut report = match &answer.verdict {
        Verdict::Found(certified) => {
            let Timed { curve, trajectory } = motion.drive().along(problem.scene(), certified, 1.0)?;
            let mut report = Report::found(planner, joints, &curve, trajectory);
            report.optimum = answer.bound.map(Optimum::from);
            report.closest = curve.nearest().map(|n| problem.scene().describe(n.contact.pair));
            followed = Some(curve);
            report
        }
        Verdict::Infeasible(proof) => {
            let boxes = proof.stuck().len();
            let reason = format!("proven: {boxes} boxes of colliding configurations separate start and goal");
            let mut report = Report::infeasible(planner, joints, reason);
            report.proof = Some(proof.stuck().iter().map(ProofBox::from).collect());
            report
        }
        Verdict::Unknown(reason) => {
            let mut report = Report::unknown(planner, joints, reason.clone());
            report.path_exists = answer.witness.is_some().then_some(true);
            report
        }
    };
    report.free_joints = free_joints(problem);
    report.path_kind = matches!(answer.verdict, Verdict::Found(_)).then(|| answer.path.name());
    report.name = Some(problem.scene().workspace().name.clone()).filter(|name| !name.is_empty());
    report.size = answer.run.size.figures().into_iter().collect();
    Ok((report, followed))
}

/// Adds which field was followed, and how the grid was searched.
pub(super) fn tell_how(report: &mut Report, answer: &Answer, effort: &Effort) {
    report.field = effort.field.map(|field| field_report(&field, answer));
    report.search = (answer.method == Method::Wavefront).then(|| SearchUsed::from(effort.wavefront));
}

/// The names of the joints that the goal leaves free.
fn free_joints(problem: &Problem) -> Vec<String> {
    let goals = problem.goals().pieces();
    let is_free = |k: &usize| goals.iter().any(|goals| goals.ends()[0][*k] != goals.ends()[1][*k]);
    (0..2).filter(is_free).map(|k| problem.scene().arm().joints[k].name.clone()).collect()
}

impl From<Bound> for Optimum {
    fn from(bound: Bound) -> Self {
        let (metric, weights) = match bound.metric {
            Metric::Euclidean => ("euclidean", None),
            Metric::Weighted { weights } => ("weighted", Some(weights)),
            Metric::Time { .. } => ("time", None),
        };
        let gap = Some(bound.gap()).filter(|gap| gap.is_finite());
        Self { metric, weights, length: bound.upper, lower_bound: bound.lower, gap }
    }
}

impl From<Wavefront> for SearchUsed {
    fn from(planner: Wavefront) -> Self {
        Self { search: planner.search.name(), neighbors: planner.neighborhood.count() }
    }
}
