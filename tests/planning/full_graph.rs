//! The visibility graph, compared with its definition in integers.

use cplan::cspace::{PolygonWithHoles, Proves, Regions};
use cplan::geometry::Point;
use cplan::planner::{GraphKind, Planner, Proposal, Query, Trace, Visibility, VisibilityGraph};
use cplan::space::{Configuration, JointRange, Topology};
use std::collections::BTreeSet;

type Place = (i64, i64);

/// Returns rectangles in some of the 6 x 4 fields of the window. Many of their corners lie on one line.
fn rectangles(seed: u64) -> Vec<[Place; 4]> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut draw = |n: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % n) as i64
    };
    let mut all = Vec::new();
    for (i, j) in (0..6).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let [x, y, width, height] = [1 + draw(4), 1 + draw(4), 1 + draw(4), 1 + draw(4)];
        let (x, y) = (10 * i + x, 10 * j + y);
        if draw(3) > 0 {
            let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)];
            all.push(corners.map(|(x, y)| (2 * x, 2 * y)));
        }
    }
    all
}

fn regions(rectangles: &[[Place; 4]]) -> Regions {
    let ring = |corners: &[Place]| corners.iter().map(|&corner| Point::from(halves(corner))).collect::<Vec<_>>();
    let hole = |corners: &[Place; 4]| ring(corners).into_iter().rev().collect();
    let window = [(0.0, 60.0), (0.0, 40.0)];
    Regions {
        topology: Topology::new(window.map(|(lower, upper)| JointRange::Interval { lower, upper })),
        proves: Proves::Exact,
        window,
        obstacles: Vec::new(),
        free: vec![PolygonWithHoles { outer: ring(&WINDOW), holes: rectangles.iter().map(hole).collect() }],
    }
}

/// Corners of the window in halves of a unit, so that start and goal can lie beside its sides.
const WINDOW: [Place; 4] = [(0, 0), (120, 0), (120, 80), (0, 80)];

fn halves((x, y): Place) -> Configuration {
    Configuration::new(x as f64 / 2.0, y as f64 / 2.0)
}

fn turn(a: Place, b: Place, c: Place) -> i64 {
    ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).signum()
}

fn is_between(a: Place, b: Place, p: Place) -> bool {
    let within = |a: i64, b: i64, p: i64| a.min(b) <= p && p <= a.max(b);
    turn(a, b, p) == 0 && within(a.0, b.0, p.0) && within(a.1, b.1, p.1)
}

/// Returns true if an edge joins two nodes. An edge is a side, or a segment that meets rectangles only at its ends and
/// leads away from them there.
fn joined(rectangles: &[[Place; 4]], a: Place, b: Place) -> bool {
    let all = || rectangles.iter().chain([&WINDOW]);
    let is_side = |ring: &[Place; 4]| {
        (0..4).any(|k| [(ring[k], ring[(k + 1) % 4]), (ring[(k + 1) % 4], ring[k])].contains(&(a, b)))
    };
    if all().any(is_side) {
        return true;
    }
    // Finds corners between the ends, and sides that are crossed.
    let meets = |ring: &[Place; 4]| {
        (0..4).any(|k| {
            let (p, q) = (ring[k], ring[(k + 1) % 4]);
            let touches = |p: Place| p != a && p != b && is_between(a, b, p);
            let crosses = turn(a, b, p) * turn(a, b, q) < 0 && turn(p, q, a) * turn(p, q, b) < 0;
            let ends_on = |e: Place| e != p && e != q && is_between(p, q, e);
            touches(p) || crosses || ends_on(a) || ends_on(b)
        })
    };
    // A diagonal of a rectangle does not cross its sides.
    let inside = |ring: &[Place; 4]| {
        let (x, y) = (a.0 + b.0, a.1 + b.1);
        2 * ring[0].0 < x && x < 2 * ring[2].0 && 2 * ring[0].1 < y && y < 2 * ring[2].1
    };
    !all().any(meets) && !rectangles.iter().any(inside)
}

#[test]
fn the_full_visibility_graph_is_that_of_the_definition() {
    let mut arcs = 0;
    for seed in 1..=40 {
        let rectangles = rectangles(seed);
        let regions = regions(&rectangles);
        let (start, goal) = ((1, 40), (119, 43));
        let query = Query { start: halves(start), goals: halves(goal).into() };
        let planner = Visibility { graph: VisibilityGraph::Full, ..Visibility::default() };
        let run = planner.query(&regions, &planner.build(&regions), &query);
        let Trace::Roads { edges, kind, .. } = &run.trace else { panic!("{:?}", run.trace) };
        assert_eq!(*kind, GraphKind::Visibility(VisibilityGraph::Full));
        let place = |q: &Configuration| ((q[0] * 2.0) as i64, (q[1] * 2.0) as i64);
        let ordered = |a: Place, b: Place| if a < b { (a, b) } else { (b, a) };
        let found: BTreeSet<_> = edges.iter().map(|[a, b]| ordered(place(a), place(b))).collect();
        assert_eq!(found.len(), edges.len(), "each arc once");
        // The corners of the window are where joint limits meet. They are corners of no obstacle.
        let nodes: Vec<Place> = rectangles.iter().flatten().copied().chain([start, goal]).collect();
        let pairs = nodes.iter().enumerate().flat_map(|(i, &a)| nodes[i + 1..].iter().map(move |&b| (a, b)));
        let expected: BTreeSet<_> =
            pairs.filter(|&(a, b)| joined(&rectangles, a, b)).map(|(a, b)| ordered(a, b)).collect();
        assert_eq!(found, expected, "seed {seed}");
        arcs += found.len();
        // The shortest path equals that of the reduced graph.
        let reduced = Visibility::default();
        let shorter = reduced.query(&regions, &reduced.build(&regions), &query);
        let length = |outcome: &Proposal| if let Proposal::Found(path) = outcome { path.length() } else { panic!() };
        assert!((length(&run.outcome) - length(&shorter.outcome)).abs() < 1e-9, "seed {seed}");
    }
    assert!(arcs > 9_000, "{arcs}");
}
