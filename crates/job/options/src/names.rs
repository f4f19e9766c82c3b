//! Names of planners, paths, searches and other choices, so that help and shells can list them.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use cplan_fields::{Device, Difference, Initial, Limits, Measure, Stencil};
use cplan_motion::Objective;
use cplan_planners::planner::{GridSearch, PathKind, VisibilityGraph};
use cplan_planners::waves::search::Ties;
use cplan_solver::{GridSpace, Method, NamedJoints};
use std::ffi::OsStr;
use std::marker::PhantomData;

/// A type whose values have words on the command line.
pub trait Named: Copy + Send + Sync + 'static {
    /// All values, in the order of the help.
    const VALUES: &'static [Self];

    /// Returns its word.
    fn word(self) -> &'static str;

    /// Returns another word for it, which the help does not list.
    fn alias(self) -> Option<&'static str> {
        None
    }

    /// Returns its line in the help; may be empty.
    fn help(self) -> &'static str;
}

/// Parses one of the words of `T`; help and shells list them.
#[derive(Debug)]
pub struct WordParser<T>(PhantomData<T>);

impl<T> Clone for WordParser<T> {
    fn clone(&self) -> Self {
        Self(PhantomData)
    }
}

/// Returns the parser of the words of `T`.
pub fn word<T: Named>() -> WordParser<T> {
    WordParser(PhantomData)
}

impl<T: Named> TypedValueParser for WordParser<T> {
    type Value = T;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        let known = PossibleValuesParser::new(T::VALUES.iter().copied().map(possible_value));
        let word = known.parse_ref(command, argument, value)?;
        let is_meant = |value: &T| value.word() == word || value.alias() == Some(&word);
        Ok(T::VALUES.iter().copied().find(is_meant).expect("the word is one of its values"))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(T::VALUES.iter().copied().map(possible_value)))
    }
}

fn possible_value<T: Named>(value: T) -> PossibleValue {
    let possible = PossibleValue::new(value.word()).aliases(value.alias());
    if value.help().is_empty() { possible } else { possible.help(value.help()) }
}

impl Named for Method {
    const VALUES: &'static [Self] = &Method::ALL;

    fn word(self) -> &'static str {
        self.name()
    }

    fn help(self) -> &'static str {
        self.descriptor().summary
    }
}

impl Named for PathKind {
    const VALUES: &'static [Self] = &PathKind::CHOICES;

    fn word(self) -> &'static str {
        self.name()
    }

    fn help(self) -> &'static str {
        match self {
            PathKind::Own => "The path of the planner's method",
            PathKind::Taut => "The same path pulled taut: shorter, nearer to obstacles",
            PathKind::Middles => {
                "For trapezoid: through the middles of portals; through a cell's centre only between portals on one \
                 vertical"
            }
        }
    }
}

impl Named for VisibilityGraph {
    const VALUES: &'static [Self] = &VisibilityGraph::ALL;

    fn word(self) -> &'static str {
        self.name()
    }

    fn help(self) -> &'static str {
        match self {
            VisibilityGraph::Reduced => "Only arcs that a shortest path can use: tangent to the obstacles at both ends",
            VisibilityGraph::Full => {
                "The textbook definition: an arc between any two corners that see each other, and every side"
            }
        }
    }
}

impl Named for GridSearch {
    const VALUES: &'static [Self] = &GridSearch::ALL;

    fn word(self) -> &'static str {
        self.name()
    }

    fn help(self) -> &'static str {
        match self {
            GridSearch::Wave => "For grids: labels all cells, beginning at the goal; fewest moves",
            GridSearch::BreadthFirst => {
                "Breadth first from one end (start or goal) to the other; fewest moves or edges"
            }
            GridSearch::DepthFirst => "Depth first from one end to the other; any path",
            GridSearch::Dijkstra => "Least cost first: length, or on grids moves, where a diagonal move costs 1.414",
            GridSearch::AStar => {
                "Least cost so far plus straight distance left first; the same path length, found sooner"
            }
            GridSearch::Greedy => "Least straight distance left first; any path, found quickly",
            GridSearch::IterativeDeepening => {
                "For grids: depth first within a limit of moves, which grows by one each round; fewest moves"
            }
        }
    }
}

impl Named for GridSpace {
    const VALUES: &'static [Self] = &GridSpace::ALL;

    fn word(self) -> &'static str {
        self.name()
    }

    fn help(self) -> &'static str {
        match self {
            GridSpace::Rows => "By exact slices: first only wholly free cells, then also cells with a free centre",
            GridSpace::Whole => "By exact slices: only wholly free cells, in every attempt",
            GridSpace::Centers => "By exact slices: cells with a free centre, in every attempt",
            GridSpace::Sampled => "By parry2d's collision checks at the cells' centres",
        }
    }
}

/// Implements [`Named`] for a type: for each variant its name, an alias after a bar, and its help, which may be empty.
macro_rules! named {
    (@alias) => {
        None
    };
    (@alias $alias:literal) => {
        Some($alias)
    };
    ($of:ty: $($variant:ident $name:literal $(| $alias:literal)? $help:literal),+) => {
        impl Named for $of {
            const VALUES: &'static [Self] = &[$(Self::$variant),+];

            fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }

            fn alias(self) -> Option<&'static str> {
                match self {
                    $(Self::$variant => named!(@alias $($alias)?)),+
                }
            }

            fn help(self) -> &'static str {
                match self {
                    $(Self::$variant => $help),+
                }
            }
        }
    };
}

named!(Difference: Central "central" "Central differences: monotone only for an epsilon below 2",
    Upwind "upwind" "Upwind differences: monotone for every epsilon");

named!(Device: Cpu "cpu" "Double precision",
    Gpu "gpu" "Single precision, cells red-black or all at once; needs a program built with the feature gpu");

named!(Stencil: Square "square" "All four neighbours have the same weight",
    Anisotropic "anisotropic" "Neighbours along joint 2 have the weight beta^2, where beta is a cell's width along joint 1 over that along joint 2");

named!(Limits: High "high" "Limits repel, like obstacles",
    Reflecting "reflecting" "Limits neither attract nor repel");

named!(Initial: High "high" "The value of obstacles", Low "low" "The value of goals, as in published counts of sweeps");

named!(Measure: GreatestRelativeChange "relative" "Greatest change relative to the cell's value", GreatestChange "greatest" "Greatest change",
    SumOfChange "absolute" | "sum" "Sum of changes; alias: sum", SumOfSquares "squares" "Sum of squared changes",
    DifferenceOfSums "sums" "Difference between the sums of changes of this and the previous sweep");

named!(Ties: Farthest "farthest" "The cell farthest from the beginning of the search, and of these the one found last: \
                                  goes straight ahead",
    First "first" "The cell found first: advances along all equally good routes together");

named!(NamedJoints: All "all" "Every movable joint of the robot", Planned "planned" "The two joints of the plan");

named!(Objective: Length "length" "The length of the path", Time "time" "The time of the motion");
