//! A planner and its options.

use super::field::FieldArgs;
use super::names::word;
use super::number::number_in;
use super::readers::{listed, readers, require};
use super::roadmap::RoadmapArgs;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, ValueEnum};
use cplan_core::planner::{GridSearch, PathKind};
use cplan_core::waves::Neighborhood;
use cplan_core::waves::search::Ties;
use cplan_fields::FieldPlanner;
use cplan_solver::{CellCounts, Criterion, GridSpace, LEVELS, MOST_MARGIN, Method, Options, Planner, Setting};
use std::ops::RangeInclusive;
use std::sync::LazyLock;

/// How hard to try, for any planner.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Resolution")]
pub struct EffortArgs {
    /// First number of grid cells along each axis, from 8 to 2048, or two such as 128x512, for the joints in turn. Up to 32 are kept as
    /// they are unless --levels says more; more are doubled up to 2048 where needed [default: 256; of fields as many, but square in joint space, where a radian is as long as a metre].
    #[arg(long, value_name = "N|AxB", allow_hyphen_values = true)]
    pub cells: Option<CellCounts>,
    /// First margin of the polygons, as a share of the arm's reach; quartered where needed. 0 is for gantries: files and pictures then
    /// have the C-obstacles B - A exactly, and the planner has the first attempt among them. Its path counts if it touches none; else
    /// the certified path is sought among polygons grown by a little, since touching is contact [default: 0.001].
    #[arg(long, value_name = "SHARE", value_parser = margin, allow_hyphen_values = true)]
    pub margin: Option<f64>,
    /// Attempts, each finer than the one before [default: 6].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(whole(&LEVELS)))]
    pub levels: Option<u8>,
}

impl EffortArgs {
    /// A planner with what of these options is its.
    pub fn put_into(&self, planner: Planner) -> Planner {
        let planner = self.margin.map_or(planner, |share| planner.with_margin(share));
        self.cells.map_or(planner, |counts| planner.with_cell_counts(counts))
    }

    /// Attempts of a planner: few coarse cells that were asked for are not doubled.
    pub fn levels(&self, planner: &Planner) -> usize {
        let is_coarse = |CellCounts(counts): CellCounts| counts.iter().all(|&n| n <= KEPT_CELLS);
        let usual = match planner.space().filter(|_| self.cells.is_some_and(is_coarse)) {
            Some(space) => space.levels_of_a_size(),
            None => Options::default().levels,
        };
        self.levels.map_or(usual, usize::from)
    }

    /// These options, and where they say nothing those of `base`.
    pub fn over(&self, base: &Self) -> Self {
        Self {
            cells: self.cells.or(base.cells),
            margin: self.margin.or(base.margin),
            levels: self.levels.or(base.levels),
        }
    }
}

/// Cells along an axis up to which as many are used as are asked for: those of pictures in which each has its number.
const KEPT_CELLS: usize = 32;

/// What makes a path short.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MetricName {
    /// Square root of the sum of squares, radians and metres as they come.
    Euclidean,
    /// The same with the joints' values multiplied by --weights.
    Weighted,
    /// Seconds at the joints' top speeds.
    Time,
}

static OPTIMUM_HEADING: LazyLock<String> =
    LazyLock::new(|| format!("Shortest paths (planners {})", readers(&[Setting::Gap], " and ")));

/// What to optimise, and how well.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = OPTIMUM_HEADING.as_str())]
pub struct OptimumArgs {
    /// What makes a path short.
    #[arg(long, value_enum, value_name = "NAME", default_value_t = MetricName::Euclidean)]
    pub metric: MetricName,
    /// Weights of the joints, such as 1,0.5, for --metric weighted.
    #[arg(long, value_name = "w1,w2", value_parser = weights, required_if_eq("metric", "weighted"), allow_hyphen_values = true)]
    pub weights: Option<Weights>,
    /// Refine until the path is proven to be longer than the optimum by no more than this share of it, such as 0.001; a larger
    /// one leaves room in which motions are faster [default of shortest: 0.0001].
    #[arg(long, value_name = "SHARE", value_parser = gap, allow_hyphen_values = true)]
    pub gap: Option<f64>,
}

/// Two positive numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights(pub [f64; 2]);

