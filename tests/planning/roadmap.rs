//! Visibility graph and trapezoidal decomposition, compared with brute force, flood fill and closed forms.

use cplan::cspace::{PolygonWithHoles, Regions};
use cplan::geometry::Point;
use cplan::planner::{
    PathKind, Planner, Prm, Proposal, Query, RoadmapSearch, Run, SearchOrder, Size, Trace, Trapezoid, Triangles,
    Visibility, VisibilityGraph, Voronoi,
};
use cplan::space::{Configuration, Metric, Path, SumSpeed};
use cplan_cases::dice::Dice;
use cplan_testkit::roadmap::*;
use cplan_testkit::scenes::q;
use proptest::prelude::*;

const USUAL: RoadmapSearch = RoadmapSearch { order: SearchOrder::AStar, backward: false };
const VISIBILITY: Visibility = Visibility { metric: Metric::Euclidean, search: USUAL, graph: VisibilityGraph::Reduced };
const MIDDLES: Trapezoid = Trapezoid { path: PathKind::Own, search: USUAL };
const TAUT: Trapezoid = Trapezoid { path: PathKind::Taut, search: USUAL };

fn query(start: (f64, f64), goal: (f64, f64)) -> Query {
    Query { start: q(start.0, start.1), goals: q(goal.0, goal.1).into() }
}

fn run<P: Planner<Space = Regions>>(planner: &P, regions: &Regions, query: &Query) -> Run {
    let map = planner.build(regions);
    let run = planner.query(regions, &map, query);
    assert_eq!(run, planner.query(regions, &map, query), "same input, same output");
    run
}

/// Returns the path of a run, if any, after checks that hold for every path.
fn checked_path<P: Planner<Space = Regions>>(planner: &P, regions: &Regions, query: &Query) -> Option<Path> {
    match run(planner, regions, query).outcome {
        Proposal::Found(path) => {
            assert_eq!(path.start(), query.start);
            let to_goal = |g: &_| regions.topology.distance(path.goal(), *g);
            assert!(query.goals.points().any(|g| path.goal() == g || to_goal(&g) < 1e-12));
            assert_free(regions, &path);
            Some(path)
        }
        Proposal::NoPath => None,
        Proposal::GaveUp(reason) => panic!("gave up: {reason}"),
    }
}

/// Returns the lengths of three paths: by visibility, through trapezoids pulled taut, and through trapezoids as they
/// are. Checks that they are in ascending order.
fn lengths(regions: &Regions, query: &Query) -> Option<[f64; 3]> {
    let shortest = checked_path(&VISIBILITY, regions, query);
    let taut = checked_path(&TAUT, regions, query);
    let middles = checked_path(&MIDDLES, regions, query);
    assert_eq!(shortest.is_some(), taut.is_some(), "planners agree on whether there is a path");
    assert_eq!(shortest.is_some(), middles.is_some());
    let lengths = [shortest?.length(), taut?.length(), middles?.length()];
    assert!(lengths[0] <= lengths[1] + 1e-9 && lengths[1] <= lengths[2] + 1e-9, "{lengths:?}");
    Some(lengths)
}

