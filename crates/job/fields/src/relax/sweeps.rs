//! Relaxation of an equation on a domain, sweep by sweep.

use super::relaxation::{Precision, Relaxation, Scheme};
use super::stages::{Stages, relax_in_stages};
use super::stencil::{AlteredMean, Mean, Stencil, WeightedMean};
use super::stopping::{Convergence, Measure, Stopping};
use super::{Boundary, Cell, Difference, Direction, Domain, Equation, Neighbor};
use cplan_interrupt::checkpoint;
use std::fmt;

/// A relaxed field.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxedField {
    /// One value per cell. Obstacles and goals have their levels.
    pub values: Vec<f64>,
    /// Result of each stage. With preferences, the first of two stages is the harmonic field; other equations have one stage.
    pub stages: Vec<Convergence>,
}

impl RelaxedField {
    /// Returns the number of sweeps of all stages together.
    pub fn sweeps(&self) -> usize {
        self.stages.iter().map(|stage| stage.sweeps).sum()
    }

    /// Returns true if every stage converged.
    pub fn converged(&self) -> bool {
        self.stages.iter().all(|stage| stage.converged)
    }

    /// Returns the measure in the last sweep.
    pub fn change(&self) -> f64 {
        self.stages.last().map_or(f64::INFINITY, |stage| stage.change)
    }
}

/// Reason why there is no relaxed field.
#[derive(Debug, Clone, PartialEq)]
pub enum RelaxError {
    /// The request is invalid, with the reason.
    Refused(String),
    /// Values grew without bound, or became NaN.
    Diverged {
        /// Number of sweeps after which this was noticed.
        sweeps: usize,
        /// The first cell with such a value, as row and column.
        cell: [usize; 2],
        /// The value of the cell.
        value: f64,
        /// Possible reason, and advice.
        hint: String,
    },
}

impl fmt::Display for RelaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(reason) => f.write_str(reason),
            Self::Diverged { sweeps, cell: [i, j], value, hint } => {
                write!(
                    f,
                    "the relaxation diverged: after {sweeps} sweeps cell ({i}, {j}) has the value {value:e}; {hint}"
                )
            }
        }
    }
}

impl std::error::Error for RelaxError {}

/// A relaxation counts as diverged if a value exceeds the greatest initial value by this factor. The factor is large, because
/// over-relaxation may overshoot and still converge: against a drift `b`, it overshoots by a factor of `exp(b / 2)` per cell,
/// which may be many orders of magnitude in total.
const DIVERGENCE_FACTOR: f64 = 1e100;

/// A guarded relaxation continues with factor 1 once no change in a sweep exceeds this fraction of the difference between the
/// obstacles' and the goals' value. It is about a hundred rounding errors of the greatest values, which is how much
/// over-relaxation amplifies them.
const OVER_RELAXATION_LIMIT: f64 = 1e-13;

/// Number of sweeps between checks for divergence.
const DIVERGENCE_CHECK_INTERVAL: usize = 16;

/// Relaxes an equation from the initial values [`Domain::start`]. A sweep costs some nanoseconds per free cell.
///
/// ```
/// use cplan_fields::*;
///
/// let kinds = [Cell::Goal, Cell::Free, Cell::Free, Cell::Obstacle].to_vec();
/// let domain = Domain::new([1, 4], kinds, [Boundary::Reflecting; 2], Levels::PUBLISHED);
/// let relaxation = Relaxation::sor(Factor::Given(1.1), Order::Corners(Lines::Rows));
/// let stopping = Stopping { measure: Measure::SumOfChange, below: 1e-12, max_sweeps: 1_000 };
/// let field = relax(&domain, &Equation::Harmonic, &relaxation, &stopping)?;
/// assert!((field.values[1] - 1.0 / 3.0).abs() < 1e-9 && (field.values[2] - 2.0 / 3.0).abs() < 1e-9);
/// # Ok::<(), RelaxError>(())
/// ```
///
/// # Errors
/// [`RelaxError::Refused`] if equation and domain differ in size, or if a factor is not positive. [`RelaxError::Diverged`] if
/// values grow without bound. If a stage neither diverges nor converges, it ends after `stopping.max_sweeps` sweeps, as its
/// [`Convergence`] reports.
pub fn relax(
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
) -> Result<RelaxedField, RelaxError> {
    relax_from(domain, equation, relaxation, stopping, domain.start())
}

/// Relaxes an equation from the values `start`, such as those of a field before obstacles moved slightly. First sets obstacles
/// and goals to their levels.
///
/// # Errors
/// Those of [`relax`], and if there is not one value per cell.
pub fn relax_from(
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
    start: Vec<f64>,
) -> Result<RelaxedField, RelaxError> {
    relax_watched(domain, equation, relaxation, stopping, start, &mut |_| {})
}

