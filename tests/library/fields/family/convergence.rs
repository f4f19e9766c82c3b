//! Convergence of relaxations. Rates are compared with closed forms for empty rectangles, solutions by elimination with
//! dense ones and with the harmonic potential, and samples with relaxations that end earlier.

use super::direct;
use super::promises::{monotone, random_domain};
use cplan::compare::{Setup, convergence};
use cplan::field::{
    Boundary, Cell, Component, Difference, Direction, Domain, Ending, Equation, Factor, Lattice, Levels, Lines,
    Measure, Order, Relaxation, Scan, Stopping, Trace, eliminated, harmonic, relax, trace,
};
use proptest::prelude::*;
use std::f64::consts::PI;

const ROWS: Order = Order::Lines(Scan::ROWS);

/// Returns a rectangle of free cells among obstacles of value 0. The exact field is 0, so the values are the error,
/// which is initially 1 everywhere.
fn empty(cells: [usize; 2]) -> Domain {
    let levels = Levels { free: 1.0, ..Levels::PROBABILITY };
    Domain::new(cells, vec![Cell::Free; cells[0] * cells[1]], [Boundary::High; 2], levels)
}

fn oriented(epsilon: f64, difference: Difference) -> Equation {
    Equation::Oriented { direction: Direction::of([1.0, 0.0]).unwrap(), epsilon, difference }
}

/// Returns the spectral radius of Jacobi's relaxation, the factor by which each sweep reduces the error in the end. Its
/// eigenvectors are products of sines and powers. Along each axis, the eigenvalue is twice the root of the product of
/// opposite weights times a cosine, over the sum of all weights.
fn jacobi_rate(cells: [usize; 2], equation: &Equation) -> f64 {
    let [a, b] = cells.map(|n| (PI / (n + 1) as f64).cos());
    match equation {
        Equation::Oriented { epsilon, difference: Difference::Central, .. } => {
            let squared = 1.0 - 0.25 * epsilon * epsilon;
            // If the drift exceeds 2, the part along the drift is imaginary.
            if squared >= 0.0 { 0.5 * (squared.sqrt() * a + b) } else { 0.5 * (-squared * a * a + b * b).sqrt() }
        }
        Equation::Oriented { epsilon, difference: Difference::Upwind, .. } => {
            2.0 * ((1.0 + epsilon.abs()).sqrt() * a + b) / (4.0 + epsilon.abs())
        }
        _ => 0.5 * (a + b),
    }
}

fn traced(domain: &Domain, equation: &Equation, relaxation: &Relaxation, below: f64) -> Trace {
    let stopping = Stopping { measure: Measure::SumOfSquares, below, max_sweeps: 20_000 };
    let exact = eliminated(domain, equation);
    trace(domain, equation, relaxation, &stopping, domain.start(), exact.as_deref()).unwrap()
}

#[test]
fn rates_in_empty_rectangles_are_the_closed_forms() {
    let equations = [
        Equation::Harmonic,
        oriented(0.6, Difference::Central),
        oriented(1.2, Difference::Central),
        oriented(0.8, Difference::Upwind),
        oriented(3.0, Difference::Upwind),
    ];
    for cells in [[12, 12], [7, 19], [20, 9]] {
        let domain = empty(cells);
        for equation in &equations {
            let rate = |relaxation: Relaxation| traced(&domain, equation, &relaxation, 1e-26).rate().unwrap();
            let jacobi = jacobi_rate(cells, equation);
            let close = |measured: f64, known: f64, within: f64| {
                assert!((measured - known).abs() < within, "{cells:?} {equation:?}: {measured} instead of {known}");
            };
            // The rate over the last half of some fifty sweeps is close to the limit.
            close(rate(Relaxation::JACOBI), jacobi, 1e-2);
            close(rate(Relaxation::weighted_jacobi(0.8)), 0.2 + 0.8 * jacobi, 1e-2);
            close(rate(Relaxation::gauss_seidel(ROWS)), jacobi * jacobi, 1e-2);
            close(rate(Relaxation::gauss_seidel(Order::RedBlack)), jacobi * jacobi, 1e-2);
            // Young 1954. With the best factor, the error falls like k (w - 1)^k: slightly more slowly.
            let best = 2.0 / (1.0 + (1.0 - jacobi * jacobi).sqrt());
            for order in [ROWS, Order::RedBlack] {
                let measured = rate(Relaxation::sor(Factor::Given(best), order));
                assert!(measured > best - 1.02 && measured < best - 1.0 + 0.08, "{cells:?} {measured} {best}");
            }
        }
    }
}

