//! Tables 6.3 to 6.17 of M. Oliveira da Silva, *Campos potenciais modificados aplicados ao controle de múltiplos robôs*
//! (ICMC-USP, São Carlos 2011): mean sweeps per state of robot soccer. Each field is relaxed from that of the previous state.
//!
//! The five minutes of play that the source measured are not published. This module rebuilds the field (IEEE Very Small Size: 150
//! cm x 130 cm and goals 10 cm deep, which are 85 x 65 cells of 2 cm), but its robots, three on each side, and its ball move
//! along our own curves. So the counts can be compared with one another, but not with those of the source.

use super::row::{Claim, Count};
use cplan::field::{
    Boundary, Cell, Difference, Direction, Domain, Equation, Factor, Influence, Levels, Measure, Order, Relaxation,
    Scan, Stopping, drift_around_robots, relax_from,
};
use std::f64::consts::TAU;

/// Number of cells along the field, over which the source's outer loop runs, and number of cells across it.
const CELLS: [usize; 2] = [85, 65];
/// Depth of a goal, in cells.
const DEPTH: usize = 5;
/// Range of cells of a goal's mouth, across the field (40 cm).
const MOUTH: std::ops::Range<usize> = 22..42;
/// Number of states of play per second.
const RATE: f64 = 30.0;
/// Number of measured states, after one that starts from the initial field.
const STATES: usize = 300;
/// Strength of the drift (`EPSILON`), and the radius of its influence in cells if it is local.
const EPSILON: f64 = 0.5;
const RADIUS: f64 = 10.0;

/// The sum of squared changes in a sweep must fall below this.
pub const STOPPING: Stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-6, max_sweeps: 5000 };

/// The curves on which objects move: three robots of our team, three of the other team, and the ball. Each has a
/// middle, an amplitude, and periods in seconds.
const CURVES: [([f64; 2], [f64; 2], [f64; 2]); 7] = [
    ([15.0, 32.0], [4.0, 8.0], [7.0, 5.0]),
    ([35.0, 20.0], [14.0, 10.0], [9.0, 6.0]),
    ([35.0, 45.0], [14.0, 10.0], [8.0, 7.0]),
    ([69.0, 32.0], [4.0, 8.0], [6.0, 5.0]),
    ([52.0, 18.0], [13.0, 9.0], [7.0, 9.0]),
    ([52.0, 47.0], [13.0, 9.0], [10.0, 6.0]),
    ([42.0, 32.0], [30.0, 24.0], [8.0, 5.0]),
];

/// Returns the position on curve `k` of [`CURVES`], in cells.
fn place(k: usize, seconds: f64) -> [f64; 2] {
    let (middle, reach, periods) = CURVES[k];
    // Each curve has its own phase, so that not all objects are in the middle at once.
    [0, 1].map(|axis| middle[axis] + reach[axis] * (TAU * (seconds / periods[axis] + 0.3 * k as f64)).sin())
}

/// Returns the domain of the robot that plans. The other five robots are obstacles with a radius of 8 cm, and the ball
/// is the goal.
pub fn state(seconds: f64) -> Domain {
    let [length, width] = CELLS;
    let mut kinds = vec![Cell::Free; length * width];
    for x in (0..DEPTH).chain(length - DEPTH..length) {
        for y in (0..width).filter(|y| !MOUTH.contains(y)) {
            kinds[x * width + y] = Cell::Obstacle;
        }
    }
    for robot in 1..6 {
        let [x, y] = place(robot, seconds).map(|at| at as usize);
        for x in x - 2..x + 2 {
            kinds[x * width + y - 2..x * width + y + 2].fill(Cell::Obstacle);
        }
    }
    let [x, y] = place(6, seconds).map(|at| at as usize);
    kinds[x * width + y] = Cell::Goal;
    Domain::new(CELLS, kinds, [Boundary::High; 2], Levels::PUBLISHED)
}

/// The three fields of the source. Their drifts point along the field of play.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// Laplace's equation.
    Harmonic,
    /// The same drift in all cells.
    Oriented(Difference),
    /// A drift around each of our robots.
    LocallyOriented(Difference),
}

impl Kind {
    /// Returns the equation for a state of play.
    pub fn equation(self, domain: &Domain, seconds: f64) -> Option<Equation> {
        let direction = Direction::of([1.0, 0.0])?;
        Some(match self {
            Self::Harmonic => Equation::Harmonic,
            Self::Oriented(difference) => Equation::Oriented { direction, epsilon: EPSILON, difference },
            Self::LocallyOriented(difference) => {
                let drift = direction.drift(EPSILON);
                let influences =
                    [0, 1, 2].map(|robot| Influence { center: place(robot, seconds), radius: RADIUS, drift });
                Equation::LocallyOriented { drift: drift_around_robots(domain, &influences), difference }
            }
        })
    }
}

