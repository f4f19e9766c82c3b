//! Compares relaxations on the GPU, sweep by sweep, with relaxations of one cell after the other.

use crate::gpu;
use crate::oracle::{Case, Kind, any_case, case, greatest_difference};
use cplan_fields::{Boundary, CellEquations, Factor, Measure, Order, Relaxation, Stopping};
use cplan_gpu::{Ending, GpuError};
use proptest::prelude::*;

/// Error of an update in single precision, relative to the greatest value: some units in the last place.
const ROUNDING: f64 = 4.0 / (1 << 24) as f64;

/// Greatest factor by which over-relaxation magnifies rounding in these cases.
const MAGNIFIED: f64 = 20.0;

/// Returns Gauss-Seidel relaxation, over-relaxed by a factor.
fn sor(factor: f64) -> Relaxation {
    Relaxation::sor(Factor::Given(factor), Order::RedBlack)
}

/// The rule of Silva 2011: the squared changes of a sweep add up to less than 10^-6.
const PUBLISHED: Stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-6, max_sweeps: 10_000 };

fn settings() -> impl Strategy<Value = (Relaxation, Stopping)> {
    let measure = prop_oneof![
        Just(Measure::SumOfChange),
        Just(Measure::SumOfSquares),
        Just(Measure::GreatestChange),
        Just(Measure::GreatestRelativeChange),
        Just(Measure::DifferenceOfSums)
    ];
    let relaxation = prop_oneof![
        Just(Relaxation::JACOBI),
        (0.3..1.0_f64).prop_map(Relaxation::weighted_jacobi),
        Just(sor(1.0)),
        (1.0..1.8_f64).prop_map(sor)
    ];
    let clamp = prop_oneof![Just(None), Just(Some([0.1, 0.9]))];
    (measure, relaxation, clamp, 1..40_usize).prop_map(|(measure, relaxation, clamp, max_sweeps)| {
        (Relaxation { clamp, ..relaxation }, Stopping { measure, below: 0.0, max_sweeps })
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(60))]

    #[test]
    #[ignore = "needs a Vulkan driver: .ci/gpu"]
    fn sweeps_are_those_of_one_cell_after_the_other(case in any_case(40), (relaxation, stopping) in settings()) {
        let on_gpu = gpu().relax(&case.problem(), &relaxation, &stopping).unwrap();
        // It ends earlier where nothing changes any more.
        prop_assert!(on_gpu.sweeps == stopping.max_sweeps || on_gpu.ending == Ending::Converged);
        let (expected, measures) = case.relaxed(&relaxation, stopping.measure, stopping.max_sweeps);
        let greatest = expected.iter().chain(&case.values).fold(1.0, |most: f64, value| most.max(value.abs()));
        let tolerance = stopping.max_sweeps as f64 * ROUNDING * greatest * MAGNIFIED.powf(f64::from(relaxation.factor(case.cells) > 1.0));
        let off = greatest_difference(&on_gpu.values, &expected);
        prop_assert!(off <= tolerance, "off by {off:e}, not {tolerance:e}");
        if on_gpu.sweeps == stopping.max_sweeps && stopping.measure != Measure::GreatestRelativeChange {
            let (own, count) = (measures[on_gpu.sweeps - 1], case.values.len() as f64);
            if own.is_finite() {
                // Each change is off by what two values are, squares by twice the change more.
                let slack = 4.0 * tolerance * count * (1.0 + greatest);
                prop_assert!((on_gpu.change - own).abs() <= slack + 1e-4 * own, "{} is {own}", on_gpu.change);
            }
        }
    }
}