/// The values after a sweep, while a field is relaxed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepSnapshot<'a> {
    /// Number of the stage, from 0. With preferences, stage 0 relaxes the harmonic field, and stage 1 the field with
    /// preferences.
    pub stage: usize,
    /// Number of sweeps of this stage so far; 0 before the first sweep.
    pub sweep: usize,
    /// One value per cell.
    pub values: &'a [f64],
}

/// Does the same as [`relax_from`], but also calls `watch` with the values before the first sweep of each stage, and
/// after every sweep. The values may be NaN if the relaxation diverges.
///
/// # Errors
/// Those of [`relax_from`].
pub fn relax_watched(
    domain: &Domain,
    equation: &Equation,
    relaxation: &Relaxation,
    stopping: &Stopping,
    start: Vec<f64>,
    watch: &mut dyn FnMut(SweepSnapshot),
) -> Result<RelaxedField, RelaxError> {
    if let Some(refusal) = refusal(domain, equation, relaxation) {
        return Err(refusal);
    }
    let mut engine = Engine::new(domain, equation, relaxation, stopping, initial_values(domain, start)?, watch);
    relax_in_stages(equation, domain, relaxation, &mut engine)?;
    engine.values.pop();
    Ok(RelaxedField { values: engine.values, stages: engine.stages })
}

/// Returns the reason why the request is invalid. `None` if it is valid.
pub(super) fn refusal(domain: &Domain, equation: &Equation, relaxation: &Relaxation) -> Option<RelaxError> {
    if let Some(refusal) = equation.refusal(domain) {
        return Some(RelaxError::Refused(refusal));
    }
    relaxation.refusal(domain.cells()).map(RelaxError::Refused)
}

/// Returns the free cells, ascending, with a neighbour other than themselves. Other free cells keep their values.
pub(super) fn unknowns(domain: &Domain) -> Vec<u32> {
    (0..domain.kinds().len()).filter(|&cell| domain.is_unknown(cell)).map(|cell| cell as u32).collect()
}

/// Returns, for each unknown, the indices of its neighbours' values in the result of [`initial_values`].
pub(super) fn places_around(domain: &Domain, unknowns: &[u32]) -> Vec<[u32; 4]> {
    let beyond = domain.kinds().len() as u32;
    let around = unknowns.iter().map(|&cell| {
        domain.neighbors(cell as usize).map(|neighbor| match neighbor {
            Neighbor::Cell(next) => next as u32,
            Neighbor::Limit => beyond,
            Neighbor::Mirror => cell,
        })
    });
    around.collect()
}

/// Returns the initial values of all cells, with obstacles and goals at their levels, and finally the value beyond limits.
pub(super) fn initial_values(domain: &Domain, start: Vec<f64>) -> Result<Vec<f64>, RelaxError> {
    if start.len() != domain.kinds().len() {
        return Err(RelaxError::Refused("the initial field must have one value per cell".into()));
    }
    let fixed = start.into_iter().zip(domain.kinds()).map(|(value, &kind)| domain.fixed(kind).unwrap_or(value));
    Ok(fixed.chain([domain.levels().obstacle]).collect())
}

/// Returns, for each cell, the share of `epsilon / 4` in altered preferences, with the sign that fits the levels.
pub(super) fn strengths(domain: &Domain, share: f64, epsilon: &[f64]) -> Vec<f64> {
    let quarter = 0.25 * share * domain.levels().orientation();
    epsilon.iter().map(|epsilon| quarter * epsilon).collect()
}

/// Returns a possible reason for a divergence, with advice.
pub(super) fn hint(domain: &Domain, equation: &Equation, relaxation: &Relaxation) -> String {
    let factor = relaxation.factor(domain.cells());
    if equation.is_monotone_on(domain) {
        let also =
            if equation.has_preferences() && relaxation.relaxes_preferences { " and its preferences" } else { "" };
        format!("the factor {factor:.4} is too great for this equation{also}; use a smaller factor, or gauss-seidel")
    } else if matches!(equation, Equation::AlteredPreference { .. }) {
        "the altered equation is monotone only if |epsilon| is less than 2 per cell: use a smaller epsilon".into()
    } else {
        "central differences are monotone only if |epsilon| is less than 2 per cell: use upwind differences, or a smaller epsilon"
            .into()
    }
}

