//! The planner for any field of the family.

use super::attach::Joined;
use super::field_choice::{EquationChoice, FieldChoice, FieldPlanner};
use super::{Note, Outcome, Planner, Query, Run, Size, Trace, grid_path};
use crate::cspace::{Grid, ZonedGrid};
use crate::field::{
    Cell, Domain, Equation, ForceField, Levels, Measure, Relaxation, Relaxed, Stopping, Stuck, Trap, descend, relax,
};
use crate::space::Configuration;

/// What became of a field.
struct Followed {
    /// The way, or why there is none.
    cells: Result<Vec<usize>, String>,
    trace: Trace,
    sweeps: usize,
    note: Option<Note>,
}

impl Planner for FieldPlanner {
    const NAME: &'static str = "harmonic";
    type Space = ZonedGrid;
    type Map = ();

    /// Nothing: what a field is depends on the goals.
    fn build(&self, _: &ZonedGrid) {}

    fn query(&self, space: &ZonedGrid, (): &(), query: &Query) -> Run {
        let grid = &space.grid;
        let nothing = || Trace::Field { cells: grid.cells, potential: vec![f64::NEG_INFINITY; grid.blocked.len()] };
        let ended =
            |outcome, cells| Run { outcome, trace: nothing(), size: Size::Grid { cells, sweeps: 0 }, note: None };
        let joined = match Joined::new(grid, query) {
            Ok(joined) => joined,
            Err(reason) => return ended(Outcome::GaveUp(reason), 0),
        };
        let goals = joined.sources();
        let domain = Domain::of_grid(grid, &goals, self.limits, Levels::PROBABILITY);
        let reached = |&cell: &usize| domain.kinds()[cell] != Cell::Obstacle;
        let cells = domain.kinds().iter().filter(|&&kind| kind != Cell::Obstacle).count();
        // The nearest cell of the start that is connected with a goal.
        let Some(start) = joined.start.cells.iter().copied().find(reached) else {
            return ended(Outcome::NoPath, cells);
        };
        let followed = match self.field {
            FieldChoice::Khatib(laws) => {
                let centers: Vec<Configuration> = goals.iter().map(|&cell| grid.center(cell)).collect();
                follow_forces(grid, &ForceField::new(grid, laws, &centers, self.limits), start, &goals)
            }
            FieldChoice::Relaxed { equation, relaxation, tolerance, max_sweeps } => {
                let stopping = Stopping { measure: Measure::GreatestRelativeChange, below: tolerance, max_sweeps };
                match follow_relaxed(space, &domain, equation, &relaxation, &stopping, start) {
                    Ok(followed) => followed,
                    Err(reason) => return ended(Outcome::GaveUp(reason), cells),
                }
            }
        };
        let outcome = match followed.cells {
            Err(reason) => Outcome::GaveUp(reason),
            Ok(way) => match grid_path::path(grid, query, &joined, &way, self.shortcut) {
                Some(path) => Outcome::Found(path),
                None => Outcome::GaveUp("the field ends in a cell that no goal is joined to".into()),
            },
        };
        let size = Size::Grid { cells, sweeps: followed.sweeps };
        Run { outcome, trace: followed.trace, size, note: followed.note }
    }
}

/// Follows attraction and repulsion.
fn follow_forces(grid: &Grid, field: &ForceField, start: usize, goals: &[usize]) -> Followed {
    let heights = (0..grid.blocked.len()).map(|cell| match grid.blocked[cell] {
        true => f64::INFINITY,
        false => field.potential(cell),
    });
    let trace = Trace::Potential { cells: grid.cells, heights: heights.collect() };
    let cells = field.descend(start, goals).map_err(|Trap { cell, value, minimum }| {
        let at = shown(grid, cell);
        match minimum {
            true => format!("the potential has a local minimum at {at}, of value {value:.4e}"),
            false => format!("the forces trap the arm at {at}, where they add up to {value:.4e}"),
        }
    });
    Followed { cells, trace, sweeps: 0, note: None }
}

/// Relaxes and climbs; the reason if there is no field.
fn follow_relaxed(
    space: &ZonedGrid,
    domain: &Domain,
    choice: EquationChoice,
    relaxation: &Relaxation,
    stopping: &Stopping,
    start: usize,
) -> Result<Followed, String> {
    let equation = choice.on(space)?;
    let field = relax(domain, &equation, relaxation, stopping).map_err(|error| error.to_string())?;
    let cells = descend(domain, &field.values, start).map_err(|stuck| {
        format!("{} at {}: {}", what(&stuck), shown(&space.grid, stuck.cell), why(&stuck, &equation, &field))
    });
    let logarithm = |(value, kind): (&f64, &Cell)| match kind {
        Cell::Obstacle => f64::NEG_INFINITY,
        // What is not monotone may fall below the obstacles' zero.
        _ => value.max(0.0).ln(),
    };
    let potential = field.values.iter().zip(domain.kinds()).map(logarithm).collect();
    let note = (!field.converged()).then(|| Note::Unconverged { sweeps: field.sweeps(), change: field.change() });
    let trace = Trace::Field { cells: domain.cells(), potential };
    Ok(Followed { cells, trace, sweeps: field.sweeps(), note })
}

/// What a climb is stuck on.
fn what(stuck: &Stuck) -> &'static str {
    if stuck.flat { "the field is flat" } else { "the field has a local maximum" }
}

/// Why a climb is stuck, as far as that can be told.
fn why(stuck: &Stuck, equation: &Equation, field: &Relaxed) -> String {
    match stuck {
        _ if !equation.is_monotone() => {
            "the equation is not monotone; take upwind differences, or a smaller epsilon".into()
        }
        _ if !field.converged() => format!("it is not converged after {} sweeps", field.sweeps()),
        Stuck { value: 0.0, .. } => "its values are too small for doubles".into(),
        Stuck { value, .. } => format!("values around {value} differ by less than doubles can tell"),
    }
}

fn shown(grid: &Grid, cell: usize) -> String {
    let center = grid.center(cell);
    let [i, j] = [cell / grid.cells[1], cell % grid.cells[1]];
    format!("({:.4}, {:.4}), cell ({i}, {j})", center[0], center[1])
}
