//! The explorer: decides, moves, looks, until it is done.

use super::outlook::Outlook;
use super::result::{Ending, Exploration, Leg, Reading};
use super::roads::{Closed, Reach, is_free, join, places, tightened};
use super::survey::{MOST_CELLS, Survey};
use crate::check::{CertifiedPath, certify};
use crate::cspace::{Grid, grid_from_slices};
use crate::engine::{Options, Verdict, solve};
use crate::field::{Component, Lattice, harmonic};
use crate::interrupt::checkpoint;
use crate::model::{MotionProblem, Scene, Sensor};
use crate::motion::{Drive, Trajectory};
use crate::space::{Configuration, Draws, GoalSet, Metric, Path, Segment};
use crate::text::counted;
use serde::Serialize;
use std::collections::BTreeSet;
use std::time::Instant;
use thiserror::Error;

/// How the explorer decides where to go next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// To the goal, by the way that the options' planner finds where what is unknown counts as free, as far as that is known to be
    /// free; where that shows nothing new, to where something new can be seen, soonest on the way to the goal.
    #[default]
    Goal,
    /// To the nearest configuration from which something new can be seen (Yamauchi 1997).
    Nearest,
    /// Up the harmonic potential whose goals are all configurations from which something new can be seen (Prestes et al. 2002).
    Harmonic,
}

/// How to explore.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Where to go next.
    pub strategy: Strategy,
    /// Cells of the grid of configurations, along both axes.
    pub cells: [usize; 2],
    /// Distance about the arm, at first, in which the world is known, metres; none for two cells of the map.
    pub surveyed: Option<f64>,
    /// Decisions at the most.
    pub decisions: usize,
    /// The planner of [`Strategy::Goal`], and how motions are driven.
    pub options: Options,
}

impl Default for Settings {
    fn default() -> Self {
        let options = Options::default();
        // A corner is stopped at: there the arm looks around.
        let drive = Drive { blend: 0.0, ..options.drive };
        let options = Options { drive, bounded: false, ..options };
        Self { strategy: Strategy::default(), cells: [96, 96], surveyed: None, decisions: 10_000, options }
    }
}

/// The arm is at a goal if it is no farther from it than this: whole turns may have been added to it, and rounded.
const AT_GOAL: f64 = 1e-9;

/// Places ahead on the way that is hoped for whose unknown cells are looked for.
const PLACES_AHEAD: usize = 8;

/// Why there is no exploration.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ExploreError {
    /// The map would be too large.
    #[error("a map of cells of {0} m would have more than {MOST_CELLS} of them")]
    Map(f64),
    /// There is no goal to go to.
    #[error("the strategy \"goal\" has no goal to go to")]
    NoGoal,
}

