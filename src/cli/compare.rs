//! `cplan compare`: every planner on the same problem, side by side.

use super::args::CompareArgs;
use super::failure::Failure;
use super::motion::MotionArgs;
use super::output::{self, Sink};
use super::{DONE, INFEASIBLE, UNKNOWN};
use crate::draw::Picture;
use crate::input;
use crate::model::Problem;
use crate::report::{Comparison, Row};
use crate::solve::{Answer, Method, Verdict, solve};
use crate::trajectory::Timed;
use std::time::Duration;

/// Compares, and returns the exit code: that of the best answer.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &CompareArgs) -> Result<u8, Failure> {
    let sinks = output::sinks(&[], &args.picture)?;
    let effort = args.effort.effort();
    let mut loaded = input::load(&args.files.urdf, &args.files.world, &args.query.overrides())?;
    args.motion.override_limits(&mut loaded.problem.scene.arm.joints);
    loaded.robot.warnings.iter().for_each(|w| output::say(&format!("warning: {w}")));
    let problem = &loaded.problem;
    let methods = if args.planner.is_empty() { Method::ALL.to_vec() } else { args.planner.clone() };
    let mut entries: Vec<_> = methods.into_iter().map(|method| (method.to_string(), method, effort)).collect();
    for variant in &args.with {
        let effort = variant.effort(effort, &problem.scene.workspace.preferences).map_err(Failure::Usage)?;
        entries.push((variant.label.clone(), variant.method, effort));
    }
    let mut answers = Vec::new();
    let mut rows = Vec::new();
    for (label, method, effort) in entries {
        if !args.quiet {
            output::say(&format!("{label} ..."));
        }
        let answer = solve(problem, method, &effort, &mut |text| {
            if !args.quiet {
                output::say(text);
            }
        });
        rows.push(row(problem, label, &answer, &args.motion)?);
        answers.push(answer);
    }
    let comparison = Comparison { problem: output::title(problem), length_unit: length_unit(problem), rows };
    for sink in &sinks {
        if let Sink::Picture(format, path) = sink {
            draw(problem, &answers, &comparison, *format, path)?;
        }
    }
    let text = if args.json {
        serde_json::to_string_pretty(&comparison.to_json()).map_err(|e| Failure::Option(e.to_string()))? + "\n"
    } else if args.csv {
        comparison.to_csv()
    } else {
        comparison.to_text()
    };
    output::print(&text)?;
    Ok(if answers.iter().any(|a| matches!(a.verdict, Verdict::Found(_))) {
        DONE
    } else if answers.iter().any(|a| matches!(a.verdict, Verdict::Infeasible(_))) {
        INFEASIBLE
    } else {
        UNKNOWN
    })
}

fn row(problem: &Problem, planner: String, answer: &Answer, motion: &MotionArgs) -> Result<Row, Failure> {
    let seconds = |time: Duration| (!time.is_zero()).then_some(time.as_secs_f64());
    let mut row = Row {
        planner,
        outcome: "unknown".into(),
        length: None,
        clearance: None,
        duration: None,
        size: Some(answer.run.size),
        build: seconds(answer.stages.build),
        query: seconds(answer.stages.query),
        certify: seconds(answer.stages.certify),
        note: answer.run.note,
    };
    match &answer.verdict {
        Verdict::Found(certified) => {
            row.outcome = "found".into();
            let Timed { curve, trajectory } = motion.drive().along(&problem.scene, certified, 1.0)?;
            row.length = Some(certified.path().length());
            row.clearance = Some(curve.clearance()).filter(|c| c.is_finite());
            row.duration = Some(trajectory.duration());
        }
        Verdict::Infeasible(_) => row.outcome = "infeasible".into(),
        Verdict::Unknown(_) => {}
    }
    Ok(row)
}

fn length_unit(problem: &Problem) -> String {
    let units = problem.scene.arm.joints.each_ref().map(|j| j.unit());
    if units[0] == units[1] { units[0].into() } else { units.join(", ") }
}

fn draw(
    problem: &Problem,
    answers: &[Answer],
    comparison: &Comparison,
    format: output::PictureFormat,
    file: &std::path::Path,
) -> Result<(), Failure> {
    let contours = output::contours(&problem.scene);
    let named = comparison.rows.iter().zip(answers);
    let paths = named.filter_map(|(row, answer)| match &answer.verdict {
        Verdict::Found(certified) => {
            Some((format!("{}: {:.3}", row.planner, certified.path().length()), certified.path()))
        }
        _ => None,
    });
    let paths: Vec<_> = paths.collect();
    let status = format!("{} of {} found a certified path", paths.len(), answers.len());
    let picture = Picture {
        title: vec![output::title(problem), format!("lengths in {}", comparison.length_unit)],
        status,
        scene: &problem.scene,
        start: problem.start,
        goals: &problem.goals,
        paths,
        trace: None,
        proof: &[],
        c_obstacles: &contours,
    };
    output::save_picture(format, file, &picture)
}
