//! A field among obstacles that move, which robots share.

use super::relax::{Memory, by_multigrid_in};
use super::{
    Boundary, Cell, Convergence, Difference, Domain, Equation, Influence, Levels, Measure, RelaxError, Relaxation,
    Slope, Stopping, Stuck, around, relax_from,
};
use cplan_harmonic::{LatticePoint, Place, Streamline, advance, direction, follow};
use std::f64::consts::FRAC_1_SQRT_2;

/// Cells are squares.
const SIDES: [f64; 2] = [1.0; 2];

/// A disc of cells: those whose centres lie nearer to its own than its radius, in cells. It does not go round circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its centre, as (fractions of) row and column; whole numbers are centres of cells.
    pub center: LatticePoint,
    /// Its radius, in cells.
    pub radius: f64,
}

impl Disc {
    /// The disc that the centre of a disc of radius `own` keeps out of, so as not to touch this one: grown by `own`, and by half a
    /// cell's diagonal, since a centre may be anywhere in a free cell.
    #[must_use]
    pub fn grown_for(self, own: f64) -> Self {
        Self { radius: self.radius + own + FRAC_1_SQRT_2, ..self }
    }

    /// The cells whose centres lie in it.
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

/// What there is at one moment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Moment {
    /// Obstacles that move: of several robots the others. They are as large as one says ([`Disc::grown_for`]).
    pub obstacles: Vec<Disc>,
    /// Where to go: the cells of these discs that are no obstacles. One whose cells are all covered is no goal now.
    pub goals: Vec<Disc>,
    /// The robots that follow the field, each with a disc in which its own drift holds; of several the nearest robot's. With an
    /// infinite radius and one robot the drift holds everywhere; without robots the field is harmonic.
    pub robots: Vec<Influence>,
}

/// How a field is found from that of the moment before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solver {
    /// Sweep by sweep, as the literature does.
    Relaxation(Relaxation),
    /// By [`by_multigrid`](super::by_multigrid).
    Multigrid,
}

/// A field among obstacles that move, found anew each moment from that of the moment before: the locally oriented field that robots
/// share, `lap p + <b, grad p> = 0` with the drift `b = epsilon v` of the nearest robot within its disc and 0 elsewhere; with one
/// robot an oriented field, with none a harmonic one (Faria 2006; Oliveira da Silva 2011, section 3.4). Obstacles have the value 1,
/// goals 0; robots that follow it are no obstacles in it, or nobody could tell where they are to go.
///
/// A moment costs one look at the cells about each disc, some nanoseconds a cell for the weights, and what its [`Solver`] costs.
/// While the equation is monotone and the rule for stopping is strict, each free cell that a goal can be reached from leads to
/// one; with a loose rule, such as the literature's `1e-6`, values far from what has moved may be those of moments ago.
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
    /// That of the last moment.
    domain: Domain,
    /// One a cell.
    values: Vec<f64>,
    memory: Memory,
}

impl MovingField {
    /// In so many rows and columns of cells, some of which are walls for ever, row by row; what is beyond the limits is the same for ever, too.
    /// Values before the first moment are those of goals, as in the literature.
    ///
    /// # Errors
    /// Where there is not one flag a cell, or there are `2^32` cells or more.
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

    /// The field of the next moment, by sweeps or steps until the sum of their squared changes is less than `below`, `most` of them at
    /// the most: [`Convergence`] says how many there were.
    ///
    /// # Errors
    /// Those of [`relax_from`] and [`by_multigrid`](super::by_multigrid), and where a number of the moment is no number; the field is then as it was.
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

    /// What each cell is at a moment.
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

    /// What each cell is at the last moment, before the first one without anything that moves.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// One a cell.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    fn guide(&self) -> Slope<'_, impl Fn(Place) -> Option<usize>> {
        Slope::new(&self.domain, &self.values, |place| self.domain.cell_at(place))
    }

    /// Where the field leads from a point, as a unit vector: see [`direction()`]. None in obstacles and goals, and where the field is
    /// level, as where no goal can be reached.
    #[must_use]
    pub fn direction(&self, at: LatticePoint) -> Option<[f64; 2]> {
        direction(&self.guide(), SIDES, at)
    }

    /// Where one comes to from a point in so many steps of [`STEP`](cplan_harmonic::STEP): see [`advance()`]. All of them lie in free cells and goals.
    #[must_use]
    pub fn advance(&self, from: LatticePoint, steps: usize) -> LatticePoint {
        advance(&self.guide(), SIDES, from, steps)
    }

    /// The curve to the goal as things are at the last moment: see [`follow()`].
    ///
    /// # Errors
    /// [`Stuck`] where there is no way on: no goal can be reached, or the field has not converged.
    ///
    /// # Panics
    /// If the point lies in no cell.
    pub fn follow(&self, from: LatticePoint) -> Result<Streamline, Stuck> {
        follow(&mut self.guide(), SIDES, from)
    }
}
