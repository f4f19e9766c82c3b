//! A planner and its options.

use super::field::{FieldArgs, numbers};
use super::names::{TIES, Word, grid_spaces, path_kinds, planners, searches, word};
use super::number::number_in;
use super::readers::{listed, readers, require};
use super::roadmap::RoadmapArgs;
use clap::{Args, Parser, ValueEnum};
use cplan_fields::FieldPlanner;
use cplan_planners::planner::{GridSearch, PathKind};
use cplan_planners::waves::Neighborhood;
use cplan_planners::waves::search::Ties;
use cplan_solver::{ALLOWED_LEVELS, CellCounts, Criterion, GridSpace, MAX_MARGIN, Method, Options, Planner, Setting};
use std::ops::RangeInclusive;
use std::sync::LazyLock;

/// Options for the resolution of any planner.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(next_help_heading = "Resolution")]
pub struct EffortArgs {
    /// Initial number of grid cells along each axis, from 8 to 2048, or one number per joint, such as 128x512. If
    /// needed, numbers above 32 are doubled, up to 2048; smaller numbers only with --levels [default: 256; for planner
    /// harmonic 65536 cells in total, square in joint space, where a radian counts like a metre].
    #[arg(long, value_name = "N|AxB", allow_hyphen_values = true)]
    pub cells: Option<CellCounts>,
    /// Initial margin by which C-obstacles are grown, as a fraction of the arm's reach; divided by four if needed. 0 is
    /// possible for gantries: files and pictures then show the exact Minkowski differences, and the first attempt plans
    /// among these. If the path touches one of them, which counts as contact, the planner tries again with a small
    /// margin [default: 0.001].
    #[arg(long, value_name = "SHARE", value_parser = margin, allow_hyphen_values = true)]
    pub margin: Option<f64>,
    /// Maximum number of attempts, each finer than the previous one [default: 6].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(to_i64_range(&ALLOWED_LEVELS)))]
    pub levels: Option<u8>,
}

impl EffortArgs {
    /// Sets those of these options that the planner reads.
    pub fn apply_to(&self, planner: Planner) -> Planner {
        let planner = self.margin.map_or(planner, |share| planner.with_margin(share));
        self.cells.map_or(planner, |counts| planner.with_cell_counts(counts))
    }

    /// Returns the number of attempts of a planner. A few requested cells are not doubled, so there are only the attempts with
    /// one size.
    pub fn levels(&self, planner: &Planner) -> usize {
        let is_coarse = |CellCounts(counts): CellCounts| counts.iter().all(|&n| n <= KEPT_CELLS);
        let usual = match planner.space().filter(|_| self.cells.is_some_and(is_coarse)) {
            Some(space) => space.levels_per_size(),
            None => Options::default().levels,
        };
        self.levels.map_or(usual, usize::from)
    }

    /// Returns a warning for each stated option that the planner does not use. [`PlannerArgs::planner`] refuses options that
    /// contradict the planner.
    pub fn ignored(&self, planner: Method) -> Vec<String> {
        let refined = [Setting::Margin, Setting::Cells];
        let options: [(&str, bool, &[Setting]); 3] = [
            ("--cells", self.cells.is_some(), &[Setting::Cells]),
            ("--margin", self.margin.is_some(), &[Setting::Margin]),
            ("--levels", self.levels.is_some(), &refined),
        ];
        let is_ignored = |settings: &[Setting]| !settings.iter().any(|&setting| planner.reads(setting));
        let ignored = options.into_iter().filter(|(_, is_given, settings)| *is_given && is_ignored(settings));
        let warning = |(option, _, settings): (&str, bool, &[Setting])| {
            format!("{option} has no effect on planner {planner}, only on {}", readers(settings, " and "))
        };
        ignored.map(warning).collect()
    }