/// Returns, for each free cell, the unit direction in which values approach that of obstacles, by central differences. Zero where
/// values are level.
pub(super) fn normalized_gradient(domain: &Domain, values: &[f64]) -> Vec<[f64; 2]> {
    let levels = domain.levels();
    let at = |cell: usize| {
        if domain.kinds()[cell] != Cell::Free {
            return [0.0; 2];
        }
        let [a, b, c, d] = domain.neighbors(cell).map(|neighbor| match neighbor {
            Neighbor::Cell(next) => values[next],
            Neighbor::Limit => levels.obstacle,
            Neighbor::Mirror => values[cell],
        });
        let rises = [b - a, domain.beta() * (d - c)];
        Direction::of(rises.map(|rise| levels.orientation() * rise)).map_or([0.0; 2], Direction::components)
    };
    (0..domain.kinds().len()).map(at).collect()
}

/// The state of a field while it is relaxed.
struct Engine<'a> {
    domain: &'a Domain,
    equation: &'a Equation,
    relaxation: &'a Relaxation,
    stopping: &'a Stopping,
    /// One value per cell, and finally the value of obstacles, for the boundary.
    values: Vec<f64>,
    /// Greatest absolute value before the first sweep.
    greatest: f64,
    /// Free cells that have a neighbour other than themselves, ascending.
    unknowns: Vec<u32>,
    /// For each unknown, the indices of its neighbours' values.
    around: Vec<[u32; 4]>,
    stages: Vec<Convergence>,
    watch: &'a mut dyn FnMut(SweepSnapshot),
}

impl Stages for Engine<'_> {
    fn harmonic(&mut self) -> Result<(), RelaxError> {
        if self.is_weighted() { self.linear(|_| [0.0; 2], Difference::Central) } else { self.run(&Mean) }
    }

    fn linear(&mut self, drift: impl Fn(usize) -> [f64; 2], difference: Difference) -> Result<(), RelaxError> {
        let stencil = WeightedMean::new(self.domain, &self.unknowns, drift, difference);
        self.run(&stencil)
    }

    fn altered(&mut self, strengths: Vec<f64>) -> Result<(), RelaxError> {
        let strength = self.unknowns.iter().map(|&cell| strengths[cell as usize]).collect();
        self.run(&AlteredMean { strength, beta: self.domain.beta() })
    }

    fn values(&self) -> &[f64] {
        &self.values
    }
}

impl<'a> Engine<'a> {
    fn new(
        domain: &'a Domain,
        equation: &'a Equation,
        relaxation: &'a Relaxation,
        stopping: &'a Stopping,
        values: Vec<f64>,
        watch: &'a mut dyn FnMut(SweepSnapshot),
    ) -> Self {
        let unknowns = unknowns(domain);
        let around = places_around(domain, &unknowns);
        let greatest = values.iter().fold(0.0, |greatest: f64, value| greatest.max(value.abs()));
        Self { domain, equation, relaxation, stopping, values, greatest, unknowns, around, stages: Vec::new(), watch }
    }

    /// Returns true if the neighbours of some cell have unequal weights even without a drift.
    fn is_weighted(&self) -> bool {
        let has_mirrors = self.domain.boundaries().contains(&Boundary::Reflecting) || self.domain.cells().contains(&1);
        has_mirrors || self.domain.beta() != 1.0
    }

    /// Relaxes one stage, with the measure of the stopping rule.
    fn run<S: Stencil>(&mut self, stencil: &S) -> Result<(), RelaxError> {
        match self.stopping.measure {
            Measure::SumOfChange | Measure::DifferenceOfSums => {
                self.stage(stencil, |sum, old, new| sum + (new - old).abs())
            }
            Measure::SumOfSquares => self.stage(stencil, |sum, old, new| sum + (new - old) * (new - old)),
            Measure::GreatestChange => self.stage(stencil, |most, old, new| most.max((new - old).abs())),
            // The quotient is NaN if a value stays 0, which `max` ignores, and infinite if it becomes 0.
            Measure::GreatestRelativeChange => {
                self.stage(stencil, |most, old, new| most.max((new - old).abs() / new.abs()))
            }
        }
    }

