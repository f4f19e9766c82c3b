//! Reachability: the places that the tip can reach from a home configuration, with their IK solutions. Each answer is
//! certified, proven impossible, or unknown.

use super::flood::Solutions;
use super::motion_tree::MotionTree;
use cplan_geometry::Point;
use cplan_interrupt::checkpoint;
use cplan_judge::certify;
use cplan_model::space::{Configuration, GoalSet, Measure, Metric, Path, Segment};
use cplan_model::{Arm, MotionProblem, Outcome, Scene, inverse};
use cplan_solver::decide;
use serde::{Serialize, Serializer};

/// Largest number of square cells that are examined.
pub const MAX_PLACES: usize = 4_000_000;

/// Largest number of boxes for the decision about a set of connected solutions.
const BOXES_PER_SET: usize = 20_000;

/// Number of values per joint in the sample that bounds the places of the tip.
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
    /// Joint values within the limits, base to tip. If a joint is free, these are the values that a motion reaches, or
    /// otherwise those nearest to home.
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
    /// IK solutions for the tip at the centre of each cell, row by row from the lowest row. Empty if the centre is out of reach.
    pub places: Vec<Vec<Solution>>,
    /// Certified motions to the solutions, which have consecutive numbers through all cells.
    #[serde(skip)]
    pub motions: MotionTree,
}

impl Reach {
    /// Returns the centre of the cell with this index.
    pub fn center(&self, place: usize) -> Point {
        let at = [place % self.size[0], place / self.size[0]];
        Point::from([0, 1].map(|k| self.corner[k] + self.cell * (at[k] as f64 + 0.5)))
    }

    /// Iterates over the cells with solutions. Each item is the index of a cell, the best reachability of its
    /// solutions, and the number of solutions with that reachability.
    pub fn best(&self) -> impl Iterator<Item = (usize, Access, usize)> {
        self.places.iter().enumerate().filter_map(|(number, solutions)| {
            let best = solutions.iter().map(|solution| solution.access).min()?;
            Some((number, best, solutions.iter().filter(|solution| solution.access == best).count()))
        })
    }

    /// Iterates over the solutions of all cells, in order.
    pub fn solutions(&self) -> impl Iterator<Item = &Solution> {
        self.places.iter().flatten()
    }

    /// Returns the certified motion from home to the solution with this index among all solutions. `None` if it
    /// is not reached.
    pub fn motion_to(&self, number: usize, arm: &Arm) -> Option<Path> {
        let joints: Vec<Configuration> = self.solutions().map(|solution| solution.joints).collect();
        self.motions.motion_to(number, &arm.topology(), |solution| joints[solution])
    }

    /// Counts cells by the best reachability of their solutions, in the order of [`Access::ALL`].
    pub fn tally(&self) -> [usize; 4] {
        Access::ALL.map(|access| self.best().filter(|(_, best, _)| *best == access).count())
    }
}

