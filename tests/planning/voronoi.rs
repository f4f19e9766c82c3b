//! Voronoi diagrams, and the paths of greatest clearance along them, compared with distances from all sides, with
//! floods over grids, and with closed forms.

use cplan::cspace::{PolygonWithHoles, Proves, Regions};
use cplan::geometry::Point;
use cplan::planner::{PathKind, Planner, Proposal, Query, Run, Size, Trace, Voronoi};
use cplan::space::{Configuration, JointRange, Measure, Metric, Path, Segment, Topology};
use cplan_cases::dice::Dice;
use cplan_testkit::roadmap::*;
use cplan_testkit::scenes::q;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn run(regions: &Regions, start: Point, goal: Point) -> Run {
    let planner = Voronoi::default();
    let query = Query { start, goals: goal.into() };
    planner.query(regions, &planner.build(regions), &query)
}

fn path(run: &Run) -> Option<&Path> {
    match &run.outcome {
        Proposal::Found(path) => Some(path),
        Proposal::NoPath => None,
        Proposal::GaveUp(reason) => panic!("gave up: {reason}"),
    }
}

/// Returns the sides that an arm can hit: those of free space, without the window's sides on circles. Includes their
/// copies on other turns.
fn obstacles(regions: &Regions) -> Vec<(Point, Point)> {
    let circle = |k: usize| regions.topology.ranges[k].is_circle();
    let on_seam = |a: Point, b: Point| {
        (0..2).any(|k| circle(k) && a[k] == b[k] && [regions.window[k].0, regions.window[k].1].contains(&a[k]))
    };
    let turns = |k: usize| if circle(k) { vec![-2.0 * TAU, 0.0, 2.0 * TAU] } else { vec![0.0] };
    let mut all = Vec::new();
    for (a, b) in sides(regions).into_iter().filter(|(a, b)| !on_seam(*a, *b)) {
        for x in turns(0) {
            let shifted = |p: Point, y: f64| Point::new(p.x + x, p.y + y);
            all.extend(turns(1).into_iter().map(|y| (shifted(a, y), shifted(b, y))));
        }
    }
    all
}

fn nearest(p: Point, (a, b): (Point, Point)) -> Point {
    a + (b - a) * ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0)
}

fn clearance(sides: &[(Point, Point)], p: Point) -> f64 {
    sides.iter().map(|side| (p - nearest(p, *side)).norm()).fold(f64::INFINITY, f64::min)
}

/// Returns the least clearance of a path, over many samples.
fn least_clearance(sides: &[(Point, Point)], path: &Path) -> f64 {
    let along = |(a, b): (Configuration, Configuration)| (0..=40).map(move |k| a + (b - a) * (f64::from(k) / 40.0));
    path.segments().flat_map(along).map(|p| clearance(sides, p)).fold(f64::INFINITY, f64::min)
}

/// Checks that at each end of an arc or chord, two nearest points are on different sides of free space. In between,
/// both distances are almost equal. The diagram must be connected.
fn assert_is_diagram(regions: &Regions, run: &Run, ends: &[Point]) {
    let sides = obstacles(regions);
    let Trace::Roads { edges, .. } = &run.trace else { panic!("{:?}", run.trace) };
    assert!(!edges.is_empty());
    let on_border = |p: Point| {
        (0..2).any(|k| [regions.window[k].0, regions.window[k].1].iter().any(|bound| (p[k] - bound).abs() < 1e-9))
    };
    let is_leg = |edge: &[Point; 2]| ends.iter().any(|end| edge.iter().any(|p| (p - end).norm() < 1e-9));
    // An arc ends where others begin, or at a corner of free space.
    let mut meeting = std::collections::BTreeMap::new();
    for p in edges.iter().flatten() {
        *meeting.entry((p[0].to_bits(), p[1].to_bits())).or_insert(0) += 1;
    }
    for (&(x, y), _) in meeting.iter().filter(|(_, count)| **count == 1) {
        let p = Point::new(f64::from_bits(x), f64::from_bits(y));
        let is_end = ends.iter().any(|end| (p - end).norm() < 1e-9) || clearance(&sides, p) < 1e-6 || on_border(p);
        assert!(is_end, "an arc ends at {p}, {} from obstacles", clearance(&sides, p));
    }
    for [a, b] in edges.iter().filter(|edge| !is_leg(edge)) {
        for (share, is_end) in [(0.0, true), (1.0, true), (0.25, false), (0.5, false), (0.75, false)] {
            let p = a + (b - a) * share;
            let foot = sides.iter().map(|side| nearest(p, *side));
            let least = clearance(&sides, p);
            // A chord that the window has cut ends at the chord.
            let slack = if is_end && !on_border(p) { 4e-7 } else { 1e-6 + f64::min(2.5e-3, 0.025 * least) };
            let close: Vec<Point> = foot.filter(|foot| (p - foot).norm() <= least + slack).collect();
            let is_two = least < 1e-6 || close.iter().any(|foot| (foot - close[0]).norm() > 1e-6);
            assert!(is_two, "{p} between {a} and {b} is {least} from {close:?} alone");
        }
    }
}

