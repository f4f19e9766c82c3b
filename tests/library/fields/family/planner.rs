//! The planner for all fields.

use cplan::cspace::{Grid, Proves, ZonedGrid};
use cplan::field::{
    Attraction, Device, Difference, Direction, Factor, Khatib, Limits, Lines, Measure, Order, Relaxation, Repulsion,
    Stencil,
};
use cplan::geometry::{Point, SimplePolygon};
use cplan::model::{Preference, Region, Scene, Workspace};
use cplan::planner::{
    EquationChoice, FieldChoice, FieldPlanner, Note, PathKind, Planner, Proposal, Query, Run, Size, Trace, Wavefront,
};
use cplan::space::{Configuration, JointRange, Path, Topology};
use cplan_testkit::arms::rr;
use cplan_testkit::scenes::placed;
use proptest::prelude::*;

const GAUSS_SEIDEL: Relaxation = Relaxation::gauss_seidel(Order::Corners(Lines::Rows));

pub fn scene(preferences: Vec<Preference>) -> Scene {
    let workspace = Workspace { name: "w".into(), obstacles: Vec::new(), clearance: 0.0, preferences };
    placed(rr([JointRange::Interval { lower: -3.0, upper: 3.0 }; 2]), workspace)
}

/// Parses cells of width 1; `#` is blocked.
pub fn drawn(text: &str) -> Grid {
    let rows: Vec<&str> = text.split_whitespace().collect();
    let cells = [rows.len(), rows[0].len()];
    grid(cells, [false; 2], rows.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect())
}

pub fn grid(cells: [usize; 2], circles: [bool; 2], blocked: Vec<bool>) -> Grid {
    let axis = |k: usize| match circles[k] {
        true => JointRange::Circle,
        false => JointRange::Interval { lower: 0.0, upper: cells[k] as f64 },
    };
    Grid { topology: Topology::new([axis(0), axis(1)]), proves: Proves::Sampled, cells, blocked }
}

pub fn planner(equation: EquationChoice, relaxation: Relaxation) -> FieldPlanner {
    let field = FieldChoice::Relaxed {
        equation,
        relaxation,
        measure: Measure::GreatestRelativeChange,
        tolerance: 1e-12,
        max_sweeps: 20_000,
        on: Device::Cpu,
        stencil: Stencil::Square,
        initial: cplan::field::Initial::High,
    };
    FieldPlanner { field, limits: Limits::High, escape: None, path: PathKind::Own }
}

pub fn run(planner: FieldPlanner, zoned: &ZonedGrid, start: usize, goal: usize) -> Run {
    let query = Query { start: zoned.grid.center(start), goals: zoned.grid.center(goal).into() };
    planner.build(zoned);
    planner.query(zoned, &(), &query)
}

pub fn found(run: &Run) -> &Path {
    match &run.outcome {
        Proposal::Found(path) => path,
        other => panic!("{other:?}"),
    }
}

/// Returns true if a cell that contains `q` is free. On the side between two cells, it suffices that one of them is
/// free.
pub fn is_free(grid: &Grid, q: Configuration) -> bool {
    let beside = |d: [f64; 2]| {
        let p = q + Configuration::new(d[0] * 1e-7 * grid.step()[0], d[1] * 1e-7 * grid.step()[1]);
        grid.topology.contains(p) && !grid.blocked[grid.locate(p)]
    };
    [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].into_iter().any(beside)
}

pub fn reason(run: &Run) -> &str {
    match &run.outcome {
        Proposal::GaveUp(reason) => reason,
        other => panic!("{other:?}"),
    }
}

fn equations() -> Vec<EquationChoice> {
    let direction = Direction::of([0.6, -0.8]).unwrap();
    let mut equations = vec![EquationChoice::Harmonic, EquationChoice::AlteredPreference { elsewhere: 0.7 }];
    for difference in [Difference::Central, Difference::Upwind] {
        equations.extend([
            EquationChoice::Oriented { direction, epsilon: 0.5, difference },
            EquationChoice::LocallyOriented { direction: Some(direction), difference },
            EquationChoice::Preference { elsewhere: 0.7, difference },
        ]);
    }
    equations
}

