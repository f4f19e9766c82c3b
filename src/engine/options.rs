//! What is asked for: a planner with options of its own, how to drive, and what files hold.

use super::{Effort, GridSpace, Method};
use crate::field::Neighborhood;
use crate::model::{Arm, Joint, Scene};
use crate::motion::{Drive, SHORTEST_INTERVAL};
use crate::planner::{FieldPlanner, GridSearch, PathKind, Wavefront};
use crate::space::Metric;
use std::ops::RangeInclusive;

/// What makes a path short.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Criterion {
    /// Square root of the sum of squares, radians and metres as they come.
    #[default]
    Euclidean,
    /// The same with the joints' values multiplied by these weights, both positive.
    Weighted([f64; 2]),
    /// Seconds at the joints' top speeds.
    Time,
}

impl Criterion {
    /// The metric for an arm.
    #[must_use]
    pub fn metric(self, arm: &Arm) -> Metric {
        match self {
            Criterion::Euclidean => Metric::Euclidean,
            Criterion::Weighted(weights) => Metric::Weighted { weights },
            Criterion::Time => Metric::Time { speeds: arm.joints.each_ref().map(|joint| joint.velocity) },
        }
    }
}

/// A planner with what it can be told. [`Planner::named`] has the defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Planner {
    /// The shortest path, from exact rows, with a proven bound on the optimum.
    Shortest {
        /// What makes a path short.
        criterion: Criterion,
        /// Refine until the path is proven to be longer than the optimum by no more than this share of it; none for 1e-4. A
        /// larger one leaves room in which motions are faster.
        gap: Option<f64>,
        /// As of [`Planner::Visibility`], whose graph has its turn where rows do not tell.
        margin: f64,
    },
    /// The first certified path that is found.
    First,
    /// Visibility graph and A*: the shortest path, with a proven bound on the optimum.
    Visibility {
        /// What makes a path short.
        criterion: Criterion,
        /// As of [`Planner::Shortest`]; none for what the first margin gives.
        gap: Option<f64>,
        /// First margin by which polygonal obstacles are grown, as a share of the arm's reach; quartered where needed.
        margin: f64,
    },
    /// Trapezoidal decomposition: a channel of cells.
    Trapezoid {
        /// Which path through the channel.
        path: PathKind,
        /// As of [`Planner::Visibility`].
        margin: f64,
    },
    /// Manhattan wavefront, or another search of a grid.
    Wavefront {
        /// How the grid is searched.
        search: GridSearch,
        /// Where a move can lead.
        neighborhood: Neighborhood,
        /// How cells are decided.
        space: GridSpace,
        /// Which path through the cells.
        path: PathKind,
        /// First number of cells along each axis; doubled where needed.
        cells: usize,
    },
    /// Harmonic potential on a grid, or another field.
    Harmonic {
        /// The field in place of the harmonic one; its path is the one that stands beside it here.
        field: Option<FieldPlanner>,
        /// How cells are decided.
        space: GridSpace,
        /// Which path: the curve along the gradient, or that one pulled taut.
        path: PathKind,
        /// First number of cells along each axis; none for 256 x 256 cells' worth of cells that are square in joint space.
        cells: Option<usize>,
    },
    /// Subdivision into free, stuck and mixed boxes.
    Subdivision {
        /// Which path through the free boxes.
        path: PathKind,
    },
}

/// Shares of the arm's reach that a margin can be: more than 0, at most this.
pub const MOST_MARGIN: f64 = 0.1;

/// Numbers of cells along an axis to begin with.
pub const CELLS: RangeInclusive<usize> = 8..=2048;

/// Numbers of attempts.
pub const LEVELS: RangeInclusive<usize> = 1..=12;

impl Planner {
    /// The planner of that name, as it is if nothing else is said.
    #[must_use]
    pub fn named(method: Method) -> Self {
        let Effort { margin, cells, gap, space, .. } = Effort::default();
        let (criterion, path) = (Criterion::Euclidean, method.path_kind());
        match method {
            Method::Shortest => Planner::Shortest { criterion, gap, margin },
            Method::First => Planner::First,
            Method::Visibility => Planner::Visibility { criterion, gap, margin },
            Method::Trapezoid => Planner::Trapezoid { path, margin },
            Method::Wavefront => {
                let Wavefront { search, neighborhood, .. } = Wavefront::default();
                Planner::Wavefront { search, neighborhood, space, path, cells }
            }
            Method::Harmonic => Planner::Harmonic { field: None, space, path, cells: None },
            Method::Subdivision => Planner::Subdivision { path },
        }
    }

