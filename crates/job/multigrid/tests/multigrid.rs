//! The fast solver against solvers that share no code with it: dense elimination, relaxation, closed forms.

use cplan_multigrid::{Ends, Multigrid};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Returns the row or column that is `step` further. Beyond a reflecting limit that is the cell itself. Returns `None`
/// beyond any other limit.
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

/// Returns the four neighbours of each cell.
fn neighbors(cells: [usize; 2], ends: [Ends; 2]) -> Vec<[Option<usize>; 4]> {
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

/// Returns the matrix. Walls have the row of the identity.
fn dense(cells: [usize; 2], ends: [Ends; 2], free: &[bool], shift: f64) -> DMatrix<f64> {
    let mut matrix = DMatrix::identity(free.len(), free.len());
    for (cell, around) in neighbors(cells, ends).into_iter().enumerate().filter(|&(cell, _)| free[cell]) {
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

fn agrees_with_elimination(
    cells: [usize; 2],
    ends: [Ends; 2],
    free: &[bool],
    right: &[f64],
    shift: f64,
) -> Result<(), TestCaseError> {
    let solver = Multigrid::new(cells, ends, free, shift);
    let mut values = vec![0.0; free.len()];
    let convergence = solver.solve(right, &mut values, 1e-9, &mut solver.workspace());
    let walled = DVector::from_fn(free.len(), |cell, _| if free[cell] { right[cell] } else { 0.0 });
    let exact = dense(cells, ends, free, shift).lu().solve(&walled).expect("regular");
    let greatest = exact.amax();
    for (cell, value) in values.iter().enumerate() {
        prop_assert!((value - exact[cell]).abs() <= 1e-8 * greatest, "{value} for {} at {cell}", exact[cell]);
    }
    prop_assert!(convergence.converged && convergence.iterations <= 12, "{convergence:?}");
    Ok(())
}

proptest! {
    #![proptest_config(cplan_cases::cases(192))]

    #[test]
    fn small_grids_agree_with_elimination((cells, ends, free, right) in scene(24), shift in prop_oneof![Just(0.0), 0.0..0.5_f64]) {
        let singular = shift == 0.0 && free.iter().all(|&free| free) && ends.iter().all(|&ends| ends != Ends::High);
        prop_assume!(!singular);
        agrees_with_elimination(cells, ends, &free, &right, shift)?;
    }
}

/// Tests rings of three and of two cells. On a ring of two cells, the neighbours on either side are the same cell.
#[test]
fn short_rings_agree_with_elimination() {
    let right = [
        0.230_752_425_333_185_6,
        -0.672_008_830_955_130_5,
        -0.116_141_791_740_784_83,
        -0.449_045_157_238_373_83,
        -0.285_430_987_942_987_6,
        0.821_760_906_724_146_5,
    ];
    let shift = 0.433_781_903_812_694_66;
    agrees_with_elimination([3, 2], [Ends::Joined, Ends::High], &[true; 6], &right, shift).unwrap();
    agrees_with_elimination([2, 3], [Ends::High, Ends::Joined], &[true; 6], &right, shift).unwrap();
    agrees_with_elimination([3, 2], [Ends::High, Ends::Joined], &[true; 6], &right, shift).unwrap();
}

/// Solves by Gauss-Seidel relaxation until nothing changes, with the goal fixed at 1. The solver under test uses
/// another equation and another method.
fn relax_until_stable(cells: [usize; 2], ends: [Ends; 2], free: &[bool], goal: usize) -> Vec<f64> {
    let around = neighbors(cells, ends);
    let mut values = vec![0.0; free.len()];
    values[goal] = 1.0;
    loop {
        let mut change = 0.0_f64;
        for cell in (0..free.len()).filter(|&cell| free[cell] && cell != goal) {
            let mean = around[cell].iter().flatten().map(|&other| values[other]).sum::<f64>() / 4.0;
            change = change.max((mean - values[cell]).abs());
            values[cell] = mean;
        }
        if change < 1e-13 {
            return values;
        }
    }
}

/// Returns the free cells of rooms. Walls are one cell thick, and doors one cell wide.
fn rooms(cells: [usize; 2], room: usize) -> Vec<bool> {
    let place = |cell: usize| [cell / cells[1] % room, cell % cells[1] % room];
    (0..cells[0] * cells[1])
        .map(|cell| {
            let [i, j] = place(cell);
            (i > 0 || j == room / 2) && (j > 0 || i == room / 3)
        })
        .collect()
}

/// Returns the shape and the free cells of a maze whose corridors have this width. Any two cells are connected by
/// exactly one way. The maze is made by depth-first search in random order.
fn maze(rooms: usize, width: usize) -> ([usize; 2], Vec<bool>) {
    let pitch = width + 1;
    let n = rooms * pitch + 1;
    let mut free = vec![false; n * n];
    let mut seen = vec![false; rooms * rooms];
    let mut random = numbers();
    let mut open = |a: [usize; 2], b: [usize; 2]| {
        let [rows, columns] = [0, 1].map(|k| [a[k].min(b[k]) * pitch + 1, a[k].max(b[k]) * pitch + 1 + width]);
        for i in rows[0]..rows[1] {
            free[i * n + columns[0]..i * n + columns[1]].fill(true);
        }
    };
    let mut path = vec![[0_usize, 0]];
    seen[0] = true;
    while let Some(&[i, j]) = path.last() {
        let steps = [[i.wrapping_sub(1), j], [i + 1, j], [i, j.wrapping_sub(1)], [i, j + 1]];
        let new = |[i, j]: [usize; 2]| i < rooms && j < rooms && !seen[i * rooms + j];
        let choices: Vec<[usize; 2]> = steps.into_iter().filter(|&step| new(step)).collect();
        if choices.is_empty() {
            path.pop();
            continue;
        }
        let next = choices[(random() * choices.len() as f64) as usize];
        open([i, j], next);
        seen[next[0] * rooms + next[1]] = true;
        path.push(next);
    }
    ([n, n], free)
}

/// Returns a function that generates random numbers between 0 and 1: a linear congruential generator with a fixed seed.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn first_free(free: &[bool], from: usize) -> usize {
    (from..free.len()).find(|&cell| free[cell]).expect("a free cell")
}

#[test]
fn fields_of_goals_agree_with_relaxation() {
    let cells = [47, 60];
    let free = rooms(cells, 15);
    for ends in [
        [Ends::High, Ends::High],
        [Ends::Joined, Ends::High],
        [Ends::Reflecting, Ends::Joined],
        [Ends::Joined, Ends::Joined],
    ] {
        let solver = Multigrid::new(cells, ends, &free, 0.0);
        let goal = first_free(&free, 1300);
        let mut values = vec![0.0; free.len()];
        let convergence = solver.goal(goal, &mut values, 1e-10, &mut solver.workspace());
        assert!(convergence.converged && convergence.iterations <= 10, "{convergence:?}");
        for (value, relaxed) in values.iter().zip(relax_until_stable(cells, ends, &free, goal)) {
            assert!((value - relaxed).abs() < 1e-9, "{value} for {relaxed}, {ends:?}");
        }
    }
}

#[test]
fn a_corridor_falls_by_two_minus_root_three_a_cell() {
    let solver = Multigrid::new([1, 400], [Ends::High; 2], &[true; 400], 0.0);
    let mut values = vec![0.0; 400];
    solver.goal(200, &mut values, 1e-14, &mut solver.workspace());
    for j in 0..12 {
        let exact = (2.0 - 3.0_f64.sqrt()).powi(j);
        for at in [200 + j as usize, 200 - j as usize] {
            assert!((values[at] / exact - 1.0).abs() < 1e-6, "{} for {exact}", values[at]);
        }
    }
}

#[test]
fn sines_are_modes_of_a_rectangle() {
    let cells = [90, 131];
    for [k, l] in [[1, 1], [3, 2], [20, 60], [90, 131]] {
        let [a, b] = [(k, cells[0]), (l, cells[1])].map(|(k, n)| k as f64 * std::f64::consts::PI / (n + 1) as f64);
        let sine = |i: usize, j: usize| ((i + 1) as f64 * a).sin() * ((j + 1) as f64 * b).sin();
        let right: Vec<f64> = (0..cells[0] * cells[1]).map(|at| sine(at / cells[1], at % cells[1])).collect();
        let eigenvalue = 4.25 - 2.0 * a.cos() - 2.0 * b.cos();
        let solver = Multigrid::new(cells, [Ends::High; 2], &vec![true; right.len()], 0.25);
        let mut values = vec![0.0; right.len()];
        solver.solve(&right, &mut values, 1e-11, &mut solver.workspace());
        for (value, right) in values.iter().zip(&right) {
            assert!((value - right / eigenvalue).abs() < 1e-10 / eigenvalue, "{value} for {}", right / eigenvalue);
        }
    }
}

/// Tests that the number of iterations depends neither on the size nor on the walls, and that the error is below the
/// tolerance.
#[test]
fn iterations_are_few_whatever_the_walls() {
    let mut random = numbers();
    let mut scenes = vec![
        ("open", [257, 300], vec![true; 257 * 300]),
        ("rooms", [300, 301], rooms([300, 301], 43)),
        ("cells", [200, 200], rooms([200, 200], 9)),
        ("comb", [200, 256], (0..200 * 256).map(|at| at % 256 % 4 != 0 || at / 256 < 8).collect()),
    ];
    for width in [1, 3, 7] {
        let (cells, free) = maze(160 / (width + 1), width);
        scenes.push(("maze", cells, free));
    }
    for density in [0.02, 0.3, 0.45] {
        scenes.push(("random", [200, 211], (0..200 * 211).map(|_| random() > density).collect()));
    }
    for (name, cells, free) in scenes {
        for ends in [[Ends::High; 2], [Ends::Joined; 2], [Ends::Reflecting; 2]] {
            // Without walls the field is constant.
            if name == "open" && ends[0] != Ends::High {
                continue;
            }
            let solver = Multigrid::new(cells, ends, &free, 0.0);
            let goal = first_free(&free, free.len() / 2 + cells[1] / 3);
            let mut workspace = solver.workspace();
            let [mut values, mut precise] = [0; 2].map(|_| vec![0.0; free.len()]);
            let convergence = solver.goal(goal, &mut values, 1e-6, &mut workspace);
            assert!(convergence.converged && convergence.iterations <= 8, "{name} {ends:?}: {convergence:?}");
            solver.goal(goal, &mut precise, 1e-12, &mut workspace);
            let error = values.iter().zip(&precise).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-6, "{name} {ends:?}: error {error}, {convergence:?}");
        }
    }
}

#[test]
fn without_walls_the_field_is_constant() {
    for ends in [[Ends::Joined; 2], [Ends::Reflecting; 2], [Ends::Joined, Ends::Reflecting]] {
        let solver = Multigrid::new([33, 24], ends, &[true; 33 * 24], 0.0);
        let mut values = vec![0.0; 33 * 24];
        let convergence = solver.goal(100, &mut values, 1e-9, &mut solver.workspace());
        assert!(convergence.converged);
        assert!(values.iter().all(|value| (value - 1.0).abs() < 2e-3));
    }
}

#[test]
fn grids_without_free_cells_need_no_work() {
    for cells in [[0, 0], [0, 5], [5, 0], [1, 1], [7, 300]] {
        let solver = Multigrid::new(cells, [Ends::Joined, Ends::High], &vec![false; cells[0] * cells[1]], 0.0);
        let mut values = vec![7.0; cells[0] * cells[1]];
        let right = values.clone();
        let convergence = solver.solve(&right, &mut values, 1e-6, &mut solver.workspace());
        assert!(convergence.converged && convergence.iterations == 0);
        assert!(values.iter().all(|&value| value == 0.0));
    }
}

/// Tests fields while an obstacle moves through an open area. The solution for each position of the obstacle starts
/// from the last field.
#[test]
fn a_field_is_repaired_after_an_obstacle_moved() {
    let cells = [65, 85];
    let goal = 20 * 85 + 60;
    let mut kept = vec![0.0; cells[0] * cells[1]];
    for at in 5..40 {
        let free: Vec<bool> = (0..kept.len())
            .map(|cell| !(30..35).contains(&(cell / 85)) || !(at..at + 5).contains(&(cell % 85)))
            .collect();
        let solver = Multigrid::new(cells, [Ends::High; 2], &free, 0.0);
        let mut workspace = solver.workspace();
        let mut fresh = vec![0.0; kept.len()];
        let cold = solver.goal(goal, &mut fresh, 1e-10, &mut workspace);
        let warm = solver.goal(goal, &mut kept, 1e-7, &mut workspace);
        assert!(warm.converged && warm.iterations < cold.iterations, "{warm:?} {cold:?}");
        let error = kept.iter().zip(&fresh).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-6, "{error}");
    }
}
