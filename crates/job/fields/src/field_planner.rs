//! The planner that follows any of the fields.

use crate::field_choice::{FieldChoice, FieldPlanner};
use crate::{
    Cell, DeadEnd, Device, Domain, Equation, Escape, EscapedMinima, ForceField, ForceGuide, Khatib, Levels, Limits,
    Measure, RelaxError, Relaxation, RelaxedField, Scheme, Stopping, Trap, ValueGuide, relax_from, relax_on,
};
use cplan_harmonic::path_along_field;
use cplan_model::space::{Configuration, Path};
use cplan_planners::cspace::{Grid, ZonedGrid};
use cplan_planners::planner::attach::JoinedQuery;
use cplan_planners::planner::grid_path::Place;
use cplan_planners::planner::{FieldQuantity, Note, PathKind, Planner, Proposal, Query, Run, Size, Trace, grid_path};

/// Default tolerance of relaxation: the relative change of values in a sweep. At this tolerance, directions of ascent no longer
/// change, except in cells with two almost equal directions.
pub const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The result of following a field.
struct FollowResult {
    /// The path, or the reason, in words, why there is none.
    path: Result<Path, String>,
    trace: Trace,
    sweeps: usize,
    note: Option<Note>,
}

impl Planner for FieldPlanner {
    const NAME: &'static str = "harmonic";
    type Space = ZonedGrid;
    type Map = ();

    /// Does nothing, because a field depends on the goals of the query.
    fn build(&self, _: &ZonedGrid) {}

    fn query(&self, space: &ZonedGrid, (): &(), query: &Query) -> Run {
        let grid = &space.grid;
        let nothing =
            || Trace::field(grid.cells, FieldQuantity::Logarithm, vec![f64::NEG_INFINITY; grid.blocked.len()]);
        let ended = |outcome, cells| Run::new(outcome, nothing(), Size::Grid { cells, sweeps: 0 });
        let joined = match JoinedQuery::new(grid, query) {
            Ok(joined) => joined,
            Err(reason) => return ended(Proposal::GaveUp(reason), 0),
        };
        let goals = joined.sources();
        let domain = Domain::of_grid(grid, &goals, self.limits, Levels::PROBABILITY);
        let reached = |&cell: &usize| domain.kinds()[cell] != Cell::Obstacle;
        let cells = domain.kinds().iter().filter(|&&kind| kind != Cell::Obstacle).count();
        // Of the cells that are connected with a goal, the one nearest to the start.
        let Some(start) = joined.start.cells.iter().copied().find(reached) else {
            return ended(Proposal::NoPath, cells);
        };
        let task = FieldQuery { space, query, joined: &joined, start, kind: self.path };
        let followed = match self.field {
            FieldChoice::Khatib(laws) => task.follow_forces(laws, self.escape, &goals, self.limits),
            FieldChoice::Relaxed { equation, relaxation, measure, tolerance, max_sweeps, on, stencil, initial } => {
                let stopping = Stopping { measure, below: tolerance, max_sweeps };
                let domain = domain.with_beta(stencil.beta(grid)).with_initial(initial);
                let equation = match equation.on(space, stencil) {
                    Ok(equation) => equation,
                    Err(reason) => return ended(Proposal::GaveUp(reason), cells),
                };
                match task.follow_relaxed(&domain, &equation, &relaxation, &stopping, on) {
                    Ok(followed) => followed,
                    Err(reason) => return ended(Proposal::GaveUp(reason), cells),
                }
            }
        };
        let outcome = followed.path.map_or_else(Proposal::GaveUp, Proposal::Found);
        let size = Size::Grid { cells, sweeps: followed.sweeps };
        Run { outcome, trace: followed.trace, size, note: followed.note }
    }
}

/// Returns the domain of a field for a query: the kind of each cell, and the levels of [`FieldPlanner`]. `O(cells)`.
///
/// # Errors
/// No free cell near the start or a goal, as a reason in words.
pub fn field_domain(grid: &Grid, query: &Query, limits: Limits) -> Result<Domain, String> {
    let goals = JoinedQuery::new(grid, query)?.sources();
    Ok(Domain::of_grid(grid, &goals, limits, Levels::PROBABILITY))
}

/// A path query on a field.
struct FieldQuery<'a> {
    space: &'a ZonedGrid,
    query: &'a Query,
    joined: &'a JoinedQuery,
    /// Index of the cell to which the start is joined: its own, or a free cell near it.
    start: usize,
    kind: PathKind,
}