    /// Which planner it is.
    #[must_use]
    pub fn method(&self) -> Method {
        match self {
            Planner::Shortest { .. } => Method::Shortest,
            Planner::First => Method::First,
            Planner::Visibility { .. } => Method::Visibility,
            Planner::Trapezoid { .. } => Method::Trapezoid,
            Planner::Wavefront { .. } => Method::Wavefront,
            Planner::Harmonic { .. } => Method::Harmonic,
            Planner::Subdivision { .. } => Method::Subdivision,
        }
    }

    /// Which of its paths it gives.
    #[must_use]
    pub fn path_kind(&self) -> PathKind {
        match *self {
            Planner::Trapezoid { path, .. }
            | Planner::Wavefront { path, .. }
            | Planner::Harmonic { path, .. }
            | Planner::Subdivision { path } => path,
            Planner::Shortest { .. } | Planner::First | Planner::Visibility { .. } => PathKind::Taut,
        }
    }

    /// The same planner, giving the other path, if it has two.
    #[must_use]
    pub fn with_path(mut self, kind: PathKind) -> Self {
        if let Planner::Trapezoid { path, .. }
        | Planner::Wavefront { path, .. }
        | Planner::Harmonic { path, .. }
        | Planner::Subdivision { path } = &mut self
        {
            *path = kind;
        }
        self
    }

    /// What it is after: the gap asked for, of planners that optimise.
    #[must_use]
    pub fn gap(&self) -> Option<f64> {
        match *self {
            Planner::Shortest { gap, .. } | Planner::Visibility { gap, .. } => gap,
            _ => None,
        }
    }

    /// How the cells of its grid are decided, if it has one.
    #[must_use]
    pub fn space(&self) -> Option<GridSpace> {
        match *self {
            Planner::Wavefront { space, .. } | Planner::Harmonic { space, .. } => Some(space),
            _ => None,
        }
    }

    /// The field that it follows, if it is not the plain harmonic one.
    #[must_use]
    pub fn field(&self) -> Option<&FieldPlanner> {
        if let Planner::Harmonic { field, .. } = self { field.as_ref() } else { None }
    }

    /// How it is to be run for an arm, with so many attempts.
    #[must_use]
    pub fn effort(&self, arm: &Arm, levels: usize) -> Effort {
        let base = Effort { levels, ..Effort::default() };
        let path = Some(self.path_kind()).filter(|_| self.method().has_own_path());
        match *self {
            Planner::First => base,
            Planner::Shortest { criterion, gap, margin } | Planner::Visibility { criterion, gap, margin } => {
                Effort { metric: criterion.metric(arm), gap, margin, ..base }
            }
            Planner::Trapezoid { margin, .. } => Effort { margin, path, ..base },
            Planner::Wavefront { search, neighborhood, space, cells, .. } => {
                let wavefront = Wavefront { search, neighborhood, ..Wavefront::default() };
                Effort { cells, space, path, wavefront, ..base }
            }
            Planner::Harmonic { field, space, cells, .. } => match cells {
                Some(cells) => Effort { field, space, path, cells, square: false, ..base },
                None => Effort { field, space, path, ..base },
            },
            Planner::Subdivision { .. } => Effort { path, ..base },
        }
    }

