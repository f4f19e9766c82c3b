//! The explorer: it decides, moves and takes readings until an ending is reached.

use super::decision::Decision;
use super::frontier::Frontier;
use super::known_space::KnownSpace;
use super::reach::places;
use super::result::{Ending, Exploration, Leg, SensorReading};
use super::settings::{ExploreError, Settings, Strategy};
use super::survey::Survey;
use cplan_interrupt::{Instant, checkpoint};
use cplan_judge::{CertifiedPath, certify};
use cplan_model::space::{Configuration, GoalSet, Path, SplitMix64};
use cplan_model::{MotionProblem, Scene};
use cplan_motion::Trajectory;
use cplan_solver::{Options, solve};
use cplan_text::counted;
use cplan_world::Sensor;

/// Greatest distance from a goal, in joint space, at which the arm counts as being at the goal. It covers the rounding
/// of added whole turns.
const GOAL_TOLERANCE: f64 = 1e-9;

/// Explores the world of `scene` from `start`. The explorer uses only the sensor's readings of this world. Calls
/// `progress` regularly.
///
/// The exploration is deterministic, except for the measured times of decisions. A decision takes a shortest-path
/// search over the grid of configurations, and certificates; with a goal, also a plan.
///
/// # Errors
/// A map with too many cells, a known map of another world, or a missing goal that the strategy needs.
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
    let (arm, clearance) = (scene.arm(), scene.workspace().clearance);
    let mut survey = Survey::new(scene, sensor.cell).ok_or(ExploreError::Map(sensor.cell))?;
    if let Some(known) = &settings.known {
        survey.add_earlier_map(known).map_err(ExploreError::Known)?;
    }
    let margin = settings.surveyed.unwrap_or(2.0 * sensor.cell) + clearance;
    let mut surroundings: Vec<usize> = (0..survey.map().cells.len()).filter(|&cell| !survey.is_unknown(cell)).collect();
    surroundings.extend(survey.survey_around(arm, start, margin));
    let known = KnownSpace::new(&survey, arm, settings.cells, clearance);
    let frontier = Frontier::new(&survey, sensor, arm, &known.grid);
    let free = (0..known.grid.blocked.len()).filter(|&cell| !known.grid.blocked[cell]).collect();
    let mut explorer = Explorer {
        sensor,
        settings,
        goals,
        scene,
        solid: survey.scene(arm, clearance, false),
        survey,
        known,
        frontier,
        errors: SplitMix64::new(sensor.seed),
        at: start,
        length: 0.0,
        new_cells: Vec::new(),
        readings: Vec::new(),
        opened: vec![(0, free)],
        legs: Vec::new(),
        trajectory: None,
        is_stalled: false,
        is_back: false,
    };
    explorer.take_reading();
    let mut decisions = Vec::new();
    let ending = loop {
        checkpoint();
        if explorer.is_at_goal() {
            break Ending::Reached;
        }
        if decisions.len() == settings.decisions {
            break Ending::Unknown(format!("not finished after {}", counted(decisions.len(), "decision")));
        }
        let clock = Instant::now();
        explorer.update_knowledge();
        let decision = explorer.decide();
        decisions.push(clock.elapsed());
        match decision {
            Decision::Done(ending) => break ending,
            Decision::Go(route, until) => {
                if let Err(why) = explorer.go(&route, until) {
                    break Ending::Unknown(why);
                }
            }
        }
        if decisions.len().is_multiple_of(50) {
            let seen = 100.0 * explorer.survey.share_seen();
            progress(&format!("{}: {seen:.0} % of the map seen", counted(decisions.len(), "decision")));
        }
    };
    let known_length =
        goals.filter(|_| ending == Ending::Reached).and_then(|goals| length_if_known(scene, start, goals, settings));
    let Explorer { survey, readings, opened, legs, trajectory, length, .. } = explorer;
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
        known_length,
        decisions,
        cells,
    })
}

/// Returns the length of the shortest motion found with knowledge of the true world. `None` if the search finds nothing.
fn length_if_known(scene: &Scene, start: Configuration, goals: &GoalSet, settings: &Settings) -> Option<f64> {
    let problem = MotionProblem::new(scene.clone(), start, goals.clone()).ok()?;
    let options = Options { bounded: false, levels: settings.options.levels, ..Options::default() };
    solve(&problem, &options, &mut |_| ()).path().map(Path::length)
}

