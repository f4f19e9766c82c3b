//! Tests of the harmonic field: exact values far below the least double, mazes and spirals, and the curve between the
//! cells.

use cplan_cases::mazes;
use cplan_harmonic::follow::follow;
use cplan_harmonic::{Component, Field, Lattice, Potential, PotentialGuide, harmonic, harmonic_path, residual};
use cplan_planners::planner::grid_path::Place;
use num_rational::BigRational;
use proptest::prelude::*;
use std::f64::consts::PI;

#[derive(Debug, Clone)]
struct Grid {
    cells: [usize; 2],
    circles: [bool; 2],
    blocked: Vec<bool>,
}

fn grid(cells: [usize; 2], circles: [bool; 2], blocked: Vec<bool>) -> Grid {
    Grid { cells, circles, blocked }
}

fn lattice(grid: &Grid) -> Lattice {
    Lattice::new(grid.cells, grid.circles, &grid.blocked)
}

fn solved(grid: &Grid, goals: &[usize]) -> (Component, Field) {
    let lattice = lattice(grid);
    let component = Component::new(&lattice, lattice.wave(goals));
    let field = harmonic(&component);
    (component, field)
}

/// Asserts what holds for every harmonic field: the residual is small, and every cell except the goals has a greater
/// neighbour.
fn is_sound(component: &Component, field: &Field) {
    let residual = residual(component, &field.potential);
    assert!(residual < 2e-14, "residual {residual:e}");
    assert!(field.potential.navigates(component));
}

/// Asserts that each step of a path goes to a neighbour whose value is as great as any, up to rounding, and that the
/// last cell is a goal.
fn is_steepest(component: &Component, way: &[usize], ln: impl Fn(usize) -> f64) {
    assert!(way.last().is_some_and(|&last| last < component.goals));
    for step in way.windows(2) {
        let around = component.neighbors(step[0]);
        let greatest = around.iter().filter(|&&n| n != component.wall()).map(|&n| ln(n)).fold(f64::MIN, f64::max);
        assert!(around.contains(&step[1]) && ln(step[1]) > greatest - 1e-9, "{} of {greatest}", ln(step[1]));
    }
}

/// Computes the harmonic function by Gaussian elimination in rational numbers, without loss of walks.
fn exact(component: &Component) -> Vec<BigRational> {
    let n = component.len();
    let number = |x: i64| BigRational::from_integer(x.into());
    let mut rows: Vec<Vec<BigRational>> = vec![vec![number(0); n + 1]; n];
    for (i, row) in rows.iter_mut().enumerate() {
        if i < component.goals {
            (row[i], row[n]) = (number(1), number(1));
            continue;
        }
        row[i] += number(4);
        for neighbor in component.neighbors(i).into_iter().filter(|&k| k < n) {
            row[neighbor] -= number(1);
        }
    }
    // Starts at the far end: a chain of corridors then has few entries per row.
    for k in (0..n).rev() {
        let row = rows[k].clone();
        for other in rows[..k].iter_mut().filter(|other| other[k] != number(0)) {
            let share = &other[k] / &row[k];
            for (x, y) in other.iter_mut().zip(&row).filter(|(_, y)| **y != number(0)) {
                *x -= &share * y;
            }
        }
    }
    let mut solution = vec![number(0); n];
    for k in 0..n {
        let known = (0..k).filter(|&l| rows[k][l] != number(0)).map(|l| &rows[k][l] * &solution[l]);
        solution[k] = (&rows[k][n] - known.fold(number(0), |sum, x| sum + x)) / &rows[k][k];
    }
    solution
}

/// Returns the natural logarithm of a positive rational of any size.
fn ln(x: &BigRational) -> f64 {
    let part = |x: &BigRational, upper: bool| {
        let digits = if upper { x.numer() } else { x.denom() }.to_string();
        let leading: f64 = digits[..digits.len().min(18)].parse().expect("digits");
        leading.ln() + (digits.len() - digits.len().min(18)) as f64 * std::f64::consts::LN_10
    };
    part(x, true) - part(x, false)
}