/// Explores the world of `scene`, of which nothing is known but what the sensor sees, from `start`. `progress` hears of it now and then.
///
/// Deterministic: the same input gives the same exploration, but for the times that decisions took. A decision costs a grid of
/// slices among the map's rectangles, a shortest-path search over it, and certificates.
///
/// # Errors
/// A map of too many cells, a strategy without its goal.
pub fn explore(
    scene: &Scene,
    sensor: &Sensor,
    start: Configuration,
    goals: Option<&GoalSet>,
    settings: &Settings,
    progress: &mut dyn FnMut(&str),
) -> Result<Exploration, ExploreError> {
    if settings.strategy == Strategy::Goal && goals.is_none() {
        return Err(ExploreError::NoGoal);
    }
    let survey = Survey::new(scene, sensor.cell).ok_or(ExploreError::Map(sensor.cell))?;
    let mut explorer = Explorer {
        scene,
        sensor,
        settings,
        goals,
        survey,
        outlook: Outlook::new(settings.cells[0] * settings.cells[1]),
        errors: Draws::new(sensor.seed),
        at: start,
        length: 0.0,
        readings: Vec::new(),
        legs: Vec::new(),
        trajectory: None,
        is_stalled: false,
        is_back: false,
    };
    let margin = settings.surveyed.unwrap_or(2.0 * sensor.cell) + scene.workspace().clearance;
    let surroundings = explorer.survey.survey_about(scene.arm(), start, margin);
    explorer.look();
    let (mut decisions, mut opened) = (Vec::new(), Vec::new());
    let mut is_open = vec![false; settings.cells[0] * settings.cells[1]];
    let ending = loop {
        checkpoint();
        if explorer.is_at_goal() {
            break Ending::Reached;
        }
        if decisions.len() == settings.decisions {
            break Ending::Unknown(format!("not done after {}", counted(decisions.len(), "decision")));
        }
        let clock = Instant::now();
        let mut known = explorer.known();
        let decision = explorer.decide(&mut known);
        decisions.push(clock.elapsed());
        let free = (0..is_open.len()).filter(|&cell| !known.grid.blocked[cell]);
        let new: Vec<usize> = free.filter(|&cell| !std::mem::replace(&mut is_open[cell], true)).collect();
        opened.push((explorer.readings.len(), new));
        match decision {
            Decision::Done(ending) => break ending,
            Decision::Go(way, until) => {
                if let Err(why) = explorer.go(&known, &way, until) {
                    break Ending::Unknown(why);
                }
            }
        }
        if decisions.len().is_multiple_of(50) {
            let [free, occupied, unknown] = explorer.survey.counts();
            let seen = 100.0 * (free + occupied) as f64 / (free + occupied + unknown) as f64;
            progress(&format!("{}: {seen:.0} % of the map seen", counted(decisions.len(), "decision")));
        }
    };
    let Explorer { survey, readings, legs, trajectory, length, .. } = explorer;
    let (cells, strategy) = (settings.cells, settings.strategy);
    Ok(Exploration {
        strategy,
        ending,
        survey,
        surroundings,
        readings,
        opened,
        legs,
        trajectory,
        length,
        decisions,
        cells,
    })
}

/// What comes next.
enum Decision {
    Done(Ending),
    /// Along a path that is certified; the cell of the grid that is gone to for what can be seen from there, if it is.
    Go(CertifiedPath, Option<usize>),
}

struct Explorer<'a> {
    scene: &'a Scene,
    sensor: &'a Sensor,
    settings: &'a Settings,
    goals: Option<&'a GoalSet>,
    survey: Survey,
    outlook: Outlook,
    errors: Draws,
    at: Configuration,
    length: f64,
    readings: Vec<Reading>,
    legs: Vec<Leg>,
    trajectory: Option<Trajectory>,
    /// Whether the last leg along a way that was hoped for showed nothing new: another one would not, either.
    is_stalled: bool,
    /// Whether the last leg was one back.
    is_back: bool,
}

/// What is known now.
struct Known {
    scene: Scene,
    grid: Grid,
    closed: Closed,
}

