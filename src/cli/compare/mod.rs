//! `cplan compare`: every planner on the same problems, side by side.
//!
//! `cases` reads the problems: a single one, those of a suite, or random pairs. `pairs` draws random pairs with a generator of
//! its own, so that a seed gives the same pairs in all versions. `runner` runs the planners on several threads, and measures
//! times and memory. It also computes a lower bound for each problem, beginning with the shortest path that any planner found.
//! The allocator that counts bytes belongs to the program, not to the library. `cli::run` receives it as a `MemoryMeter`.

mod args;
mod cases;
mod drawings;
mod pairs;
mod recorded;
mod runner;
mod started;

pub use args::CompareArgs;

use super::exit::{BAD_INPUT, DONE, INFEASIBLE, UNKNOWN};
use super::failure::Failure;
use super::memory::MemoryMeter;
use super::outputs::{Outputs, by_extension, drawn, refuse_to_overwrite_inputs};
use super::progress::Progress;
use super::sinks;
use super::terminal::BEST_VALUE;
use super::variant::Variant;
use super::words::message;
use crate::compare::{Comparison, Emphasis, Page, Refusal, Study};
use crate::engine::{Method, Options, Planner};
use crate::input::LoadedScene;
use crate::space::Configuration;
use cases::{Case, Cases};
use clap::Parser;
use recorded::planners_in;
use runner::{ComparisonResults, Entry, Runner};
use std::path::Path;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ReportFormat {
    /// Tables in Markdown.
    Markdown,
    /// One line per run.
    Csv,
    /// All data.
    Json,
    /// A page with charts and paths.
    Html,
    /// A benchmark log for OMPL's Planner Arena.
    Arena,
}

const REPORT_FORMATS: [(&str, ReportFormat); 5] = [
    ("md", ReportFormat::Markdown),
    ("csv", ReportFormat::Csv),
    ("json", ReportFormat::Json),
    ("html", ReportFormat::Html),
    ("log", ReportFormat::Arena),
];

/// Compares planners, and returns the exit code. For a single problem, it is that of the best answer. If planners
/// contradict each other, it is 1.
///
/// # Errors
/// Bad input and I/O.
pub fn run(args: &CompareArgs, meter: Option<MemoryMeter>) -> Result<u8, Failure> {
    let expected = "a comparison's name must end in .md, .csv, .json, .html or .log";
    let outputs = Outputs::new(&args.output, by_extension(&REPORT_FORMATS, expected), &args.picture, [])?;
    let cases = Cases::load(args)?;
    refuse_to_overwrite_inputs(outputs.paths(), &cases.files)?;
    let ignored = args.with.iter().flat_map(Variant::ignored);
    cases.warnings.iter().cloned().chain(ignored).for_each(|w| sinks::print_status(&format!("warning: {w}")));
    for Refusal { problem, reason, .. } in &cases.refused {
        sinks::print_status(&format!("warning: {problem} is skipped: {reason}"));
    }
    if !args.quiet {
        cases.left_out.iter().for_each(|line| sinks::print_status(&format!("note: {line}")));
    }
    let started = started::current_time();
    let (study, done) = run_planners(args, &cases, meter)?;
    let results = Results { args, cases: &cases, study: &study, done: &done, started };
    let paths = || drawings::view(&cases.cases[0], &study.comparisons[0], &done.paths[0]);
    let report = |_: &Path, format| Ok(Some(results.content(format)?.into_bytes()));
    outputs.write(vec![], report, drawn(|| args.theme.apply(paths())))?;
    match (args.json, args.csv, args.markdown) {
        (true, ..) => sinks::print_json(&results.content(ReportFormat::Json)?)?,
        (_, true, _) => sinks::print(&results.content(ReportFormat::Csv)?)?,
        (.., true) => sinks::report(&results.content(ReportFormat::Markdown)?)?,
        _ => sinks::print_styled(&results.text(BEST_VALUE))?,
    }
    let alarms = study.alarms();
    alarms.iter().for_each(|alarm| sinks::print_status(&format!("error: {alarm}")));
    Ok(exit_code(&study, args.is_single()))
}