/// Which path, and how a grid is searched.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Paths and grids")]
pub struct PathArgs {
    /// Which path.
    #[arg(long, value_parser = word::<PathKind>(), value_name = "KIND", help = path_help())]
    pub path: Option<PathKind>,
    /// How the grid or the roadmap is searched.
    #[arg(long, value_parser = word::<GridSearch>(), value_name = "NAME", help = search_help())]
    pub search: Option<GridSearch>,
    /// Cells that a move can lead to: 4 share a side, 8 a corner too, though no move cuts the corner of a blocked cell
    /// (planner wavefront). wave and bfs count moves; dijkstra and astar take a diagonal one for 1.414. [default: 4]
    #[arg(long, value_name = "N", value_parser = neighbors())]
    pub neighbors: Option<Neighborhood>,
    /// Which of equally promising cells A* expands (planner wavefront). [default: farthest]
    #[arg(long, value_parser = word::<Ties>(), value_name = "NAME")]
    pub ties: Option<Ties>,
    /// Search from the start to the goals, which planners with a roadmap do anyway; the wave cannot. Labels are then steps from
    /// the start.
    #[arg(long, conflicts_with = "backward")]
    pub forward: bool,
    /// How the grid's cells are decided.
    #[arg(long, value_parser = word::<GridSpace>(), value_name = "NAME", help = space_help())]
    pub space: Option<GridSpace>,
}

fn path_help() -> String {
    let follows = |method: &Method| method.path_kind() == PathKind::Own;
    let mut own: Vec<&str> = Method::ALL.into_iter().filter(follows).map(Method::name).collect();
    own.sort_unstable();
    format!(
        "Which path: the planner's own (the curve along a field's gradient, the wavefront's staircase, the middles of a \
         decomposition's doors and cells, the arcs of the Voronoi diagram), that one pulled taut within the planner's cells, or \
         middles [default: own for {}, taut for the others]",
        listed(&own, " and ")
    )
}

fn search_help() -> String {
    format!(
        "How the grid is searched, from the goal unless it is --forward (planner wavefront), or the roadmap, from the start unless \
         it is --backward (planners {}), of which voronoi keeps the widest ways only. [default: wave of wavefront, astar of the \
         others]",
        readers(&[Setting::Search], ", ")
    )
}

fn space_help() -> String {
    format!(
        "How the grid's cells are decided (planners {}): by exact slices, or by sampled collision checks, which prove nothing. \
         Paths are certified either way. [default: rows]",
        readers(&[Setting::Space], ", ")
    )
}

/// All options of planners.
#[derive(Debug, Clone, Args)]
pub struct PlannerArgs {
    /// How hard to try.
    #[command(flatten)]
    pub effort: EffortArgs,
    /// What to optimise.
    #[command(flatten)]
    pub optimum: OptimumArgs,
    /// Which path, and how a grid is searched.
    #[command(flatten)]
    pub path: PathArgs,
    /// How a roadmap is made and searched.
    #[command(flatten)]
    pub roadmap: RoadmapArgs,
    /// Which field, and how it is relaxed.
    #[command(flatten)]
    pub field: FieldArgs,
}

/// `PLANNER OPTIONS`, as `compare --with` has it.
#[derive(Debug, Clone, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub struct PlannerWords {
    /// Which planner.
    #[arg(value_parser = word::<Method>())]
    pub planner: Method,
    /// Its options.
    #[command(flatten)]
    pub options: PlannerArgs,
}

impl PlannerArgs {
    /// Attempts of a planner.
    pub fn levels(&self, planner: &Planner) -> usize {
        self.effort.levels(planner)
    }

    /// The planner of that name with these options.
    ///
    /// # Errors
    /// Options that it does not have or that contradict each other, in words.
    pub fn planner(&self, method: Method) -> Result<Planner, String> {
        let field = self.field.planner(method)?;
        self.optimum.check(method)?;
        self.path.check(method)?;
        if self.effort.margin == Some(0.0) {
            require("--margin 0", &[Setting::Margin], method, "plans among no polygons")?;
        }
        let search = self.roadmap.search(method, self.path.search)?;
        if self.optimum.gap.is_some() && !search.order.is_optimal() {
            return Err(format!(
                "--gap needs a search for the shortest path: --search {} takes any",
                search.order.name()
            ));
        }
        Ok(self.put_into(Planner::named(method).with_search(search), field))
    }

    fn put_into(&self, planner: Planner, field: Option<FieldPlanner>) -> Planner {
        let planner = self.effort.put_into(planner).with_criterion(self.optimum.criterion());
        let planner = planner
            .with(Setting::GridSearch, |settings| {
                settings.grid_search = self.path.search.unwrap_or_default();
                settings.ties = self.path.ties.unwrap_or_default();
                settings.forward = self.path.forward;
                settings.neighborhood = self.path.neighbors.unwrap_or_default();
            })
            .with(Setting::Field, |settings| settings.field = field);
        let planner = self.roadmap.put_into(planner);
        let planner = self.optimum.gap.map_or(planner, |share| planner.with_gap(share));
        let planner = self.path.space.map_or(planner, |space| planner.with_space(space));
        self.path.path.map_or(planner, |kind| planner.with_path(kind))
    }

