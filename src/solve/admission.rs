//! Starts and goals that are free, but nearer to an obstacle than a representation grown by a margin allows.
//!
//! Rather than to shrink the margin everywhere, which multiplies corners, such an end is replaced by a configuration
//! that the representation knows as free, at the end of a short straight motion that is certified. The planner's path is
//! completed by that motion, and judged as a whole like any other.

use crate::certify::certify;
use crate::cspace::{Grid, Regions, ZonedGrid};
use crate::model::{Problem, Scene};
use crate::plan::Query;
use crate::space::{Configuration, Path, Topology};
use std::f64::consts::TAU;

/// A representation that may block ends which are free.
pub(super) trait Admit {
    /// Whether a planner can begin or end at `q`.
    fn admits(&self, q: Configuration) -> bool;
}

impl Admit for Regions {
    fn admits(&self, q: Configuration) -> bool {
        self.component(q).is_some()
    }
}

impl Admit for Grid {
    fn admits(&self, q: Configuration) -> bool {
        !self.blocked[self.locate(q)]
    }
}

impl Admit for ZonedGrid {
    fn admits(&self, q: Configuration) -> bool {
        self.grid.admits(q)
    }
}

/// Directions tried.
const DIRECTIONS: usize = 64;

/// Steps tried in each direction, the shortest first; each is twice the one before.
const STEPS: usize = 13;

/// The shortest step, radians or metres: far below what a margin of a thousandth of the reach asks for.
const SHORTEST: f64 = 1e-4;

/// `q` if the space admits it, else the end of the shortest certified straight motion from it to where it does; `q`
/// again if there is none.
fn stand_in(scene: &Scene, space: &impl Admit, q: Configuration) -> Configuration {
    if space.admits(q) {
        return q;
    }
    let direction = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        Configuration::new(cos, sin)
    };
    for step in 0..STEPS {
        let length = SHORTEST * (1_u32 << step) as f64;
        for k in 0..DIRECTIONS {
            let there = q + direction(k) * length;
            let way = || certify(scene, Path::new(vec![q, there]), scene.workspace.clearance);
            if space.admits(there) && way().is_ok() {
                return there;
            }
        }
    }
    q
}

/// A problem's ends and what stands in for them.
pub(super) struct Ends {
    topology: Topology,
    start: Configuration,
    /// Copies near the start.
    goals: Vec<Configuration>,
    /// What the planner is asked.
    pub query: Query,
}

/// Two ends this near are copies of one another: far above rounding, far below any distance that matters.
const SAME: f64 = 1e-9;

impl Ends {
    pub fn new(problem: &Problem, space: &impl Admit) -> Self {
        let topology = problem.scene.arm.topology();
        let start = problem.start;
        let goals: Vec<Configuration> = problem.goals.iter().map(|&goal| topology.lift(goal, start)).collect();
        let admitted = |q| stand_in(&problem.scene, space, q);
        let query = Query { start: admitted(start), goals: goals.iter().map(|&goal| admitted(goal)).collect() };
        Self { topology, start, goals, query }
    }

    /// Whether something stands in for a goal.
    pub fn has_goal_stand_ins(&self) -> bool {
        self.query.goals != self.goals
    }

    /// The planner's path from the true start to the true goal by way of the stand-ins.
    pub fn complete(&self, path: &Path) -> Path {
        self.join(path.waypoints(), self.goal_reached(path))
    }

    /// The same past the stand-ins, which saves the detour where it is free; none if there is nothing to save.
    pub fn past_stand_ins(&self, path: &Path) -> Option<Path> {
        let (inner, goal) = (path.waypoints(), self.goal_reached(path));
        let (first, last) = (self.start != path.start(), goal != path.goal());
        let past = || self.join(&inner[usize::from(first)..inner.len() - usize::from(last)], goal);
        (inner.len() > 1 && (first || last)).then(past)
    }

    /// The true goal, as the copy that the path leads to.
    fn goal_reached(&self, path: &Path) -> Configuration {
        let end = path.goal();
        let of = |(stand_in, goal): (&Configuration, &Configuration)| {
            (self.topology.distance(*stand_in, end) < SAME).then(|| end + (goal - stand_in))
        };
        self.query.goals.iter().zip(&self.goals).find_map(of).unwrap_or(end)
    }

    fn join(&self, middle: &[Configuration], goal: Configuration) -> Path {
        Path::new([self.start].into_iter().chain(middle.iter().copied()).chain([goal]).collect())
    }
}