/// Returns the greatest clearance that a path can keep along its whole length. The path goes from cell to cell of a
/// grid, and begins and ends next to `start` and `goal`.
fn widest_on_grid(regions: &Regions, within: [(f64, f64); 2], n: usize, start: Point, goals: &[Point]) -> (f64, f64) {
    let (sides, obstacles) = (sides(regions), obstacles(regions));
    let step = within.map(|(lower, upper)| (upper - lower) / n as f64);
    let center = |k: usize| {
        Point::new(within[0].0 + (0.5 + (k / n) as f64) * step[0], within[1].0 + (0.5 + (k % n) as f64) * step[1])
    };
    let place = |p: Point| {
        let [i, j] = [0, 1].map(|k| (((p[k] - within[k].0) / step[k]) as usize).min(n - 1));
        i * n + j
    };
    let width: Vec<f64> = (0..n * n)
        .map(center)
        .map(|p| if is_nearly_free(&sides, p) { clearance(&obstacles, p) } else { -1.0 })
        .collect();
    let mut order: Vec<usize> = (0..n * n).filter(|&k| width[k] > 0.0).collect();
    order.sort_by(|&a, &b| width[b].total_cmp(&width[a]));
    let mut root: Vec<usize> = (0..n * n).collect();
    fn find(root: &mut [usize], mut k: usize) -> usize {
        while root[k] != k {
            root[k] = root[root[k]];
            k = root[k];
        }
        k
    }
    let mut seen = vec![false; n * n];
    for cell in order {
        seen[cell] = true;
        let (i, j) = ((cell / n) as i32, (cell % n) as i32);
        for (x, y) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (i + x, j + y))) {
            if (0..n as i32).contains(&x) && (0..n as i32).contains(&y) && seen[(x as usize) * n + y as usize] {
                let (a, b) = (find(&mut root, cell), find(&mut root, (x as usize) * n + y as usize));
                root[a] = b;
            }
        }
        let from = find(&mut root, place(start));
        if seen[place(start)] && goals.iter().any(|g| seen[place(*g)] && find(&mut root, place(*g)) == from) {
            return (width[cell], step[0].hypot(step[1]));
        }
    }
    (0.0, step[0].hypot(step[1]))
}

/// Draws a free place with some clearance.
fn free_place(random: &mut Dice, regions: &Regions, within: [(f64, f64); 2]) -> Option<Point> {
    let (sides, obstacles) = (sides(regions), obstacles(regions));
    (0..200)
        .map(|_| Point::new(random.within(within[0].0, within[0].1), random.within(within[1].0, within[1].1)))
        .find(|p| is_nearly_free(&sides, *p) && clearance(&obstacles, *p) > 0.02)
}

/// Returns a crowd on a torus, or a cylinder between walls, over two turns of each circle.
fn repeated_crowd(crowd: &[Vec<Point>], side: usize, circles: [bool; 2]) -> Regions {
    let scale = TAU / side as f64;
    let range = |k: usize| if circles[k] { (-TAU, TAU) } else { (0.0, TAU) };
    let turns = |k: usize| if circles[k] { vec![-TAU, 0.0] } else { vec![0.0] };
    let copy = |polygon: &Vec<Point>, x: f64, y: f64| -> Vec<Point> {
        polygon.iter().map(|p| Point::new(p.x * scale + x, p.y * scale + y)).collect()
    };
    let mut holes = Vec::new();
    for x in turns(0) {
        for y in turns(1) {
            holes.extend(crowd.iter().map(|polygon| copy(polygon, x, y).into_iter().rev().collect::<Vec<_>>()));
        }
    }
    let window = [range(0), range(1)];
    let axis = |k: usize| {
        if circles[k] { JointRange::Circle } else { JointRange::Interval { lower: window[k].0, upper: window[k].1 } }
    };
    let free = vec![PolygonWithHoles { outer: rectangle(window[0], window[1]), holes }];
    let topology = Topology::new([axis(0), axis(1)]);
    Regions { topology, proves: Proves::Exact, window, obstacles: Vec::new(), free }
}

