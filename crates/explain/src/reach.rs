//! Reachability: the places that the tip can reach from a home configuration, with their IK solutions. The answers are
//! certified, or proven impossible.

use cplan_core::check::certify;
use cplan_core::model::{Arm, MotionProblem, Outcome, Scene, inverse};
use cplan_core::space::{Configuration, GoalSet, Measure, Metric, Path, Segment};
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_solver::decide;
use petgraph::unionfind::UnionFind;
use serde::{Serialize, Serializer};

/// Largest number of square cells that are examined.
pub const MAX_PLACES: usize = 4_000_000;

/// Largest number of boxes for the decision about one set of connected solutions.
const BOXES_PER_SET: usize = 20_000;

/// Number of values of each joint in the sample of configurations that bounds the places of the tip.
const SAMPLES_PER_JOINT: usize = 256;

/// Reachability of a configuration from the home configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Access {
    /// A certified motion leads to the configuration.
    Reachable,
    /// It is not known whether a motion leads to the configuration.
    Unknown,
    /// The configuration is free, but it is proven that no motion leads to it.
    Unreachable,
    /// The configuration is not free.
    Blocked,
}

impl Access {
    /// All values.
    pub const ALL: [Self; 4] = [Self::Reachable, Self::Unknown, Self::Unreachable, Self::Blocked];

    /// Returns the word for this value in output.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reachable => "reachable",
            Self::Unknown => "unknown",
            Self::Unreachable => "unreachable",
            Self::Blocked => "blocked",
        }
    }
}

/// A solution of the inverse kinematics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Solution {
    /// Joint values within the limits, base to tip. For a solution with a free joint, these are the values that a
    /// motion reaches, or otherwise those nearest to home.
    #[serde(serialize_with = "pair")]
    pub joints: Configuration,
    /// Reachability of the solution.
    pub access: Access,
}

fn pair<S: Serializer>(q: &Configuration, serializer: S) -> Result<S::Ok, S::Error> {
    [q[0], q[1]].serialize(serializer)
}

/// Reachability of the tip at the centres of square cells.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reach {
    /// The home configuration.
    #[serde(serialize_with = "pair")]
    pub home: Configuration,
    /// Side of the cells, metres.
    pub cell: f64,
    /// Least coordinates of the first cell, metres.
    pub corner: [f64; 2],
    /// Number of cells along x and along y.
    pub size: [usize; 2],
    /// For each cell, the solutions that put the tip at its centre, row by row from the lowest row. Empty if the centre
    /// is out of reach.
    pub places: Vec<Vec<Solution>>,
}

impl Reach {
    /// Returns the centre of the cell with this index.
    #[must_use]
    pub fn center(&self, place: usize) -> Point {
        let at = [place % self.size[0], place / self.size[0]];
        Point::from([0, 1].map(|k| self.corner[k] + self.cell * (at[k] as f64 + 0.5)))
    }

    /// Iterates over the cells with solutions. For each, returns its index, the best reachability of its solutions, and
    /// how many of them have that reachability.
    pub fn best(&self) -> impl Iterator<Item = (usize, Access, usize)> {
        self.places.iter().enumerate().filter_map(|(number, solutions)| {
            let best = solutions.iter().map(|solution| solution.access).min()?;
            Some((number, best, solutions.iter().filter(|solution| solution.access == best).count()))
        })
    }

    /// Counts cells by the best reachability of their solutions, in the order of [`Access::ALL`].
    #[must_use]
    pub fn tally(&self) -> [usize; 4] {
        Access::ALL.map(|access| self.best().filter(|(_, best, _)| *best == access).count())
    }
}

/// Computes the IK solutions for the centre of each square cell of side `cell`, in metres. For each solution, decides
/// whether a motion from `home` leads to it that keeps the world's clearance.
///
/// Solutions of neighbouring cells are connected if the straight motion between them is certified. Of each set of
/// connected solutions, only one is decided. A certified motion to it extends to the whole set, and a proof that it is
/// unreachable holds for the whole set. Returns `None` if there are more than [`MAX_PLACES`] cells.
///
/// Takes `O(n)` short certificates for `n` solutions, and one decision per set.
#[must_use]
pub fn reach(scene: &Scene, home: Configuration, cell: f64) -> Option<Reach> {
    let arm = scene.arm();
    let [lower, upper] = tip_bounds(arm)?;
    // A whole number of cells. One more on each side, because the tip may reach beyond the sample.
    let first = [0, 1].map(|k| (lower[k] / cell).floor() - 1.0);
    let count = [0, 1].map(|k| (upper[k] / cell).floor() - first[k] + 2.0);
    if !(cell > 0.0 && count[0] * count[1] <= MAX_PLACES as f64) {
        return None;
    }
    let mut reach =
        Reach { home, cell, corner: first.map(|n| n * cell), size: count.map(|n| n as usize), places: Vec::new() };
    // A solution with a free joint stands for many configurations. One of them that can be reached suffices.
    let mut open = Vec::new();
    reach.places = (0..reach.size[0] * reach.size[1])
        .map(|place| {
            checkpoint();
            let solutions = inverse(arm, reach.center(place), home).solutions(arm).into_iter().enumerate();
            let judged = |(number, solution): (usize, Segment)| {
                let [joints, _] = solution.ends();
                if !solution.is_point() {
                    open.push((place, number, solution));
                    return Solution { joints, access: Access::Blocked };
                }
                let access = if is_free(scene, joints) { Access::Unknown } else { Access::Blocked };
                Solution { joints, access }
            };
            solutions.map(judged).collect()
        })
        .collect();
    decide_places(scene, &mut reach);
    for (place, number, solution) in open {
        reach.places[place][number] = solution_with_free_joint(scene, home, solution);
    }
    Some(reach)
}

