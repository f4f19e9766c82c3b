//! Guarantees on random grids: the maximum principle, and that the goals are the only minima.

use cplan::field::{
    Boundary, Cell, DeadEnd, Difference, Direction, Domain, Equation, Factor, Levels, Lines, Measure, Neighbor, Order,
    Relaxation, Scan, Stopping, descend, relax,
};
use proptest::prelude::*;

use super::direct::drawn;

const BOUNDARIES: [Boundary; 3] = [Boundary::High, Boundary::Reflecting, Boundary::Periodic];

/// Generates domains of up to 8 x 8 cells with at least one goal. Cells that are not connected with a goal become
/// obstacles.
pub fn random_domain() -> impl Strategy<Value = Domain> {
    let shape = (1..9_usize, 1..9_usize, 0.0..0.6_f64);
    shape.prop_flat_map(|(rows, columns, density)| {
        let n = rows * columns;
        let blocked = proptest::collection::vec(proptest::bool::weighted(density), n);
        (blocked, 0..n, 0..3_usize, 0..3_usize, any::<bool>()).prop_map(
            move |(blocked, goal, first, second, published)| {
                let mut kinds: Vec<Cell> =
                    blocked.iter().map(|&b| if b { Cell::Obstacle } else { Cell::Free }).collect();
                kinds[goal] = Cell::Goal;
                let levels = if published { Levels::PUBLISHED } else { Levels::PROBABILITY };
                let boundaries = [BOUNDARIES[first], BOUNDARIES[second]];
                let all = Domain::new([rows, columns], kinds.clone(), boundaries, levels);
                let reached = flood(&all, goal);
                for (kind, reached) in kinds.iter_mut().zip(reached) {
                    *kind = if reached { *kind } else { Cell::Obstacle };
                }
                Domain::new([rows, columns], kinds, boundaries, levels)
            },
        )
    })
}

/// Returns the cells that are connected with a goal, found by repeated passes over all cells.
fn flood(domain: &Domain, goal: usize) -> Vec<bool> {
    let [rows, columns] = domain.cells();
    let mut reached = vec![false; rows * columns];
    reached[goal] = true;
    let wraps = domain.boundaries().map(|b| b == Boundary::Periodic);
    let near = |a: usize, b: usize, n: usize, wraps: bool| {
        let d = a.abs_diff(b);
        if wraps { d.min(n - d) } else { d }
    };
    for _ in 0..rows * columns {
        for a in 0..rows * columns {
            for b in 0..rows * columns {
                let apart =
                    near(a / columns, b / columns, rows, wraps[0]) + near(a % columns, b % columns, columns, wraps[1]);
                reached[a] |= reached[b] && apart <= 1 && domain.kinds()[a] != Cell::Obstacle;
            }
        }
    }
    reached
}

/// Generates a monotone equation. Drifts are so small that no difference of values within 8 cells is lost in rounding.
pub fn monotone(n: usize) -> impl Strategy<Value = Equation> {
    let difference = prop_oneof![Just(Difference::Central), Just(Difference::Upwind)];
    let vector = [-1.0..1.0_f64, -1.0..1.0_f64];
    prop_oneof![
        Just(Equation::Harmonic),
        (vector, -1.9..1.9_f64, difference.clone()).prop_map(|(v, epsilon, difference)| {
            let direction = Direction::of(v).unwrap_or(Direction::of([1.0, 0.0]).unwrap());
            let epsilon = if difference == Difference::Upwind { 1.5 * epsilon } else { epsilon };
            Equation::Oriented { direction, epsilon, difference }
        }),
        (proptest::collection::vec([-1.9..1.9_f64, -1.9..1.9_f64], n), difference.clone())
            .prop_map(|(drift, difference)| Equation::LocallyOriented { drift, difference }),
        (proptest::collection::vec(-1.9..1.9_f64, n), difference)
            .prop_map(|(epsilon, difference)| Equation::Preference { epsilon, difference }),
        proptest::collection::vec(-1.9..1.9_f64, n).prop_map(|epsilon| Equation::AlteredPreference { epsilon }),
    ]
}

/// Generates relaxations without over-relaxation, for which the guarantees hold after any number of sweeps.
fn relaxations_with_guarantees() -> impl Strategy<Value = Relaxation> {
    prop_oneof![
        Just(Relaxation::JACOBI),
        Just(Relaxation::weighted_jacobi(0.6)),
        Just(Relaxation::gauss_seidel(Order::Lines(Scan::ROWS))),
        Just(Relaxation::gauss_seidel(Order::Corners(Lines::Columns))),
        Just(Relaxation::gauss_seidel(Order::RedBlack)),
        Just(Relaxation::sor(Factor::Given(0.7), Order::Corners(Lines::Rows))),
    ]
}

