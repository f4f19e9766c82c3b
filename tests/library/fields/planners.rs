//! The field planners, compared with independent methods: direct solutions, Floyd-Warshall, dense sampling and
//! published tables.

use super::family::planner::{drawn, found, grid, is_free};
use cplan::cspace::Grid;
use cplan::field::{Component, Field, Lattice, UNREACHED, harmonic};
use cplan::planner::{Harmonic, PathKind, Planner, Proposal, Query, Run, Size, Trace, Wavefront};
use cplan::space::Configuration;
use proptest::prelude::*;

/// Returns a corridor one cell wide that winds inwards on `n x n` cells, and the cells at its two ends.
fn spiral(n: i64) -> (Grid, usize, usize) {
    let mut free = vec![false; (n * n) as usize];
    let (mut i, mut j) = (0, 0);
    free[0] = true;
    let mut turns = 0;
    for (di, dj) in [(0, 1), (1, 0), (0, -1), (-1, 0)].into_iter().cycle() {
        let is_free =
            |i: i64, j: i64, free: &[bool]| (0..n).contains(&i) && (0..n).contains(&j) && free[(i * n + j) as usize];
        let before = (i, j);
        // The corridor continues until it would touch itself.
        while (0..n).contains(&(i + di)) && (0..n).contains(&(j + dj)) && !is_free(i + 2 * di, j + 2 * dj, &free) {
            (i, j) = (i + di, j + dj);
            free[(i * n + j) as usize] = true;
        }
        turns = if before == (i, j) { turns + 1 } else { 0 };
        if turns == 2 {
            break;
        }
    }
    let blocked = free.into_iter().map(|free| !free).collect();
    (grid([n as usize; 2], [false; 2], blocked), 0, (i * n + j) as usize)
}

fn random_grid(most: usize) -> impl Strategy<Value = Grid> {
    (1..most, 1..most, any::<[bool; 2]>(), 0.0..0.6_f64).prop_flat_map(|(rows, columns, circles, density)| {
        proptest::collection::vec(proptest::bool::weighted(density), rows * columns)
            .prop_map(move |blocked| grid([rows, columns], circles, blocked))
    })
}

/// Generates a grid with fewer than `most` cells along each axis, and two of its cells, free or not.
fn random_problem(most: usize) -> impl Strategy<Value = (Grid, usize, usize)> {
    random_grid(most).prop_flat_map(|grid| {
        let n = grid.blocked.len();
        (Just(grid), 0..n, 0..n)
    })
}

/// Returns the numbers of steps between all pairs of free cells, by the algorithm of Floyd and Warshall. Two cells are
/// neighbours if their coordinates say so.
fn all_steps(grid: &Grid) -> Vec<Vec<u32>> {
    let n = grid.blocked.len();
    let apart = |a: usize, b: usize, k: usize| {
        let at = |c: usize| if k == 0 { c / grid.cells[1] } else { c % grid.cells[1] };
        let d = at(a).abs_diff(at(b));
        if grid.topology.ranges[k].is_circle() { d.min(grid.cells[k] - d) } else { d }
    };
    let mut steps = vec![vec![u32::MAX; n]; n];
    for a in (0..n).filter(|&a| !grid.blocked[a]) {
        for b in (0..n).filter(|&b| !grid.blocked[b]) {
            let d = apart(a, b, 0) + apart(a, b, 1);
            if d <= 1 {
                steps[a][b] = d as u32;
            }
        }
    }
    for via in 0..n {
        for a in 0..n {
            for b in 0..n {
                steps[a][b] = steps[a][b].min(steps[a][via].saturating_add(steps[via][b]));
            }
        }
    }
    steps
}

/// Returns the harmonic potential by Gaussian elimination. It is 1 at the goal, and 0 in cells that are not connected
/// with the goal.
fn direct(grid: &Grid, goal: usize) -> Vec<f64> {
    let steps = &all_steps(grid)[goal];
    let n = grid.blocked.len();
    let mut a = nalgebra::DMatrix::<f64>::identity(n, n);
    let mut b = nalgebra::DVector::<f64>::zeros(n);
    b[goal] = 1.0;
    for i in (0..n).filter(|&i| i != goal && steps[i] != u32::MAX) {
        for neighbor in grid.neighbors(i).filter(|&j| !grid.blocked[j]) {
            a[(i, neighbor)] -= 0.25;
        }
    }
    a.lu().solve(&b).expect("Laplace's equation has one solution").iter().copied().collect()
}

fn query(grid: &Grid, start: usize, goal: usize) -> Query {
    Query { start: grid.center(start), goals: grid.center(goal).into() }
}

/// Returns the cells that are connected with the goal, and their potential.
fn field(grid: &Grid, goal: usize) -> (Component, Field) {
    let lattice = Lattice::from(grid);
    let component = Component::new(&lattice, lattice.wave(&[goal]));
    let field = harmonic(&component);
    (component, field)
}