fn random_grid() -> impl Strategy<Value = (Grid, usize)> {
    (1..14_usize, 1..14_usize, any::<[bool; 2]>(), 0.0..0.6_f64).prop_flat_map(|(rows, columns, circles, density)| {
        let cells = proptest::collection::vec(proptest::bool::weighted(density), rows * columns);
        (cells, 0..rows * columns)
            .prop_map(move |(blocked, goal)| (grid([rows, columns], circles, blocked), goal))
            .prop_filter("a free goal", |(grid, goal)| !grid.blocked[*goal])
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(40))]

    #[test]
    fn values_agree_with_rational_arithmetic_however_small((grid, goal) in random_grid()) {
        prop_assume!(grid.blocked.len() <= 80);
        let (component, field) = solved(&grid, &[goal]);
        let exact: Vec<f64> = exact(&component).iter().map(ln).collect();
        for (i, value) in exact.iter().enumerate() {
            // Walks are lost at a rate of 1e-13 per step.
            prop_assert!((field.potential.ln(i) - value).abs() < 1e-9, "{} is not {value}", field.potential.ln(i));
        }
        let last = component.len() - 1;
        is_steepest(&component, &harmonic_path(&component, last).expect("a way"), |i| exact[i]);
    }
}

/// Generates grids of some thousand cells: a wide room, thin walls, mazes, or pillars. The goal may be anywhere.
fn large_grid() -> impl Strategy<Value = (Grid, Vec<usize>)> {
    let kinds = (0..5_usize, 20..70_usize, any::<[bool; 2]>(), any::<u64>());
    let grids = kinds.prop_map(|(kind, half, circles, seed)| {
        let n = 2 * half + 1;
        let at = |i: usize, j: usize| (seed ^ ((i * n + j) as u64 + 1)).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33;
        let cell = |i: usize, j: usize| match kind {
            0 => at(i, j) % 100 < 2,
            1 => at(i, j) % 100 < 38,
            // Thin walls with one gap each.
            2 => i % 9 == 4 && at(i, 0) as usize % n != j,
            // Alternating wide and narrow corridors in a serpentine.
            3 => matches!(i % 20, 11 | 13 | 19) && if i % 20 == 13 { j != 0 } else { j + 1 != n },
            _ => false,
        };
        let blocked =
            if kind == 4 { mazes::maze(n, seed % 200) } else { (0..n * n).map(|c| cell(c / n, c % n)).collect() };
        grid([n, n], circles, blocked)
    });
    grids.prop_flat_map(|grid| {
        let free: Vec<usize> = (0..grid.blocked.len()).filter(|&cell| !grid.blocked[cell]).collect();
        (Just(grid), proptest::collection::vec(proptest::sample::select(free), 1..3))
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(12))]

    #[test]
    fn every_cell_has_a_greater_neighbor_in_large_grids_of_all_kinds((grid, goals) in large_grid()) {
        let (component, field) = solved(&grid, &goals);
        is_sound(&component, &field);
        for from in [component.goals / 2, component.len() / 9, component.len() / 2, component.len() - 1] {
            let way = harmonic_path(&component, from).expect("a way");
            assert_eq!(way[0], from);
            is_steepest(&component, &way, |i| field.potential.ln(i));
        }
    }
}

/// Tests a place where the symmetry of walls and goals makes all four neighbours equal, so the harmonic function is
/// level. The loss of walks makes the computed potential fall there.
#[test]
fn the_middle_of_four_goals_is_not_level() {
    for half in [2, 3, 20, 40] {
        let n = 2 * half + 1;
        let grid = grid([n, n], [false; 2], vec![false; n * n]);
        let goals = [half, half * n, half * n + n - 1, (n - 1) * n + half];
        let (component, field) = solved(&grid, &goals);
        is_sound(&component, &field);
        // At least as many steps as the distance to one of them.
        let way = field.potential.ascend(&component, component.position_of(half * n + half).unwrap()).expect("a way");
        let reached = goals.iter().any(|goal| component.position_of(*goal) == way.last().copied());
        assert!(reached && way.len() > half, "{way:?}");
    }
}

