//! Words for planners, paths, searches and other choices, for help and shells to list.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue};
use cplan_fields::{Device, Difference, Initial, Limits, Lines, Measure, Order, Scan, Stencil};
use cplan_motion::Objective;
use cplan_planners::planner::{GridSearch, PathKind, VisibilityGraph};
use cplan_planners::waves::search::Ties;
use cplan_solver::{GridSpace, Method, NamedJoints};
use std::ffi::OsStr;

/// A value, its word on the command line, and its line in the help, which may be empty. After a bar, the word may have an alias,
/// which the help does not list.
pub type Word<T> = (T, &'static str, &'static str);

/// Parses one of these words; help and shells list them.
#[derive(Debug, Clone)]
pub struct WordParser<T>(Vec<Word<T>>);

/// Returns the parser of these words.
pub fn word<T>(words: impl Into<Vec<Word<T>>>) -> WordParser<T> {
    WordParser(words.into())
}

impl<T: Copy + Send + Sync + 'static> TypedValueParser for WordParser<T> {
    type Value = T;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        let known = PossibleValuesParser::new(self.0.iter().map(possible_value));
        let word =
            known.parse_ref(command, argument, value).map_err(|error| with_search_tip(error, argument, value))?;
        let is_meant = |(_, words, _): &&Word<T>| words.split('|').any(|own| own == word);
        Ok(self.0.iter().find(is_meant).expect("the word is one of its values").0)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.0.iter().map(possible_value)))
    }
}

/// Adds a tip to an error about a planner's name that is the name of a search.
fn with_search_tip(mut error: clap::Error, argument: Option<&clap::Arg>, value: &OsStr) -> clap::Error {
    let Some(argument) = argument.filter(|argument| argument.get_id() == "planner") else { return error };
    let Some((search, name, _)) = searches().into_iter().find(|(_, name, _)| value == *name) else { return error };
    let option = if argument.get_long().is_some() { "--planner " } else { "" };
    let with = |planner: &str| format!("`{option}{planner} --search {name}`");
    let is_for_grids = matches!(search, GridSearch::Wave | GridSearch::IterativeDeepening);
    let example = if is_for_grids { with("wavefront") } else { format!("{} or {}", with("wavefront"), with("prm")) };
    let tip = format!("{name} is a search, not a planner; write {example}");
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    error
}

fn possible_value<T>(&(_, words, help): &Word<T>) -> PossibleValue {
    let mut words = words.split('|');
    let possible = PossibleValue::new(words.next().unwrap_or_default()).aliases(words);
    if help.is_empty() { possible } else { possible.help(help) }
}

/// Returns the words of planners.
pub fn planners() -> Vec<Word<Method>> {
    Method::ALL.map(|method| (method, method.name(), method.descriptor().summary)).into()
}

pub(super) fn path_kinds() -> [Word<PathKind>; 3] {
    let middles = "For trapezoid: through the middles of portals, and through a cell's centre where two portals are on one vertical";
    [
        (PathKind::Own, "The path of the planner's method"),
        (PathKind::Taut, "The same path pulled taut: shorter, nearer to obstacles"),
        (PathKind::Middles, middles),
    ]
    .map(|(kind, help)| (kind, kind.name(), help))
}

pub(super) fn visibility_graphs() -> [Word<VisibilityGraph>; 2] {
    let full = "The textbook definition: an arc between any two corners that see each other, and every side";
    [
        (
            VisibilityGraph::Reduced,
            "Only arcs that a shortest path can use, which are tangent to the obstacles at both ends",
        ),
        (VisibilityGraph::Full, full),
    ]
    .map(|(graph, help)| (graph, graph.name(), help))
}

pub(super) fn searches() -> [Word<GridSearch>; 7] {
    use GridSearch::{AStar, BreadthFirst, DepthFirst, Dijkstra, Greedy, IterativeDeepening, Wave};
    [
        (Wave, "For grids: labels all cells, beginning at the goal; fewest moves"),
        (BreadthFirst, "Breadth first from one end (start or goal) to the other; fewest moves or edges"),
        (DepthFirst, "Depth first from one end to the other; any path"),
        (Dijkstra, "Least cost first; the cost is the length, or on grids the moves (a diagonal move costs 1.414)"),
        (AStar, "Least sum of cost and straight distance to the end first; finds paths as short as dijkstra's, sooner"),
        (Greedy, "Least straight distance to the end first; any path, found quickly"),
        (
            IterativeDeepening,
            "For grids: depth first with a limit on the number of moves, which each round raises by one; fewest moves",
        ),
    ]
    .map(|(search, help)| (search, search.name(), help))
}

