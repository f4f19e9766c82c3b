//! Where to go next.

use super::explorer::Explorer;
use super::known::Known;
use super::reach::{Reach, free_about, join, places, straight_motions, tightened, unwrapped};
use super::result::Ending;
use super::settings::Strategy;
use super::wall::{self, Heading, Place};
use cplan_core::check::{CertifiedPath, certify};
use cplan_core::cspace::Grid;
use cplan_core::model::{MotionProblem, Outcome, Scene};
use cplan_core::space::{Configuration, GoalSet, Path, Segment};
use cplan_engine::{Options, Unknown, solve};
use cplan_harmonic::{Component, Lattice, harmonic_way};
use cplan_interrupt::checkpoint;
use cplan_text::{counted, listed};
use std::collections::{BTreeSet, HashSet};

/// Places ahead on an optimistic path whose unknown cells are looked for.
const PLACES_AHEAD: usize = 8;

/// Configurations that are looked at for a better view, some milliseconds' worth.
const MOST_VIEWS: usize = 150;

/// Cells along a wall that are gone past straight: as many as smooth its steps, not its corners.
const BY_THE_WALL: usize = 4;

/// What comes next.
pub enum Decision {
    Done(Ending),
    /// Along a path that is certified; the cell of the grid that is gone to for what can be seen from there, if it is.
    Go(CertifiedPath, Option<usize>),
}

