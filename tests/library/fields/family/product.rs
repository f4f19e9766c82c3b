//! Every equation with every relaxation in every order on every kind of domain.

use super::direct::{drawn, solution};
use cplan::field::{
    Boundary, Difference, Direction, Domain, Equation, Factor, Influence, Levels, Lines, Measure, Order, RelaxError,
    Relaxation, Scan, Scheme, Stopping, drift_around_robots, relax,
};

const ROOM: &str = "
    ..........
    ..G#...#..
    ...#...#..
    ...###.#..
    .......#..
    .####.....
    ......##..";

const EVEN: &str = "
    ..#...#.
    .G#...#.
    ..####..
    ........
    #.##..##
    ........";

fn domains() -> Vec<Domain> {
    let mut domains = Vec::new();
    for levels in [Levels::PUBLISHED, Levels::PROBABILITY] {
        for (text, boundaries) in [
            (ROOM, [Boundary::High, Boundary::High]),
            (ROOM, [Boundary::Reflecting, Boundary::Reflecting]),
            (ROOM, [Boundary::Periodic, Boundary::Periodic]),
            (ROOM, [Boundary::Periodic, Boundary::Reflecting]),
            (EVEN, [Boundary::Periodic, Boundary::Periodic]),
            (EVEN, [Boundary::High, Boundary::Periodic]),
        ] {
            domains.push(drawn(text, boundaries, levels));
        }
    }
    domains
}

fn equations(domain: &Domain) -> Vec<Equation> {
    let direction = Direction::of([1.0, -2.0]).unwrap();
    let robots = [
        Influence { center: [1.0, 5.5], radius: 2.5, drift: [1.2, 0.9] },
        Influence { center: [4.0, 1.0], radius: 1.5, drift: [0.0, -1.5] },
    ];
    let epsilon: Vec<f64> = (0..domain.kinds().len()).map(|cell| [0.0, 0.5, -0.5, 1.5][cell / 3 % 4]).collect();
    let mut equations = vec![Equation::Harmonic, Equation::AlteredPreference { epsilon: epsilon.clone() }];
    for difference in [Difference::Central, Difference::Upwind] {
        equations.extend([
            Equation::Oriented { direction, epsilon: 0.8, difference },
            Equation::LocallyOriented { drift: drift_around_robots(domain, &robots), difference },
            Equation::Preference { epsilon: epsilon.clone(), difference },
        ]);
    }
    // The drift is larger than central differences allow.
    equations.push(Equation::Oriented { direction, epsilon: 5.0, difference: Difference::Upwind });
    equations
}

fn relaxations() -> Vec<Relaxation> {
    let orders = [
        Order::Lines(Scan::ROWS),
        Order::Lines(Scan { lines: Lines::Columns, falling: [true, false] }),
        Order::Corners(Lines::Rows),
        Order::Corners(Lines::Columns),
        Order::RedBlack,
    ];
    let mut relaxations = vec![Relaxation::JACOBI, Relaxation::weighted_jacobi(0.7)];
    for order in orders {
        relaxations.push(Relaxation::gauss_seidel(order));
        relaxations.extend(
            [Factor::Given(1.3), Factor::Given(0.8), Factor::Formula]
                .map(|f| Relaxation::sor(f, order).relaxing_preferences()),
        );
    }
    relaxations
}

#[test]
fn every_combination_converges_to_the_direct_solution_or_is_reported_as_divergent() {
    let stopping = Stopping { measure: Measure::GreatestChange, below: 1e-13, max_sweeps: 20_000 };
    let (mut converged, mut diverged) = (0, Vec::new());
    for domain in domains() {
        for equation in equations(&domain) {
            let expected = solution(&domain, &equation);
            for relaxation in relaxations() {
                let what = format!("{:?} {:?} {equation:?} {relaxation}", domain.boundaries(), domain.levels());
                let field = match relax(&domain, &equation, &relaxation, &stopping) {
                    Err(RelaxError::Diverged { .. }) => {
                        diverged.push((equation.clone(), relaxation, domain.boundaries()));
                        continue;
                    }
                    field => field.unwrap_or_else(|e| panic!("{what}: {e}")),
                };
                assert!(field.converged(), "{what}: {:?}", field.stages);
                let error = field.values.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < 1e-9, "{what}: {error:e} off");
                converged += 1;
            }
        }
    }
    assert_eq!(converged + diverged.len(), 12 * 9 * 22);
    // A factor that is good for Laplace's equation is bad for a strong drift around circles.
    let expected = |(equation, relaxation, boundaries): &(Equation, Relaxation, [Boundary; 2])| {
        let strong = matches!(equation, Equation::Oriented { epsilon: 5.0, .. });
        let formula = matches!(relaxation.scheme, Scheme::Successive { factor: Factor::Formula, .. });
        strong && formula && *boundaries == [Boundary::Periodic; 2]
    };
    assert!(diverged.iter().all(expected), "{diverged:?}");
    assert_eq!(diverged.len(), 6);
}