/// Checks the paths of other searches and roadmaps. Each finds a free path if there is one, and none is shorter than
/// the shortest path. Searches for shortest paths find one of that length.
fn assert_searched(regions: &Regions, query: &Query, shortest: Option<f64>) {
    let ways = SearchOrder::ALL.into_iter().flat_map(|order| [false, true].map(|backward| (order, backward)));
    for search in ways.map(|(order, backward)| RoadmapSearch { order, backward }) {
        let same = |path: Option<Path>| {
            assert_eq!(path.is_some(), shortest.is_some(), "{search}");
            let length = path.map(|path| path.length());
            assert!(length >= shortest.map(|shortest| shortest - 1e-9), "{search}: {length:?} {shortest:?}");
            length
        };
        let seen = same(checked_path(&Visibility { metric: Metric::Euclidean, search, ..VISIBILITY }, regions, query));
        if let (true, Some(length), Some(shortest)) = (search.order.is_optimal(), seen, shortest) {
            assert!(length < shortest + 1e-9, "{search}: {length} {shortest}");
        }
        let [own, taut] = PathKind::ALL.map(|path| same(checked_path(&Triangles { path, search }, regions, query)));
        // If a search makes detours, the taut path within its channel may be longer than necessary.
        assert!(!search.order.is_optimal() || taut <= own.map(|own| own + 1e-9), "{search}: {taut:?} {own:?}");
        same(checked_path(&Trapezoid { path: PathKind::Taut, search }, regions, query));
        for path in PathKind::ALL {
            same(checked_path(&Voronoi { path, search }, regions, query));
        }
    }
    for path in PathKind::ALL {
        // Few samples may find a path, but never prove infeasibility.
        let prm = Prm { samples: 60, nearest: 6, path, ..Prm::default() };
        match run(&prm, regions, query).outcome {
            Proposal::Found(path) => {
                assert_free(regions, &path);
                assert!(shortest.is_some_and(|shortest| path.length() >= shortest - 1e-9), "{shortest:?}");
            }
            outcome => assert!(matches!(outcome, Proposal::GaveUp(_)), "{outcome:?}"),
        }
    }
}

fn cells(regions: &Regions) -> (Vec<Vec<Point>>, usize) {
    let run = run(&TAUT, regions, &query((1e9, 1e9), (1e9, 1e9)));
    let (Trace::Channel { cells, .. }, Size::Graph { nodes, edges }) = (run.trace, run.size) else { panic!() };
    assert_eq!(nodes, cells.len());
    (cells.to_vec(), edges)
}

/// Checks that cells are convex, and cover free space without overlap: their areas add up, and their middles are free.
/// Two cells are joined exactly if they share a piece of a vertical.
fn assert_decomposed(regions: &Regions) {
    let (cells, portals) = cells(regions);
    let sides = sides(regions);
    for cell in &cells {
        assert!(cell.len() == 3 || cell.len() == 4, "{cell:?}");
        assert!(area([cell.clone()]) > 0.0);
        let middle = cell.iter().fold(Point::zeros(), |sum, p| sum + p) / cell.len() as f64;
        assert!(is_nearly_free(&sides, middle));
    }
    let free = area(contours(regions).cloned());
    assert!((area(cells.clone()) - free).abs() < 1e-9 * free.max(1.0));
    let vertical = |cell: &Vec<Point>, x: f64| {
        let on: Vec<f64> = cell.iter().filter(|p| p.x == x).map(|p| p.y).collect();
        on.iter().fold((f64::MAX, f64::MIN), |(low, high), &y| (low.min(y), high.max(y)))
    };
    let right_end = |cell: &Vec<Point>| cell.iter().map(|p| p.x).fold(f64::MIN, f64::max);
    let left_end = |cell: &Vec<Point>| cell.iter().map(|p| p.x).fold(f64::MAX, f64::min);
    let mut shared = 0;
    for a in &cells {
        for b in cells.iter().filter(|b| left_end(b) == right_end(a)) {
            let (v, w) = (vertical(a, right_end(a)), vertical(b, left_end(b)));
            shared += usize::from(v.0.max(w.0) + 1e-12 < v.1.min(w.1));
        }
    }
    assert_eq!(portals, shared);
}

const MAPS: [[[i32; 2]; 2]; 5] =
    [[[1, 0], [0, 1]], [[0, -1], [1, 0]], [[1, 1], [0, 1]], [[2, 1], [1, 1]], [[1, 0], [-1, 1]]];