impl Explorer<'_> {
    /// What comes next, by the strategy.
    pub fn decide(&mut self) -> Decision {
        if let (Strategy::Goal, Some(goals)) = (self.settings.strategy, self.goals) {
            return self.towards_goal(goals);
        }
        let joined = join(&self.solid, &self.known.grid, self.at);
        if joined.is_empty() { self.back() } else { self.exploring(&joined) }
    }

    /// Back to where the last leg began, from where no middle of a cell can be reached; not twice.
    fn back(&mut self) -> Decision {
        let last = self.legs.last().filter(|_| !self.is_back).map(|leg| leg.curve.curve().path().waypoints());
        let reversed = last.map(|waypoints| Path::new(waypoints.iter().rev().copied().collect()));
        let certified = reversed.and_then(|path| certify(&self.solid, path, self.solid.workspace().clearance).ok());
        self.is_back = true;
        certified.map_or_else(|| Decision::Done(self.too_coarse()), |path| Decision::Go(path, None))
    }

    /// Back to the last place where the arm was and from where it can go to something new, if nothing new can be seen from what it reaches
    /// here: cells that no steps join may be joined by the way that it came. How many configurations it can reach from anywhere, if there is
    /// no such place.
    fn where_it_was(&mut self, reach: &Reach) -> Result<Decision, usize> {
        let mut is_reached = vec![false; self.known.grid.blocked.len()];
        reach.cells.iter().for_each(|&cell| is_reached[cell] = true);
        let mut back = vec![self.at];
        for leg in (0..self.legs.len()).rev() {
            checkpoint();
            back.extend(self.legs[leg].curve.curve().path().waypoints().iter().rev().skip(1));
            let place = back[back.len() - 1];
            let near = free_about(&self.known.grid, place);
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
                let path = certify(&self.solid, Path::new(back), self.solid.workspace().clearance);
                return Ok(path.map_or_else(|_| Decision::Done(self.too_coarse()), |path| Decision::Go(path, None)));
            }
        }
        Err(is_reached.iter().filter(|&&reached| reached).count())
    }

    fn too_coarse(&self) -> Ending {
        let [a, b] = self.settings.cells;
        Ending::Unknown(format!("no middle of {a} x {b} cells near ({}) is known to be free", shown(self.at)))
    }

    /// To a frontier configuration; explored if none can be reached.
    fn exploring(&mut self, joined: &[usize]) -> Decision {
        loop {
            checkpoint();
            let (way, most) = match self.settings.strategy {
                Strategy::View => (self.best_view(joined), usize::MAX),
                Strategy::Harmonic => (self.uphill(joined).map_or_else(|| self.nearest(joined), Ok), usize::MAX),
                Strategy::Wall => match self.along_wall(joined) {
                    Some(way) => (Ok(way), BY_THE_WALL),
                    None => (self.nearest(joined), usize::MAX),
                },
                Strategy::Nearest | Strategy::Goal => (self.nearest(joined), usize::MAX),
            };
            let way = match way {
                Ok(way) => way,
                Err(reach) => {
                    return self.where_it_was(&reach).unwrap_or_else(|configurations| {
                        Decision::Done(Ending::Explored { configurations, given_up: self.frontier.given_up })
                    });
                }
            };
            if let Some(decision) = self.along(&way, most) {
                return decision;
            }
        }
    }

    /// Up the harmonic potential of all frontier configurations, from the nearest cell that is joined to any.
    fn uphill(&mut self, joined: &[usize]) -> Option<Vec<usize>> {
        let mut side = Grid { blocked: vec![true; self.known.grid.blocked.len()], ..self.known.grid };
        let (from, goals) = joined.iter().find_map(|&from| {
            let goals = self.up_to_frontier(from, &mut side);
            (!goals.is_empty()).then_some((from, goals))
        })?;
        let lattice = Lattice::from(&side);
        let component = Component::new(&lattice, lattice.wave(&goals));
        let way = harmonic_way(&component, component.position_of(from)?)?;
        let way: Vec<usize> = way.into_iter().map(|position| component.cell(position)).collect();
        let Known { grid, closed, .. } = &self.known;
        // The potential knows of no steps that are closed.
        if !way.windows(2).any(|step| closed.contains(&[step[0], step[1]])) {
            return Some(way);
        }
        let end = way[way.len() - 1];
        let reach = Reach::new(grid, closed, self.at, joined, |cell, _| cell == end);
        (reach.cells.last() == Some(&end)).then(|| reach.way(end))
    }

    /// Opens the cells on this `side` of the frontier, those that can be come to from one without passing it, and those of the frontier among
    /// them, which are handed back: what is behind it has no part in the potential before it.
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

    /// To the nearest wall, and along it to the first configuration from which something new can be seen; none where it comes round again
    /// without one.
    fn along_wall(&mut self, joined: &[usize]) -> Option<Vec<usize>> {
        let Known { grid, closed, .. } = &self.known;
        let mut begin = None;
        let reach = Reach::new(grid, closed, self.at, joined, |cell, _| {
            begin = wall::is_beside_wall(grid, cell).then_some(cell);
            begin.is_some()
        });
        let mut way = reach.way(begin?);
        let mut place = Place { cell: begin?, heading: self.heading() };
        let mut gone = HashSet::new();
        while !self.is_frontier(place.cell) {
            checkpoint();
            let next = wall::next(&self.known.grid, &self.known.closed, place);
            place = next.filter(|&next| gone.insert(next))?;
            way.push(place.cell);
        }
        Some(way)
    }

    /// Which way the arm went last, in eighths of a turn.
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

    /// Towards the last of the cells on a way, straight past no more than `most` at a time; none if a step is not free, which is noted.
    fn along(&mut self, way: &[usize], most: usize) -> Option<Decision> {
        let configurations = unwrapped(&self.known.grid, self.at, way);
        let clearance = self.solid.workspace().clearance;
        match tightened(&self.solid, &configurations, most) {
            Ok(path) => {
                let certified = certify(&self.solid, path, clearance);
                let target = way[way.len() - 1];
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

    /// The way to the nearest frontier configuration; what can be reached if that is none, as for the others.
    fn nearest(&mut self, joined: &[usize]) -> Result<Vec<usize>, Reach> {
        let Self { survey, sensor, known, frontier, .. } = self;
        let mut found = None;
        let reach = Reach::new(&known.grid, &known.closed, self.at, joined, |cell, _| {
            found = frontier.contains(survey, sensor, cell).then_some(cell);
            found.is_some()
        });
        reach.way_to(found)
    }

    /// Of the configurations that show all that the nearest frontier configuration does, if nothing unknown is in the way, the one of most
    /// [`worth`], of several the nearest: so little is left behind that one would have to come back for.
    ///
    /// None is looked for farther away than where nothing could be better, nor beyond the nearest [`MOST_VIEWS`]; and the farther away the fewer
    /// are asked, down to those that are as far apart as readings.
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
                    wanted = survey.shown_first(sensor, frontier.stand(cell));
                    best = Some((worth(frontier.gain(survey, sensor, cell)), cell));
                }
                return false;
            };
            let may_be_best = is_asked(cell, length) && worth(frontier.most(cell)) > most;
            asked += usize::from(may_be_best);
            if may_be_best && survey.shows_all(sensor, frontier.stand(cell), &wanted) {
                let worth = worth(frontier.gain(survey, sensor, cell));
                if worth > most {
                    best = Some((worth, cell));
                }
            }
            worth(frontier.most_of_all()) <= most || asked == MOST_VIEWS
        });
        reach.way_to(best.map(|(_, cell)| cell))
    }

    /// Along the planner's way through what may be free, as far as it is known to be.
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
                let boxes = counted(proof.stuck().len(), "box");
                let why =
                    format!("proven: separated from the goal by {boxes} of configurations that meet what was seen");
                return Decision::Done(Ending::Unreachable(why));
            }
            // Its planner may give up, as in a trap: others see farther.
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
        // Where nothing new was seen on the way, more of it shows nothing, either; but all of it leads to the goal.
        let is_worth = free.len() > places.len() || free.len() > 1 && !self.is_stalled;
        let ahead = &places[(free.len() - 1).min(places.len())..];
        match certify(&self.solid, Path::new(free), clearance) {
            Ok(path) if is_worth => Decision::Go(path, None),
            _ => {
                let ahead = ahead.iter().take(PLACES_AHEAD).flat_map(|&q| self.survey.unknown_at(arm, q));
                let in_the_way: BTreeSet<usize> = ahead.collect();
                self.detour(goals, &in_the_way)
            }
        }
    }

    /// To the nearest configuration from which one of the cells `in_the_way` can be seen; else to the best view; if there is none, to the goal
    /// within what is known.
    fn detour(&mut self, goals: &GoalSet, in_the_way: &BTreeSet<usize>) -> Decision {
        let joined = join(&self.solid, &self.known.grid, self.at);
        if joined.is_empty() {
            return self.back();
        }
        loop {
            checkpoint();
            let way = match self.showing(&joined, in_the_way).map_or_else(|| self.best_view(&joined), Ok) {
                Ok(way) => way,
                Err(reach) => return self.where_it_was(&reach).unwrap_or_else(|_| self.within_known(goals)),
            };
            if let Some(decision) = self.along(&way, usize::MAX) {
                return decision;
            }
        }
    }

    /// The way to the nearest configuration from which any of some cells of the map can be seen.
    fn showing(&mut self, joined: &[usize], cells: &BTreeSet<usize>) -> Option<Vec<usize>> {
        if cells.is_empty() {
            return None;
        }
        let Self { survey, sensor, known, frontier, .. } = self;
        let (grid, wanted) = (&known.grid, survey.by_rows(cells));
        let mut showing = None;
        let reach = Reach::new(grid, &known.closed, self.at, joined, |cell, _| {
            let shows =
                frontier.contains(survey, sensor, cell) && survey.shows_any(sensor, frontier.stand(cell), &wanted);
            showing = shows.then_some(cell);
            shows
        });
        showing.map(|cell| reach.way(cell))
    }

    /// To the goal where nothing new can be seen.
    fn within_known(&self, goals: &GoalSet) -> Decision {
        let problem = match problem(self.solid.clone(), self.at, goals) {
            Ok(problem) => problem,
            Err(ending) => return Decision::Done(ending),
        };
        let options = Options { bounded: false, ..Options::default() };
        Decision::Done(match solve(&problem, &options, &mut |_| ()).outcome {
            Outcome::Found(path) => return Decision::Go(path.certified, None),
            Outcome::Infeasible(_) => {
                Ending::Unreachable("nothing new can be seen, and in what is known there is no way: proven".into())
            }
            Outcome::Unknown(Unknown { reason, .. }) => {
                Ending::Unknown(format!("nothing new can be seen, and in what is known {reason}"))
            }
        })
    }
}

