//! All equations and relaxations of the family on both devices.

use cplan::field::{
    Boundary, Cell, Device, Difference, Direction, Domain, Equation, Factor, Levels, Measure, Order, RelaxError,
    Relaxation, Stopping, relax_on,
};
use proptest::prelude::*;

/// Number of sweeps per stage before fields are compared. No stopping rule ends a stage earlier.
const SWEEPS: usize = 25;

/// Tolerance for single precision. Each update of a sweep is off by some units in the last place of the greatest value,
/// which is 1. The direction of a drift that follows a field is less accurate if that field is nearly level.
const ROUNDING: f64 = 4.0 / (1 << 24) as f64;

fn domain() -> impl Strategy<Value = Domain> {
    let boundary = || prop_oneof![Just(Boundary::Periodic), Just(Boundary::High), Just(Boundary::Reflecting)];
    let levels = prop_oneof![Just(Levels::PUBLISHED), Just(Levels::PROBABILITY)];
    ([2..33_usize, 2..33], [boundary(), boundary()], levels).prop_flat_map(|(cells, boundaries, levels)| {
        let kind = prop_oneof![8 => Just(Cell::Free), 2 => Just(Cell::Obstacle), 1 => Just(Cell::Goal)];
        let kinds = prop::collection::vec(kind, cells[0] * cells[1]);
        kinds.prop_map(move |kinds| Domain::new(cells, kinds, boundaries, levels))
    })
}

fn linear(domain: &Domain, drift: [f64; 2], which: usize) -> Equation {
    let difference = if which.is_multiple_of(2) { Difference::Central } else { Difference::Upwind };
    let direction = Direction::of(drift).unwrap_or(Direction::of([1.0, 0.0]).unwrap());
    let cells = 0..domain.kinds().len();
    match which {
        0 | 1 => Equation::Harmonic,
        2 | 3 => Equation::Oriented { direction, epsilon: drift[0].hypot(drift[1]), difference },
        _ => {
            let drift = cells.map(|cell| drift.map(|b| b * ((cell % 7) as f64 - 3.0) / 3.0)).collect();
            Equation::LocallyOriented { drift, difference }
        }
    }
}

fn relaxation() -> impl Strategy<Value = Relaxation> {
    prop_oneof![
        Just(Relaxation::JACOBI),
        (0.3..1.0_f64).prop_map(Relaxation::weighted_jacobi),
        Just(Relaxation::gauss_seidel(Order::RedBlack)),
        Just(Relaxation::sor(Factor::Formula, Order::RedBlack)),
        (1.0..1.8_f64).prop_map(|factor| Relaxation::sor(Factor::Given(factor), Order::RedBlack).clamped([0.0, 1.0]))
    ]
}

fn difference_from_cpu(domain: &Domain, equation: &Equation, relaxation: &Relaxation, stopping: &Stopping) -> f64 {
    cplan::bring_gpu();
    let [cpu, gpu] =
        [Device::Cpu, Device::Gpu].map(|on| relax_on(on, domain, equation, relaxation, stopping).expect("a field"));
    assert_eq!(cpu.stages.len(), gpu.stages.len());
    for (cell, kind) in domain.kinds().iter().enumerate().filter(|(_, kind)| **kind != Cell::Free) {
        assert_eq!(cpu.values[cell], gpu.values[cell], "{kind:?}");
    }
    cpu.values.iter().zip(&gpu.values).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

proptest! {
    #![proptest_config(cplan_cases::cases(48))]

    #[test]
    #[ignore = "needs a Vulkan driver: .ci/gpu"]
    fn sweeps_of_linear_equations_equal_those_of_the_cpu(
        domain in domain(), drift in [-1.3..1.3_f64, -1.3..1.3], which in 0..6_usize, relaxation in relaxation(),
    ) {
        let stopping = Stopping { measure: Measure::SumOfSquares, below: 0.0, max_sweeps: SWEEPS };
        let off = difference_from_cpu(&domain, &linear(&domain, drift, which), &relaxation, &stopping);
        // Over-relaxation magnifies rounding.
        let magnified = if relaxation.factor(domain.cells()) > 1.0 { 20.0 } else { 1.0 };
        prop_assert!(off <= SWEEPS as f64 * ROUNDING * magnified, "off by {off:e}");
    }

    #[test]
    #[ignore = "needs a Vulkan driver: .ci/gpu"]
    fn converged_preferences_equal_those_of_the_cpu(domain in domain(), epsilon in -0.9..0.9_f64, which in 0..3_usize) {
        let epsilon: Vec<f64> =
            (0..domain.kinds().len()).map(|cell| if cell % 3 == 0 { epsilon } else { 0.0 }).collect();
        let equation = match which {
            0 => Equation::Preference { epsilon, difference: Difference::Central },
            1 => Equation::Preference { epsilon, difference: Difference::Upwind },
            _ => Equation::AlteredPreference { epsilon },
        };
        let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-7, max_sweeps: 10_000 };
        let relaxation = Relaxation::gauss_seidel(Order::RedBlack);
        // If the harmonic field is nearly level, rounding decides its direction. The values hardly depend on that
        // direction.
        let off = difference_from_cpu(&domain, &equation, &relaxation, &stopping);
        prop_assert!(off <= 5e-3, "off by {off:e}");
    }
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn unsupported_gpu_options_are_reported() {
    cplan::bring_gpu();
    let domain = Domain::new([2, 2], vec![Cell::Free; 4], [Boundary::High; 2], Levels::PUBLISHED);
    let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-3, max_sweeps: 10 };
    let rows = Relaxation::gauss_seidel(Order::Lines(cplan::field::Scan::ROWS));
    let error = relax_on(Device::Gpu, &domain, &Equation::Harmonic, &rows, &stopping).expect_err("no rows");
    assert!(matches!(&error, RelaxError::Refused(reason) if reason.contains("red-black")), "{error}");
    let wild = Relaxation::sor(Factor::Given(3.0), Order::RedBlack);
    let stopping = Stopping { max_sweeps: 10_000, ..stopping };
    let start =
        Domain::new([9, 9], [vec![Cell::Goal], vec![Cell::Free; 80]].concat(), [Boundary::High; 2], Levels::PUBLISHED);
    let error = relax_on(Device::Gpu, &start, &Equation::Harmonic, &wild, &stopping).expect_err("it diverges");
    assert!(matches!(&error, RelaxError::Diverged { hint, .. } if hint.contains("too great")), "{error}");
}
