//! The decision about the next motion of an exploration.

use super::explorer::Explorer;
use super::known_space::KnownSpace;
use super::reach::{Reach, free_around, join, places, straight_motions, tightened, unwrapped};
use super::result::Ending;
use super::settings::Strategy;
use super::wall::{self, Heading, Place};
use cplan_harmonic::{Component, Lattice, harmonic_path};
use cplan_interrupt::checkpoint;
use cplan_judge::{CertifiedPath, certify};
use cplan_model::space::{Configuration, GoalSet, Path, Segment};
use cplan_model::{MotionProblem, Outcome, Scene};
use cplan_planners::cspace::Grid;
use cplan_solver::{Options, Unknown, solve};
use cplan_text::{counted, listed};
use std::collections::{BTreeSet, HashSet};

/// Number of configurations of an optimistic path that are examined for unknown map cells, from the first one that is
/// not known to be free. (An optimistic path counts unknown space as free.)
const PLACES_AHEAD: usize = 8;

/// Largest number of configurations that are examined as candidates for a better view. This takes several milliseconds.
const MAX_VIEWS: usize = 150;

/// Largest number of cells that a straight motion along a wall passes. It smooths the steps of the grid, but does not
/// cut corners.
const WALL_SMOOTHING_CELLS: usize = 4;

/// The next action.
pub enum Decision {
    Done(Ending),
    /// Follow a certified path. The second value is the cell of the grid where a reading is intended, if that is the purpose.
    Go(CertifiedPath, Option<usize>),
}

