//! Relaxations that fail. They return an error, and never a field.

use super::direct::drawn;
use cplan::field::{
    Boundary, Difference, Direction, Domain, Equation, Factor, Levels, Lines, Measure, Order, Precision, RelaxError,
    Relaxation, Scan, Stopping, relax, relax_from,
};

const MEASURES: [Measure; 5] = [
    Measure::SumOfChange,
    Measure::SumOfSquares,
    Measure::DifferenceOfSums,
    Measure::GreatestChange,
    Measure::GreatestRelativeChange,
];

fn room() -> Domain {
    let text = "..........\n".repeat(5) + "....G.....\n" + &"..........\n".repeat(5);
    drawn(&text, [Boundary::High; 2], Levels::PUBLISHED)
}

fn stopping(measure: Measure) -> Stopping {
    Stopping { measure, below: 1e-9, max_sweeps: 100_000 }
}

fn oriented(epsilon: f64, difference: Difference) -> Equation {
    Equation::Oriented { direction: Direction::of([1.0, 1.0]).unwrap(), epsilon, difference }
}

#[test]
fn a_factor_above_two_diverges_for_every_measure() {
    for measure in MEASURES {
        for relaxation in
            [Relaxation::sor(Factor::Given(2.1), Order::Corners(Lines::Rows)), Relaxation::weighted_jacobi(1.2)]
        {
            match relax(&room(), &Equation::Harmonic, &relaxation, &stopping(measure)) {
                Err(RelaxError::Diverged { hint, sweeps, .. }) => {
                    assert!(hint.contains("factor"), "{hint}");
                    assert!(sweeps < 2_000, "{sweeps}");
                }
                other => panic!("{measure:?} {relaxation}: {other:?}"),
            }
        }
    }
}

#[test]
fn too_much_drift_for_central_differences_diverges_and_upwind_bears_it() {
    let gauss_seidel = Relaxation::gauss_seidel(Order::Lines(Scan { falling: [true; 2], ..Scan::ROWS }));
    for measure in MEASURES {
        let equation = oriented(60.0, Difference::Central);
        assert!(!equation.is_monotone());
        let error = relax(&room(), &equation, &gauss_seidel, &stopping(measure)).unwrap_err();
        assert!(error.to_string().contains("upwind"), "{error}");
        assert!(error.to_string().starts_with("the relaxation diverged: after "), "{error}");
        let equation = oriented(60.0, Difference::Upwind);
        assert!(equation.is_monotone());
        assert!(relax(&room(), &equation, &gauss_seidel, &stopping(measure)).unwrap().converged(), "{measure:?}");
    }
}

#[test]
fn nan_never_counts_as_converged() {
    for measure in MEASURES {
        let mut start = room().start();
        start[37] = f64::NAN;
        let relaxation = Relaxation::JACOBI;
        let field = relax_from(&room(), &Equation::Harmonic, &relaxation, &stopping(measure), start);
        assert!(matches!(field, Err(RelaxError::Diverged { .. })), "{measure:?}: {field:?}");
    }
}

#[test]
fn invalid_relaxations_are_refused() {
    let domain = room();
    let refused = |equation: &Equation, relaxation: Relaxation, start: Vec<f64>| match relax_from(
        &domain,
        equation,
        &relaxation,
        &stopping(Measure::SumOfChange),
        start,
    ) {
        Err(RelaxError::Refused(reason)) => reason,
        other => panic!("{other:?}"),
    };
    let sor = |factor: f64| Relaxation::sor(Factor::Given(factor), Order::RedBlack);
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(&Equation::Harmonic, sor(factor), domain.start()).contains("factor"));
    }
    let empty = Relaxation::JACOBI.clamped([1.0, 0.0]);
    assert!(refused(&Equation::Harmonic, empty, domain.start()).contains("range"));
    assert!(refused(&Equation::Harmonic, sor(1.0), vec![0.0; 3]).contains("one value per cell"));
    let short = Equation::AlteredPreference { epsilon: vec![0.0; 3] };
    assert!(refused(&short, sor(1.0), domain.start()).contains("3 cells"));
    assert!(refused(&oriented(f64::NAN, Difference::Upwind), sor(1.0), domain.start()).contains("finite"));
    assert_eq!(Direction::of([0.0, 0.0]), None);
    assert_eq!(Direction::of([f64::NAN, 1.0]), None);
    assert_eq!(Direction::of([1e300, 0.0]).unwrap().components(), [1.0, 0.0]);
}

#[test]
fn a_clamp_keeps_over_relaxation_within_bounds() {
    let text = "#G........\n".to_owned() + &"..........\n".repeat(9);
    let domain = drawn(&text, [Boundary::High; 2], Levels::PUBLISHED);
    let sor = Relaxation::sor(Factor::Given(1.9), Order::Lines(Scan::ROWS));
    for max_sweeps in 1..40 {
        let stopping = Stopping { max_sweeps, ..stopping(Measure::SumOfChange) };
        let field = relax(&domain, &Equation::Harmonic, &sor.clamped([0.0, 1.0]), &stopping).unwrap();
        assert!(field.values.iter().all(|v| (0.0..=1.0).contains(v)));
    }
    let free = relax(&domain, &Equation::Harmonic, &sor, &Stopping { max_sweeps: 3, ..stopping(Measure::SumOfChange) });
    assert!(free.unwrap().values.iter().any(|v| !(0.0..=1.0).contains(v)), "the clamp is not tested by this case");
}

#[test]
fn single_precision_rounds_stored_values_only() {
    let domain = room();
    let order = Order::Lines(Scan::ROWS);
    let run = |precision: Precision, max_sweeps: usize| {
        let stopping = Stopping { max_sweeps, ..stopping(Measure::SumOfChange) };
        relax(&domain, &Equation::Harmonic, &Relaxation::gauss_seidel(order).with_precision(precision), &stopping)
            .unwrap()
    };
    for max_sweeps in [1, 5, 20] {
        let [double, single] = [Precision::Double, Precision::Single].map(|kept| run(kept, max_sweeps).values);
        assert!(single.iter().all(|&value| f64::from(value as f32) == value));
        assert!(double.iter().any(|&value| f64::from(value as f32) != value), "doubles were rounded, too");
        // Each update adds at most half a unit in the last place, and passes on at most the mean of the neighbours'
        // errors.
        let bound = max_sweeps as f64 * f64::from(f32::EPSILON);
        assert!(double.iter().zip(&single).all(|(a, b)| (a - b).abs() <= bound));
    }
}

#[test]
fn slow_relaxations_are_reported() {
    let stopping = Stopping { max_sweeps: 5, ..stopping(Measure::SumOfChange) };
    let field = relax(&room(), &Equation::Harmonic, &Relaxation::JACOBI, &stopping).unwrap();
    assert!(!field.converged());
    assert_eq!(field.sweeps(), 5);
    assert!(field.change() > 1e-3);
}
