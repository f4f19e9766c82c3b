//! Compares multigrid on the GPU with elimination.

use crate::gpu;
use crate::oracle::{Case, greatest_difference, linear};
use cplan_fields::{Boundary, CellEquations};
use cplan_gpu::{GpuError, Multigrid};
use proptest::prelude::*;

proptest! {
    #![proptest_config(cplan_cases::cases(40))]

    #[test]
    #[ignore = "needs a Vulkan driver: .ci/gpu"]
    fn solutions_are_those_of_elimination(case in linear(22)) {
        let Some(exact) = case.solved() else { return Ok(()) };
        // Unknowns that no given value reaches have no solution, or any.
        prop_assume!(exact.iter().all(|value| value.abs() < 2.0));
        let solved = gpu().solve(&case.problem(), &Multigrid::default()).unwrap();
        prop_assert!(solved.converged, "{} cycles, {:e}", solved.cycles, solved.residual);
        prop_assert!(greatest_difference(&solved.values, &exact) < 1e-9, "{:e}", greatest_difference(&solved.values, &exact));
    }
}

/// Returns a square with a goal in its middle and bars across it.
fn bars(n: usize) -> Case {
    let mut unknown = vec![true; n * n];
    for bar in 1..8 {
        let i = bar * n / 8;
        // Each with a gap at another end.
        let gap = if bar % 2 == 0 { 0..n / 16 } else { n - n / 16..n };
        (0..n).filter(|j| !gap.contains(j)).for_each(|j| unknown[i * n + j] = false);
    }
    let mut values = vec![0.0; n * n];
    let goal = (n / 2 + n / 16) * n + n / 2;
    (values[goal], unknown[goal]) = (1.0, false);
    Case {
        cells: [n; 2],
        boundaries: [Boundary::High, Boundary::Periodic],
        outside: 0.0,
        values,
        unknown,
        equations: CellEquations::Mean,
    }
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn cycles_do_not_grow_with_the_grid() {
    let mut cycles = Vec::new();
    for n in [64, 128, 256, 511] {
        let case = bars(n);
        let solved = gpu().solve(&case.problem(), &Multigrid { below: 1e-10, max_cycles: 60 }).unwrap();
        assert!(solved.converged, "{n}: {} cycles, {:e}", solved.cycles, solved.residual);
        cycles.push(solved.cycles);
    }
    assert!(cycles.iter().all(|&count| count <= 32), "{cycles:?}");
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn divergence_is_reported() {
    // Mirrors all round and nothing given but the start: any constant is a solution, and there is drift that fights it.
    let n = 24;
    let weights = vec![[0.25 - 2.0, 0.25 + 2.0, 0.25, 0.25]; n * n];
    let case = Case { equations: CellEquations::Weights(weights), ..bars(n) };
    let solved = gpu().solve(&case.problem(), &Multigrid::default()).unwrap();
    assert!(!solved.converged && solved.values.iter().all(|value| value.is_finite()), "{}", solved.residual);
}

#[test]
#[ignore = "needs a Vulkan driver: .ci/gpu"]
fn nonlinear_equations_are_refused() {
    let case = Case { equations: CellEquations::Altered(vec![0.1; 64]), ..bars(8) };
    assert!(matches!(gpu().solve(&case.problem(), &Multigrid::default()), Err(GpuError::Refused(_))));
}