    fn stage<S: Stencil>(&mut self, stencil: &S, tally: impl Tally) -> Result<(), RelaxError> {
        let Self { relaxation, stopping, .. } = *self;
        let factor = relaxation.factor(self.domain.cells());
        let passes = match relaxation.scheme {
            Scheme::Simultaneous { .. } => Vec::new(),
            Scheme::Successive { order, .. } => order.passes(self.domain.cells(), &self.unknowns),
        };
        let levels = self.domain.levels();
        let floor = OVER_RELAXATION_LIMIT * (levels.obstacle - levels.goal).abs();
        let has_floor = relaxation.guarded && factor > 1.0 && stopping.measure.is_relative();
        let range = [levels.obstacle.min(levels.goal), levels.obstacle.max(levels.goal)];
        let guard = (relaxation.guarded && factor < 2.0).then_some(range);
        let mut step = Step { stencil, factor, guard, clamp: relaxation.clamp, precision: relaxation.precision };
        let mut next = vec![0.0; if passes.is_empty() { self.unknowns.len() } else { 0 }];
        let mut stage = Convergence { sweeps: 0, change: f64::INFINITY, converged: self.unknowns.is_empty() };
        let mut before = f64::INFINITY;
        self.show(0);
        while !stage.converged && stage.sweeps < stopping.max_sweeps {
            checkpoint();
            let Changes { total, greatest } = match passes.len() {
                0 => self.at_once(&step, &mut next, tally),
                count => self.in_turn(&step, &passes[stage.sweeps % count], tally),
            };
            stage.sweeps += 1;
            self.show(stage.sweeps);
            stage.change = if stopping.measure == Measure::DifferenceOfSums { (total - before).abs() } else { total };
            before = total;
            stage.converged = stage.change < stopping.below || total == 0.0;
            if has_floor && greatest < floor {
                step.factor = 1.0;
            }
            if stage.sweeps.is_multiple_of(DIVERGENCE_CHECK_INTERVAL)
                || stage.converged
                || stage.sweeps == stopping.max_sweeps
            {
                self.look_for_divergence(stage.sweeps)?;
            }
        }
        self.stages.push(stage);
        Ok(())
    }

    fn show(&mut self, sweep: usize) {
        // Without the last value, which is for the boundary.
        let values = &self.values[..self.values.len() - 1];
        (self.watch)(SweepSnapshot { stage: self.stages.len(), sweep, values });
    }

    fn at_once<S: Stencil>(&mut self, step: &Step<S>, next: &mut [f64], tally: impl Tally) -> Changes {
        let mut changes = Changes::default();
        for (k, next) in next.iter_mut().enumerate() {
            let old = self.values[self.unknowns[k] as usize];
            *next = step.new_value(k, old, self.around[k].map(|n| self.values[n as usize]));
            changes.add(tally, old, *next);
        }
        for (&cell, &new) in self.unknowns.iter().zip(&*next) {
            self.values[cell as usize] = new;
        }
        changes
    }

    fn in_turn<S: Stencil>(&mut self, step: &Step<S>, pass: &[u32], tally: impl Tally) -> Changes {
        let mut changes = Changes::default();
        for &k in pass {
            let k = k as usize;
            let cell = self.unknowns[k] as usize;
            let old = self.values[cell];
            let new = step.new_value(k, old, self.around[k].map(|n| self.values[n as usize]));
            self.values[cell] = new;
            changes.add(tally, old, new);
        }
        changes
    }

    fn look_for_divergence(&self, sweeps: usize) -> Result<(), RelaxError> {
        let lost = |&&cell: &&u32| {
            let value = self.values[cell as usize];
            value.is_nan() || value.abs() > DIVERGENCE_FACTOR * self.greatest
        };
        let Some(&cell) = self.unknowns.iter().find(lost) else { return Ok(()) };
        let (cell, columns) = (cell as usize, self.domain.cells()[1]);
        let hint = hint(self.domain, self.equation, self.relaxation);
        Err(RelaxError::Diverged { sweeps, cell: [cell / columns, cell % columns], value: self.values[cell], hint })
    }
}

/// Adds the change of a value to the measure of a sweep.
trait Tally: Fn(f64, f64, f64) -> f64 + Copy {}

impl<F: Fn(f64, f64, f64) -> f64 + Copy> Tally for F {}

/// The changes in a sweep.
#[derive(Default)]
struct Changes {
    /// The measured quantity.
    total: f64,
    /// The greatest `|change|`.
    greatest: f64,
}

impl Changes {
    fn add(&mut self, tally: impl Tally, old: f64, new: f64) {
        self.total = tally(self.total, old, new);
        self.greatest = self.greatest.max((new - old).abs());
    }
}

/// The update of a cell.
struct Step<'a, S> {
    stencil: &'a S,
    factor: f64,
    /// Range of the fixed values. `None` if values may leave it.
    guard: Option<[f64; 2]>,
    clamp: Option<[f64; 2]>,
    precision: Precision,
}

impl<S: Stencil> Step<'_, S> {
    fn new_value(&self, position: usize, old: f64, around: [f64; 4]) -> f64 {
        let asked = self.stencil.target(position, old, around);
        // With factor 1, exactly the implied value, without additional rounding.
        let new = if self.factor == 1.0 { asked } else { old + self.factor * (asked - old) };
        let new = match self.guard {
            Some([low, high]) if new < low || new > high => asked,
            _ => new,
        };
        // In contrast to `clamp`, this does not check the bounds for each cell.
        let new = self.clamp.map_or(new, |[low, high]| new.max(low).min(high));
        match self.precision {
            Precision::Double => new,
            Precision::Single => f64::from(new as f32),
        }
    }
}