    /// Why what the field is relaxed on cannot be had, if it cannot, with the cure.
    pub fn missing(&self) -> Option<String> {
        self.field.missing()
    }
}

impl OptimumArgs {
    fn criterion(&self) -> Criterion {
        match (self.metric, self.weights) {
            (MetricName::Weighted, Some(Weights(weights))) => Criterion::Weighted(weights),
            (MetricName::Time, _) => Criterion::Time,
            _ => Criterion::Euclidean,
        }
    }

    /// Refuses what the planner cannot do.
    fn check(&self, planner: Method) -> Result<(), String> {
        if self.weights.is_some() && self.metric != MetricName::Weighted {
            return Err("--weights are for --metric weighted".into());
        }
        let asked = if self.gap.is_some() { "--gap" } else { "--metric" };
        let optimises = self.gap.is_some() || self.metric != MetricName::Euclidean;
        if optimises {
            require(asked, &[Setting::Gap], planner, "does not look for the shortest path")?;
        }
        Ok(())
    }
}

impl PathArgs {
    /// Refuses what the planner cannot do.
    fn check(&self, planner: Method) -> Result<(), String> {
        if self.search.is_some() {
            let why = "searches neither a grid from cell to cell nor a roadmap";
            require("--search", &[Setting::GridSearch, Setting::Search], planner, why)?;
        }
        if self.neighbors.is_some() {
            let why = "searches no grid from cell to cell";
            require("--neighbors", &[Setting::Neighborhood], planner, why)?;
        }
        if self.ties.is_some() && (!planner.reads(Setting::Ties) || self.search != Some(GridSearch::AStar)) {
            let planners = readers(&[Setting::Ties], " or ");
            return Err(format!(
                "--ties needs --planner {planners} --search astar: only there are cells equally promising"
            ));
        }
        if self.forward {
            self.check_forward(planner)?;
        }
        if self.space.is_some() {
            require("--space", &[Setting::Space], planner, "has no grid")?;
        }
        if self.path == Some(PathKind::Middles) && !planner.descriptor().paths.contains(&PathKind::Middles) {
            return Err(format!("--path middles needs --planner trapezoid: {planner} has no doors on verticals"));
        }
        if self.path == Some(PathKind::Own) && !planner.has_own_path() {
            return Err(format!("--path own is not for {planner}: its path is taut as it is"));
        }
        Ok(())
    }

    /// Refuses --forward where nothing is searched, or where the search has to begin at the goal.
    fn check_forward(&self, planner: Method) -> Result<(), String> {
        if planner.reads(Setting::Search) {
            return Ok(());
        }
        if !planner.reads(Setting::Forward) {
            return Err(format!(
                "--forward needs a planner that searches: {planner} has neither a grid's cells nor a roadmap"
            ));
        }
        match self.search.unwrap_or_default() {
            GridSearch::Wave => {
                Err("--forward needs --search bfs, dfs, dijkstra, astar, greedy or deepening: the wave begins \
                                     at the goal, so that its labels are steps to it"
                    .into())
            }
            _ => Ok(()),
        }
    }
}

fn neighbors() -> impl TypedValueParser<Value = Neighborhood> {
    PossibleValuesParser::new(["4", "8"])
        .map(|count| if count == "4" { Neighborhood::Four } else { Neighborhood::Eight })
}

fn weights(text: &str) -> Result<Weights, String> {
    let values: Vec<f64> = text.split(',').map(|part| part.trim().parse().unwrap_or(f64::NAN)).collect();
    match values[..] {
        [a, b] if [a, b].iter().all(|w| w.is_finite() && *w > 0.0) => Ok(Weights([a, b])),
        _ => Err("must be two positive numbers, such as 1,0.5".into()),
    }
}

fn gap(text: &str) -> Result<f64, String> {
    number_in(text, |x| x.is_finite() && x > 0.0, "of more than 0, such as 0.001")
}

fn margin(text: &str) -> Result<f64, String> {
    let range = format!("from 0 to {MOST_MARGIN} (of the arm's reach)");
    number_in(text, |x| (0.0..=MOST_MARGIN).contains(&x), &range)
}

/// A range for the parser of whole numbers.
pub(super) fn whole(range: &RangeInclusive<usize>) -> RangeInclusive<i64> {
    *range.start() as i64..=*range.end() as i64
}
