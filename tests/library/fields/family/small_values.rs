//! Over-relaxation of fields whose values span many orders of magnitude.

use super::direct::drawn;
use cplan::field::{
    Boundary, Cell, Domain, Equation, Factor, Initial, Levels, Lines, Measure, Order, RelaxError, Relaxation, Scan,
    Stopping, eliminated, relax, relax_watched,
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
fn guarded_over_relaxation_never_leaves_the_range_of_the_fixed_values() {
    let mut unguarded = [0; 2];
    for (levels, initial) in [Levels::PROBABILITY, Levels::PUBLISHED]
        .into_iter()
        .flat_map(|levels| [Initial::High, Initial::Low].map(|initial| (levels, initial)))
    {
        let room = drawn(
            &("..........\n".repeat(5) + "....G.....\n" + &"..........\n".repeat(5)),
            [Boundary::Reflecting; 2],
            levels,
        );
        let rings = Domain::new(rings().cells(), rings().kinds().to_vec(), [Boundary::High; 2], levels);
        for domain in [rings, room].map(|domain| domain.with_initial(initial)) {
            // Values beyond that of obstacles, and beyond that of goals.
            let lost = |relaxation: Relaxation| {
                let mut lost = [0; 2];
                let stopping = Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: 1_000 };
                let mut watch = |seen: cplan::field::SweepSnapshot| {
                    let count = |is_past: fn(&f64) -> bool| seen.values.iter().filter(|value| is_past(value)).count();
                    let [above, below] = [count(|value| *value > 1.0), count(|value| *value < 0.0)];
                    let [obstacles, goals] = if levels.obstacle > 0.5 { [above, below] } else { [below, above] };
                    lost = [lost[0] + obstacles, lost[1] + goals];
                };
                let start = domain.start();
                relax_watched(&domain, &Equation::Harmonic, &relaxation, &stopping, start, &mut watch).unwrap();
                lost
            };
            let sor = Relaxation::sor(Factor::Given(1.9), ROWS);
            assert_eq!(lost(sor.guarded()), [0; 2], "{levels:?}");
            let [obstacles, goals] = lost(sor);
            unguarded = [unguarded[0] + obstacles, unguarded[1] + goals];
        }
    }
    assert!(unguarded.iter().all(|&lost| lost > 0), "{unguarded:?}: no case tests one side of the guard");
}

/// Checks that the guard does not hide a divergence: with a factor of 2 or more, values would stay in their range and
/// never settle.
#[test]
fn factors_that_never_converge_diverge_although_they_are_guarded() {
    let sor = Relaxation::sor(Factor::Given(2.5), ROWS).guarded();
    let settings = Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: 20_000 };
    let Err(RelaxError::Diverged { hint, .. }) = relax(&rings(), &Equation::Harmonic, &sor, &settings) else {
        panic!("a factor of 2.5 does not diverge")
    };
    assert!(hint.contains("use a smaller factor"), "{hint}");
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
