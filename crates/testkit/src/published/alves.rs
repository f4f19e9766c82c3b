//! The counts of S. F. dos Reis Alves, *Trabalho 2 - Campos potenciais*: a robot in a room of 40 m x 20 m, cells of 0.5
//! m, harmonic and oriented fields for three goals.

use super::row::{Claim, Count};
use cplan::field::{
    Boundary, Cell, Difference, Direction, Domain, Equation, Factor, Levels, Measure, Order, Relaxation, RelaxedField,
    Scan, Stopping, relax,
};

/// Numbers of rows and columns: 20 m and 40 m, divided by 0.5 m. Row 0 is the north wall.
const CELLS: [usize; 2] = [40, 80];

/// The stopping rule: a bound for the sum of squared changes in a sweep, and the greatest number of sweeps.
pub const STOPPING: Stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-8, max_sweeps: 1000 };

/// A goal, the direction of arrival, and the published count.
struct Goal {
    name: &'static str,
    /// Position in metres from the middle of the room; the second coordinate points upwards.
    at: [f64; 2],
    /// The vector `v` along rows (downwards) and columns.
    direction: [f64; 2],
    harmonic: usize,
    oriented: usize,
}

/// Goals in the order of the source's figures 7 and 8. In the source, the first component of `v` is upwards: (0, -1) and (-1, 0).
const GOALS: [Goal; 3] = [
    Goal { name: "bin (-19, 2)", at: [-19.0, 2.0], direction: [0.0, -1.0], harmonic: 114, oriented: 424 },
    Goal { name: "object 1 (2, 4)", at: [2.0, 4.0], direction: [0.0, -1.0], harmonic: 104, oriented: 419 },
    Goal { name: "object 2 (9, -7)", at: [9.0, -7.0], direction: [1.0, 0.0], harmonic: 111, oriented: 323 },
];

/// Returns the room with a goal. Outer walls are solid, and cells for which `is_solid` is true (numbered row by row). Row and
/// column of a place follow the source's rule.
fn room(at: [f64; 2], is_solid: &dyn Fn(usize) -> bool) -> Domain {
    let [rows, columns] = CELLS;
    let row = (rows as f64 / 2.0 - at[1] / 0.5) as usize;
    let column = (at[0] / 0.5 + columns as f64 / 2.0) as usize;
    let kind = |cell: usize| {
        let [i, j] = [cell / columns, cell % columns];
        match () {
            () if [i, j] == [row, column] => Cell::Goal,
            () if i == 0 || j == 0 || i == rows - 1 || j == columns - 1 || is_solid(cell) => Cell::Obstacle,
            () => Cell::Free,
        }
    };
    Domain::new(CELLS, (0..rows * columns).map(kind).collect(), [Boundary::High; 2], Levels::PUBLISHED)
}

/// Relaxes the harmonic field of a goal (algorithm 13), if it converges.
pub fn harmonic(at: [f64; 2], is_solid: &dyn Fn(usize) -> bool, stopping: &Stopping) -> Option<RelaxedField> {
    let sor = Relaxation::sor(Factor::Given(1.8), Order::Lines(Scan::ROWS));
    relax(&room(at, is_solid), &Equation::Harmonic, &sor, stopping).ok().filter(RelaxedField::converged)
}

/// Relaxes the oriented field of a goal for a direction (rows downwards, columns), if it converges (algorithm 14).
pub fn oriented(at: [f64; 2], direction: [f64; 2], is_solid: &dyn Fn(usize) -> bool) -> Option<RelaxedField> {
    let direction = Direction::of(direction)?;
    let equation = Equation::Oriented { direction, epsilon: 0.5, difference: Difference::Central };
    let relaxation = Relaxation::gauss_seidel(Order::Lines(Scan::ROWS));
    relax(&room(at, is_solid), &equation, &relaxation, &STOPPING).ok().filter(RelaxedField::converged)
}

/// Returns name and count of every published number, in an empty room.
pub fn rows() -> Vec<(String, Count)> {
    rows_among(&|_| false)
}

/// Returns the same numbers in a room with these solid cells.
pub fn rows_among(is_solid: &dyn Fn(usize) -> bool) -> Vec<(String, Count)> {
    let count = |published: usize, field: Option<RelaxedField>| {
        // The source prints the index of the last sweep, counted from 0.
        Count::of_sweeps(published, field.map(|field| field.sweeps() - 1), Claim::Unmatched)
    };
    let harmonic = GOALS
        .iter()
        .map(|goal| (format!("harmonic, {}", goal.name), count(goal.harmonic, harmonic(goal.at, is_solid, &STOPPING))));
    let oriented = GOALS.iter().map(|goal| {
        (format!("oriented, {}", goal.name), count(goal.oriented, oriented(goal.at, goal.direction, is_solid)))
    });
    harmonic.chain(oriented).collect()
}

/// Notes on which results are reproducible.
pub const NOTES: &[&str] = &[
    "Known: cells, goals, factor 1.8, epsilon 0.5, v, order and stopping rule (the source prints its program). Unknown: the",
    "furniture, which is only in a picture. Without it harmonic fields take 2.15 to 2.23 times, oriented ones 1.22 to 1.23 times",
    "as many sweeps, in the published order of goals. Tried: outer walls moved inwards (best: 11 rows in the north, 5 in the",
    "south, 2 and 8 columns: 114, 112, 113 and 413, 414, 292), which says that there are walls, not where. On the map that the",
    "source's wall follower draws of a furnished room of ours (example mission): 100, 94, 99 and 387, 374, 332.",
];
