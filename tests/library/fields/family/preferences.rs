//! Over-relaxation with preferences, compared with plain loops of the printed algorithms (L. E. Deicu 2012).

use super::direct::greatest_difference;
use cplan::engine::{CellCounts, field_on_cells};
use cplan::field::{
    Boundary, Cell, Difference, Domain, Equation, Factor, Levels, Limits, Lines, Measure, Order, Relaxation, Scan,
    Stencil, Stopping, relax,
};
use cplan::input::{Overrides, load};
use cplan::planner::EquationChoice;
use std::f64::consts::PI;
use std::path::Path;

/// The orders of the source, "simples" and "simultâneo".
const ORDERS: [Order; 2] = [Order::Lines(Scan::ROWS), Order::Corners(Lines::Rows)];

/// Number of sweeps of each stage that are compared. After many sweeps, rounding of a case that diverges would grow.
const COMPARED_SWEEPS: usize = 12;

/// Returns true for a cell of a rectangle, given in hundredths of the side.
fn within(n: usize, cell: usize, [low, high]: [[usize; 2]; 2]) -> bool {
    let at = [cell / n, cell % n].map(|k| 100 * k / n);
    (0..2).all(|k| (low[k]..high[k]).contains(&at[k]))
}

/// Returns a room of `n x n` cells with two walls and a block, and the preference of each cell.
fn room(n: usize) -> (Domain, Vec<f64>) {
    let walls = [[[30, 0], [33, 70]], [[60, 30], [63, 100]], [[75, 10], [90, 20]]];
    let kind = |cell: usize| match cell {
        _ if [cell / n, cell % n].iter().any(|&k| k == 0 || k == n - 1) => Cell::Obstacle,
        _ if walls.iter().any(|&wall| within(n, cell, wall)) => Cell::Obstacle,
        _ if within(n, cell, [[5, 5], [8, 8]]) => Cell::Goal,
        _ => Cell::Free,
    };
    let regions = [([[10, 20], [25, 60]], 0.5), ([[40, 40], [50, 95]], -0.5), ([[66, 66], [90, 80]], 0.5)];
    let strength = |cell: usize| regions.iter().find(|region| within(n, cell, region.0)).map_or(0.0, |region| region.1);
    let kinds = (0..n * n).map(kind).collect();
    (Domain::new([n, n], kinds, [Boundary::High; 2], Levels::PUBLISHED), (0..n * n).map(strength).collect())
}

/// The field and both numbers of sweeps by the printed algorithm. `p +` is missing in lines 18 of tables 10, 11, 14 and
/// 15, and line 13 has the wrong sign.
struct Printed {
    values: Vec<f64>,
    sweeps: [usize; 2],
}

impl Printed {
    fn new(domain: &Domain, preference: &[f64], is_bvp2: bool, from_corners: bool) -> Self {
        let n = domain.cells()[0];
        let c = 2.0 * (PI / n as f64).cos();
        let w = 4.0 / (2.0 + (4.0 - c * c).sqrt());
        // Lines 1 to 10.
        let mut p: Vec<f64> = domain.kinds().iter().map(|&kind| f64::from(u8::from(kind == Cell::Obstacle))).collect();
        let mut vector = vec![[0.0; 2]; p.len()];
        let mut sweeps = [0; 2];
        #[expect(clippy::needless_range_loop, reason = "the stages of the printed algorithm")]
        for stage in 0..2 {
            if stage == 1 {
                for c in (0..p.len()).filter(|&c| domain.kinds()[c] == Cell::Free) {
                    let [x, y] = [p[c + n] - p[c - n], p[c + 1] - p[c - 1]];
                    let length = (x * x + y * y).sqrt();
                    vector[c] = if length > 0.0 { [x / length, y / length] } else { [0.0; 2] };
                }
            }
            loop {
                let corner = if from_corners { sweeps[stage] % 4 } else { 0 };
                let mut change = 0.0;
                for a in 0..n {
                    for b in 0..n {
                        let i = if corner >= 2 { n - 1 - a } else { a };
                        let c = i * n + if corner % 2 == 1 { n - 1 - b } else { b };
                        if domain.kinds()[c] != Cell::Free {
                            continue;
                        }
                        let (west, east, south, north) = (p[c - n], p[c + n], p[c - 1], p[c + 1]);
                        let mut new = p[c] + w / 4.0 * (west + east + south + north - 4.0 * p[c]);
                        if stage == 1 && is_bvp2 {
                            new += preference[c] / 4.0 * ((east - west).abs() / 2.0 + (north - south).abs() / 2.0);
                        } else if stage == 1 {
                            let d = (east - west) * vector[c][0] + (north - south) * vector[c][1];
                            new += preference[c] / 8.0 * d;
                        }
                        change += (new - p[c]).abs();
                        p[c] = new;
                    }
                }
                sweeps[stage] += 1;
                if change < 0.01 || sweeps[stage] == COMPARED_SWEEPS {
                    break;
                }
            }
        }
        Self { values: p, sweeps }
    }
}