/// The two kinds of planners: true stands for the wavefront, false for the harmonic field.
const BOTH: [bool; 2] = [true, false];

fn run(is_wavefront: bool, grid: &Grid, query: &Query, path: PathKind) -> Run {
    fn of<P: Planner<Space = Grid>>(planner: P, grid: &Grid, query: &Query) -> Run {
        planner.query(grid, &planner.build(grid), query)
    }
    match is_wavefront {
        true => of(Wavefront { path, ..Wavefront::default() }, grid, query),
        false => of(Harmonic { path }, grid, query),
    }
}

/// Checks that both planners find a path if there is one. The wavefront's plain path must visit free cells, each a
/// neighbour of the one before, and must be a shortest one.
fn check_paths_between_cells(grid: &Grid, start: usize, goal: usize) -> Result<(), TestCaseError> {
    let reached = all_steps(grid)[goal][start];
    let step = grid.step();
    for planner in BOTH {
        let run = run(planner, grid, &query(grid, start, goal), PathKind::Own);
        if reached == u32::MAX {
            prop_assert_eq!(run.outcome, Proposal::NoPath);
            continue;
        }
        let path = found(&run);
        prop_assert_eq!(path.start(), grid.center(start));
        prop_assert!(grid.topology.distance(path.goal(), grid.center(goal)) < 1e-12);
        if !planner {
            continue;
        }
        prop_assert!(path.waypoints().iter().all(|&q| !grid.blocked[grid.locate(q)]));
        for (a, b) in path.segments() {
            let d = [(b - a)[0] / step[0], (b - a)[1] / step[1]].map(f64::abs);
            prop_assert!((d[0] + d[1] - 1.0).abs() < 1e-9 && d[0].min(d[1]) < 1e-9, "not one cell: {d:?}");
        }
        prop_assert_eq!(path.segments().count() as u32, reached);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cplan_cases::cases(150))]

    #[test]
    fn harmonic_fields_navigate((grid, _, goal) in random_problem(11)) {
        let (component, field) = field(&grid, goal);
        prop_assert!(field.potential.navigates(&component));
        prop_assert!((0..component.len()).all(|i| field.potential.ln(i).is_finite()));
    }

    #[test]
    fn fields_are_the_direct_solution_within_its_bounds((grid, _, goal) in random_problem(11)) {
        prop_assume!(!grid.blocked[goal]);
        let (component, field) = field(&grid, goal);
        let expected = direct(&grid, goal);
        for (i, cell) in (0..component.len()).map(|i| (i, component.cell(i))) {
            let (ln, expected) = (field.potential.ln(i), expected[cell]);
            prop_assert!((ln.exp() - expected).abs() <= 1e-9 * expected, "{} is not {expected}", ln.exp());
            // The maximum principle: no value is above that of the goal.
            prop_assert!(ln <= 0.0);
        }
    }

    #[test]
    fn plain_paths_visit_neighboring_free_cells((grid, start, goal) in random_problem(11)) {
        prop_assume!(!grid.blocked[start] && !grid.blocked[goal]);
        check_paths_between_cells(&grid, start, goal)?;
    }

    #[test]
    fn taut_paths_stay_in_free_cells_and_are_no_detours(
        (grid, start, goal) in random_problem(11),
        offsets in any::<[(u8, u8); 2]>(),
    ) {
        prop_assume!(!grid.blocked[start] && !grid.blocked[goal]);
        // The ends are anywhere within the two cells.
        let from = within(&grid, start, offsets[0]);
        let query = Query { start: from, goals: within(&grid, goal, offsets[1]).into() };
        for planner in BOTH {
            let plain = run(planner, &grid, &query, PathKind::Own);
            let short = run(planner, &grid, &query, PathKind::Taut);
            if plain.outcome == Proposal::NoPath {
                prop_assert_eq!(short.outcome, Proposal::NoPath);
                continue;
            }
            let (plain, short) = (found(&plain), found(&short));
            prop_assert!(short.length() <= plain.length() + 1e-9);
            prop_assert!(short.start() == plain.start() && short.goal() == plain.goal());
            prop_assert_eq!(short.start(), from);
            for (a, b) in short.segments() {
                for k in 0..=500 {
                    let q = a + (b - a) * (f64::from(k) / 500.0);
                    prop_assert!(grid.topology.contains(q) && !grid.blocked[grid.locate(q)], "{q:?} is blocked");
                }
            }
        }
    }
}

/// Returns a place in a cell.
fn within(grid: &Grid, cell: usize, (a, b): (u8, u8)) -> Configuration {
    let part = [a, b].map(|x| f64::from(x) / 256.0 - 0.498);
    grid.center(cell) + Configuration::new(part[0] * grid.step()[0], part[1] * grid.step()[1])
}