/// The problem of going to those of the goals that are free; the end of it all if none is known to be. The goals are free in the world:
/// such cells are too coarse, or were not seen.
fn problem(scene: Scene, start: Configuration, goals: &GoalSet) -> Result<MotionProblem, Ending> {
    let is_blocked = |piece: &&Segment| piece.is_point() && !scene.obstructions(piece.ends()[0]).is_empty();
    let (blocked, open): (Vec<&Segment>, Vec<&Segment>) = goals.pieces().iter().partition(is_blocked);
    if let (true, Some(first)) = (open.is_empty(), blocked.first()) {
        let why = scene.obstructions(first.ends()[0]).iter().map(|o| scene.explain(o)).collect::<Vec<_>>();
        return Err(Ending::Unknown(format!("the goal meets cells that are not known to be free: {}", listed(&why))));
    }
    let open: GoalSet = open.into_iter().copied().collect();
    MotionProblem::new(scene, start, open).map_err(|error| Ending::Unknown(error.to_string()))
}

/// What it is worth to go so far to see so many cells for the first time.
///
/// The nearer the better, and of those that are about as near the one that shows more: twice as far must show 64 times as much (found by
/// trying: CPLAN_WORLDS of `planning exploring`).
fn worth(seen: u32, length: f64, step: f64) -> f64 {
    f64::from(seen).powf(1.0 / 6.0) / (length + step / 2.0)
}

/// Two numbers, for people.
fn shown(q: Configuration) -> String {
    format!("{:.4}, {:.4}", q[0], q[1])
}
