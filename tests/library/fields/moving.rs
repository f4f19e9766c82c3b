//! Fields among moving obstacles, against direct solutions for each moment.

use super::family::direct::{greatest_difference, solution};
use cplan::field::{
    Boundary, Cell, Difference, Direction, Disc, Domain, Equation, Factor, Influence, Levels, Measure, Moment,
    MovingField, Order, RelaxError, Relaxation, Scan, Solver, Stopping, by_multigrid, eliminated,
};
use cplan_cases::dice::Dice;

const BOUNDARIES: [Boundary; 3] = [Boundary::High, Boundary::Reflecting, Boundary::Periodic];

fn point(dice: &mut Dice, [rows, columns]: [usize; 2]) -> [f64; 2] {
    // Some coordinates are whole or half numbers, so that distances can be equal.
    let at = [dice.within(-1.0, rows as f64), dice.within(-1.0, columns as f64)];
    if dice.chance(0.5) { at.map(|x| (2.0 * x).round() / 2.0) } else { at }
}

fn moment(dice: &mut Dice, cells: [usize; 2], difference: Difference) -> Moment {
    let disc = |dice: &mut Dice, most: f64| Disc {
        center: point(dice, cells),
        radius: [0.0, 1.0, 2.0, dice.within(0.0, most)][dice.below(4_usize)],
    };
    let strongest = if difference == Difference::Upwind { 4.0 } else { 1.9 };
    let robot = |dice: &mut Dice| {
        let direction = Direction::of([dice.within(-1.0, 1.0), dice.within(-1.0, 1.0)]).expect("a length");
        let epsilon = dice.within(-strongest, strongest);
        let radius = if dice.chance(0.1) { f64::INFINITY } else { dice.within(0.0, 6.0).round() };
        Influence { center: point(dice, cells), radius, drift: direction.drift(epsilon) }
    };
    let [obstacles, goals, robots] = [dice.below(4_usize), dice.below(3_usize), dice.below(4_usize)];
    Moment {
        obstacles: (0..obstacles).map(|_| disc(dice, 4.0)).collect(),
        goals: (0..goals).map(|_| disc(dice, 3.0)).collect(),
        robots: (0..robots).map(|_| robot(dice)).collect(),
    }
}

fn distance(cell: usize, columns: usize, center: [f64; 2]) -> f64 {
    let [a, b] = [(cell / columns) as f64 - center[0], (cell % columns) as f64 - center[1]];
    a.hypot(b)
}

fn kinds(walls: &[bool], columns: usize, moment: &Moment) -> Vec<Cell> {
    let within = |cell: usize, discs: &[Disc]| discs.iter().any(|d| distance(cell, columns, d.center) < d.radius);
    let mut kinds = vec![Cell::Free; walls.len()];
    for (cell, kind) in kinds.iter_mut().enumerate() {
        if within(cell, &moment.goals) {
            *kind = Cell::Goal;
        }
        if walls[cell] || within(cell, &moment.obstacles) {
            *kind = Cell::Obstacle;
        }
    }
    kinds
}

/// Returns the drift of each cell. It is that of the nearest robot whose disc contains the cell. If several are equally
/// near, the first of them counts.
fn drift(cells: usize, columns: usize, robots: &[Influence]) -> Vec<[f64; 2]> {
    let of = |cell: usize| {
        let mut best: Option<&Influence> = None;
        for robot in robots {
            if best.is_none_or(|b| distance(cell, columns, robot.center) < distance(cell, columns, b.center)) {
                best = Some(robot);
            }
        }
        best.filter(|b| distance(cell, columns, b.center) < b.radius).map_or([0.0; 2], |b| b.drift)
    };
    (0..cells).map(of).collect()
}

#[test]
fn each_moment_equals_a_fresh_solution() {
    let gauss_seidel = Solver::Relaxation(Relaxation::gauss_seidel(Order::Lines(Scan::ROWS)));
    let (mut compared, mut moved) = (0, 0);
    for seed in cplan_cases::seeds(24) {
        let mut dice = Dice::new(seed);
        let cells = [dice.below(9_usize) + 3, dice.below(9_usize) + 3];
        let mut walls: Vec<bool> = (0..cells[0] * cells[1]).map(|_| dice.chance(0.1)).collect();
        // With a wall, the values are determined for all limits.
        walls[0] = true;
        let boundaries = [BOUNDARIES[dice.below(3_usize)], BOUNDARIES[dice.below(3_usize)]];
        let difference = if dice.chance(0.5) { Difference::Central } else { Difference::Upwind };
        let first = MovingField::new(cells, walls.clone(), boundaries, difference).unwrap();
        let mut fields = [(first.clone(), gauss_seidel), (first, Solver::Multigrid)];
        for _ in 0..4 {
            let moment = moment(&mut dice, cells, difference);
            let kinds = kinds(&walls, cells[1], &moment);
            let domain = Domain::new(cells, kinds.clone(), boundaries, Levels::PUBLISHED);
            let drift = drift(walls.len(), cells[1], &moment.robots);
            let expected = solution(&domain, &Equation::LocallyOriented { drift, difference });
            for (field, solver) in &mut fields {
                moved += usize::from(field.domain().kinds() != kinds);
                let done = field.next(&moment, solver, 1e-26, 100_000).unwrap();
                assert!(done.converged, "seed {seed}, {solver:?}: {done:?}");
                assert_eq!(field.domain().kinds(), kinds, "seed {seed}");
                let error = greatest_difference(field.values(), &expected);
                assert!(error < 1e-8, "seed {seed}, {solver:?}, {boundaries:?}, {moment:?}: {error:e} off");
                compared += 1;
            }
        }
    }
    assert!(
        !cplan_cases::uses_default_cases() || (compared == 192 && moved > 100),
        "{compared} fields, {moved} with another mask"
    );
}