impl Explorer<'_> {
    /// Decides the next action by the strategy.
    pub fn decide(&mut self) -> Decision {
        if let (Strategy::Goal, Some(goals)) = (self.settings.strategy, self.goals) {
            return self.towards_goal(goals);
        }
        let joined = join(&self.solid, &self.known.grid, self.at);
        if joined.is_empty() { self.go_back() } else { self.exploring(&joined) }
    }

    /// Returns to the start of the last leg, because no straight motion from here reaches the centre of a cell. Ends
    /// the exploration if the last leg already was such a return.
    fn go_back(&mut self) -> Decision {
        let last = self.legs.last().filter(|_| !self.is_back).map(|leg| leg.curve.curve().path().waypoints());
        let reversed = last.map(|waypoints| Path::new(waypoints.iter().rev().copied().collect()));
        let certified = reversed.and_then(|path| certify(&self.solid, path).ok());
        self.is_back = true;
        certified.map_or_else(|| Decision::Done(self.too_coarse()), |path| Decision::Go(path, None))
    }

    /// Returns to the last visited place from which something new can be reached. Called if no configuration that is
    /// reachable from here shows anything new. Others may be reachable, because the path so far may connect cells that
    /// the steps of the grid do not connect. If there is no such place, returns the number of configurations that are
    /// reachable from any visited place.
    fn return_to_last_place(&mut self, reach: &Reach) -> Result<Decision, usize> {
        let mut is_reached = vec![false; self.known.grid.blocked.len()];
        reach.cells.iter().for_each(|&cell| is_reached[cell] = true);
        let mut back = vec![self.at];
        for leg in (0..self.legs.len()).rev() {
            checkpoint();
            back.extend(self.legs[leg].curve.curve().path().waypoints().iter().rev().skip(1));
            let place = back[back.len() - 1];
            let near = free_around(&self.known.grid, place);
            if near.iter().all(|&cell| is_reached[cell]) {
                continue;
            }
            let mut joined = join(&self.solid, &self.known.grid, place);
            joined.retain(|&cell| !is_reached[cell]);
            let Self { survey, sensor, known, frontier, .. } = self;
            let mut is_worth = false;
            let there = Reach::new(&known.grid, &known.closed, place, &joined, |cell, _| {
                is_worth = frontier.contains(survey, sensor, cell);
                is_worth
            });
            there.cells.iter().for_each(|&cell| is_reached[cell] = true);
            if is_worth {
                let path = certify(&self.solid, Path::new(back));
                return Ok(path.map_or_else(|_| Decision::Done(self.too_coarse()), |path| Decision::Go(path, None)));
            }
        }
        Err(is_reached.iter().filter(|&&reached| reached).count())
    }

    fn too_coarse(&self) -> Ending {
        let [a, b] = self.settings.cells;
        Ending::Unknown(format!(
            "the grid of {a} x {b} cells is too coarse: near ({}), no cell has a centre that is known to be free",
            format_configuration(self.at)
        ))
    }

    /// Moves to a frontier configuration. Ends the exploration if none can be reached.
    fn exploring(&mut self, joined: &[usize]) -> Decision {
        loop {
            checkpoint();
            let (route, most) = match self.settings.strategy {
                Strategy::View => (self.best_view(joined), usize::MAX),
                Strategy::Harmonic => (self.uphill(joined).map_or_else(|| self.nearest(joined), Ok), usize::MAX),
                Strategy::Wall => match self.along_wall(joined) {
                    Some(route) => (Ok(route), WALL_SMOOTHING_CELLS),
                    None => (self.nearest(joined), usize::MAX),
                },
                Strategy::Nearest | Strategy::Goal => (self.nearest(joined), usize::MAX),
            };
            let route = match route {
                Ok(route) => route,
                Err(reach) => {
                    return self.return_to_last_place(&reach).unwrap_or_else(|configurations| {
                        Decision::Done(Ending::Explored { configurations, given_up: self.frontier.given_up })
                    });
                }
            };
            if let Some(decision) = self.move_along(&route, most) {
                return decision;
            }
        }
    }

    /// Follows the harmonic potential of all frontier configurations, from the nearest cell that a straight motion reaches.
    fn uphill(&mut self, joined: &[usize]) -> Option<Vec<usize>> {
        let mut side = Grid { blocked: vec![true; self.known.grid.blocked.len()], ..self.known.grid };
        let (from, goals) = joined.iter().find_map(|&from| {
            let goals = self.up_to_frontier(from, &mut side);
            (!goals.is_empty()).then_some((from, goals))
        })?;
        let lattice = Lattice::from(&side);
        let component = Component::new(&lattice, lattice.wave(&goals));
        let route = harmonic_path(&component, component.position_of(from)?)?;
        let route: Vec<usize> = route.into_iter().map(|position| component.cell(position)).collect();
        let KnownSpace { grid, closed, .. } = &self.known;
        // The potential ignores that steps between free cells may be closed.
        if !route.windows(2).any(|step| closed.contains(&[step[0], step[1]])) {
            return Some(route);
        }
        let end = route[route.len() - 1];
        let reach = Reach::new(grid, closed, self.at, joined, |cell, _| cell == end);
        (reach.cells.last() == Some(&end)).then(|| reach.route(end))
    }

    /// Marks the cells that are reachable from a cell without crossing the frontier as free in `side`. Also marks the frontier
    /// cells next to them, and returns these. Cells behind the frontier do not influence the potential before it.
    fn up_to_frontier(&mut self, from: usize, side: &mut Grid) -> Vec<usize> {
        let is_new = std::mem::replace(&mut side.blocked[from], false);
        let (mut open, mut goals) = (if is_new { vec![from] } else { Vec::new() }, Vec::new());
        while let Some(cell) = open.pop() {
            checkpoint();
            if self.is_frontier(cell) {
                goals.push(cell);
                continue;
            }
            for next in self.known.grid.neighbors(cell).filter(|&next| !self.known.grid.blocked[next]) {
                if std::mem::replace(&mut side.blocked[next], false) {
                    open.push(next);
                }
            }
        }
        goals
    }

    /// Moves to the nearest wall, and along it to the first frontier configuration. Returns `None` if the walk returns
    /// to its beginning without finding one.
    fn along_wall(&mut self, joined: &[usize]) -> Option<Vec<usize>> {
        let KnownSpace { grid, closed, .. } = &self.known;
        let mut begin = None;
        let reach = Reach::new(grid, closed, self.at, joined, |cell, _| {
            begin = wall::is_beside_wall(grid, cell).then_some(cell);
            begin.is_some()
        });
        let mut route = reach.route(begin?);
        let mut place = Place { cell: begin?, heading: self.heading() };
        let mut gone = HashSet::new();
        while !self.is_frontier(place.cell) {
            checkpoint();
            let next = wall::next(&self.known.grid, &self.known.closed, place);
            place = next.filter(|&next| gone.insert(next))?;
            route.push(place.cell);
        }
        Some(route)
    }

    /// Returns the direction of the last motion, in eighths of a turn.
    fn heading(&self) -> Heading {
        let last = self.legs.last().and_then(|leg| leg.curve.curve().path().segments().last());
        let step = self.known.grid.step();
        let [along, across] = last.map_or([1.0, 0.0], |(from, to)| [0, 1].map(|k| (to - from)[k] / step[k]));
        match (along.abs() >= across.abs(), along >= 0.0, across >= 0.0) {
            (true, true, _) => 0,
            (true, false, _) => 4,
            (false, _, true) => 2,
            (false, _, false) => 6,
        }
    }

    /// Moves towards the last cell of a path. Each straight motion passes at most `most` cells. If a step is not free,
    /// closes it in the grid and returns `None`.
    fn move_along(&mut self, route: &[usize], most: usize) -> Option<Decision> {
        let configurations = unwrapped(&self.known.grid, self.at, route);
        match tightened(&self.solid, &configurations, most) {
            Ok(path) => {
                let certified = certify(&self.solid, path);
                let target = route[route.len() - 1];
                Some(
                    certified
                        .map_or_else(|_| Decision::Done(self.too_coarse()), |path| Decision::Go(path, Some(target))),
                )
            }
            Err(step) => {
                let step = [configurations[step], configurations[step + 1]].map(|q| self.known.grid.locate(q));
                let before = self.known.closed.len();
                self.known.close(&self.solid, step);
                (self.known.closed.len() == before).then(|| Decision::Done(self.too_coarse()))
            }
        }
    }

    /// Returns the path to the nearest frontier configuration. If there is none, returns the reachable cells.
    fn nearest(&mut self, joined: &[usize]) -> Result<Vec<usize>, Reach> {
        let Self { survey, sensor, known, frontier, .. } = self;
        let mut found = None;
        let reach = Reach::new(&known.grid, &known.closed, self.at, joined, |cell, _| {
            found = frontier.contains(survey, sensor, cell).then_some(cell);
            found.is_some()
        });
        reach.route_to(found)
    }

    /// Returns the path to the best view. A candidate shows everything that the nearest frontier configuration shows,
    /// unless an unknown obstacle hides it. So the arm need not return for something that was left behind. The best
    /// view is the candidate with the greatest [`worth`]. If several are equal, it is the nearest of them.
    ///
    /// The search stops at the distance beyond which no candidate can be better, and after [`MAX_VIEWS`] candidates.
    /// Farther away, fewer configurations are examined, but at least one per distance between readings.
    fn best_view(&mut self, joined: &[usize]) -> Result<Vec<usize>, Reach> {
        let Self { survey, sensor, known, frontier, .. } = self;
        let grid = &known.grid;
        let is_asked = |cell: usize, length: f64| {
            let every = grid.step().map(|step| ((length / 4.0).min(sensor.step) / step).max(1.0) as usize);
            [cell / grid.cells[1], cell % grid.cells[1]].iter().zip(every).all(|(at, every)| at % every == 0)
        };
        let (mut wanted, mut asked) = (Vec::new(), 0);
        let mut best: Option<(f64, usize)> = None;
        let reach = Reach::new(grid, &known.closed, self.at, joined, |cell, length| {
            let worth = |seen: u32| worth(seen, length, sensor.step);
            let Some((most, _)) = best else {
                if frontier.contains(survey, sensor, cell) {
                    wanted = survey.first_unknown_cells(sensor, frontier.sensor_pose(cell));
                    best = Some((worth(frontier.gain(survey, sensor, cell)), cell));
                }
                return false;
            };
            let may_be_best = is_asked(cell, length) && worth(frontier.max_gain(cell)) > most;
            asked += usize::from(may_be_best);
            if may_be_best && survey.shows_all(sensor, frontier.sensor_pose(cell), &wanted) {
                let worth = worth(frontier.gain(survey, sensor, cell));
                if worth > most {
                    best = Some((worth, cell));
                }
            }
            worth(frontier.max_gain_anywhere()) <= most || asked == MAX_VIEWS
        });
        reach.route_to(best.map(|(_, cell)| cell))
    }

    /// Follows the planner's path through possibly free space up to the end of the known free space.
    fn towards_goal(&mut self, goals: &GoalSet) -> Decision {
        let arm = self.scene.arm();
        let clearance = self.scene.workspace().clearance;
        let problem = match problem(self.survey.scene(arm, clearance, true), self.at, goals) {
            Ok(problem) => problem,
            Err(ending) => return Decision::Done(ending),
        };
        let optimistic = match solve(&problem, &self.settings.options, &mut |_| ()).outcome {
            Outcome::Found(path) => path,
            Outcome::Infeasible(proof) => {
                let boxes = counted(proof.collision_boxes().len(), "box");
                let why = format!(
                    "proven: {boxes} of configurations that collide with seen obstacles separate the arm from the goal"
                );
                return Decision::Done(Ending::Unreachable(why));
            }
            // The planner for the goal may give up, for example in a local minimum of a field. Other strategies can
            // still continue.
            Outcome::Unknown(_) => return self.detour(goals, &BTreeSet::new()),
        };
        let places = places(optimistic.path(), self.sensor.step);
        let (motions, mut free) = (straight_motions(&self.solid), vec![self.at]);
        for &place in &places {
            if !motions.is_free(free[free.len() - 1], place) {
                break;
            }
            free.push(place);
        }
        // If the last leg along an optimistic path showed nothing new, a part of the next one will not, either. But a
        // path that is free to its end leads to the goal.
        let is_worth = free.len() > places.len() || free.len() > 1 && !self.is_stalled;
        let ahead = &places[(free.len() - 1).min(places.len())..];
        match certify(&self.solid, Path::new(free)) {
            Ok(path) if is_worth => Decision::Go(path, None),
            _ => {
                let ahead = ahead.iter().take(PLACES_AHEAD).flat_map(|&q| self.survey.unknown_at(arm, q));
                let in_the_way: BTreeSet<usize> = ahead.collect();
                self.detour(goals, &in_the_way)
            }
        }
    }

    /// Moves to the nearest configuration from which one of the cells `in_the_way` is visible. If there is none, moves
    /// to the best view. If nothing new can be seen, moves to the goal within known space.
    fn detour(&mut self, goals: &GoalSet, in_the_way: &BTreeSet<usize>) -> Decision {
        let joined = join(&self.solid, &self.known.grid, self.at);
        if joined.is_empty() {
            return self.go_back();
        }
        loop {
            checkpoint();
            let route = match self.showing(&joined, in_the_way).map_or_else(|| self.best_view(&joined), Ok) {
                Ok(route) => route,
                Err(reach) => return self.return_to_last_place(&reach).unwrap_or_else(|_| self.within_known(goals)),
            };
            if let Some(decision) = self.move_along(&route, usize::MAX) {
                return decision;
            }
        }
    }

    /// Returns the path to the nearest configuration from which one of the given map cells is visible.
    fn showing(&mut self, joined: &[usize], cells: &BTreeSet<usize>) -> Option<Vec<usize>> {
        if cells.is_empty() {
            return None;
        }
        let Self { survey, sensor, known, frontier, .. } = self;
        let (grid, wanted) = (&known.grid, survey.by_rows(cells));
        let mut showing = None;
        let reach = Reach::new(grid, &known.closed, self.at, joined, |cell, _| {
            let shows = frontier.contains(survey, sensor, cell)
                && survey.shows_any(sensor, frontier.sensor_pose(cell), &wanted);
            showing = shows.then_some(cell);
            shows
        });
        showing.map(|cell| reach.route(cell))
    }

    /// Plans a path to the goal within known space. Called if nothing new can be seen.
    fn within_known(&self, goals: &GoalSet) -> Decision {
        let problem = match problem(self.solid.clone(), self.at, goals) {
            Ok(problem) => problem,
            Err(ending) => return Decision::Done(ending),
        };
        let options = Options { bounded: false, ..Options::default() };
        Decision::Done(match solve(&problem, &options, &mut |_| ()).outcome {
            Outcome::Found(path) => return Decision::Go(path.certified, None),
            Outcome::Infeasible(_) => {
                Ending::Unreachable("nothing new can be seen, and there is no path in the known space (proven)".into())
            }
            Outcome::Unknown(Unknown { reason, .. }) => {
                Ending::Unknown(format!("nothing new can be seen, and planning in the known space failed: {reason}"))
            }
        })
    }
}