    /// Fills options that are not stated from `base`.
    pub fn completed_by(&self, base: &Self) -> Self {
        Self {
            cells: self.cells.or(base.cells),
            margin: self.margin.or(base.margin),
            levels: self.levels.or(base.levels),
        }
    }
}

/// Largest number of cells along an axis that is not doubled by default. Pictures show a number in each of so few cells.
const KEPT_CELLS: usize = 32;

/// Measures of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MetricName {
    /// Square root of the sum of squares; a radian counts like a metre.
    Euclidean,
    /// Like euclidean, with the joints' values multiplied by --weights.
    Weighted,
    /// Time that the joints and the elbow's motor need at top speed, seconds.
    Time,
    /// Like euclidean, but of the angles of both motors, radians, without the gears; for arms with [robot] drives.
    Motor,
}

/// Settings of searches of a grid or a roadmap.
const SEARCHES: [Setting; 2] = [Setting::GridSearch, Setting::Search];

static OPTIMUM_HEADING: LazyLock<String> =
    LazyLock::new(|| format!("Shortest paths (planners {})", readers(&[Setting::Gap], " and ")));

/// Options for the optimum: the measure and the gap.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(next_help_heading = OPTIMUM_HEADING.as_str())]
pub struct OptimumArgs {
    /// Measure of length.
    #[arg(long, value_enum, value_name = "NAME", default_value_t = MetricName::Euclidean)]
    pub metric: MetricName,
    /// Weights of the joints, such as 1,0.5, for --metric weighted.
    #[arg(long, value_name = "w1,w2", value_parser = weights, required_if_eq("metric", "weighted"), allow_hyphen_values = true)]
    pub weights: Option<[f64; 2]>,
    /// Refine until the path is proven to be longer than the optimum by at most this fraction, such as 0.001. A larger
    /// gap permits faster motions [default of shortest: 0.0001].
    #[arg(long, value_name = "SHARE", value_parser = gap, allow_hyphen_values = true)]
    pub gap: Option<f64>,
}

/// Options for the kind of path and the search of a grid.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(next_help_heading = "Paths and grids")]
pub struct PathArgs {
    /// Kind of path.
    #[arg(long, value_parser = word(path_kinds()), value_name = "KIND", help = path_help())]
    pub path: Option<PathKind>,
    /// Search of the grid or the roadmap.
    #[arg(long, value_parser = word(searches()), value_name = "NAME", help = search_help())]
    pub search: Option<GridSearch>,
    /// Number of neighbours of a cell (planner wavefront): 4 (cells with a common side) or 8 (also cells with a common
    /// corner). No move cuts the corner of a blocked cell. wave and bfs count moves; for dijkstra and astar, a diagonal
    /// move costs 1.414 [default: 4].
    #[arg(long, value_name = "N", value_parser = word(NEIGHBORHOODS))]
    pub neighbors: Option<Neighborhood>,
    /// Cell that A* expands next if several are equally promising (planner wavefront) [default: farthest].
    #[arg(long, value_parser = word(TIES), value_name = "NAME")]
    pub ties: Option<Ties>,
    /// Search from the start to the goals; labels of cells then count steps from the start. Planners with a roadmap
    /// search in this direction by default. The search `wave` cannot.
    #[arg(long, conflicts_with = "backward")]
    pub forward: bool,
    /// Test of the grid's cells.
    #[arg(long, value_parser = word(grid_spaces()), value_name = "NAME", help = space_help())]
    pub space: Option<GridSpace>,
}

fn path_help() -> String {
    let follows = |method: &Method| method.path_kind() == PathKind::Own;
    let mut own: Vec<&str> = Method::ALL.into_iter().filter(follows).map(Method::name).collect();
    own.sort_unstable();
    format!(
        "Kind of path: the planner's own (the curve along a field's gradient, the wavefront's staircase, the middles of \
         a decomposition's portals and cells, the arcs of the Voronoi diagram), that path pulled taut within the \
         planner's cells, or the portals' middles alone, with a cell's centroid only between two portals on one \
         vertical (a U-turn) [default: own for {}, taut for the others]",
        listed(&own, " and ")
    )
}

