//! The cheapest sequence of IK solutions along a line.
//!
//! States are the sheets at the nodes. Within a sheet, the arm moves straight in joint space from each node to the
//! next. It may change the sheet at a node if the straight motion between both configurations keeps the tip within the
//! tolerance, as at singular places, where the solutions meet. Initially, collisions are checked only along the
//! cheapest sequence. If that collides, they are checked for all motions.

use crate::nodes::{Division, Nodes, chord_deviation};
use crate::sheets::Sheets;
use cplan_deviation::{Kinematics, Line, sag};
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, StraightMotions, certify};
use cplan_model::Scene;
use cplan_model::space::{Configuration, JointRange, Path};
use std::cell::Cell;
use std::f64::consts::TAU;

/// Greatest difference between a configuration and a sheet that is attributed to the rounding of inverse kinematics,
/// radians or metres.
const END_ROUNDING: f64 = 1e-6;

/// Cost of a change of the sheet, seconds, in addition to the duration of its motion.
const CHANGE_COST: f64 = 0.1;

/// A sequence of waypoints along the line.
pub(crate) struct Route {
    pub path: CertifiedPath,
    /// For each waypoint: the index of its node.
    pub nodes: Vec<usize>,
    /// For each waypoint: the number of its IK solution.
    pub solutions: Vec<usize>,
    /// The waypoints at which the arm changes its IK solution.
    pub changes: Vec<usize>,
}

/// A path, the nodes and the IK solutions of its waypoints, and the waypoints at which the solution changes.
type Sequence = (Path, Vec<usize>, Vec<usize>, Vec<usize>);

pub(crate) struct Search<'a> {
    pub scene: &'a Scene,
    pub kinematics: &'a Kinematics<'a>,
    pub line: &'a Line<'a>,
    pub nodes: &'a Nodes,
    pub sheets: &'a Sheets<'a>,
    pub division: Division,
    /// The configurations at which the motion begins and ends. `None` if any IK solutions may be used.
    pub ends: Option<[Configuration; 2]>,
    /// For each part and sheet, true if the motion is within limits and tolerance, and not known to collide.
    open: Vec<bool>,
    /// For each part and sheet, true if the motion is not shown to be free.
    pub blocked: Vec<bool>,
    /// The last node that a sequence reaches.
    pub furthest: Cell<usize>,
}

/// The cheapest step to a state. It begins at the same node or at the previous one.
#[derive(Debug, Clone, Copy)]
struct Step {
    cost: f64,
    from: Option<(usize, usize)>,
}

const UNREACHED: Step = Step { cost: f64::INFINITY, from: None };

impl<'a> Search<'a> {
    pub fn new(
        scene: &'a Scene,
        (kinematics, line): (&'a Kinematics<'a>, &'a Line<'a>),
        nodes: &'a Nodes,
        sheets: &'a Sheets<'a>,
        division: Division,
        ends: Option<[Configuration; 2]>,
    ) -> Self {
        let count = sheets.sheets.len();
        let blocked = vec![false; nodes.parts.len() * count];
        let mut search = Self {
            scene,
            kinematics,
            line,
            nodes,
            sheets,
            division,
            ends,
            open: Vec::new(),
            blocked,
            furthest: Cell::new(0),
        };
        search.open = (0..nodes.parts.len() * count).map(|i| search.is_near(i / count, i % count)).collect();
        search
    }

    fn count(&self) -> usize {
        self.sheets.sheets.len()
    }

    fn motion(&self, part: usize, sheet: usize) -> Option<[Configuration; 2]> {
        Some([self.sheets.at(part, sheet)?, self.sheets.at(part + 1, sheet)?])
    }

    /// Returns true if some sheet may be used at the beginning.
    pub fn has_begun(&self) -> bool {
        (0..self.count()).any(|sheet| self.is_end(0, sheet))
    }

    /// Returns true if a sheet may be used at the beginning (`end` = 0) or at the end (1).
    pub fn is_end(&self, end: usize, sheet: usize) -> bool {
        let node = if end == 0 { 0 } else { self.nodes.nodes.len() - 1 };
        let Some(q) = self.sheets.at(node, sheet) else { return false };
        self.ends.is_none_or(|ends| {
            let off = ends[end] - q;
            (off - self.turns_between(ends[end], q)).amax() <= END_ROUNDING
        })
    }