/// The state of an exploration: the arm's configuration, and all knowledge about the world.
pub struct Explorer<'a> {
    pub sensor: &'a Sensor,
    pub settings: &'a Settings,
    pub goals: Option<&'a GoalSet>,
    /// The true scene. Decisions use only its arm and its clearance.
    pub scene: &'a Scene,
    pub survey: Survey,
    /// The arm among all cells that are not known to be free.
    pub solid: Scene,
    pub known: KnownSpace,
    pub frontier: Frontier,
    pub at: Configuration,
    /// True if the last leg along an optimistic path showed nothing new. A part of the next such path would not, either.
    pub is_stalled: bool,
    /// True if the last leg returned to a configuration where the arm had been before.
    pub is_back: bool,
    pub legs: Vec<Leg>,
    errors: SplitMix64,
    length: f64,
    /// Cells of the map that became known since the last decision.
    new_cells: Vec<usize>,
    readings: Vec<SensorReading>,
    opened: Vec<(usize, Vec<usize>)>,
    trajectory: Option<Trajectory>,
}

impl Explorer<'_> {
    /// Takes a reading at the arm's configuration. Returns true if it shows something new.
    fn take_reading(&mut self) -> bool {
        let new = self.survey.record_reading(self.sensor, self.scene.arm(), self.at, &mut self.errors);
        let is_new = !new.is_empty();
        if is_new {
            self.frontier.forget_edges();
        }
        self.new_cells.extend(&new);
        self.readings.push(SensorReading { at: self.at, length: self.length, new });
        is_new
    }

    /// Updates the grid, the frontier and the known obstacles with everything that was seen since the last decision.
    fn update_knowledge(&mut self) {
        let new_cells = std::mem::take(&mut self.new_cells);
        let (arm, clearance) = (self.scene.arm(), self.scene.workspace().clearance);
        self.opened.push((self.readings.len(), self.known.update(&self.survey, arm, &new_cells)));
        self.frontier.update(&self.survey, self.sensor);
        self.frontier.evaluate_ahead(&self.survey, self.sensor, &self.known.grid);
        if !new_cells.is_empty() {
            self.solid = self.survey.scene(arm, clearance, false);
        }
    }

    /// Returns true if the strategy has a goal and the arm is at one of the goals.
    fn is_at_goal(&self) -> bool {
        let topology = self.scene.arm().topology();
        let goals = self.goals.filter(|_| self.settings.strategy == Strategy::Goal);
        goals.is_some_and(|goals| goals.contains(&topology, self.at, GOAL_TOLERANCE))
    }

    /// Returns true if a reading at a cell of the grid would show something new.
    pub fn is_frontier(&mut self, cell: usize) -> bool {
        self.frontier.contains(&self.survey, self.sensor, cell)
    }

    /// Moves along a path and takes readings on it. If `until` is a cell, the purpose is a reading there, and the arm
    /// stops as soon as that reading would show nothing new. If `until` is `None`, the arm stops at the first reading
    /// that shows something new.
    ///
    /// # Errors
    /// The reason why a part of the path cannot be certified or timed.
    fn go(&mut self, route: &CertifiedPath, until: Option<usize>) -> Result<(), String> {
        let before = self.readings.len();
        let mut gone = vec![self.at];
        let mut is_new = false;
        for place in places(route.path(), self.sensor.step) {
            self.length += (place - self.at).norm();
            self.at = place;
            gone.push(place);
            is_new |= self.take_reading();
            let is_over = until.is_some_and(|cell| !self.is_frontier(cell));
            if is_over || until.is_none() && is_new {
                break;
            }
        }
        if let Some(cell) = until.filter(|_| !is_new) {
            self.frontier.record_nothing_new(cell);
        }
        self.is_stalled = until.is_none() && !is_new;
        self.is_back &= !is_new && until.is_none();
        if gone.len() == 1 {
            return Ok(());
        }
        // The arm may have followed only a part of the path. That part is free, but needs its own certificate.
        let path = certify(&self.solid, Path::new(gone)).map_err(|rejection| format!("a leg: {rejection:?}"))?;
        let timed =
            self.settings.options.drive.along(&self.solid, &path, 1.0).map_err(|error| format!("a leg: {error}"))?;
        match &mut self.trajectory {
            Some(trajectory) => trajectory.then(0.0, &timed.trajectory),
            None => self.trajectory = Some(timed.trajectory),
        }
        self.legs.push(Leg { curve: timed.curve, readings: before });
        Ok(())
    }
}