proptest! {
    #![proptest_config(cplan_cases::cases(300))]

    /// Checks that the harmonic planner's own path stays in free cells and ends at the goal.
    #[test]
    fn streamlines_stay_in_free_cells_and_come_to_the_goal(
        (grid, start, goal) in random_problem(14),
        offset in any::<(u8, u8)>(),
    ) {
        prop_assume!(!grid.blocked[start] && !grid.blocked[goal]);
        let from = within(&grid, start, offset);
        let run = run(false, &grid, &Query { start: from, goals: grid.center(goal).into() }, PathKind::Own);
        if run.outcome == Proposal::NoPath {
            return Ok(());
        }
        let path = found(&run);
        prop_assert_eq!(path.start(), from);
        prop_assert!(grid.topology.distance(path.goal(), grid.center(goal)) < 1e-9);
        for (a, b) in path.segments() {
            for k in 0..=50 {
                let q = a + (b - a) * (f64::from(k) / 50.0);
                prop_assert!(is_free(&grid, q), "{q:?}");
            }
        }
    }
}

#[test]
fn a_long_spiral_is_no_flat_field() {
    let (grid, outer, inner) = spiral(143);
    let free = grid.blocked.iter().filter(|&&blocked| !blocked).count();
    assert!(free > 10_000, "only {free} cells");
    let run = run(false, &grid, &query(&grid, outer, inner), PathKind::Own);
    assert!(found(&run).length() > 0.7 * free as f64);
    let Trace::Field { values: potential, .. } = &run.trace else { panic!("{:?}", run.trace) };
    // In a corridor one cell wide, each cell has 2 - sqrt 3 times the value of the one before. The few cells at its
    // closed end are an exception.
    let expected = (free - 1) as f64 * (2.0 - 3.0_f64.sqrt()).ln();
    assert!((potential[outer] - expected).abs() < 0.1, "{} instead of {expected}", potential[outer]);
}

/// Checks a case that the property tests found: on a ring of three cells, the goal is one step away in both directions.
#[test]
fn paths_on_a_ring_of_three_cells_go_the_short_way() {
    let grid = grid([3, 8], [true, false], vec![false; 24]);
    assert_eq!(all_steps(&grid)[16][0], 1);
    check_paths_between_cells(&grid, 0, 16).unwrap_or_else(|e| panic!("{e}"));
}

/// Checks a torus without walls. The harmonic function is constant there; only the loss at each step of a walk makes
/// the field fall.
#[test]
fn a_torus_without_walls_navigates() {
    for cells in [[2, 10], [1, 7], [64, 48], [300, 300]] {
        let grid = grid(cells, [true, true], vec![false; cells[0] * cells[1]]);
        let (component, field) = field(&grid, 0);
        assert!(field.potential.navigates(&component), "{cells:?}");
    }
}

#[test]
fn a_wall_means_no_path_and_the_trace_shows_what_was_reached() {
    let grid = drawn("..#.. ..#.. ..#..");
    for planner in BOTH {
        let run = run(planner, &grid, &query(&grid, 0, 4), PathKind::Taut);
        assert_eq!(run.outcome, Proposal::NoPath);
        assert!(matches!(run.size, Size::Grid { cells: 6, .. } | Size::Windows { cells: 6, .. }));
        let reached = match run.trace {
            Trace::Field { values, .. } => values.iter().filter(|p| p.is_finite()).count(),
            Trace::Wavefront { labels, .. } => labels.iter().filter(|&&label| label != UNREACHED).count(),
            _ => 0,
        };
        assert_eq!(reached, 6);
    }
}

#[test]
fn circles_are_crossed_at_the_seam_and_paths_stay_continuous() {
    let open = grid([40, 40], [true, true], vec![false; 1600]);
    let query = Query { start: Configuration::new(3.0, -2.9), goals: Configuration::new(-3.0, 2.9).into() };
    let tau = std::f64::consts::TAU;
    let end = Configuration::new(-3.0 + tau, 2.9 - tau);
    for planner in BOTH {
        let path = found(&run(planner, &open, &query, PathKind::Taut)).clone();
        assert_eq!(path.start(), query.start);
        assert!((path.goal() - end).norm() < 1e-14, "{}", path.goal());
        assert!((path.length() - (end - query.start).norm()).abs() < 1e-12);
        // A start that is a turn away remains there.
        let turned = Query { start: query.start + Configuration::new(tau, 0.0), ..query.clone() };
        let path = found(&run(planner, &open, &turned, PathKind::Taut)).clone();
        assert_eq!(path.start(), turned.start);
        assert!((path.goal() - end - Configuration::new(tau, 0.0)).norm() < 1e-12);
    }
}

#[test]
fn a_blocked_start_is_joined_to_a_free_cell_nearby() {
    let grid = drawn("....... .###... .###... .###... .......");
    for planner in BOTH {
        let start = Configuration::new(2.5, 1.2);
        let path = found(&run(planner, &grid, &Query { start, goals: grid.center(6).into() }, PathKind::Taut)).clone();
        assert_eq!((path.start(), path.goal()), (start, grid.center(6)));
    }
}