    /// Returns true if the motion along a part on a sheet is within the limits and the tolerance.
    fn is_near(&self, part: usize, sheet: usize) -> bool {
        let Some([from, to]) = self.motion(part, sheet) else { return false };
        let own = &self.nodes.parts[part];
        let off = self.nodes.nodes[part].off.max(self.nodes.nodes[part + 1].off);
        let bound = off + sag(self.line.curve(own.piece), own.ends) + chord_deviation(self.kinematics, from, to);
        self.nodes.nodes[part + 1].is_continued && bound <= self.division.deviation * (1.0 + 1e-9)
    }

    /// Returns the cheapest certified sequence. `None` if no examined sequence is certified.
    pub fn route(&mut self) -> Option<Route> {
        // After the first collision, all motions on sheets are checked. Later, only changes of the sheet can collide,
        // and the motions beside them are closed.
        for attempt in 0..=self.nodes.nodes.len() {
            checkpoint();
            let (path, nodes, solutions, changes) = self.cheapest()?;
            match certify(self.scene, path.clone()) {
                Ok(path) => return Some(Route { path, nodes, solutions, changes }),
                Err(_) if attempt == 0 => self.check_all(),
                Err(_) if !self.close_first_blocked(&path, &nodes, &solutions) => return None,
                Err(_) => {}
            }
        }
        None
    }

    /// Checks the motions of all sheets.
    fn check_all(&mut self) {
        let motions = StraightMotions::new(self.scene, self.scene.workspace().clearance);
        for part in 0..self.nodes.parts.len() {
            for sheet in 0..self.count() {
                checkpoint();
                let index = part * self.count() + sheet;
                if self.open[index]
                    && let Some([from, to]) = self.motion(part, sheet)
                    && !motions.is_free(from, to)
                {
                    (self.open[index], self.blocked[index]) = (false, true);
                }
            }
        }
    }

    /// Closes the motions beside the first change of a path that collides. Returns false if all changes are free.
    fn close_first_blocked(&mut self, path: &Path, nodes: &[usize], solutions: &[usize]) -> bool {
        let motions = StraightMotions::new(self.scene, self.scene.workspace().clearance);
        let mut legs = path.waypoints().windows(2).enumerate();
        let Some(leg) = legs.find(|(_, leg)| !motions.is_free(leg[0], leg[1])).map(|(leg, _)| leg) else {
            return false;
        };
        let (node, count) = (nodes[leg], self.count());
        let parts = [node.checked_sub(1), Some(node).filter(|node| *node < self.nodes.parts.len())];
        let mut closed = false;
        for part in parts.into_iter().flatten() {
            for sheet in (0..count).filter(|s| self.sheets.sheets[*s].solution == solutions[leg]) {
                closed |= std::mem::take(&mut self.open[part * count + sheet]);
            }
        }
        closed
    }

    /// Closes the part before a waypoint of a route for the IK solution there, so that later routes avoid it. Returns
    /// false if it is closed already.
    pub fn close_before(&mut self, route: &Route, waypoint: usize) -> bool {
        let (part, count) = (route.nodes[waypoint].saturating_sub(1), self.count());
        let mut closed = false;
        for sheet in (0..count).filter(|s| self.sheets.sheets[*s].solution == route.solutions[waypoint]) {
            closed |= self.open.get_mut(part * count + sheet).is_some_and(std::mem::take);
        }
        closed
    }

    /// Returns the least duration of a straight motion, seconds.
    fn cost(&self, from: Configuration, to: Configuration) -> f64 {
        let joints = &self.scene.arm().joints;
        (0..2).map(|k| (to[k] - from[k]).abs() / joints[k].velocity).fold(0.0, f64::max)
    }