proptest! {
    #![proptest_config(cplan_cases::cases(48))]

    #[test]
    fn shortest_among_convex_polygons_equals_brute_force(seed: u64, side in 1usize..4, corners in 3usize..7) {
        let mut random = Dice::new(seed);
        let crowd = convex_crowd(&mut random, side, corners);
        let regions = crowd_regions(side, &crowd);
        // The places are outside the cells of the crowd, where there are no polygons.
        let ends = [0, 1].map(|_| (random.within(-0.2, -0.01), random.within(-0.2, side as f64 + 0.2)));
        let (start, goal) = (ends[0], (side as f64 - ends[1].0, ends[1].1));
        let window = (-0.25, side as f64 + 0.25);
        let expected = brute_force_length(&crowd, window, Point::new(start.0, start.1), Point::new(goal.0, goal.1));
        let found = lengths(&regions, &query(start, goal));
        prop_assert!((found.unwrap()[0] - expected.unwrap()).abs() < 1e-8, "{found:?} {expected:?}");
        assert_decomposed(&regions);
        assert_searched(&regions, &query(start, goal), expected);
    }

    #[test]
    fn shortest_in_every_metric_equals_brute_force(seed: u64, side in 1usize..4, ratio in 0.2..5.0_f64) {
        let mut random = Dice::new(seed);
        let crowd = convex_crowd(&mut random, side, 4);
        let regions = crowd_regions(side, &crowd);
        let window = (-0.25, side as f64 + 0.25);
        let [s, g] = [0, 1].map(|_| Point::new(random.within(-0.2, -0.01), random.within(-0.2, side as f64 + 0.2)));
        let goals = [Point::new(side as f64 - g.x, g.y), Point::new(g.x, side as f64 - g.x)];
        for metric in metrics(ratio) {
            let planner = Visibility { metric, ..VISIBILITY };
            let query = Query { start: s, goals: goals.into_iter().collect() };
            let found = metric.length(&checked_path(&planner, &regions, &query).unwrap());
            let expected = goals.map(|g| brute_force(&crowd, window, s, g, metric).unwrap());
            prop_assert!((found - expected[0].min(expected[1])).abs() < 1e-8, "{metric:?} {found} {expected:?}");
        }
    }

    /// Checks squares of one and two units that touch along sides and in corners. The squares are in place, mirrored
    /// exactly, or turned. Turning rounds corners slightly to either side of the sides on which they lie, and leaves
    /// tiny gaps.
    #[test]
    fn touching_obstacles_equal_brute_force(
        seed: u64, size in 2usize..6, density in 0.1..0.5, turn in prop_oneof![Just(None), (0.0..1.6_f64).prop_map(Some)],
    ) {
        let mut random = Dice::new(seed);
        let blocks = blocks(&mut random, size, density);
        let (sin, cos) = turn.unwrap_or(0.0).sin_cos();
        let turned = |x: f64, y: f64| Point::new(x * cos - y * sin, x * sin + y * cos);
        let block = |&(x, y, n): &(usize, usize, usize), growth: f64| {
            let range = |k: usize| (k as f64 - growth, (k + n) as f64 + growth);
            rectangle(range(x), range(y)).into_iter().map(|p| turned(p.x, p.y)).collect::<Vec<_>>()
        };
        let sized = |growth: f64| -> Vec<_> { blocks.iter().map(|b| block(b, growth)).collect() };
        let window = (-2.0 * size as f64, 2.0 * size as f64);
        // A tiny gap may or may not be passable.
        let growth = 1e-6;
        let least = if turn.is_some() { -growth } else { growth };
        let (grown, shrunk) = (sized(growth), sized(least));
        let regions = window_with_holes(window, window, sized(0.0));
        for _ in 0..3 {
            let mut place = || (random.bits() % (size as u64 + 2)) as f64 - 0.5;
            let [p, q] = [(place(), place()), (place(), place())];
            let is_free = |(x, y): (f64, f64)| !blocks.iter().any(|b| {
                let within = |v: f64, k: usize| v > k as f64 && v < (k + b.2) as f64;
                within(x, b.0) && within(y, b.1)
            });
            if !is_free(p) || !is_free(q) {
                continue;
            }
            let [s, g] = [turned(p.0, p.1), turned(q.0, q.1)];
            let query = query((s.x, s.y), (g.x, g.y));
            for metric in metrics(1.7) {
                let found = checked_path(&Visibility { metric, ..VISIBILITY }, &regions, &query).map(|path| metric.length(&path));
                let most = brute_force(&grown, window, s, g, metric).unwrap_or(f64::INFINITY);
                let least = brute_force(&shrunk, window, s, g, metric).unwrap_or(f64::INFINITY);
                let found = found.unwrap_or(f64::INFINITY);
                prop_assert!(found <= most + 1e-9, "{found} {most}");
                prop_assert!(found >= least - 200.0 * growth, "{found} {least}");
            }
            lengths(&regions, &query);
        }
    }

    /// Compares the graph with the definition: pairs of convex corners, tangent at both ends, that no side separates.
    #[test]
    fn the_whole_graph_is_that_of_the_definition(seed: u64, count in 1usize..9) {
        let regions = star_crowd(&mut Dice::new(seed), count);
        let mut expected = bitangents(&regions);
        let mut arcs = VISIBILITY.build(&regions).arcs();
        let key = |ends: &[Configuration; 2]| ends.map(|q| (q[0], q[1]));
        let order = |a: &[Configuration; 2], b: &[Configuration; 2]| key(a).partial_cmp(&key(b)).unwrap();
        arcs.sort_by(order);
        expected.sort_by(order);
        prop_assert_eq!(arcs, expected);
    }

    #[test]
    fn boards_equal_flood_fill_and_brute_force(seed: u64, size in 2usize..7, density in 0.1..0.6) {
        let mut random = Dice::new(seed);
        let board = Board::random(&mut random, size, density);
        let component = board.components();
        let free: Vec<usize> = (0..board.free.len()).filter(|&k| board.free[k]).collect();
        prop_assume!(!free.is_empty());
        let map = MAPS[(random.bits() % 5) as usize];
        let regions = board.regions(map, || random.bits().is_multiple_of(2));
        assert_decomposed(&regions);
        // The squares are slightly grown, so that gaps between touching corners are closed.
        let growth = 1e-5;
        let blocked = (0..board.free.len()).filter(|&k| !board.free[k]).map(|k| {
            let range = |k: usize| (k as f64 - growth, (k + 1) as f64 + growth);
            rectangle(range(k / size), range(k % size))
        });
        let blocked: Vec<_> = blocked.collect();
        for _ in 0..3 {
            let [a, b] = [0, 1].map(|_| free[(random.bits() % free.len() as u64) as usize]);
            let [p, q] = [a, b].map(|k| Point::new((k / size) as f64 + 0.5, (k % size) as f64 + 0.5));
            let [s, g] = [p, q].map(|p| mapped(map, p.x, p.y));
            let found = lengths(&regions, &query((s.x, s.y), (g.x, g.y)));
            prop_assert_eq!(found.is_some(), component[a] == component[b]);
            if let (Some(found), true) = (found, map == MAPS[0] || map == MAPS[1]) {
                let expected = brute_force_length(&blocked, (0.0, size as f64), p, q).unwrap();
                prop_assert!(found[0] <= expected + 1e-9 && expected <= found[0] + 100.0 * growth);
            }
        }
    }

    #[test]
    fn starts_on_corners_and_sides_of_boards(seed: u64, size in 2usize..6, density in 0.1..0.5) {
        let mut random = Dice::new(seed);
        let board = Board::random(&mut random, size, density);
        let map = MAPS[(random.bits() % 5) as usize];
        let regions = board.regions(map, || random.bits().is_multiple_of(2));
        let component = board.components();
        // The components of the free squares around a point of the half-integer lattice.
        let around = |x: i32, y: i32| {
            let squares = |v: i32| if v % 2 == 0 { vec![v / 2 - 1, v / 2] } else { vec![v / 2] };
            let all = squares(x).into_iter().flat_map(|i| squares(y).into_iter().map(move |j| (i, j)));
            let free = all.filter(|&(i, j)| board.is_free(i, j));
            free.filter_map(|(i, j)| component[i as usize * size + j as usize]).collect::<Vec<_>>()
        };
        for _ in 0..4 {
            let [p, q] = [0, 1].map(|_| [0, 1].map(|_| (random.bits() % (2 * size as u64 + 1)) as i32));
            let (from, to) = (around(p[0], p[1]), around(q[0], q[1]));
            let [s, g] = [p, q].map(|p| mapped(map, f64::from(p[0]) / 2.0, f64::from(p[1]) / 2.0));
            let query = query((s.x, s.y), (g.x, g.y));
            if from.is_empty() || to.is_empty() {
                for outcome in [run(&VISIBILITY, &regions, &query).outcome, run(&TAUT, &regions, &query).outcome] {
                    prop_assert!(matches!(outcome, Proposal::GaveUp(_)));
                }
            } else {
                let connected = p == q || from.iter().any(|c| to.contains(c));
                prop_assert_eq!(lengths(&regions, &query).is_some(), connected);
            }
        }
    }
}