/// Compares planners in a scene that has been read, for callers from a library. `words` are the arguments of `cplan
/// compare` after the files. Without random queries, the result is a study of one problem.
///
/// # Errors
/// Invalid words, and defects of start and goal.
pub fn compare_in(scene: LoadedScene, words: &[String]) -> Result<Study, Failure> {
    let args = args_of(words)?;
    Ok(run_planners(&args, &Cases::of_scene(scene, &args)?, None)?.0)
}

/// The name of a problem's files, and its start and goal if they were drawn.
pub type ComparedProblem = (String, Option<[Configuration; 2]>);

/// Returns the problems that [`compare_in`] compares with these words. Each has the name, without extension, of files
/// with its paths, and its start and goal. These are `None` for the world's own query.
///
/// # Errors
/// Those of [`compare_in`].
pub fn compared_problems(scene: LoadedScene, words: &[String]) -> Result<Vec<ComparedProblem>, Failure> {
    let cases = Cases::of_scene(scene, &args_of(words)?)?.cases;
    Ok(cases.into_iter().map(|case| (case.file, case.query)).collect())
}

/// Returns the arguments of `cplan compare` for callers from a library.
///
/// # Errors
/// Invalid words, and options about files and printing.
fn args_of(words: &[String]) -> Result<CompareArgs, Failure> {
    let words = ["URDF", "WORLD", "--quiet"].into_iter().chain(words.iter().map(String::as_str));
    let CompareWords { args } = CompareWords::try_parse_from(words).map_err(|error| Failure::Usage(message(&error)))?;
    if args.json || args.csv || args.markdown || !args.output.is_empty() || !args.picture.is_empty() {
        let message =
            "options for printed output, files and pictures are available only on the command line, not in the library";
        return Err(Failure::Usage(message.into()));
    }
    Ok(args)
}

/// The arguments of `cplan compare`, for callers from a library.
#[derive(Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct CompareWords {
    #[command(flatten)]
    args: CompareArgs,
}

/// Runs the planners on the problems.
///
/// # Errors
/// Options that do not suit a world, and motions that cannot be timed with the options.
fn run_planners(
    args: &CompareArgs,
    cases: &Cases,
    meter: Option<MemoryMeter>,
) -> Result<(Study, ComparisonResults), Failure> {
    let entries = entries(args, cases)?;
    let total = cases.cases.len() * entries.first().map_or(0, Vec::len);
    let progress = Progress::new(total, "runs", args.is_single(), args.quiet);
    let jobs = usize::from(args.jobs);
    let meter = runner::meter(meter, jobs, args.quiet);
    let overrides = args.query.overrides();
    let runner = Runner { entries: &entries, overrides: &overrides, jobs, meter, progress: &progress };
    let mut done = runner.run(cases).map_err(|(name, error)| match error {
        error if args.is_single() => Failure::Plan(error),
        error => Failure::Refused(format!("{name}: {error}")),
    })?;
    let study = Study {
        title: cases.title.clone(),
        sampling: cases.sampling,
        comparisons: std::mem::take(&mut done.comparisons),
        left_out: cases.left_out.clone(),
        refused: cases.refused.clone(),
    };
    Ok((study, done))
}

/// Returns the exit code. It is that of a failure if planners contradict each other, or if a problem could not be run.
/// Otherwise, it is that of the best answer to a single problem.
fn exit_code(study: &Study, is_single: bool) -> u8 {
    match study.outcome_counts() {
        _ if !study.alarms().is_empty() || !study.refused.is_empty() => BAD_INPUT,
        _ if !is_single => DONE,
        [0, 0, _] => UNKNOWN,
        [0, ..] => INFEASIBLE,
        _ => DONE,
    }
}

/// Returns the planners for each world.
///
/// # Errors
/// A world that lacks something that a planner's options need, and a missing GPU.
fn entries(args: &CompareArgs, cases: &Cases) -> Result<Vec<Vec<Entry>>, Failure> {
    let methods = if args.planner.is_empty() { Method::ALL.to_vec() } else { args.planner.clone() };
    let plain = methods.iter().map(|&method| {
        let planner = args.effort.apply_to(Planner::named(method));
        Entry::planner(method.to_string(), options(args, planner, args.effort.levels(&planner)))
    });
    let plain: Vec<Entry> = plain.collect();
    if let Some(missing) = args.with.iter().find_map(Variant::missing) {
        return Err(Failure::Refused(missing));
    }
    let recorded = args.paths.as_deref().map_or(Ok(Vec::new()), planners_in)?;
    let of = |case: &Case| {
        let mut entries = plain.clone();
        for variant in &args.with {
            let preferences = &case.base.scene().workspace().preferences;
            let (planner, levels) = variant.completed_by(&args.effort);
            if let Some(lack) = planner.missing_preference(preferences) {
                return Err(Failure::Usage(if args.is_single() { lack } else { format!("{}: {lack}", case.name) }));
            }
            entries.push(Entry::planner(variant.label.clone(), options(args, planner, levels)));
        }
        entries.extend(recorded.iter().cloned().map(Entry::Recorded));
        Ok(entries)
    };
    cases.cases.chunk_by(|a, b| a.world == b.world).map(|world| of(&world[0])).collect()
}