    /// Returns the whole turns of continuous joints that bring `to` closest to `from`.
    fn turns_between(&self, from: Configuration, to: Configuration) -> Configuration {
        let joints = &self.scene.arm().joints;
        Configuration::from_fn(|k, _| match joints[k].range {
            JointRange::Circle => ((from[k] - to[k]) / TAU).round() * TAU,
            JointRange::Interval { .. } => 0.0,
        })
    }

    /// Returns the motion of a change between two sheets at a node, if the tip stays within the tolerance.
    fn change(&self, node: usize, from: usize, to: usize) -> Option<[Configuration; 2]> {
        let [a, b] = [self.sheets.at(node, from)?, self.sheets.at(node, to)?];
        let b = b + self.turns_between(a, b);
        let bound = self.nodes.nodes[node].off + chord_deviation(self.kinematics, a, b);
        (bound <= self.division.deviation).then_some([a, b])
    }

    fn cheapest(&self) -> Option<Sequence> {
        let (count, last) = (self.count(), self.nodes.nodes.len() - 1);
        let mut steps = vec![UNREACHED; (last + 1) * count];
        for node in 0..=last {
            checkpoint();
            for sheet in 0..count {
                let own = node * count + sheet;
                if node == 0 {
                    if self.is_end(0, sheet) {
                        steps[own] = Step { cost: 0.0, from: None };
                    }
                } else if self.open[(node - 1) * count + sheet] && steps[own - count].cost.is_finite() {
                    let [from, to] = self.motion(node - 1, sheet)?;
                    let cost = steps[own - count].cost + self.cost(from, to);
                    steps[own] = Step { cost, from: Some((node - 1, sheet)) };
                }
            }
            if (0..count).any(|sheet| steps[node * count + sheet].cost.is_finite()) {
                self.furthest.set(node);
            }
            // One change per node is enough: a second one would only lead to a third sheet.
            let before: Vec<f64> = (0..count).map(|sheet| steps[node * count + sheet].cost).collect();
            for (from, to) in (0..count).flat_map(|from| (0..count).map(move |to| (from, to))) {
                if from == to
                    || !before[from].is_finite()
                    || before[from] + CHANGE_COST >= steps[node * count + to].cost
                {
                    continue;
                }
                if let Some([a, b]) = self.change(node, from, to) {
                    let cost = before[from] + CHANGE_COST + self.cost(a, b);
                    let own = &mut steps[node * count + to];
                    if cost < own.cost {
                        *own = Step { cost, from: Some((node, from)) };
                    }
                }
            }
        }
        let ends =
            (0..count).filter(|sheet| self.is_end(1, *sheet)).map(|sheet| (steps[last * count + sheet].cost, sheet));
        let (cost, sheet) = ends.min_by(|a, b| a.0.total_cmp(&b.0))?;
        if !cost.is_finite() {
            return None;
        }
        let mut states = vec![(last, sheet)];
        while let Some(before) = steps[states[states.len() - 1].0 * count + states[states.len() - 1].1].from {
            states.push(before);
        }
        states.reverse();
        Some(self.path(&states))
    }

    /// Returns the configurations of a sequence of states in unwrapped values, without repetitions.
    fn path(&self, states: &[(usize, usize)]) -> Sequence {
        let (mut waypoints, mut nodes, mut solutions) = (Vec::<Configuration>::new(), Vec::new(), Vec::<usize>::new());
        let mut changes = Vec::new();
        for &(node, sheet) in states {
            let Some(q) = self.sheets.at(node, sheet) else { continue };
            let solution = self.sheets.sheets[sheet].solution;
            let first = || self.ends.map_or(q, |[start, _]| start);
            let q = waypoints.last().map_or_else(first, |last| q + self.turns_between(*last, q));
            let is_same = waypoints.last() == Some(&q);
            if solutions.last().is_some_and(|last| *last != solution) {
                changes.push(if is_same { waypoints.len() - 1 } else { waypoints.len() });
            }
            if is_same {
                // Where the solutions meet, both have this configuration.
                *nodes.last_mut().expect("a node") = node;
                *solutions.last_mut().expect("a solution") = solution;
                continue;
            }
            waypoints.push(q);
            nodes.push(node);
            solutions.push(solution);
        }
        (Path::new(waypoints), nodes, solutions, changes)
    }
}