fn random_case() -> impl Strategy<Value = (Domain, Equation, Relaxation)> {
    random_domain().prop_flat_map(|domain| {
        let n = domain.kinds().len();
        (Just(domain), monotone(n), relaxations_with_guarantees())
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(400))]

    #[test]
    fn values_stay_within_the_fixed_ones_however_early_the_relaxation_ends(
        (domain, equation, relaxation) in random_case(),
        max_sweeps in 0..40_usize,
    ) {
        prop_assert!(equation.is_monotone());
        let stopping = Stopping { measure: Measure::SumOfChange, below: 0.0, max_sweeps };
        let field = relax(&domain, &equation, &relaxation, &stopping).unwrap();
        // The weights of an update add up to 1 only up to rounding.
        prop_assert!(field.values.iter().all(|&v| (-1e-12..=1.0 + 1e-12).contains(&v)), "{:?}", field.values);
    }

    #[test]
    fn from_everywhere_the_converged_field_leads_to_the_goal((domain, equation, relaxation) in random_case()) {
        let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-15, max_sweeps: 30_000 };
        let field = relax(&domain, &equation, &relaxation, &stopping).unwrap();
        for (cell, kind) in domain.kinds().iter().enumerate() {
            // No obstacle is connected with cells that goals and reflecting limits enclose. The only field there is
            // constant.
            let shut_in = (field.values[cell] - domain.levels().goal).abs() < 1e-9;
            if *kind == Cell::Free && !shut_in {
                let way = descend(&domain, &field.values, cell);
                prop_assert!(leads_to_goal(&domain, &field.values, &way), "{way:?} in {:?}", field.values);
            }
        }
    }
}

/// Returns true if a path reaches a goal, or if it ends beside a cell whose value is equal up to rounding. The second
/// case occurs because reflecting limits can make a field exactly level around a cell. Then rounding decides whether
/// the computed values are level, too, or have a minimum.
fn leads_to_goal(domain: &Domain, values: &[f64], way: &Result<Vec<usize>, DeadEnd>) -> bool {
    let Err(stuck) = way else { return true };
    let level = |neighbor: Neighbor| matches!(neighbor, Neighbor::Cell(n) if (values[n] - stuck.value).abs() < 1e-14);
    domain.boundaries().contains(&Boundary::Reflecting) && domain.neighbors(stuck.cell).into_iter().any(level)
}

/// Checks a case that the property test above found: a field that is level around the cell in the last row, except for
/// rounding.
#[test]
fn rounding_noise_in_flat_fields_is_reported() {
    let domain = drawn("G...\n...#\n....\n.#..", [Boundary::Reflecting; 2], Levels::PUBLISHED);
    let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-15, max_sweeps: 30_000 };
    let relaxation = Relaxation::gauss_seidel(Order::Corners(Lines::Columns));
    let field = relax(&domain, &Equation::Harmonic, &relaxation, &stopping).unwrap();
    for cell in (0..16).filter(|&cell| domain.kinds()[cell] == Cell::Free) {
        let way = descend(&domain, &field.values, cell);
        assert!(leads_to_goal(&domain, &field.values, &way), "{way:?} in {:?}", field.values);
    }
}

#[test]
fn a_field_that_is_level_about_a_corner_is_crossed() {
    let domain = drawn("..#\n...\n#.G", [Boundary::Reflecting; 2], Levels::PROBABILITY);
    let stopping = Stopping { measure: Measure::GreatestChange, below: 0.0, max_sweeps: 10_000 };
    let relaxation = Relaxation::gauss_seidel(Order::Lines(Scan::ROWS));
    let field = relax(&domain, &Equation::Harmonic, &relaxation, &stopping).unwrap();
    // The values in sevenths are 1 1 0, 1 2 3, 0 3 7.
    let sevenths = [1.0, 1.0, 0.0, 1.0, 2.0, 3.0, 0.0, 3.0, 7.0];
    assert!(field.values.iter().zip(sevenths).all(|(value, expected)| (7.0 * value - expected).abs() < 1e-12));
    let way = descend(&domain, &sevenths.map(|value| value / 7.0), 0).unwrap();
    assert_eq!(way, [0, 3, 4, 7, 8]);
    // A path crosses no cell with the value of obstacles or of goals, and leaves no minimum.
    let at = |values: [f64; 9]| descend(&domain, &values, 0).unwrap_err();
    let zeros = [0.0, 0.0, 0.0, 0.0, 0.2, 0.3, 0.0, 0.3, 1.0];
    assert_eq!(at(zeros), DeadEnd { cell: 0, value: 0.0, flat: true });
    let ones = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0];
    assert_eq!(at(ones), DeadEnd { cell: 0, value: 1.0, flat: true });
    let peak = [0.3, 0.1, 0.0, 0.1, 0.2, 0.3, 0.0, 0.3, 1.0];
    assert_eq!(at(peak), DeadEnd { cell: 0, value: 0.3, flat: false });
}