/// Computes the IK solutions for the centre of each square cell of side `cell`, in metres. For each solution, decides
/// whether a motion that keeps the world's clearance leads to it from `home`.
///
/// Two solutions of neighbouring cells are connected if a straight motion to one of them is certified, either from the
/// other one or from an earlier solution of the same set. Only one solution of each connected set is decided. A
/// certified motion to it extends to the whole set, and so does a proof that it is unreachable. Returns `None` if there
/// are more than [`MAX_PLACES`] cells.
///
/// Takes `O(n)` certificates for `n` solutions, and one decision per set.
pub fn reach(scene: &Scene, home: Configuration, cell: f64) -> Option<Reach> {
    let arm = scene.arm();
    let [lower, upper] = tip_bounds(arm)?;
    // Cover the sample by whole cells, and one more on each side, because the tip may reach beyond the sample.
    let first = [0, 1].map(|k| (lower[k] / cell).floor() - 1.0);
    let count = [0, 1].map(|k| (upper[k] / cell).floor() - first[k] + 2.0);
    if !(cell > 0.0 && count[0] * count[1] <= MAX_PLACES as f64) {
        return None;
    }
    let mut reach = Reach {
        home,
        cell,
        corner: first.map(|n| n * cell),
        size: count.map(|n| n as usize),
        places: Vec::new(),
        motions: MotionTree::default(),
    };
    // A solution with a free joint represents many configurations. It is reachable if one of them is.
    let mut open = Vec::new();
    let mut number = 0;
    for place in 0..reach.size[0] * reach.size[1] {
        checkpoint();
        let mut solutions = Vec::new();
        for (index, solution) in inverse(arm, reach.center(place), home).solutions(arm).into_iter().enumerate() {
            let [joints, _] = solution.ends();
            let access = match solution.is_point() {
                true if is_free(scene, joints) => Access::Unknown,
                true => Access::Blocked,
                false => {
                    open.push((place, index, number, solution));
                    Access::Blocked
                }
            };
            solutions.push(Solution { joints, access });
            number += 1;
        }
        reach.places.push(solutions);
    }
    reach.motions = MotionTree::without_motions(number);
    decide_places(scene, &mut reach);
    for (place, index, number, solution) in open {
        reach.places[place][index] = solution_with_free_joint(scene, home, solution, number, &mut reach.motions);
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
    certify(scene, Path::new(vec![q])).is_ok()
}

/// Decides for all free solutions whether a motion from home leads to them, set by set. The solution nearest to home
/// comes first.
fn decide_places(scene: &Scene, reach: &mut Reach) {
    let mut solutions = Solutions::new(scene, reach);
    for seed in solutions.by_distance(reach.home) {
        checkpoint();
        if solutions.is_visited(seed) {
            continue;
        }
        let node = solutions.nodes[seed];
        let (access, path) = decide_access(scene, reach.home, node.joints);
        let route = path.map(|path| {
            let origin = reach.motions.add_path(node.number, &path);
            (origin, *reach.motions.routes.last().and_then(|route| route.last()).expect("a route begins at home"))
        });
        for reached in solutions.flood(seed, route) {
            let node = solutions.nodes[reached.node];
            reach.places[node.place][node.index].access = access;
            if access == Access::Reachable {
                reach.motions.origins[node.number] = Some(reached.origin);
            }
        }
    }
}

/// Decides whether a motion from home leads to one of these goals. Also returns the motion.
fn decide_access(scene: &Scene, home: Configuration, to: impl Into<GoalSet>) -> (Access, Option<Path>) {
    let Ok(problem) = MotionProblem::new(scene.clone(), home, to) else { return (Access::Unknown, None) };
    match decide(&problem, BOXES_PER_SET) {
        Outcome::Found(path) => (Access::Reachable, Some(path.path().clone())),
        Outcome::Infeasible(_) => (Access::Unreachable, None),
        Outcome::Unknown(_) => (Access::Unknown, None),
    }
}

/// Returns the result for a solution with a free joint, and adds the motion to it. The solution is reachable if any of
/// its configurations is, and blocked only if all of them are blocked.
fn solution_with_free_joint(
    scene: &Scene,
    home: Configuration,
    solution: Segment,
    number: usize,
    motions: &mut MotionTree,
) -> Solution {
    let nearest = || solution.nearest(Measure::from(Metric::Euclidean), home);
    if scene.blocked_along(&solution).is_some() {
        return Solution { joints: nearest(), access: Access::Blocked };
    }
    let (access, path) = decide_access(scene, home, solution);
    if let Some(path) = &path {
        motions.add_path(number, path);
    }
    Solution { joints: path.map_or_else(nearest, |path| path.goal()), access }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cplan_model::{Joint, Obstacle, Workspace};

    /// Returns a scene with a post that the arm must go around, and with a continuous first joint.
    fn scene() -> Scene {
        let mut arm = Arm::rr([1.0, 0.8], 0.04).expect("an arm");
        arm.joints[1] = Joint::turning("elbow", -2.8, 2.8);
        let post = Obstacle::circle("post", [1.1, 0.3], 0.15).expect("a disc");
        Scene::new(arm, Workspace::new([post])).expect("a scene")
    }

    #[test]
    fn motions_to_all_reachable_solutions_are_certified() {
        let scene = scene();
        let home = Configuration::new(-1.0, 0.5);
        let reach = reach(&scene, home, 0.1).expect("few cells");
        let mut reachable = 0;
        for (number, solution) in reach.solutions().enumerate() {
            let motion = reach.motion_to(number, scene.arm());
            assert_eq!(motion.is_some(), solution.access == Access::Reachable, "{solution:?}");
            let Some(motion) = motion else { continue };
            reachable += 1;
            assert_eq!(motion.start(), home);
            assert!(scene.arm().topology().distance(motion.goal(), solution.joints) < 1e-9, "{solution:?}");
            assert!(certify(&scene, motion).is_ok(), "{solution:?}");
        }
        assert!(reachable > 500 && reachable < reach.solutions().count());
    }

    #[test]
    fn motions_are_as_short_as_straight_ones_where_nothing_is_in_between() {
        let mut arm = Arm::rr([1.0, 0.8], 0.04).expect("an arm");
        arm.joints.iter_mut().for_each(|joint| *joint = Joint::turning("joint", -2.8, 2.8));
        let scene = Scene::new(arm, Workspace::new([])).expect("a scene");
        let home = Configuration::new(-1.0, 0.5);
        let reach = reach(&scene, home, 0.2).expect("few cells");
        for (number, solution) in reach.solutions().enumerate() {
            let motion = reach.motion_to(number, scene.arm()).expect("nothing is in the way");
            assert_eq!(motion.waypoints().len(), 2, "{solution:?}");
        }
    }
}