/// Returns the options for a planner. Bounds are computed separately, in the same way for all planners. Only planners
/// whose path depends on their bound compute their own: `shortest`, and planners for which a gap is required.
fn options(args: &CompareArgs, planner: Planner, levels: usize) -> Options {
    let bounded = planner.method() == Method::Shortest || planner.gap().is_some();
    let (drive, jerk) = (args.motion.drive(), args.motion.jerk);
    Options { planner, levels, bounded, drive, jerk, ..Options::default() }
}

/// The results, and all data that files need.
struct Results<'a> {
    args: &'a CompareArgs,
    cases: &'a Cases,
    study: &'a Study,
    done: &'a ComparisonResults,
    started: String,
}

impl Results<'_> {
    /// Returns the comparison if there is only one problem, and `None` otherwise.
    fn single(&self) -> Option<&Comparison> {
        self.study.comparisons.first().filter(|_| self.args.is_single())
    }

    /// Returns the tables for a terminal, with an emphasis on the best value of each column.
    fn text(&self, emphasis: Emphasis) -> String {
        let wide = self.args.wide;
        self.single().map_or_else(|| self.study.to_text(wide, emphasis), |single| single.to_text(wide, emphasis))
    }

    fn content(&self, format: ReportFormat) -> Result<String, Failure> {
        let (single, study) = (self.single(), self.study);
        Ok(match format {
            ReportFormat::Markdown => single.map_or_else(|| study.to_markdown(), Comparison::to_markdown),
            ReportFormat::Csv => single.map_or_else(|| study.to_csv(), Comparison::to_csv),
            ReportFormat::Json => sinks::pretty(&single.map_or_else(|| study.to_json(), Comparison::to_json))?,
            ReportFormat::Html => {
                let overlays = drawings::overlays(self.cases, study, self.done);
                let pictures = drawings::pictures(self.cases, study, self.done);
                Page { study, overlays: &overlays, pictures: &pictures }.html()
            }
            ReportFormat::Arena => study.to_arena_log(&self.started, self.done.elapsed.as_secs_f64()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Family, Row};
    use crate::model::Status;

    fn study(outcomes: &[&[Status]]) -> Study {
        let comparison = |outcomes: &&[Status]| Comparison {
            problem: "p".to_owned(),
            length_unit: "rad".to_owned(),
            query: None,
            bound: None,
            rows: outcomes.iter().map(|outcome| Row::new("planner", Family::Field, *outcome)).collect(),
        };
        let comparisons = outcomes.iter().map(comparison).collect();
        Study { title: String::new(), sampling: None, comparisons, left_out: Vec::new(), refused: Vec::new() }
    }

    #[test]
    fn the_exit_code_is_the_best_answers_and_1_for_contradictions() {
        use Status::{Found, Infeasible, Unknown};
        let single = |outcomes: &[Status]| exit_code(&study(&[outcomes]), true);
        assert_eq!([single(&[Unknown, Found]), single(&[Found])], [DONE; 2]);
        assert_eq!([single(&[Unknown, Infeasible]), single(&[Unknown])], [INFEASIBLE, UNKNOWN]);
        assert_eq!(single(&[Found, Unknown, Infeasible]), BAD_INPUT);
        assert_eq!(exit_code(&study(&[&[Unknown], &[Infeasible]]), false), DONE);
        assert_eq!(exit_code(&study(&[&[Found, Found], &[Infeasible, Found]]), false), BAD_INPUT);
        assert_eq!(study(&[&[Found, Found], &[Infeasible, Found]]).alarms().len(), 1);
    }
}