/// Returns the least and greatest coordinates of the tip. `None` if a joint has no values.
fn tip_bounds(arm: &Arm) -> Option<[[f64; 2]; 2]> {
    let values = arm.topology().ranges.map(|range| {
        let (lower, upper) = range.domain();
        (0..=SAMPLES_PER_JOINT).map(move |i| lower + (upper - lower) * i as f64 / SAMPLES_PER_JOINT as f64)
    });
    let [first, second] = values;
    let tips = first.flat_map(|a| second.clone().map(move |b| arm.tip_at(Configuration::new(a, b))));
    tips.map(|tip| [[tip.x, tip.y]; 2])
        .reduce(|[lower, upper], [tip, _]| [[0, 1].map(|k| lower[k].min(tip[k])), [0, 1].map(|k| upper[k].max(tip[k]))])
}

/// Returns true if a configuration is certified to keep the clearance.
fn is_free(scene: &Scene, q: Configuration) -> bool {
    certify(scene, Path::new(vec![q]), scene.workspace().clearance).is_ok()
}

/// Decides for all free solutions whether a motion from home leads to them.
fn decide_places(scene: &Scene, reach: &mut Reach) {
    // All free solutions, and for each cell the index of its first one.
    let mut firsts = Vec::with_capacity(reach.places.len() + 1);
    let mut free: Vec<(usize, usize)> = Vec::new();
    for (place, solutions) in reach.places.iter().enumerate() {
        firsts.push(free.len());
        free.extend((0..solutions.len()).filter(|&s| solutions[s].access == Access::Unknown).map(|s| (place, s)));
    }
    firsts.push(free.len());
    let joints = |node: usize| reach.places[free[node].0][free[node].1].joints;
    let mut sets = UnionFind::<usize>::new(free.len());
    let (columns, places) = (reach.size[0], reach.places.len());
    for place in 0..places {
        checkpoint();
        let right = (place % columns + 1 < columns).then_some(place + 1);
        for beside in [right, Some(place + columns).filter(|&above| above < places)].into_iter().flatten() {
            for a in firsts[place]..firsts[place + 1] {
                // Of the two solutions with different elbows, the nearer one has the same elbow.
                let far = |b: &usize| scene.arm().topology().distance(joints(a), joints(*b));
                let nearest = (firsts[beside]..firsts[beside + 1]).min_by(|b, c| far(b).total_cmp(&far(c)));
                if let Some(b) = nearest.filter(|&b| !sets.equiv(a, b))
                    && is_straight_motion_free(scene, joints(a), joints(b))
                {
                    sets.union(a, b);
                }
            }
        }
    }
    let labels = sets.into_labeling();
    let mut known: Vec<Option<Access>> = vec![None; free.len()];
    for node in 0..free.len() {
        checkpoint();
        let access =
            *known[labels[node]].get_or_insert_with(|| decide_access(scene, reach.home, joints(labels[node])).0);
        known[node] = Some(access);
    }
    for (&(place, solution), access) in free.iter().zip(known) {
        reach.places[place][solution].access = access.unwrap_or(Access::Unknown);
    }
}

/// Returns true if the straight motion between two configurations is certified. On a circle, it takes the shorter
/// direction.
fn is_straight_motion_free(scene: &Scene, from: Configuration, to: Configuration) -> bool {
    let displacement = scene.arm().topology().displacement(from, to);
    certify(scene, Path::new(vec![from, from + displacement]), scene.workspace().clearance).is_ok()
}

/// Decides whether a motion from home leads to one of these goals. Also returns the goal where the motion ends.
fn decide_access(scene: &Scene, home: Configuration, to: impl Into<GoalSet>) -> (Access, Option<Configuration>) {
    let Ok(problem) = MotionProblem::new(scene.clone(), home, to) else { return (Access::Unknown, None) };
    match decide(&problem, BOXES_PER_SET) {
        Outcome::Found(path) => (Access::Reachable, Some(path.path().goal())),
        Outcome::Infeasible(_) => (Access::Unreachable, None),
        Outcome::Unknown(_) => (Access::Unknown, None),
    }
}

/// Returns the result for a solution with a free joint. It is blocked only if all of its configurations are blocked,
/// and reachable if any of them is reachable.
fn solution_with_free_joint(scene: &Scene, home: Configuration, solution: Segment) -> Solution {
    let nearest = || solution.nearest(Measure::from(Metric::Euclidean), home);
    if scene.blocked_along(&solution).is_some() {
        return Solution { joints: nearest(), access: Access::Blocked };
    }
    let (access, end) = decide_access(scene, home, solution);
    Solution { joints: end.unwrap_or_else(nearest), access }
}