proptest! {
    #![proptest_config(cplan_cases::cases(150))]

    /// Checks that every field finds a path exactly if a wave reaches the goal, and that its path visits only free
    /// cells.
    #[test]
    fn every_field_answers_as_the_wave_does(
        (cells, blocked, start, goal) in (2..10_usize, 2..10_usize).prop_flat_map(|(rows, columns)| {
            let n = rows * columns;
            let blocked = proptest::collection::vec(proptest::bool::weighted(0.3), n);
            (Just([rows, columns]), blocked, 0..n, 0..n)
        }),
        circle in any::<bool>(),
    ) {
        let mut blocked = blocked;
        (blocked[start], blocked[goal]) = (false, false);
        let zoned = ZonedGrid::new(grid(cells, [circle, false], blocked), &scene(Vec::new()));
        let query = Query { start: zoned.grid.center(start), goals: zoned.grid.center(goal).into() };
        let wave = Wavefront::default();
        let exists = match wave.query(&zoned.grid, &wave.build(&zoned.grid), &query).outcome {
            Proposal::Found(_) => true,
            Proposal::NoPath => false,
            Proposal::GaveUp(reason) => panic!("{reason}"),
        };
        for equation in equations() {
            let run = run(planner(equation, GAUSS_SEIDEL), &zoned, start, goal);
            prop_assert_eq!(run.outcome == Proposal::NoPath, !exists, "{:?}", equation);
            if exists {
                for (a, b) in found(&run).segments() {
                    for k in 0..=20 {
                        let q = a + (b - a) * (f64::from(k) / 20.0);
                        prop_assert!(is_free(&zoned.grid, q), "{equation:?}: {q:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_direction_decides_on_which_side_of_an_obstacle_to_pass() {
    let text = ".........\n".repeat(4) + "....#....\n....#....\n" + &".........\n".repeat(4);
    let zoned = ZonedGrid::new(drawn(&text), &scene(Vec::new()));
    let (start, goal) = (4, 9 * 9 + 4);
    let sides = [[0.0, 1.0], [0.0, -1.0]].map(|vector| {
        let direction = Direction::of(vector).unwrap();
        let equation = EquationChoice::Oriented { direction, epsilon: 0.5, difference: Difference::Central };
        let run = run(planner(equation, GAUSS_SEIDEL), &zoned, start, goal);
        found(&run).waypoints().iter().map(|q| q[1] - 4.5).collect::<Vec<_>>()
    });
    assert!(sides[0].iter().any(|offset| offset.abs() > 0.5));
    assert_eq!(sides[0].len(), sides[1].len());
    assert!(sides[0].iter().zip(&sides[1]).all(|(a, b)| (a + b).abs() < 1e-6), "{sides:?}");
}

#[test]
fn a_positive_preference_keeps_out_of_a_region_and_a_negative_one_draws_in() {
    // Two routes lead round a block, and the region is on one of them.
    let text = "...........\n".repeat(3) + &"...#####...\n".repeat(5) + &"...........\n".repeat(3);
    let corners = [(2.0, 0.0), (9.0, 0.0), (9.0, 3.0), (2.0, 3.0)].map(|(x, y)| Point::new(x, y));
    for choice in [
        EquationChoice::Preference { elsewhere: 0.0, difference: Difference::Central },
        EquationChoice::Preference { elsewhere: 0.0, difference: Difference::Upwind },
        EquationChoice::AlteredPreference { elsewhere: 0.0 },
    ] {
        let passes_by = [1.0, -1.0].map(|epsilon| {
            let region = Region::Configurations(SimplePolygon::new(corners.to_vec()).unwrap());
            let preference = Preference { name: "left".into(), region, epsilon, direction: None };
            let zoned = ZonedGrid::new(drawn(&text), &scene(vec![preference]));
            let run = run(planner(choice, GAUSS_SEIDEL), &zoned, 5, 10 * 11 + 5);
            found(&run).waypoints().iter().any(|q| q[1] < 3.0)
        });
        assert_eq!(passes_by, [false, true], "{choice:?}");
    }
}

#[test]
fn underflow_is_reported_with_its_place() {
    let zoned = ZonedGrid::new(grid([1, 1300], [false; 2], vec![false; 1300]), &scene(Vec::new()));
    let run = run(planner(EquationChoice::Harmonic, GAUSS_SEIDEL), &zoned, 1299, 0);
    let reason = reason(&run);
    assert!(reason.starts_with("the field is flat at (0.5000, 1299.5000), cell (0, 1299): "), "{reason}");
    assert!(reason.ends_with("too small for doubles"), "{reason}");
}

#[test]
fn unconverged_fields_are_reported() {
    let zoned = ZonedGrid::new(drawn(&"..........\n".repeat(10)), &scene(Vec::new()));
    let hasty = |max_sweeps| {
        let relaxation = Relaxation::JACOBI;
        let field = FieldChoice::Relaxed {
            equation: EquationChoice::Harmonic,
            relaxation,
            measure: Measure::GreatestRelativeChange,
            stencil: Stencil::Square,
            initial: cplan::field::Initial::High,
            tolerance: 1e-9,
            max_sweeps,
            on: Device::Cpu,
        };
        FieldPlanner { field, limits: Limits::High, escape: None, path: PathKind::Own }
    };
    // After three sweeps, the goal has not influenced a cell ten cells away.
    let early = run(hasty(3), &zoned, 99, 0);
    assert!(reason(&early).starts_with("the field is not converged after 3 sweeps: "), "{:?}", early.outcome);
    // After thirty sweeps it has influenced all cells, and the field leads to the goal, but the field has not
    // converged.
    let late = run(hasty(30), &zoned, 99, 0);
    assert!(
        reason(&late).starts_with("the field is not converged after 30 sweeps: allow more sweeps"),
        "{:?}",
        late.outcome
    );
    assert!(matches!(late.note, Some(Note::Unconverged { sweeps: 30, .. })), "{:?}", late.note);
    assert_eq!(late.size, Size::Grid { cells: 100, sweeps: 30 });
}

#[test]
fn divergence_and_traps_are_reasons() {
    let zoned = ZonedGrid::new(drawn(&"..........\n".repeat(10)), &scene(Vec::new()));
    let sor = Relaxation::sor(Factor::Given(2.5), Order::RedBlack);
    let diverged = run(planner(EquationChoice::Harmonic, sor), &zoned, 99, 0);
    assert!(reason(&diverged).contains("the relaxation diverged"), "{:?}", diverged.outcome);
    let laws = Khatib {
        attraction: Attraction::Linear(1.0),
        repulsion: Repulsion::Ranged { gain: 1.0, range: 3.0 },
        saturated: false,
    };
    let khatib = FieldPlanner {
        field: FieldChoice::Khatib(laws),
        limits: Limits::Reflecting,
        escape: None,
        path: PathKind::Own,
    };
    let trap = ZonedGrid::new(drawn("........\n.####...\n....#...\n....#...\n.####...\n........"), &scene(Vec::new()));
    let run = run(khatib, &trap, 2 * 8 + 2, 2 * 8 + 7);
    assert!(reason(&run).contains("local minimum of ") && reason(&run).contains(" at ("), "{:?}", run.outcome);
    let Trace::Field { values: heights, .. } = &run.trace else { panic!("{:?}", run.trace) };
    assert_eq!(heights.iter().filter(|height| height.is_infinite()).count(), 10);
}

#[test]
fn a_region_without_direction_is_a_reason_where_one_is_needed() {
    let region = Region::Tip(
        SimplePolygon::new([(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(x, y)| Point::new(x, y)).to_vec()).unwrap(),
    );
    let preference = Preference { name: "everywhere".into(), region, epsilon: 0.5, direction: None };
    let zoned = ZonedGrid::new(drawn("....\n...."), &scene(vec![preference]));
    let local = EquationChoice::LocallyOriented { direction: None, difference: Difference::Central };
    assert_eq!(
        reason(&run(planner(local, GAUSS_SEIDEL), &zoned, 0, 7)),
        "the preference \"everywhere\" has no direction"
    );
}