#[test]
fn directions_are_those_of_the_published_formula_at_centres() {
    let mut dice = Dice::new(4);
    let cells = [11, 14];
    let mut field = MovingField::new(cells, vec![false; 154], [Boundary::High; 2], Difference::Upwind).unwrap();
    let mut seen = 0;
    for _ in 0..10 {
        let moment = moment(&mut dice, cells, Difference::Upwind);
        field.next(&moment, &Solver::Multigrid, 1e-20, 500).unwrap();
        let value = |i: usize, j: usize| if i < 11 && j < 14 { field.values()[i * 14 + j] } else { 1.0 };
        for (i, j) in (0..11).flat_map(|i| (0..14).map(move |j| (i, j))) {
            let found = field.direction([i as f64, j as f64]);
            if field.domain().kinds()[i * 14 + j] != Cell::Free {
                assert_eq!(found, None);
                continue;
            }
            let down = [value(i.wrapping_sub(1), j) - value(i + 1, j), value(i, j.wrapping_sub(1)) - value(i, j + 1)];
            let length = down[0].hypot(down[1]);
            // Differences that are due to rounding show nothing.
            if length > 1e-9 {
                let found = found.unwrap_or_else(|| panic!("a direction at {i}, {j}"));
                assert!((0..2).all(|k| (found[k] - down[k] / length).abs() < 1e-6), "{i}, {j}: {found:?}, {down:?}");
                seen += 1;
            }
        }
    }
    assert!(seen > 300, "only {seen} directions");
}

#[test]
fn paths_stay_in_free_cells_and_reach_the_goal() {
    let (mut arrived, cells) = (0, [16, 19]);
    for seed in cplan_cases::seeds(30) {
        let mut dice = Dice::new(seed);
        let walls: Vec<bool> = (0..cells[0] * cells[1]).map(|_| dice.chance(0.15)).collect();
        let mut field = MovingField::new(cells, walls, [Boundary::High; 2], Difference::Upwind).unwrap();
        let moment = moment(&mut dice, cells, Difference::Upwind);
        field.next(&moment, &Solver::Multigrid, 1e-28, 1000).unwrap();
        let kind = |at: [f64; 2]| {
            let [i, j] = at.map(|x| x.round());
            let is_inside = (0.0..16.0).contains(&i) && (0.0..19.0).contains(&j);
            if is_inside { field.domain().kinds()[i as usize * 19 + j as usize] } else { Cell::Obstacle }
        };
        for _ in 0..10 {
            let mut at = [dice.within(0.0, 15.0), dice.within(0.0, 18.0)];
            if kind(at) != Cell::Free {
                continue;
            }
            for _ in 0..100 {
                let next = field.advance(at, 1);
                let way = (next[0] - at[0]).hypot(next[1] - at[1]);
                assert!(way < 0.2 + 1e-12, "seed {seed}: a step of {way}");
                for part in 0..=20 {
                    let between = [0, 1].map(|k| at[k] + f64::from(part) / 20.0 * (next[k] - at[k]));
                    assert_ne!(kind(between), Cell::Obstacle, "seed {seed}: {at:?} to {next:?}");
                }
                assert_eq!(field.advance(at, 3), field.advance(field.advance(field.advance(at, 1), 1), 1));
                at = next;
            }
            if let Ok(way) = field.follow(at) {
                let end = way.points[way.points.len() - 1];
                assert_eq!(kind(end), Cell::Goal, "seed {seed}");
                arrived += 1;
            }
        }
    }
    assert!(!cplan_cases::uses_default_cases() || arrived > 30, "only {arrived} came to a goal");
}