/// Returns one metric of each kind.
fn metrics(ratio: f64) -> [Metric; 5] {
    let speeds = [1.0, ratio];
    [
        Metric::Euclidean,
        Metric::Weighted { weights: [1.0, ratio] },
        Metric::Motor { ratio: -ratio },
        Metric::Time { speeds, sum: None },
        Metric::Time { speeds, sum: Some(SumSpeed { ratio, speed: 0.8 }) },
    ]
}

/// Draws lower left corners and sizes of squares on a board, apart or touching.
fn blocks(random: &mut Dice, size: usize, density: f64) -> Vec<(usize, usize, usize)> {
    let mut taken = vec![false; size * size];
    let mut blocks = Vec::new();
    for k in 0..size * size {
        let (x, y) = (k / size, k % size);
        let squares = |n: usize| (x..x + n).flat_map(move |i| (y..y + n).map(move |j| i * size + j));
        let fits = |n: usize| x + n <= size && y + n <= size && squares(n).all(|s| !taken[s]);
        if random.within(0.0, 1.0) < density && fits(1) {
            let n = if random.bits().is_multiple_of(2) && fits(2) { 2 } else { 1 };
            blocks.push((x, y, n));
            squares(n).for_each(|s| taken[s] = true);
        }
    }
    blocks
}