impl FieldQuery<'_> {
    /// Follows the forces of attraction and repulsion.
    fn follow_forces(&self, laws: Khatib, escape: Option<Escape>, goals: &[usize], limits: Limits) -> FollowResult {
        let grid = &self.space.grid;
        let centers: Vec<Configuration> = goals.iter().map(|&cell| grid.center(cell)).collect();
        let field = ForceField::new(grid, laws, &centers, limits);
        let heights = (0..grid.blocked.len()).map(|cell| match grid.blocked[cell] {
            true => f64::INFINITY,
            false => field.potential(cell),
        });
        let trace = Trace::field(grid.cells, FieldQuantity::Height, heights.collect::<Vec<_>>());
        let at = |place: Place| grid_path::cell(grid, place).filter(|&cell| !grid.blocked[cell]);
        let mut guide = ForceGuide::new(&field, goals, at).with_escape(escape);
        let path = path_along_field(grid, self.query, self.joined, &mut guide, self.start, self.kind);
        let path = path.map_err(|Trap { cell, value, minimum }| {
            let at = format_cell(grid, cell);
            match minimum {
                true => format!(
                    "the potential has a local minimum of {value:.4e} at {at}{}",
                    describe_failed_escape(escape)
                ),
                false => format!("the forces trap the arm at {at}; their sum there is {value:.4e}"),
            }
        });
        let EscapedMinima { minima, moves } = guide.escaped();
        let note = escape.filter(|_| minima > 0).map(|by| Note::Escaped { how: by.description(), minima, moves });
        FollowResult { path, trace, sweeps: 0, note }
    }

    /// Relaxes an equation and climbs the field. Returns the reason, in words, if there is no field.
    fn follow_relaxed(
        &self,
        domain: &Domain,
        equation: &Equation,
        relaxation: &Relaxation,
        stopping: &Stopping,
        on: Device,
    ) -> Result<FollowResult, String> {
        let grid = &self.space.grid;
        let climb = |field: &RelaxedField| {
            let mut guide = ValueGuide::new(domain, &field.values, |place: Place| grid_path::cell(grid, place));
            path_along_field(grid, self.query, self.joined, &mut guide, self.start, self.kind)
        };
        let refused = |error: RelaxError| error.to_string();
        let mut field = relax_on(on, domain, equation, relaxation, stopping).map_err(refused)?;
        let (mut path, mut note) = (climb(&field), None);
        if path.is_err() && field.converged() && !stopping.measure.is_relative() && on.is_cpu() {
            // The measure hardly notices small values, as around a start far from the goal.
            let first = field.sweeps();
            let finely = Stopping { measure: Measure::GreatestRelativeChange, below: RELATIVE_TOLERANCE, ..*stopping };
            field = relax_from(domain, equation, relaxation, &finely, field.values).map_err(refused)?;
            (path, note) = (climb(&field), Some(Note::Continued { first, more: field.sweeps() }));
        }
        let logarithm = |(value, kind): (&f64, &Cell)| match kind {
            Cell::Obstacle => f64::NEG_INFINITY,
            // If the equation is not monotone, a value may be below 0, the level of obstacles.
            _ => value.max(0.0).ln(),
        };
        let potential: Vec<f64> = field.values.iter().zip(domain.kinds()).map(logarithm).collect();
        let (sweeps, change) = (field.sweeps(), field.change());
        if !field.converged() {
            // On a GPU, a stage that ends early cannot improve in single precision.
            note = Some(match field.stages.iter().all(|stage| stage.sweeps < stopping.max_sweeps) {
                true => Note::Floor { sweeps, change },
                false => Note::Unconverged { sweeps, change },
            });
        }
        let path = match (path, note) {
            // A path through an unfinished field would not be a path of the requested field.
            (_, Some(Note::Unconverged { .. })) => Err(describe_unconverged(domain, equation, relaxation, sweeps)),
            (path, _) => path.map_err(|stuck| {
                format!(
                    "{} at {}: {}",
                    describe_dead_end(&stuck),
                    format_cell(grid, stuck.cell),
                    explain_dead_end(&stuck, domain, equation, on)
                )
            }),
        };
        let earlier = if let Some(Note::Continued { first, .. }) = note { first } else { 0 };
        let trace = Trace::field(domain.cells(), FieldQuantity::Logarithm, potential);
        Ok(FollowResult { path, trace, sweeps: earlier + sweeps, note })
    }
}

/// Returns the addition to a message that the escape from a local minimum failed.
fn describe_failed_escape(escape: Option<Escape>) -> &'static str {
    match escape {
        None => "",
        Some(Escape::Walk { .. }) => "; no random walk from there led to a lower cell",
        Some(Escape::Wave) => "; no lower cell can be reached from there",
    }
}

/// Describes the place at which the path along a field is stuck.
fn describe_dead_end(stuck: &DeadEnd) -> &'static str {
    if stuck.flat { "the field is flat" } else { "the field has a local maximum" }
}

/// Returns the explanation that an equation is not monotone, with a hint.
fn not_monotone(equation: &Equation) -> String {
    match equation {
        Equation::AlteredPreference { .. } => "the equation is not monotone; take a smaller epsilon".into(),
        _ => "the equation is not monotone; take upwind differences, or a smaller epsilon".into(),
    }
}

/// Describes a relaxation that reached its largest number of sweeps, with a hint.
fn describe_unconverged(domain: &Domain, equation: &Equation, relaxation: &Relaxation, sweeps: usize) -> String {
    let factor = relaxation.factor(domain.cells());
    let hint = match relaxation.scheme {
        _ if !equation.is_monotone_on(domain) => not_monotone(equation),
        Scheme::Successive { .. } if factor > 1.0 && equation.has_preferences() && relaxation.relaxes_preferences => {
            "the factor also multiplies the preferences; leave out --relax-preferences, or take a smaller factor".into()
        }
        Scheme::Successive { .. } if factor > 1.0 => {
            format!("allow more sweeps or a larger tolerance, or take a factor below {factor:.4}")
        }
        _ => "allow more sweeps or a larger tolerance, or use the relaxation sor".into(),
    };
    format!("the field is not converged after {sweeps} sweeps: {hint}")
}

/// Explains why the path along a field is stuck, as far as that is known.
fn explain_dead_end(stuck: &DeadEnd, domain: &Domain, equation: &Equation, on: Device) -> String {
    match stuck {
        _ if !equation.is_monotone_on(domain) => not_monotone(equation),
        DeadEnd { value: 0.0, .. } => format!("the values of the field are too small for {}", on.precision()),
        DeadEnd { value, .. } => format!(
            "the values around {value} differ so little that {} cannot represent the differences",
            on.precision()
        ),
    }
}

fn format_cell(grid: &Grid, cell: usize) -> String {
    let center = grid.center(cell);
    let [i, j] = [cell / grid.cells[1], cell % grid.cells[1]];
    format!("({:.4}, {:.4}), cell ({i}, {j})", center[0], center[1])
}
