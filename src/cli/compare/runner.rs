//! Runs every planner on every problem, on several threads if requested.

use super::cases::{Case, Cases};
use super::recorded::RecordedPlanner;
use crate::cli::memory::MemoryMeter;
use crate::cli::progress::Progress;
use crate::cli::sinks;
use crate::compare::{Comparison, OtherPath, Row};
use crate::engine::{Motion, Options, PlanError, Problem, bound, plan};
use crate::input::Overrides;
use crate::model::{MotionProblem, Outcome, Status};
use crate::parallel::run_in_order;
use crate::planner::PathKind;
use crate::space::{Metric, Path};
use std::convert::Infallible;
use std::time::{Duration, Instant};

/// A planner that is compared.
#[derive(Debug, Clone)]
pub enum Entry {
    /// A planner of cplan.
    Planner {
        /// Name of the planner in tables.
        label: String,
        /// The planner and its options.
        options: Box<Options>,
    },
    /// Paths of another planner, from files.
    Recorded(RecordedPlanner),
}

impl Entry {
    /// Returns an entry for a planner of cplan.
    pub fn planner(label: String, options: Options) -> Self {
        Self::Planner { label, options: Box::new(options) }
    }

    /// Returns the gap that the planner must reach. `None` if it has no gap.
    fn gap(&self) -> Option<f64> {
        match self {
            Self::Planner { options, .. } => options.planner.gap(),
            Self::Recorded(_) => None,
        }
    }
}

/// The results of all runs.
pub struct ComparisonResults {
    /// One comparison per case.
    pub comparisons: Vec<Comparison>,
    /// For each case, the path of each planner that found one.
    pub paths: Vec<Vec<Option<Path>>>,
    /// Time from the start of the first run to the end of the last one.
    pub elapsed: Duration,
}

/// Settings of the runs.
pub struct Runner<'a> {
    /// The planners for each world. All worlds have the same number of planners.
    pub entries: &'a [Vec<Entry>],
    /// The start, the goal and the margins that replace those of the world.
    pub overrides: &'a Overrides,
    /// Number of runs at the same time.
    pub jobs: usize,
    /// Counter of allocated bytes. `None` if several runs take place at the same time.
    pub meter: Option<MemoryMeter>,
    /// Display of the progress of all runs.
    pub progress: &'a Progress,
}

/// The row of a run, and the path if one was found.
type RunResult = Result<(Row, Option<Path>), PlanError>;

/// Number of boxes for the warm-up run.
const WARM_UP_BOXES: usize = 1000;

/// Required gap between a lower bound and the shortest known path, as a fraction of the path's length.
const BOUND_GAP: f64 = 1e-4;