#[test]
fn another_component_is_no_path_even_if_it_touches_in_a_corner() {
    let polygon = |outer| PolygonWithHoles { outer, holes: vec![] };
    let apart = vec![polygon(rectangle((0.0, 1.0), (0.0, 1.0))), polygon(rectangle((1.0, 2.0), (1.0, 2.0)))];
    let regions = regions([(0.0, 2.0); 2], apart);
    for (from, to, connected) in
        [((0.5, 0.5), (1.5, 1.5), false), ((1.0, 1.0), (1.5, 1.5), true), ((0.5, 0.5), (1.0, 1.0), true)]
    {
        assert_eq!(lengths(&regions, &query(from, to)).is_some(), connected, "{from:?} to {to:?}");
    }
}

#[test]
fn around_a_square_the_length_is_known() {
    let regions = window_with_holes((0.0, 4.0), (0.0, 4.0), vec![rectangle((1.0, 3.0), (1.0, 3.0))]);
    let found = lengths(&regions, &query((0.5, 1.5), (3.5, 1.5))).unwrap();
    // The path leads to the corner (1, 1), along the lower side, and up again.
    let expected = 2.0 * 0.5_f64.hypot(0.5) + 2.0;
    assert!((found[0] - expected).abs() < 1e-12);
    assert!((found[1] - expected).abs() < 1e-12);
    let diagonal = lengths(&regions, &query((0.0, 0.0), (4.0, 4.0))).unwrap();
    assert!((diagonal[0] - 2.0 * 10.0_f64.sqrt()).abs() < 1e-12);
    // A start that is inside by the last bit.
    let inside = query((1.0 + 1e-15, 2.0), (0.5, 0.5));
    for outcome in [run(&VISIBILITY, &regions, &inside).outcome, run(&TAUT, &regions, &inside).outcome] {
        assert!(matches!(&outcome, Proposal::GaveUp(reason) if reason.contains("start")), "{outcome:?}");
    }
}

