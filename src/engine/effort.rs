//! How hard to try.

use crate::planner::{FieldPlanner, PathKind, Wavefront};
use crate::space::Metric;

/// How the cells of a grid are decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GridSpace {
    /// By exact rows: cells that are wholly free, then cells whose centres are ([`Proves`](crate::cspace::Proves) says which).
    #[default]
    Rows,
    /// By parry2d's collision checks at the centres ([`Proves::Sampled`](crate::cspace::Proves::Sampled)): what other libraries
    /// do, to compare with. Slower by as much as there are more cells than rows.
    Sampled,
}

impl GridSpace {
    /// All, in the order of the command line's help.
    pub const ALL: [Self; 2] = [Self::Rows, Self::Sampled];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rows => "rows",
            Self::Sampled => "sampled",
        }
    }

    /// What results say of it: nothing of rows.
    #[must_use]
    pub fn told(self) -> Option<&'static str> {
        (self != Self::Rows).then(|| self.name())
    }
}

/// How much to try before the answer is unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Attempts, each finer than the one before: a quarter of the margin; cells that are wholly free, then as many that are free at
    /// their centres, then twice as many along each axis; sampled ones twice as many each time.
    pub levels: usize,
    /// First margin by which polygonal obstacles are grown, as a share of the arm's reach.
    pub margin: f64,
    /// First number of grid cells along each axis.
    pub cells: usize,
    /// How the cells of grids are decided.
    pub space: GridSpace,
    /// Whether fields get as many cells that are square in joint space instead, where a radian is as long as a metre: then
    /// their equation is that of the configuration space, not of its picture on a grid.
    pub square: bool,
    /// Boxes for a proof that there is no path, and for planning by subdivision.
    pub boxes: usize,
    /// What makes a path short, for the visibility planner and for bounds.
    pub metric: Metric,
    /// Go on refining until the path is proven to be no longer than the optimum by more than this share of it (planners
    /// that optimise only). A larger one leaves more room, in which motions are faster.
    pub gap: Option<f64>,
    /// Whether to bound the optimum from below (planners that optimise only); if not, the gap is aimed at without proof.
    pub bounded: bool,
    /// Which path of a planner that has two; none for what the planner is used to (see [`Method::path_kind`]).
    ///
    /// [`Method::path_kind`]: super::Method::path_kind
    pub path: Option<PathKind>,
    /// How the wavefront planner searches its grid.
    pub wavefront: Wavefront,
    /// The field to follow in place of the default one (harmonic planner only).
    pub field: Option<FieldPlanner>,
}

impl Default for Effort {
    /// Margins from a thousandth of the reach down to a millionth; grids from 256 x 256 to 1024 x 1024.
    fn default() -> Self {
        Self {
            levels: 6,
            margin: 1e-3,
            cells: 256,
            space: GridSpace::Rows,
            square: true,
            boxes: 200_000,
            metric: Metric::Euclidean,
            gap: None,
            bounded: true,
            path: None,
            wavefront: Wavefront::default(),
            field: None,
        }
    }
}