fn search_help() -> String {
    format!(
        "Search of the grid (planner wavefront; from the goal, or with --forward from the start) or of the roadmap \
         (planners {}; from the start, or with --backward from the goals). voronoi searches only its widest routes \
         [default: wave for wavefront, astar for the others]",
        readers(&[Setting::Search], ", ")
    )
}

fn space_help() -> String {
    format!(
        "Cells that count as free (planners {}): those that are wholly free and, in a second attempt, those whose centre \
         is (rows); only those that are wholly free (whole); those whose centre is, by slices (centers) or by collision \
         checks (sampled). Paths are certified in all cases [default: rows]",
        readers(&[Setting::Space], ", ")
    )
}

/// All options of planners.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct PlannerArgs {
    /// Resolution and number of attempts.
    #[command(flatten)]
    pub effort: EffortArgs,
    /// Measure of length, and gap.
    #[command(flatten)]
    pub optimum: OptimumArgs,
    /// Kind of path, and search of a grid.
    #[command(flatten)]
    pub path: PathArgs,
    /// Construction and search of a roadmap.
    #[command(flatten)]
    pub roadmap: RoadmapArgs,
    /// Field, and its relaxation.
    #[command(flatten)]
    pub field: FieldArgs,
}

/// A planner with its options, as in `compare --with "PLANNER OPTIONS"`.
#[derive(Debug, Clone, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub struct PlannerWords {
    /// Name of the planner.
    #[arg(value_parser = word(planners()))]
    pub planner: Method,
    /// Options of the planner.
    #[command(flatten)]
    pub options: PlannerArgs,
}

impl PlannerArgs {
    /// Returns the planner with these options.
    ///
    /// # Errors
    /// The reason, if the planner does not have an option, or options contradict each other.
    pub fn planner(&self, method: Method) -> Result<Planner, String> {
        let field = self.field.planner(method)?;
        self.check(method)?;
        let search = self.roadmap.search(method, self.path.search)?;
        if self.optimum.gap.is_some() && !search.order.is_optimal() {
            return Err(format!(
                "--gap needs a search for the shortest path, but --search {} may find longer ones; leave out one of the two",
                search.order.name()
            ));
        }
        Ok(self.apply_to(Planner::named(method).with_search(search), field))
    }

    /// Checks that the planner has all stated options.
    fn check(&self, planner: Method) -> Result<(), String> {
        let Self { effort, optimum, path, roadmap, .. } = self;
        let shortest = "does not look for the shortest path";
        let samples = "draws no samples";
        let needs: [(bool, &str, &[Setting], &str); 11] = [
            (optimum.gap.is_some(), "--gap", &[Setting::Gap], shortest),
            (optimum.metric != MetricName::Euclidean, "--metric", &[Setting::Gap], shortest),
            (path.search.is_some(), "--search", &SEARCHES, "searches neither a grid nor a roadmap"),
            (path.neighbors.is_some(), "--neighbors", &[Setting::Neighborhood], "does not search a grid"),
            (path.space.is_some(), "--space", &[Setting::Space], "has no grid"),
            (effort.margin == Some(0.0), "--margin 0", &[Setting::Margin], "does not grow C-obstacles"),
            (roadmap.samples.is_some(), "--samples", &[Setting::Samples], samples),
            (roadmap.nearest.is_some(), "--nearest", &[Setting::Samples], samples),
            (roadmap.seed.is_some(), "--seed", &[Setting::Samples], samples),
            (roadmap.graph.is_some(), "--graph", &[Setting::Graph], "searches no visibility graph"),
            (roadmap.backward, "--backward", &[Setting::Search, Setting::GridSearch], "has no roadmap"),
        ];
        if optimum.weights.is_some() && optimum.metric != MetricName::Weighted {
            return Err("--weights needs --metric weighted".into());
        }
        for (_, option, settings, why) in needs.into_iter().filter(|need| need.0) {
            require(option, settings, planner, why)?;
        }
        path.check(planner)
    }