/// Tests a corridor one cell wide. Each value is `2 - sqrt 3` times the previous one, except for a few at its closed
/// end.
#[test]
fn a_spiral_of_a_hundred_thousand_cells_is_solved() {
    let (blocked, inner) = mazes::spiral(451);
    let grid = grid([451; 2], [false; 2], blocked);
    let free = grid.blocked.iter().filter(|&&blocked| !blocked).count();
    assert!(free > 100_000, "only {free} cells");
    let (component, field) = solved(&grid, &[inner]);
    is_sound(&component, &field);
    let cells = field.potential.ascend(&component, component.position_of(0).unwrap()).unwrap();
    assert_eq!(cells.len(), free);
    // The closed form of a chain: u_k = sinh((n - k) theta) / sinh(n theta) with the wall behind cell n - 1.
    let theta = 2.0_f64.acosh();
    for k in [1, 10, 1000, 50_000, 100_000] {
        let expected = -(k as f64) * theta + (-2.0 * (free - k) as f64 * theta).exp().ln_1p().min(0.0);
        assert!((field.potential.ln(k) - expected).abs() < 1e-12 * expected.abs() + 1e-7, "cell {k}");
    }
}

#[test]
fn a_maze_of_2001_x_2001_cells_is_solved() {
    let n = 2001;
    let grid = grid([n, n], [false; 2], mazes::maze(n, 0));
    let (component, field) = solved(&grid, &[n * n - 1]);
    assert_eq!(component.len(), 2 * 1001 * 1001 - 1);
    is_sound(&component, &field);
    let cells = field.potential.ascend(&component, component.position_of(0).unwrap()).unwrap();
    assert_eq!(component.place(*cells.last().unwrap()), [n - 1, n - 1]);
}

#[test]
fn a_braided_maze_of_501_x_501_cells_is_solved() {
    let n = 501;
    let grid = grid([n, n], [false; 2], mazes::maze(n, 100));
    let (component, field) = solved(&grid, &[0]);
    is_sound(&component, &field);
}

/// Tests paths in the potential `u = sin(pi x / w) sinh(pi y / w)`. They are compared with streamlines that a fine
/// Runge-Kutta integration finds.
#[test]
fn paths_are_streamlines_of_a_known_function() {
    let (w, h) = (64_usize, 96_usize);
    let u = |x: f64, y: f64| (PI * x / w as f64).sin() * (PI * y / w as f64).sinh();
    // Centres at 1 .. w - 1 and 1 .. h - 1; goals in the last row.
    let (columns, rows) = (w - 1, h - 1);
    let grid = grid([rows, columns], [false; 2], vec![false; rows * columns]);
    let lattice = lattice(&grid);
    let goals: Vec<usize> = ((rows - 1) * columns..rows * columns).collect();
    let component = Component::new(&lattice, lattice.wave(&goals));
    let log2 = (0..component.len()).map(|position| {
        let [i, j] = component.place(position);
        u((j + 1) as f64, (i + 1) as f64).log2()
    });
    let potential = Potential::from_log2(&log2.collect::<Vec<_>>());
    let inside = |[i, j]: Place| (0..rows as i64).contains(&i) && (0..columns as i64).contains(&j);
    let position = |p: Place| inside(p).then(|| component.position_of(p[0] as usize * columns + p[1] as usize))?;
    for start in [[1.3, 4.6], [3.0, 10.0], [20.2, 55.1], [0.0, 31.0]] {
        let streamline = follow(&mut PotentialGuide::new(&component, &potential, position), [1.0; 2], start).unwrap();
        assert_eq!(streamline.place[0], rows as i64 - 1);
        // (y, x) as in the lattice; gradient by the closed form, steps of 1/100 of a cell.
        let slope = |[i, j]: [f64; 2]| {
            let (x, y) = (PI * (j + 1.0) / w as f64, PI * (i + 1.0) / w as f64);
            let g = [x.sin() * y.cosh(), x.cos() * y.sinh()];
            let length = g[0].hypot(g[1]);
            g.map(|g| g / length)
        };
        let mut fine = vec![start];
        let mut at: [f64; 2] = start;
        while at[0] < rows as f64 - 1.5 {
            let step = 0.01;
            let moved = |d: [f64; 2], by: f64| [at[0] + by * d[0], at[1] + by * d[1]];
            let a = slope(at);
            let b = slope(moved(a, step / 2.0));
            let c = slope(moved(b, step / 2.0));
            let d = slope(moved(c, step));
            at = [0, 1].map(|k| at[k] + step / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
            fine.push(at);
        }
        for p in &streamline.points {
            // The goal is known only as a cell, and the field is nearly level along the limit in the last rows.
            let allowed = if p[0] < rows as f64 - 3.0 { 0.1 } else { 0.2 };
            let nearest = fine.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
            assert!(nearest < allowed, "{p:?} is {nearest} cells off the streamline from {start:?}");
        }
    }
}