/// Returns the mean number of sweeps per state. `None` if a state diverges.
fn mean_sweeps(kind: Kind, relaxation: &Relaxation) -> Option<f64> {
    let mut values = state(0.0).start();
    let mut total = 0;
    for frame in 0..=STATES {
        let seconds = frame as f64 / RATE;
        let domain = state(seconds);
        let equation = kind.equation(&domain, seconds)?;
        let field = relax_from(&domain, &equation, relaxation, &STOPPING, values).ok()?;
        if !field.converged() {
            return None;
        }
        total += if frame == 0 { 0 } else { field.sweeps() };
        values = field.values;
    }
    Some(total as f64 / STATES as f64)
}

/// A table of numbers of sweeps. `published` has the numbers of JR and WJR in parallel, then those of GS and SOR in sequence and
/// in parallel.
pub struct Table {
    /// Number of the table, and its field.
    pub title: &'static str,
    kind: Kind,
    /// Factors of SOR, in sequence and in parallel.
    factors: [f64; 2],
    published: [f64; 6],
}

/// The source's factor for weighted Jacobi.
const WEIGHT: f64 = 1.8;

/// Returns name and count of each published number.
pub fn rows(table: &Table) -> Vec<(String, Count)> {
    let rows = Order::Lines(Scan::ROWS);
    let [sequential, parallel] = table.factors.map(Factor::Given);
    // The order red-black represents the source's parallel sweeps.
    let relaxations = [
        Relaxation::JACOBI,
        Relaxation::weighted_jacobi(WEIGHT),
        Relaxation::gauss_seidel(rows),
        Relaxation::sor(sequential, rows),
        Relaxation::gauss_seidel(Order::RedBlack),
        Relaxation::sor(parallel, Order::RedBlack),
    ];
    let count = |(relaxation, &published): (&Relaxation, &f64)| {
        let measured = mean_sweeps(table.kind, relaxation);
        (relaxation.to_string(), Count { published, measured, claim: Claim::Unmatched })
    };
    relaxations.iter().zip(&table.published).map(count).collect()
}

/// Notes on which results can be compared.
pub const NOTES: &[&str] = &[
    "Unmatched throughout: the play is ours, and the faster it is the more sweeps a state takes. What the source says of its own",
    "holds here as well: Jacobi takes most sweeps; red-black takes as many as row by row; SOR with the source's factor takes",
    "fewer than GS, but for oriented fields by central differences, where 1.9 is too much. Weighted Jacobi with a factor of 1.8",
    "diverges: it must be weighted otherwise there. In Table 6.14 the mean of sequential GS, 20.43, is outside its own interval.",
    "Tables 6.3, 6.4, 6.6, 6.7, 6.9, 6.10, 6.12, 6.13, 6.15 and 6.16 are times and speedups on a CPU of 2009 and a GPU of 2010.",
];

/// The tables of sweeps.
pub const TABLES: [Table; 5] = [
    Table {
        title: "Table 6.5: harmonic",
        kind: Kind::Harmonic,
        factors: [1.9, 1.9],
        published: [32.57, 24.16, 19.40, 17.65, 19.44, 15.50],
    },
    Table {
        title: "Table 6.8: oriented, central differences",
        kind: Kind::Oriented(Difference::Central),
        factors: [1.9, 1.9],
        published: [34.35, 29.51, 17.17, 16.41, 10.96, 13.62],
    },
    Table {
        title: "Table 6.11: oriented, upwind differences",
        kind: Kind::Oriented(Difference::Upwind),
        factors: [1.5, 1.5],
        published: [34.96, 29.93, 23.54, 16.34, 22.08, 13.62],
    },
    Table {
        title: "Table 6.14: locally oriented, central differences",
        kind: Kind::LocallyOriented(Difference::Central),
        factors: [1.8, 1.8],
        published: [49.13, 40.78, 20.43, 20.52, 32.46, 18.32],
    },
    Table {
        title: "Table 6.17: locally oriented, upwind differences",
        kind: Kind::LocallyOriented(Difference::Upwind),
        factors: [1.7, 1.9],
        published: [49.13, 40.78, 28.44, 17.16, 27.42, 21.30],
    },
];