#[test]
fn central_differences_fail_where_predicted_and_upwind_ones_do_not() {
    let cells = [12, 9];
    let domain = empty(cells);
    let gauss_seidel = Relaxation::gauss_seidel(ROWS);
    let rate = |epsilon: f64| jacobi_rate(cells, &oriented(epsilon, Difference::Central));
    let ending = |epsilon, difference| traced(&domain, &oriented(epsilon, difference), &gauss_seidel, 1e-20).ending;
    for (epsilon, expected) in
        [(1.9, Ending::Converged), (3.0, Ending::Converged), (3.9, Ending::Converged), (4.6, Ending::Diverged)]
    {
        assert_eq!(rate(epsilon) < 1.0, expected == Ending::Converged);
        assert_eq!(ending(epsilon, Difference::Central), expected, "{epsilon}");
        assert_eq!(ending(epsilon, Difference::Upwind), Ending::Converged, "{epsilon}");
    }
    let lost = traced(&domain, &oriented(9.0, Difference::Central), &gauss_seidel, 1e-20);
    assert_eq!((lost.ending, lost.rate().is_some_and(f64::is_nan)), (Ending::Diverged, false));
    assert!(lost.samples.iter().all(|s| s.squares.is_finite() && !s.relative.is_nan()));
    assert!(lost.samples.last().unwrap().error.is_none_or(|error| error > 1e6));
}

#[test]
fn the_scan_is_best_at_the_theoretical_factor() {
    let domain = empty([20, 30]);
    let setup = Setup {
        title: "empty".into(),
        domain: &domain,
        equations: vec![("harmonic".into(), Equation::Harmonic)],
        direction: Direction::of([1.0, 0.0]).unwrap(),
        order: ROWS,
        stopping: Stopping { measure: Measure::GreatestChange, below: 1e-12, max_sweeps: 5_000 },
    };
    let mut heard = 0;
    let measured = convergence(&setup, &mut |_| heard += 1).unwrap();
    assert_eq!((measured.runs.len(), measured.factors.len(), measured.strengths.len(), heard), (8, 1, 2, 4));
    let rate = jacobi_rate([20, 30], &Equation::Harmonic);
    let theory = 2.0 / (1.0 + (1.0 - rate * rate).sqrt());
    let scan = &measured.factors[0];
    assert!((scan.by_rate.unwrap().at - theory).abs() < 2e-3, "{:?} {theory}", scan.by_rate);
    assert!((scan.formula.unwrap().at - theory).abs() < 0.02, "{:?} {theory}", scan.formula);
    assert!((scan.best().unwrap().at - theory).abs() < 0.03, "{:?} {theory}", scan.best());
    let before: Vec<usize> = scan.points.iter().filter(|p| p.at < theory - 0.02).map(|p| p.sweeps).collect();
    assert!(before.len() > 12 && before.windows(2).all(|w| w[0] > w[1]), "{before:?}");
    let after: Vec<usize> = scan.points.iter().filter(|p| p.at > theory + 0.02).map(|p| p.sweeps).collect();
    assert!(after.len() > 3 && after.windows(2).all(|w| 20 * w[0] < 21 * w[1]), "{after:?}");
    // Each scan has the results of the relaxation that it varies.
    let gauss_seidel = measured.runs.iter().find(|c| c.relaxation == Relaxation::gauss_seidel(ROWS)).unwrap();
    assert_eq!((scan.points[0].at, scan.points[0].sweeps), (1.0, gauss_seidel.trace.sweeps));
    assert!(measured.strengths.iter().all(|(_, s)| s.points[0].sweeps == gauss_seidel.trace.sweeps));
    // Jacobi's eigenvalues lie between minus the rate and the rate. So a weight above 2 / (1 + rate) diverges, and the
    // best weight is 1 or slightly less.
    let weights = &measured.weights[0];
    let jacobi = measured.runs.iter().find(|c| c.relaxation == Relaxation::JACOBI).unwrap();
    let at_one = weights.points.iter().find(|point| point.at == 1.0).unwrap();
    assert_eq!((at_one.sweeps, at_one.ending), (jacobi.trace.sweeps, jacobi.trace.ending));
    assert!((0.9..=1.0).contains(&weights.best().unwrap().at), "{:?}", weights.best());
    assert_eq!(weights.divergence_start().map(|p| p.at), Some(1.05), "the first above {}", 2.0 / (1.0 + rate));
    assert_eq!(weights.points.len(), 12);
    let [(_, central), (_, upwind)] = &measured.strengths[..] else { panic!("two") };
    assert_eq!(upwind.divergence_start(), None);
    assert!((3.8..4.4).contains(&central.divergence_start().unwrap().at), "{:?}", central.divergence_start());
}