impl Explorer<'_> {
    /// Takes a reading where the arm is. Whether it shows anything new.
    fn look(&mut self) -> bool {
        let new = self.survey.look(self.sensor, self.scene.arm(), self.at, &mut self.errors);
        let is_new = !new.is_empty();
        self.readings.push(Reading { at: self.at, length: self.length, new });
        is_new
    }

    fn known(&self) -> Known {
        let clearance = self.scene.workspace().clearance;
        let scene = self.survey.scene(self.scene.arm(), clearance, false);
        let grid = grid_from_slices(&scene, self.settings.cells, clearance);
        Known { scene, grid, closed: Closed::new() }
    }

    fn decide(&mut self, known: &mut Known) -> Decision {
        if let (Strategy::Goal, Some(goals)) = (self.settings.strategy, self.goals) {
            return self.towards_goal(known, goals);
        }
        let joined = join(&known.scene, &known.grid, self.at);
        if joined.is_empty() { self.back(known) } else { self.exploring(known, &joined) }
    }

    /// Whether the arm is where it is to go.
    fn is_at_goal(&self) -> bool {
        let topology = self.scene.arm().topology();
        let goals = self.goals.filter(|_| self.settings.strategy == Strategy::Goal);
        goals.is_some_and(|goals| goals.contains(&topology, self.at, AT_GOAL))
    }

    /// Back to where the last leg began, from where no middle of a cell can be reached; not twice.
    fn back(&mut self, known: &Known) -> Decision {
        let last = self.legs.last().filter(|_| !self.is_back).map(|leg| leg.curve.curve().path().waypoints());
        let reversed = last.map(|waypoints| Path::new(waypoints.iter().rev().copied().collect()));
        let certified = reversed.and_then(|path| certify(&known.scene, path, known.scene.workspace().clearance).ok());
        self.is_back = true;
        certified.map_or_else(|| Decision::Done(self.too_coarse()), |path| Decision::Go(path, None))
    }

    fn too_coarse(&self) -> Ending {
        let [a, b] = self.settings.cells;
        Ending::Unknown(format!("no middle of {a} x {b} cells near ({}) is known to be free", shown(self.at)))
    }

    /// To where something new can be seen; explored if that is nowhere.
    fn exploring(&mut self, known: &mut Known, joined: &[usize]) -> Decision {
        loop {
            checkpoint();
            let (arm, sensor) = (self.scene.arm(), self.sensor);
            let Known { grid, closed, .. } = &*known;
            let mut promises = |cell: usize| self.outlook.promises(&self.survey, sensor, arm, grid, cell);
            let (way, target) = match self.settings.strategy {
                Strategy::Harmonic => {
                    let reach = Reach::new(grid, closed, self.at, joined, |_| false);
                    let frontier: Vec<usize> = reach.cells.iter().copied().filter(|&cell| promises(cell)).collect();
                    if frontier.is_empty() {
                        return Decision::Done(self.explored(&reach));
                    }
                    let ascent = joined.iter().find_map(|&from| uphill(grid, &frontier, from));
                    let Some(ascent) = ascent else { return Decision::Done(self.too_coarse()) };
                    let target = ascent[ascent.len() - 1];
                    // The potential knows of no steps that are closed.
                    let is_closed = ascent.windows(2).any(|step| closed.contains(&[step[0], step[1]]));
                    let way = if is_closed { reach.way(target) } else { ascent };
                    (reach.unwrapped(grid, &way), target)
                }
                Strategy::Nearest | Strategy::Goal => {
                    let mut found = None;
                    let mut nearest = |cell: usize| {
                        let is_promising = promises(cell);
                        found = is_promising.then_some(cell);
                        is_promising
                    };
                    let reach = Reach::new(grid, closed, self.at, joined, &mut nearest);
                    let Some(target) = found else {
                        return Decision::Done(self.explored(&reach));
                    };
                    (reach.unwrapped(grid, &reach.way(target)), target)
                }
            };
            match self.certified(known, &way) {
                Ok(Some(path)) => return Decision::Go(path, Some(target)),
                Ok(None) => {}
                Err(ending) => return Decision::Done(ending),
            }
        }
    }

    fn explored(&self, reach: &Reach) -> Ending {
        Ending::Explored { configurations: reach.cells.len(), given_up: self.outlook.given_up }
    }

    /// The way as a certified path; none if a step of it is not free, which is noted.
    fn certified(&self, known: &mut Known, way: &[Configuration]) -> Result<Option<CertifiedPath>, Ending> {
        let clearance = known.scene.workspace().clearance;
        let path = match tightened(&known.scene, way) {
            Ok(path) => path,
            Err(step) => {
                let [from, to] = [way[step], way[step + 1]].map(|q| known.grid.locate(q));
                let before = known.closed.len();
                known.closed.extend([[from, to], [to, from]]);
                return if known.closed.len() > before { Ok(None) } else { Err(self.too_coarse()) };
            }
        };
        certify(&known.scene, path, clearance).map(Some).map_err(|_| self.too_coarse())
    }

    /// Along the planner's way through what may be free, as far as it is known to be.
    fn towards_goal(&mut self, known: &mut Known, goals: &GoalSet) -> Decision {
        let arm = self.scene.arm();
        let clearance = self.scene.workspace().clearance;
        let problem = match problem(self.survey.scene(arm, clearance, true), self.at, goals) {
            Ok(problem) => problem,
            Err(ending) => return Decision::Done(ending),
        };
        let hoped = match solve(&problem, &self.settings.options, &mut |_| ()).verdict {
            Verdict::Found(path) => path,
            Verdict::Infeasible(proof) => {
                let boxes = proof.stuck().len();
                let why = format!(
                    "proven: {boxes} boxes of configurations that meet what was seen separate it from the goal"
                );
                return Decision::Done(Ending::Unreachable(why));
            }
            // Its planner may give up, as in a trap: others see farther.
            Verdict::Unknown(_) => return self.aside(known, goals, &[]),
        };
        let places = places(hoped.path(), self.sensor.step);
        let mut free = vec![self.at];
        for &place in &places {
            if !is_free(&known.scene, free[free.len() - 1], place) {
                break;
            }
            free.push(place);
        }
        // Where nothing new was seen on the way, more of it shows nothing, either; but all of it leads to the goal.
        let is_worth = free.len() > places.len() || free.len() > 1 && !self.is_stalled;
        let ahead = &places[(free.len() - 1).min(places.len())..];
        match certify(&known.scene, Path::new(free), clearance) {
            Ok(path) if is_worth => Decision::Go(path, None),
            _ => {
                let ahead = ahead.iter().take(PLACES_AHEAD).flat_map(|&q| self.survey.unknown_at(arm, q));
                let wanted: BTreeSet<usize> = ahead.collect();
                self.aside(known, goals, &Vec::from_iter(wanted))
            }
        }
    }

    /// To the nearest place from which one of the `wanted` cells can be seen, which are in the way; else to where anything new can be seen,
    /// for the way there and on to the goal; if that is nowhere, to the goal within what is known.
    fn aside(&mut self, known: &mut Known, goals: &GoalSet, wanted: &[usize]) -> Decision {
        let (arm, sensor) = (self.scene.arm(), self.sensor);
        let joined = join(&known.scene, &known.grid, self.at);
        if joined.is_empty() {
            return self.back(known);
        }
        loop {
            checkpoint();
            let Known { grid, closed, .. } = &*known;
            let mut wanting = None;
            let mut shows = |cell: usize| {
                let is_shown = !wanted.is_empty()
                    && self.outlook.promises(&self.survey, sensor, arm, grid, cell)
                    && self.survey.shows_any(sensor, arm, grid.center(cell), wanted);
                wanting = is_shown.then_some(cell);
                is_shown
            };
            let reach = Reach::new(grid, closed, self.at, &joined, &mut shows);
            let on = |cell: usize| goals.distance(&grid.topology, Metric::Euclidean, grid.center(cell));
            let mut best: Option<(f64, usize)> = None;
            for &cell in reach.cells.iter().filter(|_| wanting.is_none()) {
                let total = reach.cost(cell) + on(cell);
                if best.is_none_or(|(least, _)| total < least)
                    && self.outlook.promises(&self.survey, sensor, arm, grid, cell)
                {
                    best = Some((total, cell));
                }
            }
            let Some(target) = wanting.or(best.map(|best| best.1)) else { return self.within_known(known, goals) };
            let way = reach.unwrapped(grid, &reach.way(target));
            match self.certified(known, &way) {
                Ok(Some(path)) => return Decision::Go(path, Some(target)),
                Ok(None) => {}
                Err(ending) => return Decision::Done(ending),
            }
        }
    }

    /// To the goal where nothing new can be seen.
    fn within_known(&self, known: &Known, goals: &GoalSet) -> Decision {
        let problem = match problem(known.scene.clone(), self.at, goals) {
            Ok(problem) => problem,
            Err(ending) => return Decision::Done(ending),
        };
        let options = Options { bounded: false, ..Options::default() };
        Decision::Done(match solve(&problem, &options, &mut |_| ()).verdict {
            Verdict::Found(path) => return Decision::Go(path, None),
            Verdict::Infeasible(_) => {
                Ending::Unreachable("nothing new can be seen, and in what is known there is no way: proven".into())
            }
            Verdict::Unknown(why) => Ending::Unknown(format!("nothing new can be seen, and in what is known {why}")),
        })
    }

    /// Moves along a path and looks on the way. Gone to for what can be seen from a cell, the arm stops as soon as that is nothing new.
    ///
    /// # Errors
    /// A part of the path that cannot be certified, or not be timed: why, in words.
    fn go(&mut self, known: &Known, way: &CertifiedPath, until: Option<usize>) -> Result<(), String> {
        let before = self.readings.len();
        let mut gone = vec![self.at];
        let mut is_new = false;
        for place in places(way.path(), self.sensor.step) {
            self.length += (place - self.at).norm();
            self.at = place;
            gone.push(place);
            is_new |= self.look();
            let is_over = until.is_some_and(|cell| {
                !self.outlook.promises(&self.survey, self.sensor, self.scene.arm(), &known.grid, cell)
            });
            if is_over || until.is_none() && is_new {
                break;
            }
        }
        if let Some(cell) = until.filter(|_| !is_new) {
            self.outlook.disappointed(cell);
        }
        self.is_stalled = until.is_none() && !is_new;
        self.is_back &= !is_new && until.is_none();
        if gone.len() == 1 {
            return Ok(());
        }
        // Part of what is certified is free, too.
        let clearance = known.scene.workspace().clearance;
        let path =
            certify(&known.scene, Path::new(gone), clearance).map_err(|rejection| format!("a leg: {rejection:?}"))?;
        let timed =
            self.settings.options.drive.along(&known.scene, &path, 1.0).map_err(|error| format!("a leg: {error}"))?;
        match &mut self.trajectory {
            Some(trajectory) => trajectory.then(0.0, &timed.trajectory),
            None => self.trajectory = Some(timed.trajectory),
        }
        self.legs.push(Leg { curve: timed.curve, readings: before });
        Ok(())
    }
}

