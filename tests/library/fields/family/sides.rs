//! Cells that are not square.

use super::direct::{drawn, greatest_difference, solution};
use cplan::field::{
    Boundary, Cell, Difference, Direction, Domain, Equation, Factor, Levels, Lines, Measure, Order, Relaxation,
    Stopping, by_multigrid, eliminated, relax,
};

const ROOM: &str = "
    ..........
    ..G#...#..
    ...#...#..
    ...###.#..
    .......#..
    .####.....
    ......##..";

const STOPPING: Stopping = Stopping { measure: Measure::GreatestChange, below: 1e-14, max_sweeps: 20_000 };

/// Checks the formula of source 000, section 3.3.2: `(p(-x) + p(+x) + beta^2 (p(-y) + p(+y))) / (2 (1 + beta^2))`.
#[test]
fn one_cell_is_the_weighted_mean_of_its_neighbors() {
    let beta = 2.0;
    let value = |text: &str, equation: &Equation| {
        let domain = drawn(text, [Boundary::High; 2], Levels::PROBABILITY).with_beta(beta);
        relax(&domain, equation, &Relaxation::JACOBI, &STOPPING).unwrap().values[4]
    };
    let [along, across] = ["### #.# #G#", "### #.G ###"];
    assert!((value(along, &Equation::Harmonic) - 0.1).abs() < 1e-15);
    assert!((value(across, &Equation::Harmonic) - 0.4).abs() < 1e-15);
    // A drift counts with the factor 1 along axis 1, and with `beta` along axis 2.
    let drift = |direction: [f64; 2], difference| {
        let direction = Direction::of(direction).unwrap();
        Equation::Oriented { direction, epsilon: 1.0, difference }
    };
    assert!((value(along, &drift([1.0, 0.0], Difference::Central)) - 1.5 / 10.0).abs() < 1e-15);
    assert!((value(across, &drift([0.0, 1.0], Difference::Central)) - 5.0 / 10.0).abs() < 1e-15);
    assert!((value(across, &drift([0.0, 1.0], Difference::Upwind)) - 6.0 / 12.0).abs() < 1e-15);
    assert!(
        !drift([0.0, 1.0], Difference::Central)
            .is_monotone_on(&drawn(along, [Boundary::High; 2], Levels::PROBABILITY).with_beta(0.5))
    );
}

#[test]
fn fields_on_cells_that_are_not_square_are_the_direct_solutions() {
    let direction = Direction::of([1.0, -2.0]).unwrap();
    for (beta, boundary) in [(2.0, Boundary::High), (1.4, Boundary::Reflecting), (0.8, Boundary::Periodic)] {
        for levels in [Levels::PUBLISHED, Levels::PROBABILITY] {
            let domain = drawn(ROOM, [boundary; 2], levels).with_beta(beta);
            let epsilon: Vec<f64> = (0..domain.kinds().len()).map(|cell| [0.0, 0.5, -0.5, 1.5][cell / 3 % 4]).collect();
            for equation in [
                Equation::Harmonic,
                Equation::Oriented { direction, epsilon: 0.8, difference: Difference::Central },
                Equation::Oriented { direction, epsilon: 5.0, difference: Difference::Upwind },
                Equation::Preference { epsilon: epsilon.clone(), difference: Difference::Central },
                Equation::AlteredPreference { epsilon },
            ] {
                let expected = solution(&domain, &equation);
                for relaxation in [
                    Relaxation::JACOBI,
                    Relaxation::gauss_seidel(Order::FourColors),
                    Relaxation::sor(Factor::Given(1.3), Order::Corners(Lines::Rows)).guarded().relaxing_preferences(),
                ] {
                    let field = relax(&domain, &equation, &relaxation, &STOPPING).unwrap();
                    let off = greatest_difference(&field.values, &expected);
                    assert!(off < 1e-9, "{beta} {boundary:?} {levels:?} {equation:?} {relaxation}: {off:e}");
                }
                if let Some(values) = eliminated(&domain, &equation) {
                    assert!(greatest_difference(&values, &expected) < 1e-9, "{beta} {boundary:?} {equation:?}");
                    let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-26, max_sweeps: 200 };
                    let solved = by_multigrid(&domain, &equation, &stopping, domain.start()).unwrap();
                    assert!(greatest_difference(&solved.values, &expected) < 1e-9, "{beta} {boundary:?} {equation:?}");
                }
            }
        }
    }
}

/// Compares two grids of a room whose length is twice its width: one with square cells, and one with the same number of
/// cells along both sides.
#[test]
fn cells_of_any_sides_give_the_field_of_the_room() {
    let room = |cells: [usize; 2], beta: f64| {
        let goal = |cell: usize| (cell / cells[1]) * 40 < cells[0] * 2 && (cell % cells[1]) * 20 < cells[1] * 2;
        let kinds = (0..cells[0] * cells[1]).map(|cell| if goal(cell) { Cell::Goal } else { Cell::Free });
        let domain = Domain::new(cells, kinds.collect(), [Boundary::High; 2], Levels::PROBABILITY).with_beta(beta);
        let values = eliminated(&domain, &Equation::Harmonic).unwrap();
        // At three quarters of the length, in the middle of the width: the mean of the cells around that place.
        let (i, j) = (cells[0] * 3 / 4, cells[1] / 2);
        let around = [[i, j], [i - 1, j], [i, j - 1], [i - 1, j - 1]].map(|[i, j]| values[i * cells[1] + j]);
        (around.iter().sum::<f64>() / 4.0).ln()
    };
    let square = room([80, 40], 1.0);
    let [anisotropic, plain] = [room([40, 40], 2.0), room([40, 40], 1.0)];
    assert!((anisotropic - square).abs() < 0.15, "{anisotropic} {square}");
    assert!((plain - square).abs() > 1.0, "{plain} {square}");
}
