//! Planners, paths, searches and what else has names, so that help and shells can list them.

use crate::engine::{GridSpace, Method, NamedJoints};
use crate::field::search::Ties;
use crate::field::{Device, Difference, Limits, Measure, Stencil};
use crate::motion::Objective;
use crate::planner::{GridSearch, PathKind, VisibilityGraph};
use clap::ValueEnum;
use clap::builder::PossibleValue;

impl ValueEnum for Method {
    fn value_variants<'a>() -> &'a [Self] {
        &Method::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            Method::Shortest => {
                "The shortest path, from exact slices, with a proven bound on the optimum; or a proof that there is none"
            }
            Method::First => {
                "The first certified path that is found, or a proof that there is none: the quickest answer"
            }
            Method::Visibility => "Visibility graph: the shortest path, with a proven bound on the optimum",
            Method::Trapezoid => "Trapezoidal decomposition: a channel of cells, and the funnel path through it",
            Method::Triangles => "Triangles of free space: a channel of them, and the funnel path through it",
            Method::Voronoi => {
                "Voronoi diagram: the way whose least distance from obstacles, in joint space, is the greatest"
            }
            Method::Prm => "Probabilistic roadmap: random configurations, each joined to the nearest that it sees",
            Method::Wavefront => "Manhattan wavefront on a grid",
            Method::Harmonic => "Harmonic potential on a grid",
            Method::Subdivision => "Subdivision into boxes: a path with room around it, or a proof that there is none",
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

impl ValueEnum for PathKind {
    fn value_variants<'a>() -> &'a [Self] {
        &PathKind::CHOICES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            PathKind::Own => "As the planner's method has it",
            PathKind::Taut => "Pulled taut: shorter, nearer to obstacles",
            PathKind::Middles => {
                "Of trapezoid: through the middles of doors alone, and a cell's centre only between doors on one vertical"
            }
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

impl ValueEnum for VisibilityGraph {
    fn value_variants<'a>() -> &'a [Self] {
        &VisibilityGraph::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            VisibilityGraph::Reduced => "Arcs that a shortest path can take: tangent to the obstacle at either end",
            VisibilityGraph::Full => {
                "By definition: an arc between any two corners that see each other, and every side"
            }
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

impl ValueEnum for GridSearch {
    fn value_variants<'a>() -> &'a [Self] {
        &GridSearch::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            GridSearch::Wave => "Of grids: labels all cells from the goal: fewest moves",
            GridSearch::BreadthFirst => "Breadth first, until the other end is met: fewest moves or edges",
            GridSearch::DepthFirst => "Depth first, until the other end is met: some path",
            GridSearch::Dijkstra => {
                "Least cost first: lengths, or on grids moves, where a diagonal one counts for 1.414"
            }
            GridSearch::AStar => "The same cost, led by the distance to the other end",
            GridSearch::Greedy => "Nearest to the other end first: some path, found soon",
            GridSearch::IterativeDeepening => {
                "Of grids: depth first within a limit of moves, which grows by one each round: fewest moves"
            }
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

impl ValueEnum for GridSpace {
    fn value_variants<'a>() -> &'a [Self] {
        &GridSpace::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            GridSpace::Rows => "By exact slices: cells that are wholly free first, then cells whose centres are",
            GridSpace::Centers => "By exact slices: cells whose centres are free, in every attempt",
            GridSpace::Sampled => "By parry2d's collision checks at the cells' centres",
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

/// Names of the variants of types that have no others, second names after a bar, and help that may be empty.
macro_rules! named {
    ($of:ty: $($variant:ident $name:literal $(| $alias:literal)? $help:literal),+) => {
        impl clap::ValueEnum for $of {
            fn value_variants<'a>() -> &'a [Self] {
                &[$(Self::$variant),+]
            }

            fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
                let (value, help) = match self {
                    $(Self::$variant => (clap::builder::PossibleValue::new($name)$(.alias($alias))?, $help)),+
                };
                Some(if help.is_empty() { value } else { value.help(help) })
            }
        }
    };
}

pub(crate) use named;

named!(Difference: Central "central" "Monotone for an epsilon of less than 2 only", Upwind "upwind" "Monotone for every epsilon");

named!(Device: Cpu "cpu" "In double precision",
    Gpu "gpu" "In single precision, cells red-black or all at once; needs a program with the feature gpu");

named!(Stencil: Square "square" "All four neighbours weigh the same",
    Anisotropic "anisotropic" "Those along joint 2 weigh beta^2 as much, beta the width of a cell along joint 1 over that along joint 2");

named!(Limits: High "high" "Obstacles", Reflecting "reflecting" "Mirrors: they neither attract nor repel");

named!(Measure: GreatestRelativeChange "relative" "Greatest change as a part of the value", GreatestChange "greatest" "Greatest change",
    SumOfChange "absolute" | "sum" "Sum of changes, also called sum", SumOfSquares "squares" "Sum of squared changes",
    DifferenceOfSums "sums" "Difference between the sum of changes and that of the sweep before");

named!(Ties: Farthest "farthest" "The cell that has come farther, and of equals the last one: goes straight ahead",
    First "first" "The cell that came first: all equally promising cells in rounds, one step at a time");

named!(NamedJoints: All "all" "Every movable joint of the robot", Planned "planned" "The two that are planned for");

named!(Objective: Length "length" "The length of the path", Time "time" "The time of the motion");