#[test]
fn a_funnel_path_along_a_slanted_side_has_no_corners_between() {
    // From teeth above the slanted side, verticals lead down to its middle.
    let tooth = |x: f64| points(&[(x, 1.5 + x / 3.0), (x + 0.2, 2.9), (x - 0.2, 2.9)]);
    let floor = PolygonWithHoles {
        outer: points(&[(0.0, 0.0), (0.1, 0.1), (3.1, 1.1), (3.2, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]),
        holes: [0.7, 1.3, 1.9, 2.6].map(|x| tooth(x).into_iter().rev().collect()).to_vec(),
    };
    let regions = regions([(0.0, 4.0), (0.0, 3.0)], vec![floor]);
    let query = query((0.05, 0.05), (3.6, 0.1));
    let path = checked_path(&TAUT, &regions, &query).unwrap();
    let shortest = checked_path(&VISIBILITY, &regions, &query).unwrap();
    assert!((path.length() - shortest.length()).abs() < 1e-12);
    assert_eq!(path.waypoints().len(), 4, "{path:?}");
}

#[test]
fn a_hole_that_touches_the_outer_contour_blocks_that_passage() {
    // The hole's tip touches the lower side of the window, at a point that is no corner of it.
    let hole = points(&[(2.0, 0.0), (2.5, 3.0), (1.5, 3.0)]);
    let regions = window_with_holes((0.0, 4.0), (0.0, 4.0), vec![hole]);
    let found = lengths(&regions, &query((1.0, 0.0), (3.0, 0.0))).unwrap();
    assert!((found[0] - (1.0 + 2.0 * 0.5_f64.hypot(3.0))).abs() < 1e-12);
    assert_decomposed(&regions);
}

#[test]
fn no_path_leads_between_squares_that_touch_in_a_corner() {
    let touching = vec![rectangle((1.0, 2.0), (1.0, 2.0)), rectangle((2.0, 3.0), (2.0, 3.0))];
    let regions = window_with_holes((0.0, 4.0), (0.0, 4.0), touching);
    let found = lengths(&regions, &query((1.5, 2.5), (2.5, 1.5))).unwrap();
    // The path does not lead straight over (2, 2), but over the corner (2, 3) and along two sides.
    assert!((found[0] - (2.0 + 2.0_f64.sqrt())).abs() < 1e-12, "{found:?}");
    assert_decomposed(&regions);
}

#[test]
fn of_motions_that_take_equally_long_the_shortest_is_taken() {
    // On either side of the obstacle, the first joint needs 4 s. The path below is shorter.
    let regions = window_with_holes((0.0, 4.0), (-2.0, 2.0), vec![rectangle((1.5, 2.5), (-0.5, 0.6))]);
    let planner = Visibility { metric: Metric::Time { speeds: [1.0, 1.0], sum: None }, ..VISIBILITY };
    let path = checked_path(&planner, &regions, &query((0.0, 0.0), (4.0, 0.0))).unwrap();
    let corners = [(0.0, 0.0), (1.5, -0.5), (2.5, -0.5), (4.0, 0.0)].map(|(x, y)| q(x, y));
    assert_eq!(path.waypoints(), corners);
}

#[test]
fn arcs_are_bitangents_only() {
    // The eight sides of two squares, and their two outer and two inner bitangents.
    let squares = vec![rectangle((1.0, 2.0), (1.0, 2.0)), rectangle((4.0, 5.0), (1.5, 2.5))];
    let regions = window_with_holes((0.0, 6.0), (0.0, 4.0), squares);
    let map = VISIBILITY.build(&regions);
    assert_eq!(map.corners(), 8);
    assert_eq!(map.arcs().len(), 8 + 4);
}