proptest! {
    #![proptest_config(cplan_cases::cases(48))]

    #[test]
    fn path_widths_agree_with_flood_fill(seed: u64, count in 1usize..10) {
        let mut random = Dice::new(seed);
        let regions = star_crowd(&mut random, count);
        let [start, goal] = [0, 1].map(|_| free_place(&mut random, &regions, regions.window).expect("most of it is free"));
        let run = run(&regions, start, goal);
        assert_is_diagram(&regions, &run, &[start, goal]);
        let path = path(&run).expect("stars do not touch");
        assert_free(&regions, path);
        let width = least_clearance(&obstacles(&regions), path);
        let (expected, cell) = widest_on_grid(&regions, regions.window, 90, start, &[goal]);
        prop_assert!(width >= 0.98 * expected - cell, "{width} {expected} {cell}");
        prop_assert!(width <= expected + cell, "{width} {expected} {cell}");
    }

    #[test]
    fn paths_lead_across_seams(seed: u64, side in 1usize..4, corners in 3usize..7, first: bool, second: bool) {
        let mut random = Dice::new(seed);
        let regions = repeated_crowd(&convex_crowd(&mut random, side, corners), side, [first, second]);
        // The inner part, which the sides of the window do not affect.
        let inner = [0, 1].map(|k| if [first, second][k] { (-PI, PI) } else { regions.window[k] });
        let place = |random: &mut Dice| free_place(random, &regions, inner).expect("most of it is free");
        let (start, goal) = (place(&mut random), place(&mut random));
        let run = run(&regions, start, goal);
        let turns = |k: usize| if [first, second][k] { vec![-TAU, 0.0, TAU] } else { vec![0.0] };
        let copies = turns(0).into_iter().flat_map(|x| turns(1).into_iter().map(move |y| Point::new(goal.x + x, goal.y + y)));
        let copies: Vec<Point> = copies.collect();
        assert_is_diagram(&regions, &run, &[&[start][..], &copies].concat());
        let path = path(&run).expect("a path exists");
        assert_free(&regions, path);
        prop_assert!(copies.iter().any(|copy| (copy - path.goal()).norm() < 1e-9));
        let width = least_clearance(&obstacles(&regions), path);
        let shrunk = [0, 1].map(|k| if [first, second][k] { (-1.5 * PI, 1.5 * PI) } else { regions.window[k] });
        let near: Vec<Point> = copies.into_iter().filter(|p| (0..2).all(|k| shrunk[k].0 < p[k] && p[k] < shrunk[k].1)).collect();
        let (expected, cell) = widest_on_grid(&regions, shrunk, 80, start, &near);
        prop_assert!(width >= 0.98 * expected - cell, "{width} {expected} {cell}");
    }

    /// Checks boards, which have collinear sides, equal distances everywhere, and corners that touch. The planner finds
    /// a path exactly if a flood fill does.
    #[test]
    fn boards_have_paths_where_flood_fill_finds_them(seed: u64, size in 2usize..7, density in 0.1..0.6) {
        let mut random = Dice::new(seed);
        let board = Board::random(&mut random, size, density);
        let component = board.components();
        let free: Vec<usize> = (0..board.free.len()).filter(|&k| board.free[k]).collect();
        prop_assume!(!free.is_empty());
        let map = [[[1, 0], [0, 1]], [[0, -1], [1, 0]], [[2, 1], [1, 1]]][random.below(3_usize)];
        let regions = board.regions(map, || random.bits().is_multiple_of(2));
        for _ in 0..4 {
            let [a, b] = [0, 1].map(|_| free[random.below(free.len())]);
            // The middle of a square is on the diagram, other places are not.
            let inside = random.within(0.1, 0.9);
            let [p, q] = [(a, 0.5), (b, inside)].map(|(k, y)| mapped(map, (k / size) as f64 + 0.5, (k % size) as f64 + y));
            let run = run(&regions, p, q);
            prop_assert_eq!(path(&run).is_some(), component[a] == component[b]);
            if let Some(path) = path(&run) {
                assert_free(&regions, path);
            }
        }
    }
}

#[test]
fn between_two_walls_the_path_is_in_the_middle() {
    let regions = window_with_holes((0.0, 4.0), (0.0, 1.0), Vec::new());
    let run = run(&regions, Point::new(0.75, 0.2), Point::new(3.25, 0.9));
    let expected = [(0.75, 0.2), (0.75, 0.5), (3.25, 0.5), (3.25, 0.9)];
    let found = path(&run).expect("a way").waypoints();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (q, (x, y)) in found.iter().zip(expected) {
        assert!((q - Configuration::new(x, y)).norm() < 1e-9, "{found:?}");
    }
}