    fn apply_to(&self, planner: Planner, field: Option<FieldPlanner>) -> Planner {
        let planner = self.effort.apply_to(planner).with_criterion(self.optimum.criterion());
        let planner = planner
            .with(Setting::GridSearch, |settings| {
                settings.grid_search = self.path.search.unwrap_or_default();
                settings.ties = self.path.ties.unwrap_or_default();
                settings.forward = self.path.forward;
                settings.neighborhood = self.path.neighbors.unwrap_or_default();
            })
            .with(Setting::Field, |settings| settings.field = field);
        let planner = self.roadmap.apply_to(planner);
        let planner = self.optimum.gap.map_or(planner, |share| planner.with_gap(share));
        let planner = self.path.space.map_or(planner, |space| planner.with_space(space));
        self.path.path.map_or(planner, |kind| planner.with_path(kind))
    }
}

impl OptimumArgs {
    fn criterion(&self) -> Criterion {
        match (self.metric, self.weights) {
            (MetricName::Weighted, Some(weights)) => Criterion::Weighted(weights),
            (MetricName::Time, _) => Criterion::Time,
            (MetricName::Motor, _) => Criterion::Motor,
            _ => Criterion::Euclidean,
        }
    }
}

impl PathArgs {
    /// Checks that the planner has the stated ties, direction and kind of path.
    fn check(&self, planner: Method) -> Result<(), String> {
        if self.ties.is_some() && (!planner.reads(Setting::Ties) || self.search != Some(GridSearch::AStar)) {
            let planners = readers(&[Setting::Ties], " or ");
            return Err(format!("--ties needs --planner {planners} --search astar: other searches do not rank cells"));
        }
        if self.forward {
            self.check_forward(planner)?;
        }
        if self.path == Some(PathKind::Middles) && !planner.descriptor().paths.contains(&PathKind::Middles) {
            return Err(format!("--path middles needs --planner trapezoid: {planner} has no vertical portals"));
        }
        if self.path == Some(PathKind::Own) && !planner.has_own_path() {
            return Err(format!("--path own does not apply to planner {planner}, whose only path is taut"));
        }
        Ok(())
    }

    /// If --forward is stated, checks that the planner searches, and that its search can begin at the start.
    fn check_forward(&self, planner: Method) -> Result<(), String> {
        if planner.reads(Setting::Search) {
            return Ok(());
        }
        if !planner.reads(Setting::Forward) {
            return Err(format!("--forward needs a planner that searches a grid or a roadmap: {planner} has neither"));
        }
        match self.search.unwrap_or_default() {
            GridSearch::Wave => Err(
                "--forward needs --search bfs, dfs, dijkstra, astar, greedy or deepening: the search `wave` always begins at the goal"
                    .into(),
            ),
            _ => Ok(()),
        }
    }
}

const NEIGHBORHOODS: [Word<Neighborhood>; 2] = [(Neighborhood::Four, "4", ""), (Neighborhood::Eight, "8", "")];

fn weights(text: &str) -> Result<[f64; 2], String> {
    match numbers(text)[..] {
        [a, b] if [a, b].iter().all(|w| w.is_finite() && *w > 0.0) => Ok([a, b]),
        _ => Err("must be two positive numbers, such as 1,0.5".into()),
    }
}

fn gap(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "greater than 0, such as 0.001")
}

fn margin(text: &str) -> Result<f64, String> {
    let range = format!("from 0 to {MAX_MARGIN} (of the arm's reach)");
    number_in(text, |x| (0.0..=MAX_MARGIN).contains(&x), &range)
}

pub(super) fn to_i64_range(range: &RangeInclusive<usize>) -> RangeInclusive<i64> {
    *range.start() as i64..=*range.end() as i64
}