#[test]
fn multigrid_agrees_with_elimination_for_strong_drifts() {
    for (seed, (difference, strength)) in
        (0..).zip([(Difference::Upwind, 3.0), (Difference::Upwind, 0.3), (Difference::Central, 1.5)])
    {
        let mut dice = Dice::new(seed);
        let cells = [50, 60];
        let mut kinds: Vec<Cell> =
            (0..3000).map(|_| if dice.chance(0.1) { Cell::Obstacle } else { Cell::Free }).collect();
        kinds[1234] = Cell::Goal;
        for boundaries in [[Boundary::High; 2], [Boundary::Periodic, Boundary::Reflecting]] {
            let domain = Domain::new(cells, kinds.clone(), boundaries, Levels::PROBABILITY);
            let drift = (0..3000).map(|_| [0; 2].map(|_| dice.within(-strength, strength))).collect();
            let equation = Equation::LocallyOriented { drift, difference };
            let stopping = Stopping { measure: Measure::SumOfSquares, below: 1e-22, max_sweeps: 300 };
            let start = (0..3000).map(|_| dice.within(-1.0, 2.0)).collect();
            let found = by_multigrid(&domain, &equation, &stopping, start).unwrap();
            assert!(found.converged() && found.sweeps() < 150, "{difference:?} {strength}: {:?}", found.stages);
            let error = greatest_difference(&found.values, &eliminated(&domain, &equation).expect("a solution"));
            assert!(error < 1e-8, "{difference:?} {strength}: {error:e} off");
            // Beginning with the solution, no step is needed.
            let again = by_multigrid(&domain, &equation, &stopping, found.values.clone()).unwrap();
            assert_eq!((again.sweeps(), again.values), (0, found.values));
        }
    }
}

#[test]
fn invalid_moments_are_refused_without_effect() {
    let refused = |result: Result<_, RelaxError>, word: &str| match result {
        Err(RelaxError::Refused(reason)) => assert!(reason.contains(word), "{reason}"),
        _ => panic!("not refused: {word}"),
    };
    let high = [Boundary::High; 2];
    refused(MovingField::new([3, 4], vec![false; 11], high, Difference::Upwind).map(drop), "3 x 4 cells");
    refused(MovingField::new([usize::MAX, 4], vec![], high, Difference::Upwind).map(drop), "flag");
    let mut field = MovingField::new([6, 6], vec![false; 36], high, Difference::Upwind).unwrap();
    let goal = Disc { center: [3.0, 3.0], radius: 1.0 };
    let fine = Moment { goals: vec![goal], ..Moment::default() };
    field.next(&fine, &Solver::Multigrid, 1e-12, 100).unwrap();
    let before = field.clone();
    let disc = |x: f64, radius: f64| Moment { obstacles: vec![Disc { center: [x, 1.0], radius }], ..fine.clone() };
    for moment in [disc(f64::NAN, 1.0), disc(f64::INFINITY, 1.0), disc(1.0, f64::NAN)] {
        refused(field.next(&moment, &Solver::Multigrid, 1e-12, 100).map(drop), "finite");
    }
    let robot = Influence { center: [2.0; 2], radius: 3.0, drift: [f64::NAN, 0.0] };
    for solver in [Solver::Multigrid, Solver::Relaxation(Relaxation::JACOBI)] {
        let moment = Moment { robots: vec![robot], ..fine.clone() };
        refused(field.next(&moment, &solver, 1e-12, 100).map(drop), "epsilon");
    }
    let factor = Relaxation::sor(Factor::Given(-1.0), Order::RedBlack);
    refused(field.next(&fine, &Solver::Relaxation(factor), 1e-12, 100).map(drop), "factor");
    assert_eq!(field, before);

    let (domain, start) = (field.domain(), field.domain().start());
    let squares = Stopping { measure: Measure::SumOfSquares, below: 1e-12, max_sweeps: 100 };
    let other = Stopping { measure: Measure::GreatestChange, ..squares };
    let preference = Equation::Preference { epsilon: vec![0.5; 36], difference: Difference::Central };
    refused(by_multigrid(domain, &Equation::Harmonic, &other, start.clone()).map(drop), "squared");
    refused(by_multigrid(domain, &preference, &squares, start.clone()).map(drop), "linear");
    refused(by_multigrid(domain, &Equation::Harmonic, &squares, start[1..].to_vec()).map(drop), "one value");
    let mut lost = start;
    lost[0] = f64::NAN;
    let lost = by_multigrid(domain, &Equation::Harmonic, &squares, lost);
    assert!(matches!(&lost, Err(RelaxError::Diverged { cell: [0, 0], .. })), "{lost:?}");
}

#[test]
fn moments_without_goals_or_room_have_no_path() {
    let mut field = MovingField::new([5, 5], vec![false; 25], [Boundary::High; 2], Difference::Central).unwrap();
    let covered = Disc { center: [2.0; 2], radius: 9.0 };
    for (obstacles, goals) in [(vec![], vec![]), (vec![covered], vec![covered]), (vec![covered], vec![])] {
        let moment = Moment { obstacles, goals, robots: vec![] };
        for solver in [Solver::Multigrid, Solver::Relaxation(Relaxation::JACOBI)] {
            assert!(field.next(&moment, &solver, 1e-30, 10_000).unwrap().converged);
        }
        assert!(field.values().iter().all(|value| (value - 1.0).abs() < 1e-9), "{moment:?}");
        assert!(field.follow([2.0, 2.0]).is_err());
        assert_eq!(field.advance([1.0, 1.0], 0), [1.0, 1.0]);
    }
}