#[test]
fn elimination_finds_the_harmonic_potential() {
    // Rooms with doors, on a cylinder, so that rows wrap around.
    let n = 36;
    let blocked: Vec<bool> = (0..n * n)
        .map(|cell| {
            let (i, j) = (cell / n, cell % n);
            (i % 9 == 4 && j % 12 != 5) || (j % 12 == 0 && i % 9 != 1)
        })
        .collect();
    let goal = 7 * n + 20;
    assert!(!blocked[goal]);
    let lattice = Lattice::new([n, n], [true, false], &blocked);
    let component = Component::new(&lattice, lattice.wave(&[goal]));
    let potential = harmonic(&component).potential;
    let position = |cell: usize| component.position_of(cell);
    let kinds = (0..n * n).map(|cell| match position(cell) {
        _ if cell == goal => Cell::Goal,
        Some(_) => Cell::Free,
        None => Cell::Obstacle,
    });
    let domain = Domain::new([n, n], kinds.collect(), [Boundary::Periodic, Boundary::High], Levels::PROBABILITY);
    let values = eliminated(&domain, &Equation::Harmonic).unwrap();
    let mut compared = 0;
    for (cell, value) in values.iter().enumerate() {
        match position(cell) {
            Some(k) => {
                assert!((value - potential.ln(k).exp()).abs() < 1e-12, "cell {cell}: {value}");
                compared += 1;
            }
            None => assert_eq!(*value, 0.0),
        }
    }
    assert!(compared > 500, "{compared}");
}

/// Generates all kinds of relaxations, including over-relaxation.
fn relaxation() -> impl Strategy<Value = Relaxation> {
    prop_oneof![
        Just(Relaxation::JACOBI),
        Just(Relaxation::weighted_jacobi(0.7)),
        Just(Relaxation::gauss_seidel(Order::RedBlack)),
        Just(Relaxation::sor(Factor::Formula, Order::Corners(Lines::Rows))),
        Just(Relaxation::sor(Factor::Given(1.6), ROWS)),
    ]
}

proptest! {
    #![proptest_config(cplan_cases::cases(200))]

    #[test]
    fn elimination_agrees_with_a_dense_solution(
        (domain, equation) in random_domain().prop_flat_map(|d| { let n = d.kinds().len(); (Just(d), monotone(n)) })
    ) {
        let nonlinear = matches!(equation, Equation::Preference { .. } | Equation::AlteredPreference { .. });
        let found = eliminated(&domain, &equation);
        prop_assert_eq!(found.is_none(), nonlinear);
        if let Some(values) = found {
            let dense = direct::solution(&domain, &equation);
            for (a, b) in values.iter().zip(dense) {
                prop_assert!((a - b).abs() < 1e-9, "{} {}", a, b);
            }
        }
    }

    #[test]
    fn samples_equal_relaxations_that_stop_there(
        (domain, equation) in random_domain().prop_flat_map(|d| { let n = d.kinds().len(); (Just(d), monotone(n)) }),
        relaxation in relaxation(),
        last in 1..12_usize,
    ) {
        let never = |max_sweeps| Stopping { measure: Measure::SumOfChange, below: 0.0, max_sweeps };
        let exact = eliminated(&domain, &equation);
        let run = trace(&domain, &equation, &relaxation, &never(last), domain.start(), exact.as_deref()).unwrap();
        let until = |sweeps| relax(&domain, &equation, &relaxation, &never(sweeps)).unwrap();
        prop_assert_eq!(run.sweeps, until(last).sweeps());
        prop_assert_eq!(run.ending == Ending::Converged, until(last).converged());
        // If there are two stages, a relaxation can end after the first.
        for sample in run.samples.iter().filter(|sample| sample.stage == 0) {
            let stage = if exact.is_some() { equation.clone() } else { Equation::Harmonic };
            let at = |sweeps| relax(&domain, &stage, &relaxation, &never(sweeps)).unwrap().values;
            let (old, new) = (at(sample.sweep - 1), at(sample.sweep));
            let squares: f64 = old.iter().zip(&new).map(|(a, b)| (a - b).powi(2)).sum();
            prop_assert!((sample.squares - squares).abs() <= 1e-12 * squares);
            let relative = old.iter().zip(&new).filter(|(a, b)| a != b).map(|(a, b)| ((b - a) / b).abs());
            prop_assert_eq!(sample.relative, relative.fold(0.0, f64::max));
            let far = |values: &[f64]| {
                let exact = exact.as_ref().unwrap();
                values.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            if let Some(error) = sample.error {
                prop_assert!((error - far(&new) / far(&domain.start())).abs() < 1e-12);
            }
        }
        // Without over-relaxation, no sweep increases the greatest error.
        let errors: Vec<f64> = run.samples.iter().filter_map(|sample| sample.error).collect();
        if relaxation.factor(domain.cells()) <= 1.0 {
            prop_assert!(errors.windows(2).all(|w| w[1] <= w[0] * (1.0 + 1e-12) + 1e-15), "{:?}", errors);
        }
    }
}
