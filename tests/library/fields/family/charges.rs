//! Repulsion by all obstacle cells together, and figure 3.4 of the sources. With four times the charge, the robot gets
//! out of a trap, but then cannot reach some goals.

use cplan::cspace::{Grid, Proves, ZonedGrid};
use cplan::field::{Attraction, ForceField, Khatib, Limits, Repulsion};
use cplan::model::Workspace;
use cplan::planner::{FieldChoice, FieldPlanner, PathKind, Planner, Proposal, Query};
use cplan::space::{Configuration, JointRange, Topology};
use cplan_testkit::arms;
use cplan_testkit::scenes::placed;
use proptest::prelude::*;

const SUM: Repulsion = Repulsion::Sum(1.0);

fn grid(cells: [usize; 2], circles: [bool; 2], blocked: Vec<bool>) -> Grid {
    let axis = |k: usize| match circles[k] {
        true => JointRange::Circle,
        false => JointRange::Interval { lower: 0.0, upper: cells[k] as f64 * [1.0, 2.5][k] },
    };
    Grid { topology: Topology::new([axis(0), axis(1)]), proves: Proves::Sampled, cells, blocked }
}

proptest! {
    #![proptest_config(cplan_cases::cases(60))]

    /// Checks the sum term by term. On circles, the shorter direction counts. At limits with a high value, a frame of
    /// one cell counts as obstacles.
    #[test]
    fn the_charge_is_summed_over_all_obstacle_cells(
        (rows, columns, blocked) in (1..9_usize, 1..9_usize).prop_flat_map(|(rows, columns)| {
            (Just(rows), Just(columns), proptest::collection::vec(proptest::bool::weighted(0.3), rows * columns))
        }),
        circles in any::<[bool; 2]>(),
        high in any::<bool>(),
    ) {
        let grid = grid([rows, columns], circles, blocked);
        let limits = if high { Limits::High } else { Limits::Reflecting };
        let laws = Khatib { attraction: Attraction::Constant(1e-9), repulsion: SUM, saturated: false };
        let field = ForceField::new(&grid, laws, &[grid.center(0)], limits);
        let step = grid.step();
        let side = (step[0] * step[1]).sqrt();
        let n = [rows as i64, columns as i64];
        for cell in 0..grid.blocked.len() {
            let at = [(cell / columns) as i64, (cell % columns) as i64];
            let (mut potential, mut force) = (0.0, [0.0; 2]);
            for i in -1..=n[0] {
                for j in -1..=n[1] {
                    let there = [i, j];
                    let inside = [0, 1].map(|k| (0..n[k]).contains(&there[k]));
                    let is_solid = match inside {
                        [true, true] => grid.blocked[(i * n[1] + j) as usize],
                        _ => high && (0..2).all(|k| inside[k] || !circles[k]),
                    };
                    let mut d = [0, 1].map(|k| (at[k] - there[k]) as f64);
                    let mut away = d;
                    for k in 0..2 {
                        if circles[k] {
                            let m = n[k] as f64;
                            let short = [d[k] - m, d[k], d[k] + m].into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs()));
                            d[k] = short.unwrap();
                            away[k] = if 2.0 * d[k].abs() == m { 0.0 } else { d[k] };
                        }
                    }
                    let [d, away] = [d, away].map(|d| [0, 1].map(|k| d[k] * step[k] / side));
                    let p = d[0].hypot(d[1]);
                    if is_solid && p > 0.0 {
                        potential += side / p;
                        force = [0, 1].map(|k| force[k] + away[k] / p.powi(3));
                    }
                }
            }
            prop_assert!((field.potential(cell) - potential).abs() < 1e-6 * (1.0 + potential));
            let found = field.force(cell);
            prop_assert!((0..2).all(|k| (found[k] - force[k]).abs() < 1e-7 * (1.0 + potential)), "{found:?} {force:?}");
        }
    }
}

/// Returns a room with walls, a trap that opens towards the start, and a goal between two blocks.
fn room(gap: &str) -> (ZonedGrid, Query) {
    let mut rows: Vec<String> = vec![".".repeat(44); 40];
    for (i, row) in rows.iter_mut().enumerate() {
        if (8..17).contains(&i) {
            // The side walls of the trap, and its bottom.
            let wall = if i == 16 { "######" } else { "#....#" };
            row.replace_range(19..25, wall);
        }
        if (33..38).contains(&i) {
            row.replace_range(14..30, gap);
        }
    }
    let blocked = rows.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect();
    let axis = |upper: f64| JointRange::Interval { lower: 0.0, upper };
    let topology = Topology::new([axis(40.0), axis(44.0)]);
    let grid = Grid { topology, proves: Proves::Sampled, cells: [40, 44], blocked };
    let workspace = Workspace { name: "w".into(), obstacles: Vec::new(), clearance: 0.0, preferences: Vec::new() };
    let scene = placed(arms::rr([axis(3.0), axis(3.0)]), workspace);
    let query = Query { start: Configuration::new(3.5, 19.75), goals: Configuration::new(35.5, 22.5).into() };
    (ZonedGrid::new(grid, &scene), query)
}

fn outcome(charge: f64, gap: &str) -> Proposal {
    let laws = Khatib { attraction: Attraction::Constant(1.0), repulsion: Repulsion::Sum(charge), saturated: false };
    let planner =
        FieldPlanner { field: FieldChoice::Khatib(laws), limits: Limits::High, escape: None, path: PathKind::Own };
    let (space, query) = room(gap);
    planner.query(&space, &(), &query).outcome
}

/// Returns true for places between the side walls of the trap.
fn is_in_trap([i, j]: [f64; 2]) -> bool {
    (8.0..16.0).contains(&i) && (20.0..24.0).contains(&j)
}

fn trapped_at(outcome: &Proposal) -> [f64; 2] {
    let Proposal::GaveUp(reason) = outcome else { panic!("{outcome:?}") };
    let (_, rest) = reason.split_once("local minimum of ").unwrap_or_else(|| panic!("{reason}"));
    let (at, _) = rest.split_once(" at (").and_then(|(_, place)| place.split_once(')')).unwrap();
    let numbers: Vec<f64> = at.split(", ").map(|x| x.parse().unwrap()).collect();
    [numbers[0], numbers[1]]
}

#[test]
fn a_fourfold_charge_removes_the_trap_and_then_blocks_the_goal() {
    const OPEN: &str = "................";
    const NARROW: &str = "#######..#######";
    let q = 0.8;
    // Attraction leads into the trap, where its bottom stops the path.
    let [i, j] = trapped_at(&outcome(q, OPEN));
    assert!(is_in_trap([i, j]), "({i}, {j}) is not in the trap");
    // With four times the charge, the walls of the trap keep the robot out of it.
    let Proposal::Found(path) = outcome(4.0 * q, OPEN) else { panic!("{:?}", outcome(4.0 * q, OPEN)) };
    assert!(!path.waypoints().iter().any(|q| is_in_trap([q[0], q[1]])));
    // But then a goal between obstacles cannot be reached, because they repel the robot.
    let [i, j] = trapped_at(&outcome(4.0 * q, NARROW));
    assert!(!is_in_trap([i, j]) && (i - 35.5).hypot(j - 22.5) > 2.0, "({i}, {j}) is in the trap, or at the goal");
}
