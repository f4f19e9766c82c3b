//! A field among moving obstacles, which several robots share.

use super::relax::{Memory, by_multigrid_in};
use super::{
    Boundary, Cell, Convergence, DeadEnd, Difference, Domain, Equation, Influence, Levels, Measure, RelaxError,
    Relaxation, Stopping, ValueGuide, drift_around_robots, relax_from,
};
use cplan_harmonic::follow::{LatticePoint, Streamline, advance, direction, follow};
use cplan_planners::planner::grid_path::Place;
use std::f64::consts::FRAC_1_SQRT_2;

/// Side lengths of cells, which are squares.
const SQUARE_SIDES: [f64; 2] = [1.0; 2];

/// A disc of cells: those whose centres are closer to the disc's centre than its radius. It does not extend across the seams of
/// continuous joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre as row and column, which may be fractions. Whole numbers are the centres of cells.
    pub center: LatticePoint,
    /// Radius, in cells.
    pub radius: f64,
}

impl Disc {
    /// Returns the disc that the centre of another disc, of radius `own`, must avoid so that the discs do not touch. It is this
    /// disc, grown by `own` and by half the diagonal of a cell, because the other centre may be anywhere in a free cell.
    #[must_use]
    pub fn grown_for(self, own: f64) -> Self {
        Self { radius: self.radius + own + FRAC_1_SQRT_2, ..self }
    }

    /// Iterates over the cells whose centres lie in the disc.
    fn cells(self, [rows, columns]: [usize; 2]) -> impl Iterator<Item = usize> {
        let Self { center, radius } = self;
        let near = move |axis: usize, count: usize| {
            let [from, to] = [(center[axis] - radius).ceil(), (center[axis] + radius).floor() + 1.0];
            from.max(0.0) as usize..(to.max(0.0) as usize).min(if radius > 0.0 { count } else { 0 })
        };
        near(0, rows).flat_map(move |row| {
            let across = (row as f64 - center[0]).powi(2);
            let inside = move |column: &usize| across + (*column as f64 - center[1]).powi(2) < radius.powi(2);
            near(1, columns).filter(inside).map(move |column| row * columns + column)
        })
    }
}

/// The obstacles, goals and robots at one moment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Moment {
    /// Moving obstacles, such as other robots, which block the cells of these discs. The caller must grow the discs by the size
    /// of the robot that follows the field ([`Disc::grown_for`]).
    pub obstacles: Vec<Disc>,
    /// Goal discs. Their cells are goals, except those that obstacles cover.
    pub goals: Vec<Disc>,
    /// The robots that follow the field, each with a disc and a drift. A cell has the drift of the nearest robot if it is in that
    /// robot's disc, otherwise no drift. With one robot of infinite radius, its drift holds everywhere. Without robots, the field
    /// is harmonic.
    pub robots: Vec<Influence>,
}

/// Method that computes a field from that of the previous moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solver {
    /// Relaxation, sweep by sweep, as in the literature.
    Relaxation(Relaxation),
    /// Multigrid, by [`by_multigrid`](super::by_multigrid).
    Multigrid,
}

/// A field among moving obstacles. The field of each moment is computed from that of the previous one.
///
/// It is the locally oriented field that robots share: `lap p + <b, grad p> = 0`. The drift `b = epsilon v` of a cell is that of
/// the nearest robot if the cell is in the robot's disc, and 0 otherwise. With one robot this is an oriented field, and without
/// robots a harmonic one (Faria 2006; Oliveira da Silva 2011, section 3.4). Obstacles have the value 1, goals 0. Robots that
/// follow the field are not obstacles in it, or they could not leave their own cells.
///
/// A moment costs one pass over the cells around each disc, a few nanoseconds per cell for the weights, and the cost of the
/// [`Solver`]. If the equation is monotone and the stopping rule strict, the field leads to a goal from every free cell that is
/// connected with one. With a loose rule, such as the `1e-6` of the literature, values far from a change may be out of date.
///
/// ```
/// use cplan_fields::*;
///
/// // A room of 20 x 30 cells, a robot that is to arrive from the left, and another one in its way.
/// let mut field = MovingField::new([20, 30], vec![false; 600], [Boundary::High; 2], Difference::Upwind)?;
/// let towards = Direction::of([0.0, 1.0]).expect("a vector with a length");
/// for step in 0..5 {
///     let moment = Moment {
///         obstacles: vec![Disc { center: [9.0 + f64::from(step), 15.0], radius: 3.0 }],
///         goals: vec![Disc { center: [10.0, 25.0], radius: 1.0 }],
///         robots: vec![Influence { center: [10.0, 4.0], radius: 6.0, drift: towards.drift(0.5) }],
///     };
///     let done = field.next(&moment, &Solver::Multigrid, 1e-16, 100)?;
///     assert!(done.converged);
/// }
/// let way = field.follow([10.0, 4.0]).expect("a goal that can be reached");
/// assert_eq!(field.domain().cell_at(way.place), Some(10 * 30 + 25));
/// assert!(field.direction([10.0, 4.0]).is_some_and(|[_, right]| right > 0.5));
/// # Ok::<(), RelaxError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MovingField {
    walls: Vec<bool>,
    difference: Difference,
    /// The domain of the last moment.
    domain: Domain,
    /// One value per cell.
    values: Vec<f64>,
    memory: Memory,
}

