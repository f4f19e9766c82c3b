//! Benchmarks of roadmap planners among random disjoint polygons that cover 23 % of the area: the construction, the
//! whole visibility graph, and one query. The textbook's visibility graph, which tests every pair of corners against
//! every side, is measured beside them.

use cplan::cspace::Regions;
use cplan::geometry::{Point, segments_cross};
use cplan::planner::{Planner, Proposal, Query, Trapezoid, Visibility};
use cplan::space::Metric;
use cplan_cases::dice::Dice;
use cplan_testkit::roadmap::{sides, star_crowd};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// Total numbers of corners of the scenes.
const SIZES: [usize; 5] = [100, 1_000, 10_000, 20_000, 50_000];

/// Largest number of corners for which the naive graph is measured.
const NAIVE: usize = 1_000;

/// Returns queries between free places in the window.
fn queries(regions: &Regions) -> Vec<Query> {
    let (mut random, planner) = (Dice::new(7), Trapezoid::default());
    let map = planner.build(regions);
    let mut place = || configuration_within(&mut random, regions);
    let mut queries = Vec::new();
    while queries.len() < 32 {
        let query = Query { start: place(), goals: place().into() };
        if matches!(planner.query(regions, &map, &query).outcome, Proposal::Found(_)) {
            queries.push(query);
        }
    }
    queries
}

fn configuration_within(random: &mut Dice, regions: &Regions) -> cplan::space::Configuration {
    let [x, y] = regions.window.map(|(low, high)| random.within(low, high));
    cplan::space::Configuration::new(x, y)
}

fn measure<P: Planner<Space = Regions>>(criterion: &mut Criterion, name: &str, planner: &P) {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(20);
    for size in SIZES {
        let regions = star_crowd(&mut Dice::new(1), size / 10);
        let queries = queries(&regions);
        let map = planner.build(&regions);
        group.bench_function(BenchmarkId::new("build", size), |b| b.iter(|| planner.build(black_box(&regions))));
        let mut next = queries.iter().cycle();
        group.bench_function(BenchmarkId::new("query", size), |b| {
            b.iter_batched(
                || next.next().expect("a cycle has no end"),
                |query| planner.query(&regions, &map, query),
                BatchSize::SmallInput,
            );
        });
    }
    group.finish();
}

/// Computes the visibility graph by its definition, in `O(n^3)`.
fn naive_graph(regions: &Regions) -> usize {
    let sides = sides(regions);
    let corners: Vec<Point> = sides.iter().map(|side| side.0).collect();
    let sees = |p: Point, q: Point| !sides.iter().any(|&(a, b)| segments_cross(p, q, a, b));
    corners.iter().enumerate().map(|(i, &p)| corners[..i].iter().filter(|&&q| sees(p, q)).count()).sum()
}

fn graphs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("visibility graph");
    group.sample_size(10);
    for size in SIZES {
        let regions = star_crowd(&mut Dice::new(1), size / 10);
        let planner = Visibility::default();
        let whole = |regions: &Regions| planner.build(regions).arcs();
        println!("{size} corners: {} arcs", whole(&regions).len());
        group.bench_function(BenchmarkId::new("build and all arcs", size), |b| b.iter(|| whole(black_box(&regions))));
        if size <= NAIVE {
            group.bench_function(BenchmarkId::new("naive", size), |b| b.iter(|| naive_graph(black_box(&regions))));
        }
    }
    group.finish();
}

fn planners(criterion: &mut Criterion) {
    measure(criterion, "visibility", &Visibility::default());
    let time = Visibility { metric: Metric::Time { speeds: [1.0, 1.5], sum: None }, ..Visibility::default() };
    measure(criterion, "visibility, travel time", &time);
    measure(criterion, "trapezoid", &Trapezoid::default());
}

criterion_group!(benches, planners, graphs);
criterion_main!(benches);
