//! The harmonic planner's path between centres of cells, sampled densely.

use cplan::cspace::{Grid, Proves};
use cplan::planner::{Harmonic, PathKind, Planner, Proposal, Query};
use cplan::space::{Configuration, JointRange, Topology};
use proptest::prelude::*;

fn grid(cells: [usize; 2], circles: [bool; 2], blocked: Vec<bool>) -> Grid {
    let axis = |k: usize| match circles[k] {
        true => JointRange::Circle,
        false => JointRange::Interval { lower: 0.0, upper: cells[k] as f64 },
    };
    Grid { topology: Topology::new([axis(0), axis(1)]), proves: Proves::Sampled, cells, blocked }
}

fn random_grid() -> impl Strategy<Value = (Grid, usize)> {
    (1..14_usize, 1..14_usize, any::<[bool; 2]>(), 0.0..0.6_f64).prop_flat_map(|(rows, columns, circles, density)| {
        let cells = proptest::collection::vec(proptest::bool::weighted(density), rows * columns);
        (cells, 0..rows * columns)
            .prop_map(move |(blocked, goal)| (grid([rows, columns], circles, blocked), goal))
            .prop_filter("a free goal", |(grid, goal)| !grid.blocked[*goal])
    })
}

proptest! {
    #![proptest_config(cplan_cases::cases(300))]

    /// Checks that the path stays in free cells and ends at the goal.
    #[test]
    fn streamlines_stay_in_free_cells_and_come_to_the_goal(
        (grid, goal) in random_grid(),
        start in any::<proptest::sample::Index>(),
        offset in any::<(u8, u8)>(),
    ) {
        let start = start.index(grid.blocked.len());
        prop_assume!(!grid.blocked[start]);
        let step = grid.step();
        let part = [offset.0, offset.1].map(|x| f64::from(x) / 256.0 - 0.498);
        let from = grid.center(start) + Configuration::new(part[0] * step[0], part[1] * step[1]);
        let planner = Harmonic { path: PathKind::Own };
        let run = planner.query(&grid, &planner.build(&grid), &Query { start: from, goals: grid.center(goal).into() });
        let path = match &run.outcome {
            Proposal::Found(path) => path,
            Proposal::NoPath => return Ok(()),
            Proposal::GaveUp(reason) => panic!("{reason}"),
        };
        prop_assert_eq!(path.start(), from);
        prop_assert!(grid.topology.distance(path.goal(), grid.center(goal)) < 1e-9);
        for (a, b) in path.segments() {
            for k in 0..=50 {
                let q = a + (b - a) * (f64::from(k) / 50.0);
                // On a side between two cells, either cell may be the free one.
                let beside = |d: [f64; 2]| {
                    let p = q + Configuration::new(d[0] * 1e-7 * step[0], d[1] * 1e-7 * step[1]);
                    grid.topology.contains(p) && !grid.blocked[grid.locate(p)]
                };
                prop_assert!([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].into_iter().any(beside), "{q:?}");
            }
        }
    }
}