pub(super) fn grid_spaces() -> [Word<GridSpace>; 4] {
    [
        (
            GridSpace::Rows,
            "By exact slices: first only wholly free cells, in a second attempt also cells with a free centre",
        ),
        (GridSpace::Whole, "By exact slices: only wholly free cells, in every attempt"),
        (GridSpace::Centers, "By exact slices: cells with a free centre, in every attempt"),
        (GridSpace::Sampled, "By parry2d's collision checks at the cells' centres"),
    ]
    .map(|(space, help)| (space, space.name(), help))
}

pub(super) const DIFFERENCES: [Word<Difference>; 2] = [
    (Difference::Central, "central", "Central differences: monotone only for an epsilon below 2"),
    (Difference::Upwind, "upwind", "Upwind differences: monotone for every epsilon"),
];

pub(super) const DEVICES: [Word<Device>; 2] = [
    (Device::Cpu, "cpu", "Double precision"),
    (
        Device::Gpu,
        "gpu",
        "Single precision; relaxes cells red-black or all at once; needs a program built with the feature gpu",
    ),
];

/// Orders of a sweep over the cells.
pub const ORDERS: [Word<Order>; 5] = [
    (Order::Lines(Scan::ROWS), "rows", "Line by line, joint 2 fastest"),
    (Order::Lines(Scan { lines: Lines::Columns, ..Scan::ROWS }), "columns", "Line by line, joint 1 fastest"),
    (Order::Corners(Lines::Rows), "corners", "Line by line, from each of the four corners in turn"),
    (Order::RedBlack, "red-black", "First the red, then the black squares of a chessboard"),
    (Order::FourColors, "four-color", "In blocks of 2 x 2 cells, one cell of each block after the other"),
];

const ANISOTROPIC: &str = "Neighbours along joint 2 have the weight beta^2, where beta is a cell's width along joint 1 over \
                           that along joint 2";

pub(super) const STENCILS: [Word<Stencil>; 2] = [
    (Stencil::Square, "square", "All four neighbours have the same weight"),
    (Stencil::Anisotropic, "anisotropic", ANISOTROPIC),
];

/// Effects of joint limits on a field.
pub const LIMITS: [Word<Limits>; 2] = [
    (Limits::High, "high", "Limits repel, like obstacles"),
    (Limits::Reflecting, "reflecting", "Limits neither attract nor repel"),
];

/// Values of free cells before the first sweep.
pub const INITIALS: [Word<Initial>; 2] = [
    (Initial::High, "high", "The value of obstacles"),
    (Initial::Low, "low", "The value of goals; published numbers of sweeps were counted with it"),
];

/// Measures of a sweep's changes.
pub const MEASURES: [Word<Measure>; 5] = [
    (Measure::GreatestRelativeChange, "relative", "Greatest change relative to the cell's value"),
    (Measure::GreatestChange, "greatest", "Greatest change"),
    (Measure::SumOfChange, "absolute|sum", "Sum of changes; alias: sum"),
    (Measure::SumOfSquares, "squares", "Sum of squared changes"),
    (Measure::DifferenceOfSums, "sums", "Difference between the sums of changes of this and the previous sweep"),
];

const FARTHEST: &str = "The cell farthest from the beginning of the search, and among equals the one found last: the search goes straight ahead";

pub(super) const TIES: [Word<Ties>; 2] = [
    (Ties::Farthest, "farthest", FARTHEST),
    (Ties::First, "first", "The cell found first: the search advances along all equally good routes together"),
];

/// Joints in messages.
pub const JOINTS: [Word<NamedJoints>; 2] = [
    (NamedJoints::All, "all", "Every movable joint of the robot"),
    (NamedJoints::Planned, "planned", "The two joints of the plan"),
];

pub(super) const OBJECTIVES: [Word<Objective>; 2] =
    [(Objective::Length, "length", "The length of the path"), (Objective::Time, "time", "The time of the motion")];
