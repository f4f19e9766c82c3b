//! Over-relaxation of fields whose values span many orders of magnitude.

use super::direct::drawn;
use cplan::field::{
    Boundary, Cell, Domain, Equation, Factor, Levels, Lines, Measure, Order, Relaxation, Scan, Stopping, eliminated,
    relax, relax_watched,
};

/// Returns two walls round a goal, open on opposite sides.
fn rings() -> Domain {
    let n = 60;
    let kind = |cell: usize| {
        let [i, j] = [cell / n, cell % n];
        let ring = |low: usize, high: usize| {
            (low..=high).contains(&i) && (low..=high).contains(&j) && [i, j].iter().any(|k| *k == low || *k == high)
        };
        match [i, j] {
            [28..=30, 28..=30] => Cell::Goal,
            // The doors.
            [27..=32, 20] | [27..=32, 50] => Cell::Free,
            _ if ring(20, 40) || ring(10, 50) => Cell::Obstacle,
            _ => Cell::Free,
        }
    };
    Domain::new([n, n], (0..n * n).map(kind).collect(), [Boundary::High; 2], Levels::PROBABILITY)
}

const ROWS: Order = Order::Lines(Scan::ROWS);
const RELATIVE: Stopping = Stopping { measure: Measure::GreatestRelativeChange, below: 1e-6, max_sweeps: 10_000 };

#[test]
fn over_relaxation_settles_values_that_are_smaller_than_its_rounding() {
    let domain = rings();
    for order in [ROWS, Order::Corners(Lines::Rows), Order::RedBlack, Order::FourColors] {
        let sor = Relaxation::sor(Factor::Formula, order).guarded();
        let field = relax(&domain, &Equation::Harmonic, &sor, &RELATIVE).unwrap();
        assert!(field.converged(), "{order}: {:?}", field.stages);
        let gauss_seidel = relax(
            &domain,
            &Equation::Harmonic,
            &Relaxation::gauss_seidel(order),
            &Stopping { below: 1e-9, max_sweeps: 100_000, ..RELATIVE },
        )
        .unwrap();
        assert!(gauss_seidel.converged());
        let exact = eliminated(&domain, &Equation::Harmonic).unwrap();
        for ((value, slow), exact) in field.values.iter().zip(&gauss_seidel.values).zip(&exact) {
            assert!(*value >= 0.0 && (value - slow).abs() <= 1e-2 * slow, "{order}: {value:e} {slow:e}");
            assert!((value - exact).abs() < 1e-6, "{order}: {value:e} {exact:e}");
        }
        let least = field.values.iter().filter(|value| **value > 0.0).fold(1.0, |least: f64, value| least.min(*value));
        assert!(least < 1e-16, "{least:e}");
    }
    // Without a guard, the relaxation fails.
    let field = relax(&domain, &Equation::Harmonic, &Relaxation::sor(Factor::Formula, ROWS), &RELATIVE).unwrap();
    assert!(!field.converged());
}

#[test]
fn over_relaxed_values_never_pass_that_of_obstacles() {
    for levels in [Levels::PROBABILITY, Levels::PUBLISHED] {
        let domain = Domain::new(rings().cells(), rings().kinds().to_vec(), [Boundary::High; 2], levels);
        let lost = |relaxation: Relaxation| {
            let mut lost = 0;
            let stopping = Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: 1_000 };
            let mut watch = |seen: cplan::field::SweepSnapshot| {
                let is_past = |value: &&f64| if levels.obstacle > 0.5 { **value > 1.0 } else { **value < 0.0 };
                lost += seen.values.iter().filter(is_past).count();
            };
            let start = domain.start();
            let field = relax_watched(&domain, &Equation::Harmonic, &relaxation, &stopping, start, &mut watch).unwrap();
            assert!(field.converged());
            lost
        };
        let sor = Relaxation::sor(Factor::Formula, ROWS);
        assert_eq!(lost(sor.guarded()), 0, "{levels:?}");
        assert!(lost(sor) > 0, "{levels:?}");
    }
}

/// Checks that a guard changes nothing if there are no small values.
#[test]
fn a_guard_leaves_relaxations_without_small_values_as_they_are() {
    let domain = drawn("G.... ..#.. .....", [Boundary::Reflecting; 2], Levels::PROBABILITY);
    let sor = Relaxation::sor(Factor::Given(1.2), ROWS);
    let [plain, guarded] =
        [sor, sor.guarded()].map(|sor| relax(&domain, &Equation::Harmonic, &sor, &RELATIVE).unwrap());
    assert_eq!(plain, guarded);
}
