//! A field among obstacles that move, which robots share.

use super::relax::{Memory, by_multigrid_in};
use super::{
    Boundary, Cell, Convergence, DeadEnd, Difference, Domain, Equation, Influence, Levels, Measure, RelaxError,
    Relaxation, Stopping, ValueGuide, around, relax_from,
};
use cplan_harmonic::{LatticePoint, Place, Streamline, advance, direction, follow};
use std::f64::consts::FRAC_1_SQRT_2;

/// Cells are squares.
const SQUARE_SIDES: [f64; 2] = [1.0; 2];

/// A disc of cells: those whose centres are closer to its centre than its radius, in cells. It does not wrap around
/// circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre, as (fractional) row and column. Integers are centres of cells.
    pub center: LatticePoint,
    /// Radius, in cells.
    pub radius: f64,
}

impl Disc {
    /// Returns the disc that the centre of a disc of radius `own` must avoid in order not to touch this one. It is
    /// grown by `own`, and by half a cell's diagonal, because a centre may be anywhere in a free cell.
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
    /// Obstacles that move: of several robots the others. They are as large as one says ([`Disc::grown_for`]).
    pub obstacles: Vec<Disc>,
    /// Goal discs: their cells, except obstacles. A disc whose cells are all covered is not a goal at this moment.
    pub goals: Vec<Disc>,
    /// The robots that follow the field, each with a disc in which its own drift holds; of several the nearest robot's. With an
    /// infinite radius and one robot the drift holds everywhere; without robots the field is harmonic.
    pub robots: Vec<Influence>,
}

/// Method for computing a field from that of the previous moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solver {
    /// Sweep by sweep, as the literature does.
    Relaxation(Relaxation),
    /// Multigrid, by [`by_multigrid`](super::by_multigrid).
    Multigrid,
}

/// A field among moving obstacles, computed at each moment from that of the previous one.
///
/// It is the locally oriented field that robots share: `lap p + <b, grad p> = 0` with the drift `b = epsilon v` of the
/// nearest robot within its disc, and 0 elsewhere. With one robot it is an oriented field, without robots a harmonic
/// one (Faria 2006; Oliveira da Silva 2011, section 3.4). Obstacles have the value 1, goals 0. Robots that follow the
/// field are not obstacles in it, because they could not leave their own cells.
///
/// A moment costs one pass over the cells around each disc, a few nanoseconds per cell for the weights, and the cost of
/// its [`Solver`]. If the equation is monotone and the stopping rule strict, every free cell from which a goal is
/// reachable leads to one. With a loose rule, such as the `1e-6` of the literature, values far from a change may be out
/// of date.
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
    /// Creates a field on rows and columns of cells. `walls`, row by row, are permanent, and so is the boundary
    /// condition. Before the first moment all values are those of goals, as in the literature.
    ///
    /// # Errors
    /// If there is not one flag per cell, or there are `2^32` cells or more.
    pub fn new(
        cells: [usize; 2],
        walls: Vec<bool>,
        boundaries: [Boundary; 2],
        difference: Difference,
    ) -> Result<Self, RelaxError> {
        if cells[0].checked_mul(cells[1]) != Some(walls.len()) || u32::try_from(walls.len()).is_err() {
            let [rows, columns] = cells;
            let count = walls.len();
            return Err(RelaxError::Refused(format!("{rows} x {columns} cells need one flag each, not {count}")));
        }
        let kinds = walls.iter().map(|&wall| if wall { Cell::Obstacle } else { Cell::Free }).collect();
        let domain = Domain::new(cells, kinds, boundaries, Levels::PUBLISHED);
        Ok(Self { walls, difference, values: domain.start(), domain, memory: Memory::default() })
    }

    /// Computes the field of the next moment, by sweeps or steps until the sum of their squared changes is less than
    /// `below`, or their number reaches `most`. [`Convergence`] has the number.
    ///
    /// # Errors
    /// The errors of [`relax_from`] and [`by_multigrid`](super::by_multigrid), and NaN in the moment. The field is then
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
            return Err(RelaxError::Refused("centres of discs are finite, and a radius is a number".into()));
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
            robots => Equation::LocallyOriented { drift: around(domain, robots), difference: self.difference },
        }
    }

    /// Returns the domain at the last moment. Before the first moment it has only the permanent walls.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns one value per cell.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    fn guide(&self) -> ValueGuide<'_, impl Fn(Place) -> Option<usize>> {
        ValueGuide::new(&self.domain, &self.values, |place| self.domain.cell_at(place))
    }

    /// Returns the unit direction in which the field leads from a point: see [`direction()`]. Returns `None` in
    /// obstacles and goals, and where the field is level, as in regions from which no goal is reachable.
    #[must_use]
    pub fn direction(&self, at: LatticePoint) -> Option<[f64; 2]> {
        direction(&self.guide(), SQUARE_SIDES, at)
    }

    /// Returns the end of this many steps of [`STEP_LENGTH`](cplan_harmonic::STEP_LENGTH) from a point: see [`advance()`]. All lie in
    /// free cells and goals.
    #[must_use]
    pub fn advance(&self, from: LatticePoint, steps: usize) -> LatticePoint {
        advance(&self.guide(), SQUARE_SIDES, from, steps)
    }

    /// Returns the curve to the goal in the field of the last moment: see [`follow()`].
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
