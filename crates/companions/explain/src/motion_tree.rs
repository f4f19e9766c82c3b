//! A tree of certified motions from the home configuration to many IK solutions. A straight motion leads to each
//! solution, from another solution or from the end of a planned route.

use cplan_model::space::{Configuration, Path, Topology};

/// Origin of the straight motion to a solution. Solutions have consecutive numbers through all cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The last waypoint of a planned route from home.
    Route(usize),
    /// Another solution.
    Solution(usize),
}

/// Certified motions from home to IK solutions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MotionTree {
    /// Waypoints of the planned routes. Each begins at home.
    pub routes: Vec<Vec<Configuration>>,
    /// For each solution, the origin of the straight motion to it. `None` if no certified motion leads to it.
    pub origins: Vec<Option<Origin>>,
}

impl MotionTree {
    /// Creates a tree without motions to `count` solutions.
    pub fn without_motions(count: usize) -> Self {
        Self { routes: Vec::new(), origins: vec![None; count] }
    }

    /// Adds a planned path to a solution. Returns the origin of its last straight motion.
    pub fn add_path(&mut self, solution: usize, path: &Path) -> Origin {
        let [before @ .., _] = path.waypoints() else { unreachable!("a path has a waypoint") };
        // If the path has a single waypoint, that is home.
        let route = if before.is_empty() { path.waypoints() } else { before };
        self.routes.push(route.to_vec());
        let origin = Origin::Route(self.routes.len() - 1);
        self.origins[solution] = Some(origin);
        origin
    }

    /// Returns the certified motion from home to a solution with the values `joints`. `None` if there is no certified
    /// motion. Values of continuous joints may exceed a turn, so that all motions between waypoints are straight.
    pub fn motion_to(
        &self,
        solution: usize,
        topology: &Topology,
        joints: impl Fn(usize) -> Configuration,
    ) -> Option<Path> {
        let mut later = vec![solution];
        let mut origin = self.origins[solution]?;
        while let Origin::Solution(before) = origin {
            later.push(before);
            origin = self.origins[before]?;
        }
        let Origin::Route(route) = origin else { unreachable!("the loop ends at a route") };
        let mut waypoints = self.routes[route].clone();
        for solution in later.into_iter().rev() {
            let last = *waypoints.last()?;
            let step = topology.displacement(topology.wrap(last), joints(solution));
            if step != Configuration::zeros() {
                waypoints.push(last + step);
            }
        }
        Some(Path::new(waypoints))
    }
}
