//! Build and query of the roadmap planners on crowds of disjoint convex polygons.

#[path = "../tests/roadmap/mod.rs"]
#[allow(dead_code, reason = "the judges of the test suite are not needed here")]
mod roadmap;

use cplan::cspace::Regions;
use cplan::plan::{Planner, Query, Trapezoid, Visibility};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use roadmap::{Random, configuration, convex_crowd, crowd_regions};
use std::hint::black_box;

/// Polygons along a side of the crowd, and corners of each.
const CROWDS: [(usize, usize); 4] = [(5, 4), (5, 12), (10, 10), (10, 15)];

fn measure<P: Planner<Space = Regions>>(criterion: &mut Criterion, planner: &P) {
    let mut group = criterion.benchmark_group(P::NAME);
    for (side, corners) in CROWDS {
        let vertices = side * side * corners;
        let regions = crowd_regions(side, &convex_crowd(&mut Random(1), side, corners));
        let far = side as f64 + 0.2;
        let query = Query { start: configuration(-0.2, -0.2), goals: vec![configuration(far, far)] };
        let map = planner.build(&regions);
        group.bench_function(BenchmarkId::new("build", vertices), |b| b.iter(|| planner.build(black_box(&regions))));
        group.bench_function(BenchmarkId::new("query", vertices), |b| {
            b.iter(|| planner.query(black_box(&regions), &map, &query));
        });
    }
    group.finish();
}

fn planners(criterion: &mut Criterion) {
    measure(criterion, &Visibility);
    measure(criterion, &Trapezoid::default());
}

criterion_group!(benches, planners);
criterion_main!(benches);
