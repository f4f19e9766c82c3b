//! Attraction and repulsion: their laws, their traps, and how traps are reported.

use super::planner::drawn;
use cplan::cspace::{Grid, Proves};
use cplan::field::{Attraction, ForceField, Khatib, Limits, Repulsion};
use cplan::space::{Configuration, JointRange, Topology};

const ATTRACTIONS: [Attraction; 2] = [Attraction::Constant(1.5), Attraction::Linear(0.7)];
const REPULSIONS: [Repulsion; 2] = [Repulsion::Ranged { gain: 2.0, range: 3.0 }, Repulsion::InverseSquare(2.0)];

/// Returns a trap that is open on the left, with a start in it and a goal to the right of it.
pub fn u_trap() -> (Grid, usize, usize) {
    let text = "
        ....................
        ....................
        ....................
        ...#########........
        ...........#........
        ...........#........
        ...........#........
        ...........#........
        ...........#........
        ...#########........
        ....................
        ....................
        ....................";
    (drawn(text), 6 * 20 + 5, 6 * 20 + 17)
}

#[test]
fn forces_are_the_slopes_of_their_potentials() {
    let step = 1e-6;
    for d in [0.3, 0.9, 2.0, 2.9, 3.5] {
        for law in ATTRACTIONS {
            let slope = (law.potential(d + step) - law.potential(d - step)) / (2.0 * step);
            assert!((law.force(d) - slope).abs() < 1e-6, "{law:?} at {d}");
        }
        for law in REPULSIONS {
            let slope = (law.potential(d + step) - law.potential(d - step)) / (2.0 * step);
            assert!((law.force(d) + slope).abs() < 1e-6 * (1.0 + slope.abs()), "{law:?} at {d}");
        }
    }
    assert_eq!(REPULSIONS[0].potential(3.0), 0.0);
    assert_eq!(REPULSIONS.map(|law| law.potential(f64::INFINITY)), [0.0, 0.0]);
}

/// Returns the potential of a cell from the distances to all blocked cells.
fn potential(grid: &Grid, laws: &Khatib, goal: usize, cell: usize) -> f64 {
    let distance = |other: usize| (grid.center(cell) - grid.center(other)).norm();
    let obstacle = (0..grid.blocked.len()).filter(|&c| grid.blocked[c]).map(distance).fold(f64::INFINITY, f64::min);
    laws.attraction.potential(distance(goal)) + laws.repulsion.potential(obstacle)
}

#[test]
fn the_local_minimum_in_a_u_is_reported() {
    let (grid, start, goal) = u_trap();
    for attraction in ATTRACTIONS {
        for repulsion in REPULSIONS {
            let laws = Khatib { attraction, repulsion, saturated: false };
            let field = ForceField::new(&grid, laws, &[grid.center(goal)], Limits::Reflecting);
            let trap = field.descend(start, &[goal]).expect_err("the goal lies behind the bottom of the U");
            assert!(trap.minimum);
            assert!((trap.value - potential(&grid, &laws, goal, trap.cell)).abs() < 1e-12);
            let (i, j) = (trap.cell / 20, trap.cell % 20);
            assert!((4..9).contains(&i) && (4..11).contains(&j), "({i}, {j}) is not in the U");
            for near in [i - 1, i, i + 1].into_iter().flat_map(|i| [j - 1, j, j + 1].map(|j| i * 20 + j)) {
                assert!(grid.blocked[near] || potential(&grid, &laws, goal, near) >= trap.value);
            }
        }
    }
}

#[test]
fn saturated_forces_are_trapped_too() {
    let (grid, start, goal) = u_trap();
    for attraction in ATTRACTIONS {
        let laws = Khatib { attraction, repulsion: REPULSIONS[0], saturated: true };
        let field = ForceField::new(&grid, laws, &[grid.center(goal)], Limits::Reflecting);
        let trap = field.descend(start, &[goal]).expect_err("the goal lies behind the bottom of the U");
        assert!(!trap.minimum);
        assert!((4..9).contains(&(trap.cell / 20)) && (4..11).contains(&(trap.cell % 20)));
    }
}

#[test]
fn a_component_of_a_saturated_force_never_exceeds_that_of_two() {
    let (grid, _, goal) = u_trap();
    let laws = |saturated| Khatib {
        attraction: Attraction::Linear(50.0),
        repulsion: Repulsion::InverseSquare(90.0),
        saturated,
    };
    let goals = [grid.center(goal)];
    let fields = [true, false].map(|saturated| ForceField::new(&grid, laws(saturated), &goals, Limits::High));
    let greatest = fields.map(|field| {
        let free = (0..grid.blocked.len()).filter(|&cell| !grid.blocked[cell]);
        free.flat_map(|cell| field.force(cell)).fold(0.0_f64, |most, part| most.max(part.abs()))
    });
    assert!(greatest[0] <= 2.0 && greatest[1] > 90.0, "{greatest:?}");
}

#[test]
fn without_a_trap_the_goal_is_reached_downhill_all_the_way() {
    let grid = drawn(
        "
        ..............
        ......##......
        ......###.....
        ..............
        ..............
        ..............",
    );
    let (start, goal) = (5 * 14, 13);
    for attraction in ATTRACTIONS {
        for repulsion in REPULSIONS {
            for saturated in [false, true] {
                let laws = Khatib { attraction, repulsion, saturated };
                let field = ForceField::new(&grid, laws, &[grid.center(goal)], Limits::Reflecting);
                let way = field.descend(start, &[goal]).unwrap_or_else(|trap| panic!("{laws:?}: {trap:?}"));
                assert_eq!((way[0], way[way.len() - 1]), (start, goal));
                for step in way.windows(2) {
                    let apart = [0, 1].map(|k| (grid.center(step[0])[k] - grid.center(step[1])[k]).abs());
                    assert!(apart[0] < 1.5 && apart[1] < 1.5 && !grid.blocked[step[1]]);
                    assert!(saturated || field.potential(step[1]) < field.potential(step[0]));
                }
            }
        }
    }
}

#[test]
fn on_a_torus_the_goal_attracts_the_short_way_round() {
    let topology = Topology::new([JointRange::Circle; 2]);
    let grid = Grid { topology, proves: Proves::Sampled, cells: [16, 16], blocked: vec![false; 256] };
    let laws =
        Khatib { attraction: Attraction::Linear(1.0), repulsion: Repulsion::InverseSquare(1.0), saturated: false };
    let field = ForceField::new(&grid, laws, &[grid.center(15 * 16 + 15)], Limits::High);
    // Diagonally across both seams, and then one more cell.
    assert_eq!(field.descend(17, &[255]).unwrap(), [17, 0, 255]);
    assert_eq!(field.force(255), [0.0; 2]);
    let nearest_of_two: [Configuration; 2] = [grid.center(255), grid.center(34)];
    let field = ForceField::new(&grid, laws, &nearest_of_two, Limits::High);
    assert_eq!(field.descend(17, &[255, 34]).unwrap(), [17, 34]);
}