impl MovingField {
    /// Creates a field on rows and columns of cells. `walls` has a flag per cell, row by row, which is true for permanent
    /// obstacles. Before the first moment, all cells have the value of goals, as in the literature.
    ///
    /// # Errors
    /// A wrong number of flags, and `2^32` cells or more.
    pub fn new(
        cells: [usize; 2],
        walls: Vec<bool>,
        boundaries: [Boundary; 2],
        difference: Difference,
    ) -> Result<Self, RelaxError> {
        if cells[0].checked_mul(cells[1]) != Some(walls.len()) || u32::try_from(walls.len()).is_err() {
            let [rows, columns] = cells;
            let count = walls.len();
            return Err(RelaxError::Refused(format!(
                "{count} flags are given for {rows} x {columns} cells; each cell needs one"
            )));
        }
        let kinds = walls.iter().map(|&wall| if wall { Cell::Obstacle } else { Cell::Free }).collect();
        let domain = Domain::new(cells, kinds, boundaries, Levels::PUBLISHED);
        Ok(Self { walls, difference, values: domain.start(), domain, memory: Memory::default() })
    }

    /// Computes the field of the next moment. The solver ends when the sum of squared changes is below `below`, or after `most`
    /// sweeps or steps, whose number is in the result.
    ///
    /// # Errors
    /// Those of [`relax_from`] and [`by_multigrid`](super::by_multigrid), and a moment that contains NaN, which leaves the field
    /// unchanged.
    pub fn next(
        &mut self,
        moment: &Moment,
        solver: &Solver,
        below: f64,
        most: usize,
    ) -> Result<Convergence, RelaxError> {
        let domain = self.domain_of(moment)?;
        let equation = self.equation_on(&domain, moment);
        let stopping = Stopping { measure: Measure::SumOfSquares, below, max_sweeps: most };
        let start = self.values.clone();
        let field = match solver {
            Solver::Relaxation(relaxation) => relax_from(&domain, &equation, relaxation, &stopping, start),
            Solver::Multigrid => by_multigrid_in(&domain, &equation, &stopping, start, &mut self.memory),
        }?;
        (self.domain, self.values) = (domain, field.values);
        Ok(field.stages[0])
    }

    /// Returns the kind of each cell at a moment.
    fn domain_of(&self, moment: &Moment) -> Result<Domain, RelaxError> {
        let discs = moment.obstacles.iter().chain(&moment.goals).map(|disc| (disc.center, disc.radius));
        let mut numbers = discs.chain(moment.robots.iter().map(|robot| (robot.center, robot.radius)));
        if numbers.any(|(center, radius)| center.iter().any(|x| !x.is_finite()) || radius.is_nan()) {
            return Err(RelaxError::Refused("centres of discs must be finite, and radii must be numbers".into()));
        }
        let kind = |&wall: &bool| if wall { Cell::Obstacle } else { Cell::Free };
        let mut kinds: Vec<Cell> = self.walls.iter().map(kind).collect();
        let cells = self.domain.cells();
        for disc in &moment.obstacles {
            disc.cells(cells).for_each(|cell| kinds[cell] = Cell::Obstacle);
        }
        for cell in moment.goals.iter().flat_map(|disc| disc.cells(cells)) {
            if kinds[cell] == Cell::Free {
                kinds[cell] = Cell::Goal;
            }
        }
        Ok(Domain::new(self.domain.cells(), kinds, self.domain.boundaries(), self.domain.levels()))
    }

    fn equation_on(&self, domain: &Domain, moment: &Moment) -> Equation {
        match moment.robots.as_slice() {
            [] => Equation::Harmonic,
            robots => {
                Equation::LocallyOriented { drift: drift_around_robots(domain, robots), difference: self.difference }
            }
        }
    }

    /// Returns the domain at the last moment. Before the first moment, it has only the permanent walls.
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns one value per cell.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    fn guide(&self) -> ValueGuide<'_, impl Fn(Place) -> Option<usize>> {
        ValueGuide::new(&self.domain, &self.values, |place| self.domain.cell_at(place))
    }

    /// Returns the unit direction in which the field leads from a point: see [`direction()`]. `None` in obstacles and goals, and
    /// where the field is level, as in regions from which no goal is reachable.
    pub fn direction(&self, at: LatticePoint) -> Option<[f64; 2]> {
        direction(&self.guide(), SQUARE_SIDES, at)
    }

    /// Follows the field from a point for this many steps of length [`STEP_LENGTH`](cplan_harmonic::follow::STEP_LENGTH), and
    /// returns the last point; see [`advance()`]. All points are in free cells or goals.
    pub fn advance(&self, from: LatticePoint, steps: usize) -> LatticePoint {
        advance(&self.guide(), SQUARE_SIDES, from, steps)
    }

    /// Returns the curve from a point to a goal in the field of the last moment; see [`follow()`].
    ///
    /// # Errors
    /// [`DeadEnd`] if no goal is reachable, or the field has not converged.
    ///
    /// # Panics
    /// If the point lies in no cell.
    pub fn follow(&self, from: LatticePoint) -> Result<Streamline, DeadEnd> {
        follow(&mut self.guide(), SQUARE_SIDES, from)
    }
}