#[test]
fn a_square_room_has_its_diagonals() {
    let regions = window_with_holes((0.0, 2.0), (0.0, 2.0), Vec::new());
    let planner = Voronoi { path: PathKind::Taut, ..Voronoi::default() };
    let query = Query { start: q(1.0, 0.3), goals: q(1.8, 1.0).into() };
    let own = run(&regions, query.start, Point::new(1.8, 1.0));
    assert_eq!(path(&own).expect("a way").waypoints(), [(1.0, 0.3), (1.0, 1.0), (1.8, 1.0)].map(|(x, y)| q(x, y)));
    let Trace::Roads { edges, .. } = &own.trace else { panic!() };
    let diagonals = edges.iter().filter(|edge| edge.iter().any(|q| q.amin() < 1e-9 || q.amax() > 2.0 - 1e-9));
    let total: f64 = diagonals.map(|[a, b]| (b - a).norm()).sum();
    assert!((total - 32.0_f64.sqrt()).abs() < 1e-9, "{edges:?}");
    // The taut path is straight, however near it passes obstacles.
    let taut = planner.query(&regions, &planner.build(&regions), &query);
    assert_eq!(path(&taut).expect("a way").waypoints().len(), 2);
}

/// Checks two openings: the planner takes the wider one, although it is farther away.
#[test]
fn the_wider_gap_is_taken() {
    let walls = [((0.0, 0.9), 0.0), ((1.1, 3.0), 0.0), ((3.5, 5.0), 0.0)];
    let wall = |&((from, to), _): &((f64, f64), f64)| rectangle((from, to), (1.0, 1.1));
    let holes: Vec<Vec<Point>> = walls.iter().map(wall).collect();
    // A little off the limits, where obstacles may not touch in these tests.
    let regions = window_with_holes((-0.05, 5.05), (-1.0, 3.0), holes);
    let (start, goal) = (Point::new(1.0, 0.5), Point::new(1.0, 1.6));
    let run = run(&regions, start, goal);
    let through = path(&run).expect("a way").segments().find(|(a, b)| (a[1] - 1.05) * (b[1] - 1.05) <= 0.0);
    let (a, b) = through.expect("it goes through a door");
    assert!(a[0] > 3.0 && b[0] > 3.0, "{a} {b}");
    assert!((least_clearance(&obstacles(&regions), path(&run).unwrap()) - 0.25).abs() < 1e-9);
}

/// Checks that the path is straight if there is no obstacle to keep away from.
#[test]
fn without_obstacles_on_a_torus_the_path_is_straight() {
    let regions = repeated_crowd(&[], 1, [true, true]);
    let run = run(&regions, Point::new(0.5, 0.5), Point::new(3.0, -0.5));
    assert_eq!(path(&run).expect("a way").waypoints().len(), 2);
}

/// Checks a start at a goal of a set. The nearest goal is computed, so rounding may move it away from the start.
#[test]
fn a_start_at_a_goal_up_to_rounding_stays() {
    let regions = window_with_holes((0.0, 4.0), (0.0, 4.0), vec![rectangle((2.0, 2.5), (2.0, 2.5))]);
    let planner = Voronoi::default();
    let map = planner.build(&regions);
    let mut rounded = 0;
    for k in 1..=40 {
        let goals = Segment::new(q(0.1, 0.3), q(1.7, 0.9 + 0.01 * f64::from(k)));
        let start = goals.at(f64::from(k) / 41.0);
        rounded += u32::from(goals.nearest(Measure::from(Metric::Euclidean), start) != start);
        let run = planner.query(&regions, &map, &Query { start, goals: goals.into() });
        let length = path(&run).expect("it is there").length();
        assert!(length < 1e-12, "{length} from {start}");
    }
    assert!(rounded > 5, "{rounded} of 40");
}

/// Checks corners that nearly touch a side. The gap is too narrow for a path, so the diagram needs few arcs there.
#[test]
fn corners_that_all_but_touch_a_side_make_few_arcs() {
    for gap in [1e-12, 1e-11, 1e-10, 1e-9, 2e-9, 4e-9, 7e-9, 1e-8, 1e-7, 1e-6] {
        for x in [1.03, 17.03] {
            let wall = rectangle((0.5, x + 6.0), (0.4, 0.5));
            let diamond = points(&[(x, 0.5 + gap), (x + 0.17, 0.8), (x, 1.1), (x - 0.23, 0.8)]);
            let regions = window_with_holes((0.0, x + 7.0), (0.0, 1.7), vec![wall, diamond]);
            let run = run(&regions, Point::new(x - 0.4, 0.6), Point::new(x + 0.4, 0.6));
            let Size::Graph { edges, .. } = run.size else { panic!("{:?}", run.size) };
            assert!(edges < 2000, "{edges} edges at a gap of {gap} by {x}");
            let path = path(&run).expect("a way above the diamond");
            assert_free(&regions, path);
            assert!(least_clearance(&obstacles(&regions), path) > 0.05, "{gap} {x}");
        }
    }
}