/// The problem of going to those of the goals that are free; the end of it all if none is known to be. The goals are free in the world:
/// such cells are too coarse, or were not seen.
fn problem(scene: Scene, start: Configuration, goals: &GoalSet) -> Result<MotionProblem, Ending> {
    let is_blocked = |piece: &&Segment| piece.is_point() && !scene.obstructions(piece.ends()[0]).is_empty();
    let (blocked, open): (Vec<&Segment>, Vec<&Segment>) = goals.pieces().iter().partition(is_blocked);
    if let (true, Some(first)) = (open.is_empty(), blocked.first()) {
        let why = scene.obstructions(first.ends()[0]).iter().map(|o| scene.explain(o)).collect::<Vec<_>>();
        return Err(Ending::Unknown(format!("the goal meets cells that are not known to be free: {}", why.join("; "))));
    }
    let open: GoalSet = open.into_iter().copied().collect();
    MotionProblem::new(scene, start, open).map_err(|error| Ending::Unknown(error.to_string()))
}

/// From cell to cell up the harmonic potential of some goals; none if they cannot be reached.
fn uphill(grid: &Grid, goals: &[usize], from: usize) -> Option<Vec<usize>> {
    let lattice = Lattice::from(grid);
    let component = Component::new(&lattice, lattice.wave(goals));
    let start = component.position_of(from)?;
    let way = harmonic(&component).potential.ascend(&component, start)?;
    Some(way.into_iter().map(|position| component.cell(position)).collect())
}

/// Two numbers, for people.
fn shown(q: Configuration) -> String {
    format!("{:.4}, {:.4}", q[0], q[1])
}