impl Runner<'_> {
    /// Runs all cases. Results are in the order of the cases, whatever the order of execution.
    ///
    /// # Errors
    /// A motion that cannot be timed as requested: the first one in the order of the cases.
    pub fn run(&self, cases: &Cases) -> Result<ComparisonResults, (String, PlanError)> {
        let clock = Instant::now();
        let width = self.entries.first().map_or(0, Vec::len);
        // Each problem begins with another planner, because the first run fills the caches for the others.
        let runs = self.results_in_order(cases.cases.len() * width, |i| {
            let (number, turn) = (i / width, i % width);
            let case = &cases.cases[number];
            self.measure_run(case, &self.entries[case.world][(number + turn) % width], i == 0)
        });
        let mut runs = runs.into_iter();
        let mut comparisons = Vec::new();
        let mut paths = Vec::new();
        for (number, case) in cases.cases.iter().enumerate() {
            let of_case: Result<Vec<_>, _> = runs.by_ref().take(width).collect();
            let mut of_case = of_case.map_err(|error| (case.name.clone(), error))?;
            of_case.rotate_right(number % width);
            let (rows, found): (Vec<Row>, Vec<Option<Path>>) = of_case.into_iter().unzip();
            comparisons.push(Comparison {
                problem: case.name.clone(),
                length_unit: length_unit(&case.base),
                query: case.query,
                bound: None,
                rows,
            });
            paths.push(found);
        }
        let gaps = self.entries.iter().flatten().filter_map(Entry::gap);
        let gap = gaps.map(|gap| gap / 2.0).fold(BOUND_GAP, f64::min);
        let lower = |i: usize| lower_bound(&cases.cases[i].problem(), paths[i].iter().flatten(), gap);
        let bounds = self.results_in_order(cases.cases.len(), lower);
        for (comparison, bound) in comparisons.iter_mut().zip(bounds) {
            comparison.bound = bound;
        }
        self.progress.end();
        Ok(ComparisonResults { comparisons, paths, elapsed: clock.elapsed() })
    }

    /// Calls `work` for all numbers below `count`, on one thread per job. Returns the results in order.
    fn results_in_order<T: Send>(&self, count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
        let mut results = Vec::with_capacity(count);
        let Ok(()) = run_in_order(count, self.jobs, work, |result| {
            results.push(result);
            Ok::<_, Infallible>(())
        });
        results
    }

    /// Measures one run. A coarse run precedes the very first one, so that the measured time does not include loading
    /// the program.
    fn measure_run(&self, case: &Case, entry: &Entry, is_first: bool) -> RunResult {
        let (label, options) = match entry {
            Entry::Planner { label, options } => (label, options),
            Entry::Recorded(planner) => {
                self.progress.begin(&case.name, &planner.label);
                let judged = planner.judged(case, self.overrides);
                self.progress.done();
                return Ok(judged);
            }
        };
        self.progress.begin(&case.name, label);
        let problem = Problem::from(case.problem().into_owned());
        if is_first {
            plan(&problem, &Options { levels: 1, boxes: WARM_UP_BOXES, ..**options })?;
        }
        let work = || plan(&problem, options);
        let (made, memory) = match self.meter {
            Some(meter) => {
                let (made, bytes) = meter.measure(work);
                (made?, Some(bytes))
            }
            None => (work()?, None),
        };
        let mut row = Row::new(label.clone(), options.planner.method().descriptor().family, Status::Unknown);
        let mut path = None;
        if let Some((_, answer)) = made.motion() {
            let stages = answer.stages;
            let seconds = |time: Duration| (!time.is_zero()).then_some(time.as_secs_f64());
            row = Row {
                size: Some(answer.run.size),
                build: seconds(stages.build),
                query: seconds(stages.query),
                certify: seconds(stages.certify),
                prove: seconds(stages.prove),
                total: seconds(stages.total()),
                memory,
                note: answer.run.note,
                path_kind: options.planner.path_kind(),
                outcome: answer.outcome.status(),
                ..row
            };
            match &answer.outcome {
                Outcome::Found(Motion { path: found, .. }) => {
                    row.length = made.length();
                    row.pieces = Some(found.path().segments().count());
                    row.clearance = made.clearance();
                    row.duration = made.duration();
                    row.other_path = other_path(&problem, options)?;
                    path = Some(found.path().clone());
                }
                Outcome::Infeasible(_) => {}
                Outcome::Unknown(unknown) => row.reason = Some(unknown.reason.clone()),
            }
        }
        self.progress.done();
        Ok((row, path))
    }
}

/// Returns the path of the other kind, if the planner also computes one. Its time is not measured.
fn other_path(problem: &Problem, options: &Options) -> Result<Option<OtherPath>, PlanError> {
    if !options.planner.method().has_own_path() || options.planner.path_kind() == PathKind::Middles {
        return Ok(None);
    }
    let kind = if options.planner.path_kind() == PathKind::Own { PathKind::Taut } else { PathKind::Own };
    let made = plan(problem, &Options { planner: options.planner.with_path(kind), ..*options })?;
    Ok(made.length().map(|length| OtherPath { length, clearance: made.clearance() }))
}

/// Returns a lower bound on the length of all motions, if possible within a gap of the shortest path. `None` if there
/// is no path.
fn lower_bound<'a>(problem: &MotionProblem, paths: impl Iterator<Item = &'a Path>, gap: f64) -> Option<f64> {
    let shortest = paths.min_by(|a, b| a.length().total_cmp(&b.length()))?;
    Some(bound(problem, shortest, Metric::Euclidean, gap).lower)
}

/// Returns the unit of lengths in joint space.
pub fn length_unit(problem: &MotionProblem) -> String {
    let units = problem.scene().arm().joints.each_ref().map(|j| j.unit());
    if units[0] == units[1] { units[0].into() } else { units.join(", ") }
}

/// Returns the meter if memory can be measured. Otherwise, prints why it cannot.
pub fn meter(meter: Option<MemoryMeter>, jobs: usize, quiet: bool) -> Option<MemoryMeter> {
    if jobs > 1 && meter.is_some() && !quiet {
        sinks::print_status(
            "note: memory is reported only with --jobs 1: the allocations of simultaneous runs cannot be separated",
        );
    }
    meter.filter(|_| jobs == 1)
}
