//! `cplan compare`: every planner on the same problems, side by side.

mod args;
mod cases;
mod pairs;
mod progress;
mod runner;
mod sink;

pub use args::CompareArgs;

use super::failure::Failure;
use super::memory::MemoryMeter;
use super::output::{self, Sink};
use super::{BAD_INPUT, DONE, INFEASIBLE, UNKNOWN};
use crate::draw::Picture;
use crate::report::{Comparison, Outcome, Study};
use crate::solve::Method;
use crate::space::Path;
use crate::trajectory::write_whole_set;
use cases::{Case, Cases};
use progress::Progress;
use runner::{Compared, Entry, Runner};
use sink::{ReportFormat, report_sinks};

/// Compares, and returns the exit code: that of the best answer to a single problem, and 1 if planners contradict each
/// other.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &CompareArgs, meter: Option<MemoryMeter>) -> Result<u8, Failure> {
    let sinks = report_sinks(&args.output)?;
    let pictures = output::sinks(&[], &args.picture)?;
    let cases = Cases::load(args)?;
    let entries = entries(args, &cases)?;
    cases.warnings.iter().for_each(|w| output::say(&format!("warning: {w}")));
    if !args.quiet {
        cases.left_out.iter().for_each(|line| output::say(&format!("note: {line}")));
    }
    let total = entries.iter().map(Vec::len).sum();
    let progress = Progress::new(total, args.is_single(), args.quiet);
    let jobs = usize::from(args.jobs);
    let meter = runner::meter(meter, jobs, args.quiet);
    let runner = Runner { entries: &entries, motion: &args.motion, jobs, meter, progress: &progress };
    let Compared { comparisons, paths, elapsed: _ } = runner.run(&cases).map_err(|(name, error)| match error {
        error if args.is_single() => Failure::Trajectory(error),
        error => Failure::Option(format!("{name}: {error}")),
    })?;
    let study =
        Study { title: cases.title.clone(), sampling: cases.sampling, comparisons, left_out: cases.left_out.clone() };
    for sink in &pictures {
        if let (Sink::Picture(format, path), [comparison]) = (sink, &study.comparisons[..]) {
            draw(&cases.cases[0], comparison, &paths[0], *format, path)?;
        }
    }
    let written: Result<Vec<_>, Failure> =
        sinks.iter().map(|sink| Ok((sink.path.clone(), content(args, &study, sink.format)?))).collect();
    write_whole_set(&written?)?;
    let shown = match (args.json, args.csv, args.markdown) {
        (true, ..) => content(args, &study, ReportFormat::Json)?,
        (_, true, _) => content(args, &study, ReportFormat::Csv)?,
        (.., true) => content(args, &study, ReportFormat::Markdown)?,
        _ => text(args, &study),
    };
    output::print(&shown)?;
    let alarms = study.alarms();
    alarms.iter().for_each(|alarm| output::say(&format!("error: {alarm}")));
    Ok(if !alarms.is_empty() {
        BAD_INPUT
    } else if !args.is_single() {
        DONE
    } else {
        match study.settled() {
            [0, 0, _] => UNKNOWN,
            [0, ..] => INFEASIBLE,
            _ => DONE,
        }
    })
}

/// The planners for each case.
///
/// # Errors
/// Options of a planner that need something of a world which it lacks.
fn entries(args: &CompareArgs, cases: &Cases) -> Result<Vec<Vec<Entry>>, Failure> {
    // Bounds are measured by themselves, for all planners alike.
    let effort = crate::solve::Effort { bounded: false, ..args.effort.effort() };
    let methods = if args.planner.is_empty() { Method::ALL.to_vec() } else { args.planner.clone() };
    let of = |case: &Case| {
        let plain = methods.iter().map(|&method| Entry { label: method.to_string(), method, effort });
        let mut entries: Vec<Entry> = plain.collect();
        for variant in &args.with {
            let preferences = &case.base().scene.workspace.preferences;
            let effort = variant.effort(effort, preferences).map_err(|lack| {
                Failure::Usage(if args.is_single() { lack } else { format!("{}: {lack}", case.name) })
            })?;
            entries.push(Entry { label: variant.label.clone(), method: variant.method, effort });
        }
        Ok(entries)
    };
    cases.cases.iter().map(of).collect()
}

/// The tables for a terminal.
fn text(args: &CompareArgs, study: &Study) -> String {
    match &study.comparisons[..] {
        [comparison] if args.is_single() => comparison.to_text(),
        _ => study.to_text(),
    }
}

/// A file's content.
fn content(args: &CompareArgs, study: &Study, format: ReportFormat) -> Result<String, Failure> {
    let single = match &study.comparisons[..] {
        [comparison] if args.is_single() => Some(comparison),
        _ => None,
    };
    Ok(match format {
        ReportFormat::Markdown => single.map_or_else(|| study.to_markdown(), Comparison::to_markdown),
        ReportFormat::Csv => single.map_or_else(|| study.to_csv(), Comparison::to_csv),
        ReportFormat::Json => {
            let json = single.map_or_else(|| study.to_json(), Comparison::to_json);
            serde_json::to_string_pretty(&json).map_err(|e| Failure::Option(e.to_string()))? + "\n"
        }
    })
}

fn draw(
    case: &Case,
    comparison: &Comparison,
    paths: &[Option<Path>],
    format: output::PictureFormat,
    file: &std::path::Path,
) -> Result<(), Failure> {
    let problem = case.problem();
    let contours = output::contours(&problem.scene);
    let named = comparison.rows.iter().zip(paths).filter_map(|(row, path)| Some((row, path.as_ref()?)));
    let paths: Vec<_> = named.map(|(row, path)| (format!("{}: {:.3}", row.planner, path.length()), path)).collect();
    let found = comparison.rows.iter().filter(|row| row.outcome == Outcome::Found).count();
    let picture = Picture {
        title: vec![output::title(&problem), format!("lengths in {}", comparison.length_unit)],
        status: format!("{found} of {} found a certified path", comparison.rows.len()),
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