/// Returns a square with walls around it and a goal in its middle. Free cells start at 0.
fn square(n: usize) -> Case {
    let mut values = vec![0.0; n * n];
    let mut unknown = vec![true; n * n];
    (values[n / 2 * n + n / 2], unknown[n / 2 * n + n / 2]) = (1.0, false);
    Case {
        cells: [n; 2],
        boundaries: [Boundary::High; 2],
        outside: 0.0,
        values,
        unknown,
        equations: CellEquations::Mean,
    }
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn rules_end_where_they_end_one_by_one() {
    let case = square(41);
    for (measure, below) in [
        (Measure::SumOfChange, 1e-2),
        (Measure::SumOfSquares, 1e-6),
        (Measure::GreatestChange, 1e-4),
        (Measure::GreatestRelativeChange, 1e-4),
        (Measure::DifferenceOfSums, 1e-3),
    ] {
        for relaxation in [Relaxation::JACOBI, sor(1.0)] {
            let stopping = Stopping { measure, below, max_sweeps: 10_000 };
            let on_gpu = gpu().relax(&case.problem(), &relaxation, &stopping).unwrap();
            let (_, measures) = case.relaxed(&relaxation, measure, 2_000);
            let expected = 1 + measures.iter().position(|&m| m < below).expect("it converges");
            assert_eq!(on_gpu.ending, Ending::Converged);
            // A sum of rounded numbers may fall below the bound a sweep earlier or later.
            assert!(
                on_gpu.sweeps.abs_diff(expected) <= 1 + expected / 200,
                "{measure:?}: {} is {expected}",
                on_gpu.sweeps
            );
        }
    }
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn the_floor_of_single_precision_is_reported() {
    let case = square(33);
    let exact = case.solved().unwrap();
    let mut floors = 0;
    for factor in [1.0, 1.5, 1.8, 1.9] {
        // A bound that nothing but rest meets, and factors that do not let values rest.
        let measure = Measure::GreatestRelativeChange;
        let stopping = Stopping { measure, below: 1e-12, max_sweeps: 20_000 };
        let on_gpu = gpu().relax(&case.problem(), &sor(factor), &stopping).unwrap();
        assert_ne!(on_gpu.ending, Ending::Unconverged, "{factor}: {:e}", on_gpu.change);
        floors += u32::from(on_gpu.ending == Ending::Floor);
        // Gauss-Seidel's changes are lost in rounding long before the error is.
        let off = greatest_difference(&on_gpu.values, &exact);
        assert!(off < 2e-5, "{factor}: {off:e} after {} sweeps", on_gpu.sweeps);
    }
    assert!(floors > 0);
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn divergence_is_reported_with_its_cell() {
    let stopping = Stopping { max_sweeps: 100_000, ..PUBLISHED };
    let error = gpu().relax(&square(20).problem(), &sor(2.5), &stopping).expect_err("factors above 2 diverge");
    let GpuError::Diverged { cell, value, sweeps } = error else { panic!("{error}") };
    assert!(
        cell.iter().all(|&at| at < 20) && (value.is_nan() || value.abs() > 1e20) && sweeps < 1_000,
        "{cell:?} {value}"
    );
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn the_same_comes_out_each_time() {
    let (case, relaxation) = (square(64), sor(1.7));
    let once = gpu().relax(&case.problem(), &relaxation, &PUBLISHED).unwrap();
    for _ in 0..3 {
        assert_eq!(gpu().relax(&case.problem(), &relaxation, &PUBLISHED).unwrap(), once);
    }
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn problems_without_unknowns_return_at_once() {
    let mut case = square(5);
    case.unknown = vec![false; 25];
    let done = gpu().relax(&case.problem(), &sor(1.0), &PUBLISHED).unwrap();
    assert_eq!((done.values, done.sweeps, done.ending), (case.values, 0, Ending::Converged));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let Case { cells, boundaries, values, unknown, .. } = square(3);
    let new =
        |values, equations| cplan_gpu::GridEquations::new(cells, boundaries, 0.0, values, unknown.clone(), equations);
    assert!(matches!(new(vec![0.0; 8], CellEquations::Mean), Err(GpuError::Refused(_))));
    assert!(matches!(new(vec![f64::NAN; 9], CellEquations::Mean), Err(GpuError::Refused(_))));
    assert!(matches!(new(values.clone(), CellEquations::Altered(vec![0.0; 3])), Err(GpuError::Refused(_))));
    assert!(matches!(
        new(values.clone(), CellEquations::Weights(vec![[f64::INFINITY; 4]; 9])),
        Err(GpuError::Refused(_))
    ));
    assert!(new(values, CellEquations::Mean).is_ok());
}

proptest! {
    #![proptest_config(cplan_cases::cases(12))]

    #[test]
    #[ignore = "needs a Vulkan driver: .ci/gpu"]
    fn converged_fields_are_solutions(case in case(Kind::Upwind, 16)) {
        let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-7, max_sweeps: 20_000 };
        let on_gpu = gpu().relax(&case.problem(), &sor(1.0), &stopping).unwrap();
        let Some(solution) = case.solved() else { return Ok(()) };
        prop_assert!(on_gpu.ending != Ending::Unconverged);
        // The remaining error after small changes is the change times the number of sweeps for which an error persists.
        prop_assert!(greatest_difference(&on_gpu.values, &solution) < 1e-3, "{}", greatest_difference(&on_gpu.values, &solution));
    }
}