    /// What of it makes no sense, by name.
    fn error(&self) -> Option<String> {
        let positive = |name: &str, value: f64| {
            (!value.is_finite() || value <= 0.0).then(|| format!("{name}: {value} is not finite and positive"))
        };
        match *self {
            Planner::Shortest { criterion, gap, margin } | Planner::Visibility { criterion, gap, margin } => {
                let weights = if let Criterion::Weighted(weights) = criterion { weights } else { [1.0; 2] };
                let wrong = weights.into_iter().find_map(|weight| positive("weights", weight));
                wrong.or_else(|| positive("gap", gap?)).or_else(|| wrong_margin(margin))
            }
            Planner::Trapezoid { margin, .. } => wrong_margin(margin),
            Planner::Wavefront { cells, .. } | Planner::Harmonic { cells: Some(cells), .. } => (!CELLS
                .contains(&cells))
            .then(|| format!("cells: {cells} is not from {} to {}", CELLS.start(), CELLS.end())),
            Planner::Harmonic { cells: None, .. } | Planner::First | Planner::Subdivision { .. } => None,
        }
    }
}

fn wrong_margin(margin: f64) -> Option<String> {
    (!(margin > 0.0 && margin <= MOST_MARGIN))
        .then(|| format!("margin: {margin} is not more than 0 and at most {MOST_MARGIN} (of the arm's reach)"))
}

/// Joints that ROS 2 messages name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NamedJoints {
    /// Every movable joint of the robot.
    #[default]
    All,
    /// The two that are planned for.
    Planned,
}

/// What is asked for beside the problem.
///
/// ```
/// use cplan::{Options, Planner};
///
/// let options = Options { planner: Planner::First, ..Options::default() };
/// assert_eq!(options.levels, Options::default().levels);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Which planner, with options of its own.
    pub planner: Planner,
    /// Attempts, each finer than the one before, from 1 to 12.
    pub levels: usize,
    /// Whether planners that optimise bound the optimum from below; if not, the gap is aimed at without proof.
    pub bounded: bool,
    /// How to drive along the path.
    pub drive: Drive,
    /// Greatest jerk of each joint in place of its own, rad/s3 or m/s3; none for a joint without a limit.
    pub jerk: Option<[Option<f64>; 2]>,
    /// Joints that ROS 2 messages name.
    pub joints: NamedJoints,
    /// Whether tables and messages have accelerations, so that controllers join points by quintics.
    pub accelerations: bool,
    /// Whether the JSON has the time that each stage took; without it the same input gives the same bytes.
    pub timings: bool,
}

impl Default for Options {
    /// The shortest path, six attempts, a sample every hundredth of a second.
    fn default() -> Self {
        Self {
            planner: Planner::named(Method::Shortest),
            levels: Effort::default().levels,
            bounded: true,
            drive: Drive::default(),
            jerk: None,
            joints: NamedJoints::All,
            accelerations: false,
            timings: false,
        }
    }
}

impl Options {
    /// How single motions are to be planned in a scene.
    pub(crate) fn effort(&self, scene: &Scene) -> Effort {
        Effort { bounded: self.bounded, ..self.planner.effort(scene.arm(), self.levels) }
    }

    /// Puts the limits that are given here in place of the joints' own.
    pub(crate) fn override_limits(&self, joints: &mut [Joint; 2]) {
        Joint::override_jerks(joints, self.jerk);
    }

    /// What makes no sense, by name. `has_steps` says whether they are for a sequence of steps.
    pub(crate) fn error(&self, has_steps: bool) -> Option<String> {
        let Drive { period, blend, tip_speed } = self.drive;
        let jerks = self.jerk.into_iter().flatten().flatten();
        let not_positive = |value: &f64| !value.is_finite() || *value <= 0.0;
        if let Some(error) = self.planner.error() {
            Some(error)
        } else if !LEVELS.contains(&self.levels) {
            Some(format!("levels: {} is not from {} to {}", self.levels, LEVELS.start(), LEVELS.end()))
        } else if !(period.is_finite() && period >= SHORTEST_INTERVAL) {
            Some(format!("period: {period} s is not finite and at least {SHORTEST_INTERVAL} s"))
        } else if blend.is_nan() || blend < 0.0 {
            Some(format!("blend: {blend} is not a radius"))
        } else if let Some(wrong) = tip_speed.into_iter().chain(jerks).find(not_positive) {
            Some(format!("speed and jerk: {wrong} is not finite and positive"))
        } else if has_steps && self.planner.gap().is_some() {
            Some("--gap is for a single motion; what is proven of a sequence of steps is part of every answer".into())
        } else {
            None
        }
    }
}
