//! The fast solver against solvers that share no code with it: dense elimination, relaxation, closed forms.

use cplan::field::multigrid::{Ends, Multigrid};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Row and column of the neighbour `step` further, if there is one; on a reflecting limit, the cell itself.
fn neighbor(at: usize, step: isize, cells: usize, ends: Ends) -> Option<usize> {
    let to = at as isize + step;
    if (0..cells as isize).contains(&to) {
        return Some(to as usize);
    }
    match ends {
        Ends::High => None,
        Ends::Reflecting => Some(at),
        Ends::Joined => Some(to.rem_euclid(cells as isize) as usize),
    }
}

/// For each cell the four places around it.
fn around(cells: [usize; 2], ends: [Ends; 2]) -> Vec<[Option<usize>; 4]> {
    let [rows, columns] = cells;
    let mut all = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let row = |step| neighbor(i, step, rows, ends[0]).map(|i| i * columns + j);
            let column = |step| neighbor(j, step, columns, ends[1]).map(|j| i * columns + j);
            all.push([row(-1), row(1), column(-1), column(1)]);
        }
    }
    all
}

/// The matrix, cell by cell. Walls have the row of the identity.
fn dense(cells: [usize; 2], ends: [Ends; 2], free: &[bool], shift: f64) -> DMatrix<f64> {
    let mut matrix = DMatrix::identity(free.len(), free.len());
    for (cell, around) in around(cells, ends).into_iter().enumerate().filter(|&(cell, _)| free[cell]) {
        matrix[(cell, cell)] = 4.0 + shift;
        for other in around.into_iter().flatten().filter(|&other| free[other]) {
            matrix[(cell, other)] -= 1.0;
        }
    }
    matrix
}

fn ends() -> impl Strategy<Value = Ends> {
    prop_oneof![Just(Ends::High), Just(Ends::Reflecting), Just(Ends::Joined)]
}

prop_compose! {
    fn scene(most: usize)(cells in [1..most, 1..most])(
        cells in Just(cells), ends in [ends(), ends()], density in 0.0..1.0_f64,
        chance in prop::collection::vec(0.0..1.0_f64, cells[0] * cells[1]),
        right in prop::collection::vec(-1.0..1.0_f64, cells[0] * cells[1]),
    ) -> ([usize; 2], [Ends; 2], Vec<bool>, Vec<f64>) {
        (cells, ends, chance.into_iter().map(|chance| chance >= density * density).collect(), right)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]
    #[test]
    fn small_grids_agree_with_elimination((cells, ends, free, right) in scene(24), shift in prop_oneof![Just(0.0), 0.0..0.5_f64]) {
        let singular = shift == 0.0 && free.iter().all(|&free| free) && ends.iter().all(|&ends| ends != Ends::High);
        prop_assume!(!singular);
        let solver = Multigrid::new(cells, ends, &free, shift);
        let mut values = vec![0.0; free.len()];
        let convergence = solver.solve(&right, &mut values, 1e-9, &mut solver.workspace());
        let walled = DVector::from_fn(free.len(), |cell, _| if free[cell] { right[cell] } else { 0.0 });
        let exact = dense(cells, ends, &free, shift).lu().solve(&walled).expect("regular");
        let greatest = exact.amax();
        for (cell, value) in values.iter().enumerate() {
            prop_assert!((value - exact[cell]).abs() <= 1e-8 * greatest, "{value} for {} at {cell}, {convergence:?} {cells:?} {}", exact[cell], free.iter().map(|&f| if f {'.'} else {'#'}).collect::<String>());
        }
        prop_assert!(convergence.converged && convergence.iterations <= 12, "{convergence:?}");
    }
}