/// Returns the problem of moving to those goals that are not known to be blocked. If all are blocked, returns the ending of the
/// exploration. The goals are free in the true world, so either the blocking cells are unknown, or the map is too coarse.
fn problem(scene: Scene, start: Configuration, goals: &GoalSet) -> Result<MotionProblem, Ending> {
    let is_blocked = |piece: &&Segment| piece.is_point() && !scene.obstructions(piece.ends()[0]).is_empty();
    let (blocked, open): (Vec<&Segment>, Vec<&Segment>) = goals.pieces().iter().partition(is_blocked);
    if let (true, Some(first)) = (open.is_empty(), blocked.first()) {
        let why = scene.obstructions(first.ends()[0]).iter().map(|o| scene.explain(o)).collect::<Vec<_>>();
        return Err(Ending::Unknown(format!(
            "the goal collides with cells that are not known to be free: {}",
            listed(&why)
        )));
    }
    let open: GoalSet = open.into_iter().copied().collect();
    MotionProblem::new(scene, start, open).map_err(|error| Ending::Unknown(error.to_string()))
}

/// Returns the worth of a view that shows `seen` new cells, at the distance `length`.
///
/// Short distances have priority: a configuration at twice the distance must show 64 times as many cells. This ratio
/// results from experiments (CPLAN_WORLDS of `planning exploring`).
fn worth(seen: u32, length: f64, step: f64) -> f64 {
    f64::from(seen).powf(1.0 / 6.0) / (length + step / 2.0)
}

fn format_configuration(q: Configuration) -> String {
    format!("{:.4}, {:.4}", q[0], q[1])
}