fn equation(is_bvp2: bool, epsilon: Vec<f64>) -> Equation {
    match is_bvp2 {
        true => Equation::AlteredPreference { epsilon },
        false => Equation::Preference { epsilon, difference: Difference::Central },
    }
}

const SUMS: Stopping = Stopping { measure: Measure::SumOfChange, below: 0.01, max_sweeps: 3_000 };

#[test]
fn over_relaxation_adds_preferences_as_the_printed_tables_do() {
    let few = Stopping { max_sweeps: COMPARED_SWEEPS, ..SUMS };
    for (n, is_bvp2) in [(100, false), (100, true), (250, false), (250, true)] {
        let (domain, preference) = room(n);
        for (from_corners, order) in [false, true].into_iter().zip(ORDERS) {
            let expected = Printed::new(&domain, &preference, is_bvp2, from_corners);
            let sor = Relaxation::sor(Factor::Formula, order);
            let field = relax(&domain, &equation(is_bvp2, preference.clone()), &sor, &few).unwrap();
            let sweeps: Vec<usize> = field.stages.iter().map(|stage| stage.sweeps).collect();
            assert_eq!(sweeps, expected.sweeps, "{n} {is_bvp2} {order}");
            let off = greatest_difference(&field.values, &expected.values);
            let greatest = expected.values.iter().fold(1.0, |greatest: f64, value| greatest.max(value.abs()));
            assert!(off < 1e-9 * greatest, "{n} {is_bvp2} {order}: {off:e}");
        }
    }
}

/// Checks both limits of over-relaxation against Gauss-Seidel relaxation, which has no factor to multiply.
#[test]
fn the_limit_of_over_relaxation_has_epsilon_over_the_factor_or_epsilon() {
    let (domain, preference) = room(30);
    let settled = Stopping { below: 1e-12, max_sweeps: 100_000, ..SUMS };
    let factor = 1.5;
    let sor = Relaxation::sor(Factor::Given(factor), ORDERS[0]);
    for is_bvp2 in [false, true] {
        let limit = |relaxation: Relaxation, share: f64| {
            let epsilon = preference.iter().map(|epsilon| share * epsilon).collect();
            let field = relax(&domain, &equation(is_bvp2, epsilon), &relaxation, &settled).unwrap();
            assert!(field.converged());
            field.values
        };
        let gauss_seidel = |share: f64| limit(Relaxation::gauss_seidel(ORDERS[0]), share);
        let [divided, whole] = [1.0 / factor, 1.0].map(gauss_seidel);
        assert!(greatest_difference(&divided, &whole) > 1e-3, "the limits do not differ in this case");
        assert!(greatest_difference(&limit(sor, 1.0), &divided) < 1e-9);
        assert!(greatest_difference(&limit(sor.relaxing_preferences(), 1.0), &whole) < 1e-9);
    }
}

/// Relaxes BVP and BVP 2 on the three published maps, in both orders, with 100 and 250 cells. With the sign of the
/// algorithm, BVP 2 from corners may not settle on 250 x 250 cells of maps 1 and 2: then the result says so.
#[test]
fn over_relaxed_preferences_never_leave_the_range_and_converge_in_22_of_24_published_cases() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut cases = 0;
    for map in ["leon", "rings", "pillars"] {
        let world = root.join("workspaces/maps").join(map).with_extension("toml");
        let problem = load(root.join("robots/room_gantry.urdf"), &world, &Overrides::default()).unwrap().problem;
        for n in [100, 250] {
            let (space, domain) = field_on_cells(&problem, CellCounts::square(n), Limits::High).unwrap();
            for choice in [
                EquationChoice::Preference { elsewhere: 0.0, difference: Difference::Central },
                EquationChoice::AlteredPreference { elsewhere: 0.0 },
            ] {
                let equation = choice.on(&space, Stencil::Square).unwrap();
                for order in ORDERS {
                    let sor = Relaxation::sor(Factor::Formula, order).guarded();
                    let field = relax(&domain, &equation, &sor, &SUMS);
                    let field = field.unwrap_or_else(|error| panic!("{map} {n} {choice} {order}: {error}"));
                    let is_hard = n == 250 && order == ORDERS[1] && map != "pillars" && is_altered(choice);
                    assert!(field.converged() || is_hard, "{map} {n} {choice} {order}: {:?}", field.stages);
                    let in_range = |value: &f64| (-1e-12..=1.0 + 1e-12).contains(value);
                    assert!(field.values.iter().all(in_range), "{map} {n} {choice} {order}");
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 24);
}

fn is_altered(choice: EquationChoice) -> bool {
    matches!(choice, EquationChoice::AlteredPreference { .. })
}
