//! Measures of a sweep, and areas in which robots have influence: small cases, computed by hand.

use super::direct::drawn;
use cplan::field::{Boundary, Equation, Influence, Levels, Measure, Relaxation, Stopping, drift_around_robots, relax};

/// Returns the value of a stopping measure after each of the first sweeps on the cells `#.G`, with walls above and
/// below. In each sweep, the only free cell moves half of the remaining distance to 3/4.
fn measures(measure: Measure) -> Vec<f64> {
    let domain = drawn("#.G", [Boundary::High; 2], Levels::PUBLISHED);
    let relaxation = Relaxation::weighted_jacobi(0.5);
    let after = |max_sweeps| {
        let stopping = Stopping { measure, below: 0.0, max_sweeps };
        relax(&domain, &Equation::Harmonic, &relaxation, &stopping).unwrap().change()
    };
    (0..4).map(after).collect()
}

#[test]
fn measures_match_their_definitions() {
    // The values of the cell are 0, 3/8, 9/16, 21/32.
    let changes = [f64::INFINITY, 0.375, 0.1875, 0.09375];
    assert_eq!(measures(Measure::SumOfChange), changes);
    assert_eq!(measures(Measure::GreatestChange), changes);
    assert_eq!(measures(Measure::SumOfSquares), changes.map(|change| change * change));
    assert_eq!(measures(Measure::GreatestRelativeChange), [f64::INFINITY, 1.0, 1.0 / 3.0, 1.0 / 7.0]);
    assert_eq!(measures(Measure::DifferenceOfSums), [f64::INFINITY, f64::INFINITY, 0.1875, 0.09375]);
}

#[test]
fn several_cells_are_summed_or_compared() {
    let domain = drawn("#..G", [Boundary::High; 2], Levels::PUBLISHED);
    let relaxation = Relaxation::JACOBI;
    let after = |measure| {
        let stopping = Stopping { measure, below: 0.0, max_sweeps: 1 };
        relax(&domain, &Equation::Harmonic, &relaxation, &stopping).unwrap().change()
    };
    // The values tend to 3/4 with three walls, and to 1/2 with two.
    assert_eq!(after(Measure::SumOfChange), 1.25);
    assert_eq!(after(Measure::SumOfSquares), 0.5625 + 0.25);
    assert_eq!(after(Measure::GreatestChange), 0.75);
}

#[test]
fn a_relaxation_ends_in_the_first_sweep_below_the_bound() {
    let domain = drawn("#.G", [Boundary::High; 2], Levels::PUBLISHED);
    let ended = |below| {
        let stopping = Stopping { measure: Measure::SumOfChange, below, max_sweeps: 100 };
        let field = relax(&domain, &Equation::Harmonic, &Relaxation::weighted_jacobi(0.5), &stopping).unwrap();
        assert!(field.converged());
        field.sweeps()
    };
    assert_eq!([0.38, 0.375, 0.18, 0.09].map(ended), [1, 2, 3, 4]);
}

#[test]
fn each_cell_follows_the_nearest_robot_within_its_radius() {
    let domain = drawn(&".......\n".repeat(3), [Boundary::High; 2], Levels::PUBLISHED);
    let robots = [
        Influence { center: [1.0, 1.0], radius: 2.5, drift: [1.0, 0.0] },
        Influence { center: [1.0, 4.0], radius: 1.1, drift: [0.0, 1.0] },
    ];
    let shown: Vec<char> = drift_around_robots(&domain, &robots)
        .into_iter()
        .map(|drift| {
            if drift == [1.0, 0.0] {
                'a'
            } else if drift == [0.0, 1.0] {
                'b'
            } else {
                '.'
            }
        })
        .collect();
    // (0, 3) is within the radius of the first robot. It is nearer to the second one, but outside its radius.
    assert_eq!(shown.iter().collect::<String>(), "aaa.b..aaabbb.aaa.b..");
}
